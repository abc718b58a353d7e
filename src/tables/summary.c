#include "src/tables/summary.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "src/base/words.h"

#define NUMBER(field, ...) [SUMMARY_INDEX(field)] = {#field, __VA_ARGS__}
#define TIMING             .timing = true
#define SPECIAL            .special = true
#define BOUNDS(number, label, what)                                                                \
    NUMBER(number##_low_N, #number "_low", label " low", "N",                                      \
           "least that the " what " may be where it is not determined", SPECIAL),                  \
        NUMBER(number##_high_N, #number "_high", label " high", "N",                               \
               "most that the " what " may be where it is not determined", SPECIAL)

const summary_info summary_table[] = {
    // number, name, label, unit, description, what is special about it
    NUMBER(first_contact_s, "first_contact", "first contact", "s",
           "the arm touches the wall for the first time"),
    NUMBER(contact_impulse_Ns, "contact_impulse", "contact impulse", "N s",
           "impulse of the first impact"),
    NUMBER(first_pulse_peak_N, "first_pulse_peak", "first pulse peak", "N",
           "largest force from first contact to first release"),
    BOUNDS(first_pulse_peak, "first pulse peak",
           "largest force from first contact to first release"),
    NUMBER(first_pulse_time_to_peak_s, "first_pulse_time_to_peak", "first pulse time to peak", "s",
           "from first contact to that force"),
    NUMBER(first_pulse_s, "first_pulse", "first pulse", "s", "from first contact to first release"),
    NUMBER(peak_force_N, "peak_force", "peak force", "N", "largest force of the whole run"),
    BOUNDS(peak_force, "peak force", "largest force of the whole run"),
    NUMBER(time_to_peak_s, "time_to_peak", "time to peak", "s", "from first contact to that force"),
    NUMBER(impacts, "impacts", "impacts", "", "impacts of the whole run"),
    NUMBER(separations, "separations", "separations", "",
           "times that the arm leaves the wall by more than 1 um"),
    NUMBER(steady_force_N, "steady_force", "steady force", "N", "mean force over the last 0.1 s"),
    BOUNDS(steady_force, "steady force", "mean force over the last 0.1 s"),
    NUMBER(force_overshoot_percent, "force_overshoot", "force overshoot", "%",
           "largest force over the steady one"),
    NUMBER(settling_time_s, "settling_time", "settling time", "s",
           "from first contact until the force is steady within 5 % for good"),
    NUMBER(max_penetration_m, "max_penetration", "max penetration", "m",
           "largest depth of the arm behind the wall"),
    NUMBER(motor_work_J, "motor_work", "motor work", "J", "work done by the motor torque"),
    NUMBER(energy_residual_J, "energy_residual", "energy residual", "J",
           "largest energy that the ledger does not account for"),
    NUMBER(wall_loss_J, "wall_loss", "wall loss", "J", "energy lost in a wall that gives", SPECIAL),
    NUMBER(force_command_N, "force_command", "force command", "N",
           "force that the controller is to hold at the end", SPECIAL),
    NUMBER(force_over_command_N, "force_over_command", "force over command", "N",
           "largest force minus the commanded one", SPECIAL),
    NUMBER(smoothed_over_command_N, "smoothed_over_command", "smoothed over command", "N",
           "largest mean of the force over 5 ms, impulses included, from 20 ms after first contact "
           "on, minus the commanded force",
           SPECIAL),
    NUMBER(steady_error_N, "steady_error", "steady error", "N",
           "steady force minus the commanded one", SPECIAL),
    NUMBER(largest_command_V, "largest_command", "largest command", "V",
           "largest command to the amplifier either way", SPECIAL),
    NUMBER(electrical_energy_J, "electrical_energy", "electrical energy", "J",
           "energy that the amplifier fed into the motor", SPECIAL),
    NUMBER(approach_speed_m_s, "approach_speed", "approach speed", "m/s",
           "largest speed of the tip towards the wall before first contact", SPECIAL),
    NUMBER(return_speed_m_s, "return_speed", "return speed", "m/s",
           "largest speed of the tip towards the wall without contact, after the first", SPECIAL),
    NUMBER(steps, "steps", "steps", "", "time steps taken"),
    NUMBER(cpu_time_s, "cpu_time", "cpu time", "s", "processor time of the run", TIMING),
    NUMBER(wall_time_s, "wall_time", "wall time", "s", "time that passed during the run", TIMING),
};

const int summary_count = (int)(sizeof summary_table / sizeof summary_table[0]);

// the numbers end with the struct, so that none of them is missing from the table
_Static_assert(sizeof summary_table / sizeof summary_table[0] == SUMMARY_NUMBERS,
               "every number of a summary has its row");

int summary_find(const char *key)
{
    assert(key != NULL);
    for (int i = 0; i < summary_count; i++) {
        if (strcmp(summary_table[i].key, key) == 0) {
            return i;
        }
    }
    return -1;
}

int summary_index(const char *key)
{
    int index = summary_find(key);
    assert(index >= 0);
    return index;
}

const char *summary_suggest(const char *key)
{
    nearest_word nearest = nearest_begin(key);
    for (int i = 0; i < summary_count; i++) {
        nearest_try(&nearest, summary_table[i].key);
    }
    return nearest.best;
}

static size_t offset_of(int index)
{
    assert(index >= 0 && index < summary_count);
    return offsetof(summary, first_contact_s) + (size_t)index * sizeof(double);
}

double summary_value(const summary *s, int index)
{
    assert(s != NULL);
    double value;
    memcpy(&value, (const char *)s + offset_of(index), sizeof value);
    return value;
}

const char *summary_status(const summary *s)
{
    return s->status != STATUS_OK ? "failed" : s->inaccurate ? "inaccurate" : "ok";
}

status summary_fault(const summary *s, fault *f)
{
    assert(s != NULL && s->status != STATUS_OK);
    return fault_set_at(f, s->status, s->path, "%s", s->message);
}

void summary_init(summary *s)
{
    assert(s != NULL);
    const double none = (double)NAN;
    memset(s, 0, sizeof *s);
    s->path = "";
    for (int i = 0; i < summary_count; i++) {
        memcpy((char *)s + offset_of(i), &none, sizeof none);
    }
}
