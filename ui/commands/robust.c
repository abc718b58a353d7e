// impactlab robust: control laws over many beliefs, sensors, walls and starts.
#include "ui/commands/command.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "render/plot/robust_plot.h"
#include "src/study/robust.h"
#include "src/study/sweep_run.h"
#include "ui/commands/pictures.h"

enum { MOST_LAWS = LAW_COUNT, DEFAULT_RUNS = 200 };

// The shipped set, in the folder of the scenarios.
static const char default_set[] = "sets/robust.set";

// What the command line asks for, and what was found for each law.
typedef struct robustness {
    const arguments *arguments;
    scenario scenario;
    robust_set set;
    int laws[MOST_LAWS]; // control_law
    int count;
    robust_law found[MOST_LAWS];
    int judged;
} robustness;

static void finish(robustness *r)
{
    for (int i = 0; i < r->judged; i++) {
        robust_law_finish(&r->found[i]);
    }
    robust_set_finish(&r->set);
    scenario_finish(&r->scenario);
}

// The laws of --laws, or the scenario's own.
static int read_laws(robustness *r)
{
    const char *rest = r->arguments->laws;
    if (rest == NULL) {
        r->laws[r->count++] = r->scenario.parameters.control.law;
    }
    while (rest != NULL) {
        size_t length = strcspn(rest, ",");
        int law = LAW_NONE;
        for (int i = 0; i < LAW_COUNT; i++) {
            const char *word = control_law_table[i].word;
            law = strlen(word) == length && strncmp(word, rest, length) == 0 ? i : law;
        }
        if (law == LAW_NONE || r->count == MOST_LAWS) {
            return complain("--laws %s: '%.*s' is no control law, expected those of control.law",
                            r->arguments->laws, (int)length, rest);
        }
        r->laws[r->count++] = law;
        rest = rest[length] == ',' ? rest + length + 1 : NULL;
    }
    if (r->laws[0] == LAW_NONE) {
        return complain("%s has no control law, expected one or --laws", r->scenario.name);
    }
    if (r->arguments->plot != NULL && r->count > ROBUST_MOST_CURVES) {
        return complain("--plot shows at most %d laws", ROBUST_MOST_CURVES);
    }
    return EXIT_DONE;
}

static int read_set(robustness *r)
{
    fault f = {0};
    status code;
    if (r->arguments->over != NULL) {
        code = robust_set_read(&r->set, r->arguments->over, &f);
    } else {
        char *path = scenario_folder_file(default_set);
        code = path != NULL ? robust_set_read(&r->set, path, &f) : fault_no_memory(&f);
        free(path);
    }
    return code == STATUS_OK ? EXIT_DONE : complain_fault(&f);
}

// "a/b-LAW.sqlite" for --db a/b.sqlite, on the heap; NULL without memory.
static char *place_of(const char *db, const char *law)
{
    const char *slash = strrchr(db, '/'), *dot = strrchr(db, '.');
    bool ends = dot != NULL && (slash == NULL || dot > slash);
    int stem = (int)(ends ? (size_t)(dot - db) : strlen(db));
    char *path;
    int length = asprintf(&path, "%.*s-%s%s", stem, db, law, ends ? dot : "");
    return length < 0 ? NULL : path;
}

// The runs of a law that are not in the store yet, and their judgement.
static int judge_law(robustness *r, int which, const sweep *s)
{
    const arguments *a = r->arguments;
    const char *word = control_law_table[r->laws[which]].word;
    fault f = {0};
    sweep_store *store = NULL;
    sweep_progress progress;
    sweep_options options = {.jobs = 1};
    long processors = sysconf(_SC_NPROCESSORS_ONLN);
    options.jobs = a->jobs > 0                    ? (int)a->jobs
                   : processors > SWEEP_MOST_JOBS ? SWEEP_MOST_JOBS
                   : processors > 1               ? (int)processors
                                                  : 1;

    char *db = a->db != NULL ? place_of(a->db, word) : NULL;
    status code =
        a->db != NULL && db == NULL ? fault_no_memory(&f) : sweep_store_open(&store, db, s, &f);
    code = code == STATUS_OK ? sweep_run(s, store, &options, &progress, &f) : code;
    if (code == STATUS_OK) {
        r->judged++;
        code = robust_law_of(&r->found[which], word, s, store, &f);
    }
    sweep_store_close(store);
    free(db);
    return code == STATUS_OK ? EXIT_DONE : complain_fault(&f);
}

