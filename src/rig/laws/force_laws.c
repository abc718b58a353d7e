// Laws that close the loop over the force reading, and the one that closes none.
#include <math.h>

#include "src/rig/laws/laws.h"

enum { APPROACH, CONTACT };
static const char *const mode_names[] = {"approach", "contact", NULL};

enum { FORCE_WANTED, APPROACH_VOLTAGE, KV, THRESHOLD, FORCE_GAIN, INTEGRAL_GAIN, PARAMETERS };
static const controller_parameter table[PARAMETERS] = {
    {.name = "force"},      {.name = "approach_voltage"},
    {.name = "kv"},         {.name = "contact_threshold"},
    {.name = "force_gain"}, {.name = "integral_gain"},
};

typedef struct force_memory {
    controller_setup rig;
    double p[PARAMETERS];
    int mode;
    double integral; // [V]
} force_memory;

static const char *start(void *memory, const controller_setup *setup)
{
    force_memory *m = memory;
    m->rig = *setup;
    for (int i = 0; i < PARAMETERS; i++) {
        m->p[i] = setup->parameters[i];
    }
    m->integral = m->p[APPROACH_VOLTAGE];
    return NULL;
}

// A constant command.
static void sample_open_loop(void *memory, const controller_input *in, controller_output *out)
{
    force_memory *m = memory;
    (void)in;
    out->command = m->p[APPROACH_VOLTAGE];
}

// Contact once it was felt, and from then on, unless the law is held in a mode.
static void choose_mode(force_memory *m, const controller_input *in)
{
    bool contact = m->mode == CONTACT || in->force > m->p[THRESHOLD];
    m->mode = in->wanted_mode >= 0 ? in->wanted_mode : contact ? CONTACT : APPROACH;
}

// Static torque of the wanted force, 2 f l, with feedback of the force's error and hub velocity
// [V].
static double force_pd(const force_memory *m, const controller_input *in)
{
    double torque = 2 * m->p[FORCE_WANTED] * m->rig.link_length - m->p[KV] * in->tachometer;
    return torque / m->rig.torque_per_volt + m->p[FORCE_GAIN] * (m->p[FORCE_WANTED] - in->force);
}

static void sample_force_pd(void *memory, const controller_input *in, controller_output *out)
{
    force_memory *m = memory;
    choose_mode(m, in);
    out->mode = m->mode;
    out->command = m->mode == CONTACT ? force_pd(m, in) : m->p[APPROACH_VOLTAGE];
}

// Explicit integral force control (Youcef-Toumi and Gutz): from contact on the command is the
// integral of the force's error, which filters the impact's spikes.
static void sample_force_integral(void *memory, const controller_input *in, controller_output *out)
{
    force_memory *m = memory;
    choose_mode(m, in);
    if (m->mode == APPROACH) {
        // a release goes on from the command there is
        m->integral = m->p[APPROACH_VOLTAGE];
    } else {
        double error = m->p[FORCE_WANTED] - in->force, limit = m->rig.voltage_limit;
        m->integral += m->p[INTEGRAL_GAIN] * error * m->rig.period;
        m->integral = fmax(-limit, fmin(m->integral, limit)); // no windup
    }
    out->mode = m->mode;
    out->command = m->integral;
}

// One law while the sensor feels the wall and another while it does not, without memory (after
// Mills): force feedback here, the plain approach with damping there.
static void sample_discontinuous(void *memory, const controller_input *in, controller_output *out)
{
    force_memory *m = memory;
    bool contact = in->wanted_mode >= 0 ? in->wanted_mode == CONTACT : in->force > m->p[THRESHOLD];
    out->mode = contact ? CONTACT : APPROACH;
    out->command = contact ? force_pd(m, in) : m->p[APPROACH_VOLTAGE];
}

#define LAW(law, obeys, samples)                                                                   \
    {                                                                                              \
        .interface = CONTROLLER_INTERFACE, .name = law, .modes = mode_names, .lockable = obeys,    \
        .parameters = table, .parameter_count = PARAMETERS, .memory_size = sizeof(force_memory),   \
        .start = start, .sample = samples                                                          \
    }

const controller open_loop_law = LAW("open-loop", false, sample_open_loop);
const controller force_pd_law = LAW("force-pd", true, sample_force_pd);
const controller force_integral_law = LAW("force-integral", true, sample_force_integral);
const controller discontinuous_law = LAW("discontinuous", true, sample_discontinuous);
