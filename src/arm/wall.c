#include "src/arm/wall.h"
#include "src/base/sincos.h"
#include "src/base/plain_math.h"

#include <assert.h>
#include <math.h>

// A face that swings less than this is at rest [m].
#define FACE_AT_REST 1e-15
// One without a mass that is left behind by less [m], or returns within less [s], has not been.
#define LEAST_DEPTH  1e-12
#define LEAST_RETURN 1e-14
// A bounce slower than this counts as no bounce [m/s]: half of it is what the engines take for
// rounding of a rate just after an impact (EDGE_RATE in edge_limits.h).
#define LEAST_REBOUND 2e-9
// Below this square of a phase or decay sine and its kin are their series, to the last bit.
#define SMALL_SQUARE 1e-4

void wall_init(wall_model *w, const parameters *p)
{
    assert(w != NULL && p != NULL);
    *w = (wall_model){.kind = (wall_kind)p->wall.kind,
                      .cosine = inline_cos(p->wall.angle),
                      .sine = inline_sin(p->wall.angle),
                      .restitution = p->wall.restitution,
                      .rest_speed = p->method.rest_speed,
                      .law = (wall_law)p->wall.contact,
                      .stiffness = p->wall.stiffness,
                      .damping = p->wall.damping,
                      .exponent = p->wall.contact == WALL_HUNT_CROSSLEY ? p->wall.exponent : 1,
                      .face_mass = p->wall.mass,
                      .motion = wall_motion_of(&p->wall)};
    w->x = p->arm.length * w->cosine;
    w->y = p->arm.length * w->sine;
}

double wall_restitution(const wall_model *w, double approach_speed)
{
    assert(w != NULL);
    const bool rests = approach_speed < w->rest_speed;
    return rests || w->restitution * approach_speed < LEAST_REBOUND ? 0 : w->restitution;
}

double wall_force_slope(const wall_model *w, double depth, double rate, double acceleration)
{
    assert(w != NULL);
    if (w->law == WALL_KELVIN_VOIGT) {
        return w->stiffness * rate + w->damping * acceleration;
    }
    if (depth <= 0) {
        return 0;
    }
    double power = wall_power(w, depth);
    return power * (w->exponent / depth * rate * (w->stiffness + w->damping * rate) +
                    w->damping * acceleration);
}

double wall_stored_energy(const wall_model *w, double depth)
{
    assert(w != NULL);
    return depth > 0 ? wall_spring_force(w, depth) * depth / (w->exponent + 1) : 0;
}

double wall_rate(const wall_model *w, double compliance, double depth, double rate)
{
    assert(w != NULL && compliance > 0);
    // without its damper the wall stops the mass at the deepest point, and so does a damper that
    // grows with the depth without the wall's spring
    const double n = w->exponent, inward = fmax(rate, 0);
    const double energy = 0.5 * inward * inward / compliance + wall_stored_energy(w, depth);
    double deepest = plain_pow((n + 1) * energy / w->stiffness, 1 / (n + 1));
    if (w->law == WALL_HUNT_CROSSLEY && w->damping > 0) {
        const double way = inward * (n + 1) / (w->damping * compliance);
        const double held = plain_pow(plain_pow(fmax(depth, 0), n + 1) + way, 1 / (n + 1));
        deepest = fmin(deepest, held);
    }
    double stiffness = n == 1 ? w->stiffness : n * w->stiffness * plain_pow(deepest, n - 1);
    double damping = w->law == WALL_KELVIN_VOIGT ? w->damping : w->damping * plain_pow(deepest, n);
    return fmax(sqrt(stiffness * compliance), damping * compliance);
}

// --- a face left alone --------------------------------------------------------------------------

// How long a face without a mass takes from a depth [m] to its place at rest [s], by a factor of e
// nearer to it for Kelvin-Voigt's wall.
static double return_time(const wall_model *w, double depth)
{
    const double time = w->damping / w->stiffness;
    return w->law == WALL_KELVIN_VOIGT ? time : time * depth;
}

