#include "src/base/csv_table.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "src/base/csv_units.h"
#include "src/base/numbers.h"
#include "src/base/plain_math.h"
#include "src/base/scoped.h"
#include "src/base/words.h"

#define STAMP_ERROR 0.01 // of a period, that a stamp may be off without saying anything

enum {
    SHOWN = 60,
    ROWS_FOR_ONE_BAD = 20,
    MOST_PLACES = 100 // by which a row is put in order
};

status csv_table_read(csv_table *t, const char *path, size_t least, fault *f)
{
    const status code = csv_layout_read(t, path, least, f);
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
    free(t->units);
    free(t->fields);
    free(t->lines);
    *t = (csv_table){0};
}

// --- columns ---------------------------------------------------------------------------

// Length of the name of a heading that is asked for, without "[unit]".
static size_t asked_name_length(const char *heading)
{
    const char *bracket = strrchr(heading, '[');
    size_t length = strlen(heading);
    if (bracket == NULL || heading[length - 1] != ']') {
        return length;
    }
    length = (size_t)(bracket - heading);
    while (length > 0 && is_blank(heading[length - 1])) {
        length--;
    }
    return length;
}

int csv_table_find(const csv_table *t, const char *heading)
{
    const size_t asked = asked_name_length(heading);
    int same = -1, alike = -1;

    // the first such heading itself, or of its name in another unit
    for (int c = 0; c < t->columns; c++) {
        const char *here = t->headings[c];
        size_t length;
        char unit[UNIT_TEXT];
        csv_unit_split(here, &length, unit);
        if (strcmp(here, heading) == 0) {
            return c;
        }
        if (length != asked) {
            continue;
        }
        if (same < 0 && strncmp(here, heading, length) == 0) {
            same = c;
        }
        if (alike < 0 && strncasecmp(here, heading, length) == 0) {
            alike = c;
        }
    }
    if (same >= 0) {
        return same;
    }
    return alike;
}

// Names of the column with the times, then of one that counts samples.
static const char *const time_names[] = {"time", "t", "timestamp", "time stamp", "stamp"};
static const char *const count_names[] = {"sample",  "samples", "index", "count",
                                          "counter", "tick",    "n",     "frame"};

// The heading of the only column in a unit of time, NULL if there is none.
static const char *only_time(const csv_table *t)
{
    const char *found = NULL;
    for (int c = 0; c < t->columns; c++) {
        char unit[UNIT_TEXT];
        if (!csv_table_unit(t, c, unit) || csv_unit_factor(unit, "s") == 0) {
            continue;
        }
        if (found != NULL) {
            return NULL;
        }
        found = t->headings[c];
    }
    return found;
}

// The first of some names that a table has as a heading.
static const char *first_found(const csv_table *t, const char *const *names, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (csv_table_find(t, names[i]) >= 0) {
            return names[i];
        }
    }
    return NULL;
}

const char *csv_table_clock(const csv_table *t)
{
    const char *name = first_found(t, time_names, sizeof time_names / sizeof *time_names);
    if (name == NULL) {
        name = only_time(t);
    }
    if (name != NULL) {
        return name;
    }
    return first_found(t, count_names, sizeof count_names / sizeof *count_names);
}

bool csv_table_unit(const csv_table *t, int column, char unit[UNIT_TEXT])
{
    size_t length;
    if (csv_unit_split(t->headings[column], &length, unit)) {
        return true;
    }
    if (t->units == NULL) {
        return false;
    }
    csv_unit_alone(t->units[column], unit);
    return unit[0] != '\0' && strcmp(unit, "-") != 0;
}

// The unit of a column as it is asked for, else as the table says; false if neither does.
static bool find_unit(const csv_table *t, const char *heading, int column,
                      char unit[UNIT_TEXT])
{
    const size_t length = asked_name_length(heading);
    if (heading[length] == '\0') {
        return csv_table_unit(t, column, unit);
    }
    const char *bracket = strrchr(heading, '[');
    snprintf(unit, UNIT_TEXT, "%.*s", (int)strlen(bracket) - 2, bracket + 1);
    return true;
}

static const char *field_at(const csv_table *t, size_t row, int column)
{
    return t->fields[row * (size_t)t->columns + (size_t)column];
}

