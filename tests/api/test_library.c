// libimpactlab through its public header and shared library alone.
#include "handles.h"

static const char first_impact[] = "corrected/first-impact";

static void set(impactlab_scenario *scenario, const char *path, const char *text)
{
    check_done(impactlab_scenario_set(scenario, path, text, &told));
}

static double peak_of_loop(impactlab_loop *loop)
{
    own_run *run;
    check_done(impactlab_loop_run(loop, &run, &told));
    return quantity_of(run, "peak_force_N");
}

// the same bits, not about the same number
static void check_same(double a, double b)
{
    assert_memory_equal(&a, &b, sizeof a);
}

// --- runs ------------------------------------------------------------------------------

TEST(rows_are_read_in_place)
{
    own_scenario *scenario = opened(first_impact);
    impactlab_series time, force;
    impactlab_table angles;
    own_run *run = run_of(scenario, IMPACTLAB_KEEP_ROWS);
    check_done(impactlab_run_signal(run, "time", &time, &told));
    check_done(impactlab_run_signal(run, "force", &force, &told));
    check_done(impactlab_run_angles(run, &angles, &told));
    assert_true(force.count > 1000 && force.count == time.count &&
                angles.rows == force.count);

    // the largest recorded force is near the located peak, never above it
    double largest = 0, before = -1;
    for (size_t i = 0; i < force.count; i++) {
        const char *row = (const char *)force.values + i * force.stride;
        double f, t;
        memcpy(&f, row, sizeof f);
        memcpy(&t, (const char *)time.values + i * time.stride, sizeof t);
        largest = fmax(largest, f);
        assert_true(t >= before);
        before = t;
    }
    double peak = quantity_of(run, "peak_force_N");
    assert_true(largest <= peak && largest > 0.99 * peak);
    check_same(before, 1.0);

    // events and texts
    impactlab_event event;
    assert_int_equal(impactlab_run_event(run, 0, &event), 1);
    assert_int_equal(impactlab_run_event(run, impactlab_run_event_count(run), &event), 0);
    char *json, *csv;
    check_done(impactlab_run_json(run, &json, &told));
    check_done(impactlab_run_csv(run, &csv, &told));
    assert_true(json[0] == '{' && strncmp(csv, "time[s],", 8) == 0);
    impactlab_text_free(json);
    impactlab_text_free(csv);
}

TEST(predictions_and_modes)
{
    own_scenario *scenario = opened(first_impact);
    impactlab_prediction said[8];
    size_t count, modes;
    own_run *run = run_of(scenario, IMPACTLAB_KEEP_ROWS);
    check_done(impactlab_run_predictions(run, said, 8, &count, &told));
    assert_true(count >= 4);

    // the linearised arm predicts the simulation's first pulse well
    assert_string_equal(said[3].method, "linearised");
    assert_true(said[3].known && said[3].holds);
    assert_true(fabs(said[3].peak / quantity_of(run, "first_pulse_peak_N") - 1) < 0.05);

    // a free hub and tip turn as a whole
    double frequencies[4], shapes[16];
    assert_int_equal(impactlab_freedoms(scenario), 2);
    check_done(impactlab_modes(scenario, 0, 0, frequencies, shapes, 4, &modes, &told));
    assert_int_equal(modes, 2);
    assert_true(fabs(frequencies[0]) < 1e-3 && frequencies[1] > 1);
    assert_true(fabs(shapes[0] - shapes[1]) < 1e-6);
}

// --- errors ----------------------------------------------------------------------------

