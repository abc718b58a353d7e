// A visit to the lab is kept in a file and gone on with; files from elsewhere are
// checked.
#include "tests/explorer_on_screen.h"

#include "src/session/session_file.h"

static const char path[] = "lab.session";

// Saves the visit to `path`, in the place of what is there.
static void save(explorer *ex)
{
    unlink(path);
    fail_if(!explorer_carry_out(ex, "session save lab.session"), "%s",
            ex->input.message.text);
}

// Runs of two scenarios, changes, pushes, pins, panes, axes, zoom and mark come back to
// the last bit. Saved again the file is the same. Leaving right after saving asks
// nothing. The keys pin two runs ("b"), change the second, and set up the panes.
TEST(test_what_was_done_comes_back)
{
    static const char keys[] =
        "b:open compare/hybrid<Enter>:pin with \u03b8<Enter>:set control.force "
        "1.37<Enter>:seek 0.35<Enter>:set control.force 2.1<Enter>:push "
        "0.003<Enter>b:hide 2<Enter>:set control.transition_time 0.2<Enter>:trace "
        "gap_velocity<Enter>:phase gap force<Enter>:axis -1 3 1<Enter>:axis -2 "
        "2 3<Enter>:signal hub_angle 2<Enter>:limit force 2.5<Enter>:zoom 0.1 "
        "0.9<Enter>:mark 0.3<Enter>:seek 0.5<Enter>";
    SCOPED(explorer_finish) explorer ex;
    open_changed(&ex, "corrected/first-impact", "", HUGE_VAL);
    press(&ex, keys);
    save(&ex);
    KEPT_TEXT(first) = file_text(path);
    press_quits(&ex, "q", true);

    // another explorer opens the file: the same present run, the same pinned runs
    OPEN_EXPLORER(again, "corrected/three-links");
    fail_if(!explorer_open_session(&again.model, &again.view, &again.input, path), "%s",
            again.input.message.text);
    assert_same_trace(&again.model.session.run.trace, &ex.model.session.run.trace);
    assert_int_equal(again.model.pinned.count, ex.model.pinned.count);
    assert_int_equal(again.model.pinned.baseline, ex.model.pinned.baseline);
    for (int i = 0; i < ex.model.pinned.count; i++) {
        const pinned_run *a = &again.model.pinned.runs[i], *b = &ex.model.pinned.runs[i];
        assert_same_trace(&a->run.trace, &b->run.trace);
        assert_string_equal(a->name, b->name);
        assert_int_equal(a->hidden, b->hidden);
    }

    // the cursor, the mark, the panes and the limit that the keys set
    check_close(again.model.session.now, 0.5, 0);
    check_close(again.view.mark.time, 0.3, 0);
    for (int i = 0; i < PANES; i++) {
        assert_int_equal(again.view.panes.pane[i].shown, ex.view.panes.pane[i].shown);
    }
    check_close(again.view.panes.pane[0].fixed.high, 3, 0);
    assert_int_equal(again.view.panes.pane[1].hidden, ex.view.panes.pane[1].hidden);
    check_close(again.view.panes.pane[2].fixed.low, -2, 0);
    assert_int_not_equal(again.view.panes.pane[1].hidden, 0);
    assert_int_equal(again.model.limit.signal, SIGNAL_INDEX(force));
    check_close(again.model.limit.bound, 2.5, 0);
    assert_true(again.view.panes.pane[2].is_fixed);
    assert_false(again.view.panes.pane[3].is_fixed);

    // saved a second time the file is the same
    assert_true(explorer_carry_out(&again, "session save lab.session"));
    assert_holds(path, first);

    // changes of the opened run are undone as any others; behind them, opening it is
    // undone
    press(&again, "uu");
    assert_int_equal(again.model.session.input_count, ex.model.session.input_count - 2);
    press_opens(&again, "uuu", "corrected/three-links");
}

// Writes a recording of one constant command.
static void write_command(const char *volts)
{
    put_file("command.csv", formatted("t,command\n0,%s\n", volts));
}

// The content of a recording that a run plays belongs to the run: a session says when it
// opens and another recording has taken the place of the kept recording.
TEST(test_changed_recordings_are_told)
{
    write_command("1");
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(
        &ex,
        ":set control.playback_file command.csv<Enter>:set control.law playback<Enter>");
    save(&ex);

    // opened with the recording unchanged: no warning
    OPEN_EXPLORER(same, "corrected/three-links");
    assert_true(explorer_open_session(&same.model, &same.view, &same.input, path));
    fail_if(same.input.message.warning, "%s", same.input.message.text);

    // opened with another recording in its place: a warning
    write_command("2");
    OPEN_EXPLORER(other, "corrected/three-links");
    assert_true(explorer_open_session(&other.model, &other.view, &other.input, path));
    assert_true(other.input.message.warning);
    assert_non_null(strstr(other.input.message.text, "has changed since it was kept"));

    // a recording that is replaced after the run and before the session is saved: a
    // warning, too
    write_command("3");
    save(&other);
    OPEN_EXPLORER(late, "corrected/three-links");
    assert_true(explorer_open_session(&late.model, &late.view, &late.input, path));
    assert_true(late.input.message.warning);
    unlink("command.csv");
}

// "session save" refuses to replace a file that the visit did not write, and replaces the
// file that it wrote.
TEST(test_only_the_visits_own_file_is_replaced)
{
    put_file(path, "precious");
    OPEN_EXPLORER(ex, "corrected/first-impact");
    assert_false(explorer_carry_out(&ex, "session save lab.session"));
    assert_holds(path, "precious");
    save(&ex);
    assert_true(explorer_carry_out(&ex, "session save lab.session"));
    assert_false(explorer_carry_out(&ex, "session open none.session"));
    assert_shows(&ex, "cannot be opened");
}

