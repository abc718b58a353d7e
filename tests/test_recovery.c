// Recovery: what a user has done in a lab is kept in a file of its own, which outlives
// every end of the lab but the one that the user asks for. The next lab offers to go on
// with it.
#include "tests/explorer_on_screen.h"

#include <dirent.h>
#include <signal.h>
#include <sys/resource.h>

#include "src/session/session_file.h"

// Opens a lab whose recovery file is below the test's folder.
static void open_watched(explorer *ex)
{
    assert_int_equal(setenv("XDG_STATE_HOME", test_folder, 1), 0);
    open_changed(ex, "corrected/first-impact", "", HUGE_VAL);
}

static void open_that_offers_nothing(explorer *ex)
{
    open_watched(ex);
    assert_false(recovery_begin(ex));
}

// Opens a lab that has found the recovery file of another one and offers to go on with
// it.
static void open_that_offers(explorer *ex)
{
    open_watched(ex);
    assert_true(recovery_begin(ex));
}

// Lets the lab write its recovery file as at the instant `now` [s], and waits for it.
static void keep_at(explorer *ex, double now)
{
    const bool changed = true, unchanged = false;
    recovery_keep(ex, changed, now);
    while (ex->recovery.writes) {
        usleep(1000);
        recovery_keep(ex, unchanged, now);
    }
}

// How many entries of the folder of recovery files begin with this word.
static int files_called(const char *prefix)
{
    int count = 0;
    DIR *folder = opendir(formatted("%s/impactlab", test_folder));
    assert_non_null(folder);
    for (const struct dirent *e; (e = readdir(folder)) != NULL;) {
        if (strncmp(e->d_name, prefix, strlen(prefix)) == 0) {
            count++;
        }
    }
    closedir(folder);
    return count;
}

// How many changes a recovery file holds. It can be read, so it is whole.
static int changes_in(const char *path)
{
    SCOPED(session_file_finish) session_file file;
    DONE(session_file_read(&file, path, &f));
    return file.runs[0].from.input_count;
}

TEST_IN_FOLDER(what_was_done_is_offered_and_comes_back)
{
    const bool changed = true, unchanged = false, asked_for = true, unasked = false;
    SCOPED(explorer_finish) explorer lab, next;

    // a lab in which nothing was done has nothing to lose and writes no file
    open_that_offers_nothing(&lab);
    keep_at(&lab, 0);
    assert_int_equal(files_called("rec"), 0);

    // after two changes, a pinned run and a note the file is what a saved session would
    // be
    press(&lab, "b:set arm.k2 5<Enter>:note hard<Enter>:seek 0.4<Enter>:set "
                "motor.voltage 2<Enter>");
    keep_at(&lab, 1);
    press(&lab, ":session save by-hand.session<Enter>");
    KEPT_TEXT(by_hand) = file_text("by-hand.session");
    assert_holds(lab.recovery.path, by_hand);

    // a third change 0.25 s after the file was written waits for the second to be over;
    // it is written then without another key
    press(&lab, ":set motor.voltage 3<Enter>");
    check_close(recovery_keep(&lab, changed, 1.25), 0.75, 1e-15);
    assert_holds(lab.recovery.path, by_hand);
    while (recovery_keep(&lab, unchanged, 2) < HUGE_VAL) {
        usleep(1000);
    }
    assert_int_equal(changes_in(lab.recovery.path), 3);

    // the lab ends unasked, just after a fourth change
    press(&lab, ":set arm.k2 6<Enter>");
    recovery_keep(&lab, changed, 2.1);
    recovery_end(&lab, unasked);

    // the next lab offers all of it, the fourth change too, and goes on in the same file
    open_that_offers(&next);
    assert_shows_at(&next, 80, 24, "y goes on");
    press(&next, "y");
    fail_if(next.input.message.warning, "%s", next.input.message.text);
    assert_same_trace(&next.model.session.run.trace, &lab.model.session.run.trace);
    assert_int_equal(next.model.pinned.count, 1);
    assert_int_equal(next.model.note_count, 1);
    assert_string_equal(next.recovery.path, lab.recovery.path);

    // what came back is not saved: q does not quit, and a name is asked for
    press_quits(&next, "q", false);
    press_prompts(&next, ":session save<Enter>", "session save lab.session");

    // the user ends the lab, and the file is removed: the folder has only . and .. left
    recovery_end(&next, asked_for);
    assert_int_equal(files_called(""), 2);
}

