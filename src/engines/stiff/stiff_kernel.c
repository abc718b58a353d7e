// The loops of a step of the stiff engine, built as LOOPS once for each width of the processor's
// vectors (src/engines/meson.build). The derivation stands in stiff_step.h.
#include <math.h>

#include "src/engines/stiff/stiff_tangent.h"

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
        s->y[k] = scaled(-1, to_systems(s->stage[k].r));
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

const stiff_loops LOOPS = {predict, residual, factor, differences, correct};
