// MuJoCo: the arm as hinges with springs, the wall either as the limit of a fixed tendon or as a
// plane that a tiny sphere at the tip meets.
//
// The tip (two links of equal length) lies in a flat wall through the hub axis exactly when
// q1 + q2 = 2 wall; in MuJoCo's relative angles that is the fixed tendon 2 j1 + j2, and the
// tendon's force t belongs to the contact force f = t / (l cos(q1 - wall)). Nothing is approximated
// by this, and no collision has to be detected.
#include <math.h>
#include <mujoco/mujoco.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tests/bench/peers/peer.h"

typedef enum mujoco_variant {
    TENDON_EULER,
    SPHERE_EULER,
    TENDON_IMPLICIT,
    TENDON_RK4,
    TENDON_DEFAULTS,
    FREE_FLIGHT
} mujoco_variant;

typedef struct simulation {
    mjModel *model;
    mjData *data;
    int links;
    bool sphere;
    double duration; // [s]
} simulation;

enum { XML_SIZE = 1 << 17 };
#define CHAIN_STEPS   1000  // of a chain's timed run
#define LARGEST_SPEED 100.0 // a chain faster than this has become unstable [rad/s]
#define SHORTEST_STEP 1e-7  // where the search for a stable step gives up [s]

static int warnings;

// Without a handler of its own MuJoCo writes a log file into the current folder.
static void count_warning(const char *text)
{
    (void)text;
    warnings++;
}

// As stiff as MuJoCo takes it: a time constant of two steps, critical damping, impedance 0.9999.
static const char stiff[] = "\"0.002 1\"";
static const char hard[] = "\"0.9999 0.9999 0.0001 0.5 2\"";

static const char *integrator_name(int variant)
{
    switch (variant) {
    case TENDON_IMPLICIT:
    case FREE_FLIGHT:
        return "implicit";
    case TENDON_RK4:
        return "RK4";
    default:
        return "Euler";
    }
}

static int write_options(char *xml, int size, int variant, double step)
{
    return snprintf(xml, (size_t)size,
                    "<mujoco><compiler angle=\"radian\" inertiafromgeom=\"false\"/>"
                    "<option timestep=\"%.17g\" integrator=\"%s\" gravity=\"0 0 0\" jacobian=\"%s\" "
                    "solver=\"Newton\">"
                    "<flag gravity=\"disable\" contact=\"%s\"/></option><worldbody>",
                    step, integrator_name(variant), variant == FREE_FLIGHT ? "auto" : "dense",
                    variant == SPHERE_EULER ? "enable" : "disable");
}

// The bodies, each inside the one before it, with the hinge at its own base.
static int write_bodies(char *xml, int size, const peer *self)
{
    int links = self->links, at = 0;
    double l = EXPERIMENT_BEAM_LENGTH / links, m = EXPERIMENT_BEAM_MASS / links;
    double inertia = m * l * l / 12, spring = EXPERIMENT_SPRING * links / 2;
    for (int k = 0; k < links; k++) {
        at += snprintf(xml + at, (size_t)(size - at), "<body pos=\"%.17g 0 0\">", k > 0 ? l : 0);
        if (k == 0) {
            at += snprintf(xml + at, (size_t)(size - at),
                           "<joint name=\"j0\" axis=\"0 0 1\" armature=\"%.17g\" damping=\"%.17g\" "
                           "frictionloss=\"%.17g\"",
                           EXPERIMENT_HUB_INERTIA, EXPERIMENT_HUB_DAMPING, EXPERIMENT_STICTION);
            at += self->variant == TENDON_DEFAULTS
                      ? snprintf(xml + at, (size_t)(size - at), "/>")
                      : snprintf(xml + at, (size_t)(size - at),
                                 " solreffriction=%s solimpfriction=%s/>", stiff, hard);
        } else {
            at += snprintf(xml + at, (size_t)(size - at),
                           "<joint name=\"j%d\" axis=\"0 0 1\" stiffness=\"%.17g\"/>", k, spring);
        }
        // planar motion sees the third inertia only; the first keeps a rod's triangle inequality
        at += snprintf(xml + at, (size_t)(size - at),
                       "<inertial pos=\"%.17g 0 0\" mass=\"%.17g\" "
                       "diaginertia=\"%.17g %.17g %.17g\"/>",
                       l / 2, m, inertia / 100, inertia, inertia);
    }
    if (self->variant == SPHERE_EULER) {
        at += snprintf(xml + at, (size_t)(size - at),
                       "<geom type=\"sphere\" size=\"0.001\" pos=\"%.17g 0 0\" condim=\"1\" "
                       "solref=%s solimp=%s/>",
                       l, stiff, hard);
    }
    for (int k = 0; k < links; k++) {
        at += snprintf(xml + at, (size_t)(size - at), "</body>");
    }
    return at;
}

