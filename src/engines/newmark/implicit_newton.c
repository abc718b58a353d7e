#include "src/engines/newmark/implicit_newton.h"

#include "src/arm/forces.h"
#include "src/base/sincos.h"

// Computes the accelerations of the links' centres and the forces between the links for
// an iterate's velocities and accelerations; (fx, fy) is the contact force on the tip.
static void forces_between_links(const arm *a, implicit_sweep *link, const double *w,
                                 const double *acceleration, double fx, double fy)
{
    const double l = a->link_length, m = a->link_mass;

    // accelerations from hub to tip; weight acts as an acceleration of the hub upwards
    double ax = 0, ay = a->amount.gravity;
    for (int k = 0; k < a->links; k++) {
        double al = acceleration[a->first + k], w2 = w[a->first + k] * w[a->first + k];
        double dx = -l * (link[k].s * al + link[k].c * w2);
        double dy = l * (link[k].c * al - link[k].s * w2);
        link[k].com_x = ax + dx / 2;
        link[k].com_y = ay + dy / 2;
        ax += dx;
        ay += dy;
    }

    // the forces that they need, from tip to hub
    fx += a->tip_mass * ax;
    fy += a->tip_mass * ay;
    for (int k = a->links - 1; k >= 0; k--) {
        link[k].force_x = fx;
        link[k].force_y = fy;
        fx += m * link[k].com_x;
        fy += m * link[k].com_y;
    }
}

// How the wall acts on the last link: direction and lever of its force, penetration, and
// whether the direction turns with the link (1 for a point wall, where its derivative by
// the link's angle is -(c, s), else 0).
typedef struct contact_point {
    double ex, ey, lever, g, turns_with_link;
} contact_point;

// Computes that from the directions of the links in `link`.
static contact_point contact_at(const arm *a, const implicit_sweep *link)
{
    const double l = a->link_length;
    const implicit_sweep *end = &link[a->links - 1];
    double x = 0, y = 0;
    for (int k = 0; k < a->links - 1; k++) {
        x += l * link[k].c;
        y += l * link[k].s;
    }
    wall_contact at = wall_contact_at(&a->wall, l, x, y, 0, 0, end->c, end->s, 0);
    return (contact_point){at.ex, at.ey, at.lever, at.penetration,
                           a->wall.kind == WALL_POINT};
}

// J v, the rate of the penetration at velocities v, from the directions in `link`.
static double rate_along(const arm *a, const implicit_sweep *link, contact_point p,
                         const double *v)
{
    double sum = 0, l = a->link_length;
    for (int k = 0; k < a->links; k++) {
        sum += l * (link[k].c * p.ey - link[k].s * p.ex) * v[a->first + k];
    }
    return sum + p.lever * v[a->dof - 1];
}

// How much the rate of the penetration, J w, changes with the angles by dq and with the
// velocities by gamma dq, from the directions in `link`.
static double rate_change(const arm *a, const implicit_sweep *link, contact_point p,
                          const double *w, double gamma, const double *dq)
{
    const double l = a->link_length, *v = w + a->first, *x = dq + a->first;
    const implicit_sweep *end = &link[a->links - 1];
    const int last = a->links - 1;
    double sum = gamma * rate_along(a, link, p, dq);
    if (a->wall.kind == WALL_PLANE) {
        for (int k = 0; k <= last; k++) {
            sum -= l * (link[k].c * p.ex + link[k].s * p.ey) * v[k] * x[k];
        }
        return sum;
    }

    // dg/dt = s w + t'v_base with s = r'd, see wall.h
    // along = r'v_base, to which link k brings l sin(q_N - q_k) times its velocity
    double along = 0;
    for (int k = 0; k < last; k++) {
        const double sine = end->s * link[k].c - end->c * link[k].s;
        along += l * sine * v[k];
        sum += l * (-sine * v[last] + sine * v[k]) * x[k];
    }
    return sum + (-p.g * v[last] - along) * x[last];
}

// How the links beyond a node, whose angles have been eliminated, react to changes of the
// node's acceleration and of the angle before it (implicit_newton.h).
typedef struct beyond {
    double pxx, pxy, pyx, pyy; // P, not symmetric
    double hx, hy;             // p_f
    double gx, gy, yy;         // p_t and y of the joint beyond
    double fx, fy, torque0;    // F0, T0 of the residual
    double ex, ey, torque1;    // and of a unit contact force
    double outer;              // torque of the joint beyond
} beyond;

