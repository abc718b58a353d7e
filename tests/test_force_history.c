// When a force has settled, and the largest mean over a window, on forces known in closed
// form.
#include "src/run/recording.h"
#include "src/contact/contact_machine.h"
#include "src/run/run_driver.h"
#include "tests/force_means.h"
#include "tests/rig_fixture.h"
#include "tests/shipped_scenario.h"

#define STEP 1e-2 // [s]

typedef double (*force_curve)(double t);

static double parabola(double t)
{
    return 4 * t * (1 - t);
}

static double rising(double t)
{
    return 2 * t;
}

static double flat(double t)
{
    (void)t;
    return 3;
}

// The history of a curve over [0, 1] s; each step has its mean by Simpson's rule, exact
// for cubics.
static shared_array history_of(force_curve f)
{
    shared_array h;
    shared_array_init(&h, sizeof(force_step));
    for (int i = 0; i < 100; i++) {
        double start = i * STEP, end = (i + 1) * STEP;
        double mean = (f(start) + 4 * f((start + end) / 2) + f(end)) / 6;
        force_step step = {start, end, f(start), f(end), mean};
        assert_int_equal(force_history_add(&h, step), STATUS_OK);
    }
    return h;
}

static double largest_mean(force_curve f, double from, double window)
{
    run_result r = {.history = {.forces = history_of(f)}};
    double mean = force_largest_mean(&r, from, window);
    shared_array_finish(&r.history.forces);
    return mean;
}

// The tests of settling use the band of 5 % about the final force.
TEST(a_constant_force_has_settled_from_the_start)
{
    SCOPED(shared_array_finish) shared_array h = history_of(flat);
    check_close(force_settled_since(&h, 3), 0, 0);
    // a run that ends outside the band has not settled
    assert_true(isnan(force_settled_since(&h, 4)));
}

// The force 2 t enters the band about 2 N at 1.9 N, that is at 0.95 s.
TEST(a_rising_force_settles_where_it_enters_the_band)
{
    SCOPED(shared_array_finish) shared_array h = history_of(rising);
    check_close(force_settled_since(&h, 2), 0.95, 1e-12);
}

// A single step is a parabola, and the instant of settling may lie inside it.
TEST(the_band_is_entered_within_a_step)
{
    // a force that returns to zero at the end has not settled on 0.5 N
    SCOPED(shared_array_finish) shared_array h = history_of(parabola);
    assert_true(isnan(force_settled_since(&h, 0.5)));
    shared_array_finish(&h);
    force_step bump = {0, 1, 1, 1, 1 + 2.0 / 3 * 0.2}; // rises by 0.2 to its middle
    shared_array_init(&h, sizeof(force_step));
    assert_int_equal(force_history_add(&h, bump), STATUS_OK);
    // 1 + 0.8 s (1 - s) = 1.05 at the later root
    check_close(force_settled_since(&h, 1), 0.5 + sqrt(0.25 - 0.05 / 0.8), 1e-12);
}

// A step with the parabola first + slope s + curve s^2 of its share s.
static force_step parabolic_step(double start, double end, double first, double slope,
                                 double curve)
{
    return (force_step){start, end, first, first + slope + curve,
                        first + slope / 2 + curve / 3};
}

// Straight steps to half of the final force, to the lower edge of the band and to the
// final force: it settles at the end of the second step, in any unit of force (powers of
// two).
TEST(a_line_that_meets_the_band_at_a_steps_end_settles_there)
{
    for (int power = -40; power <= 40; power += 10) {
        const double final = ldexp(2, power), edge = final - SETTLED_BAND * final;
        const force_step steps[] = {{0, 1, 0, final / 2, final / 4},
                                    {1, 2, final / 2, edge, (final / 2 + edge) / 2},
                                    {2, 3, edge, final, (final + edge) / 2}};
        SCOPED(shared_array_finish) shared_array h;
        shared_array_init(&h, sizeof(force_step));
        for (int i = 0; i < 3; i++) {
            assert_int_equal(force_history_add(&h, steps[i]), STATUS_OK);
        }
        check_close(force_settled_since(&h, final), 2, 1e-12);
    }
}

