// Longer texts on the command line: paragraphs and lines.
#include "ui/commands/command.h"

#include <assert.h>
#include <string.h>

#include "src/base/words.h"

// Width of a UTF-8 text in characters.
static int text_width(const char *text)
{
    assert(text != NULL);
    int width = 0;
    for (; *text != '\0'; text++) {
        width += ((unsigned char)*text & 0xC0) != 0x80;
    }
    return width;
}

void print_indented(FILE *stream, const char *text, int bytes, int width, int indent)
{
    const char *end = text + bytes;
    int column = 0;
    assert(bytes >= 0 && indent >= 0 && width > indent);
    while ((text += strspn(text, " \n")) < end) {
        char word[256];
        int length = (int)strcspn(text, " \n");
        length = length < end - text ? length : (int)(end - text);
        snprintf(word, sizeof word, "%.*s", length, text);

        // a word goes to the next line if this one has no room for it
        int wide = text_width(word);
        const bool fits = column > 0 && column + 1 + wide <= width;
        if (!fits) {
            fprintf(stream, "%s%*s", column > 0 ? "\n" : "", indent, "");
        }
        print_printable(stream, "%s%.*s", fits ? " " : "", length, text);
        column = fits ? column + 1 + wide : indent + wide;
        text += length;
    }
    fprintf(stream, "%s", column > 0 ? "\n" : "");
}

void print_wrapped(FILE *stream, const char *text, int bytes, int width)
{
    print_indented(stream, text, bytes, width, 0);
}

bool next_paragraph(const char **text, paragraph *p)
{
    assert(text != NULL && *text != NULL && p != NULL);
    *text += strspn(*text, "\n");
    if (**text == '\0') {
        return false;
    }
    *p = (paragraph){.start = *text, .literal = **text == ' '};

    // lines are one paragraph until one that is empty or begins with a blank
    do {
        *text += strcspn(*text, "\n");
        p->bytes = (int)(*text - p->start);
        *text += **text == '\n';
    } while (!p->literal && strchr("\n ", **text) == NULL);
    return true;
}
