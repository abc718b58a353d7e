// identify against recordings whose parameters are known: coverage of its intervals and
// the bound of Cramer and Rao, which is computed here by differences of loops that are
// stepped; what it refuses, what it finds undetermined or unexplained.
//
//   test_identify SEEDS
#include "src/study/identify/identify.h"

#include "src/base/dense.h"
#include "src/rig/sensors.h"
#include "tests/rig_fixture.h"

enum { SAMPLES = 1501, READINGS = 3, FITTED = 5, OWN = 3, RECORDINGS = 3 };
enum { UNKNOWNS = FITTED + RECORDINGS * OWN }; // of all recordings together
#define PERIOD 1e-3

static int seeds = 2;

static const char *const paths[FITTED] = {"arm.k2", "arm.hub_inertia", "motor.stiction",
                                          "motor.torque_constant",
                                          "motor.viscous_friction"};
static const double truth[FITTED] = {5.3, 0.0058, 0.052, 2.3, 0.007};

// A recording: how it is made, and what came of it.
typedef struct recording_made {
    const char *law;
    double angle, voltage;
    bool reverses, no_wall;
    char file[64];
    double command[SAMPLES];
} recording_made;

// The rig of all recordings, at its start.
static scenario rig_scenario(const recording_made *r, const double *values, int seed)
{
    static action reversals[3];
    const char *known = "";
    for (int i = 0; i < FITTED && values != NULL; i++) {
        known = formatted("%s %s=%.17g", known, paths[i], values[i]);
    }
    scenario s = {.name = (char *)"rig", .actions = reversals};
    s.parameters = rig_parameters_with(
        "control.law=%s control.rate=1000 method.step=0.0005 initial.angle=%g "
        "control.force=1 control.approach_voltage=%g control.seed=%d wall.kind=%s%s",
        r->law, r->angle, r->voltage, seed, r->no_wall ? "none" : "point", known);
    for (int i = 0; i < 3 && r->reverses; i++) {
        reversals[i] = SETS(0.25 + 0.4 * i, control.approach_voltage,
                            i % 2 == 0 ? -r->voltage : r->voltage);
        s.action_count = 3;
    }
    return s;
}

// Runs a recording with the true values and further settings, up to a NULL, and writes
// what its sensors read.
static void record_with(recording_made *r, const double *values, int seed,
                        char *const *settings)
{
    scenario s = rig_scenario(r, values, seed);
    for (; *settings != NULL; settings++) {
        DONE(scenario_override(&s, *settings, &f));
    }
    KEPT_RUN(run) = run_done(&s, true);
    snprintf(r->file, sizeof r->file, "/tmp/test_identify.XXXXXX");
    FILE *file = fdopen(mkstemp(r->file), "w");
    assert_non_null(file);
    fputs("time[ms],command[V],encoder[rad],tachometer[rad/s],force_reading[N]\n", file);
    for (int k = 0; k < SAMPLES - 1; k++) {
        // the row in the middle of the period shows what the sample at its beginning read
        const sample *row = &run.trace.rows[trace_row_at(&run.trace, (k + 0.6) * PERIOD)];
        r->command[k] = row->command;
        fprintf(file, "%d,%.17g,%.17g,%.17g,%.17g\n", k, row->command, row->encoder,
                row->tachometer, row->force_reading);
    }
    assert_int_equal(fclose(file), 0);
}

// The same of an arm of so many links.
static void record(recording_made *r, const double *values, int seed, int links)
{
    char *settings[] = {formatted("arm.links=%d", links), NULL};
    record_with(r, values, seed, settings);
}

static void set_up(identification *id, const scenario *base, recording_made *made,
                   int count, int fitted)
{
    *id = (identification){.base = base, .jobs = 2, .starts = 1};
    for (int i = 0; i < fitted; i++) {
        DONE(identify_add_path(id, paths[i], &f));
    }
    for (int i = 0; i < count; i++) {
        DONE(identify_add_trace(id, made[i].file, NULL, 0, &f));
    }
}

