// Tables of how control laws do with wrong beliefs, sensors, walls and starts.
#include <assert.h>
#include <math.h>
#include <string.h>

#include "src/base/json.h"
#include "src/base/numbers.h"
#include "src/study/result_rows.h"
#include "src/study/robust/robust.h"

enum {
    CASE, // of a set with cases
    LAW,
    RUNS,
    FAILED,
    OVER_OF, // a word: which overshoot it is
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
    COLUMNS = SMOOTHED + ROBUST_QUANTILES
};
enum { ROBUST_CELL = 64 };

#define PLACE(field) offsetof(robust_law, field), 1
#define TEXT(field)  offsetof(robust_law, field), .kind = RESULT_TEXT
#define COUNT(field) offsetof(robust_law, field), .kind = RESULT_COUNT
#define SHARE(field) offsetof(robust_law, field), 100 // in percent

// The three quantiles of a quantity, in the order of their enumeration.
#define QUANTILES(name, key_unit, unit, field)                                           \
    {name "_median" key_unit, name "_median", unit, PLACE(field[ROBUST_MEDIAN])},        \
        {name "_nine_tenths" key_unit, name "_nine_tenths", unit,                        \
         PLACE(field[ROBUST_NINE_TENTHS])},                                              \
    {                                                                                    \
        name "_worst" key_unit, name "_worst", unit, PLACE(field[ROBUST_WORST])          \
    }

static const result_column columns[COLUMNS] = {
    {"case", "case", "", TEXT(case_title)},
    {"law", "law", "", TEXT(law)},
    {"runs", "runs", "", COUNT(runs)},
    {"failed", "failed", "", COUNT(failed)},
    {"overshoot_of", "overshoot_of", "", TEXT(overshoot_of)},
    {"settled_percent", "settled", "%", SHARE(settled)},
    {"separated_percent", "separated", "%", SHARE(separated)},
    {"exceeded_percent", "exceeded", "%", SHARE(exceeded)},
    QUANTILES("overshoot", "_percent", "%", overshoot),
    QUANTILES("settling", "_s", "s", settling),
    QUANTILES("error", "_percent", "%", error),
    QUANTILES("from_start", "_s", "s", from_start),
    QUANTILES("back_share", "", "", back),
    {"from_start_share", "from_start_share", "", PLACE(against)},
    QUANTILES("raw_overshoot", "_percent", "%", raw),
    QUANTILES("smoothed_overshoot", "_percent", "%", smoothed),
};

// What people see, of the laws and of cases.
typedef struct shown_column {
    int column;
    const char *heading;
} shown_column;

static const shown_column of_laws[] = {
    {LAW, "law"},
    {RUNS, "runs"},
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
    {CASE, "case"},
    {LAW, "law"},
    {RUNS, "runs"},
    {SEPARATED, "separated/%"},
    {OVER_OF, "over of"},
    {OVER + ROBUST_WORST, "over/%"},
    {SETTLING + ROBUST_WORST, "settling/s"},
    {ERROR + ROBUST_WORST, "error/%"},
    {BACK + ROBUST_WORST, "back/there"},
    {FROM_START + ROBUST_WORST, "from start/s"},
    {AGAINST, ""}, // headed by the law
};

static bool has_cases(const robust_table *t)
{
    assert(t->count > 0);
    return t->laws[0].case_title != NULL;
}

// The columns of a table, which has cases or not.
static result_table result_columns(const robust_table *t)
{
    const int first = has_cases(t) ? CASE : LAW;
    return (result_table){columns + first, COLUMNS - first, t->laws, sizeof *t->laws,
                          t->count};
}

// The column of number i of a law's summary: the two counts RUNS and FAILED, then the
// numbers from SETTLED on without AGAINST, which needs another law.
static int summary_column(int i)
{
    const int column = i < 2 ? RUNS + i : SETTLED + i - 2;
    if (column >= AGAINST) {
        return column + 1;
    }
    return column;
}

const char *robust_key(int i)
{
    assert(i >= 0);
    if (summary_column(i) < COLUMNS) {
        return columns[summary_column(i)].key;
    }
    return NULL;
}

double robust_value(const robust_law *law, int i)
{
    assert(i >= 0 && summary_column(i) < COLUMNS);
    return result_cell_of(&(result_table){.rows = law}, 0, &columns[summary_column(i)])
        .number;
}

enum { HEADING = -1 }; // the row of the headings

// The text of a cell; `text` is room for a cell that is made up here.
static const char *robust_cell(const robust_table *t, int row, const shown_column *shown,
                               char text[ROBUST_CELL])
{
    if (row == HEADING && shown->column == AGAINST) {
        snprintf(text, ROBUST_CELL, "/%s", t->against);
        return text;
    }
    if (row == HEADING) {
        return shown->heading;
    }
    const result_table all = result_columns(t);
    const result_cell cell = result_cell_of(&all, row, &columns[shown->column]);
    if (cell.text != NULL) {
        return cell.text;
    }
    if (isnan(cell.number)) {
        return "-";
    }
    decimal_print(text, ROBUST_CELL, fabs(cell.number) >= 1000 ? "%.0f" : "%.3g",
                  cell.number);
    return text;
}

// The table in columns of blanks, or of a Markdown page.
void robust_text(FILE *stream, const robust_table *t, bool page)
{
    const bool cases = has_cases(t);
    const shown_column *shown = of_laws;
    int count = (int)(sizeof of_laws / sizeof of_laws[0]);
    if (cases) {
        shown = of_cases;
        count = (int)(sizeof of_cases / sizeof of_cases[0]);
    }
    if (cases && t->against == NULL) {
        count--; // the last is the share of another law
    }
    int widest = 0; // title of a case
    char text[ROBUST_CELL];
    for (int i = 0; i < t->count && cases; i++) {
        const int length = (int)strlen(t->laws[i].case_title);
        if (length > widest) {
            widest = length;
        }
    }

    // the headings, then a line for each law
    for (int i = HEADING; i < t->count; i++) {
        for (int k = 0; k < count; k++) {
            const int column = shown[k].column;
            int width;
            if (column == CASE) {
                width = -widest;
            } else if (column == LAW) {
                width = -16;
            } else if (column == RUNS) {
                width = 5;
            } else {
                width = 12;
            }
            result_print(stream, page, k, width, robust_cell(t, i, &shown[k], text));
        }
        if (i >= 0 && t->laws[i].failed > 0 && !page) {
            fprintf(stream, "  %zu failed", t->laws[i].failed);
        }
        fputc('\n', stream);
        if (i < 0 && page) {
            result_page_rule(stream, count);
        }
    }
}

void robust_csv(FILE *stream, const robust_table *t)
{
    const result_table all = result_columns(t);
    result_csv(stream, &all);
}

json_t *robust_json(const robust_table *t)
{
    const result_table all = result_columns(t);
    json_t *whole = json_of("scenario:t", t->scenario);
    if (t->against != NULL) {
        json_members(whole, "against:t", t->against);
    }
    return json_members(whole, "laws:o", result_json(&all));
}
