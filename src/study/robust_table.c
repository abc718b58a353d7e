// Tables of the robustness of control laws against what they were not told.
#include <assert.h>
#include <math.h>
#include <string.h>

#include "src/base/csv.h"
#include "src/base/json.h"
#include "src/base/numbers.h"
#include "src/base/words.h"
#include "src/study/robust.h"

enum {
    SETTLED,
    SEPARATED,
    EXCEEDED,
    OVER,
    SETTLING = OVER + ROBUST_QUANTILES,
    ERROR = SETTLING + ROBUST_QUANTILES,
    FROM_START = ERROR + ROBUST_QUANTILES,
    BACK = FROM_START + ROBUST_QUANTILES,
    AGAINST = BACK + ROBUST_QUANTILES,
    RAW,
    SMOOTHED = RAW + ROBUST_QUANTILES,
    COLUMNS = SMOOTHED + ROBUST_QUANTILES,
    OVER_OF // a word: which overshoot it is
};

typedef struct column {
    const char *key;  // in JSON, its unit at the end
    const char *name; // in CSV
    const char *unit; // in CSV
} column;

// The three quantiles of a quantity, in the order of their enumeration.
#define QUANTILES(name, key_unit, unit)                                                            \
    {name "_median" key_unit, name "_median", unit},                                               \
        {name "_nine_tenths" key_unit, name "_nine_tenths", unit},                                 \
    {                                                                                              \
        name "_worst" key_unit, name "_worst", unit                                                \
    }

static const column columns[COLUMNS] = {
    {"settled_percent", "settled", "%"},
    {"separated_percent", "separated", "%"},
    {"exceeded_percent", "exceeded", "%"},
    QUANTILES("overshoot", "_percent", "%"),
    QUANTILES("settling", "_s", "s"),
    QUANTILES("error", "_percent", "%"),
    QUANTILES("from_start", "_s", "s"),
    QUANTILES("back_share", "", ""),
    {"from_start_share", "from_start_share", ""},
    QUANTILES("raw_overshoot", "_percent", "%"),
    QUANTILES("smoothed_overshoot", "_percent", "%"),
};
#undef QUANTILES
static const char over_of[] = "overshoot_of"; // in JSON and CSV

// What people see, of the laws and of cases.
typedef struct shown_column {
    int column;
    const char *heading;
} shown_column;

static const shown_column of_laws[] = {
    {SETTLED, "settled/%"},
    {SEPARATED, "separated/%"},
    {EXCEEDED, "exceeded/%"},
    {OVER_OF, "over of"},
    {OVER + ROBUST_MEDIAN, "over/%"},
    {OVER + ROBUST_NINE_TENTHS, "90 %"},
    {OVER + ROBUST_WORST, "worst"},
    {SETTLING + ROBUST_MEDIAN, "settling/s"},
    {SETTLING + ROBUST_NINE_TENTHS, "90 %"},
    {SETTLING + ROBUST_WORST, "worst"},
    {ERROR + ROBUST_MEDIAN, "error/%"},
    {ERROR + ROBUST_NINE_TENTHS, "90 %"},
    {ERROR + ROBUST_WORST, "worst"},
    {BACK + ROBUST_WORST, "back/there"},
};
static const shown_column of_cases[] = {
    {SEPARATED, "separated/%"},
    {OVER_OF, "over of"},
    {OVER + ROBUST_WORST, "over/%"},
    {SETTLING + ROBUST_WORST, "settling/s"},
    {ERROR + ROBUST_WORST, "error/%"},
    {BACK + ROBUST_WORST, "back/there"},
    {FROM_START + ROBUST_WORST, "from start/s"},
    {AGAINST, ""}, // headed by the law
};

// The columns that a table shows, and how many.
static int shown_columns(const robust_table *t, const shown_column **shown)
{
    bool cases = t->laws[0].case_title != NULL;
    *shown = cases ? of_cases : of_laws;
    return cases ? (int)(sizeof of_cases / sizeof of_cases[0]) - (t->against == NULL)
                 : (int)(sizeof of_laws / sizeof of_laws[0]);
}

static void format_heading(char *text, size_t size, const robust_table *t, const shown_column *c)
{
    if (c->column == AGAINST) {
        snprintf(text, size, "/%s", t->against);
    } else {
        snprintf(text, size, "%s", c->heading);
    }
}

// A law's numbers in the order of the columns.
static void values_of(const robust_law *law, double *values)
{
    values[SETTLED] = 100 * law->settled;
    values[SEPARATED] = 100 * law->separated;
    values[EXCEEDED] = 100 * law->exceeded;
    values[AGAINST] = law->against;
    for (int i = 0; i < ROBUST_QUANTILES; i++) {
        values[OVER + i] = law->overshoot[i];
        values[SETTLING + i] = law->settling[i];
        values[ERROR + i] = law->error[i];
        values[FROM_START + i] = law->from_start[i];
        values[BACK + i] = law->back[i];
        values[RAW + i] = law->raw[i];
        values[SMOOTHED + i] = law->smoothed[i];
    }
}

// Two counts, then the columns but the one that another law is needed for.
static int column_of(int i)
{
    return i - 2 + (i - 2 >= AGAINST);
}

