// The output of a step of the stiff engine (engine.h): the states within it, by the
// polynomials through its stages, and the event functions, which say when a contact state
// ends.
#include <float.h>
#include <math.h>
#include <string.h>

#include "src/base/extremes.h"
#include "src/contact/edge_limits.h"
#include "src/engines/stiff/stiff_integrator.h"

// A power at the step's start is taken into account if it differs from the polynomial
// through the stages by less than this share of the largest power.
#define LITTLE 1e-2
// Rounding error of a current at its limit, as a share of the limit.
#define EDGE_CURRENT 1e-10
// Negative values that count as none at the start of a step, as shares of a function's
// largest coefficient: those that are rounding errors, and those of a force that presses
// at all stages, or of a gap that is open at all of them, which may change there faster
// than the step shows.
#define FLAT  1e-5
#define LACKS 1e-3
// A gap that nowhere in a step exceeds this is followed as it grows [m].
#define LOW_FLIGHT 1e-9

// --- states ----------------------------------------------------------------------------

// Sum of numbers at the stages, each times its weight.
static inline double weighted(const double *weight, const double *stages)
{
    double sum = 0;
    for (int j = 0; j < RADAU_STAGES; j++) {
        sum += weight[j] * stages[j];
    }
    return sum;
}

// Angle [rad], velocity [rad/s] and acceleration [rad/s2] of a body.
typedef struct body_motion {
    double q, w, a;
} body_motion;

// The motion of body k at the fraction x of the step that the weights are for: the
// polynomial of the accelerations, and that integrated once and twice from the start.
static inline body_motion body_at(const stiff_integrator *s, int k, double x,
                                  const radau_weights *weight)
{
    const double h = s->kept[STIFF_LENGTH], w0 = stiff_velocities(s)[k];
    const double *stages = stiff_accelerations(s) + RADAU_LANES * k;
    return (body_motion){stiff_angles(s)[k] +
                             h * (x * w0 + h * weighted(weight->twice, stages)),
                         w0 + h * weighted(weight->integral, stages),
                         weighted(weight->value, stages)};
}

// What a quadrature gains within the step if its power at the step's start counts too:
// the polynomial through start and stages is of one degree more, which changes the
// integral within the step but not over all of it. 0 where the start differs so much from
// the stages that it shows a transient which they do not.
static double gain_by_start(const stiff_integrator *s, int quadrature,
                            const radau_weights *weight)
{
    const double *values = s->kept + STIFF_VALUES + quadrature * RADAU_LANES;
    double weight_at_start[RADAU_LANES], largest = 0;
    radau_values_at(0, weight_at_start);
    for (int j = 0; j < RADAU_STAGES; j++) {
        largest = larger(fabs(values[j]), largest);
    }

    // the power at the start, less that of the polynomial through the stages
    const double difference = values[RADAU_STAGES] - weighted(weight_at_start, values);
    if (fabs(difference) < LITTLE * largest) {
        return s->kept[STIFF_LENGTH] * weight->start * difference;
    }
    return 0;
}

// A quadrature at the fraction of the step that the weights are for: its value at the
// start and the integral of its power's polynomial.
static double quadrature_at(const stiff_integrator *s, int quadrature,
                            const radau_weights *weight)
{
    const double *powers = s->kept + STIFF_VALUES + quadrature * RADAU_LANES;
    return s->kept[STIFF_QUADRATURES + quadrature] +
           s->kept[STIFF_LENGTH] * weighted(weight->integral, powers);
}

