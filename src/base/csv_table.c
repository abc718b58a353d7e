#include "src/base/csv_table.h"

#include <assert.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "src/base/numbers.h"
#include "src/base/input_file.h"

enum { MOST_COLUMNS = 4096, SHOWN = 60 };

// --- the file --------------------------------------------------------------------------

// The whole file as a text on the heap, the caller's in any case.
static status read_table_text(const char *path, char **text, fault *f)
{
    size_t length;
    fault why = {0};
    *text = input_file_read(path, SIZE_MAX / 4, &length, &why);
    if (*text == NULL) {
        return input_file_fault(path, &why, f);
    }

    // a text has no zeros in it
    if (strlen(*text) != length) {
        return fault_set(f, STATUS_BAD_ARGUMENT,
                         "'%.300s' is no text, expected a table of numbers (CSV)", path);
    }
    return STATUS_OK;
}

// Copies a field that is not quoted to `to`, up to what ends it; returns where that is.
static char *copy_plain_field(char *from, char **to)
{
    while (*from != '\0' && *from != ',' && *from != '\n') {
        *(*to)++ = *from++;
    }
    return from;
}

// Copies a quoted field, from behind its first quote on, and returns where it ends. Two
// quotes in it stand for one; what stands between its last quote and the next comma
// belongs to the field, too. *line counts the line ends in it.
static char *copy_quoted_field(char *from, char **to, int *line)
{
    while (*from != '\0' && !(from[0] == '"' && from[1] != '"')) {
        if (*from == '"') {
            from++;
        }
        if (*from == '\n') {
            (*line)++;
        }
        *(*to)++ = *from++;
    }

    // what stands there, other quotes left out
    while (*from != '\0' && *from != ',' && *from != '\n') {
        if (*from != '"') {
            *(*to)++ = *from;
        }
        from++;
    }
    return from;
}

// Takes the first field off the text and returns it without quotes and without blanks at
// its ends; it is a text of its own, as a 0 is put behind it. Sets *last if it is the
// last field of its row, adds the line ends it has to *line, and sets *text to what
// follows, NULL if nothing does.
static char *next_field(char **text, bool *last, int *line)
{
    char *from = *text;
    while (*from == ' ' || *from == '\t') {
        from++;
    }
    char *const field = from, *to = from;
    if (*from == '"') {
        from = copy_quoted_field(from + 1, &to, line);
    } else {
        from = copy_plain_field(from, &to);
    }

    // what ends it, and where the next one begins
    const char end = *from;
    *last = end != ',';
    if (end == '\n') {
        (*line)++;
    }
    if (end == '\0' || (end == '\n' && from[1] == '\0')) {
        *text = NULL;
    } else {
        *text = from + 1;
    }

    while (to > field && is_blank(to[-1])) {
        to--;
    }
    *to = '\0';
    return field;
}

// Takes the first row off the text and adds it to the table. It must have as many fields
// as there are headings; an empty line is skipped.
static status take_table_row(csv_table *t, char **text, int *line, fault *f)
{
    const int begin = *line;
    char **row = t->fields + t->rows * (size_t)t->columns;

    int columns = 0;
    bool last = false;
    while (*text != NULL && !last && columns < t->columns) {
        row[columns++] = next_field(text, &last, line);
    }

    if (columns == 1 && row[0][0] == '\0' && last) {
        return STATUS_OK;
    }

    if (columns < t->columns || !last) {
        const char *how_many = last ? "fewer" : "more";
        return fault_set_place(f, STATUS_BAD_ARGUMENT, begin, columns,
                               "%.300s:%d:%d: the row has %s than %d fields, "
                               "expected one for each heading",
                               t->file, begin, columns, how_many, t->columns);
    }
    t->lines[t->rows++] = begin;
    return STATUS_OK;
}

// Splits the text into headings and rows; there is room for all of them.
static status split_table(csv_table *t, char *text, fault *f)
{
    static const char mark[] = "\xEF\xBB\xBF"; // that some programs put before UTF-8
    if (strncmp(text, mark, strlen(mark)) == 0) {
        text += strlen(mark);
    }

    // too many headings are no table
    int line = 1;
    bool last = false;
    while (text != NULL && !last && t->columns < MOST_COLUMNS) {
        t->headings[t->columns++] = next_field(&text, &last, &line);
    }
    while (text != NULL && last) {
        TRY(take_table_row(t, &text, &line, f));
    }
    return STATUS_OK;
}

