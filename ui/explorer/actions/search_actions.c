// Actions that search through many runs: the limit of a value for a condition, parameters
// that fit measured data. A thread goes through them, and the lab goes on meanwhile.
#include "ui/explorer/actions/actions.h"

#include <math.h>
#include <string.h>

#include <glib.h>

#include "src/study/identify/identify.h"
#include "src/study/solve.h"

enum { SOLVE_THREADS = 4, FIT_STARTS = 12, FIT_THREADS = 4 };

// A search, with the run that it is about as that was when it began.
struct run_search {
    GThread *thread;
    int done;            // set when the results are there
    int shown;           // runs when the status was drawn last
    run_monitor monitor; // how many runs are over; that it is to end
    bool fits;           // it fits parameters, else it locates a limit
    char words[2 * LINE_TEXT];
    char condition_text[LINE_TEXT];
    char file[LINE_TEXT]; // of the measured data
    scenario base;
    run_origin from;

    // what comes out
    status code;
    fault fault;
    sweep_axis axis;
    solve_condition condition;
    solution found;
    identification id;
};

// --- the thread ------------------------------------------------------------------------

// Locates the limits of the parameter in words (PATH or PATH=A:B) for the condition.
static status locate(run_search *r, fault *f)
{
    TRY(solve_condition_read(r->condition_text, &r->condition, f));
    TRY(solve_axis_read(&r->axis, r->words, &r->base, f));
    return solve(&r->base, &r->axis, &r->condition, SOLVE_POINTS, SOLVE_THREADS,
                 &r->monitor, &r->found, f);
}

// Fits the parameters in words to the measured data.
static status fit(run_search *r, fault *f)
{
    TRY(identify_available(f));
    char *rest = r->words, *word;
    while ((word = strtok_r(rest, " ", &rest)) != NULL) {
        // a parameter may be given by the last part of its path
        char path[2 * LINE_TEXT];
        TRY(identify_add_path(&r->id, act_full_path(word, path, sizeof path), f));
    }
    TRY(identify_add_trace(&r->id, r->file, NULL, 0, f));
    return identify_fit(&r->id, f);
}

static gpointer search_runs(gpointer of)
{
    run_search *r = of;
    r->code = r->fits ? fit(r, &r->fault) : locate(r, &r->fault);
    g_atomic_int_set(&r->done, 1);
    return NULL;
}

void run_search_finish(run_search *r)
{
    if (r == NULL) {
        return;
    }
    if (r->thread != NULL) {
        r->monitor.stop = true;
        g_thread_join(r->thread);
    }
    sweep_axis_finish(&r->axis);
    identify_finish(&r->id);
    run_origin_finish(&r->from);
    scenario_finish(&r->base);
    g_free(r);
}

// A search about the present run that is still to begin; NULL after a refusal.
static run_search *new_search(const explorer_model *model, explorer_input *input)
{
    if (model->search != NULL) {
        act_refuse(input, "a search goes on, Esc ends it");
        return NULL;
    }
    if (!act_need_whole_run(model, input)) {
        return NULL;
    }
    run_search *r = g_new0(run_search, 1);
    const session *s = &model->session;
    const bool copied = scenario_copy(&r->base, &s->effective) == STATUS_OK &&
                        run_origin_take(&r->from, s, &input->fault) == STATUS_OK;
    if (!copied) {
        run_search_finish(r);
        act_succeeded(input, STATUS_NO_MEMORY);
        return NULL;
    }
    return r;
}

// Begins it, and takes its results if they are there soon.
static bool begin(explorer_model *model, explorer_input *input, run_search *r)
{
    r->thread = g_thread_new("search", search_runs, r);
    model->search = r;
    act_tell(input, "the lab goes on while the runs are computed; Esc ends that");
    return act_take_search(model, input, model->session.patience);
}

void act_write_progress(const run_search *r, char text[PROGRESS_TEXT])
{
    enum { FIT_RUNS = 600 };
    const int runs = r->monitor.pieces;
    const char *does = r->fits ? "fitting" : "solving";
    const int usual = r->fits ? FIT_RUNS : SOLVE_POINTS;
    if (r->monitor.stop) {
        snprintf(text, PROGRESS_TEXT, "%s ends", does);
    } else if (runs < usual) {
        snprintf(text, PROGRESS_TEXT, "%s, %d of some %d runs (Esc ends)", does, runs,
                 usual);
    } else {
        snprintf(text, PROGRESS_TEXT, "%s, %d runs (Esc ends)", does, runs);
    }
}

bool act_end_search(explorer_model *model, explorer_input *input)
{
    model->search->monitor.stop = true;
    return act_tell(input, "the search ends with the runs in hand");
}

// --- a limit ---------------------------------------------------------------------------

