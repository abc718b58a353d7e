#include "ui/explorer/state/prompt.h"

#include <assert.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "ui/terminal/keys.h"
#include "ui/terminal/screen.h"

void prompt_open(prompt *p, const char *format, ...)
{
    assert(p != NULL && format != NULL);
    va_list list;
    va_start(list, format);
    vsnprintf(p->text, sizeof p->text, format, list);
    va_end(list);
    p->open = true;
    p->fixed = 0;
    p->replaces = p->cycling = p->searches = false;
}

void prompt_open_value(prompt *p, const char *text, const char *value)
{
    assert(p != NULL && text != NULL && value != NULL);
    prompt_open(p, "%s%s", text, value);
    p->fixed = (int)strlen(text);
    p->replaces = value[0] != '\0';
}

bool prompt_type(prompt *p, int key)
{
    assert(p != NULL);
    const bool erases = key == KEY_CODE_BACKSPACE || key == 127 || key == 8;
    const bool has_value = strlen(p->text) > (size_t)p->fixed;
    const bool replaces = p->replaces;
    p->replaces = false;

    // the end of the line keeps the value and continues after it
    if (key == KEY_CODE_RIGHT || key == KEY_CODE_END || key == KEY_CODE_LEFT ||
        key == KEY_CODE_HOME) {
        return replaces;
    }
    if (has_value && (key == ('u' & 0x1f) || (replaces && erases))) {
        p->text[p->fixed] = '\0';
        return true;
    }
    if (replaces && key >= ' ' && key < KEY_CODE_FIRST) {
        p->text[p->fixed] = '\0';
    }
    return text_type(p->text, key);
}

bool text_type(char *text, int key)
{
    assert(text != NULL);
    size_t length = strlen(text);

    // backspace takes a whole UTF-8 character, C-u everything
    if (key == KEY_CODE_BACKSPACE || key == 127 || key == 8) {
        while (length > 0 && (text[length - 1] & 0xc0) == 0x80) {
            length--;
        }
        text[length > 0 ? length - 1 : 0] = '\0';
        return true;
    }
    if (key == ('u' & 0x1f)) {
        text[0] = '\0';
        return true;
    }

    // room for the longest character and the zero behind it
    if (key < ' ' || key >= KEY_CODE_FIRST || length + 5 >= LINE_TEXT) {
        return false;
    }
    glyph_encode((uint32_t)key, text + length);
    return true;
}
