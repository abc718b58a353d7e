#include "ui/terminal/line_editor.h"

#include <ctype.h>
#include <stdint.h>
#include <string.h>

#include "ui/terminal/keys.h"
#include "ui/terminal/screen.h"

enum { GLYPH_BYTES = 4 }; // of the longest character

#define CONTROL(letter) ((letter)&0x1f)

// The byte at which the character before a place begins, or behind the one at it.
static int before_character(const char *text, int at)
{
    do {
        at--;
    } while (at > 0 && (text[at] & 0xc0) == 0x80);
    return at > 0 ? at : 0;
}

static int behind_character(const char *text, int at)
{
    if (text[at] == '\0') {
        return at;
    }
    do {
        at++;
    } while ((text[at] & 0xc0) == 0x80);
    return at;
}

// Whether a byte is of a word: a letter, a digit, or of a character beyond ASCII.
static bool is_of_word(char c)
{
    return isalnum((unsigned char)c) || (c & 0x80) != 0;
}

// The beginning of the word before a place, and the end of the one behind it.
static int word_before(const char *text, int at)
{
    while (at > 0 && !is_of_word(text[at - 1])) {
        at--;
    }
    while (at > 0 && is_of_word(text[at - 1])) {
        at--;
    }
    return at;
}

static int word_behind(const char *text, int at)
{
    while (text[at] != '\0' && !is_of_word(text[at])) {
        at++;
    }
    while (is_of_word(text[at])) {
        at++;
    }
    return at;
}

// The beginning of what stands before a place up to a blank.
static int blank_before(const char *text, int at)
{
    while (at > 0 && text[at - 1] == ' ') {
        at--;
    }
    while (at > 0 && text[at - 1] != ' ') {
        at--;
    }
    return at;
}

// Where a key moves the cursor to; -1 if it moves none.
static int place_of(const char *text, int at, int key)
{
    switch (key) {
    case KEY_CODE_LEFT:
        return before_character(text, at);
    case KEY_CODE_RIGHT:
        return behind_character(text, at);
    case KEY_CODE_HOME:
    case CONTROL('a'):
        return 0;
    case KEY_CODE_END:
    case CONTROL('e'):
        return (int)strlen(text);
    case KEY_CODE_ALT_B:
        return word_before(text, at);
    case KEY_CODE_ALT_F:
        return word_behind(text, at);
    default:
        return -1;
    }
}

// To where a key takes text away from the cursor on; -1 if it takes none.
static int end_of_removal(const char *text, int fixed, int at, int key)
{
    switch (key) {
    case KEY_CODE_BACKSPACE:
        return before_character(text, at);
    case KEY_CODE_DELETE:
        return behind_character(text, at);
    case CONTROL('k'):
        return (int)strlen(text);
    case CONTROL('u'):
        return at > fixed ? fixed : 0;
    case CONTROL('w'):
        return blank_before(text, at);
    case KEY_CODE_ALT_BACKSPACE:
        return word_before(text, at);
    case KEY_CODE_ALT_D:
        return word_behind(text, at);
    default:
        return -1;
    }
}

// Takes the text between two places away, where the cursor is then.
static void take_away(char *text, int from, int to, int *cursor)
{
    memmove(text + from, text + to, strlen(text + to) + 1);
    *cursor = from;
}

// Puts a character in before the cursor, if there is room for the longest one.
static line_edit put_in(char *text, size_t size, int *cursor, int key)
{
    char glyph[GLYPH_BYTES + 1] = "";
    if (strlen(text) + GLYPH_BYTES + 1 > size) {
        return LINE_FULL;
    }
    glyph_encode((uint32_t)key, glyph);
    const size_t length = strlen(glyph);
    char *at = text + *cursor;
    memmove(at + length, at, strlen(at) + 1);
    memcpy(at, glyph, length);
    *cursor += (int)length;
    return LINE_EDITED;
}

line_edit line_edit_key(char *text, size_t size, int fixed, int *cursor, int key)
{
    const int at = *cursor, to = place_of(text, at, key);
    if (to >= 0) {
        *cursor = to;
        return LINE_EDITED;
    }
    const int end = end_of_removal(text, fixed, at, key);
    if (end >= 0) {
        take_away(text, end < at ? end : at, end < at ? at : end, cursor);
        return LINE_EDITED;
    }
    if (key < ' ' || key >= KEY_CODE_FIRST) {
        return LINE_UNTOUCHED;
    }
    return put_in(text, size, cursor, key);
}
