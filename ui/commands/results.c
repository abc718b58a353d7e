#include "ui/commands/results.h"

#include <string.h>
#include <unistd.h>

#include "render/drawing.h"
#include "src/base/json.h"
#include "src/base/text_stream.h"
#include "src/base/whole_file.h"
#include "ui/commands/command.h"
#include "ui/commands/interrupts.h"

int worse(int a, int b)
{
    if (a > b) {
        return a;
    }
    return b;
}

bool summary_wanted(const arguments *a)
{
    const option_row *o;
    for (int i = 0; (o = command_option(a->command, i)) != NULL; i++) {
        const char *path = option_written(a, o);
        if (o->type == OPTION_RESULT && path != NULL && strcmp(path, "-") == 0) {
            return false;
        }
    }
    return !a->quiet;
}

// Checks the path of one result, and that pictures can be drawn if it is one.
static status check_result(const option_row *o, const char *path, fault *f)
{
    if (o->type == OPTION_PICTURE) {
        TRY(picture_check_path(path, f));
        return drawing_open(f);
    }
    return whole_file_check(path, f);
}

int check_results(const arguments *a)
{
    const option_row *o;
    int result = EXIT_DONE;
    fault f = {0};
    if (a->command->draws && drawing_open(&f) != STATUS_OK) {
        return complain_fault(&f);
    }
    for (int i = 0; (o = command_option(a->command, i)) != NULL; i++) {
        // a place is checked by the command itself
        const char *path = option_written(a, o);
        if (path != NULL && o->type != OPTION_PLACE &&
            check_result(o, path, &f) != STATUS_OK) {
            result = worse(result, complain_fault(&f));
        }
    }
    return result;
}

int refuse_bytes_on_screen(const char *name, const char *path)
{
    if (path != NULL && strcmp(path, "-") == 0 && isatty(STDOUT_FILENO)) {
        return complain("--%s -: the standard output is a terminal, which cannot show "
                        "it, expected a file or a pipe",
                        name);
    }
    return EXIT_DONE;
}

int write_file(const char *path, result_writer *write, const void *found)
{
    whole_file file;
    fault f = {0};
    if (path == NULL || write == NULL) {
        return EXIT_DONE;
    }

    // whole or not at all
    if (whole_file_open(&file, path, &f) != STATUS_OK) {
        return complain_fault(&f);
    }
    write(file.stream, found);
    if (whole_file_commit(&file, &f) != STATUS_OK) {
        return complain_fault(&f);
    }
    return EXIT_DONE;
}

static void write_json_value(FILE *stream, const void *value)
{
    json_write(stream, value);
}

int write_json_file(const char *path, json_t *value)
{
    // a value that lacks members for want of memory is not written
    int result;
    if (loss_noted() || value == NULL) {
        result = complain_fault(&(fault){.code = STATUS_NO_MEMORY});
    } else {
        result = write_file(path, write_json_value, value);
    }
    json_decref(value);
    return result;
}

// Writes what was found as JSON. Returns the exit status.
static int write_found_json(const char *path, const command_results *r, const void *found,
                            bool whole)
{
    json_t *object = r->json(found);
    if (!whole) {
        json_put(object, "status", json_string("interrupted"));
    }
    return write_json_file(path, object);
}

int write_results(const arguments *a, const command_results *r, const void *found,
                  bool whole)
{
    int result = EXIT_DONE;
    interrupts_catch();

    // files
    if (a->json != NULL && r->json != NULL) {
        result = write_found_json(a->json, r, found, whole);
    }
    result = worse(result, write_file(a->csv, r->csv, found));
    result = worse(result, write_file(a->markdown, r->markdown, found));
    result = worse(result, write_file(a->mat, r->mat, found));
    if (whole) {
        result = worse(result, write_file(a->cases, r->cases, found));
        result = worse(result, write_file(a->output, r->output, found));
    }

    // the picture, and the text last
    if (a->plot != NULL && r->plot != NULL && (whole || r->draws_part)) {
        result = worse(result, r->plot(a, found));
    }
    if (r->text != NULL && summary_wanted(a)) {
        r->text(found);
    }
    return result;
}
