#include "src/study/calibrate.h"

#include <assert.h>
#include <math.h>

#include "src/arm/arm.h"
#include "src/run/run.h"
#include "src/base/json.h"
#include "src/study/result_rows.h"

#define SHORTEST_PRESS 5.0 // [s]
#define WINDOW_SHARE   0.4 // last part of a press over which the readings are averaged

// --- one press -------------------------------------------------------------------------

// Makes the scenario of a press under a constant command [V]. The arm starts at rest at
// the wall: an impact would make a beam without damping vibrate for ever, and the force
// sensor leave its range.
static status pressing(const scenario *s, double command, int number, scenario *under,
                       fault *f)
{
    const parameters *p = &s->parameters;
    const parameter_change changes[] = {
        {PARAMETER_INDEX(control.settings), .text = ""},
        {PARAMETER_INDEX(control.lock), .text = "none"},
        {PARAMETER_INDEX(control.law), LAW_OPEN_LOOP},
        {PARAMETER_INDEX(control.approach_voltage), command},
        {PARAMETER_INDEX(control.seed),
         (double)(((long)p->control.seed + number) % 2147483648L)},
        {PARAMETER_INDEX(initial.angle), p->wall.angle},
        {PARAMETER_INDEX(initial.velocity), 0},
        {PARAMETER_INDEX(run.duration), fmax(p->run.duration, SHORTEST_PRESS)},
    };

    // without the script's actions, and with another seed for each press
    scenario bare = *s;
    bare.action_count = 0;
    return scenario_with(&bare, changes, sizeof changes / sizeof *changes, under, f);
}

// Sums for the mean and standard deviation of readings, each weighted with the time for
// which it stood.
typedef struct average {
    double weight, sum, squares;
} average;

static void average_add(average *a, double value, double time)
{
    a->weight += time;
    a->sum += time * value;
    a->squares += time * value * value;
}

static double average_mean(const average *a)
{
    return a->sum / a->weight;
}

static double average_spread(const average *a)
{
    double mean = average_mean(a);
    return sqrt(fmax(0, a->squares / a->weight - mean * mean));
}

// K2 of (5.26) with l half the beam [N m/rad].
static double stiffness(const parameters *p, double force, double angle)
{
    return force * (p->arm.length / 2) / (2 * angle);
}

// Averages force and angle over the last part of a run, and finds the stiffness from
// them. The drift is the stiffness in the second half of that part over the one in the
// first, less 1: 0 of an arm at rest.
static void average_point(const parameters *p, const trace *t, double command,
                          calibration_point *point)
{
    average force[2] = {{0}}, angle[2] = {{0}}, whole_force = {0}, whole_angle = {0};
    const double wall = p->wall.angle + p->belief.wall_error, end = p->run.duration,
                 window = WINDOW_SHARE * end;

    // readings of the window, and of its halves, which tell whether the arm has come to
    // rest
    for (size_t i = 0; i + 1 < t->row_count; i++) {
        const sample *row = &t->rows[i];
        double stood = t->rows[i + 1].time - row->time;
        if (row->time >= end - window) {
            int half = row->time >= end - window / 2;
            average_add(&force[half], row->force_reading, stood);
            average_add(&angle[half], row->encoder - wall, stood);
            average_add(&whole_force, row->force_reading, stood);
            average_add(&whole_angle, row->encoder - wall, stood);
        }
    }

    // the stiffness that they show
    double k2[2];
    for (int half = 0; half < 2; half++) {
        k2[half] = stiffness(p, average_mean(&force[half]), average_mean(&angle[half]));
    }
    const double mean_force = average_mean(&whole_force);
    const double mean_angle = average_mean(&whole_angle);
    const double mean_k2 = stiffness(p, mean_force, mean_angle);
    *point = (calibration_point){.command = command,
                                 .force = mean_force,
                                 .angle = mean_angle,
                                 .k2 = mean_k2,
                                 .k2_over_arm = mean_k2 / p->arm.k2,
                                 .force_spread = average_spread(&whole_force),
                                 .angle_spread = average_spread(&whole_angle),
                                 .drift = k2[1] / k2[0] - 1};
}

