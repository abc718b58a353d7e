// The sweeps of a step of the stiff engine, built once for each width of the processor's vectors
// (stiff_wide_1.c and its like). The derivation stands in stiff_step.h.
#pragma once

#include <math.h>

#include "src/base/sincos.h"
#include "src/solve/by_width.h"
#include "src/solve/stiff_step.h"

// Lanes are handed to inline functions of this file only.
#pragma GCC diagnostic ignored "-Wpsabi"

#define KERNEL static inline __attribute__((always_inline))

// A link may turn by the root of this within a step [rad2].
#define MOST_TURN_SQUARE 0.5

typedef stiff_lanes lanes;
typedef stiff_complex complex_lanes;
typedef long long within_turn __attribute__((vector_size(32)));

// Four numbers of an array that begins with whole vectors.
typedef double aliasing_lanes __attribute__((vector_size(32), may_alias));
KERNEL lanes lanes_at(const double *x)
{
    return *(const aliasing_lanes *)x;
}
KERNEL lanes all(double x)
{
    return (lanes){x, x, x, x};
}
KERNEL complex_lanes number(double x)
{
    return (complex_lanes){all(x), all(0)};
}
KERNEL complex_lanes plus(complex_lanes a, complex_lanes b)
{
    return (complex_lanes){a.r + b.r, a.i + b.i};
}
KERNEL complex_lanes minus(complex_lanes a, complex_lanes b)
{
    return (complex_lanes){a.r - b.r, a.i - b.i};
}
KERNEL complex_lanes times(complex_lanes a, complex_lanes b)
{
    return (complex_lanes){a.r * b.r - a.i * b.i, a.r * b.i + a.i * b.r};
}
KERNEL complex_lanes scaled(double s, complex_lanes a)
{
    return (complex_lanes){s * a.r, s * a.i};
}
KERNEL complex_lanes inverse(complex_lanes a)
{
    const lanes d = 1 / (a.r * a.r + a.i * a.i);
    return (complex_lanes){a.r * d, -a.i * d};
}

// T^-1 of numbers at the stages.
KERNEL complex_lanes to_systems(const lanes *stages)
{
    complex_lanes sum = number(0);
    for (int i = 0; i < RADAU_STAGES; i++) {
        sum.r += lanes_at(radau_to_real[i]) * stages[i / 4][i % 4];
        sum.i += lanes_at(radau_to_imaginary[i]) * stages[i / 4][i % 4];
    }
    return sum;
}

// T of numbers of the systems, half of the stages.
KERNEL lanes to_stages(complex_lanes y, int half)
{
    lanes sum = y.r[0] * lanes_at(&radau_from_real[0][4 * half]);
    for (int j = 1; j < RADAU_SYSTEMS; j++) {
        sum += y.r[j] * lanes_at(&radau_from_real[j][4 * half]);
        sum += y.i[j] * lanes_at(&radau_from_imaginary[j][4 * half]);
    }
    return sum;
}

// --- the stages ----------------------------------------------------------------------------------

static void predict(stiff_step *s, const double *before, const double *force, const double *weight)
{
    // weights of the accelerations for velocities and angles: h a, (h a)^2
    _Alignas(32) double once[RADAU_STAGES][RADAU_LANES], twice[RADAU_STAGES][RADAU_LANES];
    const double h = s->length;
    const complex_lanes root = {lanes_at(radau_root_real), lanes_at(radau_root_imaginary)};
    s->g = scaled(h, inverse(root));
    for (int j = 0; j < RADAU_STAGES; j++) {
        for (int i = 0; i < RADAU_LANES; i++) {
            double sum = 0;
            for (int k = 0; k < RADAU_STAGES; k++) {
                sum += radau_matrix[k][i] * weight[RADAU_LANES * j + k];
            }
            once[j][i] = h * sum;
        }
        for (int i = 0; i < RADAU_LANES; i++) {
            double sum = 0;
            for (int k = 0; k < RADAU_STAGES; k++) {
                sum += radau_matrix[k][i] * once[j][k];
            }
            twice[j][i] = h * sum;
        }
    }

    for (int half = 0; half < STIFF_HALVES; half++) {
        const lanes node = lanes_at(&radau_node[4 * half]);
        const lanes start = half == 0 ? all(0) : (lanes){0, 0, 0, 1};
        for (int k = 0; k < s->dof; k++) {
            stiff_stage *g = &s->stage[k];
            lanes a = s->a0[k] * start, w = all(s->w0[k]), q = s->q0[k] + h * s->w0[k] * node;
            for (int j = 0; j < RADAU_STAGES; j++) {
                const double was = before[RADAU_LANES * k + j];
                a += was * lanes_at(&weight[RADAU_LANES * j + 4 * half]);
                w += was * lanes_at(&once[j][4 * half]);
                q += was * lanes_at(&twice[j][4 * half]);
            }
            g->a[half] = a;
            g->w[half] = w;
            g->q[half] = q;
        }
        lanes f = s->force0 * start;
        for (int j = 0; j < RADAU_STAGES; j++) {
            f += force[j] * lanes_at(&weight[RADAU_LANES * j + 4 * half]);
        }
        s->force.half[half] = f;
    }
    if (s->stuck) {
        for (int half = 0; half < STIFF_HALVES; half++) {
            s->stage[0].a[half] = s->stage[0].w[half] = all(0);
            s->stage[0].q[half] = all(s->q0[0]);
        }
    }
}

