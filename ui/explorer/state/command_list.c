#include "ui/explorer/state/command_list.h"

#include <assert.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "src/base/words.h"
#include "ui/terminal/keys.h"
#include "ui/terminal/screen.h"

const explorer_command explorer_command_table[] = {
#define COMMAND_INFO(group, name, argument, help, function) {group, name, argument, help},
    COMMAND_LIST(COMMAND_INFO)
#undef COMMAND_INFO
};
const int explorer_command_count = sizeof explorer_command_table / sizeof explorer_command_table[0];

int explorer_command_find(const char *name)
{
    int found = -1, matches = 0;

    // the whole name, else the only one that begins with it
    for (int i = 0; i < explorer_command_count; i++) {
        if (strcmp(explorer_command_table[i].name, name) == 0) {
            return i;
        }

        // a beginning never means the one that asks no questions
        const char *own = explorer_command_table[i].name;
        if (strncmp(own, name, strlen(name)) == 0 && own[strlen(own) - 1] != '!') {
            found = i;
            matches++;
        }
    }
    return matches == 1 ? found : -1;
}

const char *explorer_command_suggest(const char *name)
{
    nearest_word near = nearest_begin(name);
    for (int i = 0; i < explorer_command_count; i++) {
        nearest_try(&near, explorer_command_table[i].name);
    }
    return near.best;
}

// --- keys -------------------------------------------------------------------------------------

typedef struct binding {
    const char *key; // a character, or a name as in --keys without its brackets
    const char *line;
} binding;

// In the order of the commands, so that the keys of one stand together.
static const binding bindings[] = {{"Space", "play"},
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
                                   {"R", "runs"},
                                   {"D", "difference"},
                                   {"M", "metric"},
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
                                   {"K", "signal"},
                                   {"W", "why"},
                                   {"X", "statistics"},
                                   {"T", "lanes"},
                                   {"o", "open"},
                                   {"A", "answer"},
                                   {"y", "continue"},
                                   {"/", "filter"},
                                   {"d", "info"},
                                   {"H", "changes"},
                                   {"]", "open +1"},
                                   {"[", "open -1"},
                                   {"s", "save"},
                                   {"S", "scene"},
                                   {"C-p", "palette"},
                                   {"C-l", "redraw"},
                                   {"?", "help"},
                                   {"F1", "explain"},
                                   {"q", "quit"},
                                   {"C-c", "interrupt"}};
enum { BINDINGS = sizeof bindings / sizeof bindings[0] };

static const struct {
    const char *name;
    int key;
} key_names[] = {{"Space", ' '},
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
                 {"lt", '<'}};

int key_of_name(const char *name, size_t length)
{
    for (size_t i = 0; i < sizeof key_names / sizeof key_names[0]; i++) {
        if (strlen(key_names[i].name) == length && strncmp(key_names[i].name, name, length) == 0) {
            return key_names[i].key;
        }
    }
    if (length == 3 && name[0] == 'C' && name[1] == '-') {
        return name[2] & 0x1f;
    }

    // one character and no more
    char text[8] = "";
    if (length >= sizeof text || length == 0) {
        return 0;
    }
    memcpy(text, name, length);
    const char *rest = text;
    uint32_t glyph = glyph_decode(&rest);
    return *rest == '\0' && (glyph != '?' || name[0] == '?') ? (int)glyph : 0;
}

void key_name(int key, char *text, size_t size)
{
    char glyph[8];

    // by name, as Ctrl with a letter, or as itself
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

const char *key_built_in_line(int key)
{
    for (int i = 0; i < BINDINGS; i++) {
        if (key_of_name(bindings[i].key, strlen(bindings[i].key)) == key) {
            return bindings[i].line;
        }
    }
    return NULL;
}

// The index of a user's key, -1 if it is none.
static int own_index(const key_bindings *b, int key)
{
    for (int i = 0; i < b->count; i++) {
        if (b->own[i].key == key) {
            return i;
        }
    }
    return -1;
}

user_key *key_find_own(key_bindings *b, int key)
{
    int index = own_index(b, key);
    return index >= 0 ? &b->own[index] : NULL;
}

user_key *key_add_own(key_bindings *b, int key)
{
    user_key *own = key_find_own(b, key);
    if (own == NULL && b->count < USER_KEYS) {
        own = &b->own[b->count++];
        *own = (user_key){.key = key};
    }
    return own;
}

void key_remove_own(key_bindings *b, user_key *own)
{
    assert(b != NULL && own >= b->own && own < b->own + b->count);
    *own = b->own[--b->count];
}

const char *key_line(const key_bindings *b, int key)
{
    int index = own_index(b, key);
    if (index >= 0) {
        return b->own[index].line[0] ? b->own[index].line : NULL;
    }
    return key_built_in_line(key);
}

// Whether a line is a command with any arguments.
static bool begins_with(const char *line, const char *command)
{
    size_t length = strlen(command);
    return strncmp(line, command, length) == 0 && strchr(" ", line[length]) != NULL;
}

void key_names_of(const key_bindings *b, const char *command, char *text, size_t size)
{
    assert(b != NULL && command != NULL && text != NULL && size > 0);
    size_t used = 0;
    char name[KEY_NAME];
    text[0] = '\0';

    // the user's keys first, then the explorer's that are not overridden
    for (int i = 0; i < b->count && used < size; i++) {
        if (begins_with(b->own[i].line, command)) {
            key_name(b->own[i].key, name, sizeof name);
            used += (size_t)snprintf(text + used, size - used, "%s%s", used ? " " : "", name);
        }
    }
    for (int i = 0; i < BINDINGS && used < size; i++) {
        const binding *own = &bindings[i];
        if (begins_with(own->line, command) &&
            own_index(b, key_of_name(own->key, strlen(own->key))) < 0) {
            used += (size_t)snprintf(text + used, size - used, "%s%s", used ? " " : "", own->key);
        }
    }
}
