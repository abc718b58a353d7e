#include "src/rig/laws/smooth_approach.h"

#include <assert.h>
#include <math.h>
#include <string.h>

// Rotation of the plan at a speed, without vibration.
static void plan_rotation(smooth_approach *p, const observer_design *d, double speed)
{
    const mode_set *set = &d->observer.arm.free;
    memset(p->state, 0, sizeof p->state);
    for (int i = 0; i < set->count; i++) {
        p->state[set->count + i] = set->momentum[i] * speed;
    }
}

double smooth_approach_speed(const smooth_approach *p, const observer_design *d)
{
    assert(p != NULL && d != NULL);
    const mode_set *set = &d->observer.arm.free;
    return p->state[set->count] / set->momentum[0];
}

// From now on the plan takes up another speed [rad/s].
static void change_speed(smooth_approach *p, const observer_design *d, double speed)
{
    p->speed_before = smooth_approach_speed(p, d);
    p->planned_change = speed - p->speed_before;
    p->changing = 0;
}

void smooth_approach_begin(smooth_approach *p, const observer_design *d, double angle)
{
    assert(p != NULL && d != NULL && p->period > 0);
    double way = p->guarded - angle;
    double room = (way - d->touch_speed * d->ramp_time / 2) / d->ramp_time;

    // from rest to the cruising speed
    p->start_angle = angle;
    p->cruise_speed = fmax(d->touch_speed, fmin(d->top_speed, room));
    p->slows = !(p->cruise_speed > d->touch_speed);
    plan_rotation(p, d, 0);
    change_speed(p, d, p->cruise_speed);
}

void smooth_approach_touch(smooth_approach *p, const observer_design *d)
{
    assert(p != NULL && d != NULL);
    plan_rotation(p, d, d->touch_speed);
    change_speed(p, d, d->touch_speed);
    p->slows = true;
}

// Share of a change of speed that is made after a time: the integral of a trapezoid, which is one
// vibration's period as a box convolved with the next one's.
static double share_changed(const observer_design *d, double t)
{
    const double T = d->ramp_time, edge = d->ramp_edge, top = 1 / (T - edge);
    t = fmax(0, fmin(t, T));
    if (t < edge) {
        return top * t * t / (2 * edge);
    }
    double left = T - t;
    return left < edge ? 1 - top * left * left / (2 * edge) : top * (t - edge / 2);
}

double smooth_approach_follow(smooth_approach *p, const observer_design *d)
{
    assert(p != NULL && d != NULL);

    // the mean over the period
    double share = share_changed(d, p->changing + p->period) - share_changed(d, p->changing);
    double torque = share * p->planned_change / p->period * d->observer.arm.inertia;

    // the arm under that
    double next[ESTIMATOR_STATES];
    const sampled_model *model = &d->plan_model;
    for (int i = 0; i < model->n; i++) {
        next[i] = model->b[i] * torque;
        for (int j = 0; j < model->n; j++) {
            next[i] += model->a[i][j] * p->state[j];
        }
    }
    memcpy(p->state, next, (size_t)model->n * sizeof next[0]);
    p->changing += p->period;
    return torque;
}

void smooth_approach_slow(smooth_approach *p, const observer_design *d, double tip)
{
    assert(p != NULL && d != NULL);
    double left = p->guarded - tip;
    double slowing = (p->cruise_speed + d->touch_speed) / 2 * d->ramp_time;
    if (!p->slows && p->changing >= d->ramp_time && left <= slowing) {
        p->slows = true;
        change_speed(p, d, d->touch_speed);
    }
}

void smooth_approach_again(smooth_approach *p, const observer_design *d)
{
    assert(p != NULL && d != NULL);
    double under_way = p->changing;
    if (p->slows) {
        plan_rotation(p, d, p->speed_before);
        change_speed(p, d, d->touch_speed);
    } else {
        smooth_approach_begin(p, d, p->start_angle);
    }
    while (p->changing < under_way) {
        smooth_approach_follow(p, d);
    }
}
