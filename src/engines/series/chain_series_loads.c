// What an arm may have beyond links and linear joints: joints that stiffen, damping by mode, air.
//
// Each adds to torques, moments and forces of an order what lower ones, or that order of angles and
// velocities, say: a joint's torque gains k s b^3 of its bend b; damping by mode g (g'(bend
// rates)); a link feels c l v of the velocity v of its middle and c l^3/12 w of its turning.
#include "src/engines/series/chain_series_parts.h"

// The n-th coefficients of a product of two arrays by coefficient and link, in block b.
static void block_product(const double *x, const double *y, int b, int n, double sum[SERIES_LANES])
{
    x += chain_term(0, (size_t)b * SERIES_LANES);
    y += chain_term(0, (size_t)b * SERIES_LANES);
    for (int j = 0; j < SERIES_LANES; j++) {
        sum[j] = 0;
    }
    for (int i = 0; i <= n; i++) {
        for (int j = 0; j < SERIES_LANES; j++) {
            sum[j] += x[i * SERIES_LANES + j] * y[(n - i) * SERIES_LANES + j];
        }
    }
}

static double product_term(const series_terms *x, const series_terms *y, int n)
{
    double sum = 0;
    for (int i = 0; i <= n; i++) {
        sum += x->term[i] * y->term[n - i];
    }
    return sum;
}

// What stiffening adds to the torques of the inner joints; returns what it adds to the root's.
static double stiffen(chain_series *s, const arm *a, int n)
{
    chain_rows *r = &s->rows;
    for (int k = 0; k + 1 < s->links; k++) {
        const size_t at = chain_term(n, chain_place(r, k));
        r->bend[at] = r->angle[chain_term(n, chain_place(r, k + 1))] - r->angle[at];
    }
    for (int b = 0; b < r->blocks; b++) {
        const size_t block = (size_t)b * SERIES_LANES;
        double square[SERIES_LANES], cube[SERIES_LANES];
        block_product(r->bend, r->bend, b, n, square);
        for (int j = 0; j < SERIES_LANES; j++) {
            r->bend_square[chain_term(n, block) + (size_t)j] = square[j];
        }
        block_product(r->bend, r->bend_square, b, n, cube);
        for (int j = 0; j < SERIES_LANES; j++) {
            r->torque[block + (size_t)j] +=
                a->stiffening * r->stiffness[block + (size_t)j] * cube[j];
        }
    }

    // a root is half a joint, as arm_stiffening_torque has it
    if (!a->root_bends) {
        return 0;
    }
    const double angle = r->angle[chain_term(n, s->first_place)];
    s->root_bend.term[n] = angle - s->hub_angle.term[n];
    s->root_square.term[n] = product_term(&s->root_bend, &s->root_bend, n);
    return s->length * s->length * arm_joint_stiffness(a, 0) * 4 * a->stiffening *
           product_term(&s->root_bend, &s->root_square, n);
}

// The same of damping by mode.
static double damp_modes(chain_series *s, const arm *a, int n)
{
    chain_rows *r = &s->rows;
    const double rate = r->rate[chain_term(n, s->first_place)];
    const double turn = a->hub_spring ? rate - s->hub_rate.term[n] : 0;
    double root = 0;
    for (int i = 0; i < a->damped_modes; i++) {
        const double *g = a->modal_damping[i];
        double sum = g[0] * turn;
        for (int k = 0; k + 1 < s->links; k++) {
            sum += g[k + 1] * r->bend_rate[chain_term(n, chain_place(r, k))];
        }
        s->mode_rate[i].term[n] = sum;

        // on all joints
        root += s->length * g[0] * sum;
        for (int k = 0; k + 1 < s->links; k++) {
            r->torque[chain_place(r, k)] += s->length * g[k + 1] * sum;
        }
    }
    return root;
}

double chain_series_load_joints(chain_series *s, const arm *a, int n)
{
    double root = 0;
    if (a->stiffening > 0) {
        root += stiffen(s, a, n);
    }
    if (a->damped_modes > 0) {
        root += damp_modes(s, a, n);
    }
    return root;
}

void chain_series_drag(chain_series *s, int n)
{
    chain_rows *r = &s->rows;
    double x = 0, y = 0; // velocity of the link's base
    for (int k = 0; k < s->links; k++) {
        const size_t at = chain_place(r, k), now = chain_term(n, at), next = chain_term(n + 1, at);
        const double half_x = r->half[at] * (n + 1) * r->cosine[next];
        const double half_y = r->half[at] * (n + 1) * r->sine[next];
        r->air_x[now] = x + half_x;
        r->air_y[now] = y + half_y;
        x += 2 * half_x;
        y += 2 * half_y;
        const double fx = r->air[at] * r->air_x[now], fy = r->air[at] * r->air_y[now];
        r->moment[at] += r->air_turning[at] * r->rate[now] +
                         r->half[at] * (r->start_c[at] * fy - r->start_s[at] * fx);
    }
}

void chain_series_add_drag(chain_series *s, int n)
{
    chain_rows *r = &s->rows;
    for (int k = 0; k < s->links; k++) {
        const size_t at = chain_place(r, k), now = chain_term(n, at);
        r->add_x[at] += r->air[at] * r->air_x[now];
        r->add_y[at] += r->air[at] * r->air_y[now];
    }
}
