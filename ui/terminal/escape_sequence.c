#include "ui/terminal/escape_sequence.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>

// Bits and numbers of a mouse report's button (xterm's control sequences).
enum {
    FIRST_BUTTON = 0,
    OLD_RELEASE = 3, // of any button
    SHIFT = 4,
    META = 8,
    CONTROL = 16,
    DRAG = 32,
    WHEEL_UP = 64,
    WHEEL_DOWN = 65,
    OLD_OFFSET = 32 // of the numbers in an old report
};

enum { ESCAPE = 27 };

// Fills in the report of a mouse's button; only the wheel and the first button mean
// something here.
static sequence_result report_mouse(int button, int column, int row, bool pressed,
                                    pointer_event *report)
{
    *report = (pointer_event){.x = column - 1,
                              .y = row - 1,
                              .shift = (button & SHIFT) != 0,
                              .control = (button & CONTROL) != 0};
    const int plain = button & ~(SHIFT | META | CONTROL);
    switch (plain) {
    case WHEEL_UP:
    case WHEEL_DOWN:
        report->kind = plain == WHEEL_UP ? POINTER_WHEEL_UP : POINTER_WHEEL_DOWN;
        return pressed ? SEQUENCE_MOUSE : SEQUENCE_OVER;
    case FIRST_BUTTON:
        report->kind = pressed ? POINTER_PRESS : POINTER_RELEASE;
        return SEQUENCE_MOUSE;
    case DRAG:
        report->kind = pressed ? POINTER_DRAG : POINTER_RELEASE;
        return SEQUENCE_MOUSE;
    case OLD_RELEASE:
        report->kind = POINTER_RELEASE;
        return SEQUENCE_MOUSE;
    default:
        return SEQUENCE_OVER;
    }
}

// Ends a sequence of parameters with its last character.
static sequence_result end_parameters(escape_sequence *e, int last, pointer_event *report)
{
    e->text[e->length] = '\0';
    e->state = SEQUENCE_NONE;

    // the mouse, "<BUTTON;COLUMN;ROW" with M for a press and m for a release
    int button, column, row;
    char rest;
    if ((last == 'M' || last == 'm') &&
        sscanf(e->text, "<%d;%d;%d%c", &button, &column, &row, &rest) == 3) {
        return report_mouse(button, column, row, last == 'M', report);
    }

    // the marks around pasted text
    if (last == '~' && strcmp(e->text, "200") == 0) {
        return SEQUENCE_PASTE;
    }
    if (last == '~' && strcmp(e->text, "201") == 0) {
        return SEQUENCE_PASTED;
    }

    // an answer, if one is expected, else the sequence of an unknown key
    e->introducer = '[';
    e->final = (char)last;
    if (e->awaits_answers) {
        return SEQUENCE_ANSWER;
    }
    return SEQUENCE_OVER;
}

// Adds a character to the text; one that is longer than any we know loses its end.
static void add_character(escape_sequence *e, int character)
{
    if (e->length + 1 < (int)sizeof e->text) {
        e->text[e->length++] = (char)character;
    }
}

// A character of an answer's text, which a bell or ESC \ ends.
static sequence_result take_string(escape_sequence *e, int character)
{
    const bool escaped = e->state == SEQUENCE_STRING_END;
    const bool ends = escaped ? character == '\\' : character == '\a';
    if (ends) {
        e->state = SEQUENCE_NONE;
        e->text[e->length] = '\0';
        return SEQUENCE_ANSWER;
    }

    // broken off by anything else after the escape, or by what no text holds
    if (escaped || character == '\b' || character == '\r') {
        e->state = SEQUENCE_NONE;
        e->text[e->length] = '\0';
        return SEQUENCE_OTHER_KEY;
    }
    if (character == ESCAPE) {
        e->state = SEQUENCE_STRING_END;
    } else {
        add_character(e, character);
    }
    return SEQUENCE_CONTINUES;
}

// A character after ESC [ or ESC O, the last one of which is a letter or a sign.
static sequence_result take_parameter(escape_sequence *e, int character,
                                      pointer_event *report)
{
    // broken off: a control character or another escape begins something new
    if (character < ' ' || character > 0x7e) {
        e->state = SEQUENCE_NONE;
        return SEQUENCE_OTHER_KEY;
    }
    if (character == 'M' && e->length == 0) {
        e->state = SEQUENCE_OLD_MOUSE;
        return SEQUENCE_CONTINUES;
    }
    if (character >= 0x40) {
        return end_parameters(e, character, report);
    }
    add_character(e, character);
    return SEQUENCE_CONTINUES;
}

// A byte of an old mouse report: button, column and row, each a number from 32 on.
static sequence_result take_old_mouse(escape_sequence *e, int character,
                                      pointer_event *report)
{
    e->text[e->length++] = (char)(character - OLD_OFFSET);
    if (e->length < 3) {
        return SEQUENCE_CONTINUES;
    }
    e->state = SEQUENCE_NONE;
    return report_mouse(e->text[0] & 0x7f, e->text[1], e->text[2], true, report);
}

// The character after ESC, which says what kind of sequence it is.
static sequence_result begin_sequence(escape_sequence *e, int character)
{
    e->length = 0;
    if (character == '[' || character == 'O') {
        e->state = SEQUENCE_BRACKET;
        return SEQUENCE_CONTINUES;
    }
    if (e->awaits_answers && (character == 'P' || character == ']' || character == '_')) {
        e->state = SEQUENCE_STRING;
        e->introducer = (char)character;
        return SEQUENCE_CONTINUES;
    }

    // the escape was a key
    e->state = SEQUENCE_NONE;
    return SEQUENCE_OTHER_KEY;
}

sequence_result escape_sequence_take(escape_sequence *e, int character,
                                     pointer_event *report)
{
    assert(e->state != SEQUENCE_NONE);
    switch (e->state) {
    case SEQUENCE_BRACKET:
        return take_parameter(e, character, report);
    case SEQUENCE_OLD_MOUSE:
        return take_old_mouse(e, character, report);
    case SEQUENCE_STRING:
    case SEQUENCE_STRING_END:
        return take_string(e, character);
    default:
        return begin_sequence(e, character);
    }
}
