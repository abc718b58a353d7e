#include "src/exchange/law_export.h"

#include <ctype.h>
#include <math.h>
#include <string.h>

#include "src/base/numbers.h"
#include "src/base/words.h"
#include "src/rig/controller_values.h"
#include "src/run/run_loop.h"
#include "src/exchange/law_texts.h"

#define SINGLE_TOLERANCE 5e-3 // of a command in single precision [V]

// The laws that keep to their memory from the first call on. Those of one file have one
// text.
#define TOUCH_FILE                                                                       \
    "touch_memory", {touch_double, touch_single}, {17000, 850},                          \
    {                                                                                    \
        432, 248                                                                         \
    }
#define HYBRID_FILE                                                                      \
    "hybrid_memory", {hybrid_double, hybrid_single}, {14000, 500},                       \
    {                                                                                    \
        312, 192                                                                         \
    }
#define FORCE_FILE                                                                       \
    "force_memory", {force_feedback_double, force_feedback_single}, {3500, 200},         \
    {                                                                                    \
        304, 176                                                                         \
    }
static const exported_law exported_laws[] = {
    {LAW_TOUCH, "touch_law", TOUCH_FILE},
    {LAW_HYBRID, "hybrid_law", HYBRID_FILE},
    {LAW_RECOVERING, "recovering_law", HYBRID_FILE},
    {LAW_REVERSE_TORQUE, "reverse_torque_law", HYBRID_FILE},
    {LAW_SPEED_LIMIT, "speed_limit_law", HYBRID_FILE},
    {LAW_BANG_BANG, "bang_bang_law", HYBRID_FILE},
    {LAW_FORCE_PD, "force_pd_law", FORCE_FILE},
    {LAW_FORCE_INTEGRAL, "force_integral_law", FORCE_FILE},
    {LAW_DISCONTINUOUS, "discontinuous_law", FORCE_FILE},
};
enum { EXPORTED_LAWS = sizeof exported_laws / sizeof exported_laws[0] };

status law_export_init(law_export *e, const scenario *s, int precision, fault *f)
{
    const int law = s->parameters.control.law;
    *e = (law_export){.scenario = s, .precision = precision};
    for (int i = 0; i < EXPORTED_LAWS; i++) {
        if (exported_laws[i].law == law) {
            e->law = &exported_laws[i];
        }
    }
    if (e->law == NULL) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, "control.law",
                            "control.law = '%s' cannot be exported, expected touch, "
                            "hybrid or one of its variants, or force-pd, force-integral "
                            "or discontinuous",
                            control_law_table[law].word);
    }
    return rig_create(&e->rig, &s->parameters, NULL, f);
}

void law_export_finish(law_export *e)
{
    rig_destroy(e->rig);
    e->rig = NULL;
}

// --- the texts -------------------------------------------------------------------------

// The words of each precision in the exported files.
static const struct {
    const char *type, *word, *infinity, *cast, *interface;
    double tolerance; // of replayed commands [V]
} precisions[PRECISIONS] = {
    {"double", "double", "HUGE_VAL", "", interface_double, 0},
    {"float", "single", "HUGE_VALF", "(float)", interface_single, SINGLE_TOLERANCE},
};

// What stands over both files.
static void write_heading(const law_export *e, FILE *stream, const char *what)
{
    const controller *law = e->rig->law;
    char scenario_name[256]; // a line end in it would end the comment
    snprintf(scenario_name, sizeof scenario_name, "%s", e->scenario->name);
    make_printable(scenario_name, 0);
    fprintf(stream, "// %s of the control law '%s', in %s precision,\n", what, law->name,
            precisions[e->precision].word);
    fprintf(stream, "// written by impactlab from the scenario %s.\n//\n", scenario_name);
}

// The name of a parameter in capitals, as its place is called.
static void write_place(FILE *stream, const char *name)
{
    fputs("LAW_", stream);
    for (; *name != '\0'; name++) {
        fputc(toupper((unsigned char)*name), stream);
    }
}

