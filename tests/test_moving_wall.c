// A wall that moves: driven arms and impacts in closed form, walls moved at once by a
// script, and a law that holds its force on one.

#include "src/arm/impact.h"
#include "src/session/session.h"
#include "tests/passage.h"
#include "tests/rig_fixture.h"
#include "tests/scenario_fixture.h"

// One link without friction, pressed by its weight against a flat wall at the angle 0.
#define PRESSED_LINK                                                                     \
    "arm.links=1", "wall.kind=plane", "wall.angle=0", "motor.voltage=0",                 \
        "motor.stiction=0", "motor.viscous_friction=0", "motor.back_emf=0",              \
        "arm.tilt=-0.3", "wall.motion=sine"

// The angle at an instant, from rest at the wall.
static double angle_at(const char *const *settings, double time, double *force)
{
    const parameters p = fixture_parameters(settings);
    STARTED(a, m, &p, NULL, p.initial.angle, 0);
    assert_ptr_equal(m->engine, &stiff_engine);
    const passage done = move_on(&a, m, time, 100000);
    check_below(done.open, 1e-10);
    *force = m->state[SLOT_FORCE];
    return state_angles(m, m->state)[0];
}

// On a spring and damper the link is an oscillator that the wall drives:
// (-I w^2 + L^2 (k + i w c)) q = -L (k + i w c) u.
TEST(a_driven_spring_has_its_amplitude_and_phase)
{
    arm a = arm_with(SETTINGS(PRESSED_LINK));
    const double length = a.link_length, k = 2000, c = 20, u = 1e-5;
    const double inertia = a.hub_inertia + a.link_mass * length * length / 3;
    for (EACH_TEXT(one, "2", "15", "20", "60")) {
        const double w = 2 * M_PI * atof(*one), period = 2 * M_PI / w;
        const double lre = length * length * k - inertia * w * w,
                     lim = length * length * w * c;
        const double d = lre * lre + lim * lim;
        const double re = -length * u * (k * lre + w * c * lim) / d;
        const double im = -length * u * (w * c * lre - k * lim) / d;
        for (int phase = 0; phase < 4; phase++) {
            const double t = 2 + phase * period / 4;
            double q[2], force;
            for (int side = 0; side < 2; side++) {
                q[side] = angle_at(SETTINGS(PRESSED_LINK, "wall.contact=kelvin-voigt",
                                            "wall.stiffness=2000", "wall.damping=20",
                                            formatted("wall.motion_frequency=%s", *one),
                                            side ? "wall.motion_amplitude=-1e-5"
                                                 : "wall.motion_amplitude=1e-5"),
                                   t, &force);
            }
            const double expected = re * sin(w * t) + im * cos(w * t);
            check_close((q[0] - q[1]) / 2, expected, 2e-4 * hypot(re, im));
        }
    }
}

// On a rigid one the tip goes where the wall does, and the force makes it so.
TEST(a_rigid_wall_leads_the_tip)
{
    arm a = arm_with(SETTINGS(PRESSED_LINK));
    const double length = a.link_length, u0 = 1e-3, w = 2 * M_PI * 2;
    const double inertia = a.hub_inertia + a.link_mass * length * length / 3;
    for (int i = 1; i < 8; i++) {
        // from its end on, where it comes to the arm at no speed
        const double t = 0.11 * i, s = u0 * sin(w * (t + 0.125)),
                     v = u0 * w * cos(w * (t + 0.125));
        const double accelerates = -w * w * s;
        double force;
        const double q =
            angle_at(SETTINGS(PRESSED_LINK, "wall.motion_frequency=2",
                              "wall.motion_time=-0.125",
                              formatted("initial.angle=%.17g", -asin(u0 / length))),
                     t, &force);
        check_close(q, -asin(s / length), 1e-9);

        // q' = -v/(L cos q), q" = -(a + L sin q q'^2 ... )/(L cos q), of s = -L sin q
        const double rate = -v / (length * cos(q));
        const double turn =
            -(accelerates - length * sin(q) * rate * rate) / (length * cos(q));
        const double weight = a.amount.gravity * a.link_mass * length / 2 * cos(q);
        check_relative(force, (-weight - inertia * turn) / (length * cos(q)), 1e-6);
    }
}