// Refuses a column whose heading another one has, too, where they differ.
static status check_alone(const csv_table *t, int column, fault *f)
{
    int other = column + 1;
    while (other < t->columns && strcmp(t->headings[other], t->headings[column]) != 0) {
        other++;
    }
    for (size_t r = 0; other < t->columns && r < t->rows; r++) {
        if (strcmp(field_at(t, r, column), field_at(t, r, other)) != 0) {
            return fault_set_place(f, STATUS_BAD_ARGUMENT, t->lines[r], other + 1,
                                   "%.300s:%d:%d: columns %d and %d are both headed "
                                   "'%.*s' and differ here, expected one of them",
                                   t->file, t->lines[r], other + 1, column + 1, other + 1,
                                   SHOWN, t->headings[column]);
        }
    }
    return STATUS_OK;
}

// Finds the column of a heading.
static status find_column(const csv_table *t, const char *heading, int *column, fault *f)
{
    *column = csv_table_find(t, heading);
    if (*column >= 0) {
        return check_alone(t, *column, f);
    }

    // as many of the headings as have room
    char headings[4 * SHOWN] = "";
    for (int c = 0; c < t->columns; c++) {
        text_add(headings, sizeof headings, "%s'%.*s'", c > 0 ? ", " : "", SHOWN,
                 t->headings[c]);
    }
    const int line = t->headings_line;
    return fault_set_place(f, STATUS_BAD_ARGUMENT, line, 1,
                           "%.300s:%d:1: there is no column '%.*s', expected one of its "
                           "%d headings %s",
                           t->file, line, SHOWN, heading, t->columns, headings);
}

// How many of the wanted unit a number in a column is.
static status find_factor(const csv_table *t, const char *heading, int column,
                          const char *wanted, double *factor, fault *f)
{
    char unit[UNIT_TEXT];
    *factor = 1;
    if (find_unit(t, heading, column, unit)) {
        *factor = csv_unit_factor(unit, wanted);
    }
    if (*factor == 0) {
        return fault_set_place(
            f, STATUS_BAD_ARGUMENT, t->headings_line, column + 1,
            "%.300s:%d:%d: the unit [%s] of '%.*s' is not known, expected [%s] or "
            "what can be converted to it",
            t->file, t->headings_line, column + 1, unit, SHOWN, t->headings[column],
            wanted);
    }
    return STATUS_OK;
}

// Whether a field says that there is no number.
static bool is_gap(const char *field)
{
    static const char *const words[] = {"",     "nan",  "-nan", "na", "n/a",
                                        "#n/a", "null", "none", "-"};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        if (strcasecmp(field, words[i]) == 0) {
            return true;
        }
    }
    return false;
}

static status refuse_field(const csv_table *t, size_t row, int column, fault *f)
{
    return fault_set_place(f, STATUS_BAD_ARGUMENT, t->lines[row], column + 1,
                           "%.300s:%d:%d: '%.*s' in column '%.*s' is no finite number, "
                           "expected one such as 1%c5",
                           t->file, t->lines[row], column + 1, SHOWN,
                           field_at(t, row, column), SHOWN, t->headings[column],
                           t->decimal);
}

// Reads the fields of a column, NaN for a gap where one may be.
static status read_fields(const csv_table *t, int column, double factor, bool gaps,
                          double *values, fault *f)
{
    for (size_t r = 0; r < t->rows; r++) {
        const char *field = field_at(t, r, column);
        if (gaps && is_gap(field)) {
            values[r] = (double)NAN;
        } else if (csv_layout_number(field, t->decimal, &values[r])) {
            values[r] *= factor;
        } else {
            return refuse_field(t, r, column, f);
        }
    }
    return STATUS_OK;
}

// Fills gaps with the value above, those above the first value with that.
static status hold_values(const csv_table *t, int column, double *values, fault *f)
{
    size_t first = 0;
    while (first < t->rows && isnan(values[first])) {
        first++;
    }
    if (first == t->rows) {
        return refuse_field(t, 0, column, f);
    }
    for (size_t r = 0; r < first; r++) {
        values[r] = values[first];
    }
    for (size_t r = first; r < t->rows; r++) {
        if (isnan(values[r])) {
            values[r] = values[r - 1];
        }
    }
    return STATUS_OK;
}

