#include "ui/terminal/pixel_answers.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    KITTY_QUESTION = 31, // number of the picture in the question
    SIXEL_ATTRIBUTE = 4, // among the device attributes
    LEAST_CELL = 2,      // [pixels]
    MOST_CELL = 200,     // [pixels]
    LEAST_REGISTERS = 2, // a terminal that says less is taken to have said nothing
    MOST_SAID = 1 << 20, // no number beyond this is believed
};

// version, device attributes
static const char ask_name[] = "\033[>q\033[c";

// a picture of one pixel, not to be shown; colours and size of sixel pictures; the ground's colour,
// the size of a cell, device attributes
#define ASK_KITTY "\033_Gi=31,s=1,v=1,a=q,t=d,f=24;AAAA\033\\"
#define ASK_SIXEL "\033[?1;1;0S\033[?2;1;0S"
#define ASK_REST  "\033]11;?\033\\\033[16t\033[c"

// by whether kitty's protocol and whether sixels are asked for
static const char *const ask_pixels[2][2] = {{ASK_REST, ASK_SIXEL ASK_REST},
                                             {ASK_KITTY ASK_REST, ASK_KITTY ASK_SIXEL ASK_REST}};

const char pixel_ask_cell[] = "\033[16t";

const char *pixel_answers_begin(pixel_answers *a, bool multiplexer)
{
    assert(a != NULL);
    *a = (pixel_answers){.stage = PIXELS_ASKED_NAME, .multiplexer = multiplexer};
    return ask_name;
}

// Reads up to `most` numbers between semicolons from text; returns how many there are.
static int read_numbers(const char *text, int *numbers, int most)
{
    int count = 0;
    while (count < most) {
        char *end;
        const long value = strtol(text, &end, 10);
        if (end == text || value < 0 || value > MOST_SAID) {
            break;
        }
        numbers[count++] = (int)value;
        if (*end != ';') {
            break;
        }
        text = end + 1;
    }
    return count;
}

static const char *take_attributes(pixel_answers *a, const char *text)
{
    int numbers[32];
    const int count = read_numbers(text, numbers, 32);

    // each number but the first is something that the terminal can do
    for (int i = 1; i < count; i++) {
        a->sixel = a->sixel || numbers[i] == SIXEL_ATTRIBUTE;
    }
    if (a->stage == PIXELS_ASKED_NAME) {
        a->stage = PIXELS_ASKED;
        return ask_pixels[!a->multiplexer][a->sixel];
    }
    a->stage = PIXELS_ANSWERED;
    return "";
}

// "rgb:ffff/ffff/ffff", in two or four digits each.
static void take_ground(pixel_answers *a, const char *text)
{
    unsigned red, green, blue;
    int digits = 0;
    if (sscanf(text, "rgb:%4x/%n%4x/%4x", &red, &digits, &green, &blue) != 3) {
        return;
    }
    const unsigned shift = digits == 9 ? 8 : 0;
    a->ground = (rgb){(unsigned char)(red >> shift), (unsigned char)(green >> shift),
                      (unsigned char)(blue >> shift)};
    a->has_ground = true;
}

// "6;HEIGHT;WIDTH" of a cell, "1;0;COLOURS" or "2;0;WIDTH;HEIGHT" of sixel pictures.
static void take_sizes(pixel_answers *a, const char *text, char final)
{
    int n[4];
    const int count = read_numbers(text, n, 4);
    if (final == 't' && count == 3 && n[0] == 6) {
        const bool usual =
            n[1] >= LEAST_CELL && n[1] <= MOST_CELL && n[2] >= LEAST_CELL && n[2] <= MOST_CELL;
        a->cell_height = usual ? n[1] : 0;
        a->cell_width = usual ? n[2] : 0;
    } else if (final == 'S' && count >= 3 && n[0] == 1 && n[1] == 0) {
        a->registers = n[2] >= LEAST_REGISTERS ? n[2] : 0;
    } else if (final == 'S' && count == 4 && n[0] == 2 && n[1] == 0) {
        a->most_width = n[2];
        a->most_height = n[3];
    }
}

const char *pixel_answers_take(pixel_answers *a, const escape_sequence *answer)
{
    assert(a != NULL && answer != NULL);
    const char *text = answer->text;
    const bool asked = a->stage == PIXELS_ASKED;
    int number = 0;
    if (a->stage == PIXELS_UNASKED) {
        return "";
    }

    // by what begins and ends it
    switch (answer->introducer) {
    case '[':
        if (answer->final == 'c' && text[0] == '?' && a->stage != PIXELS_ANSWERED) {
            return take_attributes(a, text + 1);
        }
        take_sizes(a, text + (text[0] == '?'), answer->final);
        break;
    case 'P':
        a->multiplexer = a->multiplexer || strncmp(text, ">|tmux", 6) == 0;
        break;
    case ']':
        if (asked && strncmp(text, "11;", 3) == 0) {
            take_ground(a, text + 3);
        }
        break;
    default:
        // "Gi=31;OK": the picture could be read
        a->kitty = a->kitty || (asked && sscanf(text, "Gi=%d;", &number) == 1 &&
                                number == KITTY_QUESTION && strstr(text, ";OK") != NULL);
    }
    return "";
}

pixel_protocol pixel_answers_protocol(const pixel_answers *a)
{
    assert(a != NULL);
    if (a->stage != PIXELS_ANSWERED) {
        return PIXELS_NONE;
    }
    return a->kitty ? PIXELS_KITTY : a->sixel ? PIXELS_SIXEL : PIXELS_NONE;
}