// A link at rest that a wall meets at a constant speed leaves it as one that comes at
// that speed leaves a wall at rest: seen from the wall. The sine is slow enough to be
// straight.
TEST(a_wall_at_constant_speed_is_one_at_rest_seen_from_it)
{
    for (EACH_OF(double, c, 0, 0.5, 1)) {
        const parameters p = fixture_parameters(
            SETTINGS(PRESSED_LINK, "arm.tilt=0", "initial.angle=-0.01",
                     formatted("wall.restitution=%g", *c), "wall.motion_amplitude=10",
                     "wall.motion_frequency=0.001"));
        STARTED(a, m, &p, NULL, -0.01, 0);
        const double w = 2 * M_PI * 1e-3, place = a.link_length * sin(0.01);
        const double meets = asin(place / 10) / w, speed = 10 * w * cos(w * meets);
        const passage done = move_on(&a, m, meets + 1e-3, 1000);
        assert_int_equal(done.impacts, 1);
        const double turns = -(1 + *c) * speed / (a.link_length * cos(0.01));
        const double inertia =
            a.hub_inertia + a.link_mass * a.link_length * a.link_length / 3;
        check_relative(state_velocities(m, m->state)[0], turns, 1e-5);
        check_relative(done.momentum, -inertia * turns / (a.link_length * cos(0.01)),
                       1e-5);
        check_below(done.open, 1e-10);
    }
}

// An arm at rest that a wall strikes gets the impulse with which it would strike the
// wall.
TEST(only_the_relative_velocity_counts_at_an_impact)
{
    for (EACH_TEXT(c, "wall.kind=plane", "wall.kind=point")) {
        const parameters p = fixture_parameters(
            SETTINGS("arm.links=3", "arm.hub_joint=spring", "wall.angle=0.2", *c));
        arm still, comes;
        arm_init(&still, &p);
        comes = still;
        comes.wall.motion.kind = MOTION_SINE;
        comes.wall.shift.velocity = 0.7;
        const double q[] = {0.19, 0.21, 0.2, 0.18}, rest[4] = {0};
        double w[4], by_arm[4], by_wall[4];
        chain_link work[3];
        const double reach = chain_contact_response(&still, work, q, false, w);
        const double same = chain_penetration(&comes, q, rest).rate;
        for (int k = 0; k < 4; k++) {
            w[k] *= -same / reach;
        }
        const impact_result one =
            impact_velocity_increments(&still, work, q, w, 0, 0.4, by_arm);
        const impact_result two =
            impact_velocity_increments(&comes, work, q, rest, 0, 0.4, by_wall);
        check_relative(one.speed, two.speed, 1e-13);
        check_relative(one.impulse, two.impulse, 1e-13);
        for (int k = 1; k < 4; k++) {
            check_close(by_arm[k], by_wall[k], 1e-12);
        }

        // the arm gains what the wall does less the loss
        check_relative(chain_kinetic_energy(&comes, q, by_wall), two.work - two.loss,
                       1e-12);
    }
}

// --- a face with a mass ----------------------------------------------------------------

// x'' = u'' - (c x' + k x)/M and the work of (k x + c x') u', by the classic formula of
// order 4 in so many steps, extrapolated.
static void shaken_by_steps(const wall_model *w, wall_face from, double h, int steps,
                            double y[3])
{
    static const double node[] = {0, 0.5, 0.5, 1},
                        weight[] = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};
    const double step = h / steps;
    y[0] = from.position, y[1] = from.velocity, y[2] = 0;
    for (int i = 0; i < steps; i++) {
        double k[3] = {0}, sum[3] = {0};
        for (int j = 0; j < 4; j++) {
            const double part = node[j] * step, x = y[0] + part * k[0],
                         v = y[1] + part * k[1];
            const wall_shift at =
                wall_motion_at(&w->motion, w->shift.time + i * step + node[j] * step);
            const double pulls = w->stiffness * x + w->damping * v;
            k[0] = v, k[1] = at.acceleration - pulls / w->face_mass,
            k[2] = pulls * at.velocity;
            for (int n = 0; n < 3; n++) {
                sum[n] += weight[j] * k[n];
            }
        }
        for (int n = 0; n < 3; n++) {
            y[n] += step * sum[n];
        }
    }
}

