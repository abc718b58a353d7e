// impactlab robust: control laws over many nominal models, sensors, walls and initial
// states.
#include "ui/commands/command.h"

#include <assert.h>
#include <glib.h>
#include <stdio.h>
#include <string.h>

#include "src/rig/controller_values.h"
#include "src/rig/rig.h"
#include "src/study/robust/law_exam.h"
#include "src/study/robust/robust.h"
#include "src/study/store/sweep_store.h"
#include "src/tables/settings.h"
#include "ui/commands/command_pictures.h"
#include "ui/commands/progress.h"
#include "ui/commands/results.h"
#include "ui/commands/studies/robust_exam.h"

enum { DEFAULT_RUNS = 200, DEFAULT_CASE_RUNS = 4 };

// The case of a set without cases: the scenario as it is.
enum { NO_CASE = -1 };

// The shipped set, in the folder of the scenarios.
static const char default_set[] = "sets/robust.set";

// What the command line asks for, and what was found: by case, in it by law.
typedef struct robustness {
    const arguments *arguments;
    const scenario *scenario;
    robust_set set;
    int laws[LAW_COUNT + 1]; // control_law; behind those that are judged that of
                             // --against, if it is none of them
    int judged_laws;         // how many are judged
    int against;             // place of the law of --against, -1: none
    size_t runs;             // of each law, in each case
    robust_law *found;
    int found_count;
    size_t done; // runs of all laws in all cases
} robustness;

// How many laws are run: those that are judged, and the one of --against.
static int count_laws(const robustness *r)
{
    if (r->against == r->judged_laws) {
        return r->judged_laws + 1;
    }
    return r->judged_laws;
}

// How often the laws are run: once for each case, or once.
static int count_cases(const robustness *r)
{
    if (r->set.case_count > 0) {
        return r->set.case_count;
    }
    return 1;
}

static void robustness_finish(robustness *r)
{
    for (int i = 0; i < r->found_count; i++) {
        robust_law_finish(&r->found[i]);
    }
    g_free(r->found);
    robust_set_finish(&r->set);
}

// --- what is asked for -----------------------------------------------------------------

// The law of a word of a certain length; LAW_NONE if there is none.
static int find_law(const char *text, size_t length)
{
    for (int i = LAW_NONE + 1; i < LAW_COUNT; i++) {
        const char *word = control_law_table[i].word;
        if (strlen(word) == length && strncmp(word, text, length) == 0) {
            return i;
        }
    }
    return LAW_NONE;
}

// Reads --laws, words between commas. Returns the exit status.
static int read_law_list(robustness *r, const char *list)
{
    const char *rest = list;
    while (rest != NULL) {
        const size_t length = strcspn(rest, ",");
        const int law = find_law(rest, length);
        if (law == LAW_NONE || r->judged_laws == LAW_COUNT) {
            return complain(
                "--laws %s: '%.*s' is no control law, expected those of control.law",
                list, (int)length, rest);
        }
        r->laws[r->judged_laws++] = law;

        // the next word, if there is one
        const char *comma = rest + length;
        rest = NULL;
        if (*comma == ',') {
            rest = comma + 1;
        }
    }
    return EXIT_DONE;
}

// The laws of --laws, or the scenario's own. Returns the exit status.
static int read_laws(robustness *r)
{
    if (r->arguments->laws != NULL) {
        const int ended = read_law_list(r, r->arguments->laws);
        if (ended != EXIT_DONE) {
            return ended;
        }
    } else {
        r->laws[r->judged_laws++] = r->scenario->parameters.control.law;
    }

    // what cannot be run, or not be shown
    if (r->laws[0] == LAW_NONE) {
        return complain("%s has no control law, expected one or --laws",
                        r->scenario->name);
    }
    if (r->arguments->plot != NULL && r->judged_laws > ROBUST_MOST_CURVES) {
        return complain("--plot shows at most %d laws", ROBUST_MOST_CURVES);
    }
    return EXIT_DONE;
}

// The law of --against: one of those that are judged, or one more. Returns the exit
// status.
static int read_against(robustness *r)
{
    const char *word = r->arguments->against;
    r->against = -1;
    if (word == NULL) {
        return EXIT_DONE;
    }

    const int law = find_law(word, strlen(word));
    if (law == LAW_NONE) {
        return complain("--against %s: no control law, expected one of control.law",
                        word);
    }
    if (r->set.case_count == 0) {
        return complain(
            "--against %s: the set has no cases, expected lines case TITLE: ... in it",
            word);
    }

    // behind the laws that are judged, unless it is one of them
    r->against = r->judged_laws;
    r->laws[r->judged_laws] = law;
    for (int i = 0; i < r->judged_laws; i++) {
        if (r->laws[i] == law) {
            r->against = i;
        }
    }
    return EXIT_DONE;
}

