// The functions of FMI 2.0 for co-simulation, around a loop (src/run/run_loop.h).
//
// Parameters and inputs are collected in `values`. The loop begins with them when
// somebody asks for a signal or initialisation ends; from then on inputs act at the
// beginning of the next step, so that no output depends directly on an input. Tools hand
// back every start value: only one that differs from what is known counts as given.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/sha256.h"
#include "src/exchange/fmu/fmi2/fmi2Functions.h"
#include "src/exchange/fmu/fmu_scenario.h"
#include "src/run/run_loop.h"

// Instants that are nearer than this are the same [s], and as a share of late ones.
#define SAME_INSTANT 1e-9

typedef enum stage { STAGE_SET_UP, STAGE_RUNNING, STAGE_OVER } stage;

// All that an FMU remembers beside its loop.
typedef struct fmu_values {
    stage stage;
    double time;        // where the last step ended [s]
    parameters started; // with which the loop began
    parameters wanted;  // as they are set from outside
    unsigned char changed[sizeof(((parameters *)0)->set)]; // 1: not yet told the loop
    fmi2Boolean commanded;
    double command;         // [V]
    double push, last_push; // as set, and as of the last step [N s]
} fmu_values;

typedef struct instance {
    fmi2CallbackFunctions callbacks;
    char name[FMU_TEXT];
    fmu_values values;
    run_loop *loop; // NULL: not yet begun
} instance;

// --- failures --------------------------------------------------------------------------

// Tells the importer the sentence.
static fmi2Status fail(const instance *m, const fault *f)
{
    if (m->callbacks.logger != NULL) {
        m->callbacks.logger(m->callbacks.componentEnvironment, m->name, fmi2Error,
                            "logStatusError", "%s", f->text);
    }
    return fmi2Error;
}

static fmi2Status refuse(const instance *m, const char *sentence)
{
    fault f;
    fault_set(&f, STATUS_BAD_ARGUMENT, "%s", sentence);
    return fail(m, &f);
}

static fmi2Status refuse_variable(const instance *m, fmi2ValueReference variable)
{
    fault f;
    fault_set(
        &f, STATUS_BAD_ARGUMENT,
        "there is no variable of this type with the value reference %u, that may be "
        "read or set so",
        variable);
    return fail(m, &f);
}

// --- the loop --------------------------------------------------------------------------

static void drop_loop(instance *m)
{
    loop_destroy(m->loop);
    m->loop = NULL;
}

// Begins the loop with parameters; the scenario's other parts stay in fmu_given.
static status begin_with(instance *m, const parameters *start, fault *f)
{
    scenario s = {.name = (char *)fmu_given.name,
                  .parameters = fmu_given.parameters,
                  .actions = (action *)fmu_given.actions,
                  .action_count = fmu_given.action_count};
    TRY(scenario_take_parameters(&s, start, f));
    const loop_options options = {.commanded = m->values.commanded != fmi2False};
    TRY(loop_create(&m->loop, &s, &options, f));
    m->values.started = *start;
    m->values.wanted = s.parameters;
    memset(m->values.changed, 0, sizeof m->values.changed);
    return STATUS_OK;
}

// The loop, begun if need be. False, and the importer has been told, if it cannot begin.
static bool has_loop(instance *m)
{
    fault f;
    const parameters start = m->values.wanted;
    if (m->loop == NULL && begin_with(m, &start, &f) != STATUS_OK) {
        fail(m, &f);
        return false;
    }
    return true;
}

static void start_again(instance *m)
{
    drop_loop(m);
    memset(&m->values, 0, sizeof m->values);
    m->values.wanted = fmu_given.parameters;
}

// --- beginning and end -----------------------------------------------------------------

const char *fmi2GetTypesPlatform(void)
{
    return fmi2TypesPlatform;
}

const char *fmi2GetVersion(void)
{
    return fmi2Version;
}

// Only errors are ever told.
fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t count,
                               const fmi2String categories[])
{
    (void)c;
    (void)on;
    (void)count;
    (void)categories;
    return fmi2OK;
}

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid,
                              fmi2String resources,
                              const fmi2CallbackFunctions *callbacks, fmi2Boolean visible,
                              fmi2Boolean logging)
{
    (void)resources;
    (void)visible;
    (void)logging;
    instance made = {.loop = NULL};
    if (callbacks != NULL) {
        made.callbacks = *callbacks;
    }
    snprintf(made.name, sizeof made.name, "%s", name != NULL ? name : "");
    if (type != fmi2CoSimulation) {
        refuse(&made, "this FMU is for co-simulation, not for model exchange");
        return NULL;
    }
    if (guid == NULL || strcmp(guid, fmu_given.guid) != 0) {
        refuse(&made, "the guid is another than this FMU's: modelDescription.xml and the "
                      "code do not belong together");
        return NULL;
    }

    instance *m = malloc(sizeof *m);
    if (m == NULL) {
        refuse(&made, "no memory for an instance");
        return NULL;
    }
    *m = made;
    start_again(m);
    return m;
}