TEST(mistakes_are_told)
{
    own_scenario *scenario = opened(first_impact), *none;
    impactlab_run *run;
    impactlab_loop *loop;

    // wrong names name the nearest
    check_refused(impactlab_scenario_set(scenario, "motor.voltag", "1", &told),
                  "motor.voltage");
    check_refused(impactlab_scenario_open(&none, "corrected/frist-impact", &told),
                  "first-impact");
    assert_null(none);

    // wrong values change nothing
    assert_int_not_equal(impactlab_scenario_set(scenario, "motor.voltage", "much", &told),
                         0);
    assert_string_equal(told.parameter, "motor.voltage");
    assert_int_not_equal(impactlab_scenario_set_number(scenario, "wall.angle",
                                                       (double)NAN, &told),
                         0);
    check_done(impactlab_scenario_set_number(scenario, "wall.angle", 2.9, &told));
    assert_int_not_equal(impactlab_scenario_set_number(scenario, "initial.angle", -0.4,
                                                       &told),
                         0);
    assert_string_equal(told.parameter, "initial.angle");
    check_same(number_of(scenario, "initial.angle"), 0);
    check_same(number_of(scenario, "motor.voltage"), 1);

    // and no call without its arguments gets anywhere
    assert_int_equal(impactlab_run_create(&run, NULL, 0, &told), IMPACTLAB_BAD_ARGUMENT);
    assert_null(run);
    assert_int_equal(impactlab_run_create(&run, scenario, 1000, &told),
                     IMPACTLAB_BAD_ARGUMENT);
    assert_int_equal(impactlab_scenario_set(NULL, NULL, NULL, NULL),
                     IMPACTLAB_BAD_ARGUMENT);
    assert_null(impactlab_signal_at(100000));
    impactlab_run_destroy(NULL);
    impactlab_scenario_destroy(NULL);
    impactlab_loop_destroy(NULL);

    // a loop knows its flags
    assert_int_equal(impactlab_loop_create(&loop, scenario, 1000, &told),
                     IMPACTLAB_BAD_ARGUMENT);
    assert_null(loop);
}

TEST(files_with_faults_are_refused)
{
    // the fault, its place in the text and whose value it is
    static const struct {
        const char *text, *parameter;
        int line, column;
    } faulty[] = {
        {"title: x\nmotor: {voltage: plenty}\n", "motor.voltage", 2, 18},
        {"title: x\narm:\n  links: 3\n  link_inertia: 0.1\n", "arm.link_inertia", 4, 17},
        {"title: x\narm:\n  linkz: 3\nmotor: {voltage: plenty}\n", "", 3, 3},
        {"title: x\nmotor: {voltage: 1}\nscript: 5\n", "", 3, 9},
        {"title: x\n\n  : [", "", 3, 3},
    };
    impactlab_scenario *scenario;
    for (EACH(c, faulty)) {
        assert_int_equal(impactlab_scenario_parse(&scenario, c->text, strlen(c->text),
                                                  &told),
                         IMPACTLAB_BAD_SCENARIO);
        assert_null(scenario);
        const char *place = formatted("text:%d:%d: ", c->line, c->column);
        assert_memory_equal(told.sentence, place, strlen(place));
        assert_int_equal(told.line, c->line);
        assert_int_equal(told.column, c->column);
        assert_string_equal(told.parameter, c->parameter);
    }

    // what is of no place in a file has none, and is of its parameter
    static const char *const sets[] = {"motor.voltage=2", "wall.angle=wide"};
    scenario = opened(first_impact);
    assert_int_equal(impactlab_scenario_set_all(scenario, sets, 2, &told),
                     IMPACTLAB_BAD_ARGUMENT);
    assert_int_equal(told.line, 0);
    assert_int_equal(told.column, 0);
    assert_string_equal(told.parameter, "wall.angle");
    impactlab_scenario_destroy(scenario);
    assert_int_equal(impactlab_scenario_open(&scenario, "/nowhere.yaml", &told),
                     IMPACTLAB_BAD_ARGUMENT);
    assert_int_equal(told.line, 0);
}

// --- loops -----------------------------------------------------------------------------

// The corrected arm and the printed one, with a rig and bare.
TEST(a_stepped_run_is_the_run)
{
    static const char *const names[] = {"compare/hybrid", "compare/hybrid-printed-arm",
                                        "thesis/fig-3-4"};
    static const char *const keys[] = {"peak_force_N", "first_pulse_peak_N",
                                       "time_to_peak_s", "steady_force_N",
                                       "settling_time_s"};
    for (EACH(c, names)) {
        own_scenario *scenario = opened(*c);
        own_run *run = run_of(scenario, 0), *stepped;
        own_loop *loop = loop_of(scenario, 0);
        while (!impactlab_loop_ended(loop)) {
            check_done(impactlab_loop_step(loop, &told));
        }
        check_done(impactlab_loop_run(loop, &stepped, &told));
        for (EACH(key, keys)) {
            check_same(quantity_of(stepped, *key), quantity_of(run, *key));
        }
    }
}

