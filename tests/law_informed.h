// What physics allows in a drawn case (law_cases.h): a law that sees the whole arm.
//
// It is told arm, wall, delay and clock, and sees the angles and rates of all links as
// they will be when its command takes effect, which follow from those at the sample; a
// push it sees when it has happened. On the linear arm, free up to a planned touch and on
// the wall's spring from there, it minimises the sum over samples of
//
//     ((f - f_d)/F)^2 + weight ((T - T_d)/(1 N m))^2,      f_d = F (1 - (1 - first)
//     exp(-t/rise)),
//
// T_d what holds F. A touch with speed makes a force that is not f_d, so it comes
// without. Where a landing speed is given, it costs to be off that speed's line to the
// wall in the last 0.06 s. Friction's torque is added in the direction in which the hub
// is to move.
//
// To say what knowledge is worth it may also be told less: the nearest of 0, 40 and 80 g
// for the mass at the tip, and a rigid wall for one that gives.
#pragma once

#include "src/arm/modes.h"
#include "src/base/dense.h"
#include "src/run/run_loop.h"
#include "tests/law_cases.h"

// Sizes: bodies; their angles, rates and a one; these and the torque; samples; parts of a
// period.
enum {
    BODIES = 9,
    STATE = 2 * BODIES + 1,
    WITH_TORQUE = STATE + 1,
    SAMPLES = 4096,
    PARTS = 4
};

#define PRESSING   0.6   // of the plan, from the touch on [s]
#define HOLDING    0.3   // from then on as at this time after it [s]
#define LANDING    0.06  // before the touch, with a speed of its own [s]
#define AGAIN      0.15  // to the next touch, where contact is lost [s]
#define LOST_GAP   2e-4  // which counts as lost [m]
#define LOST_TIME  8e-3  // after so long [s]
#define RIGID      3e6   // spring of a rigid wall [N/m]
#define RIGID_LOSS 300.0 // its damper [N s/m]
#define LINE_COST  3e4   // of being off the line to the wall [1/m2]

typedef struct informed_arm {
    int bodies, state;
    double mass[BODIES * BODIES], stiffness[BODIES * BODIES], damping[BODIES * BODIES];
    double reach[BODIES]; // the tip's place is its product with the angles [m]
    double spring, damper,
        offset;                  // force at the tip's place y: spring y + damper y' + it
    double face;                 // mass that moves with the tip in contact [kg]
    double period, delay, force; // F
    arm arm;
} informed_arm;

// What is told of the tip's mass and of the wall.
enum { TOLD_ALL, MASS_ROUGHLY, MASS_ROUGHLY_NOT_THE_WALL, KNOWLEDGE };
static const char *const knowledge_names[] = {"told all", "the tip's mass to 20 g",
                                              "the tip's mass to 20 g and not the wall"};

static void forget(parameters *p, int knowledge)
{
    double *mass = &p->arm.tip_mass;
    if (knowledge >= MASS_ROUGHLY) {
        *mass = fmin(0.08, 0.04 * round(*mass / 0.04));
    }
    if (knowledge == MASS_ROUGHLY_NOT_THE_WALL) {
        p->wall.contact = WALL_RIGID;
        p->wall.mass = 0;
    }
}

typedef struct informed_tuning {
    double touch, rise, first, weight,
        speed; // [s], [s], share of F, -, landing speed [m/s] or 0
} informed_tuning;

typedef struct informed_plan {
    double gain[SAMPLES][STATE];
    int touch, samples; // the sample of the touch; how many there are
} informed_plan;

typedef struct informed_commands {
    double volts[SAMPLES];
    int count;
} informed_commands;

