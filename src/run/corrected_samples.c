#include "src/run/corrected_samples.h"

#include <assert.h>
#include <math.h>

#include "src/base/extremes.h"
#include "src/base/instant.h"

// Whether the arm flies in strides that outlive steps.
static bool flies_far(const corrected_run *c)
{
    const motion *m = c->motion;
    return c->recording->rig != NULL && m->state[SLOT_CONTACT] == 0 && m->engine->hub_at != NULL &&
           !m->starved && !motion_held_still(m);
}

void corrected_look_ahead(corrected_run *c)
{
    const parameters *p = &c->recording->scenario->parameters;
    const double far = flies_far(c) ? smaller(p->run.duration, c->horizon) : c->stop;
    motion_look_far(&c->arm, c->motion, c->stop, far, c->recording->now.method.step);
}

// One sample, in flight at an instant within the step [s].
static status sample_at(corrected_run *c, double time, flight_samples *met, fault *f)
{
    const motion *m = c->motion;
    rig *on = c->recording->rig;

    // most sensors see nothing but the hub, and no force
    sensed_motion at = {.force = 0};
    const bool watched = on->sensors.p.film || on->sensors.p.accelerometer;
    if (watched && !corrected_sensed_ahead(c, time, &at)) {
        return STATUS_NOT_FINITE;
    }
    const glance hub = m->engine->hub_at(&c->arm, m, time - m->state[SLOT_TIME]);
    at.angle = hub.value;
    at.velocity = hub.slope;

    const status followed = corrected_follow_flight(c, time, &at);
    if (followed == STATUS_OK) {
        met->failed = rig_act(on, time, &at, &met->changed, f);
    }
    return followed;
}

status corrected_sample_flight(corrected_run *c, flight_samples *met, fault *f)
{
    assert(c != NULL && met != NULL && f != NULL);
    const double duration = c->recording->scenario->parameters.run.duration;
    const rig *on = c->recording->rig;
    motion *m = c->motion;
    *met = (flight_samples){.failed = STATUS_OK};
    c->sensed.time = m->state[SLOT_TIME];
    if (!flies_far(c)) {
        return STATUS_OK;
    }
    if (!m->ahead.known) {
        corrected_look_ahead(c);
    }

    // from the step's start on, as long as nothing changes
    c->sensed.at = corrected_sensed_motion(c, m->state);
    c->sensed.integral = state_quadratures(m, m->state)[QUADRATURE_FORCE];
    const double end = m->state[SLOT_TIME] + (m->ahead.begun ? m->ahead.length : 0);
    status s = STATUS_OK;
    bool goes_on = true;
    while (goes_on && instant_after(end, rig_next_time(on))) {
        const double due = rig_next_time(on);
        s = corrected_record_rows_to(c, due);
        s = s == STATUS_OK ? sample_at(c, due, met, f) : s;

        // the step ends here, or at the next one that stops it
        goes_on = s == STATUS_OK && met->failed == STATUS_OK && !met->changed;
        c->stop = goes_on ? smaller(rig_next_time(on), duration) : due;
        if (!goes_on) {
            m->ahead.length = due - m->state[SLOT_TIME];
            m->ahead.any = false;
        }
    }
    return s;
}
