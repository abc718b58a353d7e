// How often the intervals of identify hold the true values, with its default options:
// recordings of four set-ups that a scenario describes, of one whose command is not the
// one that is recorded, and of two benches by programs of their own, whose amplifier
// lags, whose sensors show 0.2 % too much and whose hub has play.
//
//     test_fit_coverage RECORDINGS [SETUP [FIRST]]
//
// FIRST is the number of the first recording, from 0, so that a study can go on.
#include "src/study/identify/identify.h"

#include "tests/bench_sensors.h"
#include "tests/rig_fixture.h"

#define SPREAD     0.15 // share by which true values are drawn about the scenario's

#define UNRECORDED 0.05 // standard deviation of a command that is not recorded [V]

enum { FITTED = 3, BENCH_SAMPLES = 300, BENCH_RATE = 200 };

static int recordings = 2, first = 0;
static const char *only;

typedef enum recorder { BY_LAB, BY_LAB_PUSHED, BY_FORMULA, BY_MUJOCO } recorder;

typedef struct set_up {
    const char *name;
    recorder recorder;
    bool reverses;        // the command, three times
    const char *settings; // of the scenario
    const char *fits[FITTED];
} set_up;

#define BENCH                                                                            \
    "control.law=open-loop control.approach_voltage=1 control.rate=200 "                 \
    "wall.kind=plane wall.contact=kelvin-voigt wall.stiffness=2000 wall.damping=20"

static const set_up set_ups[] = {
    {"free",
     BY_LAB,
     true,
     "control.law=open-loop control.approach_voltage=3 control.rate=500 "
     "initial.angle=-1.5 wall.kind=none",
     {"arm.k2", "arm.hub_inertia", "motor.stiction"}},
    {"rigid",
     BY_LAB,
     false,
     "control.law=open-loop control.approach_voltage=1 control.rate=200",
     {"arm.k2", "arm.hub_inertia", "motor.stiction"}},
    {"giving",
     BY_LAB,
     false,
     "control.law=open-loop control.approach_voltage=1 control.rate=200 arm.links=3 "
     "arm.tip_mass=0.01 wall.contact=kelvin-voigt wall.stiffness=20000 wall.damping=5",
     {"arm.k2", "arm.tip_mass", "motor.stiction"}},
    {"closed",
     BY_LAB,
     false,
     "control.law=hybrid control.force=1 control.approach_voltage=2 control.rate=500 "
     "initial.angle=-0.3",
     {"arm.k2", "motor.torque_constant", "motor.stiction"}},
    {"pushed",
     BY_LAB_PUSHED,
     false,
     BENCH,
     {"arm.k2", "arm.hub_inertia", "motor.stiction"}},
    // as many links as the bench has: k2 of fewer would be that of a stiffer root
    {"formula",
     BY_FORMULA,
     true,
     BENCH " arm.links=8",
     {"arm.k2", "arm.hub_inertia", "motor.stiction"}},
    {"mujoco",
     BY_MUJOCO,
     true,
     BENCH " arm.links=32 arm.damping_ratio=1e-4",
     {"arm.k2", "arm.hub_inertia", "motor.stiction"}},
};

enum { SET_UPS = sizeof set_ups / sizeof *set_ups };

// --- recordings ------------------------------------------------------------------------

static FILE *open_recording(char file[64])
{
    snprintf(file, 64, "/tmp/test_fit_coverage.XXXXXX");
    FILE *stream = fdopen(mkstemp(file), "w");
    assert_non_null(stream);
    fputs("time[s],command[V],encoder[rad],tachometer[rad/s],force_reading[N]\n", stream);
    return stream;
}

// What the lab's rig reads at each sample of a run, with the command of the run, or with
// command[] where that is not NULL.
static void record_by_lab(const scenario *s, const double *command, char file[64])
{
    FILE *stream = open_recording(file);
    KEPT_RUN(run) = run_done(s, true);
    const double rate = s->parameters.control.rate;
    for (int k = 0; k < (int)(s->parameters.run.duration * rate); k++) {
        // the row in the middle of the period shows what the sample at its beginning read
        const sample *row = &run.trace.rows[trace_row_at(&run.trace, (k + 0.6) / rate)];
        const double volts = command != NULL ? command[k] : row->command;
        fprintf(stream, "%.17g,%.17g,%.17g,%.17g,%.17g\n", k / rate, volts, row->encoder,
                row->tachometer, row->force_reading);
    }
    assert_int_equal(fclose(stream), 0);
}

// A command that goes to and fro.
static void go_to_and_fro(double command[BENCH_SAMPLES])
{
    for (int k = 0; k < BENCH_SAMPLES; k++) {
        command[k] = k / 80 % 2 == 0 ? 1 : -1;
    }
}

