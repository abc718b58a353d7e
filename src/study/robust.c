#include "src/study/robust.h"

#include <assert.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/csv.h"
#include "src/base/json.h"
#include "src/base/numbers.h"
#include "src/study/sweep_rows.h"

enum { MOST_SET_BYTES = 65536 };

const double robust_levels[ROBUST_QUANTILES] = {
    [ROBUST_MEDIAN] = 0.5, [ROBUST_NINE_TENTHS] = 0.9, [ROBUST_WORST] = 1};

// --- the set ----------------------------------------------------------------------------------

// The whole file as a text on the heap.
static status read_text(const char *path, char **text, fault *f)
{
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        return fault_set(f, STATUS_CANNOT_READ, "the set '%s' cannot be opened: %s", path,
                         strerror(errno));
    }

    // all of it, if it is not too long
    *text = calloc(1, MOST_SET_BYTES + 1);
    size_t length = *text != NULL ? fread(*text, 1, MOST_SET_BYTES, file) : 0;
    bool whole = *text != NULL && ferror(file) == 0 && fgetc(file) == EOF;
    fclose(file);

    if (*text == NULL) {
        return fault_no_memory(f);
    }
    if (!whole || strlen(*text) != length) {
        free(*text);
        return fault_set(
            f, STATUS_BAD_ARGUMENT,
            "'%s' is no set, expected lines PATH=a:b or PATH=v1,v2 of at most %d bytes", path,
            MOST_SET_BYTES);
    }
    return STATUS_OK;
}

status robust_set_read(robust_set *set, const char *path, fault *f)
{
    assert(set != NULL && path != NULL);
    *set = (robust_set){0};
    status code = read_text(path, &set->text, f);
    if (code != STATUS_OK) {
        return code;
    }

    // a line has at least one character
    set->lines = calloc(strlen(set->text) + 1, sizeof *set->lines);
    if (set->lines == NULL) {
        robust_set_finish(set);
        return fault_no_memory(f);
    }

    // without the blanks at both ends; remarks and empty lines say nothing
    char *rest = set->text;
    for (char *line; (line = strsep(&rest, "\n")) != NULL;) {
        line += strspn(line, " \t\r");
        size_t length = strlen(line);
        while (length > 0 && strchr(" \t\r", line[length - 1]) != NULL) {
            line[--length] = '\0';
        }
        if (length > 0 && line[0] != '#') {
            set->lines[set->count++] = line;
        }
    }

    if (set->count == 0) {
        robust_set_finish(set);
        return fault_set(f, STATUS_BAD_ARGUMENT,
                         "the set '%s' names no parameter, expected lines PATH=a:b or PATH=v1,v2",
                         path);
    }
    return STATUS_OK;
}

void robust_set_finish(robust_set *set)
{
    if (set != NULL) {
        free(set->text);
        free(set->lines);
        *set = (robust_set){0};
    }
}

// --- a law ------------------------------------------------------------------------------------

// Ascending, with NaN behind all numbers.
static int compare_numbers(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    if (isnan(x) || isnan(y)) {
        return isnan(x) - isnan(y);
    }
    return (x > y) - (x < y);
}

// Sorts the values; between two of them a quantile lies on a straight line.
static void find_quantiles(double *values, size_t count, double *quantiles)
{
    qsort(values, count, sizeof *values, compare_numbers);
    for (int i = 0; i < ROBUST_QUANTILES; i++) {
        double place = robust_levels[i] * (double)(count - 1), whole = floor(place);
        size_t at = (size_t)whole, next = at + 1 < count ? at + 1 : at;
        double part = place - whole;
        quantiles[i] = part > 0 ? (1 - part) * values[at] + part * values[next] : values[at];
    }
}

// Quantities of every run that a judgement takes.
enum { COMMAND, OVER, SMOOTHED, PEAK, SETTLING, ERROR, SEPARATIONS, QUANTITIES };
static const char *const keys[QUANTITIES] = {
    [COMMAND] = "force_command_N",          [OVER] = "force_over_command_N",
    [SMOOTHED] = "smoothed_over_command_N", [PEAK] = "peak_force_N",
    [SETTLING] = "settling_time_s",         [ERROR] = "steady_error_N",
    [SEPARATIONS] = "separations",
};

