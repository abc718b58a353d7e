// What the step of a two-link arm comes to at instants of it, and what another torque of the motor
// does at once to one whose hub slides.
#include <math.h>
#include <string.h>

#include "src/arm/chain_pair.h"
#include "src/base/sincos.h"
#include "src/engines/pair/taylor_integrator.h"

// What one of the instants comes to, into `state`; in contact the gap and its derivatives ought to
// be zero, and the second one is taken so.
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

// The instant h: evaluated with others', where *place says, or into `one`.
static const taylor_instants *instant_at(taylor_integrator *s, double h, taylor_instants *one,
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

void taylor_states_at(const arm *a, motion *m, const double *h, int count, double *const *states,
                      state_energy *energies)
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

void taylor_dense_output(const arm *a, motion *m, output_quantity of, double from, double to,
                         int count, value_and_slope *at)
{
    taylor_integrator *s = m->memory;
    taylor_lane *lane = &s->lane;
    const double width = count > 0 ? (to - from) / count : 0;
    const int order = lane->form.order;

    // forces may be evaluated with others', which began their steps with the steps
    if (of == OUTPUT_FORCE && count > 0 && lane->pieces == count && from == 0 && lane->end == to) {
        const taylor_pieces *pieces = &lane->group->pieces;
        at[0] = (value_and_slope){*taylor_term(lane, AT_FORCE), *taylor_term(lane, AT_FORCE + 1)};
        for (int i = 0; i < count; i++) {
            at[i + 1] =
                (value_and_slope){pieces->force[i][lane->number], pieces->slope[i][lane->number]};
        }
        return;
    }

    const int hub = a->first == 0 ? AT_ANGLE_1 : AT_ANGLE_0;
    const int place = of == OUTPUT_FORCE ? AT_FORCE : of == OUTPUT_GAP ? AT_GAP : hub;
    const int terms = of == OUTPUT_FORCE ? order : order + 2;
    const double *term = taylor_terms(lane, place, terms);
    for (int i = 0; i <= count; i++) {
        const double t = s->used + (from + i * width);
        at[i] = t > 0 ? value_and_slope_at(term, terms, t) : (value_and_slope){term[0], term[1]};
    }
    if (of == OUTPUT_HUB && m->state[SLOT_FRICTION] == HUB_STICK) {
        for (int i = 0; i <= count; i++) {
            at[i].slope = 0;
        }
    }
}

// --- another torque ------------------------------------------------------------------------------

// J, the entries of dg/dq, as taylor_order.h has them [m].
static void levers(const arm *a, const double *q, double bend_cosine, double j[2])
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

    // M^-1 of a unit torque on the first link
    const double *q = state_angles(m, state), c = inline_cos(q[1] - q[0]);
    const pair_mass mass = pair_mass_of(a);
    double first, second;
    pair_solve(&mass, mass.m12 * c, false, 1, 0, &first, &second);

    // and what the wall makes of it: in contact its force keeps the gap's rate from changing
    if (wall_stands(&a->wall)) {
        double j[2], y1, y2;
        levers(a, q, c, j);
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
