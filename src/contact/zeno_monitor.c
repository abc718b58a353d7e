#include "src/contact/zeno_monitor.h"

#include <assert.h>
#include <math.h>

#include "src/base/numbers.h"

// A run is given up where its internal steps are shorter than this, as a share of its
// duration or of a second, whichever is less: it would take ten million of them, hours
// with many links. In contact with a wall whose damper shortens each of them a million
// are enough: such internal steps follow a decay that is long over. Steps requested by
// method.step do not count.
#define LEAST_STEP        1e-7
#define LEAST_DAMPED_STEP 1e-6
#define ASKED_FOR         1e-3 // share of method.step

// Links up to which all chains have ZENO_STEPS between two checks, and the least number
// of those of more links.
enum { FEW_LINKS = 8, LEAST_STEPS = 1 << 12 };

// The wall makes internal steps short where more than one in so many ends in contact.
enum { FEW_TOUCHING = 8 };

// Whether the arm is in contact with a wall that gives.
static bool is_within(const motion *m)
{
    return !motion_wall_is_rigid(m) && m->state[SLOT_CONTACT] != 0;
}

// Whether an event is one of the wall.
static bool is_of_wall(motion_event event)
{
    return event == MOTION_IMPACT || event == MOTION_TOUCH || event == MOTION_RELEASE;
}

// Whether the fastest mode vibrates on and on, and is what steps follow.
static bool rings_on(const arm *a, const motion *m)
{
    const bool damped = arm_link_of(a, a->links - 1).damping > 0 || a->damped_modes > 0;
    return !damped && a->fastest_decay <= a->highest_frequency &&
           motion_wall_is_rigid(m) && a->motor.inductance == 0;
}

void zeno_monitor_cause(const arm *a, const motion *m, motion_event last, char *text,
                        size_t size)
{
    const double *w = state_velocities(m, m->state);
    int fastest = 0;
    for (int i = 1; i < m->dof; i++) {
        if (fabs(w[i]) > fabs(w[fastest])) {
            fastest = i;
        }
    }

    if (fabs(w[fastest]) >= a->fastest_rate) {
        decimal_print(text, size, "its angle %d turns at %.3g rad/s, too fast to follow",
                      fastest + 1, w[fastest]);
    } else if (last == MOTION_STICK || last == MOTION_SLIP) {
        decimal_print(text, size,
                      "the hub comes to rest and breaks away by turns, and another "
                      "motor.stiction, or none, has longer strides");
    } else if (is_within(m) || (is_of_wall(last) && !motion_wall_is_rigid(m))) {
        const char *damper = "", *mass = "";
        if (a->wall.damping > 0) {
            damper = "wall.damping or ";
        }
        if (m->wall_has_face) {
            mass = ", or a larger wall.mass,";
        }
        decimal_print(text, size,
                      "it is in contact with a wall that gives, and a smaller "
                      "%swall.stiffness%s has longer strides",
                      damper, mass);
    } else if (is_of_wall(last) && a->wall.restitution > 0) {
        decimal_print(text, size,
                      "it bounces off the wall, which a smaller wall.restitution or a "
                      "larger method.rest_speed ends sooner");
    } else if (rings_on(a, m)) {
        decimal_print(
            text, size,
            "an undamped arm is followed as fast as its fastest mode vibrates, "
            "%.3g rad/s; fewer links, softer joints or an arm.damping_ratio have "
            "longer strides",
            a->highest_frequency);
    } else {
        decimal_print(text, size,
                      "the fastest mode of the arm changes at %.3g 1/s, and softer or "
                      "fewer joints with less damping have longer strides",
                      a->fastest_rate);
    }
}

zeno_monitor zeno_monitor_begin(void)
{
    return (zeno_monitor){.checked_at = -1};
}

// Internal steps between two checks.
static long steps_between(const arm *a)
{
    long steps = ZENO_STEPS;
    if (a->dof > FEW_LINKS) {
        steps = steps * FEW_LINKS / a->dof;
        if (!(steps > LEAST_STEPS)) {
            steps = LEAST_STEPS;
        }
    }
    return steps;
}

status zeno_monitor_check(zeno_monitor *p, const arm *a, const motion *m, double duration,
                          double asked, fault *f)
{
    assert(duration > 0 && asked > 0);
    const double now = m->state[SLOT_TIME], from = p->checked_at;

    // the first internal step only begins to count
    double slowest = LEAST_STEP;
    if (is_within(m) && a->wall.damping > 0) {
        slowest = LEAST_DAMPED_STEP;
    }
    const long steps = steps_between(a);
    const double least =
        (double)steps * fmin(slowest * fmin(duration, 1), ASKED_FOR * asked);
    const bool passes = from < 0 || now - from >= least;
    const bool meets_wall = p->touching * FEW_TOUCHING > p->steps;
    p->steps = p->touching = 0;
    p->due = steps;
    p->checked_at = now;
    if (passes) {
        return STATUS_OK;
    }

    char cause[ZENO_CAUSE_SIZE];
    const motion_event last = meets_wall ? MOTION_TOUCH : MOTION_REACHED;
    zeno_monitor_cause(a, m, last, cause, sizeof cause);
    return fault_set(f, STATUS_NO_PROGRESS,
                     "at t = %.9g s of %g s: %ld strides by %s passed %.3g s, at which "
                     "the run is given up: %s",
                     now, duration, steps, m->engine->name, now - from, cause);
}
