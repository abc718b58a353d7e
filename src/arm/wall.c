#include "src/arm/wall.h"
#include "src/base/sincos.h"
#include "src/base/plain_math.h"

#include <assert.h>
#include <math.h>

// A face that swings less than this is at rest [m].
#define FACE_AT_REST 1e-15
// A face without a mass that is left behind by less than this [m], or that returns within
// less than this [s], is at rest at once.
#define LEAST_DEPTH  1e-12
#define LEAST_RETURN 1e-14
// A bounce slower than this counts as no bounce [m/s]: half of it is what the engines
// take for rounding of a rate just after an impact (EDGE_RATE in edge_limits.h).
#define LEAST_REBOUND 2e-9
// Below this square of a phase, circular and hyperbolic sine and cosine are given by the
// first terms of their series, to the last bit.
#define SMALL_SQUARE 1e-4

void wall_init(wall_model *w, const parameters *p)
{
    *w = (wall_model){.kind = (wall_kind)p->wall.kind,
                      .cosine = inline_cos(p->wall.angle),
                      .sine = inline_sin(p->wall.angle),
                      .restitution = p->wall.restitution,
                      .rest_speed = p->method.rest_speed,
                      .law = (wall_law)p->wall.contact,
                      .stiffness = p->wall.stiffness,
                      .damping = p->wall.damping,
                      .exponent =
                          p->wall.contact == WALL_HUNT_CROSSLEY ? p->wall.exponent : 1,
                      .face_mass = p->wall.mass,
                      .motion = wall_motion_of(&p->wall)};
    w->x = p->arm.length * w->cosine;
    w->y = p->arm.length * w->sine;
}

double wall_restitution(const wall_model *w, double approach_speed)
{
    const bool rests = approach_speed < w->rest_speed;
    if (rests || w->restitution * approach_speed < LEAST_REBOUND) {
        return 0;
    }
    return w->restitution;
}

double wall_stored_energy(const wall_model *w, double depth)
{
    if (depth > 0) {
        return wall_spring_force(w, depth) * depth / (w->exponent + 1);
    }
    return 0;
}

double wall_rate(const wall_model *w, double compliance, double depth, double rate)
{
    assert(compliance > 0);

    // The greatest depth, at which the wall is stiffest: at most that at which the spring
    // alone stops the mass 1 / compliance, and that at which the damper alone stops it,
    // if it grows with the depth.
    const double n = w->exponent, inward = fmax(rate, 0);
    const double energy =
        0.5 * inward * inward / compliance + wall_stored_energy(w, depth);
    double deepest = plain_pow((n + 1) * energy / w->stiffness, 1 / (n + 1));
    if (w->law == WALL_HUNT_CROSSLEY && w->damping > 0) {
        const double way = inward * (n + 1) / (w->damping * compliance);
        const double held =
            plain_pow(plain_pow(fmax(depth, 0), n + 1) + way, 1 / (n + 1));
        deepest = fmin(deepest, held);
    }

    // the tangents of spring and damper there, and the faster of their two rates
    double stiffness = w->stiffness, damping = w->damping;
    if (n != 1) {
        stiffness = n * w->stiffness * plain_pow(deepest, n - 1);
    }
    if (w->law != WALL_KELVIN_VOIGT) {
        damping = w->damping * plain_pow(deepest, n);
    }
    return fmax(sqrt(stiffness * compliance), damping * compliance);
}

// --- a face left alone -----------------------------------------------------------------

// How long a face without a mass takes to return from a depth [m] to its place at rest
// [s]; on Kelvin and Voigt's wall, which it approaches exponentially, the time in which
// its distance falls by a factor of e.
static double return_time(const wall_model *w, double depth)
{
    const double time = w->damping / w->stiffness;
    if (w->law == WALL_KELVIN_VOIGT) {
        return time;
    }
    return time * depth;
}

// A face without a mass that returns from a depth [m]; at rest if that is at most
// `least`.
static wall_face returning(const wall_model *w, double depth, double least)
{
    if (depth > least) {
        return (wall_face){depth, -depth / return_time(w, depth)};
    }
    return (wall_face){0};
}

wall_face wall_face_left_behind(const wall_model *w, double depth)
{
    assert(!wall_has_face(w));
    const double left = return_time(w, depth) > LEAST_RETURN ? depth : 0;
    return returning(w, left, LEAST_DEPTH);
}

