// What the terminal lab remembers between visits: a file of its own commands in the user's
// configuration folder.
#include "ui/lab/lab.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "src/lab/whole_file.h"

static const char *const remembered[] = {"theme", "glyphs", "mouse", "speed", "panes"};

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

void lab_settings_load(lab *l)
{
    char path[1024], line[LAB_TEXT];
    if (!settings_folder(path, sizeof path - 8, false)) {
        return;
    }
    strcat(path, "/lab");
    FILE *stream = fopen(path, "r");
    for (int number = 1; stream != NULL && fgets(line, sizeof line, stream) != NULL; number++) {
        line[strcspn(line, "\r\n")] = '\0';
        bool known = is_remembered(line);
        if (!known || !lab_carry_out(l, line)) {
            char why[LAB_TEXT];
            snprintf(why, sizeof why, "%.200s", known ? l->message : "this is no setting");
            lab_say(l, true, "%s:%d is ignored: %s", path, number, why);
            l->settings_broken = true;
        }
    }
    if (stream != NULL) {
        fclose(stream);
    }
    if (!l->settings_broken) {
        l->message[0] = '\0';
    }
}

bool lab_settings_save(lab *l)
{
    static const char *const themes[] = {"dark", "light", "mono"};
    static const char *const glyphs[] = {"braille", "blocks", "ascii"};
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
    fprintf(file.stream, "theme %s\nglyphs %s\nmouse %s\nspeed %g\npanes ", themes[l->theme],
            glyphs[l->glyphs], l->mouse ? "on" : "off", l->speed);
    for (int i = 0; i < LAB_PANES - 1; i++) {
        if (l->panes[i].shown) {
            fprintf(file.stream, "%d", i + 1);
        }
    }
    fputc('\n', file.stream);
    if (whole_file_commit(&file, &f) != STATUS_OK) {
        lab_say(l, true, "%s", f.text);
        return false;
    }
    lab_say(l, false, "settings kept in %s", path);
    return true;
}