static void fit(identification *id)
{
    DONE(identify_fit(id, &f));
}

// --- the bound -------------------------------------------------------------------------

// What ideal converters without noise read under the recorded command, and the first
// touch.
static void read_exactly(const recording_made *r, const double *values, double angle,
                         double read[READINGS][SAMPLES], double *touch)
{
    recording_made here = *r;
    here.angle = angle;
    here.reverses = false;
    scenario s = rig_scenario(&here, values, 1);
    s.parameters.sensor.encoder_counts = s.parameters.sensor.adc_bits = 0;
    s.parameters.sensor.tachometer_noise = s.parameters.sensor.fsr_noise = 0;
    const loop_options options = {.commanded = true};
    KEPT_LOOP(loop);
    DONE(loop_create(&loop, &s, &options, &f));
    for (int k = 0; k < SAMPLES - 1; k++) {
        sensor_reading now;
        assert_true(loop_sense(loop, &now));
        read[0][k] = now.encoder;
        read[1][k] = now.tachometer;
        read[2][k] = fsr_volts(&s.parameters.sensor, now.force_reading);
        loop_command(loop, r->command[k]);
        DONE(loop_step(loop, &f));
    }
    const summary sum = loop_summary(loop);
    *touch = sum.first_contact_s;
}

// Derivatives of the readings of one recording, and of its first touch, by each unknown.
typedef struct sensitivity {
    double exact[READINGS][SAMPLES];           // the readings themselves
    double slope[UNKNOWNS][READINGS][SAMPLES]; // their derivatives
    double touch, touch_slope[UNKNOWNS];       // the first touch [s], and its derivatives
} sensitivity;

// Sets the derivatives of recording number r. Its own unknowns come after the parameters:
// a shift of its clock, an offset of its encoder, and the angle of its start. Those by
// the parameters and by the angle are differences of two runs.
static void find_sensitivity(const recording_made *made, int r, int fitted,
                             sensitivity *to)
{
    static double low[READINGS][SAMPLES], high[READINGS][SAMPLES];
    const int shift = fitted + r * OWN, offset = shift + 1, start = shift + 2;
    memset(to, 0, sizeof *to);
    read_exactly(&made[r], truth, made[r].angle, to->exact, &to->touch);
    for (int i = 0; i <= fitted; i++) {
        // the values and the angle on both sides of the true ones
        const bool is_angle = i == fitted;
        const int row = is_angle ? start : i;
        double values[FITTED], angle_step = 1e-5, value_step = 0;
        memcpy(values, truth, sizeof values);
        if (!is_angle) {
            angle_step = 0;
            value_step = 1e-4 * truth[i];
        }
        const int changed = is_angle ? 0 : i;
        double before, after;
        values[changed] = truth[changed] + value_step;
        read_exactly(&made[r], values, made[r].angle + angle_step, high, &after);
        values[changed] = truth[changed] - value_step;
        read_exactly(&made[r], values, made[r].angle - angle_step, low, &before);

        // central differences
        const double span = 2 * (value_step + angle_step);
        to->touch_slope[row] = (after - before) / span;
        for (int c = 0; c < READINGS; c++) {
            for (int k = 0; k < SAMPLES - 1; k++) {
                to->slope[row][c][k] = (high[c][k] - low[c][k]) / span;
            }
        }
    }

    // a later clock shifts all readings; the offset is one of the encoder only
    to->touch_slope[shift] = 1;
    for (int c = 0; c < READINGS; c++) {
        for (int k = 1; k < SAMPLES - 2; k++) {
            to->slope[shift][c][k] =
                -(to->exact[c][k + 1] - to->exact[c][k - 1]) / (2 * PERIOD);
            to->slope[offset][c][k] = c == 0 ? 1 : 0;
        }
    }
}

