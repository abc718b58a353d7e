#include "src/exchange/fmu/model_description.h"

#include <ctype.h>
#include <math.h>
#include <string.h>

#include "src/base/numbers.h"
#include "src/base/shipped.h"
#include "src/scenario/outside.h"
#include "src/tables/signals.h"

// --- text ------------------------------------------------------------------------------

// The first `length` bytes of a text as the value of an attribute.
static void write_escaped(FILE *stream, const char *text, size_t length)
{
    for (const char *c = text; c < text + length && *c != '\0'; c++) {
        switch (*c) {
        case '&':
            fputs("&amp;", stream);
            break;
        case '<':
            fputs("&lt;", stream);
            break;
        case '"':
            fputs("&quot;", stream);
            break;
        default:
            fputc(is_control(*c) ? ' ' : *c, stream);
        }
    }
}

static void write_attribute(FILE *stream, const char *name, const char *text)
{
    fprintf(stream, " %s=\"", name);
    write_escaped(stream, text, strlen(text));
    fputc('"', stream);
}

static void write_number(FILE *stream, const char *name, double value)
{
    char text[NUMBER_TEXT];
    number_format_short(text, value);
    fprintf(stream, " %s=\"%s\"", name, text);
}

// --- units -----------------------------------------------------------------------------

enum { UNITS = 64, UNIT_TEXT = 32, BASE_UNITS = 5 };

static const char *const base_units[BASE_UNITS] = {"kg", "m", "s", "A", "rad"};

// The units of the tables, by the exponents of their base units.
static const struct {
    const char *name;
    int exponents[BASE_UNITS];
} known_units[] = {
    {"kg", {1, 0, 0, 0, 0}},  {"m", {0, 1, 0, 0, 0}},     {"s", {0, 0, 1, 0, 0}},
    {"A", {0, 0, 0, 1, 0}},   {"rad", {0, 0, 0, 0, 1}},   {"N", {1, 1, -2, 0, 0}},
    {"J", {1, 2, -2, 0, 0}},  {"V", {1, 2, -3, -1, 0}},   {"H", {1, 2, -2, -2, 0}},
    {"Hz", {0, 0, -1, 0, 0}}, {"ohm", {1, 2, -3, -2, 0}},
};
enum { KNOWN_UNITS = sizeof known_units / sizeof known_units[0] };

// Adds a unit's exponents, times a factor.
static void add_exponents(const char *name, size_t length, int factor,
                          int exponents[BASE_UNITS])
{
    for (int i = 0; i < KNOWN_UNITS; i++) {
        if (strlen(known_units[i].name) == length &&
            strncmp(known_units[i].name, name, length) == 0) {
            for (int j = 0; j < BASE_UNITS; j++) {
                exponents[j] += factor * known_units[i].exponents[j];
            }
        }
    }
}

// The exponents of a product such as "N m/rad" or "V/(N s)": a stroke holds for the next
// unit or for those in brackets.
static void find_exponents(const char *unit, int exponents[BASE_UNITS])
{
    int sign = 1;
    bool brackets = false;
    for (const char *c = unit; *c != '\0';) {
        if (isalpha((unsigned char)*c)) {
            size_t length = 1;
            while (isalpha((unsigned char)c[length])) {
                length++;
            }
            const bool power = isdigit((unsigned char)c[length]);
            const int exponent = power ? c[length] - '0' : 1;
            add_exponents(c, length, sign * exponent, exponents);
            sign = brackets ? sign : 1;
            c += length + power;
            continue;
        }
        if (*c == '/') {
            sign = -1;
        } else if (*c == '(') {
            brackets = true;
        } else if (*c == ')') {
            brackets = false;
            sign = 1;
        }
        c++;
    }
}

// A unit as Modelica writes it, with a dot for each blank.
static const char *unit_name(const char *unit, char text[UNIT_TEXT])
{
    snprintf(text, UNIT_TEXT, "%s", unit);
    for (char *blank; (blank = strchr(text, ' ')) != NULL;) {
        *blank = '.';
    }
    return text;
}

static void write_unit_attribute(FILE *stream, const char *unit)
{
    char text[UNIT_TEXT];
    if (unit[0] != '\0') {
        write_attribute(stream, "unit", unit_name(unit, text));
    }
}

static void write_unit(FILE *stream, const char *unit)
{
    char text[UNIT_TEXT];
    int exponents[BASE_UNITS] = {0};
    find_exponents(unit, exponents);
    fputs("    <Unit", stream);
    write_attribute(stream, "name", unit_name(unit, text));
    fputs("><BaseUnit", stream);
    for (int i = 0; i < BASE_UNITS; i++) {
        if (exponents[i] != 0) {
            fprintf(stream, " %s=\"%d\"", base_units[i], exponents[i]);
        }
    }
    fputs("/></Unit>\n", stream);
}

