#include "src/session/session_file.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/numbers.h"
#include "src/base/input_file.h"
#include "src/rig/rig.h"
#include "src/scenario/outside.h"

static const char head[] = "impactlab-session: 1";

enum { MOST_BYTES = 16 << 20, MOST_INPUTS = 20000 };

// --- writing ---------------------------------------------------------------------------

// Writes a scenario's name, then its text with "| " before each line.
static void write_base(FILE *stream, const scenario *s)
{
    char *whole = scenario_as_text(s);
    fprintf(stream, "scenario: %s\n", s->name);
    if (whole == NULL) {
        return;
    }

    // the text ends with a line's end, behind which there is no line
    char *rest = whole, *line = strsep(&rest, "\n");
    while (rest != NULL) {
        fprintf(stream, "| %s\n", line);
        line = strsep(&rest, "\n");
    }
    free(whole);
}

static void write_number(FILE *stream, const char *before, double value)
{
    char text[NUMBER_TEXT];
    number_format(text, value);
    fprintf(stream, "%s%s", before, text);
}

// Writes a change as a line: its word, its instant, and what it changes.
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
            const action a = session_input_action(in);
            action_give(&a, &p, NULL);
        }
    }
    return p;
}

// Writes the lines of a run: its changes, its cursor, whether it is hidden, and the
// digest of what it read from outside.
static void write_run(FILE *stream, const kept_run *r)
{
    for (int i = 0; i < r->from.input_count; i++) {
        write_input(stream, &r->from.inputs[i]);
    }

    write_number(stream, "cursor: ", r->from.now);
    write_number(stream, " ", r->from.seen);
    fputc('\n', stream);

    if (r->hidden) {
        fputs("hidden:\n", stream);
    }
    if (r->from.outside[0] != '\0') {
        fprintf(stream, "outside: %s\n", r->from.outside);
    }
}

// The runs, each behind its scenario, then the baseline and the lines of the view.
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
        write_run(stream, r);
    }

    // how they are looked at
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

// Ends the text of a scenario: parses it and makes it the base of the runs that follow.
// Without such a text the base stays.
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

    if (code != STATUS_OK && first.text[0] == '\0') {
        return refuse_line(r, status_text(code));
    }
    if (code != STATUS_OK) {
        return refuse_line(r, first.text);
    }

    scenario_finish(&r->base);
    r->base = fresh;
    return STATUS_OK;
}

// Begins a run of the scenario that was read last.
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

// Reads two finite numbers, of which the first is not negative.
static bool read_two_numbers(const char *text, double *first, double *second,
                             const char **rest)
{
    return decimal_read(text, first, rest) && isfinite(*first) && *first >= 0 &&
           decimal_read(*rest, second, rest) && isfinite(*second);
}

// Reads the parameter and the value of a change and checks them, as session_change does.
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
    const char *value = text + length;
    if (*value == ' ') {
        value++;
    }
    snprintf(in->text, sizeof in->text, "%s", value);
    const bool timed = in->kind == SESSION_INPUT_TIMED;

    // The value is checked beside those that the run starts with. Whether all values go
    // together is checked when the run is computed.
    fault f = {0};
    if (timed && !rig_can_change(&scratch, in->parameter)) {
        return refuse_line(r, "a parameter that does not change during a run");
    }
    if (parameter_set_text(&scratch, in->parameter, in->text, &f) != STATUS_OK) {
        return refuse_line(r, f.text);
    }
    session_input_take(in, &scratch);
    return STATUS_OK;
}

// The run that the lines belong to, NULL before the first.
static kept_run *last_run(const session_reader *r)
{
    if (r->file->run_count == 0) {
        return NULL;
    }
    return &r->file->runs[r->file->run_count - 1];
}

// Reads an input of a known kind from the text behind its word.
static status read_input(const session_reader *r, const run_origin *from,
                         session_input *in, const char *text)
{
    const char *rest;
    if (in->kind == SESSION_INPUT_PUSH) {
        if (!read_two_numbers(text, &in->time, &in->value, &rest) || *rest != '\0' ||
            from->base.parameters.arm.model == ARM_PRINTED) {
            return refuse_line(r, "no push, expected an instant and an impulse");
        }
        return STATUS_OK;
    }

    if (!decimal_read(text, &in->time, &rest) || !(in->time >= 0) ||
        !isfinite(in->time)) {
        return refuse_line(r, "no change, expected an instant, a parameter and a value");
    }
    return read_parameter_change(r, from, in, rest);
}