// A force that comes back to the edge of its band at the last instant has settled then.
TEST(a_force_at_the_edge_of_its_band_has_settled)
{
    double final = 1;
    while (final + SETTLED_BAND * final - final != SETTLED_BAND * final) {
        final += 0.0625; // until the edge of the band is exact in floating point
    }

    // up to twice the final force, and back to the edge along a line or a parabola
    const double edge = final + SETTLED_BAND * final;
    const force_step steps[] = {{0, 1, final, 2 * final, 1.5 * final},
                                {1, 2, 2 * final, edge, (2 * final + edge) / 2},
                                parabolic_step(1, 2, edge + 2, -3, 1)};
    for (int last = 1; last < 3; last++) {
        SCOPED(shared_array_finish) shared_array h;
        shared_array_init(&h, sizeof(force_step));
        assert_int_equal(force_history_add(&h, steps[0]), STATUS_OK);
        assert_int_equal(force_history_add(&h, steps[last]), STATUS_OK);
        check_close(force_settled_since(&h, final), 2, 1e-12);
    }
}

TEST(a_history_keeps_all_of_its_steps)
{
    enum { STEPS = 5000 };
    SCOPED(shared_array_finish) shared_array h;
    shared_array_init(&h, sizeof(force_step));
    for (int i = 0; i < STEPS; i++) {
        assert_int_equal(force_history_add(&h, (force_step){i, i + 1, i, i, i}),
                         STATUS_OK);
    }
    assert_int_equal(h.count, STEPS);
    for (int i = 0; i < STEPS; i++) {
        check_close(force_steps(&h)[i].start, i, 0);
        check_close(force_steps(&h)[i].mean, i, 0);
    }
}

// A step of 1 s is a straight line that crosses the lower edge of the band at a random
// share of the step; rounding leaves it a curvature of nearly zero. The instant found is
// that share, whatever the unit of the force (1e-6 to 1e6).
TEST(lines_are_crossed_where_they_are)
{
    random_generator g = seeded(5);
    for (int i = 0; i < 2000; i++) {
        const double final = pow(10, 12 * random_uniform(&g) - 6);
        const double edge = final - SETTLED_BAND * final, share = random_uniform(&g);
        const double slope = final * (0.06 + random_uniform(&g)),
                     first = edge - share * slope;
        force_step step = parabolic_step(0, 1, first, slope, 0);
        if (step.last > final * (1 + SETTLED_BAND)) {
            continue; // beyond the band again
        }
        SCOPED(shared_array_finish) shared_array h;
        shared_array_init(&h, sizeof(force_step));
        assert_int_equal(force_history_add(&h, step), STATUS_OK);
        check_close(force_settled_since(&h, final), share, 1e-11);
    }
}