TEST_IN_FOLDER(no_lab_takes_the_file_of_another)
{
    const bool asked_for = true, unasked = false;
    SCOPED(explorer_finish) explorer first, second, third;

    // the file of a lab that runs is offered to no other lab
    open_that_offers_nothing(&first);
    press(&first, ":set arm.k2 5<Enter>");
    keep_at(&first, 0);
    open_that_offers_nothing(&second);
    press(&first, ":set arm.k2 6<Enter>");
    keep_at(&first, 1);
    open_that_offers_nothing(&third);

    // once the first lab has ended unasked, only one of two labs offers its file
    recovery_end(&first, unasked);
    recovery_end(&second, asked_for);
    explorer_finish(&second);
    open_that_offers(&second);
    assert_false(recovery_begin(&third));

    // a key that is no answer ends the offer, and another lab may make it
    press(&second, "<Left>");
    assert_true(recovery_begin(&third));

    // n declines it: the file stays under another name and is not offered again
    press_shows(&third, "n", "goes on with it");
    assert_int_equal(files_called("rec"), 0);
    assert_int_equal(files_called("declined-"), 1);
    assert_false(recovery_begin(&second));
}

// When the recovery file cannot be written the lab says so in one sentence and works on.
// A file that was written before stays.
TEST_IN_FOLDER(a_file_that_cannot_be_written_is_told_once)
{
    SCOPED(explorer_finish) explorer ex, nowhere;
    open_that_offers_nothing(&ex);
    press(&ex, ":set arm.k2 5<Enter>");
    keep_at(&ex, 0);

    // no file may be larger than 100 bytes, as on a full disk: that is said
    signal(SIGXFSZ, SIG_IGN);
    const struct rlimit full = {100, RLIM_INFINITY},
                        room = {RLIM_INFINITY, RLIM_INFINITY};
    setrlimit(RLIMIT_FSIZE, &full);
    press(&ex, ":set arm.k2 6<Enter>");
    keep_at(&ex, 1);
    assert_shows(&ex, "would not outlive a crash", "File too large");

    // the same failure after the next change is not said again
    press(&ex, ":set arm.k2 7<Enter>");
    keep_at(&ex, 2);
    assert_shows(&ex, "!would not outlive");

    // the file still holds the first change, and all of them when there is room again
    setrlimit(RLIMIT_FSIZE, &room);
    assert_int_equal(changes_in(ex.recovery.path), 1);
    keep_at(&ex, 3);
    assert_int_equal(changes_in(ex.recovery.path), 3);

    // a folder that cannot be made is said with the file's name
    setenv("XDG_STATE_HOME", "/proc/none", 1);
    open_changed(&nowhere, "corrected/first-impact", "", HUGE_VAL);
    assert_false(recovery_begin(&nowhere));
    press(&nowhere, ":set arm.k2 5<Enter>");
    keep_at(&nowhere, 0);
    assert_shows(&nowhere, "would not outlive a crash", "/proc/none/impactlab/recovery-");
}

// A lab that makes one change after another without end, and sends a byte through the
// pipe after each change that its recovery file holds.
static void make_changes(int pipe)
{
    SCOPED(explorer_finish) explorer ex;
    open_that_offers_nothing(&ex);
    for (int i = 0;; i++) {
        press_text(&ex, ":set arm.k2 %d<Enter>", 4 + i % 5);
        keep_at(&ex, i);
        assert_int_equal(write(pipe, "", 1), 1);
    }
}

// The lab above in a process of its own, with the default action of each of these
// signals. Returns the end of the pipe to read from.
static int start_lab(pid_t *lab, const int *signals, int count)
{
    int ends[2];
    assert_int_equal(pipe(ends), 0);
    *lab = fork();
    if (*lab == 0) {
        // a crash is meant here: it leaves no core file
        setrlimit(RLIMIT_CORE, &(struct rlimit){0, 0});
        for (int i = 0; i < count; i++) {
            signal(signals[i], SIG_DFL);
        }
        close(ends[0]);
        make_changes(ends[1]);
    }
    close(ends[1]);
    return ends[0];
}

// A lab that is killed at any instant of its writing leaves a whole file with every
// change that it reported. The file may hold one more, which it had no time to report.
TEST_IN_FOLDER(whatever_ends_it_the_file_is_whole)
{
    enum { KILLED_LABS = 25, SIGNALS = 5 };
    static const int signals[SIGNALS] = {SIGKILL, SIGHUP, SIGABRT, SIGSEGV, SIGTERM};
    random_generator random = seeded(1);
    for (int n = 0; n < KILLED_LABS; n++) {
        pid_t lab;
        const int reports = start_lab(&lab, signals, SIGNALS);

        // after one to four reports and up to 8 ms the lab is killed
        char byte;
        int reported = 0;
        while (reported < 1 + n % 4) {
            assert_int_equal(read(reports, &byte, 1), 1);
            reported++;
        }
        usleep((useconds_t)evenly(&random, 0, 8000));
        kill(lab, signals[n % SIGNALS]);
        assert_int_equal(waitpid(lab, NULL, 0), lab);

        // reports it made meanwhile
        while (read(reports, &byte, 1) == 1) {
            reported++;
        }
        close(reports);

        // the next lab is offered the file
        SCOPED(explorer_finish) explorer next;
        open_that_offers(&next);
        const int changes = changes_in(next.recovery.left);
        fail_if(changes != reported && changes != reported + 1, "%d of %d changes",
                changes, reported);
        press(&next, "y");
        assert_int_equal(next.model.session.input_count, changes);

        // and removes it when its user ends it
        const bool asked_for = true;
        recovery_end(&next, asked_for);
        assert_int_equal(files_called("rec"), 0);
    }

    // a lab that was killed while it wrote leaves a temporary file
    assert_int_equal(system(
                         formatted("rm -f %s/impactlab/.impactlab-*.part", test_folder)),
                     0);
}

