#include "src/session/account.h"

#include <assert.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

typedef struct account {
    const scenario *scenario;
    const run_result *run;
    char (*sentences)[ACCOUNT_SENTENCE];
    int count;
} account;

__attribute__((format(printf, 2, 3))) static void add_sentence(account *a,
                                                               const char *format, ...)
{
    assert(a->count < ACCOUNT_SENTENCES);
    va_list list;
    va_start(list, format);
    vsnprintf(a->sentences[a->count++], ACCOUNT_SENTENCE, format, list);
    va_end(list);
}

// The row with which an instant begins, of the state before an event there, or the last
// one before.
static const sample *row_entering(const trace *t, double time)
{
    size_t r = trace_row_at(t, time);
    while (r > 0 && t->rows[r - 1].time >= time) {
        r--;
    }
    return &t->rows[r];
}

// The row before the first touch: where no row holds the state just before it, as of the
// printed arm, the one of the step before.
static const sample *row_before_touch(const trace *t, double touch)
{
    const sample *row = row_entering(t, touch);
    if (row->contact != 0 && row > t->rows) {
        row--;
    }
    return row;
}

// --- the sentences ---------------------------------------------------------------------

// Writes what drives the arm: a voltage, or a control law by its name.
static void write_drive(const scenario *s, char *text, size_t size)
{
    const parameters *p = &s->parameters;
    char law[64];
    if (p->control.law == LAW_NONE) {
        snprintf(text, size, "%g V", p->motor.voltage);
        return;
    }
    parameter_format(p, PARAMETER_INDEX(control.law), law, sizeof law);
    snprintf(text, size, "the law '%s'", law);
}

// How near the arm comes to the wall [m]; infinite without a wall.
static double nearest_gap(const trace *t)
{
    double nearest = (double)INFINITY;
    for (size_t r = 0; r < t->row_count; r++) {
        nearest = fmin(nearest, t->rows[r].gap);
    }
    return nearest;
}

// Adds a sentence on a run without a touch: how near the arm comes to the wall.
static void say_no_touch(account *a, const char *drive)
{
    const trace *t = &a->run->trace;
    const double end = t->rows[t->row_count - 1].time;
    const double nearest = nearest_gap(t);

    if (isfinite(nearest)) {
        add_sentence(a,
                     "Driven by %s the arm does not touch the wall in %.4g s: %.3g mm "
                     "are left at its nearest.",
                     drive, end, 1e3 * nearest);
    } else {
        add_sentence(a,
                     "Driven by %s the arm moves for %.4g s, and nothing is in its way.",
                     drive, end);
    }
}

// Adds a sentence on how the arm comes to the wall; false if it does not.
static bool say_approach(account *a)
{
    const trace *t = &a->run->trace;
    const double touch = a->run->summary.first_contact_s;
    char drive[96];
    write_drive(a->scenario, drive, sizeof drive);
    if (isnan(touch)) {
        say_no_touch(a, drive);
        return false;
    }

    // with its speed and energy, as far as the model tells them
    const sample *before = row_before_touch(t, touch);
    if (before->contact != 0) {
        add_sentence(a, "Driven by %s the arm starts on the wall.", drive);
        return true;
    }

    if (isnan(before->kinetic_energy) || isnan(before->gap_velocity)) {
        add_sentence(a, "Driven by %s the arm touches the wall at %.4g s.", drive, touch);
        return true;
    }
    add_sentence(a,
                 "Driven by %s the arm touches the wall at %.4g s, its tip at %.3g "
                 "m/s, with %.3g J of motion.",
                 drive, touch, fabs(before->gap_velocity), before->kinetic_energy);
    return true;
}

// The first impact; NULL without one.
static const event *first_impact(const trace *t)
{
    for (size_t i = 0; i < t->event_count; i++) {
        if (t->events[i].kind == EVENT_IMPACT) {
            return &t->events[i];
        }
    }
    return NULL;
}

// Adds a sentence on the first impact, if there is one: its impulse, and the kinetic
// energy before and after it.
static void say_blow(account *a)
{
    const trace *t = &a->run->trace;
    const event *impact = first_impact(t);
    if (impact == NULL) {
        return;
    }

    // what was there before it, and after it
    add_sentence(a,
                 "At %.4g s an impulse of %.3g N s stops what has to stop at once: of "
                 "%.3g J of motion %.3g J are left, whatever comes.",
                 impact->time, impact->impulse,
                 row_entering(t, impact->time)->kinetic_energy,
                 t->rows[trace_row_at(t, impact->time)].kinetic_energy);
}