// The same draws for every law.
static int run_law(robustness *r, int which)
{
    fault f = {0};
    sweep s;
    scenario under = r->scenario; // borrows all but its parameters
    sweep_request request = {.vary = r->set.lines,
                             .vary_count = r->set.count,
                             .sampling = SWEEP_LATIN,
                             .runs =
                                 r->arguments->runs > 0 ? (size_t)r->arguments->runs : DEFAULT_RUNS,
                             .seed = r->arguments->seed};
    under.parameters.control.law = r->laws[which];
    under.parameters.set[PARAMETER_INDEX(control.law)] = 1;
    if (parameters_resolve(&under.parameters, &f) != STATUS_OK ||
        sweep_init(&s, &under, &request, &f) != STATUS_OK) {
        return complain_fault(&f);
    }
    int code = judge_law(r, which, &s);
    sweep_finish(&s);
    return code;
}

static void write_markdown(FILE *stream, const void *table)
{
    robust_markdown(stream, table);
}

static void write_csv(FILE *stream, const void *table)
{
    robust_csv(stream, table);
}

static int write_results(const robustness *r)
{
    const arguments *a = r->arguments;
    robust_table table = {r->scenario.name, r->found, r->count};
    int code = EXIT_DONE;
    if (a->json != NULL) {
        code = worse(code, write_json(a->json, robust_json(&table)));
    }
    if (a->csv != NULL) {
        code = worse(code, write_file(a->csv, write_csv, &table));
    }
    if (a->markdown != NULL) {
        code = worse(code, write_file(a->markdown, write_markdown, &table));
    }
    if (a->plot != NULL) {
        robust_figure *drawn = robust_figure_create(&table);
        code = worse(code, publish_figure(a, robust_figure_of(drawn)));
        robust_figure_destroy(drawn);
    }
    if (summary_wanted(a)) {
        robust_text(stdout, &table);
    }
    return code;
}

static int robust(const arguments *a)
{
    robustness r = {.arguments = a};
    int code = open_scenario(&r.scenario, a->operands[0], a);
    if (code != EXIT_DONE) {
        return code;
    }
    code = read_laws(&r);
    code = code == EXIT_DONE ? read_set(&r) : code;
    for (int i = 0; i < r.count && code == EXIT_DONE; i++) {
        code = run_law(&r, i);
    }
    code = code == EXIT_DONE ? write_results(&r) : code;
    finish(&r);
    return code;
}

static const option_row rows[] = {
    {.name = "laws",
     .type = OPTION_TEXT,
     .value = "LAW,LAW...",
     .help = "control laws to judge (the scenario's)",
     PLACE(laws)},
    {.name = "over",
     .type = OPTION_FILE,
     .value = "SET",
     .help = "file of what is drawn, a line PATH=a:b each (sets/robust.set)",
     PLACE(over)},
    {.name = "runs",
     .type = OPTION_WHOLE,
     .value = "N",
     .help = "number of runs of each law (200)",
     PLACE(runs),
     .low = 1,
     .high = SWEEP_MOST_RUNS},
    {.name = "seed",
     .type = OPTION_WHOLE,
     .value = "S",
     .help = "start of the random numbers (0)",
     PLACE(seed),
     .high = HUGE_VAL},
    {.name = "jobs",
     .type = OPTION_WHOLE,
     .value = "J",
     .help = "number of runs at a time (as many as processors)",
     PLACE(jobs),
     .low = 1,
     .high = SWEEP_MOST_JOBS},
    {.name = "db",
     .type = OPTION_PLACE,
     .value = "FILE.sqlite",
     .help = "keep every run, in FILE-LAW.sqlite; go on where they end",
     PLACE(db)},
    {.name = "csv",
     .type = OPTION_RESULT,
     .value = "FILE|-",
     .help = "write a row for each law",
     PLACE(csv)},
    {.name = "markdown",
     .type = OPTION_RESULT,
     .value = "FILE|-",
     .help = "write the table as one of a Markdown page",
     PLACE(markdown)},
    PLOT_OPTION("draw the distribution of the overshoot, a curve for each law"),
};
static const option_table options = OPTION_TABLE("Options", rows);

const command robust_command = {
    .name = "robust",
    .group = GROUP_CONTROL,
    .operands = "SCENARIO",
    .summary = "How control laws stand what they were not told",
    .help =
        "Runs each law many times on the scenario, with beliefs, sensors, wall and start drawn "
        "from a set (a Latin\nhypercube, the same draws for every law), and says which share "
        "of the runs settles, leaves the wall\nand exceeds control.force_limit (without one, "
        "1.3 times the command), and the median, the 90 %\nquantile and the worst of overshoot, "
        "settling time and steady error. '-': that many do not settle.\n",
    .least = 1,
    .most = 1,
    .takes_scenarios = true,
    .options = {&set_options, &json_options, &options, &quiet_options, &page_options},
    .run = robust,
};
