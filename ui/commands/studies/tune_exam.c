#include "ui/commands/studies/tune_exam.h"

#include <math.h>
#include <string.h>

#include "src/base/json.h"
#include "src/base/numbers.h"
#include "src/base/whole_file.h"
#include "src/study/robust/exam_tuning.h"
#include "ui/commands/progress.h"
#include "ui/commands/results.h"
#include "ui/commands/studies/robust_exam.h"

enum { EVALUATIONS = 400, UNSEEN_CASES = 480 };

// The exams of the values as given and as found, on cases that the search did not see.
enum { GIVEN, FOUND, JUDGED };

typedef struct exam_tuner {
    const arguments *arguments;
    const scenario *scenario;
    exam_tuning tuning;
    law_exam unseen[JUDGED];
    bool judged;
    bool shows_progress; // on a terminal, without --quiet
} exam_tuner;

static void exam_tuner_finish(exam_tuner *t)
{
    for (int i = 0; i < JUDGED; i++) {
        law_exam_finish(&t->unseen[i]);
    }
    exam_tuning_finish(&t->tuning);
}

// --- results ---------------------------------------------------------------------------

// The shares of unseen cases within the bounds, at each force.
static json_t *unseen_json(const exam_tuner *t)
{
    json_t *list = json_array();
    for (int k = 0; k < t->tuning.asked.force_count && t->judged; k++) {
        const exam_share given = law_exam_share(&t->unseen[GIVEN], 0, k, -1);
        const exam_share found = law_exam_share(&t->unseen[FOUND], 0, k, -1);
        json_add(list, json_of("force_N:n given:n tuned:n low:n high:n",
                               t->tuning.asked.forces[k], given.share, found.share,
                               found.low, found.high));
    }
    return list;
}

static json_t *exam_tuner_json(const void *tuner)
{
    const exam_tuner *t = tuner;
    const exam_tuning *tuned = &t->tuning;
    json_t *numbers = json_array();
    for (int i = 0; i < tuned->axis_count; i++) {
        json_add(numbers, json_of("path:t given:n value:n", tuned->axes[i].name,
                                  tuned->given[i], tuned->found[i]));
    }
    return json_of("scenario:t cases:i seed:i evaluations:i loss_given:n loss_tuned:n "
                   "tune:o unseen:o",
                   t->scenario->name, (int)tuned->asked.cases, (int)tuned->asked.seed,
                   (int)tuned->done, tuned->given_loss, tuned->found_loss, numbers,
                   unseen_json(t));
}

static void print_exam_tuning(const void *tuner)
{
    const exam_tuner *t = tuner;
    const exam_tuning *tuned = &t->tuning;
    say_title(t->scenario);
    say("loss %.4g, %.4g before, in %zu evaluations of %zu cases\n\n", tuned->found_loss,
        tuned->given_loss, tuned->done, tuned->asked.cases);
    say("  %-40s%13s%13s\n", "", "given", "tuned");
    for (int i = 0; i < tuned->axis_count; i++) {
        say("  %-40s%13.6g%13.6g\n", tuned->axes[i].name, tuned->given[i],
            tuned->found[i]);
    }
    if (!t->judged) {
        return;
    }

    say("\nwithin the bounds, of %zu cases that the search did not see [%%]\n",
        t->unseen[GIVEN].asked.cases);
    for (int k = 0; k < tuned->asked.force_count; k++) {
        const exam_share found = law_exam_share(&t->unseen[FOUND], 0, k, -1);
        say("  %-40g%13.1f%13.1f (%.1f to %.1f)\n", tuned->asked.forces[k],
            100 * law_exam_share(&t->unseen[GIVEN], 0, k, -1).share, 100 * found.share,
            100 * found.low, 100 * found.high);
    }
}

static void write_tuned_scenario(FILE *stream, const void *tuner)
{
    const exam_tuner *t = tuner;
    scenario best;
    if (exam_tuning_apply(&t->tuning, t->tuning.found, &best, NULL) == STATUS_OK) {
        scenario_write(stream, &best);
    }
}

