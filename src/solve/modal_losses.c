#include <math.h>
#include <string.h>

#include "src/solve/modal_loops.h"
#include "src/solve/modal_parts.h"

enum { LEAST_HUB_STEPS = 6 };

#define HUB_TURN 0.75 // of the fastest of them from step to step [rad]
#define LOW_TURN 24   // rate times time up to which modes are taken together

// --- walks ------------------------------------------------------------------------------------

// Puts the walk of the first `count` modes at the stride's start.
static void walk_begin(modal_stride *s, int count)
{
    modal_walk *w = &s->walk;
    const size_t whole = ((size_t)count + MODAL_LANES - 1) / MODAL_LANES * MODAL_LANES;
    const size_t size = whole * sizeof(double);
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

// Sets the length of the walk's steps [s].
static void walk_set_step(modal_stride *s, double step)
{
    if (s->walk.step != step) {
        s->walk.step = step;
        modal_fill_table(s, step, MODAL_NODES, s->walk.count, &s->walk.at);
    }
}

// Takes the walk on by one step.
static void walk_on(modal_stride *s)
{
    modal_walk *w = &s->walk;
    modal_loops_here()->walk(s, w);
    w->time += w->step;
}

// --- losses -----------------------------------------------------------------------------------

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

// Integral of the product of two polynomials sum p[j] t^j / j!.
static double product_integral(const double *p, const double *q, modal_weights weights)
{
    double sum = 0;
    for (int i = 0; i < MODAL_NODES; i++) {
        for (int j = 0; j < MODAL_NODES; j++) {
            sum += p[i] * q[j] * weights[i][j];
        }
    }
    return sum;
}

// The hub's velocity without what vibrates fast, beyond the low modes: a polynomial, and decays.
typedef struct hub_motion {
    double power[MODAL_NODES]; // sum power[j] t^j / j! [rad/s]
    modal_decays decays;       // [rad/s]
} hub_motion;

// Adds a mode that is not a low one; returns the loss of its own that is in its vibration alone.
static double add_to_hub(const modal_stride *s, int k, const modal_mode_losses *losses,
                         hub_motion *h)
{
    const double hub = s->modes->by_dof[k], damping = s->damping[k], rate = s->modes->rate[k];
    for (int j = 0; j + 1 < MODAL_NODES; j++) {
        h->power[j] += hub * s->followed[j + 1][k];
    }

    // a vibration
    if (damping < rate) {
        return damping > 0 ? losses->vibrating[k] * s->viscous[k] / (2 * damping) : 0;
    }

    // two decays, of which the fast one is over in no time
    const double root = fmax(sqrt((damping - rate) * (damping + rate)), 1e-4 * rate);
    const double slow = rate * rate / (damping + root), fast = damping + root;
    const double place = -s->followed[0][k];
    const double speed = s->start[k] + s->drift[0][k] - s->followed[1][k];
    const double kept = (fast * place + speed) / (fast - slow);
    const double lost = fast * (slow * place + speed) / (fast - slow);
    h->decays.now[h->decays.count] = -hub * slow * kept;
    h->decays.rate[h->decays.count++] = slow;
    return s->viscous[k] * lost * lost * (1 - modal_decay(-2 * fast * losses->time)) / (2 * fast);
}

// What the hub's viscous damping takes from the low modes and the rest's slow motion together: the
// trapezoidal rule with corrected ends on a walk that resolves them.
static double hub_loss(modal_stride *s, const arm *a, double t, int low, hub_motion *rest)
{
    const modal_loops *loops = modal_loops_here();
    const double *hub = s->modes->by_dof;
    double sum = 0, first_slope = 0, last_slope = 0;
    modal_walk *w = &s->walk;

    // hub's velocity and its slope from step to step
    walk_begin(s, low);
    const double turn = low > 0 ? s->modes->rate[low - 1] * t : 0;
    const int steps = (int)fmax(LEAST_HUB_STEPS, ceil(turn / HUB_TURN));
    walk_set_step(s, t / steps);
    modal_decays *decays = &rest->decays;
    for (int k = 0; k < decays->count; k++) {
        decays->factor[k] = modal_decay(-decays->rate[k] * w->step);
    }
    for (int k = decays->count; k % MODAL_LANES != 0; k++) {
        decays->now[k] = decays->rate[k] = decays->factor[k] = 0;
    }
    for (int i = 0; i <= steps; i++) {
        const double x = w->time;
        double speed = 0, slope = 0, power = 1;
        for (int j = 0; j < MODAL_NODES; j++) {
            speed += power * rest->power[j];
            slope += j + 1 < MODAL_NODES ? power * rest->power[j + 1] : 0;
            power *= x / (j + 1);
        }
        const glance decaying = loops->decay(decays);
        speed += decaying.value;
        slope += decaying.slope;
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
            walk_on(s);
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
    const ptrdiff_t row = s->row;
    hub_motion rest = {
        .decays = {.now = s->columns, .rate = s->columns + row, .factor = s->columns + 2 * row}};
    for (int j = 0; e >= 0 && j < MODAL_NODES; j++) {
        rest.power[j] = s->modes->by_dof[e] * s->drift[j][e];
    }

    // mode by mode
    modal_mode_losses losses = {
        .time = t, .all = s->more_columns, .vibrating = s->more_columns + row};
    set_weights(losses.weights, t);
    modal_loops_here()->losses(s, &losses);
    for (int k = 0; k < s->count; k++) {
        const double rate = s->modes->rate[k], twice = 2 * s->damping[k];
        if (k == e || twice == 0) {
            continue;
        }

        // in the springs, and at the hub beyond what the slow modes do together
        lost.damping += losses.all[k] * s->per_stiffness * rate * rate / twice;
        if (a->motor.damping > 0 && k >= low) {
            lost.viscous += add_to_hub(s, k, &losses, &rest);
        }
    }

    // that vector's own, and the slow modes' at the hub
    if (e >= 0) {
        double across[MODAL_NODES];
        for (int j = 0; j < MODAL_NODES; j++) {
            across[j] = s->drift[j][e];
        }
        lost.damping +=
            s->per_stiffness * s->modes->stiff * product_integral(across, across, losses.weights);
    }
    lost.viscous += a->motor.damping > 0 ? hub_loss(s, a, t, low, &rest) : 0;
    return lost;
}
