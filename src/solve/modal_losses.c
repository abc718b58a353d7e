#include <math.h>

#include "src/base/sincos.h"
#include "src/solve/modal_loops.h"
#include "src/solve/modal_parts.h"

#define ROUNDING   1e-18 // share of a series' largest term
#define NEGLIGIBLE 1e-13 // share of the hub's loss that a transient's products may have

// The hub's velocity until an instant, x being the share of the time: what changes slowly as a
// power series, all else as transients [rad/s].
typedef struct hub_motion {
    double time;                 // [s]
    double power[MODAL_SERIES];  // t^j / j!
    double series[MODAL_SERIES]; // sum series[j] x^j,
    int terms;                   // of which those from here on are rounding
    modal_transients *fast;
} hub_motion;

// --- the hub's motion ---------------------------------------------------------------------------

// Adds C e^(-a t) cos bt + D e^(-a t) sin bt.
static void add_transient(hub_motion *h, double decay, double turn, double cosine, double sine)
{
    modal_transients *v = h->fast;
    const int k = v->count++;
    double s, c;
    v->decay[k] = decay * h->time;
    v->turn[k] = turn * h->time;
    v->cosine[k] = cosine;
    v->sine[k] = sine;
    const double keep = modal_decay(-v->decay[k]);
    inline_sincos(v->turn[k], &s, &c);
    v->end_cosine[k] = keep * c;
    v->end_sine[k] = keep * s;
}

// Adds `weight` times the decay u' + rate u = sum n[j] t^j / j! from u = start.
static void add_decay(hub_motion *h, double rate, double start, const double *n, double weight)
{
    const modal_decay_course u = {rate, h->time, start, n};
    double derivatives[MODAL_SERIES] = {0}, amplitude = 0;
    if (modal_add_decay(&u, weight, &amplitude, derivatives)) {
        add_transient(h, rate, 0, amplitude, 0);
    }
    for (int j = 0; j < MODAL_SERIES; j++) {
        h->series[j] += derivatives[j] * h->power[j];
    }
}

// Adds an overdamped mode: u = x' + fast x and v = x' + slow x decay at slow and fast, and
// x' = (fast v - slow u) / (fast - slow).
static void add_overdamped(hub_motion *h, double hub, double damping, double rate, double speed,
                           const double *n)
{
    const double root = fmax(sqrt((damping - rate) * (damping + rate)), MODAL_NEAR_CRITICAL * rate);
    const double slow = rate * rate / (damping + root), fast = damping + root;
    const double per = hub / (fast - slow);
    add_decay(h, slow, speed, n, -slow * per);
    add_decay(h, fast, speed, n, fast * per);
}

// Adds a mode, by its place in the basis.
static void add_mode(hub_motion *h, const modal_stride *s, int k)
{
    const double hub = s->modes->by_dof[k], damping = s->damping[k], rate = s->modes->rate[k];
    const double speed = s->start[k] + s->drift[0][k];
    const bool slow = rate * h->time <= 1 && (damping < rate || 2 * damping * h->time <= 1);
    double n[MODAL_NODES]; // x'' + 2 damping x' + rate^2 x = sum n[j] t^j / j!
    for (int j = 0; j < MODAL_NODES && (slow || damping >= rate); j++) {
        const double turn = j + 1 < MODAL_NODES ? s->drift[j + 1][k] : 0;
        n[j] = s->force[j][k] + 2 * damping * s->drift[j][k] + turn;
    }

    // one that turns and decays little, as a series from x = 0
    if (slow) {
        double place = 0, now = speed;
        for (int j = 0; j < MODAL_SERIES; j++) {
            h->series[j] += hub * now * h->power[j];
            const double next =
                (j < MODAL_NODES ? n[j] : 0) - 2 * damping * now - rate * rate * place;
            place = now;
            now = next;
        }
        return;
    }
    if (damping >= rate) {
        add_overdamped(h, hub, damping, rate, speed, n);
        return;
    }

    // what it follows without vibrating, and the vibration that this starts from
    for (int j = 0; j + 1 < MODAL_NODES; j++) {
        h->series[j] += hub * s->followed[j + 1][k] * h->power[j];
    }
    const double turn = fmax(sqrt((rate - damping) * (rate + damping)), MODAL_NEAR_CRITICAL * rate);
    const double x = -s->followed[0][k], v = speed - s->followed[1][k];
    const double sine = (v + damping * x) / turn;
    add_transient(h, damping, turn, hub * v, -hub * (damping * sine + turn * x));
}

// --- integrals over x from 0 to 1 ---------------------------------------------------------------

// The square of the series.
static double series_square(const hub_motion *h)
{
    double sum = 0;
    for (int i = 0; i < h->terms; i++) {
        for (int j = 0; j < h->terms; j++) {
            sum += h->series[i] * h->series[j] / (i + j + 1);
        }
    }
    return sum;
}

// The products of the series and all transients.
static double series_transients(const hub_motion *h)
{
    double start[MODAL_SERIES], end[MODAL_SERIES] = {0}; // derivatives by x at 0 and 1
    double factorial = 1;
    for (int j = 0; j < h->terms; j++) {
        factorial *= j > 0 ? j : 1;
        start[j] = factorial * h->series[j];
        double falling = factorial; // i! / (i - j)!
        for (int i = j; i < h->terms; i++) {
            falling *= i > j ? (double)i / (i - j) : 1;
            end[j] += falling * h->series[i];
        }
    }
    return modal_loops_here()->series(h->fast, start, end, h->terms);
}

