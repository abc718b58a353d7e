// What a step of the stiff engine tells of itself (engine.h): its states, by the polynomials
// through its stages, and the watched functions.
#include <float.h>
#include <math.h>
#include <string.h>

#include "src/base/extremes.h"
#include "src/engines/stiff/stiff_stride.h"

// --- states --------------------------------------------------------------------------------------

// The quadratures' integrals from the step's start, with these weights.
static void add_quadratures(const stiff_stride *s, const motion *m, const double *weight,
                            double *state)
{
    static const int of[][2] = {
        {QUADRATURE_VISCOUS, STIFF_VISCOUS},      {QUADRATURE_DAMPING, STIFF_LOST},
        {QUADRATURE_FORCE, STIFF_FORCE},          {QUADRATURE_WALL, STIFF_WALL_LOST},
        {QUADRATURE_CURRENT, STIFF_CURRENT_RATE}, {QUADRATURE_MOTOR, STIFF_ELECTRIC},
        {QUADRATURE_PUSHED, STIFF_PUSHED}};
    double *after = state_quadratures(m, state);
    for (int i = 0; i < (int)(sizeof of / sizeof *of); i++) {
        double sum = 0;
        for (int j = 0; j < RADAU_STAGES; j++) {
            sum += weight[j] * s->kept[of[i][1] + j];
        }
        after[of[i][0]] = s->kept[STIFF_QUADRATURES + of[i][0]] + s->kept[STIFF_LENGTH] * sum;
    }
}

// Angles, velocities and what has added up at `time` after the step's start, evaluated.
void stiff_state_within(const stiff_stride *s, const arm *a, motion *m, double time, double *state)
{
    const double h = s->kept[STIFF_LENGTH], x = time / h;
    const double *q0 = stiff_angles(s), *w0 = stiff_velocities(s);
    const double *acceleration = stiff_accelerations(s);
    double *q = state_angles(m, state), *w = state_velocities(m, state);
    radau_weights weight;
    radau_weights_at(x, &weight);
    for (int k = 0; k < s->step.dof; k++) {
        double once = 0, twice = 0;
        for (int j = 0; j < RADAU_STAGES; j++) {
            once += weight.integral[j] * acceleration[RADAU_LANES * k + j];
            twice += weight.twice[j] * acceleration[RADAU_LANES * k + j];
        }
        q[k] = q0[k] + h * (x * w0[k] + h * twice);
        w[k] = w0[k] + h * once;
    }
    add_quadratures(s, m, weight.integral, state);
    if (a->motor.electric) {
        double *current = state_quadratures(m, state) + QUADRATURE_CURRENT;
        const double most = a->motor.current_limit;
        *current = a->motor.inductance > 0 ? fmax(-most, fmin(*current, most))
                                           : s->kept[STIFF_QUADRATURES + QUADRATURE_CURRENT];
    }

    // what follows from them
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
    motion_evaluate(a, m, state);
    if (state[SLOT_CONTACT] != 0 && motion_wall_is_rigid(m)) {
        motion_project(a, m, state);
    }
    if (swings) { // what a face left alone loses
        const double work = wall_face_work(&wall, start, time);
        state_quadratures(m, state)[QUADRATURE_PUSHED] += work;
        state_quadratures(m, state)[QUADRATURE_WALL] +=
            wall_face_energy(&wall, start) + work - motion_wall_energy(a, m, state);
    }
    state[SLOT_MOTOR_WORK] = s->kept[STIFF_WORK] + a->motor.torque * (q[0] - q0[0]);
    state[SLOT_FRICTION_LOSS] =
        s->kept[STIFF_RUBBED] + state[SLOT_FRICTION] * a->motor.stiction * (q[0] - q0[0]);
    memcpy(state_algorithmic(m, state), state_accelerations(m, state),
           (size_t)m->dof * sizeof(double));
}

// What sensors see of the state at `time` after the step's start, as the stages have it and not
// evaluated.
static void sense_within(const stiff_stride *s, const arm *a, const motion *m, double time,
                         double *state)
{
    const double h = s->kept[STIFF_LENGTH], x = time / h;
    const int seen[] = {0, a->first, a->dof - 1};
    radau_weights weight;
    radau_weights_at(x, &weight);
    for (int i = 0; i < (int)(sizeof seen / sizeof *seen); i++) {
        const int k = seen[i];
        const double *of_body = stiff_accelerations(s) + RADAU_LANES * k;
        const double w0 = stiff_velocities(s)[k];
        double value = 0, once = 0, twice = 0;
        for (int j = 0; j < RADAU_STAGES; j++) {
            value += weight.value[j] * of_body[j];
            once += weight.integral[j] * of_body[j];
            twice += weight.twice[j] * of_body[j];
        }
        state_angles(m, state)[k] = stiff_angles(s)[k] + h * (x * w0 + h * twice);
        state_velocities(m, state)[k] = w0 + h * once;
        state_accelerations(m, state)[k] = value;
    }
    const double *force = s->kept + STIFF_FORCE;
    double pressed = 0;
    for (int j = 0; j < RADAU_STAGES; j++) {
        pressed += weight.integral[j] * force[j];
    }
    state[SLOT_FORCE] = function_at(&s->force, x).value;
    state_quadratures(m, state)[QUADRATURE_FORCE] =
        s->kept[STIFF_QUADRATURES + QUADRATURE_FORCE] + h * pressed;
}

