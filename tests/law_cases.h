// Cases for a control law that nobody chose, and the judgement of a run of one: for the
// programs that count them and that ask why they are out of bounds.
#pragma once

#include <math.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/random.h"
#include "src/rig/rig.h"
#include "src/run/run.h"

#define RUN_TIME  2.0 // [s]
#define PUSH_FROM 0.9 // a push comes between this and PUSH_TO [s]
#define PUSH_TO   1.1

static const double commands[] = {0.5, 1, 3};
enum { COMMANDS = 3, MOST_SETTINGS = 32 };

typedef struct law_case {
    char settings[MOST_SETTINGS][64];
    int count;
    int of[MOST_SETTINGS]; // the error that a setting belongs to, -1 for none
    double push, push_time;
} law_case;

static random_generator generator;

static double even(double low, double high)
{
    return low + (high - low) * random_uniform(&generator);
}

static double logarithmic(double low, double high)
{
    return low * exp(log(high / low) * random_uniform(&generator));
}

static __attribute__((format(printf, 2, 3))) void add(law_case *c, const char *format,
                                                      ...)
{
    va_list list;
    va_start(list, format);
    c->of[c->count] = -1;
    vsnprintf(c->settings[c->count++], sizeof c->settings[0], format, list);
    va_end(list);
}

// --- the errors ------------------------------------------------------------------------

static void giving_wall(law_case *c)
{
    const bool hertz = random_below(&generator, 2) == 1;
    add(c, "wall.contact=%s", hertz ? "hunt-crossley" : "kelvin-voigt");
    add(c, "wall.stiffness=%.6g", logarithmic(200, 1e6));
}

static void face(law_case *c)
{
    add(c, "wall.contact=kelvin-voigt");
    add(c, "wall.stiffness=%.6g", logarithmic(200, 1e6));
    add(c, "wall.mass=%.6g", logarithmic(0.005, 0.1));
}

static void tip_mass(law_case *c)
{
    add(c, "arm.tip_mass=%.6g", even(0.02, 0.1));
}

static void push(law_case *c)
{
    c->push = even(-0.06, 0.06);
    c->push_time = even(PUSH_FROM, PUSH_TO);
}

static void rate(law_case *c)
{
    add(c, "control.rate=%.6g", logarithmic(100, 1000));
}

// Told up to two periods, untold to one.
static void delay(law_case *c)
{
    const bool told = random_below(&generator, 2) == 1;
    add(c, "control.delay_periods=%.6g", even(0, told ? 2 : 1));
    if (!told) {
        add(c, "belief.delay_error=-2");
    }
}

static void tip_sensor(law_case *c)
{
    add(c, "sensor.fsr_gain_error=%.6g", even(-0.03, 0.03));
    add(c, "sensor.fsr_offset=%.6g", even(-0.01, 0.01));
    add(c, "sensor.fsr_hysteresis=%.6g", even(0, 0.03));
}

static void hub_sensors(law_case *c)
{
    add(c, "sensor.encoder_gain_error=%.6g", even(-0.05, 0.05));
    add(c, "sensor.encoder_offset=%.6g", even(-0.02, 0.02));
    add(c, "sensor.tachometer_gain_error=%.6g", even(-0.05, 0.05));
    add(c, "sensor.tachometer_offset=%.6g", even(-0.02, 0.02));
    add(c, "sensor.encoder_counts=1000");
    add(c, "sensor.tachometer_noise=0.05");
}

static void scattered_samples(law_case *c)
{
    add(c, "control.jitter=%.6g", even(0, 1) * 1e-3); // a period of the fastest rate
    add(c, "sensor.accelerometer=%s",
        random_below(&generator, 2) == 1 ? "true" : "false");
}

static void links(law_case *c)
{
    const int n = 3 + (int)random_below(&generator, 6);
    add(c, "arm.links=%d", n);
    add(c, "arm.damping_ratio=0.01");
    if (random_below(&generator, 2) == 1) {
        add(c, "belief.links=%d", n);
    }
}

static void restitution(law_case *c)
{
    add(c, "wall.restitution=%.6g", even(0, 0.5));
}

// Errors of the wall exclude one another.
static const struct {
    void (*draw)(law_case *c);
    bool of_wall;
    const char *name;
} errors[] = {{giving_wall, true, "giving wall"},
              {giving_wall, true, "giving wall"},
              {face, true, "face"},
              {restitution, true, "restitution"},
              {tip_mass, false, "tip mass"},
              {push, false, "push"},
              {rate, false, "rate"},
              {delay, false, "delay"},
              {tip_sensor, false, "tip sensor"},
              {hub_sensors, false, "hub sensors"},
              {scattered_samples, false, "scattered samples"},
              {links, false, "links"}};
enum { ERRORS = sizeof errors / sizeof errors[0] };