// Appends a change to the present run.
static status append_input(session_reader *r, session_input_kind kind, const char *text)
{
    kept_run *run = last_run(r);
    if (run == NULL) {
        return refuse_line(r, "a change, expected a run before it");
    }

    run_origin *from = &run->from;
    if (from->input_count == MOST_INPUTS) {
        return refuse_line(r, "too many changes");
    }

    session_input in = {.kind = kind, .parameter = -1, .before = (double)NAN};
    TRY(read_input(r, from, &in, text));
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

// --- the kinds of lines, each read from what stands behind its word

// "scenario: NAME", whose text follows.
static status take_scenario(session_reader *r, const char *rest)
{
    free(r->text);
    r->length = 0;
    r->text = calloc(1, 2);
    snprintf(r->name, sizeof r->name, "%s", rest);
    if (r->text == NULL) {
        return fault_no_memory(r->fault);
    }
    return STATUS_OK;
}

// "present:", the first run.
static status take_present(session_reader *r, const char *rest)
{
    if (r->file->run_count != 0) {
        return refuse_line(r, "expected one present run, then pinned ones");
    }
    return begin_section(r, rest);
}

// "pinned: NAME", each further run.
static status take_pinned(session_reader *r, const char *rest)
{
    if (r->file->run_count == 0) {
        return refuse_line(r, "expected one present run, then pinned ones");
    }
    return begin_section(r, rest);
}

// "start: INSTANT PARAMETER VALUE"
static status take_start(session_reader *r, const char *rest)
{
    return append_input(r, SESSION_INPUT_START, rest);
}

// "from: INSTANT PARAMETER VALUE"
static status take_timed(session_reader *r, const char *rest)
{
    return append_input(r, SESSION_INPUT_TIMED, rest);
}

// "push: INSTANT IMPULSE"
static status take_push(session_reader *r, const char *rest)
{
    return append_input(r, SESSION_INPUT_PUSH, rest);
}

// "cursor: INSTANT SEEN"
static status take_cursor(session_reader *r, const char *rest)
{
    run_origin *from = &last_run(r)->from;
    const char *end;
    if (!read_two_numbers(rest, &from->now, &from->seen, &end)) {
        return refuse_line(r, "no cursor, expected two instants");
    }
    return STATUS_OK;
}

// "hidden:"
static status take_hidden(session_reader *r, const char *rest)
{
    (void)rest;
    last_run(r)->hidden = true;
    return STATUS_OK;
}

// "outside: DIGEST"
static status take_outside(session_reader *r, const char *rest)
{
    run_origin *from = &last_run(r)->from;
    snprintf(from->outside, sizeof from->outside, "%s", rest);
    return STATUS_OK;
}

// "baseline: NUMBER" of a pinned run, from 1; 0 for none.
static status take_baseline(session_reader *r, const char *rest)
{
    session_file *file = r->file;
    file->baseline = atoi(rest) - 1;
    if (file->baseline < -1 || file->baseline >= file->run_count - 1) {
        return refuse_line(r, "no baseline, expected the number of a pinned run, or 0");
    }
    return STATUS_OK;
}

// "view: LINE", which belongs to who shows the session.
static status take_view(session_reader *r, const char *rest)
{
    session_file *file = r->file;
    if (file->line_count == SESSION_FILE_LINES) {
        return refuse_line(r, "a line that does not belong here");
    }
    file->lines[file->line_count] = strdup(rest);
    if (file->lines[file->line_count] == NULL) {
        return fault_no_memory(r->fault);
    }
    file->line_count++;
    return STATUS_OK;
}

static const struct {
    const char *word;
    bool of_run; // belongs to the run before it
    status (*take)(session_reader *r, const char *rest);
} line_kinds[] = {
    {"scenario", false, take_scenario}, {"present", false, take_present},
    {"pinned", false, take_pinned},     {"start", false, take_start},
    {"from", false, take_timed},        {"push", false, take_push},
    {"cursor", true, take_cursor},      {"hidden", true, take_hidden},
    {"outside", true, take_outside},    {"baseline", false, take_baseline},
    {"view", false, take_view},
};

// Takes a line of any kind: "| TEXT" of a scenario, or "word: rest".
static status take_line(session_reader *r, char *line)
{
    if (strncmp(line, "| ", 2) == 0) {
        return append_line(r, line + 2);
    }

    // the word and the rest
    char *rest = strchr(line, ':');
    if (rest == NULL) {
        return refuse_line(r, "no line of a session, expected 'word: rest'");
    }
    *rest++ = '\0';
    if (*rest == ' ') {
        rest++;
    }

    // by its word
    for (size_t i = 0; i < sizeof line_kinds / sizeof *line_kinds; i++) {
        const bool belongs_here = !line_kinds[i].of_run || last_run(r) != NULL;
        if (belongs_here && strcmp(line, line_kinds[i].word) == 0) {
            return line_kinds[i].take(r, rest);
        }
    }
    return refuse_line(r, "a line that does not belong here");
}

// Reads one line, given without its end; `bytes` counts the file's bytes up to its end.
static status read_session_line(session_reader *r, char *line, size_t bytes)
{
    r->line++;
    if (bytes > MOST_BYTES) {
        return refuse_line(r, "the file is too long");
    }

    if (r->line == 1) {
        if (strcmp(line, head) != 0) {
            return refuse_line(r, "this is no session");
        }
        return STATUS_OK;
    }

    if (line[0] == '\0') {
        return STATUS_OK;
    }
    return take_line(r, line);
}

// Reads a whole session, line by line.
static status read_session_lines(session_reader *r, FILE *stream)
{
    char *line = NULL;
    size_t room = 0, bytes = 0;
    status code = STATUS_OK;
    ssize_t length;
    while (code == STATUS_OK && (length = getline(&line, &room, stream)) >= 0) {
        bytes += (size_t)length;
        line[strcspn(line, "\r\n")] = '\0';
        code = read_session_line(r, line, bytes);
    }
    free(line);
    TRY(code);

    // a session has a run, and each scenario one that follows it
    if (r->line == 0) {
        return refuse_line(r, "this is no session");
    }
    if (r->file->run_count == 0 || r->text != NULL) {
        return refuse_line(r, "the file ends early");
    }
    return STATUS_OK;
}

// Reads the whole file, or nothing of it.
status session_file_read(session_file *file, const char *path, fault *f)
{
    *file = (session_file){.baseline = -1};
    fault why = {0};
    FILE *stream = input_file_open(path, &why);
    if (stream == NULL) {
        return input_file_fault(path, &why, f);
    }

    // faults name the line
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

// Whether a file or program that a run read has changed since.
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
