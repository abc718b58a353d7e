#include "src/solve/modal_shapes.h"

#include <math.h>
#include <string.h>

#include "src/base/sincos.h"

typedef double real;
#include "src/solve/modal_straight.h"

#define PI         3.14159265358979323846
#define EDGE       0.5 // phi N from the ends of its range up to where elimination is the better way
#define SLOWEST    1e-24 // of w^2 over that of phi N = EDGE: slower modes than the rigid ones
#define RESOLUTION 4e-16 // of a root, as a share of it

enum { MOST_HALVINGS = 200, MOST_ROOT_STEPS = 80, SLOWEST_MODES = 4 };

// --- the straight chain ---------------------------------------------------------------------

void modal_mass_times(const arm *a, const double *x, double *y)
{
    straight_mass_times(a, x, y);
}

void modal_stiffness_times(const arm *a, const double *x, double *y)
{
    straight_stiffness_times(a, x, y);
}

// The chain in units of a link's mass and length; stiffnesses and w^2 both over kappa.
typedef struct straight {
    int links;
    bool contact, stuck, spring;
    double reach;                               // of the wall, from the last link's base
    double inertia, hub_inertia, hub_stiffness; // of a link about its centre, of the hub
    double across;                              // c
    double *lever, *pivot;                      // by link, of the elimination last made
    double last;                                // pivot of the first link, of a spring hub
} straight;

// --- elimination ------------------------------------------------------------------------------

// Modes slower than w, w^2 / kappa = y. The links beyond a joint weigh [a b; b d] for what moves
// and turns their base.
static int slower_modes(straight *c, double y)
{
    const int n = c->links;
    double a = 1, b = 0.5, d = c->inertia + 0.25;
    int count = 0;
    for (int k = n - 2; k >= 0; k--) {
        double along, both, turn;
        if (c->contact && k == n - 2) {
            // held: the last link turns as its base moves
            const double r = 1 / c->reach;
            along = a - 2 * b * r + d * r * r - r * r / y;
            both = -r / y;
            turn = -1 / y;
        } else {
            // joint k + 1, then its link's angle
            double pivot = 1 - y * d;
            pivot = pivot == 0 ? 1e-300 : pivot;
            count += pivot < 0;
            c->lever[k + 1] = y * b;
            c->pivot[k + 1] = pivot;
            along = a + y * b * b / pivot;
            both = b / pivot;
            turn = d / pivot;
        }
        a = 1 + along;
        b = 0.5 + along + both;
        d = c->inertia + 0.25 + along + 2 * both + turn;
    }

    // the hub
    if (!c->spring) {
        return count + (!c->stuck && d + c->hub_inertia > 0);
    }
    c->last = 1 - y * d / c->hub_stiffness;
    c->last = c->last == 0 ? 1e-300 : c->last;
    count += c->last < 0;
    return count + (!c->stuck && c->hub_inertia + d / c->last > 0);
}

// Angles by link, and the hub's of a spring hub into *hub, of the mode at which the elimination
// stands.
static void eliminated_shape(const straight *c, double *angle, double *hub)
{
    const int n = c->links;
    double base = 0; // place of the next link's base
    int k = 0;
    *hub = 0;
    if (!c->spring && c->stuck) {
        angle[k++] = 0;
    }
    angle[k] = 1;
    if (c->spring && !c->stuck) {
        angle[k] = fabs(c->last) > 1 ? 1 / c->last : 1;
        *hub = fabs(c->last) > 1 ? 1 : c->last;
    }

    for (k++; k < n; k++) {
        base += angle[k - 1];
        const bool held = c->contact && k == n - 1;
        angle[k] = held ? -base / c->reach : (angle[k - 1] + c->lever[k] * base) / c->pivot[k];
    }
}

// --- closed form ------------------------------------------------------------------------------

// What belongs to one phi.
typedef struct wave {
    double phi, s, half_cosine; // of phi / 2
    double y;                   // w^2 / kappa
    double sinh, step, all;     // sinh(psi/2), e^(-psi/2), e^(-psi N)
} wave;

static double power(double x, int n)
{
    double product = 1;
    for (; n > 0; n /= 2) {
        product *= n % 2 ? x : 1;
        x *= x;
    }
    return product;
}

