#include "src/solve/motion.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/arm/impact.h"
#include "src/solve/implicit_stepper.h"
#include "src/solve/locate.h"

// Strides of a fraction of a time step keep (fastest rate) x (stride) below this; the 8th-order
// method then loses a few parts in 1e12 of the fastest mode's energy in one.
#define EXPLICIT_LIMIT 0.36
// Strides over several time steps, which slow arms take, may go this far: they are few, and what
// they lose in a second is less than the short ones of fast arms do.
#define STRIDE_LIMIT 0.45
// Strides that are cut short and stay below this take the explicit method's brief form, and with
// them all that is located within.
#define BRIEF_LIMIT 0.2
// The event method steps implicitly where the explicit one would need more substeps than this.
#define MOST_SUBSTEPS 90
// The explicit method takes at most this many time steps in one stride.
#define LONGEST_STRIDE  12

#define TOUCH_SPEED     1e-11 // approach speed below which a touch carries no impulse [m/s]
#define MOST_HALVINGS   8     // of a step that does not converge or makes energy
#define LEAST_AFTER_CUT 1e-9  // share of a step; what is left of a stride before a cut is longer
#define PROJECTION_GAP  1e-14 // drift that is projected away in contact [m]
#define PROJECTION_RATE 1e-13 // [m/s]

bool motion_unresolved(const arm *a, const motion *m)
{
    return m->stepper != &explicit_stepper && m->nominal_step * a->fastest_rate > 1;
}

static void choose_stepper(const arm *a, motion *m, const method_parameters *method)
{
    double rho = method->spectral_radius;
    bool too_stiff = a->fastest_rate * method->step > EXPLICIT_LIMIT * MOST_SUBSTEPS;
    if (method->name == METHOD_NEWMARK) {
        m->stepper = &newmark_stepper;
        m->beta = method->beta;
        m->gamma = method->gamma;
    } else if (method->name == METHOD_GENERALIZED_ALPHA || too_stiff) {
        m->stepper = &generalized_alpha_stepper;
        // Chung and Hulbert (1993), equations (17), (18), (25)
        m->alpha_m = (2 * rho - 1) / (rho + 1);
        m->alpha_f = rho / (rho + 1);
        m->gamma = 0.5 - m->alpha_m + m->alpha_f;
        m->beta = 0.25 * (1 - m->alpha_m + m->alpha_f) * (1 - m->alpha_m + m->alpha_f);
    } else {
        m->stepper = &explicit_stepper;
    }
}

motion *motion_create(const arm *a, const method_parameters *method)
{
    motion *m = calloc(1, sizeof *m);
    if (m == NULL) {
        return NULL;
    }
    m->dof = a->dof;
    m->nominal_step = method->step;
    m->cut = HUGE_VAL;
    m->size = SLOT_COUNT + 4 * a->dof + QUADRATURE_COUNT;
    choose_stepper(a, m, method);
    size_t size = (size_t)m->size, n = (size_t)a->dof, links = (size_t)a->links;
    m->state = calloc(size, sizeof(double));
    m->trial = calloc(size, sizeof(double));
    m->between = calloc(size, sizeof(double));
    m->stages = calloc((size_t)(m->stepper->scratch_vectors + 1) * (size_t)smooth_length(m),
                       sizeof(double));
    m->scratch = calloc(4 * n, sizeof(double));
    m->links = calloc(links, sizeof(chain_link));
    m->sweeps = calloc(links, IMPLICIT_SWEEP_SIZE);
    if (!m->state || !m->trial || !m->between || !m->stages || !m->scratch || !m->links ||
        !m->sweeps) {
        motion_destroy(m);
        return NULL;
    }
    return m;
}

void motion_destroy(motion *m)
{
    if (m != NULL) {
        free(m->state);
        free(m->trial);
        free(m->between);
        free(m->stages);
        free(m->scratch);
        free(m->links);
        free(m->sweeps);
        free(m);
    }
}

void motion_evaluate(const arm *a, motion *m, double *state)
{
    chain_reaction r;
    chain_accelerations(a, m->links, state_angles(m, state), state_velocities(m, state),
                        contact_state_of(state), state_accelerations(m, state), &r);
    state[SLOT_FORCE] = r.force;
    state[SLOT_FRICTION_TORQUE] = r.friction;
    state[SLOT_GAP_ACCELERATION] = r.gap_acceleration;
    state[SLOT_GAP] = r.gap;
    state[SLOT_GAP_VELOCITY] = r.gap_velocity;
    state[SLOT_VISCOUS_POWER] = r.viscous_power;
    state[SLOT_DAMPING_POWER] = r.damping_power;
}

