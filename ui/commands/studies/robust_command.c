// impactlab robust: control laws over many nominal models, sensors, walls and initial
// states.
#include "ui/commands/command.h"

#include <stdlib.h>
#include <string.h>

#include "render/plot/study_plot.h"
#include "src/rig/controller_values.h"
#include "src/rig/rig.h"
#include "src/study/store/sweep_store.h"
#include "src/study/robust.h"
#include "src/tables/settings.h"
#include "ui/commands/progress.h"
#include "ui/commands/command_pictures.h"

enum { DEFAULT_RUNS = 200, DEFAULT_CASE_RUNS = 4 };

// The shipped set, in the folder of the scenarios.
static const char default_set[] = "sets/robust.set";

// What the command line asks for, and what was found: by case, in it by law.
typedef struct robustness {
    const arguments *arguments;
    const scenario *scenario;
    robust_set set;
    int laws[LAW_COUNT +
             1]; // control_law; behind the last the one of --against, if it is given
    int count;   // of laws, that one left out
    int against; // its place, -1: none
    size_t runs; // of each law, in each case
    robust_law *found;
    int judged;
    size_t done; // runs of all laws in all cases
} robustness;

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

// The law of --against: one of those that are judged, or one more.
static int read_against(robustness *r)
{
    const char *word = r->arguments->against;
    r->against = -1;
    if (word == NULL) {
        return EXIT_DONE;
    }
    int law = find_law(word, strlen(word));
    if (law == LAW_NONE) {
        return complain("--against %s: no control law, expected one of control.law",
                        word);
    }
    if (r->set.case_count == 0) {
        return complain(
            "--against %s: the set has no cases, expected lines case TITLE: ... in it",
            word);
    }

    for (int i = 0; i < r->count; i++) {
        if (r->laws[i] == law) {
            r->against = i;
        }
    }
    if (r->against < 0) {
        r->against = r->count;
        r->laws[r->count] = law;
    }
    return EXIT_DONE;
}

// The laws of --laws, or the scenario's own.
static int read_laws(robustness *r)
{
    const char *rest = r->arguments->laws;
    if (rest == NULL) {
        r->laws[r->count++] = r->scenario->parameters.control.law;
    }

    // each of the words between commas
    while (rest != NULL) {
        size_t length = strcspn(rest, ",");
        int law = find_law(rest, length);
        if (law == LAW_NONE || r->count == LAW_COUNT) {
            return complain(
                "--laws %s: '%.*s' is no control law, expected those of control.law",
                r->arguments->laws, (int)length, rest);
        }
        r->laws[r->count++] = law;
        if (rest[length] == ',') {
            rest = rest + length + 1;
        } else {
            rest = NULL;
        }
    }

    // what cannot be run, or not be shown
    if (r->laws[0] == LAW_NONE) {
        return complain("%s has no control law, expected one or --laws",
                        r->scenario->name);
    }
    if (r->arguments->plot != NULL && r->count > ROBUST_MOST_CURVES) {
        return complain("--plot shows at most %d laws", ROBUST_MOST_CURVES);
    }
    return EXIT_DONE;
}

// What the set draws for each law, in each case.
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

// The set, and room for what will be found.
static int read_set(robustness *r)
{
    const arguments *a = r->arguments;
    SCOPED(free_kept)
    char *path = a->over == NULL ? scenario_folder_file(default_set) : NULL;
    const char *read = a->over != NULL ? a->over : path;
    fault f = {0};
    if (read != NULL) {
        if (robust_set_read(&r->set, read, &f) != STATUS_OK) {
            return complain_fault(&f);
        }
    } else {
        if (fault_no_memory(&f) != STATUS_OK) {
            return complain_fault(&f);
        }
    }
    if (r->set.case_count > 0 && a->plot != NULL) {
        return complain("--plot shows laws, not the cases of %s", a->over);
    }

    // what is drawn is the same in all cases
    bool cases = r->set.case_count > 0;
    if (a->runs > 0) {
        r->runs = (size_t)a->runs;
    } else if (cases) {
        r->runs = DEFAULT_CASE_RUNS;
    } else {
        r->runs = DEFAULT_RUNS;
    }
    const sweep_request request = request_of(r);
    SCOPED(sweep_finish) sweep plan;
    if (sweep_plan(&plan, &request, &f) != STATUS_OK) {
        return complain_fault(&f);
    }
    r->found = calloc((size_t)(cases ? r->set.case_count : 1) * (size_t)(r->count + 1),
                      sizeof *r->found);
    if (r->found == NULL) {
        if (fault_no_memory(&f) != STATUS_OK) {
            return complain_fault(&f);
        }
    }
    return EXIT_DONE;
}

