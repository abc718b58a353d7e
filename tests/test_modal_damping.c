// Damping of the beam by mode and by air: how each mode decays, and what the ledger says
// of it.
#include "tests/arm_fixture.h"

enum { MOST = 9 }; // bodies

// The modes of an arm with its hub held.
typedef struct held_modes {
    arm arm;
    double mass[MOST * MOST];
    arm_modes modes;
} held_modes;

static held_modes held_modes_of(const parameters *p)
{
    held_modes m = {.arm = arm_of(p)};
    double stiffness[MOST * MOST] = {0};
    m.modes = modes_of(&m.arm, HUB_LOCKED, TIP_FREE);
    modes_matrices(&m.arm, m.mass, stiffness);
    return m;
}

// Joints that the arm does not have take no part.
TEST(only_joints_that_are_there_are_damped)
{
    const char *const *const arms[] = {given("arm.links=5"),
                                       given("arm.links=32 arm.hub_joint=beam")};
    for (int j = 0; j < 2; j++) {
        double rows[PARAMETER_MODES_MOST][PARAMETER_MODAL_LINKS];
        arm a = arm_with(arms[j]);
        assert_int_equal(modal_damping_rows(&a, "0.1,0.2,0.3", rows), 3);
        for (int i = 0; i < 3; i++) {
            int damped = 0;
            for (int k = 0; k < PARAMETER_MODAL_LINKS; k++) {
                damped += rows[i][k] != 0;
            }
            assert_int_equal(damped, a.dof - 1);
        }
    }
}

// x' M y over the bodies beyond the hub.
static double product(const held_modes *m, const double *x, const double *y)
{
    const int n = m->arm.dof;
    double sum = 0;
    for (int i = 1; i < n; i++) {
        for (int j = 1; j < n; j++) {
            sum += x[i] * m->mass[i * n + j] * y[j];
        }
    }
    return sum;
}

// How fast mode i decays and vibrates, from a run of 20 radians begun in its shape with
// the hub held by friction: an amplitude a e^(-d t) cos(w t + phase) has a'' + 2 d a' +
// (d^2 + w^2) a = 0, whose two factors three instants give.
static void decay_of_mode(const parameters *p, int mode, double *rate, double *frequency)
{
    held_modes m = held_modes_of(p);
    const double small = 1e-5, step = 0.4 / m.modes.w[mode];
    const double *shape = m.modes.shapes + mode * m.arm.dof;
    KEPT_MOTION(run) = motion_create(&m.arm, &p->method);
    assert_non_null(run);
    motion_start(&m.arm, run, 0, 0);
    for (int i = 1; i < m.arm.dof; i++) {
        state_angles(run, run->state)[i] = small * shape[i];
    }
    motion_evaluate(&m.arm, run, run->state);
    run->record.start_energy = chain_strain_energy(&m.arm, state_angles(run, run->state));

    // amplitudes at equal distances, with y[k+1] + y[k-1] = c y[k] - (e^(-2 d h) - 1)
    // y[k-1]
    double amplitude[52], a = 0, b = 0, c = 0, d = 0, e = 0;
    for (int k = 0; k < 52; k++) {
        motion_report report;
        assert_int_equal(motion_advance(&m.arm, run, k * step, p->method.step, &report),
                         STATUS_OK);
        amplitude[k] =
            product(&m, shape, state_angles(run, run->state)) / product(&m, shape, shape);
    }
    for (int k = 1; k < 51; k++) { // least squares of y[k+1] = s y[k] - r y[k-1]
        a += amplitude[k] * amplitude[k];
        b -= amplitude[k] * amplitude[k - 1];
        c += amplitude[k - 1] * amplitude[k - 1];
        d += amplitude[k] * amplitude[k + 1];
        e -= amplitude[k - 1] * amplitude[k + 1];
    }
    const double s = (d * c - b * e) / (a * c - b * b),
                 r = (a * e - b * d) / (a * c - b * b);
    *rate = -log(r) / (2 * step);
    *frequency = acos(s / (2 * sqrt(r))) / step;

    // the ledger
    const double put_in = run->record.start_energy;
    check_below(fabs(motion_energy_residual(&m.arm, run, run->state)), 1e-9 * put_in);
    check_below(0.05 * put_in * *rate * 20 / m.modes.w[mode],
                state_quadratures(run, run->state)[QUADRATURE_DAMPING]);
}

