#include "ui/explorer/state/prompt.h"

#include <assert.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "ui/terminal/key_codes.h"
#include "ui/terminal/screen.h"

void prompt_open(prompt *p, const char *format, ...)
{
    assert(p != NULL && format != NULL);
    va_list list;
    va_start(list, format);
    vsnprintf(p->text, sizeof p->text, format, list);
    va_end(list);
    p->open = true;
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
