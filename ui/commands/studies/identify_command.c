// impactlab identify: fits parameters to measured data and says how far to trust them.

#include "render/plot/study_plot.h"
#include "src/base/json.h"
#include "src/base/numbers.h"
#include "src/study/identify.h"
#include "ui/commands/command_pictures.h"
#include "ui/commands/progress.h"

enum { MOST_LINKS = 8 };

// The fit, its validation, and what other numbers of links make of the same data.
typedef struct outcome {
    identification fit;
    identification validation; // no traces: none was asked for
    scenario written;          // with the fitted values
    int links[MOST_LINKS], link_count;
    double aic[MOST_LINKS];
    bool white[MOST_LINKS];
} outcome;

// Reads what is fitted to what.
static status set_up(const arguments *a, const scenario *s, identification *id, fault *f)
{
    *id = (identification){.base = s,
                           .jobs = many_runs_jobs(a),
                           .seed = a->seed,
                           .starts = a->starts > 0 ? (int)a->starts : IDENTIFY_STARTS};
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
static status validate(const arguments *a, outcome *o, fault *f)
{
    o->validation = (identification){.base = &o->written,
                                     .jobs = o->fit.jobs,
                                     .starts = 1,
                                     .monitor = o->fit.monitor};
    TRY(identify_add_trace(&o->validation, a->validate, a->headings.items,
                           a->headings.count, f));
    const status code = identify_fit(&o->validation, f);
    if (code == STATUS_STOPPED) {
        identify_finish(&o->validation);
        o->validation = (identification){.count = 0};
    }
    return code;
}

// The numbers of --links.
static status read_links(const char *text, outcome *o, fault *f)
{
    while (text != NULL && *text != '\0') {
        double value;
        const char *rest;
        FAULT_IF(o->link_count == MOST_LINKS || !decimal_read(text, &value, &rest) ||
                     (*rest != ',' && *rest != '\0') || value != floor(value) ||
                     value < 1 || value > 64,
                 f, STATUS_BAD_ARGUMENT,
                 "--links takes up to %d numbers of links from 1 to 64, such as 2,4,8",
                 MOST_LINKS);
        o->links[o->link_count++] = (int)value;
        if (*rest == ',') {
            text = rest + 1;
        } else {
            text = rest;
        }
    }
    return STATUS_OK;
}

// The same data with other numbers of links, from the fitted values on.
static status compare_links(const arguments *a, outcome *o, fault *f)
{
    const int asked = o->link_count;
    o->link_count = 0; // of those that are done
    for (int i = 0; i < asked; i++) {
        scenario other;
        const parameter_change links = {PARAMETER_INDEX(arm.links), o->links[i]};
        TRY(scenario_with(&o->written, &links, 1, &other, f));
        SCOPED(identify_finish) identification id = {0};
        TRY(set_up(a, &other, &id, f));
        id.starts = 1;
        id.monitor = o->fit.monitor;
        TRY(identify_fit(&id, f));
        o->aic[i] = id.aic;
        o->white[i] = id.white;
        o->link_count++;
    }
    return STATUS_OK;
}

// --- results ---------------------------------------------------------------------------

static json_t *answer(const scenario *s, const void *found)
{
    const outcome *o = found;
    json_t *object = identify_json(&o->fit), *links = json_array();
    for (int i = 0; i < o->link_count; i++) {
        json_add(links,
                 json_of("links:i aic:n white:b", o->links[i], o->aic[i], o->white[i]));
    }
    return json_members(object, "links:o validation:o", links,
                        identify_traces_json(&o->validation));
}

static void print_traces(const identification *id, const char *what)
{
    for (int k = 0; k < id->trace_count; k++) {
        const recorded_trace *t = &id->traces[k];
        say("  %s %s: shifted by %.3g ms, encoder by %.3g rad;", what, t->file,
            1e3 * t->own[OWN_SHIFT], t->own[OWN_OFFSET]);
        for (int c = 0; c < CHANNELS; c++) {
            if (!isnan(t->rms[c])) {
                say(" %s %.3g", signal_table[identify_signals[c]].name, t->rms[c]);
            }
        }
        say(" of their noise");
        if (t->contact_count > 0) {
            say("; %d contact%s within %.3g ms, largest force off by %.3g %%",
                t->contact_count, t->contact_count == 1 ? "" : "s",
                1e3 * t->contact_error, 100 * t->peak_error);
        }
        say("\n");
    }
}

static void print_answer(const scenario *s, const void *found)
{
    const outcome *o = found;
    const identification *id = &o->fit;
    const bool judged = !isnan(id->aic);
    say_title(s);
    say("\n  %-26s %12s %12s   %s\n", "parameter", "value", "error", "95 % interval");
    for (int i = 0; i < id->count; i++) {
        const fitted_parameter *fit = &id->fit[i];
        const char *unit = sweep_axis_parameter(&fit->axis)->unit;
        if (fit->determined) {
            say("  %-26s %12.6g %12.3g   %.6g to %.6g %s%s\n", fit->axis.name, fit->value,
                fit->standard_error, fit->low, fit->high, unit,
                identify_at_end(fit) ? ", at the end of its range" : "");
        } else if (judged) {
            say("  %-26s %12s %12s   not determined\n", fit->axis.name, "-", "-");
        } else {
            say("  %-26s %12.6g %12s   not known yet\n", fit->axis.name, fit->value, "-");
        }
    }
    if (!judged) {
        say("\n  chi square %.4g\n", id->chi_square);
        return;
    }
    for (int k = 0; k < id->undetermined; k++) {
        char words[1024];
        say("\n  not determined: %s\n", identify_words(id, k, words, sizeof words));
    }
    say("\n  %zu readings, chi square %.4g, AIC %.6g; the residuals are %s\n",
        id->residuals - (size_t)id->count, id->chi_square, id->aic,
        id->white ? "white" : "correlated: the model lacks something that the data show");
    print_traces(id, "trace");
    print_traces(&o->validation, "validation");
    for (int i = 0; i < o->link_count; i++) {
        say("  with %d links: AIC %.6g, residuals %s\n", o->links[i], o->aic[i],
            o->white[i] ? "white" : "correlated");
    }
}

RESULT_WRITER(write_fitted, outcome, scenario_write(stream, &found->written))
RESULT_WRITER(write_cases, outcome, identify_write_set(stream, &found->fit))

// Whether the values can be relied on; says where they are none.
static bool is_reliable(const identification *id)
{
    bool reliable = id->undetermined == 0;
    double most;
    for (int i = 0; i < id->count; i++) {
        const fitted_parameter *fit = &id->fit[i];
        if (identify_at_end(fit)) {
            complain("%s = %g is an end of its range, no estimate: expected a wider "
                     "--fit %s=a:b",
                     fit->axis.name, fit->value, fit->axis.name);
            reliable = false;
        }
    }
    const double misfit = identify_misfit(id, &most);
    if (misfit > most) {
        complain("chi square is %.3g per reading, expected about 1 and at most %.3g: "
                 "the best of %d starts led to no values that fit; the scenario may "
                 "be of another arm or other runs, or more --starts find better values",
                 misfit, most, id->starts);
    }
    return reliable && misfit <= most;
}

static int plot(const arguments *a, const scenario *s, const void *found)
{
    return publish_owned(a, identify_figure_create(&((const outcome *)found)->fit));
}

static int identify_and_report(const arguments *a, scenario *s)
{
    static const command_results r = {answer, print_answer, plot, .output = write_fitted,
                                      .cases = write_cases};
    fault f = {0};
    outcome o = {0};
    if (a->data.count == 0 || a->fits.count == 0) {
        return complain("identify needs a recorded trace, --data FILE.csv, and what is "
                        "to be found, --fit PATH");
    }
    status code = read_links(a->links, &o, &f);
    if (code == STATUS_OK) {
        code = set_up(a, s, &o.fit, &f);
    }
    if (code == STATUS_OK) {
        // the number of runs is not known before they are through
        o.fit.monitor = work_begin(a, "runs", 1000);
        code = identify_fit(&o.fit, &f);
        parameters p;
        o.written = *s;
        if (code == STATUS_OK) {
            code = identify_parameters(&o.fit, true, &p, &f);
        }
        if (code == STATUS_OK) {
            code = scenario_take_parameters(&o.written, &p, &f);
        }
        if (code == STATUS_OK && a->validate != NULL) {
            code = validate(a, &o, &f);
        }
        if (code == STATUS_OK) {
            code = compare_links(a, &o, &f);
        }
        work_end();
    }
    const bool stopped = code == STATUS_STOPPED, any = stopped && o.fit.chi_square > 0;
    const bool reliable = code != STATUS_OK || is_reliable(&o.fit);
    int written = EXIT_DONE;
    if (code == STATUS_OK || any) {
        written = write_results(a, &r, s, &o, !stopped);
    } else if (!stopped) {
        written = complain_fault(&f);
    }
    if (stopped) {
        const char *fit = isnan(o.fit.aic)
                              ? "the values are the best so far, not judged"
                              : "the fit is whole, what compares it is missing";
        complain("stopped: %s", any ? fit : "nothing was tried yet");
        written = EXIT_FAILED;
    }
    const int result = reliable ? written : worse(written, EXIT_FAILED);
    identify_finish(&o.fit);
    identify_finish(&o.validation);
    return result;
}

static const option_row rows[] = {
    OPTION(FILES, "data", "FILE.csv", "a recorded trace (may be repeated)", PLACE(data)),
    OPTION(PARAMETERS, "fit", "PATH[=a:b]", "a parameter to be found (may be repeated)",
           PLACE(fits)),
    OPTION(PARAMETERS, "column", "SIGNAL=HEADER[unit]",
           "where a trace has a signal under another heading (may be repeated)",
           PLACE(headings)),
    OPTION(FILE, "validate", "FILE.csv",
           "a trace that is not fitted, to judge the result by", PLACE(validate)),
    OPTION(TEXT, "links", "N,N,...", "fit these numbers of links too, and compare",
           PLACE(links)),
    OUTPUT_OPTION(RESULT, "FILE|-",
                  "write the scenario with the values that are determined",
                  .replaces = scenario_is),
    OPTION(RESULT, "cases", "FILE.set",
           "write 200 arms drawn from the covariance, for robust", PLACE(cases)),
    OPTION(WHOLE, "starts", "N", "values that the search begins with (16)", PLACE(starts),
           .low = 1, .high = 10000),
    SEED_OPTION,
    JOBS_OPTION,
};

const command identify_command = {
    CALLED("identify", CONTROL,
           "Find parameters of an arm, and their errors, from recorded traces"),
    ONE_SCENARIO,
    .help = "identify compare/open-loop --data a.csv --data b.csv --fit arm.k2 --fit "
            "motor.stiction\n"
            "simulates each trace with the command that was recorded and fits the "
            "parameters until\n"
            "the readings agree, each judged by its noise. Columns are headed as run "
            "--csv heads\n"
            "them: time[s], command[V] and any of encoder, tachometer, force_reading, "
            "piezo_force,\n"
            "film, accelerometer. Each trace has a time shift, an encoder offset and an "
            "initial\n"
            "state of its own. A combination that the data do not determine is named and "
            "not\n"
            "written. The exit status is 1 then, where a value ends at an end of its "
            "range, and\n"
            "where chi square per reading is above 4, as of noise twice as large as it "
            "is said\n"
            "to be.\n",
    .options = {&set_options, &json_options, OWN_OPTIONS(rows), &drawn_options,
                &quiet_options, &page_options},
    .use = identify_and_report,
};