// --- what holds at an instant ---------------------------------------------------------------

bool motion_held_still(const motion *m)
{
    contact_state mode = contact_state_of(m->state);
    int holds = mode.contact + (mode.friction == HUB_STICK);
    return m->dof == 1 ? holds > 0 : holds >= m->dof;
}

// How far the state violates what its mode promises: tension in contact, penetration to come in
// a released touch, friction beyond its limit, sliding against the chosen direction.
static double violation(const arm *a, const motion *m, const double *state, bool touching,
                        bool hub_rests)
{
    contact_state mode = contact_state_of(state);
    double worst = 0;
    if (mode.contact) {
        worst = fmax(worst, -state[SLOT_FORCE]);
    } else if (touching) {
        worst = fmax(worst, -state[SLOT_GAP_ACCELERATION]);
    }
    if (mode.friction == HUB_STICK) {
        worst = fmax(worst, fabs(state[SLOT_FRICTION_TORQUE]) - a->motor.stiction);
    } else if (hub_rests) {
        worst = fmax(worst, -mode.friction * state[SLOT_COUNT + 2 * m->dof + QUADRATURE_COUNT]);
    }
    return worst;
}

// Finds the one combination of contact and hub friction that violates nothing and evaluates the
// state under it. Gauss's principle makes the problem a strictly convex one, since the friction
// torque is bounded independently of the contact force: there is exactly one solution. At an event
// two combinations agree to rounding; `event` says which of them the motion has just left.
static void resolve(const arm *a, motion *m, bool touching, motion_event event)
{
    static const hub_friction sticking_first[] = {HUB_STICK, HUB_FORWARD, HUB_BACKWARD};
    static const hub_friction sliding_first[] = {HUB_FORWARD, HUB_BACKWARD, HUB_STICK};
    const hub_friction *at_rest = event == MOTION_SLIP ? sliding_first : sticking_first;
    double *state = m->state;
    double hub_velocity = state_velocities(m, state)[0];
    bool hub_rests = hub_velocity == 0 && a->motor.stiction > 0;
    hub_friction sliding = hub_velocity < 0 ? HUB_BACKWARD : HUB_FORWARD;
    int choices = hub_rests ? 3 : 1, ways = touching ? 2 : 1;
    double least = 0;
    contact_state best = {false, sliding};

    for (int i = 0; i < ways * choices; i++) {
        bool second = i >= choices;
        state[SLOT_CONTACT] = touching && second == (event == MOTION_RELEASE);
        state[SLOT_FRICTION] = hub_rests ? at_rest[i % choices] : sliding;
        motion_evaluate(a, m, state);
        double v = violation(a, m, state, touching, hub_rests);
        if (i == 0 || v < least) {
            least = v;
            best = contact_state_of(state);
        }
        if (v <= FORCE_TOLERANCE / 1000) {
            best = contact_state_of(state);
            break;
        }
    }
    state[SLOT_CONTACT] = best.contact;
    state[SLOT_FRICTION] = best.friction;
    if (motion_held_still(m)) {
        memset(state_velocities(m, state), 0, (size_t)m->dof * sizeof(double));
    }
    motion_evaluate(a, m, state);
    if (motion_held_still(m)) {
        memset(state_accelerations(m, state), 0, (size_t)m->dof * sizeof(double));
    }
    memcpy(state_algorithmic(m, state), state_accelerations(m, state),
           (size_t)m->dof * sizeof(double));
    state[SLOT_JUMPED] = 1;
}

void motion_start(const arm *a, motion *m, double angle, double velocity)
{
    memset(m->state, 0, (size_t)m->size * sizeof(double));
    for (int i = 0; i < m->dof; i++) {
        state_angles(m, m->state)[i] = angle;
        state_velocities(m, m->state)[i] = velocity;
    }
    m->start_energy =
        chain_kinetic_energy(a, state_angles(m, m->state), state_velocities(m, m->state)) +
        chain_strain_energy(a, state_angles(m, m->state));
    m->steps = 0;
    m->largest_penetration = 0;
    motion_watch(m);
    double g, rate;
    chain_penetration(a, state_angles(m, m->state), state_velocities(m, m->state), &g, &rate);
    resolve(a, m, g >= 0 && rate >= 0, MOTION_REACHED);
}

void motion_watch(motion *m)
{
    m->pulse_peak = -1;
    m->pulse_peak_time = m->state[SLOT_TIME];
}

