// Lines that are carried out: typed after `:`, of scripts, of keys, of the settings. And
// the commands that give keys another meaning.
#include "ui/explorer/explorer.h"

#include <glib.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "src/base/whole_file.h"
#include "src/base/words.h"
#include "ui/explorer/state/user_files.h"
#include "ui/terminal/keys.h"

// --- lines -----------------------------------------------------------------------------

// Calls the action of the index-th command with the parts of the state that its row
// names.
static bool call_action(explorer_model *model, explorer_view *view, explorer_input *input,
                        int index, const char *argument)
{
    bool done = false;
    int row = 0;
#define CALL_ROW(group, name, call, keys, words, help)                                   \
    if (index == row++) {                                                                \
        done = call;                                                                     \
    }
    COMMAND_LIST(CALL_ROW)
#undef CALL_ROW
    return done;
}

// The command of a line's first word.
static bool find_command(explorer_input *input, const char *line, int *index)
{
    char name[32];
    text_cut(line, " \t", name, sizeof name);
    *index = explorer_command_find(name);
    if (*index >= 0) {
        return true;
    }
    nearest_word near = nearest_begin(name);
    for (int i = 0; i < explorer_command_count; i++) {
        nearest_try(&near, explorer_command_table[i].name);
    }
    if (near.best == NULL) {
        return act_refuse(input, "there is no command '%s' (? lists them)", name);
    }
    return act_refuse(input, "there is no command '%s', did you mean %s?", name,
                      near.best);
}

// Puts the home folder in the place of ~ where a command's argument ends in a file that
// begins so. False if that has no room.
static bool expand_home(char text[LINE_TEXT], int argument, const char *kind)
{
    const char *home = getenv("HOME");
    const bool takes_file =
        strstr(kind, "FILE") != NULL || strstr(kind, "NAME|+1") != NULL;
    char *at = strstr(text + argument, "~/");
    if (!takes_file || home == NULL || at == NULL || (at > text && at[-1] != ' ')) {
        return true;
    }
    char rest[LINE_TEXT];
    snprintf(rest, sizeof rest, "%s", at + 1);
    const size_t room = LINE_TEXT - (size_t)(at - text);
    return snprintf(at, room, "%s%s", home, rest) < (int)room;
}

bool explorer_execute(explorer_model *model, explorer_view *view, explorer_input *input,
                      const char *line)
{
    const int begin = (int)strspn(line, " \t:");
    line += begin;
    if (*line == '\0' || *line == '#') {
        return true;
    }

    // without the blanks at its end
    char text[LINE_TEXT];
    if (snprintf(text, sizeof text, "%s", line) >= LINE_TEXT) {
        return act_refuse(input, "the line is too long");
    }
    g_strchomp(text);

    // the command, and its argument behind it
    int index;
    if (!find_command(input, text, &index)) {
        input->message.at = begin;
        return false;
    }
    size_t length = strcspn(text, " \t");
    length += strspn(text + length, " \t");
    input->message.at = 0;
    if (!expand_home(text, (int)length, explorer_command_table[index].argument)) {
        return act_refuse(input, "the line is too long with the whole path");
    }
    const bool done = call_action(model, view, input, index, text + length);

    // what is wrong with the argument is said of the line
    input->message.at += begin + (int)length;
    return done;
}

// --- keys ------------------------------------------------------------------------------

// Reads the key that begins an argument, and where the rest of it does.
static bool read_key(explorer_input *input, const char *argument, int *key,
                     const char **rest)
{
    int length = (int)strcspn(argument, " \t");
    *key = key_of_name(argument, (size_t)length);
    *rest = argument + length + strspn(argument + length, " \t");

    // what cannot be bound
    if (length == 0) {
        return act_refuse(
            input,
            "a key is a character or a name such as Space, PgUp, F1, S-Left or C-r");
    }
    if (*key == 0) {
        return act_refuse(input, "there is no key '%.*s'", length, argument);
    }
    if (*key == ':' || *key == KEY_CODE_ESCAPE || *key == ('c' & 0x1f)) {
        return act_refuse(input,
                          "%.*s keeps its meaning: the way to the prompt, back or out",
                          length, argument);
    }
    return true;
}

// Gives a key a line, unless there is no room for another one.
static bool bind_key(explorer_view *view, explorer_input *input, int key,
                     const char *line)
{
    if (!key_bind(&view->keys, key, line)) {
        return act_refuse(input, "there are %d keys of your own already, no more fit",
                          USER_KEYS);
    }
    return true;
}

// Says what a key does.
static bool tell_key(explorer_input *input, const char *name, const char *line)
{
    if (line == NULL) {
        return act_tell(input, "%s does nothing", name);
    }
    return act_tell(input, "%s does '%s'", name, line);
}