// --- the search ------------------------------------------------------------------------

// Says on a terminal how far the search is, and writes the best so far where it is new.
static status keep_best_of_exam(void *context, const exam_tuning *tuned, bool better,
                                fault *f)
{
    const exam_tuner *t = context;
    const char *path = t->arguments->output;
    if (t->shows_progress) {
        fprintf(stderr, "\r%zu of %zu exams, loss %.4g ", tuned->done, tuned->evaluations,
                tuned->found_loss);
        fflush(stderr);
    }
    if (!better || path == NULL || strcmp(path, "-") == 0) {
        return STATUS_OK;
    }
    whole_file file;
    TRY(whole_file_open(&file, path, f));
    write_tuned_scenario(file.stream, t);
    return whole_file_commit(&file, f);
}

// Both on the cases behind those of the search.
static status judge_unseen(exam_tuner *t, const exam_options *options, fault *f)
{
    const exam_tuning *tuned = &t->tuning;
    const uint64_t seed = tuned->asked.seed + tuned->asked.cases;
    TRY(exam_tuning_exam(tuned, tuned->given, UNSEEN_CASES, seed, options,
                         &t->unseen[GIVEN], f));
    TRY(exam_tuning_exam(tuned, tuned->found, UNSEEN_CASES, seed, options,
                         &t->unseen[FOUND], f));
    t->judged = true;
    return STATUS_OK;
}

// Refuses what is of a search without an exam. Returns the exit status.
static int check_other_options(const arguments *a)
{
    const struct {
        const char *name;
        bool given;
    } others[] = {
        {"minimise", a->minimise != NULL}, {"subject", a->subject != NULL},
        {"over", a->over != NULL},         {"db", a->db != NULL},
        {"plot", a->plot != NULL},
    };
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++) {
        if (others[i].given) {
            return complain("--%s does not go with --draw, whose exam says what is small",
                            others[i].name);
        }
    }
    return EXIT_DONE;
}

int tune_over_exam(const arguments *a, const scenario *s)
{
    static const command_results results = {.json = exam_tuner_json,
                                            .text = print_exam_tuning,
                                            .output = write_tuned_scenario};
    exam_request asked = {.base = s,
                          .laws = {s->parameters.control.law},
                          .law_count = 1,
                          .cases = (size_t)a->draw,
                          .seed = a->seed};
    int ended = check_other_options(a);
    if (ended == EXIT_DONE && s->parameters.control.law == LAW_NONE) {
        ended = complain("%s has no control law to tune", s->name);
    }
    if (ended == EXIT_DONE) {
        ended = read_exam_forces(a, s, &asked);
    }
    if (ended != EXIT_DONE) {
        return ended;
    }

    // the search, and its judgement
    SCOPED(exam_tuner_finish) exam_tuner t = {.arguments = a, .scenario = s};
    const size_t evaluations = a->runs > 0 ? (size_t)a->runs : EVALUATIONS;
    fault f = {.path = ""};
    if (exam_tuning_init(&t.tuning, &asked, a->varies.items, a->varies.count, evaluations,
                         &f) != STATUS_OK) {
        return complain_fault(&f);
    }
    t.tuning.told = keep_best_of_exam;
    t.tuning.context = &t;
    const sweep_options many = many_runs_begin(a, "");
    t.shows_progress = many.report != NULL;
    const exam_options options = {.jobs = many.jobs,
                                  .stop = many.stop,
                                  .abandon = many.abandon};
    status code = exam_tuning_run(&t.tuning, &options, &f);
    if (code == STATUS_OK) {
        code = judge_unseen(&t, &options, &f);
    }
    many_runs_end(&many);

    // a search that was stopped tells what it has
    if (code != STATUS_OK && code != STATUS_STOPPED) {
        return complain_fault(&f);
    }
    ended = write_results(a, &results, &t, code == STATUS_OK);
    if (code == STATUS_STOPPED) {
        complain("the values are the best of %zu evaluations, not judged on other cases",
                 t.tuning.done);
        return EXIT_FAILED;
    }
    return ended;
}