// Room for the fields of the text: one for each comma and each line end.
static status make_table_room(csv_table *t, fault *f)
{
    size_t commas = 0, line_ends = 0;
    for (const char *c = t->text; *c != '\0'; c++) {
        if (*c == '\n') {
            line_ends++;
        } else if (*c == ',') {
            commas++;
        }
    }

    t->headings = calloc(MOST_COLUMNS, sizeof *t->headings);
    t->fields = calloc(line_ends + commas + 2, sizeof *t->fields);
    t->lines = calloc(line_ends + 2, sizeof *t->lines);
    if (t->headings == NULL || t->fields == NULL || t->lines == NULL) {
        return fault_no_memory(f);
    }
    return STATUS_OK;
}

// The whole table into t, of which nothing but the name of its file is set.
static status read_table(csv_table *t, size_t least, fault *f)
{
    if (t->file == NULL) {
        return fault_no_memory(f);
    }
    TRY(read_table_text(t->file, &t->text, f));
    TRY(make_table_room(t, f));
    TRY(split_table(t, t->text, f));
    if (t->rows >= least) {
        return STATUS_OK;
    }

    // fewer rows than are needed
    int line = 1;
    if (t->rows > 0) {
        line = t->lines[t->rows - 1];
    }
    const char *plural = t->rows == 1 ? "" : "s";
    return fault_set_place(
        f, STATUS_BAD_ARGUMENT, line, 1,
        "%.300s:%d:1: %zu row%s below the headings, expected at least %zu", t->file, line,
        t->rows, plural, least);
}

status csv_table_read(csv_table *t, const char *path, size_t least, fault *f)
{
    *t = (csv_table){.file = strdup(path)};
    const status code = read_table(t, least, f);
    if (code != STATUS_OK) {
        csv_table_finish(t);
    }
    return code;
}

void csv_table_finish(csv_table *t)
{
    if (t == NULL) {
        return;
    }
    free(t->file);
    free(t->text);
    free(t->headings);
    free(t->fields);
    free(t->lines);
    *t = (csv_table){0};
}

// --- columns ---------------------------------------------------------------------------

// Length of a heading's name, without "[unit]" and the blanks before it.
static size_t heading_name_length(const char *heading)
{
    const char *bracket = strrchr(heading, '[');
    const size_t whole = strlen(heading);
    if (bracket == NULL || heading[whole - 1] != ']') {
        return whole;
    }
    while (bracket > heading && is_blank(bracket[-1])) {
        bracket--;
    }
    return (size_t)(bracket - heading);
}

// The column of a heading, or of its name in another unit; -1 for none.
int csv_table_find(const csv_table *t, const char *heading)
{
    const size_t length = heading_name_length(heading);
    int found = -1;

    // the heading itself, or the first of its name in another unit
    for (int c = t->columns - 1; c >= 0; c--) {
        const char *here = t->headings[c];
        if (strcmp(here, heading) == 0) {
            return c;
        }
        if (heading_name_length(here) == length && strncmp(here, heading, length) == 0) {
            found = c;
        }
    }
    return found;
}

// The units that a column may have beside the wanted one, and how many of that they are.
static const struct {
    const char *unit, *wanted;
    double factor;
} units[] = {
    {"ms", "s", 1e-3},
    {"us", "s", 1e-6},
    {"µs", "s", 1e-6},
    {"min", "s", 60},
    {"mV", "V", 1e-3},
    {"kV", "V", 1e3},
    {"mN", "N", 1e-3},
    {"kN", "N", 1e3},
    {"mrad", "rad", 1e-3},
    {"deg", "rad", 3.14159265358979323846 / 180},
    {"°", "rad", 3.14159265358979323846 / 180},
    {"rev", "rad", 2 * 3.14159265358979323846},
    {"mrad/s", "rad/s", 1e-3},
    {"deg/s", "rad/s", 3.14159265358979323846 / 180},
    {"°/s", "rad/s", 3.14159265358979323846 / 180},
    {"rpm", "rad/s", 3.14159265358979323846 / 30},
    {"rad/s^2", "rad/s2", 1},
    {"rad/s²", "rad/s2", 1},
    {"deg/s2", "rad/s2", 3.14159265358979323846 / 180},
    {"mm", "m", 1e-3},
    {"um", "m", 1e-6},
    {"cm", "m", 1e-2},
    {"Nm", "N m", 1},
    {"mA", "A", 1e-3},
};

// Copies the unit of a heading; false if it has none.
static bool copy_unit(const char *heading, char unit[32])
{
    const char *bracket = heading + heading_name_length(heading);
    while (is_blank(*bracket)) {
        bracket++;
    }
    if (*bracket != '[') {
        return false;
    }

    // what stands between the brackets
    const int length = (int)strlen(bracket) - 2;
    snprintf(unit, 32, "%.*s", length, bracket + 1);
    return true;
}

