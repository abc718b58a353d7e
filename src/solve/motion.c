#include "src/solve/motion.h"

#include <assert.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/extremes.h"
#include "src/solve/edge_limits.h"

// The fastest decay of the two-link series [1/s]: so cheap are they that half a million strides
// take a third of a second.
#define FASTEST_OF_PAIR 2e6

// The remainders of decays change little within this share of the time since the event.
#define GRADING    0.2

#define CACHE_LINE 64 // [bytes]

// A link that friction holds so near the wall rests on it [m].
#define RESTING_GAP 1e-12

// A few units in the last place of an acceleration, relative to 1e-9, which counts as zero in a
// slow soft arm.
#define LAST_BITS 4e-4

// The engine asked for by name, NULL where the arm is to decide.
static const engine *named_engine(engine_kind name)
{
    static const engine *const named[] = {[ENGINE_AUTO] = NULL,
                                          [ENGINE_PAIR] = &taylor_engine,
                                          [ENGINE_STIFF] = &stiff_engine,
                                          [ENGINE_SERIES] = &series_engine};
    return named[name];
}

// Whether the wall's force is one that the series follow in strides no shorter than the arm's: with
// a power series at the touch, and a damper that slows the tip of the free last link (a mass m/4)
// and what moves with it no faster than the arm vibrates.
static bool wall_suits_series(const arm *a)
{
    const wall_model *w = &a->wall;
    const double tip = arm_link_mass(a, a->links - 1) / 4 + a->tip_mass + w->face_mass;
    const bool slow = w->damping <= 2 * a->highest_frequency * tip;
    return !wall_stands(w) || !wall_gives(w) || (w->law == WALL_KELVIN_VOIGT && slow);
}

// Whether vibrations of the arm go on for ever but for what motor and wall take: nothing else damps
// them. An engine that controls its error then has steps as short as the strides of the series,
// which are exact and up to three times cheaper.
static bool rings_on(const arm *a)
{
    bool damped = a->damped_modes > 0 || a->air_drag > 0 || a->fastest_decay > a->highest_frequency;
    for (int k = 0; k < a->links && !damped; k++) {
        damped = arm_joint_damping(a, k) > 0;
    }
    return !damped && a->stiffening == 0 && a->motor.inductance == 0;
}

// The event method's engine: series of two equal links on a rigid wall, series of chains that ring
// on, the stiff engine for all others. It does not depend on the time step.
static const engine *event_engine(const arm *a)
{
    if (taylor_engine_suits(a) && a->fastest_decay <= FASTEST_OF_PAIR) {
        return &taylor_engine;
    }
    return rings_on(a) && wall_suits_series(a) ? &series_engine : &stiff_engine;
}

static void choose_engine(const arm *a, motion *m, const method_parameters *method,
                          const engine *chosen)
{
    double rho = method->spectral_radius;
    m->electric = a->motor.electric;
    m->wall_has_face = wall_stands(&a->wall) && wall_has_face(&a->wall);
    m->wall_gives = wall_stands(&a->wall) && wall_gives(&a->wall) && !m->wall_has_face;

    // the engine, and its coefficients
    if (method->name == METHOD_NEWMARK) {
        m->engine = &newmark_engine;
        m->beta = method->beta;
        m->gamma = method->gamma;
    } else if (method->name == METHOD_GENERALIZED_ALPHA) {
        m->engine = &generalized_alpha_engine;
        // Chung and Hulbert (1993), equations (17), (18), (25)
        m->alpha_m = (2 * rho - 1) / (rho + 1);
        m->alpha_f = rho / (rho + 1);
        m->gamma = 0.5 - m->alpha_m + m->alpha_f;
        m->beta = 0.25 * (1 - m->alpha_m + m->alpha_f) * (1 - m->alpha_m + m->alpha_f);
    } else {
        const engine *wanted = chosen != NULL ? chosen : named_engine((engine_kind)method->engine);
        m->engine = wanted != NULL ? wanted : event_engine(a);
        m->chosen = wanted != NULL;
        m->tolerance = method->tolerance;
    }
}

// Divides one block of memory into parts, each on cache lines of its own. Adding parts without a
// block first gives the size that the block needs.
typedef struct layout {
    char *block;   // NULL: there is none yet
    size_t length; // [bytes]
} layout;

