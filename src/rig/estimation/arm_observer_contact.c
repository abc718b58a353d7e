// The observer's estimate where contact begins and ends.
#include <assert.h>
#include <math.h>

#include "src/rig/estimation/arm_observer.h"

enum { N = ESTIMATOR_STATES };

#define TIP_IMPULSE 0.03 // that the wall may give where contact ends, a standard deviation [N s]

void arm_observer_touch(arm_observer *o, double time)
{
    assert(!o->touches);
    const mode_set *contact = &o->arm.contact;
    const int m = contact->count, n = o->arm.free.count, wall = 2 * m;

    // the wall is where the tip came between the two samples; or where it was known to be
    double way = o->tip_now - o->tip_before;
    double met = (o->tip_now + o->tip_before) / 2, variance = way * way / 12 + 1e-6;
    if (o->wall_variance < HUGE_VAL) {
        double known = o->wall_variance + 1e-6;
        met = (met * known + o->wall * variance) / (known + variance);
        variance = known * variance / (known + variance);
    }

    // what the touch keeps of the motion, seen from there
    double t[N][N] = {{0}};
    for (int i = 0; i < m; i++) {
        for (int j = 0; j < n; j++) {
            t[i][j] = t[m + i][n + j] = o->arm.touch[i][j];
        }
    }
    t[wall + 1][2 * n] = 1;
    estimator_transform(&o->e, 2 * n + 1, 2 * m + 2, t);
    o->e.z[wall] = o->met = met;
    for (int i = 0; i < m; i++) {
        o->e.z[i] -= contact->momentum[i] * met;
        o->e.p[wall][i] = o->e.p[i][wall] = -contact->momentum[i] * variance;
        for (int j = 0; j < m; j++) {
            o->e.p[i][j] += contact->momentum[i] * contact->momentum[j] * variance;
        }
        double kick = contact->hub[i] * ARM_OBSERVER_TORQUE_NOISE * o->period;
        o->e.p[m + i][m + i] += kick * kick;
    }
    o->e.p[wall][wall] = variance;
    o->touches = true;
    o->since = time;
}

void arm_observer_leave(arm_observer *o, double time)
{
    assert(o->touches);
    const mode_set *free = &o->arm.free;
    const int m = o->arm.contact.count, n = free->count, wall = 2 * m;
    double t[N][N] = {{0}};
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < m; j++) {
            t[i][j] = t[n + i][m + j] = o->arm.touch[j][i];
        }
        t[i][wall] = free->momentum[i];
    }
    t[2 * n][wall + 1] = 1;
    estimator_transform(&o->e, 2 * m + 2, 2 * n + 1, t);

    // an impulse at the tip that no sensor saw
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            double l = o->arm.length * TIP_IMPULSE;
            o->e.p[n + i][n + j] += l * l * free->tip[i] * free->tip[j];
        }
    }
    o->touches = false;
    o->since = time;
    o->tip_before = o->tip_now = o->wall;
}