// A plane whose normal points back at the arm, moved by the sphere's radius.
static int write_plane(char *xml, int size)
{
    double s = sin(EXPERIMENT_WALL), c = cos(EXPERIMENT_WALL);
    return snprintf(xml, (size_t)size,
                    "<geom type=\"plane\" size=\"2 2 1\" pos=\"%.17g %.17g 0\" "
                    "zaxis=\"%.17g %.17g 0\" condim=\"1\" solref=%s solimp=%s/>",
                    -0.001 * s, 0.001 * c, s, -c, stiff, hard);
}

static int write_tendon(char *xml, int size, bool defaults)
{
    int at = snprintf(xml, (size_t)size,
                      "<tendon><fixed limited=\"true\" range=\"-10 %.17g\"", 2 * EXPERIMENT_WALL);
    if (!defaults) {
        at += snprintf(xml + at, (size_t)(size - at), " solreflimit=%s solimplimit=%s", stiff, hard);
    }
    return at + snprintf(xml + at, (size_t)(size - at),
                         "><joint joint=\"j0\" coef=\"2\"/><joint joint=\"j1\" coef=\"1\"/>"
                         "</fixed></tendon>");
}

static mjModel *load(const char *xml, int length)
{
    char message[500] = "out of memory";
    mjVFS *files = malloc(sizeof *files);
    mjModel *model = NULL;
    if (files != NULL) {
        mj_defaultVFS(files);
        mj_makeEmptyFileVFS(files, "arm.xml", length);
        int index = mj_findFileVFS(files, "arm.xml");
        memcpy(files->filedata[index], xml, (size_t)length);
        model = mj_loadXML("arm.xml", files, message, sizeof message);
        mj_deleteVFS(files);
        free(files);
    }
    if (model == NULL) {
        fprintf(stderr, "peers: MuJoCo: %s\n", message);
    }
    return model;
}

static void start(const simulation *s)
{
    mj_resetData(s->model, s->data);
    s->data->qfrc_applied[0] = EXPERIMENT_TORQUE * EXPERIMENT_VOLTAGE;
}

static bool is_stable(const simulation *s, double step)
{
    s->model->opt.timestep = step;
    start(s);
    warnings = 0;
    for (int i = 0; i < CHAIN_STEPS; i++) {
        mj_step(s->model, s->data);
        for (int k = 0; k < s->model->nv; k++) {
            if (!(fabs(s->data->qvel[k]) < LARGEST_SPEED)) {
                return false;
            }
        }
    }
    return warnings == 0;
}

// Its springs are explicit in every integrator: the step has to follow the fastest mode.
static bool find_stable_step(simulation *s)
{
    double step = EXPERIMENT_STEP;
    while (step > SHORTEST_STEP && !is_stable(s, step)) {
        step /= 2;
    }
    s->duration = CHAIN_STEPS * step;
    return step > SHORTEST_STEP;
}

static void destroy(void *instance)
{
    simulation *s = instance;
    if (s->data != NULL) {
        mj_deleteData(s->data);
    }
    if (s->model != NULL) {
        mj_deleteModel(s->model);
    }
    free(s);
}