static void *add_part(layout *l, size_t size)
{
    void *part = l->block != NULL ? l->block + l->length : NULL;
    l->length += (size + CACHE_LINE - 1) / CACHE_LINE * CACHE_LINE;
    return part;
}

// A block that has room for so many bytes from its first whole cache line on, zeroed; NULL if out
// of memory. Pages of a large one are the system's until they are touched: of many links most never
// are.
static void *zeroed_block(size_t length)
{
    return calloc(1, length + CACHE_LINE - 1);
}
static char *first_line(void *block)
{
    const size_t beyond = (uintptr_t)block % CACHE_LINE;
    return (char *)block + (CACHE_LINE - beyond) % CACHE_LINE;
}

// Lays out what belongs to the engine.
static void lay_out_engine(const arm *a, motion *m, layout *l)
{
    const engine *e = m->engine;
    const size_t state = (size_t)m->size * sizeof(double), links = (size_t)a->links;
    m->memory = add_part(l, e->memory_for != NULL ? e->memory_for(a) : e->memory_size);
    m->between = add_part(l, e->states_at != NULL ? MOTION_TOGETHER * state : state);
    m->sweeps = add_part(l, links * e->link_scratch);
}

// Lays out everything else.
static void lay_out_motion(const arm *a, motion *m, layout *l)
{
    const size_t state = (size_t)m->most_size * sizeof(double);
    m->state = add_part(l, state);
    m->trial = add_part(l, state);
    m->scratch = add_part(l, 4 * (size_t)a->dof * sizeof(double));
    m->links = add_part(l, (size_t)a->links * sizeof(chain_link));
}

// Allocates the engine's storage; false, with nothing allocated, if out of memory.
static bool open_engine(const arm *a, motion *m)
{
    layout l = {0};
    lay_out_engine(a, m, &l);
    m->engine_block = zeroed_block(l.length);
    if (m->engine_block == NULL) {
        return false;
    }
    l = (layout){.block = first_line(m->engine_block)};
    lay_out_engine(a, m, &l);
    if (m->engine->open != NULL) {
        m->engine->open(a, m);
    }
    return true;
}

// Numbers in a state of an engine.
static int size_of_states(const arm *a, const motion *m, const engine *e)
{
    return m->head_size + (e->kept_for != NULL ? (int)e->kept_for(a) : 0);
}

// The same of the engine that has the most of those that a changed arm may get.
static int most_size(const arm *a, const motion *m)
{
    const bool stays = motion_is_implicit(m) || m->chosen;
    return size_of_states(a, m, stays ? m->engine : &stiff_engine);
}

motion *motion_create(const arm *a, const method_parameters *method)
{
    return motion_create_by(a, method, NULL);
}

motion *motion_create_by(const arm *a, const method_parameters *method, const engine *chosen)
{
    assert(a != NULL && method != NULL && a->dof > 0 && method->step > 0);
    motion *m = calloc(1, sizeof *m);
    if (m == NULL) {
        return NULL;
    }
    m->dof = a->dof;
    m->link_count = a->links;
    m->nominal_step = method->step;
    m->cut = HUGE_VAL;
    m->head_size = SLOT_COUNT + 4 * a->dof + QUADRATURE_COUNT + KEPT_COUNT;
    choose_engine(a, m, method, chosen);
    m->size = size_of_states(a, m, m->engine);
    m->most_size = most_size(a, m);

    // its storage: all of it or none
    layout l = {0};
    lay_out_motion(a, m, &l);
    m->block = zeroed_block(l.length);
    if (m->block != NULL) {
        l = (layout){.block = first_line(m->block)};
        lay_out_motion(a, m, &l);
    }
    if (m->block == NULL || !open_engine(a, m)) {
        motion_destroy(m);
        return NULL;
    }
    return m;
}

