#include "src/solve/modal_watch.h"

#include <math.h>
#include <string.h>

#include "src/base/sincos.h"
#include "src/solve/modal_parts.h"

// --- the functional ---------------------------------------------------------------------------

// Gradient of the penetration by the angles.
static void contact_gradient(const arm *a, const double *q, double *gradient)
{
    const double l = a->link_length;
    const int last = a->first + a->links - 1;

    // where the last link begins, and the wall as met from there
    double x = 0, y = 0, c = 1, s = 0;
    for (int k = a->first; k < last; k++) {
        inline_sincos(q[k], &s, &c);
        x += l * c;
        y += l * s;
    }
    inline_sincos(q[last], &s, &c);
    wall_contact at = wall_contact_at(&a->wall, l, x, y, 0, 0, c, s, 0);

    // the last link turns about that place, the others move it
    gradient[0] = 0;
    gradient[last] = wall_last_lever(&at, l, c, s);
    for (int k = a->first; k < last; k++) {
        inline_sincos(q[k], &s, &c);
        gradient[k] = l * (c * at.ey - s * at.ex);
    }
}

// Coordinates V' K direction and, with structural damping, the same of the velocities.
static void through_springs(modal_function *f, modal_stride *s, const arm *a, double *direction,
                            double hub)
{
    double *springs = s->columns;
    modal_stiffness_times(a, direction, springs);
    modal_from_angles(s->modes, s->dof, 1, springs, f->place, s->dof);
    for (int k = 0; k < s->count; k++) {
        f->speed[k] = s->per_stiffness * f->place[k] + hub * s->modes->by_dof[k];
    }
}

static void fit_functional(modal_function *f, modal_stride *s, const arm *a, motion *m)
{
    const int n = s->dof;
    const double *q = state_angles(m, m->state);
    double *direction = s->angles, compliance, impulse;
    const bool stuck = s->mode.friction == HUB_STICK;

    // weights of the modes' angles and speeds; most kinds need no speeds
    memset(f->speed, 0, (size_t)n * sizeof(double));
    if (f->kind == WATCH_GAP) {
        // the gap shrinks as the penetration grows
        contact_gradient(a, q, direction);
        for (int i = 0; i < n; i++) {
            direction[i] = -direction[i];
        }
        modal_from_angles(s->modes, n, 1, direction, f->place, n);
    } else if (f->kind == WATCH_FORCE) {
        // the force: springs at work along the contact's response
        chain_contact_response(a, m->links, q, stuck, direction, &compliance);
        for (int i = 0; i < n; i++) {
            direction[i] /= compliance;
        }
        through_springs(f, s, a, direction, stuck ? 0 : a->motor.damping * direction[0]);
    } else if (f->kind == WATCH_HUB) {
        // the hub's speed in the direction that its friction is for
        memset(f->place, 0, (size_t)n * sizeof(double));
        for (int k = 0; k < s->count; k++) {
            f->speed[k] = s->mode.friction * s->modes->by_dof[k];
        }
    } else {
        // the friction torque on a stuck hub: springs at work along what a free hub would do
        const contact_state free_hub = {s->mode.contact, HUB_FORWARD};
        memset(direction, 0, (size_t)n * sizeof(double));
        if (a->hub_spring) {
            direction[0] = 1;
        } else {
            double *unit = s->columns + n, *rates = unit + n;
            memset(unit, 0, (size_t)n * sizeof(double));
            unit[0] = 1;
            chain_from_momentum(a, m->links, free_hub, q, unit, direction, rates, &impulse);
            for (int i = n - 1; i >= 0; i--) {
                direction[i] /= direction[0];
            }
        }
        through_springs(f, s, a, direction, 0);
    }
}

// --- values -------------------------------------------------------------------------------------