// "a/b-LAW.sqlite" for --db a/b.sqlite, of case k (from 0) "a/b-LAW-3.sqlite" with its
// number from 1, on the heap; NULL without memory.
static char *place_of(const char *db, const char *law, int k)
{
    const char *slash = strrchr(db, '/'), *dot = strrchr(db, '.');
    bool ends = dot != NULL && (slash == NULL || dot > slash);
    int stem = (int)(ends ? (size_t)(dot - db) : strlen(db));
    char *path, number[16] = "";
    if (k >= 0) {
        snprintf(number, sizeof number, "-%d", k + 1);
    }
    int length = asprintf(&path, "%.*s-%s%s%s", stem, db, law, number, ends ? dot : "");
    if (length < 0) {
        return NULL;
    }
    return path;
}

// The runs of a law that are not in the store yet, and their judgement.
static int judge_law(robustness *r, const char *law, int k, const sweep *s)
{
    const arguments *a = r->arguments;
    fault f = {0};
    char word[64];
    SCOPED(free_kept) char *db = a->db != NULL ? place_of(a->db, law, k) : NULL;
    SCOPED(sweep_store_close_kept) sweep_store *store = NULL;
    sweep_progress progress = {0};
    snprintf(word, sizeof word, "%-16.40s", law);
    const sweep_options options = many_runs_begin(a, word);

    // the runs
    status code;
    if (a->db != NULL && db == NULL) {
        code = fault_no_memory(&f);
    } else {
        code = sweep_store_open(&store, db, s, &f);
    }
    if (code == STATUS_OK) {
        code = sweep_run(s, store, &options, &progress, &f);
    }
    many_runs_end(&options);

    // all of them are there, or what there is
    bool stopped = code == STATUS_OK && progress.done < progress.total;
    r->done += progress.done;
    const bool tell =
        progress.failed > 0 && (!a->quiet || progress.failed == progress.total);
    if (code == STATUS_OK && tell) {
        many_runs_report_failure(&progress);
    }
    if (code == STATUS_OK && progress.done > 0) {
        robust_law *found = &r->found[r->judged++];
        code = robust_law_of(found, law, s, (sweep_share){0}, store, &f);
        if (k >= 0) {
            found->case_title = r->set.cases[k].title;
        } else {
            found->case_title = NULL;
        }
    }
    if (code != STATUS_OK) {
        return complain_fault(&f);
    }
    if (stopped) {
        const int cases = r->set.case_count > 0 ? r->set.case_count : 1,
                  laws = r->count + (r->against == r->count);
        return many_runs_stopped(db, r->done, r->runs * (size_t)(cases * laws),
                                 r->done > 0 ? "the table is that of these"
                                             : "none is shown");
    }
    return EXIT_DONE;
}

// Whether the scenario's own law or one that is judged has a parameter of that name. The
// parameters of a plug-in or a program are not known here: it may have any.
static bool others_have_parameter(const robustness *r, const char *name)
{
    const int own = r->scenario->parameters.control.law,
              laws = r->count + (r->against == r->count);
    bool known = false;
    for (int i = own == LAW_NONE ? 0 : -1; i < laws && !known; i++) {
        const controller *law = controller_of(i < 0 ? own : r->laws[i]);
        known = law == NULL || controller_find_parameter(law, name) >= 0;
    }
    return known;
}