motion *motion_renew(motion *m, const arm *a, const method_parameters *method)
{
    assert(m == NULL || (a != NULL && method != NULL && method->step > 0));
    if (m == NULL || m->dof != a->dof || a->links != m->link_count || m->starved) {
        motion_destroy(m);
        return motion_create(a, method);
    }

    // storage of the same sizes can be reused as it is
    motion next = {.state = m->state,
                   .size = m->size,
                   .head_size = m->head_size,
                   .dof = m->dof,
                   .link_count = m->link_count,
                   .nominal_step = method->step,
                   .cut = HUGE_VAL,
                   .trial = m->trial,
                   .between = m->between,
                   .scratch = m->scratch,
                   .links = m->links,
                   .sweeps = m->sweeps,
                   .memory = m->memory,
                   .forgets = true,
                   .block = m->block,
                   .engine_block = m->engine_block};
    choose_engine(a, &next, method, NULL);
    next.most_size = most_size(a, &next);
    if (next.engine != m->engine || next.engine->memory_for != NULL ||
        next.most_size > m->most_size) {
        motion_destroy(m);
        return motion_create(a, method);
    }
    *m = next;
    if (m->engine->open != NULL) {
        m->engine->open(a, m);
    }
    return m;
}

void motion_destroy(motion *m)
{
    if (m != NULL) {
        free(m->engine_block);
        free(m->block);
        free(m);
    }
}

void motion_follow_arm(const arm *a, motion *m)
{
    assert(a != NULL && m != NULL && a->dof == m->dof);
    const bool stays = motion_is_implicit(m) || m->chosen;
    const engine *wanted = stays ? m->engine : event_engine(a);
    if (wanted == m->engine && !m->starved) {
        return;
    }
    free(m->engine_block);
    m->ahead.known = false;
    m->engine = wanted;
    m->size = size_of_states(a, m, wanted);
    m->starved = !open_engine(a, m);
    motion_end_stride(m);

    // it knows nothing yet of the strides to come
    memset(m->state + m->head_size, 0, (size_t)(m->size - m->head_size) * sizeof *m->state);
}

void motion_evaluate(const arm *a, motion *m, double *state)
{
    chain_reaction r;
    contact_state mode = contact_state_of(state);
    mode.current = state_quadratures(m, state)[QUADRATURE_CURRENT];
    chain_accelerations(a, m->links, state_angles(m, state), state_velocities(m, state), mode,
                        state_accelerations(m, state), &r);
    state[SLOT_MOTOR_TORQUE] = r.motor_torque;
    state[SLOT_FORCE] = r.force;
    state[SLOT_FRICTION_TORQUE] = r.friction;
    state[SLOT_GAP_ACCELERATION] = r.gap_acceleration;
    state[SLOT_GAP] = r.gap;
    state[SLOT_GAP_VELOCITY] = r.gap_velocity;
    state[SLOT_VISCOUS_POWER] = r.viscous_power;
    state[SLOT_DAMPING_POWER] = r.damping_power;
    state[SLOT_WALL_POWER] = r.wall_power;

    // the wall's face goes with the arm in contact, else the gap is that to it
    if (mode.contact && !motion_wall_is_rigid(m)) {
        state[SLOT_FACE] = -r.gap;
        state[SLOT_FACE_VELOCITY] = -r.gap_velocity;
    } else if (state_face_swings(state)) {
        const wall_face face = state_face(state);
        state[SLOT_GAP] += face.position;
        state[SLOT_GAP_VELOCITY] += face.velocity;
        state[SLOT_GAP_ACCELERATION] += wall_face_acceleration(&a->wall, face);
    }
}

force_bounds motion_held_forces(const arm *a, const motion *m, double *state)
{
    assert(a != NULL && m != NULL && state != NULL && m->dof == 1 && wall_stands(&a->wall));
    const double one = 1, lever = chain_penetration_rate(a, state_angles(m, state), &one);
    const double balanced = (a->motor.torque + state[SLOT_MOTOR_TORQUE]) / lever;
    const double friction = a->motor.stiction / fabs(lever);
    return (force_bounds){larger(balanced - friction, 0), larger(balanced + friction, 0)};
}

force_bounds motion_force_bounds(const arm *a, const motion *m, double *state)
{
    assert(a != NULL && m != NULL && state != NULL);
    const contact_state now = contact_state_of(state);
    const bool single = m->dof == 1 && wall_stands(&a->wall) && motion_wall_is_rigid(m);
    const bool near = state[SLOT_GAP] <= RESTING_GAP && now.friction == HUB_STICK;
    const bool rests = single && state_velocities(m, state)[0] == 0 && (now.contact || near);
    return rests ? motion_held_forces(a, m, state)
                 : (force_bounds){state[SLOT_FORCE], state[SLOT_FORCE]};
}

