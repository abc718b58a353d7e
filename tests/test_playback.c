// control.law = playback: a recorded command is the input of another run.

#include "src/run/export.h"
#include "tests/rig_fixture.h"

static const char *const recorded_csv = "recorded.csv";

// Runs settings and keeps the trace as the lab's own CSV.
static summary record(const char *const *settings)
{
    KEPT_RUN(r) = rig_run(settings, true);
    const scenario s = {.parameters = rig_parameters(settings)};
    SCOPED(free_kept) WRITTEN(text, export_csv(stream, &s, &r.trace));
    put_file(recorded_csv, text);
    return r.summary;
}

// What a run plays back is the run, to the last bit, where its samples are those that
// were recorded. Under a delay the voltage is the command of a delay earlier.
TEST(a_run_plays_back_its_own_csv)
{
    static const struct {
        const char *law, *rate, *delay, *column, *shift;
    } cases[] = {
        {"control.law=open-loop", "control.rate=200", "control.delay=0", "command", "0"},
        {"control.law=hybrid", "control.rate=200", "control.delay=0", "command", "0"},
        {"control.law=hybrid", "control.rate=333", "control.jitter=0.0003", "command",
         "0"},
        {"control.law=observer", "control.rate=1000", "control.delay=0", "voltage[V]",
         "0"},
        {"control.law=hybrid", "control.rate=333", "control.delay=0.0007", "voltage",
         "-0.0007"},
    };
    for (EACH(c, cases)) {
        const summary was = record(given("%s %s %s", c->law, c->rate, c->delay));
        const summary is = rig_summary_with(
            "control.law=playback control.playback_file=recorded.csv %s %s %s %s",
            formatted("control.playback_column=%s", c->column),
            formatted("control.playback_shift=%s", c->shift), c->rate, c->delay);
        assert_true(was.peak_force_N > 0);
        check_close(is.first_contact_s, was.first_contact_s, 0);
        check_close(is.peak_force_N, was.peak_force_N, 0);
        check_close(is.steady_force_N, was.steady_force_N, 0);
        check_close(is.motor_work_J, was.motor_work_J, 0);
    }
}

// What goes out at an instant: between rows, beyond them, and shifted.
TEST(a_command_is_held_or_goes_straight)
{
    static const struct {
        const char *hold, *shift;
        double time, volts;
    } cases[] = {
        {"hold", "0", 0.15, 1},       {"linear", "0", 0.15, 1.5},
        {"hold", "0", 0.2, 2},        {"hold", "0", 0.05, 1},
        {"linear", "0", 0.05, 1},     {"hold", "0", 0.4, 3},
        {"linear", "0", 0.4, 3},      {"hold", "0.1", 0.25, 1},
        {"linear", "0.1", 0.25, 1.5}, {"linear", "-0.1", 0.1, 2},
    };
    put_file("u.csv", "\"t[ms]\",u[mV]\n100,1000\n200,2000\n300,3000\n");
    for (EACH(c, cases)) {
        RIG_RUN(r,
                "control.law=playback control.playback_file=u.csv "
                "control.playback_column=u %s %s control.rate=1000 sensor.ideal=true "
                "run.duration=0.45 wall.kind=none",
                formatted("control.playback_hold=%s", c->hold),
                formatted("control.playback_shift=%s", c->shift));
        const size_t row = trace_rows_until(&r.trace, c->time) - 1;
        check_close(r.trace.rows[row].voltage, c->volts, 1e-9);
    }
}

