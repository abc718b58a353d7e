// How hard would it hit if the tip struck the wall now? The rig's answer at every sample,
// from what its sensors read and the nominal model: the impact dynamics, (4.20)-(4.22),
// while the arm is on its way.
//
// The predictor asks for both links, the rig sees the hub. In free flight the bend b of
// the beam's joint follows from the hub's motion alone: the second link's equation
// without a contact force, (2.17) to first order, is
//
//     b'' + k2/m33 b = -(1 + m32/m33) w',    m33 = I + m l^2/4,  m32 = m l^2/2,
//
// driven by the hub's acceleration w'. With w linear between two readings of the
// tachometer the solution is a rotation in the phase plane about the bend in balance with
// this acceleration, damped by `damping_ratio`.
#pragma once

#include "src/tables/parameters.h"
#include "src/rig/controller.h"

typedef struct touch_forecast {
    parameters arm;   // the nominal one, two links
    double frequency; // of the bend, hub held [rad/s]
    double lag;       // 1 + m32/m33
    double decay;     // [1/s]
    double bend, bend_rate;
    double time, hub_velocity; // of the last sample
    bool flies;                // the last sample was in the air: bend and time are of it
} touch_forecast;

// Takes the nominal model: the parameters told and the setup that the controller gets of
// them. The bend so far stays.
void touch_forecast_tell(touch_forecast *t, const parameters *told,
                         const controller_setup *setup);

// The largest force [N] of the first pulse if the tip struck now and the command in
// effect stayed, from a controller's input at its sample; 0 if the tip moves away from
// the wall, or would be thrown back without a pulse. NaN in contact (force above
// control.contact_threshold), after which the bend starts anew from a straight beam.
double touch_forecast_sample(touch_forecast *t, const controller_input *in);