static informed_arm informed_arm_of(const parameters *p, double force)
{
    informed_arm m = {.force = force,
                      .period = 1 / p->control.rate,
                      .delay =
                          p->control.delay + p->control.delay_periods / p->control.rate};
    arm_init(&m.arm, p);
    const int n = m.bodies = m.arm.dof;
    m.state = 2 * n + 1;
    modes_matrices(&m.arm, m.mass, m.stiffness);
    m.damping[0] = m.arm.motor.damping;
    const int first = m.arm.first; // of the links among the bodies
    for (int k = first; k < n; k++) {
        m.reach[k] = arm_link_of(&m.arm, k - first).length;
    }
    for (int k = 1; k < n; k++) {
        const double d = arm_link_of(&m.arm, k - first).damping;
        m.damping[(k - 1) * (n + 1)] += d;
        m.damping[k * (n + 1)] += d;
        m.damping[(k - 1) * n + k] -= d;
        m.damping[k * n + k - 1] -= d;
    }

    // the wall's spring, of one that is not linear its tangent at the force
    const wall_model *w = &m.arm.wall;
    const bool hertz = w->law == WALL_HUNT_CROSSLEY;
    const double depth = hertz ? pow(force / w->stiffness, 1 / w->exponent) : 0;
    m.spring = !wall_gives(w) ? RIGID
               : hertz        ? w->exponent * force / depth
                              : w->stiffness;
    m.damper = !wall_gives(w) ? RIGID_LOSS
               : hertz        ? w->damping * wall_power(w, depth)
                              : w->damping;
    m.offset = hertz ? force - m.spring * depth : 0;
    m.face = w->face_mass;
    return m;
}

// State and torque after each part of a period, as products with those before it.
static void informed_steps(const informed_arm *m, bool contact,
                           double step[PARTS][WITH_TORQUE * WITH_TORQUE])
{
    const int n = m->bodies, size = m->state + 1, columns = 2 * n + 2;
    double mass[BODIES * BODIES], right[BODIES * WITH_TORQUE],
        rate[WITH_TORQUE * WITH_TORQUE] = {0};
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            const double both = contact ? m->reach[i] * m->reach[j] : 0;
            mass[i * n + j] = m->mass[i * n + j] + m->face * both;
            right[i * columns + j] = -m->stiffness[i * n + j] - m->spring * both;
            right[i * columns + n + j] = -m->damping[i * n + j] - m->damper * both;
        }
        right[i * columns + 2 * n] = contact ? -m->offset * m->reach[i] : 0;
        right[i * columns + 2 * n + 1] = i == 0;
    }
    dense_solve_columns(n, columns, mass, right);
    for (int i = 0; i < n; i++) {
        rate[i * size + n + i] = 1;
        memcpy(rate + (n + i) * size, right + i * columns,
               (size_t)columns * sizeof *rate);
    }
    for (int i = 0; i < PARTS; i++) {
        double power[WITH_TORQUE * WITH_TORQUE], product[WITH_TORQUE * WITH_TORQUE];
        matrix_exponential(rate, size, m->period * (i + 1) / PARTS, step[i], power,
                           product);
    }
}

// Adds weight (row step - wanted)^2, a cost of the state after a step, to that of the one
// before.
static void informed_cost(const informed_arm *m, const double *row, const double *step,
                          double wanted, double weight, double *cost)
{
    const int size = m->state + 1;
    double after[WITH_TORQUE] = {0};
    for (int j = 0; j < size; j++) {
        for (int i = 0; i < m->state; i++) {
            after[j] += row[i] * step[i * size + j];
        }
    }
    after[m->state - 1] -= wanted;
    for (int i = 0; i < size; i++) {
        for (int j = 0; j < size; j++) {
            cost[i * size + j] += weight * after[i] * after[j];
        }
    }
}

// The gains, from the last sample back to the first by Riccati's equation.
static void informed_design(const informed_arm *m, const informed_tuning *t,
                            informed_plan *plan)
{
    static double steps[2][PARTS][WITH_TORQUE * WITH_TORQUE];
    const int n = m->bodies, size = m->state + 1, last = m->state, one = last - 1;
    double force[WITH_TORQUE] = {0}, tip[WITH_TORQUE] = {0}, ahead[STATE * STATE] = {0};
    double length = 0;
    for (int i = 0; i < n; i++) {
        length += tip[i] = m->reach[i];
        force[i] = m->spring * m->reach[i];
        force[n + i] = m->damper * m->reach[i];
    }
    force[one] = m->offset;
    informed_steps(m, false, steps[0]);
    informed_steps(m, true, steps[1]);
    plan->touch = (int)fmax(2, floor(t->touch / m->period));
    plan->samples = plan->touch + (int)ceil(PRESSING / m->period);
    for (int k = plan->samples - 1; k >= 0; k--) {
        // what lies ahead, as a cost of state and torque now
        const bool contact = k >= plan->touch;
        const double since = (k - plan->touch) * m->period, part = m->period / PARTS;
        const double *step = steps[contact][PARTS - 1];
        double cost[WITH_TORQUE * WITH_TORQUE] = {0}, product[STATE * WITH_TORQUE] = {0};
        for (int i = 0; i < last; i++) {
            for (int l = 0; l < last; l++) {
                for (int j = 0; j < size; j++) {
                    product[i * size + j] += ahead[i * last + l] * step[l * size + j];
                }
            }
        }
        for (int l = 0; l < last; l++) {
            for (int i = 0; i < size; i++) {
                for (int j = 0; j < size; j++) {
                    cost[i * size + j] += step[l * size + i] * product[l * size + j];
                }
            }
        }

        // and that of this period
        const double holding = contact ? m->force * length : 0,
                     weight = t->weight * m->period;
        cost[last * size + last] += weight;
        cost[last * size + one] -= weight * holding;
        cost[one * size + last] -= weight * holding;
        for (int i = 0; i < PARTS; i++) {
            const double time = since + part * (i + 1);
            if (contact) {
                const double wanted =
                    m->force * (1 - (1 - t->first) * exp(-time / t->rise));
                informed_cost(m, force, steps[1][i], wanted, part / (m->force * m->force),
                              cost);
            } else if (t->speed > 0 && since > -LANDING) {
                informed_cost(m, tip, steps[0][i], t->speed * time, part * LINE_COST,
                              cost);
            }
        }
        for (int i = 0; i < last; i++) {
            plan->gain[k][i] = -cost[last * size + i] / cost[last * size + last];
            for (int j = 0; j < last; j++) {
                ahead[i * last + j] = cost[i * size + j] - cost[i * size + last] *
                                                               cost[last * size + j] /
                                                               cost[last * size + last];
            }
        }
    }
}

