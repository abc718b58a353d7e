// The sweeps of chain.h as inline functions, so that the two-link arm, whose loops the compiler can
// unroll, and the chain of any length share one source.
#pragma once

#include <math.h>

#include "src/arm/chain_link.h"
#include "src/base/sincos.h"

#define KERNEL static inline __attribute__((always_inline))

// Whether the chain is more than a plain one, or its tip may feel a force that its place and
// velocity say before any acceleration is known.
static inline bool chain_is_loaded(const arm *a)
{
    return !arm_is_plain(a) || wall_gives(&a->wall);
}

// Sums of the rows of the modal damping, g'(bend rates), into sums[damped_modes] [N m s^(1/2)]; the
// torques are g times them. Returns the power lost [W].
static inline double chain_modal_rates(const arm *a, const double *w, double *sums)
{
    double power = 0;
    for (int i = 0; i < a->damped_modes; i++) {
        sums[i] = 0;
        for (int k = a->first > 0 ? 0 : 1; k < a->links; k++) {
            sums[i] += a->modal_damping[i][k] * (w[a->first + k] - w[a->first + k - 1]);
        }
        power += sums[i] * sums[i];
    }
    return power;
}
static inline double chain_modal_torque(const arm *a, const double *sums, int k)
{
    double torque = 0;
    for (int i = 0; i < a->damped_modes; i++) {
        torque += a->modal_damping[i][k] * sums[i];
    }
    return torque;
}

