// Samples of the rig that are taken in flight while a step goes on are what they are where every
// one of them ends a step: with a piezo film, which these laws do not read, and in a loop that a
// program stops anywhere.
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>

#include "src/base/random.h"
#include "src/run/loop.h"
#include "tests/check.h"
#include "tests/rig_fixture.h"

enum { RUNS = 60, MOST_SETTINGS = 16, SETTING_SIZE = 64 };

#define SAME      1e-7 // of a quantity's largest value
#define SAME_TIME 1e-9 // [s]

// One of so many texts.
static const char *one_of(random_generator *g, const char *const *texts, uint64_t count)
{
    return texts[random_below(g, count)];
}

// A random arm under a random law.
typedef struct drawn_settings {
    char text[MOST_SETTINGS][SETTING_SIZE];
    int count;
} drawn_settings;

static __attribute__((format(printf, 2, 3))) void add(drawn_settings *s, const char *format, ...)
{
    va_list values;
    va_start(values, format);
    vsnprintf(s->text[s->count++], SETTING_SIZE, format, values);
    va_end(values);
}

static drawn_settings draw(random_generator *g)
{
    static const char *const laws[] = {"hybrid",    "force-pd",  "inverse-dynamics",
                                       "open-loop", "bang-bang", "impedance"};
    static const char *const walls[] = {"point", "plane", "none"};
    static const char *const hubs[] = {"rigid", "spring"};
    drawn_settings s = {.count = 0};
    add(&s, "control.law=%s", one_of(g, laws, 6));
    add(&s, "control.rate=%.3g", 50 + 350 * random_uniform(g));
    add(&s, "control.delay=%.3g", random_below(g, 2) == 0 ? 0 : 0.002 * random_uniform(g));
    add(&s, "control.jitter=%.3g", random_below(g, 3) == 0 ? 1e-4 * random_uniform(g) : 0);
    add(&s, "wall.kind=%s", one_of(g, walls, 3));
    add(&s, "arm.hub_joint=%s", one_of(g, hubs, 2));
    add(&s, "arm.k2=%.4g", 2 + 20 * random_uniform(g));
    add(&s, "sensor.film=%s", random_below(g, 2) == 0 ? "true" : "false");
    add(&s, "sensor.accelerometer=%s", random_below(g, 2) == 0 ? "true" : "false");
    add(&s, "run.duration=0.6");
    add(&s, "sensor.ideal=true"); // no code at whose edge a last bit would show
    return s;
}

static parameters drawn_parameters(const drawn_settings *s)
{
    const char *settings[MOST_SETTINGS + 1] = {NULL};
    for (int i = 0; i < s->count; i++) {
        settings[i] = s->text[i];
    }
    return rig_parameters(settings);
}

static double signal_of(const sample *row, size_t offset)
{
    return *(const double *)((const char *)row + offset);
}

// How large a signal of the rows becomes at most.
static double largest_of(const trace *t, size_t offset)
{
    double most = 1e-3;
    for (size_t i = 0; i < t->row_count; i++) {
        most = fmax(most, fabs(signal_of(&t->rows[i], offset)));
    }
    return most;
}

// Rows at the same instants have the same signals; only where a command differs from the one before
// by its last bit does one of them have a row more.
static void check_rows(const trace *a, const trace *b)
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

    size_t together = 0;
    for (size_t i = 0, j = 0; i < a->row_count && j < b->row_count;) {
        const sample *x = &a->rows[i], *y = &b->rows[j];
        const double later = x->time - y->time;
        i += later < SAME_TIME;
        j += later > -SAME_TIME;
        if (fabs(later) >= SAME_TIME) {
            continue;
        }
        together++;
        for (int k = 0; k < SIGNALS; k++) {
            const double one = signal_of(x, signals[k]), other = signal_of(y, signals[k]);
            assert_int_equal(isfinite(one), isfinite(other));
            if (isfinite(one)) {
                check_close(one, other, SAME * most[k]);
            }
        }
    }
    assert_true(together + 2 >= a->row_count && together + 2 >= b->row_count);
}

// Goes on with a loop to the next sample, or by a random time.
static void go_on(run_loop *l, random_generator *g, bool anywhere)
{
    fault f;
    if (!anywhere) {
        assert_int_equal(loop_step(l, &f), STATUS_OK);
        return;
    }
    const double until = loop_time(l) + 0.03 * random_uniform(g);
    assert_int_equal(loop_until(l, until, &f), STATUS_OK);
    assert_true(loop_ended(l) || fabs(loop_time(l) - until) < SAME_TIME);
}

// A whole run and a loop, stopped anywhere or at samples.
static void check_loops(uint64_t seed, bool anywhere)
{
    static char name[] = "loop", none[] = "";
    random_generator g;
    random_seed(&g, seed);
    for (int i = 0; i < RUNS; i++) {
        const drawn_settings drawn = draw(&g);
        const scenario s = {.name = name,
                            .file = none,
                            .title = none,
                            .description = none,
                            .parameters = drawn_parameters(&drawn)};
        run_result whole;
        assert_int_equal(run_scenario(&s, true, &whole), STATUS_OK);

        const loop_options options = {.keep_trace = true};
        run_loop *l;
        fault f;
        assert_int_equal(loop_create(&l, &s, &options, &f), STATUS_OK);
        while (!loop_ended(l)) {
            go_on(l, &g, anywhere);
        }
        const run_result *pieces = loop_result(l);
        const summary end = loop_summary(l);
        assert_int_equal(whole.trace.event_count, pieces->trace.event_count);
        check_rows(&whole.trace, &pieces->trace);
        check_close(whole.summary.approach_speed_m_s, end.approach_speed_m_s, SAME);
        check_close(whole.summary.return_speed_m_s, end.return_speed_m_s, SAME);
        loop_destroy(l);
        run_finish(&whole);
    }
}

static void samples_on_the_way_are_those_at_ends_of_steps(void **state)
{
    (void)state;
    check_loops(11, false);
}

static void a_loop_stops_between_samples_on_the_way(void **state)
{
    (void)state;
    check_loops(12, true);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(samples_on_the_way_are_those_at_ends_of_steps),
        cmocka_unit_test(a_loop_stops_between_samples_on_the_way),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