// The current at the stages from the hub's velocities there. Through an inductance it solves its
// own collocation: with g of the systems, (L + g Ra) T^-1 i' = T^-1 (volts - Ra i0 - kB w).
KERNEL void follow_current(stiff_step *s)
{
    const motor_model *m = s->motor;
    const double volts = m->gain * m->voltage;
    if (s->drive != STIFF_FLOWS) {
        for (int half = 0; half < STIFF_HALVES; half++) {
            s->current.half[half] =
                s->drive == STIFF_LIMITED
                    ? all(s->limited)
                    : (volts - m->back_emf * s->stage[0].w[half]) / m->resistance;
            s->current_rate.half[half] = all(0);
        }
        return;
    }
    stiff_nodes drives;
    for (int half = 0; half < STIFF_HALVES; half++) {
        drives.half[half] = volts - m->resistance * s->current0 - m->back_emf * s->stage[0].w[half];
    }
    const complex_lanes slows = plus(number(m->inductance), scaled(m->resistance, s->g));
    const complex_lanes rate = times(to_systems(drives.half), inverse(slows));
    const complex_lanes change = times(rate, s->g);
    for (int half = 0; half < STIFF_HALVES; half++) {
        s->current_rate.half[half] = to_stages(rate, half);
        s->current.half[half] = s->current0 + to_stages(change, half);
    }
}

// The force of a wall that gives at a depth and its rates, [N].
KERNEL lanes law(const stiff_step *s, lanes depth, lanes rate, lanes acceleration)
{
    const wall_model *w = s->wall;
    if (w->law == WALL_KELVIN_VOIGT) {
        return w->stiffness * depth + w->damping * rate + w->face_mass * acceleration;
    }
    lanes force;
    for (int i = 0; i < 4; i++) {
        force[i] = wall_force(w, depth[i], rate[i]);
    }
    return force;
}