// Leaves a law those settings that it has, and says which it does without (`tell`). What
// no law has stays, and is refused.
static void fit_settings(const robustness *r, int law, control_parameters *control,
                         bool tell)
{
    const controller *known = controller_of(law);
    char kept[sizeof control->settings] = "", left[sizeof control->settings] = "";
    if (known == NULL) {
        return;
    }

    // word by word
    const char *rest = control->settings;
    setting s;
    while (settings_next(&rest, &s)) {
        bool stays = controller_find_parameter(known, s.name) >= 0 ||
                     !others_have_parameter(r, s.name);
        char *list = stays ? kept : left;
        size_t used = strlen(list);
        snprintf(list + used, sizeof kept - used, "%s%.*s", used > 0 ? " " : "",
                 (int)s.length, s.word);
    }

    memcpy(control->settings, kept, sizeof kept);
    if (tell && left[0] != '\0') {
        complain("%s runs without '%s' of control.settings, which it does not have",
                 control_law_table[law].word, left);
    }
}

// What a law gets to do under case k of the set, -1: under the scenario as it is. The
// same draws for every law. `base` and `under` last as long as the sweep; `tell` says
// which settings it does without.
static int open_law(const robustness *r, const scenario *base, int which, int k,
                    bool tell, scenario *under, sweep *s)
{
    fault f = {0};
    const sweep_request request = request_of(r);
    *under = *base; // borrows all but its parameters
    under->parameters.control.law = r->laws[which];
    under->parameters.set[PARAMETER_INDEX(control.law)] = 1;

    // said once, and where a case has settings of its own
    const bool own = strcmp(under->parameters.control.settings,
                            r->scenario->parameters.control.settings) != 0;
    fit_settings(r, r->laws[which], &under->parameters.control, (k <= 0 || own) && tell);
    if (parameters_resolve(&under->parameters, &f) != STATUS_OK ||
        sweep_init(s, under, &request, &f) != STATUS_OK) {
        fault of_case = f;
        if (k >= 0) {
            robust_case_fault(&r->set.cases[k], &f, &of_case);
        }
        return complain_fault(&of_case);
    }
    return EXIT_DONE;
}

// All laws under case k (-1: the scenario as it is), looked at or run. Everything that
// can be wrong with a case is known before the first one is run.
static int take_case(robustness *r, int k, bool run)
{
    SCOPED(robust_case_finish) scenario base;
    const robust_case *c = k >= 0 ? &r->set.cases[k] : NULL;
    fault f = {0};
    if (robust_case_scenario(&base, r->scenario, c, &f) != STATUS_OK) {
        return complain_fault(&f);
    }
    for (int i = 0; i < r->count + (r->against == r->count); i++) {
        scenario under;
        SCOPED(sweep_finish) sweep s = {0};
        int ended = open_law(r, &base, i, k, run && !r->arguments->quiet, &under, &s);
        if (ended != EXIT_DONE) {
            return ended;
        }
        ended = run ? judge_law(r, control_law_table[r->laws[i]].word, k, &s) : EXIT_DONE;
        if (ended != EXIT_DONE) {
            return ended;
        }
    }
    return EXIT_DONE;
}

// Runs all laws under case k, and compares them with that of --against.
static int run_case(robustness *r, int k)
{
    const int first = r->judged;
    int ended = take_case(r, k, true);
    if (ended != EXIT_DONE) {
        return ended;
    }

    // its own line is shown only where it was asked for
    if (r->against >= 0) {
        double other = r->found[first + r->against].from_start[ROBUST_WORST];
        for (int i = 0; i < r->count; i++) {
            r->found[first + i].against =
                r->found[first + i].from_start[ROBUST_WORST] / other;
        }
        if (r->against == r->count) {
            robust_law_finish(&r->found[--r->judged]);
        }
    }
    return EXIT_DONE;
}

