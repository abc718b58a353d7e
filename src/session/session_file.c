#include "src/session/session_file.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/numbers.h"
#include "src/base/text_stream.h"
#include "src/base/input_file.h"
#include "src/rig/rig.h"
#include "src/scenario/outside.h"

static const char head[] = "impactlab-session: 1";

enum { MOST_BYTES = 16 << 20, MOST_INPUTS = 20000 };

// --- writing ---------------------------------------------------------------------------

// A scenario's text, each line behind a bar.
static void write_base(FILE *stream, const scenario *s)
{
    text_stream text;
    char *whole = NULL, *rest;
    if (text_stream_open(&text)) {
        scenario_write(text.stream, s);
        whole = text_stream_close(&text, NULL);
    }
    loss_unless(whole != NULL);
    fprintf(stream, "scenario: %s\n", s->name);
    rest = whole;
    for (char *line;
         rest != NULL && (line = strsep(&rest, "\n")) != NULL && rest != NULL;) {
        fprintf(stream, "| %s\n", line);
    }
    free(whole);
}

static void write_number(FILE *stream, const char *before, double value)
{
    char text[NUMBER_TEXT];
    number_format(text, value);
    fprintf(stream, "%s%s", before, text);
}

static void write_input(FILE *stream, const session_input *in)
{
    static const char *const words[] = {[SESSION_INPUT_START] = "start: ",
                                        [SESSION_INPUT_TIMED] = "from: ",
                                        [SESSION_INPUT_PUSH] = "push: "};
    write_number(stream, words[in->kind], in->time);
    if (in->kind == SESSION_INPUT_PUSH) {
        write_number(stream, " ", in->value);
        fputc('\n', stream);
    } else {
        fprintf(stream, " %s %s\n", parameter_table[in->parameter].path, in->text);
    }
}

// The parameters that a run starts with.
static parameters started_with(const run_origin *from)
{
    parameters p = from->base.parameters;
    for (int i = 0; i < from->input_count; i++) {
        const session_input *in = &from->inputs[i];
        if (in->kind == SESSION_INPUT_START) {
            parameter_set_text(&p, in->parameter, in->text, NULL);
        }
    }
    return p;
}

void session_file_write(FILE *stream, const session_file *file)
{
    assert(file->run_count > 0);
    fprintf(stream, "%s\n", head);
    for (int i = 0; i < file->run_count; i++) {
        const kept_run *r = &file->runs[i];

        // a scenario is written once for the runs of it that follow each other
        if (i == 0 || !same_base(&r->from.base, &file->runs[i - 1].from.base)) {
            write_base(stream, &r->from.base);
        }
        if (i == 0) {
            fputs("present:\n", stream);
        } else {
            fprintf(stream, "pinned: %s\n", r->name);
        }
        for (int k = 0; k < r->from.input_count; k++) {
            write_input(stream, &r->from.inputs[k]);
        }
        write_number(stream, "cursor: ", r->from.now);
        write_number(stream, " ", r->from.seen);
        fputs(r->hidden ? "\nhidden:\n" : "\n", stream);
        if (r->from.outside[0] != '\0') {
            fprintf(stream, "outside: %s\n", r->from.outside);
        }
    }
    fprintf(stream, "baseline: %d\n", file->baseline + 1);
    for (int i = 0; i < file->line_count; i++) {
        fprintf(stream, "view: %s\n", file->lines[i]);
    }
}

// --- reading ---------------------------------------------------------------------------

typedef struct session_reader {
    session_file *file;
    const char *path;
    int line;      // from 1
    scenario base; // of zeroes before the first
    char *text;    // of the scenario that is being read
    size_t length;
    char name[SESSION_FILE_NAME];
    fault *fault;
} session_reader;

static status refuse_line(const session_reader *r, const char *what)
{
    return fault_set(r->fault, STATUS_BAD_ARGUMENT, "%s:%d:1: %s", r->path, r->line,
                     what);
}

// The scenario whose text is complete.
static status end_base(session_reader *r)
{
    if (r->text == NULL) {
        if (r->base.name != NULL) {
            return STATUS_OK;
        }
        return refuse_line(r, "a run, expected a scenario before it");
    }
    fault first = {0};
    scenario fresh;
    const status code = scenario_parse(&fresh, r->text, r->length, r->path, r->name,
                                       keep_first_fault, &first);
    free(r->text);
    r->text = NULL;
    if (code != STATUS_OK) {
        return refuse_line(r, first.text[0] ? first.text : status_text(code));
    }
    scenario_finish(&r->base);
    r->base = fresh;
    return STATUS_OK;
}

