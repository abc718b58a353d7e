// Sampled loops: limits of stability, margins, loop gains measured in runs, pushes that
// lose contact.
#include <assert.h>

#include "src/arm/chain.h"
#include "src/base/random.h"
#include "src/study/linear/linear.h"
#include "tests/shipped_scenario.h"

#define IDEAL "motor.stiction=0 sensor.ideal=true "

static linear_system loop_of(const scenario *s)
{
    linear_arm l;
    linear_system loop = {0};
    DONE(linear_arm_init(&l, &s->parameters, LINEAR_CONTACT, &f) != STATUS_OK ||
         linear_loop(&loop, &l, &s->parameters, &f));
    linear_system_finish(&l.system);
    return loop;
}

// Limits that another program found, on a grid of half a hertz and for the straight arm.
TEST(limits_are_those_found_otherwise)
{
    static const struct {
        const char *name, *changes, *path;
        double from, to, known;
    } cases[] = {
        {"compare/sampling-rate", IDEAL, "control.rate", 150, 250, 193.5},
        {"compare/sampling-rate", IDEAL "control.delay_periods=0", "control.rate", 40, 60,
         45.5},
        {"compare/sampling-rate", IDEAL "control.delay_periods=0", "control.rate", 60,
         120, 88.5},
        {"compare/force-pd", "control.rate=200", "control.force_gain", 1, 8, 4.12},
    };
    for (EACH(c, cases)) {
        KEPT_SCENARIO(s) = shipped_with(c->name, c->changes);
        char *vary[] = {(char *)formatted("%s=%g:%g:2", c->path, c->from, c->to)};
        SCOPED(linear_survey_finish) linear_survey found;
        DONE(linear_survey_begin(&found, &s, &(sweep_request){vary, 1}, &f));
        DONE(linear_survey_make(&found, LINEAR_CONTACT, NULL, &f));
        assert_false(found.limits[0].by_runs);
        check_relative(found.limits[0].value, c->known, 1e-2);
    }
}

// A gain margin is the factor, a delay margin the delay, at which a pole reaches the unit
// circle.
TEST(margins_are_met_by_the_poles)
{
    static const char *const cases[][2] = {
        {"compare/force-pd", IDEAL "control.rate=200 control.force_gain=2 control.kv=0"},
        {"compare/force-integral", IDEAL "control.rate=100"},
        {"compare/sampling-rate", IDEAL},
        {"compare/hybrid", IDEAL "control.rate=300 control.delay=0.002"},
    };
    for (EACH(c, cases)) {
        KEPT_SCENARIO(s) = shipped_with((*c)[0], (*c)[1]);
        SCOPED(linear_system_finish) linear_system loop = loop_of(&s);
        linear_response r;
        const double period = 1 / s.parameters.control.rate;
        DONE(linear_respond(&loop, 0, period, &r, &f));
        linear_margins m = linear_margins_of(&r);
        linear_arm l;
        DONE(linear_arm_init(&l, &s.parameters, LINEAR_CONTACT, &f));
        DONE(linear_delay_margin(&l, &s.parameters, &m.delay_s, &f));
        linear_system_finish(&l.system);

        // the gain at its margin puts a pole on the circle
        double complex poles[64];
        const double factor = pow(10, m.gain_db / 20);
        for (int k = 0; k < loop.states; k++) {
            loop.c[k] *= factor;
        }
        linear_close(&loop);
        DONE(linear_poles(&loop, poles, &f));
        check_close(cabs(poles[loop.states - 1]), 1, 2e-4);
        assert_true(m.disk <= 2 * (factor - 1) / (factor + 1) * (1 + 1e-6));
        assert_true(m.disk <= 4 * tan(m.phase_deg * acos(-1) / 360) + 1e-6);

        // and so does the delay
        if (m.delay_s + s.parameters.control.delay < 4 * period) {
            const char *delay = formatted("%s control.delay=%.12g", (*c)[1],
                                          s.parameters.control.delay + m.delay_s);
            KEPT_SCENARIO(late) = shipped_with((*c)[0], delay);
            double growth;
            DONE(linear_stability(&late, LINEAR_CONTACT, false, &growth, &f));
            check_close(growth * period, 0, 1e-6);
        }
        free(r.frequency);
    }
}

