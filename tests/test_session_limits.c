// What a session refuses leaves it as it was, and a run that is being computed can be
// left, stopped, and continued.
#include "tests/trace_check.h"

#include "tests/session_fixture.h"

static scenario read_text(const char *text)
{
    scenario s;
    assert_int_equal(scenario_parse(&s, text, strlen(text), "test.yaml", NULL,
                                    fail_on_fault, NULL),
                     STATUS_OK);
    return s;
}

static session opened(const char *text)
{
    session s;
    scenario base = read_text(text);
    DONE(session_open(&s, &base, HUGE_VAL, &f));
    return s;
}

static const char brief[] = "title: t\nwall: {angle: 0}\ninitial: {angle: -0.02}\n"
                            "run: {duration: 0.3 s}\n";

// Pushes of one gesture are undone and redone together, and a new gesture has a number of
// its own.
TEST(a_gesture_is_one_step)
{
    KEPT_SESSION(s) = opened(brief);
    assert_int_equal(session_new_gesture(&s), 1);
    static const struct {
        double time;
        unsigned gesture;
    } pushes[] = {{0.05, 0}, {0.1, 4},  {0.12, 4}, {0.14, 4},
                  {0.16, 2}, {0.18, 0}, {0.2, 0}};
    for (int i = 0; i < 7; i++) {
        session_seek(&s, pushes[i].time);
        DONE(session_pull(&s, 1e-4 * (i + 1), pushes[i].gesture, &f));
        const session_input *in = &s.inputs[i];
        assert_int_equal(in->kind, SESSION_INPUT_PUSH);
        assert_int_equal(in->gesture, pushes[i].gesture);
        check_close(in->value, 1e-4 * (i + 1), 0);
        check_close(in->time, pushes[i].time, 1e-3);
        check_close(in->seen_at, in->time, 0);
        assert_int_equal(in->parameter, -1);
        assert_true(isnan(in->before));
    }
    assert_int_equal(session_new_gesture(&s), 5);

    // those without a gesture one by one
    for (EACH_OF(int, c, 6, 5, 4, 1, 0)) {
        DONE(session_undo(&s, &f));
        assert_int_equal(s.input_count, *c);
        assert_int_equal(s.input_total, 7);
        assert_int_equal(session_new_gesture(&s), 5);
        check_close(s.now, s.inputs[*c].seen_at, 0);
    }
    REFUSED(STATUS_BAD_ARGUMENT, "", session_undo(&s, &f));
    for (EACH_OF(int, each, 1, 4, 5, 6, 7)) {
        DONE(session_redo(&s, &f));
        assert_int_equal(s.input_count, *each);
        check_close(s.now, s.inputs[*each - 1].time, 0);
    }
    REFUSED(STATUS_BAD_ARGUMENT, "", session_redo(&s, &f));

    // room for more than there was at first
    while (s.input_count < 40) {
        DONE(session_push(&s, 1e-6, &f));
        assert_int_equal(session_new_gesture(&s), 5);
    }
    REFUSED(STATUS_BAD_ARGUMENT, "", session_push(&s, (double)INFINITY, &f));
    assert_int_equal(s.input_total, 40);
}

TEST(what_is_too_long_or_no_value_is_refused)
{
    session s = opened(brief);
    fault f = {0};
    const char *endless = repeated('1', 2 * SESSION_INPUT_TEXT);
    session_seek(&s, 0.1);
    assert_int_equal(session_change(&s, PARAMETER_INDEX(motor.voltage), "2", &f),
                     STATUS_OK);
    assert_int_equal(session_push(&s, 0.01, &f), STATUS_OK);
    const unsigned version = s.version;

    // a new input
    assert_int_equal(session_change(&s, PARAMETER_INDEX(arm.k2), endless, &f),
                     STATUS_BAD_ARGUMENT);
    assert_non_null(strstr(f.text, "too long"));
    assert_int_not_equal(session_adjust(&s, PARAMETER_INDEX(arm.k2), "soft", &f),
                         STATUS_OK);

    // too long by its last character
    const char *just = formatted("%s7 ", repeated('0', SESSION_INPUT_TEXT - 2));
    f = (fault){0};
    assert_int_equal(session_change(&s, PARAMETER_INDEX(arm.k2), just, &f),
                     STATUS_BAD_ARGUMENT);
    assert_non_null(strstr(f.text, "too long"));
    f = (fault){0};
    assert_int_equal(session_change_input(&s, 0, just, &f), STATUS_BAD_ARGUMENT);
    assert_non_null(strstr(f.text, "too long"));

    // another value for one there is
    assert_int_equal(session_change_input(&s, 0, endless, &f), STATUS_BAD_ARGUMENT);
    assert_int_not_equal(session_change_input(&s, 0, "strong", &f), STATUS_OK);
    assert_int_equal(session_change_input(&s, 1, "2", &f), STATUS_BAD_ARGUMENT);
    assert_non_null(strstr(f.text, "push"));

    // what cannot be undone, redone or continued
    assert_int_equal(session_redo(&s, &f), STATUS_BAD_ARGUMENT);
    assert_int_equal(session_go_on(&s, &f), STATUS_BAD_ARGUMENT);
    assert_int_equal(s.input_count, 2);
    assert_int_equal(s.version, version);
    assert_string_equal(s.inputs[0].text, "2");
    session_finish(&s);

    KEPT_SESSION(printed) =
        opened("title: t\narm: {model: printed}\nrun: {duration: 0.1 s}\n");
    assert_int_equal(session_push(&printed, 0.01, &f), STATUS_BAD_ARGUMENT);
    assert_non_null(strstr(f.text, "no pushes"));
}