// The printed model knows nothing between its rows: a loop ends at the first one that is
// due. An input there is what the script does at that instant.
TEST(the_printed_arm_stops_at_its_rows)
{
    own_scenario *scenario = opened("thesis/fig-3-4");
    impactlab_table angles;
    const double step = number_of(scenario, "method.step");
    own_loop *loop = loop_of(scenario, 0);
    check_done(impactlab_loop_step_until(loop, 9.5 * step, &told));
    check_same(impactlab_loop_time(loop), 10 * step);
    check_done(impactlab_loop_step_until(loop, 10 * step, &told));
    check_same(impactlab_loop_time(loop), 10 * step);

    // its state in place
    check_done(impactlab_loop_state(loop, &angles, &told));
    assert_true(angles.rows == 2 && angles.columns == 3);
    check_same(angles.values[0], signal_of(loop, "hub_angle"));

    // half the voltage from there on, as a script has it
    check_done(impactlab_scenario_add_change(scenario, 10 * step, "motor.voltage", "0.5",
                                             &told));
    own_run *run = run_of(scenario, 0);
    check_done(impactlab_loop_set_input(loop, "motor.voltage", 0.5, &told));
    check_done(impactlab_loop_step_until(loop, 1000, &told));
    assert_int_equal(impactlab_loop_ended(loop), 1);
    check_same(peak_of_loop(loop), quantity_of(run, "peak_force_N"));

    // pushes it does not know, which is no end of it
    assert_int_equal(impactlab_loop_push(loop, 1e-3, &told), IMPACTLAB_BAD_ARGUMENT);
    check_done(impactlab_loop_step(loop, &told));
}

// What a proportional controller outside the library remembers.
typedef struct outside {
    void *context; // left there by the rig
    long samples;
} outside;

static double commanded(double encoder, double force)
{
    return 1 + 0.3 * (0.1 - encoder) + 0.1 * (1 - force);
}

static void push_softly(void *memory, const controller_input *in, controller_output *out)
{
    outside *m = memory;
    m->samples++;
    *(long *)m->context = m->samples;
    out->command = commanded(in->encoder, in->force);
}

// A program that reads and commands in a loop is the same controller as one that is
// called back.
TEST(commands_come_from_outside)
{
    static const char *const modes[] = {"push", NULL};
    static const controller law = {.interface = CONTROLLER_INTERFACE,
                                   .name = "outside",
                                   .modes = modes,
                                   .memory_size = sizeof(outside),
                                   .sample = push_softly};
    own_scenario *scenario = opened(first_impact);
    own_run *run;
    long samples = 0;
    check_done(impactlab_run_create_with(&run, scenario, 0, &law, &samples, &told));
    assert_int_equal(samples, 200);

    own_loop *loop = loop_of(scenario, IMPACTLAB_COMMAND);
    while (!impactlab_loop_ended(loop)) {
        impactlab_reading read, again;
        check_done(impactlab_loop_read_sensors(loop, &read, &told));
        check_done(impactlab_loop_read_sensors(loop, &again, &told));
        assert_memory_equal(&read, &again, sizeof read);
        double volts = commanded(read.encoder, read.force);
        check_done(impactlab_loop_command(loop, volts, &told));
        check_done(impactlab_loop_step(loop, &told));
    }
    check_same(peak_of_loop(loop), quantity_of(run, "peak_force_N"));
}

// One that falls silent half-way.
static void fall_silent(void *memory, const controller_input *in, controller_output *out)
{
    (void)memory;
    if (in->time < 0.5) {
        out->command = 1;
    }
}

// What nobody answers is no command of 0 V: the run ends there and says who did not
// answer.
TEST(a_controller_that_does_not_answer_ends_the_run)
{
    static const char *const modes[] = {"push", NULL};
    static const controller law = {.interface = CONTROLLER_INTERFACE,
                                   .name = "silent",
                                   .modes = modes,
                                   .memory_size = sizeof(outside),
                                   .sample = fall_silent};
    own_scenario *scenario = opened(first_impact);
    own_run *run;
    impactlab_series time;
    check_refused(impactlab_run_create_with(&run, scenario, IMPACTLAB_KEEP_ROWS, &law,
                                            NULL, &told),
                  "at t = 0.5 s the controller 'silent' did not answer");
    assert_string_equal(impactlab_run_status(run), "failed");

    // what was computed until then is there
    check_done(impactlab_run_signal(run, "time", &time, &told));
    assert_true(time.count > 500);
}

// --- stops -----------------------------------------------------------------------------

// Counts how often it was asked, and says yes from a question on.
typedef struct asked {
    int count, enough;
} asked;

static int is_enough(void *context)
{
    asked *a = context;
    return ++a->count >= a->enough;
}

// An arm that nothing damps, which would take hours.
static impactlab_scenario *endless(asked *a)
{
    impactlab_scenario *scenario = opened(first_impact);
    set(scenario, "arm.links", "24");
    set(scenario, "arm.damping_ratio", "0");
    set(scenario, "run.duration", "90000");
    set(scenario, "method.step", "0.1");
    impactlab_scenario_stop_when(scenario, is_enough, a);
    return scenario;
}