// Whether the force crosses the threshold of a touch within 10 ms of the sample k.
static bool is_near_touch(const double force[SAMPLES], int k, double threshold)
{
    for (int j = k > 10 ? k - 10 : 1; j <= k + 10 && j < SAMPLES - 1; j++) {
        if ((force[j] > threshold) != (force[j - 1] > threshold)) {
            return true;
        }
    }
    return false;
}

// How many samples around the sample k have the same count of the encoder.
static int samples_of_one_count(const double angle[SAMPLES], int k, double count)
{
    const double wanted = floor(angle[k] / count + 0.5);
    int first = k, last = k;
    while (first > 1 && floor(angle[first - 1] / count + 0.5) == wanted) {
        first--;
    }
    while (last < SAMPLES - 2 && floor(angle[last + 1] / count + 0.5) == wanted) {
        last++;
    }
    return last - first + 1;
}

// Adds to the information matrix what one value says whose derivatives are `slope`:
// slope slope' / variance.
static void add_information(double *information, int n, const double *slope,
                            double variance)
{
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            information[i * n + j] += slope[i] * slope[j] / variance;
        }
    }
}

// The bound of Cramer and Rao: the standard deviations below which no unbiased estimate
// can be, from the inverse of Fisher's information of all readings. Readings within 10 ms
// of a touch or release are left out, and so is the force below the threshold; the first
// touch counts as an instant known to a period. An encoder that stands says its value
// only once.
static void bound(const recording_made *made, int count, int fitted, double *deviations)
{
    static sensitivity s;
    double information[UNKNOWNS * UNKNOWNS] = {0}, inverse[UNKNOWNS * UNKNOWNS] = {0};
    const sensor_parameters sensor = rig_scenario(made, truth, 1).parameters.sensor;
    const int n = fitted + count * OWN;

    // variances of rounding to steps, step^2 / 12, and of noise
    const double adc = 20.0 / 4096, step = 2 * M_PI / sensor.encoder_counts;
    const double variance[READINGS] = {step * step / 12, (1e-4 + adc * adc / 12) / 4,
                                       4e-4 + adc * adc / 12};

    // what all recordings say
    const double threshold = fsr_volts(&sensor, 0.05);
    for (int r = 0; r < count; r++) {
        find_sensitivity(made, r, fitted, &s);
        for (int k = 1; k < SAMPLES - 2; k++) {
            if (is_near_touch(s.exact[2], k, threshold)) {
                continue;
            }
            const int standing = samples_of_one_count(s.exact[0], k, step);
            for (int c = 0; c < READINGS; c++) {
                if (c == 2 && s.exact[2][k] <= threshold) {
                    continue;
                }
                double slope[UNKNOWNS];
                for (int i = 0; i < n; i++) {
                    slope[i] = s.slope[i][c][k];
                }
                const int repeated = c == 0 ? standing : 1;
                add_information(information, n, slope, variance[c] * repeated);
            }
        }
        if (isfinite(s.touch)) {
            add_information(information, n, s.touch_slope, PERIOD * PERIOD / 12);
        }
    }

    // an offset of which nothing is known in free flight leaves the matrix regular
    for (int i = fitted; i < n; i++) {
        information[i * n + i] *= 1 + 1e-9;
    }

    // the roots of the diagonal of its inverse
    for (int i = 0; i < n; i++) {
        inverse[i * n + i] = 1;
    }
    assert_true(dense_solve_columns(n, n, information, inverse));
    for (int i = 0; i < fitted; i++) {
        deviations[i] = sqrt(inverse[i * n + i]);
    }
}

