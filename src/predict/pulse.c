// The first pulse of a touch, followed by the arm's own engine from the touch on.
#include "src/predict/linearised.h"

#include <assert.h>
#include <math.h>

#include "src/base/sincos.h"
#include "src/contact/contact_machine.h"
#include "src/engines/motion_create.h"

// The peak is known if it grows by no more than this share of it between this share of the horizon
// and its end.
#define SETTLED_FROM 0.8
#define SETTLED      5e-4

#define ENERGY_ROW   1e-4  // from one look at the energies to the next [s]
#define COMMAND_DUE  1e-12 // share of its instant by which a command may be early

enum { MOST_STEPS = 60000 };

arm arm_touching_now(const arm *a, const double *q)
{
    arm touched = *a;
    double x, y;

    // a point moves across the last link onto its line, a flat wall turns to the tip
    if (a->wall.kind == WALL_POINT) {
        double t_x = -inline_sin(q[a->dof - 1]), t_y = inline_cos(q[a->dof - 1]);
        chain_node(a, q, a->links - 1, &x, &y);
        double across = t_x * (a->wall.x - x) + t_y * (a->wall.y - y);
        touched.wall.x -= across * t_x;
        touched.wall.y -= across * t_y;
    } else {
        chain_node(a, q, a->links, &x, &y);
        double distance = sqrt(x * x + y * y);
        touched.wall.cosine = x / distance;
        touched.wall.sine = y / distance;
    }
    return touched;
}

// What is seen of energies: the kinetic energy where the strain was largest [J].
typedef struct seen_energies {
    double most_strain, kinetic_there;
} seen_energies;

static void see_energies(const arm *a, motion *m, seen_energies *seen)
{
    const state_energy now = motion_energy(a, m, m->state);
    if (now.strain > seen->most_strain) {
        *seen = (seen_energies){now.strain, now.kinetic};
    }
}

// Puts the commands into effect that are due; returns when the next one is [s].
static double give_commands(arm *a, motion *m, const voltage_profile *command, int *next)
{
    const double now = m->state[SLOT_TIME];
    while (*next < command->count && command->times[*next] <= now * (1 + COMMAND_DUE)) {
        const double before = a->motor.torque;
        arm_set_voltage(a, command->volts[(*next)++]);
        motion_retorque(a, m, before);
    }
    return *next < command->count ? command->times[*next] : HUGE_VAL;
}

// Puts the arm where it is touched, through the impact. Whether the touch holds.
static bool touch(const arm *a, motion *m, const double *q, const double *w, double flows,
                  prediction *out)
{
    const double limit = a->motor.current_limit > 0 ? a->motor.current_limit : HUGE_VAL;
    const double current = a->motor.inductance > 0 ? flows : 0;
    motion_report report = {.event = m->wall_gives ? MOTION_TOUCH : MOTION_IMPACT};
    motion_start_at(a, m, q, w, fmax(-limit, fmin(current, limit)));
    if (m->state[SLOT_CONTACT] == 0) {
        motion_apply(a, m, &report);
    }
    out->impulse = report.impulse;
    motion_reset_peak(m);
    return m->state[SLOT_CONTACT] != 0;
}

// Follows the arm in contact to where that ends, to the horizon, or as far as it can be followed.
static status follow(arm *a, motion *m, const voltage_profile *command, seen_energies *seen,
                     prediction *out)
{
    const double settled = SETTLED_FROM * PULSE_HORIZON;
    double before = 0; // the peak then [N]
    int next = 0, steps = 0;
    while (m->state[SLOT_TIME] < PULSE_HORIZON) {
        double until = fmin(give_commands(a, m, command, &next), PULSE_HORIZON);
        if (seen != NULL) {
            see_energies(a, m, seen);
            until = fmin(until, m->state[SLOT_TIME] + ENERGY_ROW);
        }
        if (m->state[SLOT_TIME] <= settled) {
            before = m->record.pulse_peak;
            until = m->state[SLOT_TIME] < settled ? fmin(until, settled) : until;
        }

        // a step, and the event at its end; a command may end the contact, too
        motion_report report;
        if (m->state[SLOT_CONTACT] != 0) {
            TRY(motion_step(a, m, until, m->nominal_step, &report));
            motion_apply(a, m, &report);
        }
        if (m->state[SLOT_CONTACT] == 0) {
            return STATUS_OK;
        }
        if (steps++ == MOST_STEPS) {
            break;
        }
    }

    // a force that still rises has its peak beyond the horizon
    const bool rises = m->record.pulse_peak - before > SETTLED * m->record.pulse_peak;
    out->doubtful = rises || steps > MOST_STEPS;
    return STATUS_OK;
}

status predict_pulse(const arm *source, const method_parameters *method, const double *q,
                     const double *w, const voltage_profile *command, bool energies,
                     prediction *out)
{
    assert(command == NULL || command->count == 0 || (command->times && command->volts));
    *out = prediction_none();
    if (!wall_stands(&source->wall)) {
        return STATUS_OK;
    }
    const voltage_profile given = command != NULL ? *command : (voltage_profile){0};
    arm a = arm_touching_now(source, q);
    method_parameters event = *method;
    event.name = METHOD_EVENT;
    motion *m = motion_create(&a, &event);
    FAIL_IF(m == NULL, STATUS_NO_MEMORY);

    // numbers only where they are to be relied on
    seen_energies seen = {0};
    const bool held = touch(&a, m, q, w, given.current, out);
    const status s = held ? follow(&a, m, &given, energies ? &seen : NULL, out) : STATUS_OK;
    out->holds = held && s == STATUS_OK && !out->doubtful;
    if (out->holds) {
        out->force = m->record.pulse_peak;
        out->delay = m->record.pulse_peak_time;
    }
    if (out->holds && energies && m->state[SLOT_CONTACT] == 0) {
        see_energies(&a, m, &seen);
        const double left = motion_energy(&a, m, m->state).kinetic;
        out->restitution = seen.most_strain > 0 ? (left - seen.kinetic_there) / seen.most_strain
                                                : (double)NAN; // no joint stores anything
    }
    motion_destroy(m);
    return s;
}