KERNEL bool sweep(stiff_step *s, int half, bool account)
{
    const lanes zero = all(0);
    lanes ax = zero, ay = zero, vx = zero, vy = zero, x = zero, y = zero, lost = zero;
    within_turn within = all(0) == zero;
    lanes bx = zero, by = zero, bvx = zero, bvy = zero, px = zero, py = zero;

    // outwards: directions, accelerations, and the forces that they take
    for (int k = 0; k < s->links; k++) {
        const stiff_link *l = &s->link[k];
        const stiff_stage *g = &s->stage[s->first + k];
        stiff_body *b = &s->body[k];
        const lanes z = g->q[half] - s->q0[s->first + k], w = g->w[half], al = g->a[half];
        const lanes w2 = w * w;
        lanes sz, cz;
        SINCOS_NEAR_ZERO(lanes, z, sz, cz);
        within &= z * z < MOST_TURN_SQUARE;
        const lanes c = l->cosine * cz - l->sine * sz, sn = l->sine * cz + l->cosine * sz;
        b->c[half] = c;
        b->s[half] = sn;
        bx = ax, by = ay, bvx = vx, bvy = vy, px = x, py = y;
        const lanes dx = -l->length * (sn * al + c * w2), dy = l->length * (c * al - sn * w2);
        const lanes dvx = -l->length * sn * w, dvy = l->length * c * w;
        lanes fx = l->mass * (ax + 0.5 * dx), fy = l->mass * (ay + 0.5 * dy);
        if (s->drags) {
            const lanes mx = vx + 0.5 * dvx, my = vy + 0.5 * dvy;
            fx += l->air * mx;
            fy += l->air * my;
            if (account) {
                lost += l->air * (mx * mx + my * my) + l->turning * w2;
            }
        }
        b->fx[half] = fx;
        b->fy[half] = fy;
        ax += dx, ay += dy, vx += dvx, vy += dvy;
        x += l->length * c, y += l->length * sn;
    }
    for (int i = 0; i < 4; i++) {
        if (!within[i]) {
            return false;
        }
    }

    // the wall: gap, rate and force (wall_contact_at of wall.h, for lanes)
    const int last = s->links - 1;
    const stiff_link *tip = &s->link[last];
    const lanes c = s->body[last].c[half], sn = s->body[last].s[half];
    const lanes w = s->stage[s->first + last].w[half];
    lanes ex = zero, ey = zero, lever = zero, force = zero;
    if (wall_stands(s->wall)) {
        lanes depth, bends; // bends: what velocities add to the depth's second derivative
        if (s->wall->kind == WALL_POINT) {
            const lanes dx = s->wall->x - px, dy = s->wall->y - py;
            ex = -sn;
            ey = c;
            lever = c * dx + sn * dy - tip->length;
            depth = sn * dx - c * dy;
            bends = -depth * w * w - 2 * w * (c * bvx + sn * bvy);
        } else {
            ex = all(-s->wall->sine);
            ey = all(s->wall->cosine);
            depth = ex * (px + tip->length * c) + ey * (py + tip->length * sn);
            bends = -tip->length * w * w * (ex * c + ey * sn);
        }
        const lanes reach = lever + tip->length * (c * ey - sn * ex);
        const lanes rate = ex * bvx + ey * bvy + reach * w;
        s->gap.half[half] = -depth;
        s->rate.half[half] = -rate;
        if (s->contact == STIFF_GIVES) {
            const lanes rate2 =
                ex * bx + ey * by + reach * s->stage[s->first + last].a[half] + bends;
            s->force.half[half] = law(s, depth, rate, rate2);
        }
        if (s->contact == STIFF_FREE) {
            s->force.half[half] = zero;
        }
        force = s->force.half[half];
        if (account) {
            s->wall_lost.half[half] = zero;
        }
        if (account && s->contact == STIFF_GIVES) {
            lanes power = s->wall->damping * rate * rate;
            for (int i = 0; i < 4 && s->wall->law == WALL_HUNT_CROSSLEY; i++) {
                power[i] = (force[i] - wall_spring_force(s->wall, depth[i])) * rate[i];
            }
            s->wall_lost.half[half] = power;
        }
    }

    // damped modes: sums of the bends' rates
    lanes sum[PARAMETER_MODES_MOST];
    for (int i = 0; i < s->modes; i++) {
        sum[i] = zero;
        for (int k = 0; k < s->dof; k++) {
            sum[i] += s->mode[i * s->dof + k] * s->stage[k].w[half];
        }
        if (account) {
            lost += sum[i] * sum[i];
        }
    }

    // inwards: forces, and what each equation lacks
    lanes fx = s->tip_mass * ax + force * ex, fy = s->tip_mass * ay + force * ey, outer = zero;
    for (int k = last; k >= 0; k--) {
        const stiff_link *l = &s->link[k];
        const stiff_body *b = &s->body[k];
        stiff_stage *g = &s->stage[s->first + k];
        const lanes hx = l->length * (fx + 0.5 * b->fx[half]);
        const lanes hy = l->length * (fy + 0.5 * b->fy[half]);
        lanes inner = zero;
        if (k + s->first > 0) {
            const stiff_stage *before = g - 1;
            const lanes bend = g->q[half] - before->q[half], rate = g->w[half] - before->w[half];
            inner = l->stiffness * bend + l->damping * rate;
            if (s->stiffens) {
                inner += l->stiffening * bend * bend * bend;
            }
            if (account) {
                lost += l->damping * rate * rate;
            }
        }
        lanes r = l->inertia * g->a[half] + b->c[half] * hy - b->s[half] * hx - outer + inner;
        if (s->drags) {
            r += l->turning * g->w[half];
        }
        if (k == last) {
            r += force * lever;
        }
        for (int i = 0; i < s->modes; i++) {
            r += s->mode[i * s->dof + s->first + k] * sum[i];
        }
        g->r[half] = r;
        fx += b->fx[half];
        fy += b->fy[half];
        outer = inner;
    }

    // the hub
    stiff_stage *hub = &s->stage[0];
    lanes r = s->first > 0 ? -outer : hub->r[half];
    r += s->hub_inertia * hub->a[half] + s->hub_damping * hub->w[half] - s->torque;
    for (int i = 0; i < s->modes && s->first > 0; i++) {
        r += s->mode[i * s->dof] * sum[i];
    }
    if (s->drive != STIFF_DIRECT) {
        r -= s->motor->torque_constant * s->current.half[half];
    }
    hub->r[half] = s->stuck ? zero : r + s->friction;
    if (account) {
        s->hold.half[half] = r;
        s->lost.half[half] = lost;
        s->viscous.half[half] = s->hub_damping * hub->w[half] * hub->w[half];
        if (s->drive != STIFF_DIRECT) {
            s->electric.half[half] =
                s->motor->torque_constant * s->current.half[half] * hub->w[half];
        }
    }
    return true;
}

