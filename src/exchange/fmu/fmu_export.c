#include "src/exchange/fmu/fmu_export.h"

#include <assert.h>
#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/input_file.h"
#include "src/base/numbers.h"
#include "src/base/sha256.h"
#include "src/base/shipped.h"
#include "src/base/text_stream.h"
#include "src/exchange/fmu/fmu_parts.h"
#include "src/exchange/fmu/model_description.h"
#include "src/exchange/fmu/zip_writer.h"
#include "src/scenario/outside.h"

enum {
    FMU_PARTS = sizeof fmu_parts / sizeof fmu_parts[0],
    FOLDER = sizeof "sources/" - 1,
    NUMBERS_A_LINE = 20
};

// --- what the FMU is given -------------------------------------------------------------

// Takes in the file that a parameter names.
static status take_file(fmu_file *file, const char *path, fault *f)
{
    fault why;
    size_t length;
    char *bytes = input_file_read(path, sizeof file->bytes + 1, &length, &why);
    if (bytes == NULL) {
        return input_file_fault(path, &why, f);
    }
    if (length > sizeof file->bytes) {
        free(bytes);
        return fault_set(f, STATUS_BAD_SCENARIO,
                         "'%s' has more than the %zu bytes that an FMU has room for",
                         path, sizeof file->bytes);
    }
    snprintf(file->path, sizeof file->path, "%s", path);
    memcpy(file->bytes, bytes, length);
    file->length = length;
    free(bytes);
    return STATUS_OK;
}

// Takes in what the scenario reads from outside; code of others is refused.
static status take_outside(fmu_scenario *given, const parameters *p, fault *f)
{
    int files = 0;
    for (int i = 0; i < outside_count; i++) {
        const outside_source *source = &outside_table[i];
        const int parameter = parameter_at(source->parameter);
        if (!outside_is_read(source, p)) {
            continue;
        }
        if (source->kind != OUTSIDE_FILE) {
            return fault_set_at(f, STATUS_BAD_SCENARIO, "control.law",
                                "control.law = '%s' cannot be put into an FMU, expected "
                                "none or a law of the lab",
                                control_law_table[p->control.law].word);
        }
        char path[PARAMETER_TEXT_SIZE];
        parameter_format(p, parameter, path, sizeof path);
        TRY(take_file(&given->files[files++], path, f));
    }
    return STATUS_OK;
}

// The last part of the scenario's name as a name of C.
static void name_binary(char identifier[FMU_TEXT], const char *name)
{
    const char *slash = strrchr(name, '/');
    snprintf(identifier, FMU_TEXT, "arm_%.200s", slash != NULL ? slash + 1 : name);
    for (char *c = identifier; *c != '\0'; c++) {
        if (!isalnum((unsigned char)*c) || (unsigned char)*c >= 0x80) {
            *c = '_';
        }
    }
}

// Another guid for another scenario or another version.
static void make_guid(fmu_scenario *given)
{
    sha256 h;
    char digest[SHA256_TEXT];
    sha256_init(&h);
    sha256_add_text(&h, lab_version());
    sha256_add(&h, given, sizeof *given);
    sha256_finish(&h, digest);
    snprintf(given->guid, sizeof given->guid, "{%.8s-%.4s-%.4s-%.4s-%.12s}", digest,
             digest + 8, digest + 12, digest + 16, digest + 20);
}

// Marks the parameters that are inputs.
static status choose_inputs(fmu_export *e, const char *paths, fault *f)
{
    for (int i = 0; i < parameter_count; i++) {
        e->inputs[i] = paths == NULL && parameter_table[i].timed;
    }
    while (paths != NULL && *paths != '\0') {
        char path[FMU_TEXT];
        const int length = (int)strcspn(paths, ",");
        snprintf(path, sizeof path, "%.*s", length, paths);
        const int parameter = parameter_look_up(path, f);
        if (parameter < 0) {
            return STATUS_BAD_ARGUMENT;
        }
        FAULT_IF(!parameter_table[parameter].timed, f, STATUS_BAD_ARGUMENT,
                 "%s cannot be an input: it holds from the start of a run", path);
        e->inputs[parameter] = true;
        paths += length + (paths[length] == ',');
    }
    return STATUS_OK;
}

