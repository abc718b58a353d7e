// The best possible result after an impact: closed forms, and controllers tried at
// random.
#include "src/predict/best_stop.h"
#include "tests/arm_fixture.h"

static pressed_arm_model model_of(const char *const *settings)
{
    pressed_arm_model m;
    parameters p = fixture_parameters(settings);
    assert_true(pressed_arm_model_of(&p, &m));
    return m;
}

// Rate [1/s] of the runaway mode. With a force F held at the wall the model is
// mass_force x'' = spring_force x - F, so that xi = spring_force (x + x'/s) obeys
// xi' = s (xi - F) with this s: the force grows away from every F but xi.
static double divergence(const pressed_arm_model *m)
{
    return sqrt(m->spring_force / m->mass_force);
}

// A pressed arm moves as one: the first link turns by x, the second one by -x. From the
// masses of the arm, m = 0.20054 kg and l = 0.5 m a link, follow the inertia
// M11 - 2 M12 + M22 [kg m^2], the torque 4 k2 of the spring between the links per x, and
// the force at the wall, F = (2 k2/l) x - ((M12 - M22)/l) x''. An arm that does not move
// like this has no such model.
TEST(the_model_has_the_numbers_of_the_arm)
{
    pressed_arm_model m = model_of(NULL);
    check_close(m.inertia, 0.0386, 1e-4);
    check_close(m.stiffness, 19.68, 1e-9);
    check_close(m.spring_force, 19.68, 1e-9);
    check_close(m.mass_force, 0.0167, 1e-4);
    check_close(m.torque_limit, 4.377, 1e-3);

    // each of these settings alone takes the arm out of the model
    for (EACH_TEXT(c, "arm.links=1", "arm.hub_joint=spring", "arm.damping_ratio=0.1",
                   "wall.kind=none", "arm.model=printed", "arm.tilt=0.3",
                   "arm.tip_mass=0.1", "arm.air_drag=0.1", "arm.stiffening=1",
                   "wall.motion=sine", "wall.contact=kelvin-voigt")) {
        parameters p = fixture_parameters(SETTINGS(*c));
        assert_false(pressed_arm_model_of(&p, &m));
    }

    // links whose inertia m l^2/4 makes M12 equal to M22: the force does not depend on
    // the acceleration, and there is no runaway mode
    parameters p =
        fixture_parameters(SETTINGS("arm.mass=0.4", "arm.link_inertia=0.0125"));
    assert_false(pressed_arm_model_of(&p, &m));
}

// The impact leaves one velocity x' = ((M11 - M12) w2 + (M12 - M22) w3)/M, which keeps
// the momentum along x (w2 and w3 are the links' velocities before, M is the inertia
// along x).
TEST(an_impact_throws_both_links_onto_one_motion)
{
    parameters p = fixture_parameters(SETTINGS("wall.angle=0"));
    pressed_arm_model m;
    pressed_state after;
    assert_true(pressed_arm_model_of(&p, &m));

    // the mass matrix of the stretched arm: hub of 5.2e-3 kg m^2, links of 0.20054 kg and
    // 0.5 m
    double ml2 = 0.20054 * 0.25, i = p.arm.link_inertia, m11 = 5.2e-3 + i + 1.25 * ml2,
           m12 = 0.5 * ml2, m22 = i + 0.25 * ml2;
    three_body_state before = {{0.001, 0.001, -0.001}, {0.5, 0.5, 0.9}};
    assert_true(pressed_after_impact(&p, &before, &after));
    check_relative(after.velocity, ((m11 - m12) * 0.5 + (m12 - m22) * 0.9) / m.inertia,
                   1e-4);
    check_close(after.x, 0.001, 1e-15);

    // velocities whose momentum is beyond the largest number are refused
    p.arm.mass = 1000;
    before.velocity[1] = before.velocity[2] = 1.5e308;
    assert_false(pressed_after_impact(&p, &before, &after));
}