static double exact_at(watch kind, const arm *a, motion *m, contact_state mode, const double *q,
                       const double *w, double *accelerations)
{
    if (kind == WATCH_HUB) {
        return mode.friction * w[0];
    }
    if (kind == WATCH_GAP) {
        double penetration;
        chain_penetration(a, q, w, &penetration, NULL);
        return -penetration;
    }
    chain_reaction r;
    chain_accelerations(a, m->links, q, w, mode, accelerations, &r);
    return kind == WATCH_FORCE ? r.force : r.friction;
}

// The functional less its value at the start.
static double functional(const modal_function *f, const modal_stride *s, const double *x,
                         const double *y, const double *drift, const double *drift0)
{
    double sum = 0;
    for (int k = 0; k < s->count; k++) {
        const double change = y[k] + drift[k] - (s->start[k] + drift0[k]);
        const double speed = k == s->modes->across ? drift[k] - drift0[k] : change;
        sum += f->place[k] * x[k] + f->speed[k] * speed;
    }
    return sum;
}

// Derivatives at the start of a mode that turns little in the stride, g_j of x = sum g_j t^j / j!,
// under n(t) = sum n_j t^j / j!; x = 0 at the start.
static void slow_mode(double damping, double rate, double speed, const double *n, double *g)
{
    g[0] = 0;
    g[1] = speed;
    for (int j = 0; j + 2 <= MODAL_SERIES; j++) {
        g[j + 2] = (j < MODAL_NODES ? n[j] : 0) - 2 * damping * g[j + 1] - rate * rate * g[j];
    }
}

// The vibration that takes a mode from `place` and `speed` [of x], into the function's amplitudes.
static void add_vibration(modal_function *f, const modal_vibrations *v, int mode, double place,
                          double speed)
{
    const int e = v->entry[mode];
    const double p = f->place[mode], s = f->speed[mode];
    const double a = v->decay[e], turn = v->turn[e], b = (speed + a * place) / turn;
    f->sum.cosine[e] = p * place + s * (turn * b - a * place);
    f->sum.sine[e] = p * b - s * (a * b + turn * place);
}

// An overdamped mode from x = 0 with a speed under n(t). With decays a and b, u = x' + b x and
// v = x' + a x decay at a and b, x = (u - v)/(b - a) and x' = (b v - a u)/(b - a). Apart, since one
// may be slow and the other fast by any factor.
static void add_overdamped(modal_function *f, const modal_vibrations *v, int mode, double speed,
                           const double *n, double *total)
{
    const int e = v->entry[mode], other = e + v->overdamped;
    const double slow = v->decay[e], fast = v->decay[other], per = 1 / (fast - slow);
    const double p = f->place[mode], s = f->speed[mode], length = f->sum.length;
    const modal_decay_course at[2] = {{slow, length, speed, n}, {fast, length, speed, n}};
    modal_add_decay(&at[0], per * (p - s * slow), &f->sum.cosine[e], total);
    modal_add_decay(&at[1], -per * (p - s * fast), &f->sum.cosine[other], total);
}

