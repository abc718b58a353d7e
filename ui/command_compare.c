#include "ui/command.h"

#include <stdlib.h>

#include "src/lab/compare.h"
#include "src/words.h"

enum { MOST_SCENARIOS = 1000 };

// The scenarios named on the command line, and then the one that they are held against.
typedef struct comparison {
    scenario *scenarios;
    compare_row *rows;
    int opened, done;
    bool failed;
} comparison;

static void finish(comparison *c)
{
    for (int i = 0; i < c->opened; i++) {
        scenario_finish(&c->scenarios[i]);
    }
    free(c->scenarios);
    free(c->rows);
}

static int open_all(comparison *c, const arguments *a, int count)
{
    c->scenarios = calloc((size_t)count, sizeof *c->scenarios);
    c->rows = calloc((size_t)count, sizeof *c->rows);
    if (c->scenarios == NULL || c->rows == NULL) {
        complain("out of memory");
        return EXIT_FAILED;
    }
    for (int i = 0; i < count; i++) {
        const char *name = i < a->operand_count ? a->operands[i] : a->against;
        int result = open_scenario(&c->scenarios[i], name, a);
        if (result != EXIT_DONE) {
            return result;
        }
        c->opened++;
    }
    return EXIT_DONE;
}

// Runs them one after the other. One that fails keeps its row and is complained about.
static void run_all(comparison *c)
{
    for (int i = 0; i < c->opened; i++) {
        run_result result;
        scenario *s = &c->scenarios[i];
        if (run_scenario(s, false, &result) != STATUS_OK) {
            complain("%s failed: %s", s->name, result.summary.message);
            c->failed = true;
        }
        c->rows[i] = compare_row_of(s, &result.summary);
        run_finish(&result);
    }
}

static int write_csv(const char *path, const compare_row *rows, int count)
{
    whole_file file;
    fault f = {0};
    status code = whole_file_open(&file, path, &f);
    if (code == STATUS_OK) {
        compare_csv(file.stream, rows, count);
        code = whole_file_commit(&file, &f);
    }
    return code == STATUS_OK ? EXIT_DONE : complain_fault(&f);
}

// A tolerance in percent as a share; false if it is none.
static bool read_tolerance(const char *text, double *share)
{
    const char *rest = "";
    double percent = 5;
    if (text != NULL && (!decimal_read(text, &percent, &rest) || *rest != '\0' || percent < 0)) {
        return false;
    }
    *share = percent / 100;
    return true;
}

static int write_results(const arguments *a, const comparison *c, double tolerance)
{
    const compare_row *against = a->against != NULL ? &c->rows[a->operand_count] : NULL;
    int result = c->failed ? EXIT_FAILED : EXIT_DONE;
    if (a->json != NULL && write_json(a->json, compare_json(c->rows, a->operand_count, against,
                                                            tolerance)) != EXIT_DONE) {
        result = EXIT_FAILED;
    }
    if (a->csv != NULL && write_csv(a->csv, c->rows, a->operand_count) != EXIT_DONE) {
        result = EXIT_FAILED;
    }
    if (summary_wanted(a)) {
        compare_text(stdout, c->rows, a->operand_count, against, tolerance);
        if (against != NULL) {
            printf("\n* differs from %s by more than %g %%\n", against->scenario, 100 * tolerance);
        }
    }
    return result;
}

static int compare(const arguments *a)
{
    comparison c = {0};
    double tolerance;
    if (!read_tolerance(a->tolerance, &tolerance)) {
        return complain("--tolerance %s is wrong, expected a number of percent from 0",
                        a->tolerance);
    }
    int result = check_output(a->json);
    result = result == EXIT_DONE ? check_output(a->csv) : result;
    if (result == EXIT_DONE) {
        result = open_all(&c, a, a->operand_count + (a->against != NULL));
    }
    if (result == EXIT_DONE) {
        run_all(&c);
        result = write_results(a, &c, tolerance);
    }
    finish(&c);
    return result;
}

const command compare_command = {
    .name = "compare",
    .operands = "SCENARIO...",
    .options = "sjCAtq",
    .summary = "Several scenarios in one table",
    .help = "One row a run: peak force, its overshoot over the commanded force, settling time, "
            "impacts,\nseparations, steady error, largest command and electrical energy. --set "
            "holds for all of them.\n",
    .least = 1,
    .most = MOST_SCENARIOS,
    .run = compare,
};
