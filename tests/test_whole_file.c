#include "src/base/whole_file.h"

#include <dirent.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>

#include "tests/check.h"

// Number of files in the test's folder.
static int files(void)
{
    int count = 0;
    DIR *d = opendir(".");
    assert_non_null(d);
    for (struct dirent *e = readdir(d); e != NULL; e = readdir(d)) {
        count += e->d_name[0] != '.' || strlen(e->d_name) > 2;
    }
    closedir(d);
    return count;
}

// A file that can be begun, with this in it.
static void begin(whole_file *w, const char *path, const char *text)
{
    DONE(whole_file_open(w, path, &f));
    fputs(text, w->stream);
}

TEST_IN_FOLDER(appears_only_when_committed)
{
    put_file("old", "old");
    whole_file w;
    begin(&w, "old", "new");
    fflush(w.stream);
    assert_holds("old", "old");
    DONE(whole_file_commit(&w, &f));
    assert_holds("old", "new");
    assert_int_equal(files(), 1);
}

TEST_IN_FOLDER(abandoning_leaves_the_target_and_nothing_else)
{
    put_file("old", "old");
    whole_file w;
    begin(&w, "old", "new");
    whole_file_abandon(&w);
    assert_holds("old", "old");
    assert_int_equal(files(), 1);
}

static mode_t mode_of(const char *path)
{
    struct stat about;
    assert_int_equal(stat(path, &about), 0);
    return about.st_mode & 07777;
}

static status try_new(const char *path, fault *f)
{
    whole_file w;
    const status code = whole_file_open(&w, path, f);
    if (code != STATUS_OK) {
        return code;
    }
    fputs("new", w.stream);
    return whole_file_commit(&w, f);
}

static void write_new(const char *path)
{
    DONE(try_new(path, &f));
}

TEST_IN_FOLDER(mode_follows_the_umask_or_the_old_file)
{
    mode_t before = umask(027);
    write_new("fresh");
    assert_int_equal(mode_of("fresh"), 0640);
    chmod("fresh", 0604);
    write_new("fresh");
    assert_int_equal(mode_of("fresh"), 0604);
    umask(before);
}

static bool is_link(const char *path)
{
    struct stat about;
    assert_int_equal(lstat(path, &about), 0);
    return S_ISLNK(about.st_mode);
}

TEST_IN_FOLDER(a_link_to_a_file_stays_a_link)
{
    put_file("target", "old");
    assert_int_equal(symlink("target", "link"), 0);
    write_new("link");
    assert_true(is_link("link"));
    assert_holds("target", "new");
}

// Whoever left the link does not choose where a file begins.
TEST_IN_FOLDER(a_link_to_nothing_becomes_the_file)
{
    assert_int_equal(symlink("later", "link"), 0);
    write_new("link");
    assert_false(is_link("link"));
    assert_holds("link", "new");
    assert_int_equal(files(), 1);
}

// A run that was killed left its temporary, and another one of the same number writes.
TEST_IN_FOLDER(a_temporary_of_a_killed_run_is_left_alone)
{
    whole_file w;
    begin(&w, "first", "new");
    int number;
    assert_int_equal(sscanf(strrchr(w.temporary, '-'), "-%d", &number), 1);
    const char *left = formatted(".impactlab-%ld-%d.part", (long)getpid(), number + 1);
    put_file(left, "left");
    DONE(whole_file_commit(&w, &f));
    write_new("second");
    assert_holds(left, "left");
    assert_holds("second", "new");
    unlink(left);
}

TEST_IN_FOLDER(two_ways_to_one_place_are_told)
{
    assert_int_equal(mkdir("folder", 0777), 0);
    put_file("there", "");
    assert_int_equal(symlink("there", "link"), 0);
    assert_true(whole_file_same_place("later", "./folder/../later"));
    assert_true(whole_file_same_place("there", "link"));
    assert_true(whole_file_same_place("-", "-"));
    assert_false(whole_file_same_place("later", "folder/later"));
    assert_false(whole_file_same_place("later", "there"));
    assert_false(whole_file_same_place("-", "there"));
}

TEST_IN_FOLDER(a_full_device_is_reported_and_stays_a_device)
{
    struct stat about;
    REFUSED(STATUS_CANNOT_WRITE, "/dev/full", try_new("/dev/full", &f));
    REFUSED(STATUS_CANNOT_WRITE, "No space left", try_new("/dev/full", &f));
    assert_int_equal(stat("/dev/full", &about), 0);
    assert_true(S_ISCHR(about.st_mode));
}

