// Cases for a control law that nobody chose (law_errors.h), and the judgement of a run of
// one, apart from that of the exam: for the programs that count them and that ask why
// they are out of bounds.
#pragma once

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "src/rig/rig.h"
#include "src/run/run.h"
#include "src/study/robust/law_errors.h"

static const double commands[] = {0.5, 1, 3};
enum { COMMANDS = 3 };

// --- a run -----------------------------------------------------------------------------

// What the cases are drawn around: an arm at 0.1 rad before its wall.
static scenario law_base(const char *law, double command)
{
    char force[32], of_law[48];
    snprintf(force, sizeof force, "control.force=%g", command);
    snprintf(of_law, sizeof of_law, "control.law=%s", law);
    char *all[] = {(char[]){"wall.angle=0"}, (char[]){"initial.angle=-0.1"}, force,
                   of_law};
    scenario s = {.name = "case"};
    fault f = {.code = STATUS_OK};
    parameters_defaults(&s.parameters, ARM_CORRECTED);
    for (int i = 0; i < 4; i++) {
        if (scenario_override(&s, all[i], &f) != STATUS_OK) {
            fprintf(stderr, "%s: %s\n", all[i], f.text);
            exit(2);
        }
    }
    return s;
}

// The scenario of a case under a law; `pushed` is where its push is kept, NULL for none.
static void case_scenario(scenario *s, action *pushed, const drawn_case *c,
                          const char *law, double command)
{
    action none;
    fault f = {.code = STATUS_OK};
    const scenario base = law_base(law, command);
    if (drawn_case_scenario(s, &base, c, pushed != NULL, pushed != NULL ? pushed : &none,
                            &f) != STATUS_OK) {
        fprintf(stderr, "%s\n", f.text);
        exit(2);
    }
    if (pushed == NULL) {
        s->actions = NULL; // of which there are none
    }
}

// Under `given` in the place of the law, if it is not NULL.
static summary run_case(const drawn_case *c, const char *law, const given_law *given,
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
static verdict judge_runs(const drawn_case *c, double command, double open_loop,
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

static verdict judge(const drawn_case *c, const char *law, double command,
                     double open_loop)
{
    const summary s = run_case(c, law, NULL, command);
    drawn_case calm = *c;
    calm.push = 0;
    const summary undisturbed = c->push != 0 ? run_case(&calm, law, NULL, command) : s;
    return judge_runs(c, command, open_loop, &s, &undisturbed);
}

// Draws that many cases, of seeds from `seed` on, and judges each at every command;
// `each` is told of them in order.
typedef void judged_case(void *tally, int number, const drawn_case *c, int command,
                         double open_loop, const verdict *v);
static void judge_cases(int seed, int count, const char *law, judged_case *each,
                        void *tally)
{
    const scenario base = law_base(law, 1);
    for (int i = 0; i < count; i++) {
        const drawn_case c = drawn_case_of(&base, (uint64_t)(seed + i));
        const double open_loop = run_case(&c, "open-loop", NULL, 1).first_contact_s;
        for (int k = 0; k < COMMANDS; k++) {
            const verdict v = judge(&c, law, commands[k], open_loop);
            each(tally, i, &c, k, open_loop, &v);
        }
    }
}