static wave wave_at(const straight *c, double phi)
{
    wave v = {.phi = phi};
    inline_sincos(phi / 2, &v.s, &v.half_cosine);
    const double square = v.s * v.s, rest = 1 - 4 * c->across * square;
    v.y = 16 * square * square / rest;
    v.sinh = v.s / sqrt(rest);
    v.step = 1 / (sqrt(1 + v.sinh * v.sinh) + v.sinh);
    v.all = power(v.step, 2 * c->links);
    return v;
}

// Amplitudes: u = cosine cos(phi j) + sine sin(phi j) + near e^(-psi j) + far e^(-psi i).
typedef struct amplitudes {
    double cosine, sine, near, far;
} amplitudes;

// The same for a tip that a wall holds `lever` links beyond it with a force f: u_0 + lever (u_0 -
// u_1) = 0, and what the recurrence, gone on with beyond the tip, has too much there is
// kappa (d2 u)_0 = lever f, of which the tip's own equation has the rest.
static void at_held_tip(const straight *c, const wave *v, amplitudes out[2])
{
    const double lever = c->reach - 1, square = v->s * v->s, grown = v->sinh * v->sinh;
    const double sine = 2 * v->s * v->half_cosine;
    const double both = 2 * v->sinh * sqrt(1 + grown), step = v->step * v->step;

    // of cosine, sine, near and far: what they leave of the two equations
    const amplitudes moment = {-square, lever * grown * sine, grown + lever * square * both,
                               v->all * (grown - lever * square * both)};
    const amplitudes place = {1 + 2 * lever * square, -lever * sine, 1 + lever * (1 - step),
                              v->all * (1 + lever * (1 - 1 / step))};

    // the first without far, the second without sine
    const double size = moment.near * place.cosine - moment.cosine * place.near;
    out[0] = (amplitudes){(moment.sine * place.near - moment.near * place.sine) / size, 1,
                          (moment.cosine * place.sine - moment.sine * place.cosine) / size, 0};
    out[1] = (amplitudes){(moment.far * place.near - moment.near * place.far) / size, 0,
                          (moment.cosine * place.far - moment.far * place.cosine) / size, 1};
}

// The two motions that the tip allows, the first decaying from there, the second from the hub.
static void at_tip(const straight *c, const wave *v, amplitudes out[2])
{
    if (c->contact) {
        at_held_tip(c, v, out);
        return;
    }

    // no moment and no force
    const double square = v->s * v->s, cosine = 1 / (1 - 4 * c->across * square);
    const double sine = sqrt(1 + 4 * c->inertia * square); // over cos(phi/2)
    out[0] = (amplitudes){cosine * v->half_cosine, -sine, v->half_cosine, 0};
    out[1] = (amplitudes){cosine * v->all * v->half_cosine, sine * v->all, 0, v->half_cosine};
}

// Place of the hub's axis, which rests, and what its moment has too much, of one such motion.
typedef struct residue {
    double place, moment;
} residue;

static residue at_hub(const straight *c, const wave *v, const amplitudes *u)
{
    double s, co, half_s, half_c;
    inline_sincos(v->phi * c->links, &s, &co);
    inline_sincos(v->phi * (c->links - 0.5), &half_s, &half_c);
    const double trig = u->cosine * co + u->sine * s, decay = u->near * v->all + u->far;
    const double turned = 2 * v->s * (u->cosine * half_s - u->sine * half_c);
    const double grown = 2 * v->sinh * (u->near * v->all / v->step - u->far * v->step);
    const double moment = 4 * (v->sinh * v->sinh * decay - v->s * v->s * trig);
    const double angle = turned + grown;

    // M alpha = angle beta
    double alpha = 1, beta;
    if (!c->spring) {
        alpha = c->stuck ? 0 : 1;
        beta = c->stuck ? 1 : -v->y * c->hub_inertia;
    } else if (c->stuck) {
        beta = c->hub_stiffness;
    } else {
        alpha = v->y * c->hub_inertia - c->hub_stiffness;
        beta = v->y * c->hub_inertia * c->hub_stiffness;
    }
    const double size = 1 / (fabs(alpha) + fabs(beta));
    return (residue){trig + decay, (alpha * moment - beta * angle) * size};
}

static double determinant(const straight *c, double phi)
{
    const wave v = wave_at(c, phi);
    amplitudes two[2];
    at_tip(c, &v, two);
    const residue one = at_hub(c, &v, &two[0]), other = at_hub(c, &v, &two[1]);
    return one.place * other.moment - other.place * one.moment;
}

