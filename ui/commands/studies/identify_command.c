// impactlab identify: fits parameters to measured data and says how far to trust them.
#include "ui/commands/command.h"

#include <math.h>
#include <string.h>

#include "src/base/json.h"
#include "src/base/numbers.h"
#include "src/study/identify/identify.h"
#include "ui/commands/command_pictures.h"
#include "ui/commands/progress.h"
#include "ui/commands/results.h"

#define SHORTEST 1e-9 // time that is told [s]

enum { MOST_LINKS_COMPARED = 8, MOST_LINKS = 64 };

// What other numbers of links make of the same data.
typedef struct links_comparison {
    int links[MOST_LINKS_COMPARED], count;
    double aic[MOST_LINKS_COMPARED];
    bool white[MOST_LINKS_COMPARED]; // residuals
} links_comparison;

// The fit, its validation, and the comparison of numbers of links.
typedef struct fit_outcome {
    const scenario *scenario;
    identification fit;
    identification validation; // no traces: none was asked for
    scenario fitted;           // with the fitted values
    scenario_fit left_open;    // what the fit leaves open of them
    links_comparison compared;
} fit_outcome;

static void fit_outcome_finish(fit_outcome *o)
{
    identify_finish(&o->fit);
    identify_finish(&o->validation);
}

// --- the fits --------------------------------------------------------------------------

// Reads what is fitted to what.
static status read_fit(const arguments *a, const scenario *s, identification *id,
                       fault *f)
{
    *id = (identification){.base = s,
                           .jobs = many_runs_jobs(a),
                           .seed = a->seed,
                           .noise_from_residuals =
                               a->noise != NULL && strcmp(a->noise, "residual") == 0,
                           .starts = IDENTIFY_STARTS};
    if (a->starts > 0) {
        id->starts = (int)a->starts;
    }

    // what is fitted, and to what
    TRY(identify_available(f));
    for (int i = 0; i < a->fits.count; i++) {
        TRY(identify_add_path(id, a->fits.items[i], f));
    }
    for (int i = 0; i < a->data.count; i++) {
        TRY(identify_add_trace(id, a->data.items[i], a->headings.items, a->headings.count,
                               f));
    }
    return STATUS_OK;
}

// Another trace under the fitted values: only what is its own is fitted.
static status validate_fit(const arguments *a, fit_outcome *o, fault *f)
{
    o->validation = (identification){.base = &o->fitted,
                                     .jobs = o->fit.jobs,
                                     .starts = 1,
                                     .monitor = o->fit.monitor};
    TRY(identify_add_trace(&o->validation, a->validate, a->headings.items,
                           a->headings.count, f));
    const status code = identify_fit(&o->validation, f);
    if (code == STATUS_STOPPED) {
        // a part of it judges nothing
        identify_finish(&o->validation);
        o->validation = (identification){.count = 0};
    }
    return code;
}

// Reads a number of links; *rest is what follows it.
static bool read_number_of_links(const char *text, int *links, const char **rest)
{
    double value;
    if (!decimal_read(text, &value, rest) || (**rest != ',' && **rest != '\0')) {
        return false;
    }
    if (value != floor(value) || value < 1 || value > MOST_LINKS) {
        return false;
    }
    *links = (int)value;
    return true;
}

// Reads the numbers of --links.
static status read_links(const char *text, links_comparison *c, fault *f)
{
    const char *rest = text;
    while (rest != NULL && *rest != '\0') {
        FAULT_IF(c->count == MOST_LINKS_COMPARED ||
                     !read_number_of_links(rest, &c->links[c->count], &rest),
                 f, STATUS_BAD_ARGUMENT,
                 "--links takes up to %d numbers of links from 1 to %d, such as 2,4,8",
                 MOST_LINKS_COMPARED, MOST_LINKS);
        c->count++;
        if (*rest == ',') {
            rest++;
        }
    }
    return STATUS_OK;
}