// The factor to the wanted unit, 0 for an unknown one.
static double factor_to(const char *unit, const char *wanted)
{
    if (strcmp(unit, wanted) == 0) {
        return 1;
    }
    for (size_t i = 0; i < sizeof units / sizeof units[0]; i++) {
        if (strcmp(units[i].unit, unit) == 0 && strcmp(units[i].wanted, wanted) == 0) {
            return units[i].factor;
        }
    }
    return 0;
}

static const char *field_at(const csv_table *t, size_t row, int column)
{
    return t->fields[row * (size_t)t->columns + (size_t)column];
}

// The finite number in a field; NaN in one that may be a gap and is. False for all else.
static bool read_number_field(const char *field, bool gaps, double *number)
{
    const char *rest;
    if (gaps && (field[0] == '\0' || strcasecmp(field, "nan") == 0)) {
        *number = (double)NAN;
        return true;
    }
    return decimal_read(field, number, &rest) && *rest == '\0' && isfinite(*number);
}

// The numbers of a column in a unit, which is converted to.
status csv_table_numbers(const csv_table *t, const char *heading, const char *unit,
                         bool gaps, double **values, fault *f)
{
    *values = NULL;
    const int column = csv_table_find(t, heading);
    if (column < 0) {
        return fault_set_place(f, STATUS_BAD_ARGUMENT, 1, 1,
                               "%.300s:1:1: there is no column '%.*s', expected one of "
                               "its %d headings, such as '%.*s'",
                               t->file, SHOWN, heading, t->columns, SHOWN,
                               t->headings[0]);
    }

    // its unit
    char own[32];
    const bool said = copy_unit(heading, own) || copy_unit(t->headings[column], own);
    double factor = 1;
    if (said) {
        factor = factor_to(own, unit);
    }
    if (factor == 0) {
        return fault_set_place(
            f, STATUS_BAD_ARGUMENT, 1, column + 1,
            "%.300s:1:%d: the unit [%s] of '%.*s' is not known, expected [%s] or "
            "what can be converted to it",
            t->file, column + 1, own, SHOWN, t->headings[column], unit);
    }

    // and its numbers
    double *numbers = calloc(t->rows + 1, sizeof *numbers);
    if (numbers == NULL) {
        return fault_no_memory(f);
    }
    for (size_t r = 0; r < t->rows; r++) {
        const char *field = field_at(t, r, column);
        if (!read_number_field(field, gaps, &numbers[r])) {
            free(numbers);
            return fault_set_place(
                f, STATUS_BAD_ARGUMENT, t->lines[r], column + 1,
                "%.300s:%d:%d: '%.*s' in column '%.*s' is no finite number", t->file,
                t->lines[r], column + 1, SHOWN, field, SHOWN, t->headings[column]);
        }
        numbers[r] *= factor;
    }
    *values = numbers;
    return STATUS_OK;
}

// A column of times, which may not go back.
status csv_table_times(const csv_table *t, const char *heading, double **values, fault *f)
{
    status code = csv_table_numbers(t, heading, "s", false, values, f);

    for (size_t r = 1; code == STATUS_OK && r < t->rows; r++) {
        if ((*values)[r] < (*values)[r - 1]) {
            const int column = csv_table_find(t, heading) + 1;
            code = fault_set_place(
                f, STATUS_BAD_ARGUMENT, t->lines[r], column,
                "%.300s:%d:%d: the time %.9g s lies before that of the row "
                "above, %.9g s, expected rows by growing time",
                t->file, t->lines[r], column, (*values)[r], (*values)[r - 1]);
            free(*values);
            *values = NULL;
        }
    }
    return code;
}

// The value of a column at an instant, held or linear between rows.
double csv_table_at(const double *times, const double *values, size_t rows, double time,
                    bool linear)
{
    assert(rows > 0);
    size_t low = 0, high = rows; // the first row that is later lies in (low, high]

    if (times[0] > time) {
        return values[0];
    }

    // halved until the last row that is not later is found
    while (high - low > 1) {
        const size_t middle = low + (high - low) / 2;
        if (times[middle] <= time) {
            low = middle;
        } else {
            high = middle;
        }
    }

    // held until the next row, or on the line to it
    if (!linear || high == rows) {
        return values[low];
    }
    const double share = (time - times[low]) / (times[high] - times[low]);
    return (1 - share) * values[low] + share * values[high];
}