// Where a run stands in the plan.
typedef struct informed_progress {
    int at;              // sample of the plan
    bool touched;        // it presses
    double touched_last; // [s]
} informed_progress;

// The next command [V] from the state when it takes effect.
static double informed_command(const informed_arm *m, const informed_plan *plan,
                               informed_progress *on, const sample *row,
                               const double *state)
{
    const int n = m->bodies, again = (int)(AGAIN / m->period);
    const bool rigid = !wall_gives(&m->arm.wall), contact = row->contact > 0.5;
    const bool bounces = rigid && row->gap < LOST_GAP && !on->touched &&
                         (on->at >= plan->touch - 1 ||
                          (row->gap_velocity > 0 && on->at > plan->touch / 2));
    if (contact || bounces) {
        on->at = on->touched ? on->at : plan->touch;
        on->touched = true;
        on->touched_last = row->time;
    } else if (on->touched && row->gap > LOST_GAP &&
               row->time - on->touched_last > LOST_TIME) {
        on->touched = false;
        on->at = plan->touch > again ? plan->touch - again : 0;
    }
    const int most =
        on->touched ? plan->touch + (int)(HOLDING / m->period) : plan->touch - 1;
    on->at = on->at < most ? on->at : most;

    // tip's place and rate from the gap, which is not quite linear, and from the force
    double place = -row->gap, rate = rigid && on->touched ? 0 : -row->gap_velocity;
    if (contact && (rigid || m->offset != 0)) {
        place = (row->force - m->offset) / m->spring;
    } else if (on->touched && !contact) {
        place = fmax(place, -m->force / m->spring);
    }
    double square = 0, torque = 0;
    for (int i = 0; i < n; i++) {
        square += m->reach[i] * m->reach[i];
        place -= m->reach[i] * state[i];
        rate -= m->reach[i] * state[n + i];
    }
    const double *gain = plan->gain[on->at++];
    for (int i = 0; i < n; i++) {
        torque += gain[i] * (state[i] + m->reach[i] * place / square) +
                  gain[n + i] * (state[n + i] + m->reach[i] * rate / square);
    }
    torque += gain[2 * n];

    // and friction's
    const double off = contact ? (m->force - row->force) / (0.03 * m->force) : 0;
    torque += m->arm.motor.stiction * tanh(state[n] / 0.02 + off);
    const double limit = m->arm.motor.voltage_limit;
    return fmax(-limit, fmin(torque / m->arm.motor.torque_per_volt, limit));
}

