#include "src/rig/estimation/touch_forecast.h"

#include <math.h>

#include "src/base/plain_math.h"
#include "src/base/sincos.h"
#include "src/predict/predict.h"

void touch_forecast_tell(touch_forecast *t, const parameters *told,
                         const controller_setup *setup)
{
    const double l = setup->link_length;
    parameters *p = &t->arm;

    // the arm in two links, with the numbers that the controller is told
    *p = *told;
    p->arm.model = ARM_CORRECTED;
    p->arm.links = 2;
    p->arm.hub_joint = HUB_RIGID;
    if (isfinite(setup->hub_spring)) {
        p->arm.hub_joint = HUB_SPRING;
        p->arm.k1 = setup->hub_spring;
    }
    p->arm.k2 = setup->k2;
    p->arm.mass = 2 * setup->link_mass;
    p->arm.link_inertia = setup->link_inertia;
    p->arm.hub_inertia = setup->hub_inertia;
    p->motor.torque_constant *= told->belief.torque_factor;
    p->motor.viscous_friction *= told->belief.friction_factor;
    p->motor.stiction = setup->stiction;

    // its bend on a hub that is held
    const double m33 = setup->link_inertia + setup->link_mass * l * l / 4;
    t->frequency = sqrt(setup->k2 / m33);
    t->lag = 1 + setup->link_mass * l * l / 2 / m33;
    t->decay = setup->damping_ratio * t->frequency;
}

// Takes the bend to a sample h [s] after the last one, the hub then turning at w [rad/s]:
// a rotation in the phase plane about the bend in balance with the hub's acceleration,
// -lag w'/f^2, damped.
static void follow_bend(touch_forecast *t, double h, double w)
{
    const double f = t->frequency;
    const double held = t->lag * (w - t->hub_velocity) / (h * f * f);
    const double left = plain_exp(-t->decay * h), from = t->bend + held;
    double s, c;
    inline_sincos(f * h, &s, &c);
    t->bend = left * (from * c + t->bend_rate / f * s) - held;
    t->bend_rate = left * (t->bend_rate * c - from * f * s);
}

double touch_forecast_sample(touch_forecast *t, const controller_input *in)
{
    if (in->force > t->arm.control.contact_threshold) {
        t->flies = false;
        return (double)NAN;
    }

    // from sample to sample, the first of a flight with a straight beam
    if (t->flies && in->time > t->time) {
        follow_bend(t, in->time - t->time, in->tachometer);
    } else if (!t->flies) {
        t->bend = t->bend_rate = 0;
    }
    t->flies = true;
    t->time = in->time;
    t->hub_velocity = in->tachometer;

    // both links as they then are, under the command in effect
    const double angle = in->encoder, w = in->tachometer;
    const three_body_state now = {.angle = {angle, angle, angle + t->bend},
                                  .velocity = {w, w, w + t->bend_rate}};
    prediction touch;
    t->arm.motor.voltage = in->voltage;
    const status code = predict_impact_dynamics(&t->arm, &now, &touch, NULL);
    const bool pulse = code == STATUS_OK && touch.impulse > 0 && touch.force > 0;
    if (pulse) {
        return touch.force;
    }
    return 0;
}
