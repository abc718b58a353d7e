#include "src/base/csv_layout.h"

#include <assert.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/csv_units.h"
#include "src/base/input_file.h"
#include "src/base/numbers.h"
#include "src/base/scoped.h"

enum {
    LINES_LOOKED_AT = 400, // for the separator
    ROWS_LOOKED_AT = 20,   // below headings
    NUMBER_FIELD = 64      // longest number [characters]
};

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
    const int line = 1;
    if (strlen(*text) != length) {
        return fault_set_place(
            f, STATUS_BAD_ARGUMENT, line, 1,
            "%.300s:1: this is no text of single bytes or UTF-8, expected a table "
            "of numbers (CSV)",
            path);
    }

    // lines may end with a carriage return alone
    for (char *c = *text; *c != '\0'; c++) {
        if (c[0] == '\r' && c[1] != '\n') {
            *c = '\n';
        }
    }
    return STATUS_OK;
}

// Whether a line is a comment; *text becomes what follows the sign for that.
static bool skip_comment_sign(const char **text)
{
    const char *c = *text;
    while (*c == ' ' || *c == '\t') {
        c++;
    }
    if (*c == '#' || *c == '%') {
        *text = c + 1;
        return true;
    }
    if (c[0] == '/' && c[1] == '/') {
        *text = c + 2;
        return true;
    }
    return false;
}

// --- the separator ---------------------------------------------------------------------

static bool separates(char c, char separator)
{
    return c == separator || (separator == ' ' && c == '\t');
}

// The quote that closes a field, of which `text` follows the first one: two quotes stand
// for one, and behind line ends only one counts that ends the field. NULL if there is
// none: the first quote is part of the field then.
static const char *closing_quote(const char *text, char separator)
{
    bool other_line = false;
    for (const char *c = text; *c != '\0'; c++) {
        other_line = other_line || *c == '\n';
        if (c[0] == '"' && c[1] == '"') {
            c++;
        } else if (c[0] == '"') {
            const bool ends =
                c[1] == '\0' || is_blank(c[1]) || separates(c[1], separator);
            if (other_line && !ends) {
                return NULL;
            }
            return c;
        }
    }
    return NULL;
}

// How many fields a line has, of which blanks alone are none; *text becomes the next
// line.
static int count_fields(const char **text, char separator)
{
    const char *c = *text;
    int fields = 0;
    bool within = false;
    for (; *c != '\0' && *c != '\n'; c++) {
        const char *closing = NULL;
        if (*c == '"' && !within) {
            closing = closing_quote(c + 1, separator);
        }
        if (closing != NULL) {
            c = closing;
            within = true;
        } else if (separates(*c, separator) && (within || separator != ' ')) {
            fields++;
            within = false;
        } else if (!is_blank(*c)) {
            within = true;
        }
    }
    *text = c;
    if (*c == '\n') {
        *text = c + 1;
    }
    if (within || (fields > 0 && separator != ' ')) {
        fields++;
    }
    return fields;
}

// The separator that gives most lines as many fields, at least two, as the next line has.
static char find_separator(const char *text)
{
    static const char separators[] = "\t;|, ";
    char best = ',';
    int most = 0;
    for (const char *s = separators; *s != '\0'; s++) {
        const char *rest = text;
        int before = 0, alike = 0;
        for (int line = 0; *rest != '\0' && line < LINES_LOOKED_AT; line++) {
            if (skip_comment_sign(&rest)) {
                rest += strcspn(rest, "\n");
                continue;
            }
            const int fields = count_fields(&rest, *s);
            if (fields == 0) {
                continue;
            }
            if (fields > 1 && fields == before) {
                alike++;
            }
            before = fields;
        }
        if (alike > most) {
            most = alike;
            best = *s;
        }
    }
    return best;
}

// --- rows ------------------------------------------------------------------------------

// All rows of the file, each of its own length, empty ones left out.
typedef struct file_rows {
    char **fields;
    size_t *begin; // of each row among the fields, and the end of the last
    int *lines;
    bool *comment;
    size_t count;
    char separator;
} file_rows;

static void file_rows_finish(file_rows *r)
{
    free(r->fields);
    free(r->begin);
    free(r->lines);
    free(r->comment);
}

static int fields_of(const file_rows *r, size_t row)
{
    return (int)(r->begin[row + 1] - r->begin[row]);
}