// Writes what the hub does first between the touch and the end of the pulse.
static void write_turn(const trace *t, double touch, double end, char *text, size_t size)
{
    for (size_t i = 0; i < t->event_count; i++) {
        const event *e = &t->events[i];
        if (!(e->time > touch && e->time <= end)) {
            continue;
        }
        if (e->kind == EVENT_REVERSAL) {
            snprintf(text, size, "the hub reverses at %.4g s", e->time);
            return;
        }
        if (e->kind == EVENT_STICK) {
            snprintf(text, size, "the hub comes to rest at %.4g s", e->time);
            return;
        }
    }
    snprintf(text, size, "the hub goes on turning");
}

// Adds a sentence on the pulse: its peak, the energy in the springs there, and what the
// hub does.
static void say_pulse(account *a, double touch, double end)
{
    const trace *t = &a->run->trace;
    const summary *m = &a->run->summary;
    if (isnan(m->first_pulse_peak_N) || isnan(m->first_pulse_time_to_peak_s)) {
        return;
    }

    const double peak = touch + m->first_pulse_time_to_peak_s;
    const sample *at_peak = &t->rows[trace_row_at(t, peak)];
    char turn[96];
    write_turn(t, touch, end, turn, sizeof turn);

    add_sentence(a,
                 "The rest bends the arm against the wall: the force is largest at "
                 "%.4g s, %.4g N, when the springs hold %.3g J; %s.",
                 peak, m->first_pulse_peak_N, at_peak->strain_energy, turn);
}

// The energies of a run, with the sign 1 of those that give energy as they fall, and -1
// of those that give energy as they rise (works).
static const struct {
    int signal;
    const char *name;
    double sign;
} energy_shares[] = {
    {SIGNAL_INDEX(kinetic_energy), "motion", 1},
    {SIGNAL_INDEX(strain_energy), "springs", 1},
    {SIGNAL_INDEX(wall_energy), "wall", 1},
    {SIGNAL_INDEX(weight_energy), "weight", 1},
    {SIGNAL_INDEX(motor_work), "motor", -1},
    {SIGNAL_INDEX(external_work), "pushes", -1},
    {SIGNAL_INDEX(wall_work), "the wall's motion", -1},
    {SIGNAL_INDEX(viscous_loss), "back EMF", 1},
    {SIGNAL_INDEX(friction_loss), "friction", 1},
    {SIGNAL_INDEX(damping_loss), "damping", 1},
    {SIGNAL_INDEX(impact_loss), "impacts", 1},
    {SIGNAL_INDEX(wall_loss), "the wall's damping", 1},
};

// Lists what gives energy between two rows (sign 1) or takes it (-1): "springs 0.01 J,
// motor 0.002 J". Shares below a thousandth of the change of motion and springs are left
// out.
static void list_shares(const sample *from, const sample *to, double sign, char *text,
                        size_t size)
{
    const double least = 1e-3 * (fabs(from->kinetic_energy - to->kinetic_energy) +
                                 fabs(from->strain_energy - to->strain_energy));
    const int count = sizeof energy_shares / sizeof *energy_shares;

    // "nothing" stays if the list has no entry
    size_t used = 0;
    snprintf(text, size, "nothing");
    const char *comma = "";

    for (int i = 0; i < count && used < size; i++) {
        const int signal = energy_shares[i].signal;
        const double fall = signal_value(from, signal) - signal_value(to, signal);
        const double share = sign * energy_shares[i].sign * fall;
        if (share > least) { // false of an energy that the scenario has not, which is NaN
            used += (size_t)snprintf(text + used, size - used, "%s%s %.3g J", comma,
                                     energy_shares[i].name, share);
            comma = ", ";
        }
    }
}

// Adds a sentence on the end of the pulse: what gives energy from the peak to the release
// and what takes it, or that the arm stays on the wall.
static void say_release(account *a, double touch)
{
    const trace *t = &a->run->trace;
    const summary *m = &a->run->summary;
    if (isnan(m->first_pulse_s)) {
        add_sentence(a,
                     "What the springs give back is too little to lift the arm off: it "
                     "stays on the wall.");
        return;
    }
    const double end = touch + m->first_pulse_s;
    const char *then = m->impacts > 1 ? ", and comes back" : "";

    // without rows between the peak and the release there is no balance to tell
    double delay = m->first_pulse_time_to_peak_s;
    if (isnan(delay)) {
        delay = 0;
    }
    const sample *at_peak = &t->rows[trace_row_at(t, touch + delay)];
    const sample *after = &t->rows[trace_row_at(t, end)];
    if (!(delay > 0) || after == at_peak) {
        add_sentence(a, "The arm lets go at %.4g s%s.", end, then);
        return;
    }

    char given[160], taken[160];
    list_shares(at_peak, after, 1, given, sizeof given);
    list_shares(at_peak, after, -1, taken, sizeof taken);
    add_sentence(
        a,
        "From there until it lets go at %.4g s%s, energy is given by %s and taken by %s.",
        end, then, given, taken);
}