// Swinging, at its own frequency without a damper, creeping, and in a soft bed: place,
// speed and work are those of an independent integrator; energy put in is stored or lost.
TEST(a_shaken_face_swings_as_its_equation_says)
{
    static const double beds[][3] = {{0.05, 2000, 3},
                                     {0.05, 0.05 * 4 * M_PI * M_PI * 900, 0},
                                     {0.01, 500, 20},
                                     {0.2, 5, 0.01},
                                     {0.02, 1e4, 50}};
    static const wall_motion_kind kinds[] = {MOTION_SINE, MOTION_STEP};
    for (int i = 0; i < 10; i++) {
        const double *bed = beds[i / 2];
        const wall_model still = {.law = WALL_KELVIN_VOIGT,
                                  .stiffness = bed[1],
                                  .damping = bed[2],
                                  .exponent = 1,
                                  .face_mass = bed[0],
                                  .motion = {.kind = kinds[i % 2],
                                             .amplitude = 2e-3,
                                             .frequency = 30,
                                             .time = -1e-3}};
        const wall_model w = wall_at(&still, 2e-3);
        const wall_face from = {1e-4, -0.02};
        const double h = 8e-3;
        double coarse[3], fine[3];
        shaken_by_steps(&w, from, h, 4000, coarse);
        shaken_by_steps(&w, from, h, 8000, fine);
        for (int n = 0; n < 3; n++) {
            fine[n] += (fine[n] - coarse[n]) / 15;
        }
        const wall_face end = wall_face_after(&w, from, h);
        check_close(end.position, fine[0], 1e-13);
        check_close(end.velocity, fine[1], 1e-11);
        check_close(wall_face_work(&w, from, h), fine[2], 1e-13);

        // in two parts as in one, and without a loss where no damper is
        const wall_face half = wall_face_after(&w, from, h / 3);
        const wall_model later = wall_at(&still, 2e-3 + h / 3),
                         last = wall_at(&still, 2e-3 + h);
        const wall_face again = wall_face_after(&later, half, h - h / 3);
        check_close(again.position, end.position, 1e-15);
        const double put_in = wall_face_work(&w, from, h);
        const double lost =
            wall_face_energy(&w, from) + put_in - wall_face_energy(&last, end);
        fail_if(bed[2] > 0 ? lost <= 0 : fabs(lost) > 1e-15, "%d: %g J", i, lost);

        // the rate is that of the motion
        const wall_face next = wall_face_after(&w, from, 1e-7);
        check_relative(wall_face_acceleration(&w, from),
                       (next.velocity - from.velocity) / 1e-7, 1e-3);
    }
}

// A light face with a heavy damper soon creeps: it is followed in long steps as in short
// ones.
TEST(a_face_that_creeps_is_followed_in_long_steps)
{
    const wall_model still = {.law = WALL_KELVIN_VOIGT,
                              .stiffness = 2e3,
                              .damping = 30,
                              .exponent = 1,
                              .face_mass = 1e-6,
                              .motion = {MOTION_SINE, 2e-3, 5, 0, NULL}};
    wall_face face = {0, 0};
    double time = 0;
    for (int i = 0; i < 4000; i++, time += 1e-6) {
        const wall_model w = wall_at(&still, time);
        face = wall_face_after(&w, face, 1e-6);
    }
    const wall_model w = wall_at(&still, time);
    check_relative(wall_face_rate(&w, face), 2e3 / 30, 1e-4);
    wall_face fine = face;
    double pieces = 0;
    for (int i = 0; i < 4000; i++) {
        const wall_model at = wall_at(&still, time + i * 1e-6);
        pieces += wall_face_work(&at, fine, 1e-6);
        fine = wall_face_after(&at, fine, 1e-6);
    }
    const wall_face end = wall_face_after(&w, face, 4e-3);
    check_close(end.position, fine.position, 1e-15);
    check_close(end.velocity, fine.velocity, 1e-13);
    check_close(wall_face_work(&w, face, 4e-3), pieces, 1e-15);
}

// A run on one: what is put in is stored or lost, to the last digits.
TEST(the_ledger_closes_on_a_shaken_face)
{
    static const char *const sets[][3] = {
        {"wall.motion=sine", "wall.stiffness=2000", "wall.damping=5"},
        {"wall.motion=sine", "wall.stiffness=75000", "wall.damping=0"},
        {"wall.motion=step", "wall.stiffness=400", "wall.damping=40"},
        {"wall.motion=step", "wall.stiffness=1e6", "wall.damping=300"}};
    for (size_t i = 0; i < 8; i++) {
        const char *const *set = sets[i / 2];
        RUN(r, "wall.kind=plane", "wall.contact=kelvin-voigt", "wall.mass=0.05",
            "wall.motion_frequency=9", "wall.motion_time=0.2", set[0], set[1], set[2],
            i % 2 ? "arm.links=4" : "arm.links=2", "arm.tilt=-0.2",
            "wall.motion_amplitude=2e-3", "wall.restitution=0.3");
        assert_true(r.summary.impacts > 0);
        check_below(r.summary.energy_residual_J, 1e-10 * fabs(r.summary.motor_work_J));
    }
}