// What the set draws for each law, in each case: the text of its lines, and their numbers
// in the file.
static sweep_request request_of(const robustness *r)
{
    return (sweep_request){.vary = r->set.lines,
                           .vary_count = r->set.count,
                           .sampling = SWEEP_LATIN,
                           .runs = r->runs,
                           .seed = r->arguments->seed,
                           .file = r->set.file,
                           .lines = r->set.line_numbers};
}

// Checks that the draws of the set can be made. Returns the exit status.
static int check_draws(const robustness *r)
{
    const sweep_request request = request_of(r);
    SCOPED(sweep_finish) sweep all;
    fault f = {0};
    if (sweep_plan(&all, &request, &f) != STATUS_OK) {
        return complain_fault(&f);
    }
    return EXIT_DONE;
}

// The path of the set: that of --over, or the shipped one; to be freed with free.
static char *path_of_set(const arguments *a)
{
    if (a->over != NULL) {
        return strdup(a->over);
    }
    return scenario_folder_file(default_set);
}

// Reads the set, and makes room for what will be found. Returns the exit status.
static int read_set(robustness *r)
{
    const arguments *a = r->arguments;
    fault f = {0};
    SCOPED(free_kept) char *path = path_of_set(a);
    if (path == NULL) {
        fault_no_memory(&f);
        return complain_fault(&f);
    }
    if (robust_set_read(&r->set, path, &f) != STATUS_OK) {
        return complain_fault(&f);
    }

    // cases are a table, no curves
    if (r->set.case_count > 0 && a->plot != NULL) {
        return complain("--plot shows laws, not the cases of %s", a->over);
    }

    // how many runs, of which all draws must go together
    r->runs = (size_t)a->runs;
    if (r->runs == 0) {
        r->runs = r->set.case_count > 0 ? DEFAULT_CASE_RUNS : DEFAULT_RUNS;
    }
    const int ended = check_draws(r);
    if (ended != EXIT_DONE) {
        return ended;
    }

    // room for all laws, and that of --against
    const int most_laws = r->judged_laws + 1;
    r->found = g_new0(robust_law, (size_t)count_cases(r) * (size_t)most_laws);
    return EXIT_DONE;
}

// --- a law under a case ----------------------------------------------------------------

// Whether the scenario's own law or one that is run has a parameter of that name. The
// parameters of a plug-in or a program are not known here: it may have any.
static bool any_law_has_parameter(const robustness *r, const char *name)
{
    int laws[LAW_COUNT + 2], count = 0;
    if (r->scenario->parameters.control.law != LAW_NONE) {
        laws[count++] = r->scenario->parameters.control.law;
    }
    for (int i = 0; i < count_laws(r); i++) {
        laws[count++] = r->laws[i];
    }

    // any of them that has it, or may have it
    for (int i = 0; i < count; i++) {
        const controller *law = controller_of(laws[i]);
        if (law == NULL || controller_find_parameter(law, name) >= 0) {
            return true;
        }
    }
    return false;
}

// Leaves a law those settings that it has, and says which it does without, unless it is
// `quiet`. What no law has stays, and is refused.
static void fit_settings(const robustness *r, int law, control_parameters *control,
                         bool quiet)
{
    const controller *known = controller_of(law);
    if (known == NULL) {
        return;
    }

    // word by word
    g_autoptr(GString) kept = g_string_new(NULL);
    g_autoptr(GString) left_out = g_string_new(NULL);
    const char *rest = control->settings;
    setting s;
    while (settings_next(&rest, &s)) {
        GString *list = left_out;
        if (controller_find_parameter(known, s.name) >= 0 ||
            !any_law_has_parameter(r, s.name)) {
            list = kept;
        }
        if (list->len > 0) {
            g_string_append_c(list, ' ');
        }
        g_string_append_len(list, s.word, (gssize)s.length);
    }

    snprintf(control->settings, sizeof control->settings, "%s", kept->str);
    if (!quiet && left_out->len > 0) {
        complain("%s runs without '%s' of control.settings, which it does not have",
                 control_law_table[law].word, left_out->str);
    }
}