status csv_table_numbers(const csv_table *t, const char *heading, const char *unit,
                         csv_gaps gaps, double **values, fault *f)
{
    int column;
    double factor;
    *values = NULL;
    TRY(find_column(t, heading, &column, f));
    TRY(find_factor(t, heading, column, unit, &factor, f));

    double *numbers = calloc(t->rows + 1, sizeof *numbers);
    if (numbers == NULL) {
        return fault_no_memory(f);
    }
    status code = read_fields(t, column, factor, gaps != GAPS_REFUSED, numbers, f);
    if (code == STATUS_OK && gaps == GAPS_HELD) {
        code = hold_values(t, column, numbers, f);
    }
    if (code != STATUS_OK) {
        free(numbers);
        return code;
    }
    *values = numbers;
    return STATUS_OK;
}

// --- times -----------------------------------------------------------------------------

// Whether a column of times counts samples: its unit says so, or its name.
static bool counts_samples(const csv_table *t, const char *heading, int column)
{
    char unit[UNIT_TEXT];
    if (find_unit(t, heading, column, unit)) {
        return csv_unit_counts(unit);
    }
    for (size_t i = 0; i < sizeof count_names / sizeof *count_names; i++) {
        if (strcasecmp(heading, count_names[i]) == 0) {
            return true;
        }
    }
    return false;
}

// Exchanges two rows of the table and their times; one may be the other.
static void exchange_rows(csv_table *t, double *times, size_t a, size_t b)
{
    char **of_a = t->fields + a * (size_t)t->columns;
    char **of_b = t->fields + b * (size_t)t->columns;
    for (int c = 0; c < t->columns; c++) {
        char *field = of_a[c];
        of_a[c] = of_b[c];
        of_b[c] = field;
    }
    const int line = t->lines[a];
    const double time = times[a];
    t->lines[a] = t->lines[b];
    times[a] = times[b];
    t->lines[b] = line;
    times[b] = time;
}

// Takes the rows out of the table that have no time, puts those whose time lies before
// that of the row above in their places, and counts both.
static void order_rows(csv_table *t, double *times)
{
    size_t kept = 0;
    for (size_t r = 0; r < t->rows; r++) {
        if (isnan(times[r])) {
            if (t->untimed++ == 0) {
                t->untimed_line = t->lines[r];
            }
            continue;
        }
        exchange_rows(t, times, r, kept);
        if (kept > 0 && times[kept] < times[kept - 1]) {
            t->receding++;
        }
        for (size_t k = kept; k > 0 && times[k] < times[k - 1]; k--) {
            exchange_rows(t, times, k, k - 1);
        }
        kept++;
    }
    t->rows = kept;
}

// Refuses a table of which too many rows have no time, or one before that of the row
// above, by the first such row, or in which a recorder began anew.
static status check_times(const csv_table *t, int column, const double *times, fault *f)
{
    size_t untimed = 0, receding = 0, first_untimed = 0, first_receding = 0;
    size_t latest = 0, above = 0; // so far, and when the first receded
    const size_t most = t->rows / ROWS_FOR_ONE_BAD;
    bool anew = false;
    for (size_t r = 0; r < t->rows; r++) {
        if (isnan(times[r])) {
            if (untimed++ == 0) {
                first_untimed = r;
            }
        } else if (times[r] < times[latest]) {
            const bool goes_far = r >= MOST_PLACES && times[r] < times[r - MOST_PLACES];
            const bool is_first = goes_far && !anew && receding <= most;
            if (receding++ == 0 || is_first) {
                first_receding = r;
                above = latest;
            }
            anew = anew || goes_far;
        } else {
            latest = r;
        }
    }
    if (untimed > most || isnan(times[0])) {
        return refuse_field(t, first_untimed, column, f);
    }
    if (!anew && receding <= most) {
        return STATUS_OK;
    }
    const int line = t->lines[first_receding];
    return fault_set_place(f, STATUS_BAD_ARGUMENT, line, column + 1,
                           "%.300s:%d:%d: the time %.9g s lies before that of a row "
                           "above, %.9g s, as in %zu rows: expected rows by growing time",
                           t->file, line, column + 1, times[first_receding], times[above],
                           receding);
}

// What the last digit of a number stands for.
static double last_digit(const char *field, char decimal)
{
    double exponent = 0;
    const char *rest, *e = strpbrk(field, "eE"), *point = strchr(field, decimal);
    if (e != NULL) {
        decimal_read(e + 1, &exponent, &rest);
    }
    if (point != NULL) {
        const char *digits = point + 1;
        exponent -= (double)strspn(digits, "0123456789");
    }
    return plain_pow(10, exponent);
}

