// The loops of a step of the stiff engine, built as LOOPS once for each width of the
// processor's vectors (src/engines/meson.build). The derivation stands in stiff_step.h.
#ifndef LOOPS
#define LOOPS stiff_loops_1
#endif

#include <math.h>

#define FORCE_LANES 4
#include "src/engines/stiff/stiff_sweeps.h"

// --- the tangent -----------------------------------------------------------------------

// y of a right side without borders, in place.
KERNEL void solve_unbordered(const stiff_step *s, complex_lanes *y)
{
    // from tip to hub: what each body's equation leaves for those before it
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

    // from hub to tip: what the bodies before take along
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
KERNEL complex_lanes row_product(const stiff_step *s, const double *row,
                                 const complex_lanes *y)
{
    complex_lanes sum = number(0);
    for (int k = 0; k < s->dof; k++) {
        sum = plus(sum, scaled(row[k], y[k]));
    }
    return sum;
}

// The middle stage, of which the tangent is.
enum { HALF = RADAU_MIDDLE / 4, LANE = RADAU_MIDDLE % 4 };

// How the wall answers there: derivatives of its forces, and the direction along it.
KERNEL void factor_wall(stiff_step *s, complex_lanes g, complex_lanes g2)
{
    s->slip_damping = 0;
    if (s->contact == STIFF_FREE) {
        return;
    }
    const stiff_body *last = &s->body[s->links - 1];
    if (s->wall->kind == WALL_POINT) {
        s->along_x = last->c[HALF][LANE];
        s->along_y = last->s[HALF][LANE];
    } else {
        s->along_x = s->wall->cosine;
        s->along_y = s->wall->sine;
    }

    const wall_meeting meeting = {-s->gap.half[HALF], -s->rate.half[HALF], all(0)};
    const wall_answer f = wall_forces(s->wall, s->amount, &meeting);
    s->slip_damping = f.by_slip[LANE];
    s->wall_damping = f.by_rate[LANE];
    s->press = plus(plus(scaled(f.by_depth[LANE], g2), scaled(s->wall_damping, g)),
                    number(s->wall->face_mass));
}

// J there, the normal of the wall being (-along_y, along_x).
KERNEL void find_jacobian(stiff_step *s)
{
    double x = 0, y = 0;
    const int last = s->links - 1;
    for (int k = 0; k < last; k++) {
        x += s->pivot[k].lc;
        y += s->pivot[k].ls;
    }
    const stiff_pivot *p = &s->pivot[last];
    x -= s->wall->sine * s->shift[0].half[HALF][LANE];
    y += s->wall->cosine * s->shift[0].half[HALF][LANE];
    const double ex = -s->along_y, ey = s->along_x;
    s->jacobian[0] = 0;
    for (int k = 0; k < last; k++) {
        s->jacobian[s->first + k] = s->pivot[k].lc * ey - s->pivot[k].ls * ex;
    }

    // a point touches the last link beyond its end
    double lever = 0;
    if (s->wall->kind == WALL_POINT) {
        lever = s->along_x * (s->wall->x - x) + s->along_y * (s->wall->y - y) -
                s->link[last].length;
    }
    s->jacobian[s->first + last] = lever + p->lc * ey - p->ls * ex;
    if (s->stuck) {
        s->jacobian[0] = 0;
    }
}

// What the links beyond a joint answer, by the numbers P, p and tau of stiff_step.h, and
// their weight [N].
typedef struct links_beyond {
    complex_lanes pxx, pxy, pyy, px, py, tau;
    double weight;
} links_beyond;

// What the tip carries, and what slips along the wall with it.
KERNEL links_beyond factor_tip(const stiff_step *s, complex_lanes g)
{
    const complex_lanes mass = number(s->tip_mass), slip = scaled(s->slip_damping, g);
    return (links_beyond){
        .pxx = plus(mass, scaled(s->along_x * s->along_x, slip)),
        .pxy = plus(number(0), scaled(s->along_x * s->along_y, slip)),
        .pyy = plus(mass, scaled(s->along_y * s->along_y, slip)),
        .px = number(0),
        .py = number(0),
        .tau = number(0),
        .weight = s->tip.weight,
    };
}

// The row of link k, and what it shows with those beyond to the link before.
KERNEL void factor_link(stiff_step *s, int k, complex_lanes g, complex_lanes g2,
                        links_beyond *b)
{
    const stiff_link *l = &s->link[k];
    const stiff_stage *at = &s->stage[s->first + k];
    stiff_pivot *p = &s->pivot[k];
    const bool has_joint = s->first + k > 0;
    const double lc = l->length * s->body[k].c[HALF][LANE];
    const double ls = l->length * s->body[k].s[HALF][LANE];
    const double square = 0.25 * l->length * l->length;

    // its mass, and the drag of a link at rest, which counts as a mass of g times its
    // coefficients
    link_force on_link = {0};
    add_link_forces(&l->forces, s->amount, &(link_motion){0}, &on_link);
    complex_lanes mass = number(l->mass), own = number(l->inertia + l->mass * square);
    if (on_link.by_speed != 0) {
        mass = plus(mass, scaled(on_link.by_speed, g));
        own = plus(own, scaled(on_link.by_turn + on_link.by_speed * square, g));
    }
    own = plus(own, scaled(weight_by_angle(&l->forces, b->weight, ls), g2));
    b->weight += l->forces.weight;

    // with the links beyond: u and d
    const complex_lanes ptx = minus(scaled(lc, b->pxy), scaled(ls, b->pxx));
    const complex_lanes pty = minus(scaled(lc, b->pyy), scaled(ls, b->pxy));
    complex_lanes d = plus(minus(scaled(lc, pty), scaled(ls, ptx)), plus(b->tau, own));
    d = plus(d, minus(scaled(2 * lc, b->py), scaled(2 * ls, b->px)));
    const complex_lanes ux = minus(plus(ptx, b->px), scaled(0.5 * ls, mass));
    const complex_lanes uy = plus(plus(pty, b->py), scaled(0.5 * lc, mass));

    // the joint before it, and the pivot
    complex_lanes kappa = number(0);
    double joint_damping = 0;
    if (has_joint) {
        const joint_force joint =
            joint_forces(&l->forces, s->amount, at->q[HALF] - at[-1].q[HALF],
                         at->w[HALF] - at[-1].w[HALF]);
        joint_damping = joint.by_rate[LANE];
        kappa = plus(scaled(joint.by_bend[LANE], g2), scaled(joint_damping, g));
    }
    const complex_lanes inv = inverse(plus(d, kappa)), share = times(kappa, inv);
    *p = (stiff_pivot){.ux = ux,
                       .uy = uy,
                       .inverse = inv,
                       .kappa = kappa,
                       .share = share,
                       .lc = lc,
                       .ls = ls,
                       .joint_damping = joint_damping,
                       .drag = on_link.by_speed,
                       .turning = on_link.by_turn};

    // a first link without a joint is the hub's own
    if (!has_joint) {
        b->tau = d;
        return;
    }
    b->pxx = plus(minus(b->pxx, times(ux, times(ux, inv))), mass);
    b->pxy = minus(b->pxy, times(ux, times(uy, inv)));
    b->pyy = plus(minus(b->pyy, times(uy, times(uy, inv))), mass);
    b->px = times(ux, share);
    b->py = times(uy, share);
    b->tau = times(share, d);
}

// The links' rows, from the tip inwards; what they show to the hub, tau of stiff_step.h.
KERNEL complex_lanes factor_links(stiff_step *s, complex_lanes g, complex_lanes g2)
{
    links_beyond b = factor_tip(s, g);
    for (int k = s->links - 1; k >= 0; k--) {
        factor_link(s, k, g, g2, &b);
    }
    return b.tau;
}

// The hub, whose back EMF works through the current.
KERNEL void factor_hub(stiff_step *s, complex_lanes g, complex_lanes g2,
                       complex_lanes tau)
{
    hub_force f = {0};
    add_hub_forces(s->motor, s->stage[0].w[HALF], s->current.half[HALF], &f);
    s->hub_damping = f.by_rate;

    // the current answers the hub's rate at once, through its inductance, or not at all
    const double back_emf = -f.by_current * s->motor->back_emf;
    complex_lanes hub = plus(tau, plus(number(s->hub_inertia), scaled(f.by_rate, g)));
    if (s->drive == STIFF_FOLLOWS) {
        s->hub_damping += back_emf / s->motor->resistance;
        hub = plus(hub, scaled(back_emf / s->motor->resistance, g));
    } else if (s->drive == STIFF_FLOWS) {
        const complex_lanes slows =
            plus(number(s->motor->inductance), scaled(s->motor->resistance, g));
        hub = plus(hub, scaled(back_emf, times(g2, inverse(slows))));
    }
    s->hub_inverse = s->stuck ? number(0) : inverse(hub);
    if (s->first == 0) {
        s->pivot[0].inverse = s->hub_inverse;
    }
}

// The borders' answers and their equations, the contact's last; eliminated in that order.
KERNEL void factor_borders(stiff_step *s, complex_lanes g)
{
    const int count = stiff_borders(s);
    if (s->contact != STIFF_FREE) {
        find_jacobian(s);
    }
    for (int b = 0; b < count; b++) {
        const double *row = stiff_border_row(s, b);
        for (int k = 0; k < s->dof; k++) {
            s->border[b][k] = number(-row[k]);
        }
        solve_unbordered(s, s->border[b]);
    }

    // what each border's equation takes of every border's answer
    for (int i = 0; i < count; i++) {
        complex_lanes by = g;
        double own = 1;
        if (i == s->modes && s->contact == STIFF_GIVES) {
            by = s->press;
        } else if (i == s->modes) {
            by = number(-1);
            own = 0;
        }
        for (int j = 0; j < count; j++) {
            const complex_lanes sum =
                row_product(s, stiff_border_row(s, i), s->border[j]);
            s->corner[i][j] = minus(number(i == j ? own : 0), times(by, sum));
        }
    }
    for (int p = 0; p < count; p++) {
        s->corner[p][p] = inverse(s->corner[p][p]);
        for (int i = p + 1; i < count; i++) {
            s->corner[i][p] = times(s->corner[i][p], s->corner[p][p]);
            for (int j = p + 1; j < count; j++) {
                s->corner[i][j] =
                    minus(s->corner[i][j], times(s->corner[i][p], s->corner[p][j]));
            }
        }
    }
}

static void factor(stiff_step *s)
{
    const complex_lanes g = s->g, g2 = times(g, g);
    factor_wall(s, g, g2);
    factor_hub(s, g, g2, factor_links(s, g, g2));
    factor_borders(s, g);
}

// y of the right side that stands there, with its borders.
static void solve_bordered(stiff_step *s, const complex_lanes *target)
{
    const int count = stiff_borders(s);
    complex_lanes *x = s->unknown;
    solve_unbordered(s, s->y);

    // right sides of the borders' equations
    for (int i = 0; i < count; i++) {
        const complex_lanes sum = row_product(s, stiff_border_row(s, i), s->y);
        if (i < s->modes) {
            x[i] = times(s->g, sum);
        } else if (s->contact == STIFF_GIVES) {
            x[i] = plus(*target, times(s->press, sum));
        } else {
            x[i] = minus(*target, sum);
        }
    }

    // their unknowns, by the factors that factor_borders left
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

    // what they make of the bodies
    for (int i = 0; i < count; i++) {
        for (int k = 0; k < s->dof; k++) {
            s->y[k] = plus(s->y[k], times(x[i], s->border[i][k]));
        }
    }
}

// --- an iteration ----------------------------------------------------------------------

// Radau's embedded sums of the stages, x of velocities and v of accelerations.
static void differences(const stiff_step *s, double *x, double *v)
{
    const lanes low = lanes_at(radau_difference), high = lanes_at(radau_difference + 4);
    for (int k = 0; k < s->dof; k++) {
        const stiff_stage *g = &s->stage[k];
        const lanes w = low * g->w[0] + high * g->w[1],
                    a = low * g->a[0] + high * g->a[1];
        x[k] = radau_start * s->w0[k] + ((w[0] + w[2]) + (w[1] + w[3]));
        v[k] = radau_start * s->a0[k] + ((a[0] + a[2]) + (a[1] + a[3]));
    }
}

static double correct(stiff_step *s)
{
    for (int k = 0; k < s->dof; k++) {
        s->y[k] = scaled(-1, to_systems(s->stage[k].r));
    }
    complex_lanes target = number(0);
    if (s->contact == STIFF_RIGID) {
        target = times(to_systems(s->rate.half), inverse(s->g));
    }
    solve_bordered(s, &target);
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

const stiff_loops LOOPS = {predict_stages, residual, factor, differences, correct};
