#include "tests/given_parameters.h"

#include "src/thesis/printed_algorithm.h"

enum { MOST_ROWS = 20000 };

// A recorded run of the printed algorithm.
typedef struct recording {
    printed_row rows[MOST_ROWS];
    int count;
} recording;

// Changes timed parameters before the step that starts at a time [s].
typedef void (*script)(double time, parameters *p);

// Steps through a run and records its rows until it ends or fails.
static status run_into(recording *r, parameters p, script change, fault *f)
{
    printed_motion m;
    status result = STATUS_OK;
    printed_motion_start(&m, &p);
    r->rows[r->count++] = m.row;
    while (result == STATUS_OK && !printed_motion_ended(&m)) {
        if (change != NULL) {
            change(m.row.time, &p);
            printed_motion_rebind(&m, &p);
        }
        result = printed_motion_step(&m, f);
        if (result == STATUS_OK) {
            assert_true(r->count < MOST_ROWS);
            r->rows[r->count++] = m.row;
        }
    }
    return result;
}

static parameters printed_parameters_of(double voltage, double duration)
{
    parameters p = defaults_of(ARM_PRINTED);
    p.motor.voltage = voltage;
    p.run.duration = duration;
    return p;
}

static recording *run(const parameters *p, script change)
{
    recording *r = calloc(1, sizeof *r);
    assert_non_null(r);
    DONE(run_into(r, *p, change, &f));
    return r;
}

TEST(rows_stand_on_the_time_grid_from_the_initial_state)
{
    parameters p = printed_parameters_of(5, 0.6);
    p.initial.angle = -0.2;
    SCOPED(free_kept) recording *r = run(&p, NULL);
    assert_int_equal(r->count, 601);
    check_close(r->rows[0].angle[2], -0.2, 0);
    check_close(r->rows[0].force, 0, 0);
    for (int i = 0; i < r->count; i++) {
        check_close(r->rows[i].time, i * 1e-3, 1e-12);
    }
}

static double first_contact(const parameters *p)
{
    SCOPED(free_kept) recording *r = run(p, NULL);
    double time = (double)NAN;
    for (int i = r->count - 1; i >= 0; i--) {
        if (r->rows[i].contact) {
            time = r->rows[i].time;
        }
    }
    return time;
}

TEST(first_contact_comes_when_the_thesis_says)
{
    const double voltage[4] = {1, 2, 5, 10}, expected[4] = {0.312, 0.215, 0.145, 0.101};
    for (int i = 0; i < 4; i++) {
        // the listing labels a row with the time at which its step starts
        parameters p = printed_parameters_of(voltage[i], 0.5);
        check_close(first_contact(&p) - p.method.step, expected[i], 0.00101);
    }
}

TEST(contact_keeps_the_constraint_and_never_pulls)
{
    parameters p = printed_parameters_of(1, 1);
    p.printed.newton_iterations = 5;
    SCOPED(free_kept) recording *r = run(&p, NULL);
    int in_contact = 0, pulses = 0;
    for (int i = 1; i < r->count; i++) {
        const printed_row *row = &r->rows[i];
        assert_true(row->force >= 0);
        if (row->contact) {
            check_close(row->gap, 0, 1e-6);
            in_contact++;
            pulses += !r->rows[i - 1].contact;
        } else {
            check_close(row->force, 0, 0);
        }
    }
    assert_true(in_contact > 50);
    // "a number of pulses precede the steady force"
    assert_true(pulses >= 2);
}

// The listing's way of letting go: the constraint is left in the step after the one whose
// force came out as nothing, and no sooner.
TEST(contact_ends_after_the_step_without_force)
{
    parameters p = printed_parameters_of(2, 1);
    SCOPED(free_kept) recording *r = run(&p, NULL);
    int releases = 0;
    for (int i = 1; i + 1 < r->count; i++) {
        if (r->rows[i].contact) {
            assert_true(r->rows[i + 1].contact == (r->rows[i].force > 1e-6));
            releases += !r->rows[i + 1].contact;
        }
    }
    assert_true(releases >= 1);
}

TEST(steady_force_is_the_balance_of_the_printed_equations)
{
    // at rest k1 (theta1 - theta2) = torque less what friction holds back, and (2.16),
    // (2.17) as printed give f l (1 + cos d) + f l = k1 (theta1 - theta2): three levers
    // instead of two
    parameters p = printed_parameters_of(1, 6);
    p.arm.damping_ratio = 0;
    SCOPED(free_kept) recording *r = run(&p, NULL);
    const printed_row *end = &r->rows[r->count - 1];
    double mean = 0, hub_torque = 0;
    for (int i = 0; i < 1000; i++) {
        const printed_row *row = &r->rows[r->count - 1 - i];
        mean += row->force / 1000;
        hub_torque += p.arm.k1 * (row->angle[0] - row->angle[1]) / 1000;
    }
    check_relative(mean * 3 * 0.5, hub_torque, 0.03);
    assert_true(end->contact);
    check_close(hub_torque, 0.4377, 0.045 + 0.01);
}