// Such a face on its way back, or at rest where it is next to its place.
static wall_face returning(const wall_model *w, double depth, double least)
{
    return depth > least ? (wall_face){depth, -depth / return_time(w, depth)} : (wall_face){0};
}

wall_face wall_face_left_behind(const wall_model *w, double depth)
{
    assert(w != NULL && !wall_has_face(w));
    return returning(w, return_time(w, depth) > LEAST_RETURN ? depth : 0, LEAST_DEPTH);
}

double wall_face_acceleration(const wall_model *w, wall_face face)
{
    assert(w != NULL);
    return wall_has_face(w)
               ? -(w->stiffness * face.position + w->damping * face.velocity) / w->face_mass
               : -wall_face_rate(w, face) * face.velocity;
}

double wall_face_energy(const wall_model *w, wall_face face)
{
    assert(w != NULL);
    return 0.5 * w->face_mass * face.velocity * face.velocity +
           wall_stored_energy(w, fabs(face.position));
}

// Without a mass as wall.h has it. x'' + 2 d x' + w0^2 x = 0 has x(h) = x0 C + (x0' + d x0) S and
// x'(h) = x0' C - (d x0' + w0^2 x0) S with C = e^-dh cos(sh), S = e^-dh sin(sh)/s, s^2 = w0^2 -
// d^2; hyperbolic where that is negative.
wall_face wall_face_after(const wall_model *w, wall_face face, double h)
{
    assert(w != NULL && h >= 0);
    if (!wall_has_face(w)) {
        const double passed = face.position > 0 ? h / return_time(w, face.position) : 0;
        const double left = w->law == WALL_KELVIN_VOIGT ? plain_exp(-passed) : 1 - passed;
        return returning(w, face.position * left, FACE_AT_REST);
    }
    const double square = w->stiffness / w->face_mass, d = w->damping / (2 * w->face_mass);
    const double turn = square - d * d, s = sqrt(fabs(turn)), phase = turn * h * h;
    double c, sine;

    // cosine and sine over s with their decay; hyperbolic ones by the slower of their two decays
    if (fabs(phase) < SMALL_SQUARE) {
        const double decay = plain_exp(-d * h);
        c = decay * (1 - phase / 2 * (1 - phase / 12 * (1 - phase / 30)));
        sine = decay * h * (1 - phase / 6 * (1 - phase / 20 * (1 - phase / 42)));
    } else if (turn > 0) {
        const double decay = plain_exp(-d * h);
        inline_sincos(s * h, &sine, &c);
        c *= decay;
        sine *= decay / s;
    } else {
        const double slow = plain_exp(-square / (d + s) * h), fast = plain_exp(-(d + s) * h);
        c = (slow + fast) / 2;
        sine = (slow - fast) / (2 * s);
    }

    // what is left when it has died away is rounding
    wall_face after = {face.position * c + (face.velocity + d * face.position) * sine,
                       face.velocity * c - (d * face.velocity + square * face.position) * sine};
    const double least = 0.5 * w->stiffness * FACE_AT_REST * FACE_AT_REST;
    return wall_face_energy(w, after) > least ? after : (wall_face){0};
}

double wall_face_rate(const wall_model *w, wall_face face)
{
    assert(w != NULL);
    if (face.position == 0 && face.velocity == 0) {
        return 0;
    }
    if (!wall_has_face(w)) {
        return w->law == WALL_KELVIN_VOIGT ? w->stiffness / w->damping : 0;
    }
    const double square = w->stiffness / w->face_mass, d = w->damping / (2 * w->face_mass);
    if (d * d <= square) {
        return sqrt(square);
    }

    // creeping back at the slow decay, once what belongs to the fast one has died away
    const double root = sqrt(d * d - square), fast = d + root, slow = square / fast;
    const double share = fabs(face.velocity + slow * face.position);
    return share > FACE_AT_REST * 2 * root ? fast : slow;
}

double wall_face_lasts(const wall_model *w, wall_face face)
{
    assert(w != NULL);
    return w->law == WALL_HUNT_CROSSLEY && face.position > 0 ? return_time(w, face.position)
                                                             : HUGE_VAL;
}
