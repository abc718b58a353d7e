#include <math.h>
#include <string.h>

#include "src/solve/modal_parts.h"

enum { LEAST_HUB_STEPS = 6 };

#define HUB_TURN 0.75 // of the fastest of them from step to step [rad]
#define LOW_TURN 24   // rate times time up to which modes are taken together

// --- walks ------------------------------------------------------------------------------------

void modal_walk_begin(modal_stride *s, int count)
{
    modal_walk *w = &s->walk;
    const size_t size = (size_t)count * sizeof(double);
    const int e = s->modes->across;
    w->count = count;
    w->step = w->time = 0;

    // from rest at the stride's start, under its polynomials
    memset(w->x, 0, size);
    memcpy(w->y, s->start, size);
    for (int j = 0; j < MODAL_NODES; j++) {
        memcpy(w->force[j], s->force[j], size);
        memcpy(w->drift[j], s->drift[j], size);
        if (e >= 0 && e < count) {
            w->force[j][e] = w->y[e] = 0;
        }
    }
}

void modal_walk_set_step(modal_stride *s, double step)
{
    if (s->walk.step != step) {
        s->walk.step = step;
        modal_fill_table(s, step, MODAL_NODES, s->walk.count, &s->walk.at);
    }
}

void modal_walk_on(modal_stride *s)
{
    modal_walk *w = &s->walk;
    const double t = w->step;
    const modal_table *at = &w->at;

    // the modes
    for (int k = 0; k < w->count; k++) {
        const double twice = 2 * s->damping[k], stiff = s->modes->rate[k] * s->modes->rate[k];
        const double x = w->x[k], y = w->y[k], g = at->impulse[k], gr = at->impulse_rate[k];
        double place = x * (gr + twice * g) + y * g, rate = y * gr - stiff * g * x, lower = g;
        for (int j = 0; j < MODAL_NODES; j++) {
            const double power = at->power[j][k], f = w->force[j][k], d = w->drift[j][k];
            place += f * power + d * (lower + twice * power);
            rate += f * lower - stiff * d * power;
            lower = power;
        }
        w->x[k] = place;
        w->y[k] = rate;
    }

    // the polynomials about the next instant
    for (int i = 0; i < 2; i++) {
        double **p = i == 0 ? w->force : w->drift;
        for (int j = 0; j < MODAL_NODES - 1; j++) {
            double power = 1;
            for (int higher = j + 1; higher < MODAL_NODES; higher++) {
                power *= t / (higher - j);
                for (int k = 0; k < w->count; k++) {
                    p[j][k] += power * p[higher][k];
                }
            }
        }
    }
    w->time += t;
}

// --- losses -----------------------------------------------------------------------------------

// Integral from 0 to t of the product of two polynomials sum p[j] t^j / j!.
static double product_integral(const double *p, const double *q, double t)
{
    static const double factorial[MODAL_NODES] = {1, 1, 2, 6, 24, 120};
    double powers[2 * MODAL_NODES], sum = 0;
    powers[0] = t;
    for (int i = 1; i < 2 * MODAL_NODES; i++) {
        powers[i] = powers[i - 1] * t;
    }
    for (int i = 0; i < MODAL_NODES; i++) {
        for (int j = 0; j < MODAL_NODES; j++) {
            sum += p[i] * q[j] * powers[i + j] / ((i + j + 1) * factorial[i] * factorial[j]);
        }
    }
    return sum;
}

// Moments of a mode: of x, integral of t^j / j! x, and of v = x', the same.
static void moments(const modal_stride *s, int k, double t, double *of_x, double *of_v)
{
    const modal_table *at = s->ending;
    const double twice = 2 * s->damping[k];

    // x integrated i times
    double repeated[MODAL_NODES + 1];
    for (int i = 1; i <= MODAL_NODES; i++) {
        double sum = s->start[k] * at->power[i - 1][k];
        for (int j = 0; j < MODAL_NODES; j++) {
            const double power = at->power[j + i][k];
            sum +=
                s->force[j][k] * power + s->drift[j][k] * (at->power[j + i - 1][k] + twice * power);
        }
        repeated[i] = sum;
    }

    // by parts
    double term[MODAL_NODES] = {1};
    for (int j = 1; j < MODAL_NODES; j++) {
        term[j] = term[j - 1] * t / j;
    }
    for (int j = 0; j < MODAL_NODES; j++) {
        of_x[j] = 0;
        for (int i = 0; i <= j; i++) {
            of_x[j] += (i % 2 ? -term[j - i] : term[j - i]) * repeated[i + 1];
        }
        of_v[j] = term[j] * s->place[k] - (j > 0 ? of_x[j - 1] : 0);
    }
}

// The hub's velocity without what vibrates fast, beyond the low modes: a polynomial, and decays.
typedef struct hub_motion {
    double power[MODAL_NODES]; // sum power[j] t^j / j! [rad/s]
    double *slow, *rate;       // decays [rad/s], [1/s]
    int decays;
} hub_motion;

