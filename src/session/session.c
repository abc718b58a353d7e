// A session: its cursor and the run that is computed from a scenario and its inputs.
#include "src/session/session.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/text_stream.h"
#include "src/run/background_run.h"
#include "src/run/resume.h"
#include "src/base/instant.h"

// --- the cursor ---

// Notes that the cursor has been at its instant.
static void note_seen(session *s)
{
    s->seen = fmax(s->seen, s->now);
}

const sample *session_sample(const session *s)
{
    assert(s->row < s->run.trace.row_count);
    return &s->run.trace.rows[s->row];
}

double session_end(const session *s)
{
    assert(s->run.trace.row_count > 0);
    return s->run.trace.rows[s->run.trace.row_count - 1].time;
}

// Moves the cursor to an instant of the run, and to the row there.
void session_seek(session *s, double time)
{
    double end = session_end(s);

    // the cursor may stand beyond the rows of a run that is still being computed
    if (s->computing != NULL && s->now > end) {
        end = s->now;
    }
    if (time > end) {
        s->now = end;
    } else if (time > 0) {
        s->now = time;
    } else {
        s->now = 0;
    }
    s->row = trace_row_at(&s->run.trace, s->now);

    // an instant that differs from the next row's by rounding is that row's instant, so
    // that a change there cuts no other step
    if (s->row + 1 < s->run.trace.row_count) {
        const double next = s->run.trace.rows[s->row + 1].time;
        if (next > s->now && same_instant(next, s->now)) {
            session_seek(s, next);
        }
    }
    note_seen(s);
}

// Moves the cursor by rows, as far as there are any.
bool session_step(session *s, long rows)
{
    long last = (long)s->run.trace.row_count - 1, to = (long)s->row + rows;
    if (to < 0) {
        to = 0;
    } else if (to > last) {
        to = last;
    }

    bool moved = to != (long)s->row;
    s->row = (size_t)to;
    s->now = session_sample(s)->time;
    note_seen(s);
    return moved;
}

const event *session_event(const session *s)
{
    for (size_t i = 0; i < s->run.trace.event_count; i++) {
        if (s->run.trace.events[i].time == s->now) {
            return &s->run.trace.events[i];
        }
    }
    return NULL;
}

void session_input_take(session_input *in, const parameters *p)
{
    const char *given = in->text + strspn(in->text, " ");
    const action a = action_of(in->time, p, in->parameter, given);
    in->value = a.value;
    memcpy(in->kept, a.text, sizeof in->kept);
}

action session_input_action(const session_input *in)
{
    action a = {.time = in->time,
                .kind = ACTION_SET,
                .parameter = in->parameter,
                .value = in->value,
                .added = true};
    if (in->kind == SESSION_INPUT_PUSH) {
        a.kind = ACTION_PUSH;
    }
    memcpy(a.text, in->kept, sizeof a.text);
    return a;
}

// --- the run ---

#define MEMORY_BUDGET (512.0 * 1024 * 1024) // rows of one run [bytes]
#define ROW_SPARE     1.5                   // rows of events beside those of the grid
#define SHORT_WAIT    0.001 // for the first row of a run that takes long [s]

enum { ROWS_SURVEYED = 50000 }; // at once, for the largest force of an incomplete run

status session_scenario(const scenario *base, const session_input *inputs, int count,
                        scenario *to, fault *f)
{
    // the base without its script
    *to = *base;
    to->expectation_count = 0;
    to->action_count = 0;
    to->actions = calloc((size_t)(base->action_count + count) + 1, sizeof *to->actions);
    if (to->actions == NULL) {
        return fault_no_memory(f);
    }

    // the script's actions, then the inputs: an input comes after the script's actions of
    // the same instant
    for (int i = 0; i < base->action_count; i++) {
        scenario_insert_action(to, base->actions[i]);
    }
    for (int i = 0; i < count; i++) {
        const session_input *in = &inputs[i];
        const action a = session_input_action(in);
        if (in->kind == SESSION_INPUT_START) {
            TRY(action_give(&a, &to->parameters, f));
        } else {
            scenario_insert_action(to, a);
        }
    }
    return parameters_resolve(&to->parameters, f);
}

static double expected_rows(const parameters *p)
{
    return p->run.duration / p->method.step * ROW_SPARE;
}