// The same of all walls that move, at every row: what is lacking is a share of what motor
// and wall did, one way and the other.
TEST(the_ledger_closes_on_every_wall_that_moves)
{
    static const char *const sets[][5] = {
        {"wall.motion=sine", "wall.contact=hunt-crossley", "wall.damping=300",
         "arm.links=6", "wall.motion_frequency=743"},
        {"wall.motion=sine", "wall.contact=hunt-crossley", "wall.damping=0",
         "arm.links=1", "wall.motion_frequency=986"},
        {"wall.motion=step", "wall.contact=kelvin-voigt", "wall.stiffness=3000",
         "arm.links=1", "motor.voltage=5"},
        // so fast that the force falls through zero within the last bit of the time
        {"wall.motion=sine", "wall.motion_amplitude=1e-6", "wall.motion_frequency=1e4",
         "arm.links=2", "motor.voltage=2"}};
    int worked = 0;
    for (EACH(set, sets)) {
        const char *const *more = *set;
        RUN(r, "wall.motion_amplitude=5e-3", "wall.motion_frequency=15", more[0], more[1],
            more[2], more[3], more[4], "run.duration=0.6");
        double worst = 0, done = 0;
        for (size_t k = 1; k < r.trace.row_count; k++) {
            const sample *was = &r.trace.rows[k - 1], *is = &r.trace.rows[k];
            worst = fmax(worst, fabs(is->energy_residual));
            done += fabs(is->motor_work - was->motor_work) +
                    fabs(is->wall_work - was->wall_work);
        }
        check_below(fmax(worst, r.summary.energy_residual_J), 1e-10 * done);

        // the summary says what the wall did in all
        check_close(r.summary.wall_work_J, r.trace.rows[r.trace.row_count - 1].wall_work,
                    0);
        worked += r.summary.wall_work_J != 0;
    }
    assert_true(worked > 1);
    RUN(still, "run.duration=0.6");
    assert_true(isnan(still.summary.wall_work_J));
}

// --- walls that a script moves ---------------------------------------------------------

static run_result run_of(const char *wall, double from, double time, double to,
                         status expected)
{
    const char *text = formatted("wall: {%s, angle: %.17g}\nrun: {duration: 0.6}\n"
                                 "method: {tolerance: 1e-10}\n"
                                 "script:\n  - {at: %.17g, set: {wall.angle: %g}}\n",
                                 wall, from, time, to);
    KEPT_SCENARIO(s) = good(text);
    run_result r;
    run_scenario(&s, true, &r);
    fail_if(r.summary.status != expected, "%s: %s", text, r.summary.message);
    return r;
}

static const char *const walls[] = {"kind: point", "kind: plane, restitution: 0.4",
                                    "kind: point, contact: kelvin-voigt",
                                    "kind: plane, contact: hunt-crossley",
                                    "kind: point, contact: kelvin-voigt, mass: 0.05"};

// Moved while the arm flies, it is as if it had always been there.
TEST(a_wall_moved_in_flight_is_where_it_was_put)
{
    for (EACH(c, walls)) {
        KEPT_RUN(moved) = run_of(*c, 0.1, 0.05, 0.07, STATUS_OK);
        KEPT_RUN(there) = run_of(*c, 0.07, 0, 0.07, STATUS_OK);
        check_close(moved.summary.first_contact_s, there.summary.first_contact_s, 1e-11);
        check_relative(moved.summary.motor_work_J, there.summary.motor_work_J, 1e-8);
        check_relative(moved.summary.peak_force_N, there.summary.peak_force_N, 1e-6);
    }
}