bool act_key(explorer_view *view, explorer_input *input, const char *argument)
{
    const char *line;
    int key;
    if (!read_key(input, argument, &key, &line)) {
        return false;
    }
    char name[KEY_NAME];
    key_name(key, name, sizeof name);

    // without a command it is asked what the key does
    const char *old = key_line(&view->keys, key);
    if (line[0] == '\0') {
        return tell_key(input, name, old);
    }

    // a copy of the old meaning: its place gets the new one
    char before[LINE_TEXT] = "";
    if (old != NULL) {
        snprintf(before, sizeof before, "%s", old);
    }
    int index;
    if (!find_command(input, line, &index) || !bind_key(view, input, key, line)) {
        input->message.at = (int)(line - argument);
        return false;
    }
    if (before[0] != '\0' && strcmp(before, line) != 0) {
        return act_tell(input, "%s does '%s' now, no longer '%s'", name, line, before);
    }
    return act_tell(input, "%s does '%s' now", name, line);
}

// Takes the user's key with this index back: the explorer's own comes back.
static bool unbind_own(explorer_view *view, explorer_input *input, int own,
                       const char *name, const char *built_in)
{
    view->keys.own[own] = view->keys.own[--view->keys.count];
    if (built_in == NULL) {
        return act_tell(input, "%s does nothing now", name);
    }
    return act_tell(input, "%s does '%s' again", name, built_in);
}

bool act_unkey(explorer_view *view, explorer_input *input, const char *argument)
{
    const char *rest;
    int key;
    if (!read_key(input, argument, &key, &rest)) {
        return false;
    }
    if (rest[0] != '\0') {
        input->message.at = (int)(rest - argument);
        return act_refuse(input, "unkey takes one key, what is '%s' for?", rest);
    }

    // the user's key
    char name[KEY_NAME];
    key_name(key, name, sizeof name);
    const char *built_in = key_built_in_line(key);
    const int own = key_own(&view->keys, key);
    if (own >= 0) {
        return unbind_own(view, input, own, name, built_in);
    }

    // one of the explorer's own does nothing then
    if (built_in == NULL) {
        return act_refuse(input, "%s does nothing as it is", name);
    }
    return bind_key(view, input, key, "") &&
           act_tell(
               input,
               "%s does nothing now, no longer '%s' (unkey it again to have that back)",
               name, built_in);
}

// --- sessions --------------------------------------------------------------------------

#define SESSION_ENDING ".session"

// Whether a line's first word is one of some with blanks round each.
static bool begins_with_one(const char *line, const char *words)
{
    char word[LINE_TEXT];
    snprintf(word, sizeof word, " %.*s ", (int)strcspn(line, " \t"), line);
    return strstr(words, word) != NULL;
}

// Whether a line of a file that an earlier lab wrote is about what the screen now does by
// itself.
static bool is_outgrown(const char *line)
{
    return begins_with_one(line, " colourby colours lanes closeup band ") ||
           g_str_has_prefix(line, "axis grow") || g_str_has_prefix(line, "axis calm");
}

// Carries out a line that says how runs are looked at, and none that does anything else.
static bool carry_out_look(explorer_model *model, explorer_view *view,
                           explorer_input *input, const char *line)
{
    if (is_outgrown(line)) {
        return act_refuse(input, "'%.60s' is passed over, the lab has no such choice now",
                          line);
    }
    if (begins_with_one(line, " panes axis zoom mark trace phase spectrum signal limit "
                              "data sweep metric # "
                              "residual note ")) {
        return explorer_execute(model, view, input, line);
    }
    return act_refuse(input, "'%.60s' does not belong into a session", line);
}

bool explorer_open_session(explorer_model *model, explorer_view *view,
                           explorer_input *input, const char *path)
{
    return explorer_resume_session(model, view, input, path, carry_out_look);
}

// The name of a session's file: one without the ending by which the lab knows a session
// gets it, but a file that is to be opened and is there is taken as it is.
static void session_name(const char *path, bool saves, char name[LINE_TEXT])
{
    if (!saves && access(path, F_OK) == 0) {
        snprintf(name, LINE_TEXT, "%s", path);
        return;
    }
    const int stem = (int)text_stem(path, SESSION_ENDING);
    snprintf(name, LINE_TEXT, "%.*s%s", stem, path, SESSION_ENDING);
}

bool act_session(explorer_model *model, explorer_view *view, explorer_input *input,
                 const char *argument)
{
    char word[8], name[LINE_TEXT];
    const char *path = text_cut(argument, " ", word, sizeof word);
    const bool saves = strcmp(word, "save") == 0, opens = strcmp(word, "open") == 0;

    // without a name to save it under the prompt proposes one
    if (saves && path[0] == '\0') {
        const char *proposed = model->session_path;
        if (proposed[0] == '\0') {
            proposed = "lab.session";
        }
        prompt_open(&input->prompt, proposed, "session save ");
        return true;
    }
    if ((!saves && !opens) || path[0] == '\0') {
        return act_refuse(input,
                          "session takes save or open, and a file such as lab.session");
    }
    session_name(path, saves, name);
    if (saves) {
        return explorer_save_session(model, view, input, name);
    }
    return explorer_open_session(model, view, input, name);
}

