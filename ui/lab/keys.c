// The keys of the terminal lab: what each carries out, and how the prompt, the list and the pages
// take them.
#include <limits.h>
#include <string.h>

#include "ui/lab/lab.h"

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
enum { KEYS_SHOWN = 24 }; // cells of the help
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
    {"lt", '<'},
};

void lab_keys_of(const char *command, char *text, size_t size)
{
    size_t used = 0, length = strlen(command);
    text[0] = '\0';
    for (int i = 0; i < BINDINGS && used < KEYS_SHOWN; i++) {
        const lab_binding *b = &bindings[i];
        if (strncmp(b->line, command, length) == 0 && strchr(" ", b->line[length]) != NULL) {
            used += (size_t)snprintf(text + used, size - used, "%s%s", used ? " " : "", b->key);
        }
    }
}

// The key of a name, 0 if there is none.
static int key_of(const char *name, size_t length)
{
    for (size_t i = 0; i < sizeof key_names / sizeof key_names[0]; i++) {
        if (strlen(key_names[i].name) == length && strncmp(key_names[i].name, name, length) == 0) {
            return key_names[i].key;
        }
    }
    if (length == 3 && name[0] == 'C' && name[1] == '-') {
        return name[2] & 0x1f;
    }
    return length == 1 ? (unsigned char)name[0] : 0;
}

bool lab_keys(lab *l, const char *text, fault *f)
{
    while (*text != '\0' && !l->quit) {
        const char *close = *text == '<' ? strchr(text, '>') : NULL;
        if (close == NULL) {
            lab_key(l, (unsigned char)*text++);
            continue;
        }
        int key = key_of(text + 1, (size_t)(close - text - 1));
        if (key == 0) {
            fault_set(f, STATUS_BAD_ARGUMENT, "there is no key '%.*s'", (int)(close - text + 1),
                      text);
            return false;
        }
        lab_key(l, key);
        text = close + 1;
    }
    return true;
}

// Puts a character at a text's end or takes the last one off. False if the key does neither.
static bool type(char *text, int key)
{
    size_t length = strlen(text);
    if (key == KEY_CODE_BACKSPACE || key == 127 || key == 8) {
        while (length > 0 && (text[length - 1] & 0xc0) == 0x80) {
            length--;
        }
        text[length > 0 ? length - 1 : 0] = '\0';
        return true;
    }
    if (key == ('u' & 0x1f)) {
        text[0] = '\0';
        return true;
    }
    if (key < ' ' || key >= KEY_CODE_FIRST || length + 5 >= LAB_TEXT) {
        return false;
    }
    glyph_encode((uint32_t)key, text + length);
    return true;
}

// Candidates for the word that is being typed: the i-th, or NULL.
static const char *candidate(const lab *l, const char *command, int i)
{
    if (command == NULL) {
        return lab_command_name(i);
    }
    if (strcmp(command, "set") == 0) {
        return i < parameter_count ? parameter_table[i].path : NULL;
    }
    if (strcmp(command, "trace") == 0) {
        return i < signal_count ? signal_table[i].name : NULL;
    }
    if (strcmp(command, "open") == 0) {
        return i < l->name_count ? l->names[i] : NULL;
    }
    return NULL;
}

// Completes the prompt's last word as far as its candidates agree, and lists them.
static void complete(lab *l)
{
    char *space = strrchr(l->prompt, ' '), *word = space ? space + 1 : l->prompt;
    char command[32] = "", common[LAB_TEXT] = "", listed[512] = "";
    snprintf(command, sizeof command, "%.*s", (int)strcspn(l->prompt, " "), l->prompt);
    const char *name;
    size_t used = 0;
    int count = 0;
    for (int i = 0; (name = candidate(l, space ? command : NULL, i)) != NULL; i++) {
        if (strncmp(name, word, strlen(word)) != 0) {
            continue;
        }
        if (count++ == 0) {
            snprintf(common, sizeof common, "%s", name);
        }
        size_t same = 0;
        while (common[same] != '\0' && common[same] == name[same]) {
            same++;
        }
        common[same] = '\0';
        if (used < sizeof listed) {
            used += (size_t)snprintf(listed + used, sizeof listed - used, "%s ", name);
        }
    }
    if (count == 0) {
        return;
    }
    size_t room = sizeof l->prompt - (size_t)(word - l->prompt);
    snprintf(word, room, "%s%s", common, count == 1 ? " " : "");
    lab_say(l, false, "%s", count > 1 ? listed : "");
}