static bool residual(stiff_step *s, bool account)
{
    if (s->drive != STIFF_DIRECT) {
        follow_current(s);
    }
    return account ? sweep(s, 0, true) && sweep(s, 1, true)
                   : sweep(s, 0, false) && sweep(s, 1, false);
}

// --- the tangent ---------------------------------------------------------------------------------

// y of a right side without borders, in place.
KERNEL void solve_bare(const stiff_step *s, complex_lanes *y)
{
    complex_lanes fx = number(0), fy = fx, t = fx;
    for (int k = s->links - 1; k >= 0; k--) {
        const stiff_pivot *p = &s->pivot[k];
        complex_lanes *own = &y[s->first + k];
        const complex_lanes beyond = minus(scaled(p->lc, fy), scaled(p->ls, fx));
        const complex_lanes f = times(minus(minus(*own, t), beyond), p->inverse);
        *own = f;
        fx = plus(fx, times(p->ux, f));
        fy = plus(fy, times(p->uy, f));
        t = scaled(-1, times(p->kappa, f));
    }
    if (s->first > 0) {
        y[0] = times(minus(y[0], t), s->hub_inverse);
    }

    complex_lanes ax = number(0), ay = ax, before = y[0];
    for (int k = 0; k < s->links; k++) {
        const stiff_pivot *p = &s->pivot[k];
        complex_lanes *own = &y[s->first + k];
        if (s->first + k > 0) {
            const complex_lanes base = plus(times(p->ux, ax), times(p->uy, ay));
            *own = plus(minus(*own, times(base, p->inverse)), times(p->share, before));
        }
        before = *own;
        ax = minus(ax, scaled(p->ls, before));
        ay = plus(ay, scaled(p->lc, before));
    }
}

// Sum of a row's numbers times y.
KERNEL complex_lanes along(const stiff_step *s, const double *row, const complex_lanes *y)
{
    complex_lanes sum = number(0);
    for (int k = 0; k < s->dof; k++) {
        sum = plus(sum, scaled(row[k], y[k]));
    }
    return sum;
}

// How many borders there are, and the row of one: the damped modes', then the contact's.
KERNEL int borders(const stiff_step *s)
{
    return s->modes + (s->contact != STIFF_FREE ? 1 : 0);
}
KERNEL const double *border_row(const stiff_step *s, int i)
{
    return i < s->modes ? s->mode + i * s->dof : s->jacobian;
}

// J at the middle stage, of whose lanes that is one.
KERNEL void find_jacobian(stiff_step *s, int half, int lane)
{
    double x = 0, y = 0;
    const int last = s->links - 1;
    for (int k = 0; k < last; k++) {
        x += s->pivot[k].lc;
        y += s->pivot[k].ls;
    }
    const stiff_pivot *p = &s->pivot[last];
    const double l = s->link[last].length;
    const double c = s->body[last].c[half][lane], sn = s->body[last].s[half][lane];
    const bool point = s->wall->kind == WALL_POINT;
    const double ex = point ? -sn : -s->wall->sine, ey = point ? c : s->wall->cosine;
    s->jacobian[0] = 0;
    for (int k = 0; k < last; k++) {
        s->jacobian[s->first + k] = s->pivot[k].lc * ey - s->pivot[k].ls * ex;
    }
    const double lever = point ? c * (s->wall->x - x) + sn * (s->wall->y - y) - l : 0;
    s->jacobian[s->first + last] = lever + p->lc * ey - p->ls * ex;
    if (s->stuck) {
        s->jacobian[0] = 0;
    }
}

