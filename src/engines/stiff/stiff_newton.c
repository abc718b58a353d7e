// Stages of a step: the arm as numbers, Newton's iteration, the error (stiff_step.h).
#include <assert.h>
#include <math.h>
#include <string.h>

#include "src/base/extremes.h"
#include "src/base/sincos.h"
#include "src/engines/stiff/stiff_integrator.h"

#define NEWTON_SHARE 3e-3 // of the tolerance, what the iteration leaves
#define FARTHEST     2    // in lengths of a step, to where its polynomials are extrapolated
#define LEAST_RATE   1e-4 // of the iteration that is believed
#define SLOW_RATE    0.6  // and from which on a shorter step is cheaper
#define LEAST_SHARE  1e-14
#define LAST_DIGITS  1e-14 // of an angle, as corrections that do not converge show them
#define MOST_LEFT    30    // times what is wanted, of such corrections

enum { MOST_ITERATIONS = 12 };

// --- the arm -------------------------------------------------------------------------------------

// Whether the drive's current is held at its limit, and which way.
static void choose_drive(stiff_step *s, const motor_model *m, double current, double w,
                         double acceleration)
{
    const double limit = m->current_limit, rounding = 1e-11;
    const double wanted = (m->gain * m->voltage - m->back_emf * w) / m->resistance;
    const bool flows = m->inductance > 0;
    const double side = (flows ? current : wanted) < 0 ? -1 : 1;
    s->drive = flows ? STIFF_FLOWS : STIFF_FOLLOWS;
    s->limited = side * limit;
    if (limit == HUGE_VAL || (flows && fabs(current) < limit * (1 - rounding))) {
        return;
    }

    // where the voltage would drive it beyond, or is about to
    const double beyond = side * wanted - limit, grows = -side * m->back_emf * acceleration;
    if (fabs(beyond) > rounding * limit ? beyond > 0 : grows > 0) {
        s->drive = STIFF_LIMITED;
    }
}

void stiff_set_arm(stiff_integrator *integrator, const arm *a, const motion *m)
{
    stiff_step *s = &integrator->step;
    const contact_state now = contact_state_of(m->state);
    s->links = a->links;
    s->dof = a->dof;
    s->first = a->first;
    for (int k = 0; k < a->links; k++) {
        const arm_link own = arm_link_of(a, k);
        const double air = a->air_drag * own.length;
        s->link[k] = (stiff_link){.length = own.length,
                                  .mass = own.mass,
                                  .inertia = own.inertia,
                                  .stiffness = own.stiffness,
                                  .damping = own.damping,
                                  .stiffening = arm_stiffening_torque(a, k, 1),
                                  .air = air,
                                  .turning = air * own.length * own.length / 12};
    }
    s->stiffens = a->stiffening != 0;
    s->drags = a->air_drag > 0;
    s->tip_mass = a->tip_mass;
    s->gravity = a->gravity;

    // damped modes, in the bodies' velocities
    s->modes = a->damped_modes;
    memset(s->mode, 0, (size_t)(s->modes * s->dof) * sizeof *s->mode);
    for (int i = 0; i < s->modes; i++) {
        for (int k = a->first > 0 ? 0 : 1; k < a->links; k++) {
            s->mode[i * s->dof + a->first + k] += a->modal_damping[i][k];
            s->mode[i * s->dof + a->first + k - 1] -= a->modal_damping[i][k];
        }
    }

    // the hub
    s->hub_inertia = a->hub_inertia;
    s->hub_damping = a->motor.damping;
    s->torque = a->motor.torque;
    const bool held = now.contact && motion_wall_is_rigid(m) && a->dof == 1;
    s->stuck = now.friction == HUB_STICK && !held;
    s->friction = held ? 0 : now.friction * a->motor.stiction;
    s->motor = &a->motor;
    s->drive = STIFF_DIRECT;
    if (a->motor.electric) {
        s->current0 = state_quadratures(m, m->state)[QUADRATURE_CURRENT];
        choose_drive(s, &a->motor, s->current0, state_velocities(m, m->state)[0],
                     state_accelerations(m, m->state)[0]);
    }

    // the wall
    s->wall = &a->wall;
    s->contact = !now.contact ? STIFF_FREE : motion_wall_is_rigid(m) ? STIFF_RIGID : STIFF_GIVES;
}