// What the i-th law gets to do under case k: `under` is the scenario of the case with
// that law, and the sweep draws the same for every law. Both last as long as `of_case`.
// Returns the exit status.
static int open_law_sweep(const robustness *r, const scenario *of_case, int i, int k,
                          bool quiet, scenario *under, sweep *s)
{
    *under = *of_case; // borrows all but its parameters
    under->parameters.control.law = r->laws[i];
    under->parameters.set[PARAMETER_INDEX(control.law)] = 1;

    // what a law does without is said once, and where a case has settings of its own
    const bool has_own_settings = strcmp(under->parameters.control.settings,
                                         r->scenario->parameters.control.settings) != 0;
    const bool is_said_before = k > 0 && !has_own_settings;
    fit_settings(r, r->laws[i], &under->parameters.control, quiet || is_said_before);

    const sweep_request request = request_of(r);
    fault f = {0};
    if (parameters_resolve(&under->parameters, &f) == STATUS_OK &&
        sweep_init(s, under, &request, &f) == STATUS_OK) {
        return EXIT_DONE;
    }
    if (k == NO_CASE) {
        return complain_fault(&f);
    }
    fault in_case = f;
    robust_case_fault(&r->set.cases[k], &f, &in_case);
    return complain_fault(&in_case);
}

// "a/b-LAW.sqlite" for --db a/b.sqlite, of case k "a/b-LAW-3.sqlite" with its number from
// 1; to be freed with g_free. NULL without --db.
static char *database_of_law(const char *db, const char *law, int k)
{
    if (db == NULL) {
        return NULL;
    }
    const char *slash = strrchr(db, '/'), *ending = strrchr(db, '.');
    if (ending == NULL || (slash != NULL && slash > ending)) {
        ending = db + strlen(db);
    }

    const int stem = (int)(ending - db);
    if (k == NO_CASE) {
        return text_printf("%.*s-%s%s", stem, db, law, ending);
    }
    return text_printf("%.*s-%s-%d%s", stem, db, law, k + 1, ending);
}

// Judges a law by the runs of it that there are.
static status add_judgement(robustness *r, const char *law, int k, const sweep *s,
                            sweep_store *store, fault *f)
{
    assert(r->found_count < count_cases(r) * count_laws(r));
    robust_law *found = &r->found[r->found_count++];
    const status code = robust_law_of(found, law, s, (sweep_share){0}, store, f);
    found->case_title = NULL;
    if (k != NO_CASE) {
        found->case_title = r->set.cases[k].title;
    }
    return code;
}

// Runs a law under case k, as far as its runs are not in the database yet.
static status run_law(const robustness *r, const char *law, const char *db,
                      const sweep *s, sweep_store **store, sweep_progress *progress,
                      fault *f)
{
    char word[64];
    snprintf(word, sizeof word, "%-16.40s", law);
    const sweep_options options = many_runs_begin(r->arguments, word);
    status code = sweep_store_open(store, db, s, f);
    if (code == STATUS_OK) {
        code = sweep_run(s, *store, &options, progress, f);
    }
    many_runs_end(&options);
    return code;
}

// Runs a law under case k, and judges it. Returns the exit status.
static int judge_law(robustness *r, const char *law, int k, const sweep *s)
{
    const bool quiet = r->arguments->quiet;
    g_autofree char *db = database_of_law(r->arguments->db, law, k);
    SCOPED(sweep_store_close_kept) sweep_store *store = NULL;
    sweep_progress progress = {0};
    fault f = {0};
    if (run_law(r, law, db, s, &store, &progress, &f) != STATUS_OK) {
        return complain_fault(&f);
    }
    r->done += progress.done;

    // all of its runs are there, or what there is
    const bool all_failed = progress.failed == progress.total;
    if (progress.failed > 0 && (!quiet || all_failed)) {
        many_runs_report_failure(&progress);
    }
    if (progress.done > 0 && add_judgement(r, law, k, s, store, &f) != STATUS_OK) {
        return complain_fault(&f);
    }
    if (progress.done == progress.total) {
        return EXIT_DONE;
    }

    const char *what_became = "none is shown";
    if (r->done > 0) {
        what_became = "the table is that of these";
    }
    const size_t total = r->runs * (size_t)count_cases(r) * (size_t)count_laws(r);
    return many_runs_stopped(db, r->done, total, what_became);
}