// The signal whose values a quantity is one of, -1 if there is none.
static int signal_of_quantity(int quantity)
{
    static const struct {
        int quantity, signal;
    } pairs[] = {{SUMMARY_INDEX(peak_force_N), SIGNAL_INDEX(force)},
                 {SUMMARY_INDEX(first_pulse_peak_N), SIGNAL_INDEX(force)},
                 {SUMMARY_INDEX(steady_force_N), SIGNAL_INDEX(force)},
                 {SUMMARY_INDEX(largest_command_V), SIGNAL_INDEX(command)},
                 {SUMMARY_INDEX(approach_speed_m_s), SIGNAL_INDEX(gap_velocity)}};
    for (size_t i = 0; i < sizeof pairs / sizeof pairs[0]; i++) {
        if (pairs[i].quantity == quantity) {
            return pairs[i].signal;
        }
    }
    return -1;
}

// The limit that is nearest to the value the run has.
static int nearest_limit(const run_search *r)
{
    const solution *found = &r->found;
    const double value = parameter_get(&r->base.parameters, r->axis.parameter);
    int nearest = 0;
    for (int i = 1; i < found->count && r->axis.element == 0; i++) {
        const double here = fabs(found->limits[i].value - value);
        if (here < fabs(found->limits[nearest].value - value)) {
            nearest = i;
        }
    }
    return nearest;
}

// Pins the run with the limit that is nearest, from the start.
static status pin_limit(explorer_model *model, const run_search *r, fault *f)
{
    const double value = r->found.limits[nearest_limit(r)].value;
    parameters p = r->base.parameters;
    char name[RUN_NAME];
    session other;
    snprintf(name, sizeof name, "%s %.5g", strchr(r->axis.name, '.') + 1, value);
    TRY(sweep_axis_apply(&r->axis, value, &p, f));
    TRY(session_reopen(&other, &r->from, HUGE_VAL, f));
    session_seek(&other, 0);
    status code = session_change_from_start(&other, &p, r->axis.parameter, f);
    if (code == STATUS_OK) {
        code = run_list_pin(&model->pinned, &other, name, f);
    }
    session_finish(&other);
    return code;
}

// Says that there is no limit in the range that was searched.
static bool refuse_without_limit(explorer_input *input, const run_search *r)
{
    const sweep_axis *axis = &r->axis;
    const solution *found = &r->found;
    const double low = fmin(axis->low, axis->high), high = fmax(axis->low, axis->high);
    char text[MESSAGE_TEXT / 2];
    snprintf(text, sizeof text,
             "no limit of %s from %g to %g %s: the %s is as asked in %d runs, and not in "
             "%d",
             axis->name, low, high, sweep_axis_parameter(axis)->unit,
             summary_table[r->condition.quantity].label, found->holding, found->failing);
    if (found->unknown > 0) {
        return act_refuse(input, "%s; first of the others: %s", text, found->reason);
    }
    return act_refuse(input, "%s%s", text, found->reason);
}

// Says what was found: the limit that is pinned, and where others are.
static bool tell_limits(explorer_input *input, const run_search *r)
{
    const solution *found = &r->found;
    const int nearest = nearest_limit(r);
    char others[160] = "";
    for (int i = 0; i < found->count; i++) {
        if (i != nearest) {
            const char *before = others[0] == '\0' ? "; limits also at " : ", ";
            text_add(others, sizeof others, "%s%.5g", before, found->limits[i].value);
        }
    }

    // the nearest, with what the quantity is there
    const solve_limit *l = &found->limits[nearest];
    const char *side = l->holds_below ? "up to" : "from";
    const char *jump = l->jumps ? ", where it jumps" : "";
    const char *unit = sweep_axis_parameter(&r->axis)->unit, *blank = unit[0] ? " " : "";
    return act_tell(input, "%s %s = %#.5g%s%s: %#.5g %s%s%s; that run is pinned", side,
                    r->axis.name, l->value, blank, unit, l->reached,
                    summary_table[r->condition.quantity].unit, jump, others);
}

// Pins the run with the limit and draws the condition in the panes of its signal.
static bool take_limits(explorer_model *model, explorer_input *input, const run_search *r)
{
    if (r->found.count == 0) {
        return refuse_without_limit(input, r);
    }
    const int quantity = r->condition.quantity;
    model->limit =
        (solved_limit){signal_of_quantity(quantity), r->condition.bound, quantity};
    return act_succeeded(input, pin_limit(model, r, &input->fault)) &&
           tell_limits(input, r);
}

bool act_solve(explorer_model *model, explorer_input *input, const char *argument)
{
    const char *condition_text = argument + strcspn(argument, " ");
    if (*condition_text == '\0') {
        return act_refuse(input, "solve takes a parameter and a condition, such as "
                                 "motor.voltage peak_force_N<2");
    }
    run_search *r = new_search(model, input);
    if (r == NULL) {
        return false;
    }

    // a parameter may be given by the last part of its path
    char word[LINE_TEXT];
    snprintf(word, sizeof word, "%.*s", (int)(condition_text - argument), argument);
    act_full_path(word, r->words, sizeof r->words);
    snprintf(r->condition_text, sizeof r->condition_text, "%s", condition_text);
    return begin(model, input, r);
}

