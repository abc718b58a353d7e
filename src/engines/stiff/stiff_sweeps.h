// Arithmetic in lanes, and the stages of a step of the stiff engine: part of
// stiff_kernel.c.
#pragma once

#include "src/base/sincos.h"
#include "src/engines/stiff/stiff_step.h"

// A link may turn by the root of this within a step [rad2].
#define MOST_TURN_SQUARE 0.5

typedef stiff_lanes lanes;
typedef stiff_complex complex_lanes;
typedef long long within_turn __attribute__((vector_size(32)));

// Four numbers of an array that begins with whole vectors.
typedef double aliasing_lanes __attribute__((vector_size(32), may_alias));
KERNEL lanes lanes_at(const double *x)
{
    return *(const aliasing_lanes *)x;
}
KERNEL lanes all(double x)
{
    return (lanes){x, x, x, x};
}
KERNEL complex_lanes number(double x)
{
    return (complex_lanes){all(x), all(0)};
}
KERNEL complex_lanes plus(complex_lanes a, complex_lanes b)
{
    return (complex_lanes){a.r + b.r, a.i + b.i};
}
KERNEL complex_lanes minus(complex_lanes a, complex_lanes b)
{
    return (complex_lanes){a.r - b.r, a.i - b.i};
}
KERNEL complex_lanes times(complex_lanes a, complex_lanes b)
{
    return (complex_lanes){a.r * b.r - a.i * b.i, a.r * b.i + a.i * b.r};
}
KERNEL complex_lanes scaled(double s, complex_lanes a)
{
    return (complex_lanes){s * a.r, s * a.i};
}
KERNEL complex_lanes inverse(complex_lanes a)
{
    const lanes d = 1 / (a.r * a.r + a.i * a.i);
    return (complex_lanes){a.r * d, -a.i * d};
}

// T^-1 of numbers at the stages.
KERNEL complex_lanes to_systems(const lanes *stages)
{
    complex_lanes sum = number(0);
    for (int i = 0; i < RADAU_STAGES; i++) {
        sum.r += lanes_at(radau_to_real[i]) * stages[i / 4][i % 4];
        sum.i += lanes_at(radau_to_imaginary[i]) * stages[i / 4][i % 4];
    }
    return sum;
}

// T of numbers of the systems, half of the stages.
KERNEL lanes to_stages(complex_lanes y, int half)
{
    lanes sum = y.r[0] * lanes_at(&radau_from_real[0][4 * half]);
    for (int j = 1; j < RADAU_SYSTEMS; j++) {
        sum += y.r[j] * lanes_at(&radau_from_real[j][4 * half]);
        sum += y.i[j] * lanes_at(&radau_from_imaginary[j][4 * half]);
    }
    return sum;
}

// --- the stages ------------------------------------------------------------------------

// Predicts accelerations and force at the stages from those of the step before, by the
// weights of stiff_stages.c, and velocities and angles from these by the Radau matrix A:
// w = w0 + h A a, q = q0 + h c w0 + (h A)^2 a. A stuck hub stays.
static void predict_stages(stiff_step *s, const double *before, const double *force,
                           const double *weight)
{
    // the weights for velocities and angles: those for accelerations, times h A once and
    // twice
    _Alignas(32) double once[RADAU_STAGES][RADAU_LANES], twice[RADAU_STAGES][RADAU_LANES];
    const double h = s->length;
    const complex_lanes root = {lanes_at(radau_root_real),
                                lanes_at(radau_root_imaginary)};
    s->g = scaled(h, inverse(root));
    for (int j = 0; j < RADAU_STAGES; j++) {
        for (int i = 0; i < RADAU_LANES; i++) {
            double sum = 0;
            for (int k = 0; k < RADAU_STAGES; k++) {
                sum += radau_matrix[k][i] * weight[RADAU_LANES * j + k];
            }
            once[j][i] = h * sum;
        }
        for (int i = 0; i < RADAU_LANES; i++) {
            double sum = 0;
            for (int k = 0; k < RADAU_STAGES; k++) {
                sum += radau_matrix[k][i] * once[j][k];
            }
            twice[j][i] = h * sum;
        }
    }

    // four stages together; the last lane of the second half is the step's start
    for (int half = 0; half < STIFF_HALVES; half++) {
        const lanes node = lanes_at(&radau_node[4 * half]);
        const lanes start = half == 0 ? all(0) : (lanes){0, 0, 0, 1};
        for (int k = 0; k < s->dof; k++) {
            stiff_stage *g = &s->stage[k];
            lanes a = s->a0[k] * start, w = all(s->w0[k]),
                  q = s->q0[k] + h * s->w0[k] * node;
            for (int j = 0; j < RADAU_STAGES; j++) {
                const double was = before[RADAU_LANES * k + j];
                a += was * lanes_at(&weight[RADAU_LANES * j + 4 * half]);
                w += was * lanes_at(&once[j][4 * half]);
                q += was * lanes_at(&twice[j][4 * half]);
            }
            g->a[half] = a;
            g->w[half] = w;
            g->q[half] = q;
        }

        // the contact force
        lanes f = s->force0 * start;
        for (int j = 0; j < RADAU_STAGES; j++) {
            f += force[j] * lanes_at(&weight[RADAU_LANES * j + 4 * half]);
        }
        s->force.half[half] = f;
    }

    // a stuck hub
    if (s->stuck) {
        for (int half = 0; half < STIFF_HALVES; half++) {
            s->stage[0].a[half] = s->stage[0].w[half] = all(0);
            s->stage[0].q[half] = all(s->q0[0]);
        }
    }
}

