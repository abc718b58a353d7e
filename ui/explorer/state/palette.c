#include "ui/explorer/state/palette.h"

#include <glib.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "src/base/text_stream.h"

// --- files -----------------------------------------------------------------------------

// What the lab does with a file, by the end of its name; NULL: nothing.
static const struct {
    const char *ending, *command, *about;
} openings[] = {{".csv", "data ", "measured columns under the run"},
                {".session", "session open ", "a session: runs, changes, panes"},
                {".yaml", "open ", "a scenario"}};
enum { OPENINGS = sizeof openings / sizeof openings[0] };

// Which of them takes a file, -1 for none.
static int opening_of(const char *name)
{
    for (int i = 0; i < OPENINGS; i++) {
        if (g_str_has_suffix(name, openings[i].ending)) {
            return i;
        }
    }
    return -1;
}

enum { MOST_EVENTS = 256 }; // listed

static int compare_names(const void *a, const void *b)
{
    return strcmp(a, b);
}

void palette_read_files(file_list *files)
{
    *files = (file_list){.count = 0};
    GDir *here = g_dir_open(".", 0, NULL);
    for (const char *name; here != NULL && (name = g_dir_read_name(here)) != NULL;) {
        const bool fits = strlen(name) < FILE_NAME && files->count < FILES_LISTED;
        if (fits && name[0] != '.' && opening_of(name) >= 0) {
            g_strlcpy(files->names[files->count++], name, FILE_NAME);
        }
    }
    if (here != NULL) {
        g_dir_close(here);
    }
    qsort(files->names, (size_t)files->count, FILE_NAME, compare_names);
}

void palette_take_path(file_list *files, const char *typed)
{
    g_autofree char *path = g_strdup(typed);
    if (g_str_has_prefix(typed, "~/")) {
        g_free(path);
        path = g_strconcat(g_get_home_dir(), typed + 1, NULL);
    }
    files->typed[0] = '\0';
    if (strchr(path, '/') != NULL && strlen(path) < LINE_TEXT && opening_of(path) >= 0 &&
        access(path, R_OK) == 0) {
        g_strlcpy(files->typed, path, LINE_TEXT);
    }
}

// The name of a file of the list; the one whose path is typed comes last.
static const char *file_name(const file_list *files, int index)
{
    return index < files->count ? files->names[index] : files->typed;
}

// --- entries ---------------------------------------------------------------------------

// What each kind is called, and the command that deals with what is chosen.
static const struct {
    const char *name, *command;
} kinds[PALETTE_KINDS] = {{"command", ""},       {"parameter", "edit "},
                          {"signal", "trace "},  {"quantity", "quantity "},
                          {"scenario", "open "}, {"lesson", "open "},
                          {"run", "take "},      {"event", "seek "},
                          {"file", ""},          {"recording", "data "},
                          {"help", "help "}};

// What is said of an entry: its name, what it is about.
static const char *describe(const explorer_model *model, const explorer_view *view,
                            palette_entry entry, const char **about)
{
    const scenario_menu *menu = &view->scenarios;
    const int i = entry.index;
    switch (entry.kind) {
    case PALETTE_COMMAND:
        *about = explorer_command_table[i].help;
        return explorer_command_table[i].name;
    case PALETTE_PARAMETER:
        *about = parameter_table[i].description;
        return parameter_table[i].path;
    case PALETTE_SIGNAL:
        *about = signal_table[i].description;
        return signal_table[i].name;
    case PALETTE_QUANTITY:
        *about = summary_table[i].description;
        return summary_table[i].key;
    case PALETTE_RUN:
        *about = "goes on with this pinned run";
        return model->pinned.runs[i].name;
    case PALETTE_EVENT:
        *about = event_description((int)model->session.run.trace.events[i].kind);
        return event_name(model->session.run.trace.events[i].kind);
    case PALETTE_FILE:
        *about = openings[opening_of(file_name(&view->files, i))].about;
        return file_name(&view->files, i);
    case PALETTE_RECORDING:
        *about = "the same, and the run plays their command";
        return file_name(&view->files, i);
    case PALETTE_TOPIC:
        *about = "of the help";
        return explorer_command_table[i].group;
    default:
        *about = scenario_menu_text(menu, i).title;
        return menu->names[i];
    }
}

