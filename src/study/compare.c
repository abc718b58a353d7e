#include "src/study/compare.h"

#include <math.h>
#include <string.h>

#include "src/base/csv.h"
#include "src/base/json.h"
#include "src/base/numbers.h"
#include "src/base/words.h"
#include "src/study/result_rows.h"
#include "src/predict/best_stop.h"
#include "src/predict/least_time.h"
#include "src/tables/settings.h"

// Number, key, name, heading and unit of each.
#define COMPARED(QUANTITY)                                                               \
    QUANTITY(PEAK, "peak_force_N", "peak_force", "peak", "N")                            \
    QUANTITY(SENSED, "sensor_1ms_peak_N", "sensor_1ms_peak", "1 ms peak", "N")           \
    QUANTITY(BEST_PEAK, "best_peak_N", "best_peak", "best peak", "N")                    \
    QUANTITY(OVERSHOOT, "overshoot_percent", "overshoot", "over", "%")                   \
    QUANTITY(SETTLING, "settling_time_s", "settling_time", "settled", "s")               \
    QUANTITY(BEST_SETTLING, "best_settling_s", "best_settling", "best time", "s")        \
    QUANTITY(FROM_START, "from_start_s", "from_start", "from start", "s")                \
    QUANTITY(LEAST_TIME, "least_time_s", "least_time", "least time", "s")                \
    QUANTITY(IMPACTS, "impacts", "impacts", "impacts", "")                               \
    QUANTITY(SEPARATIONS, "separations", "separations", "separations", "")               \
    QUANTITY(STEADY_ERROR, "steady_error_N", "steady_error", "error", "N")               \
    QUANTITY(COMMAND, "largest_command_V", "largest_command", "command", "V")            \
    QUANTITY(ENERGY, "electrical_energy_J", "electrical_energy", "energy", "J")
#define NUMBER(number, ...) number,
#define ROW(number, ...)    {__VA_ARGS__},
enum { COMPARED(NUMBER) };
const compare_quantity compare_quantities[COMPARE_QUANTITIES] = {COMPARED(ROW)};

// --- rows ------------------------------------------------------------------------------

// The bounds for every controller after the run's first impact: the least peak [N] and
// the least settling time [s] (best_stop.h); NaN where they are not known.
static void find_best(const scenario *s, const run_result *result, double *peak,
                      double *settling)
{
    const summary *m = &result->summary;
    const parameters *p = &s->parameters;
    const landing *touch = &result->landing;
    const double command = m->force_command_N;
    pressed_arm_model model;
    pressed_state after;
    *peak = *settling = (double)NAN;

    // it is known for a plastic impact of two links without a script
    if (!(touch->time > 0) || isnan(touch->before.angle[0]) || s->action_count > 0 ||
        p->wall.restitution > 0 || !pressed_arm_model_of(p, &model)) {
        return;
    }

    if (pressed_after_impact(p, &touch->before, &after)) {
        *peak = best_peak(&model, after);
        if (!isnan(command)) {
            double allowed = fmax(m->peak_force_N, (1 + SETTLED_BAND) * command);
            *settling = best_settling(&model, after, command, SETTLED_BAND, allowed);
        }
    }
}

// The least time [s] that any controller takes from the start until the force is settled,
// with no larger peak than the run's; NaN where it is not known.
static double find_least_time(const scenario *s, const run_result *result)
{
    const parameters *p = &s->parameters;
    const double command = result->summary.force_command_N,
                 peak = result->summary.peak_force_N;
    bool known = s->action_count == 0 && p->initial.velocity == 0 &&
                 p->wall.restitution == 0 && command > 0 && !isnan(peak);
    if (known) {
        return least_time_of(p, command, SETTLED_BAND, peak).total;
    }
    return (double)NAN;
}

compare_row compare_row_of(const scenario *s, const run_result *result)
{
    const summary *m = &result->summary;
    double command = m->force_command_N, peak, settling;
    bool commanded = !isnan(command) && command > 0;

    find_best(s, result, &peak, &settling);

    // under a commanded force the overshoot is over the command, else over the steady
    // force
    double overshoot = m->force_overshoot_percent;
    if (commanded) {
        overshoot = 100 * m->force_over_command_N / command;
    }
    return (compare_row){
        .scenario = s->name,
        .law = control_law_table[s->parameters.control.law].word,
        .ok = m->status == STATUS_OK,
        .values = {[PEAK] = m->peak_force_N,
                   [SENSED] = m->sensor_1ms_peak_N,
                   [BEST_PEAK] = peak,
                   [OVERSHOOT] = overshoot,
                   [SETTLING] = m->settling_time_s,
                   [BEST_SETTLING] = settling,
                   [FROM_START] = m->first_contact_s + m->settling_time_s,
                   [LEAST_TIME] = find_least_time(s, result),
                   [IMPACTS] = m->impacts,
                   [SEPARATIONS] = m->separations,
                   [STEADY_ERROR] = m->steady_error_N,
                   [COMMAND] = m->largest_command_V,
                   [ENERGY] = m->electrical_energy_J},
    };
}