void law_export_header(const law_export *e, FILE *stream)
{
    const controller *law = e->rig->law;
    write_heading(e, stream, "The interface");
    fputs(
        "// law_start clears the law's memory and tells it the design; it returns NULL, "
        "or why the\n// law refuses. law_sample is called once a period with what the "
        "sensors read; the command\n// may exceed the limit of the D/A converter, "
        "which saturates. law_set changes a parameter\n// between two samples.\n"
        "#ifndef LAW_H\n#define LAW_H\n\n",
        stream);
    fputs(precisions[e->precision].interface, stream);

    // where each parameter stands
    fputs("\n// Places of the law's parameters.\nenum law_parameter {\n", stream);
    for (int i = 0; i < law->parameter_count; i++) {
        const controller_parameter p = controller_parameter_at(law, i);
        fputs("    ", stream);
        write_place(stream, p.name);
        fprintf(stream, ", // %s [%s]\n", p.description, p.unit);
    }
    fputs("    LAW_PARAMETERS\n};\n\n", stream);

    char text[NUMBER_TEXT];
    number_format(text, precisions[e->precision].tolerance);
    fprintf(stream, "#define LAW_TOLERANCE %s // of replayed commands [V]\n\n", text);
    fprintf(stream,
            "// On a Cortex-M4F, compiled by gcc -O2: instructions of a sample, at most, "
            "and bytes of\n// the largest frame on the stack.\n"
            "#define LAW_INSTRUCTIONS %d\n#define LAW_STACK %d\n\n",
            e->law->instructions[e->precision], e->law->stack[e->precision]);
    fprintf(stream,
            "const char *law_start(void);\n"
            "void law_sample(const controller_input *in, controller_output *out);\n"
            "const char *law_set(enum law_parameter parameter, %s value);\n\n#endif\n",
            precisions[e->precision].type);
}

// A number of the design; infinity is HUGE_VAL.
static void write_number(const law_export *e, FILE *stream, double value)
{
    if (isinf(value)) {
        fputs(precisions[e->precision].infinity, stream);
        return;
    }
    char text[NUMBER_TEXT];
    number_format_short(text, value);
    fprintf(stream, "%s%s", precisions[e->precision].cast, text);
}

// The nominal model that the law is told.
static void write_setup(const law_export *e, FILE *stream)
{
    const controller_setup told = rig_nominal_setup(e->rig, &e->scenario->parameters);
    const struct {
        const char *name;
        double value;
    } fields[] = {
        {"period", told.period},
        {"delay", told.delay},
        {"voltage_limit", told.voltage_limit},
        {"torque_per_volt", told.torque_per_volt},
        {"hub_damping", told.hub_damping},
        {"stiction", told.stiction},
        {"hub_inertia", told.hub_inertia},
        {"link_mass", told.link_mass},
        {"link_length", told.link_length},
        {"link_inertia", told.link_inertia},
        {"k2", told.k2},
        {"wall_angle", told.wall_angle},
        {"hub_spring", told.hub_spring},
        {"damping_ratio", told.damping_ratio},
    };

    fputs("static const controller_setup law_setup = {\n", stream);
    for (size_t i = 0; i < sizeof fields / sizeof fields[0]; i++) {
        fprintf(stream, "    .%s = ", fields[i].name);
        write_number(e, stream, fields[i].value);
        fputs(",\n", stream);
    }
    fprintf(stream, "    .links = %d,\n    .parameters = law_values,\n};\n", told.links);
}

// The law's parameters, and the memory that holds all it remembers.
static void write_memory(const law_export *e, FILE *stream)
{
    const controller *law = e->rig->law;
    fprintf(stream, "\n// --- the design\n\nstatic %s law_values[LAW_PARAMETERS] = {\n",
            precisions[e->precision].type);
    for (int i = 0; i < law->parameter_count; i++) {
        fputs("    [", stream);
        write_place(stream, controller_parameter_at(law, i).name);
        fputs("] = ", stream);
        write_number(e, stream, e->rig->values[i]);
        fputs(",\n", stream);
    }
    fputs("};\n\n", stream);
    write_setup(e, stream);
    fprintf(stream, "static %s law_memory;\n\n", e->law->memory);
}

