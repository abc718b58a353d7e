#include "src/engines/newmark/implicit_newton.h"

#include "src/base/sincos.h"

// Residual quantities of the iterate: forces between the links and node accelerations.
static void forces_between_links(const arm *a, implicit_sweep *link, const double *w,
                                 const double *acceleration, double fx, double fy)
{
    const double l = a->link_length, m = a->link_mass;
    double ax = 0, ay = a->gravity; // what weight would take

    // accelerations from hub to tip, then the forces that they need from tip to hub
    for (int k = 0; k < a->links; k++) {
        double al = acceleration[a->first + k], w2 = w[a->first + k] * w[a->first + k];
        double dx = -l * (link[k].s * al + link[k].c * w2);
        double dy = l * (link[k].c * al - link[k].s * w2);
        link[k].com_x = ax + dx / 2;
        link[k].com_y = ay + dy / 2;
        ax += dx;
        ay += dy;
    }
    fx += a->tip_mass * ax;
    fy += a->tip_mass * ay;

    for (int k = a->links - 1; k >= 0; k--) {
        link[k].force_x = fx;
        link[k].force_y = fy;
        fx += m * link[k].com_x;
        fy += m * link[k].com_y;
    }
}

// Penetration, and how the wall acts at q: direction, lever.
typedef struct contact_point {
    double ex, ey, lever, g, angle_force; // angle_force: e' = -r of a point wall, see below
} contact_point;

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
    return (contact_point){at.ex, at.ey, at.lever, at.penetration, a->wall.kind == WALL_POINT};
}

// J v from the directions in `link`.
static double rate_along(const arm *a, const implicit_sweep *link, contact_point p, const double *v)
{
    double sum = 0, l = a->link_length;
    for (int k = 0; k < a->links; k++) {
        sum += l * (link[k].c * p.ey - link[k].s * p.ex) * v[a->first + k];
    }
    return sum + p.lever * v[a->dof - 1];
}

// d(dg/dt)/dq . dq from the directions in `link`, dw = gamma' dq, at velocities w.
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
    double along = 0; // r'v_base
    for (int k = 0; k < last; k++) {
        double sine = end->s * link[k].c - end->c * link[k].s; // r'(l t_k) = l sin(q_N - q_k)
        along += l * sine * v[k];
        sum += l * (-sine * v[last] + sine * v[k]) * x[k];
    }
    return sum + (-p.g * v[last] - along) * x[last];
}