const char *robust_key(int i)
{
    assert(i >= 0);
    return i == 0 ? "runs" : i == 1 ? "failed" : i <= COLUMNS ? columns[column_of(i)].key : NULL;
}

double robust_value(const robust_law *law, int i)
{
    double values[COLUMNS];
    assert(law != NULL && i >= 0 && i <= COLUMNS);
    values_of(law, values);
    return i == 0 ? (double)law->runs : i == 1 ? (double)law->failed : values[column_of(i)];
}

// A law's cell in a column that people see; its values are values_of it.
static void format_cell(char *text, size_t size, const robust_law *law, const double *values,
                        int which)
{
    if (which == OVER_OF) {
        snprintf(text, size, "%s", robust_overshoot_of(law));
    } else if (isnan(values[which])) {
        snprintf(text, size, "-");
    } else {
        decimal_print(text, size, fabs(values[which]) >= 1000 ? "%.0f" : "%.3g", values[which]);
    }
}

// The widest title of a case, 0 without cases.
static int case_width(const robust_table *t)
{
    int width = 0;
    for (int i = 0; i < t->count && t->laws[0].case_title != NULL; i++) {
        const int length = (int)strlen(t->laws[i].case_title);
        width = length > width ? length : width;
    }
    return width;
}

// The table in columns of blanks, or of a Markdown page.
static void write_table(FILE *stream, const robust_table *t, bool page)
{
    assert(stream != NULL && t != NULL && t->count > 0);
    const shown_column *shown;
    const int count = shown_columns(t, &shown), width = case_width(t);
    const bool cases = t->laws[0].case_title != NULL;
    const char *cell = page ? " %s |" : "  %12s";
    char text[64];

    // headings
    if (cases) {
        fprintf(stream, page ? "| %-*s " : "%-*s  ", page ? 0 : width, "case");
    }
    fprintf(stream, page ? "| %s | %s |" : "%-16s  %5s", "law", "runs");
    for (int k = 0; k < count; k++) {
        format_heading(text, sizeof text, t, &shown[k]);
        fprintf(stream, cell, text);
    }
    fputc('\n', stream);
    for (int k = 0; page && k < count + 2 + cases; k++) {
        fprintf(stream, "%s---|%s", k == 0 ? "|" : "", k == count + 1 + cases ? "\n" : "");
    }

    // a line a law
    for (int i = 0; i < t->count; i++) {
        const robust_law *law = &t->laws[i];
        double values[COLUMNS];
        values_of(law, values);
        if (cases) {
            print_printable(stream, page ? "| %-*s " : "%-*s  ", page ? 0 : width, law->case_title);
        }
        fprintf(stream, page ? "| %s | %zu |" : "%-16s  %5zu", law->law, law->runs);
        for (int k = 0; k < count; k++) {
            format_cell(text, sizeof text, law, values, shown[k].column);
            fprintf(stream, cell, text);
        }
        if (law->failed > 0 && !page) {
            fprintf(stream, "  %zu failed", law->failed);
        }
        fputc('\n', stream);
    }
}

void robust_text(FILE *stream, const robust_table *t)
{
    write_table(stream, t, false);
}

void robust_markdown(FILE *stream, const robust_table *t)
{
    write_table(stream, t, true);
}

void robust_csv(FILE *stream, const robust_table *t)
{
    assert(stream != NULL && t != NULL && t->count > 0);
    const bool cases = t->laws[0].case_title != NULL;

    // headings
    csv_writer csv = csv_begin(stream);
    if (cases) {
        csv_heading(&csv, "case", "");
    }
    csv_heading(&csv, "law", "");
    csv_heading(&csv, "runs", "");
    csv_heading(&csv, "failed", "");
    csv_heading(&csv, over_of, "");
    for (int k = 0; k < COLUMNS; k++) {
        csv_heading(&csv, columns[k].name, columns[k].unit);
    }
    csv_end_row(&csv);

    // a row a law
    for (int i = 0; i < t->count; i++) {
        const robust_law *law = &t->laws[i];
        double values[COLUMNS];
        values_of(law, values);
        if (cases) {
            csv_text(&csv, law->case_title);
        }
        csv_text(&csv, law->law);
        csv_number(&csv, (double)law->runs);
        csv_number(&csv, (double)law->failed);
        csv_text(&csv, robust_overshoot_of(law));
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
        const robust_law *found = &t->laws[i];
        json_t *law = json_object();
        double values[COLUMNS];
        values_of(found, values);

        // which, then its numbers
        if (found->case_title != NULL) {
            json_put(law, "case", json_text(found->case_title));
        }
        json_put(law, "law", json_text(found->law));
        json_put(law, "runs", json_integer((json_int_t)found->runs));
        json_put(law, "failed", json_integer((json_int_t)found->failed));
        json_put(law, over_of, json_text(robust_overshoot_of(found)));
        for (int k = 0; k < COLUMNS; k++) {
            json_put(law, columns[k].key, json_number(values[k]));
        }
        json_add(laws, law);
    }

    json_put(whole, "scenario", json_text(t->scenario));
    if (t->against != NULL) {
        json_put(whole, "against", json_text(t->against));
    }
    json_put(whole, "laws", laws);
    return whole;
}