// Accelerations under `mode`; N, hub_spring, contact (which is mode.contact) and loaded
// (chain_is_loaded) are passed apart so that they can be compile-time constants. Without `gap` the
// reaction's gap and its derivatives are left out in free flight. The derivation stands in chain.h.
KERNEL void chain_sweep_loaded(const arm *a, int N, bool hub_spring, bool contact, bool loaded,
                               bool gap, chain_link *link, const double *q, const double *w,
                               contact_state mode, double *alpha, chain_reaction *reaction)
{
    const bool uneven = loaded && a->uneven, drags = loaded && a->air_drag > 0;
    const int first = hub_spring ? 1 : 0;
    const double *theta = q + first, *omega = w + first;
    const bool gives = loaded && wall_gives(&a->wall) && wall_stands(&a->wall);
    const bool face = gives && wall_has_face(&a->wall);
    const bool constrained = contact && (!gives || face);
    const bool wanted = contact || gap || gives || drags; // the last link's base and its velocity

    // directions of the links, and place and velocity of the last one's base
    double x = 0, y = 0, vx = 0, vy = 0;
    for (int k = 0; k < N; k++) {
        const double l = uneven ? a->each.length[k] : a->link_length;
        inline_sincos(theta[k], &link[k].s, &link[k].c);
        if (wanted && k < N - 1) {
            x += l * link[k].c;
            y += l * link[k].s;
            vx -= l * link[k].s * omega[k];
            vy += l * link[k].c * omega[k];
        }
    }
    const double l_last = uneven ? a->each.length[N - 1] : a->link_length;
    wall_contact wall = {0};
    if (wanted && wall_stands(&a->wall)) {
        wall = wall_contact_at(&a->wall, l_last, x, y, vx, vy, link[N - 1].c, link[N - 1].s,
                               omega[N - 1]);
    }

    // a single link on a rigid hub is held by the wall alone; friction then has no say
    const bool held = constrained && !face && N == 1 && !hub_spring;
    const bool stuck = mode.friction == HUB_STICK && !held;

    // a wall that gives answers to place and velocity alone, one with a mass also to accelerations
    double pressed = 0, held_back = 0, wall_power = 0;
    if (gives && mode.contact) {
        double lever = wall_last_lever(&wall, l_last, link[N - 1].c, link[N - 1].s);
        double depth = wall.penetration;
        double rate = wall_penetration_rate(&wall, vx, vy, lever, omega[N - 1]) +
                      wall_comes(&a->wall, wall.ex, wall.ey);
        if (face) {
            held_back = wall_force(&a->wall, depth, rate);
            wall_power = a->wall.damping * rate * rate;
        } else {
            pressed = wall_force(&a->wall, depth, rate);
            // a step tries Kelvin-Voigt's law in front of the wall, too, and loses nothing there
            const bool damper = a->wall.law == WALL_KELVIN_VOIGT;
            wall_power = damper ? a->wall.damping * rate * rate
                                : (pressed - wall_spring_force(&a->wall, depth)) * rate;
        }
    }

    // motor, damping and sliding friction at the hub
    const double sliding = held ? 0 : -mode.friction * a->motor.stiction;
    double hub = a->motor.torque - a->motor.damping * w[0] + sliding;
    double motor_torque = 0;
    if (loaded && a->motor.electric) {
        motor_torque = a->motor.torque_constant * motor_current(&a->motor, mode.current, w[0]);
        hub += motor_torque;
    }
    double hub_joint = 0, damping_power = 0, modal[PARAMETER_MODES_MOST];
    if (loaded) {
        damping_power = chain_modal_rates(a, w, modal);
    }
    if (hub_spring) {
        double rate = omega[0] - w[0], bend = theta[0] - q[0];
        hub_joint = a->hub_stiffness * bend + a->hub_joint_damping * rate;
        damping_power += a->hub_joint_damping * rate * rate;
        if (loaded) {
            hub_joint += arm_stiffening_torque(a, 0, bend) + chain_modal_torque(a, modal, 0);
        }
        hub += hub_joint;
    }

    // tip to hub: eliminate each link's acceleration
    double pxx = 0, pxy = 0, pyy = 0; // P: mass shown by the links beyond
    double qx = 0, qy = 0;            // Q of velocity and springs
    if (loaded) {
        pxx = pyy = a->tip_mass;
        qx = pressed * wall.ex;
        qy = pressed * wall.ey + a->tip_mass * a->gravity;
    }
    double ux2 = wall.ex, uy2 = wall.ey; // Q of a unit contact force
    double outer = 0;                    // torque of the joint beyond
    double root_free = 0, root_unit = 0; // moments on the first link before division
    double end_x = 0, end_y = 0;         // velocity of the link's end, where air drags
    if (drags) {
        end_x = vx - l_last * link[N - 1].s * omega[N - 1];
        end_y = vy + l_last * link[N - 1].c * omega[N - 1];
    }
    for (int k = N - 1; k >= 0; k--) {
        const bool tip = k == N - 1, bare = tip && !loaded;
        const double l = uneven ? a->each.length[k] : a->link_length, half = 0.5 * l;
        const double m = uneven ? a->each.mass[k] : a->link_mass;
        const double own = (uneven ? a->each.inertia[k] : a->link_inertia) + m * half * half;
        double c = link[k].c, s = link[k].s, w2 = omega[k] * omega[k];
        double ux = -m * half * s, uy = m * half * c, d = own, fx = 0, fy = 0;
        if (!bare) {
            double ptx = -pxx * s + pxy * c, pty = -pxy * s + pyy * c; // P t
            double prx = pxx * c + pxy * s, pry = pxy * c + pyy * s;   // P r
            ux += l * ptx;
            uy += l * pty;
            d += l * l * (c * pty - s * ptx);
            fx = qx - l * w2 * prx;
            fy = qy - l * w2 * pry;
        }
        double torque = outer;
        if (k > 0) {
            const double kj = uneven ? a->each.stiffness[k] : a->joint_stiffness;
            const double cj = uneven ? a->each.damping[k] : a->joint_damping;
            double rate = omega[k] - omega[k - 1], bend = theta[k] - theta[k - 1];
            outer = kj * bend + cj * rate;
            damping_power += cj * rate * rate;
            if (loaded) {
                outer += arm_stiffening_torque(a, k, bend) + chain_modal_torque(a, modal, k);
            }
            torque -= outer;
        } else if (hub_spring) {
            torque -= hub_joint;
        } else {
            torque += hub;
            d += a->hub_inertia;
        }
        double moment = bare ? torque : torque - l * (c * fy - s * fx);
        double moment2 = 0;
        if (loaded) {
            moment -= (tip ? pressed * wall.lever : 0) + half * m * a->gravity * c;
        }
        double drag_x = 0, drag_y = 0; // of air on the link
        if (drags) {
            const double turn = l * omega[k], turning = a->air_drag * l * l * l / 12 * omega[k];
            drag_x = a->air_drag * l * (end_x + half * s * omega[k]);
            drag_y = a->air_drag * l * (end_y - half * c * omega[k]);
            moment -= half * (c * drag_y - s * drag_x) + turning;
            damping_power +=
                (drag_x * drag_x + drag_y * drag_y) / (a->air_drag * l) + turning * omega[k];
            end_x += s * turn;
            end_y -= c * turn;
        }
        if (constrained) {
            moment2 = -l * (c * uy2 - s * ux2) - (tip ? wall.lever : 0);
        }
        if (k == 0) {
            root_free = moment;
            root_unit = moment2;
            if (!hub_spring && stuck) {
                moment = moment2 = 0; // a stuck hub has no acceleration
            }
        }
        double inv_d = 1 / d;
        link[k].inv_d = inv_d;
        link[k].ux = ux;
        link[k].uy = uy;
        link[k].free = moment * inv_d;
        if (constrained) {
            link[k].unit = moment2 * inv_d;
        }
        if (k > 0) {
            qx = fx - m * half * w2 * c + ux * link[k].free;
            qy = fy - m * half * w2 * s + uy * link[k].free;
            if (loaded) {
                qy += m * a->gravity;
            }
            if (drags) {
                qx += drag_x;
                qy += drag_y;
            }
            if (constrained) {
                ux2 += ux * link[k].unit;
                uy2 += uy * link[k].unit;
            }
            pxx = (bare ? m : pxx + m) - ux * ux * inv_d;
            pxy = (bare ? 0 : pxy) - ux * uy * inv_d;
            pyy = (bare ? m : pyy + m) - uy * uy * inv_d;
        }
    }

    // hub to tip: accelerations with and without the unit force
    double ax = 0, ay = 0, bx = 0, by = 0; // base acceleration, free and per unit force
    double *out = alpha + first;
    for (int k = 0; k < N; k++) {
        double c = link[k].c, s = link[k].s;
        out[k] = link[k].free;
        if (k > 0) { // the first link's base rests
            out[k] -= (link[k].ux * ax + link[k].uy * ay) * link[k].inv_d;
        }
        if (constrained && k > 0) {
            link[k].unit -= (link[k].ux * bx + link[k].uy * by) * link[k].inv_d;
        }
        if (k < N - 1) {
            const double l = uneven ? a->each.length[k] : a->link_length, w2 = omega[k] * omega[k];
            ax -= l * (s * out[k] + c * w2);
            ay += l * (c * out[k] - s * w2);
            if (constrained) {
                bx -= l * s * link[k].unit;
                by += l * c * link[k].unit;
            }
        }
    }

    // d2g/dt2 = 0 gives the force, or what a face with a mass needs to go along
    double last = 0, rate2 = 0, force = pressed; // J_N, d2g/dt2
    if (wanted) {
        last = wall_last_lever(&wall, l_last, link[N - 1].c, link[N - 1].s);
        rate2 = wall.ex * ax + wall.ey * ay + last * out[N - 1] + wall.convective;
    }
    const double comes = loaded ? wall_comes(&a->wall, wall.ex, wall.ey) : 0;
    const double comes_faster = loaded ? wall_comes_faster(&a->wall, wall.ex, wall.ey) : 0;
    rate2 += face ? 0 : comes_faster; // the mass of a face feels the acceleration in space
    if (constrained) {
        const double yields = wall.ex * bx + wall.ey * by + last * link[N - 1].unit;
        force = -rate2 / yields;
        if (face) {
            const double mass = a->wall.face_mass;
            force = (mass * rate2 + held_back) / (1 - mass * yields);
        }
        for (int k = 0; k < N; k++) {
            out[k] += force * link[k].unit;
        }
        rate2 = face ? rate2 + force * yields : 0;
    }
    rate2 += face ? comes_faster : 0;
    reaction->force = force;
    if (gap) {
        reaction->gap_acceleration = -rate2;
        reaction->gap = wall_stands(&a->wall) ? -wall.penetration : HUGE_VAL;
        reaction->gap_velocity =
            -(wall_penetration_rate(&wall, vx, vy, last, omega[N - 1]) + comes);
    }
    reaction->friction = sliding;
    if (hub_spring) {
        alpha[0] = hub / a->hub_inertia;
        if (stuck) {
            reaction->friction = -hub;
            alpha[0] = 0;
        }
    } else if (stuck) {
        reaction->friction = -(root_free + force * root_unit);
    }
    reaction->viscous_power = a->motor.damping * w[0] * w[0];
    reaction->damping_power = damping_power;
    reaction->wall_power = wall_power;
    reaction->wall_work = force * comes;
    reaction->motor_torque = motor_torque;
}

// The same for equal bare links, on a rigid wall.
KERNEL void chain_sweep(const arm *a, int N, bool hub_spring, bool contact, bool gap,
                        chain_link *link, const double *q, const double *w, contact_state mode,
                        double *alpha, chain_reaction *reaction)
{
    chain_sweep_loaded(a, N, hub_spring, contact, false, gap, link, q, w, mode, alpha, reaction);
}
