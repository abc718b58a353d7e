#include "ui/web/page.h"

#include <emscripten.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/json.h"
#include "src/base/text_stream.h"
#include "src/rig/rig.h"
#include "src/run/export.h"
#include "src/run/run.h"
#include "src/session/account.h"

static scenario opened;  // as its text says
static scenario changed; // with what was changed in the page
static bool is_opened, is_changed, is_run;
static run_result result; // of `changed`
static double deadline;   // of the run [ms of emscripten_get_now]
static char *answer;      // the text that was returned last
static double *column;    // the signal that was returned last

// --- answers ---------------------------------------------------------------------------

// Begins the text of an answer.
static bool begin_answer(text_stream *text)
{
    loss_forget();
    free(answer);
    answer = NULL;
    return text_stream_open(text);
}

// Returns a JSON value as text, and takes it over.
static const char *answer_json(json_t *value)
{
    text_stream text;
    if (begin_answer(&text)) {
        json_write(text.stream, value);
        answer = text_stream_close(&text, NULL);
    }
    json_decref(value);
    return answer;
}

// A fault_handler: adds the sentence to an array.
static void keep_sentence(void *sentences, const char *sentence)
{
    json_add(sentences, json_text(sentence));
}

// --- tables ----------------------------------------------------------------------------

// A row of the parameters' table.
static json_t *parameter_object(const parameter_info *info)
{
    const char *choices = "";
    if (info->type == PARAMETER_CHOICE) {
        choices = info->choices;
    }
    json_t *object =
        json_of("path:t unit:t choices:t about:t timed:b text:b", info->path, info->unit,
                choices, info->description, info->timed, parameter_is_text(info));
    json_put(object, "switch", json_boolean(info->type == PARAMETER_BOOLEAN));
    json_put(object, "whole", json_boolean(info->type == PARAMETER_INTEGER));
    return object;
}

EMSCRIPTEN_KEEPALIVE const char *page_tables(void)
{
    json_t *parameters = json_array(), *signals = json_array(), *numbers = json_array();
    for (int i = 0; i < parameter_count; i++) {
        json_add(parameters, parameter_object(&parameter_table[i]));
    }
    for (int i = 0; i < signal_count; i++) {
        const signal_info *info = &signal_table[i];
        json_add(signals, json_of("name:t unit:t about:t", info->name, info->unit,
                                  info->description));
    }
    for (int i = 0; i < summary_count; i++) {
        const summary_info *info = &summary_table[i];
        json_add(numbers, json_of("key:t label:t unit:t about:t", info->key, info->label,
                                  info->unit, info->description));
    }
    return answer_json(
        json_of("parameters:o signals:o numbers:o", parameters, signals, numbers));
}

// --- the scenario ----------------------------------------------------------------------

// The range of a number's slider.
static json_t *slider_object(const char *path, double low, double high, bool logarithmic)
{
    return json_of("path:t low:n high:n logarithmic:b", path, low, high, logarithmic);
}

// The numbers of a law that are its own, each control.settings.NAME, with their sliders,
// and the paths of those that it shares.
static json_t *law_object(const parameters *p)
{
    const controller *law = controller_of(p->control.law);
    json_t *settings = json_array(), *shared = json_array();
    for (int i = 0; law != NULL && i < law->parameter_count; i++) {
        const controller_parameter *row = &law->parameters[i];
        char path[ACTION_PATH];
        snprintf(path, sizeof path, "control.%s", row->name);
        if (parameter_find(path) >= 0) {
            json_add(shared, json_text(path));
            continue;
        }
        json_add(settings, json_of("name:t unit:t about:t initial:n minimum:n maximum:n",
                                   row->name, row->unit, row->description, row->initial,
                                   row->minimum, row->maximum));
    }
    return json_of("settings:o shared:o", settings, shared);
}

// What the changed scenario is: its values, which of them were given, and sliders for
// them.
static json_t *scenario_object(const scenario *s)
{
    const parameters *p = &s->parameters;
    char title[SCENARIO_TITLED];
    json_t *given = json_array(), *sliders = json_array(), *panes = json_array();
    for (int i = 0; i < parameter_count; i++) {
        const char *path = parameter_table[i].path;
        double low, high;
        bool logarithmic;
        if (p->set[i] != 0) {
            json_add(given, json_text(path));
        }
        if (parameter_usual_range(i, parameter_get(p, i), &low, &high, &logarithmic)) {
            json_add(sliders, slider_object(path, low, high, logarithmic));
        }
    }
    for (int i = 0; i < s->pane_count; i++) {
        json_add(panes, json_text(signal_table[s->panes[i]].name));
    }

    return json_of("title:t description:t panes:o values:o given:o sliders:o law:o "
                   "without_effect:o",
                   scenario_titled(s, title), s->description, panes, export_parameters(p),
                   given, sliders, law_object(p), export_without_effect(s));
}

static void forget_run(void)
{
    if (is_run) {
        run_finish(&result);
    }
    is_run = false;
}

static void forget_changes(void)
{
    forget_run();
    if (is_changed) {
        scenario_finish(&changed);
    }
    is_changed = false;
}