void fmi2FreeInstance(fmi2Component c)
{
    instance *m = c;
    if (m != NULL) {
        drop_loop(m);
        free(m);
    }
}

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean tolerance_given,
                               fmi2Real tolerance, fmi2Real start, fmi2Boolean stop_given,
                               fmi2Real stop)
{
    (void)tolerance_given;
    (void)tolerance;
    instance *m = c;
    if (start != 0) {
        return refuse(m, "a run starts at 0 s, expected startTime = 0");
    }

    // without an end it may go on for as long as any run
    const int duration = PARAMETER_INDEX(run.duration);
    if (!stop_given || !isfinite(stop)) {
        stop = parameter_table[duration].maximum;
    }
    fault f;
    drop_loop(m);
    if (parameter_set_number(&m->values.wanted, duration, stop, &f) != STATUS_OK) {
        return fail(m, &f);
    }
    return fmi2OK;
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c)
{
    (void)c;
    return fmi2OK;
}

fmi2Status fmi2ExitInitializationMode(fmi2Component c)
{
    instance *m = c;
    if (!has_loop(m)) {
        return fmi2Error;
    }
    m->values.stage = STAGE_RUNNING;
    return fmi2OK;
}

fmi2Status fmi2Terminate(fmi2Component c)
{
    instance *m = c;
    m->values.stage = STAGE_OVER;
    return fmi2OK;
}

fmi2Status fmi2Reset(fmi2Component c)
{
    start_again(c);
    return fmi2OK;
}

// --- variables -------------------------------------------------------------------------

// The place of a parameter of one of two types; -1 if the reference is another's.
static int parameter_of(fmi2ValueReference variable, parameter_type type,
                        parameter_type other)
{
    if (variable >= (unsigned)parameter_count) {
        return -1;
    }
    const parameter_type own = parameter_table[variable].type;
    return own == type || own == other ? (int)variable : -1;
}

// A parameter was given another value.
static fmi2Status note_change(instance *m, int parameter)
{
    m->values.changed[parameter] = 1;
    if (m->values.stage == STAGE_SET_UP) {
        drop_loop(m);
    }
    return fmi2OK;
}

// Whether a parameter may be set now; else the importer has been told.
static bool may_set(const instance *m, int parameter)
{
    if (m->values.stage == STAGE_SET_UP || parameter_table[parameter].timed) {
        return true;
    }
    fault f;
    fault_set(&f, STATUS_BAD_ARGUMENT,
              "%s holds from the start and cannot change during a run",
              parameter_table[parameter].path);
    fail(m, &f);
    return false;
}

static fmi2Status set_number(instance *m, int parameter, double value)
{
    fault f;
    if (value == parameter_get(&m->values.wanted, parameter)) {
        return fmi2OK;
    }
    if (!may_set(m, parameter)) {
        return fmi2Error;
    }
    if (parameter_set_number(&m->values.wanted, parameter, value, &f) != STATUS_OK) {
        return fail(m, &f);
    }
    return note_change(m, parameter);
}

// The text of a parameter that is one.
static const char *text_of(const instance *m, int parameter)
{
    return (const char *)&m->values.wanted + parameter_table[parameter].offset;
}

static fmi2Status set_text(instance *m, int parameter, const char *text)
{
    fault f;
    if (strcmp(text, text_of(m, parameter)) == 0) {
        return fmi2OK;
    }
    if (!may_set(m, parameter)) {
        return fmi2Error;
    }
    if (parameter_set_text(&m->values.wanted, parameter, text, &f) != STATUS_OK) {
        return fail(m, &f);
    }
    return note_change(m, parameter);
}

fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference variables[],
                       size_t count, fmi2Real values[])
{
    instance *m = c;
    sample row;
    bool known = false; // one row serves all signals
    for (size_t i = 0; i < count; i++) {
        const fmi2ValueReference v = variables[i];
        const int parameter = parameter_of(v, PARAMETER_REAL, PARAMETER_REAL);
        if (v >= FMU_SIGNALS && v < FMU_SIGNALS + (unsigned)signal_count) {
            if (!known && !has_loop(m)) {
                return fmi2Error;
            }
            if (!known) {
                row = loop_row(m->loop);
                known = true;
            }
            values[i] = signal_value(&row, (int)(v - FMU_SIGNALS));
        } else if (v == FMU_COMMAND) {
            values[i] = m->values.command;
        } else if (v == FMU_PUSH) {
            values[i] = m->values.push;
        } else if (parameter >= 0) {
            values[i] = parameter_get(&m->values.wanted, parameter);
        } else {
            return refuse_variable(m, v);
        }
    }
    return fmi2OK;
}

fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference variables[],
                       size_t count, const fmi2Real values[])
{
    instance *m = c;
    for (size_t i = 0; i < count; i++) {
        const fmi2ValueReference v = variables[i];
        const int parameter = parameter_of(v, PARAMETER_REAL, PARAMETER_REAL);
        if (!isfinite(values[i])) {
            return refuse(m, "a value is not finite, expected a number");
        }
        if (v == FMU_COMMAND) {
            m->values.command = values[i];
        } else if (v == FMU_PUSH) {
            m->values.push = values[i];
        } else if (parameter < 0) {
            return refuse_variable(m, v);
        } else if (set_number(m, parameter, values[i]) != fmi2OK) {
            return fmi2Error;
        }
    }
    return fmi2OK;
}

fmi2Status fmi2GetInteger(fmi2Component c, const fmi2ValueReference variables[],
                          size_t count, fmi2Integer values[])
{
    const instance *m = c;
    for (size_t i = 0; i < count; i++) {
        const int parameter =
            parameter_of(variables[i], PARAMETER_INTEGER, PARAMETER_CHOICE);
        if (parameter < 0) {
            return refuse_variable(m, variables[i]);
        }
        values[i] = (fmi2Integer)parameter_get(&m->values.wanted, parameter);
    }
    return fmi2OK;
}

fmi2Status fmi2SetInteger(fmi2Component c, const fmi2ValueReference variables[],
                          size_t count, const fmi2Integer values[])
{
    instance *m = c;
    for (size_t i = 0; i < count; i++) {
        const int parameter =
            parameter_of(variables[i], PARAMETER_INTEGER, PARAMETER_CHOICE);
        if (parameter < 0) {
            return refuse_variable(m, variables[i]);
        }
        if (set_number(m, parameter, values[i]) != fmi2OK) {
            return fmi2Error;
        }
    }
    return fmi2OK;
}

fmi2Status fmi2GetBoolean(fmi2Component c, const fmi2ValueReference variables[],
                          size_t count, fmi2Boolean values[])
{
    const instance *m = c;
    for (size_t i = 0; i < count; i++) {
        const int parameter =
            parameter_of(variables[i], PARAMETER_BOOLEAN, PARAMETER_BOOLEAN);
        if (variables[i] == FMU_COMMANDED) {
            values[i] = m->values.commanded;
        } else if (parameter >= 0) {
            values[i] = parameter_get(&m->values.wanted, parameter) != 0;
        } else {
            return refuse_variable(m, variables[i]);
        }
    }
    return fmi2OK;
}

fmi2Status fmi2SetBoolean(fmi2Component c, const fmi2ValueReference variables[],
                          size_t count, const fmi2Boolean values[])
{
    instance *m = c;
    for (size_t i = 0; i < count; i++) {
        const int parameter =
            parameter_of(variables[i], PARAMETER_BOOLEAN, PARAMETER_BOOLEAN);
        const fmi2Boolean value = values[i] != fmi2False;
        if (variables[i] == FMU_COMMANDED) {
            if (m->values.stage != STAGE_SET_UP && value != m->values.commanded) {
                return refuse(m, "commanded holds from the start and cannot change "
                                 "during a run");
            }
            m->values.commanded = value;
            if (m->values.stage == STAGE_SET_UP) {
                drop_loop(m);
            }
        } else if (parameter < 0) {
            return refuse_variable(m, variables[i]);
        } else if (set_number(m, parameter, value) != fmi2OK) {
            return fmi2Error;
        }
    }
    return fmi2OK;
}

fmi2Status fmi2GetString(fmi2Component c, const fmi2ValueReference variables[],
                         size_t count, fmi2String values[])
{
    const instance *m = c;
    for (size_t i = 0; i < count; i++) {
        const int parameter = parameter_of(variables[i], PARAMETER_TEXT, PARAMETER_LIST);
        if (parameter < 0) {
            return refuse_variable(m, variables[i]);
        }
        values[i] = text_of(m, parameter);
    }
    return fmi2OK;
}

