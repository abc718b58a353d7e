#include "src/rig/rig.h"

#include <dlfcn.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/arm/arm.h"
#include "src/quantities/k2_table.h"
#include "src/rig/laws/laws.h"
#include "src/base/words.h"
#include "src/base/numbers.h"

const controller *controller_of(int law)
{
    static const controller *const built_in[] = {[LAW_OPEN_LOOP] = &open_loop_law,
                                                 [LAW_HYBRID] = &hybrid_law,
                                                 [LAW_FORCE_PD] = &force_pd_law,
                                                 [LAW_FORCE_INTEGRAL] = &force_integral_law,
                                                 [LAW_REVERSE_TORQUE] = &reverse_torque_law,
                                                 [LAW_SPEED_LIMIT] = &speed_limit_law,
                                                 [LAW_BANG_BANG] = &bang_bang_law,
                                                 [LAW_DISCONTINUOUS] = &discontinuous_law,
                                                 [LAW_RECOVERING] = &recovering_law,
                                                 [LAW_OPTIMAL] = &optimal_law,
                                                 [LAW_PREDICTIVE] = &predictive_law,
                                                 [LAW_INVERSE_DYNAMICS] = &inverse_dynamics_law,
                                                 [LAW_PLUGIN] = NULL};
    return built_in[law];
}

// --- starting -------------------------------------------------------------------------------

static status load_plugin(rig *r, const char *file, fault *f)
{
    r->library = dlopen(file, RTLD_NOW | RTLD_LOCAL);
    if (r->library == NULL) {
        return fault_set(f, STATUS_CANNOT_READ, "control.plugin = %s cannot be loaded: %.600s",
                         file, dlerror());
    }
    // a function behind a pointer to data: as POSIX has it
    controller_entry entry = NULL;
    void *symbol = dlsym(r->library, CONTROLLER_ENTRY);
    memcpy(&entry, &symbol, sizeof entry);
    r->law = entry != NULL ? entry() : NULL;
    if (r->law == NULL) {
        return fault_set(f, STATUS_BAD_SCENARIO,
                         "control.plugin = %s has no function %s that returns a controller", file,
                         CONTROLLER_ENTRY);
    }
    if (r->law->interface != CONTROLLER_INTERFACE) {
        return fault_set(
            f, STATUS_BAD_SCENARIO,
            "control.plugin = %s was made for version %d of the interface, expected %d; "
            "compile it again",
            file, r->law->interface, CONTROLLER_INTERFACE);
    }
    if (r->law->sample == NULL) {
        return fault_set(f, STATUS_BAD_SCENARIO, "control.plugin = %s has no function `sample`",
                         file);
    }
    return STATUS_OK;
}

// Initial values, then those of the scenario's parameters of the same name.
static void take_parameters(rig *r, const parameters *p)
{
    for (int i = 0; i < r->law->parameter_count; i++) {
        const controller_parameter *wanted = &r->law->parameters[i];
        char path[80];
        snprintf(path, sizeof path, "control.%.60s", wanted->name);
        int index = parameter_find(path);
        bool own = r->library != NULL && (index < 0 || !p->set[index]);
        r->values[i] = index < 0 || own ? wanted->initial : parameter_get(p, index);
    }
}

static status take_setting(rig *r, const char *word, size_t length, fault *f)
{
    const char *equals = memchr(word, '=', length);
    size_t name = equals != NULL ? (size_t)(equals - word) : length;
    for (int i = 0; i < r->law->parameter_count; i++) {
        const controller_parameter *wanted = &r->law->parameters[i];
        if (strlen(wanted->name) != name || strncmp(wanted->name, word, name) != 0) {
            continue;
        }
        char text[PARAMETER_TEXT_SIZE] = "";
        const char *end = text;
        double value = 0;
        if (equals != NULL) {
            memcpy(text, equals + 1, length - name - 1);
        }
        if (!decimal_read(text, &value, &end) || *end != '\0' ||
            !(value >= wanted->minimum && value <= wanted->maximum)) {
            return fault_set(
                f, STATUS_BAD_SCENARIO,
                "control.settings: '%.*s' is wrong, expected %s=NUMBER from %g to %g%s%s",
                (int)length, word, wanted->name, wanted->minimum, wanted->maximum,
                wanted->unit[0] ? " " : "", wanted->unit);
        }
        r->values[i] = value;
        return STATUS_OK;
    }
    char written[PARAMETER_TEXT_SIZE] = "";
    memcpy(written, word, name);
    nearest_word near = nearest_begin(written);
    for (int i = 0; i < r->law->parameter_count; i++) {
        nearest_try(&near, r->law->parameters[i].name);
    }
    return fault_set(f, STATUS_BAD_SCENARIO,
                     "control.settings: the controller '%s' has no parameter '%.*s'%s%s%s",
                     r->law->name, (int)name, word, near.best ? ", did you mean '" : "",
                     near.best ? near.best : "", near.best ? "'?" : "");
}