// Taken away from an arm that presses on it, it lets go at once and costs no energy;
// moved into the arm it is refused.
TEST(a_wall_moved_in_contact_lets_go_or_is_refused)
{
    for (EACH(c, walls)) {
        KEPT_RUN(r) = run_of(*c, 0.1, 0, 0.1, STATUS_OK);
        const trace *t = &r.trace;
        double pressed = 0;
        for (size_t k = 0; k < t->row_count && pressed == 0; k++) {
            pressed = t->rows[k].force > 0.01 && t->rows[k].contact != 0
                          ? t->rows[k].time + 4e-4
                          : 0;
        }
        assert_true(pressed > 0);
        run_finish(&r);

        r = run_of(*c, 0.1, pressed, 0.15, STATUS_OK);
        const event *change = find_event(&r, EVENT_CHANGE, 0);
        assert_true(change < r.trace.events + r.trace.event_count - 1);
        assert_int_equal(change[1].kind, EVENT_RELEASE);
        check_close(change[1].time, pressed, 0);
        assert_true(r.summary.energy_residual_J < 1e-10 * r.summary.motor_work_J);
        run_finish(&r);

        r = run_of(*c, 0.1, pressed, 0.099, STATUS_BAD_SCENARIO);
        assert_non_null(strstr(r.summary.message, "behind the wall"));
    }
}

// A loop goes on after a wall was refused as if nothing had been asked.
TEST(a_refused_wall_changes_nothing)
{
    double end[2];
    for (int asked = 0; asked < 2; asked++) {
        scenario s = {.parameters = fixture_parameters(SETTINGS("run.duration=0.5"))};
        KEPT_LOOP(l);
        DONE(loop_create(&l, &s, &(loop_options){0}, &f));
        DONE(loop_until(l, 0.3, &f));
        if (asked) {
            REFUSED(STATUS_BAD_SCENARIO, "behind the wall",
                    loop_set_number(l, PARAMETER_INDEX(wall.angle), 0.05, &f));
        }
        DONE(loop_until(l, 0.5, &f));
        end[asked] = loop_state(l, &(int){0})[0];
    }
    assert_true(end[0] == end[1]);
}

// On walls that come and go by a millimetre a second the law holds its force.
TEST(the_observer_holds_its_force_on_a_moving_wall)
{
    static const char *const on[] = {"wall.contact=rigid", "wall.contact=kelvin-voigt",
                                     "wall.contact=hunt-crossley"};
    for (size_t i = 0; i < 3; i++) {
        KEPT_RUN(r) = rig_run(SETTINGS("control.law=observer", "control.force=1",
                                       "control.approach_voltage=1", "run.duration=3",
                                       "wall.motion=sine", on[i]),
                              true);
        for (EACH_ROW(row, &r.trace)) {
            // a wall that takes no energy up is bounced on for longer
            if (row->time > (i < 2 ? 1 : 1.3)) {
                check_close(row->force, 1, 0.1);
            }
        }
    }
}

// --- a wall that a table moves ---------------------------------------------------------

static const char *const path_csv = "wall-path.csv";

// Rows of u = A sin(2 pi f (t - t0)) from one rest to the next but some; `every` apart.
static void write_sine(double amplitude, double f, double from, double to, double every)
{
    FILE *file = fopen(path_csv, "w");
    assert_non_null(file);
    fputs("time[ms],place[mm]\n", file);
    for (int i = 0; from + i * every < to + every / 2; i++) {
        const double t = from + i * every;
        fprintf(file, "%.17g,%.17g\n", 1e3 * t, 1e3 * amplitude * sin(2 * M_PI * f * t));
    }
    assert_int_equal(fclose(file), 0);
}

// A wall that the file moves.
static parameters path_parameters(void)
{
    return fixture_parameters(
        SETTINGS("wall.motion=file", "wall.motion_file=wall-path.csv"));
}

// The spline goes through the rows, its rate and acceleration are the derivatives of its
// place, and neither jumps at a row; a step of the engine ends at each.
TEST(a_spline_is_smooth_up_to_the_acceleration)
{
    wall_path *path;
    write_sine(2e-3, 3, -0.25, 0.25, 0.02);
    const parameters p = path_parameters();
    DONE(wall_path_create(&path, &p, &f));
    const wall_motion m = {.kind = MOTION_FILE, .time = 0.4, .path = path};
    for (size_t i = 0; i < path->rows; i++) {
        const double t = 0.4 + path->times[i], next = 1e-9;
        const wall_shift before = wall_motion_at(&m, t - next),
                         at = wall_motion_at(&m, t);
        check_close(at.place, path->places[i], 1e-15);
        check_close(before.velocity, at.velocity, 1e-8);
        if (i > 0 && i + 1 < path->rows) {
            check_close(before.acceleration, at.acceleration, 1e-5);
            check_close(wall_motion_lasts(&m, t), 0.02, 1e-9);
            const double h = 1e-5, x = t + 0.013;
            const wall_shift low = wall_motion_at(&m, x - h),
                             high = wall_motion_at(&m, x + h);
            const wall_shift mid = wall_motion_at(&m, x);
            check_close((high.place - low.place) / (2 * h), mid.velocity, 1e-8);
            check_close((high.velocity - low.velocity) / (2 * h), mid.acceleration, 1e-8);
        }
    }
    check_close(wall_motion_at(&m, -5).place, path->places[0], 0);
    check_close(wall_motion_at(&m, 9).place, path->places[path->rows - 1], 0);
    assert_true(wall_motion_lasts(&m, 9) == HUGE_VAL && wall_motion_rate(&m, 9) == 0);
    check_close(wall_motion_lasts(&m, 0), 0.15, 1e-12);
    wall_path_destroy(path);
    unlink(path_csv);
}