// --- cases -----------------------------------------------------------------------------

// Goes through all laws under case k: looks whether each can run, or runs and judges it.
// Returns the exit status.
static int go_through_laws(robustness *r, int k, bool runs)
{
    const robust_case *c = NULL;
    if (k != NO_CASE) {
        c = &r->set.cases[k];
    }

    // the scenario with the changes of the case
    SCOPED(robust_case_finish) scenario of_case;
    fault f = {0};
    if (robust_case_scenario(&of_case, r->scenario, c, &f) != STATUS_OK) {
        return complain_fault(&f);
    }

    // each law in it
    const bool quiet = !runs || r->arguments->quiet;
    for (int i = 0; i < count_laws(r); i++) {
        scenario under;
        SCOPED(sweep_finish) sweep s = {0};
        int ended = open_law_sweep(r, &of_case, i, k, quiet, &under, &s);
        if (ended == EXIT_DONE && runs) {
            ended = judge_law(r, control_law_table[r->laws[i]].word, k, &s);
        }
        if (ended != EXIT_DONE) {
            return ended;
        }
    }
    return EXIT_DONE;
}

// Holds the laws that were just judged against that of --against, whose own line is shown
// only where it is one of them.
static void compare_with_against(robustness *r)
{
    const int first = r->found_count - count_laws(r);
    robust_law *of_case = &r->found[first];
    const double other = of_case[r->against].from_start[ROBUST_WORST];
    for (int i = 0; i < r->judged_laws; i++) {
        of_case[i].against = of_case[i].from_start[ROBUST_WORST] / other;
    }
    if (r->against == r->judged_laws) {
        r->found_count--;
        robust_law_finish(&r->found[r->found_count]);
    }
}

// Runs all cases. Everything that can be wrong with one is known before the first is run,
// and faults of all are told. Returns the exit status.
static int run_cases(robustness *r)
{
    int first = 0, last = r->set.case_count - 1;
    if (r->set.case_count == 0) {
        first = last = NO_CASE;
    }

    int result = EXIT_DONE;

    // whether they can be run
    for (int k = first; k <= last; k++) {
        result = worse(result, go_through_laws(r, k, false));
    }

    // the runs
    for (int k = first; k <= last && result == EXIT_DONE; k++) {
        result = go_through_laws(r, k, true);
        if (result == EXIT_DONE && r->against >= 0) {
            compare_with_against(r);
        }
    }
    return result;
}

// --- results ---------------------------------------------------------------------------

// The table of what was found.
static robust_table table_of(const robustness *r)
{
    return (robust_table){r->scenario->name, r->found, r->found_count,
                          r->arguments->against};
}

static json_t *robustness_json(const void *found)
{
    const robust_table table = table_of(found);
    return robust_json(&table);
}

static void print_robustness(const void *found)
{
    const robust_table table = table_of(found);
    robust_text(stdout, &table, false);
}

static void write_robustness_markdown(FILE *stream, const void *found)
{
    const robust_table table = table_of(found);
    robust_text(stream, &table, true);
}

static void write_robustness_csv(FILE *stream, const void *found)
{
    const robust_table table = table_of(found);
    robust_csv(stream, &table);
}

static int plot_robustness(const arguments *a, const void *found)
{
    const robustness *r = found;
    const robust_table table = table_of(r);
    char changes[SCENARIO_CHANGES];
    scenario_changes(r->scenario, changes);
    return publish_owned(a, drawing()->robust_figure_create(&table, changes));
}

// Whether any run did not fail.
static bool any_succeeded(const robustness *r)
{
    for (int i = 0; i < r->found_count; i++) {
        if (r->found[i].failed < r->found[i].runs) {
            return true;
        }
    }
    return false;
}

// Writes the table of what was judged; nothing to judge is a failure. Returns the exit
// status.
static int report_robustness(const robustness *r, bool whole)
{
    static const command_results results = {.json = robustness_json,
                                            .text = print_robustness,
                                            .plot = plot_robustness,
                                            .csv = write_robustness_csv,
                                            .markdown = write_robustness_markdown,
                                            .draws_part = true};
    const int result = write_results(r->arguments, &results, r, whole);
    if (!any_succeeded(r)) {
        return worse(result, EXIT_FAILED);
    }
    return result;
}

