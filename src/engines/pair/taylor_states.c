// What the stride of a two-link arm comes to at instants of it.
#include <math.h>
#include <string.h>

#include "src/engines/pair/taylor_stride.h"

// What one of the instants comes to, into `state`, but for what is kept of the stride; in contact
// the gap and its derivatives ought to be zero, and the second one is taken so.
static void take_motion(const arm *a, const motion *m, const taylor_instants *at, int i,
                        double *state)
{
    const taylor_stride *s = m->memory;
    const double *before = s->kept + KEPT_QUADRATURES;
    double *quadrature = state_quadratures(m, state);

    // the motion
    double *q = state_angles(m, state), *acceleration = state_accelerations(m, state);
    for (int body = 1 - a->first; body < 3; body++, q++, acceleration++) {
        q[0] = at->angle[body][i];
        q[m->dof] = at->velocity[body][i];
        acceleration[0] = acceleration[m->dof] = at->acceleration[body][i];
    }

    // what it has lost and pressed
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
    state[SLOT_FRICTION_TORQUE] = stuck ? at->hold[i] : -state[SLOT_FRICTION] * a->motor.stiction;
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

// The same with where in the stride it is.
static void take_instant(const arm *a, const motion *m, const taylor_instants *at, int i,
                         double *state)
{
    const taylor_stride *s = m->memory;
    memcpy(state_kept(m, state), s->kept, sizeof s->kept);
    state_kept(m, state)[KEPT_USED] = at->time[i];
    take_motion(a, m, at, i, state);
}

// The instant h: evaluated with others', where *place says, or into `one`.
static const taylor_instants *instant_at(taylor_stride *s, double h, taylor_instants *one,
                                         int *place)
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

status taylor_state_at(const arm *a, motion *m, double h)
{
    taylor_stride *s = m->memory;
    taylor_instants one;
    int place;
    const taylor_instants *at = instant_at(s, h, &one, &place);
    take_instant(a, m, at, place, m->trial);
    m->holds = (state_energy){at->kinetic[place], at->strain[place]};
    if (s->lane.form.contact && motion_project(a, m, m->trial)) {
        m->holds = unknown_energy;
    }
    return STATUS_OK;
}

bool taylor_move_to(const arm *a, motion *m, double h, state_energy *has)
{
    taylor_stride *s = m->memory;
    taylor_instants one;
    int place;
    const taylor_instants *at = instant_at(s, h, &one, &place);
    double sum = s->lane.form.contact ? at->force[place] : 0;
    for (int body = a->first == 0 ? 1 : 0; body < 3; body++) {
        sum += at->angle[body][place] + at->velocity[body][place];
    }
    const bool drifted =
        s->lane.form.contact && motion_drifted(at->gap[place], at->gap_velocity[place]);
    if (drifted || !isfinite(sum)) {
        return false;
    }

    // the state keeps the stride that it is in
    take_motion(a, m, at, place, m->state);
    state_kept(m, m->state)[KEPT_USED] = at->time[place];
    *has = (state_energy){at->kinetic[place], at->strain[place]};
    return true;
}

bool taylor_states_at(const arm *a, motion *m, double *start, const double *h, int count,
                      double *const *states, state_energy *energies)
{
    taylor_stride *s = m->memory;
    const int width = taylor_width();
    (void)start;
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
    return true;
}

value_and_slope taylor_hub_at(const arm *a, const motion *m, double h)
{
    taylor_stride *s = m->memory;
    const int count = s->lane.form.order + 2;
    const double *angle = taylor_terms(&s->lane, a->first == 0 ? AT_ANGLE_1 : AT_ANGLE_0, count);
    value_and_slope hub = value_and_slope_at(angle, count, s->used + h);
    hub.slope = m->state[SLOT_FRICTION] == HUB_STICK ? 0 : hub.slope;
    return hub;
}
