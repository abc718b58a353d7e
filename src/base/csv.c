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
    while (*text != '\0') {
        int length = 1;
        if (*text != '\n') {
            length = printable_length(text);
        }
        if (length == 0) {
            fputc('?', stream);
            text++;
            continue;
        }
        if (*text == '"') {
            fputc('"', stream);
        }
        fwrite(text, 1, (size_t)length, stream);
        text += length;
    }
}

// name[unit], in quotes where it needs them.
void csv_heading(csv_writer *w, const char *name, const char *unit)
{
    static const char special[] = ",\"\n";
    const char *quote = "";
    if (strpbrk(name, special) != NULL ||
        (unit != NULL && strpbrk(unit, special) != NULL)) {
        quote = "\"";
    }
    if (w->in_row) {
        fputc(',', w->stream);
    }
    fputs(quote, w->stream);
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
    char text[NUMBER_TEXT];
    if (w->in_row) {
        fputc_unlocked(',', w->stream);
    }
    w->in_row = true;

    // what is missing is empty
    if (!isnan(value)) {
        number_format(text, value);
        fputs_unlocked(text, w->stream);
    }
}

void csv_end_row(csv_writer *w)
{
    fputc('\n', w->stream);
    w->in_row = false;
}
