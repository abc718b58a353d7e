#include "src/run/corrected_samples.h"

#include <assert.h>
#include <math.h>

#include "src/base/extremes.h"
#include "src/base/instant.h"

// Whether the sensors need nothing of the flight to come but the hub's motion at their samples.
static bool flies_unwatched(const corrected_run *c)
{
    const rig *on = c->recording->rig;
    const motion *m = c->motion;
    return on != NULL && m->state[SLOT_CONTACT] == 0 && m->engine->hub_at != NULL && !m->starved &&
           !on->sensors.p.film && !on->sensors.p.accelerometer && !motion_held_still(m);
}

void corrected_look_ahead(corrected_run *c)
{
    const parameters *p = &c->recording->scenario->parameters;
    const double far = flies_unwatched(c) ? smaller(p->run.duration, c->horizon) : c->stop;
    motion_look_far(&c->arm, c->motion, c->stop, far, c->recording->now.method.step);
}

// One sample, in flight at an instant within the step [s].
static void sample_at(corrected_run *c, double time, flight_samples *met, fault *f)
{
    const motion *m = c->motion;
    const glance hub = m->engine->hub_at(&c->arm, m, time - m->state[SLOT_TIME]);
    const sensed_motion sensed = {.angle = hub.value, .velocity = hub.slope};
    corrected_follow_flight(c, time);
    met->failed = rig_act(c->recording->rig, time, &sensed, &met->changed, f);
}

status corrected_sample_flight(corrected_run *c, flight_samples *met, fault *f)
{
    assert(c != NULL && met != NULL && f != NULL);
    const double duration = c->recording->scenario->parameters.run.duration;
    const rig *on = c->recording->rig;
    motion *m = c->motion;
    *met = (flight_samples){.failed = STATUS_OK};
    c->sensed = m->state[SLOT_TIME];
    if (!flies_unwatched(c)) {
        return STATUS_OK;
    }
    if (!m->ahead.known) {
        corrected_look_ahead(c);
    }

    // as long as nothing changes
    const double end = m->state[SLOT_TIME] + (m->ahead.begun ? m->ahead.length : 0);
    status s = STATUS_OK;
    bool goes_on = true;
    while (goes_on && instant_after(end, rig_next_time(on))) {
        const double due = rig_next_time(on);
        s = corrected_record_rows_to(c, due);
        if (s == STATUS_OK) {
            sample_at(c, due, met, f);
        }

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