status fmu_export_create(fmu_export **made, const scenario *s, const char *inputs,
                         fault *f)
{
    *made = NULL;
    FAULT_IF(s->action_count > FMU_ACTIONS, f, STATUS_BAD_SCENARIO,
             "the script has %d actions, but an FMU has room for %d", s->action_count,
             FMU_ACTIONS);
    fmu_export *e = calloc(1, sizeof *e);
    if (e == NULL) {
        return fault_no_memory(f);
    }
    status code = choose_inputs(e, inputs, f);
    if (code == STATUS_OK) {
        code = take_outside(&e->given, &s->parameters, f);
    }
    if (code != STATUS_OK) {
        free(e);
        return code;
    }

    e->title = s->title;
    name_binary(e->identifier, s->name);
    snprintf(e->given.name, sizeof e->given.name, "%s", s->name);
    e->given.parameters = s->parameters;
    e->given.parameters.code_allowed = false;
    e->given.action_count = s->action_count;
    for (int i = 0; i < s->action_count; i++) {
        e->given.actions[i] = s->actions[i];
    }
    make_guid(&e->given);
    *made = e;
    return STATUS_OK;
}

// --- as C ------------------------------------------------------------------------------

// A text as a literal of C.
static void write_literal(FILE *stream, const char *text)
{
    fputc('"', stream);
    for (; *text != '\0'; text++) {
        const unsigned char c = (unsigned char)*text;
        if (c < 0x20 || c >= 0x7f || c == '"' || c == '\\' || c == '?') {
            fprintf(stream, "\\%03o", c);
        } else {
            fputc(c, stream);
        }
    }
    fputc('"', stream);
}

static void write_real(FILE *stream, double value)
{
    char text[NUMBER_TEXT];
    if (isnan(value)) {
        fputs("NAN", stream);
    } else if (isinf(value)) {
        fputs(value > 0 ? "HUGE_VAL" : "-HUGE_VAL", stream);
    } else {
        number_format_short(text, value);
        fputs(text, stream);
    }
}

static void write_parameters(FILE *stream, const parameters *p)
{
    fputs("    .parameters = {\n", stream);
    for (int i = 0; i < parameter_count; i++) {
        const parameter_info *info = &parameter_table[i];
        fprintf(stream, "        .%s = ", info->path);
        if (parameter_is_text(info)) {
            write_literal(stream, (const char *)p + info->offset);
        } else {
            write_real(stream, parameter_get(p, i));
        }
        fputs(",\n", stream);
    }

    // which of them were given
    fputs("        .set = {", stream);
    for (int i = 0; i < parameter_count; i++) {
        fprintf(stream, "%d,", p->set[i]);
    }
    fputs("},\n    },\n", stream);
}

static void write_actions(FILE *stream, const fmu_scenario *given)
{
    fprintf(stream, "    .action_count = %d,\n    .actions = {\n", given->action_count);
    for (int i = 0; i < given->action_count; i++) {
        const action *a = &given->actions[i];
        fputs("        {.time = ", stream);
        write_real(stream, a->time);
        fprintf(stream, ", .kind = %d, .parameter = %d, .value = ", (int)a->kind,
                a->parameter);
        write_real(stream, a->value);
        fputs(", .text = ", stream);
        write_literal(stream, a->text);
        fputs("},\n", stream);
    }
    fputs("        {0},\n    },\n", stream);
}