void law_export_source(const law_export *e, FILE *stream)
{
    const char *name = e->law->name;
    write_heading(e, stream, "The source");
    fprintf(
        stream,
        "// C99; no heap, no file; of the mathematical library sqrt, fmin, fmax, fabs "
        "and copysign.\n// Compile with -ffp-contract=off for the lab's bits. It "
        "remembers %zu bytes where double\n// has 8 and a pointer 8.\n",
        e->rig->law->memory_size);
    fputs(e->law->source[e->precision], stream);
    write_memory(e, stream);
    fprintf(stream,
            "const char *law_start(void)\n{\n    law_memory = (%s){0};\n"
            "    return %s.start(&law_memory, &law_setup);\n}\n\n"
            "void law_sample(const controller_input *in, controller_output *out)\n{\n"
            "    *out = (controller_output){0};\n"
            "    %s.sample(&law_memory, in, out);\n}\n\n"
            "const char *law_set(enum law_parameter parameter, %s value)\n{\n"
            "    law_values[parameter] = value;\n"
            "    return %s.tune(&law_memory, &law_setup);\n}\n",
            e->law->memory, name, name, precisions[e->precision].type, name);
}

void law_export_replay(const law_export *e, FILE *stream)
{
    (void)e;
    fputs(replay_program, stream);
}

// --- the readings ----------------------------------------------------------------------

// A law that calls the exported one and writes what it read and answered. Its memory is
// the tap's address.
typedef struct reading_tap {
    law_export *export;
    FILE *stream;
} reading_tap;

static reading_tap *tap_of(void *memory)
{
    reading_tap *tap;
    memcpy(&tap, memory, sizeof tap);
    return tap;
}

static void write_cell(FILE *stream, double value)
{
    if (!isnan(value)) {
        char text[NUMBER_TEXT];
        number_format_short(text, value);
        fputs(text, stream);
    }
}

static void sample_and_write(void *memory, const controller_input *in,
                             controller_output *out)
{
    const reading_tap *tap = tap_of(memory);
    law_export *e = tap->export;
    e->rig->law->sample(e->rig->memory, in, out);
    if (e->told_again) {
        return;
    }

    const double cells[] = {in->time,  in->encoder,       in->tachometer,
                            in->force, in->voltage,       in->piezo_force,
                            in->film,  in->accelerometer, in->predicted_force};
    for (size_t i = 0; i < sizeof cells / sizeof cells[0]; i++) {
        write_cell(tap->stream, cells[i]);
        fputc(',', tap->stream);
    }
    write_cell(tap->stream, out->command);
    fputs("\r\n", tap->stream);
    e->samples++;
}

static const char *tune_and_note(void *memory, const controller_setup *setup)
{
    law_export *e = tap_of(memory)->export;
    e->told_again = true;
    return e->rig->law->tune(e->rig->memory, setup);
}

status law_export_readings(law_export *e, FILE *stream, fault *f)
{
    reading_tap tap = {e, stream};
    controller law = *e->rig->law;
    law.memory_size = sizeof(reading_tap *);
    law.start = controller_takes_anything; // the exported law was started with its rig
    law.sample = sample_and_write;
    law.tune = tune_and_note;

    fputs("time[s],encoder[rad],tachometer[rad/s],force[N],voltage[V],piezo_force[N],"
          "film[rad],accelerometer[rad/s2],predicted_force[N],command[V]\r\n",
          stream);
    const loop_options options = {.law = {&law, &tap}};
    run_loop *loop;
    TRY(loop_create(&loop, e->scenario, &options, f));
    const status code = loop_until(loop, e->scenario->parameters.run.duration, f);
    loop_destroy(loop);
    return code;
}