bool compare_differs(double value, double reference, double tolerance)
{
    if (isnan(value) || isnan(reference)) {
        return isnan(value) != isnan(reference);
    }
    return fabs(value - reference) > tolerance * fmax(fabs(value), fabs(reference));
}

// Whether quantity k of row i differs from the reference's.
static bool marked(const compare_table *t, int i, int k)
{
    return t->against != NULL &&
           compare_differs(t->rows[i].values[k], t->against[i / t->group].values[k],
                           t->tolerance);
}

status compare_choose(compare_table *t, const char *keys, fault *f)
{
    for (int k = 0; k < COMPARE_QUANTITIES; k++) {
        t->hidden[k] = true;
    }

    // one key after the other
    for (const char *key = keys;; key++) {
        size_t length = strcspn(key, ",");
        char word[64];
        int found = -1;
        snprintf(word, sizeof word, "%.*s", (int)length, key);

        nearest_word near = nearest_begin(word);
        for (int k = 0; k < COMPARE_QUANTITIES; k++) {
            nearest_try(&near, compare_quantities[k].key);
            if (strcmp(word, compare_quantities[k].key) == 0) {
                found = k;
            }
        }
        FAULT_IF(found < 0 && near.best != NULL, f, STATUS_BAD_ARGUMENT,
                 "there is no column '%s', did you mean '%s'?", word, near.best);
        FAULT_IF(found < 0, f, STATUS_BAD_ARGUMENT,
                 "there is no column '%s', expected keys of --json", word);

        t->hidden[found] = false;
        key += length;
        if (*key == '\0') {
            return STATUS_OK;
        }
    }
}

// --- tables ----------------------------------------------------------------------------

// Value of a row's varied parameter as a scenario file would give it, without its unit.
static void format_varied(const compare_table *t, int row, int which, char *text,
                          size_t size)
{
    sweep_axis_format(&t->varied[which], t->rows[row].varied[which], text, size);
}

// Columns of the table: names, what was varied, results.
enum {
    SCENARIO,
    LAW,
    NAMES,
    MOST_COLUMNS = NAMES + COMPARE_MOST_VARIED + COMPARE_QUANTITIES
};

// How a number is printed: a page has three digits, a terminal four.
static const char *value_format(double value, bool page)
{
    if (isnan(value)) {
        return page ? "–" : "-";
    }
    if (!page) {
        return "%.4g";
    }
    return fabs(value) >= 999.5 ? "%.0f" : "%.3g";
}

// The heading of a varied parameter or a quantity with its unit: "peak/N", for a page
// "peak [N]".
static void write_heading(const compare_table *t, int column, bool page,
                          char text[PARAMETER_TEXT_SIZE])
{
    const int v = column - NAMES, k = v - t->varied_count;
    const char *name, *unit;
    if (k >= 0) {
        name = compare_quantities[k].heading;
        unit = compare_quantities[k].unit;
    } else {
        const char *path = t->varied[v].name;
        name = settings_name(path);
        if (name == NULL) {
            name = strchr(path, '.') + 1;
        }
        unit = sweep_axis_parameter(&t->varied[v])->unit;
    }

    const char *format = "%s";
    if (unit[0] != '\0') {
        format = page ? "%s [%s]" : "%s/%s";
    }
    snprintf(text, PARAMETER_TEXT_SIZE, format, name, unit);
}

enum { HEADING = -1 }; // the row of the headings

// The text of a cell; NULL in a column that is not shown. `text` is room for a cell that
// is made up here. A varied parameter is headed by its path without the group, for which
// there is no room.
static const char *comparison_cell(const compare_table *t, int row, int column, bool page,
                                   char text[PARAMETER_TEXT_SIZE])
{
    // the row's run, the varied parameter, and the quantity from 0 on
    const bool is_heading = row == HEADING;
    const compare_row *run = is_heading ? NULL : &t->rows[row];
    const int varied = column - NAMES, quantity = varied - t->varied_count;
    if (column == SCENARIO) {
        return is_heading ? "scenario" : run->scenario;
    }
    if (column == LAW) {
        return is_heading ? "law" : run->law;
    }
    if (quantity >= 0 && t->hidden[quantity]) {
        return NULL;
    }

    if (is_heading) {
        write_heading(t, column, page, text);
    } else if (quantity < 0) {
        char value[PARAMETER_TEXT_SIZE];
        const char *remark = run->idle[varied] != NULL ? " (no effect)" : "";
        format_varied(t, row, varied, value, sizeof value);
        snprintf(text, PARAMETER_TEXT_SIZE, "%.100s%s", value, remark);
    } else {
        const double value = run->values[quantity];
        decimal_print(text, PARAMETER_TEXT_SIZE, value_format(value, page), value);
    }
    if (quantity < 0 || page) {
        return text;
    }

    // behind a quantity a star if it differs from the reference, else the room for one
    if (!is_heading && marked(t, row, quantity)) {
        return strcat(text, "*");
    }
    return strcat(text, " ");
}

