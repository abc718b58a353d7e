// What the contact machine asks of the step of a two-link arm: event functions, and the force.
#include <math.h>

#include "src/base/extremes.h"
#include "src/contact/dense_location.h"
#include "src/engines/pair/taylor_integrator.h"

static double rounding_of(const arm *a, const motion *m, const taylor_integrator *s)
{
    return motion_rounding_at(a, m->dof, s->kept + KEPT_ANGLES, s->kept + KEPT_VELOCITIES);
}

// A function that is to be watched, from the series: only where it comes near zero is it asked for.
// Just after an event it may begin at zero, as the gap does after a bounce cut short.
static void prepare_event_function(const arm *a, const motion *m, taylor_integrator *s,
                                   event_function w)
{
    const int order = s->lane.form.order;
    const bool jumped = s->kept[KEPT_JUMPED] != 0;
    const double friction = m->state[SLOT_FRICTION], stiction = a->motor.stiction;
    polynomial *p = &s->function[w];
    const taylor_lane *lane = &s->lane;
    const int spacing = taylor_spacing(lane);
    s->known |= 1u << w;

    // the wall
    if (w == EVENT_OF_FORCE) {
        const double edge[] = {EDGE_VALUE, EDGE_RATE, EDGE_MORE};
        set_polynomial(p, taylor_term(lane, AT_FORCE), spacing, order, 1);
        if (jumped) {
            deflate_root(p, edge);
        }
    } else if (w == EVENT_OF_GAP) {
        set_polynomial(p, taylor_term(lane, AT_GAP), spacing, order + 2, 1);
        const bool inside = p->terms[0] < 0 && p->terms[0] > -EDGE_DEPTH && p->terms[1] > 0;
        p->terms[0] = inside ? 0 : p->terms[0];
        if (jumped || inside) {
            const double lacking = EDGE_RATE * (1 + LEFT_OUT * (rounding_of(a, m, s) - 1));
            deflate_root(p, (double[]){EDGE_GAP, EDGE_RATE, fmax(EDGE_MORE, lacking)});
        }
    }

    // the hub; what holds a stuck one may hold a little more just after an event
    if (w == EVENT_OF_HUB) {
        const int place = a->hub_spring ? AT_RATE_0 : AT_RATE_1;
        set_polynomial(p, taylor_term(lane, place), spacing, order + 1, friction);
        if (jumped) {
            deflate_root(p, (double[]){0, EDGE_RATE * rounding_of(a, m, s), EDGE_MORE});
        }
    } else if (w == EVENT_OF_STICTION) {
        const double *hold = taylor_term(lane, AT_HOLD);
        const double sign = hold[0] < 0 ? -1 : 1;
        set_polynomial(p, hold, spacing, order, -sign);
        set_polynomial(&s->far_limit, hold, spacing, order, sign);
        p->terms[0] += stiction;
        s->far_limit.terms[0] += stiction;
        p->terms[0] = jumped && fabs(p->terms[0]) <= EDGE_VALUE ? EDGE_VALUE : p->terms[0];
    }
}

static const polynomial *function(const arm *a, const motion *m, event_function w)
{
    taylor_integrator *s = m->memory;
    if (!(s->known & 1u << w)) {
        prepare_event_function(a, m, s, w);
    }
    return &s->function[w];
}

value_and_slope taylor_event_function(const arm *a, const motion *m, event_function w, double h)
{
    const taylor_integrator *s = m->memory;
    const polynomial *p = function(a, m, w);
    const double t = s->used + h;
    value_and_slope near = t > 0 ? value_and_slope_at(p->terms, p->count, t)
                                 : (value_and_slope){p->terms[0], p->terms[1]};
    if (w != EVENT_OF_STICTION) {
        return near;
    }
    value_and_slope far = value_and_slope_at(s->far_limit.terms, s->far_limit.count, t);
    return near.value < far.value ? near : far;
}

double taylor_second_derivative(const arm *a, const motion *m, event_function w, double from,
                                double to)
{
    taylor_integrator *s = m->memory;
    const polynomial *p = function(a, m, w);
    const double t = s->used + to;
    double near = curvature_bound(p, t);
    (void)from;
    if (w == EVENT_OF_FORCE && p->divided) {
        // divided by the time: the force itself may be more curved
        polynomial force;
        set_polynomial(&force, taylor_term(&s->lane, AT_FORCE), taylor_spacing(&s->lane),
                       s->lane.form.order, 1);
        return fmax(near, curvature_bound(&force, t));
    }
    return near; // that of both limits of stiction
}

bool taylor_excludes_event(const motion *m, event_function w)
{
    // it is above zero from the start, or rises from it, and stays above zero over the whole step
    const taylor_integrator *s = m->memory;
    const bool wall = w == EVENT_OF_GAP || w == EVENT_OF_FORCE;
    return s->lane.block[wall ? AT_WALL_LEAST : AT_HUB_LEAST] > 0;
}

// The root of an event function that the series' kernel has found, since the step's start; beyond
// every step where the function stays clear, negative where the kernel has not found it.
static double known_root(const taylor_integrator *s, int place, bool clear)
{
    const double root = s->lane.block[place] - s->used;
    return clear ? HUGE_VAL : s->lane.block[place] > 0 ? root : -1;
}

void taylor_first_event(const arm *a, motion *m, step_end *end)
{
    // of most steps the bounds rule all events out
    const taylor_integrator *s = m->memory;
    const contact_state now = contact_state_of(m->state);
    const bool stuck = now.friction == HUB_STICK;
    const event_function wall = now.contact ? EVENT_OF_FORCE : EVENT_OF_GAP;
    const event_function hub = stuck ? EVENT_OF_STICTION : EVENT_OF_HUB;
    const bool wall_clear =
        taylor_excludes_event(m, wall) || (!now.contact && !wall_stands(&a->wall));
    const bool hub_clear = taylor_excludes_event(m, hub) || (!stuck && a->motor.stiction == 0);

    *end = (step_end){.length = end->length};
    if (wall_clear && hub_clear) {
        return;
    }

    // most others end where the kernel has found a root
    const double at_wall = known_root(s, AT_WALL_ROOT, wall_clear);
    const double at_hub = known_root(s, AT_HUB_ROOT, hub_clear);
    if (!(at_wall >= 0 && at_hub >= 0)) {
        dense_search_event(a, m, end);
        return;
    }
    const double root = smaller(at_wall, at_hub);
    if (root <= end->length) {
        *end = (step_end){root, true, at_hub < at_wall ? hub : wall};
    }
}
