#include "src/arm/chain_momentum.h"

#include "src/base/sincos.h"

typedef double real;
typedef chain_link momentum_link;
#include "src/arm/chain_momentum_kernel.h"

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

void chain_from_momentum(const arm *a, chain_link *link, contact_state mode, const double *q,
                         const double *momentum, double *w, double *rate, double *impulse)
{
    const double l = a->link_length;
    const double *theta = q + a->first;
    const int last = a->links - 1;
    const bool stuck = mode.friction == HUB_STICK;

    // directions of the links, and where the last one begins
    double x = 0, y = 0;
    for (int k = 0; k <= last; k++) {
        inline_sincos(theta[k], &link[k].s, &link[k].c);
        if (k < last) {
            x += l * link[k].c;
            y += l * link[k].s;
        }
    }

    momentum_wall wall = {0};
    if (mode.contact) {
        const wall_contact at =
            wall_contact_at(&a->wall, l, x, y, 0, 0, link[last].c, link[last].s, 0);
        wall = (momentum_wall){at.ex, at.ey, at.lever, at.penetration};
        momentum_sweep(a, true, stuck, link, &wall, momentum, w, rate, impulse);
    } else {
        momentum_sweep(a, false, stuck, link, &wall, momentum, w, rate, impulse);
    }
}