static void write_files(FILE *stream, const fmu_scenario *given)
{
    fputs("    .files = {\n", stream);
    for (int i = 0; i < FMU_FILES; i++) {
        const fmu_file *file = &given->files[i];
        fputs("        {.path = ", stream);
        write_literal(stream, file->path);
        fprintf(stream, ", .length = %zu, .bytes = {", file->length);
        for (size_t j = 0; j < file->length; j++) {
            fprintf(stream, "%s%d,", j % NUMBERS_A_LINE == 0 ? "\n            " : "",
                    file->bytes[j]);
        }
        fputs("0}},\n", stream);
    }
    fputs("    },\n", stream);
}

static void write_scenario(FILE *stream, const fmu_scenario *given)
{
    fputs("// What the FMU runs, written by impactlab fmu.\n#include \"portable.h\"\n"
          "#include <math.h>\n\n#include \"fmu_scenario.h\"\n\n"
          "const fmu_scenario fmu_given = {\n    .guid = ",
          stream);
    write_literal(stream, given->guid);
    fputs(",\n    .name = ", stream);
    write_literal(stream, given->name);
    fputs(",\n", stream);
    write_parameters(stream, &given->parameters);
    write_actions(stream, given);
    write_files(stream, given);
    fputs("};\n", stream);
}

// --- the archive -----------------------------------------------------------------------

// The description, with the names of all sources that are compiled.
static void write_description(FILE *stream, const fmu_export *e)
{
    const char *names[FMU_PARTS + 1];
    int count = 0;
    names[count++] = "given.c";
    for (int i = 0; i < FMU_PARTS; i++) {
        const char *name = fmu_parts[i].name, *ending = strrchr(name, '.');
        if (strcmp(ending, ".c") == 0) {
            names[count++] = name + FOLDER;
        }
    }
    write_model_description(stream, &e->given, e->inputs, e->title, e->identifier, names,
                            count);
}

// Adds a text that was written to memory; closes the stream.
static status add_text(zip_writer *z, const char *name, text_stream *text, fault *f)
{
    size_t length;
    char *content = text_stream_close(text, &length);
    if (content == NULL) {
        return fault_no_memory(f);
    }
    const status code = zip_add(z, name, content, length, f);
    free(content);
    return code;
}

// Adds the shared object with the scenario in its place, where there is one.
static status add_binary(zip_writer *z, fmu_export *e, const char *name, fault *f)
{
    e->has_binary = fmu_binary.size > 0;
    if (!e->has_binary) {
        return STATUS_OK;
    }
    unsigned char *binary = zip_unpack(&fmu_binary);
    if (binary == NULL) {
        return fault_no_memory(f);
    }
    void *place = memmem(binary, fmu_binary.size, FMU_BLANK, sizeof FMU_BLANK);
    assert(place != NULL);
    memcpy(place, &e->given, sizeof e->given);
    const status code = zip_add(z, name, binary, fmu_binary.size, f);
    free(binary);
    return code;
}

// Adds the generated files.
static status add_own_files(zip_writer *z, fmu_export *e, const char *binary, fault *f)
{
    text_stream text;
    FAULT_IF(!text_stream_open(&text), f, STATUS_NO_MEMORY, "no memory for a text");
    write_description(text.stream, e);
    TRY(add_text(z, "modelDescription.xml", &text, f));
    FAULT_IF(!text_stream_open(&text), f, STATUS_NO_MEMORY, "no memory for a text");
    write_scenario(text.stream, &e->given);
    TRY(add_text(z, "sources/given.c", &text, f));
    return add_binary(z, e, binary, f);
}

status fmu_export_write(fmu_export *e, FILE *stream, fault *f)
{
    char binary[FMU_TEXT + 32]; // the archive's directory has the name, too
    zip_writer *z = malloc(sizeof *z);
    if (z == NULL) {
        return fault_no_memory(f);
    }
    snprintf(binary, sizeof binary, "binaries/linux64/%s.so", e->identifier);
    zip_init(z, stream);
    const status code = add_own_files(z, e, binary, f);
    for (int i = 0; i < FMU_PARTS; i++) {
        zip_add_packed(z, &fmu_parts[i]);
    }
    zip_finish(z);
    free(z);
    return code;
}