TEST(a_question_ends_a_run)
{
    asked a = {.enough = 5}, never = {.enough = 1000000};
    own_scenario *scenario = endless(&a);
    own_run *run, *whole;
    impactlab_series time;
    check_refused(impactlab_run_create(&run, scenario, IMPACTLAB_KEEP_ROWS, &told),
                  "stopped");
    assert_int_equal(told.status, IMPACTLAB_STOPPED);
    assert_int_equal(a.count, 5);

    // the rows until then are there, and how many a machine has by the fifth question is
    // its affair
    check_done(impactlab_run_signal(run, "time", &time, &told));
    assert_true(time.count > 0);

    impactlab_run_destroy(run);

    // who is asked and says no changes nothing
    set(scenario, "run.duration", "0.5");
    impactlab_scenario_stop_when(scenario, is_enough, &never);
    check_done(impactlab_run_create(&run, scenario, 0, &told));
    impactlab_scenario_stop_when(scenario, NULL, NULL);
    check_done(impactlab_run_create(&whole, scenario, 0, &told));
    check_same(quantity_of(run, "peak_force_N"), quantity_of(whole, "peak_force_N"));
    assert_true(never.count > 0);
}

// A loop that is stopped again and again comes to the same rows as one that is not.
TEST(a_stopped_loop_goes_on)
{
    asked a = {.enough = 1};
    own_scenario *scenario = endless(&a);
    own_loop *stopped = loop_of(scenario, IMPACTLAB_KEEP_ROWS);
    int stops = 0;
    while (impactlab_loop_step_until(stopped, 0.5, &told) == IMPACTLAB_STOPPED) {
        stops++;
    }
    assert_int_equal(told.status, IMPACTLAB_OK);
    assert_true(stops > 0 && stops == a.count);

    // each ends where no step is under way
    impactlab_scenario_stop_when(scenario, NULL, NULL);
    own_loop *loop = loop_of(scenario, IMPACTLAB_KEEP_ROWS);
    check_done(impactlab_loop_step_until(loop, 0.5, &told));
    own_run *one, *other;
    check_done(impactlab_loop_run(stopped, &one, &told));
    check_done(impactlab_loop_run(loop, &other, &told));
    char *rows, *expected;
    check_done(impactlab_run_csv(one, &rows, &told));
    check_done(impactlab_run_csv(other, &expected, &told));
    assert_string_equal(rows, expected);
    impactlab_text_free(rows);
    impactlab_text_free(expected);
}

static void step_to(impactlab_loop *loop, double time)
{
    while (!impactlab_loop_ended(loop) && impactlab_loop_time(loop) < time) {
        check_done(impactlab_loop_step(loop, &told));
    }
}

// A state goes into another loop, and back into its own, to the last bit; noise and all.
TEST(states_come_back)
{
    static const char *const names[] = {"corrected/first-impact", "compare/hybrid",
                                        "compare/touch", "corrected/twenty-links",
                                        "compare/hybrid-printed-arm"};
    for (EACH(c, names)) {
        own_scenario *scenario = opened(*c);
        own_loop *loop = loop_of(scenario, 0), *other = loop_of(scenario, 0);
        const double end = number_of(scenario, "run.duration");

        // before and in the contact
        for (double share = 0.2; share < 1; share += 0.4) {
            step_to(loop, share * end);
            size_t size = impactlab_loop_state_size(loop);
            SCOPED(free_kept) void *bytes = malloc(size);
            check_done(impactlab_loop_save_state(loop, bytes, size, &told));
            step_to(loop, (share + 0.1) * end);
            const double force = signal_of(loop, "force");

            impactlab_loop *const both[] = {other, loop};
            for (int k = 0; k < 2; k++) {
                check_done(impactlab_loop_restore_state(both[k], bytes, size, &told));
                step_to(both[k], (share + 0.1) * end);
                check_same(force, signal_of(both[k], "force"));
            }
            assert_int_not_equal(impactlab_loop_restore_state(loop, bytes, size - 1,
                                                              &told),
                                 0);

            // a bit that is another is noticed, wherever it is, and changes nothing
            unsigned char *const damaged = bytes;
            for (size_t at = 0; at < size; at += 1 + size / 997) {
                damaged[at] ^= (unsigned char)(1u << at % 8);
                assert_int_not_equal(impactlab_loop_restore_state(loop, bytes, size,
                                                                  &told),
                                     0);
                damaged[at] ^= (unsigned char)(1u << at % 8);
            }
            check_same(force, signal_of(loop, "force"));
        }
    }
}