// Lets the stamps be the instants of the clock's samples, if they are off them by no more
// than rounding and a small part of a period.
static void take_instants(const csv_table *t, int column, double factor,
                          const sample_clock *clock, double *times)
{
    if (clock->period == 0 || t->rows < RECORDED_ROWS) {
        return;
    }
    for (size_t r = 0; r < t->rows; r++) {
        const double n = sample_clock_number(clock, times[r]);
        const double off = fabs(times[r] - sample_clock_instant(clock, n));
        const double digit = factor * last_digit(field_at(t, r, column), t->decimal);
        if (off > digit / 2 + STAMP_ERROR * clock->period) {
            return;
        }
    }
    for (size_t r = 0; r < t->rows; r++) {
        const double n = sample_clock_number(clock, times[r]);
        times[r] = sample_clock_instant(clock, n);
    }
}

status csv_table_times(csv_table *t, const char *heading, double rate,
                       sample_clock *clock, double **values, fault *f)
{
    int column;
    double factor;
    *values = NULL;
    if (heading == NULL) {
        heading = csv_table_clock(t);
    }
    if (heading == NULL) {
        heading = time_names[0];
    }
    TRY(find_column(t, heading, &column, f));

    // a number of a sample, or a time
    if (counts_samples(t, heading, column)) {
        if (rate == 0) {
            return fault_set_place(f, STATUS_BAD_ARGUMENT, t->headings_line, column + 1,
                                   "%.300s:%d:%d: '%.*s' counts samples, whose rate is "
                                   "not known here, expected times such as time[s]",
                                   t->file, t->headings_line, column + 1, SHOWN,
                                   t->headings[column]);
        }
        factor = 1 / rate;
    } else {
        TRY(find_factor(t, heading, column, "s", &factor, f));
    }

    // the rows that have one
    SCOPED(free_kept) double *times = calloc(t->rows + 1, sizeof *times);
    if (times == NULL) {
        return fault_no_memory(f);
    }
    TRY(read_fields(t, column, factor, true, times, f));
    TRY(check_times(t, column, times, f));
    order_rows(t, times);

    // and when they were recorded
    if (!sample_clock_fit(clock, times, t->rows)) {
        return fault_no_memory(f);
    }
    take_instants(t, column, factor, clock, times);
    *values = times;
    times = NULL;
    return STATUS_OK;
}

// Refuses a recording whose samples are further apart than a run lasts.
static status check_speed(const csv_table *t, const sample_clock *clock, double end,
                          fault *f)
{
    const bool slow = sample_clock_is_foreign(t->rows, clock->period, clock->period, end);
    if (!slow) {
        return STATUS_OK;
    }
    return fault_set_place(f, STATUS_BAD_ARGUMENT, t->lines[1], 1,
                           "%.300s:%d:1: by their times the rows come every %.4g s, "
                           "which is more than the whole run, %.4g s: expected times in "
                           "s, or with their unit in the heading, such as time[ms]",
                           t->file, t->lines[1], clock->period, end);
}

status csv_table_play(csv_table *t, double rate, double shift, double end,
                      sample_clock *clock, double **values, char told[CSV_TOLD], fault *f)
{
    TRY(csv_table_times(t, NULL, rate, clock, values, f));
    double *times = *values;
    const double first = times[0], last = times[t->rows - 1];
    const status code = check_speed(t, clock, end, f);
    if (code != STATUS_OK) {
        free(times);
        *values = NULL;
        return code;
    }

    // what is left out, and whose clock it is
    csv_table_left_out(t, told, CSV_TOLD);
    if (sample_clock_is_foreign(t->rows, first + shift, last + shift, end)) {
        text_add(told, CSV_TOLD, "%sits clock begins at %.9g s, which is taken for 0",
                 told[0] != '\0' ? "; " : "", first);
        for (size_t r = 0; r < t->rows; r++) {
            times[r] -= first;
        }
        clock->origin -= first;
    }
    return STATUS_OK;
}

const char *csv_table_left_out(const csv_table *t, char *text, size_t size)
{
    text[0] = '\0';
    if (t->cut_line > 0) {
        text_add(text, size, "line %d, which breaks off, is left out", t->cut_line);
    }
    if (t->untimed > 0) {
        text_add(text, size, "%s%zu without a time (the first in line %d)",
                 text[0] != '\0' ? "; " : "", t->untimed, t->untimed_line);
    }
    if (t->receding > 0) {
        text_add(text, size, "%s%zu before the row above by time, put in order",
                 text[0] != '\0' ? "; " : "", t->receding);
    }
    return text;
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
