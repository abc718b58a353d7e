// The functions that say when a contact state ends, as polynomials through a step's stages.
#include <math.h>
#include <string.h>

#include "src/base/extremes.h"
#include "src/contact/edge_limits.h"
#include "src/engines/stiff/stiff_integrator.h"

// Of the current, as a share of its limit.
#define EDGE_CURRENT 1e-10
// Shares of a function's largest coefficient: of what is rounding at a start, and of what a force
// that presses at all stages, or a gap that is open at them, may lack there, where it changes
// faster than the step shows.
#define FLAT  1e-5
#define LACKS 1e-3
// A gap that nowhere in a step exceeds this is followed as it grows [m].
#define LOW_FLIGHT 1e-9

// The function less what is only rounding at its start (edge_limits.h).
static void deflate_root(stiff_integrator *s, event_function w, const double limits[3])
{
    double terms[4];
    function_start(&s->function[w], terms);
    const int powers = edge_powers(terms, limits, s->step.length);
    for (int i = 0; i < powers; i++) {
        function_divide(&s->function[w]);
        s->divided[w] = true;
    }

    // of one that starts flatter still, what is left at the start is rounding; of a force that
    // presses at all stages, or a gap that is open at all of them, the step's own error, too
    double *start = s->function[w].b;
    bool holds = (w == EVENT_OF_FORCE && powers > 0) || (w == EVENT_OF_GAP && powers == 3);
    for (int i = 0; i < RADAU_STAGES && holds; i++) {
        holds = w == EVENT_OF_FORCE ? s->step.force.at[i] > 0
                                    : function_at(&s->function[w], radau_node[i]).value > 0;
    }
    const double share = holds ? LACKS : powers == 3 ? FLAT : 0;
    if (*start < 0 && *start > -share * function_greatest(&s->function[w])) {
        *start = -*start;
    }
}

// Of an arm in contact with a wall that gives: its depth, and of Hunt and Crossley's law, for the
// force itself, the factor k + c v of the power. Of Kelvin and Voigt's the force with its own slope
// at the start, which decides whether the arm stays.
static void set_compliant_functions(stiff_integrator *s, const arm *a, const motion *m)
{
    double law[RADAU_LANES];
    s->function[EVENT_OF_GAP] = s->gap;
    function_scale(&s->function[EVENT_OF_GAP], -1, 0);
    if (a->wall.law == WALL_KELVIN_VOIGT) {
        const double grows = -a->wall.stiffness * m->state[SLOT_GAP_VELOCITY] -
                             a->wall.damping * m->state[SLOT_GAP_ACCELERATION];
        function_through_rising(&s->function[EVENT_OF_FORCE], stiff_force(s),
                                s->step.length * grows);
        return;
    }
    for (int i = 0; i < RADAU_LANES; i++) {
        law[i] = a->wall.stiffness - a->wall.damping * s->step.rate.at[i];
    }
    function_through(&s->function[EVENT_OF_FORCE], law);
}

// The gap, from its rates, its acceleration at the start and where it starts [m].
static void set_gap(stiff_integrator *s, const arm *a, const motion *m)
{
    const double h = s->step.length;
    double start = m->state[SLOT_GAP], rates[RADAU_LANES];
    const wall_model wall = wall_at(&a->wall, m->state[SLOT_TIME]);
    if (m->state[SLOT_JUMPED] != 0 ? fabs(start) <= EDGE_GAP : s->kept[STIFF_GAP] != 0) {
        start = m->state[SLOT_JUMPED] != 0 ? 0 : s->kept[STIFF_GAP];
    }
    for (int i = 0; i < RADAU_LANES; i++) {
        rates[i] = s->step.rate.at[i];
        if (state_face_swings(m, m->state)) {
            const wall_face face = state_face(m->state);
            rates[i] += wall_face_after(&wall, face, radau_node[i] * h).velocity;
        }
    }
    function_through_rising(&s->gap, rates, h * m->state[SLOT_GAP_ACCELERATION]);
    function_integrate(&s->gap, start, h);
    memcpy(s->kept + STIFF_GAPS, s->gap.b, sizeof s->gap.b);
    const double end = s->gap.b[s->gap.degree];
    s->kept[STIFF_GAP] = function_greatest(&s->gap) < LOW_FLIGHT ? end : 0;
}

// A gap or depth that is less than places are known to all through the step says nothing.
static void ignore_rounding(stiff_function *f)
{
    if (function_least(f) > -EDGE_PLACE && function_greatest(f) < EDGE_PLACE) {
        *f = (stiff_function){.degree = f->degree};
    }
}