// A random number whose logarithm is spread evenly.
static double between(random_generator *g, double from, double to)
{
    return from * pow(to / from, random_uniform(g));
}

// The settings of a random arm with a random law. Each law's gain lies about a usual
// value.
static const char *drawn_loop(random_generator *g)
{
    static const char *const joints[] = {"rigid", "beam"};
    static const char *const laws[] = {"force-pd control.force_gain", "hybrid control.kp",
                                       "force-integral control.force_rate"};
    static const double gains[] = {0.8, 8, 2};
    const int law = (int)random_below(g, 3);
    const double length = between(g, 0.4, 1.2);
    return formatted(
        IDEAL "control.law=%s=%.6g control.rate=%.4g arm.links=%d arm.hub_joint=%s "
              "arm.length=%.4g arm.mass=%.4g arm.EI=%.4g arm.damping_ratio=%.3g "
              "arm.hub_inertia=%.3g wall.angle=0 ",
        laws[law], gains[law] * between(g, 0.3, 2), between(g, 80, 400),
        2 + (int)random_below(g, 4), joints[random_below(g, 2)], length,
        0.4 * length * between(g, 0.7, 1.4), between(g, 0.7, 4), between(g, 0.005, 0.05),
        between(g, 0.002, 0.01));
}

// Ratio of the force's swing (largest minus smallest) between 6 and 7 s to that between 2
// and 3 s, after a small push at 1.5 s: below one where the loop is stable.
static double swing_grows(const char *changes)
{
    KEPT_SCENARIO(s) = shipped_with("compare/force-pd", changes);
    SCOPED(loop_destroy_kept) run_loop *l = NULL;
    double swing[2];
    s.parameters.run.duration = 7;
    DONE(loop_create(&l, &s, &(loop_options){.keep_trace = false}, &f));
    DONE(loop_until(l, 1.5, &f) != STATUS_OK || loop_push(l, 1e-5, &f));
    for (int late = 0; late < 2; late++) {
        double least = HUGE_VAL, most = -HUGE_VAL;
        DONE(loop_until(l, late ? 6 : 2, &f));
        while (loop_time(l) < (late ? 7 : 3) - 1e-9) {
            DONE(loop_step(l, &f));
            least = fmin(least, loop_row(l).force);
            most = fmax(most, loop_row(l).force);
        }
        swing[late] = most - least;
    }
    return swing[1] / swing[0];
}

// The largest absolute value of the poles of the closed loop whose open-loop gain is
// multiplied by a factor. linear_poles sorts by absolute value, so the last is the
// largest.
static double radius_of(const scenario *s, double factor)
{
    SCOPED(linear_system_finish) linear_system loop = loop_of(s);
    double complex poles[64];
    for (int k = 0; k < loop.states; k++) {
        loop.c[k] *= factor;
    }
    linear_close(&loop);
    DONE(linear_poles(&loop, poles, &f));
    return cabs(poles[loop.states - 1]);
}

// The margins of random arms and laws are where stability ends. At 0.999 of the gain
// margin the poles of the closed loop lie within the unit circle, at 1.001 of it one lies
// outside. At 0.95 of the delay margin a run fades, at 1.05 of it the run keeps swinging.
// The first loop is fixed: its delay margin is less than its sampling period of 5 ms.
TEST(margins_part_runs)
{
    static const char *const first =
        IDEAL "arm.links=3 arm.hub_joint=beam arm.length=0.6 arm.mass=0.2 "
              "arm.EI=0.9 arm.damping_ratio=0.01 arm.hub_inertia=0.002 "
              "control.force_gain=0.6 control.rate=200 ";
    random_generator g;
    random_seed(&g, 47);
    int compared = 0;
    for (int i = 0; i < 40; i++) {
        const char *changes = i == 0 ? first : drawn_loop(&g);
        KEPT_SCENARIO(s) = shipped_with("compare/force-pd", changes);
        if (radius_of(&s, 1) > 1) {
            continue; // unstable from the start: it has no margins
        }

        // the margins of the loop
        SCOPED(linear_system_finish) linear_system loop = loop_of(&s);
        linear_arm l;
        linear_response r;
        const double period = 1 / s.parameters.control.rate;
        DONE(linear_respond(&loop, 0, period, &r, &f));
        linear_margins m = linear_margins_of(&r);
        DONE(linear_arm_init(&l, &s.parameters, LINEAR_CONTACT, &f));
        DONE(linear_delay_margin(&l, &s.parameters, &m.delay_s, &f));
        free(r.frequency);
        linear_system_finish(&l.system);

        const double factor = pow(10, m.gain_db / 20);
        check_below(radius_of(&s, 0.999 * factor), 1);
        check_below(1, radius_of(&s, 1.001 * factor));
        if (i == 0) {
            check_relative(m.delay_s, 3.468e-3, 1e-3);
        }

        // on either side of the delay margin, for delays that a run can have
        for (int more = 0; more < 2 && m.delay_s < 4.5 * period; more++) {
            const double delay = (more ? 1.05 : 0.95) * m.delay_s;
            const char *late = formatted("%scontrol.delay=%.9g belief.delay_error=-%.9g",
                                         changes, delay, delay);
            assert_true((swing_grows(late) > 0.5) == more);
            compared++;
        }
    }
    check_below(40, compared);
}

