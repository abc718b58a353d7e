// Order, damping and stability of the engines, on motions with known solutions.
#include "tests/arm_fixture.h"
#include "tests/explicit_stepper.h"

// One link on a spring whose hub never lets go: a linear oscillator,
// (I + m l^2/4) a + k1 theta = 0. k1 is chosen for the wanted frequency.
static arm oscillator(double frequency, const char *method, const char *more,
                      method_parameters *mp)
{
    parameters p =
        parameters_with("arm.links=1 arm.hub_joint=spring arm.k1=%.17g wall.kind=none "
                        "motor.voltage=0 motor.stiction=1000 %s %s",
                        frequency * frequency * 0.40108 / 3, method, more);
    arm a = arm_of(&p);
    *mp = p.method;
    return a;
}

// One step without events.
static void step_once(const arm *a, motion *m, double h)
{
    memcpy(m->trial, m->state, SLOT_COUNT * sizeof(double));
    m->trial[SLOT_JUMPED] = 0;
    assert_int_equal(m->engine->state_at(a, m, h, STATE_WHOLE), STATUS_OK);
    motion_evaluate(a, m, m->trial);
    double *next = m->trial;
    m->trial = m->state;
    m->state = next;
}

// By the method asked for; the event method's is the explicit formula.
static motion *motion_by(const arm *a, const method_parameters *mp)
{
    return motion_create_by(a, mp, mp->name == METHOD_EVENT ? &explicit_engine : NULL);
}

// Growth of the state per step, averaged over many steps from a general start. The
// oscillator is linear, so the state is scaled back after each step. Without damping the
// norm still swings within a period, which leaves an error of a few 1e-4 in the average.
static double spectral_radius(double frequency_step, const char *method, const char *more)
{
    enum { STEPS = 4000 };
    const double h = 1, wanted = 1e-2;
    method_parameters mp;
    arm a = oscillator(frequency_step / h, method, more, &mp);
    KEPT_MOTION(m) = motion_by(&a, &mp);
    motion_start(&a, m, 0, 0);
    state_angles(m, m->state)[1] = wanted;
    state_velocities(m, m->state)[1] = wanted * frequency_step / h / 3;
    double growth = 0;
    for (int i = 0; i < STEPS; i++) {
        double *q = &state_angles(m, m->state)[1], *v = &state_velocities(m, m->state)[1];
        double *algorithmic = &state_algorithmic(m, m->state)[1];
        double f = frequency_step / h;
        double size = sqrt(*q * *q + *v * *v / (f * f) +
                           *algorithmic * *algorithmic / (f * f * f * f));
        growth += i > STEPS / 2 ? log(size / wanted) : 0;
        *q *= wanted / size;
        *v *= wanted / size;
        *algorithmic *= wanted / size;
        motion_evaluate(&a, m, m->state);
        step_once(&a, m, h);
    }
    return exp(growth / (STEPS / 2.0 - 1));
}

// Error of the oscillator's angle after one period and a bit.
static double error_at(const char *method, const char *more, double h)
{
    method_parameters mp;
    double frequency = 40, until = 0.2, amplitude = 0.3;
    arm a = oscillator(frequency, method, more, &mp);
    KEPT_MOTION(m) = motion_by(&a, &mp);
    motion_start(&a, m, 0, 0);
    state_angles(m, m->state)[1] = amplitude;
    motion_evaluate(&a, m, m->state);
    state_algorithmic(m, m->state)[1] = state_accelerations(m, m->state)[1];
    for (int i = 0; i < (int)(until / h + 0.5); i++) {
        step_once(&a, m, h);
    }
    return fabs(state_angles(m, m->state)[1] - amplitude * cos(frequency * until));
}

static double order_of(const char *method, const char *more, double h)
{
    return log2(error_at(method, more, h) / error_at(method, more, h / 2));
}

TEST(orders_are_as_published)
{
    check_close(order_of("method.name=newmark", "method.beta=0.25", 1e-3), 2, 0.05);
    check_close(order_of("method.name=newmark", "method.beta=0.4", 1e-3), 2, 0.05);
    check_close(order_of("method.name=newmark", "method.gamma=0.6", 2.5e-4), 1, 0.1);
    check_close(order_of("method.name=generalized-alpha", "method.spectral_radius=0.8",
                         1e-3),
                2, 0.05);
    check_close(order_of("method.name=generalized-alpha", "method.spectral_radius=0",
                         1e-3),
                2, 0.1);
    check_close(order_of("method.name=event", "method.beta=0.4", 2e-2), 8, 0.5);
}

TEST(newmark_without_damping_keeps_the_amplitude)
{
    for (EACH_OF(double, c, 0.1, 1, 10, 1000)) {
        check_close(spectral_radius(*c, "method.name=newmark", "method.beta=0.25"), 1,
                    1e-3);
    }
}