// Fits recordings with many seeds of noise: the intervals hold the true values as often
// as they promise, and with `bounded` the errors are not far above the bound.
static void study(const recording_made *from, int fitted, bool bounded)
{
    enum { count = RECORDINGS };
    recording_made made[count];
    memcpy(made, from, sizeof made);
    double(*errors)[FITTED] = calloc((size_t)seeds, sizeof *errors), least[FITTED];
    double squares[FITTED] = {
        0}; // of what estimates are off, in their own standard errors
    SCOPED(free_kept) double *sorted = calloc((size_t)seeds, sizeof *sorted);
    int covered[FITTED] = {0}, white = 0;
    double values[FITTED];
    assert_true(errors != NULL && sorted != NULL);
    memcpy(values, truth, sizeof values);
    for (int seed = 0; seed < seeds; seed++) {
        // not fitted means known
        const scenario base = rig_scenario(&made[1], NULL, 1);
        values[4] = fitted > 4 ? truth[4] : base.parameters.motor.viscous_friction;
        for (int r = 0; r < count; r++) {
            record(&made[r], values, 1 + 10 * seed + r, 2);
        }
        identification id;
        set_up(&id, &base, made, count, fitted);
        fit(&id);
        for (int i = 0; i < fitted; i++) {
            assert_true(id.fit[i].determined);
            covered[i] += id.fit[i].low <= values[i] && values[i] <= id.fit[i].high;
            errors[seed][i] = id.fit[i].standard_error;
            const double off = (id.fit[i].value - values[i]) / id.fit[i].standard_error;
            squares[i] += off * off;
        }
        white += id.white;
        identify_finish(&id);
        for (int r = 0; r < count; r++) {
            unlink(made[r].file);
        }
    }

    bound(made, count, fitted, least);
    for (int i = 0; i < fitted; i++) {
        for (int s = 0; s < seeds; s++) {
            sorted[s] = errors[s][i];
        }
        qsort(sorted, (size_t)seeds, sizeof *sorted, by_size);
        const double median = sorted[seeds / 2];
        print_message("%-24s covered %d of %d, off %.2f, error %.3g of %.4g, bound %.3g, "
                      "ratio %.3g\n",
                      paths[i], covered[i], seeds, sqrt(squares[i] / seeds), median,
                      values[i], least[i], median / least[i]);
        // four standard deviations of a binomial number below 95 %, or 90 % of many
        const double spread = 4 * sqrt(0.95 * 0.05 * seeds);
        assert_true(covered[i] >= (seeds >= 200 ? 0.9 * seeds : 0.95 * seeds - spread));
        assert_true(seeds < 200 || covered[i] <= 0.99 * seeds);
        if (bounded) {
            check_below(median, 1.5 * least[i]);
        }
    }
    print_message("white in %d of %d\n", white, seeds);
    free(errors);
}

static const recording_made three[RECORDINGS] = {
    {.law = "open-loop", .angle = -1.5, .voltage = 3, .reverses = true},
    {.law = "open-loop", .angle = -0.3, .voltage = 1},
    {.law = "open-loop", .angle = -0.3, .voltage = 3},
};

TEST(intervals_cover_and_errors_are_near_the_bound)
{
    study(three, 4, true);
}

TEST(so_they_do_with_viscous_friction)
{
    study(three, 5, false);
}

TEST(so_they_do_in_a_closed_loop)
{
    recording_made made[RECORDINGS];
    memcpy(made, three, sizeof made);
    made[1].law = made[2].law = "hybrid";
    made[2].voltage = 2;
    study(made, 4, true);
}

// --- the search ------------------------------------------------------------------------

// Writes what the sensors of the shipped scenario read when it runs with changes.
static void record_shipped(char file[64], const char *changes)
{
    KEPT_SCENARIO(s) = shipped_with("compare/open-loop", changes);
    KEPT_RUN(run) = run_done(&s, true);
    snprintf(file, 64, "/tmp/test_identify.XXXXXX");
    FILE *stream = fdopen(mkstemp(file), "w");
    assert_non_null(stream);
    fputs("time[s],command[V],encoder[rad],tachometer[rad/s],force_reading[N]\n", stream);
    for (int k = 0; k < 300; k++) {
        const sample *row = &run.trace.rows[trace_row_at(&run.trace, (k + 0.6) / 200)];
        fprintf(stream, "%.17g,%.17g,%.17g,%.17g,%.17g\n", k / 200.0, row->command,
                row->encoder, row->tachometer, row->force_reading);
    }
    assert_int_equal(fclose(stream), 0);
}