// Adds a mode that is not a low one; returns the loss of its own that is in its vibration alone, of
// the `loss` of all its motion.
static double add_to_hub(const modal_stride *s, int k, double t, double loss, hub_motion *h)
{
    const double hub = s->modes->by_dof[k], damping = s->damping[k], rate = s->modes->rate[k];
    double p[MODAL_NODES + 2];
    modal_follow(s, k, p);
    for (int j = 0; j < MODAL_NODES; j++) {
        h->power[j] += hub * p[j + 1];
    }

    // a vibration
    if (damping < rate) {
        const double own = loss - 2 * damping * product_integral(p + 1, p + 1, t);
        return damping > 0 ? own * s->viscous[k] / (2 * damping) : 0;
    }

    // two decays, of which the fast one is over in no time
    const double root = fmax(sqrt((damping - rate) * (damping + rate)), 1e-4 * rate);
    const double slow = rate * rate / (damping + root), fast = damping + root;
    const double place = -p[0], speed = s->start[k] + s->drift[0][k] - p[1];
    const double kept = (fast * place + speed) / (fast - slow);
    const double lost = fast * (slow * place + speed) / (fast - slow);
    h->slow[h->decays] = -hub * slow * kept;
    h->rate[h->decays++] = slow;
    return s->viscous[k] * lost * lost * (1 - modal_decay(-2 * fast * t)) / (2 * fast);
}

// What the hub's viscous damping takes from the low modes and the rest's slow motion together: the
// trapezoidal rule with corrected ends on a walk that resolves them.
static double hub_loss(modal_stride *s, const arm *a, double t, int low, const hub_motion *rest)
{
    const double *hub = s->modes->by_dof;
    double sum = 0, first_slope = 0, last_slope = 0;
    modal_walk *w = &s->walk;

    // hub's velocity and its slope from step to step
    modal_walk_begin(s, low);
    const double turn = low > 0 ? s->modes->rate[low - 1] * t : 0;
    const int steps = (int)fmax(LEAST_HUB_STEPS, ceil(turn / HUB_TURN));
    modal_walk_set_step(s, t / steps);
    for (int i = 0; i <= steps; i++) {
        const double x = w->time;
        double speed = 0, slope = 0, power = 1;
        for (int j = 0; j < MODAL_NODES; j++) {
            speed += power * rest->power[j];
            slope += j + 1 < MODAL_NODES ? power * rest->power[j + 1] : 0;
            power *= x / (j + 1);
        }
        for (int k = 0; k < rest->decays; k++) {
            const double now = rest->slow[k] * modal_decay(-rest->rate[k] * x);
            speed += now;
            slope -= rest->rate[k] * now;
        }
        for (int k = 0; k < low; k++) {
            const double rate = s->modes->rate[k];
            speed += hub[k] * (w->y[k] + w->drift[0][k]);
            slope += hub[k] * (w->force[0][k] + w->drift[1][k] - rate * rate * w->x[k] -
                               2 * s->damping[k] * w->y[k]);
        }
        sum += (i == 0 || i == steps ? 0.5 : 1) * speed * speed;
        first_slope = i == 0 ? 2 * speed * slope : first_slope;
        last_slope = 2 * speed * slope;
        if (i < steps) {
            modal_walk_on(s);
        }
    }

    return a->motor.damping * w->step * (sum + w->step * (first_slope - last_slope) / 12);
}

modal_losses modal_stride_losses(modal_stride *s, const arm *a, double t)
{
    const int e = s->modes->across;
    modal_losses lost = {0};

    // modes slow enough to be taken together
    int low = 0;
    while (low < s->count && low != e && s->modes->rate[low] * t < LOW_TURN &&
           s->damping[low] * t < LOW_TURN) {
        low++;
    }

    // the hub's motion beyond them
    hub_motion rest = {.slow = s->columns, .rate = s->more_columns};
    for (int j = 0; e >= 0 && j < MODAL_NODES; j++) {
        rest.power[j] = s->modes->by_dof[e] * s->drift[j][e];
    }

    for (int k = 0; k < s->count; k++) {
        const double rate = s->modes->rate[k], twice = 2 * s->damping[k];
        if (k == e || (twice == 0 && (e < 0 || s->per_stiffness == 0))) {
            continue;
        }

        // 2 a v^2, from the change of y^2 + w^2 x^2
        double of_x[MODAL_NODES], of_v[MODAL_NODES], drift[MODAL_NODES], sum[MODAL_NODES];
        moments(s, k, t, of_x, of_v);
        double x = s->place[k], y = s->momenta[k], y0 = s->start[k];
        double loss = -0.5 * ((y - y0) * (y + y0) + rate * rate * x * x);
        for (int j = 0; j < MODAL_NODES; j++) {
            drift[j] = s->drift[j][k];
            sum[j] = s->force[j][k] + twice * drift[j];
            loss += (sum[j] + twice * drift[j]) * of_v[j] + rate * rate * drift[j] * of_x[j];
        }
        loss -= product_integral(sum, drift, t);

        // in the springs, and at the hub beyond what the slow modes do together
        if (twice > 0) {
            lost.damping += loss * s->per_stiffness * rate * rate / twice;
        }
        if (a->motor.damping > 0 && k >= low) {
            lost.viscous += add_to_hub(s, k, t, loss, &rest);
        }

        // between this mode and the vector across the constraint
        double with_across = 0;
        for (int j = 0; j < MODAL_NODES; j++) {
            with_across += e >= 0 ? s->drift[j][e] * of_v[j] : 0;
        }
        lost.damping += 2 * s->per_stiffness * s->modes->pull[k] * with_across;
    }

    // that vector's own, and the slow modes' at the hub
    if (e >= 0) {
        double across[MODAL_NODES];
        for (int j = 0; j < MODAL_NODES; j++) {
            across[j] = s->drift[j][e];
        }
        lost.damping += s->per_stiffness * s->modes->pull[e] * product_integral(across, across, t);
    }
    lost.viscous += a->motor.damping > 0 ? hub_loss(s, a, t, low, &rest) : 0;
    return lost;
}
