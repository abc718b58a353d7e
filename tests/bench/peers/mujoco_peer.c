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
    FLIGHT_EULER,
    FLIGHT_IMPLICIT
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

// As stiff as MuJoCo takes it: a time constant of two steps and an impedance of 0.9999. With a
// damping ratio of 1 the tip would bounce off by about a tenth of its speed; 10 makes the impact
// plastic.
#define STIFF(what) "solref" what "=\"0.002 10\" solimp" what "=\"0.9999 0.9999 0.0001 0.5 2\""

// The two-link arm, the second link inside the first. Planar motion sees the third inertia only;
// the first keeps a rod's triangle inequality. With variants of soft contact the wall is a tendon's
// limit or a plane whose normal points back at the arm, moved by the sphere's radius.
static int write_arm(char *xml, int size, int variant)
{
    const double l = EXPERIMENT_BEAM_LENGTH / 2, m = EXPERIMENT_BEAM_MASS / 2;
    const double inertia = m * l * l / 12, radius = 0.001;
    const double s = sin(EXPERIMENT_WALL), c = cos(EXPERIMENT_WALL);
    bool sphere = variant == SPHERE_EULER, soft = variant == TENDON_DEFAULTS;
    char rod[200], tip[200] = "", plane[300] = "", tendon[300] = "";
    snprintf(rod, sizeof rod,
             "<inertial pos=\"%.17g 0 0\" mass=\"%.17g\" diaginertia=\"%.17g %.17g %.17g\"/>",
             l / 2, m, inertia / 100, inertia, inertia);
    if (sphere) {
        snprintf(tip, sizeof tip,
                 "<geom type=\"sphere\" size=\"%g\" pos=\"%.17g 0 0\" condim=\"1\" %s/>", radius, l,
                 STIFF(""));
        snprintf(
            plane, sizeof plane,
            "<geom type=\"plane\" size=\"2 2 1\" pos=\"%.17g %.17g 0\" zaxis=\"%.17g %.17g 0\" "
            "condim=\"1\" %s/>",
            -radius * s, radius * c, s, -c, STIFF(""));
    } else {
        snprintf(tendon, sizeof tendon,
                 "<tendon><fixed limited=\"true\" range=\"-10 %.17g\" %s>"
                 "<joint joint=\"hub\" coef=\"2\"/><joint joint=\"middle\" "
                 "coef=\"1\"/></fixed></tendon>",
                 2 * EXPERIMENT_WALL, soft ? "" : STIFF("limit"));
    }
    return snprintf(
        xml, (size_t)size,
        "<mujoco><compiler angle=\"radian\" inertiafromgeom=\"false\"/>"
        "<option integrator=\"%s\" solver=\"PGS\" jacobian=\"dense\">"
        "<flag contact=\"%s\"/></option><worldbody>%s"
        "<body><joint name=\"hub\" axis=\"0 0 1\"/>%s<body pos=\"%.17g 0 0\">"
        "<joint name=\"middle\" axis=\"0 0 1\"/>%s%s</body></body></worldbody>%s</mujoco>",
        variant == TENDON_IMPLICIT ? "implicit"
        : variant == TENDON_RK4    ? "RK4"
                                   : "Euler",
        sphere ? "enable" : "disable", plane, rod, l, rod, tip, tendon);
}

