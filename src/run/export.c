#include "src/run/export.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const char *lab_version(void)
{
    return IMPACTLAB_VERSION;
}

void number_format(char *text, double value)
{
    if (!isfinite(value)) {
        snprintf(text, NUMBER_TEXT, "%s", isnan(value) ? "nan" : value > 0 ? "inf" : "-inf");
        return;
    }
    // the sign of a zero says nothing to a reader
    value = value == 0 ? 0 : value;
    for (int digits = 15; digits <= 17; digits++) {
        snprintf(text, NUMBER_TEXT, "%.*g", digits, value);
        if (digits == 17 || strtod(text, NULL) == value) {
            return;
        }
    }
}

json_t *json_number(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

json_t *json_text(const char *text)
{
    json_t *string = json_string(text);
    char *copy = string == NULL ? strdup(text) : NULL;
    // a file's name may be no UTF-8, which JSON cannot hold
    for (char *c = copy; c != NULL && *c != '\0'; c++) {
        *c = (unsigned char)*c < 0x80 ? *c : '?';
    }
    if (copy != NULL) {
        string = json_string(copy);
        free(copy);
    }
    return string;
}

static void write_string(FILE *stream, const char *text)
{
    json_t *string = json_text(text);
    if (string != NULL) {
        json_dumpf(string, stream, JSON_ENCODE_ANY);
    }
    json_decref(string);
}

static void write_indented(FILE *stream, const json_t *value, int depth);

static void new_line(FILE *stream, int depth)
{
    fprintf(stream, "\n%*s", 2 * depth, "");
}

static void write_object(FILE *stream, const json_t *object, int depth)
{
    const char *key, *separator = "";
    json_t *member;
    fputc('{', stream);
    json_object_foreach((json_t *)object, key, member)
    {
        fputs(separator, stream);
        new_line(stream, depth + 1);
        write_string(stream, key);
        fputs(": ", stream);
        write_indented(stream, member, depth + 1);
        separator = ",";
    }
    if (separator[0] != '\0') {
        new_line(stream, depth);
    }
    fputc('}', stream);
}

// An array of plain values stands on one line.
static void write_array(FILE *stream, const json_t *array, int depth)
{
    size_t length = json_array_size(array);
    bool nested = false;
    fputc('[', stream);
    for (size_t i = 0; i < length; i++) {
        const json_t *element = json_array_get(array, i);
        nested = json_is_object(element) || json_is_array(element);
        if (i > 0) {
            fputs(nested ? "," : ", ", stream);
        }
        if (nested) {
            new_line(stream, depth + 1);
        }
        write_indented(stream, element, depth + 1);
    }
    if (nested) {
        new_line(stream, depth);
    }
    fputc(']', stream);
}

static void write_indented(FILE *stream, const json_t *value, int depth)
{
    char text[NUMBER_TEXT];
    switch (json_typeof(value)) {
    case JSON_OBJECT:
        write_object(stream, value, depth);
        break;
    case JSON_ARRAY:
        write_array(stream, value, depth);
        break;
    case JSON_STRING:
        write_string(stream, json_string_value(value));
        break;
    case JSON_REAL:
    case JSON_INTEGER:
        number_format(text, json_number_value(value));
        fputs(text, stream);
        break;
    case JSON_TRUE:
        fputs("true", stream);
        break;
    case JSON_FALSE:
        fputs("false", stream);
        break;
    case JSON_NULL:
        fputs("null", stream);
        break;
    }
}

void json_write(FILE *stream, const json_t *value)
{
    write_indented(stream, value, 0);
    fputc('\n', stream);
}

static json_t *parameter_value(const parameters *p, int index)
{
    char text[128];
    switch (parameter_table[index].type) {
    case PARAMETER_CHOICE:
    case PARAMETER_TEXT:
        parameter_format(p, index, text, sizeof text);
        return json_text(text);
    case PARAMETER_BOOLEAN:
        return json_boolean(parameter_get(p, index) != 0);
    case PARAMETER_INTEGER:
    case PARAMETER_REAL:
        break;
    }
    return json_number(parameter_get(p, index));
}

static json_t *parameters_object(const parameters *p)
{
    json_t *object = json_object();
    for (int i = 0; i < parameter_count; i++) {
        json_object_set_new(object, parameter_table[i].path, parameter_value(p, i));
    }
    return object;
}

static json_t *expectations_array(const scenario *s, const run_result *result)
{
    json_t *array = json_array();
    for (int i = 0; i < s->expectation_count; i++) {
        const expectation *e = &s->expectations[i];
        double value = (double)NAN;
        bool known = summary_get(&result->summary, e->quantity, &value);
        bool met = known && (e->is_null ? isnan(value) : fabs(value - e->value) <= e->tolerance);
        json_t *object = json_object();
        json_object_set_new(object, "quantity", json_string(e->quantity));
        json_object_set_new(object, "expected", e->is_null ? json_null() : json_number(e->value));
        json_object_set_new(object, "tolerance",
                            e->is_null ? json_null() : json_number(e->tolerance));
        json_object_set_new(object, "value", json_number(value));
        json_object_set_new(object, "met", json_boolean(met));
        json_array_append_new(array, object);
    }
    return array;
}

static json_t *event_object(const scenario *s, const event *e)
{
    json_t *object = json_object();
    json_object_set_new(object, "t_s", json_number(e->time));
    json_object_set_new(object, "kind", json_string(event_name(e->kind)));
    if (e->kind == EVENT_IMPACT || e->kind == EVENT_PUSH) {
        json_object_set_new(object, "impulse_Ns", json_number(e->impulse));
    }
    if (e->kind == EVENT_IMPACT) {
        json_object_set_new(object, "speed_m_s", json_number(e->speed));
        json_object_set_new(object, "loss_J", json_number(e->loss));
    }
    if (e->kind == EVENT_CHANGE && e->index >= 0 && e->index < s->action_count) {
        const action *a = &s->actions[e->index];
        json_object_set_new(object, "parameter", json_string(parameter_table[a->parameter].path));
        bool text = parameter_table[a->parameter].type == PARAMETER_TEXT;
        json_object_set_new(object, "value", text ? json_text(a->text) : json_number(a->value));
    }
    return object;
}

static json_t *events_array(const scenario *s, const trace *t)
{
    json_t *array = json_array();
    for (size_t i = 0; i < t->event_count; i++) {
        json_array_append_new(array, event_object(s, &t->events[i]));
    }
    return array;
}

json_t *export_run(const scenario *s, const run_result *result)
{
    const summary *m = &result->summary;
    json_t *object = json_object();
    if (object == NULL) {
        return NULL;
    }
    json_object_set_new(object, "scenario", json_text(s->name));
    json_object_set_new(object, "version", json_string(lab_version()));
    json_object_set_new(object, "status", json_string(m->status == STATUS_OK ? "ok" : "failed"));
    json_object_set_new(object, "message", json_text(m->message));
    json_object_set_new(object, "method_used", json_text(m->method));
    json_object_set_new(object, "parameters", parameters_object(&s->parameters));
    for (int i = 0; i < summary_count; i++) {
        double value = (double)NAN;
        summary_get(m, summary_table[i].key, &value);
        json_object_set_new(object, summary_table[i].key, json_number(value));
    }
    if (s->expectation_count > 0) {
        json_object_set_new(object, "expectations", expectations_array(s, result));
    }
    json_object_set_new(object, "events", events_array(s, &result->trace));
    return object;
}

// Indices of the signals that have a column; returns how many those are.
static int csv_signals(const trace *t, int *columns)
{
    int count = 0;
    for (int i = 0; i < signal_count; i++) {
        if (!signal_table[i].optional || trace_has(t, i)) {
            columns[count++] = i;
        }
    }
    return count;
}

static void csv_header(FILE *stream, const trace *t, const int *columns, int count, bool angles)
{
    for (int i = 0; i < count; i++) {
        const signal_info *signal = &signal_table[columns[i]];
        fprintf(stream, "%s%s[%s]", i > 0 ? "," : "", signal->name, signal->unit);
    }
    for (int i = 0; angles && i < t->angle_count; i++) {
        fprintf(stream, ",angle_%d[rad]", i + 1);
    }
    fputc('\n', stream);
}

void export_csv(FILE *stream, const trace *t, int links)
{
    char text[NUMBER_TEXT];
    int columns[SIGNALS_AT_MOST], count = csv_signals(t, columns);
    bool angles = links > 2;
    csv_header(stream, t, columns, count, angles);
    for (size_t row = 0; row < t->row_count && !ferror(stream); row++) {
        for (int i = 0; i < count; i++) {
            number_format(text, signal_value(&t->rows[row], columns[i]));
            if (i > 0) {
                fputc(',', stream);
            }
            fputs(text, stream);
        }
        for (int i = 0; angles && i < t->angle_count; i++) {
            number_format(text, t->angles[row * (size_t)t->angle_count + (size_t)i]);
            fprintf(stream, ",%s", text);
        }
        fputc('\n', stream);
    }
}