double motion_energy_residual(const arm *a, const motion *m, double *state)
{
    const double *q = state_angles(m, state), *w = state_velocities(m, state);
    const double *quadrature = state_quadratures(m, state);
    double stored = chain_kinetic_energy(a, q, w) + chain_strain_energy(a, q) - m->start_energy;
    double work = state[SLOT_MOTOR_WORK] + state[SLOT_EXTERNAL_WORK];
    double lost = state[SLOT_FRICTION_LOSS] + state[SLOT_IMPACT_LOSS] +
                  quadrature[QUADRATURE_VISCOUS] + quadrature[QUADRATURE_DAMPING];
    return stored + lost - work;
}

// --- a step of smooth motion ----------------------------------------------------------------

void motion_project(const arm *a, motion *m, double *state)
{
    bool locked = contact_state_of(state).friction == HUB_STICK;
    if (m->dof == 1 || (fabs(state[SLOT_GAP]) <= PROJECTION_GAP &&
                        fabs(state[SLOT_GAP_VELOCITY]) <= PROJECTION_RATE)) {
        return;
    }
    double compliance, *response = m->scratch;
    double *q = state_angles(m, state), *w = state_velocities(m, state);
    chain_contact_response(a, m->links, q, locked, response, &compliance);
    double shift = -state[SLOT_GAP] / compliance; // g = -gap falls along the response
    for (int i = 0; i < m->dof; i++) {
        q[i] += shift * response[i];
    }
    double jump = chain_penetration_rate(a, q, w) / compliance;
    for (int i = 0; i < m->dof; i++) {
        w[i] += jump * response[i];
    }
    motion_evaluate(a, m, state);
}

// Time passes over an arm that is held still.
static void wait(motion *m, double h)
{
    memcpy(m->trial, m->state, (size_t)m->size * sizeof(double));
    m->trial[SLOT_TIME] += h;
    state_quadratures(m, m->trial)[QUADRATURE_FORCE] += h * m->state[SLOT_FORCE];
}

status motion_try_step(const arm *a, motion *m, double h)
{
    double *trial = m->trial;
    if (motion_held_still(m)) {
        wait(m, h);
        return STATUS_OK;
    }
    memcpy(trial, m->state, SLOT_COUNT * sizeof(double));
    trial[SLOT_TIME] += h;
    trial[SLOT_JUMPED] = trial[SLOT_IMPULSE] = 0;
    status s = m->stepper->step(a, m, h);
    if (s != STATUS_OK) {
        return s;
    }
    double turned = state_angles(m, trial)[0] - state_angles(m, m->state)[0];
    trial[SLOT_MOTOR_WORK] += a->motor.torque * turned;
    trial[SLOT_FRICTION_LOSS] += trial[SLOT_FRICTION] * a->motor.stiction * turned;
    double sum = trial[SLOT_FORCE];
    for (int i = 0; i < 2 * m->dof; i++) {
        sum += state_angles(m, trial)[i];
    }
    return isfinite(sum) ? STATUS_OK : STATUS_NOT_FINITE;
}

static void accept(motion *m, double step)
{
    double *previous = m->state;
    m->state = m->trial;
    m->trial = previous;
    double strode = m->state[SLOT_TIME] - previous[SLOT_TIME];
    m->steps += (long)fmax(1, ceil(strode / step - 1e-6));
    m->largest_penetration = fmax(m->largest_penetration, -m->state[SLOT_GAP]);
}

// --- the machine ----------------------------------------------------------------------------

// How long the next stride may be, and by which form of the explicit method.
static double stride_length(const arm *a, motion *m, double remaining, double step)
{
    m->brief = false;
    if (motion_held_still(m)) {
        return remaining;
    }
    double longest = step;
    if (m->stepper == &explicit_stepper) {
        double steps = floor(STRIDE_LIMIT / (step * fmax(a->fastest_rate, 1e-3)));
        longest = steps >= 2 ? fmin(steps, LONGEST_STRIDE) * step
                             : step / ceil(step * a->fastest_rate / EXPLICIT_LIMIT);
    }
    // a stride that something cuts to half or less, such as the next sample of a controller
    m->brief = remaining < 0.5 * longest && remaining * a->fastest_rate <= BRIEF_LIMIT;
    return remaining < longest * (1 + 1e-9) ? remaining : longest;
}

static motion_event event_of(const motion *m, watch w)
{
    switch (w) {
    case WATCH_GAP:
        return m->state[SLOT_GAP_VELOCITY] < -TOUCH_SPEED ? MOTION_IMPACT : MOTION_TOUCH;
    case WATCH_FORCE:
        return MOTION_RELEASE;
    case WATCH_HUB:
        return MOTION_STICK;
    case WATCH_STICTION:
        return MOTION_SLIP;
    }
    return MOTION_REACHED;
}