// Adds the rigid hub, which turns with the first link, to that link's equation: to the
// slope `pivot` and the right side. A stuck hub does not turn; it->excess gets the torque
// that friction has to hold.
static void add_hub(const arm *a, implicit_iterate *it, implicit_tangent t,
                    double residual, double *pivot, double *right, double *right1)
{
    const double alpha = it->acceleration[0], omega = it->w[0];
    *pivot += a->hub_inertia * t.beta + a->motor.damping * t.gamma;
    *right -=
        a->hub_inertia * alpha + a->motor.damping * omega - a->motor.torque - it->sliding;
    if (it->stuck) {
        it->excess = -residual - a->hub_inertia * alpha - a->motor.damping * omega +
                     a->motor.torque;
        *right = *right1 = 0;
    }
}

// Turns *b into what link k and those beyond show to the link before. L gives the angle
// of link k; (px, py) is the derivative of the force on its base by that angle, kappa
// that of its joint's torque.
static inline __attribute__((always_inline)) void show_before(const implicit_sweep *L,
                                                              double mass, double px,
                                                              double py, double kappa,
                                                              beyond *b)
{
    b->pxx += mass - px * L->vx;
    b->pxy -= px * L->vy;
    b->pyx -= py * L->vx;
    b->pyy += mass - py * L->vy;
    b->hx = px * L->to_parent;
    b->hy = py * L->to_parent;
    b->fx += px * L->free;
    b->fy += py * L->free;
    b->ex += px * L->unit;
    b->ey += py * L->unit;
    b->gx = -kappa * L->vx;
    b->gy = -kappa * L->vy;
    b->yy = kappa * L->to_parent - kappa;
    b->torque0 = kappa * L->free;
    b->torque1 = kappa * L->unit;
}

// Eliminates the change of link k's angle, tip to hub: the balance of torques about the
// link's node gives it as a function of the node's acceleration and of the change of the
// angle before. *b becomes what link k and those beyond show to the link before.
static inline __attribute__((always_inline)) void
eliminate_tangent(const arm *a, implicit_sweep *link, int k, implicit_iterate *it,
                  implicit_tangent t, double lever, beyond *b)
{
    const double l = a->link_length, m = a->link_mass, half = 0.5 * l;
    const double *q = it->q, *w = it->w;
    const int first = a->first;
    implicit_sweep *L = &link[k];
    const double c = L->c, s = L->s, omega = w[first + k],
                 alpha = it->acceleration[first + k];

    // how the node's acceleration changes with the link's angle
    const double across = t.beta - omega * omega, along = alpha + 2 * t.gamma * omega;
    L->zx = -s * across - c * along;
    L->zy = c * across - s * along;

    // the joint's torque, and what it changes with
    double kappa = 0, inner = 0;
    if (first + k > 0) {
        const force_constants constants = force_constants_of(a, k);
        const joint_force joint =
            joint_forces(&constants, &a->amount, q[first + k] - q[first + k - 1],
                         omega - w[first + k - 1]);
        kappa = joint.by_bend + joint.by_rate * t.gamma;
        inner = joint.torque;
    }

    // the balance of torques: residual, and its slope by the angle
    double residual = a->link_inertia * alpha + half * m * (c * L->com_y - s * L->com_x) +
                      l * (c * L->force_y - s * L->force_x) - b->outer + inner;
    residual += it->force * lever;
    const double zpx = b->pxx * L->zx + b->pxy * L->zy; // P z
    const double zpy = b->pyx * L->zx + b->pyy * L->zy;
    double pivot = a->link_inertia * t.beta - half * m * (c * L->com_x + s * L->com_y) -
                   l * (c * L->force_x + s * L->force_y) +
                   half * half * m * (c * L->zy - s * L->zx) +
                   l * (c * (l * zpy + b->hy) - s * (l * zpx + b->hx)) -
                   (l * (b->gx * L->zx + b->gy * L->zy) + b->yy) + kappa;
    const double vx = -half * m * s + l * (c * b->pyx - s * b->pxx) - b->gx;
    const double vy = half * m * c + l * (c * b->pyy - s * b->pxy) - b->gy;
    double right = -residual - l * (c * b->fy - s * b->fx) + b->torque0;
    double right1 = -lever - l * (c * b->ey - s * b->ex) + b->torque1;
    if (first + k == 0) {
        add_hub(a, it, t, residual, &pivot, &right, &right1);
    }

    // the angle as a function of what comes before the link
    L->vx = vx / pivot;
    L->vy = vy / pivot;
    L->to_parent = kappa / pivot;
    L->free = right / pivot;
    L->unit = right1 / pivot;

    // the force on the base by the angle, of this link and all beyond it
    const double px = m * half * L->zx + l * zpx + b->hx;
    const double py = m * half * L->zy + l * zpy + b->hy;
    show_before(L, m, px, py, kappa, b);
    b->outer = inner;
}

