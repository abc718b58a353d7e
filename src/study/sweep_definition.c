#include "src/study/sweep_definition.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/numbers.h"
#include "src/base/text_stream.h"
#include "src/base/shipped.h"
#include "src/scenario/outside.h"

// What comes before the path of a parameter in the key of what it names outside.
static const char content_of[] = "content of ";
static const char untold[] = "cannot be told"; // in place of a digest

void definition_add(definition *d, const char *key, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    char *value = decimal_vtext(format, list);
    va_end(list);

    // a name of a file need not be UTF-8
    json_t *text = value != NULL ? json_stringn_nocheck(value, strlen(value)) : NULL;
    if (json_object_set_new_nocheck(d->lines, key, text) != 0) {
        d->code = STATUS_NO_MEMORY;
    }
    free(value);
}

static bool is_varied(const sweep *s, int parameter)
{
    for (int i = 0; i < s->axis_count; i++) {
        if (s->axes[i].parameter == parameter && s->axes[i].element == 0 &&
            sweep_axis_parameter(&s->axes[i]) == &parameter_table[parameter]) {
            return true;
        }
    }
    return false;
}

// Parameters that keep their value, and which of them were given (the others follow
// arm.model).
static void define_parameters(definition *d, const sweep *s)
{
    const parameters *p = &s->base->parameters;
    char given[4096] = "";
    for (int i = 0; i < parameter_count; i++) {
        char text[128];
        if (is_varied(s, i)) {
            continue;
        }

        // its value, and that it was given
        parameter_format(p, i, text, sizeof text);
        definition_add(d, parameter_table[i].path, "%s", text);
        if (p->set[i]) {
            size_t length = strlen(given);
            snprintf(given + length, sizeof given - length, "%s%s", length > 0 ? " " : "",
                     parameter_table[i].path);
        }
    }
    definition_add(d, "given", "%s", given);
}

// The script in one line.
static void define_script(definition *d, const scenario *s)
{
    text_stream line;
    if (!text_stream_open(&line)) {
        d->code = STATUS_NO_MEMORY;
        return;
    }

    // action by action, in their order
    for (int i = 0; i < s->action_count; i++) {
        const action *a = &s->actions[i];
        bool push = a->kind == ACTION_PUSH;
        char time[NUMBER_TEXT], value[NUMBER_TEXT];
        number_format(time, a->time);
        number_format(value, a->value);
        char path[ACTION_PATH];
        const char *what = "push", *to = value;
        if (!push) {
            what = action_path(a, path);
        }
        if (!push && action_is_text(a)) {
            to = a->text;
        }
        fprintf(line.stream, "%sat %s %s = %s", i > 0 ? "; " : "", time, what, to);
    }

    // closing it shows whether there was memory
    char *text = text_stream_close(&line, NULL);
    if (text != NULL) {
        definition_add(d, "script", "%s", text);
    } else {
        d->code = STATUS_NO_MEMORY;
    }
    free(text);
}

// The sources that any run of the sweep reads from outside, as bits. The parameter that
// chooses whether a source is read may be varied: its values then decide, not the
// scenario's.
static unsigned read_outside(const sweep *s)
{
    unsigned sources = outside_read(&s->base->parameters);
    for (int i = 0; i < outside_count; i++) {
        const outside_source *source = &outside_table[i];
        const unsigned bit = 1U << i;
        for (int k = 0; k < s->axis_count; k++) {
            const sweep_axis *axis = &s->axes[k];
            if (axis->parameter != parameter_at(source->chooser)) {
                continue;
            }
            sources &= ~bit;
            for (size_t v = 0; v < axis->count; v++) {
                if (sweep_axis_value(axis, v) == source->choice) {
                    sources |= bit;
                }
            }
        }
    }
    return sources;
}

// Adds the digest of every file or program outside the scenario that the sweep reads.
static void define_outside(definition *d, const sweep *s, fault *f)
{
    const unsigned sources = read_outside(s);
    for (int i = 0; i < outside_count && d->code == STATUS_OK; i++) {
        const outside_source *source = &outside_table[i];
        const parameters *p = &s->base->parameters;
        char key[DEFINITION_KEY], digest[SHA256_TEXT];
        if ((sources >> i & 1) == 0) {
            continue;
        }
        snprintf(key, sizeof key, "%s%s", content_of,
                 parameter_table[parameter_at(source->parameter)].path);
        const bool told = outside_is_told(source, p);
        if (told) {
            d->code = outside_digest(source, p, digest, f);
        } else {
            d->code = STATUS_OK;
        }
        if (d->code == STATUS_OK) {
            definition_add(d, key, "%s", told ? digest : untold);
        }
    }
}

void definition_stamp(const sweep *s, char stamp[SHA256_TEXT])
{
    outside_stamp(read_outside(s), &s->base->parameters, stamp);
}

status definition_init(definition *d, const sweep *s, fault *f)
{
    *d = (definition){.lines = json_object()};

    // what is varied, and how
    definition_add(d, "version", "%s", lab_version());
    definition_add(d, "scenario", "%s", s->base->name);
    definition_add(d, "sample", "%s", sweep_sampling_name(s->sampling));
    definition_add(d, "runs", "%zu", s->run_count);
    if (s->sampling != SWEEP_GRID) {
        definition_add(d, "seed", "%llu", (unsigned long long)s->seed);
    }
    for (int i = 0; i < s->axis_count; i++) {
        char key[16];
        snprintf(key, sizeof key, "vary %d", i + 1);
        definition_add(d, key, "%s%s=%s", s->axes[i].together ? "with " : "",
                       s->axes[i].name, s->axes[i].text);
    }

    if (s->chosen_by != NULL) {
        definition_add(d, "chosen by", "%s", s->chosen_by);
    }

    // what stays
    define_script(d, s->base);
    define_parameters(d, s);
    define_outside(d, s, f);
    if (d->code == STATUS_NO_MEMORY) {
        return fault_no_memory(f);
    }
    return d->code;
}