static void key_in_prompt(lab *l, int key)
{
    char line[LAB_TEXT];
    switch (key) {
    case KEY_CODE_ESCAPE:
    case 'c' & 0x1f:
        l->prompting = false;
        l->message[0] = '\0';
        break;
    case KEY_CODE_ENTER:
    case '\n':
        l->prompting = false;
        l->message[0] = '\0';
        snprintf(line, sizeof line, "%s", l->prompt);
        snprintf(l->history, sizeof l->history, "%s", line);
        lab_carry_out(l, line);
        break;
    case KEY_CODE_TAB:
        complete(l);
        break;
    case KEY_CODE_UP:
        snprintf(l->prompt, sizeof l->prompt, "%s", l->history);
        break;
    default:
        type(l->prompt, key);
    }
}

// The list's selected line moved on to one that the filter lets through.
static void move_in_list(lab *l, int direction)
{
    for (int i = l->scroll + direction; i >= 0 && i < l->name_count; i += direction) {
        if (lab_listed(l, l->names[i])) {
            l->scroll = i;
            return;
        }
    }
}

static void key_in_filter(lab *l, int key)
{
    if (key == KEY_CODE_ENTER || key == '\n' || key == KEY_CODE_ESCAPE) {
        l->filtering = false;
    } else {
        type(l->filter, key);
    }
    if (l->scroll < l->name_count && !lab_listed(l, l->names[l->scroll])) {
        l->scroll = -1;
        move_in_list(l, 1);
        l->scroll = l->scroll < 0 ? 0 : l->scroll;
    }
}

static void key_in_list(lab *l, int key)
{
    if (l->filtering) {
        key_in_filter(l, key);
    } else if (key == '/') {
        l->filtering = true;
        l->filter[0] = '\0';
    } else if (key == KEY_CODE_UP || key == 'k') {
        move_in_list(l, -1);
    } else if (key == KEY_CODE_DOWN || key == 'j') {
        move_in_list(l, 1);
    } else if (key == KEY_CODE_PAGE_UP || key == KEY_CODE_PAGE_DOWN) {
        for (int i = 0; i < 10; i++) {
            move_in_list(l, key == KEY_CODE_PAGE_UP ? -1 : 1);
        }
    } else if (key == KEY_CODE_ENTER || key == '\n') {
        l->overlay = OVERLAY_NONE;
        if (l->scroll < l->name_count && lab_listed(l, l->names[l->scroll])) {
            lab_open(l, l->names[l->scroll]);
        }
    } else if (key == KEY_CODE_ESCAPE || key == 'q' || key == 'o') {
        l->overlay = OVERLAY_NONE;
    }
}

// In help and comparison: scrolling and leaving.
static void key_in_page(lab *l, int key)
{
    if (key == KEY_CODE_DOWN || key == 'j' || key == KEY_CODE_PAGE_DOWN) {
        l->scroll += lab_help_line(l->scroll + 1) != NULL;
    } else if (key == KEY_CODE_UP || key == 'k' || key == KEY_CODE_PAGE_UP) {
        l->scroll -= l->scroll > 0;
    } else if (key == KEY_CODE_END || key == 'G') {
        l->scroll = INT_MAX;
    } else if (key == KEY_CODE_HOME || key == 'g') {
        l->scroll = 0;
    } else {
        l->overlay = OVERLAY_NONE;
    }
}

static void key_by_table(lab *l, int key)
{
    key = key == '\n' ? KEY_CODE_ENTER : key == 127 || key == 8 ? KEY_CODE_BACKSPACE : key;
    for (int i = 0; i < BINDINGS; i++) {
        if (key_of(bindings[i].key, strlen(bindings[i].key)) == key) {
            l->message[0] = '\0';
            lab_carry_out(l, bindings[i].line);
            return;
        }
    }
    if (key == KEY_CODE_ESCAPE) {
        l->message[0] = '\0';
        l->has_mark = false;
    } else if (key > ' ' && key < 127) {
        lab_say(l, true, "'%c' does nothing here, ? lists the keys", key);
    }
}

void lab_key(lab *l, int key)
{
    if (l->prompting) {
        key_in_prompt(l, key);
    } else if (key == ':') {
        l->prompting = true;
        l->prompt[0] = '\0';
        l->message[0] = '\0';
    } else if (l->overlay == OVERLAY_OPEN) {
        key_in_list(l, key);
    } else if (l->overlay != OVERLAY_NONE && key != ('c' & 0x1f)) {
        key_in_page(l, key);
    } else if (key == '/') {
        lab_carry_out(l, "open");
        l->filtering = true;
    } else {
        key_by_table(l, key);
    }
}