void motion_watch(motion *m)
{
    m->pulse_peak = -1;
    m->pulse_peak_time = m->state[SLOT_TIME];
}

double motion_rounding(const arm *a, const motion *m)
{
    return motion_rounding_at(a, m->dof, state_angles(m, m->state), state_velocities(m, m->state));
}

double motion_face_rounding(const arm *a, const motion *m)
{
    return m->wall_has_face ? EDGE_PLACE * a->wall.stiffness : 0;
}

void motion_gap_edges(const arm *a, const motion *m, double limits[3])
{
    // a rounding error of the force accelerates a face by that error over its mass, and so does
    // that of its spring, by the face's place; one without a mass returns at a rate that has the
    // error of the place where it was left
    const bool returns = m->wall_gives && state_face_swings(m->state);
    const double rate = returns ? wall_face_rate(&a->wall, state_face(m->state)) : 0;
    const double yields = m->wall_has_face ? 1 / a->wall.face_mass : 0;
    limits[0] = EDGE_GAP;
    limits[1] = EDGE_RATE + EDGE_PLACE * rate;
    limits[2] = EDGE_RATE * (motion_rounding(a, m) + yields) + EDGE_PLACE * rate * rate +
                yields * motion_face_rounding(a, m);
    limits[2] = fmax(EDGE_MORE, limits[2]);
}

double motion_rounding_at(const arm *a, int dof, const double *q, const double *w)
{
    double angle = 0, rate = 0;
    for (int i = 0; i < dof; i++) {
        angle = larger(fabs(q[i]), angle);
        rate = larger(fabs(w[i]), rate);
    }
    return 1 + LAST_BITS * (a->highest_frequency * a->highest_frequency * angle + rate * rate);
}

double motion_decay_length(const arm *a, double reach, double since)
{
    return fmax(GRADING * since, reach / fmax(a->highest_frequency, a->fastest_decay));
}

double motion_wall_compliance(const arm *a, motion *m, double *state)
{
    double compliance;
    const bool locked = contact_state_of(state).friction == HUB_STICK && m->dof > 1;
    chain_contact_response(a, m->links, state_angles(m, state), locked, m->scratch, &compliance);
    return compliance / (1 + a->wall.face_mass * compliance); // both masses on the spring
}

double motion_wall_rate(const arm *a, motion *m, double *state)
{
    if (motion_wall_is_rigid(m) || !contact_state_of(state).contact) {
        return state_face_swings(state) ? wall_face_rate(&a->wall, state_face(state)) : 0;
    }
    return wall_rate(&a->wall, motion_wall_compliance(a, m, state), fmax(-state[SLOT_GAP], 0),
                     -state[SLOT_GAP_VELOCITY]);
}

double motion_vibration(const arm *a, motion *m, double *state)
{
    // most have nothing but their own
    if (motion_wall_is_rigid(m) && a->stiffening == 0 && a->motor.inductance == 0) {
        return a->highest_frequency;
    }
    const double wall = motion_wall_rate(a, m, state);
    const double current = a->motor.inductance > 0 ? a->motor.resistance / a->motor.inductance : 0;
    const double own = a->highest_frequency * chain_stiffened(a, state_angles(m, state));
    return wall > 0 || current > 0 ? sqrt(own * own + wall * wall + current * current) : own;
}

state_energy motion_energy(const arm *a, const motion *m, double *state)
{
    const double *q = state_angles(m, state), *w = state_velocities(m, state);
    return (state_energy){chain_kinetic_energy(a, q, w), chain_strain_energy(a, q)};
}

double motion_energy_residual(const arm *a, const motion *m, double *state)
{
    const state_energy has = motion_energy(a, m, state);
    const double energy = has.kinetic + has.strain;
    return motion_unaccounted(m, state, energy + motion_wall_energy(a, m, state));
}

// --- a step of smooth motion ----------------------------------------------------------------

