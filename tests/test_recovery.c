// What is done in a lab outlives every end but the one that is asked for, and is offered
// once more.
#include "tests/explorer_on_screen.h"

#include <dirent.h>
#include <signal.h>
#include <sys/resource.h>

#include "src/session/session_file.h"

// Sets where the files go, and opens a lab that keeps its own there.
static void open_watched(explorer *ex, bool offers)
{
    assert_int_equal(setenv("XDG_STATE_HOME", test_folder, 1), 0);
    open_changed(ex, "corrected/first-impact", "", HUGE_VAL);
    assert_int_equal(recovery_begin(ex), offers);
}

// Lets it write what has changed, at an instant of which the caller says when it is [s].
static void keep(explorer *ex, double now)
{
    recovery_keep(ex, true, now);
    while (ex->recovery.writes) {
        usleep(1000);
        recovery_keep(ex, false, now);
    }
}

// How many files begin with a word where they are.
static int files_called(const char *prefix)
{
    int count = 0;
    DIR *folder = opendir(formatted("%s/impactlab", test_folder));
    assert_non_null(folder);
    for (const struct dirent *e; (e = readdir(folder)) != NULL;) {
        count += strncmp(e->d_name, prefix, strlen(prefix)) == 0;
    }
    closedir(folder);
    return count;
}

// How many changes a recovery file has; it is whole.
static int changes_in(const char *path)
{
    SCOPED(session_file_finish) session_file file;
    DONE(session_file_read(&file, path, &f));
    return file.runs[0].from.input_count;
}

TEST_IN_FOLDER(what_was_done_is_offered_and_comes_back)
{
    SCOPED(explorer_finish) explorer ex, next;
    open_watched(&ex, false);
    keep(&ex, 0);
    assert_int_equal(files_called("rec"), 0); // nothing would be lost
    press(&ex, "b:set arm.k2 5<Enter>:note hard<Enter>:seek 0.4<Enter>:set motor.voltage "
               "2<Enter>");
    keep(&ex, 1);
    press(&ex, ":session save as-told.session<Enter>");
    KEPT_TEXT(told) = file_text("as-told.session");
    assert_holds(ex.recovery.path, told);

    // not more than once a second, but then without another key
    press(&ex, ":set motor.voltage 3<Enter>");
    check_close(recovery_keep(&ex, true, 1.25), 0.75, 1e-15);
    assert_holds(ex.recovery.path, told);
    while (recovery_keep(&ex, false, 2) < HUGE_VAL) {
        usleep(1000);
    }
    assert_int_equal(changes_in(ex.recovery.path), 3);

    // it ends, what was changed last is in it, and the next one takes it over as its own
    press(&ex, ":set arm.k2 6<Enter>");
    recovery_keep(&ex, true, 2.1);
    recovery_end(&ex, false);
    open_watched(&next, true);
    assert_shows_at(&next, 80, 24, "y goes on");
    press(&next, "y");
    fail_if(next.input.message.warning, "%s", next.input.message.text);
    assert_same_trace(&next.model.session.run.trace, &ex.model.session.run.trace);
    assert_int_equal(next.model.pinned.count, 1);
    assert_int_equal(next.model.note_count, 1);
    assert_string_equal(next.recovery.path, ex.recovery.path);
    press_quits(&next, "q", false); // it is not saved
    press_prompts(&next, ":session save<Enter>", "session save lab.session");
    recovery_end(&next, true);
    assert_int_equal(files_called(""), 2); // . and ..
}

TEST_IN_FOLDER(no_lab_takes_the_file_of_another)
{
    SCOPED(explorer_finish) explorer first, second, third;
    open_watched(&first, false);
    press(&first, ":set arm.k2 5<Enter>");
    keep(&first, 0);
    open_watched(&second, false);
    press(&first, ":set arm.k2 6<Enter>");
    keep(&first, 1);
    open_watched(&third, false);
    recovery_end(&first, false);

    // of two that start one offers it; declined by another key it is offered again, by n
    // it is kept
    recovery_end(&second, true);
    explorer_finish(&second);
    open_watched(&second, true);
    assert_false(recovery_begin(&third));
    press(&second, "<Left>");
    assert_true(recovery_begin(&third));
    press_shows(&third, "n", "goes on with it");
    assert_int_equal(files_called("rec"), 0);
    assert_int_equal(files_called("declined-"), 1);
    assert_false(recovery_begin(&second));
}