TEST(no_wall_no_contact)
{
    parameters p = printed_parameters_of(5, 1);
    p.wall.kind = WALL_NONE;
    SCOPED(free_kept) recording *r = run(&p, NULL);
    assert_true(r->rows[r->count - 1].angle[2] > 0.5);
    for (int i = 0; i < r->count; i++) {
        assert_false(r->rows[i].contact);
        check_close(r->rows[i].force, 0, 0);
    }
}

TEST(the_wall_stands_where_its_angle_says)
{
    parameters near = printed_parameters_of(1, 1), far = near;
    far.wall.angle = 0.4;
    far.initial.angle = 0.3;
    check_close(first_contact(&far), first_contact(&near), 1e-9);
}

TEST(command_saturates_at_its_limit)
{
    parameters ten = printed_parameters_of(10, 0.3),
               twenty = printed_parameters_of(20, 0.3);
    SCOPED(free_kept) recording *a = run(&ten, NULL), *b = run(&twenty, NULL);
    assert_memory_equal(a->rows, b->rows, (size_t)a->count * sizeof a->rows[0]);
}

TEST(same_input_gives_the_same_bytes)
{
    parameters p = printed_parameters_of(5, 1);
    SCOPED(free_kept) recording *a = run(&p, NULL), *b = run(&p, NULL);
    assert_int_equal(a->count, b->count);
    assert_memory_equal(a->rows, b->rows, sizeof a->rows);
}

static void switch_off_at_100_ms(double time, parameters *p)
{
    p->motor.voltage = time < 0.1 - 1e-9 ? 2 : 0;
}

TEST(script_changes_parameters_between_steps)
{
    parameters p = printed_parameters_of(2, 1);
    SCOPED(free_kept)
    recording *driven = run(&p, NULL), *coasting = run(&p, switch_off_at_100_ms);
    assert_memory_equal(driven->rows, coasting->rows, 101 * sizeof driven->rows[0]);
    check_below(coasting->rows[101].velocity[0], driven->rows[101].velocity[0]);
    // back EMF and friction stop it before the wall
    assert_false(coasting->rows[coasting->count - 1].contact);
}

TEST(overflow_stops_the_run_with_a_sentence)
{
    parameters p = printed_parameters_of(1, 1);
    p.initial.velocity = 1e200;
    SCOPED(free_kept) recording *r = calloc(1, sizeof *r);
    REFUSED(STATUS_NOT_FINITE, "t = 0 s", run_into(r, p, NULL, &f));
    assert_int_equal(r->count, 1);
    for (int i = 0; i < 3; i++) {
        assert_true(isfinite(r->rows[0].velocity[i]));
    }
}

// A smooth torque from nothing, sampled at the end of each step as Newmark's method does.
static double ramp(double time)
{
    return 3 * sin(12 * time) * sin(12 * time);
}
static double ramp_step; // [s]
static void follow_ramp(double time, parameters *p)
{
    p->motor.voltage = ramp(time + ramp_step);
}

// (2.15)-(2.17) without contact and stiction, solved for the accelerations by hand.
static void printed_equations(const parameters *p, double time, const double y[6],
                              double rate[6])
{
    double l = 0.5, e = 0.25, m = p->arm.mass / 2, in = p->arm.link_inertia;
    double d = y[2] - y[1], c = cos(d), s = sin(d), w1 = y[3], w2 = y[4], w3 = y[5];
    double kt = p->motor.torque_constant, ra = p->motor.resistance;
    double torque = p->motor.amplifier_gain * kt / ra * ramp(time);
    double a = m * e * e + m * l * l + in + m * l * e * c,
           b = m * e * e + in + m * l * e * c;
    double g = m * l * e * c, h = m * e * e + in;
    double right2 =
        p->arm.k2 * d - p->arm.k1 * (y[1] - y[0]) + m * l * e * s * (w3 * w3 - w2 * w2);
    double right3 = -p->arm.k2 * d - m * l * e * s * w2 * w2;
    double determinant = a * h - b * g;
    memcpy(rate, y + 3, 3 * sizeof(double));
    rate[3] = (torque + p->arm.k1 * (y[1] - y[0]) -
               (p->motor.viscous_friction + kt * p->motor.back_emf / ra) * w1) /
              p->arm.hub_inertia;
    rate[4] = (h * right2 - b * right3) / determinant;
    rate[5] = (a * right3 - g * right2) / determinant;
}