// What a run tells, as one text.
static char *told_by(const impactlab_run *run)
{
    char *json, *csv, *all;
    impactlab_prediction said[8];
    size_t count = 0;
    check_done(impactlab_run_json(run, &json, &told));
    check_done(impactlab_run_csv(run, &csv, &told));
    const int predicted =
        impactlab_run_predictions(run, said, COUNT(said), &count, &told);
    assert_true(asprintf(&all, "%s%s%s %d %zu %.17g %zu", json, csv,
                         impactlab_run_message(run), predicted, count,
                         count > 0 ? said[0].peak : 0,
                         impactlab_run_event_count(run)) > 0);
    impactlab_text_free(json);
    impactlab_text_free(csv);
    return all;
}

// A run goes into bytes and comes back as it was, with rows, without, and one that
// stopped on its way; other bytes and another scenario's are refused.
TEST(runs_come_back)
{
    static const char *const names[] = {"corrected/first-impact", "compare/hybrid",
                                        "corrected/twenty-links",
                                        "compare/hybrid-printed-arm"};
    for (EACH(c, names)) {
        own_scenario *scenario = opened(*c);
        for (int flags = 0; flags <= IMPACTLAB_KEEP_ROWS; flags++) {
            own_run *run = run_of(scenario, flags), *again = NULL, *none = NULL;
            const size_t size = impactlab_run_saved_size(run);
            SCOPED(free_kept) unsigned char *bytes = malloc(size);
            SCOPED(free_kept) unsigned char *odd = malloc(size + 1);
            check_refused(impactlab_run_save(run, bytes, size - 1, &told), "room");
            check_done(impactlab_run_save(run, bytes, size, &told));
            memcpy(odd + 1, bytes, size);
            check_done(impactlab_run_restore(&again, scenario, odd + 1, size, &told));
            SCOPED(free_kept) char *was = told_by(run), *is = told_by(again);
            assert_string_equal(is, was);

            bytes[size / 2] ^= 4;
            check_refused(impactlab_run_restore(&none, scenario, bytes, size, &told),
                          "damaged");
            check_refused(impactlab_run_restore(&none, scenario, bytes, 3, &told), "no");
            own_scenario *other = opened(*c);
            set(other, "run.duration", "0.3");
            check_refused(impactlab_run_restore(&none, other, odd + 1, size, &told),
                          "another scenario");
            assert_null(none);
        }
    }
}

// Rows on a grid: an instant each, with the signals that the run has there last.
TEST(rows_on_a_grid)
{
    own_scenario *scenario = opened("compare/hybrid");
    own_run *run = run_of(scenario, IMPACTLAB_KEEP_ROWS);
    const double every = 0.01, end = number_of(scenario, "run.duration");
    size_t width = 0, count, written;
    while (impactlab_signal_at(width) != NULL) {
        width++;
    }
    check_done(impactlab_run_grid(run, every, NULL, 0, &count, &told));
    assert_int_equal(count, 1 + lround(end / every));
    SCOPED(free_kept) double *rows = calloc(count, width * sizeof *rows);
    check_done(impactlab_run_grid(run, every, rows, count - 1, &written, &told));
    assert_int_equal(written, count);
    assert_true(rows[(count - 1) * width] == 0);
    check_done(impactlab_run_grid(run, every, rows, count, &written, &told));

    impactlab_series time, force;
    check_done(impactlab_run_signal(run, "time", &time, &told));
    check_done(impactlab_run_signal(run, "force", &force, &told));
    const size_t step = time.stride / sizeof(double);
    size_t column = 0, row = 0;
    while (strcmp(impactlab_signal_at(column)->name, "force") != 0) {
        column++;
    }
    for (size_t i = 0; i < count; i++) {
        check_same(rows[i * width], (double)i * every);
        while (row + 1 < time.count &&
               time.values[(row + 1) * step] < (double)i * every + 1e-9) {
            row++;
        }
        check_same(rows[i * width + column], force.values[row * step]);
    }

    static const double wrong[] = {0, -1, (double)NAN, 1e-12};
    for (EACH(w, wrong)) {
        check_refused(impactlab_run_grid(run, *w, NULL, 0, &count, &told), "more than 0");
    }

    // a run without rows has none there
    own_run *bare = run_of(scenario, 0);
    check_done(impactlab_run_grid(bare, every, rows, count, &count, &told));
    assert_int_equal(count, 0);
}

