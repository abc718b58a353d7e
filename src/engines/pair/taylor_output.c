// The output of a two-link arm's step (engine.h): the states within it, the event
// functions, and the change that another torque of the motor makes at once if the hub
// slides.
#include <math.h>
#include <string.h>

#include "src/arm/chain_pair.h"
#include "src/base/extremes.h"
#include "src/base/sincos.h"
#include "src/contact/locate.h"
#include "src/engines/pair/taylor_integrator.h"

// --- states ----------------------------------------------------------------------------

// Copies the motion at instant i of those evaluated into `state`. In contact the gap and
// its derivatives ought to be zero, and the second derivative is set to that.
static void take_instant(const arm *a, const motion *m, const taylor_instants *at, int i,
                         double *state)
{
    const taylor_integrator *s = m->memory;
    const double *before = s->kept + KEPT_QUADRATURES;
    double *quadrature = state_quadratures(m, state);
    memcpy(state_kept(m, state), s->kept, sizeof s->kept);
    state_kept(m, state)[KEPT_USED] = at->time[i];

    // the motion
    double *q = state_angles(m, state), *acceleration = state_accelerations(m, state);
    for (int body = 1 - a->first; body < 3; body++, q++, acceleration++) {
        q[0] = at->angle[body][i];
        q[m->dof] = at->velocity[body][i];
        acceleration[0] = acceleration[m->dof] = at->acceleration[body][i];
    }

    // the quadratures: values at the step's start and the integrals since
    const double turn = state_velocities(m, state)[0];
    quadrature[QUADRATURE_VISCOUS] =
        before[QUADRATURE_VISCOUS] + a->motor.damping * at->hub_square[i];
    quadrature[QUADRATURE_DAMPING] = before[QUADRATURE_DAMPING];
    if (s->lane.form.damped) {
        quadrature[QUADRATURE_DAMPING] += at->dissipated[i];
        state[SLOT_DAMPING_POWER] = at->dissipation[i];
    }
    quadrature[QUADRATURE_FORCE] = before[QUADRATURE_FORCE];
    state[SLOT_VISCOUS_POWER] = a->motor.damping * turn * turn;

    // friction and wall
    const bool stuck = state[SLOT_FRICTION] == HUB_STICK;
    state[SLOT_FRICTION_TORQUE] =
        stuck ? at->hold[i] : -state[SLOT_FRICTION] * a->motor.stiction;
    if (s->lane.form.contact) {
        state[SLOT_FORCE] = at->force[i];
        quadrature[QUADRATURE_FORCE] += at->pressed[i];
    }
    if (wall_stands(&a->wall)) {
        state[SLOT_GAP] = at->gap[i];
        state[SLOT_GAP_VELOCITY] = at->gap_velocity[i];
        state[SLOT_GAP_ACCELERATION] = s->lane.form.contact ? 0 : at->gap_acceleration[i];
    }
}

// The motion at h in the step: that of the whole group, at number *place, if the group
// was evaluated for this instant; else it is evaluated into `one`.
static const taylor_instants *instant_at(taylor_integrator *s, double h,
                                         taylor_instants *one, int *place)
{
    *place = 0;
    if (s->lane.end == h) {
        *place = s->lane.number;
        return &s->lane.group->ends;
    }
    one->time[0] = s->used + h;
    taylor_evaluate(&s->lane, 1, one);
    return one;
}

status taylor_state_at(const arm *a, motion *m, double h, state_extent extent)
{
    (void)extent;
    taylor_integrator *s = m->memory;
    taylor_instants one;
    int place;
    const taylor_instants *at = instant_at(s, h, &one, &place);
    take_instant(a, m, at, place, m->trial);
    m->step.trial_energy = (state_energy){at->kinetic[place], at->strain[place]};
    if (s->lane.form.contact && motion_project(a, m, m->trial)) {
        m->step.trial_energy = unknown_energy;
    }
    return STATUS_OK;
}

void taylor_states_at(const arm *a, motion *m, const double *h, int count,
                      double *const *states, state_energy *energies)
{
    taylor_integrator *s = m->memory;
    const int width = taylor_width();
    for (int done = 0; done < count; done += width) {
        taylor_instants at;
        const int more = count - done < width ? count - done : width;
        for (int i = 0; i < more; i++) {
            at.time[i] = s->used + h[done + i];
        }
        taylor_evaluate(&s->lane, more, &at);
        for (int i = 0; i < more; i++) {
            double *state = states[done + i];
            take_instant(a, m, &at, i, state);
            energies[done + i] = (state_energy){at.kinetic[i], at.strain[i]};
            if (s->lane.form.contact && motion_project(a, m, state)) {
                energies[done + i] = motion_energy(a, m, state);
            }
        }
    }
}

