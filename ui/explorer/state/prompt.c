#include "ui/explorer/state/prompt.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "src/base/text_stream.h"
#include "src/base/whole_file.h"
#include "src/tables/parameters.h"
#include "src/tables/signals.h"
#include "src/tables/summary.h"
#include "ui/explorer/state/view.h"
#include "ui/terminal/keys.h"
#include "ui/terminal/line_editor.h"
#include "ui/terminal/screen.h"

void prompt_open(prompt *p, const char *value, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    vsnprintf(p->text, sizeof p->text, format, list);
    va_end(list);
    p->open = true;
    p->cycling = p->searches = p->replaces = false;
    p->fixed = p->recalled = 0;
    if (value != NULL) {
        p->fixed = (int)strlen(p->text);
        p->replaces = value[0] != '\0';
        text_add(p->text, sizeof p->text, "%s", value);
    }
    p->cursor = (int)strlen(p->text);
}

bool prompt_type(prompt *p, int key)
{
    // a value that is to be replaced goes at once; other keys keep it and go on in it
    const bool types = key >= ' ' && key < KEY_CODE_FIRST;
    if (p->replaces && (types || key == KEY_CODE_BACKSPACE || key == KEY_CODE_DELETE)) {
        p->text[p->fixed] = '\0';
        p->cursor = p->fixed;
        p->replaces = false;
        if (!types) {
            return true;
        }
    }
    p->replaces = false;
    return line_edit_key(p->text, LINE_TEXT, p->fixed, &p->cursor, key) != LINE_FULL;
}

bool text_type(char *text, int key)
{
    int end = (int)strlen(text);
    const bool known = key == KEY_CODE_BACKSPACE || key == ('u' & 0x1f) ||
                       key == ('w' & 0x1f) || (key >= ' ' && key < KEY_CODE_FIRST);
    return !known || line_edit_key(text, LINE_TEXT, 0, &end, key) != LINE_FULL;
}

// --- lines that were entered -----------------------------------------------------------

// Keeps a line behind the others, of which the oldest goes where there is no room.
static void add_to_history(prompt *p, const char *line)
{
    if (p->history_count == HISTORY_LINES) {
        memmove(p->history[0], p->history[1], sizeof p->history - sizeof p->history[0]);
        p->history_count--;
    }
    snprintf(p->history[p->history_count++], LINE_TEXT, "%s", line);
}

void prompt_remember(prompt *p, const char *line)
{
    const int count = p->history_count;
    if (line[0] == '\0' || (count > 0 && strcmp(p->history[count - 1], line) == 0)) {
        return;
    }
    add_to_history(p, line);

    // a file that cannot be written keeps nothing, which hinders no command
    FILE *file = p->history_path[0] != '\0' ? fopen(p->history_path, "ae") : NULL;
    if (file != NULL) {
        fprintf(file, "%s\n", line);
        fclose(file);
    }
}

void prompt_recall(prompt *p, int direction)
{
    const int to = p->recalled - direction;
    if (to < 0 || to > p->history_count) {
        return;
    }
    if (p->recalled == 0) {
        snprintf(p->typed, sizeof p->typed, "%s", p->text);
    }
    if (to == 0) {
        prompt_open(p, NULL, "%s", p->typed);
    } else {
        prompt_open(p, NULL, "%s", p->history[p->history_count - to]);
    }
    p->recalled = to;
}

void prompt_use_history(prompt *p, const char *path)
{
    char *line = NULL;
    size_t room = 0;
    int lines = 0;
    snprintf(p->history_path, sizeof p->history_path, "%s", path);
    FILE *file = fopen(path, "re");
    for (; file != NULL && getline(&line, &room, file) >= 0; lines++) {
        line[strcspn(line, "\r\n")] = '\0';
        if (line[0] != '\0' && strlen(line) < LINE_TEXT) {
            add_to_history(p, line);
        }
    }
    free(line);
    if (file != NULL) {
        fclose(file);
    }

    // a file that has grown long keeps the latest
    whole_file shorter;
    if (lines > 2 * HISTORY_LINES && whole_file_open(&shorter, path, NULL) == STATUS_OK) {
        for (int i = 0; i < p->history_count; i++) {
            fprintf(shorter.stream, "%s\n", p->history[i]);
        }
        loss_unless(whole_file_commit(&shorter, NULL) == STATUS_OK);
    }
}

// --- the palette -----------------------------------------------------------------------

// What each kind is called, and the command that deals with what is chosen.
static const struct {
    const char *name, *command;
} kinds[PALETTE_KINDS] = {{"command", ""},       {"parameter", "edit "},
                          {"signal", "trace "},  {"quantity", "quantity "},
                          {"scenario", "open "}, {"lesson", "open "}};

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
    case PALETTE_QUANTITY:
        text.name = summary_table[entry.index].key;
        text.about = summary_table[entry.index].description;
        break;
    default:
        text.name = menu->names[entry.index];
        text.about = scenario_menu_text(menu, entry.index).title;
    }
    return text;
}

const char *synonyms_of(const char *name)
{
    static const struct {
        const char *name, *words;
    } table[] = {{"save", "export figure picture image plot recipe csv"},
                 {"scene", "figure picture image 3d"},
                 {"editor", "edit source yaml vim"},
                 {"changes", "history list edits"},
                 {"undo", "back revert history"},
                 {"redo", "forward again history"},
                 {"data", "measurement recording csv bench overlay"},
                 {"reload", "refresh again recording"},
                 {"spectrum", "fft frequency"},
                 {"mark", "cursor measure ruler"},
                 {"peak_force_N", "maximum hit hard"},
                 {"force_over_command_N", "overshoot"},
                 {"force_overshoot_percent", "overshoot"},
                 {"settling_time_s", "settling settled"},
                 {"impacts", "bounces hits"},
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
                 {"session", "store save load keep resume"},
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
    const int counts[PALETTE_KINDS] = {
        explorer_command_count, parameter_count, signal_count,
        summary_count,          menu->count,     menu->count};
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
