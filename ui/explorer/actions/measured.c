// Actions on measured data: laid under the run, and an arm found that moves like it.
#include "ui/explorer/actions/actions.h"

#include <math.h>
#include <string.h>

#include "src/run/trace.h"
#include "src/study/identify.h"

// --- under the run ----------------------------------------------------------------------------

// The force by which two traces are aligned, -1 if none is in both.
static int common_force(const trace *a, const trace *b)
{
    static const int forces[] = {SIGNAL_INDEX(piezo_force), SIGNAL_INDEX(force_reading),
                                 SIGNAL_INDEX(force)};
    int found = -1;
    for (size_t i = 0; i < sizeof forces / sizeof forces[0]; i++) {
        found = trace_has(a, forces[i]) && trace_has(b, forces[i]) ? forces[i] : found;
    }
    return found;
}

// The first instant at which a signal is above a level [s], NaN if it never is.
static double first_above(const trace *t, int signal, double level)
{
    size_t r = 0;
    while (r < t->row_count && !(signal_value(&t->rows[r], signal) > level)) {
        r++;
    }
    return r < t->row_count ? t->rows[r].time : (double)NAN;
}

// Measured columns under the run, shifted as the file's name says, else to the run's first touch.
bool act_data(explorer_state *st, const char *argument)
{
    trace fresh = {0};
    csv_table table = {0};
    char path[LINE_TEXT];
    const char *at = strrchr(argument, '@');
    double shift = (double)NAN;
    FAIL_IF(argument[0] == '\0',
            act_refuse(st, "data takes a table with a column time, such as bench.csv, or off"));
    if (strcmp(argument, "off") == 0) {
        trace_finish(&st->measured);
        st->measured = (trace){0};
        return act_tell(st, "no measured data");
    }
    NEED(act_need_whole_run(st));
    NEED(at == NULL || act_read_number(st, at + 1, &shift));
    snprintf(path, sizeof path, "%.*s", at != NULL ? (int)(at - argument) : (int)strlen(argument),
             argument);
    trace_init(&fresh, 1);
    status code = csv_table_read(&table, path, 1, &st->fault);
    code = code == STATUS_OK ? measured_rows(&fresh, &table, NULL, -1, &st->fault) : code;
    csv_table_finish(&table);
    if (code != STATUS_OK) {
        trace_finish(&fresh);
        return act_worked(st, code);
    }

    // a tenth of the measured largest force marks the touch in both
    const trace *t = &st->session.run.trace;
    const int force = common_force(&fresh, t);
    if (isnan(shift) && force >= 0) {
        const double last = fresh.rows[fresh.row_count - 1].time;
        const double level = trace_statistics(&fresh, force, fresh.rows[0].time, last).maximum / 10;
        shift = first_above(t, force, level) - first_above(&fresh, force, level);
    }
    for (size_t r = 0; r < fresh.row_count && isfinite(shift); r++) {
        fresh.rows[r].time += shift;
    }
    trace_finish(&st->measured);
    st->measured = fresh;
    st->measured_id++;
    snprintf(st->measured_file, sizeof st->measured_file, "%s", path);
    return isfinite(shift)
               ? act_tell(st, "%zu rows, shifted by %.6g s; :data off takes them away",
                          fresh.row_count, shift)
               : act_warn(st, "%zu rows, as they are: no force in both that shows a touch",
                          fresh.row_count);
}

// --- identification ---------------------------------------------------------------------------

enum { FIT_STARTS = 4, FIT_THREADS = 4, FIT_RUNS = 400 };

// Says each value with its error, and what is not determined.
static bool tell_fit(explorer_state *st, const identification *id)
{
    char text[MESSAGE_TEXT / 2] = "";
    double most;
    const bool misfits = identify_misfit(id, &most) > most;
    for (int i = 0; i < id->count; i++) {
        const fitted_parameter *fit = &id->fit[i];
        const char *unit = sweep_axis_parameter(&fit->axis)->unit;
        text_add(text, sizeof text,
                 !fit->determined       ? "%s%s is not determined"
                 : identify_at_end(fit) ? "%s%s %.5g, at the end of its range"
                                        : "%s%s %.5g +- %.2g%s%s",
                 i > 0 ? "; " : "", strchr(fit->axis.name, '.') + 1, fit->value,
                 fit->standard_error, unit[0] ? " " : "", unit);
    }
    return act_tell(st, "%s%s", text,
                    id->undetermined > 0 ? ": fit fewer, or record more"
                    : misfits            ? "; pinned, but far off the data"
                    : id->white          ? "; that run is pinned"
                                         : "; pinned, but the data show more than the model has");
}

// Fits parameters to the measured data and pins the run that they give.
bool act_identify(explorer_state *st, const char *argument)
{
    char words[LINE_TEXT], *rest = words;
    identification id = {.base = &st->session.effective, .starts = FIT_STARTS, .jobs = FIT_THREADS};
    const sweep_axis *axes[IDENTIFY_PATHS];
    double values[IDENTIFY_PATHS];
    FAIL_IF(argument[0] == '\0' || st->measured.row_count == 0,
            act_refuse(st, argument[0] == '\0' ? "identify takes parameters, such as k2 stiction"
                                               : "there are no measured data: :data FILE.csv"));
    NEED(act_need_whole_run(st) && act_need_short_runs(st, "identify", FIT_RUNS));

    // a parameter may be given by the last part of its path
    fault *f = &st->fault;
    status code = identify_available(f);
    snprintf(words, sizeof words, "%s", argument);
    for (char *word; code == STATUS_OK && (word = strtok_r(rest, " ", &rest)) != NULL;) {
        char path[2 * LINE_TEXT];
        code = identify_add_path(&id, act_whole_path(word, path, sizeof path), f);
    }
    code = code == STATUS_OK ? identify_add_trace(&id, st->measured_file, NULL, 0, f) : code;
    code = code == STATUS_OK ? identify_fit(&id, f) : code;
    int count = 0;
    for (int i = 0; i < id.count && code == STATUS_OK; i++) {
        if (id.fit[i].determined) {
            axes[count] = &id.fit[i].axis;
            values[count++] = id.fit[i].value;
        }
    }
    if (code == STATUS_OK && count > 0) {
        code = act_pin_values(st, axes, values, count, "identified", f);
    }
    const bool done = act_worked(st, code) && tell_fit(st, &id), all = id.undetermined == 0;
    identify_finish(&id);
    return done && act_settle_baseline(st) && all;
}