// Computes the changes of all angles from hub to tip: dq by the residual, `unit` by a
// unit contact force.
static void substitute_tangent(const arm *a, const implicit_sweep *link, bool stuck,
                               double *dq, double *unit)
{
    double ax = 0, ay = 0, bx = 0, by = 0;
    for (int k = 0; k < a->links; k++) {
        const implicit_sweep *L = &link[k];
        const int i = a->first + k;
        double parent = 0, parent1 = 0;
        if (i > 0) {
            parent = dq[i - 1];
            parent1 = unit[i - 1];
        }

        double d = L->free - L->vx * ax - L->vy * ay + L->to_parent * parent;
        double d1 = L->unit - L->vx * bx - L->vy * by + L->to_parent * parent1;
        if (i == 0 && stuck) { // a stuck hub stays
            d = d1 = 0;
        }
        dq[i] = d;
        unit[i] = d1;
        ax += a->link_length * L->zx * d;
        ay += a->link_length * L->zy * d;
        bx += a->link_length * L->zx * d1;
        by += a->link_length * L->zy * d1;
    }
}

double implicit_correction(const arm *a, implicit_sweep *link, implicit_iterate *it,
                           implicit_tangent t, double *dq, double *unit)
{
    const int last = a->links - 1;
    const double *w = it->w;

    // directions, contact and forces of the iterate
    contact_point point = {0};
    for (int k = 0; k <= last; k++) {
        inline_sincos(it->q[a->first + k], &link[k].s, &link[k].c);
    }
    if (it->contact) {
        point = contact_at(a, link);
    }
    forces_between_links(a, link, w, it->acceleration, it->force * point.ex,
                         it->force * point.ey);

    // elimination from tip to hub; a point wall's force turns with the last link
    beyond b = {.pxx = a->tip_mass, .pyy = a->tip_mass, .ex = point.ex, .ey = point.ey};
    b.hx = -it->force * point.turns_with_link * link[last].c;
    b.hy = -it->force * point.turns_with_link * link[last].s;
    for (int k = last; k >= 0; k--) {
        eliminate_tangent(a, link, k, it, t, k == last ? point.lever : 0, &b);
    }

    // the hub on its spring
    dq[0] = unit[0] = 0;
    if (a->hub_spring && it->stuck) {
        it->excess = a->motor.torque + b.outer;
    } else if (a->hub_spring) {
        const double pivot = a->hub_inertia * t.beta + a->motor.damping * t.gamma - b.yy;
        const double residual = a->hub_inertia * it->acceleration[0] +
                                a->motor.damping * w[0] - a->motor.torque - it->sliding -
                                b.outer;
        dq[0] = (b.torque0 - residual) / pivot;
        unit[0] = b.torque1 / pivot;
    }
    substitute_tangent(a, link, it->stuck, dq, unit);
    if (!it->contact) {
        return 0;
    }

    // the change df of the force with which the changed angles meet the constraint
    double df;
    if (it->velocity_level) {
        const double rate = rate_along(a, link, point, w);
        df = -(rate + rate_change(a, link, point, w, t.gamma, dq)) /
             rate_change(a, link, point, w, t.gamma, unit);
    } else {
        df = -(point.g + rate_along(a, link, point, dq)) /
             rate_along(a, link, point, unit);
    }
    for (int i = 0; i < a->dof; i++) {
        dq[i] += df * unit[i];
    }
    return df;
}