palette_text palette_describe(const explorer_model *model, const explorer_view *view,
                              palette_entry entry)
{
    palette_text text = {.kind = kinds[entry.kind].name};
    g_strlcpy(text.name, describe(model, view, entry, &text.about), LINE_TEXT);
    if (entry.kind == PALETTE_COMMAND) {
        key_names_of(&view->keys, text.name, text.keys, sizeof text.keys);
    } else if (entry.kind == PALETTE_EVENT) {
        text_add(text.name, LINE_TEXT, " at %.5g s",
                 model->session.run.trace.events[entry.index].time);
    }
    return text;
}

const char *synonyms_of(const char *name)
{
    static const struct {
        const char *name, *words;
    } table[] = {{"save", "export figure picture image plot recipe csv"},
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

// Whether a palette of a scope lists a kind.
static bool is_in_scope(palette_scope scope, palette_kind kind)
{
    switch (scope) {
    case SCOPE_SCENARIOS:
        return kind == PALETTE_SCENARIO || kind == PALETTE_LESSON || kind == PALETTE_FILE;
    case SCOPE_LESSONS:
        return kind == PALETTE_LESSON;
    default:
        return true;
    }
}

// Whether there is an entry: the table of its kind may have others in between.
static bool has_entry(const explorer_model *model, const explorer_view *view,
                      palette_entry entry)
{
    const scenario_menu *menu = &view->scenarios;
    const char *file;
    switch (entry.kind) {
    case PALETTE_SCENARIO:
        return !scenario_menu_text(menu, entry.index).is_lesson;
    case PALETTE_LESSON:
        return scenario_menu_text(menu, entry.index).is_lesson;
    case PALETTE_EVENT:
        return model->session.run.trace.events[entry.index].time <= model->session.seen;
    case PALETTE_RECORDING:
        file = file_name(&view->files, entry.index);
        return strcmp(openings[opening_of(file)].command, kinds[entry.kind].command) == 0;
    case PALETTE_TOPIC:
        return explorer_command_table[entry.index].group[0] != '\0';
    default:
        return true;
    }
}

int palette_find(const explorer_model *model, const explorer_view *view,
                 const char *words, palette_entry entries[PALETTE_ENTRIES])
{
    const int files = view->files.count + (view->files.typed[0] != '\0' ? 1 : 0);
    const int events = (int)model->session.run.trace.event_count;
    const int counts[PALETTE_KINDS] = {explorer_command_count,
                                       parameter_count,
                                       signal_count,
                                       summary_count,
                                       view->scenarios.count,
                                       view->scenarios.count,
                                       model->pinned.count,
                                       events < MOST_EVENTS ? events : MOST_EVENTS,
                                       files,
                                       files,
                                       explorer_command_count};
    int count = 0;
    for (int kind = 0; kind < PALETTE_KINDS; kind++) {
        if (!is_in_scope(view->palette.scope, (palette_kind)kind)) {
            continue;
        }
        for (int i = 0; i < counts[kind] && count < PALETTE_ENTRIES; i++) {
            palette_entry entry = {(palette_kind)kind, i, 0};
            if (!has_entry(model, view, entry)) {
                continue;
            }
            const palette_text text = palette_describe(model, view, entry);
            entry.rank = rank_of(&text, words);
            if (entry.rank >= 0) {
                entries[count++] = entry;
            }
        }
    }
    qsort(entries, (size_t)count, sizeof *entries, compare_entries);
    return count;
}

void palette_line(const explorer_model *model, const explorer_view *view,
                  palette_entry entry, char line[LINE_TEXT], bool *needs_argument)
{
    const palette_text text = palette_describe(model, view, entry);
    const char *begin = kinds[entry.kind].command;
    *needs_argument = false;
    if (entry.kind == PALETTE_FILE) {
        begin = openings[opening_of(text.name)].command;
    }
    switch (entry.kind) {
    case PALETTE_RUN:
        snprintf(line, LINE_TEXT, "%s%d", begin, entry.index + 1);
        return;
    case PALETTE_EVENT:
        snprintf(line, LINE_TEXT, "%s%.17g", begin,
                 model->session.run.trace.events[entry.index].time);
        return;
    default:
        break;
    }
    snprintf(line, LINE_TEXT, "%s", begin);
    text_add(line, LINE_TEXT, "%s", text.name);
    if (entry.kind == PALETTE_RECORDING) {
        text_add(line, LINE_TEXT, " play");
    }
    if (entry.kind == PALETTE_COMMAND) {
        // what is in brackets need not be there
        const char *argument = explorer_command_table[entry.index].argument;
        *needs_argument = argument[0] != '\0' && argument[0] != '[';
        text_add(line, LINE_TEXT, "%s", *needs_argument ? " " : "");
    }
}