// One sentence says that nothing can be kept; the lab works on, and a file that is there
// stays.
TEST_IN_FOLDER(a_file_that_cannot_be_written_is_told_once)
{
    SCOPED(explorer_finish) explorer ex, nowhere;
    open_watched(&ex, false);
    press(&ex, ":set arm.k2 5<Enter>");
    keep(&ex, 0);
    signal(SIGXFSZ, SIG_IGN);
    const struct rlimit full = {100, RLIM_INFINITY},
                        room = {RLIM_INFINITY, RLIM_INFINITY};
    setrlimit(RLIMIT_FSIZE, &full);
    press(&ex, ":set arm.k2 6<Enter>");
    keep(&ex, 1);
    assert_shows(&ex, "would not outlive a crash", "File too large");
    press(&ex, ":set arm.k2 7<Enter>");
    keep(&ex, 2);
    assert_shows(&ex, "!would not outlive");
    setrlimit(RLIMIT_FSIZE, &room);
    assert_int_equal(changes_in(ex.recovery.path), 1);
    keep(&ex, 3);
    assert_int_equal(changes_in(ex.recovery.path), 3);

    setenv("XDG_STATE_HOME", "/proc/none", 1);
    open_changed(&nowhere, "corrected/first-impact", "", HUGE_VAL);
    assert_false(recovery_begin(&nowhere));
    press(&nowhere, ":set arm.k2 5<Enter>");
    keep(&nowhere, 0);
    assert_shows(&nowhere, "would not outlive a crash", "/proc/none/impactlab/recovery-");
}

// A lab that makes one change after another, and tells each that was written.
static void change_and_tell(int pipe)
{
    SCOPED(explorer_finish) explorer ex;
    open_watched(&ex, false);
    for (int i = 0;; i++) {
        press_text(&ex, ":set arm.k2 %d<Enter>", 4 + i % 5);
        keep(&ex, i);
        assert_int_equal(write(pipe, "", 1), 1);
    }
}

// Killed at whatever instant of the writing it has all that was written before, and is
// whole.
TEST_IN_FOLDER(whatever_ends_it_the_file_is_whole)
{
    static const int signals[] = {SIGKILL, SIGHUP, SIGABRT, SIGSEGV, SIGTERM};
    random_generator random = seeded(1);
    for (int n = 0; n < 25; n++) {
        int ends[2];
        char told;
        assert_int_equal(pipe(ends), 0);
        const pid_t lab = fork();
        if (lab == 0) {
            setrlimit(RLIMIT_CORE, &(struct rlimit){0, 0});
            for (size_t i = 0; i < sizeof signals / sizeof *signals; i++) {
                signal(signals[i], SIG_DFL);
            }
            close(ends[0]);
            change_and_tell(ends[1]);
        }
        close(ends[1]);
        const int wanted = 1 + n % 4;
        for (int i = 0; i < wanted; i++) {
            assert_int_equal(read(ends[0], &told, 1), 1);
        }
        usleep((useconds_t)evenly(&random, 0, 8000));
        kill(lab, signals[n % 5]);
        assert_int_equal(waitpid(lab, NULL, 0), lab);
        int written = wanted;
        while (read(ends[0], &told, 1) == 1) {
            written++;
        }
        close(ends[0]);

        // offered to the next one, and with it removed
        SCOPED(explorer_finish) explorer next;
        open_watched(&next, true);
        const int changes = changes_in(next.recovery.left);
        fail_if(changes != written && changes != written + 1, "%d of %d changes", changes,
                written);
        press(&next, "y");
        assert_int_equal(next.model.session.input_count, changes);
        recovery_end(&next, true);
        assert_int_equal(files_called("rec"), 0);
    }

    // one that was killed while it wrote leaves what it had written until then
    assert_int_equal(system(
                         formatted("rm -f %s/impactlab/.impactlab-*.part", test_folder)),
                     0);
}