// Small steps of one parameter are one input; what is refused on the way is none of them.
TEST(adjusting_keeps_what_was_before)
{
    KEPT_SESSION(s) = opened(brief);
    fault f = {0};
    const int voltage = PARAMETER_INDEX(motor.voltage);
    session_seek(&s, 0.1);
    assert_int_equal(session_adjust(&s, voltage, "1.1", &f), STATUS_OK);
    assert_int_equal(session_adjust(&s, voltage, "1.2", &f), STATUS_OK);
    assert_int_equal(s.input_count, 1);
    assert_int_not_equal(session_adjust(&s, voltage, "much", &f), STATUS_OK);
    assert_int_equal(s.input_count, 1);
    assert_string_equal(s.inputs[0].text, "1.2");

    // at another instant it is another one, and back at what it was there is none
    session_seek(&s, 0.2);
    assert_int_equal(session_adjust(&s, voltage, "1.5", &f), STATUS_OK);
    assert_int_equal(s.input_count, 2);
    assert_int_equal(session_adjust(&s, voltage, "1.2", &f), STATUS_OK);
    assert_int_equal(s.input_count, 1);
    assert_int_equal(session_push(&s, 0.01, &f), STATUS_OK);
    assert_int_equal(session_adjust(&s, voltage, "3", &f), STATUS_OK);
    assert_int_equal(s.input_count, 3);
    assert_int_equal(session_adjust(&s, PARAMETER_INDEX(arm.k2), "5", &f), STATUS_OK);
    assert_int_equal(s.input_count, 4);
}

// An input that another one needs stays, and so do all where the run of others cannot be.
TEST(inputs_that_cannot_go_stay)
{
    KEPT_SESSION(s) = opened(brief);
    DONE(session_change(&s, PARAMETER_INDEX(arm.links), "3", &f));
    DONE(session_change(&s, PARAMETER_INDEX(arm.joint_stiffness), "7,8", &f));
    const unsigned version = s.version;
    REFUSED(STATUS_BAD_SCENARIO, "arm.joint_stiffness", session_drop_input(&s, 0, &f));
    assert_int_equal(s.input_count, 2);
    assert_int_equal(s.inputs[0].parameter, PARAMETER_INDEX(arm.links));

    session_input alone = s.inputs[1];
    REFUSED(STATUS_BAD_SCENARIO, "", session_take_inputs(&s, &alone, 1, &f));
    assert_int_equal(s.input_count, 2);
    assert_int_equal(s.version, version);
    DONE(session_take_inputs(&s, NULL, 0, &f));
    assert_int_equal(s.input_count, 0);
}

// A gesture that nothing comes before, and one whose number another one had that was
// undone.
TEST(gestures_end_where_their_inputs_end)
{
    KEPT_SESSION(s) = opened(brief);
    for (int i = 0; i < 3; i++) {
        session_seek(&s, 0.05 * (i + 1));
        DONE(session_pull(&s, 1e-4, 1, &f));
    }
    DONE(session_undo(&s, &f));
    assert_int_equal(s.input_count, 0);
    DONE(session_pull(&s, 1e-4, 1, &f));
    DONE(session_undo(&s, &f));
    DONE(session_redo(&s, &f));
    assert_int_equal(s.input_count, 1);
    REFUSED(STATUS_BAD_ARGUMENT, "", session_redo(&s, &f));
}

