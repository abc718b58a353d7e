// The stiff engine: Radau IIA of seven stages, order 13, for every arm and wall (stiff_step.h).
//
// A step is as long as the error of its velocities and angles allows, whatever is asked of it:
// rows, stops and the end of a run read its polynomials, and the state keeps it
// (stiff_integrator.h). A step within which an event function falls below zero is taken again up to
// that instant, so that an event is where a step ends. After an event a step begins anew, short;
// after a change of torque it is predicted from the step before, as every other one is.
//
// How a step is made stands in stiff_control.c, what it tells in stiff_output.c.
#include <string.h>

#include "src/base/extremes.h"
#include "src/contact/dense_location.h"
#include "src/engines/stiff/stiff_integrator.h"
#include "src/engines/pair/taylor_lanes.h"

#define LEAST_LEFT 1e-13 // share of a step that is continued

static size_t init(const arm *a, void *memory)
{
    const size_t n = (size_t)a->dof, links = (size_t)a->links, modes = (size_t)a->damped_modes;
    stiff_integrator none, *s = memory != NULL ? memory : &none;
    stiff_step *p = &s->step;
    layout l = {.block = memory};
    memset(s, 0, sizeof *s);
    s->loops = &stiff_loops_1;
#if defined __x86_64__
    s->loops = taylor_width() >= 4 ? &stiff_loops_4 : s->loops;
#endif
    layout_add(&l, sizeof *s);
    p->stage = layout_add(&l, n * sizeof *p->stage);
    p->body = layout_add(&l, links * sizeof *p->body);
    p->pivot = layout_add(&l, links * sizeof *p->pivot);
    p->y = layout_add(&l, n * sizeof *p->y);
    for (size_t i = 0; i <= modes; i++) {
        p->border[i] = layout_add(&l, n * sizeof *p->y);
    }
    p->link = layout_add(&l, links * sizeof *p->link);
    p->mode = layout_add(&l, (modes * n + 1) * sizeof(double));
    p->jacobian = layout_add(&l, n * sizeof(double));
    p->q0 = layout_add(&l, n * sizeof(double));
    p->w0 = layout_add(&l, n * sizeof(double));
    p->a0 = layout_add(&l, n * sizeof(double));
    for (int i = 0; i < 4; i++) {
        s->scratch[i] = layout_add(&l, 2 * n * sizeof(double));
    }
    s->kept = layout_add(&l, (KEPT_COUNT + stiff_kept_size(a)) * sizeof(double));
    s->end = layout_add(&l, (SLOT_COUNT + 4 * n + QUADRATURE_COUNT) * sizeof(double));
    return l.length;
}

// Continues in the step that the state keeps.
static void take_up(stiff_integrator *s, const arm *a, motion *m)
{
    const double *kept = state_kept(m, m->state);
    const size_t from = STIFF_LENGTH,
                 size = (KEPT_COUNT + stiff_kept_size(a) - from) * sizeof *kept;
    if (!s->known || m->step.history_invalid || memcmp(s->kept + from, kept + from, size) != 0) {
        memcpy(s->kept, kept, (KEPT_COUNT + stiff_kept_size(a)) * sizeof *kept);
        s->step.dof = a->dof;
        s->step.links = a->links;
        s->step.first = a->first;
        s->step.length = kept[STIFF_LENGTH];
        s->ended = false;
        function_through(&s->force, stiff_force(s));
        s->gap.degree = FUNCTION_MOST - 1;
        memcpy(s->gap.b, s->kept + STIFF_GAPS, sizeof s->gap.b);
        s->known = true;
    }
    s->used = kept[KEPT_USED];
}

static double advance(const arm *a, motion *m, double remaining, double step)
{
    stiff_integrator *s = m->memory;
    const double *kept = state_kept(m, m->state);
    (void)step;
    const double left = kept[KEPT_LENGTH] - kept[KEPT_USED];
    const bool goes_on = m->state[SLOT_JUMPED] == 0 && kept[KEPT_LENGTH] > 0 &&
                         left > (kept[STIFF_EVENT] != 0 ? 0 : LEAST_LEFT * kept[KEPT_LENGTH]);
    if (goes_on) {
        take_up(s, a, m);
    } else if (!stiff_make_step(s, a, m)) {
        s->known = false;
        return 0;
    }
    m->step.history_invalid = false;
    m->most_force = function_greatest(&s->force);
    memcpy(state_kept(m, m->state), s->kept, (KEPT_COUNT + stiff_kept_size(a)) * sizeof *kept);
    state_kept(m, m->state)[KEPT_USED] = s->used;
    return smaller(s->kept[KEPT_LENGTH] - s->used, remaining);
}

const engine stiff_engine = {.name = "stiff",
                             .init = init,
                             .advance = advance,
                             .state_at = stiff_state_at,
                             .dense_output = stiff_dense_output,
                             .event_function = stiff_event_function,
                             .second_derivative = stiff_second_derivative,
                             .excludes_event = stiff_excludes_event,
                             .first_event = stiff_first_event,
                             .kept = STIFF_HEAD - KEPT_COUNT,
                             .kept_for_body = 2 + RADAU_LANES,
                             .parabolas = 32};
