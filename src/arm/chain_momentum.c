#include "src/arm/chain_momentum.h"

#include <math.h>

#include "src/base/sincos.h"

void chain_momentum(const arm *a, const double *q, const double *w, double *p)
{
    const double l = a->link_length, m = a->link_mass;
    const double *theta = q + a->first, *omega = w + a->first;

    // from the hub: velocities of the links' ends; from the tip: what the links beyond carry
    double vx = 0, vy = 0;
    for (int k = 0; k < a->links; k++) {
        double s, c;
        inline_sincos(theta[k], &s, &c);
        vx -= l * s * omega[k];
        vy += l * c * omega[k];
    }
    double px = 0, py = 0;
    for (int k = a->links - 1; k >= 0; k--) {
        double s, c;
        inline_sincos(theta[k], &s, &c);
        const double dx = -l * s * omega[k], dy = l * c * omega[k];
        const double mx = m * (vx - dx / 2), my = m * (vy - dy / 2); // of the link itself
        const double ax = l * (px + mx / 2), ay = l * (py + my / 2);
        p[a->first + k] = c * ay - s * ax + a->link_inertia * omega[k];
        px += mx;
        py += my;
        vx -= dx;
        vy -= dy;
    }
    p[0] = (a->first > 0 ? 0 : p[0]) + a->hub_inertia * w[0];
}

// dT/dq and J'^T L at velocities w, the links' directions standing in `link`.
static void momentum_rate(const arm *a, const chain_link *link, const wall_contact *wall,
                          double impulse, double vx, double vy, const double *w, double *rate)
{
    const double l = a->link_length, m = a->link_mass;
    const double *omega = w + a->first;
    const int last = a->links - 1;
    const bool moves = a->wall.kind == WALL_POINT; // the force's direction turns with the last link
    const double base_x = vx, base_y = vy;
    double px = 0, py = 0;
    double ex = vx - l * link[last].s * omega[last], ey = vy + l * link[last].c * omega[last];

    // from the tip inwards: px, py is the momentum of the links beyond, ex, ey the end's velocity
    for (int k = last; k >= 0; k--) {
        const double c = link[k].c, s = link[k].s;
        const double dx = -l * s * omega[k], dy = l * c * omega[k];
        const double mx = m * (ex - dx / 2), my = m * (ey - dy / 2);
        double sum = -omega[k] * (c * l * (px + mx / 2) + s * l * (py + my / 2));

        // the impulse's share, at a point with a direction that turns
        if (impulse != 0 && (k < last || !moves)) {
            double turn = -l * omega[k] * (c * wall->ex + s * wall->ey);
            if (moves) { // e = t_N, e' = -w_N r_N
                turn -= l * omega[last] * (-s * link[last].c + c * link[last].s);
            }
            sum += impulse * turn;
        } else if (impulse != 0) {
            // the point's distance along the last link
            sum += impulse * (-wall->penetration * omega[last] -
                              (link[last].c * base_x + link[last].s * base_y));
        }

        // on to the link before
        rate[a->first + k] = sum;
        px += mx;
        py += my;
        ex -= dx;
        ey -= dy;
    }

    // the energy of motion does not depend on the angle of a hub of its own
    if (a->first > 0) {
        rate[0] = 0;
    }
}

void chain_from_momentum(const arm *a, chain_link *link, contact_state mode, const double *q,
                         const double *momentum, double *w, double *rate, double *impulse)
{
    const double l = a->link_length, m = a->link_mass, half = 0.5 * l;
    const double *theta = q + a->first, *p = momentum + a->first;
    const int last = a->links - 1;
    const bool stuck = mode.friction == HUB_STICK;

    // directions, and the wall's geometry
    double x = 0, y = 0;
    for (int k = 0; k <= last; k++) {
        inline_sincos(theta[k], &link[k].s, &link[k].c);
        if (k < last) {
            x += l * link[k].c;
            y += l * link[k].s;
        }
    }
    wall_contact wall = {0};
    if (mode.contact) {
        wall = wall_contact_at(&a->wall, l, x, y, 0, 0, link[last].c, link[last].s, 0);
    }

    // tip to hub
    double pxx = 0, pxy = 0, pyy = 0, fx = 0, fy = 0, gx = wall.ex, gy = wall.ey;
    for (int k = last; k >= 0; k--) {
        const double c = link[k].c, s = link[k].s;
        const double ptx = -pxx * s + pxy * c, pty = -pxy * s + pyy * c;
        const double ux = l * ptx - m * half * s, uy = l * pty + m * half * c;
        double d = a->link_inertia + m * half * half + l * l * (c * pty - s * ptx);
        double moment = p[k] - l * (c * fy - s * fx);
        double moment1 = -l * (c * gy - s * gx) - (k == last ? wall.lever : 0);
        if (k == 0 && !a->hub_spring) {
            d += a->hub_inertia;
            moment = stuck ? 0 : moment;
            moment1 = stuck ? 0 : moment1;
        }
        const double inv_d = 1 / d;
        link[k].inv_d = inv_d;
        link[k].ux = ux;
        link[k].uy = uy;
        link[k].free = moment * inv_d;
        link[k].unit = moment1 * inv_d;
        fx += ux * link[k].free;
        fy += uy * link[k].free;
        gx += ux * link[k].unit;
        gy += uy * link[k].unit;
        pxx += m - ux * ux * inv_d;
        pxy -= ux * uy * inv_d;
        pyy += m - uy * uy * inv_d;
    }

    // hub to tip, and the impulse that keeps the contact
    double *omega = w + a->first, vx = 0, vy = 0, bx = 0, by = 0;
    for (int k = 0; k <= last; k++) {
        const double c = link[k].c, s = link[k].s;
        omega[k] = link[k].free - (link[k].ux * vx + link[k].uy * vy) * link[k].inv_d;
        link[k].unit -= (link[k].ux * bx + link[k].uy * by) * link[k].inv_d;
        if (k < last) {
            vx -= l * s * omega[k];
            vy += l * c * omega[k];
            bx -= l * s * link[k].unit;
            by += l * c * link[k].unit;
        }
    }
    *impulse = 0;
    if (mode.contact) {
        const double lever = wall_last_lever(&wall, l, link[last].c, link[last].s);
        *impulse = -wall_penetration_rate(&wall, vx, vy, lever, omega[last]) /
                   wall_penetration_rate(&wall, bx, by, lever, link[last].unit);
        for (int k = 0; k <= last; k++) {
            omega[k] += *impulse * link[k].unit;
        }
        vx += *impulse * bx;
        vy += *impulse * by;
    }
    if (a->first > 0) {
        w[0] = stuck ? 0 : momentum[0] / a->hub_inertia;
    }
    momentum_rate(a, link, &wall, *impulse, vx, vy, w, rate);
}
