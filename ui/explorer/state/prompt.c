#include "ui/explorer/state/prompt.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/text_stream.h"
#include "src/base/whole_file.h"
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

bool palette_shows(const prompt *p)
{
    return p->open && (p->searches || (p->fixed == 0 && p->text[0] != '\0' &&
                                       strchr(p->text, ' ') == NULL));
}