// The function on the whole stride from its value, functional and rest.
static void fit_sum(modal_function *f, const modal_stride *s)
{
    const modal_vibrations *v = s->now;
    modal_sum *sum = &f->sum;
    const double h = s->length;
    double total[MODAL_SERIES + 1] = {f->value}, g[MODAL_SERIES + 1];
    sum->vibrations = s->now;
    sum->length = h;
    sum->first = 0;
    sum->last = v->count;
    memset(sum->cosine, 0, (size_t)v->count * sizeof(double));
    memset(sum->sine, 0, (size_t)v->count * sizeof(double));
    for (int j = 0; j < MODAL_NODES; j++) {
        total[j] += f->rest[j];
    }

    // mode by mode
    for (int k = 0; k < s->count; k++) {
        const double rate = s->modes->rate[k], damping = s->damping[k];
        const double speed =
            k == s->modes->across ? s->drifts[0][k] : s->start[k] + s->drifts[0][k];
        int terms = MODAL_NODES; // of g that there are
        double n[MODAL_NODES];
        for (int j = 0; j < MODAL_NODES; j++) {
            const double turn = j + 1 < MODAL_NODES ? s->drift[j + 1][k] : 0;
            n[j] = s->force[j][k] + 2 * damping * s->drift[j][k] + turn;
        }
        total[0] -= f->speed[k] * speed;
        if (k == s->modes->across) {
            g[0] = 0;
            for (int j = 0; j < MODAL_NODES; j++) {
                g[j + 1] = s->drift[j][k];
            }
            g[++terms] = 0;
        } else if (v->entry[k] < 0 ||
                   (rate * h <= MODAL_SLOW_TURN && 2 * damping * h <= MODAL_SLOW_TURN)) {
            slow_mode(damping, rate, speed, n, g);
            terms = MODAL_SERIES;
            sum->first =
                v->entry[k] >= 0 && v->entry[k] == sum->first ? sum->first + 1 : sum->first;
        } else if (v->entry[k] >= v->vibrating) {
            add_overdamped(f, v, k, speed, n, total);
            continue;
        } else {
            for (int j = 0; j < MODAL_NODES; j++) {
                g[j] = s->followed[j][k];
            }
            g[terms] = 0;
            add_vibration(f, v, k, -g[0], speed - g[1]);
        }
        for (int j = 0; j < terms; j++) {
            total[j] += f->place[k] * g[j] + f->speed[k] * g[j + 1];
        }
    }

    // in powers of the share of the stride
    double scale = 1, most = 0;
    sum->terms = 1;
    for (int j = 0; j < MODAL_SERIES; j++) {
        sum->series[j] = total[j] * scale;
        most = fmax(most, fabs(sum->series[j]));
        sum->terms = fabs(sum->series[j]) > 1e-19 * most ? j + 1 : sum->terms;
        scale *= h / (j + 1);
    }
}

size_t modal_function_size(int n)
{
    return 10 * (size_t)n;
}

void modal_function_place(modal_function *f, int n, double *storage)
{
    f->place = storage;
    f->speed = storage + n;
    f->sum.cosine = storage + 2 * n;
    f->sum.sine = storage + 4 * n;
    f->sum.a = storage + 6 * n;
    f->sum.b = storage + 8 * n;
}

void modal_function_fit(modal_function *f, watch kind, modal_stride *s, const arm *a, motion *m)
{
    f->kind = kind;
    fit_functional(f, s, a, m);
    f->value = exact_at(kind, a, m, s->mode, state_angles(m, m->state),
                        state_velocities(m, m->state), s->columns);

    // angles turned until the points, where a gap begins on the wall
    const size_t pair = 2 * (size_t)s->row;
    const bool on_wall = kind == WATCH_GAP && fabs(f->value) <= MODAL_ON_WALL;
    if (on_wall) {
        modal_to_angles(s->modes, s->dof, MODAL_NODES - 1, s->modal + pair, s->more_columns + pair,
                        (int)pair);
    }

    // what the modes leave unexplained there
    double values[MODAL_NODES] = {0};
    for (int i = 1; i < MODAL_NODES; i++) {
        const double *x = s->modal + (size_t)i * pair, *turn = s->more_columns + (size_t)i * pair;
        const double change = on_wall
                                  ? -chain_penetration_change(a, state_angles(m, m->state), turn)
                                  : exact_at(kind, a, m, s->mode, s->point_angles[i],
                                             s->point_velocities[i], s->columns) -
                                        f->value;
        values[i] = change - functional(f, s, x, x + s->row, s->drifts[i], s->drifts[0]);
    }

    // both parts as functions of time
    modal_polynomial(values, s->length, f->rest);
    fit_sum(f, s);
}

glance modal_function_watched(const modal_function *f, const arm *a, glance g)
{
    if (f->kind == WATCH_STICTION) {
        g = (glance){a->motor.stiction - fabs(g.value), g.value > 0 ? -g.slope : g.slope};
    }
    return (glance){g.value - f->edge, g.slope};
}

glance modal_function_at(const modal_function *f, const arm *a, double t)
{
    return modal_function_watched(f, a, modal_sum_at(&f->sum, t));
}