// Fits what record_shipped wrote by searches of different seeds: each finds the true
// values within five of their errors, and none needs more than `most` runs.
static void search_often(const char *file, const scenario *base, const char *const *fits,
                         const double *values, int count, int searches, int most)
{
    for (int seed = 0; seed < searches; seed++) {
        SCOPED(identify_finish)
        identification id = {.base = base,
                             .jobs = 2,
                             .starts = IDENTIFY_STARTS,
                             .seed = (unsigned long)seed};
        for (int i = 0; i < count; i++) {
            DONE(identify_add_path(&id, fits[i], &f));
        }
        DONE(identify_add_trace(&id, file, NULL, 0, &f));
        fit(&id);
        assert_true(identify_settled(&id));
        assert_in_range(id.runs, 1, most);
        for (int i = 0; i < count; i++) {
            check_close(id.fit[i].value, values[i], 5 * id.fit[i].standard_error);
        }
    }
}

TEST(false_minima_are_left)
{
    static const char *const fits[] = {"arm.k2=2:10", "motor.stiction=0.01:0.12",
                                       "arm.hub_inertia=0.002:0.02"};
    static const double values[] = {5.63, 0.0612, 0.0071};
    char file[64];
    KEPT_SCENARIO(base) = shipped("compare/open-loop");
    record_shipped(file, "arm.k2=5.63 motor.stiction=0.0612 arm.hub_inertia=0.0071 "
                         "control.seed=777");
    search_often(file, &base, fits, values, 3, 2 * seeds, 2000);
    unlink(file);
}

// An arm of three links that bounces ten times on a stiff wall which gives: errors of one
// touch grow to the next one.
TEST(many_touches_are_told_one_by_one)
{
    static const char wall[] = "arm.links=3 wall.contact=kelvin-voigt "
                               "wall.stiffness=20000 wall.damping=5";
    static const char *const fits[] = {"arm.k2", "arm.tip_mass", "motor.stiction"};
    static const double values[] = {4.51, 0.00876, 0.0416};
    char file[64];
    KEPT_SCENARIO(base) =
        shipped_with("compare/open-loop", formatted("%s arm.tip_mass=0.01", wall));
    record_shipped(file, formatted("%s arm.k2=4.51 arm.tip_mass=0.00876 "
                                   "motor.stiction=0.0416 control.seed=11",
                                   wall));
    search_often(file, &base, fits, values, 3, seeds, 5000);
    unlink(file);
}

// A force that falls below the threshold of a touch and rises again, pressing all the
// time.
TEST(a_light_press_is_no_touch)
{
    static const char *const fits[] = {"arm.k2=2:10", "motor.stiction=0.01:0.12",
                                       "arm.hub_inertia=0.002:0.02"};
    static const double values[] = {3.174, 0.0572, 0.0143};
    char file[64];
    KEPT_SCENARIO(base) = shipped("compare/open-loop");
    record_shipped(file, "arm.k2=3.174 motor.stiction=0.0572 arm.hub_inertia=0.0143 "
                         "control.seed=3");
    search_often(file, &base, fits, values, 3, 2 * seeds, 2000);
    unlink(file);
}

// --- other sensors ---------------------------------------------------------------------