static void check_decay(const parameters *p, int mode, double ratio)
{
    held_modes m = held_modes_of(p);
    double rate, frequency, w = m.modes.w[mode];
    decay_of_mode(p, mode, &rate, &frequency);
    check_close(rate, ratio * w, 1e-5 * ratio * w + 1e-9 * w);
    check_relative(frequency, w * sqrt(1 - ratio * ratio), 1e-7);
}

static const char *const hubs[] = {"arm.hub_joint=rigid", "arm.hub_joint=beam"};

TEST(modes_decay_with_the_ratios_of_the_list)
{
    const double ratios[] = {0.02, 0.3, 0.005, 0};
    for (int hub = 0; hub < 2; hub++) {
        for (int mode = 0; mode < 4; mode++) {
            parameters p = parameters_with(
                "%s arm.links=5 wall.kind=none arm.modal_ratios=0.02,0.3,0.005 "
                "motor.stiction=1000 motor.voltage=0",
                hubs[hub]);
            check_decay(&p, mode, ratios[mode]);
        }
    }

    // and links that differ
    parameters p =
        parameters_with("arm.links=4 wall.kind=none arm.modal_ratios=0.02,0.3,0.1 "
                        "arm.joint_stiffness=8,11,5 arm.link_lengths=0.2,0.3,0.4,0.1 "
                        "motor.stiction=1000 motor.voltage=0");
    check_decay(&p, 0, 0.02);
    check_decay(&p, 1, 0.3);
    check_decay(&p, 2, 0.1);
}

// Drag per length over mass per length: every mode of the held beam decays at half of it.
TEST(air_takes_from_all_modes_alike)
{
    const double drag = 0.5, rate = drag / 0.40108 / 2;
    for (int mode = 0; mode < 3; mode++) {
        parameters p = parameters_with("arm.links=4 wall.kind=none arm.air_drag=0.5 "
                                       "motor.stiction=1000 motor.voltage=0");
        held_modes m = held_modes_of(&p);
        check_decay(&p, mode, rate / m.modes.w[mode]);
    }
}

// Ratios that grow with the frequency are damping in proportion to stiffness.
TEST(ratios_in_proportion_are_structural_damping)
{
    for (int hub = 0; hub < 2; hub++) {
        parameters p =
            parameters_with("%s arm.links=5 arm.damping_ratio=0.03 wall.kind=plane",
                            hubs[hub]);
        held_modes m = held_modes_of(&p);
        char list[160] = "arm.modal_ratios=";
        for (int i = 0; i < m.modes.count; i++) {
            const size_t used = strlen(list);
            snprintf(list + used, sizeof list - used, "%s%.15g", i > 0 ? "," : "",
                     0.03 * m.modes.w[i] / m.modes.w[0]);
        }
        parameters q =
            parameters_with("%s arm.links=5 %s wall.kind=plane", hubs[hub], list);
        arm b = arm_of(&q);
        assert_int_equal(b.damped_modes, m.modes.count);

        // the same accelerations and losses
        double angle[MOST], velocity[MOST], one[MOST], other[MOST];
        chain_link work[MOST];
        chain_reaction r, s;
        for (int i = 0; i < b.dof; i++) {
            angle[i] = 0.2 * sin(2.1 * i);
            velocity[i] = cos(1.7 * i);
        }
        chain_accelerations(&m.arm, work, angle, velocity,
                            (contact_state){true, HUB_FORWARD}, one, &r);
        chain_accelerations(&b, work, angle, velocity, (contact_state){true, HUB_FORWARD},
                            other, &s);
        for (int i = 0; i < b.dof; i++) {
            check_close(other[i], one[i], 1e-6 * (1 + fabs(one[i])));
        }
        check_relative(s.damping_power, r.damping_power, 1e-6);
        check_relative(s.force, r.force, 1e-6);
    }
}

// An arm that turns as a whole loses nothing to damping by mode.
TEST(an_arm_that_turns_as_a_whole_is_not_damped)
{
    parameters p =
        parameters_with("arm.links=5 arm.hub_joint=beam arm.modal_ratios=0.1,0.2");
    held_modes m = held_modes_of(&p);
    double angle[MOST] = {0}, velocity[MOST], alpha[MOST];
    chain_link work[MOST];
    chain_reaction r;
    for (int i = 0; i < m.arm.dof; i++) {
        velocity[i] = 3;
    }
    chain_accelerations(&m.arm, work, angle, velocity,
                        (contact_state){false, HUB_FORWARD}, alpha, &r);
    check_close(r.damping_power, 0, 1e-20);
}