// Notes a unit unless it is there. Returns how many there are.
static int note_unit(const char *units[UNITS], int count, const char *unit)
{
    for (int i = 0; i < count; i++) {
        if (strcmp(units[i], unit) == 0) {
            return count;
        }
    }
    if (unit[0] != '\0' && count < UNITS) {
        units[count++] = unit;
    }
    return count;
}

static void write_units(FILE *stream)
{
    const char *units[UNITS];
    int count = 0;
    for (int i = 0; i < parameter_count; i++) {
        if (parameter_table[i].type == PARAMETER_REAL) {
            count = note_unit(units, count, parameter_table[i].unit);
        }
    }
    for (int i = 0; i < signal_count; i++) {
        count = note_unit(units, count, signal_table[i].unit);
    }

    fputs("  <UnitDefinitions>\n", stream);
    for (int i = 0; i < count; i++) {
        write_unit(stream, units[i]);
    }
    fputs("  </UnitDefinitions>\n", stream);
}

// --- choices ---------------------------------------------------------------------------

// An enumeration for each choice, of the parameter's name.
static void write_choices(FILE *stream)
{
    fputs("  <TypeDefinitions>\n", stream);
    for (int i = 0; i < parameter_count; i++) {
        const parameter_info *info = &parameter_table[i];
        if (info->type != PARAMETER_CHOICE) {
            continue;
        }
        fprintf(stream, "    <SimpleType name=\"%s\"><Enumeration>", info->path);
        int value = 0;
        for (const char *word = info->choices; *word != '\0';) {
            const size_t length = strcspn(word, "|");
            fprintf(stream, "<Item name=\"%.*s\" value=\"%d\"/>", (int)length, word,
                    value++);
            word += length + (word[length] == '|');
        }
        fputs("</Enumeration></SimpleType>\n", stream);
    }
    fputs("  </TypeDefinitions>\n", stream);
}

// --- variables -------------------------------------------------------------------------

bool fmu_shows_parameter(const parameters *p, int parameter)
{
    for (int i = 0; i < outside_count; i++) {
        if (parameter_at(outside_table[i].parameter) == parameter) {
            return false;
        }
    }
    return parameter != PARAMETER_INDEX(run.duration) &&
           !isnan(parameter_get(p, parameter));
}

// Begins a variable, up to its type.
static void begin_variable(FILE *stream, const char *name, int reference,
                           const char *kind, const char *description)
{
    fprintf(stream, "    <ScalarVariable name=\"%s\" valueReference=\"%d\" %s", name,
            reference, kind);
    write_attribute(stream, "description", description);
    fputc('>', stream);
}

static void end_variable(FILE *stream)
{
    fputs("/></ScalarVariable>\n", stream);
}

static void write_real(FILE *stream, const parameter_info *info, double value)
{
    fputs("<Real", stream);
    write_unit_attribute(stream, info->unit);
    write_number(stream, "min", info->minimum);
    write_number(stream, "max", info->maximum);
    write_number(stream, "start", value);
}

// A parameter: an input, one that may be changed between steps, or one that may not.
static void write_parameter(FILE *stream, const parameters *p, int index, bool is_input)
{
    const parameter_info *info = &parameter_table[index];
    const double value = parameter_get(p, index);
    const char *kind = "causality=\"parameter\" variability=\"fixed\" initial=\"exact\"";
    if (is_input) {
        kind = "causality=\"input\" variability=\"discrete\"";
    } else if (info->timed) {
        kind = "causality=\"parameter\" variability=\"tunable\" initial=\"exact\"";
    }
    begin_variable(stream, info->path, index, kind, info->description);
    switch (info->type) {
    case PARAMETER_REAL:
        write_real(stream, info, value);
        break;
    case PARAMETER_INTEGER:
        fprintf(stream, "<Integer min=\"%.0f\" max=\"%.0f\" start=\"%.0f\"",
                info->minimum, info->maximum, value);
        break;
    case PARAMETER_BOOLEAN:
        fprintf(stream, "<Boolean start=\"%s\"", value != 0 ? "true" : "false");
        break;
    case PARAMETER_CHOICE:
        fprintf(stream, "<Enumeration declaredType=\"%s\" start=\"%.0f\"", info->path,
                value);
        break;
    case PARAMETER_TEXT:
    case PARAMETER_LIST:
        fputs("<String", stream);
        write_attribute(stream, "start", (const char *)p + info->offset);
        break;
    }
    end_variable(stream);
}