// Tries a stride of *h, shorter if need be; *h and m->trial end at the first event, if there is
// one.
static status try_stride(const arm *a, motion *m, double *h, watch *first, bool *any)
{
    status s = motion_try_step(a, m, *h);
    for (int i = 0; i < MOST_HALVINGS && (s == STATUS_NEWTON_FAILED || s == STATUS_UNSTABLE); i++) {
        *h /= 2;
        s = motion_try_step(a, m, *h);
    }
    return s == STATUS_OK ? locate_first_event(a, m, h, first, any) : s;
}

// Ends a stride of the `wanted` length that was just tried at m->cut if it goes beyond, or ends
// within rounding of it.
static status cut_stride(const arm *a, motion *m, double step, status tried, double wanted,
                         double *h, watch *first, bool *any)
{
    double left = m->cut - m->state[SLOT_TIME];
    double reached = tried == STATUS_OK ? *h : wanted;
    double spare = tried == STATUS_OK && *any ? 0 : LEAST_AFTER_CUT * step;
    if (reached <= left - spare) {
        return tried;
    }
    *h = left;
    *any = false;
    status s = tried == STATUS_OK ? motion_try_step(a, m, left) : tried;
    return s == STATUS_OK ? s : try_stride(a, m, h, first, any);
}

status motion_step(const arm *a, motion *m, double until, double step, motion_report *report)
{
    *report = (motion_report){.event = MOTION_REACHED};
    double wanted = stride_length(a, m, until - m->state[SLOT_TIME], step), h = wanted;
    watch first = WATCH_GAP;
    bool any = false;
    status s = try_stride(a, m, &h, &first, &any);
    s = cut_stride(a, m, step, s, wanted, &h, &first, &any);
    if (s == STATUS_OK && m->state[SLOT_CONTACT] != 0) {
        s = locate_peak(a, m, h);
    }
    if (s != STATUS_OK) {
        m->failure_time = m->state[SLOT_TIME] + h;
        return s;
    }
    accept(m, step);
    if (any) {
        report->event = event_of(m, first);
    }
    double stop = fmin(until, m->cut);
    if (stop - m->state[SLOT_TIME] <= 1e-12 * fmax(1, stop)) {
        m->state[SLOT_TIME] = stop;
    }
    return STATUS_OK;
}

status motion_advance(const arm *a, motion *m, double until, double step, motion_report *report)
{
    status s = STATUS_OK;
    *report = (motion_report){.event = MOTION_REACHED};
    while (s == STATUS_OK && report->event == MOTION_REACHED && m->state[SLOT_TIME] < until) {
        s = motion_step(a, m, until, step, report);
    }
    return s;
}

double *motion_between(const arm *a, motion *m, double time)
{
    // step from the stride's start, which is where m->trial was left, into m->between
    double *now = m->state, *start = m->trial;
    m->state = start;
    m->trial = m->between;
    status s = motion_try_step(a, m, time - start[SLOT_TIME]);
    m->state = now;
    m->trial = start;
    m->between[SLOT_TIME] = time;
    return s == STATUS_OK ? m->between : NULL;
}

// The jump of an impact, and what holds after it. Slower than the rest speed it is plastic: a
// sequence of ever smaller bounces ends in contact.
static void impact(const arm *a, motion *m, motion_report *report)
{
    double *q = state_angles(m, m->state), *w = state_velocities(m, m->state);
    double *increment = m->scratch;
    double e = chain_penetration_rate(a, q, w) < a->rest_speed ? 0 : a->restitution;
    impact_result result = impact_velocity_increments(a, m->links, q, w, e, increment);
    report->speed = result.speed;
    report->impulse = result.impulse;
    report->loss = result.loss;
    if (motion_unresolved(a, m) && e == 0) {
        // the impact happens within the next step, whose own damping takes the loss (after Moreau)
        m->state[SLOT_CONTACT] = 1;
        m->state[SLOT_FORCE] = 0;
        m->state[SLOT_IMPULSE] = result.impulse;
        m->state[SLOT_JUMPED] = 1;
        report->holds = true;
        return;
    }
    m->state[SLOT_IMPACT_LOSS] += result.loss;
    for (int i = 0; i < m->dof; i++) {
        w[i] += increment[i];
    }
    resolve(a, m, e == 0, MOTION_IMPACT);
    report->holds = m->state[SLOT_CONTACT] != 0;
}