fmi2Status fmi2SetString(fmi2Component c, const fmi2ValueReference variables[],
                         size_t count, const fmi2String values[])
{
    instance *m = c;
    for (size_t i = 0; i < count; i++) {
        const int parameter = parameter_of(variables[i], PARAMETER_TEXT, PARAMETER_LIST);
        if (parameter < 0) {
            return refuse_variable(m, variables[i]);
        }
        if (set_text(m, parameter, values[i] != NULL ? values[i] : "") != fmi2OK) {
            return fmi2Error;
        }
    }
    return fmi2OK;
}

// --- steps -----------------------------------------------------------------------------

// Tells the loop the parameters that have changed.
static status tell_changes(instance *m, fault *f)
{
    for (int i = 0; i < parameter_count; i++) {
        if (m->values.changed[i] == 0) {
            continue;
        }
        m->values.changed[i] = 0;
        if (parameter_is_text(&parameter_table[i])) {
            TRY(loop_set_text(m->loop, i, text_of(m, i), f));
        } else {
            TRY(loop_set_number(m->loop, i, parameter_get(&m->values.wanted, i), f));
        }
    }
    return STATUS_OK;
}

// Tells the loop all inputs. A push acts once, in the step in which it has a new value.
static status tell_inputs(instance *m, fault *f)
{
    fmu_values *v = &m->values;
    TRY(tell_changes(m, f));
    FAULT_IF(
        !v->commanded && v->command != 0, f, STATUS_BAD_ARGUMENT,
        "motor_command = %g V has no effect, since control.law or motor.voltage commands "
        "the motor; expected commanded = true at the start",
        v->command);
    if (v->commanded) {
        loop_command(m->loop, v->command);
    }
    if (v->push != v->last_push && v->push != 0) {
        TRY(loop_push(m->loop, v->push, f));
    }
    v->last_push = v->push;
    return STATUS_OK;
}

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real point, fmi2Real step,
                      fmi2Boolean no_way_back)
{
    (void)no_way_back;
    instance *m = c;
    const double until = point + step;
    if (m->values.stage != STAGE_RUNNING) {
        return refuse(m, "a step before the end of initialisation or after termination");
    }
    if (!isfinite(until) || step < 0) {
        return refuse(m, "a step goes forward to a finite instant");
    }

    // a step begins where the last one ended, but for rounding
    fault f;
    if (fabs(point - m->values.time) > SAME_INSTANT * (1 + fabs(point))) {
        fault_set(&f, STATUS_BAD_ARGUMENT,
                  "a step from %.9g s, but the FMU is at %.9g s; the way back is a saved "
                  "state",
                  point, m->values.time);
        return fail(m, &f);
    }
    const double end = loop_scenario(m->loop)->parameters.run.duration;
    if (until > end * (1 + SAME_INSTANT)) {
        fault_set(&f, STATUS_BAD_ARGUMENT,
                  "a step to %.9g s, but the run ends at %.9g s (stopTime)", until, end);
        return fail(m, &f);
    }

    if (tell_inputs(m, &f) != STATUS_OK || loop_until(m->loop, until, &f) != STATUS_OK) {
        return fail(m, &f);
    }
    m->values.time = until;
    return fmi2OK;
}

fmi2Status fmi2CancelStep(fmi2Component c)
{
    return refuse(c, "no step is under way: each is complete when its call returns");
}

// --- states ----------------------------------------------------------------------------

// What an fmi2FMUstate points to.
typedef struct saved_state {
    fmu_values values;
    size_t loop_size; // of the loop's bytes that follow; 0: it had not begun
    unsigned char loop[];
} saved_state;

static size_t state_size(const saved_state *s)
{
    return sizeof *s + s->loop_size;
}

fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate *state)
{
    (void)c;
    free(*state);
    *state = NULL;
    return fmi2OK;
}

fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate *state)
{
    const instance *m = c;
    const size_t loop_size = m->loop != NULL ? loop_saved_size(m->loop) : 0;
    saved_state *s = calloc(1, sizeof *s + loop_size);
    if (s == NULL) {
        return refuse(m, "no memory for a state");
    }
    s->values = m->values;
    s->loop_size = loop_size;
    if (m->loop != NULL) {
        loop_save(m->loop, s->loop);
    }

    // one that was there before is replaced
    free(*state);
    *state = s;
    return fmi2OK;
}