// Evaluates a series at count + 1 equally spaced times from `used + from` on [s], as many
// side by side as the processor's vectors hold.
static void evaluate_equally(const double *term, int terms, double used, double from,
                             double spacing, int count, value_and_slope *at)
{
    const int width = taylor_width();
    for (int done = 0; done <= count; done += width) {
        double times[TAYLOR_WIDEST], values[TAYLOR_WIDEST], slopes[TAYLOR_WIDEST];
        for (int i = 0; i < width; i++) {
            times[i] = used + (from + (done + i) * spacing);
        }
        taylor_values(term, terms, times, values, slopes);
        for (int i = 0; i < width && done + i <= count; i++) {
            at[done + i] = (value_and_slope){values[i], slopes[i]};
        }
    }
}

void taylor_dense_output(const arm *a, motion *m, output_quantity of, double from,
                         double to, int count, value_and_slope *at)
{
    taylor_integrator *s = m->memory;
    taylor_lane *lane = &s->lane;
    const double spacing = count > 0 ? (to - from) / count : 0;
    const int order = lane->form.order;

    // forces that were evaluated for the whole group, from the step's start on
    if (of == OUTPUT_FORCE && count > 0 && lane->pieces == count && from == 0 &&
        lane->end == to) {
        const taylor_pieces *pieces = &lane->group->pieces;
        at[0] = (value_and_slope){*taylor_term(lane, AT_FORCE),
                                  *taylor_term(lane, AT_FORCE + 1)};
        for (int i = 0; i < count; i++) {
            at[i + 1] = (value_and_slope){pieces->force[i][lane->number],
                                          pieces->slope[i][lane->number]};
        }
        return;
    }

    // the series of the quantity
    const int hub = a->first == 0 ? AT_ANGLE_1 : AT_ANGLE_0;
    int place = hub, terms = order + 2;
    if (of == OUTPUT_FORCE) {
        place = AT_FORCE;
        terms = order;
    } else if (of == OUTPUT_GAP) {
        place = AT_GAP;
    }
    const double *term = taylor_terms(lane, place, terms);

    // its values, of which the first may be the start itself
    if (count > 0) {
        evaluate_equally(term, terms, s->used, from, spacing, count, at);
    } else {
        at[0] = value_and_slope_at(term, terms, s->used + from);
    }
    if (!(s->used + from > 0)) {
        at[0] = (value_and_slope){term[0], term[1]};
    }
    if (of == OUTPUT_HUB && m->state[SLOT_FRICTION] == HUB_STICK) {
        for (int i = 0; i <= count; i++) {
            at[i].slope = 0;
        }
    }
}

// --- event functions -------------------------------------------------------------------

// Amplification of rounding errors (motion_rounding) at the start of the step.
static double start_rounding(const arm *a, const motion *m, const taylor_integrator *s)
{
    return motion_rounding_at(a, m->dof, s->kept + KEPT_ANGLES,
                              s->kept + KEPT_VELOCITIES);
}

// Makes the polynomial of an event function from the series, once it is asked for: in
// most steps bounds exclude the event, and it is not. Just after an event the function
// may begin at zero, which is then taken out of it.
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
        const bool inside =
            p->terms[0] < 0 && p->terms[0] > -EDGE_DEPTH && p->terms[1] > 0;
        if (inside) {
            p->terms[0] = 0;
        }
        if (jumped || inside) {
            const double lacking =
                EDGE_RATE * (1 + LEFT_OUT * (start_rounding(a, m, s) - 1));
            deflate_root(p, (double[]){EDGE_GAP, EDGE_RATE, fmax(EDGE_MORE, lacking)});
        }
    }

    // the hub; a stuck one may exceed stiction by a rounding error just after an event
    if (w == EVENT_OF_HUB) {
        const int place = a->hub_spring ? AT_RATE_0 : AT_RATE_1;
        set_polynomial(p, taylor_term(lane, place), spacing, order + 1, friction);
        if (jumped) {
            deflate_root(p,
                         (double[]){0, EDGE_RATE * start_rounding(a, m, s), EDGE_MORE});
        }
    } else if (w == EVENT_OF_STICTION) {
        const double *hold = taylor_term(lane, AT_HOLD);
        const double sign = hold[0] < 0 ? -1 : 1;
        set_polynomial(p, hold, spacing, order, -sign);
        set_polynomial(&s->far_limit, hold, spacing, order, sign);
        p->terms[0] += stiction;
        s->far_limit.terms[0] += stiction;
        if (jumped && fabs(p->terms[0]) <= EDGE_VALUE) {
            p->terms[0] = EDGE_VALUE;
        }
    }
}