void definition_finish(definition *d)
{
    json_decref(d->lines);
    d->lines = NULL;
}

const char *definition_value(const definition *d, const char *key)
{
    return json_string_value(json_object_get(d->lines, key));
}

// The whole number that a line holds. False if it is none, or too large.
static bool definition_number(const definition *d, const char *key,
                              unsigned long long *number)
{
    const char *text = definition_value(d, key);
    const size_t length = text != NULL ? strspn(text, "0123456789") : 0;
    errno = 0;
    if (length > 0) {
        *number = strtoull(text, NULL, 10);
    } else {
        *number = 0;
    }
    return length > 0 && text[length] == '\0' && errno == 0;
}

status definition_plan(const definition *d, const char *path, sweep *plan, fault *f)
{
    char *vary[SWEEP_MOST_AXES];
    const char *sample = definition_value(d, "sample");
    unsigned long long runs = 0, seed = 0;
    fault why = {.text = "it does not say how its values are combined"};
    const int sampling = sample != NULL ? sweep_sampling_find(sample) : -1;
    sweep_request request = {.vary = vary, .sampling = (sweep_sampling)sampling};
    *plan = (sweep){.axis_count = 0};

    // how the values are combined, and of how many runs
    const bool drawn = sampling != SWEEP_GRID;
    bool good = sampling >= 0;
    if (good && (!definition_number(d, "runs", &runs) ||
                 (drawn && !definition_number(d, "seed", &seed)))) {
        snprintf(why.text, sizeof why.text,
                 "it does not say how many runs its sweep has");
        good = false;
    }

    // what is varied: lines "vary 1" = "PATH=..."
    for (char key[20]; request.vary_count < SWEEP_MOST_AXES; request.vary_count++) {
        snprintf(key, sizeof key, "vary %d", request.vary_count + 1);
        const char *line = definition_value(d, key);
        if (line == NULL) {
            break;
        }
        vary[request.vary_count] = (char *)line; // is only read
    }
    if (drawn) {
        request.runs = (size_t)runs;
    } else {
        request.runs = 0;
    }
    request.seed = seed;
    status code = STATUS_BAD_ARGUMENT;
    if (good) {
        code = sweep_plan(plan, &request, &why);
    }
    if (code == STATUS_OK && plan->run_count != runs) {
        snprintf(why.text, sizeof why.text,
                 "it says that it has %llu runs, but its values make %zu", runs,
                 plan->run_count);
        sweep_finish(plan);
        code = STATUS_BAD_ARGUMENT;
    }
    if (code == STATUS_OK) {
        return STATUS_OK;
    }
    if (code == STATUS_NO_MEMORY) {
        return fault_no_memory(f);
    }
    return fault_set(f, code,
                     "'%.200s' holds no sweep that this version can make: %.700s", path,
                     why.text);
}

// A line's value as a sentence has it.
static const char *value_in_words(const char *value)
{
    if (value == NULL) {
        return "not there";
    }
    if (value[0] == '\0') {
        return "empty";
    }
    return value;
}

// Adds one difference to the sentence; beyond the first few they are only counted.
static void append_difference(char *text, size_t size, int *count, const char *key,
                              const char *was, const char *now)
{
    enum { SHOWN = 4 };
    size_t length = strlen(text);

    if (++*count > SHOWN) {
        return;
    }
    const char *separator = *count > 1 ? "; " : "";

    // a digest says nothing to people
    if (strncmp(key, content_of, strlen(content_of)) == 0) {
        const char *differs = "is another one";
        if (now != NULL && strcmp(now, untold) == 0) {
            differs = "may be another one, it cannot be told";
        }
        snprintf(text + length, size - length, "%sthe %s %s", separator, key, differs);
        return;
    }

    // named as the user gives it: an axis is an option
    const char *dashes = strncmp(key, "vary", 4) == 0 ? "--" : "";
    snprintf(text + length, size - length, "%s%s%s was %.80s, now it is %.80s", separator,
             dashes, key, value_in_words(was), value_in_words(now));
}

status definition_compare(const char *path, const definition *was, const definition *now,
                          fault *f)
{
    char text[900] = "";
    const char *key;
    json_t *line;
    int count = 0;

    // what is new or another value
    json_object_foreach(now->lines, key, line)
    {
        const char *before = definition_value(was, key), *value = json_string_value(line);
        // the same scenario may have another name (a file seen from another folder), and
        // which parameters were given is worth saying only if all values are the same
        const bool aside =
            strcmp(key, "scenario") == 0 || (count > 0 && strcmp(key, "given") == 0);
        const bool same = before != NULL && strcmp(before, value) == 0;
        if (!aside && (!same || strcmp(before, untold) == 0)) {
            append_difference(text, sizeof text, &count, key, before, value);
        }
    }

    // what is gone
    json_object_foreach(was->lines, key, line)
    {
        if (definition_value(now, key) == NULL) {
            append_difference(text, sizeof text, &count, key, json_string_value(line),
                              NULL);
        }
    }
    if (count == 0) {
        return STATUS_OK;
    }
    return fault_set(f, STATUS_BAD_ARGUMENT, "'%.200s' holds another sweep: %s%s", path,
                     text, count > 4 ? "; and more" : "");
}