// Refuses a run whose rows would not fit into the budget.
static status check_memory(const parameters *p, fault *f)
{
    const double rows = expected_rows(p);
    const double bytes = rows * (double)trace_row_bytes(p->arm.links + 1);
    FAULT_IF(bytes > MEMORY_BUDGET, f, STATUS_BAD_ARGUMENT,
             "%g s in steps of %g s would keep %.0f MiB of rows, the lab keeps at "
             "most %.0f: shorten run.duration or lengthen method.step",
             p->run.duration, p->method.step, bytes / (1024 * 1024),
             MEMORY_BUDGET / (1024 * 1024));
    return STATUS_OK;
}

// Puts the run that was being computed in the place of the present one, as far as it
// went. The cursor may be beyond its end.
static void collect_run(session *s)
{
    s->run = background_run_finish(s->computing);
    s->computing = NULL;
}

// Ends what is being computed; false if there is nothing, or it was just over.
static bool end_computing(session *s)
{
    if (s->computing == NULL) {
        return false;
    }
    background_run_stop(s->computing);
    collect_run(s);
    return s->run.summary.status == STATUS_STOPPED;
}

// Sets the stamp of the files and programs that parameters name; returns whether the
// present run's stamp is the same.
static bool outside_is_same(session *s, const parameters *p, char stamp[SHA256_TEXT])
{
    // without a consent only data files are looked at, no program
    unsigned looked_at = ~0u;
    if (!p->code_allowed) {
        looked_at = outside_files();
    }
    outside_stamp(looked_at, p, stamp);
    return strcmp(stamp, s->outside) == 0;
}

// Sets the digest of all that a run reads from outside: the present run's one if that
// read the same files (`same`), and an empty one if there is no consent to read them.
static void digest_of_outside(const session *s, const parameters *p, bool same,
                              char digest[SHA256_TEXT])
{
    const unsigned reads = outside_read(p);
    if (!p->code_allowed && (reads & ~outside_files()) != 0) {
        digest[0] = '\0';
    } else if (!same || reads != outside_read(&s->effective.parameters)) {
        outside_digest_all(p, digest);
    } else {
        memcpy(digest, s->digest, SHA256_TEXT);
    }
}

// Waits for a run within the session's patience, and then for its first row. *run
// receives what there is of it. Returns the run, or NULL if it is over.
static background_run *wait_for_run(const session *s, background_run *c, run_result *run)
{
    bool over = background_run_wait(c, fmin(s->patience, 1e6));
    while (!over && background_run_look(c, run) == 0) {
        over = background_run_wait(c, SHORT_WAIT);
    }

    if (over) {
        *run = background_run_finish(c);
        return NULL;
    }

    summary_init(&run->summary);
    run->history = (run_history){0};
    return c;
}

// Why a run has not a single row.
static status fault_of_empty_run(const run_result *run, fault *f)
{
    if (run->summary.status != STATUS_OK) {
        return summary_fault(&run->summary, f);
    }
    return fault_no_memory(f);
}

// Computes the run of a scenario, from the present run's rows as far as both are the
// same. A run that takes longer than the session's patience goes on in its thread. On
// failure the present run stays.
static status start_run(session *s, const scenario *effective, fault *f)
{
    const parameters *p = &effective->parameters;
    const size_t rows = (size_t)expected_rows(p) + 1;

    // resume the present run if both read the same files, with the rows both share
    char stamp[SHA256_TEXT], digest[SHA256_TEXT];
    const bool same = outside_is_same(s, p, stamp);
    digest_of_outside(s, p, same, digest);
    run_result run = {.landing = {.time = 0}}, *resumed = NULL;
    if (same && run_resume(&s->run, &s->effective, effective, rows, &run)) {
        resumed = &run;
    }

    const background_options how = {.rows_expected = rows, .at_once = isinf(s->patience)};
    background_run *c = background_run_start(effective, &how, resumed);
    if (c == NULL) {
        run_finish(&run);
        return fault_no_memory(f);
    }
    c = wait_for_run(s, c, &run);

    // a run that diverges is kept, one without a single row is not
    loss_unless(run.summary.status != STATUS_NO_MEMORY);
    if (run.trace.row_count == 0) {
        const status code = fault_of_empty_run(&run, f);
        run_finish(&run);
        return code;
    }

    run_finish(&s->run);
    s->run = run;
    memcpy(s->outside, stamp, sizeof stamp);
    memcpy(s->digest, digest, sizeof digest);
    s->computing = c;
    s->surveyed = 0;
    return STATUS_OK;
}