double wall_face_acceleration(const wall_model *w, wall_face face)
{
    if (wall_has_face(w)) {
        return w->shift.acceleration -
               (w->stiffness * face.position + w->damping * face.velocity) / w->face_mass;
    }
    return -wall_face_rate(w, face) * face.velocity;
}

double wall_face_energy(const wall_model *w, wall_face face)
{
    const double moves = face.velocity - w->shift.velocity;
    return 0.5 * w->face_mass * moves * moves +
           wall_stored_energy(w, fabs(face.position));
}

// --- a face that its foundation shakes -------------------------------------------------

// The number of terms of all series in this section: at a phase of one, what they leave
// out is less than the last bit.
enum { TERMS = 20 };

// Gets the series of the foundation's acceleration from the instant of the wall on. False
// if it does not move.
static bool is_shaken(const wall_model *w, double *series)
{
    return wall_is_shaken(w) &&
           wall_motion_series(&w->motion, w->shift.time, TERMS, series);
}

// The two decays of a face that creeps back without swinging, d -+ sqrt(d^2 - w0^2)
// [1/s].
static void find_decays(const wall_model *w, double *slow, double *fast)
{
    const double square = w->stiffness / w->face_mass,
                 d = w->damping / (2 * w->face_mass);
    *fast = d + sqrt(fmax(d * d - square, 0));
    *slow = square / *fast;
}

// Series of the solution without a transient of y' + fast y = u'', u'' being the
// foundation's acceleration: from the last term down by y = (u'' - y') / fast.
static void quiet_series(const double *shakes, double fast, double *y)
{
    y[TERMS - 1] = shakes[TERMS - 1] / fast;
    for (int n = TERMS - 2; n >= 0; n--) {
        y[n] = (shakes[n] - (n + 1) * y[n + 1]) / fast;
    }
}

// Computes the series x of the face's place by its equation of motion. If the face
// `creeps`, its fast decay is over and much faster than all else: the series then follows
// from x' + slow x = y, with y of quiet_series.
static void face_series(const wall_model *w, const double *shakes, bool creeps,
                        wall_face face, double *x)
{
    const double square = w->stiffness / w->face_mass,
                 damping = w->damping / w->face_mass;
    x[0] = face.position;
    if (creeps) {
        double slow, fast, y[TERMS];
        find_decays(w, &slow, &fast);
        quiet_series(shakes, fast, y);
        for (int n = 0; n < TERMS - 1; n++) {
            x[n + 1] = (y[n] - slow * x[n]) / (n + 1);
        }
        return;
    }
    x[1] = face.velocity;
    for (int n = 0; n < TERMS - 2; n++) {
        const double pulls = damping * (n + 1) * x[n + 1] + square * x[n];
        x[n + 2] = (shakes[n] - pulls) / ((n + 1) * (n + 2));
    }
}

// The value of a series at h, and its slope, by Horner's scheme.
static wall_face sum_up(const double *x, double h)
{
    wall_face at = {x[TERMS - 1], 0};
    for (int n = TERMS - 2; n >= 0; n--) {
        at.velocity = at.velocity * h + at.position;
        at.position = at.position * h + x[n];
    }
    return at;
}

// The work of the foundation on the face from 0 to h: the integral of (k x + c x') u',
// both factors as series in t / h, whose product is integrated term by term.
static double work_by(const wall_model *w, double velocity, const double *shakes,
                      const double *x, double h)
{
    double force[TERMS], moves[TERMS], power = 1, sum = 0;
    for (int n = 0; n < TERMS; n++, power *= h) {
        const double rate = n + 1 < TERMS ? (n + 1) * x[n + 1] : 0;
        force[n] = power * (w->stiffness * x[n] + w->damping * rate);
        if (n == 0) {
            moves[n] = velocity;
        } else {
            moves[n] = power * shakes[n - 1] / n;
        }
    }
    for (int n = 0; n < TERMS; n++) {
        double product = 0;
        for (int i = 0; i <= n; i++) {
            product += force[i] * moves[n - i];
        }
        sum += product / (n + 1);
    }
    return sum * h;
}