// Gives the scenario that was read these values, "PATH=VALUE" each; faults go to an
// array.
static status change(char *const *assignments, int count, json_t *faults)
{
    forget_changes();
    const status copied = scenario_copy(&changed, &opened);
    if (copied != STATUS_OK) {
        return copied;
    }
    is_changed = true;
    const status code =
        scenario_override_all(&changed, assignments, count, keep_sentence, faults);
    if (code != STATUS_OK) {
        forget_changes();
    }
    return code;
}

// What a call that changes the scenario answers: what was wrong, or what it is.
static const char *answer_scenario(status code, json_t *faults, int line)
{
    if (code == STATUS_OK) {
        json_decref(faults);
        return answer_json(scenario_object(&changed));
    }

    // what was not found in the text is a fault, too
    if (json_array_size(faults) == 0) {
        json_add(faults, json_text(status_text(code)));
    }
    return answer_json(json_of("faults:o line:i", faults, line));
}

EMSCRIPTEN_KEEPALIVE const char *page_read(const char *name, const char *text)
{
    // what was there before is gone, even if this one has faults
    forget_changes();
    if (is_opened) {
        scenario_finish(&opened);
    }
    json_t *faults = json_array();
    status code =
        scenario_parse(&opened, text, strlen(text), name, name, keep_sentence, faults);
    is_opened = code == STATUS_OK;

    const int line = opened.refused.line;
    if (is_opened) {
        code = change(NULL, 0, faults);
    }
    return answer_scenario(code, faults, line);
}

EMSCRIPTEN_KEEPALIVE const char *page_change(const char *assignments)
{
    // its lines, of which there are no more than bytes
    char *lines = strdup(assignments);
    char **each = calloc(strlen(assignments) + 1, sizeof *each);
    const bool have_memory = lines != NULL && each != NULL;
    int count = 0;
    for (char *line = have_memory ? strtok(lines, "\n") : NULL; line != NULL;
         line = strtok(NULL, "\n")) {
        each[count++] = line;
    }

    json_t *faults = json_array();
    status code = STATUS_NO_MEMORY;
    if (is_opened && have_memory) {
        code = change(each, count, faults);
    }
    free(lines);
    free(each);
    return answer_scenario(code, faults, 0);
}

// What is handed out as a text of its own kind, not JSON.
static void write_scenario(FILE *stream)
{
    scenario_write(stream, &changed);
}

static void write_rows(FILE *stream)
{
    export_csv(stream, &changed, &result.trace);
}

static const char *answer_text(void (*write)(FILE *stream), bool there)
{
    text_stream text;
    if (begin_answer(&text)) {
        if (there) {
            write(text.stream);
        }
        answer = text_stream_close(&text, NULL);
    }
    return answer;
}

EMSCRIPTEN_KEEPALIVE const char *page_yaml(void)
{
    return answer_text(write_scenario, is_changed);
}

EMSCRIPTEN_KEEPALIVE const char *page_csv(void)
{
    return answer_text(write_rows, is_run);
}

// --- the run ---------------------------------------------------------------------------

// A question of a run: whether its time is over.
static int is_late(void *context)
{
    (void)context;
    return emscripten_get_now() > deadline;
}

EMSCRIPTEN_KEEPALIVE const char *page_run(double seconds, int with_rows)
{
    forget_run();
    if (!is_changed) {
        return answer_text(NULL, false);
    }
    const run_options options = {.keep_trace = with_rows != 0, .ask = is_late};
    deadline = emscripten_get_now() + 1e3 * seconds;
    run_scenario_with(&changed, &options, &result);
    is_run = true;
    return answer_json(export_run(&changed, &result));
}

EMSCRIPTEN_KEEPALIVE const char *page_predictions(void)
{
    prediction_answer answers[PREDICTOR_COUNT];
    const sample *row = NULL;
    if (is_run) {
        row = predict_first_contact(&changed, &result, NULL, answers);
    }
    if (row == NULL) {
        return answer_json(json_null());
    }
    return answer_json(export_predictions(&changed, &result, row, answers));
}

EMSCRIPTEN_KEEPALIVE const char *page_account(void)
{
    char line[ACCOUNT_SENTENCE] = "", sentences[ACCOUNT_SENTENCES][ACCOUNT_SENTENCE];
    json_t *array = json_array();
    int count = 0;
    if (result.trace.row_count > 0) {
        run_account_line(&result, line);
        count = run_account(&changed, &result, sentences);
    }
    for (int i = 0; i < count; i++) {
        json_add(array, json_text(sentences[i]));
    }
    return answer_json(json_of("line:t sentences:o", line, array));
}

EMSCRIPTEN_KEEPALIVE int page_rows(void)
{
    return (int)result.trace.row_count;
}

EMSCRIPTEN_KEEPALIVE int page_freedoms(void)
{
    return result.trace.angle_count;
}

EMSCRIPTEN_KEEPALIVE const double *page_angles(void)
{
    return result.trace.angles;
}

EMSCRIPTEN_KEEPALIVE const double *page_signal(const char *name)
{
    const int index = signal_find(name);
    const size_t rows = result.trace.row_count;
    double *room = realloc(column, rows * sizeof *room + 1);
    if (room == NULL || index < 0) {
        return NULL;
    }

    column = room;
    for (size_t i = 0; i < rows; i++) {
        const char *row = (const char *)&result.trace.rows[i];
        memcpy(&column[i], row + signal_table[index].offset, sizeof column[i]);
    }
    return column;
}