// What the rig reads under a command that differs from the recorded one: by random volts,
// others every 10 ms.
static void record_pushed(scenario *s, random_generator *random, char file[64])
{
    static double command[BENCH_SAMPLES];
    char played[64] = "/tmp/test_fit_coverage.XXXXXX";
    FILE *stream = fdopen(mkstemp(played), "w");
    assert_non_null(stream);
    go_to_and_fro(command);
    fputs("time[s],command[V]\n", stream);
    double more = 0;
    for (int k = 0; k < BENCH_SAMPLES; k++) {
        if (k % 2 == 0) {
            more = UNRECORDED * random_about_normal(random);
        }
        fprintf(stream, "%.17g,%.17g\n", (double)k / BENCH_RATE, command[k] + more);
    }
    assert_int_equal(fclose(stream), 0);

    parameters p = s->parameters;
    DONE(parameter_set_text(&p, parameter_find("control.law"), "playback", &f));
    DONE(parameter_set_text(&p, parameter_find("control.playback_file"), played, &f));
    DONE(parameter_set_number(&p, parameter_find("run.duration"),
                              (double)BENCH_SAMPLES / BENCH_RATE, &f));
    DONE(scenario_take_parameters(s, &p, &f));
    record_by_lab(s, command, file);
    unlink(played);
}

// The bench of a scenario's parameters, with what no scenario holds.
static bench_arm bench_of(const parameters *p, int links)
{
    const motor_parameters *m = &p->motor;
    return (bench_arm){.links = links,
                       .length = p->arm.length,
                       .mass = p->arm.mass,
                       .rotor_inertia = p->arm.hub_inertia,
                       .joint_stiffness = p->arm.k2 * links / 2,
                       .torque_per_volt =
                           m->amplifier_gain * m->torque_constant / m->resistance,
                       .damping = m->viscous_friction +
                                  m->torque_constant * m->back_emf / m->resistance,
                       .stiction = m->stiction,
                       .wall_stiffness = 2000,
                       .wall_damping = 20,
                       .start = -0.1,
                       .amplifier_lag = 2e-3,
                       .play = 1e-3,
                       .coupling = 3000, // its compliance is 1 % of the beam's
                       .force_lag = 1.5e-3 / log(9)};
}

// Recorded commands.
static double play(void *commands, int k, const bench_sample *to)
{
    (void)to;
    return ((const double *)commands)[k];
}

// What the sensors of a bench read.
static void record_bench(const set_up *u, const parameters *p, random_generator *random,
                         char file[64])
{
    static double command[BENCH_SAMPLES];
    static bench_sample read[BENCH_SAMPLES];
    go_to_and_fro(command);
    if (u->recorder == BY_FORMULA) {
        const bench_arm a = bench_of(p, 8);
        bench_arm_run(&a, command, BENCH_SAMPLES, BENCH_RATE, read);
    } else {
        const bench_arm a = bench_of(p, 32);
        assert_true(
            bench_arm_run_mujoco(&a, play, command, BENCH_SAMPLES, BENCH_RATE, read));
    }

    FILE *stream = open_recording(file);
    for (int k = 0; k < BENCH_SAMPLES; k++) {
        const bench_reading shown = bench_read(&read[k], random);
        fprintf(stream, "%.17g,%g,%.17g,%.17g,%.17g\n", (double)k / BENCH_RATE,
                command[k], shown.angle, shown.velocity, shown.force);
    }
    assert_int_equal(fclose(stream), 0);
}

// --- fits ------------------------------------------------------------------------------

// What came of a set-up's recordings.
typedef struct outcome {
    int covered[FITTED],
        none[FITTED];     // intervals that hold the truth; that are not there
    double error[FITTED]; // largest, as a share of the truth
    // sums of the errors over those that are stated, and of the squares of that
    double sum[FITTED], squares[FITTED];
    double least_command, most_command; // that nobody recorded, as it was estimated [V]
    int found, explained;
} outcome;