// Histories of parabolas that end near their final force. From the instant found on the
// force is in the band, and just before it was not; the same forces in another unit give
// the same instant.
TEST(from_the_instant_found_the_force_stays)
{
    enum { STEPS = 30, LOOKS = 200 };
    random_generator g = seeded(6);
    int within = 0, between = 0;
    for (int round = 0; round < 300; round++) {
        SCOPED(shared_array_finish) shared_array h;
        SCOPED(shared_array_finish) shared_array scaled;
        shared_array_init(&h, sizeof(force_step));
        shared_array_init(&scaled, sizeof(force_step));
        double force = 0, time = 0;
        for (int i = 0; i < STEPS; i++) {
            // towards 1 by shares, now and then with a jump as at an impact
            const double spread = exp(-0.15 * i),
                         jump = random_uniform(&g) < 0.2 ? spread : 0;
            const double end = time + 0.1 + random_uniform(&g);
            const double aim =
                1 + (round % 2 ? 0.3 : 1) * spread * (random_uniform(&g) - 0.5);
            const double curve = 2 * spread * (random_uniform(&g) - 0.5);
            const double first = force + jump * (random_uniform(&g) - 0.5);
            const force_step step =
                parabolic_step(time, end, first, aim - first - curve, curve);
            force_step larger_unit = step;
            larger_unit.first = ldexp(step.first, -45);
            larger_unit.last = ldexp(step.last, -45);
            larger_unit.mean = ldexp(step.mean, -45);
            assert_int_equal(force_history_add(&h, step), STATUS_OK);
            assert_int_equal(force_history_add(&scaled, larger_unit), STATUS_OK);
            force = step.last;
            time = end;
        }

        const double since = force_settled_since(&h, 1);
        const double again = force_settled_since(&scaled, ldexp(1, -45));
        assert_true(since == again || (isnan(since) && isnan(again)));
        assert_int_equal(isnan(since), fabs(force - 1) > SETTLED_BAND);
        for (size_t i = 0; i < h.count && !isnan(since); i++) {
            const force_step *step = &force_steps(&h)[i];
            const step_parabola p = step_parabola_of(step);
            for (int k = 0; k <= LOOKS; k++) {
                const double s = (double)k / LOOKS;
                const double at = step->start + s * (step->end - step->start);
                if (at > since + 1e-9) {
                    check_below(fabs(p.first + s * (p.slope + s * p.curve) - 1),
                                SETTLED_BAND + 1e-9);
                }
            }

            // the step that it lies in crosses the band's edge there, else the one before
            // ends outside
            if (since > step->start && since < step->end) {
                const double s = (since - step->start) / (step->end - step->start);
                check_close(fabs(p.first + s * (p.slope + s * p.curve) - 1), SETTLED_BAND,
                            1e-9);
                within++;
            } else if (since == step->end) {
                assert_true(fabs(step->last - 1) > SETTLED_BAND);
                between++;
            }
        }
    }
    assert_true(within > 50 && between > 5);
}

// The sign of a force counts: one as large the other way is not in the band.
TEST(the_opposite_force_is_outside)
{
    for (int sign = -1; sign <= 1; sign += 2) {
        SCOPED(shared_array_finish) shared_array h;
        shared_array_init(&h, sizeof(force_step));
        assert_int_equal(force_history_add(&h, (force_step){0, 1, sign, -sign, 0}),
                         STATUS_OK);
        assert_true(isnan(force_settled_since(&h, sign)));
        // the way from one to the other is a line of slope 2
        check_close(force_settled_since(&h, -sign), 1 - SETTLED_BAND / 2, 1e-12);
    }
}

TEST(an_empty_history_has_no_answer)
{
    SCOPED(shared_array_finish) shared_array h = {0};
    assert_true(isnan(force_settled_since(&h, 1)));
}

TEST(the_largest_mean_is_where_the_curve_is_highest)
{
    // a window of w round the top of 4 t (1 - t) has the mean 1 - w^2/3
    check_close(largest_mean(parabola, 0, 0.1), 1 - 0.01 / 3, 1e-12);
    check_close(largest_mean(parabola, 0, 0.237), 1 - 0.237 * 0.237 / 3, 1e-12);
    // from 0.6 s on it is the first window
    check_close(largest_mean(parabola, 0.6, 0.1), 4 * (0.65 - 0.65 * 0.65) - 0.01 / 3,
                1e-12);
    // the whole curve, and a window longer than what is left
    check_close(largest_mean(parabola, 0, 1), 2.0 / 3, 1e-12);
    assert_true(isnan(largest_mean(parabola, 0.95, 0.1)));
    check_close(largest_mean(rising, 0, 0.1), 2 * 0.95, 1e-12);
}

TEST(an_impulse_counts_as_long_as_the_window_holds_it)
{
    event impact = {.time = 0.503, .kind = EVENT_IMPACT, .impulse = 0.2, .index = -1};
    run_result r = {.history = {.forces = history_of(flat)},
                    .trace = {.events = &impact, .event_count = 1}};
    check_close(force_largest_mean(&r, 0, 0.1), 3 + 0.2 / 0.1, 1e-12);
    check_close(force_largest_mean(&r, 0.6, 0.1), 3, 1e-12);
    shared_array_finish(&r.history.forces);
}