// A recorder's clock is another one than the rig's: its stamps are a little off, fast or
// slow, rounded, by the time of day. The rows are the samples all the same: the run is
// that of the stamps without errors, to the last bit.
TEST(the_rows_of_a_recording_are_the_samples)
{
    static const struct {
        const char *heading;
        double unit, scatter, fast, begin;
        int decimals, rows; // a row in so many is left out where the command stays
    } cases[] = {
        {"time[s]", 1, 0, 0, 0, 9, 0},
        {"time[s]", 1, 5e-6, 0, 0, 9, 0},
        {"time[s]", 1, 0, 20e-6, 0, 9, 0},
        {"time[s]", 1, 0, -9e-4, 0, 9, 0},
        {"time[s]", 1, 6e-4, 0, 0, 9, 0},
        {"time[s]", 1, 0, 0, 0, 3, 0},
        {"time[s]", 1, 0, 1e-4, 1764e6, 6, 0},
        {"time[ms]", 1e3, 1e-5, 0, 3600, 3, 0},
        {"time[ns]", 1e9, 1e-6, 0, 1764e6, 0, 0},
        {"sample", 500, 0, 0, 0, 0, 0},
        {"time[s]", 1, 1e-5, 2e-5, 0, 9, 7},
    };
    double first_touch = 0, peak = 0;
    for (EACH(c, cases)) {
        random_generator random;
        char text[40000];
        snprintf(text, sizeof text, "%s,command[V]\n", c->heading);
        random_seed(&random, 5);
        double before = 0;
        for (int n = 0; n < 700; n++) {
            // 1.5 V, and every 40 samples a sample of another command
            const double volts = n % 40 == 39 ? 0.5 + 0.01 * (n / 40) : 1.5;
            const double off = c->scatter * (2 * random_uniform(&random) - 1);
            const double time = c->begin + n / 500.0 * (1 + c->fast) + off;
            if (c->rows == 0 || n % c->rows != 3 || volts != before) {
                const size_t used = strlen(text);
                snprintf(text + used, sizeof text - used, "%.*f,%.4g\n", c->decimals,
                         c->unit * time, volts);
            }
            before = volts;
        }
        put_file("stamps.csv", text);
        const summary is = rig_summary_with(
            "control.law=playback control.playback_file=stamps.csv control.rate=500 "
            "run.duration=1.39");
        assert_true(is.peak_force_N > 0);
        if (c == cases) {
            first_touch = is.first_contact_s;
            peak = is.peak_force_N;
        }
        check_close(is.first_contact_s, first_touch, 0);
        check_close(is.peak_force_N, peak, 0);
        const bool foreign = c->begin > 0;
        assert_true((strstr(is.message, "its clock begins at") != NULL) == foreign);
    }
}

TEST(a_file_with_faults_is_told_with_its_place)
{
    static const struct {
        const char *text, *sentence;
    } cases[] = {
        {"t[s],command[V]\n0,1\n0.1,inf\n", "bad.csv:3:2: 'inf'"},
        {"t[s],command[V]\n0,nan\n0.1,\n", "bad.csv:2:2: 'nan'"},
        {"t[s],command[V]\n0.2,1\n0.1,2\n", "bad.csv:3:1: the time"},
        {"t[s],u[V]\n0,1\n", "there is no column 'command'"},
        {"x,command[V]\n0,1\n", "there is no column 'time'"},
        {"t[s],command[furlong]\n0,1\n", "bad.csv:1:2: the unit [furlong]"},
        {"t,command\n0,1\n2,1\n4,1\n6,1\n8,1\n10,1\n12,1\n14,1\n16,1\n18,1\n",
         "bad.csv:3:1: by their times the rows come every 2 s"},
        {"t[s],command[V]\n", "0 rows"},
        {"t[s],command[V]\n0\n", "bad.csv:2"},
        {"", "bad.csv"},
    };
    for (EACH(c, cases)) {
        put_file("bad.csv", c->text);
        check_refused(given("control.law=playback control.playback_file=bad.csv"),
                      c->sentence);
    }
    unlink("bad.csv");
    check_refused(given("control.law=playback control.playback_file=bad.csv"),
                  "cannot be opened");

    // without a file there is nothing to play
    parameters p = rig_parameters(NULL);
    fault f = {0};
    p.control.law = LAW_PLAYBACK;
    p.set[PARAMETER_INDEX(control.law)] = 1;
    assert_int_equal(parameters_resolve(&p, &f), STATUS_BAD_SCENARIO);
    assert_string_equal(
        f.text, "control.law = playback needs a CSV file in control.playback_file");
}

ALL_BETWEEN(enter_folder, leave_folder)