// Runs a case under the law and keeps its commands. False where the run fails.
static bool informed_run(const drawn_case *c, double command, const informed_arm *m,
                         const informed_plan *plan, informed_commands *out)
{
    scenario s;
    fault f = {.code = STATUS_OK};
    run_loop *loop;
    drawn_case calm = *c;
    calm.push = 0; // it comes from outside
    case_scenario(&s, NULL, &calm, "open-loop", command);
    if (loop_create(&loop, &s, &(loop_options){.commanded = true}, &f) != STATUS_OK) {
        return false;
    }
    const size_t most = loop_saved_size(loop);
    char *now = malloc(most);
    informed_progress on = {0};
    bool pushed = c->push == 0, ok = now != NULL;
    for (out->count = 0; ok && out->count < SAMPLES && !loop_ended(loop);) {
        // looks ahead to when the command takes effect
        const double time = loop_time(loop);
        if (m->delay > 0) {
            loop_save(loop, now);
            ok = loop_until(loop, time + m->delay, &f) == STATUS_OK;
        }
        int angles;
        const double *at = loop_state(loop, &angles);
        const sample row = loop_row(loop);
        const double volts = informed_command(m, plan, &on, &row, at);
        ok = ok && (m->delay == 0 || loop_restore(loop, now, most, &f) == STATUS_OK);
        loop_command(loop, out->volts[out->count++] = volts);

        // and goes on, past the push
        if (ok && !pushed && c->push_time < time + m->period) {
            ok = loop_until(loop, c->push_time, &f) == STATUS_OK &&
                 loop_push(loop, c->push, &f) == STATUS_OK;
            pushed = true;
        }
        ok = ok && loop_step(loop, &f) == STATUS_OK;
    }
    free(now);
    loop_destroy(loop);
    return ok;
}

// Plays the commands once more, sample by sample.
typedef struct informed_player {
    const informed_commands *commands;
    int at;
} informed_player;

static void informed_play(void *memory, const controller_input *in,
                          controller_output *out)
{
    (void)in;
    informed_player *p = memory;
    out->command = p->commands->volts[p->at];
    p->at += p->at + 1 < p->commands->count;
}

static const controller informed_law = {.interface = CONTROLLER_INTERFACE,
                                        .name = "informed",
                                        .modes = (const char *const[]){"informed", NULL},
                                        .memory_size = sizeof(informed_player),
                                        .sample = informed_play};

// The verdict on the law with a tuning: of a run of its own under the commands that it
// gave.
static verdict informed_verdict(const drawn_case *c, double command, double open_loop,
                                const informed_arm *m, const informed_tuning *t)
{
    static informed_plan plan;
    static informed_commands quiet, given;
    drawn_case calm = *c;
    calm.push = 0;
    informed_design(m, t, &plan);
    if (!informed_run(&calm, command, m, &plan, &quiet) ||
        !informed_run(c, command, m, &plan, &given)) {
        return (verdict){.over = HUGE_VAL, .settling = HUGE_VAL, .beyond = true};
    }
    const summary undisturbed =
        run_case(&calm, "open-loop", &(given_law){&informed_law, &quiet}, command);
    const summary s =
        run_case(c, "open-loop", &(given_law){&informed_law, &given}, command);
    return judge_runs(c, command, open_loop, &s, &undisturbed);
}

// With one tuning for all cases.
static verdict informed_once(const drawn_case *c, double command, double open_loop,
                             int knowledge)
{
    scenario s;
    case_scenario(&s, NULL, c, "open-loop", command);
    forget(&s.parameters, knowledge);
    const informed_arm m = informed_arm_of(&s.parameters, command);
    const double speed = command < 1 ? 0.01 : command < 3 ? 0.02 : 0.04;
    const informed_tuning t = {1.2 * open_loop, 0.03, 0.4, 1e-3, speed};
    return informed_verdict(c, command, open_loop, &m, &t);
}

// Tries tunings until the law is within the bounds; else the last verdict.
static verdict informed_search(const drawn_case *c, double command, double open_loop)
{
    static const double speeds[] = {0, 0.02, 0.05, 0.01}, weights[] = {1e-3, 1e-2, 1e-4};
    static const double touches[] = {1.2, 1.35, 0.9}, rises[] = {0.03, 0.06},
                        firsts[] = {0.1, 0.4};
    scenario s;
    case_scenario(&s, NULL, c, "open-loop", command);
    const informed_arm m = informed_arm_of(&s.parameters, command);
    verdict v = {0};
    for (int i = 0; i < 4 * 3 * 3 * 2 * 2 && !v.within; i++) {
        const informed_tuning t = {.touch = touches[i / 4 % 3] * open_loop,
                                   .rise = rises[i / 2 % 2],
                                   .first = firsts[i % 2],
                                   .weight = weights[i / 12 % 3],
                                   .speed = speeds[i / 36]};
        v = informed_verdict(c, command, open_loop, &m, &t);
    }
    return v;
}