// --- settings --------------------------------------------------------------------------

// The commands that :remember writes, with blanks round each.
static const char remembered[] =
    " theme glyphs pixels mouse bending rate slow speed panes axis key unkey ";

// Executes a line of the file, where only what :remember writes is taken.
static bool execute_setting(explorer_model *model, explorer_view *view,
                            explorer_input *input, const char *line)
{
    const int begin = (int)strspn(line, " \t");
    input->message.at = begin;
    if (is_outgrown(line + begin)) {
        return true; // :remember drops it
    }
    if (line[begin] == '\0' || line[begin] == '#' ||
        begins_with_one(line + begin, remembered)) {
        return explorer_execute(model, view, input, line);
    }
    return act_refuse(input, "this is no setting");
}

void explorer_load_settings(explorer_model *model, explorer_view *view,
                            explorer_input *input)
{
    char path[1024], *line = NULL;
    message_line first = {.text = ""};
    size_t room = 0;
    int faults = 0;
    if (!user_file(USER_SETTINGS, "lab", path, sizeof path, false)) {
        return;
    }

    // every line that can be carried out is
    FILE *stream = fopen(path, "r");
    for (int number = 1; stream != NULL && getline(&line, &room, stream) >= 0; number++) {
        line[strcspn(line, "\r\n")] = '\0';
        if (execute_setting(model, view, input, line)) {
            continue;
        }

        // the first that is wrong is said with its place
        if (faults == 0) {
            act_refuse(input, "%s:%d:%d is ignored: %.200s", path, number,
                       input->message.at + 1, input->message.text);
            first = input->message;
        }
        faults++;
    }
    free(line);
    if (stream != NULL) {
        fclose(stream);
    }

    if (view->panes.chosen) {
        explorer_shown_panes(view, view->kept_panes);
    }

    // the first fault, and the number of further ones
    view->settings_broken = faults > 0;
    input->message = first;
    if (faults > 1) {
        act_warn(input, "%.900s (and %d more)", first.text, faults - 1);
    }
}

// The axes that are not as they are at first, and the user's keys.
static void write_axes_and_keys(const explorer_view *view, FILE *stream)
{
    // every pane but the user's own
    for (int i = 0; i < PANES_OF_TABLE; i++) {
        const pane *p = &view->panes.pane[i];
        if (p->is_fixed) {
            fprintf(stream, "axis %.10g %.10g %d\n", p->fixed.low, p->fixed.high, i + 1);
        }
    }

    // a key without a line is one that was taken away
    for (int i = 0; i < view->keys.count; i++) {
        const user_key *own = &view->keys.own[i];
        char name[KEY_NAME];
        key_name(own->key, name, sizeof name);
        if (own->line[0] != '\0') {
            fprintf(stream, "key %s %s\n", name, own->line);
        } else {
            fprintf(stream, "unkey %s\n", name);
        }
    }
}

static void write_settings(const explorer_view *view, FILE *stream)
{
    fprintf(stream, "# settings of the terminal lab, written by :remember\n");
    for (const look_choice *c = look_choices; c->command != NULL; c++) {
        fprintf(stream, "%s %s\n", c->command, look_word(&view->looks, c));
    }
    fprintf(stream, "bending %g\nrate %g\nspeed %g\nslow %g\n", view->looks.bending,
            view->looks.rate, view->playback.speed, view->playback.slow);

    // panes that the user did not choose are those that suit the scenario
    if (view->panes.chosen) {
        fprintf(stream, "panes %s\n", view->kept_panes);
    }
    write_axes_and_keys(view, stream);
}

bool act_remember(explorer_view *view, explorer_input *input)
{
    char path[1024];
    whole_file file;
    if (!user_file(USER_SETTINGS, "lab", path, sizeof path, true)) {
        return act_refuse(input,
                          "there is no folder for settings (XDG_CONFIG_HOME or HOME)");
    }
    if (view->settings_broken) {
        return act_refuse(input, "%s has faults and is left alone: mend or remove it",
                          path);
    }

    // whole or not at all
    if (!act_succeeded(input, whole_file_open(&file, path, &input->fault))) {
        return false;
    }
    explorer_shown_panes(view, view->kept_panes);
    write_settings(view, file.stream);
    return act_succeeded(input, whole_file_commit(&file, &input->fault)) &&
           act_tell(input, "settings kept in %s", path);
}
