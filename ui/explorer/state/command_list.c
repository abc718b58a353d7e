#include "ui/explorer/state/command_list.h"

#include <assert.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "ui/terminal/keys.h"
#include "ui/terminal/screen.h"

const char *text_cut(const char *text, const char *ends, char *word, size_t size)
{
    const size_t length = strcspn(text, ends);
    snprintf(word, size, "%.*s", (int)length, text);
    return text + length + strspn(text + length, ends);
}

const explorer_command explorer_command_table[] = {
#define COMMAND_INFO(group, name, call, keys, argument, help)                            \
    {group, name, keys, argument, help},
    COMMAND_LIST(COMMAND_INFO)
#undef COMMAND_INFO
};
const int explorer_command_count =
    sizeof explorer_command_table / sizeof explorer_command_table[0];

int explorer_command_find(const char *name)
{
    int found = -1, matches = 0;
    for (int i = 0; i < explorer_command_count; i++) {
        const char *own = explorer_command_table[i].name;
        if (strcmp(own, name) == 0) {
            return i;
        }

        // a beginning never means the one that asks no questions
        if (strncmp(own, name, strlen(name)) == 0 && own[strlen(own) - 1] != '!') {
            found = i;
            matches++;
        }
    }

    // the only one that begins so
    if (matches == 1) {
        return found;
    }
    return -1;
}

// --- keys ------------------------------------------------------------------------------

static const struct {
    const char *name;
    int key;
} key_names[] = {
#define KEY_NAMED(code, name, curses) {name, KEY_CODE_##code},
    KEY_LIST(KEY_NAMED)
#undef KEY_NAMED
        {"Space", ' '},
    {"Enter", KEY_CODE_ENTER},
    {"Esc", KEY_CODE_ESCAPE},
    {"Tab", KEY_CODE_TAB},
    {"lt", '<'}};

int key_of_name(const char *name, size_t length)
{
    char text[KEY_NAME] = "";
    if (length >= sizeof text || length == 0) {
        return 0;
    }
    memcpy(text, name, length);
    for (size_t i = 0; i < sizeof key_names / sizeof key_names[0]; i++) {
        if (strcmp(key_names[i].name, text) == 0) {
            return key_names[i].key;
        }
    }

    // Ctrl with a letter
    if (length == 3 && text[0] == 'C' && text[1] == '-') {
        return text[2] & 0x1f;
    }

    // one character and no more; a byte that is none is decoded as a question mark
    const char *rest = text;
    const uint32_t glyph = glyph_decode(&rest);
    if (*rest == '\0' && (glyph != '?' || name[0] == '?')) {
        return (int)glyph;
    }
    return 0;
}

void key_name(int key, char *text, size_t size)
{
    // by name; what a binding can hold needs no other name than "<"
    for (size_t i = 0; i < sizeof key_names / sizeof key_names[0]; i++) {
        if (key_names[i].key == key && key != '<') {
            snprintf(text, size, "%s", key_names[i].name);
            return;
        }
    }

    // as itself, or as Ctrl with a letter
    char name[8] = {'C', '-', (char)(key | 0x60)};
    if (key >= ' ') {
        glyph_encode((uint32_t)key, name);
    }
    snprintf(text, size, "%s", name);
}

// A key of the explorer's own.
typedef struct binding {
    int key;
    char name[KEY_NAME];
    char line[KEY_NAME + 8];
} binding;

enum { BINDINGS = 128 };

// Reads a word of a command's keys, KEY or KEY:ARGUMENT.
static binding read_binding(const char *word, const char *command)
{
    binding b;
    const char *argument = text_cut(word, ":", b.name, sizeof b.name);
    b.key = key_of_name(b.name, strlen(b.name));
    snprintf(b.line, sizeof b.line, "%s", command);
    if (*argument != '\0') {
        text_add(b.line, sizeof b.line, " %s", argument);
    }
    return b;
}

// All of them in the order of the commands, read from their table once; key 0 behind the
// last.
static const binding *built_in_keys(void)
{
    static binding all[BINDINGS + 1];
    static int count, read;
    for (; read < explorer_command_count; read++) {
        const explorer_command *c = &explorer_command_table[read];
        const char *keys = c->keys;
        while (*keys != '\0') {
            char word[2 * KEY_NAME];
            keys = text_cut(keys, " ", word, sizeof word);
            assert(count < BINDINGS);
            all[count++] = read_binding(word, c->name);
        }
    }
    return all;
}

const char *key_built_in_line(int key)
{
    for (const binding *b = built_in_keys(); b->key != 0; b++) {
        if (b->key == key) {
            return b->line;
        }
    }
    return NULL;
}

int key_own(const key_bindings *b, int key)
{
    int index = b->count - 1;
    while (index >= 0 && b->own[index].key != key) {
        index--;
    }
    return index;
}

bool key_bind(key_bindings *b, int key, const char *line)
{
    int at = key_own(b, key);
    if (at < 0) {
        if (b->count == USER_KEYS) {
            return false;
        }
        at = b->count++;
    }
    b->own[at].key = key;
    snprintf(b->own[at].line, sizeof b->own[at].line, "%s", line);
    return true;
}

const char *key_line(const key_bindings *b, int key)
{
    const int own = key_own(b, key);
    const char *line;
    if (own >= 0) {
        line = b->own[own].line;
    } else {
        line = key_built_in_line(key);
    }
    if (line == NULL || line[0] == '\0') {
        return NULL;
    }
    return line;
}

// Whether a line is a command with any arguments.
static bool begins_with(const char *line, const char *command)
{
    size_t length = strlen(command);
    return strncmp(line, command, length) == 0 && strchr(" ", line[length]) != NULL;
}

// Adds a name to a list with blanks between them.
static void add_name(char *text, size_t size, const char *name)
{
    if (text[0] != '\0') {
        text_add(text, size, " ");
    }
    text_add(text, size, "%s", name);
}

void key_names_of(const key_bindings *b, const char *command, char *text, size_t size)
{
    text[0] = '\0';

    // the user's keys first, then the explorer's that are not overridden
    for (int i = 0; i < b->count; i++) {
        if (begins_with(b->own[i].line, command)) {
            char name[KEY_NAME];
            key_name(b->own[i].key, name, sizeof name);
            add_name(text, size, name);
        }
    }
    for (const binding *own = built_in_keys(); own->key != 0; own++) {
        if (begins_with(own->line, command) && key_own(b, own->key) < 0) {
            add_name(text, size, own->name);
        }
    }
}
