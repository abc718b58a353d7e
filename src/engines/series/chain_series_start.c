#include "src/base/sincos.h"
#include "src/engines/series/chain_series_parts.h"

void chain_series_prepare_sweep(chain_series *s, const arm *a)
{
    chain_rows *r = &s->rows;
    const double t = s->length;
    double pxx = a->tip_mass, pxy = 0, pyy = a->tip_mass;
    for (int k = s->links - 1; k >= 0; k--) {
        const size_t at = chain_place(r, k);
        const bool joint = k + 1 < s->links; // beyond it
        const double l = arm_link_length(a, k), m = arm_link_mass(a, k);
        const double own = arm_link_inertia(a, k) + m * l * l / 4;
        r->length[at] = l;
        r->half[at] = l / 2;
        r->stiffness[at] = joint ? t * t * arm_joint_stiffness(a, k + 1) : 0;
        r->damping[at] = joint ? t * arm_joint_damping(a, k + 1) : 0;
        r->air[at] = t * a->air_drag * l;
        r->air_turning[at] = r->air[at] * l * l / 12;

        // what it and those beyond show at its base
        const double c = r->start_c[at], sn = r->start_s[at];
        const double ptx = -pxx * sn + pxy * c, pty = -pxy * sn + pyy * c; // P t
        const double ux = l * ptx - m * l / 2 * sn, uy = l * pty + m * l / 2 * c;
        double d = own + l * l * (c * pty - sn * ptx);
        d += k == 0 && !a->hub_spring ? a->hub_inertia : 0;
        const bool held = k == 0 && !a->hub_spring && s->mode.friction == HUB_STICK && !s->pinned;
        const double inv_d = held ? 0 : 1 / d, vx = -l * sn, vy = l * c;

        // what rho does here: l^2 P t + m l^2/4 t, and l P + m l/2
        r->back_x[at] = l * l * ptx - m * l * l / 4 * sn;
        r->back_y[at] = l * l * pty + m * l * l / 4 * c;
        r->rho_xx[at] = l * pxx + m * l / 2;
        r->rho_xy[at] = l * pxy;
        r->rho_yy[at] = l * pyy + m * l / 2;

        // on to the link before
        r->ux[at] = ux;
        r->uy[at] = uy;
        r->inv_d[at] = inv_d;
        r->vx[at] = vx;
        r->vy[at] = vy;
        r->matrix[0][at] = 1 - inv_d * ux * vx;
        r->matrix[1][at] = -inv_d * ux * vy;
        r->matrix[2][at] = -inv_d * uy * vx;
        r->matrix[3][at] = 1 - inv_d * uy * vy;
        r->pxx[at] = pxx += m - ux * ux * inv_d;
        r->pxy[at] = pxy -= ux * uy * inv_d;
        r->pyy[at] = pyy += m - uy * uy * inv_d;
    }
}

void chain_series_prepare_contact(chain_series *s, const arm *a)
{
    chain_rows *r = &s->rows;
    const int last = s->links - 1;
    const bool point = a->wall.kind == WALL_POINT;
    const double ex = point ? -r->start_s[s->last_place] : -a->wall.sine;
    const double ey = point ? r->start_c[s->last_place] : a->wall.cosine;
    double qx = point ? 0 : ex, qy = point ? 0 : ey;

    // tip to hub
    for (int k = last; k >= 0; k--) {
        const size_t at = chain_place(r, k);
        double moment = -(r->vx[at] * qx + r->vy[at] * qy);
        if (k == last && point) {
            moment = -s->along.term[0];
            qx = ex;
            qy = ey;
        }
        r->unit[at] = moment * r->inv_d[at];
        qx += r->ux[at] * r->unit[at];
        qy += r->uy[at] * r->unit[at];
        r->unit_fx[at] = qx;
        r->unit_fy[at] = qy;
    }

    // hub to tip
    double bx = 0, by = 0;
    for (int k = 0; k <= last; k++) {
        const size_t at = chain_place(r, k);
        r->unit[at] -= (r->ux[at] * bx + r->uy[at] * by) * r->inv_d[at];
        s->unit_x[at] = bx;
        s->unit_y[at] = by;
        r->unit_fx[at] += r->pxx[at] * bx + r->pxy[at] * by;
        r->unit_fy[at] += r->pxy[at] * bx + r->pyy[at] * by;
        bx += r->vx[at] * r->unit[at];
        by += r->vy[at] * r->unit[at];
    }
    const size_t end = s->last_place;
    s->response = point
                      ? ex * s->unit_x[end] + ey * s->unit_y[end] + s->along.term[0] * r->unit[end]
                      : ex * bx + ey * by;
}

void chain_series_take_state(chain_series *s, const arm *a, const double *q, const double *w)
{
    chain_rows *r = &s->rows;
    for (int k = 0; k < s->links; k++) {
        const size_t at = chain_place(r, k), zeroth = chain_term(0, at), first = chain_term(1, at);
        const double rate = s->length * w[a->first + k];
        double sn, c;
        inline_sincos(q[a->first + k], &sn, &c);
        r->angle[zeroth] = q[a->first + k];
        r->angle[first] = r->rate[zeroth] = rate;
        r->cosine[zeroth] = r->start_c[at] = c;
        r->sine[zeroth] = r->start_s[at] = sn;
        r->cosine[first] = -sn * rate;
        r->sine[first] = c * rate;
    }
    s->hub_angle.term[0] = q[0];
    s->hub_angle.term[1] = s->hub_rate.term[0] = s->length * w[0];
}
