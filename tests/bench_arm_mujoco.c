// The bench by MuJoCo: rods as nested bodies on hinges with springs, the rotor a body of
// its own. Motor, coupling and wall are forces given at every step.
#include "tests/bench_arm.h"

#ifdef HAS_MUJOCO
#include <math.h>
#include <mujoco/mujoco.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define COUPLING_DAMPING 0.02 // [N m s/rad]
#define CREEP            2e-3 // velocity below which friction is viscous [rad/s]

enum { XML_SIZE = 1 << 15 };

// The step [s]: Euler's method takes damping implicitly and bears a longer one. The
// coupling's torque is constant in a step; without the joints' damping its own has to
// hold what that adds, a rate of stiffness times step over inertia.
static double step_of(const bench_arm *a)
{
    return a->joint_damping > 0 ? 5e-5 : 5e-6;
}

// MuJoCo warns of motions that go to infinity, which are no recordings.
static void give_up(const char *warning)
{
    fprintf(stderr, "%s\n", warning);
    abort();
}

// Writes the model: joint 0 is the rotor's, then those of the rods; the tip is a site.
static void write_model(const bench_arm *a, char *xml)
{
    const double l = a->length / a->links, m = a->mass / a->links,
                 inertia = m * l * l / 12;
    int at = snprintf(
        xml, XML_SIZE,
        "<mujoco><compiler angle='radian' inertiafromgeom='false'/>"
        "<option integrator='%s' timestep='%g'><flag contact='disable' "
        "gravity='disable'/>"
        "</option><worldbody><body><joint axis='0 0 1'/><inertial pos='0 0 0' mass='1' "
        "diaginertia='%.17g %.17g %.17g'/></body>",
        a->joint_damping > 0 ? "Euler" : "RK4", step_of(a), a->rotor_inertia,
        a->rotor_inertia, a->rotor_inertia);
    for (int k = 0; k < a->links; k++) {
        at += snprintf(xml + at, (size_t)(XML_SIZE - at),
                       "<body pos='%.17g 0 0'><joint axis='0 0 1' stiffness='%.17g' "
                       "damping='%.17g'/>"
                       "<inertial pos='%.17g 0 0' mass='%.17g' diaginertia='%.17g %.17g "
                       "%.17g'/>",
                       k > 0 ? l : 0, k > 0 ? a->joint_stiffness : 0,
                       k > 0 ? a->joint_damping : 0, l / 2, m, inertia / 100, inertia,
                       inertia);
    }
    if (a->tip_mass > 0) {
        const double small = 1e-9;
        at += snprintf(xml + at, (size_t)(XML_SIZE - at),
                       "<body pos='%.17g 0 0'><inertial pos='0 0 0' mass='%.17g' "
                       "diaginertia='%g %g %g'/></body>",
                       l, a->tip_mass, small, small, small);
    }
    at += snprintf(xml + at, (size_t)(XML_SIZE - at),
                   "<site name='tip' pos='%.17g 0 0'/>", l);
    for (int k = 0; k < a->links; k++) {
        at += snprintf(xml + at, (size_t)(XML_SIZE - at), "</body>");
    }
    snprintf(xml + at, (size_t)(XML_SIZE - at), "</worldbody></mujoco>");
}

static mjModel *load(const bench_arm *a)
{
    char *xml = malloc(XML_SIZE), message[500];
    mjVFS *files = malloc(sizeof *files);
    if (xml == NULL || files == NULL) {
        abort();
    }
    write_model(a, xml);
    mj_defaultVFS(files);
    mj_makeEmptyFileVFS(files, "bench.xml", (int)strlen(xml));
    const int index = mj_findFileVFS(files, "bench.xml");
    memcpy(files->filedata[index], xml, strlen(xml));
    mjModel *model = mj_loadXML("bench.xml", files, message, sizeof message);
    if (model == NULL) {
        fprintf(stderr, "%s\n", message);
        abort();
    }
    mj_deleteVFS(files);
    free(files);
    free(xml);
    return model;
}

// Gives the step under way its forces. Returns that of the wall.
static double push(const bench_arm *a, double volts, const mjModel *model, mjData *data)
{
    const double apart = data->qpos[0] - data->qpos[1];
    const double moving = data->qvel[0] - data->qvel[1];
    const double out = fmax(fabs(apart) - a->play / 2, 0);
    double torque = 0, force = 0;
    if (out > 0) {
        torque = copysign(a->coupling * out, apart) + COUPLING_DAMPING * moving;
    }
    data->qfrc_applied[0] = a->torque_per_volt * volts - a->damping * data->qvel[0] -
                            a->stiction * tanh(data->qvel[0] / CREEP) - torque;

    // depth and speed of the tip from the chain of the angles
    const double l = a->length / a->links;
    double depth = 0, speed = 0, angle = 0, turning = 0;
    for (int k = 1; k <= a->links; k++) {
        angle += data->qpos[k];
        turning += data->qvel[k];
        depth += l * sin(angle);
        speed += l * cos(angle) * turning;
    }
    if (depth > 0) {
        force = fmax(a->wall_stiffness * depth + a->wall_damping * speed, 0);
    }

    // a force on the tip along -y: its moment about joint k is its arm in x
    double arm = 0;
    angle = 0;
    for (int k = 1; k <= a->links; k++) {
        angle += data->qpos[k];
    }
    for (int k = a->links; k >= 1; k--) {
        arm += l * cos(angle);
        angle -= data->qpos[k];
        data->qfrc_applied[k] = -force * arm;
    }
    data->qfrc_applied[1] += torque;
    (void)model;
    return force;
}

bool bench_has_mujoco(void)
{
    return true;
}

bool bench_arm_run_mujoco(const bench_arm *a, bench_board *board, void *context,
                          int samples, double rate, bench_sample *to)
{
    mju_user_warning = give_up;
    mjModel *model = load(a);
    mjData *data = mj_makeData(model);
    const double step = step_of(a);
    const int steps = (int)lround(1 / (rate * step));
    double volts = 0, felt = 0, pressed = 0;
    data->qpos[0] = data->qpos[1] = a->start;
    for (int k = 0; k < samples; k++) {
        to[k] = (bench_sample){data->qpos[0], data->qvel[0], felt, pressed / steps};
        const double command = board(context, k, to);
        if (isnan(command)) {
            break;
        }
        pressed = 0;
        for (int i = 0; i < steps; i++) {
            const double force = push(a, volts, model, data);
            mj_step(model, data);
            pressed += force;
            volts += (command - volts) * -expm1(-step / a->amplifier_lag);
            felt += (force - felt) * -expm1(-step / a->force_lag);
        }
    }
    mj_deleteData(data);
    mj_deleteModel(model);
    return true;
}
#else
bool bench_has_mujoco(void)
{
    return false;
}

bool bench_arm_run_mujoco(const bench_arm *a, bench_board *board, void *context,
                          int samples, double rate, bench_sample *to)
{
    (void)a, (void)board, (void)context, (void)samples, (void)rate, (void)to;
    return false;
}
#endif