// Copies a quoted field, from behind its first quote on, and returns where it ends. Two
// quotes in it stand for one; what stands between its last quote and the next separator
// belongs to the field, too. *line counts the line ends in it.
static char *copy_quoted_field(char *from, char **to, char separator, int *line)
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
    while (*from != '\0' && *from != '\n' && !separates(*from, separator)) {
        if (*from != '"') {
            *(*to)++ = *from;
        }
        from++;
    }
    return from;
}

// Takes the first field off the text and returns it without quotes and without blanks at
// its ends; it is a text of its own, as a 0 is put behind it. *end becomes the sign that
// ended it, a separator, a line end or 0, and *text what follows that. A field of a
// comment has no quotes.
static char *next_field(char **text, char separator, bool comment, int *line, char *end)
{
    char *from = *text;
    while (*from == ' ' || (*from == '\t' && separator != '\t')) {
        from++;
    }
    char *const field = from, *to = from;
    if (*from == '"' && !comment && closing_quote(from + 1, separator) != NULL) {
        from = copy_quoted_field(from + 1, &to, separator, line);
    }
    while (*from != '\0' && *from != '\n' && !separates(*from, separator)) {
        *to++ = *from++;
    }

    // several blanks are one, and those at a line's end are none
    while (separator == ' ' && separates(*from, ' ') &&
           (is_blank(from[1]) || from[1] == '\0')) {
        from++;
    }
    *end = *from;
    *text = from;
    if (*from != '\0') {
        *text = from + 1;
    }

    while (to > field && is_blank(to[-1])) {
        to--;
    }
    *to = '\0';
    return field;
}

// Takes the first row off the text; one of empty fields is not kept.
static void take_row(file_rows *r, char **text, char separator, int *line)
{
    const char *inside = *text;
    const bool comment = skip_comment_sign(&inside);
    *text += inside - *text;

    const size_t begin = r->begin[r->count];
    size_t fields = begin;
    const int first_line = *line;
    bool empty = true;
    char end;
    do {
        char *field = next_field(text, separator, comment, line, &end);
        empty = empty && field[0] == '\0';
        r->fields[fields++] = field;
    } while (end != '\n' && end != '\0');
    (*line)++;

    if (!empty) {
        r->comment[r->count] = comment;
        r->lines[r->count++] = first_line;
        r->begin[r->count] = fields;
    }
}

// Divides the text into rows; there is room for a field more than there are separators
// and line ends.
static status divide(file_rows *r, char *text, fault *f)
{
    const char separator = r->separator = find_separator(text);
    size_t fields = 2, lines = 2;
    for (const char *c = text; *c != '\0'; c++) {
        if (*c == '\n') {
            lines++;
        }
        if (*c == '\n' || separates(*c, separator)) {
            fields++;
        }
    }
    r->fields = calloc(fields, sizeof *r->fields);
    r->begin = calloc(lines, sizeof *r->begin);
    r->lines = calloc(lines, sizeof *r->lines);
    r->comment = calloc(lines, sizeof *r->comment);
    if (r->fields == NULL || r->begin == NULL || r->lines == NULL || r->comment == NULL) {
        return fault_no_memory(f);
    }

    int line = 1;
    while (*text != '\0') {
        take_row(r, &text, separator, &line);
    }
    return STATUS_OK;
}

// --- numbers ---------------------------------------------------------------------------

bool csv_layout_number(const char *field, char decimal, double *number)
{
    char text[NUMBER_FIELD];
    const char *rest;
    if (decimal == ',' && strchr(field, '.') != NULL) {
        return false;
    }
    if (decimal == ',' && strlen(field) < sizeof text) {
        // the first comma is the decimal sign, a second one stays
        strcpy(text, field);
        char *comma = strchr(text, ',');
        if (comma != NULL) {
            *comma = '.';
        }
        field = text;
    }
    return decimal_read(field, number, &rest) && *rest == '\0' && isfinite(*number);
}

// How many fields of a row are numbers, with a point or with a comma.
static int numbers_of(const file_rows *r, size_t row)
{
    int numbers = 0;
    for (size_t i = r->begin[row]; i < r->begin[row + 1]; i++) {
        double number;
        if (csv_layout_number(r->fields[i], '.', &number) ||
            csv_layout_number(r->fields[i], ',', &number)) {
            numbers++;
        }
    }
    return numbers;
}

