#include "tests/chain_outcome.h"

#include "src/contact/contact_machine.h"
#include "src/engines/motion_create.h"
#include "tests/check.h"

GIVEN_BACK(motion, motion_destroy)

#define SENSOR 1e-3 // time constant [s]

// The lowest flight, measured by its time multiplied by its speed at the end [m], and the
// least such speed [m/s]. What is below is rounding, of an arm that friction holds.
#define LOWEST  1e-11
#define SLOWEST 1e-8

#define NOTHING 1e-12 // momentum of a wall that is not pressed on [N s]

enum { MOST_EVENTS = 200000 };

// Notes the momentum that the wall has taken, at each interval since first contact that
// the last step has passed. The step began at `before`.
static void take_samples(const arm *a, motion *m, double before, double impulses,
                         chain_outcome *o)
{
    while (!isnan(o->first_contact) && o->samples < REFERENCE_SAMPLES) {
        double time = o->first_contact + o->samples * REFERENCE_INTERVAL;
        if (time > m->state[SLOT_TIME]) {
            return;
        }
        double *state =
            time > before ? motion_between(a, m, time, STATE_WHOLE) : m->trial;
        assert_non_null(state);
        o->momentum[o->samples++] =
            impulses + state_quadratures(m, state)[QUADRATURE_FORCE];
    }
}

void chain_outcome_note(chain_outcome *o, double time, double speed, double parted)
{
    const bool flew = speed > SLOWEST && speed * (time - parted) > LOWEST;
    if (isnan(o->first_contact)) {
        o->first_contact = flew ? time : 0;
    }
    if (flew) {
        if (o->contacts < OUTCOME_CONTACTS) {
            o->contact_times[o->contacts] = time;
            o->contact_speeds[o->contacts] = speed;
        }
        o->contacts++;
    }
}

void chain_outcome_forget(chain_outcome *o, double momentum)
{
    if (o->first_contact == 0 && o->contacts == 0 && momentum < NOTHING) {
        o->first_contact = (double)NAN;
        o->samples = 0;
    }
}

chain_outcome chain_outcome_of(const chain_start *start)
{
    const parameters *p = start->parameters;
    arm a;
    arm_init(&a, p);
    KEPT_MOTION(m) = motion_create_by(&a, &p->method, start->by);
    assert_non_null(m);
    motion_start(&a, m, start->angle, start->velocity);
    chain_outcome o = {.first_contact = (double)NAN};

    // an arm that starts on its wall
    double impulses = 0, end = start->duration, parted = 0;
    if (m->state[SLOT_CONTACT] != 0) {
        o.first_contact = 0;
        o.momentum[o.samples++] = 0;
        end = fmin(end, start->after_contact);
    }

    for (int events = 0; m->state[SLOT_TIME] < end; events++) {
        // a step, up to the next event at most
        motion_report r;
        const double before_contact = m->state[SLOT_CONTACT];
        const double before = m->state[SLOT_TIME], work = motion_motor_work(m, m->state);
        const double pushed = state_quadratures(m, m->state)[QUADRATURE_PUSHED];
        if (events == MOST_EVENTS) {
            o.status = STATUS_NO_PROGRESS;
            break;
        }
        o.status = motion_step(&a, m, end, p->method.step, &r);
        if (o.status != STATUS_OK) {
            break;
        }

        // momentum and ledger, then the event
        take_samples(&a, m, before, impulses, &o);
        o.put_in += fabs(motion_motor_work(m, m->state) - work) +
                    fabs(state_quadratures(m, m->state)[QUADRATURE_PUSHED] - pushed);
        o.residual = fmax(o.residual, fabs(motion_energy_residual(&a, m, m->state)));
        const double now = m->state[SLOT_TIME], speed = -m->state[SLOT_GAP_VELOCITY];
        if (r.event != MOTION_REACHED) {
            motion_apply(&a, m, &r);
        }
        const bool waited = isnan(o.first_contact);
        impulses += r.impulse;
        o.impulses = impulses;
        if (r.event == MOTION_IMPACT) {
            o.impacts++;
        }
        if (r.event == MOTION_IMPACT ||
            (r.event == MOTION_TOUCH && before_contact == 0)) {
            chain_outcome_note(&o, now, speed, parted);
        }

        // where contacts end, and the run
        if (m->state[SLOT_CONTACT] == 0 &&
            (before_contact != 0 || r.event == MOTION_IMPACT)) {
            parted = now;
            chain_outcome_forget(&o,
                                 impulses +
                                     state_quadratures(m, m->state)[QUADRATURE_FORCE]);
        }
        if (waited && !isnan(o.first_contact)) {
            o.first_impulse = r.impulse;
            o.momentum[o.samples++] = impulses;
        }
        end = start->duration;
        if (!isnan(o.first_contact)) {
            end = fmin(end, o.first_contact + start->after_contact);
        }
        if (start->most_contacts > 0 && o.contacts >= start->most_contacts) {
            end = now;
        }
    }

    // the end, largest force and losses
    o.ended = m->state[SLOT_TIME];
    o.motor_work = motion_motor_work(m, m->state);
    o.put_in += m->record.start_energy;
    o.peak = m->record.pulse_peak;
    o.peak_time = m->dof > 1 ? m->record.pulse_peak_time : 0;
    const double *quadrature = state_quadratures(m, m->state);
    const double lost[] = {m->state[SLOT_FRICTION_LOSS],
                           m->state[SLOT_IMPACT_LOSS],
                           quadrature[QUADRATURE_VISCOUS],
                           quadrature[QUADRATURE_DAMPING],
                           quadrature[QUADRATURE_WALL],
                           -quadrature[QUADRATURE_PUSHED]};
    memcpy(o.lost, lost, sizeof o.lost);
    return o;
}

double chain_outcome_sensor_difference(const chain_outcome *a, const chain_outcome *b)
{
    const double keep = exp(-REFERENCE_INTERVAL / SENSOR);
    const int samples = a->samples < b->samples ? a->samples : b->samples;
    double read[2] = {a->momentum[0] / SENSOR, b->momentum[0] / SENSOR}, square = 0,
           apart = 0;
    for (int k = 1; k < samples; k++) {
        for (int i = 0; i < 2; i++) {
            const chain_outcome *o = i == 0 ? a : b;
            double mean = (o->momentum[k] - o->momentum[k - 1]) / REFERENCE_INTERVAL;
            read[i] = keep * read[i] + (1 - keep) * mean;
        }
        square += read[0] * read[0];
        apart += (read[0] - read[1]) * (read[0] - read[1]);
    }
    return sqrt(apart / square);
}