// All signals at once are each of them, to the last bit; a short array gets the first.
TEST(all_signals_at_once)
{
    static const char *const names[] = {"corrected/first-impact", "compare/touch",
                                        "corrected/twenty-links",
                                        "compare/hybrid-printed-arm"};
    enum { FEW = 3, MOST = 64 };
    for (EACH(c, names)) {
        own_scenario *scenario = opened(*c);
        own_loop *loop = loop_of(scenario, 0);
        for (double time = 0; time < 0.5; time += 0.031) {
            step_to(loop, time);
            double few[FEW + 1] = {0, 0, 0, -7}, all[MOST];
            const size_t count = impactlab_loop_signals(loop, all, MOST);
            assert_null(impactlab_signal_at(count));
            assert_int_equal(impactlab_loop_signals(loop, few, FEW), count);
            assert_memory_equal(few, all, FEW * sizeof *few);
            assert_true(few[FEW] == -7);
            for (size_t i = 0; i < count; i++) {
                check_same(all[i], signal_of(loop, impactlab_signal_at(i)->name));
            }
        }
    }
    assert_int_equal(impactlab_loop_signals(NULL, NULL, 0) > 0, 1);
}

// Flips `flips` bits of a block, of which at least one is then another than it was.
static void flip_bits(unsigned char *bytes, const unsigned char *whole, size_t size,
                      int flips)
{
    for (int i = 0; i < flips || memcmp(bytes, whole, size) == 0; i++) {
        const size_t bit = (size_t)lrand48() % (8 * size);
        bytes[bit / 8] ^= (unsigned char)(1u << bit % 8);
    }
}

// No block but a whole one of its own scenario goes into a loop: flipped, cut, turned
// round or another's is refused, and the loop stays as it is. Loops of one state save the
// same bytes.
TEST(only_whole_states_are_taken)
{
    enum { BLOCKS = 100000 };
    own_scenario *scenario = opened("compare/hybrid");
    own_loop *loop = loop_of(scenario, 0), *same = loop_of(scenario, 0);
    set(scenario, "wall.angle", "0.5");
    own_loop *other = loop_of(scenario, 0);
    const size_t size = impactlab_loop_state_size(loop);
    assert_int_equal(impactlab_loop_state_size(other), size);
    SCOPED(free_kept) unsigned char *whole = malloc(size), *bytes = malloc(size);
    step_to(same, 0.3);
    check_done(impactlab_loop_save_state(same, bytes, size, &told));
    step_to(loop, 0.3);
    check_done(impactlab_loop_save_state(loop, whole, size, &told));
    assert_memory_equal(whole, bytes, size);

    srand48(1);
    for (int i = 0; i < BLOCKS; i++) {
        const size_t part = (size_t)lrand48() % size;
        size_t given = size;
        memcpy(bytes, whole, size);
        if (i % 4 == 0) {
            given = part;
        } else if (i % 4 == 1) {
            // the halves first, then parts of any length
            size_t middle = size / 2;
            if (i > 1) {
                middle = 1 + part % (size - 1);
            }
            memcpy(bytes, whole + middle, size - middle);
            memcpy(bytes + size - middle, whole, middle);
        } else {
            flip_bits(bytes, whole, size, 1 + i / 4 % 64);
        }
        assert_int_equal(impactlab_loop_restore_state(loop, bytes, given, &told),
                         IMPACTLAB_BAD_ARGUMENT);
    }
    step_to(other, 0.3);
    check_done(impactlab_loop_save_state(other, bytes, size, &told));
    assert_int_equal(impactlab_loop_restore_state(loop, bytes, size, &told),
                     IMPACTLAB_BAD_ARGUMENT);

    check_done(impactlab_loop_save_state(loop, bytes, size, &told));
    assert_memory_equal(whole, bytes, size);
    check_done(impactlab_loop_restore_state(loop, bytes, size, &told));
}