// Computes the drive's current and its rate at the stages from the hub's velocities w
// there. Without an inductance it is at its limit or follows from the voltage. With an
// inductance L it solves the same collocation as the motion, in the complex systems with
// their factors g: (L + g Ra) T^-1 i' = T^-1 (volts - Ra i0 - kB w).
KERNEL void follow_current(stiff_step *s)
{
    const motor_model *m = s->motor;
    const double volts = m->gain * m->voltage;
    if (s->drive != STIFF_FLOWS) {
        for (int half = 0; half < STIFF_HALVES; half++) {
            if (s->drive == STIFF_LIMITED) {
                s->current.half[half] = all(s->limited);
            } else {
                s->current.half[half] =
                    (volts - m->back_emf * s->stage[0].w[half]) / m->resistance;
            }
            s->current_rate.half[half] = all(0);
        }
        return;
    }

    // through an inductance
    stiff_nodes drives;
    for (int half = 0; half < STIFF_HALVES; half++) {
        drives.half[half] =
            volts - m->resistance * s->current0 - m->back_emf * s->stage[0].w[half];
    }
    const complex_lanes slows = plus(number(m->inductance), scaled(m->resistance, s->g));
    const complex_lanes rate = times(to_systems(drives.half), inverse(slows));
    const complex_lanes change = times(rate, s->g);
    for (int half = 0; half < STIFF_HALVES; half++) {
        s->current_rate.half[half] = to_stages(rate, half);
        s->current.half[half] = s->current0 + to_stages(change, half);
    }
}

// Motion of the arm's end at the stages: acceleration and velocity of the tip, the same
// and the place of the last link's base, and the power that the arm loses.
typedef struct stiff_tip {
    lanes ax, ay, vx, vy, base_ax, base_ay, base_vx, base_vy, base_x, base_y, lost;
} stiff_tip;

// Sweeps from hub to tip: computes the links' directions and accelerations, and the force
// and moment on each link that these need, beside the external forces on it. The moments
// about the centres go into r, those of joints not yet included. False if a link turns
// too far in the step.
KERNEL bool sweep_outwards(stiff_step *s, int half, bool account, stiff_tip *tip)
{
    const lanes zero = all(0);
    lanes ax = zero, ay = zero, vx = zero, vy = zero, x = zero, y = zero, lost = zero;
    within_turn within = all(0) == zero;
    const force_amounts amount = *s->amount;
    for (int k = 0; k < s->links; k++) {
        const stiff_link *l = &s->link[k];
        stiff_stage *g = &s->stage[s->first + k];
        stiff_body *b = &s->body[k];
        const lanes z = g->q[half] - s->q0[s->first + k], w = g->w[half], al = g->a[half];
        const lanes w2 = w * w;

        // direction, by the turn z since the step's start
        lanes sz, cz;
        SINCOS_NEAR_ZERO(lanes, z, sz, cz);
        within &= z * z < MOST_TURN_SQUARE;
        const lanes c = l->cosine * cz - l->sine * sz, sn = l->sine * cz + l->cosine * sz;
        b->c[half] = c;
        b->s[half] = sn;

        // how the link's end moves relative to its base
        tip->base_ax = ax, tip->base_ay = ay, tip->base_vx = vx, tip->base_vy = vy;
        tip->base_x = x, tip->base_y = y;
        const lanes dx = -l->length * (sn * al + c * w2),
                    dy = l->length * (c * al - sn * w2);
        const lanes dvx = -l->length * sn * w, dvy = l->length * c * w;

        // inertia, and the forces on the link
        const link_motion centre = {vx + 0.5 * dvx, vy + 0.5 * dvy, w};
        link_force f = {.x = l->mass * (ax + 0.5 * dx),
                        .y = l->mass * (ay + 0.5 * dy),
                        .moment = l->inertia * al};
        add_link_forces(&l->forces, &amount, &centre, &f);
        if (account) {
            lost += f.lost;
        }
        b->fx[half] = f.x;
        b->fy[half] = f.y;
        g->r[half] = f.moment;

        ax += dx, ay += dy, vx += dvx, vy += dvy;
        x += l->length * c, y += l->length * sn;
    }
    tip->ax = ax, tip->ay = ay, tip->vx = vx, tip->vy = vy;
    tip->lost = lost;
    for (int i = 0; i < 4; i++) {
        if (!within[i]) {
            return false;
        }
    }
    return true;
}