void compare_text(FILE *stream, const compare_table *t, bool page)
{
    const int columns = NAMES + t->varied_count + COMPARE_QUANTITIES;
    int widths[MOST_COLUMNS];
    char text[PARAMETER_TEXT_SIZE];

    // Quantities are 12 columns wide; names and varied values are as wide as the widest
    // of them. A negative width aligns the names to the left.
    const int first_quantity = NAMES + t->varied_count;
    const bool for_page = false;
    for (int c = 0; c < first_quantity; c++) {
        widths[c] = 0;
        for (int i = HEADING; i < t->count; i++) {
            const int length = (int)strlen(comparison_cell(t, i, c, for_page, text));
            if (length > widths[c]) {
                widths[c] = length;
            }
        }
        if (c < NAMES) {
            widths[c] = -widths[c];
        }
    }
    for (int c = first_quantity; c < columns; c++) {
        widths[c] = 12;
    }

    // the headings, then a line for each run
    for (int i = HEADING; i < t->count; i++) {
        int shown = 0;
        for (int c = 0; c < columns; c++) {
            const char *cell = comparison_cell(t, i, c, page, text);
            if (cell != NULL) {
                result_print(stream, page, shown++, widths[c], cell);
            }
        }
        if (!page && i >= 0 && !t->rows[i].ok) {
            fputs(" failed", stream);
        }
        fputc('\n', stream);
        if (page && i < 0) {
            result_page_rule(stream, shown);
        }
    }
}

// --- for programs ----------------------------------------------------------------------

static json_t *varied_object(const compare_table *t, int row)
{
    json_t *object = json_object();

    // in JSON's own types where there is one
    for (int v = 0; v < t->varied_count; v++) {
        const parameter_info *info = sweep_axis_parameter(&t->varied[v]);
        char text[PARAMETER_TEXT_SIZE];
        format_varied(t, row, v, text, sizeof text);
        const double value = t->rows[row].varied[v];
        json_t *member;
        if (info->type == PARAMETER_CHOICE) {
            member = json_text(text);
        } else if (info->type == PARAMETER_BOOLEAN) {
            member = json_boolean(value);
        } else {
            member = json_number(value);
        }
        json_put(object, t->varied[v].name, member);
    }
    return object;
}

static json_t *row_object(const compare_table *t, int i)
{
    const compare_row *row = &t->rows[i];
    json_t *differs = json_array();

    // which run
    json_t *object = json_of("scenario:t law:t", row->scenario, row->law);
    if (t->varied_count > 0) {
        json_put(object, "varied", varied_object(t, i));
    }

    // its results, and which of them differ from the reference
    json_put(object, "status", json_string(row->ok ? "ok" : "failed"));
    for (int k = 0; k < COMPARE_QUANTITIES; k++) {
        const char *key = compare_quantities[k].key;
        json_put(object, key, json_number(row->values[k]));
        if (marked(t, i, k)) {
            json_add(differs, json_string(key));
        }
    }

    // which of the values changed nothing
    json_t *idle = json_array();
    for (int v = 0; v < t->varied_count; v++) {
        if (row->idle[v] != NULL) {
            json_add(idle, json_of("path:t why:t", t->varied[v].name, row->idle[v]));
        }
    }
    if (json_array_size(idle) > 0) {
        json_put(object, "without_effect", json_incref(idle));
    }
    json_decref(idle);

    if (t->against != NULL) {
        json_put(object, "differs", json_incref(differs));
    }
    json_decref(differs);
    return object;
}

json_t *compare_json(const compare_table *t)
{
    json_t *whole = json_object(), *array = json_array();
    for (int i = 0; i < t->count; i++) {
        json_add(array, row_object(t, i));
    }

    if (t->against != NULL) {
        json_members(whole, "against:t tolerance:n", t->against->scenario, t->tolerance);
    }
    return json_members(whole, "runs:o", array);
}

void compare_csv(FILE *stream, const compare_table *t)
{
    // headings
    csv_writer csv = csv_begin(stream);
    csv_heading(&csv, "scenario", "");
    csv_heading(&csv, "law", "");
    for (int v = 0; v < t->varied_count; v++) {
        csv_heading(&csv, t->varied[v].name, sweep_axis_parameter(&t->varied[v])->unit);
    }
    csv_heading(&csv, "status", "");
    for (int k = 0; k < COMPARE_QUANTITIES; k++) {
        csv_heading(&csv, compare_quantities[k].name, compare_quantities[k].unit);
    }

    csv_end_row(&csv);

    // rows
    for (int i = 0; i < t->count; i++) {
        const compare_row *row = &t->rows[i];
        csv_text(&csv, row->scenario);
        csv_text(&csv, row->law);
        for (int v = 0; v < t->varied_count; v++) {
            char text[PARAMETER_TEXT_SIZE];
            format_varied(t, i, v, text, sizeof text);
            csv_text(&csv, text);
        }
        csv_text(&csv, row->ok ? "ok" : "failed");
        for (int k = 0; k < COMPARE_QUANTITIES; k++) {
            csv_number(&csv, row->values[k]);
        }
        csv_end_row(&csv);
    }
}