bool motion_project(const arm *a, motion *m, double *state)
{
    bool locked = contact_state_of(state).friction == HUB_STICK;
    if (m->dof == 1 || !motion_drifted(state[SLOT_GAP], state[SLOT_GAP_VELOCITY])) {
        return false;
    }
    double compliance, *response = m->scratch;
    double *q = state_angles(m, state), *w = state_velocities(m, state);
    chain_contact_response(a, m->links, q, locked, response, &compliance);

    // position first, then velocity at the new position
    double shift = -state[SLOT_GAP] / compliance; // g = -gap falls along the response
    for (int i = 0; i < m->dof; i++) {
        q[i] += shift * response[i];
    }
    double jump = chain_penetration_rate(a, q, w) / compliance;
    for (int i = 0; i < m->dof; i++) {
        w[i] += jump * response[i];
    }
    motion_evaluate(a, m, state);
    return true;
}

double motion_begin_stride(const arm *a, motion *m, double remaining, double step)
{
    return motion_held_still(m) ? remaining : m->engine->begin(a, m, remaining, step);
}

// A step of an arm that is held still: only time passes.
static void let_time_pass(motion *m, double h)
{
    memcpy(m->trial, m->state, (size_t)m->size * sizeof(double));
    m->trial[SLOT_TIME] += h;
    state_quadratures(m, m->trial)[QUADRATURE_FORCE] += h * m->state[SLOT_FORCE];
}

// The parts of a state, `h` after another one, that need no evaluation.
static void set_slots(const arm *a, const motion *m, double *from, double h, double *state)
{
    static const int kept[] = {QUADRATURE_WALL, QUADRATURE_CURRENT, QUADRATURE_MOTOR};
    memcpy(state, from, SLOT_COUNT * sizeof(double));
    state[SLOT_TIME] += h;
    state[SLOT_JUMPED] = state[SLOT_IMPULSE] = 0;
    for (size_t i = 0; i < sizeof kept / sizeof *kept; i++) {
        state_quadratures(m, state)[kept[i]] = state_quadratures(m, from)[kept[i]];
    }
    if (state_face_swings(from)) {
        const wall_face face = wall_face_after(&a->wall, state_face(from), h);
        state[SLOT_FACE] = face.position;
        state[SLOT_FACE_VELOCITY] = face.velocity;
    }
}

// Updates the energy ledger of an evaluated state from that of an earlier one.
static void book(const arm *a, const motion *m, double *from, double *state)
{
    if (state_face_swings(from)) {
        state_quadratures(m, state)[QUADRATURE_WALL] +=
            motion_wall_energy(a, m, from) - motion_wall_energy(a, m, state);
    }
    motion_book(a, m, state_angles(m, from)[0], state);
}

static bool is_finite(const motion *m, double *state)
{
    double sum = state[SLOT_FORCE];
    for (int i = 0; i < 2 * m->dof; i++) {
        sum += state_angles(m, state)[i];
    }
    return isfinite(sum);
}

status motion_try_step(const arm *a, motion *m, double h)
{
    double *trial = m->trial;
    m->holds = unknown_energy;
    if (motion_held_still(m)) {
        let_time_pass(m, h);
        return STATUS_OK;
    }

    set_slots(a, m, m->state, h, trial);
    status s = m->engine->state_at(a, m, h);
    if (s != STATUS_OK) {
        return s;
    }

    if (m->engine->kept_for == NULL) {
        book(a, m, m->state, trial);
    }
    return is_finite(m, trial) ? STATUS_OK : STATUS_NOT_FINITE;
}

bool motion_between_all(const arm *a, motion *m, const double *times, int count,
                        state_energy *energies)
{
    assert(a != NULL && m != NULL && count >= 1 && count <= MOTION_TOGETHER);
    double *start = m->trial, *states[MOTION_TOGETHER], h[MOTION_TOGETHER];
    if (m->engine->states_at == NULL || state_is_held_still(m, start) || count < 1) {
        return false;
    }

    for (int i = 0; i < count; i++) {
        states[i] = m->between + i * m->size;
        h[i] = times[i] - start[SLOT_TIME];
        set_slots(a, m, start, h[i], states[i]);
    }
    if (!m->engine->states_at(a, m, start, h, count, states, energies)) {
        return false;
    }

    bool finite = true;
    for (int i = 0; i < count; i++) {
        book(a, m, start, states[i]);
        states[i][SLOT_TIME] = times[i];
        finite = finite && is_finite(m, states[i]);
    }
    return finite;
}