// How the wall meets the last link at the stages, and with which forces.
typedef struct stiff_contact {
    lanes ex, ey, lever; // as wall_contact of wall.h has them
    lanes reach;         // J of the last link [m]
    lanes bends;         // what velocities add to the depth's second derivative [m/s2]
    lanes force, along;  // along: against the slip along the wall [N]
} stiff_contact;

// The geometry of contact (wall_contact_at of wall.h, for lanes), the gap and its rate.
KERNEL stiff_contact meet_wall(stiff_step *s, int half, const stiff_tip *tip)
{
    const wall_model *wall = s->wall;
    const int last = s->links - 1;
    const double length = s->link[last].length;
    const lanes c = s->body[last].c[half], sn = s->body[last].s[half];
    const lanes w = s->stage[s->first + last].w[half];
    stiff_contact at = {.lever = all(0)};

    // seen from a wall that moves, the arm is shifted the other way
    const lanes comes = s->shift[1].half[half];
    const lanes px = tip->base_x - wall->sine * s->shift[0].half[half];
    const lanes py = tip->base_y + wall->cosine * s->shift[0].half[half];
    lanes depth;
    if (wall->kind == WALL_POINT) {
        const lanes dx = wall->x - px, dy = wall->y - py;
        const lanes along_link = c * (tip->base_vx - wall->sine * comes) +
                                 sn * (tip->base_vy + wall->cosine * comes);
        at.ex = -sn;
        at.ey = c;
        at.lever = c * dx + sn * dy - length;
        depth = sn * dx - c * dy;
        at.bends = -depth * w * w - 2 * w * along_link;
    } else {
        at.ex = all(-wall->sine);
        at.ey = all(wall->cosine);
        depth = at.ex * (px + length * c) + at.ey * (py + length * sn);
        at.bends = -length * w * w * (at.ex * c + at.ey * sn);
    }

    at.reach = at.lever + length * (c * at.ey - sn * at.ex);
    const lanes along = wall->cosine * at.ey - wall->sine * at.ex;
    s->gap.half[half] = -depth;
    s->rate.half[half] =
        -(at.ex * tip->base_vx + at.ey * tip->base_vy + at.reach * w + comes * along);
    return at;
}

// Computes the wall's forces on an arm in contact and, to `account` for energy, the power
// that the wall loses and that with which a moving wall works on the arm.
KERNEL void press_wall(stiff_step *s, int half, bool account, const stiff_tip *tip,
                       stiff_contact *at)
{
    const wall_model *wall = s->wall;
    const lanes comes = s->shift[1].half[half];
    const lanes slides = comes * (wall->sine * at->ey + wall->cosine * at->ex);
    const wall_meeting meeting = {-s->gap.half[half], -s->rate.half[half],
                                  at->ey * tip->vx - at->ex * tip->vy - slides};
    const wall_answer answer = wall_forces(wall, s->amount, &meeting);

    // the force of a wall that gives, plus what accelerates a face with a mass
    if (s->contact == STIFF_GIVES) {
        const lanes al = s->stage[s->dof - 1].a[half];
        const lanes rate2 =
            at->ex * tip->base_ax + at->ey * tip->base_ay + at->reach * al + at->bends;
        s->force.half[half] = answer.normal + wall->face_mass * rate2;
    }
    at->force = s->force.half[half];
    at->along = answer.along;
    if (!account) {
        return;
    }

    // the foundation of a face works on its spring and damper
    lanes by = at->force;
    if (s->contact == STIFF_GIVES && wall->face_mass > 0) {
        by = answer.normal;
    }
    const lanes along = wall->cosine * at->ey - wall->sine * at->ex;
    s->pushed.half[half] = by * comes * along - at->along * slides;
    s->wall_lost.half[half] = answer.lost;
}