static status take_settings(rig *r, const char *settings, fault *f)
{
    status s = STATUS_OK;
    while (s == STATUS_OK && *(settings += strspn(settings, " ")) != '\0') {
        size_t length = strcspn(settings, " ");
        s = take_setting(r, settings, length, f);
        settings += length;
    }
    return s;
}

// "approach, impact or force"
static void list_modes(const controller *law, char *text, size_t size)
{
    size_t used = 0;
    text[0] = '\0';
    for (int i = 0; law->modes != NULL && law->modes[i] != NULL && used < size; i++) {
        const char *before = i == 0 ? "" : law->modes[i + 1] == NULL ? " or " : ", ";
        used += (size_t)snprintf(text + used, size - used, "%s%.40s", before, law->modes[i]);
    }
}

status rig_find_mode(const controller *law, const char *lock, int *mode, fault *f)
{
    char modes[256];
    *mode = -1;
    if (lock[0] == '\0' || strcmp(lock, "none") == 0) {
        return STATUS_OK;
    }
    if (!law->lockable || law->modes == NULL) {
        return fault_set(f, STATUS_BAD_SCENARIO,
                         "control.lock = '%.60s', but the law '%s' cannot be held in a mode, "
                         "expected none",
                         lock, law->name);
    }
    for (int i = 0; law->modes[i] != NULL; i++) {
        if (strcmp(law->modes[i], lock) == 0) {
            *mode = i;
            return STATUS_OK;
        }
    }
    list_modes(law, modes, sizeof modes);
    return fault_set(f, STATUS_BAD_SCENARIO,
                     "control.lock = '%.60s' is no mode of the law '%s', expected none, %s", lock,
                     law->name, modes);
}

status rig_lock(rig *r, const char *lock, fault *f)
{
    int mode;
    status s = rig_find_mode(r->law, lock, &mode, f);
    r->lock = s == STATUS_OK ? mode : r->lock;
    return s;
}

int rig_mode_names(const parameters *p, char names[][MODE_NAME_SIZE], int most, bool *lockable)
{
    fault ignored;
    int count = 0;
    rig r = {.law = controller_of(p->control.law)};
    if (p->control.law == LAW_PLUGIN && load_plugin(&r, p->control.plugin, &ignored) != STATUS_OK) {
        r.law = NULL;
    }
    *lockable = r.law != NULL && r.law->lockable;
    const char *const *modes = r.law != NULL ? r.law->modes : NULL;
    for (; modes != NULL && modes[count] != NULL && count < most; count++) {
        snprintf(names[count], MODE_NAME_SIZE, "%s", modes[count]);
    }
    if (r.library != NULL) {
        dlclose(r.library);
    }
    return count;
}

static controller_setup make_setup(const rig *r, const parameters *p)
{
    // controllers work on the two-link beam, whatever the arm is
    double m = p->arm.mass / 2, l = p->arm.length / 2, k2 = p->arm.k2;
    k2_table measured;
    if (k2_table_read(&measured, p->control.k2_table, NULL) == STATUS_OK && measured.count > 0) {
        k2 = k2_table_at(&measured, p->control.force);
    }
    return (controller_setup){
        .period = r->period,
        .delay = r->delay,
        .voltage_limit = r->voltage_limit,
        .torque_per_volt = motor_torque_per_volt(&p->motor),
        .hub_damping = motor_damping(&p->motor),
        .stiction = p->motor.stiction,
        .hub_inertia = p->arm.hub_inertia,
        .link_mass = m,
        .link_length = l,
        .link_inertia = p->arm.links == 2 ? p->arm.link_inertia : m * l * l / 12,
        .k2 = k2 * p->control.k2_factor,
        .wall_angle = p->wall.angle + p->control.wall_error,
        .parameters = r->values,
    };
}

// Memory, values and the controller's own start, once it is known which controller it is.
static status start_controller(rig *r, const parameters *p, fault *f)
{
    size_t count = (size_t)(r->law->parameter_count > 0 ? r->law->parameter_count : 1);
    r->memory = calloc(1, r->law->memory_size + 1);
    r->values = calloc(count, sizeof *r->values);
    if (r->memory == NULL || r->values == NULL) {
        return fault_set(f, STATUS_NO_MEMORY, "no memory for the controller '%s'", r->law->name);
    }
    take_parameters(r, p);
    status s = take_settings(r, p->control.settings, f);
    controller_setup setup = make_setup(r, p);
    const char *refusal = s == STATUS_OK && r->law->start ? r->law->start(r->memory, &setup) : NULL;
    if (refusal != NULL) {
        return fault_set(f, STATUS_BAD_SCENARIO, "the controller '%s' cannot run: %.600s",
                         r->law->name, refusal);
    }
    return s;
}