// With a motor that gives every force only the runaway mode xi counts (see divergence).
// The smallest peak is xi itself. A lower force is reached soonest under the force
// `peak`, from where xi falls to 1.05 of it, a higher one without force, until xi has
// grown to 0.95 of it; both times are the logarithms that solve xi' = s (xi - F).
TEST(a_strong_motor_leaves_the_closed_forms)
{
    pressed_arm_model m = model_of(SETTINGS("motor.voltage_limit=1000"));
    double s = divergence(&m), k = m.spring_force;
    for (EACH_OF(double, c, 0.4, 1.37, 4)) {
        pressed_state at = {0.003, *c};
        double xi = k * (at.x + at.velocity / s);
        check_relative(best_peak(&m, at), xi, 1e-4);

        // a force below the present one, above it, and the present one
        const double peak = 1.4 * xi, low = 0.6 * xi, high = 1.9 * xi;
        check_close(best_settling(&m, at, low, 0.05, peak),
                    log((peak - 1.05 * low) / (peak - xi)) / s, 3e-6);
        check_close(best_settling(&m, at, high, 0.05, 1.05 * high),
                    log(0.95 * high / xi) / s, 3e-6);
        check_close(best_settling(&m, at, xi, 0.05, peak), 0, 0);
    }
}

// The model is linear where friction is small: a touch a thousand times as gentle has a
// force a thousand times as small.
TEST(the_gentlest_touch_has_a_best_force_too)
{
    pressed_arm_model m = model_of(SETTINGS("motor.voltage_limit=1000"));
    for (double velocity = 1e-6; velocity < 10; velocity *= 7) {
        const pressed_state at = {0, velocity};
        check_relative(best_peak(&m, at), m.spring_force * velocity / divergence(&m),
                       1e-4);
    }
}

// A hub with much damping is braked by it from the first moment, and the braked mass
// presses on the wall whatever the motor does: at x = 0 the force is -mass_force x'',
// with x'' from the damping and the motor's largest torque. No peak is below this force
// or below that of the runaway mode; the best one is at most 0.3 N above the larger of
// them.
TEST(no_peak_is_below_the_force_of_the_damping)
{
    pressed_arm_model m = model_of(NULL);
    for (int i = 1; i <= 4; i++) {
        m.damping = 5.0 * i;
        const pressed_state at = {0, 1};
        const double drive = m.torque_limit - m.stiction - m.damping * at.velocity;
        const double least = -m.mass_force * drive / m.inertia;
        const double peak = best_peak(&m, at), runaway = m.spring_force / divergence(&m);
        check_below(fmax(least, runaway) * (1 - 1e-4), peak);
        check_below(peak, 1.0001 * fmax(least, runaway) + 0.3);
    }
}

// A motor holds a force that its largest torque and stiction together carry, and no
// larger one: at rest x = torque/stiffness, and the force is spring_force x. At a force
// that can be held the settling time is zero.
TEST(stiction_helps_to_hold)
{
    pressed_arm_model m = model_of(NULL);
    m.stiction = 0.3 * m.torque_limit;
    const double most = m.spring_force / m.stiffness * (m.torque_limit + m.stiction);

    // 0.75 to 0.93 of the largest force; the torque alone would carry 0.77 of it
    for (int i = 0; i < 4; i++) {
        const double share = 0.75 + 0.06 * i, force = share * most;
        const pressed_state there = {force / m.spring_force, 0};
        check_close(best_settling(&m, there, force, 0.05, 1.06 * force), 0, 1e-3);
    }

    // a hundredth more than that is never held
    const double more = 1.01 * most;
    assert_true(isnan(best_settling(&m, (pressed_state){more / m.spring_force, 0}, more,
                                    0.05, 1.06 * more)));
}

// A lower limit of the current leaves less torque to brake with: the peak is higher, the
// force settles later, and with too little current it does not settle at all. A limit
// that the motor never reaches (10 A) changes nothing.
TEST(a_limited_current_stops_later)
{
    pressed_arm_model any = model_of(NULL),
                      much = model_of(SETTINGS("motor.current_limit=10"));
    pressed_arm_model some = model_of(SETTINGS("motor.current_limit=0.4"));
    pressed_arm_model little = model_of(SETTINGS("motor.current_limit=0.1"));
    const pressed_state at = {0, 1.37};

    // settling: on 1 N within 5 %, below a peak of 9 N
    const double peak = best_peak(&any, at),
                 settling = best_settling(&any, at, 1, 0.05, 9);
    check_close(best_peak(&much, at), peak, 0);
    check_close(best_settling(&much, at, 1, 0.05, 9), settling, 0);
    check_below(peak * 1.01, best_peak(&some, at));
    check_below(best_peak(&some, at), best_peak(&little, at));
    assert_true(best_settling(&some, at, 1, 0.05, 9) >= settling);
    assert_true(isnan(best_settling(&little, at, 1, 0.05, 9)));
}