// Adds a sentence on the end of the run: the force held, the force pressed with, or the
// gap.
static void say_end(account *a)
{
    const trace *t = &a->run->trace;
    const summary *m = &a->run->summary;
    const sample *last = &t->rows[t->row_count - 1];
    const bool sticks = last->sticking != 0;

    if (a->scenario->parameters.control.law != LAW_NONE) {
        char peak[64] = "";
        if (!isnan(m->force_over_command_N)) {
            snprintf(peak, sizeof peak, "; its peak is %.3g N above that",
                     m->force_over_command_N);
        }

        const char *rest = sticks ? ", where the hub sticks" : "";
        add_sentence(a, "The law wants %.3g N and gets %.4g at the end%s%s.",
                     m->force_command_N, m->steady_force_N, rest, peak);
    } else if (last->contact != 0) {
        const char *held = sticks ? ", the hub held by friction" : "";
        add_sentence(
            a,
            "At the end the arm presses with %.3g N under %.3g N m of the motor%s; a "
            "controller would choose that force and damp the pulse (:law).",
            last->force, last->motor_torque, held);
    } else {
        add_sentence(a,
                     "At the end the arm is off the wall by %.3g mm; a controller would "
                     "hold it there or bring it back (:law).",
                     1e3 * last->gap);
    }
}

// The account in the order of time, from the approach to the end.
int run_account(const scenario *s, const run_result *run,
                char sentences[ACCOUNT_SENTENCES][ACCOUNT_SENTENCE])
{
    assert(run->trace.row_count > 0);
    account a = {.scenario = s, .run = run, .sentences = sentences};
    const double last = run->trace.rows[run->trace.row_count - 1].time;
    if (run->summary.status != STATUS_OK) {
        const char *why = run->summary.message;
        if (why[0] == '\0') {
            why = status_text(run->summary.status);
        }
        add_sentence(&a, "The run stops at %.4g s: %.200s.", last, why);
        return a.count;
    }
    if (!say_approach(&a)) {
        return a.count;
    }

    // a pulse that does not end lasts as long as the run
    const double touch = run->summary.first_contact_s;
    double end = last;
    if (!isnan(run->summary.first_pulse_s)) {
        end = touch + run->summary.first_pulse_s;
    }

    // the printed model has no energies in its rows: its account is shorter
    if (s->parameters.arm.model == ARM_CORRECTED) {
        say_blow(&a);
        say_pulse(&a, touch, end);
        say_release(&a, touch);
    }
    say_end(&a);
    return a.count;
}

// Writes how fast the arm comes to the wall, as far as the model tells it.
static void write_hit(const trace *t, double touch, char *line)
{
    const sample *before = row_before_touch(t, touch);
    if (before->contact != 0) {
        snprintf(line, ACCOUNT_SENTENCE, "starts on the wall");
    } else if (isnan(before->gap_velocity)) {
        snprintf(line, ACCOUNT_SENTENCE, "touches the wall at %.4g s", touch);
    } else {
        snprintf(line, ACCOUNT_SENTENCE, "hits at %.3g m/s", fabs(before->gap_velocity));
    }
}

void run_account_line(const run_result *run, char line[ACCOUNT_SENTENCE])
{
    const trace *t = &run->trace;
    const double touch = run->summary.first_contact_s;
    if (isnan(touch)) {
        const double nearest = nearest_gap(t);
        snprintf(line, ACCOUNT_SENTENCE, "no touch");
        if (isfinite(nearest)) {
            snprintf(line, ACCOUNT_SENTENCE, "no touch: %.3g mm are left at its nearest",
                     1e3 * nearest);
        }
        return;
    }
    write_hit(t, touch, line);

    // what the impact takes of the motion
    const event *impact = first_impact(t);
    if (impact == NULL) {
        return;
    }
    const double before = row_entering(t, impact->time)->kinetic_energy;
    const double after = t->rows[trace_row_at(t, impact->time)].kinetic_energy;
    if (before > 0 && isfinite(after)) {
        const size_t used = strlen(line);
        snprintf(line + used, ACCOUNT_SENTENCE - used,
                 ", %.0f %% of the motion is lost at once, the rest bends the arm",
                 100 * (before - after) / before);
    }
}