RESULT_GIVEN(json_t *, table_json, robust_table, return robust_json(found))
RESULT_GIVEN(void, print_table, robust_table, robust_text(stdout, found, false))
RESULT_WRITER(write_markdown, robust_table, robust_text(stream, found, true))
RESULT_WRITER(write_csv, robust_table, robust_csv(stream, found))

static int plot(const arguments *a, const scenario *s, const void *table)
{
    char changes[SCENARIO_CHANGES];
    return publish_owned(a, robust_figure_create(table, scenario_changes(s, changes)));
}

static int report(const robustness *r, bool whole)
{
    static const command_results written = {
        table_json,        print_table, plot, write_csv, .markdown = write_markdown,
        .draws_part = true};
    const robust_table table = {r->scenario->name, r->found, r->judged,
                                r->arguments->against};
    const int code = write_results(r->arguments, &written, r->scenario, &table, whole);

    // nothing to judge is a failure
    bool any = false;
    for (int i = 0; i < r->judged; i++) {
        any = any || r->found[i].failed < r->found[i].runs;
    }
    if (any) {
        return code;
    }
    return worse(code, EXIT_FAILED);
}

static void finish(robustness *r)
{
    for (int i = 0; i < r->judged; i++) {
        robust_law_finish(&r->found[i]);
    }
    free(r->found);
    robust_set_finish(&r->set);
}

static int robust(const arguments *a, scenario *s)
{
    SCOPED(finish) robustness r = {.arguments = a, .scenario = s};
    int ended = read_laws(&r);
    if (ended != EXIT_DONE) {
        return ended;
    }
    ended = read_set(&r);
    if (ended != EXIT_DONE) {
        return ended;
    }
    ended = read_against(&r);
    if (ended != EXIT_DONE) {
        return ended;
    }

    // case by case, or the scenario as it is; faults of all cases are told
    const int last = r.set.case_count - 1, begin = last < 0 ? -1 : 0;
    int code = EXIT_DONE;
    for (int k = begin; k <= last; k++) {
        code = worse(code, take_case(&r, k, false));
    }
    for (int k = begin; k <= last && code == EXIT_DONE; k++) {
        code = run_case(&r, k);
    }
    const bool part = interrupted != 0 && r.judged > 0;
    if (code == EXIT_DONE || part) {
        return worse(code, report(&r, code == EXIT_DONE));
    }
    return code;
}

static const option_row rows[] = {
    OPTION(TEXT, "laws", "LAW,LAW...", "control laws to judge (the scenario's)",
           PLACE(laws)),
    OPTION(FILE, "over", "SET",
           "file of what is drawn, a line PATH=a:b each (sets/robust.set)", PLACE(over)),
    OPTION(TEXT, "against", "LAW",
           "of cases: a law whose time from the start the others are held against",
           PLACE(against)),
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
    CALLED("robust", CONTROL, "How control laws stand what they were not told"),
    ONE_SCENARIO,
    .help =
        "Runs each law many times on the scenario, with beliefs, sensors, wall and start "
        "drawn "
        "from a set (a Latin\nhypercube, the same draws for every law), and says which "
        "share "
        "of the runs settles, leaves the wall\nand exceeds control.force_limit (without "
        "one, "
        "1.3 times the command), and the median, the 90 %\nquantile and the worst of "
        "overshoot, settling time and steady error. '-': that many do not settle. "
        "back/there: "
        "the worst of the\ntip's largest speed towards the wall in the air after first "
        "contact, over that before it. over: of the peak, of arms with more than two "
        "links of "
        "the force's mean over\n5 ms, as 'over of' says; --json and --csv have both.\n\n"
        "A set with lines 'case TITLE: PATH=VALUE; ...' gives a table of its cases, with "
        "the "
        "worst of the\nruns of each. Of control.settings each law gets those that it "
        "has.\n\n"
        "^C finishes the runs in hand, within five seconds, and judges what there is "
        "(exit "
        "status 130); with --db it goes on.\n",
    .options = {&set_options, &json_options, OWN_OPTIONS(rows), &quiet_options,
                &page_options},
    .use = robust,
};