// Angles of the mode at phi, by link, and of a spring hub.
static void closed_shape(const straight *c, double phi, double *angle, double *hub)
{
    const int n = c->links;
    const wave v = wave_at(c, phi);
    amplitudes two[2];
    at_tip(c, &v, two);
    const residue one = at_hub(c, &v, &two[0]), other = at_hub(c, &v, &two[1]);

    // both together, by the equation that says more
    const bool place = fabs(one.place) + fabs(other.place) > fabs(one.moment) + fabs(other.moment);
    const double p = place ? other.place : other.moment, q = place ? -one.place : -one.moment;
    const amplitudes u = {p * two[0].cosine + q * two[1].cosine, p * two[0].sine + q * two[1].sine,
                          p * two[0].near + q * two[1].near, p * two[0].far + q * two[1].far};

    // differences of u from link to link
    const double decay = v.step * v.step;
    double far = -2 * v.sinh * v.step * u.far, near = 2 * v.sinh * v.step * u.near;
    for (int k = 0; k < n; k++) {
        double s, co;
        inline_sincos(phi * (n - k - 0.5), &s, &co);
        angle[k] = 2 * v.s * (u.cosine * s - u.sine * co) + far;
        far *= decay;
    }
    for (int k = n - 1; k >= 0; k--) {
        angle[k] += near;
        near *= decay;
    }

    // the hub, from the moment of its spring or from that spring's bend
    *hub = 0;
    if (c->spring && !c->stuck) {
        double s, co;
        inline_sincos(phi * n, &s, &co);
        const double trig = u.cosine * co + u.sine * s, ends = u.near * v.all + u.far;
        const double moment = 4 * (v.sinh * v.sinh * ends - v.s * v.s * trig);
        const double weight = v.y * c->hub_inertia;
        *hub = weight > c->hub_stiffness ? -moment / weight : angle[0] - moment / c->hub_stiffness;
    }
}

// --- one mode after the other -----------------------------------------------------------------

// y, or phi with `by_wave`, of mode `number` within (low, high), by counting.
static double counted(straight *c, int number, double low, double high, bool by_wave)
{
    for (int i = 0; i < MOST_HALVINGS && high - low > RESOLUTION * high; i++) {
        const double middle = by_wave || low > 0.25 * high ? (low + high) / 2 : sqrt(low * high);
        if (slower_modes(c, by_wave ? wave_at(c, middle).y : middle) > number) {
            high = middle;
        } else {
            low = middle;
        }
    }
    return (low + high) / 2;
}

// phi of the one mode within [low, high]; the same by counting where the determinant does not
// change its sign.
static double root(straight *c, int number, double low, double high)
{
    double at_low = determinant(c, low), at_high = determinant(c, high);
    if ((at_low < 0) == (at_high < 0)) {
        return counted(c, number, low, high, true);
    }

    // false position; an end that stays counts for half (Illinois)
    int stayed = 0;
    for (int i = 0; i < MOST_ROOT_STEPS && high - low > RESOLUTION * high; i++) {
        double next = high - at_high * (high - low) / (at_high - at_low);
        next = next > low && next < high && i % 8 != 7 ? next : (low + high) / 2;
        const double value = determinant(c, next);
        if (value == 0 || next == low || next == high) {
            return next;
        }
        if ((value < 0) == (at_high < 0)) {
            high = next;
            at_high = value;
            at_low *= stayed > 0 ? 0.5 : 1;
            stayed = 1;
        } else {
            low = next;
            at_low = value;
            at_high *= stayed < 0 ? 0.5 : 1;
            stayed = -1;
        }
    }
    return (low + high) / 2;
}

// phi of the modes first..last - 1, all within (low, high), into phi[first..].
static void isolate(straight *c, double low, int first, double high, int last, double *phi)
{
    if (last - first <= 1) {
        if (last > first) {
            phi[first] = root(c, first, low, high);
        }
        return;
    }
    const double middle = (low + high) / 2;
    if (!(middle > low && middle < high)) {
        for (int k = first; k < last; k++) {
            phi[k] = middle;
        }
        return;
    }
    int slower = slower_modes(c, wave_at(c, middle).y);
    slower = slower < first ? first : slower > last ? last : slower;
    isolate(c, low, first, middle, slower, phi);
    isolate(c, middle, slower, high, last, phi);
}