status stiff_state_at(const arm *a, motion *m, double h, state_extent extent)
{
    const stiff_stride *s = m->memory;
    double *kept = state_kept(m, m->trial);

    // by the instant itself, which is the same whatever stops were made on the way
    double time = m->state[SLOT_TIME] + h;
    time = fabs(time - m->step.aim) <= 4 * DBL_EPSILON * time ? m->step.aim : time;
    if (extent == STATE_SENSED) {
        sense_within(s, a, m, time - s->kept[STIFF_TIME], m->trial);
        return STATUS_OK;
    }
    const bool whole = s->used + h >= s->kept[KEPT_LENGTH];
    const double used = whole ? s->kept[KEPT_LENGTH] : time - s->kept[STIFF_TIME];
    if (whole && s->ended) {
        memcpy(m->trial, s->end, stiff_head_size(m));
        m->trial[SLOT_JUMPED] = m->trial[SLOT_IMPULSE] = 0;
    } else {
        stiff_state_within(s, a, m, used, m->trial);
    }
    memcpy(kept, s->kept, (KEPT_COUNT + stiff_kept_size(a)) * sizeof *kept);
    kept[KEPT_CHANGED] = state_kept(m, m->state)[KEPT_CHANGED];
    kept[KEPT_INTERVAL] = state_kept(m, m->state)[KEPT_INTERVAL];
    kept[KEPT_USED] = used;
    return STATUS_OK;
}

// --- what the contact machine asks ---------------------------------------------------------------

static value_and_slope by_time(const stiff_stride *s, value_and_slope g)
{
    return (value_and_slope){g.value, g.slope / s->step.length};
}

value_and_slope stiff_event_function(const arm *a, const motion *m, event_function w, double h)
{
    const stiff_stride *s = m->memory;
    const double x = (s->used + h) / s->step.length;
    value_and_slope near = function_at(&s->watched[w], x);
    if (w >= EVENT_OF_STICTION) {
        const value_and_slope far =
            function_at(w == EVENT_OF_CURRENT ? &s->far_current : &s->far_limit, x);
        near = near.value < far.value ? near : far;
    }
    (void)a;
    return by_time(s, near);
}

double stiff_second_derivative(const arm *a, const motion *m, event_function w, double from,
                               double to)
{
    const stiff_stride *s = m->memory;
    const double length = s->step.length;
    const double x0 = (s->used + from) / length, x1 = (s->used + to) / length;
    const stiff_function *f = s->used > 0 && w == EVENT_OF_FORCE ? &s->force : &s->watched[w];
    double most = function_curvature(f, x0, x1);
    if (w >= EVENT_OF_STICTION) {
        const stiff_function *far = w == EVENT_OF_CURRENT ? &s->far_current : &s->far_limit;
        most = larger(most, function_curvature(far, x0, x1));
    } else if (w == EVENT_OF_FORCE) {
        most = larger(most, function_curvature(&s->force, x0, x1));
    }
    (void)a;
    return most / (length * length);
}

bool stiff_excludes_event(const motion *m, event_function w)
{
    const stiff_stride *s = m->memory;
    const stiff_function *far = w == EVENT_OF_CURRENT ? &s->far_current : &s->far_limit;
    return s->passed == 1 + (int)w || (function_least(&s->watched[w]) > 0 &&
                                       (w < EVENT_OF_STICTION || function_least(far) > 0));
}

// The hub's angle and velocity at x of the step.
static value_and_slope hub_at(const stiff_stride *s, double x)
{
    const double length = s->step.length, *of_hub = stiff_accelerations(s);
    radau_weights w;
    radau_weights_at(x, &w);
    double once = 0, twice = 0;
    for (int j = 0; j < RADAU_STAGES; j++) {
        once += w.integral[j] * of_hub[j];
        twice += w.twice[j] * of_hub[j];
    }
    const double velocity = stiff_velocities(s)[0];
    return (value_and_slope){stiff_angles(s)[0] + length * (x * velocity + length * twice),
                             velocity + length * once};
}

void stiff_dense_output(const arm *a, motion *m, output_quantity of, double from, double to,
                        int count, value_and_slope *at)
{
    const stiff_stride *s = m->memory;
    const double width = count > 0 ? (to - from) / count : 0;
    for (int i = 0; i <= count; i++) {
        const double x = (s->used + (from + i * width)) / s->step.length;
        if (of == OUTPUT_HUB) {
            at[i] = hub_at(s, x);
        } else if (of == OUTPUT_GAP && !wall_stands(&a->wall)) {
            at[i] = (value_and_slope){HUGE_VAL, 0};
        } else {
            at[i] = by_time(s, function_at(of == OUTPUT_GAP ? &s->gap : &s->force, x));
        }
    }
}

void stiff_first_event(const arm *a, motion *m, double *h, event_function *first, bool *any)
{
    const stiff_stride *s = m->memory;
    const int event = (int)s->kept[STIFF_EVENT];
    (void)a;
    *any = event > 0 && *h >= s->kept[KEPT_LENGTH] - s->used;
    *first = *any ? (event_function)(event - 1) : EVENT_OF_GAP;
}