// The same choice where steps do not resolve the fastest modes: accelerations at an instant are
// then no information, so the event itself says what holds next, and the next step corrects it.
static void resolve_coarsely(const arm *a, motion *m, motion_report *report)
{
    double *state = m->state;
    if (report->event == MOTION_RELEASE) {
        state[SLOT_CONTACT] = state[SLOT_FORCE] = 0;
    } else if (report->event == MOTION_TOUCH) {
        state[SLOT_CONTACT] = 1;
    } else if (report->event == MOTION_STICK) {
        state_velocities(m, state)[0] = 0;
        state[SLOT_FRICTION] = HUB_STICK;
    } else if (report->event == MOTION_SLIP) {
        bool forward = state[SLOT_FRICTION_TORQUE] < 0; // friction resists the way the hub goes
        state[SLOT_FRICTION] = forward ? HUB_FORWARD : HUB_BACKWARD;
        state[SLOT_FRICTION_TORQUE] = forward ? -a->motor.stiction : a->motor.stiction;
    }
    report->holds = state[SLOT_CONTACT] != 0;
    state[SLOT_JUMPED] = 1;
}

void motion_apply(const arm *a, motion *m, motion_report *report)
{
    bool contact = m->state[SLOT_CONTACT] != 0;
    bool coarse = report->event == MOTION_SLIP || (contact && report->event != MOTION_IMPACT);
    if (coarse && report->event != MOTION_REACHED && motion_unresolved(a, m)) {
        resolve_coarsely(a, m, report);
        return;
    }
    switch (report->event) {
    case MOTION_REACHED:
        break;
    case MOTION_IMPACT:
        impact(a, m, report);
        break;
    case MOTION_TOUCH:
    case MOTION_RELEASE:
        resolve(a, m, true, report->event);
        report->holds = m->state[SLOT_CONTACT] != 0;
        break;
    case MOTION_STICK:
        state_velocities(m, m->state)[0] = 0;
        resolve(a, m, contact, report->event);
        break;
    case MOTION_SLIP:
        resolve(a, m, contact, report->event);
        break;
    }
}

void motion_push(const arm *a, motion *m, double impulse, motion_report *report)
{
    double *q = state_angles(m, m->state), *w = state_velocities(m, m->state);
    bool contact = m->state[SLOT_CONTACT] != 0;
    double *response = m->scratch, before = chain_kinetic_energy(a, q, w);
    *report = (motion_report){.event = MOTION_REACHED};
    chain_tip_response(a, m->links, q, response);
    for (int i = 0; i < m->dof; i++) {
        w[i] += impulse * response[i];
    }
    m->state[SLOT_EXTERNAL_WORK] += chain_kinetic_energy(a, q, w) - before;
    if (contact && chain_penetration_rate(a, q, w) > 0) {
        report->event = MOTION_IMPACT;
        impact(a, m, report);
    } else {
        resolve(a, m, contact && chain_penetration_rate(a, q, w) == 0, MOTION_REACHED);
    }
}

void motion_retorque(const arm *a, motion *m, double before)
{
    if (motion_unresolved(a, m)) {
        return; // an instant's accelerations say nothing: the next step finds out
    }
    double *state = m->state;
    const bool sticks = contact_state_of(state).friction == HUB_STICK;
    double friction = state[SLOT_FRICTION_TORQUE] - (a->motor.torque - before);
    if (sticks && m->dof > 1 && fabs(friction) < a->motor.stiction * (1 - 1e-9)) {
        state[SLOT_FRICTION_TORQUE] = friction; // takes up what the motor does, the rest stays
        return;
    }
    motion_evaluate(a, m, state);
    bool moves = !sticks && state_velocities(m, state)[0] != 0;
    if (!moves || (state[SLOT_CONTACT] != 0 && state[SLOT_FORCE] <= 0)) {
        resolve(a, m, state[SLOT_CONTACT] != 0, MOTION_REACHED);
        return;
    }
    memcpy(state_algorithmic(m, state), state_accelerations(m, state),
           (size_t)m->dof * sizeof(double));
    state[SLOT_JUMPED] = 1;
}

void motion_rebind(const arm *before, const arm *after, motion *m)
{
    const double *q = state_angles(m, m->state);
    m->state[SLOT_EXTERNAL_WORK] += chain_strain_energy(after, q) - chain_strain_energy(before, q);
    resolve(after, m, m->state[SLOT_CONTACT] != 0, MOTION_REACHED);
}