// After a session is saved the message gives the command that goes on with it, quoted
// where the name of the file has a space.
TEST(test_the_command_that_is_told_works)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, "b:session save s 1<Enter>");
    fail_if(strstr(ex.input.message.text, "impactlab lab 's 1.session'") == NULL, "%s",
            ex.input.message.text);
    assert_true(file_has("s 1.session", "impactlab-session"));

    // a second pin, saved to the same file without a question
    press(&ex, "b:session save s 1<Enter>");
    assert_false(ex.input.message.warning);
    OPEN_EXPLORER(again, "corrected/three-links");
    press_opens(&again, ":session open s 1<Enter>", "corrected/first-impact");
}

// A session from elsewhere whose law is a program does not start the program, and its
// lines of a view cannot save a file or allow the program: the file `mark`, which either
// would write, is not there.
TEST(test_a_file_from_elsewhere_starts_nothing)
{
    const char *mark = formatted("%s/started", test_folder);
    put_file(
        path,
        formatted("impactlab-session: 1\nscenario: mine\n| title: \"mine\"\npresent:\n"
                  "start: 0 control.command touch %s\nstart: 0 control.law process\n"
                  "cursor: 0 0\nbaseline: 0\nview: save %s\nview: allow\n",
                  mark, mark));
    OPEN_EXPLORER(ex, "corrected/first-impact");
    explorer_open_session(&ex.model, &ex.view, &ex.input, path);
    assert_int_equal(ex.model.session.run.summary.status, STATUS_NOT_ALLOWED);
    assert_shows(&ex, "does not belong into a session");
    assert_int_equal(access(mark, F_OK), -1);
}

// Each fault of a session file is reported with line and column, and the visit stays as
// it was: one pinned run and one change.
TEST(test_broken_files_are_refused_with_their_line)
{
#define BASE "impactlab-session: 1\nscenario: a\n| title: \"a\"\n"
    static const struct {
        const char *text, *says;
    } cases[] = {
        {"", "this is no session"},
        {"title: a\n", ":1:1: this is no session"},
        {"impactlab-session: 1\n", "ends early"},
        {BASE, "ends early"},
        {"impactlab-session: 1\npresent:\n", ":2:1: a run, expected a scenario"},
        {"impactlab-session: 1\n| title: a\n", ":2:1: text without a scenario"},
        {BASE "pinned: a\n", ":4:1: expected one present run"},
        {BASE "present:\npresent:\n", ":5:1: expected one present run"},
        {BASE "present:\nnonsense\n", ":5:1: no line of a session"},
        {BASE "present:\nrun: a\n", ":5:1: a line that does not belong"},
        {BASE "start: 0 motor.voltage 2\n", ":4:1: a change, expected a run"},
        {BASE "present:\nstart: 0 motor.voltgae 2\n", ":5:1: no change"},
        {BASE "present:\nstart: -1 motor.voltage 2\n", ":5:1: no change"},
        {BASE "present:\nstart: 0 motor.voltage lots\n", ":5:1: "},
        {BASE "present:\nfrom: 0.1 arm.links 5\n",
         ":5:1: a parameter that does not change"},
        {BASE "present:\npush: 0.1\n", ":5:1: no push"},
        {BASE "present:\npush: 0.1 nan\n", ":5:1: no push"},
        {BASE "present:\ncursor: 1\n", ":5:1: no cursor"},
        {BASE "present:\nbaseline: 1\n", ":5:1: no baseline"},
        {BASE "| arm: {k3: 1}\npresent:\n", "k3"},
    };
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, "b:set arm.k2 5<Enter>");
    for (EACH(c, cases)) {
        put_file(path, c->text);
        fail_if(explorer_open_session(&ex.model, &ex.view, &ex.input, path) ||
                    strstr(ex.input.message.text, c->says) == NULL,
                "'%s' says '%s'", c->text, ex.input.message.text);
        assert_int_equal(ex.model.pinned.count, 1);
        assert_int_equal(ex.model.session.input_count, 1);
    }

    // any beginning of a good file is read or refused with a sentence; none crashes
    save(&ex);
    KEPT_TEXT(good) = file_text(path);
    const size_t length = strlen(good);
    for (size_t cut = 0; cut < length; cut += 37) {
        KEPT_TEXT(part) = strndup(good, cut);
        put_file(path, part);
        session_file file;
        fault f = {0};
        if (session_file_read(&file, path, &f) == STATUS_OK) {
            session_file_finish(&file);
        } else {
            assert_true(f.text[0] != '\0');
        }
    }
}

// Four runs are pinned, as many as there is room for: a session with four more pins is
// refused, and nothing changes.
TEST(test_pins_without_room_are_refused)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    for (int i = 0; i < 4; i++) {
        press_text(&ex, ":set arm.k2 %d<Enter>b", 4 + i);
    }
    save(&ex);

    // saving without a name proposes a file and waits
    press(&ex, ":session save<Enter>"); // proposes the visit's own file
    assert_true(ex.input.prompt.open);
    press(&ex, "<Esc>");
    assert_false(explorer_open_session(&ex.model, &ex.view, &ex.input, path));
    assert_shows(&ex, "have no room");
    assert_int_equal(ex.model.pinned.count, 4);
}

ALL_BETWEEN(enter_folder, leave_folder)