// There is no best peak, or no best settling time, where the arm leaves the wall or the
// motor cannot do what is wanted: the answer is NaN. Arguments of best_settling: state,
// the wanted force [N], its band (5 %) and the peak that is allowed [N].
TEST(what_cannot_be_is_said)
{
    pressed_arm_model m = model_of(NULL);

    // an arm that moves away from the wall, and one whose bend throws it back
    assert_true(isnan(best_peak(&m, (pressed_state){.x = 0.01, .velocity = -0.1})));
    assert_true(isnan(best_peak(&m, (pressed_state){.x = -0.05, .velocity = 1})));

    // an arm that leaves the wall has no force to settle on
    const pressed_state leaving = {.x = 0, .velocity = -1};
    assert_true(isnan(best_settling(&m, leaving, 1, 0.05, 2)));

    // 6 N are more than the motor holds: torque_limit 4.377 N m gives 4.377 N
    const pressed_state arriving = {.x = 0, .velocity = 1};
    assert_true(isnan(best_settling(&m, arriving, 6, 0.05, 9)));

    // 0.58 N are needed to stop the arm: with a peak of 0.5 N it cannot be stopped
    assert_true(isnan(best_settling(&m, arriving, 0.4, 0.05, 0.5)));

    // the band of a force of zero has no width
    assert_true(isnan(best_settling(&m, arriving, 0, 0.05, 0.5)));

    // a motor with less voltage stops the arm with a higher peak
    pressed_arm_model weak = model_of(SETTINGS("motor.voltage_limit=1.5"));
    check_below(1.02 * best_peak(&m, (pressed_state){0, 1.37}),
                best_peak(&weak, (pressed_state){0, 1.37}));
}

// --- controllers tried at random -------------------------------------------------------

// A second solution of the equation of motion, independent of the one tested: the
// controller applies up to PIECES forces of 4 ms each, and the motion is integrated by
// the midpoint rule. After the last piece the controller holds the force of the runaway
// mode, which then stays as it is, as far as the band allows.
enum { PIECES = 18 };
#define PIECE     4e-3 // [s]
#define FINE_STEP 5e-5 // [s]

// Force at the wall [N] under a motor torque; *rate is the acceleration x'' under it.
static double force_of(const pressed_arm_model *m, pressed_state s, double torque,
                       double *rate)
{
    double friction = s.velocity > 0 ? m->stiction : s.velocity < 0 ? -m->stiction : 0;
    *rate =
        (torque - m->damping * s.velocity - friction - m->stiffness * s.x) / m->inertia;
    return m->spring_force * s.x - m->mass_force * *rate;
}

// Torque under which the force is `wanted`, as far as the motor gives it.
static double torque_for(const pressed_arm_model *m, pressed_state s, double wanted)
{
    double none, at_zero = force_of(m, s, 0, &none);
    double torque = (at_zero - wanted) * m->inertia / m->mass_force;
    return fmax(-m->torque_limit, fmin(torque, m->torque_limit));
}

// What a controller is tried for: to settle on a force below a peak [N], and what has
// been reached so far, by which a try that changes nothing is given up early.
typedef struct stop_game {
    double force, peak;
    double large;   // a force that every try must reach [N]
    double soonest; // of the tries before [s]
} stop_game;

