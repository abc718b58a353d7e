#include "ui/commands/command.h"

#include "src/study/sweep.h"
#include "src/base/json.h"

#include <langinfo.h>
#include <stdarg.h>
#include <string.h>
#include <sys/stat.h>

int complain(const char *format, ...)
{
    va_list list;
    fflush(stdout);
    fputs("impactlab: ", stderr);
    va_start(list, format);
    vfprintf(stderr, format, list);
    va_end(list);
    fputc('\n', stderr);
    return EXIT_BAD_ARGUMENTS;
}

int complain_fault(const fault *f)
{
    complain("%s", f->text[0] ? f->text : status_text(f->code));
    switch (f->code) {
    case STATUS_OK:
        return EXIT_DONE;
    case STATUS_BAD_ARGUMENT:
    case STATUS_BAD_SCENARIO:
    case STATUS_CANNOT_READ:
        return EXIT_BAD_ARGUMENTS;
    default:
        return EXIT_FAILED;
    }
}

void report_to_stderr(void *context, const char *sentence)
{
    (void)context;
    fflush(stdout);
    fprintf(stderr, "%s\n", sentence);
}

// Applies every --set once. Returns how many failed; complains about them if asked to.
static int apply_sets_once(scenario *s, const arguments *a, bool aloud)
{
    int failures = 0;
    for (int i = 0; i < a->set_count; i++) {
        fault f = {0};
        if (scenario_override(s, a->sets[i], &f) != STATUS_OK) {
            failures++;
            if (aloud) {
                complain_fault(&f);
            }
        }
    }
    return failures;
}

// Gives every parameter of --set its value. One that is wrong only until another one is set
// (arm.links=4 before arm.model=corrected) gets another chance, so that their order is free.
static int apply_sets(scenario *s, const arguments *a)
{
    for (int pass = 0; pass < a->set_count; pass++) {
        if (apply_sets_once(s, a, false) == 0) {
            return EXIT_DONE;
        }
    }
    return apply_sets_once(s, a, true) == 0 ? EXIT_DONE : EXIT_BAD_ARGUMENTS;
}

// Counts the faults it passes on, so that none of them goes unsaid.
static void report_and_count(void *context, const char *sentence)
{
    (*(int *)context)++;
    report_to_stderr(NULL, sentence);
}

static bool is_same_file(const char *path, const char *other)
{
    struct stat a, b;
    return path != NULL && stat(path, &a) == 0 && stat(other, &b) == 0 && a.st_dev == b.st_dev &&
           a.st_ino == b.st_ino;
}

// Results must not replace the scenario they come from.
static int check_keeps_scenario(const scenario *s, const arguments *a)
{
    const char *const outputs[] = {a->json, a->csv, a->plot, a->scene, a->output};
    for (size_t i = 0; i < sizeof outputs / sizeof outputs[0]; i++) {
        if (is_same_file(outputs[i], s->file)) {
            return complain("'%s' is the scenario itself, expected another file for the results",
                            outputs[i]);
        }
    }
    return EXIT_DONE;
}

int open_scenario(scenario *s, const char *name_or_file, const arguments *a)
{
    int reported = 0;
    status code = scenario_open(s, name_or_file, report_and_count, &reported);
    if (code != STATUS_OK) {
        if (reported == 0) {
            complain("'%s': %s", name_or_file, status_text(code));
        }
        return code == STATUS_NO_MEMORY ? EXIT_FAILED : EXIT_BAD_ARGUMENTS;
    }
    int result = check_keeps_scenario(s, a);
    if (result == EXIT_DONE) {
        result = apply_sets(s, a);
    }
    if (result != EXIT_DONE) {
        scenario_finish(s);
    }
    return result;
}

int write_json(const char *path, json_t *value)
{
    whole_file file;
    fault f = {0};
    if (value == NULL) {
        fault_set(&f, STATUS_NO_MEMORY, "%s", status_text(STATUS_NO_MEMORY));
        return complain_fault(&f);
    }
    status code = whole_file_open(&file, path, &f);
    if (code == STATUS_OK) {
        json_write(file.stream, value);
        code = whole_file_commit(&file, &f);
    }
    json_decref(value);
    return code == STATUS_OK ? EXIT_DONE : complain_fault(&f);
}

int check_output(const char *path)
{
    fault f = {0};
    if (path == NULL || whole_file_check(path, &f) == STATUS_OK) {
        return EXIT_DONE;
    }
    return complain_fault(&f);
}

static bool is_standard_output(const char *path)
{
    return path != NULL && strcmp(path, "-") == 0;
}

bool summary_wanted(const arguments *a)
{
    return !a->quiet && !is_standard_output(a->json) && !is_standard_output(a->csv) &&
           !is_standard_output(a->markdown) && !is_standard_output(a->output);
}

void key_label(const char *key, char *label, size_t size, const char **unit)
{
    quantity_name(key, label, size, unit);
    for (char *c = label; *c != '\0'; c++) {
        *c = *c == '_' ? ' ' : *c;
    }
}

int text_width(const char *text)
{
    int width = 0;
    for (; *text != '\0'; text++) {
        width += ((unsigned char)*text & 0xC0) != 0x80;
    }
    return width;
}

bool terminal_has_utf8(void)
{
    return strcmp(nl_langinfo(CODESET), "UTF-8") == 0;
}