// The largest value of the lag tau y' + y = 4 t (1 - t) from y(0) = value on: y = f - tau
// f' + tau^2 f'' + C exp(-t/tau), and where y = f.
static double parabola_sensed(double tau, double value)
{
    const double c = value + 4 * tau + 8 * tau * tau;
    double early = 0.5, late = 1;
    for (int i = 0; i < 60; i++) {
        const double t = (early + late) / 2;
        const bool rises = c * exp(-t / tau) < tau * (4 - 8 * t) + 8 * tau * tau;
        early = rises ? t : early;
        late = rises ? late : t;
    }
    return fmax(parabola(early), value);
}

// Exact, wherever within a step it is; with an impulse at the start, too, whether that is
// the largest itself, or not; up to an instant, at that.
TEST(the_largest_reading_of_a_sensor_is_located)
{
    const double taus[] = {0.001, 0.03, 0.1, 0.2};
    run_result r = {.history = {.forces = history_of(parabola)},
                    .summary = {.peak_force_N = 1}};
    for (EACH(tau, taus)) {
        r.trace.event_count = 0;
        check_relative(force_largest_sensed(&r, *tau, HUGE_VAL), parabola_sensed(*tau, 0),
                       1e-14);
        for (double value = 0.1; value < 2; value += 0.3) {
            event impact = {.kind = EVENT_IMPACT, .impulse = value * *tau, .index = -1};
            r.trace.events = &impact;
            r.trace.event_count = 1;
            check_relative(force_largest_sensed(&r, *tau, HUGE_VAL),
                           parabola_sensed(*tau, value), 1e-14);
        }
    }

    // t = 0.123 s lies within a step
    const double tau = 0.1, t = 0.123, c = 4 * tau + 8 * tau * tau;
    r.trace.event_count = 0;
    check_relative(force_largest_sensed(&r, tau, t),
                   parabola(t) - tau * (4 - 8 * t) - 8 * tau * tau + c * exp(-t / tau),
                   1e-13);

    // an impact at the very end adds to what is left; one that a step delivers does not
    // count twice
    event last = {.time = 1, .kind = EVENT_IMPACT, .impulse = 0.5, .index = -1};
    r.trace.events = &last;
    r.trace.event_count = 1;
    const double left = 4 * tau - 8 * tau * tau + c * exp(-1 / tau);
    check_relative(force_largest_sensed(&r, tau, HUGE_VAL), left + 0.5 / tau, 1e-13);
    last.delivered_by_step = true;
    check_relative(force_largest_sensed(&r, tau, HUGE_VAL), parabola_sensed(tau, 0),
                   1e-14);
    shared_array_finish(&r.history.forces);
}

// Of whole runs: a lag of 1 ms that is stepped finely through rows and impacts.
TEST(a_run_tells_what_a_sensor_of_1_ms_reads)
{
    const struct {
        const char *name, *changes;
    } runs[] = {{"corrected/first-impact", ""},
                {"corrected/first-impact", "wall.restitution=0.6"},
                {"corrected/damped-beam", "arm.links=6"},
                {"corrected/first-impact", "wall.contact=hunt-crossley"},
                {"corrected/first-impact", "wall.contact=kelvin-voigt arm.links=4"},
                {"compare/hybrid", ""}};
    for (EACH(c, runs)) {
        KEPT_SCENARIO(s) =
            shipped_with(c->name,
                         formatted("method.step=1e-5 run.duration=0.7 %s", c->changes));
        KEPT_RUN(r) = run_done(&s, true);
        double value = 0, largest = 0;
        for (size_t k = 1; k < r.trace.row_count; k++) {
            const sample *a = &r.trace.rows[k - 1], *b = a + 1;
            const double h = b->time - a->time, mean = (a->force + b->force) / 2;
            value = mean + (value - mean) * exp(-h / 1e-3) + b->impulse / 1e-3;
            largest = fmax(largest, value);
        }
        check_relative(r.summary.sensor_1ms_peak_N, largest, 1e-4);
    }

    // none without a contact
    KEPT_SCENARIO(free) = shipped_with("corrected/first-impact", "wall.kind=none");
    KEPT_RUN(flight) = run_done(&free, false);
    assert_true(isnan(flight.summary.sensor_1ms_peak_N));
}

