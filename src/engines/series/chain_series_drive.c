// The current of an electric drive (motor.h) along a stride. It follows the voltage at once or
// through an inductance, or it is held at its limit: in each of the three the equations are smooth,
// and a stride ends where another one begins to hold.
#include <math.h>

#include "src/engines/series/chain_series_parts.h"

#define AT_LIMIT 1e-11 // share of the limit that is rounding

// Coefficient n of the hub's w.
static double hub_rate(const chain_series *s, const arm *a, int n)
{
    return a->hub_spring ? s->hub_rate.term[n] : chain_series_first_rate(s, n);
}

void chain_series_choose_drive(chain_series *s, const arm *a, double current, double w,
                               double acceleration)
{
    const motor_model *m = &a->motor;
    const double limit = m->current_limit;
    const double wanted = (m->gain * m->voltage - m->back_emf * w) / m->resistance;
    const bool flows = m->inductance > 0;
    s->limit_side = (flows ? current : wanted) < 0 ? -1 : 1;
    s->drive = flows ? DRIVE_FLOWS : DRIVE_FOLLOWS;
    if (limit == HUGE_VAL || (flows && fabs(current) < limit * (1 - AT_LIMIT))) {
        return;
    }

    // held where the voltage would drive it beyond, or is about to
    const double beyond = s->limit_side * wanted - limit;
    const double grows = -s->limit_side * m->back_emf * acceleration;
    if (fabs(beyond) > AT_LIMIT * limit ? beyond > 0 : grows > 0) {
        s->drive = DRIVE_HELD;
    }
}

double chain_series_drive_torque(chain_series *s, const arm *a, int n)
{
    const motor_model *m = &a->motor;
    const double t = s->length, rate = hub_rate(s, a, n) / t,
                 volts = n == 0 ? m->gain * m->voltage : 0;
    double *i = s->current.term;
    switch (s->drive) {
    case DRIVE_FOLLOWS:
        i[n] = (volts - m->back_emf * rate) / m->resistance;
        break;
    case DRIVE_FLOWS:
        i[n] = n == 0 ? s->mode.current : i[n];
        i[n + 1] =
            t * (volts - m->resistance * i[n] - m->back_emf * rate) / (m->inductance * (n + 1));
        break;
    case DRIVE_HELD:
        i[n] = n == 0 ? s->limit_side * m->current_limit : 0;
        i[n + 1] = 0;
        break;
    }
    return t * t * m->torque_constant * i[n];
}

void chain_series_sum_drive(chain_series *s, const arm *a)
{
    const motor_model *m = &a->motor;
    const int order = s->order;

    // to the limit, or the current that the voltage would drive beyond it
    for (int n = 0; n < order; n++) {
        const double held = -m->back_emf * hub_rate(s, a, n) / (s->length * m->resistance);
        s->to_limit.term[n] = s->limit_side * (s->drive == DRIVE_HELD ? held : -s->current.term[n]);
        s->to_far_limit.term[n] = s->limit_side * s->current.term[n];
    }
    const double volts = s->limit_side * m->gain * m->voltage / m->resistance;
    s->to_limit.term[0] += s->drive == DRIVE_HELD ? volts - m->current_limit : m->current_limit;
    s->to_far_limit.term[0] += m->current_limit;

    // its power, times L
    for (int n = 0; n < 2 * order - 1; n++) {
        double sum = 0;
        for (int i = n < order ? 0 : n - order + 1; i <= n && i < order; i++) {
            sum += s->current.term[i] * hub_rate(s, a, n - i);
        }
        s->motor_work.term[n] = m->torque_constant * sum;
    }
}
