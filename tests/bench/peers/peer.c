// Shared by the peers: their answers, and for those with a fixed step finding contact times and
// peaks in their samples.
#include "tests/bench/peers/peer.h"

#include <math.h>

void peer_answer_clear(peer_answer *answer)
{
    const double none = (double)NAN;
    *answer = (peer_answer){none, none, none, none, none, none, none, none, none, none, none};
}

double peer_own_steps(const void *instance)
{
    (void)instance;
    return 0;
}

double peer_duration(const void *instance)
{
    (void)instance;
    return EXPERIMENT_DURATION;
}

void peer_note_peak(double time, double force, peer_answer *answer)
{
    if (!(force <= answer->peak)) {
        answer->peak = force;
        answer->peak_delay = time - answer->first_contact;
    }
}

void peer_note_contact(double time, double impulse, peer_answer *answer)
{
    if (isnan(answer->first_contact)) {
        answer->first_contact = time;
        answer->impulse = impulse;
    } else if (isnan(answer->second_contact)) {
        answer->second_contact = time;
    }
}

void contact_watch_begin(contact_watch *watch, double step, peer_answer *answer)
{
    *watch = (contact_watch){.answer = answer, .step = step};
}

void contact_watch_sample(contact_watch *watch, double time, double angles, double rate,
                          double force)
{
    peer_answer *a = watch->answer;
    // sin(q1 - wall) + sin(q2 - wall) is zero just where the angles' sum is twice the wall's
    double into = angles - 2 * EXPERIMENT_WALL, before = watch->into;
    if (into >= 0 && before < 0) {
        double closed = time - watch->step * fmax(0, 1 + before / (watch->step * watch->rate));
        if (isnan(a->first_contact)) {
            a->first_contact = closed;
        } else if (watch->released && isnan(a->second_contact)) {
            a->second_contact = closed;
        }
    }
    watch->into = into;
    watch->rate = rate;
    a->final_force = force;
    if (isnan(a->first_contact)) {
        return;
    }
    double since = time - a->first_contact;
    a->spike = force <= a->spike ? a->spike : force;
    if (!watch->released && since > EXPERIMENT_SETTLING) {
        if (force <= 0) {
            watch->released = true;
            a->release = time;
        } else if (!(force <= a->peak)) {
            a->peak = force;
            a->peak_delay = since;
        }
    }
}
