// The wall: where it stands, how the arm's last link meets it, and what it answers.
//
// Geometry. g is the penetration: negative in free flight, zero in contact, gap = -g.
// With the last link's base at (x, y), its direction r = (c, s), across it t = (-s, c),
// and d = (a, b) - (x, y):
//
//   point: the link's line runs against the point (a, b),
//          g = -t'd (3.9),   dg/dt = s_c w + t'v (3.12),   s_c = r'd,
//          d2g/dt2 = s_c alpha + t'a - g w^2 - 2 w r'v (3.13)
// Of a wall that moves by u towards the arm x, v and a are those relative to it: with n
// of the wall's direction, x + u n, v + u' n and a + u" n.
//
//   plane: the tip runs against the plane through the hub's axis,
//          g = n'tip,   n = (-sin, cos) of the wall's direction
//
// Both give dg/dt = J w with J_k = l t_k'e for the inner links and J_N = l t'e + lever.
//
// Law. A rigid wall keeps gap >= 0, f >= 0, gap f = 0, and an impact returns the share e
// of the approach speed (wall_restitution). f is then the constraint's, from d2g/dt2 = 0.
// A wall that gives has no constraint and no impact. At the depth x = g > 0 and its rate
// v it answers with
//
//   Kelvin-Voigt:    f = k x + c v
//   Hunt-Crossley:   f = x^n (k + c v)
//
// as long as that pushes. It stores k x^(n+1)/(n+1) (n = 1 for Kelvin-Voigt) and turns
// the rest of f v into heat.
//
// Face. In contact the wall's face is as deep as the arm, x = g. Where the law would
// pull, the arm leaves it behind, and it returns on its own: with f = 0 the law says its
// rate,
//
//   Kelvin-Voigt:    x' = -k x / c,    x = x_0 exp(-k t / c)
//   Hunt-Crossley:   x' = -k / c,      x = max(x_0 - k t / c, 0)
//
// at once without a damper; what the spring holds goes into the damper. The arm is met
// where the face is by then, without an impact, since the face has no mass.
//
// Mass. A Kelvin-Voigt wall's face may have a mass M. Arm and face then meet as two rigid
// bodies: an impact returns the share e of their relative speed, and in contact both move
// as one. With the force f on the face
//
//   M x'' + c x' + k x = f
//
// f is the constraint's once more: were the tip let go, it would move into the wall with
// g'' = a_f, and a force holds it back by C = J M^-1 J^T for each newton, so that
//
//   f = (M a_f + k x + c x') / (1 + M C),
//
// which is the law above for M = 0 and the rigid wall's a_f / C for M without bound.
// Contact ends where f falls to zero; the face then swings on its own, f = 0, until the
// arm meets it again, and for M = 0 that is the return above. On a foundation that moves
// by u (wall_motion.h) a_f is the acceleration in space, and the face swings, even alone,
// by
//
//   M x'' + c x' + k x = f + M u''
//
// where the foundation does the work (k x + c x') u' on it. Spring and motion in space
// have the energy k x^2/2 + M (x' - u')^2/2.
#pragma once

#include <math.h>
#include <stdbool.h>

#include "src/tables/parameters.h"
#include "src/arm/wall_motion.h"
#include "src/base/plain_math.h"

typedef struct wall_model {
    wall_kind kind;
    double cosine, sine; // direction of the wall [-]
    double x, y;         // contact point (a, b) [m]
    double restitution;  // e [-]
    double rest_speed;   // impacts slower than this are plastic [m/s]
    wall_law law;
    double stiffness; // k [N/m^n]
    double damping;   // c [N s/m], Hunt-Crossley [N s/m^(n+1)]
    double exponent;  // n, 1 for Kelvin-Voigt [-]
    double face_mass; // M, 0: the face has none [kg]
    wall_motion motion;
    wall_shift shift; // of a wall that moves, at the instant that the model is for
} wall_model;

// How the wall's face moves, in front of a foundation that may move itself.
typedef struct wall_face {
    double position; // x, into the wall [m]
    double velocity; // [m/s]
} wall_face;

// Where and how the wall acts on the last link.
typedef struct wall_contact {
    double ex, ey; // e, direction of the contact force's reaction [-]
    double lever; // distance of the contact point beyond the last link's end, s_c - l [m]
    double penetration; // g [m]
    double convective;  // d2g/dt2 - J alpha - (base acceleration)'e: the last link's
                        // velocity terms
} wall_contact;

// The wall of resolved parameters; the contact point lies the arm's length from the hub.
void wall_init(wall_model *w, const parameters *p);

// Share of the approach speed [m/s] with which the arm bounces: none below the rest
// speed, so that a sequence of ever smaller bounces ends in contact, nor where it would
// bounce at less than 2e-9 m/s, which the engines could not tell from rest.
double wall_restitution(const wall_model *w, double approach_speed);

// Whether it moves.
static inline bool wall_moves(const wall_model *w)
{
    return w->motion.kind != MOTION_NONE;
}

// The velocity with which a wall that moves comes towards the arm along e, and the
// acceleration [m/s], [m/s2].
static inline double wall_comes(const wall_model *w, double ex, double ey)
{
    return w->shift.velocity * (w->cosine * ey - w->sine * ex);
}
static inline double wall_comes_faster(const wall_model *w, double ex, double ey)
{
    return w->shift.acceleration * (w->cosine * ey - w->sine * ex);
}