// Impulse of the force over a run, as the motion itself integrates it [N s].
static double pressed(const parameters *p)
{
    STARTED(a, m, p, NULL, p->initial.angle, p->initial.velocity);
    while (m->state[SLOT_TIME] < p->run.duration) {
        step_on(&a, m, p->run.duration, p->method.step);
    }
    return state_quadratures(m, m->state)[QUADRATURE_FORCE];
}

// The modes of a damped chain decay within nanoseconds of an impact, in which they press
// with thousands of newtons: what is kept of the force has their impulse.
TEST(the_force_kept_has_the_impulse_of_decays)
{
    static const char *const links[] = {"arm.links=2", "arm.links=8", "arm.links=32"};
    static const char *const ratios[] = {"arm.damping_ratio=0.01",
                                         "arm.damping_ratio=0.3", "arm.damping_ratio=1"};
    for (int i = 0; i < 9; i++) {
        const char *const settings[] = {links[i / 3],          ratios[i % 3],
                                        "initial.angle=-0.01", "initial.velocity=1",
                                        "run.duration=0.03",   NULL};
        const parameters p = rig_parameters(settings);
        const scenario one = {.parameters = p};
        const run_options kept = {.keep_trace = true, .rows_expected = 100};
        KEPT_RUN(run);
        assert_int_equal(run_scenario_with(&one, &kept, &run), STATUS_OK);
        const shared_array *h = &run.history.forces;
        double sum = 0;
        for (size_t k = 0; k < h->count; k++) {
            const force_step *step = &force_steps(h)[k];
            sum += step->mean * (step->end - step->start);
        }
        check_relative(sum, pressed(&p), 1e-4);
    }
}

// Wall and friction hold two links, and only the motor's current goes on: once it has
// settled the force is that of the last row, and so is its mean, however long the strides
// are by then.
TEST(a_held_arm_presses_with_the_mean_of_its_force)
{
    static const char *const cases[][2] = {
        {"compare/open-loop", "motor.inductance=0.02 sensor.ideal=true"},
        {"compare/hybrid", "motor.current_limit=1 wall.kind=plane sensor.ideal=true"},
        {"compare/hybrid", "motor.inductance=0.041 sensor.ideal=true"},
        {"compare/bang-bang", "motor.current_limit=0.5036 sensor.ideal=true"},
        {"compare/observer", "motor.inductance=0.0201"},
        {"compare/observer", "motor.inductance=0.0073"}};
    for (EACH(c, cases)) {
        KEPT_SCENARIO(s) = shipped_with((*c)[0], (*c)[1]);
        KEPT_RUN(r) = run_done(&s, true);
        const sample *last = &r.trace.rows[r.trace.row_count - 1];
        assert_true(last->contact != 0 && last->sticking != 0);
        check_close(r.summary.steady_force_N, last->force, 1e-6);
        assert_null(impossible_mean(&r));

        // what a sensor reads is that force, too, by the digits of its converter
        check_close(last->force_reading, last->force, 0.05 * last->force);
    }
}

// A mean beyond the range of its force is nobody's: it ends the run with a sentence.
TEST(a_mean_that_the_force_never_was_is_said)
{
    for (EACH_OF(double, off, 1, -1)) {
        KEPT_SCENARIO(s) = shipped("corrected/three-links");
        const run_options options = {.keep_trace = true};
        KEPT_RUN(r);
        run_driver d;
        bool ended = false;
        fault f = {.text = ""};
        assert_int_equal(driver_open(&d, &s, &options, &r, &f), STATUS_OK);

        // into contact
        motion *m = d.run.corrected.motion;
        while (m->state[SLOT_FORCE] == 0 && !ended) {
            assert_int_equal(driver_advance(&d, driver_time(&d) + 1e-3, &ended, &f),
                             STATUS_OK);
        }
        assert_false(ended);

        // the last step's own force, then with more or less in the integral
        assert_int_equal(arm_run_record_forces(&d.run.corrected), STATUS_OK);
        state_quadratures(m, m->state)[QUADRATURE_FORCE] += *off;
        assert_int_equal(arm_run_record_forces(&d.run.corrected), STATUS_IMPOSSIBLE_MEAN);
        driver_close(&d, STATUS_IMPOSSIBLE_MEAN, &f);
    }
}
