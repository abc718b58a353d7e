#include "src/rig/laws/observer_arms.h"

#include <assert.h>
#include <math.h>

#define AS_STIFF  1.25      // ratio of stiffnesses up to which an arm is one with that told of
#define HUB_GIVES (1.0 / 6) // of the beam's compliance at the wall, that of a hub on a spring
#define NO_DOUBT  28        // of -2 log likelihood, 2 log(1e6)

const observer_design *observer_arms_design(const observer_arms *a)
{
    return &a->arms[a->on];
}

const arm_observer *observer_arms_observer(const observer_arms *a)
{
    return &a->arms[a->on].observer;
}

const char *observer_arms_init(observer_arms *a, const controller_setup *setup,
                               const observer_task *task)
{
    assert(a != NULL && setup != NULL && task != NULL);
    static const int links[] = {2, 3, 6};
    a->count = a->on = 0;
    const char *refusal = observer_design_init(&a->arms[a->count++], setup, task);
    if (refusal != NULL) {
        return refusal;
    }

    // beams of other numbers of links
    const double told = reduced_arm_compliance(&a->arms[0].observer.arm);
    for (size_t i = 0; i < sizeof links / sizeof links[0] && refusal == NULL; i++) {
        observer_design *d = &a->arms[a->count];
        controller_setup other = *setup;
        other.links = links[i];
        refusal = observer_design_init(d, &other, task);
        double ratio = refusal == NULL ? reduced_arm_compliance(&d->observer.arm) / told : 1;
        a->count += fmax(ratio, 1 / ratio) > AS_STIFF;
    }

    // a spring k1 at the hub gives 4 k2/k1 of what a beam of two links does
    controller_setup other = *setup;
    other.hub_spring = 4 * setup->k2 / HUB_GIVES;
    if (refusal == NULL && setup->hub_spring > 2 * other.hub_spring) {
        refusal = observer_design_init(&a->arms[a->count++], &other, task);
    }
    return refusal;
}

void observer_arms_start(observer_arms *a, const controller_input *in)
{
    for (int i = 0; i < a->count; i++) {
        arm_observer_start(&a->arms[i].observer, in);
    }
}

void observer_arms_know_wall(observer_arms *a, double angle)
{
    for (int i = 0; i < a->count; i++) {
        arm_observer_know_wall(&a->arms[i].observer, angle);
    }
}

void observer_arms_sample(observer_arms *a, const controller_input *in, bool takes_force)
{
    for (int i = 0; i < a->count; i++) {
        arm_observer_sample(&a->arms[i].observer, in, takes_force);
    }
}

void observer_arms_touch(observer_arms *a, double time)
{
    for (int i = 0; i < a->count; i++) {
        arm_observer_touch(&a->arms[i].observer, time);
    }
}

void observer_arms_leave(observer_arms *a, double time)
{
    for (int i = 0; i < a->count; i++) {
        arm_observer_leave(&a->arms[i].observer, time);
    }
}

bool observer_arms_choose(observer_arms *a)
{
    int best = a->on;
    for (int i = 0; i < a->count; i++) {
        best = a->arms[i].observer.missed < a->arms[best].observer.missed ? i : best;
    }
    if (observer_arms_observer(a)->missed - a->arms[best].observer.missed < NO_DOUBT) {
        return false;
    }
    a->on = best;
    return true;
}