static void set_wall_functions(stiff_integrator *s, const arm *a, const motion *m,
                               contact_state now)
{
    bool at_edge = m->state[SLOT_JUMPED] != 0;
    function_through(&s->force, stiff_force(s)); // the state's own at both ends
    set_gap(s, a, m);
    s->function[EVENT_OF_FORCE] = s->force;
    if (m->wall_gives && now.contact) {
        set_compliant_functions(s, a, m);
    } else if (!now.contact) {
        stiff_function *distance = &s->function[EVENT_OF_GAP];
        *distance = s->gap;
        if (distance->b[0] < 0 && distance->b[0] > -EDGE_DEPTH && distance->b[1] > distance->b[0]) {
            distance->b[0] = 0;
            at_edge = true;
        }
    }
    ignore_rounding(&s->function[EVENT_OF_GAP]);
    if (!at_edge) {
        return;
    }

    // just after an event they may begin at zero
    const double stiffness = m->wall_gives ? a->wall.stiffness * EDGE_GAP : 0;
    const double reaction[] = {EDGE_VALUE + stiffness, EDGE_RATE + stiffness, EDGE_MORE};
    if (now.contact) {
        deflate_root(s, EVENT_OF_FORCE, reaction);
    }
    if (!now.contact || m->wall_gives) {
        double gap[3];
        motion_gap_edges(a, m, gap);
        deflate_root(s, EVENT_OF_GAP, gap);
    }
}

static void set_hub_functions(stiff_integrator *s, const arm *a, const motion *m, contact_state now)
{
    const bool jumped = m->state[SLOT_JUMPED] != 0;
    if (now.friction != HUB_STICK) {
        double rate[RADAU_LANES];
        for (int i = 0; i < RADAU_LANES; i++) {
            rate[i] = now.friction * s->step.stage[0].w[i / 4][i % 4];
        }
        function_through(&s->function[EVENT_OF_HUB], rate);
        if (jumped) { // it may start at zero
            const double limits[] = {0, EDGE_RATE * motion_rounding(a, m), EDGE_MORE};
            function_through_rising(&s->function[EVENT_OF_HUB], rate,
                                    now.friction * s->step.length * s->step.a0[0]);
            deflate_root(s, EVENT_OF_HUB, limits);
        }
        return;
    }

    // the nearer limit of what friction holds, and the farther one
    stiff_function *near = &s->function[EVENT_OF_STICTION];
    function_through(near, s->step.hold.at);
    const double sign = near->b[0] < 0 ? 1 : -1;
    stiff_function *far = &s->far[EVENT_OF_STICTION];
    *far = *near;
    function_scale(near, sign, a->motor.stiction);
    function_scale(far, -sign, a->motor.stiction);
    s->stiction_excess = jumped && fabs(near->b[0]) <= EDGE_VALUE ? EDGE_VALUE - near->b[0] : 0;
    function_scale(near, 1, s->stiction_excess);
}

static void set_current_function(stiff_integrator *s, const arm *a)
{
    const motor_model *motor = &a->motor;
    const double most = motor->current_limit, side = s->step.limited < 0 ? -1 : 1;
    double current[RADAU_LANES];
    for (int i = 0; i < RADAU_LANES; i++) {
        current[i] = side * s->step.current.at[i];
    }
    stiff_function *near = &s->function[EVENT_OF_CURRENT];
    function_through(near, current);
    s->far[EVENT_OF_CURRENT] = *near;
    function_scale(&s->far[EVENT_OF_CURRENT], 1, most);
    function_scale(near, -1, most);
    if (s->step.drive == STIFF_LIMITED) {
        for (int i = 0; i < RADAU_LANES; i++) {
            const double w = s->step.stage[0].w[i / 4][i % 4];
            current[i] =
                side * (motor->gain * motor->voltage - motor->back_emf * w) / motor->resistance;
        }
        function_through(near, current);
        function_scale(near, 1, -most);
    }
    if (s->turned) {
        near->b[0] = 0;
    }
    const double rounding = EDGE_CURRENT * most;
    const double rate = motor->inductance > 0 ? motor->resistance / motor->inductance : 0;
    const double edge[] = {rounding, rounding * rate, 0};
    deflate_root(s, EVENT_OF_CURRENT, edge);
    if (s->turned) { // a current that leaves its limit does so without a slope
        near->b[0] = fabs(near->b[0]);
    }
}

void stiff_event_functions(stiff_integrator *s, const arm *a, const motion *m)
{
    const contact_state now = contact_state_of(m->state);
    memset(s->divided, 0, sizeof s->divided);
    if (wall_stands(&a->wall)) {
        set_wall_functions(s, a, m, now);
    }
    set_hub_functions(s, a, m, now);
    if (a->motor.electric && a->motor.current_limit < HUGE_VAL) {
        set_current_function(s, a);
    }
}
