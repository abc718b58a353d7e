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

static bool is_there(const char *path)
{
    return access(path, F_OK) == 0;
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

// Also one to what is not there yet.
TEST_IN_FOLDER(a_link_stays_a_link_and_leads_to_the_new_file)
{
    struct stat about;
    put_file("target", "old");
    for (EACH_TEXT(c, "target", "later")) {
        assert_int_equal(symlink(*c, "link"), 0);
        write_new("link");
        assert_int_equal(lstat("link", &about), 0);
        assert_true(S_ISLNK(about.st_mode));
        assert_holds(*c, "new");
        unlink("link");
    }
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

// A run that was killed leaves its temporary; the next one removes it, but none of a run
// that lives.
TEST_IN_FOLDER(what_killed_runs_left_goes)
{
    int told[2];
    char byte;
    assert_int_equal(mkdir("folder", 0777), 0);
    assert_int_equal(pipe(told), 0);
    put_file("folder/.impactlab-notes.part", "no temporary of ours");
    put_file("folder/.impactlab-1-2.part.txt", "neither");
    put_file("folder/.impactlab-999999-0.part", "left by nobody");
    assert_int_equal(mkfifo("folder/.impactlab-1-7.part", 0600), 0);

    // another process writes into it
    pid_t other = fork();
    if (other == 0) {
        whole_file file;
        _exit(whole_file_open(&file, "folder/other", NULL) != STATUS_OK ||
              write(told[1], "x", 1) != 1 || pause() == 0);
    }
    assert_int_equal(read(told[0], &byte, 1), 1);
    const char *living = formatted("folder/.impactlab-%ld-0.part", (long)other);
    whole_file mine;
    begin(&mine, "folder/mine", "");
    whole_file_abandon(&mine);
    assert_true(is_there(living));
    assert_false(is_there("folder/.impactlab-999999-0.part"));

    // killed: what it left goes with the next file in the folder
    kill(other, SIGKILL);
    waitpid(other, NULL, 0);
    for (EACH_TEXT(c, "elsewhere", "folder/mine")) {
        assert_true(is_there(living));
        begin(&mine, *c, "");
        whole_file_abandon(&mine);
    }
    assert_false(is_there(living));
    for (EACH_TEXT(c, "folder/.impactlab-notes.part", "folder/.impactlab-1-2.part.txt",
                   "folder/.impactlab-1-7.part")) {
        assert_int_equal(unlink(*c), 0);
    }
    close(told[0]);
    close(told[1]);
}

// A run in another process that opens a file at that moment looks for what killed ones
// left.
static bool cleans_before_rename;
static struct rlimit descriptors;
int rename(const char *from, const char *to)
{
    if (cleans_before_rename) {
        setrlimit(RLIMIT_NOFILE, &descriptors);
        whole_file_clean_folder(".");
    }
    return renameat(AT_FDCWD, from, AT_FDCWD, to);
}

// Until a file has its name its temporary is nobody's to remove, be there descriptors
// left or not.
TEST_IN_FOLDER(a_temporary_is_locked_until_it_has_its_name)
{
    whole_file w;
    begin(&w, "new", "new");
    assert_int_equal(getrlimit(RLIMIT_NOFILE, &descriptors), 0);
    const struct rlimit none = {(rlim_t)w.descriptor + 1, descriptors.rlim_max};
    assert_int_equal(setrlimit(RLIMIT_NOFILE, &none), 0);
    cleans_before_rename = true;
    const bool committed = whole_file_commit(&w, NULL) == STATUS_OK;
    cleans_before_rename = false;
    assert_true(committed);
    assert_holds("new", "new");
}

// In a folder like /tmp a link of somebody else's leads nowhere, as the kernel has it.
TEST_IN_FOLDER(a_strangers_link_is_not_followed)
{
    assert_int_equal(mkdir("shared", 0777), 0);
    assert_int_equal(chmod("shared", 01777), 0);
    assert_int_equal(symlink("../target", "shared/link"), 0);
    whole_file file;
    begin(&file, "shared/link", "");
    whole_file_abandon(&file);

    // only root can make a link somebody else's
    if (geteuid() == 0) {
        assert_int_equal(lchown("shared/link", 12345, 12345), 0);
        REFUSED(STATUS_CANNOT_WRITE, strerror(EACCES),
                whole_file_open(&file, "shared/link", &f));
        assert_int_equal(whole_file_check("shared/link", NULL), STATUS_CANNOT_WRITE);
        assert_int_equal(chmod("shared", 0755), 0);
        begin(&file, "shared/link", "");
        whole_file_abandon(&file);

        // one that belongs to the owner of the folder is
        assert_int_equal(chown("shared", 12345, 12345), 0);
        assert_int_equal(chmod("shared", 01777), 0);
        assert_int_equal(whole_file_check("shared/link", NULL), STATUS_OK);
    }
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

    // a process that writes one of them ends before it could make its file again
    int ended = 0;
    const pid_t writer = fork();
    assert_true(writer >= 0);
    if (writer == 0) {
        pause();
        _exit(0);
    }

    // the program that ends makes no other: here it is a child
    const pid_t ends = fork();
    assert_true(ends >= 0);
    if (ends == 0) {
        whole_file late;
        whole_file_set_writer(writer);
        whole_file_remove_unfinished();
        _exit(whole_file_open(&late, "three", NULL) == STATUS_CANNOT_WRITE ? 7 : 1);
    }
    assert_int_equal(waitpid(ends, &ended, 0), ends);
    assert_true(WIFEXITED(ended) && WEXITSTATUS(ended) == 7);
    assert_int_equal(waitpid(writer, &ended, 0), writer);
    assert_true(WIFSIGNALED(ended) && WTERMSIG(ended) == SIGKILL);
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
    assert_int_equal(mkdir("below", 0700), 0);
    assert_int_equal(symlink(formatted("%s/target", test_folder), "below/link"), 0);
    write_new("below/link");
    assert_holds("target", "new");
}

// Only what is a temporary by name and kind is cleaned away.
TEST_IN_FOLDER(what_only_looks_left_behind_stays)
{
    static const char *const others[] = {".impactlab-1-2.party", ".impactlab-1.part",
                                         ".impactlab-x-2.part", ".impactlab-1-2.par"};
    const int before = files();
    for (EACH(one, others)) {
        put_file(*one, "mine");
    }
    put_file("mine", "mine");
    assert_int_equal(symlink("mine", ".impactlab-1-3.part"), 0);
    assert_int_equal(mkfifo(".impactlab-1-4.part", 0600), 0);
    assert_int_equal(mkdir(".impactlab-1-5.part", 0700), 0);
    put_file(".impactlab-1-6.part", "left");
    whole_file_clean_folder("nowhere");
    whole_file_clean_folder(".");
    assert_false(is_there(".impactlab-1-6.part"));
    assert_int_equal(files(), before + 8);
    for (EACH_TEXT(c, ".impactlab-1-5.part", ".impactlab-1-4.part",
                   ".impactlab-1-3.part")) {
        assert_int_equal(remove(*c), 0);
    }
    for (EACH(one, others)) {
        unlink(*one);
    }
}

// Names that are all taken are no reason to touch what has them.
TEST_IN_FOLDER(a_folder_without_a_free_name_is_said)
{
    enum { NAMES = 1000 };
    whole_file first, w;
    begin(&first, "kept", "whole");
    for (int i = 0; i < NAMES; i++) {
        const char *name = formatted(".impactlab-%ld-%d.part", (long)getpid(), i);
        assert_true(mkdir(name, 0700) == 0 || i == 0);
    }
    REFUSED(STATUS_CANNOT_WRITE, strerror(EEXIST), whole_file_open(&w, "other", &f));

    // open files are still written
    DONE(whole_file_commit(&first, &f));
    assert_holds("kept", "whole");
    for (int i = 1; i < NAMES; i++) {
        assert_int_equal(rmdir(formatted(".impactlab-%ld-%d.part", (long)getpid(), i)),
                         0);
    }
}

// A stranger's file with a temporary's name is none of ours.
TEST_IN_FOLDER(what_another_user_left_stays)
{
    if (geteuid() != 0) {
        skip(); // only root can make a file somebody else's
    }
    put_file(".impactlab-1-8.part", "a stranger's");
    assert_int_equal(chown(".impactlab-1-8.part", 12345, 12345), 0);
    whole_file_clean_folder(".");
    assert_holds(".impactlab-1-8.part", "a stranger's");
    unlink(".impactlab-1-8.part");
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