TEST(stability_limits_are_those_of_table_3_1)
{
    // omega h = (gamma/2 - beta)^(-1/2)
    double linear_acceleration = 1 / sqrt(0.25 - 1.0 / 6);
    check_close(linear_acceleration, 3.4641, 1e-4);
    const char *beta = "method.beta=0.166666666666666667";
    check_close(spectral_radius(0.99 * linear_acceleration, "method.name=newmark", beta),
                1, 1e-3);
    assert_true(spectral_radius(1.01 * linear_acceleration, "method.name=newmark", beta) >
                1.05);

    double limit = 1 / sqrt(0.25 - 0.1);
    check_close(spectral_radius(0.99 * limit, "method.name=newmark", "method.beta=0.1"),
                1, 1e-3);
    assert_true(spectral_radius(1.01 * limit, "method.name=newmark", "method.beta=0.1") >
                1.05);

    // unconditional: 2 beta >= gamma >= 1/2
    check_close(spectral_radius(1e4, "method.name=newmark", "method.beta=0.4"), 1, 1e-3);
}

TEST(generalised_alpha_damps_the_highest_modes_as_asked)
{
    check_close(spectral_radius(3e4, "method.name=generalized-alpha",
                                "method.spectral_radius=0.9"),
                0.9, 2e-3);
    check_close(spectral_radius(3e4, "method.name=generalized-alpha",
                                "method.spectral_radius=0.5"),
                0.5, 2e-3);
    // and hardly the lowest
    assert_true(spectral_radius(0.05, "method.name=generalized-alpha",
                                "method.spectral_radius=0.5") > 0.999);
}

// Free, undamped motion of a bent chain: largest change of energy over the time,
// relative.
static double energy_drift(const char *links, const char *hub, double duration)
{
    parameters p =
        parameters_with("%s %s wall.kind=none motor.voltage=0 motor.stiction=0 "
                        "motor.viscous_friction=0 motor.back_emf=0",
                        links, hub);
    STARTED(a, m, &p, NULL, 0, 1);
    for (int i = 0; i < a.dof; i++) {
        state_angles(m, m->state)[i] += 0.3 * sin(1.0 + 2 * i / (double)a.dof);
        state_velocities(m, m->state)[i] += cos(1.0 + i);
    }
    state_angles(m, m->state)[0] = a.hub_spring ? state_angles(m, m->state)[1] : 0.1;
    motion_evaluate(&a, m, m->state);
    double *q = state_angles(m, m->state), *w = state_velocities(m, m->state);
    double energy = chain_kinetic_energy(&a, q, w) + chain_strain_energy(&a, q),
           drift = 0;
    for (int second = 1; second <= 10; second++) {
        motion_report report;
        assert_int_equal(motion_advance(&a, m, duration * second / 10, 1e-3, &report),
                         STATUS_OK);
        q = state_angles(m, m->state), w = state_velocities(m, m->state);
        double now = chain_kinetic_energy(&a, q, w) + chain_strain_energy(&a, q);
        drift = fmax(drift, fabs(now / energy - 1));
    }
    return drift;
}

TEST(free_motion_keeps_its_energy)
{
    check_below(energy_drift("arm.links=2", "arm.hub_joint=rigid", 10), 1e-8);
    check_below(energy_drift("arm.links=5", "arm.hub_joint=rigid", 10), 1e-8);
    check_below(energy_drift("arm.links=2", "arm.hub_joint=spring", 10), 1e-8);
}

// The implicit step solves the same equations: halving h quarters the distance to the
// event method.
static double distance_to_event_method(const char *links, const char *wall,
                                       const char *method, double h)
{
    double angle[2];
    for (int side = 0; side < 2; side++) {
        parameters p = parameters_with("%s %s arm.damping_ratio=0.02 %s", links, wall,
                                       side ? "method.name=event" : method);
        STARTED(a, m, &p, NULL, 0, 0);
        motion_report report = {.event = MOTION_IMPACT};
        while (m->state[SLOT_TIME] < 0.33) { // through the impact, into contact
            assert_int_equal(motion_advance(&a, m, 0.33, side ? 1e-3 : h, &report),
                             STATUS_OK);
            motion_apply(&a, m, &report);
        }
        angle[side] = state_angles(m, m->state)[a.dof - 1];
        if (m->state[SLOT_CONTACT] != 0) {
            check_close(m->state[SLOT_GAP], 0, 1e-12);
            check_close(m->state[SLOT_GAP_VELOCITY], 0, 1e-11);
        }
    }
    return fabs(angle[0] - angle[1]);
}

TEST(implicit_methods_converge_through_an_impact)
{
    static const char *const methods[] = {"method.name=newmark",
                                          "method.name=generalized-alpha"};
    for (int i = 0; i < 4; i++) {
        const char *wall = i % 2 ? "wall.kind=plane" : "wall.kind=point";
        double coarse =
            distance_to_event_method("arm.links=2", wall, methods[i / 2], 1e-3);
        double fine = distance_to_event_method("arm.links=2", wall, methods[i / 2], 5e-4);
        check_below(coarse, 1e-4);
        check_close(log2(coarse / fine), 2, 0.4);
    }
}