// Rows of a sine close together, at rest at the ends, are that sine: the same contacts
// and forces, to the fourth power of their distance.
TEST(a_table_of_a_sine_is_the_sine)
{
    static const char *const kinds[][2] = {
        {"wall.kind=point", "wall.contact=rigid"},
        {"wall.kind=plane", "wall.contact=rigid"},
        {"wall.kind=plane", "wall.contact=kelvin-voigt"},
        {"wall.kind=point", "wall.contact=hunt-crossley"},
    };
    write_sine(1e-3, 2, -0.125, 0.875, 0.0025);
    for (size_t i = 0; i < 4; i++) {
        summary sums[2];
        for (int file = 0; file < 2; file++) {
            RUN(r, "arm.links=3", kinds[i][0], kinds[i][1], "run.duration=0.8",
                "wall.motion_frequency=2", file ? "wall.motion=file" : "wall.motion=sine",
                "wall.motion_file=wall-path.csv", "arm.damping_ratio=0.01");
            sums[file] = r.summary;
        }
        check_close(sums[1].first_contact_s, sums[0].first_contact_s, 1e-7);
        check_relative(sums[1].contact_impulse_Ns, sums[0].contact_impulse_Ns, 1e-5);
        check_relative(sums[1].first_pulse_peak_N, sums[0].first_pulse_peak_N, 1e-4);
        assert_true(sums[1].energy_residual_J < 1e-9 * sums[1].motor_work_J);
    }
    unlink(path_csv);
}

// What cannot be a motion is told with its place in the file.
TEST(a_table_with_faults_is_told_with_its_place)
{
    static const struct {
        const char *text, *says;
    } wrong[] = {
        {"time[s],place[m]\n0,0\n", "at least 2"},
        {"time[s],place[m]\n0,0\n0.1,1\n0.1,2\n", "wall-path.csv:4:1"},
        {"time[s],place[kg]\n0,0\n1,1\n", "kg"},
        {"time[s],force[N]\n0,0\n1,1\n", "place"},
        {"time[s],place[m]\n0,0\n1,nan\n", "wall-path.csv:3"},
    };
    const parameters p = path_parameters();
    for (EACH(c, wrong)) {
        fault f = {0};
        wall_path *path;
        put_file(path_csv, c->text);
        assert_int_equal(wall_path_create(&path, &p, &f), STATUS_BAD_SCENARIO);
        assert_null(path);
        assert_string_equal(f.path, "wall.motion_file");
        fail_if(strstr(f.text, c->says) == NULL, "%s", f.text);
    }
    unlink(path_csv);
}

// A run taken up after a change goes on with the wall where the table has it.
TEST(a_resumed_run_has_its_wall)
{
    write_sine(5e-3, 1, -0.25, 2.25, 0.05);
    scenario s = {.parameters = fixture_parameters(
                      SETTINGS("arm.links=3", "wall.motion=file", "wall.motion_time=0.3",
                               "wall.motion_file=wall-path.csv", "run.duration=2.5"))};
    s.name = strdup("walls");
    KEPT_SESSION(changed);
    DONE(session_open(&changed, &s, (double)INFINITY, &f));
    session_seek(&changed, 1.6);
    DONE(session_change(&changed, PARAMETER_INDEX(motor.voltage), "2", &f));
    KEPT_RUN(whole) = run_done(&changed.effective, true);
    assert_int_equal(whole.trace.row_count, changed.run.trace.row_count);
    for (size_t i = 0; i < whole.trace.row_count; i++) {
        assert_true(whole.trace.rows[i].gap == changed.run.trace.rows[i].gap);
        assert_true(whole.trace.rows[i].force == changed.run.trace.rows[i].force);
    }
    unlink(path_csv);
}