// The square of a transient.
static double transient_square(const modal_transients *v, int k)
{
    const double a = v->decay[k], b = v->turn[k], c = v->cosine[k], d = v->sine[k];
    const double keep = v->end_cosine[k] * v->end_cosine[k] + v->end_sine[k] * v->end_sine[k];
    const double mean = a > 1e-3 ? (1 - keep) / (2 * a) : 1 - a * (1 - a * (2.0 / 3) * (1 - a / 2));

    // twice its phase, at the end less at the start
    const double cosine = v->end_cosine[k] * v->end_cosine[k] - v->end_sine[k] * v->end_sine[k] - 1;
    const double sine = 2 * v->end_cosine[k] * v->end_sine[k];
    const double per = 1 / (2 * (a * a + b * b));
    const double f = (b * sine - a * cosine) * per, g = -(a * sine + b * cosine) * per;
    return 0.5 * ((c * c + d * d) * mean + (c * c - d * d) * f + 2 * c * d * g);
}

// Takes the first `count` transients for all there are, behind which stand some that do nothing.
static void put_end(modal_transients *v, int count)
{
    v->count = count;
    for (int k = count; k < count + MODAL_LANES; k++) {
        v->decay[k] = 1;
        v->turn[k] = v->cosine[k] = v->sine[k] = v->end_cosine[k] = v->end_sine[k] = 0;
    }
}

// Leaves only those transients whose products with others matter beside `square`.
static void leave_large(modal_transients *v, double square)
{
    double all = 0;
    for (int k = 0; k < v->count; k++) {
        all += fabs(v->cosine[k]) + fabs(v->sine[k]);
    }
    int kept = 0;
    for (int k = 0; k < v->count; k++) {
        if ((fabs(v->cosine[k]) + fabs(v->sine[k])) * all > NEGLIGIBLE * square) {
            v->decay[kept] = v->decay[k];
            v->turn[kept] = v->turn[k];
            v->cosine[kept] = v->cosine[k];
            v->sine[kept] = v->sine[k];
            v->end_cosine[kept] = v->end_cosine[k];
            v->end_sine[kept++] = v->end_sine[k];
        }
    }
    put_end(v, kept);
}

// What the hub's viscous damping takes until t: the integral of the velocity's square, all products
// in closed form.
static double hub_loss(modal_stride *s, const arm *a, double t)
{
    const int e = s->modes->across;
    hub_motion h = {.time = t, .power = {1}, .fast = &s->transients};
    h.fast->count = 0;
    for (int j = 1; j < MODAL_SERIES; j++) {
        h.power[j] = h.power[j - 1] * t / j;
    }
    for (int k = 0; k < s->count; k++) {
        if (k != e) {
            add_mode(&h, s, k);
        }
    }
    for (int j = 0; e >= 0 && j < MODAL_NODES; j++) {
        h.series[j] += s->modes->by_dof[e] * s->drift[j][e] * h.power[j];
    }

    double most = 0;
    for (int j = 0; j < MODAL_SERIES; j++) {
        most = fmax(most, fabs(h.series[j]));
        h.terms = fabs(h.series[j]) > ROUNDING * most ? j + 1 : h.terms;
    }

    // the products
    put_end(h.fast, h.fast->count);
    const double mixed = series_transients(&h);
    double square = series_square(&h);
    for (int k = 0; k < h.fast->count; k++) {
        square += transient_square(h.fast, k);
    }
    leave_large(h.fast, square);
    return a->motor.damping * t * (square + 2 * (mixed + modal_loops_here()->overlap(h.fast)));
}

// --- all losses ---------------------------------------------------------------------------------

// Weights of the products of two polynomials' coefficients in an integral until t.
static void set_weights(modal_weights weights, double t)
{
    static const double factorial[MODAL_NODES] = {1, 1, 2, 6, 24, 120};
    double power = t;
    for (int sum = 0; sum < 2 * MODAL_NODES - 1; sum++) {
        for (int i = 0; i < MODAL_NODES; i++) {
            const int j = sum - i;
            if (j >= 0 && j < MODAL_NODES) {
                weights[i][j] = power / ((sum + 1) * factorial[i] * factorial[j]);
            }
        }
        power *= t;
    }
}

// Integral of the square of a polynomial sum p[j] t^j / j!.
static double square_integral(const double *p, modal_weights weights)
{
    double sum = 0;
    for (int i = 0; i < MODAL_NODES; i++) {
        for (int j = 0; j < MODAL_NODES; j++) {
            sum += p[i] * p[j] * weights[i][j];
        }
    }
    return sum;
}

modal_losses modal_stride_losses(modal_stride *s, const arm *a, double t)
{
    const int e = s->modes->across;
    modal_losses lost = {0};

    // in the springs, mode by mode
    modal_mode_losses losses = {.time = t, .all = s->more_columns};
    set_weights(losses.weights, t);
    modal_loops_here()->losses(s, &losses);
    for (int k = 0; k < s->count; k++) {
        const double rate = s->modes->rate[k], twice = 2 * s->damping[k];
        if (k != e && twice != 0) {
            lost.damping += losses.all[k] * s->per_stiffness * rate * rate / twice;
        }
    }

    // that of the vector across the constraint, and at the hub
    if (e >= 0) {
        double across[MODAL_NODES];
        for (int j = 0; j < MODAL_NODES; j++) {
            across[j] = s->drift[j][e];
        }
        lost.damping +=
            s->per_stiffness * s->modes->stiff * square_integral(across, losses.weights);
    }
    lost.viscous = a->motor.damping > 0 ? hub_loss(s, a, t) : 0;
    return lost;
}