// Gives an instance a loop that a state's bytes fit: one with the same parameters.
static status begin_like(instance *m, const fmu_values *v, fault *f)
{
    if (m->loop != NULL && m->values.commanded == v->commanded &&
        memcmp(&m->values.started, &v->started, sizeof v->started) == 0) {
        return STATUS_OK;
    }
    drop_loop(m);
    m->values.commanded = v->commanded;
    return begin_with(m, &v->started, f);
}

fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate state)
{
    instance *m = c;
    const saved_state *s = state;
    fault f;
    if (s->loop_size == 0) {
        drop_loop(m);
    } else if (begin_like(m, &s->values, &f) != STATUS_OK ||
               loop_restore(m->loop, s->loop, s->loop_size, &f) != STATUS_OK) {
        return fail(m, &f);
    }
    m->values = s->values;
    return fmi2OK;
}

// A serialised state begins with the digest of the FMU and of the bytes behind it.
static void digest_of(const void *bytes, size_t size, char digest[SHA256_TEXT])
{
    sha256 h;
    sha256_init(&h);
    sha256_add_text(&h, fmu_given.guid);
    sha256_add(&h, bytes, size);
    sha256_finish(&h, digest);
}

fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate state, size_t *size)
{
    (void)c;
    *size = SHA256_TEXT + state_size(state);
    return fmi2OK;
}

fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate state, fmi2Byte bytes[],
                                 size_t size)
{
    const size_t own = state_size(state);
    if (size < SHA256_TEXT + own) {
        return refuse(c, "there is not enough room for the state");
    }
    digest_of(state, own, bytes);
    memcpy(bytes + SHA256_TEXT, state, own);
    return fmi2OK;
}

fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte bytes[], size_t size,
                                   fmi2FMUstate *state)
{
    char digest[SHA256_TEXT] = "";
    if (size >= SHA256_TEXT + sizeof(saved_state)) {
        digest_of(bytes + SHA256_TEXT, size - SHA256_TEXT, digest);
    }
    if (digest[0] == '\0' || memcmp(digest, bytes, SHA256_TEXT) != 0) {
        return refuse(c, "the bytes are damaged or the state of another FMU, expected "
                         "them as they were serialised");
    }

    saved_state *s = malloc(size - SHA256_TEXT);
    if (s == NULL) {
        return refuse(c, "no memory for a state");
    }
    memcpy(s, bytes + SHA256_TEXT, size - SHA256_TEXT);
    *state = s;
    return fmi2OK;
}

// --- what the description says is not there --------------------------------------------

fmi2Status fmi2GetDirectionalDerivative(fmi2Component c,
                                        const fmi2ValueReference unknowns[],
                                        size_t unknown_count,
                                        const fmi2ValueReference knowns[],
                                        size_t known_count, const fmi2Real by[],
                                        fmi2Real derivatives[])
{
    (void)unknowns;
    (void)unknown_count;
    (void)knowns;
    (void)known_count;
    (void)by;
    (void)derivatives;
    return refuse(c, "this FMU has no directional derivatives");
}

fmi2Status fmi2SetRealInputDerivatives(fmi2Component c,
                                       const fmi2ValueReference variables[], size_t count,
                                       const fmi2Integer orders[],
                                       const fmi2Real values[])
{
    (void)variables;
    (void)count;
    (void)orders;
    (void)values;
    return refuse(c, "inputs are held during a step, their derivatives have no effect");
}

fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c,
                                        const fmi2ValueReference variables[],
                                        size_t count, const fmi2Integer orders[],
                                        fmi2Real values[])
{
    (void)variables;
    (void)count;
    (void)orders;
    (void)values;
    return refuse(c, "this FMU has no derivatives of its outputs");
}

// No step is ever pending, so that there is nothing to be told.
fmi2Status fmi2GetStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Status *value)
{
    (void)c;
    (void)kind;
    (void)value;
    return fmi2Discard;
}

fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Real *value)
{
    const instance *m = c;
    if (kind != fmi2LastSuccessfulTime) {
        return fmi2Discard;
    }
    *value = m->values.time;
    return fmi2OK;
}

fmi2Status fmi2GetIntegerStatus(fmi2Component c, const fmi2StatusKind kind,
                                fmi2Integer *value)
{
    (void)c;
    (void)kind;
    (void)value;
    return fmi2Discard;
}

fmi2Status fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind kind,
                                fmi2Boolean *value)
{
    (void)c;
    (void)kind;
    (void)value;
    return fmi2Discard;
}

fmi2Status fmi2GetStringStatus(fmi2Component c, const fmi2StatusKind kind,
                               fmi2String *value)
{
    (void)c;
    (void)kind;
    (void)value;
    return fmi2Discard;
}