// The decimal sign: a comma where numbers have one, unless it separates fields and
// numbers have a point, too.
static char find_decimal(const csv_table *t, char separator)
{
    bool comma = false, point = false;
    for (size_t i = 0; i < t->rows * (size_t)t->columns; i++) {
        const char *field = t->fields[i];
        double number;
        if (strchr(field, ',') != NULL && csv_layout_number(field, ',', &number)) {
            comma = true;
        } else if (!point && strchr(field, '.') != NULL) {
            point = csv_layout_number(field, '.', &number);
        }
    }
    if (comma && !(point && separator == ',')) {
        return ',';
    }
    return '.';
}

// --- headings --------------------------------------------------------------------------

// Whether a row is one of units: it has no number, and a known unit.
static bool has_units(const file_rows *r, size_t row)
{
    bool known = false;
    for (size_t i = r->begin[row]; i < r->begin[row + 1]; i++) {
        char unit[UNIT_TEXT];
        known = known || csv_unit_alone(r->fields[i], unit);
    }
    return known && numbers_of(r, row) == 0;
}

// The next row from `row` on that is no comment; the count of rows if there is none.
static size_t skip_comments(const file_rows *r, size_t row)
{
    while (row < r->count && r->comment[row]) {
        row++;
    }
    return row;
}

// Whether units stand below a row of headings, for each of them, maybe as a comment,
// whose sign then may be the first one.
static bool has_units_below(const file_rows *r, size_t headings)
{
    const size_t below = headings + 1;
    if (below == r->count || !has_units(r, below)) {
        return false;
    }
    const int lacking = fields_of(r, headings) - fields_of(r, below);
    return lacking == 0 || (lacking == 1 && r->comment[below]);
}

// The row of data that follows a row of headings and their units.
static size_t data_below(const file_rows *r, size_t headings)
{
    if (has_units_below(r, headings)) {
        headings++;
    }
    return skip_comments(r, headings + 1);
}

// Whether a row has numbers in as many fields as some headings, give or take one.
static bool is_below(const file_rows *r, size_t row, int headings)
{
    return abs(fields_of(r, row) - headings) <= 1 && numbers_of(r, row) > 0;
}

// How many rows of numbers, as far as is looked, a row heads that has no number itself; a
// single one counts at the end only.
static int rows_headed(const file_rows *r, size_t row)
{
    const int headings = fields_of(r, row);
    size_t below = data_below(r, row);
    int rows = 0;
    if (numbers_of(r, row) > 0) {
        return 0;
    }
    while (rows < ROWS_LOOKED_AT && below < r->count && is_below(r, below, headings)) {
        rows++;
        below = skip_comments(r, below + 1);
    }
    if (rows == 1 && below < r->count) {
        return 0;
    }
    return rows;
}

// The row of headings: the first that heads most rows, else the first row if it has no
// number, else the last comment above it with as many fields. The count of rows if there
// is none.
static size_t find_headings(const file_rows *r)
{
    const size_t first = skip_comments(r, 0);
    size_t best = r->count;
    int most = 0;
    for (size_t row = first; row < r->count && most < ROWS_LOOKED_AT;
         row = skip_comments(r, row + 1)) {
        const int rows = rows_headed(r, row);
        if (rows > most) {
            most = rows;
            best = row;
        }
    }
    if (most > 0) {
        return best;
    }
    if (first == r->count || numbers_of(r, first) == 0) {
        return first;
    }
    for (size_t row = first; row-- > 0;) {
        if (numbers_of(r, row) == 0 && fields_of(r, row) == fields_of(r, first)) {
            return row;
        }
    }
    return r->count;
}

// Copies a row's texts from column `first` on, to be freed; NULL without memory.
static char **copy_row(const file_rows *r, size_t row, int first, int columns)
{
    char **copy = calloc((size_t)columns + 1, sizeof *copy);
    for (int i = 0; copy != NULL && i < columns; i++) {
        copy[i] = (char *)"";
        if (i >= first && i - first < fields_of(r, row)) {
            copy[i] = r->fields[r->begin[row] + (size_t)(i - first)];
        }
    }
    return copy;
}

// --- the table -------------------------------------------------------------------------

// Whether each row from `first` on has one field more than there are headings, which are
// not all empty at the end, and its first field counts the rows from 0 or 1 on.
static bool rows_are_counted(const file_rows *r, size_t first, int columns)
{
    double count = 0;
    bool from_zero = true, from_one = true, last_is_empty = true;
    for (size_t row = first; row < r->count; row = skip_comments(r, row + 1)) {
        double number = -1;
        const char *field = r->fields[r->begin[row]];
        if (fields_of(r, row) != columns + 1 || !csv_layout_number(field, '.', &number)) {
            return false;
        }
        const char *last = r->fields[r->begin[row + 1] - 1];
        last_is_empty = last_is_empty && last[0] == '\0';
        from_zero = from_zero && number == count;
        from_one = from_one && number == count + 1;
        count++;
    }
    return !last_is_empty && (from_zero || from_one);
}