// The command: runs all laws in all cases, and judges them.
static int judge_and_report(const arguments *a, scenario *s)
{
    SCOPED(robustness_finish) robustness r = {.arguments = a, .scenario = s};
    int ended = read_laws(&r);
    if (ended != EXIT_DONE) {
        return ended;
    }
    if (a->draw > 0) {
        return robust_exam(a, s, r.laws, r.judged_laws);
    }
    if (a->forces.count > 0 || a->before != NULL) {
        return complain("--force and --before go with --draw only");
    }
    ended = read_set(&r);
    if (ended != EXIT_DONE) {
        return ended;
    }
    ended = read_against(&r);
    if (ended != EXIT_DONE) {
        return ended;
    }

    // an interrupt leaves a table of what was judged
    const int result = run_cases(&r);
    const bool is_part = interrupted != 0 && r.found_count > 0;
    if (result == EXIT_DONE || is_part) {
        return worse(result, report_robustness(&r, result == EXIT_DONE));
    }
    return result;
}

static const option_row rows[] = {
    OPTION(TEXT, "laws", "LAW,LAW...", "control laws to judge (the scenario's)",
           PLACE(laws)),
    OPTION(FILE, "over", "SET",
           "file of what is drawn, a line PATH=a:b each (sets/robust.set)", PLACE(over)),
    OPTION(TEXT, "against", "LAW",
           "of cases: a law whose time from the start the others are held against",
           PLACE(against)),
    OPTION(WHOLE, "draw", "N",
           "instead of a set: N cases of errors that no law knows, of seeds S, S + 1 ...",
           PLACE(draw), .low = 1, .high = EXAM_MOST_CASES),
    OPTION(NUMBERS, "force", "F",
           "with --draw: a commanded force, may be repeated (the scenario's)",
           PLACE(forces), .low = 0, .high = 1e6, .unit = "N"),
    OPTION(FILE, "before", "FILE.json",
           "with --draw: what --json wrote of the same cases, to compare with",
           PLACE(before)),
    RUNS_OPTION("number of runs of each law (200; in each case 4)"),
    SEED_OPTION,
    JOBS_OPTION,
    DB_OPTION("keep every run, in FILE-LAW.sqlite; go on where they end"),
    OPTION(RESULT, "csv", "FILE|-", "write a row for each law", PLACE(csv)),
    OPTION(RESULT, "markdown", "FILE|-", "write the table as one of a Markdown page",
           PLACE(markdown)),
    PLOT_OPTION("draw the distribution of the overshoot, a curve for each law"),
};

const command robust_command = {
    .name = "robust",
    .group = GROUP_CONTROL,
    .summary = "Judge control laws over wrong beliefs, sensors, walls and starts",
    .operands = "SCENARIO",
    .least = 1,
    .most = 1,
    .takes_scenarios = true,
    .help =
        "Runs each law many times on the scenario, with beliefs, sensors, wall and "
        "start drawn from a set (a Latin hypercube, the same draws for every law), "
        "and says which share of the runs settles, leaves the wall and exceeds "
        "control.force_limit (without one, 1.3 times the command), and the median, "
        "the 90 % quantile and the worst of overshoot, settling time and steady "
        "error. '-': that many do not settle. back/there: the worst of the tip's "
        "largest speed towards the wall in the air after first contact, over that "
        "before it. over: of the peak, of arms with more than two links of the "
        "force's mean over 5 ms, as 'over of' says; --json and --csv have both.\n\n"
        "A set with lines 'case TITLE: PATH=VALUE; ...' gives a table of its cases, "
        "with the worst of the runs of each. Of control.settings each law gets those "
        "that it has.\n\n"
        "With --draw N the laws are examined instead: N cases, each with two or three "
        "errors of arm, wall, sensors, computer and beliefs from ranges that are "
        "stated in the manual, at each --force. A run is within the bounds with at "
        "most 30 % smoothed overshoot, settled in 0.3 s (0.6 s where contact is "
        "lost), 5 % steady error, and first contact at most 1.5 times as late as "
        "open-loop's. Shares are given with their 95 % interval, by kind of error, "
        "and beside --before. Around a scenario of identify -o the arms are those "
        "that its recordings leave possible.\n\n"
        "^C finishes the runs in hand, within five seconds, and judges what there is "
        "(exit status 130); with --db it goes on.\n",
    .options = {&set_options, &json_options, OWN_OPTIONS(rows), &quiet_options,
                &page_options},
    .use = judge_and_report,
};
