// Samples of the rig that are taken in flight while a step goes on: a loop from one to
// the next is the run to the last bit, and what they read is what is read where every one
// of them ends a step, with a piezo film, which these laws do not read, and in a loop
// that a program stops anywhere.
#include "src/study/batch.h"
#include "tests/rig_fixture.h"

enum { RUNS = 40 };

#define SAME      1e-7 // of a quantity's largest value
#define SAME_TIME 1e-9 // [s]

// One of so many texts.
static const char *one_of(random_generator *g, const char *const *texts, uint64_t count)
{
    return texts[random_below(g, count)];
}

// A random arm under a random law.
static parameters draw(random_generator *g)
{
    static const char *const laws[] = {"hybrid",    "force-pd",  "inverse-dynamics",
                                       "open-loop", "bang-bang", "impedance"};
    static const char *const walls[] = {"point", "plane", "none"};
    static const char *const hubs[] = {"rigid", "spring"};
    const char *law = one_of(g, laws, 6);
    const double rate = 50 + 350 * random_uniform(g);
    const double delay = random_below(g, 2) == 0 ? 0 : 0.002 * random_uniform(g);
    const double jitter = random_below(g, 3) == 0 ? 1e-4 * random_uniform(g) : 0;
    const char *wall = one_of(g, walls, 3), *hub = one_of(g, hubs, 2);
    const double k2 = 2 + 20 * random_uniform(g);
    const char *film = random_below(g, 2) == 0 ? "true" : "false";
    const char *accelerometer = random_below(g, 2) == 0 ? "true" : "false";

    // ideal sensors have no code step at which a last bit would show
    return rig_parameters_with(
        "control.law=%s control.rate=%.3g control.delay=%.3g control.jitter=%.3g "
        "wall.kind=%s arm.hub_joint=%s arm.k2=%.4g sensor.film=%s "
        "sensor.accelerometer=%s run.duration=0.6 sensor.ideal=true",
        law, rate, delay, jitter, wall, hub, k2, film, accelerometer);
}

static double signal_of(const sample *row, size_t offset)
{
    return *(const double *)((const char *)row + offset);
}

// How large a signal of the rows becomes at most.
static double largest_of(const trace *t, size_t offset)
{
    double most = 1e-3;
    for (EACH_ROW(row, t)) {
        most = fmax(most, fabs(signal_of(row, offset)));
    }
    return most;
}

static void check_same_signal(const sample *x, const sample *y, size_t signal,
                              double tolerance)
{
    const double one = signal_of(x, signal), other = signal_of(y, signal);
    assert_int_equal(isfinite(one), isfinite(other));
    if (isfinite(one)) {
        check_close(one, other, tolerance);
    }
}

// The row after the last one at the instant of a row.
static size_t end_of_instant(const trace *t, size_t row)
{
    size_t end = row;
    while (end < t->row_count && t->rows[end].time - t->rows[row].time < SAME_TIME) {
        end++;
    }
    return end;
}

// The last rows of an instant have the same signals; there may be others where an input
// is recorded, or a command differs from the one before by its last bit. All instants are
// the same but for those of inputs, which are those of b.
static void check_rows(const trace *a, const trace *b, bool inputs)
{
    static const size_t signals[] = {
        offsetof(sample, hub_angle),     offsetof(sample, hub_velocity),
        offsetof(sample, last_velocity), offsetof(sample, gap),
        offsetof(sample, force),         offsetof(sample, motor_torque),
        offsetof(sample, motor_work),    offsetof(sample, encoder),
        offsetof(sample, tachometer),    offsetof(sample, command),
        offsetof(sample, force_reading), offsetof(sample, sticking),
        offsetof(sample, film),          offsetof(sample, accelerometer)};
    enum { SIGNALS = sizeof signals / sizeof *signals };
    double most[SIGNALS];
    for (int k = 0; k < SIGNALS; k++) {
        most[k] = largest_of(a, signals[k]);
    }

    size_t together = 0, missing = 0;
    for (size_t i = 0, j = 0; i < a->row_count && j < b->row_count;) {
        const size_t x = end_of_instant(a, i), y = end_of_instant(b, j);
        const double later = a->rows[i].time - b->rows[j].time;
        for (int k = 0; k < SIGNALS && fabs(later) < SAME_TIME; k++) {
            check_same_signal(&a->rows[x - 1], &b->rows[y - 1], signals[k],
                              SAME * most[k]);
        }
        together += fabs(later) < SAME_TIME;
        missing += later <= -SAME_TIME || (later >= SAME_TIME && !inputs);
        i = later < SAME_TIME ? x : i;
        j = later > -SAME_TIME ? y : j;
    }
    assert_true(together >= 600 && missing <= 2);
}

// Ways of continuing a loop.
typedef enum looping {
    LOOPING_AT_SAMPLES, // from sample to sample, with questions, there and back
    LOOPING_ANYWHERE,   // by random times
    LOOPING_ENDED       // from sample to sample, each ending the step
} looping;