// The velocity of a wall that moves along itself, across e [m/s]; none of a plane.
static inline double wall_slides(const wall_model *w, double ex, double ey)
{
    return w->shift.velocity * (w->sine * ey + w->cosine * ex);
}

// Whether there is a wall at all.
static inline bool wall_stands(const wall_model *w)
{
    return w->kind != WALL_NONE;
}

// Whether it gives; else it is rigid.
static inline bool wall_gives(const wall_model *w)
{
    return w->law != WALL_RIGID;
}

// Whether its face has a mass: a wall that gives, but meets the arm with an impact.
static inline bool wall_has_face(const wall_model *w)
{
    return w->face_mass > 0;
}

// depth^n for a depth [m], zero in front of the wall; Hertz's exponent needs no
// logarithm.
static inline double wall_power(const wall_model *w, double depth)
{
    if (depth <= 0) {
        return 0;
    }
    if (w->exponent == 1.0) {
        return depth;
    }
    if (w->exponent == 1.5) {
        return depth * sqrt(depth);
    }
    return plain_pow(depth, w->exponent);
}

// Its derivative by the depth, from the power itself.
static inline double wall_power_slope(const wall_model *w, double depth, double power)
{
    if (depth <= 0) {
        return 0;
    }
    return w->exponent * power / depth;
}

// Force of the wall's spring at a depth [N]; none in front of it.
static inline double wall_spring_force(const wall_model *w, double depth)
{
    return w->stiffness * wall_power(w, depth);
}

// Energy that the wall's spring holds at a depth [J].
double wall_stored_energy(const wall_model *w, double depth);

// How fast the wall and a mass of 1/compliance [kg] behind it can move, until they part,
// from a depth [m] and its rate [m/s] on: frequency or decay [1/s].
double wall_rate(const wall_model *w, double compliance, double depth, double rate);

// A face without a mass that an arm leaves behind at a depth [m]: there, with the rate of
// its return; at rest in place where it returns in less than can be told.
wall_face wall_face_left_behind(const wall_model *w, double depth);

// The wall where it is at an instant [s].
static inline wall_model wall_at(const wall_model *w, double time)
{
    wall_model at = *w;
    at.shift = wall_motion_at(&w->motion, time);
    return at;
}

// Whether its face never rests for long: it has a mass, on a foundation that moves.
static inline bool wall_is_shaken(const wall_model *w)
{
    return wall_has_face(w) && wall_moves(w);
}

// A face on its spring and damper alone, h [s] after the instant of a wall that moves,
// and what that has done on it by then [J].
wall_face wall_face_after(const wall_model *w, wall_face face, double h);
double wall_face_work(const wall_model *w, wall_face face, double h);

// Its acceleration there [m/s2]; the energy of face and spring [J].
double wall_face_acceleration(const wall_model *w, wall_face face);
double wall_face_energy(const wall_model *w, wall_face face);

// How fast the motion of a face left alone changes: frequency or decay [1/s], 0 for one
// at rest or at a constant rate.
double wall_face_rate(const wall_model *w, wall_face face);

// How long the motion of a swinging face stays analytic [s]: on a wall of Hunt and
// Crossley it does so until the face comes to rest.
double wall_face_lasts(const wall_model *w, wall_face face);

// Place of the contact point in a frame with direction (c, s) through the hub's axis:
// along it, and how far it lies to its right [m].
static inline double wall_along(const wall_model *w, double c, double s)
{
    return w->x * c + w->y * s;
}
static inline double wall_right_of(const wall_model *w, double c, double s)
{
    return w->x * s - w->y * c;
}

// Geometry of contact from the last link's length l, its base (x, y) moving at (vx, vy),
// its direction (c, s) and angular velocity omega. For a wall that stands.
static inline __attribute__((always_inline)) wall_contact
wall_contact_at(const wall_model *w, double l, double x, double y, double vx, double vy,
                double c, double s, double omega)
{
    wall_contact at;

    // seen from a wall that moves, the arm is shifted the other way
    x -= w->shift.place * w->sine;
    y += w->shift.place * w->cosine;
    vx -= w->shift.velocity * w->sine;
    vy += w->shift.velocity * w->cosine;

    // a point pushes across the link, a plane across its own surface
    if (w->kind == WALL_POINT) {
        double dx = w->x - x, dy = w->y - y;
        at.ex = -s;
        at.ey = c;
        at.lever = c * dx + s * dy - l;
        at.penetration = s * dx - c * dy;
        at.convective = -at.penetration * omega * omega - 2 * omega * (c * vx + s * vy);
    } else {
        at.ex = -w->sine;
        at.ey = w->cosine;
        at.lever = 0;
        at.penetration = at.ex * (x + l * c) + at.ey * (y + l * s);
        at.convective = -l * omega * omega * (at.ex * c + at.ey * s);
    }
    return at;
}

// J_N, the last link's entry of the Jacobian dg/dq [m].
static inline double wall_last_lever(const wall_contact *at, double l, double c, double s)
{
    return at->lever + l * (c * at->ey - s * at->ex);
}

// dg/dt [m/s] with the last link's base moving at (vx, vy), J_N and the link's angular
// velocity.
static inline double wall_penetration_rate(const wall_contact *at, double vx, double vy,
                                           double last_lever, double omega)
{
    return at->ex * vx + at->ey * vy + last_lever * omega;
}