// The last link turns as all others have moved its base: held to the last bit.
static void keep_tip(int links, double reach, double *angle)
{
    double base = 0;
    for (int i = 0; i < links - 1; i++) {
        base += angle[i];
    }
    angle[links - 1] = -base / reach;
}

// Scales a mode to unit length in M0 and, in rounding, takes the slowest modes out of it: `slowest`
// [SLOWEST_MODES][dof] holds M0 times those that come before.
static bool scale_shape(const arm *a, int number, double *shapes, double *slowest)
{
    const size_t n = (size_t)a->dof;
    double *row = shapes + (size_t)number * n;
    for (int j = 0; j < number && j < SLOWEST_MODES; j++) {
        const double *mode = shapes + (size_t)j * n, *product = slowest + (size_t)j * n;
        double shared = 0;
        for (size_t i = 0; i < n; i++) {
            shared += row[i] * product[i];
        }
        for (size_t i = 0; i < n; i++) {
            row[i] -= shared * mode[i];
        }
    }

    double *product = slowest + (size_t)(number < SLOWEST_MODES ? number : SLOWEST_MODES) * n;
    double square = 0;
    modal_mass_times(a, row, product);
    for (size_t i = 0; i < n; i++) {
        square += row[i] * product[i];
    }
    const double scale = 1 / sqrt(square);
    for (size_t i = 0; i < n; i++) {
        row[i] *= scale;
        product[i] *= scale;
    }
    return isfinite(scale);
}

int modal_shapes(const arm *a, modal_ends ends, double *rate, double *shapes, double *scratch)
{
    const bool contact = ends.contact, stuck = ends.stuck;
    const int N = a->links;
    const double unit = a->link_mass * a->link_length * a->link_length;
    straight c = {.links = N,
                  .contact = contact,
                  .stuck = stuck,
                  .spring = a->hub_spring,
                  .reach = 1 + ends.lever,
                  .inertia = a->link_inertia / unit,
                  .hub_inertia = a->hub_inertia / unit,
                  .hub_stiffness = a->hub_stiffness / a->joint_stiffness,
                  .lever = scratch,
                  .pivot = scratch + a->dof};
    c.across = 0.25 - c.inertia;
    const int modes = a->dof - stuck - contact;

    // hardly bent ones, those of the closed form, those that the hub confines
    const double low = EDGE / N, high = PI - EDGE / N;
    const double slow = wave_at(&c, low).y, fast = wave_at(&c, high).y;
    const int rigid = !contact && !stuck, first = slower_modes(&c, slow);
    const int last = slower_modes(&c, fast);
    double most = 4 * fast;
    while (most < 1e300 && slower_modes(&c, most) < modes) {
        most *= 4;
    }
    if (slower_modes(&c, SLOWEST * slow) != rigid || slower_modes(&c, most) != modes) {
        return -1;
    }
    isolate(&c, low, first, high, last, rate);

    for (int k = 0; k < modes; k++) {
        double *row = shapes + (size_t)k * (size_t)a->dof, *angle = row + a->first, hub = 1;
        double y = 0;
        if (k < rigid) {
            for (int i = 0; i < N; i++) {
                angle[i] = 1;
            }
        } else if (k >= first && k < last) {
            y = wave_at(&c, rate[k]).y;
            closed_shape(&c, rate[k], angle, &hub);
        } else {
            y = k < first ? counted(&c, k, SLOWEST * slow, slow, false)
                          : counted(&c, k, fast, most, false);
            (void)slower_modes(&c, y);
            eliminated_shape(&c, angle, &hub);
        }
        rate[k] = sqrt(y * a->joint_stiffness / unit);
        row[0] = stuck ? 0 : a->first > 0 ? hub : row[0];
        if (contact) {
            keep_tip(N, c.reach, angle);
        }
        if (!scale_shape(a, k, shapes, scratch + 2 * a->dof)) {
            return -1;
        }
    }
    return modes;
}

void modal_tip_shift(const arm *a, modal_ends ends, double *angles)
{
    // turned as a whole, or bent by a force that has so many links beyond a joint for its lever
    angles[0] = ends.stuck ? 0 : 1;
    for (int k = 1; k < a->dof; k++) {
        const double s = k == a->first ? a->hub_stiffness : a->joint_stiffness;
        angles[k] = angles[k - 1] + (ends.stuck ? (a->dof - k + ends.lever) / s : 0);
    }
}