// --- a fit -----------------------------------------------------------------------------

// Writes a fitted value with its error, or that it is not determined.
static void write_fit(const fitted_parameter *fit, char *text, size_t size)
{
    text_add(text, size, "%s", strchr(fit->axis.name, '.') + 1);
    if (!fit->determined) {
        text_add(text, size, " is not determined");
    } else if (identify_at_end(fit)) {
        text_add(text, size, " %.5g, at the end of its range", fit->value);
    } else {
        const char *unit = sweep_axis_parameter(&fit->axis)->unit;
        const char *blank = unit[0] ? " " : "";
        text_add(text, size, " %.5g +- %.2g%s%s", fit->value, fit->standard_error, blank,
                 unit);
    }
}

// Says what was found, and what to think of it.
static bool tell_fit(explorer_input *input, const identification *id)
{
    char text[MESSAGE_TEXT / 2] = "";
    for (int i = 0; i < id->count; i++) {
        if (i > 0) {
            text_add(text, sizeof text, "; ");
        }
        write_fit(&id->fit[i], text, sizeof text);
    }

    // the fit as a whole
    if (id->undetermined > 0) {
        return act_tell(input, "%s: fit fewer, or record more", text);
    }
    double most;
    if (identify_misfit(id, &most) > most) {
        return act_tell(input, "%s; pinned, but far off the data", text);
    }
    if (!identify_settled(id)) {
        return act_tell(input, "%s; pinned, but other starts may end better", text);
    }
    if (id->white) {
        return act_tell(input, "%s; that run is pinned", text);
    }
    return act_tell(input, "%s; pinned, but the data show more than the model has", text);
}

// Pins the run that was compared with the data in the end, and lays these under it, if
// they are still the same.
static status pin_fitted(explorer_model *model, const run_search *r, fault *f)
{
    scenario fitted, copy;
    session other;
    const recorded_trace *t = &r->id.traces[0];
    TRY(identify_scenario(&r->id, 0, &fitted, f));
    TRY(scenario_copy(&copy, &fitted));
    TRY(session_open(&other, &copy, HUGE_VAL, f));
    const status code = run_list_pin(&model->pinned, &other, "identified", f);
    session_finish(&other);
    const bool has_data =
        model->measured.row_count > 0 && strcmp(model->measured_file, r->file) == 0;
    if (code == STATUS_OK && has_data) {
        model_lay_data(model, -(t->begin + t->own[OWN_SHIFT]));
    }
    return code;
}

// Pins the run with the fitted values, if any is determined.
static bool take_fit(explorer_model *model, explorer_input *input, const run_search *r)
{
    const identification *id = &r->id;
    bool any = false;
    for (int i = 0; i < id->count; i++) {
        any = any || id->fit[i].determined;
    }
    if (any && !act_succeeded(input, pin_fitted(model, r, &input->fault))) {
        return false;
    }
    return tell_fit(input, id) && id->undetermined == 0;
}

bool act_identify(explorer_model *model, explorer_input *input, const char *argument)
{
    if (argument[0] == '\0') {
        return act_refuse(input, "identify takes parameters, such as k2 stiction");
    }
    if (model->measured.row_count == 0) {
        return act_refuse(input, "there are no measured data: :data FILE.csv");
    }
    run_search *r = new_search(model, input);
    if (r == NULL) {
        return false;
    }
    r->fits = true;
    r->id = (identification){.base = &r->base,
                             .starts = FIT_STARTS,
                             .jobs = FIT_THREADS,
                             .monitor = &r->monitor};
    snprintf(r->words, sizeof r->words, "%s", argument);
    snprintf(r->file, sizeof r->file, "%s", model->measured_file);
    return begin(model, input, r);
}

// --- what came out ---------------------------------------------------------------------

// Takes the results of a search that is over.
static bool take_search(explorer_model *model, explorer_input *input, const run_search *r)
{
    if (r->monitor.stop) {
        return act_warn(input, "the search ended after %d runs: nothing is pinned",
                        (int)r->monitor.pieces);
    }
    if (r->code != STATUS_OK) {
        input->fault = r->fault;
        return act_succeeded(input, r->code);
    }
    const bool done = r->fits ? take_fit(model, input, r) : take_limits(model, input, r);
    return act_apply_baseline(model, input) && done;
}

bool act_take_search(explorer_model *model, explorer_input *input, double patience)
{
    run_search *r = model->search;
    if (r == NULL || !act_wait_for(&r->done, patience)) {
        return true;
    }
    model->search = NULL;
    const bool done = take_search(model, input, r);
    run_search_finish(r);
    return done;
}

bool act_follow_search(explorer_model *model, explorer_input *input)
{
    run_search *r = model->search;
    if (r == NULL) {
        return false;
    }
    const int runs = r->monitor.pieces;
    const bool more = runs != r->shown;
    r->shown = runs;
    act_take_search(model, input, 0);
    return more || model->search == NULL;
}