static void fit_recording(const set_up *u, int number, outcome *o)
{
    static action reversals[3];
    char file[64];
    random_generator random;
    random_seed(&random, (uint64_t)number + 1);
    scenario base = {.name = (char *)u->name, .actions = reversals};
    base.parameters = rig_parameters_with("%s control.seed=%d", u->settings, number + 1);
    for (int i = 0; i < 3 && u->reverses && u->recorder == BY_LAB; i++) {
        reversals[i] =
            SETS(0.25 + 0.4 * i, control.approach_voltage, i % 2 == 0 ? -3.0 : 3.0);
        base.action_count = 3;
    }

    // the true values
    scenario other = base;
    double truth[FITTED];
    for (int i = 0; i < FITTED; i++) {
        const int index = parameter_find(u->fits[i]);
        truth[i] = parameter_get(&base.parameters, index) *
                   (1 + SPREAD * (2 * random_uniform(&random) - 1));
        DONE(parameter_set_number(&other.parameters, index, truth[i], &f));
    }
    parameters p = other.parameters;
    DONE(scenario_take_parameters(&other, &p, &f));
    if (u->recorder == BY_LAB) {
        record_by_lab(&other, NULL, file);
    } else if (u->recorder == BY_LAB_PUSHED) {
        record_pushed(&other, &random, file);
    } else {
        record_bench(u, &other.parameters, &random, file);
    }

    SCOPED(identify_finish)
    identification id = {.base = &base, .jobs = 2, .starts = IDENTIFY_STARTS};
    for (int i = 0; i < FITTED; i++) {
        DONE(identify_add_path(&id, u->fits[i], &f));
    }
    DONE(identify_add_trace(&id, file, NULL, 0, &f));
    unlink(file);
    DONE(identify_fit(&id, &f));
    o->found += identify_settled(&id) && id.undetermined == 0;
    o->explained += identify_explained(&id);
    o->least_command = fmin(o->least_command, id.lack.command);
    o->most_command = fmax(o->most_command, id.lack.command);
    for (int i = 0; i < FITTED; i++) {
        const fitted_parameter *fit = &id.fit[i];
        o->covered[i] += fit->low <= truth[i] && truth[i] <= fit->high;
        o->none[i] += isnan(fit->low);
        o->error[i] = fmax(o->error[i], fabs(fit->value / truth[i] - 1));
        const double off = (fit->value - truth[i]) / fit->standard_error;
        if (!isnan(off)) {
            o->sum[i] += off;
            o->squares[i] += off * off;
        }
    }
}

static void study(const set_up *u)
{
    outcome o = {.least_command = HUGE_VAL, .most_command = 0};
    if (only != NULL && strcmp(only, u->name) != 0) {
        return;
    }
    for (int k = first; k < first + recordings; k++) {
        fit_recording(u, k, &o);
    }
    print_message("%s: found %d, explained %d of %d\n", u->name, o.found, o.explained,
                  recordings);
    for (int i = 0; i < FITTED; i++) {
        print_message("    %-24s covered %d of %d, none for %d; off by %.2f of the "
                      "stated errors, %+.2f in the mean; at most by %.2g %%\n",
                      u->fits[i], o.covered[i], recordings, o.none[i],
                      sqrt(o.squares[i] / recordings), o.sum[i] / recordings,
                      100 * o.error[i]);
    }

    // by four standard deviations of a binomial number, with many recordings as asked for
    const double spread = 4 * sqrt(0.95 * 0.05 * recordings);
    const double least = fmax(0.9 * recordings, 0.95 * recordings - spread);
    const bool by_lab = u->recorder == BY_LAB || u->recorder == BY_LAB_PUSHED;
    for (int i = 0; i < FITTED && by_lab; i++) {
        assert_true(o.covered[i] >= fmin(least, 0.95 * recordings - 1));
        assert_true(recordings < 200 || o.covered[i] <= 0.99 * recordings);
    }
    if (u->recorder == BY_LAB_PUSHED) {
        print_message("    a command that nobody recorded: %.3g to %.3g V, in truth %g\n",
                      o.least_command, o.most_command, UNRECORDED);
        assert_true(o.least_command > UNRECORDED / 2 && o.most_command < 2 * UNRECORDED);
        assert_true(o.explained == 0);
    } else if (u->recorder != BY_LAB) {
        // nine in ten of two hundred; of fewer, two standard deviations less
        double held = 0.9 * recordings;
        if (recordings < 200) {
            held -= 2 * sqrt(0.9 * 0.1 * recordings);
        }
        for (int i = 0; i < FITTED; i++) {
            assert_true(o.covered[i] >= held);
        }
        assert_true(o.explained <= 0.1 * recordings);
        check_below(o.error[0], 0.03);
    }
}

TEST(intervals_hold_the_truth_where_the_scenario_is_right)
{
    for (int i = 0; i < SET_UPS; i++) {
        if (set_ups[i].recorder == BY_LAB) {
            study(&set_ups[i]);
        }
    }
}

TEST(a_command_that_nobody_recorded_is_told_by_its_size)
{
    for (int i = 0; i < SET_UPS; i++) {
        if (set_ups[i].recorder == BY_LAB_PUSHED) {
            study(&set_ups[i]);
        }
    }
}

TEST(what_a_bench_has_more_is_named)
{
    for (int i = 0; i < SET_UPS; i++) {
        const bool has = set_ups[i].recorder != BY_MUJOCO || bench_has_mujoco();
        const bool is_bench =
            set_ups[i].recorder == BY_FORMULA || set_ups[i].recorder == BY_MUJOCO;
        if (is_bench && has) {
            study(&set_ups[i]);
        }
    }
}

int main(int argc, char **argv)
{
    fault f;
    recordings = argc > 1 ? atoi(argv[1]) : recordings;
    only = argc > 2 ? argv[2] : NULL;
    first = argc > 3 ? atoi(argv[3]) : 0;
    if (identify_available(&f) != STATUS_OK) {
        return 77;
    }
    return run_cases(NULL, NULL);
}