// Queries everything of a loop, continues it and restores it. It is then in its former
// state.
static void ask_and_return(run_loop *l, random_generator *g, void *bytes)
{
    int freedoms;
    const sample row = loop_row(l);
    const double first = *loop_state(l, &freedoms);
    check_close(first, row.hub_angle, 0);
    check_close(loop_summary(l).motor_work_J, row.motor_work, 0);
    loop_save(l, bytes);
    if (random_below(g, 2) == 0) {
        DONE(loop_until(l, loop_time(l) + 0.03 * random_uniform(g), &f));
    }
    DONE(loop_restore(l, bytes, loop_saved_size(l), &f));
    const sample again = loop_row(l);
    assert_memory_equal(&row, &again, sizeof row);
}

static void go_on(run_loop *l, random_generator *g, looping how, void *bytes)
{
    if (how == LOOPING_ANYWHERE) {
        const double until = loop_time(l) + 0.03 * random_uniform(g);
        DONE(loop_until(l, until, &f));
        assert_true(loop_ended(l) || fabs(loop_time(l) - until) < SAME_TIME);
        return;
    }
    DONE(loop_step(l, &f));
    if (how == LOOPING_AT_SAMPLES && random_below(g, 4) == 0) {
        ask_and_return(l, g, bytes);
    }
    if (how == LOOPING_ENDED && !loop_ended(l)) { // an input, which changes nothing
        DONE(loop_set_number(l, PARAMETER_INDEX(motor.voltage), 1, &f));
    }
}

// All numbers of two summaries but for times taken are the same bits.
static void check_same_summary(const summary *a, const summary *b)
{
    for (int i = 0; i < summary_count; i++) {
        const double one = summary_value(a, i), other = summary_value(b, i);
        if (!summary_table[i].timing) {
            assert_memory_equal(&one, &other, sizeof one);
        }
    }
}

// A whole run and a loop agree, where it is not cut by inputs or anywhere in contact to
// the last bit.
static void check_same_run(const run_result *whole, const run_result *loop,
                           const summary *end, looping how)
{
    const trace *a = &whole->trace, *b = &loop->trace;
    const summary *s = &whole->summary;
    check_close(s->approach_speed_m_s, end->approach_speed_m_s, SAME);
    check_close(s->return_speed_m_s, end->return_speed_m_s, SAME);
    if (how != LOOPING_ENDED) {
        assert_int_equal(a->event_count, b->event_count);
    }
    if (how != LOOPING_AT_SAMPLES) {
        check_rows(a, b, how == LOOPING_ENDED);
        return;
    }

    // rows, events, what was summed up
    assert_int_equal(a->row_count, b->row_count);
    assert_memory_equal(a->rows, b->rows, a->row_count * sizeof *a->rows);
    for (size_t i = 0; i < a->event_count; i++) {
        assert_true(a->events[i].time == b->events[i].time);
    }
    check_same_summary(s, end);
}

static void check_loops(uint64_t seed, looping how)
{
    random_generator g = seeded(seed);
    for (int i = 0; i < RUNS; i++) {
        const scenario s = {.name = (char *)"loop", .parameters = draw(&g)};
        KEPT_RUN(whole) = run_done(&s, true);

        const loop_options options = {.keep_trace = true};
        KEPT_LOOP(l);
        DONE(loop_create(&l, &s, &options, &f));
        SCOPED(free_kept) void *bytes = malloc(loop_saved_size(l));
        assert_non_null(bytes);
        while (!loop_ended(l)) {
            go_on(l, &g, how, bytes);
        }
        const summary end = loop_summary(l);
        check_same_run(&whole, loop_result(l), &end, how);
    }
}

TEST(a_loop_from_sample_to_sample_is_the_run)
{
    check_loops(11, LOOPING_AT_SAMPLES);
}

TEST(a_loop_stops_between_samples_on_the_way)
{
    check_loops(12, LOOPING_ANYWHERE);
}

TEST(samples_on_the_way_are_those_at_ends_of_steps)
{
    check_loops(13, LOOPING_ENDED);
}

// Number i of the random arms under random laws, the same for every caller.
static status make(void *context, size_t i, scenario *made, fault *f)
{
    random_generator g = seeded(100 + i);
    (void)context, (void)f;
    made->parameters = draw(&g);
    return STATUS_OK;
}

// Runs side by side, computed in lanes, are the same as single runs.
TEST(runs_side_by_side_are_single_runs)
{
    summary together[RUNS];
    const batch runs = {.count = RUNS, .make = make, .summaries = together};
    DONE(batch_run(&runs, 1, &f));
    for (size_t i = 0; i < RUNS; i++) {
        scenario s = {0};
        make(NULL, i, &s, NULL);
        KEPT_RUN(single) = run_done(&s, false);
        check_same_summary(&together[i], &single.summary);
    }
}