// Fits the same data with other numbers of links, from the fitted values on.
static status compare_links(const arguments *a, fit_outcome *o, fault *f)
{
    links_comparison *c = &o->compared;
    const int asked = c->count;
    c->count = 0; // of those that are done
    for (int i = 0; i < asked; i++) {
        // the fitted arm with this number of links
        scenario other;
        const parameter_change change = {PARAMETER_INDEX(arm.links), c->links[i]};
        TRY(scenario_with(&o->fitted, &change, 1, &other, f));

        // its own fit, from there on
        SCOPED(identify_finish) identification id = {0};
        TRY(read_fit(a, &other, &id, f));
        id.starts = 1;
        id.monitor = o->fit.monitor;
        TRY(identify_fit(&id, f));
        c->aic[i] = id.aic;
        c->white[i] = id.white;
        c->count++;
    }
    return STATUS_OK;
}

// Fits the parameters, and judges them by what else is asked for.
static status fit_and_judge(const arguments *a, fit_outcome *o, fault *f)
{
    TRY(identify_fit(&o->fit, f));

    // the scenario with the values that are determined
    parameters fitted;
    TRY(identify_parameters(&o->fit, true, &fitted, f));
    TRY(scenario_take_parameters(&o->fitted, &fitted, f));
    o->left_open = identify_left_open(&o->fit);
    if (o->left_open.count > 0) {
        o->fitted.fit = &o->left_open;
    }

    if (a->validate != NULL) {
        TRY(validate_fit(a, o, f));
    }
    return compare_links(a, o, f);
}

// --- results ---------------------------------------------------------------------------

// The fit, what compares it, and its validation.
static json_t *fit_json(const void *found)
{
    const fit_outcome *o = found;
    const links_comparison *c = &o->compared;
    json_t *object = identify_json(&o->fit), *links = json_array();
    for (int i = 0; i < c->count; i++) {
        json_add(links,
                 json_of("links:i aic:n white:b", c->links[i], c->aic[i], c->white[i]));
    }
    return json_members(object, "links:o validation:o", links,
                        identify_traces_json(&o->validation));
}

// What a trace has before any fit: its samples and their clock, its columns, and what of
// its readings is compared.
static void print_trace_read(const recorded_trace *t, const char *what)
{
    say("  %s %s: %zu samples in %.6g s", what, t->file, t->rows, t->time[t->rows - 1]);
    if (fabs(t->begin) > SHORTEST) {
        say(", from %.12g s on", t->begin);
    }
    if (t->clock.period > 0) {
        say(", at %.7g Hz", 1 / t->clock.period);
        if (fabs(t->rate * t->clock.period - 1) > SHORTEST) {
            say(", taken for %.7g Hz", t->rate);
        }
    } else {
        say(", at no steady rate, commands at %.7g Hz", t->rate);
    }
    if (t->clock.scatter > SHORTEST) {
        say(", stamps off by %.2g us", 1e6 * t->clock.scatter);
    }
    if (t->clock.missing > 0) {
        say("; %zu sample%s missing, the longest gap %.3g ms", t->clock.missing,
            plural_ending(t->clock.missing), 1e3 * t->clock.longest);
    }

    // rows and columns
    say("\n    columns %s", t->taken);
    if (t->not_taken[0] != '\0') {
        say("; not taken: %s", t->not_taken);
    }
    say("\n");
    if (t->table_rows > t->rows) {
        say("    %zu rows, of which those of one sample count once\n", t->table_rows);
    }
    if (t->left_out[0] != '\0') {
        say("    %s\n", t->left_out);
    }

    // readings
    for (int c = 0; c < CHANNELS; c++) {
        if (t->reading[c] == NULL) {
            continue;
        }
        say("    %zu of %s compared", t->uses[c][READING_COMPARED],
            signal_table[identify_signals[c]].name);
        for (int use = READING_COMPARED + 1; use < READING_USES; use++) {
            if (t->uses[c][use] > 0) {
                say(", %zu %s", t->uses[c][use], identify_uses[use]);
            }
        }
        say("\n");
    }
}

static void print_traces_read(const identification *id, const char *what)
{
    for (int k = 0; k < id->trace_count; k++) {
        print_trace_read(&id->traces[k], what);
    }
}