static law_case draw_case(int seed)
{
    law_case c = {.count = 0};
    size_t order[ERRORS];
    random_permutation(&generator, order, ERRORS);
    int wanted = 2 + (int)random_below(&generator, 2);
    bool wall = false;
    for (int i = 0; i < ERRORS && wanted > 0; i++) {
        if (errors[order[i]].of_wall && wall) {
            continue;
        }
        wall = wall || errors[order[i]].of_wall;
        const int from = c.count;
        errors[order[i]].draw(&c);
        for (int j = from; j < c.count; j++) {
            c.of[j] = (int)order[i];
        }
        wanted--;
    }
    add(&c, "control.seed=%d", seed);
    return c;
}

// --- a run -----------------------------------------------------------------------------

// The scenario of a case under a law; `pushed` is where its push is kept, NULL for none.
static void case_scenario(scenario *s, action *pushed, const law_case *c, const char *law,
                          double command)
{
    char force[32], of_law[48];
    snprintf(force, sizeof force, "control.force=%g", command);
    snprintf(of_law, sizeof of_law, "control.law=%s", law);
    char *all[MOST_SETTINGS + 8] = {(char[]){"wall.angle=0"},
                                    (char[]){"initial.angle=-0.1"},
                                    (char[]){"run.duration=2"}, force, of_law};
    int count = 5;
    for (int i = 0; i < c->count; i++) {
        all[count++] = (char *)c->settings[i];
    }
    *s = (scenario){.name = "case"};
    fault f = {.code = STATUS_OK};
    parameters_defaults(&s->parameters, ARM_CORRECTED);
    if (pushed != NULL && c->push != 0) {
        *pushed = (action){.time = c->push_time,
                           .kind = ACTION_PUSH,
                           .parameter = -1,
                           .value = c->push,
                           .added = true};
        s->actions = pushed;
        s->action_count = 1;
    }
    for (int i = 0; i < count; i++) {
        scenario_override(s, all[i], &f); // two that need one another
    }
    for (int i = 0; i < count; i++) {
        if (scenario_override(s, all[i], &f) != STATUS_OK) {
            fprintf(stderr, "%s: %s\n", all[i], f.text);
            exit(2);
        }
    }
}

// Under `given` in the place of the law, if it is not NULL.
static summary run_case(const law_case *c, const char *law, const given_law *given,
                        double command)
{
    scenario s;
    action pushed;
    run_result r;
    case_scenario(&s, &pushed, c, law, command);
    run_scenario_with(&s, &(run_options){.law = given}, &r);
    const summary out = r.summary;
    run_finish(&r);
    return out;
}

typedef struct verdict {
    double over, settling, error; // [%], [s], [%]; settling NaN: not
    double lost, late;            // separations; first contact over open-loop's
    bool within, beyond;
} verdict;

// Of a run, and the same without the push.
static verdict judge_runs(const law_case *c, double command, double open_loop,
                          const summary *s, const summary *calm)
{
    const double end = s->first_contact_s + s->settling_time_s;
    const double begin =
        c->push != 0 ? fmax(s->first_contact_s, c->push_time) : s->first_contact_s;
    verdict v = {.over = 100 * calm->smoothed_over_command_N / command,
                 .settling = isnan(end) ? end : fmax(0, end - begin),
                 .error = 100 * s->steady_error_N / command,
                 .lost = s->separations,
                 .late = s->first_contact_s / open_loop};
    const bool ok = s->status == STATUS_OK && !s->inaccurate;
    v.within = ok && v.over <= 30 && v.settling <= (v.lost > 0 ? 0.6 : 0.3) &&
               fabs(v.error) <= 5 && v.late <= 1.5;
    v.beyond = !(ok && v.over <= 120 && v.settling <= 0.8);
    return v;
}

static verdict judge(const law_case *c, const char *law, double command, double open_loop)
{
    const summary s = run_case(c, law, NULL, command);
    law_case calm = *c;
    calm.push = 0;
    const summary undisturbed = c->push != 0 ? run_case(&calm, law, NULL, command) : s;
    return judge_runs(c, command, open_loop, &s, &undisturbed);
}

// Draws that many cases and judges each at every command; `each` is told of them in
// order.
typedef void judged_case(void *tally, int number, const law_case *c, int command,
                         double open_loop, const verdict *v);
static void judge_cases(int seed, int count, const char *law, judged_case *each,
                        void *tally)
{
    random_seed(&generator, (uint64_t)seed);
    for (int i = 0; i < count; i++) {
        const law_case c = draw_case(seed);
        const double open_loop = run_case(&c, "open-loop", NULL, 1).first_contact_s;
        for (int k = 0; k < COMMANDS; k++) {
            const verdict v = judge(&c, law, commands[k], open_loop);
            each(tally, i, &c, k, open_loop, &v);
        }
    }
}