// Keeps the present run where there is no new one, and computes the rest of it if it was
// not finished.
static void go_on_with_present_run(session *s, bool unfinished)
{
    if (unfinished && start_run(s, &s->effective, NULL) == STATUS_OK) {
        s->version++;
    }
    session_follow(s);
    session_seek(s, s->now);
}

// Computes the run of the scenario with the inputs in effect.
status session_compute(session *s, fault *f)
{
    // the scenario, whose run has to fit into memory
    scenario effective;
    status code = session_scenario(&s->base, s->inputs, s->input_count, &effective, f);
    if (code == STATUS_OK) {
        code = check_memory(&effective.parameters, f);
    }

    // end the run that is being computed: the new one needs the machine
    bool unfinished = end_computing(s);
    if (code == STATUS_OK) {
        code = start_run(s, &effective, f);
    }

    if (code != STATUS_OK) {
        free(effective.actions);
        if (s->run.trace.row_count > 0) {
            go_on_with_present_run(s, unfinished);
        }
        return code;
    }

    free(s->effective.actions);
    s->effective = effective;
    s->version++;
    session_follow(s);
    session_seek(s, s->now);
    s->seen = s->now;
    return STATUS_OK;
}

// Takes over the rows that were computed in the background meanwhile.
bool session_follow(session *s)
{
    if (s->computing == NULL) {
        return false;
    }

    // the run is over
    if (background_run_wait(s->computing, 0)) {
        collect_run(s);
        session_seek(s, s->now);
        return true;
    }

    // or it has more rows
    size_t before = s->run.trace.row_count;
    bool more = background_run_look(s->computing, &s->run) > before;

    // the largest force so far, as the summary of an unfinished run does not have it
    const trace *t = &s->run.trace;
    const size_t end = s->surveyed + ROWS_SURVEYED;
    for (; s->surveyed < t->row_count && s->surveyed < end; s->surveyed++) {
        s->run.summary.peak_force_N =
            fmax(s->run.summary.peak_force_N, t->rows[s->surveyed].force);
    }
    s->row = trace_row_at(&s->run.trace, s->now);
    return more;
}

bool session_stop(session *s)
{
    bool stopped = end_computing(s);
    if (s->run.trace.row_count > 0) {
        session_seek(s, s->now);
    }
    return stopped;
}

// Resumes a run that was stopped.
status session_go_on(session *s, fault *f)
{
    FAULT_IF(s->computing != NULL || s->run.summary.status != STATUS_STOPPED, f,
             STATUS_BAD_ARGUMENT, "the run was not stopped");

    // a cursor that has been further than the rows there are stays remembered
    double seen = s->seen;
    status code = start_run(s, &s->effective, f);
    if (code == STATUS_OK) {
        s->version++;
    }
    session_follow(s);
    session_seek(s, s->now);
    s->seen = fmax(seen, s->now);
    return code;
}

parameters session_parameters_at(const session *s, double time)
{
    return scenario_parameters_at(&s->effective, time);
}

// Keeps a run to be compared with the present one.
status session_keep_beside(session *s, const run_result *run, fault *f)
{
    run_result kept;
    if (run_share(run, &kept) != STATUS_OK) {
        return fault_no_memory(f);
    }
    session_forget_other(s);
    s->other = kept;
    s->has_other = true;
    s->version++;
    return STATUS_OK;
}

status session_allow_code(session *s, fault *f)
{
    const bool before = s->base.parameters.code_allowed;
    s->base.parameters.code_allowed = true;
    status code = session_compute(s, f);
    if (code != STATUS_OK) {
        s->base.parameters.code_allowed = before;
    }
    return code;
}

void session_forget_other(session *s)
{
    if (s->has_other) {
        run_finish(&s->other);
        s->has_other = false;
    }
}

// --- beginning and end ---

status session_open(session *s, scenario *base, double patience, fault *f)
{
    assert(patience >= 0);
    memset(s, 0, sizeof *s);
    s->base = *base;
    s->patience = patience;
    status code = session_compute(s, f);
    if (code != STATUS_OK) {
        session_finish(s);
    }
    return code;
}

void session_finish(session *s)
{
    session_stop(s);
    session_forget_other(s);
    run_finish(&s->run);
    free(s->effective.actions);
    free(s->inputs);
    scenario_finish(&s->base);
    memset(s, 0, sizeof *s);
}