// Runs one press and averages its readings. It is a fault if the arm does not press.
static status press_once(const scenario *s, double command, int number,
                         run_monitor *monitor, calibration_point *point, fault *f)
{
    const run_options options = {.keep_trace = true, .monitor = monitor};
    scenario under;
    TRY(pressing(s, command, number, &under, f));

    // a run that presses with it, and what the sensors read at its end
    SCOPED(run_finish) run_result result;
    const status code = run_scenario_with(&under, &options, &result);
    if (code != STATUS_OK) {
        return fault_set_at(f, code, result.summary.path,
                            "pressing with %g V failed: %.700s", command,
                            result.summary.message);
    }
    average_point(&under.parameters, &result.trace, command, point);
    FAULT_IF(!(point->force > 0) || !(point->angle > 0), f, STATUS_BAD_ARGUMENT,
             "under %g V the arm does not press: the force sensor reads %.4g N, "
             "the encoder %.4g rad beyond the wall; friction alone holds %.3g V",
             command, point->force, point->angle,
             s->parameters.motor.stiction / motor_torque_per_volt(&s->parameters.motor));
    return STATUS_OK;
}

status calibrate(const scenario *s, const double *commands, int count,
                 run_monitor *monitor, calibration *c, fault *f)
{
    assert(count > 0 && count <= K2_TABLE_MOST);
    *c = (calibration){0};

    // a force at rest needs a wall
    FAULT_IF(s->parameters.wall.kind == WALL_NONE, f, STATUS_BAD_ARGUMENT,
             "there is nothing to press against, wall.kind is none");

    if (s->parameters.wall.motion != MOTION_NONE) {
        return fault_set_at(f, STATUS_BAD_ARGUMENT, "wall.motion",
                            "force and angle come to rest on a wall at rest only: "
                            "calibrate with wall.motion = none");
    }

    // K2 says how the wall's force alone bends the beam
    if (s->parameters.arm.tilt != 0) {
        return fault_set_at(
            f, STATUS_BAD_ARGUMENT, "arm.tilt",
            "the weight bends the beam, too, so that force and angle say nothing "
            "of its stiffness alone: calibrate in a level plane, arm.tilt = 0");
    }

    // up to the first fault; what was measured before is kept
    for (int i = 0; i < count; i++) {
        TRY(press_once(s, commands[i], i, monitor, &c->points[i], f));
        c->count++;
        run_monitor_count(monitor);
    }
    return STATUS_OK;
}

// --- results ---------------------------------------------------------------------------

status calibration_table(const calibration *c, k2_table *t, fault *f)
{
    *t = (k2_table){0};

    // by growing force, whatever the commands' order
    for (int i = 0; i < c->count; i++) {
        const calibration_point *point = &c->points[i];
        int at = t->count++;
        for (; at > 0 && t->force[at - 1] > point->force; at--) {
            t->force[at] = t->force[at - 1];
            t->k2[at] = t->k2[at - 1];
        }
        t->force[at] = point->force;
        t->k2[at] = point->k2;
    }

    // a table gives one stiffness for a force
    for (int i = 1; i < t->count; i++) {
        // to the digits that the table is written with
        FAULT_IF(t->force[i] - t->force[i - 1] < 2e-3 * t->force[i], f,
                 STATUS_BAD_ARGUMENT,
                 "two commands press alike, with %.4g N, so there is no table by "
                 "force; expected commands further apart",
                 t->force[i]);
    }
    return STATUS_OK;
}

#define COLUMN(key, name, unit, field, times)                                            \
    {                                                                                    \
        key, name, unit, offsetof(calibration_point, field), times                       \
    }

static result_table calibration_columns(const calibration *c)
{
    static const result_column columns[] = {
        COLUMN("command_V", "command", "V", command, 1),
        COLUMN("force_N", "force", "N", force, 1),
        COLUMN("hub_angle_rad", "hub_angle", "rad", angle, 1),
        COLUMN("k2_Nm_per_rad", "k2", "N m/rad", k2, 1),
        COLUMN("k2_over_arm", "k2_over_arm", "", k2_over_arm, 1),
        COLUMN("force_spread_N", "force_spread", "N", force_spread, 1),
        COLUMN("angle_spread_rad", "angle_spread", "rad", angle_spread, 1),
        COLUMN("drift_percent", "drift", "%", drift, 100),
    };
    return (result_table){columns, sizeof columns / sizeof *columns, c->points,
                          sizeof *c->points, c->count};
}

json_t *calibration_json(const calibration *c, const char *name, const char *table)
{
    const result_table points = calibration_columns(c);
    return json_of("scenario:t k2_table:t points:o", name, table, result_json(&points));
}

void calibration_csv(FILE *stream, const calibration *c)
{
    const result_table points = calibration_columns(c);
    result_csv(stream, &points);
}
