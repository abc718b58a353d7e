#include "ui/commands/studies/robust_exam.h"

#include <math.h>
#include <string.h>
#include <unistd.h>

#include "src/study/robust/law_exam.h"
#include "ui/commands/progress.h"
#include "ui/commands/results.h"

// What the writers of results get.
typedef struct exam_found {
    const law_exam *exam;
    const exam_rows *before; // NULL: none were given
} exam_found;

// The judgement of each law, as JSON.
static json_t *exam_json(const void *found)
{
    const exam_found *e = found;
    return law_exam_json(e->exam, e->before);
}

// The judgement of each law, as text.
static void print_exam(const void *found)
{
    const exam_found *e = found;
    law_exam_text(stdout, e->exam, e->before);
}

// A row for each run of each law.
static void write_exam_csv(FILE *stream, const void *found)
{
    const exam_found *e = found;
    law_exam_csv(stream, e->exam);
}

// How far the exam is, on the line of the one before.
static void show_exam_progress(const law_exam *e)
{
    fprintf(stderr, "\r%zu of %zu runs ", e->done, e->runs);
    fflush(stderr);
}

// Refuses options that are of draws from a set. Returns the exit status.
static int check_exam_options(const arguments *a)
{
    const struct {
        const char *name;
        bool given;
    } others[] = {
        {"over", a->over != NULL},
        {"against", a->against != NULL},
        {"runs", a->runs > 0},
        {"db", a->db != NULL},
        {"markdown", a->markdown != NULL},
        {"plot", a->plot != NULL},
    };
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++) {
        if (others[i].given) {
            return complain("--%s does not go with --draw, which judges cases of its own",
                            others[i].name);
        }
    }
    return EXIT_DONE;
}

int read_exam_forces(const arguments *a, const scenario *s, exam_request *asked)
{
    asked->force_count = a->forces.count;
    if (asked->force_count > EXAM_MOST_FORCES) {
        return complain("--force can be given %d times at most", EXAM_MOST_FORCES);
    }

    // each of them
    for (int k = 0; k < asked->force_count; k++) {
        asked->forces[k] = a->forces.numbers[k];
        if (!(asked->forces[k] > 0)) {
            return complain("--force %g: expected a force above 0 N", asked->forces[k]);
        }
    }

    // none is given
    if (asked->force_count == 0) {
        asked->forces[asked->force_count++] = s->parameters.control.force;
    }
    if (!(asked->forces[0] > 0)) {
        return complain("%s commands no force, expected one or --force", s->name);
    }
    return EXIT_DONE;
}

int robust_exam(const arguments *a, const scenario *s, const int *laws, int law_count)
{
    static const command_results results = {.json = exam_json,
                                            .text = print_exam,
                                            .csv = write_exam_csv};
    exam_request asked = {.base = s,
                          .law_count = law_count,
                          .cases = (size_t)a->draw,
                          .seed = a->seed};
    if (law_count > EXAM_MOST_LAWS) {
        return complain("--laws: --draw judges at most %d laws", EXAM_MOST_LAWS);
    }
    memcpy(asked.laws, laws, (size_t)law_count * sizeof *laws);
    int code = check_exam_options(a);
    if (code == EXIT_DONE) {
        code = read_exam_forces(a, s, &asked);
    }
    if (code != EXIT_DONE) {
        return code;
    }

    // the runs
    const sweep_options many = many_runs_begin(a, "");
    exam_options options = {.jobs = many.jobs,
                            .stop = many.stop,
                            .abandon = many.abandon};
    if (many.report != NULL) {
        options.report = show_exam_progress;
    }
    SCOPED(law_exam_finish) law_exam e;
    fault f = {.path = ""};
    const status ran = law_exam_run(&e, &asked, &options, &f);
    many_runs_end(&many);
    const bool is_part = ran == STATUS_STOPPED && e.asked.cases > 0;
    if (ran != STATUS_OK && !is_part) {
        return complain_fault(&f);
    }

    // beside those of before
    SCOPED(exam_rows_finish) exam_rows before = {.path = a->before};
    exam_found found = {.exam = &e, .before = NULL};
    if (a->before != NULL) {
        if (exam_rows_read(&before, a->before, &e, &f) != STATUS_OK) {
            return complain_fault(&f);
        }
        found.before = &before;
    }
    code = write_results(a, &results, &found, !is_part);
    if (is_part) {
        complain("stopped: %zu of %zu cases were done, the table is that of these",
                 e.asked.cases, asked.cases);
        return EXIT_FAILED;
    }
    return code;
}