// A chain as URDF, which lists links and joints one after the other: MJCF, with each body inside
// the one before it, may be nested less than a hundred deep.
static int write_chain(char *xml, int size, int links)
{
    double l = EXPERIMENT_BEAM_LENGTH / links, m = EXPERIMENT_BEAM_MASS / links;
    double inertia = m * l * l / 12;
    int at = snprintf(xml, (size_t)size, "<robot name=\"chain\"><link name=\"l0\"/>");
    for (int k = 1; k <= links; k++) {
        at += snprintf(
            xml + at, (size_t)(size - at),
            "<link name=\"l%d\"><inertial><origin xyz=\"%.17g 0 0\"/><mass value=\"%.17g\"/>"
            "<inertia ixx=\"%.17g\" iyy=\"%.17g\" izz=\"%.17g\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/>"
            "</inertial></link><joint name=\"j%d\" type=\"continuous\">"
            "<origin xyz=\"%.17g 0 0\"/><parent link=\"l%d\"/><child link=\"l%d\"/>"
            "<axis xyz=\"0 0 1\"/></joint>",
            k, l / 2, m, inertia / 100, inertia, inertia, k, k > 1 ? l : 0, k - 1, k);
    }
    return at + snprintf(xml + at, (size_t)(size - at), "</robot>");
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

// What both files leave out: springs, hub and surroundings.
static void complete(mjModel *model, int links, bool soft)
{
    static const mjtNum stiff_reference[mjNREF] = {0.002, 10};
    static const mjtNum stiff_impedance[mjNIMP] = {0.9999, 0.9999, 0.0001, 0.5, 2};
    model->opt.timestep = EXPERIMENT_STEP;
    model->opt.gravity[0] = model->opt.gravity[1] = model->opt.gravity[2] = 0;
    model->opt.disableflags |= mjDSBL_GRAVITY;
    model->dof_armature[0] = EXPERIMENT_HUB_INERTIA;
    model->dof_damping[0] = EXPERIMENT_HUB_DAMPING;
    model->dof_frictionloss[0] = EXPERIMENT_STICTION;
    if (!soft) {
        mju_copy(model->dof_solref, stiff_reference, mjNREF);
        mju_copy(model->dof_solimp, stiff_impedance, mjNIMP);
    }
    for (int k = 1; k < links; k++) {
        model->jnt_stiffness[k] = EXPERIMENT_SPRING * links / 2;
    }
}

static bool prepare(simulation *s, const peer *self, char *xml)
{
    bool flight = self->variant == FLIGHT_EULER || self->variant == FLIGHT_IMPLICIT;
    int length =
        flight ? write_chain(xml, XML_SIZE, self->links) : write_arm(xml, XML_SIZE, self->variant);
    s->links = self->links;
    s->sphere = self->variant == SPHERE_EULER;
    s->duration = EXPERIMENT_DURATION;
    s->model = load(xml, length);
    if (s->model == NULL) {
        return false;
    }
    complete(s->model, s->links, self->variant == TENDON_DEFAULTS);
    if (flight) {
        s->model->opt.integrator = self->variant == FLIGHT_EULER ? mjINT_EULER : mjINT_IMPLICIT;
        s->model->opt.solver = mjSOL_PGS;
    }
    s->data = mj_makeData(s->model);
    return s->data != NULL && (!flight || find_stable_step(s));
}

static void *create(const peer *self)
{
    simulation *s = calloc(1, sizeof *s);
    char *xml = malloc(XML_SIZE);
    mju_user_warning = count_warning;
    bool good = s != NULL && xml != NULL && prepare(s, self, xml);
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
    contact_watch_begin(&watch, EXPERIMENT_STEP, answer);
    start(s);
    long steps = lround(s->duration / s->model->opt.timestep);
    for (long i = 0; i < steps; i++) {
        double time = s->data->time, hub = s->data->qpos[0], bend = s->data->qpos[1];
        double rate = 2 * s->data->qvel[0] + s->data->qvel[1];
        mj_step(s->model, s->data);
        if (s->links == 2) {
            contact_watch_sample(&watch, time, 2 * hub + bend, rate, wall_force(s, hub));
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
    {                                                                                              \
        "MuJoCo", NULL, text, links, variant, create, destroy, run, fixed_step, duration           \
    }

static peer list_of_peers[] = {
    MUJOCO("tendon limit, Euler", 2, TENDON_EULER),
    MUJOCO("sphere and plane, Euler", 2, SPHERE_EULER),
    MUJOCO("tendon limit, implicit", 2, TENDON_IMPLICIT),
    MUJOCO("tendon limit, RK4", 2, TENDON_RK4),
    MUJOCO("tendon limit, its default softness", 2, TENDON_DEFAULTS),
    MUJOCO("Euler, largest stable step", 8, FLIGHT_EULER),
    MUJOCO("implicit, largest stable step", 8, FLIGHT_IMPLICIT),
    MUJOCO("Euler, largest stable step", 32, FLIGHT_EULER),
    MUJOCO("implicit, largest stable step", 32, FLIGHT_IMPLICIT),
    MUJOCO("Euler, largest stable step", 128, FLIGHT_EULER),
    MUJOCO("implicit, largest stable step", 128, FLIGHT_IMPLICIT),
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