// An input that may not go leaves all of them as and where they were, whichever it is.
TEST(a_refused_drop_keeps_the_order)
{
    KEPT_SESSION(s) = opened(brief);
    session_input before[5];
    DONE(session_change(&s, PARAMETER_INDEX(arm.mass), "0.45", &f));
    DONE(session_change(&s, PARAMETER_INDEX(arm.links), "3", &f));
    DONE(session_change(&s, PARAMETER_INDEX(arm.joint_stiffness), "7,8", &f));
    session_seek(&s, 0.1);
    DONE(session_push(&s, 0.01, &f));
    DONE(session_change(&s, PARAMETER_INDEX(motor.voltage), "2", &f));
    assert_int_equal(s.input_count, 5);
    memcpy(before, s.inputs, sizeof before);
    DONE(session_take_inputs(&s, before, 5, &f)); // with room for no more
    REFUSED(STATUS_BAD_SCENARIO, "", session_drop_input(&s, 1, &f));
    assert_int_equal(s.input_count, 5);
    assert_memory_equal(before, s.inputs, sizeof before);

    // the others can go, and those behind move up
    for (int i = 4; i > 2; i--) {
        DONE(session_drop_input(&s, i, &f));
        assert_int_equal(s.input_count, i);
        assert_memory_equal(before, s.inputs, (size_t)i * sizeof *before);
    }
    DONE(session_drop_input(&s, 0, &f));
    assert_int_equal(s.input_count, 2);
    assert_memory_equal(before + 1, s.inputs, 2 * sizeof *before);
}

// Where another input went meanwhile, the run has other rows at the instant that undoing
// leads to: none, a later one, or another one with the number of the row that was shown.
TEST(undoing_leads_to_the_instant_in_another_run)
{
    static const struct {
        const char *path, *value;
        double at;
    } first[] = {{"run.duration", "0.6", 0.5},
                 {"method.step", "0.0005", 0.1},
                 {"method.step", "0.002", 0.1}};
    for (EACH(c, first)) {
        KEPT_SESSION(s) = opened(brief);
        DONE(session_change(&s, parameter_find(c->path), c->value, &f));
        session_seek(&s, c->at);
        DONE(session_push(&s, 1e-4, &f));
        DONE(session_drop_input(&s, 0, &f));
        session_seek(&s, 0);
        DONE(session_undo(&s, &f));
        assert_int_equal(s.input_count, 0);
        check_close(s.now, fmin(c->at, LAST_ROW(&s.run.trace)->time), 1e-9);
        check_close(session_sample(&s)->time, s.now, 1e-3);
    }
}

// An arm that starts on the wall meets it at once: what is done at the row before is done
// at 0.
TEST(a_push_before_a_contact_at_once_is_at_the_start)
{
    KEPT_SESSION(s) = opened("title: t\nwall: {angle: 0}\nrun: {duration: 0.1 s}\n"
                             "initial: {velocity: 0.5}\n");
    assert_true(s.run.summary.first_contact_s == 0);
    session_seek(&s, 0);
    while (session_step(&s, -1)) {
    }
    DONE(session_push(&s, 1e-4, &f));
    assert_true(s.inputs[0].time == 0);
}

// A session that takes the inputs of another one has its run to the last bit.
TEST(taken_inputs_make_the_same_run)
{
    KEPT_SESSION(from) = opened(brief), to = opened(brief);
    DONE(session_change(&from, PARAMETER_INDEX(arm.k2), "7", &f));
    for (int i = 1; i <= 3; i++) {
        session_seek(&from, 0.05 * i);
        DONE(session_change(&from, PARAMETER_INDEX(motor.voltage), formatted("%d", i),
                            &f));
        DONE(session_push(&from, 0.001 * i, &f));
        DONE(session_take_inputs(&to, from.inputs, from.input_count, &f));
        assert_int_equal(to.input_count, 1 + 2 * i);
        assert_memory_equal(to.inputs, from.inputs,
                            (size_t)to.input_count * sizeof *to.inputs);
        assert_int_equal(to.run.trace.row_count, from.run.trace.row_count);
        assert_memory_equal(to.run.trace.rows, from.run.trace.rows,
                            to.run.trace.row_count * sizeof *to.run.trace.rows);
    }

    // it goes on with inputs of its own, after none, too
    for (int taken = 7; taken >= 0; taken -= 7) {
        DONE(session_take_inputs(&to, from.inputs, taken, &f));
        for (int i = 1; i <= 3; i++) {
            DONE(session_push(&to, 1e-6, &f));
            assert_int_equal(to.input_count, taken + i);
        }
    }
}