// What a lab would write as a session, to be freed.
static char *session_text(explorer *ex)
{
    fault f = {0};
    WRITTEN(text,
            assert_int_equal(explorer_write_session(&ex->model, &ex->view, stream, &f),
                             STATUS_OK));
    return text;
}

// Whatever was done, after each of 50 actions the recovery file brings all of it back:
// what the next lab would write is what this one did.
TEST_IN_FOLDER(everything_comes_back_at_fifty_instants)
{
    enum { INSTANTS = 50 };
    static const char *const actions[] = {
        ":set motor.voltage %d<Enter>",
        ":note @0.%d something<Enter>",
        ":mark 0.%d<Enter>",
        ":limit force %d<Enter>",
        "b:band force 0.%d<Enter>",
        ":data bench.csv<Enter>",
        ":data bench.csv@0.%d<Enter>",
        ":residual force<Enter>",
        ":phase force gap<Enter>",
        ":trace force - %d*voltage<Enter>",
        ":panes 1%d<Enter>",
        ":zoom 0.1 0.%d<Enter>",
        ":pin number %d<Enter>",
        ":sweep arm.k2=4:6:3<Enter>",
        ":metric contact_impulse_Ns<Enter>",
        ":axis 0 %d 1<Enter>",
        ":open compare/hybrid<Enter>",
        "u",
    };
    enum { ACTIONS = sizeof actions / sizeof actions[0] };
    put_file("bench.csv", "time[s],force[N]\n0,0\n0.2,0\n0.25,1\n0.3,0.5\n0.4,0.1\n");
    random_generator random = seeded(3);
    SCOPED(explorer_finish) explorer lab;
    open_that_offers_nothing(&lab);
    for (int i = 0; i < INSTANTS; i++) {
        const char *doing = actions[(int)evenly(&random, 0, ACTIONS - 1e-9)];
        if (lab.model.pinned.count == PINNED_RUNS) {
            press(&lab, "Rd<Esc>");
        }
        press(&lab, formatted(doing, 2 + (int)evenly(&random, 0, 7)));
        free(picture(&lab, 120, 40, GLYPHS_BRAILLE));
        keep_at(&lab, i);
        KEPT_TEXT(kept) = session_text(&lab);
        if (!explorer_has_work(&lab.model, &lab.view)) {
            continue;
        }
        KEPT_TEXT(file) = file_text(lab.recovery.path);
        assert_string_equal(file, kept);

        // the next lab stands where this one does
        SCOPED(explorer_finish) explorer next;
        open_changed(&next, "corrected/first-impact", "", HUGE_VAL);
        put_file("left.session", file);
        assert_true(
            explorer_open_session(&next.model, &next.view, &next.input, "left.session"));
        fail_if(next.input.message.warning, "after %s: %s", doing,
                next.input.message.text);
        free(picture(&next, 120, 40, GLYPHS_BRAILLE));
        KEPT_TEXT(again) = session_text(&next);
        assert_string_equal(again, kept);
        assert_int_equal(next.model.measured.row_count, lab.model.measured.row_count);
        assert_int_equal(next.model.sweep.count, lab.model.sweep.count);
    }
}

// Data that were changed since are told.
TEST_IN_FOLDER(changed_data_are_told)
{
    SCOPED(explorer_finish) explorer lab, next;
    open_that_offers_nothing(&lab);
    put_file("bench.csv", "time[s],force[N]\n0,0\n0.2,0\n0.25,1\n0.3,0.5\n");
    press(&lab, ":data bench.csv<Enter>:session save a.session<Enter>");
    put_file("bench.csv", "time[s],force[N]\n0,0\n0.2,0\n0.25,2\n0.3,0.5\n");
    open_changed(&next, "corrected/first-impact", "", HUGE_VAL);
    press_warns(&next, ":session open a.session<Enter>", "have changed");
    assert_int_equal(next.model.measured.row_count, 4);

    // and read again
    put_file("bench.csv", "time[s],force[N]\n0,0\n0.2,0\n0.25,3\n0.3,0.5\n0.4,0\n");
    press(&next, ":reload<Enter>");
    assert_int_equal(next.model.measured.row_count, 5);
    check_close(next.model.measured.rows[2].force, 3, 0);
}
