#include "ui/explorer/state/prompt.h"

#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "src/tables/parameters.h"
#include "src/tables/signals.h"
#include "ui/explorer/state/view.h"
#include "ui/terminal/keys.h"
#include "ui/terminal/screen.h"

void prompt_open(prompt *p, const char *value, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    vsnprintf(p->text, sizeof p->text, format, list);
    va_end(list);
    p->open = true;
    p->cycling = p->searches = p->replaces = false;
    p->fixed = 0;
    if (value != NULL) {
        p->fixed = (int)strlen(p->text);
        p->replaces = value[0] != '\0';
        text_add(p->text, sizeof p->text, "%s", value);
    }
}

void prompt_type(prompt *p, int key)
{
    const bool has_value = strlen(p->text) > (size_t)p->fixed, replaces = p->replaces;
    const bool erases = key == ('u' & 0x1f) || (replaces && key == KEY_CODE_BACKSPACE);
    const bool types = key >= ' ' && key < KEY_CODE_FIRST;
    p->replaces = false;

    // the value goes at once; the other keys of the line keep it and continue after it
    if (has_value && (erases || (replaces && types))) {
        p->text[p->fixed] = '\0';
    }
    if (!has_value || !erases) {
        text_type(p->text, key);
    }
}

void text_type(char *text, int key)
{
    // a whole UTF-8 character goes, which begins with a byte that is no continuation
    size_t length = strlen(text);
    if (key == KEY_CODE_BACKSPACE && length > 0) {
        do {
            length--;
        } while (length > 0 && (text[length] & 0xc0) == 0x80);
        text[length] = '\0';
    } else if (key == ('u' & 0x1f)) {
        text[0] = '\0';
    }

    // there must be room for the longest character and the zero behind it
    if (key >= ' ' && key < KEY_CODE_FIRST && length + 5 < LINE_TEXT) {
        glyph_encode((uint32_t)key, text + length);
    }
}

// --- the palette -----------------------------------------------------------------------

// What each kind is called, and the command that deals with what is chosen.
static const struct {
    const char *name, *command;
} kinds[PALETTE_KINDS] = {{"command", ""},
                          {"parameter", "edit "},
                          {"signal", "trace "},
                          {"scenario", "open "},
                          {"lesson", "open "}};

palette_text palette_describe(const scenario_menu *menu, const key_bindings *keys,
                              palette_entry entry)
{
    palette_text text = {.kind = kinds[entry.kind].name};

    // what each is called and about; only commands have keys
    switch (entry.kind) {
    case PALETTE_COMMAND:
        text.name = explorer_command_table[entry.index].name;
        text.about = explorer_command_table[entry.index].help;
        key_names_of(keys, text.name, text.keys, sizeof text.keys);
        break;
    case PALETTE_PARAMETER:
        text.name = parameter_table[entry.index].path;
        text.about = parameter_table[entry.index].description;
        break;
    case PALETTE_SIGNAL:
        text.name = signal_table[entry.index].name;
        text.about = signal_table[entry.index].description;
        break;
    default:
        text.name = menu->names[entry.index];
        text.about = scenario_menu_text(menu, entry.index).title;
    }
    return text;
}

// Other words by which people look for a thing, "" for none.
static const char *synonyms_of(const char *name)
{
    static const struct {
        const char *name, *words;
    } table[] = {{"save", "export picture image plot"},
                 {"scene", "picture image 3d"},
                 {"solve", "goal below above limit target threshold"},
                 {"control.force", "goal target setpoint"},
                 {"wall.restitution", "bounce rebound"},
                 {"sweep", "vary several values"},
                 {"law", "controller control"},
                 {"touch", "bounce hit impact"},
                 {"push", "hit kick"},
                 {"branch", "keep compare copy"},
                 {"why", "explain cause reason"},
                 {"poles", "eigenvalues modes vibration linear"},
                 {"session", "store load keep"},
                 {"quit", "exit leave"}};
    for (size_t i = 0; i < sizeof table / sizeof table[0]; i++) {
        if (strcmp(table[i].name, name) == 0) {
            return table[i].words;
        }
    }
    return "";
}

// How well a thing fits: its name is that, its name or a part of it begins so, its name
// has it, what is said of it has it; -1 if it does not fit.
static int rank_of(const palette_text *text, const char *words)
{
    enum { IS_NAME, BEGINS, IN_NAME, SAID };
    char all[2 * LINE_TEXT];
    const size_t length = strlen(words);
    const char *part = strpbrk(text->name, "./_");
    if (length == 0) {
        return IN_NAME;
    }

    // the best one first
    snprintf(all, sizeof all, "%s %s %s %s", text->name, text->keys, text->about,
             synonyms_of(text->name));
    const bool begins = strncasecmp(text->name, words, length) == 0 ||
                        (part != NULL && strncasecmp(part + 1, words, length) == 0);
    if (strcasecmp(text->name, words) == 0) {
        return IS_NAME;
    }
    if (begins) {
        return BEGINS;
    }
    if (filter_passes(words, text->name)) {
        return IN_NAME;
    }
    if (filter_passes(words, all)) {
        return SAID;
    }
    return -1;
}

// By rank, then by kind, then as their tables have them.
static int compare_entries(const void *a, const void *b)
{
    const palette_entry *one = a, *other = b;
    if (one->rank != other->rank) {
        return one->rank - other->rank;
    }
    if (one->kind != other->kind) {
        return (int)one->kind - (int)other->kind;
    }
    return one->index - other->index;
}

int palette_find(const scenario_menu *menu, const key_bindings *keys, const char *words,
                 palette_entry entries[PALETTE_ENTRIES])
{
    const int counts[PALETTE_KINDS] = {explorer_command_count, parameter_count,
                                       signal_count, menu->count, menu->count};
    int count = 0;
    for (int kind = 0; kind < PALETTE_KINDS; kind++) {
        for (int i = 0; i < counts[kind] && count < PALETTE_ENTRIES; i++) {
            palette_entry entry = {(palette_kind)kind, i, 0};

            // the list of scenarios has the lessons too
            if (kind >= PALETTE_SCENARIO &&
                scenario_menu_text(menu, i).is_lesson != (kind == PALETTE_LESSON)) {
                continue;
            }
            const palette_text text = palette_describe(menu, keys, entry);
            entry.rank = rank_of(&text, words);
            if (entry.rank >= 0) {
                entries[count++] = entry;
            }
        }
    }
    qsort(entries, (size_t)count, sizeof *entries, compare_entries);
    return count;
}

void palette_line(const scenario_menu *menu, const key_bindings *keys,
                  palette_entry entry, char line[LINE_TEXT], bool *needs_argument)
{
    // what is in brackets need not be there
    *needs_argument = false;
    if (entry.kind == PALETTE_COMMAND) {
        const char *argument = explorer_command_table[entry.index].argument;
        *needs_argument = argument[0] != '\0' && argument[0] != '[';
    }
    snprintf(line, LINE_TEXT, "%s%s", kinds[entry.kind].command,
             palette_describe(menu, keys, entry).name);
    if (*needs_argument) {
        text_add(line, LINE_TEXT, " ");
    }
}

bool palette_shows(const prompt *p)
{
    return p->open && (p->searches || (p->fixed == 0 && p->text[0] != '\0' &&
                                       strchr(p->text, ' ') == NULL));
}