// The polynomial of an event function, made when it is first asked for in a step.
static const polynomial *prepared_function(const arm *a, const motion *m,
                                           event_function w)
{
    taylor_integrator *s = m->memory;
    if (!(s->known & 1u << w)) {
        prepare_event_function(a, m, s, w);
    }
    return &s->function[w];
}

value_and_slope taylor_event_function(const arm *a, const motion *m, event_function w,
                                      double h)
{
    const taylor_integrator *s = m->memory;
    const polynomial *p = prepared_function(a, m, w);
    const double t = s->used + h;
    value_and_slope near = {p->terms[0], p->terms[1]};
    if (t > 0) {
        near = value_and_slope_at(p->terms, p->count, t);
    }
    if (w != EVENT_OF_STICTION) {
        return near;
    }

    // stiction has a limit either way
    value_and_slope far = value_and_slope_at(s->far_limit.terms, s->far_limit.count, t);
    if (near.value < far.value) {
        return near;
    }
    return far;
}

double taylor_second_derivative(const arm *a, const motion *m, event_function w,
                                double from, double to)
{
    taylor_integrator *s = m->memory;
    const polynomial *p = prepared_function(a, m, w);
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
    // it is above zero from the start, or rises from it, and stays above zero over the
    // whole step
    const taylor_integrator *s = m->memory;
    if (w == EVENT_OF_GAP || w == EVENT_OF_FORCE) {
        return s->lane.block[AT_WALL_LEAST] > 0;
    }
    return s->lane.block[AT_HUB_LEAST] > 0;
}

// The instant of the root of an event function that taylor_kernel.c found, from the
// present state on [s]: infinite if the function stays `clear` of zero, negative if the
// kernel found none.
static double known_root(const taylor_integrator *s, int place, bool clear)
{
    if (clear) {
        return HUGE_VAL;
    }
    if (s->lane.block[place] > 0) {
        return s->lane.block[place] - s->used;
    }
    return -1;
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
    const bool hub_clear =
        taylor_excludes_event(m, hub) || (!stuck && a->motor.stiction == 0);

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

// --- another torque --------------------------------------------------------------------

// The entries j of dg/dq at the angles q [m]; taylor_order.h has their formulas.
static void penetration_gradient(const arm *a, const double *q, double bend_cosine,
                                 double j[2])
{
    const wall_model *w = &a->wall;
    double s, c;
    inline_sincos(q[1], &s, &c);
    if (w->kind == WALL_POINT) {
        j[0] = a->link_length * bend_cosine;
        j[1] = w->x * c + w->y * s - j[0];
        return;
    }
    j[1] = a->link_length * (w->cosine * c + w->sine * s);
    inline_sincos(q[0], &s, &c);
    j[0] = a->link_length * (w->cosine * c + w->sine * s);
}

void taylor_retorque(const arm *a, motion *m, double change)
{
    double *state = m->state, *acceleration = state_accelerations(m, state);
    if (a->hub_spring) {
        acceleration[0] += change / a->hub_inertia; // the links do not feel it yet
        return;
    }

    // accelerations by a unit torque on the first link, which turns with the hub
    const double *q = state_angles(m, state), c = inline_cos(q[1] - q[0]);
    const pair_mass mass = pair_mass_of(a);
    double first, second;
    pair_solve(&mass, mass.m12 * c, false, 1, 0, &first, &second);

    // the wall: in contact its force changes so that the gap's acceleration stays zero
    if (wall_stands(&a->wall)) {
        double j[2], y1, y2;
        penetration_gradient(a, q, c, j);
        const double closing = j[0] * first + j[1] * second;
        if (state[SLOT_CONTACT] != 0) {
            pair_solve(&mass, mass.m12 * c, false, j[0], j[1], &y1, &y2);
            const double force = closing / (j[0] * y1 + j[1] * y2);
            first -= y1 * force;
            second -= y2 * force;
            state[SLOT_FORCE] += force * change;
        } else {
            state[SLOT_GAP_ACCELERATION] -= closing * change;
        }
    }
    acceleration[0] += first * change;
    acceleration[1] += second * change;
}