// A parameter with its error and interval, as far as these are known.
static void print_fitted_parameter(const fitted_parameter *fit, bool is_judged)
{
    const char *name = fit->axis.name;
    const char *unit = sweep_axis_parameter(&fit->axis)->unit;
    if (fit->determined && isnan(fit->standard_error)) {
        say("  %-26s %12.6g %12s   none: what is left is no noise\n", name, fit->value,
            "-");
    } else if (fit->determined && fit->one_sided) {
        say("  %-26s %12.6g %12.3g   at most %.6g %s\n", name, fit->value,
            fit->standard_error, fit->high, unit);
    } else if (fit->determined) {
        say("  %-26s %12.6g %12.3g   %.6g to %.6g %s", name, fit->value,
            fit->standard_error, fit->low, fit->high, unit);
        if (identify_at_end(fit)) {
            say(", at the end of its range");
        }
        say("\n");
    } else if (is_judged) {
        say("  %-26s %12s %12s   not determined\n", name, "-", "-");
    } else {
        say("  %-26s %12.6g %12s   not known yet\n", name, fit->value, "-");
    }
}

// What a trace has of its own, and what its residuals are.
static void print_recorded_trace(const recorded_trace *t, const char *what)
{
    say("  %s %s: shifted by %.3g ms", what, t->file, 1e3 * t->own[OWN_SHIFT]);
    if (t->reading[CHANNEL_ENCODER] != NULL) {
        say(", encoder by %.3g rad", t->own[OWN_OFFSET]);
    }
    if (t->contact_count > 0) {
        say("; %d contact%s within %.3g ms, largest force off by %.3g %%",
            t->contact_count, plural_ending((size_t)t->contact_count),
            1e3 * t->contact_error, 100 * t->peak_error);
    }
    say("\n");

    // how large the residuals of each channel are
    for (int c = 0; c < CHANNELS; c++) {
        const signal_info *signal = &signal_table[identify_signals[c]];
        if (!isnan(t->rms[c])) {
            say("    %-14s off by %.3g %s (rms), %.3g of its noise; %.5g %% explained\n",
                signal->name, t->rms_unit[c], signal->unit, t->rms[c],
                100 * t->explained[c]);
        }
    }
}

static void print_recorded_traces(const identification *id, const char *what)
{
    for (int k = 0; k < id->trace_count; k++) {
        print_recorded_trace(&id->traces[k], what);
    }
}

// What would explain residuals that are no noise: the errors are of that.
static void print_lack(const identification *id)
{
    const unexplained *lack = &id->lack;
    if (!isnan(lack->command)) {
        say("  errors are those that a command of %.3g V (rms) besides the recorded one, "
            "another every %.3g ms, could make\n",
            lack->command, 1e3 * lack->stretch);
    }
    if (!isnan(lack->hub_spring)) {
        say("  and those of a hub that gives: the readings allow arm.hub_joint = spring "
            "with arm.k1 = %.4g N m/rad",
            lack->hub_spring);
        if (lack->hub_damping > 0) {
            say(" and %.3g N m s/rad in that joint", lack->hub_damping);
        }
        say(":\n   ");
        for (int i = 0; i < id->count; i++) {
            say(" %s = %.6g,", id->fit[i].axis.name, lack->with_spring[i]);
        }
        say(" chi square %.4g\n", lack->chi_square);
    }
}

// How good the fit is: what it does not determine, and its residuals.
static void print_judgement(const fit_outcome *o)
{
    const identification *id = &o->fit;

    // combinations that the data leave open
    for (int k = 0; k < id->undetermined; k++) {
        char words[1024];
        say("\n  not determined: %s\n", identify_words(id, k, words, sizeof words));
    }

    // what the fit leaves, in all and by trace
    say("\n  %zu readings, chi square %.4g, AIC %.6g; the residuals are %s\n",
        id->residuals - (size_t)id->count, id->chi_square, id->aic,
        id->white ? "white" : "correlated");
    print_lack(id);
    say("  the least of %d starts, reached from %d of those that were drawn, in %d "
        "runs\n",
        id->searches, id->reached, id->runs);
    print_recorded_traces(id, "trace");
    print_recorded_traces(&o->validation, "validation");

    // other models of the arm
    const links_comparison *c = &o->compared;
    for (int i = 0; i < c->count; i++) {
        const char *of_links = c->white[i] ? "white" : "correlated";
        say("  with %d links: AIC %.6g, residuals %s\n", c->links[i], c->aic[i],
            of_links);
    }
}