// The evaluated state at `time` after the step's start: angles, velocities and
// quadratures by the polynomials, a swinging face by its own law, and what follows from
// all of them.
void stiff_state_within(const stiff_integrator *s, const arm *a, motion *m, double time,
                        double *state)
{
    const double x = time / s->kept[STIFF_LENGTH];
    double *q = state_angles(m, state), *w = state_velocities(m, state);

    // the polynomials
    radau_weights weight;
    radau_weights_at(x, &weight);
    for (int k = 0; k < s->step.dof; k++) {
        const body_motion at = body_at(s, k, x, &weight);
        q[k] = at.q;
        w[k] = at.w;
    }
    for (int i = 0; i < QUADRATURE_COUNT; i++) {
        state_quadratures(m, state)[i] = quadrature_at(s, i, &weight);
        if (m->wall_moves && i != QUADRATURE_CURRENT && i != QUADRATURE_FORCE) {
            state_quadratures(m, state)[i] += gain_by_start(s, i, &weight);
        }
    }

    // the current keeps to its limit; without an inductance it is no state of its own
    if (a->motor.electric) {
        double *current = state_quadratures(m, state) + QUADRATURE_CURRENT;
        const double most = a->motor.current_limit;
        if (a->motor.inductance > 0) {
            *current = fmax(-most, fmin(*current, most));
        } else {
            *current = s->kept[STIFF_QUADRATURES + QUADRATURE_CURRENT];
        }
    }

    // a face that swings by itself
    state[SLOT_TIME] = s->kept[STIFF_TIME] + (time > DBL_MIN ? time : 0);
    const wall_face start = {s->kept[STIFF_FACE], s->kept[STIFF_FACE + 1]};
    const wall_model wall = wall_at(&a->wall, s->kept[STIFF_TIME]);
    const bool moved = start.position != 0 || start.velocity != 0;
    const bool swings = state[SLOT_CONTACT] == 0 && (moved || m->wall_is_shaken);
    if (swings) {
        const wall_face face = wall_face_after(&wall, start, time);
        state[SLOT_FACE] = face.position;
        state[SLOT_FACE_VELOCITY] = face.velocity;
    }

    // accelerations, force and gap
    motion_evaluate(a, m, state);
    if (state[SLOT_CONTACT] != 0 && motion_wall_is_rigid(m)) {
        motion_project(a, m, state);
    }

    // the energy ledger: losses of the face, work of the motor, losses of friction
    if (swings) {
        const double work = wall_face_work(&wall, start, time);
        state_quadratures(m, state)[QUADRATURE_PUSHED] += work;
        state_quadratures(m, state)[QUADRATURE_WALL] +=
            wall_face_energy(&wall, start) + work - motion_wall_energy(a, m, state);
    }
    const double turned = q[0] - stiff_angles(s)[0];
    state[SLOT_MOTOR_WORK] = s->kept[STIFF_WORK] + a->motor.torque * turned;
    state[SLOT_FRICTION_LOSS] =
        s->kept[STIFF_RUBBED] + state[SLOT_FRICTION] * a->motor.stiction * turned;
    memcpy(state_algorithmic(m, state), state_accelerations(m, state),
           (size_t)m->dof * sizeof(double));
}

// Sets what sensors see of the state at `time` after the step's start: the motions of
// hub, first and last link, the force and its integral. All are read from the polynomials
// without evaluating the state, which is faster.
static void sense_within(const stiff_integrator *s, const arm *a, const motion *m,
                         double time, double *state)
{
    const double x = time / s->kept[STIFF_LENGTH];
    const int bodies[] = {0, a->first, a->dof - 1};
    radau_weights weight;
    radau_weights_at(x, &weight);
    for (int i = 0; i < (int)(sizeof bodies / sizeof *bodies); i++) {
        const int k = bodies[i];
        const body_motion at = body_at(s, k, x, &weight);
        state_angles(m, state)[k] = at.q;
        state_velocities(m, state)[k] = at.w;
        state_accelerations(m, state)[k] = at.a;
    }
    state[SLOT_FORCE] = function_at(&s->force, x).value;
    state_quadratures(m, state)[QUADRATURE_FORCE] =
        quadrature_at(s, QUADRATURE_FORCE, &weight);
}