static void runge_kutta(const parameters *p, double duration, int steps, double y[6])
{
    double h = duration / steps;
    for (int i = 0; i < steps; i++) {
        double k[4][6], at[6], t = i * h;
        const double ahead[4] = {0, 0.5, 0.5, 1};
        for (int stage = 0; stage < 4; stage++) {
            for (int j = 0; j < 6; j++) {
                at[j] = y[j] + (stage > 0 ? ahead[stage] * h * k[stage - 1][j] : 0);
            }
            printed_equations(p, t + ahead[stage] * h, at, k[stage]);
        }
        for (int j = 0; j < 6; j++) {
            y[j] += h / 6 * (k[0][j] + 2 * k[1][j] + 2 * k[2][j] + k[3][j]);
        }
    }
}

// Largest error of the angles at the end of a free flight in steps of h.
static double newmark_error(parameters p, const double exact[6], double h)
{
    p.method.step = ramp_step = h;
    SCOPED(free_kept) recording *r = run(&p, follow_ramp);
    const printed_row *end = &r->rows[r->count - 1];
    double error = 0;
    for (int i = 0; i < 3; i++) {
        error = fmax(error, fabs(end->angle[i] - exact[i]));
        error = fmax(error, 0.05 * fabs(end->velocity[i] - exact[3 + i]));
    }
    return error;
}

TEST(free_flight_converges_to_the_equations_with_second_order)
{
    parameters p = printed_parameters_of(1, 0.25);
    p.wall.kind = WALL_NONE;
    p.motor.stiction = 0;
    p.printed.newton_iterations = 10;
    double exact[6] = {0, 0, 0, 0, 0, 0};
    runge_kutta(&p, 0.25, 50000, exact);
    assert_true(fabs(exact[2]) > 0.05);
    double coarse = newmark_error(p, exact, 5e-4), fine = newmark_error(p, exact, 2.5e-4);
    double finest = newmark_error(p, exact, 1.25e-4);
    check_below(finest, 1e-4);
    check_close(log2(coarse / fine), 2, 0.15);
    check_close(log2(fine / finest), 2, 0.15);
    // with gamma off one half the order drops to one
    p.method.gamma = 0.6;
    check_close(log2(newmark_error(p, exact, 2.5e-4) / newmark_error(p, exact, 1.25e-4)),
                1, 0.15);
}

TEST(beta_matters_little_in_free_flight)
{
    parameters p = printed_parameters_of(1, 0.3), q = p;
    p.wall.kind = q.wall.kind = WALL_NONE;
    p.method.beta = 0.25;
    SCOPED(free_kept) recording *a = run(&p, NULL), *b = run(&q, NULL);
    check_close(a->rows[a->count - 1].angle[2], b->rows[b->count - 1].angle[2], 2e-3);
}

// Largest force of a run that may fail on its way, huge if it does.
static double largest_force(const parameters *p)
{
    SCOPED(free_kept) recording *r = calloc(1, sizeof *r);
    fault f = {.text = ""};
    assert_non_null(r);
    double largest = run_into(r, *p, NULL, &f) == STATUS_OK ? 0 : HUGE_VAL;
    for (int i = 0; i < r->count; i++) {
        largest = fmax(largest, r->rows[i].force);
    }
    return largest;
}

// 3.1.3: with a single run no beta and gamma give a force that is any use. Where it
// survives, it is the impulse over one step: ten times as large with a tenth of the step.
TEST(a_single_run_gives_no_force_whatever_beta_and_gamma)
{
    parameters p = printed_parameters_of(1, 0.5);
    const double both = largest_force(&p);
    p.printed.reevaluation = REEVALUATE_NONE;
    for (int b = 0; b < 4; b++) {
        for (int g = 0; g < 3; g++) {
            p.method.beta = 0.1 + 0.2 * b;
            p.method.gamma = 0.5 + 0.2 * g;
            p.method.step = 1e-3;
            check_below(5 * both, largest_force(&p));
        }
    }

    // with the thesis's own pair
    p.method.beta = 0.4;
    p.method.gamma = 0.5;
    double coarse = largest_force(&p);
    p.method.step = 1e-4;
    double fine = largest_force(&p);
    check_below(7 * coarse, fine);
    check_below(fine, 13 * coarse);

    // what two runs give hardly depends on the step
    p.printed.reevaluation = REEVALUATE_RHS;
    check_relative(largest_force(&p), both, 0.05);
}