// A program starts where it is allowed, and its loop does not go back.
TEST(the_loop_of_a_process)
{
    own_scenario *scenario = opened(first_impact);
    check_done(impactlab_scenario_set(
        scenario, "control.command",
        "while read -r line; do echo \"{\\\"command\\\": 1.5}\"; done", &told));
    check_done(impactlab_scenario_set(scenario, "control.law", "process", &told));
    own_loop *refused = loop_of(scenario, 0);
    assert_int_equal(impactlab_loop_step(refused, &told), IMPACTLAB_NOT_ALLOWED);
    impactlab_scenario_allow_code(scenario, 1);
    own_loop *loop = loop_of(scenario, 0);

    step_to(loop, 0.05);
    const size_t size = impactlab_loop_state_size(loop);
    SCOPED(free_kept) void *bytes = malloc(size);
    check_done(impactlab_loop_save_state(loop, bytes, size, &told));
    assert_int_equal(impactlab_loop_restore_state(loop, bytes, size, &told),
                     IMPACTLAB_BAD_ARGUMENT);
    step_to(loop, 0.2);
}

// A mode's name holds a law in it as the script's action does; a name that it has not is
// refused.
TEST(texts_act_at_once)
{
    own_scenario *scenario = opened("compare/hybrid");
    own_run *run;
    set(scenario, "run.duration", "0.4");
    own_loop *loop = loop_of(scenario, 0);
    check_done(impactlab_loop_step_until(loop, 0.1, &told));
    assert_int_not_equal(impactlab_loop_set_text(loop, "control.lock", "sideways", &told),
                         0);
    check_done(impactlab_loop_set_text(loop, "control.lock", "approach", &told));
    check_done(impactlab_loop_step_until(loop, 1, &told));
    check_same(signal_of(loop, "controller_mode"), 0);

    check_done(
        impactlab_scenario_add_change(scenario, 0.1, "control.lock", "approach", &told));
    check_done(impactlab_run_create(&run, scenario, 0, &told));
    check_same(peak_of_loop(loop), quantity_of(run, "peak_force_N"));
}

TEST(inputs_act_at_once)
{
    own_scenario *scenario = opened(first_impact);
    own_loop *loop = loop_of(scenario, IMPACTLAB_KEEP_ROWS);
    check_done(impactlab_loop_step_until(loop, 0.01, &told));
    check_same(impactlab_loop_time(loop), 0.01);
    const double torque = signal_of(loop, "motor_torque");
    check_done(impactlab_loop_set_input(loop, "motor.voltage", 2, &told));
    assert_true(fabs(signal_of(loop, "motor_torque") - 2 * torque) < 1e-12);

    // a push across the last link turns it
    const double before = signal_of(loop, "last_velocity");
    check_done(impactlab_loop_push(loop, 1e-3, &told));
    assert_true(signal_of(loop, "last_velocity") > before);

    // what holds from the start cannot be set, and an arm without a rig has no sensors
    impactlab_reading reading;
    assert_int_equal(impactlab_loop_set_input(loop, "arm.links", 4, &told),
                     IMPACTLAB_BAD_ARGUMENT);
    assert_int_equal(impactlab_loop_read_sensors(loop, &reading, &told),
                     IMPACTLAB_BAD_ARGUMENT);
    assert_int_equal(impactlab_loop_command(loop, 1, &told), IMPACTLAB_BAD_ARGUMENT);
    check_done(impactlab_loop_step(loop, &told));
}

// --- batches ---------------------------------------------------------------------------

typedef struct collected {
    double peak[500];
    size_t count, most;
} collected;

static int collect(void *context, const impactlab_outcome *outcome)
{
    collected *c = context;
    size_t peak = 0;
    while (strcmp(impactlab_quantity_at(peak)->key, "peak_force_N") != 0) {
        peak++;
    }
    assert_int_equal(outcome->index, c->count);
    c->peak[c->count++] = outcome->quantities[peak];
    return c->count == c->most;
}

// Durations of a batch, what came of each, and how many came.
typedef struct durations {
    double values[40], work[40];
    int status[40];
    size_t count;
} durations;

static int keep_work(void *context, const impactlab_outcome *outcome)
{
    durations *d = context;
    size_t work = 0;
    while (strcmp(impactlab_quantity_at(work)->key, "motor_work_J") != 0) {
        work++;
    }
    d->work[outcome->index] = outcome->quantities[work];
    d->status[outcome->index] = outcome->status;
    d->count++;
    return 0;
}

