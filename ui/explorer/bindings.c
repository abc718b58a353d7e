// Which key carries out what: the lab's own table, the user's keys over it, and the names of keys.
#include <string.h>

#include "ui/explorer/actions.h"

typedef struct lab_binding {
    const char *key; // a character, or a name as lab_keys takes it without brackets
    const char *line;
} lab_binding;

static const lab_binding bindings[] = {
    {"Space", "play"},
    {"Right", "step 1"},
    {"l", "step 1"},
    {"Left", "step -1"},
    {"h", "step -1"},
    {"PgDn", "step 20"},
    {"PgUp", "step -20"},
    {"n", "event"},
    {"N", "event -1"},
    {"i", "touch"},
    {"I", "touch -1"},
    {"Home", "seek 0"},
    {"g", "seek 0"},
    {"End", "seek end"},
    {"G", "seek end"},
    {"+", "speed up"},
    {"=", "speed up"},
    {"-", "speed down"},
    {"Backspace", "restart"},
    {"r", "restart"},
    {"Down", "select"},
    {"j", "select"},
    {"Up", "select -1"},
    {"k", "select -1"},
    {"Enter", "edit"},
    {">", "nudge"},
    {"<", "nudge -1"},
    {"p", "push 0.01"},
    {"P", "push -0.01"},
    {"C", "law"},
    {"L", "lock next"},
    {"F", "lock off"},
    {"t", "model"},
    {"x", "extend"},
    {"b", "branch"},
    {"B", "forget"},
    {"c", "compare"},
    {"u", "undo"},
    {"U", "redo"},
    {"C-r", "redo"},
    {"m", "mark"},
    {"Tab", "side"},
    {"z", "zoom in"},
    {"Z", "zoom out"},
    {"0", "zoom all"},
    {"(", "pan left"},
    {"S-Left", "pan left"},
    {")", "pan right"},
    {"S-Right", "pan right"},
    {"f", "follow"},
    {"w", "focus"},
    {"e", "alone"},
    {"a", "axis next"},
    {"v", "axis in"},
    {"V", "axis out"},
    {"S-Up", "axis up"},
    {"S-Down", "axis down"},
    {"1", "trace 1"},
    {"2", "trace 2"},
    {"3", "trace 3"},
    {"4", "trace 4"},
    {"5", "trace 5"},
    {"6", "trace 6"},
    {"7", "trace 7"},
    {"8", "trace 8"},
    {"9", "trace 9"},
    {"o", "open"},
    {"/", "find"},
    {"]", "open +1"},
    {"[", "open -1"},
    {"s", "save"},
    {"S", "scene"},
    {"C-l", "redraw"},
    {"?", "help"},
    {"F1", "help"},
    {"q", "quit"},
    {"C-c", "quit"},
};
enum { BINDINGS = sizeof bindings / sizeof bindings[0] };

static const struct {
    const char *name;
    int key;
} key_names[] = {
    {"Space", ' '},
    {"Enter", KEY_CODE_ENTER},
    {"Esc", KEY_CODE_ESCAPE},
    {"Tab", KEY_CODE_TAB},
    {"Left", KEY_CODE_LEFT},
    {"Right", KEY_CODE_RIGHT},
    {"Up", KEY_CODE_UP},
    {"Down", KEY_CODE_DOWN},
    {"Home", KEY_CODE_HOME},
    {"End", KEY_CODE_END},
    {"PgUp", KEY_CODE_PAGE_UP},
    {"PgDn", KEY_CODE_PAGE_DOWN},
    {"Backspace", KEY_CODE_BACKSPACE},
    {"Delete", KEY_CODE_DELETE},
    {"F1", KEY_CODE_F1},
    {"S-Left", KEY_CODE_SHIFT_LEFT},
    {"S-Right", KEY_CODE_SHIFT_RIGHT},
    {"S-Up", KEY_CODE_SHIFT_UP},
    {"S-Down", KEY_CODE_SHIFT_DOWN},
    {"lt", '<'},
};

int lab_key_of(const char *name, size_t length)
{
    for (size_t i = 0; i < sizeof key_names / sizeof key_names[0]; i++) {
        if (strlen(key_names[i].name) == length && strncmp(key_names[i].name, name, length) == 0) {
            return key_names[i].key;
        }
    }
    if (length == 3 && name[0] == 'C' && name[1] == '-') {
        return name[2] & 0x1f;
    }
    char text[8] = "";
    if (length >= sizeof text || length == 0) {
        return 0;
    }
    memcpy(text, name, length);
    const char *rest = text;
    uint32_t glyph = glyph_decode(&rest);
    // one character and no more
    return *rest == '\0' && (glyph != '?' || name[0] == '?') ? (int)glyph : 0;
}

void lab_key_name(int key, char *text, size_t size)
{
    char glyph[8];
    for (size_t i = 0; i < sizeof key_names / sizeof key_names[0]; i++) {
        // what a binding can hold needs no other name
        if (key_names[i].key == key && key != '<') {
            snprintf(text, size, "%s", key_names[i].name);
            return;
        }
    }
    if (key < ' ') {
        snprintf(text, size, "C-%c", key | 0x60);
        return;
    }
    glyph_encode((uint32_t)key, glyph);
    snprintf(text, size, "%s", glyph);
}

