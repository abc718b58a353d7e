#include "ui/explorer/settings.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/whole_file.h"
#include "ui/explorer/commands.h"
#include "ui/explorer/state/settings_folder.h"

static const char *const remembered[] = {"theme", "glyphs",  "colours", "pixels", "closeup",
                                         "mouse", "bending", "lanes",   "slow",   "speed",
                                         "panes", "axis",    "key",     "unkey"};

static bool is_remembered(const char *line)
{
    size_t length = strcspn(line, " \t");
    for (size_t i = 0; i < sizeof remembered / sizeof remembered[0]; i++) {
        if (strlen(remembered[i]) == length && strncmp(line, remembered[i], length) == 0) {
            return true;
        }
    }
    return length == 0 || line[0] == '#';
}

// Where the file is; false if there is no folder for it.
static bool settings_path(char *path, size_t size, bool make)
{
    if (!settings_folder(path, size - 8, make)) {
        return false;
    }
    strcat(path, "/lab");
    return true;
}

// Executes a line of the file; errors are reported with line and column.
static action_result execute_line(explorer_state *st, const char *path, int number,
                                  const char *line)
{
    const int begin = (int)strspn(line, " \t");
    action_result result;

    // only what :remember writes is taken from a file
    if (!is_remembered(line + begin)) {
        result = result_refused("this is no setting");
        result.at = begin;
    } else if (strlen(line) >= LINE_TEXT) {
        result = result_refused("the line is too long");
        result.at = begin;
    } else {
        result = explorer_execute(st, line);
    }

    // the place in the file comes before what is wrong
    if (result_ok(&result)) {
        return result;
    }
    return result_refused("%s:%d:%d is ignored: %.200s", path, number, result.at + 1, result.text);
}

void explorer_load_settings(explorer *ex)
{
    assert(ex != NULL);
    explorer_state *st = &ex->state;
    char path[1024], *line = NULL;
    action_result first = result_quiet();
    size_t room = 0;
    int faults = 0;
    if (!settings_path(path, sizeof path, false)) {
        return;
    }

    // every line that can be carried out is
    FILE *stream = fopen(path, "r");
    for (int number = 1; stream != NULL && getline(&line, &room, stream) >= 0; number++) {
        line[strcspn(line, "\r\n")] = '\0';
        action_result result = execute_line(st, path, number, line);
        if (!result_ok(&result) && faults++ == 0) {
            first = result;
        }
    }
    free(line);
    if (stream != NULL) {
        fclose(stream);
    }

    // the first fault, and the number of further ones
    st->settings_broken = faults > 0;
    if (faults > 1) {
        message_say(&st->message, true, "%.900s (and %d more)", first.text, faults - 1);
    } else {
        result_show(&first, &st->message);
    }
}

// The axes that are not as they are at first, and the user's keys.
static void write_axes_and_keys(const explorer_state *st, FILE *stream)
{

    // every pane but the user's own
    for (int i = 0; i < PANES - 1; i++) {
        const pane *p = &st->panes.pane[i];
        if (p->scaling == AXIS_GROW) {
            fprintf(stream, "axis grow %d\n", i + 1);
        } else if (p->scaling == AXIS_FIXED) {
            fprintf(stream, "axis %.10g %.10g %d\n", p->fixed.low, p->fixed.high, i + 1);
        }
    }

    // a key without a line is one that was taken away
    for (int i = 0; i < st->keys.count; i++) {
        const user_key *own = &st->keys.own[i];
        char name[KEY_NAME];
        key_name(own->key, name, sizeof name);
        fprintf(stream, own->line[0] ? "key %s %s\n" : "unkey %s\n", name, own->line);
    }
}

static void write_settings(const explorer_state *st, FILE *stream)
{
    const looks *l = &st->looks;
    fprintf(stream, "# settings of the terminal lab, written by :remember\n");
    fprintf(stream, "theme %s\nglyphs %s\ncolours %s\n", colour_theme_words[l->theme],
            glyph_set_words[l->glyphs], colour_depth_words[l->depth]);
    fprintf(stream, "pixels %s\ncloseup %s\nbending %g\n", pixel_words[l->pixels],
            close_up_words[l->close_up], l->bending);
    fprintf(stream, "mouse %s\nlanes %s\nspeed %g\nslow %g\n", mouse_words[l->mouse],
            lane_choice_words[l->lanes], st->playback.speed, st->playback.slow);

    // panes that the user did not choose are those that suit the scenario
    fputs(st->panes.chosen ? "panes " : "", stream);
    for (int i = 0; i < PANES - 1; i++) {
        if (st->panes.chosen && st->panes.pane[i].shown) {
            fprintf(stream, "%d", i + 1);
        }
    }
    fputs(st->panes.chosen ? "\n" : "", stream);
    write_axes_and_keys(st, stream);
}

action_result act_remember(explorer_state *st, const char *argument)
{
    (void)argument;
    char path[1024];
    whole_file file;
    fault f = {0};
    if (!settings_path(path, sizeof path, true)) {
        return result_refused("there is no folder for settings (XDG_CONFIG_HOME or HOME)");
    }
    if (st->settings_broken) {
        return result_refused("%s has faults and is left alone: mend or remove it", path);
    }

    // whole or not at all
    status code = whole_file_open(&file, path, &f);
    if (code == STATUS_OK) {
        write_settings(st, file.stream);
        code = whole_file_commit(&file, &f);
    }
    return code == STATUS_OK ? result_news("settings kept in %s", path) : result_of(code, &f);
}