// A signal. The first is the time, which an importer has of its own.
static void write_signal(FILE *stream, int index)
{
    const char *kind = "causality=\"independent\" variability=\"continuous\"";
    if (index != SIGNAL_INDEX(time)) {
        kind = "causality=\"output\" variability=\"continuous\" initial=\"calculated\"";
    }
    const signal_info *info = signal_table + index;
    begin_variable(stream, info->name, FMU_SIGNALS + index, kind, info->description);
    fputs("<Real", stream);
    write_unit_attribute(stream, info->unit);
    end_variable(stream);
}

// The inputs that are no parameters.
static void write_inputs(FILE *stream)
{
    begin_variable(stream, "commanded", FMU_COMMANDED,
                   "causality=\"parameter\" variability=\"fixed\" initial=\"exact\"",
                   "whether the input motor_command commands the motor, in the place of "
                   "control.law");
    fputs("<Boolean start=\"false\"", stream);
    end_variable(stream);

    begin_variable(stream, "motor_command", FMU_COMMAND,
                   "causality=\"input\" variability=\"discrete\"",
                   "command that the rig takes at its next sample, where commanded is "
                   "true");
    fputs("<Real unit=\"V\" start=\"0\"", stream);
    end_variable(stream);

    begin_variable(stream, "push", FMU_PUSH,
                   "causality=\"input\" variability=\"discrete\"",
                   "impulse that the tip gets at the beginning of the step in which this "
                   "takes a new value, unless that is 0");
    fputs("<Real unit=\"N.s\" start=\"0\"", stream);
    end_variable(stream);
}

// Writes the variables, outputs last. Returns the number of those before the outputs.
static int write_variables(FILE *stream, const parameters *p, const bool *inputs)
{
    int before = 0;
    fputs("  <ModelVariables>\n", stream);
    for (int i = 0; i < parameter_count; i++) {
        if (fmu_shows_parameter(p, i)) {
            write_parameter(stream, p, i, inputs[i]);
            before++;
        }
    }
    write_inputs(stream);
    for (int i = 0; i < signal_count; i++) {
        write_signal(stream, i);
    }
    fputs("  </ModelVariables>\n", stream);
    return before + 3 + 1; // three inputs and the time
}

// Outputs depend on the state alone, as inputs act from the next step on; at the start
// they depend on all.
static void write_structure(FILE *stream, int before)
{
    fputs("  <ModelStructure>\n    <Outputs>\n", stream);
    for (int i = 1; i < signal_count; i++) {
        fprintf(stream, "      <Unknown index=\"%d\" dependencies=\"\"/>\n", before + i);
    }
    fputs("    </Outputs>\n    <InitialUnknowns>\n", stream);
    for (int i = 1; i < signal_count; i++) {
        fprintf(stream, "      <Unknown index=\"%d\"/>\n", before + i);
    }
    fputs("    </InitialUnknowns>\n  </ModelStructure>\n", stream);
}

// --- the whole -------------------------------------------------------------------------

static void write_head(FILE *stream, const fmu_scenario *given, const char *title)
{
    fputs("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
          "<fmiModelDescription fmiVersion=\"2.0\"",
          stream);
    write_attribute(stream, "modelName", given->name);
    write_attribute(stream, "guid", given->guid);
    write_attribute(stream, "description", title);
    fprintf(stream,
            " generationTool=\"impactlab %s\" variableNamingConvention=\"structured\">\n",
            lab_version());
}

void write_model_description(FILE *stream, const fmu_scenario *given, const bool *inputs,
                             const char *title, const char *identifier,
                             const char *const *sources, int source_count)
{
    write_head(stream, given, title);
    fprintf(stream,
            "  <CoSimulation modelIdentifier=\"%s\" "
            "canHandleVariableCommunicationStepSize=\"true\" "
            "canNotUseMemoryManagementFunctions=\"true\" canGetAndSetFMUstate=\"true\" "
            "canSerializeFMUstate=\"true\">\n    <SourceFiles>\n",
            identifier);
    for (int i = 0; i < source_count; i++) {
        fprintf(stream, "      <File name=\"%s\"/>\n", sources[i]);
    }
    fputs("    </SourceFiles>\n  </CoSimulation>\n", stream);

    write_units(stream);
    write_choices(stream);
    fputs("  <LogCategories><Category name=\"logStatusError\"/></LogCategories>\n"
          "  <DefaultExperiment startTime=\"0\"",
          stream);
    write_number(stream, "stopTime", given->parameters.run.duration);
    write_number(stream, "stepSize", given->parameters.method.step);
    fputs("/>\n", stream);
    write_structure(stream, write_variables(stream, &given->parameters, inputs));
    fputs("</fmiModelDescription>\n", stream);
}
