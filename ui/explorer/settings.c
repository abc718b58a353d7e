// What the terminal lab remembers between visits: a file of its own commands in the user's
// configuration folder.
#include "ui/explorer/lab.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "src/base/whole_file.h"

static const char *const remembered[] = {"theme", "glyphs", "colours", "mouse", "speed",
                                         "panes", "axis",   "key",     "unkey"};

// The folder's path ($XDG_CONFIG_HOME/impactlab or ~/.config/impactlab); false if there is none.
static bool settings_folder(char *path, size_t size, bool make)
{
    const char *base = getenv("XDG_CONFIG_HOME"), *home = getenv("HOME");
    int length;
    if (base != NULL && base[0] == '/') {
        length = snprintf(path, size, "%s", base);
    } else if (home != NULL && home[0] == '/') {
        length = snprintf(path, size, "%s/.config", home);
    } else {
        return false;
    }
    if (length < 0 || (size_t)length + 16 > size) {
        return false;
    }
    if (make) {
        mkdir(path, 0700);
    }
    snprintf(path + length, size - (size_t)length, "/impactlab");
    return !make || mkdir(path, 0700) == 0 || errno == EEXIST;
}

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

// Carries a line of the file out; false with a fault that names its line and column.
static bool take_line(lab *l, const char *path, int number, const char *line)
{
    char why[LAB_TEXT];
    l->fault_at = (int)strspn(line, " \t");
    if (!is_remembered(line + l->fault_at)) {
        lab_say(l, true, "this is no setting");
    } else if (strlen(line) >= LAB_TEXT) {
        lab_say(l, true, "the line is too long");
    } else if (lab_carry_out(l, line)) {
        return true;
    }
    snprintf(why, sizeof why, "%.200s", l->message);
    lab_say(l, true, "%s:%d:%d is ignored: %s", path, number, l->fault_at + 1, why);
    return false;
}

void lab_settings_load(lab *l)
{
    char path[1024], first[sizeof l->message], *line = NULL;
    size_t room = 0;
    int faults = 0;
    if (!settings_folder(path, sizeof path - 8, false)) {
        return;
    }
    strcat(path, "/lab");
    FILE *stream = fopen(path, "r");
    for (int number = 1; stream != NULL && getline(&line, &room, stream) >= 0; number++) {
        line[strcspn(line, "\r\n")] = '\0';
        if (!take_line(l, path, number, line) && faults++ == 0) {
            snprintf(first, sizeof first, "%s", l->message);
        }
    }
    free(line);
    if (stream != NULL) {
        fclose(stream);
    }
    l->message[0] = '\0';
    l->settings_broken = faults > 0;
    if (faults == 1) {
        lab_say(l, true, "%s", first);
    } else if (faults > 1) {
        lab_say(l, true, "%.900s (and %d more)", first, faults - 1);
    }
}

// The axes that are not as a fresh lab has them, and the user's keys.
static void write_axes_and_keys(const lab *l, FILE *stream)
{
    for (int i = 0; i < LAB_PANES - 1; i++) {
        const lab_pane *pane = &l->panes[i];
        if (pane->axis == AXIS_GROW) {
            fprintf(stream, "axis grow %d\n", i + 1);
        } else if (pane->axis == AXIS_FIXED) {
            fprintf(stream, "axis %.10g %.10g %d\n", pane->low, pane->high, i + 1);
        }
    }
    for (int i = 0; i < l->user_key_count; i++) {
        const lab_user_key *own = &l->user_keys[i];
        char name[16];
        lab_key_name(own->key, name, sizeof name);
        fprintf(stream, own->line[0] ? "key %s %s\n" : "unkey %s\n", name, own->line);
    }
}

bool lab_settings_save(lab *l)
{
    static const char *const themes[] = {"dark", "light", "mono"};
    static const char *const glyphs[] = {"braille", "blocks", "ascii"};
    static const char *const depths[] = {"auto", "true", "256", "16", "mono"};
    char path[1024];
    whole_file file;
    fault f = {0};
    if (!settings_folder(path, sizeof path - 8, true)) {
        lab_say(l, true, "there is no folder for settings (XDG_CONFIG_HOME or HOME)");
        return false;
    }
    strcat(path, "/lab");
    if (l->settings_broken) {
        lab_say(l, true, "%s has faults and is left alone: mend or remove it", path);
        return false;
    }
    if (whole_file_open(&file, path, &f) != STATUS_OK) {
        lab_say(l, true, "%s", f.text);
        return false;
    }
    fprintf(file.stream, "# settings of the terminal lab, written by :remember\n");
    fprintf(file.stream, "theme %s\nglyphs %s\ncolours %s\nmouse %s\nspeed %g\n", themes[l->theme],
            glyphs[l->glyphs], depths[l->depth], l->mouse ? "on" : "off", l->speed);
    // panes that nobody chose are the ones that suit the scenario
    fputs(l->panes_chosen ? "panes " : "", file.stream);
    for (int i = 0; i < LAB_PANES - 1; i++) {
        if (l->panes_chosen && l->panes[i].shown) {
            fprintf(file.stream, "%d", i + 1);
        }
    }
    fputs(l->panes_chosen ? "\n" : "", file.stream);
    write_axes_and_keys(l, file.stream);
    if (whole_file_commit(&file, &f) != STATUS_OK) {
        lab_say(l, true, "%s", f.text);
        return false;
    }
    lab_say(l, false, "settings kept in %s", path);
    return true;
}