static void factor(stiff_step *s)
{
    enum { HALF = RADAU_MIDDLE / 4, LANE = RADAU_MIDDLE % 4 };
    const complex_lanes g = s->g, g2 = times(g, g);

    // from the tip inwards
    complex_lanes pxx = number(s->tip_mass), pxy = number(0), pyy = pxx;
    complex_lanes px = number(0), py = px, tau = px;
    for (int k = s->links - 1; k >= 0; k--) {
        const stiff_link *l = &s->link[k];
        const stiff_stage *at = &s->stage[s->first + k];
        stiff_pivot *p = &s->pivot[k];
        const double lc = l->length * s->body[k].c[HALF][LANE];
        const double ls = l->length * s->body[k].s[HALF][LANE];
        const double square = 0.25 * l->length * l->length;
        complex_lanes mass = number(l->mass), own = number(l->inertia + l->mass * square);
        if (s->drags) {
            mass = plus(mass, scaled(l->air, g));
            own = plus(own, scaled(l->turning + l->air * square, g));
        }
        const complex_lanes ptx = minus(scaled(lc, pxy), scaled(ls, pxx));
        const complex_lanes pty = minus(scaled(lc, pyy), scaled(ls, pxy));
        complex_lanes d = plus(minus(scaled(lc, pty), scaled(ls, ptx)), plus(tau, own));
        d = plus(d, minus(scaled(2 * lc, py), scaled(2 * ls, px)));
        const complex_lanes ux = minus(plus(ptx, px), scaled(0.5 * ls, mass));
        const complex_lanes uy = plus(plus(pty, py), scaled(0.5 * lc, mass));
        complex_lanes kappa = number(0);
        if (s->first + k > 0) {
            double stiffness = l->stiffness;
            if (s->stiffens) {
                const double bend = at->q[HALF][LANE] - at[-1].q[HALF][LANE];
                stiffness += 3 * l->stiffening * bend * bend;
            }
            kappa = plus(scaled(stiffness, g2), scaled(l->damping, g));
        } else {
            tau = d; // the hub's, below
        }
        const complex_lanes inv = inverse(plus(d, kappa)), share = times(kappa, inv);
        *p = (stiff_pivot){ux, uy, inv, kappa, share, lc, ls};
        if (s->first + k > 0) {
            pxx = plus(minus(pxx, times(ux, times(ux, inv))), mass);
            pxy = minus(pxy, times(ux, times(uy, inv)));
            pyy = plus(minus(pyy, times(uy, times(uy, inv))), mass);
            px = times(ux, share);
            py = times(uy, share);
            tau = times(share, d);
        }
    }

    // the hub, whose back EMF works through the current
    complex_lanes hub = plus(tau, plus(number(s->hub_inertia), scaled(s->hub_damping, g)));
    if (s->drive == STIFF_FOLLOWS) {
        const double brakes = s->motor->torque_constant * s->motor->back_emf / s->motor->resistance;
        hub = plus(hub, scaled(brakes, g));
    } else if (s->drive == STIFF_FLOWS) {
        const complex_lanes slows =
            plus(number(s->motor->inductance), scaled(s->motor->resistance, g));
        const double brakes = s->motor->torque_constant * s->motor->back_emf;
        hub = plus(hub, scaled(brakes, times(g2, inverse(slows))));
    }
    s->hub_inverse = s->stuck ? number(0) : inverse(hub);
    if (s->first == 0) {
        s->pivot[0].inverse = s->hub_inverse;
    }

    // the borders' answers
    const int count = borders(s);
    if (s->contact != STIFF_FREE) {
        find_jacobian(s, HALF, LANE);
    }
    for (int b = 0; b < count; b++) {
        const double *row = border_row(s, b);
        for (int k = 0; k < s->dof; k++) {
            s->border[b][k] = number(-row[k]);
        }
        solve_bare(s, s->border[b]);
    }

    // their equations, the contact's last; eliminated in that order
    if (s->contact == STIFF_GIVES) {
        const double depth = -s->gap.at[RADAU_MIDDLE], rate = -s->rate.at[RADAU_MIDDLE];
        double stiffness = s->wall->stiffness, damping = s->wall->damping;
        if (s->wall->law == WALL_HUNT_CROSSLEY) {
            const double power = wall_power(s->wall, depth);
            stiffness =
                depth > 0 ? s->wall->exponent * power / depth * (stiffness + damping * rate) : 0;
            damping *= power;
        }
        s->wall_damping = damping;
        s->press =
            plus(plus(scaled(stiffness, g2), scaled(damping, g)), number(s->wall->face_mass));
    }
    for (int i = 0; i < count; i++) {
        const bool wall = i == s->modes;
        for (int j = 0; j < count; j++) {
            const complex_lanes sum = along(s, border_row(s, i), s->border[j]);
            const complex_lanes by = !wall ? g : s->contact == STIFF_GIVES ? s->press : number(-1);
            const bool one = i == j && !(wall && s->contact == STIFF_RIGID);
            s->corner[i][j] = minus(number(one ? 1 : 0), times(by, sum));
        }
    }
    for (int p = 0; p < count; p++) {
        s->corner[p][p] = inverse(s->corner[p][p]);
        for (int i = p + 1; i < count; i++) {
            s->corner[i][p] = times(s->corner[i][p], s->corner[p][p]);
            for (int j = p + 1; j < count; j++) {
                s->corner[i][j] = minus(s->corner[i][j], times(s->corner[i][p], s->corner[p][j]));
            }
        }
    }
}