// Of a batch that is stopped the runs that were done come, each under its own number, and
// those that fail among them.
TEST(a_stopped_batch_has_the_right_rows)
{
    static const char *const paths[] = {"run.duration", "control.law"};
    asked a = {.enough = 30};
    own_scenario *scenario = endless(&a), *single = endless(&a);
    durations d = {.count = 0};
    double values[40][2], plugin;
    set(scenario, "control.plugin", "not-allowed.so");
    set(single, "control.plugin", "not-allowed.so");
    set(single, "control.law", "plugin");
    plugin = number_of(single, "control.law");
    set(single, "control.law", "none");
    impactlab_scenario_stop_when(single, NULL, NULL);
    for (int i = 0; i < 40; i++) {
        d.status[i] = -1;
        values[i][0] = i % 4 == 2 ? 90000 : 0.001 * (i + 1);
        values[i][1] = i % 4 == 1 ? plugin : number_of(single, "control.law");
    }
    check_refused(impactlab_batch(scenario, paths, 2, values[0], 40, 2, keep_work, &d,
                                  &told),
                  "stopped");
    assert_int_equal(told.status, IMPACTLAB_STOPPED);
    assert_true(a.count >= 30 && d.count > 0 && d.count <= 30);

    for (int i = 0; i < 40; i++) {
        if (i % 4 == 2) {
            assert_int_equal(d.status[i], -1);
        } else if (i % 4 == 1 && d.status[i] >= 0) {
            assert_int_equal(d.status[i], IMPACTLAB_NOT_ALLOWED);
        } else if (d.status[i] >= 0) {
            check_done(impactlab_scenario_set_number(single, "run.duration", values[i][0],
                                                     &told));
            own_run *run = run_of(single, 0);
            assert_int_equal(d.status[i], IMPACTLAB_OK);
            check_same(d.work[i], quantity_of(run, "motor_work_J"));
        }
    }
}

TEST(batches_are_runs)
{
    static const char *const paths[] = {"motor.voltage"};
    own_scenario *scenario = opened(first_impact);
    collected one = {.most = 1000}, many = {.most = 1000}, few = {.most = 7};
    double volts[500];
    for (int i = 0; i < 500; i++) {
        volts[i] = 1 + 0.004 * i;
    }
    check_done(impactlab_batch(scenario, paths, 1, volts, 500, 1, collect, &one, &told));
    check_done(impactlab_batch(scenario, paths, 1, volts, 500, 3, collect, &many, &told));
    assert_memory_equal(&one.peak, &many.peak, sizeof one.peak);
    assert_int_equal(one.count, 500);

    // as a run by itself
    check_done(
        impactlab_scenario_set_number(scenario, "motor.voltage", volts[250], &told));
    own_run *run = run_of(scenario, 0);
    check_same(one.peak[250], quantity_of(run, "peak_force_N"));

    // the taker may have enough, and a wrong value is found before anything runs
    assert_int_equal(impactlab_batch(scenario, paths, 1, volts, 500, 1, collect, &few,
                                     &told),
                     IMPACTLAB_STOPPED);
    assert_int_equal(few.count, 7);
    volts[499] = (double)NAN;
    assert_int_not_equal(impactlab_batch(scenario, paths, 1, volts, 500, 1, collect, &few,
                                         &told),
                         0);
    assert_non_null(strstr(told.sentence, "run 499"));
    assert_int_equal(few.count, 7);
}

TEST(scenarios_are_written_and_read)
{
    impactlab_scenario *scenario = opened(first_impact), *again;
    char *yaml, text[64];
    set(scenario, "motor.voltage", "2.5 V");
    check_done(impactlab_scenario_add_push(scenario, 0.5, 0.001, &told));
    check_done(impactlab_scenario_add_change(scenario, 0.2, "motor.voltage", "1", &told));
    check_done(impactlab_scenario_yaml(scenario, &yaml, &told));
    check_done(impactlab_scenario_parse(&again, yaml, strlen(yaml), &told));
    check_done(impactlab_scenario_text(again, "motor.voltage", text, sizeof text, &told));
    assert_string_equal(text, "2.5");
    assert_int_equal(impactlab_scenario_is_set(again, "motor.voltage"), 1);
    assert_int_equal(impactlab_scenario_is_set(again, "arm.tip_mass"), 0);
    assert_string_equal(impactlab_scenario_name(again), "text");
    impactlab_scenario_destroy(again);
    check_done(
        impactlab_scenario_parse_named(&again, yaml, strlen(yaml), first_impact, &told));
    assert_string_equal(impactlab_scenario_name(again), first_impact);
    assert_int_not_equal(impactlab_scenario_add_push(scenario, -1, 0.001, &told), 0);

    // both are the same run
    own_run *a = run_of(scenario, 0), *b = run_of(again, 0);
    check_same(quantity_of(a, "peak_force_N"), quantity_of(b, "peak_force_N"));
    impactlab_text_free(yaml);
    impactlab_scenario_destroy(scenario);
    impactlab_scenario_destroy(again);
}
