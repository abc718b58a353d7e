// Tables of the robustness of control laws against what they were not told.
#include <assert.h>
#include <math.h>
#include <string.h>

#include "src/base/json.h"
#include "src/base/numbers.h"
#include "src/study/result_rows.h"
#include "src/study/robust.h"

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

// The three quantiles of a quantity, in the order of their enumeration.
#define QUANTILES(name, key_unit, unit)                                                            \
    {name "_median" key_unit, name "_median", unit},                                               \
        {name "_nine_tenths" key_unit, name "_nine_tenths", unit},                                 \
    {                                                                                              \
        name "_worst" key_unit, name "_worst", unit                                                \
    }

static const result_column columns[COLUMNS] = {
    {"case", "case", ""},
    {"law", "law", ""},
    {"runs", "runs", ""},
    {"failed", "failed", ""},
    {"overshoot_of", "overshoot_of", ""},
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

// The first column of a table, which has cases or not.
static int first_column(const robust_table *t)
{
    return t->laws[0].case_title != NULL ? CASE : LAW;
}

// A law's cells, all of them.
static void fill_cells(const robust_law *law, result_cell *cells)
{
    for (int k = 0; k < COLUMNS; k++) {
        cells[k].text = NULL;
    }
    cells[CASE].text = law->case_title;
    cells[LAW].text = law->law;
    cells[RUNS].number = (double)law->runs;
    cells[FAILED].number = (double)law->failed;
    cells[OVER_OF].text = robust_overshoot_of(law);
    cells[SETTLED].number = 100 * law->settled;
    cells[SEPARATED].number = 100 * law->separated;
    cells[EXCEEDED].number = 100 * law->exceeded;
    cells[AGAINST].number = law->against;
    for (int i = 0; i < ROBUST_QUANTILES; i++) {
        cells[OVER + i].number = law->overshoot[i];
        cells[SETTLING + i].number = law->settling[i];
        cells[ERROR + i].number = law->error[i];
        cells[FROM_START + i].number = law->from_start[i];
        cells[BACK + i].number = law->back[i];
        cells[RAW + i].number = law->raw[i];
        cells[SMOOTHED + i].number = law->smoothed[i];
    }
}

// Two counts, then the numbers but the one that another law is needed for.
static int column_of(int i)
{
    const int column = i < 2 ? RUNS + i : SETTLED + i - 2;
    return column + (column >= AGAINST);
}

const char *robust_key(int i)
{
    assert(i >= 0);
    return column_of(i) < COLUMNS ? columns[column_of(i)].key : NULL;
}

double robust_value(const robust_law *law, int i)
{
    result_cell cells[COLUMNS];
    assert(i >= 0 && column_of(i) < COLUMNS);
    fill_cells(law, cells);
    return cells[column_of(i)].number;
}

// The table in columns of blanks, or of a Markdown page.
void robust_text(FILE *stream, const robust_table *t, bool page)
{
    assert(t->count > 0);
    const bool cases = first_column(t) == CASE;
    const shown_column *shown = cases ? of_cases : of_laws;
    const int count = cases ? (int)(sizeof of_cases / sizeof of_cases[0]) - (t->against == NULL)
                            : (int)(sizeof of_laws / sizeof of_laws[0]);
    int widest = 0; // title of a case
    char text[64];
    for (int i = 0; i < t->count && cases; i++) {
        const int length = (int)strlen(t->laws[i].case_title);
        widest = length > widest ? length : widest;
    }

    // headings, then a line a law
    for (int i = -1; i < t->count; i++) {
        result_cell cells[COLUMNS] = {{0}};
        if (i >= 0) {
            fill_cells(&t->laws[i], cells);
        }
        for (int k = 0; k < count; k++) {
            const int column = shown[k].column;
            const double number = cells[column].number;
            const char *told = i < 0 ? shown[k].heading : cells[column].text;
            if (i < 0 && column == AGAINST) {
                snprintf(text, sizeof text, "/%s", t->against);
                told = text;
            } else if (told == NULL) {
                decimal_print(text, sizeof text,
                              isnan(number)          ? "-"
                              : fabs(number) >= 1000 ? "%.0f"
                                                     : "%.3g",
                              number);
                told = text;
            }
            const int width = column == CASE   ? -widest
                              : column == LAW  ? -16
                              : column == RUNS ? 5
                                               : 12;
            result_print(stream, page, k, width, told);
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
    assert(t->count > 0);
    const int first = first_column(t);
    csv_writer csv = csv_begin(stream);
    result_headings(&csv, columns + first, COLUMNS - first);
    for (int i = 0; i < t->count; i++) {
        result_cell cells[COLUMNS];
        fill_cells(&t->laws[i], cells);
        result_row(&csv, cells + first, COLUMNS - first);
    }
}

json_t *robust_json(const robust_table *t)
{
    json_t *whole = json_members(json_object(), "scenario:t", t->scenario), *laws = json_array();
    for (int i = 0; i < t->count; i++) {
        result_cell cells[COLUMNS];
        const int first = first_column(t);
        json_t *law = json_object();
        fill_cells(&t->laws[i], cells);
        result_put(law, columns + first, cells + first, COLUMNS - first);
        json_add(laws, law);
    }

    if (t->against != NULL) {
        json_put(whole, "against", json_text(t->against));
    }
    return json_members(whole, "laws:o", laws);
}