// Either sensor of the beam's shape, alone and slower than the rig, tells the stiffness.
TEST(the_beams_shape_alone_tells_its_stiffness)
{
    const char *const channels[] = {"tip_deflection", "root_strain"};
    for (int i = 0; i < 2; i++) {
        char file[] = "/tmp/test_identify.XXXXXX";
        const char *fitted = formatted("sensor.%s=true sensor.%s_rate=100 wall.kind=none",
                                       channels[i], channels[i]);
        KEPT_SCENARIO(base) = shipped_with("compare/open-loop", fitted);
        KEPT_SCENARIO(s) =
            shipped_with("compare/open-loop", formatted("%s arm.k2=5.5", fitted));
        KEPT_RUN(run) = run_done(&s, true);
        FILE *stream = fdopen(mkstemp(file), "w");
        assert_non_null(stream);
        fprintf(stream, "time[s],command[V],%s\n", channels[i]);
        for (int k = 0; k < 300; k++) {
            const sample *row =
                &run.trace.rows[trace_row_at(&run.trace, (k + 0.6) / 200)];
            fprintf(stream, "%.17g,%.17g,%.17g\n", k / 200.0, row->command,
                    i == 0 ? row->tip_deflection : row->root_strain);
        }
        assert_int_equal(fclose(stream), 0);

        SCOPED(identify_finish)
        identification id = {.base = &base, .jobs = 2, .starts = IDENTIFY_STARTS};
        DONE(identify_add_path(&id, "arm.k2", &f));
        DONE(identify_add_trace(&id, file, NULL, 0, &f));
        fit(&id);
        assert_true(id.fit[0].determined && identify_settled(&id));
        check_close(id.fit[0].value, 5.5, 4 * id.fit[0].standard_error);
        check_below(id.fit[0].standard_error, 0.1);
        unlink(file);
    }
}

// --- what the data do not say ----------------------------------------------------------

TEST(one_combination_is_named)
{
    recording_made made = {.law = "open-loop",
                           .angle = -2.9,
                           .voltage = 3,
                           .no_wall = true};
    char words[512];
    const scenario base = rig_scenario(&made, NULL, 1);
    record(&made, truth, 1, 2);
    SCOPED(identify_finish) identification id = {.base = &base, .jobs = 1, .starts = 1};
    for (int i = 2; i < 5; i++) {
        DONE(identify_add_path(&id, paths[i], &f));
    }
    DONE(identify_add_trace(&id, made.file, NULL, 0, &f));
    fit(&id);
    assert_int_equal(id.undetermined, 1);
    identify_words(&id, 0, words, sizeof words);
    for (int i = 0; i < 3; i++) {
        assert_false(id.fit[i].determined);
        assert_non_null(strstr(words, paths[i + 2]));
    }

    // nothing of it is written
    parameters p;
    DONE(identify_parameters(&id, true, &p, &f));
    check_close(p.motor.torque_constant, base.parameters.motor.torque_constant, 0);
    unlink(made.file);
}

TEST(two_links_leave_eight_unexplained)
{
    int rejected = 0;
    recording_made made[RECORDINGS];
    memcpy(made, three, sizeof made);
    const scenario base = rig_scenario(&made[1], NULL, 1);
    for (int seed = 1; seed <= seeds; seed++) {
        record(&made[0], truth, seed, 8);
        SCOPED(identify_finish) identification id;
        set_up(&id, &base, made, 1, 4);
        fit(&id);
        rejected += !id.white;
        unlink(made[0].file);
    }
    print_message("whiteness rejected in %d of %d\n", rejected, seeds);
    assert_true(rejected >= 0.95 * seeds);
}

