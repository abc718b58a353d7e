// What a mode, x'' + 2 a x' + w^2 x = n(t), does from rest under a force that is a power of time.
#pragma once

enum { MODAL_POWERS = 12 };

// Response at time t >= 0 to an impulse and to powers, of length t:
//   impulse: G with G(0) = 0, G'(0) = 1 [s], and its derivative [-];
//   power[j]: F_j = integral from 0 to t of G(t - s) s^j / j! ds [s^(j+2)], F_j' = F_{j-1},
//   F_0' = G.
// For any a, w >= 0: vibrating, overdamped, without a spring. The same bits on every machine.
typedef struct modal_response {
    double impulse, impulse_rate;
    double power[MODAL_POWERS];
} modal_response;

// e^x for x <= 0 from IEEE operations alone, within a few units of the last place.
double modal_decay(double x);

void modal_respond(double a, double w, double t, int powers, modal_response *r);