// Carries out one write to the standard output, which leads to `path` meanwhile.
static status write_to_output(const char *path, fault *f)
{
    fflush(stdout);
    const int kept = dup(STDOUT_FILENO), there = open(path, O_WRONLY | O_CREAT, 0600);
    assert_true(kept >= 0 && there >= 0);
    assert_int_equal(dup2(there, STDOUT_FILENO), STDOUT_FILENO);
    close(there);

    // nothing may fail before the output is itself again
    const status code = try_new("-", f);
    clearerr(stdout);
    dup2(kept, STDOUT_FILENO);
    close(kept);
    return code;
}

TEST_IN_FOLDER(the_standard_output_is_written_or_said_to_be_full)
{
    DONE(write_to_output("output", &f));
    assert_holds("output", "new");
    REFUSED(STATUS_CANNOT_WRITE, "standard output", write_to_output("/dev/full", &f));
    REFUSED(STATUS_CANNOT_WRITE, strerror(ENOSPC), write_to_output("/dev/full", &f));
}

TEST_IN_FOLDER(what_cannot_be_written_is_said_beforehand)
{
    put_file("file", "");
    for (EACH_TEXT(c, "nowhere/file", ".", "", "nothing/")) {
        whole_file w;
        REFUSED(STATUS_CANNOT_WRITE, *c, whole_file_check(*c, &f));
        REFUSED(STATUS_CANNOT_WRITE, "", whole_file_open(&w, *c, &f));
    }
    assert_int_equal(whole_file_check("file/below", NULL), STATUS_CANNOT_WRITE);
    assert_int_equal(whole_file_check("new", NULL), STATUS_OK);
    assert_int_equal(whole_file_check("-", NULL), STATUS_OK);
    assert_int_equal(files(), 1);
}

TEST_IN_FOLDER(a_reader_that_left_is_told_from_a_full_disk)
{
    int ends[2];
    assert_int_equal(pipe(ends), 0);
    close(ends[0]);
    FILE *stream = fdopen(ends[1], "w");
    assert_non_null(stream);
    signal(SIGPIPE, SIG_IGN);
    // the failing write lies far behind the last one
    for (int i = 0; i < 100000; i++) {
        fputc('x', stream);
    }
    assert_int_equal(stream_failure(stream), EPIPE);
    fclose(stream);
}

// Who reads the standard output may leave when he has enough; of any other pipe it is a
// failure.
TEST_IN_FOLDER(only_the_reader_of_the_standard_output_may_leave)
{
    int ends[2];
    fault f = {0};
    signal(SIGPIPE, SIG_IGN);
    assert_int_equal(pipe(ends), 0);
    close(ends[0]);
    fflush(stdout);
    const int output = dup(1);
    dup2(ends[1], 1);
    const status written = try_new("-", &f);
    dup2(output, 1);
    close(output);
    clearerr(stdout);
    assert_int_equal(written, STATUS_OK);

    close(ends[1]);
    assert_int_equal(mkfifo("pipe", 0600), 0);
    const int reader = open("pipe", O_RDONLY | O_NONBLOCK);
    assert_true(reader >= 0);
    whole_file w;
    begin(&w, "pipe", "text");
    close(reader);
    assert_int_equal(whole_file_commit(&w, &f), STATUS_CANNOT_WRITE);
}

// A write that failed at once leaves nothing to be flushed, and is still a failure.
TEST_IN_FOLDER(a_failure_before_the_last_flush_is_one)
{
    FILE *stream = fopen("/dev/full", "w");
    assert_non_null(stream);
    setvbuf(stream, NULL, _IONBF, 0);
    fputc('x', stream);
    assert_int_equal(fflush(stream), 0);
    assert_int_equal(stream_failure(stream), EIO);
    fclose(stream);
}

// The stream loses the reason of an earlier failed write; it is still reported when the
// file is closed.
TEST_IN_FOLDER(why_a_write_failed_is_known_at_the_end)
{
    struct rlimit before;
    fault f = {0};
    put_file("kept", "old");
    signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before);
    const struct rlimit small = {.rlim_cur = 100000, .rlim_max = before.rlim_max};
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);

    // one large write fails, small ones follow
    static const char block[400000];
    whole_file file;
    begin(&file, "kept", "");
    fwrite(block, 1, sizeof block, file.stream);
    clearerr(file.stream);
    fputc('x', file.stream);
    assert_int_equal(whole_file_commit(&file, &f), STATUS_CANNOT_WRITE);
    setrlimit(RLIMIT_FSIZE, &before);
    assert_non_null(strstr(f.text, strerror(EFBIG)));
    assert_holds("kept", "old");
}