// A shaken face a time h later, and in *work the work of its foundation meanwhile. The
// time is divided into pieces over which the series converge; if these were too many, the
// face creeps, and only its slow decay limits them.
static wall_face shake(const wall_model *w, wall_face face, double h, double *work)
{
    enum { MOST_PIECES = 64 };
    const double swings = sqrt(w->stiffness / w->face_mass) + w->damping / w->face_mass;
    const double shakes = wall_motion_rate(&w->motion, w->shift.time);
    const bool creeps = h * (swings + shakes) > MOST_PIECES;
    double slow, fast, series[TERMS], x[TERMS];
    find_decays(w, &slow, &fast);

    // piece after piece
    const double fastest = creeps ? slow : swings;
    const int pieces = 1 + (int)(h * (fastest + shakes));
    *work = 0;
    for (int i = 0; i < pieces; i++) {
        const double piece = h / pieces, from = w->shift.time + i * piece;
        wall_motion_series(&w->motion, from, TERMS, series);
        face_series(w, series, creeps, face, x);
        *work += work_by(w, wall_motion_at(&w->motion, from).velocity, series, x, piece);
        face = sum_up(x, piece);
    }
    return face;
}

double wall_face_work(const wall_model *w, wall_face face, double h)
{
    assert(h >= 0);
    double series[TERMS], work = 0;
    if (is_shaken(w, series)) {
        shake(w, face, h, &work);
    }
    return work;
}

// --- its motion ------------------------------------------------------------------------

// Without a mass as wall.h has it. x'' + 2 d x' + w0^2 x = 0 has x(h) = x0 C + (x0' + d
// x0) S and x'(h) = x0' C - (d x0' + w0^2 x0) S with C = e^-dh cos(sh), S = e^-dh
// sin(sh)/s, s^2 = w0^2 - d^2; hyperbolic where that is negative.
wall_face wall_face_after(const wall_model *w, wall_face face, double h)
{
    assert(h >= 0);

    // a face without a mass: linearly, or exponentially
    if (!wall_has_face(w)) {
        double passed = 0;
        if (face.position > 0) {
            passed = h / return_time(w, face.position);
        }
        double left = 1 - passed;
        if (w->law == WALL_KELVIN_VOIGT) {
            left = plain_exp(-passed);
        }
        return returning(w, face.position * left, FACE_AT_REST);
    }

    // one that is shaken
    double series[TERMS], work;
    if (is_shaken(w, series)) {
        return shake(w, face, h, &work);
    }
    const double square = w->stiffness / w->face_mass,
                 d = w->damping / (2 * w->face_mass);
    const double turn = square - d * d, s = sqrt(fabs(turn)), phase = turn * h * h;
    double c, sine;

    // C and S: by their series, by circular functions, or by two decays
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
        const double slow = plain_exp(-square / (d + s) * h),
                     fast = plain_exp(-(d + s) * h);
        c = (slow + fast) / 2;
        sine = (slow - fast) / (2 * s);
    }

    // a swing that has died away is at rest
    wall_face after = {face.position * c + (face.velocity + d * face.position) * sine,
                       face.velocity * c -
                           (d * face.velocity + square * face.position) * sine};
    const double least = 0.5 * w->stiffness * FACE_AT_REST * FACE_AT_REST;
    if (wall_face_energy(w, after) > least) {
        return after;
    }
    return (wall_face){0};
}

double wall_face_rate(const wall_model *w, wall_face face)
{
    double series[TERMS], quiet[TERMS] = {0};
    const bool shaken = is_shaken(w, series);

    // at rest, or without a mass
    if (face.position == 0 && face.velocity == 0 && !shaken) {
        return 0;
    }
    if (!wall_has_face(w)) {
        if (w->law == WALL_KELVIN_VOIGT) {
            return w->stiffness / w->damping;
        }
        return 0;
    }

    // a face that swings
    const double square = w->stiffness / w->face_mass,
                 d = w->damping / (2 * w->face_mass);
    if (d * d <= square) {
        return sqrt(square);
    }

    // one that creeps back: at the slow decay, once the part of the fast decay is over
    double slow, fast;
    find_decays(w, &slow, &fast);
    if (shaken) {
        quiet_series(series, fast, quiet);
    }
    const double share = fabs(face.velocity + slow * face.position - quiet[0]);
    if (share <= FACE_AT_REST * (fast - slow)) {
        return slow;
    }
    return fast;
}

double wall_face_lasts(const wall_model *w, wall_face face)
{
    if (w->law == WALL_HUNT_CROSSLEY && face.position > 0) {
        return return_time(w, face.position);
    }
    return HUGE_VAL;
}
