#include "src/base/csv.h"

#include <math.h>
#include <string.h>

#include "src/base/numbers.h"
#include "src/base/words.h"

csv_writer csv_begin(FILE *stream)
{
    return (csv_writer){.stream = stream};
}

// What stands between quotes, inner ones doubled; what may not leave the program becomes
// '?'.
static void write_quoted(FILE *stream, const char *text)
{
    const char *begin = text; // of what is written as it stands
    while (*text != '\0') {
        const int length = *text == '\n' ? 1 : printable_length(text);
        if (length > 0 && *text != '"') {
            text += length;
            continue;
        }

        // a quote ends the piece and begins the next one, too
        fwrite(begin, 1, (size_t)(text - begin), stream);
        fputc(length > 0 ? '"' : '?', stream);
        if (length > 0) {
            begin = text;
        } else {
            begin = text + 1;
        }
        text++;
    }
    fwrite(begin, 1, (size_t)(text - begin), stream);
}

void csv_heading(csv_writer *w, const char *name, const char *unit)
{
    static const char special[] = ",\"\n";
    const char *quote = "";
    if (strpbrk(name, special) != NULL ||
        (unit != NULL && strpbrk(unit, special) != NULL)) {
        quote = "\"";
    }
    fprintf(w->stream, "%s%s", w->in_row ? "," : "", quote);
    w->in_row = true;

    // name[unit]
    write_quoted(w->stream, name);
    if (unit != NULL) {
        fputc('[', w->stream);
        write_quoted(w->stream, unit);
        fputc(']', w->stream);
    }
    fputs(quote, w->stream);
}

void csv_number(csv_writer *w, double value)
{
    char text[1 + NUMBER_TEXT] = ",";
    char *number = text + w->in_row;
    *number = '\0';
    if (!isnan(value)) {
        number_format(number, value);
    }
    w->in_row = true;
    fputs_unlocked(text, w->stream);
}

void csv_end_row(csv_writer *w)
{
    fputc('\n', w->stream);
    w->in_row = false;
}