// More at once than are recorded for a signal: each is still complete.
TEST_IN_FOLDER(several_files_are_written_at_once)
{
    enum { FILES = 12 };
    const int before = files();
    whole_file all[FILES];
    const char *name[FILES];
    for (int i = 0; i < FILES; i++) {
        name[i] = formatted("file-%d", i);
        begin(&all[i], name[i], name[i]);
    }
    for (int i = 0; i < FILES; i++) {
        DONE(whole_file_commit(&all[i], &f));
        assert_holds(name[i], name[i]);
        unlink(name[i]);
    }
    assert_int_equal(files(), before);
}

// Called by a signal handler: no unfinished file stays, and former files do.
TEST_IN_FOLDER(a_signal_leaves_no_temporaries)
{
    const int before = files();
    put_file("one", "old");
    whole_file one, two;
    begin(&one, "one", "");
    begin(&two, "two", "");
    assert_int_equal(files(), before + 3);

    whole_file_remove_unfinished();
    assert_int_equal(files(), before + 1);
    assert_holds("one", "old");
    whole_file_abandon(&one);
    whole_file_abandon(&two);
}

// Something else took the place of the target meanwhile.
TEST_IN_FOLDER(what_cannot_be_renamed_goes)
{
    const int before = files();
    whole_file w;
    begin(&w, "place", "new");
    assert_int_equal(mkdir("place", 0700), 0);
    REFUSED(STATUS_CANNOT_WRITE, "'place' cannot be written", whole_file_commit(&w, &f));
    assert_int_equal(rmdir("place"), 0);
    assert_int_equal(files(), before);
}

TEST_IN_FOLDER(devices_and_the_standard_output_can_be_abandoned)
{
    struct stat about;
    whole_file w;
    for (EACH_TEXT(c, "/dev/null", "-")) {
        begin(&w, *c, "");
        whole_file_abandon(&w);
    }
    assert_int_equal(stat("/dev/null", &about), 0);
    assert_true(S_ISCHR(about.st_mode));
    begin(&w, "-", "");
    assert_int_equal(whole_file_close(&w, STATUS_STOPPED, NULL), STATUS_STOPPED);
    begin(&w, "closed", "whole");
    assert_int_equal(whole_file_close(&w, STATUS_OK, NULL), STATUS_OK);
    assert_holds("closed", "whole");
}

TEST_IN_FOLDER(a_link_may_be_absolute)
{
    put_file("target", "old");
    assert_int_equal(mkdir("below", 0700), 0);
    assert_int_equal(symlink(formatted("%s/target", test_folder), "below/link"), 0);
    write_new("below/link");
    assert_holds("target", "new");
}

TEST_IN_FOLDER(a_link_to_itself_leads_nowhere)
{
    whole_file w;
    assert_int_equal(symlink("itself", "itself"), 0);
    REFUSED(STATUS_CANNOT_WRITE, "", whole_file_check("itself", &f));
    REFUSED(STATUS_CANNOT_WRITE, "", whole_file_open(&w, "itself", &f));
}

// A program that was started without a standard input has its number for the next file,
// which is written all the same, whole or in its place.
TEST_IN_FOLDER(a_file_may_have_the_number_of_the_standard_input)
{
    const int input = dup(STDIN_FILENO);
    for (EACH_TEXT(c, "numbered-0", "/dev/null")) {
        whole_file w;
        fault f = {0};
        close(STDIN_FILENO);
        const status opened = whole_file_open(&w, *c, &f);
        const bool is_0 = opened == STATUS_OK && fcntl(STDIN_FILENO, F_GETFD) >= 0;
        fputs("whole", opened == STATUS_OK ? w.stream : stderr);
        const status written = opened == STATUS_OK ? whole_file_commit(&w, &f) : opened;
        dup2(input, STDIN_FILENO);
        assert_int_equal(written, STATUS_OK);
        assert_true(is_0);
    }
    close(input);
    assert_holds("numbered-0", "whole");
    assert_int_equal(files(), 1);
}

ALL_IN_TWO_MINUTES