// Tries a controller that applies each of `count` forces for the time PIECE, and then
// keeps the force that it has, near the wanted one. Returns the instant from which on the
// force is within 5 % of the wanted one, and sets *largest to the largest force. HUGE_VAL
// if the force does not settle, leaves the wall or exceeds the peak; also as soon as it
// is clear that the try changes nothing: it settles later than one before, and its force
// has been large enough.
static double try_out(const pressed_arm_model *m, pressed_state s, const double *pieces,
                      int count, const stop_game *game, double *largest)
{
    double settled = HUGE_VAL, xi_factor = m->spring_force / divergence(m);
    *largest = 0;
    for (int i = 0; i * FINE_STEP < count * PIECE + 0.25; i++) {
        // the torque for the piece's force, or after the pieces for the force that is
        // kept
        int piece = (int)(i * FINE_STEP / PIECE);
        double keep = m->spring_force * s.x + xi_factor * s.velocity;
        keep = fmax(0.95 * game->force, fmin(keep, 1.05 * game->force));
        double torque = torque_for(m, s, piece < count ? pieces[piece] : keep), rate,
               half_rate;
        double f = force_of(m, s, torque, &rate);
        pressed_state half = {s.x + FINE_STEP / 2 * s.velocity,
                              s.velocity + FINE_STEP / 2 * rate};
        force_of(m, half, torque, &half_rate);
        if (f < -1e-9 || f > game->peak * 1.0001) {
            return HUGE_VAL;
        }

        // given up where it settles no sooner than a try before
        *largest = fmax(*largest, f);
        bool inside = fabs(f - game->force) <= 0.0502 * game->force;
        settled = !inside ? HUGE_VAL : fmin(settled, i * FINE_STEP);
        if (fmin(settled, i * FINE_STEP) >= game->soonest && *largest >= game->large) {
            return HUGE_VAL;
        }
        s.x += FINE_STEP * half.velocity;
        s.velocity += FINE_STEP * half_rate;
    }
    return settled;
}

// A controller to be tried: forces [N] that change once between nothing and the peak for
// the most part, with a few in between. Returns how many.
static int draw_controller(random_generator *g, double peak, double pieces[PIECES])
{
    const int count = 1 + (int)(random_uniform(g) * PIECES),
              turn = (int)fmin(random_uniform(g) * 2 * (count + 1), count);
    const double first = random_uniform(g) < 0.5 ? 0 : peak;
    for (int k = 0; k < count; k++) {
        if (random_uniform(g) < 0.05) {
            pieces[k] = random_uniform(g) * peak;
        } else if (k < turn) {
            pieces[k] = first;
        } else {
            pieces[k] = peak - first;
        }
    }
    return count;
}

// Of thousands of controllers none settles earlier than the best stop, or reaches a
// smaller peak; and some come near it.
TEST(no_controller_tried_is_better)
{
    // velocity after the impact, wanted force, allowed peak [N], limit of the voltage [V]
    const struct {
        double velocity, force, peak, limit;
    } cases[] = {{1.37, 0.5, 1, 10}, {1.37, 0.5, 1.6, 10}, {1.37, 1, 1.05, 10},
                 {1.37, 2, 2.1, 10}, {1.37, 3, 3.15, 10},  {1.37, 4, 4.2, 10},
                 {3, 1, 3, 10},      {3, 2, 2.6, 6},       {1.37, 1.5, 1.6, 4},
                 {0.8, 2, 2.1, 5},   {4, 1, 3.5, 5},       {3, 1.9, 2.2, 8}};
    random_generator g = seeded(7);
    for (EACH(c, cases)) {
        pressed_arm_model m =
            model_of(SETTINGS(formatted("motor.voltage_limit=%g", c->limit)));
        pressed_state start = {0.002, c->velocity};
        double best = best_settling(&m, start, c->force, 0.05, c->peak);
        double least = best_peak(&m, start);
        assert_true(isfinite(best) && isfinite(least));
        stop_game game = {.force = c->force,
                          .peak = c->peak,
                          .large = 0.999 * least,
                          .soonest = HUGE_VAL};
        for (int n = 0; n < 4000; n++) {
            double pieces[PIECES], largest;
            int count = draw_controller(&g, c->peak, pieces);
            double settled = try_out(&m, start, pieces, count, &game, &largest);
            game.soonest = fmin(game.soonest, settled);
            if (settled < HUGE_VAL) {
                check_below(game.large, largest);
            }
        }

        // no controller settles before the best stop, and the soonest of them is at most
        // two pieces later: the bound is reached
        check_below(best - 2e-4, game.soonest);
        check_below(game.soonest, best + 2 * PIECE);
    }
}