// The fitted parameters, and how far to trust them.
static void print_fit(const void *found)
{
    const fit_outcome *o = found;
    const identification *id = &o->fit;
    const bool is_judged = !isnan(id->aic);
    say_title(o->scenario);
    say("\n");
    print_traces_read(id, "trace");
    print_traces_read(&o->validation, "validation");
    say("\n  %-26s %12s %12s   %s\n", "parameter", "value", "error", "95 % interval");
    for (int i = 0; i < id->count; i++) {
        print_fitted_parameter(&id->fit[i], is_judged);
    }

    // how far to trust them
    if (is_judged) {
        print_judgement(o);
    } else {
        say("\n  chi square %.4g\n", id->chi_square);
    }
}

static void write_fitted_scenario(FILE *stream, const void *found)
{
    const fit_outcome *o = found;
    scenario_write(stream, &o->fitted);
}

static void write_drawn_arms(FILE *stream, const void *found)
{
    const fit_outcome *o = found;
    identify_write_set(stream, &o->fit);
}

static int plot_fit(const arguments *a, const void *found)
{
    const fit_outcome *o = found;
    return publish_owned(a, drawing()->identify_figure_create(&o->fit));
}

// --- the command -----------------------------------------------------------------------

// Complains of values that were not found. Returns whether there are such.
static bool complain_not_found(const identification *id)
{
    bool found = id->undetermined == 0;

    // a value at the end of its range is a limit
    for (int i = 0; i < id->count; i++) {
        const fitted_parameter *fit = &id->fit[i];
        if (identify_at_end(fit) && !fit->one_sided) {
            complain("%s = %g is an end of its range, no estimate: expected a wider "
                     "--fit %s=a:b",
                     fit->axis.name, fit->value, fit->axis.name);
            found = false;
        }
    }

    // a minimum that few starts lead to may be a false one
    if (!identify_settled(id)) {
        complain(
            "not found: of %d starts %d of those that were drawn led to the least sum "
            "of squares, expected %d: there may be better values, try more --starts",
            id->searches, id->reached, IDENTIFY_CONFIRMED);
        found = false;
    }
    return !found;
}

// Complains of a model that the data contradict.
static void complain_unexplained(const identification *id)
{
    const unexplained *lack = &id->lack;
    double most;
    const double misfit = identify_misfit(id, &most);
    const char *how = "residuals that are correlated";
    if (id->white) {
        how = "residuals larger than noise";
    }
    if (lack->trace < 0) {
        complain("the model lacks something: chi square is %.3g per reading, expected "
                 "about 1",
                 misfit);
        return;
    }
    const signal_info *signal = &signal_table[identify_signals[lack->channel]];
    double from = lack->from;
    if (fabs(from) < SHORTEST) {
        from = 0;
    }
    complain(
        "the model lacks something: the best fit leaves %s, chi square %.3g per "
        "reading, expected about 1. %s shows it most in %s from %.4g s to %.4g s, off "
        "by %.3g %s, %.3g times the noise",
        how, misfit, id->traces[lack->trace].file, signal->name, from, lack->to,
        lack->rms_unit, signal->unit, lack->rms);
}

// Whether the values can be relied on; complains where they cannot. Returns the exit
// status.
static int judge_fit(const identification *id)
{
    const bool not_found = complain_not_found(id), explained = identify_explained(id);
    if (!explained) {
        complain_unexplained(id);
    }
    if (not_found) {
        return EXIT_FAILED;
    }
    if (!explained) {
        return EXIT_UNEXPLAINED;
    }
    return EXIT_DONE;
}

static const command_results fit_results = {.json = fit_json,
                                            .text = print_fit,
                                            .plot = plot_fit,
                                            .output = write_fitted_scenario,
                                            .cases = write_drawn_arms};

static json_t *preview_json(const void *found)
{
    const fit_outcome *o = found;
    return identify_preview_json(&o->fit);
}

static void print_preview(const void *found)
{
    const fit_outcome *o = found;
    say_title(o->scenario);
    say("\n");
    print_traces_read(&o->fit, "trace");
}

static const command_results preview_results = {.json = preview_json,
                                                .text = print_preview};

// Writes what an interrupt leaves, and says what that is. Returns the exit status.
static int report_stopped_fit(const arguments *a, const fit_outcome *o)
{
    const char *what_became = "nothing was tried yet";
    int result = EXIT_FAILED;
    if (o->fit.chi_square > 0) {
        result = worse(result, write_results(a, &fit_results, o, false));
        what_became = "the fit is whole, what compares it is missing";
        if (isnan(o->fit.aic)) {
            what_became = "the values are the best so far, not judged";
        }
    }
    complain("stopped: %s", what_became);
    return result;
}

