#include "ui/terminal/escape_sequence.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>

enum {
    WHEEL = 64,
    DRAG = 32,
    SHIFT = 4,
    META = 8,
    CONTROL = 16,
    OLD_RELEASE = 3,
    OLD_OFFSET = 32
};

static sequence_result mouse(int button, int column, int row, bool pressed,
                             pointer_event *report)
{
    int plain = button & ~(SHIFT | META | CONTROL);
    *report = (pointer_event){.x = column - 1,
                              .y = row - 1,
                              .shift = (button & SHIFT) != 0,
                              .control = (button & CONTROL) != 0};

    // only the wheel and the first button mean something here
    if (plain == WHEEL || plain == WHEEL + 1) {
        if (plain == WHEEL) {
            report->kind = POINTER_WHEEL_UP;
        } else {
            report->kind = POINTER_WHEEL_DOWN;
        }
        if (pressed) {
            return SEQUENCE_MOUSE;
        }
        return SEQUENCE_OVER;
    }
    if (plain != 0 && plain != DRAG && plain != OLD_RELEASE) {
        return SEQUENCE_OVER;
    }
    if (!pressed || plain == OLD_RELEASE) {
        report->kind = POINTER_RELEASE;
    } else if (plain == DRAG) {
        report->kind = POINTER_DRAG;
    } else {
        report->kind = POINTER_PRESS;
    }
    return SEQUENCE_MOUSE;
}

static sequence_result end(escape_sequence *e, int last, pointer_event *report)
{
    int button, column, row;
    char rest;
    e->text[e->length] = '\0';
    e->state = SEQUENCE_NONE;
    if ((last == 'M' || last == 'm') &&
        sscanf(e->text, "<%d;%d;%d%c", &button, &column, &row, &rest) == 3) {
        return mouse(button, column, row, last == 'M', report);
    }
    if (last == '~' && (strcmp(e->text, "200") == 0 || strcmp(e->text, "201") == 0)) {
        if (e->text[2] == '0') {
            return SEQUENCE_PASTE;
        }
        return SEQUENCE_PASTED;
    }
    e->introducer = '[';
    e->final = (char)last;
    if (e->awaits) {
        return SEQUENCE_ANSWER;
    }
    return SEQUENCE_OVER;
}

// A character of an answer's text, which a bell or ESC \ ends.
static sequence_result take_string(escape_sequence *e, int character)
{
    const bool escaped = e->state == SEQUENCE_STRING_END;
    const bool ends = character == (escaped ? '\\' : '\a');

    // anything else after the escape, or what no text holds: broken off
    if (ends || escaped || character == '\b' || character == '\r') {
        e->state = SEQUENCE_NONE;
        e->text[e->length] = '\0';
        if (ends) {
            return SEQUENCE_ANSWER;
        }
        return SEQUENCE_OTHER_KEY;
    }
    if (character == 27) {
        e->state = SEQUENCE_STRING_END;
    } else if (e->length + 1 < (int)sizeof e->text) {
        e->text[e->length++] = (char)character;
    }
    return SEQUENCE_GOES_ON;
}

static sequence_result take_parameter(escape_sequence *e, int character,
                                      pointer_event *report)
{
    // broken off: a control character or another escape begins something new
    if (character < ' ' || character > 0x7e) {
        e->state = SEQUENCE_NONE;
        return SEQUENCE_OTHER_KEY;
    }
    if (character >= 0x40 && (character != 'M' || e->length > 0)) {
        return end(e, character, report);
    }

    // one that is longer than any we know loses its end
    if (character == 'M') {
        e->state = SEQUENCE_OLD_MOUSE;
    } else if (e->length + 1 < (int)sizeof e->text) {
        e->text[e->length++] = (char)character;
    }
    return SEQUENCE_GOES_ON;
}

sequence_result escape_sequence_take(escape_sequence *e, int character,
                                     pointer_event *report)
{
    assert(e->state != SEQUENCE_NONE);

    // what kind of sequence it is
    if (e->state == SEQUENCE_ESCAPED && (character == '[' || character == 'O')) {
        e->state = SEQUENCE_BRACKET;
        e->length = 0;
        return SEQUENCE_GOES_ON;
    }
    if (e->state == SEQUENCE_BRACKET) {
        return take_parameter(e, character, report);
    }
    if (e->state == SEQUENCE_STRING || e->state == SEQUENCE_STRING_END) {
        return take_string(e, character);
    }

    // three bytes, each a number from 32 on
    if (e->state == SEQUENCE_OLD_MOUSE) {
        e->text[e->length++] = (char)(character - OLD_OFFSET);
        if (e->length < 3) {
            return SEQUENCE_GOES_ON;
        }
        e->state = SEQUENCE_NONE;
        return mouse(e->text[0] & 0x7f, e->text[1], e->text[2], true, report);
    }

    // the text of an answer
    if (e->awaits && (character == 'P' || character == ']' || character == '_')) {
        e->state = SEQUENCE_STRING;
        e->introducer = (char)character;
        e->length = 0;
        return SEQUENCE_GOES_ON;
    }

    // the escape was a key
    e->state = SEQUENCE_NONE;
    return SEQUENCE_OTHER_KEY;
}