static void *create(const peer *self)
{
    simulation *s = calloc(1, sizeof *s);
    char *xml = malloc(XML_SIZE);
    bool good = s != NULL && xml != NULL;
    if (good) {
        mju_user_warning = count_warning;
        bool flight = self->variant == FREE_FLIGHT;
        s->links = self->links;
        s->sphere = self->variant == SPHERE_EULER;
        s->duration = EXPERIMENT_DURATION;
        int at = write_options(xml, XML_SIZE, self->variant, EXPERIMENT_STEP);
        at += write_bodies(xml + at, XML_SIZE - at, self);
        at += s->sphere ? write_plane(xml + at, XML_SIZE - at) : 0;
        at += snprintf(xml + at, (size_t)(XML_SIZE - at), "</worldbody>");
        if (!flight && !s->sphere) {
            at += write_tendon(xml + at, XML_SIZE - at, self->variant == TENDON_DEFAULTS);
        }
        at += snprintf(xml + at, (size_t)(XML_SIZE - at), "</mujoco>");
        s->model = load(xml, at);
        s->data = s->model != NULL ? mj_makeData(s->model) : NULL;
        good = s->data != NULL && (!flight || find_stable_step(s));
    }
    free(xml);
    if (!good && s != NULL) {
        destroy(s);
    }
    return good ? s : NULL;
}

// The wall's force in the step just made. Friction has the first row of the constraints.
static double wall_force(const simulation *s, double hub_angle)
{
    const mjData *d = s->data;
    if (d->nefc < 2) {
        return 0;
    }
    double lever = EXPERIMENT_BEAM_LENGTH / 2 * cos(hub_angle - EXPERIMENT_WALL);
    return s->sphere ? d->efc_force[1] : d->efc_force[1] / lever;
}

static bool run(void *instance, peer_answer *answer)
{
    simulation *s = instance;
    contact_watch watch;
    contact_watch_begin(&watch, answer);
    start(s);
    long steps = lround(s->duration / s->model->opt.timestep);
    for (long i = 0; i < steps; i++) {
        double time = s->data->time, hub = s->data->qpos[0], bend = s->data->qpos[1];
        mj_step(s->model, s->data);
        if (s->links == 2) {
            contact_watch_sample(&watch, time, 2 * hub + bend, wall_force(s, hub));
        }
    }
    answer->hub_angle = s->data->qpos[0];
    answer->steps = (double)steps;
    return isfinite(answer->hub_angle);
}

static double fixed_step(const void *instance)
{
    const simulation *s = instance;
    return s->model->opt.timestep;
}

static double duration(const void *instance)
{
    const simulation *s = instance;
    return s->duration;
}

#define MUJOCO(text, links, variant)                                                               \
    {"MuJoCo", NULL, text, links, variant, create, destroy, run, fixed_step, duration}

static peer list_of_peers[] = {
    MUJOCO("tendon limit, Euler", 2, TENDON_EULER),
    MUJOCO("sphere and plane, Euler", 2, SPHERE_EULER),
    MUJOCO("tendon limit, implicit", 2, TENDON_IMPLICIT),
    MUJOCO("tendon limit, RK4", 2, TENDON_RK4),
    MUJOCO("tendon limit, its default softness", 2, TENDON_DEFAULTS),
    MUJOCO("implicit, largest stable step", 8, FREE_FLIGHT),
    MUJOCO("implicit, largest stable step", 32, FREE_FLIGHT),
    MUJOCO("implicit, largest stable step", 128, FREE_FLIGHT),
};

int peers_mujoco(const peer **list)
{
    int count = (int)(sizeof list_of_peers / sizeof list_of_peers[0]);
    for (int i = 0; i < count; i++) {
        list_of_peers[i].version = mj_versionString();
    }
    *list = list_of_peers;
    return count;
}