// A fit with a rigid hub takes one that gives for another arm: its errors are of that
// too, unless the joints' damping is fitted, which one joint more would number anew.
TEST(a_hub_that_gives_is_allowed_for)
{
    static char *const sprung[] = {"arm.hub_joint=spring", "arm.k1=500",
                                   "arm.joint_damping=0.3,0.003", NULL};
    recording_made made = {.law = "open-loop",
                           .angle = -1.5,
                           .voltage = 3,
                           .reverses = true,
                           .no_wall = true};
    record_with(&made, truth, 1, sprung);
    for (int damping = 0; damping <= 1; damping++) {
        scenario base = rig_scenario(&made, NULL, 1);
        const char *damped =
            damping ? "arm.joint_damping=0.003" : "arm.damping_ratio=1e-4";
        DONE(scenario_override(&base, damped, &f));
        SCOPED(identify_finish) identification id;
        set_up(&id, &base, &made, 1, 3);
        if (damping) {
            DONE(identify_add_path(&id, "arm.joint_damping[1]", &f));
        }
        fit(&id);
        const fitted_parameter *k2 = &id.fit[0];
        assert_false(identify_explained(&id));
        assert_true(id.lack.command > 0);
        assert_true(isnan(id.lack.hub_spring) == damping);
        if (!damping) {
            // the true one is among those that are allowed
            const double with_spring = id.lack.with_spring[0];
            check_below(id.lack.hub_spring, 500);
            assert_true(k2->low < with_spring && with_spring < k2->high);
            assert_true(k2->low < truth[0] && truth[0] < k2->high);
            assert_true(id.lack.hub_damping > 0.1);
        }
    }
    unlink(made.file);
}

TEST(another_trace_is_foretold)
{
    recording_made made[RECORDINGS],
        other = {.law = "open-loop", .angle = -0.2, .voltage = 2};
    memcpy(made, three, sizeof made);
    const scenario base = rig_scenario(&made[1], NULL, 1);
    double values[FITTED];
    memcpy(values, truth, sizeof values);
    values[4] = base.parameters.motor.viscous_friction;
    for (int r = 0; r < RECORDINGS; r++) {
        record(&made[r], values, 40 + r, 2);
    }
    record(&other, values, 50, 2);

    identification id, judged;
    set_up(&id, &base, made, RECORDINGS, 4);
    id.starts = 8;
    fit(&id);
    scenario fitted = base;
    parameters p;
    DONE(identify_parameters(&id, true, &p, &f));
    DONE(scenario_take_parameters(&fitted, &p, &f));
    set_up(&judged, &fitted, &other, 1, 0);
    fit(&judged);
    double most;
    check_below(identify_misfit(&id, &most), 1.2);
    check_below(identify_misfit(&judged, &most), 1.2);
    assert_true(judged.traces[0].contact_count > 0);
    check_close(judged.traces[0].contact_error, 0, 2e-3);
    check_close(judged.traces[0].peak_error, 0, 0.05);
    identify_finish(&id);
    identify_finish(&judged);
    for (int r = 0; r < RECORDINGS; r++) {
        unlink(made[r].file);
    }
    unlink(other.file);
}

// A value that the search would have further away, and a motor whose back EMF is another
// one.
TEST(a_bad_fit_is_known_as_one)
{
    recording_made made = three[0];
    scenario base = rig_scenario(&made, truth, 1);
    record(&made, truth, 1, 2);
    for (int slow = 0; slow <= 1; slow++) {
        DONE(parameter_set_number(&base.parameters, PARAMETER_INDEX(motor.back_emf),
                                  (slow ? 1.5 : 1) * base.parameters.motor.back_emf, &f));
        SCOPED(identify_finish)
        identification id = {.base = &base, .jobs = 2, .starts = 1};
        DONE(identify_add_path(&id, slow ? "arm.k2" : "arm.hub_inertia=0.004:0.005", &f));
        DONE(identify_add_trace(&id, made.file, NULL, 0, &f));
        fit(&id);
        double most;
        const double misfit = identify_misfit(&id, &most);

        assert_true(identify_at_end(&id.fit[0]) == !slow);
        assert_true(misfit > most && most > 4 && most < 5);
    }
    unlink(made.file);
}

int main(int argc, char **argv)
{
    fault f;
    seeds = argc > 1 ? atoi(argv[1]) : seeds;
    if (identify_available(&f) != STATUS_OK) {
        return 77;
    }
    cmocka_set_test_filter(argc > 2 ? argv[2] : NULL);
    return run_cases(NULL, NULL);
}