// The lab's own command of a key, or NULL.
static const char *built_in_line(int key)
{
    for (int i = 0; i < BINDINGS; i++) {
        if (lab_key_of(bindings[i].key, strlen(bindings[i].key)) == key) {
            return bindings[i].line;
        }
    }
    return NULL;
}

static lab_user_key *find_user_key(const lab *l, int key)
{
    for (int i = 0; i < l->user_key_count; i++) {
        if (l->user_keys[i].key == key) {
            return (lab_user_key *)&l->user_keys[i];
        }
    }
    return NULL;
}

const char *lab_bound_line(const lab *l, int key)
{
    const lab_user_key *own = find_user_key(l, key);
    if (own != NULL) {
        return own->line[0] ? own->line : NULL;
    }
    return built_in_line(key);
}

const char *lab_overridden_line(const lab_user_key *own)
{
    return built_in_line(own->key);
}

// Whether a line is a command with any arguments.
static bool begins_with(const char *line, const char *command)
{
    size_t length = strlen(command);
    return strncmp(line, command, length) == 0 && strchr(" ", line[length]) != NULL;
}

void lab_keys_of(const lab *l, const char *command, char *text, size_t size)
{
    size_t used = 0;
    char name[16];
    text[0] = '\0';
    for (int i = 0; i < l->user_key_count && used < size; i++) {
        if (begins_with(l->user_keys[i].line, command)) {
            lab_key_name(l->user_keys[i].key, name, sizeof name);
            used += (size_t)snprintf(text + used, size - used, "%s%s", used ? " " : "", name);
        }
    }
    for (int i = 0; i < BINDINGS && used < size; i++) {
        const lab_binding *b = &bindings[i];
        if (begins_with(b->line, command) &&
            find_user_key(l, lab_key_of(b->key, strlen(b->key))) == NULL) {
            used += (size_t)snprintf(text + used, size - used, "%s%s", used ? " " : "", b->key);
        }
    }
}

// --- binding ----------------------------------------------------------------------------------

// The key that begins an argument, and where the rest does; 0 with a message if there is none.
static int take_key(lab *l, const char *argument, const char **rest)
{
    size_t length = strcspn(argument, " \t");
    int key = lab_key_of(argument, length);
    *rest = argument + length + strspn(argument + length, " \t");
    if (length == 0) {
        lab_say(l, true, "a key is a character or a name such as Space, PgUp, F1, S-Left or C-r");
    } else if (key == 0) {
        lab_say(l, true, "there is no key '%.*s'", (int)length, argument);
    } else if (key == ':' || key == KEY_CODE_ESCAPE || key == ('c' & 0x1f)) {
        lab_say(l, true, "%.*s keeps its meaning: the way to the prompt, back or out", (int)length,
                argument);
        key = 0;
    }
    return key;
}

// A free place for a user's key, or the one it has.
static lab_user_key *place_for(lab *l, int key)
{
    lab_user_key *own = find_user_key(l, key);
    if (own == NULL && l->user_key_count < LAB_USER_KEYS) {
        own = &l->user_keys[l->user_key_count++];
        own->key = key;
    }
    if (own == NULL) {
        lab_say(l, true, "there are %d keys of your own already, no more fit", LAB_USER_KEYS);
    }
    return own;
}

bool act_bind_key(lab *l, const char *argument)
{
    const char *line;
    char name[16], before[LAB_TEXT] = "";
    int key = take_key(l, argument, &line);
    if (key == 0) {
        return false;
    }
    lab_key_name(key, name, sizeof name);
    const char *old = lab_bound_line(l, key);
    if (line[0] == '\0') {
        lab_say(l, false, old ? "%s does '%s'" : "%s does nothing", name, old);
        return true;
    }
    l->fault_at += (int)(line - argument);
    if (!lab_is_command(l, line)) {
        return false;
    }
    snprintf(before, sizeof before, "%s", old ? old : "");
    lab_user_key *own = place_for(l, key);
    if (own == NULL) {
        return false;
    }
    snprintf(own->line, sizeof own->line, "%s", line);
    if (before[0] != '\0' && strcmp(before, line) != 0) {
        lab_say(l, false, "%s does '%s' now, no longer '%s'", name, line, before);
    } else {
        lab_say(l, false, "%s does '%s' now", name, line);
    }
    return true;
}

bool act_unbind_key(lab *l, const char *argument)
{
    const char *rest, *built_in;
    char name[16];
    int key = take_key(l, argument, &rest);
    if (key == 0) {
        return false;
    }
    if (rest[0] != '\0') {
        l->fault_at += (int)(rest - argument);
        lab_say(l, true, "unkey takes one key, what is '%s' for?", rest);
        return false;
    }
    lab_key_name(key, name, sizeof name);
    lab_user_key *own = find_user_key(l, key);
    built_in = built_in_line(key);
    if (own != NULL) {
        // the user's key goes, the lab's own comes back
        *own = l->user_keys[--l->user_key_count];
        lab_say(l, false, built_in ? "%s does '%s' again" : "%s does nothing now", name, built_in);
    } else if (built_in != NULL && (own = place_for(l, key)) != NULL) {
        own->line[0] = '\0';
        lab_say(l, false, "%s does nothing now, no longer '%s' (unkey it again to have that back)",
                name, built_in);
    } else if (built_in == NULL) {
        lab_say(l, true, "%s does nothing as it is", name);
        return false;
    }
    return true;
}