// Sweeps from tip to hub: sums up the forces and completes the residual r of each link's
// balance of moments. `size` has the forces of modal damping. Returns the torque of the
// joint at the hub, 0 if the hub is rigid.
KERNEL lanes sweep_inwards(stiff_step *s, int half, bool account, const stiff_contact *at,
                           const lanes *size, stiff_tip *tip)
{
    // the forces at the tip: its mass, the wall, and the external ones
    const int last = s->links - 1;
    const force_amounts amount = *s->amount;
    const link_motion tip_moves = {tip->vx, tip->vy, all(0)};
    link_force end = {.x = s->tip_mass * tip->ax + at->force * at->ex,
                      .y = s->tip_mass * tip->ay + at->force * at->ey};
    add_link_forces(&s->tip, &amount, &tip_moves, &end);
    lanes fx = end.x + at->along * at->ey, fy = end.y - at->along * at->ex;
    lanes outer = all(0);
    for (int k = last; k >= 0; k--) {
        const stiff_link *l = &s->link[k];
        const stiff_body *b = &s->body[k];
        stiff_stage *g = &s->stage[s->first + k];
        const lanes hx = l->length * (fx + 0.5 * b->fx[half]);
        const lanes hy = l->length * (fy + 0.5 * b->fy[half]);

        // the joint before it
        lanes inner = all(0);
        if (k + s->first > 0) {
            const stiff_stage *before = g - 1;
            const joint_force joint =
                joint_forces(&l->forces, &amount, g->q[half] - before->q[half],
                             g->w[half] - before->w[half]);
            inner = joint.torque;
            if (account) {
                tip->lost += joint.lost;
            }
        }

        // the balance of moments about its base
        lanes r = g->r[half] + b->c[half] * hy - b->s[half] * hx - outer + inner;
        if (k == last) {
            r += at->force * at->lever;
        }
        for (int i = 0; i < s->modes; i++) {
            r += s->mode[i * s->dof + s->first + k] * size[i];
        }
        g->r[half] = r;
        fx += b->fx[half];
        fy += b->fy[half];
        outer = inner;
    }
    return outer;
}

// Computes the residuals of all equations of motion at half of the stages; to `account`
// for energy, also the powers lost. False if a link turns too far.
KERNEL bool sweep(stiff_step *s, int half, bool account)
{
    const lanes zero = all(0);
    stiff_tip tip = {.lost = zero};
    if (!sweep_outwards(s, half, account, &tip)) {
        return false;
    }

    // the wall, where there is one
    stiff_contact at = {.lever = zero};
    if (wall_stands(s->wall)) {
        at = meet_wall(s, half, &tip);
    }
    if (s->contact != STIFF_FREE) {
        press_wall(s, half, account, &tip, &at);
    } else if (wall_stands(s->wall)) {
        s->force.half[half] = s->wall_lost.half[half] = s->pushed.half[half] = zero;
    }

    // forces on shapes, by the bends' rates
    lanes size[PARAMETER_MODES_MOST];
    for (int i = 0; i < s->modes; i++) {
        lanes rate = zero;
        for (int k = 0; k < s->dof; k++) {
            rate += s->mode[i * s->dof + k] * s->stage[k].w[half];
        }
        const shape_force f = shape_forces(rate);
        size[i] = f.size;
        if (account) {
            tip.lost += f.lost;
        }
    }
    const lanes outer = sweep_inwards(s, half, account, &at, size, &tip);

    // the hub
    stiff_stage *hub = &s->stage[0];
    hub_force f = {.torque = s->hub_inertia * hub->a[half]};
    add_hub_forces(s->motor, hub->w[half], s->current.half[half], &f);
    lanes r = f.torque;
    if (s->first > 0) {
        r -= outer;
    } else {
        r += hub->r[half];
    }
    for (int i = 0; i < s->modes && s->first > 0; i++) {
        r += s->mode[i * s->dof] * size[i];
    }

    // a stuck hub has no equation: what it lacks is what friction holds
    if (s->stuck) {
        hub->r[half] = zero;
    } else {
        hub->r[half] = r + s->friction;
    }
    if (account) {
        s->hold.half[half] = r;
        s->lost.half[half] = tip.lost;
        s->viscous.half[half] = f.viscous;
        s->electric.half[half] = f.drive * hub->w[half];
    }
    return true;
}

// Computes the residuals at all stages, both halves one after the other (sweep).
static bool residual(stiff_step *s, bool account)
{
    if (s->drive != STIFF_DIRECT) {
        follow_current(s);
    }

    // each form has a sweep of its own
    if (account) {
        return sweep(s, 0, true) && sweep(s, 1, true);
    }
    return sweep(s, 0, false) && sweep(s, 1, false);
}