TEST(negative_forces_change_no_peak)
{
    parameters p = printed_parameters_of(5, 1);
    SCOPED(free_kept) recording *clamped = run(&p, NULL);
    p.printed.clamp_force = false;
    SCOPED(free_kept) recording *free_sign = run(&p, NULL);
    double largest[2] = {0, 0}, smallest = 0;
    for (int i = 0; i < clamped->count; i++) {
        largest[0] = fmax(largest[0], clamped->rows[i].force);
        largest[1] = fmax(largest[1], free_sign->rows[i].force);
        smallest = fmin(smallest, free_sign->rows[i].force);
    }
    check_below(smallest, 0);
    check_close(largest[1], largest[0], 0);
}

// Every step under every combination of switches: Newmark's relations between both ends,
// the equations at its end, what is re-evaluated there, and what the next step starts
// from.
TEST(every_step_solves_what_its_switches_say)
{
    int constrained = 0, released = 0, steps = 0, unsolved = 0;
    for (unsigned switches = 0; switches < 96; switches++) {
        parameters p = printed_parameters_of(switches % 2 ? 2 : 5, 0.5);
        p.printed.spring_counted_twice = switches & 1;
        p.printed.force_at_link_end = switches & 2;
        p.printed.feed_newmark_acceleration = switches & 4;
        p.printed.clamp_force = switches & 8;
        p.printed.force_after_release = switches & 16;
        p.printed.reevaluation = (int)(switches / 32);
        p.printed.newton_iterations = 40;
        p.method.beta = 0.3025;
        p.method.gamma = 0.6;
        p.motor.stiction = 0; // whose jump Newton may go back and forth over
        const double h = p.method.step, beta = p.method.beta, gamma = p.method.gamma;
        printed_motion m;
        fault f;
        printed_motion_start(&m, &p);
        double fed[3] = {0}; // as listed, from zero
        for (int k = 0; k < 500; k++) {
            assert_false(printed_motion_ended(&m));
            const printed_row from = m.row;
            const double force_before = m.force;
            if (printed_motion_step(&m, &f) != STATUS_OK) {
                break; // some combinations overflow
            }
            const printed_row *to = &m.row;
            check_close(to->time, (k + 1) * h, 1e-15);
            for (int i = 0; i < 3; i++) {
                const double next = to->newmark_acceleration[i];
                const double size = 1e-9 * (1 + fabs(next) + fabs(fed[i]));
                check_close(to->angle[i],
                            from.angle[i] + h * from.velocity[i] +
                                h * h * ((0.5 - beta) * fed[i] + beta * next),
                            size * h);
                check_close(to->velocity[i],
                            from.velocity[i] + h * ((1 - gamma) * fed[i] + gamma * next),
                            size);
            }

            // the equations to Newton's tolerance; without contact the wall is not passed
            // unless the force of a release is still there
            double residual[4], alpha[3] = {0}, force;
            printed_residual(&m.arm, to->angle, to->velocity, to->newmark_acceleration,
                             m.newmark_force, residual);
            double largest = 0;
            for (int i = 0; i < (to->contact ? 4 : 3); i++) {
                largest = fmax(largest, fabs(residual[i]));
            }
            unsolved += largest > 2e-3 * (1 + fabs(m.newmark_force));
            steps++;
            assert_true(to->contact || m.newmark_force == 0);
            check_close(to->gap, -printed_penetration(&m.arm, to->angle), 0);
            constrained += to->contact;
            released += from.contact && !to->contact;
            assert_true(!from.contact || to->contact == (force_before > 1e-6));

            // accelerations and force of that instant
            const bool wanted = p.printed.force_after_release
                                    ? force_before > 0 || m.contact_steps == 1
                                    : to->contact;
            if (!wanted) {
                check_close(to->force, 0, 0);
                assert_memory_equal(to->acceleration, to->newmark_acceleration,
                                    sizeof alpha);
            } else if (p.printed.reevaluation == REEVALUATE_NONE) {
                const double own = m.newmark_force;
                check_close(to->force, p.printed.clamp_force ? fmax(own, 0) : own, 0);
                assert_memory_equal(to->acceleration, to->newmark_acceleration,
                                    sizeof alpha);
            } else {
                assert_true(
                    printed_reevaluate(&m.arm, to->angle, to->velocity, alpha, &force));
                check_close(to->force, p.printed.clamp_force ? fmax(force, 0) : force, 0);
                assert_memory_equal(to->acceleration, alpha, sizeof alpha);
            }
            check_close(m.force, to->force, 0);
            memcpy(fed,
                   p.printed.feed_newmark_acceleration ? to->newmark_acceleration
                                                       : to->acceleration,
                   sizeof fed);
        }
    }
    assert_true(constrained > 1000 && released > 50);

    // Newton's method goes back and forth in a few of them
    assert_true(unsolved < steps / 10);
}