// A loop whose gain where the phase is -180 degrees is below a millionth has no gain
// margin; with a gain of 1e-5 there the margin is 20 log10(1e5) = 100 dB.
TEST(no_gain_that_matters_is_no_margin)
{
    double complex gain[3] = {complex_of(-1e-7, 1e-9), complex_of(-1e-7, -1e-9), 0};
    double w[3] = {1, 2, 3};
    assert_true(isinf(linear_margins_of(&(linear_response){3, w, gain}).gain_db));
    gain[0] *= 100;
    gain[1] *= 100;
    check_close(linear_margins_of(&(linear_response){3, w, gain}).gain_db, 100, 1e-6);
}

static const char *plugin_path, *program_path;

// Small sines in a run meet what the matrices say, also of laws that are not the lab's.
TEST(measured_loops_are_the_exact_ones)
{
    const char *loaded =
        formatted(IDEAL
                  "control.law=plugin control.settings=rise_time=0.05 control.plugin=%s",
                  plugin_path);
    const char *const cases[][2] = {
        {"compare/force-pd", IDEAL},  {"compare/hybrid", IDEAL},
        {"compare/impedance", IDEAL}, {"compare/force-pd", loaded},
        {"compare/force-pd", IDEAL},
    };
    for (int i = 0; i < 5; i++) {
        KEPT_SCENARIO(s) = shipped_with(cases[i][0], cases[i][1]);
        parameters *p = &s.parameters;
        p->code_allowed = i >= 3;
        if (i == 4) {
            p->control.law = LAW_PROCESS;
            snprintf(p->control.command, sizeof p->control.command, "python3 '%s'",
                     program_path);
        }

        // one that does not hold the force is asked for that which it comes to
        for (int k = 0; k < 6 && i >= 3; k++) {
            KEPT_RUN(result) = run_done(&s, false);
            p->control.force = result.summary.steady_force_N;
        }
        SCOPED(linear_system_finish) linear_system loop = loop_of(&s);
        linear_response r;
        fault f = {.text = ""};
        fail_if(linear_inject(&s, &r, &f) != STATUS_OK, "%s: %s", cases[i][1], f.text);
        const double period = 1 / p->control.rate;
        double complex scratch[64 * 67];
        int compared = 0;
        for (int k = 0; k < r.count; k++) {
            const double turn = r.frequency[k] * period;
            if (turn <= 0.8 * acos(-1)) {
                const double complex point = complex_of(cos(turn), sin(turn));
                const double complex ratio =
                    r.gain[k] / -linear_answer(&loop, 0, point, scratch);
                check_close(20 * log10(cabs(ratio)), 0, 0.1);
                check_close(carg(ratio) * 180 / acos(-1), 0, 1);
                compared++;
            }
        }
        assert_true(compared > 20);
        free(r.frequency);
    }
}

// A law whose command deviates `factor` times as far from that at rest, under a sine that
// keeps it from falling asleep, from 3 s on.
typedef struct scaled {
    rig *inner;
    double factor, rest; // NaN until then
} scaled;

