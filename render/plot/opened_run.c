#include "render/plot/opened_run.h"

#include <assert.h>
#include <glib.h>

// Keeps the first of a scenario's faults.
static void keep_first(void *context, const char *sentence)
{
    fault *f = context;
    if (f->code == STATUS_OK) {
        fault_set(f, STATUS_BAD_SCENARIO, "%s", sentence);
    }
}

void run_end(opened_run *r)
{
    run_finish(&r->result);
    scenario_finish(&r->scenario);
}

status run_begin(opened_run *r, const char *name, const char *change, fault *f)
{
    return run_begin_changed(r, name, &change, change != NULL ? 1 : 0, NULL, f);
}

status run_begin_changed(opened_run *r, const char *name, const char *const *changes, int count,
                         run_monitor *monitor, fault *f)
{
    assert(r != NULL && name != NULL);
    const run_options options = {.keep_trace = true, .monitor = monitor};
    fault first = {STATUS_OK, ""};
    status code = scenario_open(&r->scenario, name, keep_first, &first);
    if (code != STATUS_OK) {
        return fault_set(f, code, "%s", first.text);
    }

    // changes lie above what the file says
    if (count > 0) {
        code =
            scenario_override_all(&r->scenario, (char *const *)changes, count, keep_first, &first);
        fault_set(f, code, "%s", first.text);
    }

    // a run that fails takes its rows with it
    if (code == STATUS_OK) {
        code = run_scenario_with(&r->scenario, &options, &r->result);
        if (code == STATUS_OK) {
            return code;
        }
        fault_set(f, code, "%s: %s", name, r->result.summary.message);
        run_finish(&r->result);
    }

    // after any fault the caller has nothing to finish
    scenario_finish(&r->scenario);
    return code;
}

char *scenario_title(const scenario *s)
{
    assert(s != NULL && s->title != NULL);
    char changes[SCENARIO_CHANGES];
    GString *out = g_string_new(s->title);

    // lines break between changes, not within one
    for (const char *c = scenario_changes(s, changes); *c != '\0'; c++) {
        g_string_append(out, *c == ' ' && c[-1] != ',' ? "\u00a0" : (char[]){*c, '\0'});
    }
    return g_string_free(out, FALSE);
}

char *parameters_line(const scenario *s)
{
    assert(s != NULL);
    GString *out = g_string_new(NULL);
    g_string_printf(out, "scenario=%s", s->name);
    for (int i = 0; i < parameter_count; i++) {
        char value[128];
        parameter_format(&s->parameters, i, value, sizeof value);
        g_string_append_printf(out, " %s=%s", parameter_table[i].path, value);
    }
    return g_string_free(out, FALSE);
}