void stiff_set_start(stiff_integrator *integrator, motion *m)
{
    stiff_step *s = &integrator->step;
    const size_t size = (size_t)s->dof * sizeof(double);
    memcpy(s->q0, state_angles(m, m->state), size);
    memcpy(s->w0, state_velocities(m, m->state), size);
    memcpy(s->a0, state_accelerations(m, m->state), size);
    s->force0 = m->state[SLOT_FORCE];
    s->time = m->state[SLOT_TIME];
    for (int k = 0; k < s->links; k++) {
        inline_sincos(s->q0[s->first + k], &s->link[k].sine, &s->link[k].cosine);
    }
}

// --- Newton --------------------------------------------------------------------------------------

bool stiff_solve_stages(stiff_integrator *integrator, bool fresh, double offset, double ratio,
                        double *rate)
{
    stiff_step *s = &integrator->step;
    _Alignas(32) double weight[RADAU_STAGES][RADAU_LANES] = {{0}};
    for (int i = 0; i < RADAU_STAGES && !fresh; i++) {
        double value[RADAU_LANES];
        radau_values_at(smaller(offset + ratio * radau_node[i], FARTHEST), value);
        for (int j = 0; j < RADAU_STAGES; j++) {
            weight[j][i] = value[j];
        }
    }
    for (int i = 0; i < RADAU_LANES && wall_moves(s->wall); i++) {
        const double part = i < RADAU_STAGES ? radau_node[i] : 0;
        const wall_shift at = wall_motion_at(&s->wall->motion, s->time + part * s->length);
        s->shift[0].at[i] = at.place;
        s->shift[1].at[i] = at.velocity;
    }
    integrator->loops->predict(s, stiff_accelerations(integrator), stiff_force(integrator),
                               weight[0]);

    // with the tangent at the first iterate
    const double scale = integrator->kept[STIFF_SCALE];
    const double wanted = NEWTON_SHARE * integrator->tolerance * scale;
    double before = 0;
    for (int i = 0; i < MOST_ITERATIONS; i++) {
        if (!integrator->loops->residual(s, false)) {
            return false;
        }
        if (i == 0) {
            integrator->loops->factor(s);
        }
        const double now = integrator->loops->correct(s), theta = i > 0 ? now / before : *rate;
        if (!(now < 1e3 * (1 + scale))) {
            return false;
        }
        if (i > 0) {
            *rate = smaller(larger(theta, LEAST_RATE), 0.5);
        }
        if (i == 0 ? now * theta < wanted : theta < 1 && now * theta / (1 - theta) < wanted) {
            return true;
        }
        if (now < LEAST_SHARE * scale) {
            return true;
        }
        if (i > 1 && theta > SLOW_RATE) { // as near as the angles' last digits let it come
            const double rounding = LAST_DIGITS * stiff_momentum(integrator, s->q0) / s->length;
            return now < smaller(rounding, MOST_LEFT * wanted);
        }
        before = now;
    }
    return false;
}

void stiff_keep_stages(stiff_integrator *integrator)
{
    const stiff_step *s = &integrator->step;
    double *kept = integrator->kept;
    memcpy(kept + STIFF_VALUES, s->values, sizeof s->values);
    memcpy(stiff_angles(integrator), s->q0, (size_t)s->dof * sizeof(double));
    memcpy(stiff_velocities(integrator), s->w0, (size_t)s->dof * sizeof(double));
    double *a = stiff_accelerations(integrator);
    for (int k = 0; k < s->dof; k++) {
        memcpy(a + (size_t)RADAU_LANES * (size_t)k, s->stage[k].a, sizeof s->stage[k].a);
    }

    // what holds one link holds it to the last bit; with the hub stuck too, what joins the two
    // presses with one force throughout
    const bool both = s->dof == 2 && s->stuck && !wall_moves(s->wall);
    if (s->contact == STIFF_RIGID && ((s->dof == 1 && !wall_moves(s->wall)) || both)) {
        memset(a, 0, (size_t)s->dof * RADAU_LANES * sizeof *a);
    }
    for (int i = 0; i < RADAU_LANES && both && s->contact == STIFF_RIGID; i++) {
        stiff_force(integrator)[i] = s->force.at[RADAU_LANES - 1];
    }
    kept[STIFF_LENGTH] = s->length;
}