static void sample_scaled(void *memory, const controller_input *in,
                          controller_output *out)
{
    scaled *s;
    memcpy(&s, memory, sizeof s);
    s->inner->law->sample(s->inner->memory, in, out);
    if (in->time >= 3) {
        s->rest = isnan(s->rest) ? out->command : s->rest;
        out->command = s->rest + s->factor * (out->command - s->rest) +
                       0.3 * sin(8 * (in->time - 3));
    }
}

static const char *start_scaled(void *memory, const controller_setup *setup)
{
    (void)memory, (void)setup;
    return NULL;
}

// How often the arm loses contact with the loop gain so many times larger.
static double losses_with(double factor)
{
    KEPT_SCENARIO(s) = shipped_with("compare/observer", IDEAL "run.duration=6");
    scaled scale = {.factor = factor, .rest = (double)NAN};
    run_loop *l;
    DONE(rig_create(&scale.inner, &s.parameters, NULL, &f));
    controller law = *scale.inner->law;
    law.memory_size = sizeof(scaled *);
    law.start = start_scaled;
    law.sample = sample_scaled;
    law.tune = NULL;
    DONE(loop_create(&l, &s, &(loop_options){.law = {&law, &scale}}, &f));
    DONE(loop_until(l, 3, &f));
    const double before = loop_summary(l).separations;
    DONE(loop_until(l, 6, &f));
    const double after = loop_summary(l).separations;
    loop_destroy(l);
    rig_destroy(scale.inner);
    return after - before;
}

// The observer law, which has no linear form, fails in runs within a tenth of the loop
// gain and of the further delay that its measured loop bears.
TEST(measured_margins_are_those_of_runs)
{
    KEPT_SCENARIO(s) = shipped_with("compare/observer", IDEAL "run.duration=3");
    linear_arm l;
    linear_system loop;
    linear_response r;
    DONE(linear_arm_init(&l, &s.parameters, LINEAR_CONTACT, &f));
    REFUSED(STATUS_UNSTABLE, "", linear_loop(&loop, &l, &s.parameters, &f));
    DONE(linear_inject(&s, &r, &f));
    const linear_margins m = linear_margins_of(&r);
    free(r.frequency);
    linear_system_finish(&l.system);
    const double factor = pow(10, m.gain_db / 20);
    assert_true(losses_with(0.9 * factor) == 0);
    assert_true(losses_with(1.1 * factor) > 0);

    // the law is not told of the delay, which is five periods at most
    for (int more = 0; more < 2; more++) {
        const double delay = more ? fmin(1.1 * m.delay_s, 0.0249) : 0.9 * m.delay_s;
        KEPT_SCENARIO(late) =
            shipped_with("compare/observer",
                         formatted(IDEAL "run.duration=6 control.delay=%.6g "
                                         "belief.delay_error=-%.6g",
                                   delay, delay));
        KEPT_RUN(result) = run_done(&late, false);
        assert_true(isfinite(result.summary.settling_time_s) ==
                    !more); // or it never does
    }
}

// A push away from a rigid wall throws the arm off with p C, C = J M^-1 J', and the force
// f brings it back after (p C)^2/(2 f C): a micrometre is a separation.
TEST(the_least_push_lifts_the_arm_by_a_micrometre)
{
    KEPT_SCENARIO(s) =
        shipped_with("corrected/first-impact", "motor.stiction=0 run.duration=4");
    linear_arm l;
    double push;
    DONE(linear_arm_init(&l, &s.parameters, LINEAR_CONTACT, &f));
    DONE(linear_contact_margin(&s, &push, &f));

    arm a;
    chain_link work[2];
    double q[2], response[2];
    KEPT_RUN(result) = run_done(&s, false);
    const double force = result.summary.steady_force_N;
    arm_init(&a, &s.parameters);
    q[0] = l.hub_angle;
    q[1] = l.hub_angle + l.bending;
    const double compliance = chain_contact_response(&a, work, q, false, response);
    check_relative(push, sqrt(2e-6 * force / compliance), 0.02);
    linear_system_finish(&l.system);
}

int main(int argc, char **argv)
{
    assert(argc == 3);
    plugin_path = argv[1];
    program_path = argv[2];
    return run_cases(NULL, NULL);
}