// The command: fits the parameters to the traces, and judges the fit.
static int fit_and_report(const arguments *a, scenario *s)
{
    if (a->data.count == 0 || (a->fits.count == 0 && !a->preview)) {
        return complain("identify needs a recorded trace, --data FILE.csv, and what is "
                        "to be found, --fit PATH");
    }
    SCOPED(fit_outcome_finish) fit_outcome o = {.scenario = s, .fitted = *s};
    fault f = {0};
    if (read_links(a->links, &o.compared, &f) != STATUS_OK ||
        read_fit(a, s, &o.fit, &f) != STATUS_OK) {
        return complain_fault(&f);
    }

    if (a->preview) {
        return write_results(a, &preview_results, &o, true);
    }

    // the number of runs is not known before they are through
    o.fit.monitor = work_begin(a, "runs", 1000);
    const status code = fit_and_judge(a, &o, &f);
    work_end();

    if (code == STATUS_STOPPED) {
        return report_stopped_fit(a, &o);
    }
    if (code != STATUS_OK) {
        return complain_fault(&f);
    }
    const int judged = judge_fit(&o.fit);
    const int written = write_results(a, &fit_results, &o, true);
    if (written != EXIT_DONE) {
        return written;
    }
    return judged;
}

static const option_row rows[] = {
    OPTION(FILES, "data", "FILE.csv", "a recorded trace (may be repeated)", PLACE(data)),
    OPTION(PARAMETERS, "fit", "PATH[=a:b]", "a parameter to be found (may be repeated)",
           PLACE(fits)),
    OPTION(PARAMETERS, "column", "SIGNAL=HEADER[unit]",
           "where a trace has a signal under another heading (may be repeated)",
           PLACE(headings)),
    OPTION(FLAG, "preview", NULL,
           "read the traces only, and tell rows, rate, gaps and columns", PLACE(preview)),
    OPTION(FILE, "validate", "FILE.csv",
           "a trace that is not fitted, to judge the result by", PLACE(validate)),
    OPTION(TEXT, "links", "N,N,...", "fit these numbers of links too, and compare",
           PLACE(links)),
    OUTPUT_OPTION(RESULT, "FILE|-",
                  "write the scenario with the values that are determined",
                  .replaces = scenario_is),
    OPTION(RESULT, "cases", "FILE.set",
           "write 200 arms drawn from the covariance, for robust", PLACE(cases)),
    OPTION(CHOICE, "noise", "scenario|residual",
           "where each channel has its noise from: the scenario, or what the fit leaves "
           "of it (scenario)",
           PLACE(noise)),
    OPTION(WHOLE, "starts", "N",
           "search from so many starts at most (40); 1: from the scenario's values alone",
           PLACE(starts), .low = 1, .high = 10000),
    SEED_OPTION,
    JOBS_OPTION,
};

const command identify_command = {
    .name = "identify",
    .group = GROUP_CONTROL,
    .summary = "Find parameters of an arm, and their errors, from recorded traces",
    .operands = "SCENARIO",
    .least = 1,
    .most = 1,
    .takes_scenarios = true,
    .help = "identify compare/open-loop --data a.csv --data b.csv --fit arm.k2 --fit "
            "motor.stiction simulates each trace with the command that was recorded and "
            "fits the parameters until the readings agree, each judged by its noise. "
            "Columns are headed as run --csv heads them: time[s], command[V] and any of "
            "encoder, tachometer, force_reading, piezo_force, film, accelerometer, "
            "tip_deflection, root_strain. Each trace has a time shift, an encoder offset "
            "and an initial state of its own. It searches from the scenario's values, "
            "then from draws until three of these led to the least sum of squares. The "
            "exit status is 1 where 40 starts do not settle that, where a value ends at "
            "an end of its range (but where that is 0, the least there is: then it has "
            "an upper limit), and where the data do not determine a combination, which "
            "is named and not written. It is 3 where a fit was found and the model lacks "
            "something: residuals that are correlated, or chi square per reading above "
            "4, as of noise twice as large as it is said to be. Errors of correlated "
            "residuals are those that a command nobody recorded and a hub that gives "
            "could make.\n",
    .options = {&set_options, &json_options, OWN_OPTIONS(rows), &drawn_options,
                &quiet_options, &page_options},
    .use = fit_and_report,
};