status stiff_state_at(const arm *a, motion *m, double h, state_extent extent)
{
    const stiff_integrator *s = m->memory;
    double *kept = state_kept(m, m->trial);

    // by the instant itself, which is the same whatever stops were made on the way
    double time = m->state[SLOT_TIME] + h;
    if (fabs(time - m->step.aim) <= 4 * DBL_EPSILON * time) {
        time = m->step.aim;
    }
    if (extent == STATE_SENSED) {
        sense_within(s, a, m, time - s->kept[STIFF_TIME], m->trial);
        return STATUS_OK;
    }

    // the state at the step's end is known already
    const bool whole = s->used + h >= s->kept[KEPT_LENGTH];
    const double used = whole ? s->kept[KEPT_LENGTH] : time - s->kept[STIFF_TIME];
    if (whole && s->ended) {
        memcpy(m->trial, s->end, stiff_head_size(m));
        m->trial[SLOT_JUMPED] = m->trial[SLOT_IMPULSE] = 0;
    } else {
        stiff_state_within(s, a, m, used, m->trial);
    }

    // the state keeps the step, and how much of it is used
    memcpy(kept, s->kept, (KEPT_COUNT + stiff_kept_size(a)) * sizeof *kept);
    kept[KEPT_CHANGED] = state_kept(m, m->state)[KEPT_CHANGED];
    kept[KEPT_INTERVAL] = state_kept(m, m->state)[KEPT_INTERVAL];
    kept[KEPT_USED] = used;
    return STATUS_OK;
}

// --- what the contact machine asks -----------------------------------------------------

// A function of the fraction of the step, with its slope by time [1/s].
static value_and_slope by_time(const stiff_integrator *s, value_and_slope g)
{
    return (value_and_slope){g.value, g.slope / s->step.length};
}

// Functions from EVENT_OF_STICTION on have a second, farther limit: the smaller value of
// the two counts, also where one of them is not a number.
value_and_slope stiff_watched_at(const stiff_integrator *s, event_function w, double x)
{
    value_and_slope near = function_at(&s->function[w], x);
    if (w >= EVENT_OF_STICTION) {
        const value_and_slope far = function_at(&s->far[w], x);
        if (!(near.value < far.value)) {
            near = far;
        }
    }
    return near;
}

value_and_slope stiff_event_function(const arm *a, const motion *m, event_function w,
                                     double h)
{
    const stiff_integrator *s = m->memory;
    (void)a;
    return by_time(s, stiff_watched_at(s, w, (s->used + h) / s->step.length));
}

double stiff_second_derivative(const arm *a, const motion *m, event_function w,
                               double from, double to)
{
    const stiff_integrator *s = m->memory;
    const double length = s->step.length;
    const double x0 = (s->used + from) / length, x1 = (s->used + to) / length;
    const stiff_function *f = &s->function[w];
    if (s->used > 0 && w == EVENT_OF_FORCE) {
        f = &s->force;
    }

    double most = function_curvature(f, x0, x1);
    if (w >= EVENT_OF_STICTION) {
        most = larger(most, function_curvature(&s->far[w], x0, x1));
    } else if (w == EVENT_OF_FORCE) {
        most = larger(most, function_curvature(&s->force, x0, x1));
    }
    (void)a;
    return most / (length * length);
}

bool stiff_excludes_event(const motion *m, event_function w)
{
    const stiff_integrator *s = m->memory;
    return s->passed == 1 + (int)w ||
           (function_least(&s->function[w]) > 0 &&
            (w < EVENT_OF_STICTION || function_least(&s->far[w]) > 0));
}

void stiff_dense_output(const arm *a, motion *m, output_quantity of, double from,
                        double to, int count, value_and_slope *at)
{
    const stiff_integrator *s = m->memory;
    const double width = count > 0 ? (to - from) / count : 0;
    for (int i = 0; i <= count; i++) {
        const double x = (s->used + (from + i * width)) / s->step.length;
        if (of == OUTPUT_HUB) {
            radau_weights weight;
            radau_weights_at(x, &weight);
            const body_motion hub = body_at(s, 0, x, &weight);
            at[i] = (value_and_slope){hub.q, hub.w};
        } else if (of == OUTPUT_GAP && !wall_stands(&a->wall)) {
            at[i] = (value_and_slope){HUGE_VAL, 0};
        } else if (of == OUTPUT_GAP) {
            at[i] = by_time(s, function_at(&s->gap, x));
        } else {
            at[i] = by_time(s, function_at(&s->force, x));
        }
    }
}

void stiff_first_event(const arm *a, motion *m, step_end *end)
{
    const stiff_integrator *s = m->memory;
    const int event = (int)s->kept[STIFF_EVENT];
    (void)a;
    end->any = event > 0 && end->length >= s->kept[KEPT_LENGTH] - s->used;
    if (end->any) {
        end->first = (event_function)(event - 1);
    } else {
        end->first = EVENT_OF_GAP;
    }
}