// Judges the runs, whose quantities stand one behind the other; what is sorted is overwritten.
static void judge(robust_law *out, const sweep *s, double *values)
{
    const size_t n = s->run_count;
    double *of[QUANTITIES];
    size_t settled = 0, separated = 0, exceeded = 0;
    for (int q = 0; q < QUANTITIES; q++) {
        of[q] = values + (size_t)q * n;
    }

    // each run
    for (size_t i = 0; i < n; i++) {
        scenario derived;
        bool known = sweep_scenario(s, i, &derived, NULL) == STATUS_OK;
        bool many = known && derived.parameters.arm.links > 2;
        double command = of[COMMAND][i];
        double allowed = known && derived.parameters.control.force_limit > 0
                             ? derived.parameters.control.force_limit
                             : ROBUST_EXCESS * command;

        settled += !isnan(of[SETTLING][i]);
        separated += of[SEPARATIONS][i] > 0;
        exceeded += (many ? of[SMOOTHED][i] + command : of[PEAK][i]) > allowed;
        out->overshoots[i] = 100 * of[many ? SMOOTHED : OVER][i] / command;
        of[ERROR][i] = 100 * fabs(of[ERROR][i]) / command;
    }

    // all of them
    out->settled = (double)settled / (double)n;
    out->separated = (double)separated / (double)n;
    out->exceeded = (double)exceeded / (double)n;
    find_quantiles(out->overshoots, n, out->overshoot);
    find_quantiles(of[SETTLING], n, out->settling);
    find_quantiles(of[ERROR], n, out->error);
}

status robust_law_of(robust_law *out, const char *law, const sweep *s, sweep_store *store, fault *f)
{
    assert(out != NULL && law != NULL && s != NULL && store != NULL && s->run_count > 0);
    *out = (robust_law){.law = law, .runs = s->run_count};

    // a column of the store for each quantity
    double *values = calloc(QUANTITIES * s->run_count, sizeof *values);
    out->overshoots = calloc(s->run_count, sizeof *out->overshoots);
    status code = values != NULL && out->overshoots != NULL ? STATUS_OK : fault_no_memory(f);
    for (int q = 0; q < QUANTITIES && code == STATUS_OK; q++) {
        code = sweep_store_quantity(store, keys[q], values + (size_t)q * s->run_count, &out->failed,
                                    f);
    }

    if (code == STATUS_OK) {
        judge(out, s, values);
    }
    free(values);
    return code;
}

void robust_law_finish(robust_law *law)
{
    if (law != NULL) {
        free(law->overshoots);
        law->overshoots = NULL;
    }
}

// --- tables -----------------------------------------------------------------------------------

enum { COLUMNS = 3 + 3 * ROBUST_QUANTILES };

typedef struct column {
    const char *key;     // in JSON, its unit at the end
    const char *name;    // in CSV
    const char *unit;    // in CSV
    const char *heading; // for people
} column;

static const column columns[COLUMNS] = {
    {"settled_percent", "settled", "%", "settled/%"},
    {"separated_percent", "separated", "%", "separated/%"},
    {"exceeded_percent", "exceeded", "%", "exceeded/%"},
    {"overshoot_median_percent", "overshoot_median", "%", "over/%"},
    {"overshoot_nine_tenths_percent", "overshoot_nine_tenths", "%", "90 %"},
    {"overshoot_worst_percent", "overshoot_worst", "%", "worst"},
    {"settling_median_s", "settling_median", "s", "settling/s"},
    {"settling_nine_tenths_s", "settling_nine_tenths", "s", "90 %"},
    {"settling_worst_s", "settling_worst", "s", "worst"},
    {"error_median_percent", "error_median", "%", "error/%"},
    {"error_nine_tenths_percent", "error_nine_tenths", "%", "90 %"},
    {"error_worst_percent", "error_worst", "%", "worst"},
};

