#include "src/run/export.h"

#include <math.h>

#include "src/base/json.h"
#include "src/base/shipped.h"
#include "src/base/text_stream.h"
#include "src/scenario/effect.h"
#include "src/tables/settings.h"

// The value of a parameter in JSON: numbers and lists of numbers as such, booleans as
// such, choices and texts as a scenario file would have them.
static json_t *parameter_value(const parameters *p, int index)
{
    const parameter_info *info = &parameter_table[index];
    if (info->type == PARAMETER_LIST) {
        double numbers[PARAMETER_LIST_MOST];
        return json_numbers(numbers, parameter_get_list(p, index, numbers));
    }
    if (info->type != PARAMETER_CHOICE && !parameter_is_text(info)) {
        const double value = parameter_get(p, index);
        if (info->type == PARAMETER_BOOLEAN) {
            return json_boolean(value != 0);
        }
        return json_number(value);
    }

    // words and texts as a scenario file would have them
    char text[PARAMETER_VALUE_SIZE];
    parameter_format(p, index, text, sizeof text);
    return json_text(text);
}

json_t *export_parameters(const parameters *p)
{
    json_t *object = json_object();
    for (int i = 0; i < parameter_count; i++) {
        json_put(object, parameter_table[i].path, parameter_value(p, i));
    }

    // each number of control.settings by its path, too
    const char *rest = p->control.settings;
    setting s;
    while (settings_next(&rest, &s)) {
        char path[ACTION_PATH];
        double value;
        snprintf(path, sizeof path, "%s.%s", setting_info.path, s.name);
        if (setting_number(&s, &value)) {
            json_put(object, path, json_number(value));
        }
    }
    return object;
}

// The expectations of the scenario in JSON, each with the value that the run came to and
// whether it meets the expectation.
static json_t *expectations_array(const scenario *s, const run_result *result)
{
    json_t *array = json_array();
    for (int i = 0; i < s->expectation_count; i++) {
        const expectation *e = &s->expectations[i];
        double value = summary_value(&result->summary, e->quantity);

        json_t *object =
            json_of("quantity:t expected:n tolerance:n value:n met:b",
                    summary_table[e->quantity].key, e->is_null ? (double)NAN : e->value,
                    e->is_null ? (double)NAN : e->tolerance, value,
                    expectation_is_met(e, value));

        json_add(array, object);
    }
    return array;
}

// An event in JSON: time and kind, and what only some kinds have, such as the impulse of
// an impact or the parameter that an action changed.
static json_t *event_object(const scenario *s, const event *e)
{
    json_t *object = json_of("t_s:n kind:t", e->time, event_name(e->kind));

    // impacts and pushes
    if (e->kind == EVENT_IMPACT || e->kind == EVENT_PUSH) {
        json_put(object, "impulse_Ns", json_number(e->impulse));
    }
    if (e->kind == EVENT_IMPACT) {
        json_members(object, "speed_m_s:n loss_J:n", e->speed, e->loss);
    }

    // changes that the script made
    if (e->kind == EVENT_CHANGE && e->index >= 0 && e->index < s->action_count) {
        const action *a = &s->actions[e->index];
        char path[ACTION_PATH];
        json_put(object, "parameter", json_text(action_path(a, path)));
        json_put(object, "value",
                 action_is_text(a) ? json_text(a->text) : json_number(a->value));
    }
    return object;
}

json_t *export_without_effect(const scenario *s)
{
    json_t *array = json_array();
    idle_value idle;
    for (int place = 0; effect_next_idle(s, &place, &idle);) {
        json_add(array, json_of("path:t why:t", idle.path, idle.why));
    }
    return array;
}

json_t *export_run(const scenario *s, const run_result *result)
{
    const summary *m = &result->summary;
    json_t *object = json_object();

    // which run, and how it went
    json_members(object, "scenario:t version:t status:t message:t method_used:t", s->name,
                 lab_version(), summary_status(m), m->message, m->method);

    // what went in and what came out
    json_put(object, "parameters", export_parameters(&s->parameters));
    json_put(object, "without_effect", export_without_effect(s));
    for (int i = 0; i < summary_count; i++) {
        json_put(object, summary_table[i].key, json_number(summary_value(m, i)));
    }
    if (s->expectation_count > 0) {
        json_put(object, "expectations", expectations_array(s, result));
    }
    json_t *events = json_array();
    for (size_t i = 0; i < result->trace.event_count; i++) {
        json_add(events, event_object(s, &result->trace.events[i]));
    }
    json_put(object, "events", events);
    return object;
}

// What one predictor says.
static json_t *prediction_object(const prediction_answer *answer)
{
    const prediction *p = &answer->prediction;

    // a predictor that has no answer says why
    const char *message;
    json_t *holds;
    if (prediction_known(answer)) {
        message = answer->note;
        holds = json_boolean(p->holds);
    } else {
        message = prediction_reason(answer);
        holds = json_null();
    }

    return json_of("method:t message:t holds:o peak_N:n time_to_peak_s:n impulse_Ns:n "
                   "equivalent_restitution:n inductance_changes_peak_N:n",
                   answer->name, message, holds, p->force, p->delay, p->impulse,
                   p->restitution, p->inductance);
}

json_t *export_predictions(const scenario *s, const run_result *result, const sample *row,
                           const prediction_answer answers[PREDICTOR_COUNT])
{
    const landing *simulated = &result->landing;

    // one entry each, even where a predictor has no answer
    json_t *predictions = json_array();
    for (int i = 0; i < PREDICTOR_COUNT; i++) {
        json_add(predictions, prediction_object(&answers[i]));
    }
    json_t *simulation =
        json_of("peak_N:n time_to_peak_s:n impulse_Ns:n", simulated->peak,
                simulated->time_to_peak, simulated->impulse);
    return json_of("scenario:t t_s:n predictions:o simulation:o", s->name, row->time,
                   predictions, simulation);
}

// --- CSV -------------------------------------------------------------------------------

csv_writer export_csv_begin(FILE *stream, const run_columns *columns)
{
    csv_writer csv = csv_begin(stream);
    for (int i = 0; i < columns->count; i++) {
        csv_heading(&csv, columns->all[i].name, columns->all[i].unit);
    }
    csv_end_row(&csv);
    return csv;
}

void export_csv_row(csv_writer *csv, const run_columns *columns, const sample *row,
                    const double *angles)
{
    for (int i = 0; i < columns->count; i++) {
        csv_number(csv, run_column_value(&columns->all[i], row, angles));
    }
    csv_end_row(csv);
}

void export_csv(FILE *stream, const scenario *s, const trace *t)
{
    SCOPED(run_columns_finish) run_columns columns;
    const status code = run_columns_init(&columns, s, NULL, NULL);
    loss_unless(code == STATUS_OK);
    if (code != STATUS_OK) {
        return;
    }

    // writing ends with the first error, which the stream keeps
    csv_writer csv = export_csv_begin(stream, &columns);
    for (size_t r = 0; r < t->row_count && !ferror(stream); r++) {
        export_csv_row(&csv, &columns, &t->rows[r],
                       t->angles + r * (size_t)t->angle_count);
    }
}