// --- event functions -------------------------------------------------------------------

// Takes the zero out of an event function that starts at zero just after an event: each
// of its first terms that is within `limits` is rounding, and the function is divided by
// time for each of them (edge_limits.h). The sign of the rest is that of the function.
static void deflate_event_root(stiff_integrator *s, event_function w,
                               const double limits[3])
{
    double terms[4];
    function_start(&s->function[w], terms);
    const int powers = edge_powers(terms, limits, s->step.length);
    for (int i = 0; i < powers; i++) {
        function_divide(&s->function[w]);
        s->divided[w] = true;
    }

    // A negative value that is left at the start is the step's own error if the force
    // presses at all stages, or the gap is open at all of them. If three terms were taken
    // out, it is rounding.
    double *start = s->function[w].b;
    bool holds =
        (w == EVENT_OF_FORCE && powers > 0) || (w == EVENT_OF_GAP && powers == 3);
    for (int i = 0; i < RADAU_STAGES && holds; i++) {
        if (w == EVENT_OF_FORCE) {
            holds = s->step.force.at[i] > 0;
        } else {
            holds = function_at(&s->function[w], radau_node[i]).value > 0;
        }
    }
    double share = LACKS;
    if (!holds) {
        if (powers == 3) {
            share = FLAT;
        } else {
            share = 0;
        }
    }
    if (*start < 0 && *start > -share * function_greatest(&s->function[w])) {
        *start = -*start;
    }
}

// Sets the event functions of an arm in contact with a wall that gives. One is the depth.
// The other is, for Kelvin and Voigt's law, the force; it gets its exact slope at the
// start, which decides whether the arm stays. For Hunt and Crossley's law, whose force is
// (k + c v) times a power of the depth, it is the factor k + c v.
static void set_compliant_functions(stiff_integrator *s, const arm *a, const motion *m)
{
    s->function[EVENT_OF_GAP] = s->gap;
    function_scale(&s->function[EVENT_OF_GAP], -1, 0);
    if (a->wall.law == WALL_KELVIN_VOIGT) {
        const double grows = -a->wall.stiffness * m->state[SLOT_GAP_VELOCITY] -
                             a->wall.damping * m->state[SLOT_GAP_ACCELERATION];
        function_through_rising(&s->function[EVENT_OF_FORCE], stiff_force(s),
                                s->step.length * grows);
        return;
    }

    // the factor of Hunt and Crossley's law
    double factor[RADAU_LANES];
    for (int i = 0; i < RADAU_LANES; i++) {
        factor[i] = a->wall.stiffness - a->wall.damping * s->step.rate.at[i];
    }
    function_through(&s->function[EVENT_OF_FORCE], factor);
}

// Makes the polynomial of the gap to the wall's face: the integral of the one through its
// rates at the stages, with the acceleration at the start, from the value at the start.
static void set_gap(stiff_integrator *s, const arm *a, const motion *m)
{
    const double h = s->step.length;

    // where it starts: at zero just after an event; in a flight too low to be told from
    // rounding, where the step before ended
    double start = m->state[SLOT_GAP], rates[RADAU_LANES];
    const wall_model wall = wall_at(&a->wall, m->state[SLOT_TIME]);
    const bool jumped = m->state[SLOT_JUMPED] != 0;
    if ((jumped && fabs(start) <= EDGE_GAP) || (!jumped && s->kept[STIFF_GAP] != 0)) {
        start = jumped ? 0 : s->kept[STIFF_GAP];
    }

    // the arm's rate, and that of a face that swings
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

    // the end of a low flight is kept for the next step
    const double end = s->gap.b[s->gap.degree];
    if (function_greatest(&s->gap) < LOW_FLIGHT) {
        s->kept[STIFF_GAP] = end;
    } else {
        s->kept[STIFF_GAP] = 0;
    }
}

// Makes a gap or depth zero if throughout the step it is within the rounding error of a
// place, as its sign then says nothing.
static void ignore_rounding(stiff_function *f)
{
    if (function_least(f) > -EDGE_PLACE && function_greatest(f) < EDGE_PLACE) {
        *f = (stiff_function){.degree = f->degree};
    }
}