// One function, since its sweeps share what they keep in registers.
double implicit_correction(const arm *a, implicit_sweep *link, implicit_iterate *it,
                           implicit_tangent t, double *dq, double *unit)
{
    const double l = a->link_length, m = a->link_mass, half = 0.5 * l;
    const double *q = it->q, *w = it->w, *al = it->acceleration;
    const int first = a->first, last = a->links - 1;
    contact_point point = {0};

    // residual quantities of the iterate
    for (int k = 0; k <= last; k++) {
        inline_sincos(q[first + k], &link[k].s, &link[k].c);
    }
    if (it->contact) {
        point = contact_at(a, link);
    }
    forces_between_links(a, link, w, al, it->force * point.ex, it->force * point.ey);

    // elimination from tip to hub
    double pxx = a->tip_mass, pxy = 0, pyx = 0, pyy = a->tip_mass; // P, no longer symmetric
    double hx = -it->force * point.angle_force * link[last].c; // p_f: the point wall's force turns
    double hy = -it->force * point.angle_force * link[last].s; // with the last link
    double gx = 0, gy = 0, yy = 0;                             // p_t and y of the joint beyond
    double fx = 0, fy = 0, torque0 = 0;                        // F0, T0 of the residual
    double ex = point.ex, ey = point.ey, torque1 = 0;          // and of a unit force
    double outer = 0;                                          // torque of the joint beyond
    for (int k = last; k >= 0; k--) {
        implicit_sweep *L = &link[k];
        double c = L->c, s = L->s, omega = w[first + k], alpha = al[first + k];

        // how the node's acceleration changes with the link's angle
        double across = t.beta - omega * omega, along = alpha + 2 * t.gamma * omega;
        L->zx = -s * across - c * along;
        L->zy = c * across - s * along;

        // the joint's torque, and what it changes with
        double kappa = 0, inner = 0;
        if (first + k > 0) {
            double stiffness = k > 0 ? a->joint_stiffness : a->hub_stiffness;
            double damping = k > 0 ? a->joint_damping : a->hub_joint_damping;
            kappa = stiffness + damping * t.gamma;
            inner = stiffness * (q[first + k] - q[first + k - 1]) +
                    damping * (omega - w[first + k - 1]);
        }

        // the link's balance of torques about its node: residual, and its slope by the angle
        double residual = a->link_inertia * alpha + half * m * (c * L->com_y - s * L->com_x) +
                          l * (c * L->force_y - s * L->force_x) - outer + inner;
        double lever_force = 0;
        if (k == last) {
            residual += it->force * point.lever;
            lever_force = point.lever;
        }
        double zpx = pxx * L->zx + pxy * L->zy, zpy = pyx * L->zx + pyy * L->zy; // P z
        double pivot = a->link_inertia * t.beta - half * m * (c * L->com_x + s * L->com_y) -
                       l * (c * L->force_x + s * L->force_y) +
                       half * half * m * (c * L->zy - s * L->zx) +
                       l * (c * (l * zpy + hy) - s * (l * zpx + hx)) -
                       (l * (gx * L->zx + gy * L->zy) + yy) + kappa;
        double vx = -half * m * s + l * (c * pyx - s * pxx) - gx;
        double vy = half * m * c + l * (c * pyy - s * pxy) - gy;
        double right = -residual - l * (c * fy - s * fx) + torque0;
        double right1 = -lever_force - l * (c * ey - s * ex) + torque1;
        if (first + k == 0) {
            // the first link turns with the hub
            pivot += a->hub_inertia * t.beta + a->motor.damping * t.gamma;
            right -=
                a->hub_inertia * alpha + a->motor.damping * omega - a->motor.torque - it->sliding;
            if (it->stuck) {
                it->excess =
                    -residual - a->hub_inertia * alpha - a->motor.damping * omega + a->motor.torque;
                right = right1 = 0;
            }
        }

        // the angle as a function of what comes before the link
        L->vx = vx / pivot;
        L->vy = vy / pivot;
        L->to_parent = kappa / pivot;
        L->free = right / pivot;
        L->unit = right1 / pivot;

        // the answer of this link and all beyond it
        double px = m * half * L->zx + l * zpx + hx, py = m * half * L->zy + l * zpy + hy;
        pxx += m - px * L->vx;
        pxy -= px * L->vy;
        pyx -= py * L->vx;
        pyy += m - py * L->vy;
        hx = px * L->to_parent;
        hy = py * L->to_parent;
        fx += px * L->free;
        fy += py * L->free;
        ex += px * L->unit;
        ey += py * L->unit;
        gx = -kappa * L->vx;
        gy = -kappa * L->vy;
        yy = kappa * L->to_parent - kappa;
        torque0 = kappa * L->free;
        torque1 = kappa * L->unit;
        outer = inner;
    }

    // the hub on its spring
    dq[0] = unit[0] = 0;
    if (a->hub_spring && it->stuck) {
        it->excess = a->motor.torque + outer;
    } else if (a->hub_spring) {
        double pivot = a->hub_inertia * t.beta + a->motor.damping * t.gamma - yy;
        double residual = a->hub_inertia * al[0] + a->motor.damping * w[0] - a->motor.torque -
                          it->sliding - outer;
        dq[0] = (torque0 - residual) / pivot;
        unit[0] = torque1 / pivot;
    }

    // substitution from hub to tip: dq for the residual, `unit` for a unit contact force
    double ax = 0, ay = 0, bx = 0, by = 0;
    for (int k = 0; k <= last; k++) {
        implicit_sweep *L = &link[k];
        double parent = first + k > 0 ? dq[first + k - 1] : 0;
        double parent1 = first + k > 0 ? unit[first + k - 1] : 0;
        bool fixed = first + k == 0 && it->stuck;

        // a stuck hub stays
        double d = fixed ? 0 : L->free - L->vx * ax - L->vy * ay + L->to_parent * parent;
        double d1 = fixed ? 0 : L->unit - L->vx * bx - L->vy * by + L->to_parent * parent1;
        dq[first + k] = d;
        unit[first + k] = d1;
        ax += l * L->zx * d;
        ay += l * L->zy * d;
        bx += l * L->zx * d1;
        by += l * L->zy * d1;
    }
    if (!it->contact) {
        return 0;
    }

    // the force that meets the constraint
    double df;
    if (it->velocity_level) {
        double rate = rate_along(a, link, point, w);
        df = -(rate + rate_change(a, link, point, w, t.gamma, dq)) /
             rate_change(a, link, point, w, t.gamma, unit);
    } else {
        df = -(point.g + rate_along(a, link, point, dq)) / rate_along(a, link, point, unit);
    }
    for (int i = 0; i < a->dof; i++) {
        dq[i] += df * unit[i];
    }
    return df;
}
