// impactlab export: a control law as C for a board.
#include "ui/commands/command.h"

#include <errno.h>
#include <glib.h>
#include <string.h>
#include <sys/stat.h>

#include "src/base/whole_file.h"
#include "src/exchange/law_export.h"
#include "ui/commands/results.h"

// One file of the folder, written whole or not at all.
typedef status file_writer(law_export *e, FILE *stream, fault *f);

static status write_header(law_export *e, FILE *stream, fault *f)
{
    (void)f;
    law_export_header(e, stream);
    return STATUS_OK;
}

static status write_source(law_export *e, FILE *stream, fault *f)
{
    (void)f;
    law_export_source(e, stream);
    return STATUS_OK;
}

static status write_replay(law_export *e, FILE *stream, fault *f)
{
    (void)f;
    law_export_replay(e, stream);
    return STATUS_OK;
}

static status write_file_of(law_export *e, const char *folder, const char *name,
                            file_writer *write, fault *f)
{
    g_autofree char *path = g_build_filename(folder, name, NULL);
    whole_file file;
    TRY(whole_file_open(&file, path, f));
    return whole_file_close(&file, write(e, file.stream, f), f);
}

// The files of the folder, by whose first an export is known.
static const struct {
    const char *name;
    file_writer *write;
} files[] = {
    {"law.h", write_header},
    {"law.c", write_source},
    {"replay.c", write_replay},
    {"readings.csv", law_export_readings},
};
enum { FILES = sizeof files / sizeof files[0] };

static bool holds(const char *folder, const char *name)
{
    g_autofree char *path = g_build_filename(folder, name, NULL);
    return g_file_test(path, G_FILE_TEST_EXISTS);
}

// A file of somebody else's is not replaced: only an export's folder holds law.h.
static status check_folder(const char *folder, fault *f)
{
    for (int i = 1; i < FILES; i++) {
        FAULT_IF(!holds(folder, files[0].name) && holds(folder, files[i].name), f,
                 STATUS_CANNOT_WRITE,
                 "the folder '%s' holds %s, which no export made, expected a new folder "
                 "or that of an export",
                 folder, files[i].name);
    }
    return STATUS_OK;
}

// The folder and its four files.
static status write_folder(law_export *e, const char *folder, fault *f)
{
    TRY(check_folder(folder, f));
    FAULT_IF(mkdir(folder, 0777) != 0 && errno != EEXIST, f, STATUS_CANNOT_WRITE,
             "the folder '%s' cannot be made: %s", folder, strerror(errno));
    for (int i = 0; i < FILES; i++) {
        TRY(write_file_of(e, folder, files[i].name, files[i].write, f));
    }
    return STATUS_OK;
}

// What was written, and how to try it.
static void say_export(const law_export *e, const char *folder)
{
    say_title(e->scenario);
    say("%s: law.h, law.c, replay.c and %ld samples in readings.csv\n", folder,
        e->samples);
    if (e->told_again) {
        say("The readings end where the script tells the law another value.\n");
    }
    say("\n    cd %s\n    cc -O2 -ffp-contract=off -o replay law.c replay.c -lm && "
        "./replay <readings.csv\n",
        folder);
}

static int export_law(const arguments *a, scenario *s)
{
    if (a->output == NULL) {
        return complain("export needs a folder for its files: -o DIR");
    }

    law_export e;
    fault f = {0};
    const int precision = a->single ? IN_SINGLE : IN_DOUBLE;
    status code = law_export_init(&e, s, precision, &f);
    if (code == STATUS_OK) {
        code = write_folder(&e, a->output, &f);
    }
    if (code == STATUS_OK && summary_wanted(a)) {
        say_export(&e, a->output);
    }
    law_export_finish(&e);
    return code == STATUS_OK ? EXIT_DONE : complain_fault(&f);
}

static const option_row rows[] = {
    OUTPUT_OPTION(PLACE, "DIR", "folder to write to, made if it is not there"),
    OPTION(FLAG, "float", NULL, "single precision, for boards without double",
           PLACE(single)),
};

const command export_command = {
    .name = "export",
    .group = GROUP_CONTROL,
    .summary = "Write a scenario's control law as C for a board",
    .operands = "SCENARIO",
    .least = 1,
    .most = 1,
    .takes_scenarios = true,
    .help =
        "law.c and law.h are C99 without heap or files: the law's own source, and what "
        "the scenario\ntells it as tables. replay.c runs readings.csv, what the law "
        "read in this scenario, through\nthem and compares the commands: the same "
        "bits in double precision. Laws that can be exported:\ntouch, hybrid and its "
        "variants, force-pd, force-integral, discontinuous.\n",
    .options = {&set_options, OWN_OPTIONS(rows), &quiet_options},
    .use = export_law,
};