// Sets the event functions of the wall: the force, which ends contact, and the gap (or
// depth), which begins it. Just after an event their zeros at the start are taken out.
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
        if (distance->b[0] < 0 && distance->b[0] > -EDGE_DEPTH &&
            distance->b[1] > distance->b[0]) {
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
        deflate_event_root(s, EVENT_OF_FORCE, reaction);
    }
    if (!now.contact || m->wall_gives) {
        double gap[3];
        motion_gap_edges(a, m, gap);
        deflate_event_root(s, EVENT_OF_GAP, gap);
    }
}

// Sets the event function of the hub's friction: of a sliding hub its velocity in the
// direction in which it slides, of a stuck one what is left up to stiction, in both
// directions.
static void set_hub_functions(stiff_integrator *s, const arm *a, const motion *m,
                              contact_state now)
{
    const bool jumped = m->state[SLOT_JUMPED] != 0;

    // a sliding hub, whose velocity may start at zero just after an event
    if (now.friction != HUB_STICK) {
        double rate[RADAU_LANES];
        for (int i = 0; i < RADAU_LANES; i++) {
            rate[i] = now.friction * s->step.stage[0].w[i / 4][i % 4];
        }
        function_through(&s->function[EVENT_OF_HUB], rate);
        if (jumped) {
            const double limits[] = {0, EDGE_RATE * motion_rounding(a, m), EDGE_MORE};
            function_through_rising(&s->function[EVENT_OF_HUB], rate,
                                    now.friction * s->step.length * s->step.a0[0]);
            deflate_event_root(s, EVENT_OF_HUB, limits);
        }
        return;
    }

    // a stuck hub: how far the held torque is from the limit that is nearer at the start,
    // and from the farther one in the other direction
    stiff_function *near = &s->function[EVENT_OF_STICTION];
    function_through(near, s->step.hold.at);
    const double sign = near->b[0] < 0 ? 1 : -1;
    stiff_function *far = &s->far[EVENT_OF_STICTION];
    *far = *near;
    function_scale(near, sign, a->motor.stiction);
    function_scale(far, -sign, a->motor.stiction);

    // a torque that starts at the limit is raised above its rounding
    if (jumped && fabs(near->b[0]) <= EDGE_VALUE) {
        s->stiction_excess = EDGE_VALUE - near->b[0];
    } else {
        s->stiction_excess = 0;
    }
    function_scale(near, 1, s->stiction_excess);
}

// Sets the event function of a drive whose current is limited: how far the current is
// from its limits or, while it is limited, how far the current that the voltage would
// drive is beyond the limit.
static void set_current_function(stiff_integrator *s, const arm *a)
{
    const motor_model *motor = &a->motor;
    const double most = motor->current_limit, side = s->step.limited < 0 ? -1 : 1;

    // from the nearer limit, and from the farther one on the other side
    double current[RADAU_LANES];
    for (int i = 0; i < RADAU_LANES; i++) {
        current[i] = side * s->step.current.at[i];
    }
    stiff_function *near = &s->function[EVENT_OF_CURRENT];
    function_through(near, current);
    s->far[EVENT_OF_CURRENT] = *near;
    function_scale(&s->far[EVENT_OF_CURRENT], 1, most);
    function_scale(near, -1, most);

    // at the limit, the current by voltage and back EMF
    if (s->step.drive == STIFF_LIMITED) {
        for (int i = 0; i < RADAU_LANES; i++) {
            const double w = s->step.stage[0].w[i / 4][i % 4];
            current[i] = side * (motor->gain * motor->voltage - motor->back_emf * w) /
                         motor->resistance;
        }
        function_through(near, current);
        function_scale(near, 1, -most);
    }

    // just after a change of the drive's equation it starts at zero, which is taken out;
    // a current that leaves its limit does so without a slope
    if (s->turned) {
        near->b[0] = 0;
    }
    const double rounding = EDGE_CURRENT * most;
    const double rate = motor->inductance > 0 ? motor->resistance / motor->inductance : 0;
    const double edge[] = {rounding, rounding * rate, 0};
    deflate_event_root(s, EVENT_OF_CURRENT, edge);
    if (s->turned) {
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