// A law's numbers in the order of the columns.
static void values_of(const robust_law *law, double *values)
{
    *values++ = 100 * law->settled;
    *values++ = 100 * law->separated;
    *values++ = 100 * law->exceeded;
    memcpy(values, law->overshoot, sizeof law->overshoot);
    memcpy(values + ROBUST_QUANTILES, law->settling, sizeof law->settling);
    memcpy(values + 2 * ROBUST_QUANTILES, law->error, sizeof law->error);
}

static void format_value(char *text, size_t size, double value)
{
    if (isnan(value)) {
        snprintf(text, size, "-");
    } else {
        decimal_print(text, size, fabs(value) >= 1000 ? "%.0f" : "%.3g", value);
    }
}

void robust_text(FILE *stream, const robust_table *t)
{
    assert(stream != NULL && t != NULL);

    // headings
    fprintf(stream, "%-16s  %5s", "law", "runs");
    for (int k = 0; k < COLUMNS; k++) {
        fprintf(stream, "  %11s", columns[k].heading);
    }
    fputc('\n', stream);

    // a line a law
    for (int i = 0; i < t->count; i++) {
        double values[COLUMNS];
        values_of(&t->laws[i], values);
        fprintf(stream, "%-16s  %5zu", t->laws[i].law, t->laws[i].runs);
        for (int k = 0; k < COLUMNS; k++) {
            char text[32];
            format_value(text, sizeof text, values[k]);
            fprintf(stream, "  %11s", text);
        }
        if (t->laws[i].failed > 0) {
            fprintf(stream, "  %zu failed", t->laws[i].failed);
        }
        fputc('\n', stream);
    }
}

void robust_markdown(FILE *stream, const robust_table *t)
{
    assert(stream != NULL && t != NULL);

    // headings
    fputs("| law | runs |", stream);
    for (int k = 0; k < COLUMNS; k++) {
        fprintf(stream, " %s |", columns[k].heading);
    }
    fputs("\n|---|---|", stream);
    for (int k = 0; k < COLUMNS; k++) {
        fputs("---|", stream);
    }
    fputc('\n', stream);

    // a line a law
    for (int i = 0; i < t->count; i++) {
        double values[COLUMNS];
        values_of(&t->laws[i], values);
        fprintf(stream, "| %s | %zu |", t->laws[i].law, t->laws[i].runs);
        for (int k = 0; k < COLUMNS; k++) {
            char text[32];
            format_value(text, sizeof text, values[k]);
            fprintf(stream, " %s |", text);
        }
        fputc('\n', stream);
    }
}

void robust_csv(FILE *stream, const robust_table *t)
{
    assert(stream != NULL && t != NULL);

    // headings
    csv_writer csv = csv_begin(stream);
    csv_heading(&csv, "law", "");
    csv_heading(&csv, "runs", "");
    csv_heading(&csv, "failed", "");
    for (int k = 0; k < COLUMNS; k++) {
        csv_heading(&csv, columns[k].name, columns[k].unit);
    }
    csv_end_row(&csv);

    // a row a law
    for (int i = 0; i < t->count; i++) {
        double values[COLUMNS];
        values_of(&t->laws[i], values);
        csv_text(&csv, t->laws[i].law);
        csv_number(&csv, (double)t->laws[i].runs);
        csv_number(&csv, (double)t->laws[i].failed);
        for (int k = 0; k < COLUMNS; k++) {
            csv_number(&csv, values[k]);
        }
        csv_end_row(&csv);
    }
}

json_t *robust_json(const robust_table *t)
{
    assert(t != NULL);
    json_t *whole = json_object(), *laws = json_array();

    for (int i = 0; i < t->count; i++) {
        json_t *law = json_object();
        double values[COLUMNS];
        values_of(&t->laws[i], values);
        json_object_set_new(law, "law", json_text(t->laws[i].law));
        json_object_set_new(law, "runs", json_integer((json_int_t)t->laws[i].runs));
        json_object_set_new(law, "failed", json_integer((json_int_t)t->laws[i].failed));
        for (int k = 0; k < COLUMNS; k++) {
            json_object_set_new(law, columns[k].key, json_number(values[k]));
        }
        json_array_append_new(laws, law);
    }

    json_object_set_new(whole, "scenario", json_text(t->scenario));
    json_object_set_new(whole, "laws", laws);
    return whole;
}