// Adds a row of the file to the table, from its field `skipped` on. What it has more than
// there are headings must be empty.
static status add_table_row(csv_table *t, const file_rows *r, size_t row, int skipped,
                            fault *f)
{
    const int line = r->lines[row], count = fields_of(r, row) - skipped;
    char **from = r->fields + r->begin[row] + skipped;
    const char *how_many = NULL;
    if (count < t->columns) {
        how_many = "fewer";
    }
    for (int i = t->columns; i < count; i++) {
        if (from[i][0] != '\0') {
            how_many = "more";
        }
    }
    if (how_many != NULL) {
        const int column = count < t->columns ? count : t->columns;
        return fault_set_place(f, STATUS_BAD_ARGUMENT, line, column,
                               "%.300s:%d:%d: the row has %s than %d fields, "
                               "expected one for each heading",
                               t->file, line, column, how_many, t->columns);
    }
    memcpy(t->fields + t->rows * (size_t)t->columns, from,
           (size_t)t->columns * sizeof *from);
    t->lines[t->rows++] = line;
    return STATUS_OK;
}

// Adds the rows from `first` on. A last one that is too short because the file breaks off
// there, without a line end, is left out.
static status add_table_rows(csv_table *t, const file_rows *r, size_t first, bool cut,
                             fault *f)
{
    const int skipped = rows_are_counted(r, first, t->columns) ? 1 : 0;
    for (size_t row = first; row < r->count; row = skip_comments(r, row + 1)) {
        if (cut && row + 1 == r->count && fields_of(r, row) - skipped < t->columns) {
            t->cut_line = r->lines[row];
            break;
        }
        TRY(add_table_row(t, r, row, skipped, f));
    }
    return STATUS_OK;
}

// Makes the table of the rows of the file: headings, units and what lies below.
static status make_table(csv_table *t, const file_rows *r, bool cut, fault *f)
{
    const size_t headings = find_headings(r);
    if (headings == r->count && r->count > 0 && skip_comments(r, 0) < r->count) {
        const int line = r->lines[skip_comments(r, 0)];
        return fault_set_place(f, STATUS_BAD_ARGUMENT, line, 1,
                               "%.300s:%d:1: the first row has numbers, expected a row "
                               "of headings above it, such as time[s] and command[V]",
                               t->file, line);
    }
    t->lines = calloc(r->count + 1, sizeof *t->lines);
    t->fields = calloc(r->begin[r->count] + 1, sizeof *t->fields);
    if (t->lines == NULL || t->fields == NULL) {
        return fault_no_memory(f);
    }
    if (headings == r->count) {
        return STATUS_OK;
    }

    // a heading at the end that is empty is none
    t->columns = fields_of(r, headings);
    while (t->columns > 1 &&
           r->fields[r->begin[headings] + (size_t)t->columns - 1][0] == '\0') {
        t->columns--;
    }
    t->headings = copy_row(r, headings, 0, t->columns);
    t->headings_line = r->lines[headings];

    // a row of units
    bool room = t->headings != NULL;
    if (has_units_below(r, headings)) {
        const int first = fields_of(r, headings) - fields_of(r, headings + 1);
        t->units = copy_row(r, headings + 1, first, t->columns);
        room = room && t->units != NULL;
    }
    if (!room) {
        return fault_no_memory(f);
    }
    TRY(add_table_rows(t, r, data_below(r, headings), cut, f));
    t->decimal = find_decimal(t, r->separator);
    return STATUS_OK;
}

status csv_layout_read(csv_table *t, const char *path, size_t least, fault *f)
{
    static const char mark[] = "\xEF\xBB\xBF"; // that some programs put before UTF-8
    assert(least > 0);
    *t = (csv_table){.file = strdup(path), .decimal = '.', .headings_line = 1};
    if (t->file == NULL) {
        return fault_no_memory(f);
    }
    TRY(read_table_text(path, &t->text, f));
    char *text = t->text;
    if (strncmp(text, mark, strlen(mark)) == 0) {
        text += strlen(mark);
    }
    const size_t length = strlen(text);
    const bool cut = length > 0 && text[length - 1] != '\n';

    SCOPED(file_rows_finish) file_rows rows = {0};
    TRY(divide(&rows, text, f));
    TRY(make_table(t, &rows, cut, f));
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