static status begin_section(session_reader *r, const char *name)
{
    session_file *file = r->file;
    TRY(end_base(r));
    if (file->run_count == SESSION_FILE_RUNS) {
        return refuse_line(r, "one run more than a session holds");
    }
    kept_run *k = &file->runs[file->run_count];
    *k = (kept_run){0};
    if (scenario_copy(&k->from.base, &r->base) != STATUS_OK) {
        return fault_no_memory(r->fault);
    }
    snprintf(k->name, sizeof k->name, "%s", name);
    file->run_count++;
    return STATUS_OK;
}

// Two numbers from 0 on, the second one behind a blank.
static bool read_two_numbers(const char *text, double *first, double *second,
                             const char **rest)
{
    return decimal_read(text, first, rest) && isfinite(*first) && *first >= 0 &&
           decimal_read(*rest, second, rest) && isfinite(*second);
}

// The parameter and the value of a change, as session_change would take them.
static status read_parameter_change(const session_reader *r, const run_origin *from,
                                    session_input *in, const char *text)
{
    char path[128];
    parameters scratch = started_with(from);
    const size_t length = strcspn(text, " ");
    snprintf(path, sizeof path, "%.*s", (int)length, text);
    in->parameter = parameter_find(path);
    if (in->parameter < 0 || strlen(text + length) >= sizeof in->text) {
        return refuse_line(r, "no change, expected an instant, a parameter and a value");
    }
    snprintf(in->text, sizeof in->text, "%s", text + length + (text[length] == ' '));
    const bool timed = in->kind == SESSION_INPUT_TIMED;

    // among the values that the changes before it give; values that others must go with
    // are checked with all of them, when the run is computed
    fault f = {0};
    if ((timed && !rig_can_change(&scratch, in->parameter)) ||
        parameter_set_text(&scratch, in->parameter, in->text, &f) != STATUS_OK) {
        if (f.text[0] != '\0') {
            return refuse_line(r, f.text);
        }
        return refuse_line(r, "a parameter that does not change during a run");
    }
    in->value = parameter_get(&scratch, in->parameter);
    return STATUS_OK;
}

static status append_input(session_reader *r, session_input_kind kind, const char *text)
{
    session_file *file = r->file;
    session_input in = {.kind = kind, .parameter = -1, .before = (double)NAN};
    const char *rest;
    run_origin *from = file->run_count > 0 ? &file->runs[file->run_count - 1].from : NULL;
    status code = STATUS_OK;
    if (from == NULL) {
        return refuse_line(r, "a change, expected a run before it");
    }
    if (from->input_count == MOST_INPUTS) {
        return refuse_line(r, "too many changes");
    }
    if (kind == SESSION_INPUT_PUSH) {
        const bool good = read_two_numbers(text, &in.time, &in.value, &rest) &&
                          *rest == '\0' && from->base.parameters.arm.model != ARM_PRINTED;
        if (good) {
            code = STATUS_OK;
        } else {
            code = refuse_line(r, "no push, expected an instant and an impulse");
        }
    } else {
        const bool good =
            decimal_read(text, &in.time, &rest) && in.time >= 0 && isfinite(in.time);
        if (good) {
            code = read_parameter_change(r, from, &in, rest);
        } else {
            code =
                refuse_line(r, "no change, expected an instant, a parameter and a value");
        }
    }
    TRY(code);
    in.seen_at = in.time;
    session_input *more =
        realloc(from->inputs, ((size_t)from->input_count + 1) * sizeof *from->inputs);
    if (more == NULL) {
        return fault_no_memory(r->fault);
    }
    from->inputs = more;
    from->inputs[from->input_count++] = in;
    return STATUS_OK;
}

// Appends a line to the scenario's text.
static status append_line(session_reader *r, const char *line)
{
    const size_t more = strlen(line);
    if (r->text == NULL) {
        return refuse_line(r, "text without a scenario");
    }
    char *longer = realloc(r->text, r->length + more + 2);
    if (longer == NULL) {
        return fault_no_memory(r->fault);
    }
    r->text = longer;
    r->length += (size_t)sprintf(r->text + r->length, "%s\n", line);
    return STATUS_OK;
}