static double sampling_instant(rig *r)
{
    double nominal = (double)r->samples * r->period;
    if (r->jitter == 0 || r->samples == 0) {
        return nominal;
    }
    return nominal + r->jitter * (random_uniform(&r->clock) - 0.5);
}

status rig_create(rig **created, const parameters *p, fault *f)
{
    rig *r = calloc(1, sizeof *r);
    *created = NULL;
    if (r == NULL) {
        return fault_set(f, STATUS_NO_MEMORY, "no memory for the rig");
    }
    r->period = 1 / p->control.rate;
    r->delay = p->control.delay + p->control.delay_periods * r->period;
    r->jitter = p->control.jitter;
    r->voltage_limit = p->motor.voltage_limit;
    r->effect_time = HUGE_VAL;
    r->output = (controller_output){.desired_angle = (double)NAN,
                                    .desired_velocity = (double)NAN,
                                    .calculated_force = (double)NAN};
    sensors_init(&r->sensors, &p->sensor, p->control.seed);
    random_seed(&r->clock, ~(uint64_t)p->control.seed);
    r->law = controller_of(p->control.law);
    status s = STATUS_OK;
    if (p->control.law == LAW_PLUGIN) {
        s = load_plugin(r, p->control.plugin, f);
    }
    s = s == STATUS_OK ? rig_lock(r, p->control.lock, f) : s;
    s = s == STATUS_OK ? start_controller(r, p, f) : s;
    if (s != STATUS_OK) {
        rig_destroy(r);
        return s;
    }
    *created = r;
    return STATUS_OK;
}

void rig_destroy(rig *r)
{
    if (r != NULL) {
        free(r->memory);
        free(r->values);
        if (r->library != NULL) {
            dlclose(r->library);
        }
        free(r);
    }
}

// --- the sampled loop -----------------------------------------------------------------------

double rig_next_time(const rig *r)
{
    return fmin(r->sample_time, r->effect_time);
}

static void apply(rig *r, bool *changed)
{
    *changed = *changed || r->pending != r->voltage;
    r->voltage = r->pending;
    r->effect_time = HUGE_VAL;
}

static status take_sample(rig *r, double time, const sensed_motion *now, fault *f)
{
    const sensor_reading *read = &r->reading;
    r->reading = sensors_read(&r->sensors, now);
    controller_input input = {.time = time,
                              .encoder = read->encoder,
                              .tachometer = read->tachometer,
                              .force = r->sensors.p.force == FORCE_BY_PIEZO ? read->piezo_force
                                                                            : read->force_reading,
                              .voltage = r->voltage,
                              .piezo_force = read->piezo_force,
                              .film = read->film,
                              .accelerometer = read->accelerometer,
                              .wanted_mode = r->lock};
    controller_output *out = &r->output;
    *out = (controller_output){.desired_angle = (double)NAN,
                               .desired_velocity = (double)NAN,
                               .calculated_force = (double)NAN};
    r->law->sample(r->memory, &input, out);
    if (!isfinite(out->command)) {
        return fault_set(
            f, STATUS_NOT_FINITE,
            "at t = %.9g s the controller '%s' gave the command %g V, expected a finite "
            "number; its sensors read %.6g rad, %.6g rad/s and %.6g N",
            time, r->law->name, out->command, input.encoder, input.tachometer, input.force);
    }
    r->pending = converter_value(out->command, r->sensors.p.dac_bits, r->voltage_limit);
    r->largest_command = fmax(r->largest_command, fabs(r->pending));
    r->effect_time = time + r->delay;
    r->samples++;
    r->sample_time = sampling_instant(r);
    return STATUS_OK;
}

status rig_act(rig *r, double time, const sensed_motion *now, bool *changed, fault *f)
{
    const double late = 1e-9 * r->period; // instants of another grid may miss ours by rounding
    const int mode = r->output.mode;
    status s = STATUS_OK;
    *changed = false;
    const bool samples = r->sample_time <= time + late;
    // with jitter the next sample may come before a late command: it goes out then
    if (r->effect_time <= time + late || (samples && r->effect_time < HUGE_VAL)) {
        apply(r, changed);
    }
    if (samples) {
        s = take_sample(r, time, now, f);
    }
    if (s == STATUS_OK && r->effect_time <= time + late) {
        apply(r, changed);
    }
    *changed = *changed || r->output.mode != mode;
    return s;
}
