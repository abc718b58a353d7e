// What the laws share that close the loop over the force reading alone (force-pd,
// force-integral, discontinuous), and the one that closes none (open-loop): modes,
// parameters and memory.
//
// With the static torque 2 f l of the wanted force f, the hub's velocity w and K the
// torque per volt, force-pd and discontinuous send in contact
//
//     u = (2 f l - kv w)/K + force_gain (f - reading)
#include <math.h>
#include <string.h>

#include "src/rig/laws/law_parts.h"

enum { APPROACH, CONTACT }; // modes

// Their parameters, by their names in control.*, in the order of the table.
enum {
    FORCE_WANTED,
    APPROACH_VOLTAGE,
    KV,
    THRESHOLD,
    FORCE_GAIN,
    INTEGRAL_GAIN,
    PARAMETERS
};

typedef struct force_memory {
    controller_setup rig;
    double p[PARAMETERS]; // values of the parameters
    set_point wanted;
    int mode;
    double integral; // force-integral's command [V]
} force_memory;

// A controller of this family: its word, whether it can be held in a mode, its sample
// function.
#define FORCE_FEEDBACK_LAW(law, obeys, samples)                                          \
    CONTROLLER_LAW(law, force_feedback_modes, force_feedback_parameters, force_memory,   \
                   .lockable = obeys, .start = force_feedback_start, .sample = samples,  \
                   .tune = force_feedback_tune)

static const char *const force_feedback_modes[] = {"approach", "contact", NULL};

static const controller_parameter force_feedback_parameters[PARAMETERS] = {
    [FORCE_WANTED] = {.name = "force"},
    [APPROACH_VOLTAGE] = {.name = "approach_voltage"},
    [KV] = {.name = "kv"},
    [THRESHOLD] = {.name = "contact_threshold"},
    [FORCE_GAIN] = {.name = "force_gain"},
    [INTEGRAL_GAIN] = {.name = "integral_gain"},
};

// Takes setup and parameters into a force_memory, at the start or later; never refuses.
static const char *force_feedback_tune(void *memory, const controller_setup *setup)
{
    force_memory *m = memory;
    set_point_tell(&m->wanted, SET_POINT_PACE, setup->parameters[FORCE_WANTED],
                   setup->period, m->rig.period == 0);
    m->rig = setup_kept(setup);
    memcpy(m->p, setup->parameters, sizeof m->p);
    return NULL;
}

// As the tuning; the command of force-integral begins with that of the approach.
static const char *force_feedback_start(void *memory, const controller_setup *setup)
{
    force_memory *m = memory;
    const char *refusal = force_feedback_tune(memory, setup);
    m->integral = m->p[APPROACH_VOLTAGE];
    return refusal;
}

// Chooses the mode: CONTACT from the first reading above the threshold on, or the mode
// that the user holds the law in.
static void force_feedback_choose_mode(force_memory *m, const controller_input *in)
{
    bool contact = m->mode == CONTACT || in->force > m->p[THRESHOLD];
    if (in->wanted_mode >= 0) {
        m->mode = in->wanted_mode;
    } else if (contact) {
        m->mode = CONTACT;
    } else {
        m->mode = APPROACH;
    }
}

// The law of force-pd, with the torque and the turn of a set-point that moves [V].
static double force_feedback_command(const force_memory *m, const controller_input *in)
{
    // a set-point that moves turns the hub
    const double f = m->wanted.force, turn = set_point_turn(&m->wanted, &m->rig);
    double torque = 2 * f * m->rig.link_length - m->p[KV] * (in->tachometer - turn);
    torque += set_point_torque(&m->wanted, &m->rig);
    return torque / m->rig.torque_per_volt + m->p[FORCE_GAIN] * (f - in->force);
}

// --- open-loop ---

// The constant command of the approach, whatever the sensors read: figures 2.4 to 2.6.
static void open_loop_sample(void *memory, const controller_input *in,
                             controller_output *out)
{
    force_memory *m = memory;
    (void)in;
    out->command = m->p[APPROACH_VOLTAGE];
}

const controller open_loop_law = FORCE_FEEDBACK_LAW("open-loop", false, open_loop_sample);

// --- force-pd ---

// Static torque of the wanted force with feedback of the force error and of the hub's
// velocity, once contact was felt.
static void force_pd_sample(void *memory, const controller_input *in,
                            controller_output *out)
{
    force_memory *m = memory;
    set_point_follow(&m->wanted, m->rig.period);
    force_feedback_choose_mode(m, in);
    out->mode = m->mode;
    if (m->mode == CONTACT) {
        out->command = force_feedback_command(m, in);
    } else {
        out->command = m->p[APPROACH_VOLTAGE];
    }
}

const controller force_pd_law = FORCE_FEEDBACK_LAW("force-pd", true, force_pd_sample);

// --- discontinuous ---

// One law while the sensor feels the wall and another while it does not, without memory
// (after Mills): force feedback here, the plain approach there.
static void discontinuous_sample(void *memory, const controller_input *in,
                                 controller_output *out)
{
    force_memory *m = memory;
    set_point_follow(&m->wanted, m->rig.period);

    // contact by this reading alone, unless the user holds the law in a mode
    bool contact = in->force > m->p[THRESHOLD];
    if (in->wanted_mode >= 0) {
        contact = in->wanted_mode == CONTACT;
    }
    if (contact) {
        out->mode = CONTACT;
    } else {
        out->mode = APPROACH;
    }
    if (contact) {
        out->command = force_feedback_command(m, in);
    } else {
        out->command = m->p[APPROACH_VOLTAGE];
    }
}

const controller discontinuous_law =
    FORCE_FEEDBACK_LAW("discontinuous", true, discontinuous_sample);

// --- force-integral ---

// Explicit integral force control (Youcef-Toumi and Gutz): from contact on the command is
// the integral of the force's error, u' = integral_gain (f - reading), which filters the
// impact's spikes.
static void force_integral_sample(void *memory, const controller_input *in,
                                  controller_output *out)
{
    force_memory *m = memory;
    force_feedback_choose_mode(m, in);

    // the integral is the command itself, so that modes join without a jump
    if (m->mode == APPROACH) {
        // after a release the present command continues
        m->integral = m->p[APPROACH_VOLTAGE];
    } else {
        double error = m->p[FORCE_WANTED] - in->force, limit = m->rig.voltage_limit;
        m->integral += m->p[INTEGRAL_GAIN] * error * m->rig.period;
        m->integral = fmax(-limit, fmin(m->integral, limit)); // no windup
    }
    out->mode = m->mode;
    out->command = m->integral;
}

const controller force_integral_law =
    FORCE_FEEDBACK_LAW("force-integral", true, force_integral_sample);