static status take_line(session_reader *r, char *line)
{
    session_file *file = r->file;
    kept_run *last = file->run_count > 0 ? &file->runs[file->run_count - 1] : NULL;
    char *rest = strchr(line, ':');
    const char *end;
    if (strncmp(line, "| ", 2) == 0) {
        return append_line(r, line + 2);
    }
    if (rest == NULL) {
        return refuse_line(r, "no line of a session, expected 'word: rest'");
    }
    *rest++ = '\0';
    rest += *rest == ' ';

    // by its word
    if (strcmp(line, "scenario") == 0) {
        free(r->text);
        r->length = 0;
        r->text = calloc(1, 2);
        snprintf(r->name, sizeof r->name, "%s", rest);
        if (r->text == NULL) {
            return fault_no_memory(r->fault);
        }
        return STATUS_OK;
    }
    if (strcmp(line, "present") == 0 || strcmp(line, "pinned") == 0) {
        if ((line[1] == 'r') == (file->run_count == 0)) {
            return begin_section(r, rest);
        }
        return refuse_line(r, "expected one present run, then pinned ones");
    }
    if (strcmp(line, "start") == 0 || strcmp(line, "from") == 0 ||
        strcmp(line, "push") == 0) {
        return append_input(r,
                            line[0] == 's'   ? SESSION_INPUT_START
                            : line[0] == 'f' ? SESSION_INPUT_TIMED
                                             : SESSION_INPUT_PUSH,
                            rest);
    }
    if (strcmp(line, "cursor") == 0 && last != NULL) {
        if (read_two_numbers(rest, &last->from.now, &last->from.seen, &end)) {
            return STATUS_OK;
        }
        return refuse_line(r, "no cursor, expected two instants");
    }
    if (strcmp(line, "hidden") == 0 && last != NULL) {
        last->hidden = true;
        return STATUS_OK;
    }
    if (strcmp(line, "outside") == 0 && last != NULL) {
        snprintf(last->from.outside, sizeof last->from.outside, "%s", rest);
        return STATUS_OK;
    }
    if (strcmp(line, "baseline") == 0) {
        file->baseline = atoi(rest) - 1;
        if (file->baseline >= -1 && file->baseline < file->run_count - 1) {
            return STATUS_OK;
        }
        return refuse_line(r, "no baseline, expected the number of a pinned run, or 0");
    }
    if (strcmp(line, "view") == 0 && file->line_count < SESSION_FILE_LINES) {
        file->lines[file->line_count] = strdup(rest);
        if (file->lines[file->line_count++] == NULL) {
            return fault_no_memory(r->fault);
        }
        return STATUS_OK;
    }
    return refuse_line(r, "a line that does not belong here");
}

static status read_session_lines(session_reader *r, FILE *stream)
{
    char *line = NULL;
    size_t room = 0, bytes = 0;
    status code = STATUS_OK;
    ssize_t length;
    while (code == STATUS_OK && (length = getline(&line, &room, stream)) >= 0) {
        r->line++;
        bytes += (size_t)length;
        line[strcspn(line, "\r\n")] = '\0';
        if (bytes > MOST_BYTES || (r->line == 1 && strcmp(line, head) != 0)) {
            code = refuse_line(r, bytes > MOST_BYTES ? "the file is too long"
                                                     : "this is no session");
        } else if (r->line > 1 && line[0] != '\0') {
            code = take_line(r, line);
        }
    }
    free(line);
    if (code == STATUS_OK && (r->file->run_count == 0 || r->text != NULL)) {
        code =
            refuse_line(r, r->line == 0 ? "this is no session" : "the file ends early");
    }
    return code;
}

status session_file_read(session_file *file, const char *path, fault *f)
{
    *file = (session_file){.baseline = -1};
    fault why = {0};
    FILE *stream = input_file_open(path, &why);
    if (stream == NULL) {
        return input_file_fault(path, &why, f);
    }
    fault own = {0};
    session_reader r = {.file = file, .path = path, .fault = &own};
    const status code = read_session_lines(&r, stream);
    fclose(stream);
    free(r.text);
    scenario_finish(&r.base);
    if (code != STATUS_OK) {
        session_file_finish(file);
        return fault_set(f, own.code, "%s", own.text);
    }
    return STATUS_OK;
}

bool session_file_is_outdated(const session_file *file)
{
    bool outdated = false;
    for (int i = 0; i < file->run_count && !outdated; i++) {
        const run_origin *from = &file->runs[i].from;
        const parameters p = started_with(from);
        char now[SHA256_TEXT];
        outside_digest_all(&p, now);
        outdated = from->outside[0] != '\0' && strcmp(now, from->outside) != 0;
    }
    return outdated;
}

void session_file_finish(session_file *file)
{
    for (int i = 0; i < file->run_count; i++) {
        run_origin_finish(&file->runs[i].from);
    }
    for (int i = 0; i < file->line_count; i++) {
        free(file->lines[i]);
    }
    *file = (session_file){0};
}
