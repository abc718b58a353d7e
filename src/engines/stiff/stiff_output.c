// What a step of the stiff engine tells of itself (engine.h): its states, by the polynomials
// through its stages, and the event functions.
#include <float.h>
#include <math.h>
#include <string.h>

#include "src/base/extremes.h"
#include "src/engines/stiff/stiff_integrator.h"

// Share of a power's largest value by which it may differ at a start from what the stages say.
#define LITTLE 1e-2

// --- states --------------------------------------------------------------------------------------

// What numbers at the stages add up to with such weights.
static inline double weighted(const double *weight, const double *stages)
{
    double sum = 0;
    for (int j = 0; j < RADAU_STAGES; j++) {
        sum += weight[j] * stages[j];
    }
    return sum;
}

// Angle, velocity and acceleration of body k at x of the step, which the weights are for.
typedef struct body_motion {
    double q, w, a;
} body_motion;

static inline body_motion body_at(const stiff_integrator *s, int k, double x,
                                  const radau_weights *weight)
{
    const double h = s->kept[STIFF_LENGTH], w0 = stiff_velocities(s)[k];
    const double *stages = stiff_accelerations(s) + RADAU_LANES * k;
    return (body_motion){stiff_angles(s)[k] + h * (x * w0 + h * weighted(weight->twice, stages)),
                         w0 + h * weighted(weight->integral, stages),
                         weighted(weight->value, stages)};
}

// What the power of a quadrature at the step's start adds there to that by the stages, which have
// it for a whole step: the next order of the polynomial through them. Nothing where the start shows
// a transient that they do not.
static double start_adds(const stiff_integrator *s, int of, const radau_weights *weight)
{
    const double *values = s->kept + STIFF_VALUES + of * RADAU_LANES;
    double value[RADAU_LANES], most = 0;
    radau_values_at(0, value);
    for (int j = 0; j < RADAU_STAGES; j++) {
        most = larger(fabs(values[j]), most);
    }
    const double more = values[RADAU_STAGES] - weighted(value, values);
    return fabs(more) < LITTLE * most ? s->kept[STIFF_LENGTH] * weight->start * more : 0;
}

// A quadrature there.
static double quadrature_at(const stiff_integrator *s, int of, const radau_weights *weight)
{
    return s->kept[STIFF_QUADRATURES + of] +
           s->kept[STIFF_LENGTH] *
               weighted(weight->integral, s->kept + STIFF_VALUES + of * RADAU_LANES);
}

// Angles, velocities and what has added up at `time` after the step's start, evaluated.
void stiff_state_within(const stiff_integrator *s, const arm *a, motion *m, double time,
                        double *state)
{
    const double x = time / s->kept[STIFF_LENGTH];
    double *q = state_angles(m, state), *w = state_velocities(m, state);
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
            state_quadratures(m, state)[i] += start_adds(s, i, &weight);
        }
    }
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
    const double turned = q[0] - stiff_angles(s)[0];
    state[SLOT_MOTOR_WORK] = s->kept[STIFF_WORK] + a->motor.torque * turned;
    state[SLOT_FRICTION_LOSS] =
        s->kept[STIFF_RUBBED] + state[SLOT_FRICTION] * a->motor.stiction * turned;
    memcpy(state_algorithmic(m, state), state_accelerations(m, state),
           (size_t)m->dof * sizeof(double));
}

// What sensors see of the state at `time` after the step's start, as the stages have it and not
// evaluated.
static void sense_within(const stiff_integrator *s, const arm *a, const motion *m, double time,
                         double *state)
{
    const double x = time / s->kept[STIFF_LENGTH];
    const int seen[] = {0, a->first, a->dof - 1};
    radau_weights weight;
    radau_weights_at(x, &weight);
    for (int i = 0; i < (int)(sizeof seen / sizeof *seen); i++) {
        const body_motion at = body_at(s, seen[i], x, &weight);
        state_angles(m, state)[seen[i]] = at.q;
        state_velocities(m, state)[seen[i]] = at.w;
        state_accelerations(m, state)[seen[i]] = at.a;
    }
    state[SLOT_FORCE] = function_at(&s->force, x).value;
    state_quadratures(m, state)[QUADRATURE_FORCE] = quadrature_at(s, QUADRATURE_FORCE, &weight);
}

status stiff_state_at(const arm *a, motion *m, double h, state_extent extent)
{
    const stiff_integrator *s = m->memory;
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

static value_and_slope by_time(const stiff_integrator *s, value_and_slope g)
{
    return (value_and_slope){g.value, g.slope / s->step.length};
}

value_and_slope stiff_event_function(const arm *a, const motion *m, event_function w, double h)
{
    const stiff_integrator *s = m->memory;
    const double x = (s->used + h) / s->step.length;
    value_and_slope near = function_at(&s->function[w], x);
    if (w >= EVENT_OF_STICTION) {
        const value_and_slope far = function_at(&s->far[w], x);
        near = near.value < far.value ? near : far;
    }
    (void)a;
    return by_time(s, near);
}

double stiff_second_derivative(const arm *a, const motion *m, event_function w, double from,
                               double to)
{
    const stiff_integrator *s = m->memory;
    const double length = s->step.length;
    const double x0 = (s->used + from) / length, x1 = (s->used + to) / length;
    const stiff_function *f = s->used > 0 && w == EVENT_OF_FORCE ? &s->force : &s->function[w];
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
    return s->passed == 1 + (int)w || (function_least(&s->function[w]) > 0 &&
                                       (w < EVENT_OF_STICTION || function_least(&s->far[w]) > 0));
}

void stiff_dense_output(const arm *a, motion *m, output_quantity of, double from, double to,
                        int count, value_and_slope *at)
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
        } else {
            at[i] = by_time(s, function_at(of == OUTPUT_GAP ? &s->gap : &s->force, x));
        }
    }
}

void stiff_first_event(const arm *a, motion *m, step_end *end)
{
    const stiff_integrator *s = m->memory;
    const int event = (int)s->kept[STIFF_EVENT];
    (void)a;
    end->any = event > 0 && end->length >= s->kept[KEPT_LENGTH] - s->used;
    end->first = end->any ? (event_function)(event - 1) : EVENT_OF_GAP;
}