// A change given at the row before an event takes effect before it, one at the row after
// it does not change the event.
TEST(a_change_at_an_event_belongs_to_its_row)
{
    KEPT_SESSION(s) = opened(brief);
    const double contact = s.run.summary.first_contact_s;
    assert_true(contact > 0);
    session_seek(&s, contact);
    assert_true(session_step(&s, -1));
    if (session_sample(&s)->time != contact) {
        assert_true(session_step(&s, 1)); // the first of the rows at contact
    }
    assert_false(session_sample(&s)->contact);
    DONE(session_change(&s, PARAMETER_INDEX(motor.voltage), "9", &f));
    assert_true(s.inputs[0].time < contact && s.inputs[0].time > contact - 1e-3);
    DONE(session_undo(&s, &f));
    assert_true(session_sample(&s)->time == contact && !session_sample(&s)->contact);

    while (!session_sample(&s)->contact) {
        assert_true(session_step(&s, 1));
    }
    assert_true(session_sample(&s)->time == contact);
    DONE(session_change(&s, PARAMETER_INDEX(motor.voltage), "9", &f));
    assert_true(s.inputs[0].time == contact);
    assert_true(s.run.summary.first_contact_s == contact);
}

// So it is at every event of a run, the first and the last, and before nothing else is
// anything moved.
TEST(what_is_done_at_any_event_belongs_to_its_row)
{
    KEPT_SESSION(s) =
        opened("title: t\nwall: {angle: 0.3, restitution: 0.6}\nmotor: {stiction: 0.02}\n"
               "run: {duration: 0.6 s}\n");
    int events = 0, changes = 0;
    const double change = 0.25;
    session_seek(&s, change);
    DONE(session_change(&s, PARAMETER_INDEX(motor.voltage), "1.1", &f));
    for (size_t r = 1; r + 1 < s.run.trace.row_count; r++) {
        const sample *rows = s.run.trace.rows;
        const double last = rows[r - 1].time, now = rows[r].time;
        const bool twice = now == rows[r + 1].time;
        if (!twice && r % 50 != 0) {
            continue;
        }

        // stands on the row: the first of its instant
        session_seek(&s, now);
        while (s.row > r) {
            assert_true(session_step(&s, -1));
        }
        assert_int_equal(s.row, r);
        DONE(session_push(&s, 1e-9, &f));
        const double given = s.inputs[1].time;
        if (twice && now != change) {
            check_close(given, fmax(now - 1e-7, (last + now) / 2), 0);
            assert_true(given < now && given > last);
        } else {
            check_close(given, now, 0);
        }
        DONE(session_undo(&s, &f));
        assert_int_equal(s.row, r);
        events += twice && now != change;
        changes += twice && now == change;
    }
    assert_true(events >= 3 && changes > 0);
}

// A long run is available as far as it is computed; when stopped it continues to the same
// rows.
TEST(a_stopped_run_goes_on)
{
    KEPT_SESSION(s);
    scenario base =
        read_text("title: t\nmotor: {voltage: 0.001 V}\nwall: {angle: 3 rad}\n"
                  "arm: {links: 24, damping_ratio: 0}\nrun: {duration: 300 s}\n");
    DONE(session_open(&s, &base, 0, &f));
    assert_non_null(s.computing);
    assert_true(s.run.trace.row_count > 0);

    // meanwhile it cannot be continued, and one too large leaves it running
    REFUSED(STATUS_BAD_ARGUMENT, "", session_go_on(&s, &f));
    REFUSED(STATUS_BAD_ARGUMENT, "",
            session_change(&s, PARAMETER_INDEX(method.step), "1e-7", &f));
    assert_int_equal(s.input_count, 0);
    assert_non_null(s.computing);

    // stopped, all rows so far are there
    assert_true(session_stop(&s));
    assert_false(session_stop(&s));
    assert_int_equal(s.run.summary.status, STATUS_STOPPED);
    const size_t count = s.run.trace.row_count;
    SCOPED(free_kept) sample *before = malloc(count * sizeof *before);
    assert_non_null(before);
    memcpy(before, s.run.trace.rows, count * sizeof *before);

    // and stand at the beginning of what comes then
    DONE(session_go_on(&s, &f));
    while (s.computing != NULL && s.run.trace.row_count < count + 10) {
        session_follow(&s);
    }
    assert_true(s.run.trace.row_count >= count + 10);
    for (size_t i = 0; i + 1 < count; i++) { // the last one is where it was cut
        assert_memory_equal(&before[i], &s.run.trace.rows[i], sizeof *before);
    }
}

// Code that is allowed and cannot be loaded: the session is as it was, and not allowed.
TEST(code_that_cannot_be_loaded_stays_withheld)
{
    KEPT_SESSION(s) =
        opened("title: t\ncontrol: {law: plugin, plugin: /nonexistent.so, force: 1 N}\n"
               "run: {duration: 0.1 s}\n");
    fault f = {0};
    const unsigned version = s.version;
    assert_int_not_equal(session_allow_code(&s, &f), STATUS_OK);
    assert_non_null(strstr(f.text, "/nonexistent.so"));
    assert_false(s.base.parameters.code_allowed);
    assert_int_equal(s.version, version);
    assert_true(s.run.trace.row_count > 0);
}