static void solve(stiff_step *s, const complex_lanes *target)
{
    const int count = borders(s);
    complex_lanes *x = s->unknown;
    for (int k = 0; k < s->dof; k++) {
        s->y[k] = s->rhs[k];
    }
    solve_bare(s, s->y);
    for (int i = 0; i < count; i++) {
        const complex_lanes sum = along(s, border_row(s, i), s->y);
        x[i] = i < s->modes                ? times(s->g, sum)
               : s->contact == STIFF_GIVES ? plus(*target, times(s->press, sum))
                                           : minus(*target, sum);
    }
    for (int i = 1; i < count; i++) {
        for (int j = 0; j < i; j++) {
            x[i] = minus(x[i], times(s->corner[i][j], x[j]));
        }
    }
    for (int i = count - 1; i >= 0; i--) {
        for (int j = i + 1; j < count; j++) {
            x[i] = minus(x[i], times(s->corner[i][j], x[j]));
        }
        x[i] = times(x[i], s->corner[i][i]);
    }
    for (int i = 0; i < count; i++) {
        for (int k = 0; k < s->dof; k++) {
            s->y[k] = plus(s->y[k], times(x[i], s->border[i][k]));
        }
    }
}

// Radau's embedded sums of the stages, x of velocities and v of accelerations.
static void differences(const stiff_step *s, double *x, double *v)
{
    const lanes low = lanes_at(radau_difference), high = lanes_at(radau_difference + 4);
    for (int k = 0; k < s->dof; k++) {
        const stiff_stage *g = &s->stage[k];
        const lanes w = low * g->w[0] + high * g->w[1], a = low * g->a[0] + high * g->a[1];
        x[k] = radau_start * s->w0[k] + ((w[0] + w[2]) + (w[1] + w[3]));
        v[k] = radau_start * s->a0[k] + ((a[0] + a[2]) + (a[1] + a[3]));
    }
}

static double correct(stiff_step *s)
{
    for (int k = 0; k < s->dof; k++) {
        s->rhs[k] = scaled(-1, to_systems(s->stage[k].r));
    }
    complex_lanes target = number(0);
    if (s->contact == STIFF_RIGID) {
        target = times(to_systems(s->rate.half), inverse(s->g));
    }
    solve(s, &target);
    if (s->contact == STIFF_RIGID) {
        for (int half = 0; half < STIFF_HALVES; half++) {
            s->force.half[half] += to_stages(s->unknown[s->modes], half);
        }
    }

    // the stages; as for an arm that is straight, how much they move
    const complex_lanes g = s->g;
    lanes v[STIFF_HALVES] = {all(0), all(0)}, sum[STIFF_HALVES] = {all(0), all(0)};
    for (int k = 0; k < s->dof; k++) {
        const complex_lanes y = s->y[k], once = times(y, g), twice = times(once, g);
        stiff_stage *at = &s->stage[k];
        const bool link = k >= s->first;
        for (int half = 0; half < STIFF_HALVES; half++) {
            const lanes dw = to_stages(once, half);
            at->a[half] += to_stages(y, half);
            at->w[half] += dw;
            at->q[half] += to_stages(twice, half);
            if (k == 0) {
                sum[half] = s->hub_inertia * dw * dw;
            }
            if (link) {
                const stiff_link *l = &s->link[k - s->first];
                v[half] += l->length * dw;
                sum[half] += l->mass * v[half] * v[half];
            }
        }
    }
    double most = 0;
    for (int i = 0; i < RADAU_STAGES; i++) {
        const double here = sum[i / 4][i % 4];
        most = here > most || !(here == here) ? here : most;
    }
    return sqrt(most);
}

const stiff_loops GLUE(stiff_loops_, WIDTH) = {predict, residual, factor, differences, correct};
