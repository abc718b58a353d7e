// impactlab solve: the limit of a parameter up to which a condition on a result holds.
#include "ui/commands/command.h"

#include <glib.h>
#include <math.h>
#include <stdio.h>

#include "src/base/json.h"
#include "src/base/numbers.h"
#include "src/study/solve.h"
#include "ui/commands/progress.h"
#include "ui/commands/results.h"

// What is asked for, and the answer: SCENARIO, PATH[=a:b], 'KEY<VALUE'.
typedef struct question {
    const scenario *scenario;
    sweep_axis axis;
    solve_condition condition;
    int points;
    solution found;
} question;

// One limit; after an interrupt also the nearest value beyond it.
static json_t *limit_json(const question *q, const solve_limit *limit)
{
    const char *holds = limit->holds_below ? "below" : "above";
    json_t *object =
        json_of("path:t value:n quantity:t reached:n holds:t jumps:b", q->axis.name,
                limit->value, summary_table[q->condition.quantity].key, limit->reached,
                holds, limit->jumps);
    if (q->found.stopped) {
        json_members(object, "beyond:n", limit->beyond);
    }
    return object;
}

static json_t *solution_json(const void *found)
{
    const question *q = found;
    json_t *limits = json_array();
    for (int i = 0; i < q->found.count; i++) {
        json_add(limits, limit_json(q, &q->found.limits[i]));
    }
    return json_of("scenario:t solve:o", q->scenario->name, limits);
}

// A value with its unit, as text to be freed with g_free.
static char *text_with_unit(const char *value, const char *unit)
{
    return g_strconcat(value, blank_before(unit), unit, NULL);
}

// "peak force < 2 N for motor.voltage from 1 to 2 V, 65 runs"
static void print_question(const question *q)
{
    const solve_condition *c = &q->condition;
    const summary_info *quantity = &summary_table[c->quantity];
    char relation[3] = ">";
    if (c->below) {
        relation[0] = '<';
    }
    if (c->equal) {
        relation[1] = '=';
    }

    // its bound, and the range that was looked at
    char bound[NUMBER_TEXT], low[NUMBER_TEXT], high[NUMBER_TEXT];
    number_format_short(bound, c->bound);
    number_format_short(low, fmin(q->axis.low, q->axis.high));
    number_format_short(high, fmax(q->axis.low, q->axis.high));
    g_autofree char *bound_text = text_with_unit(bound, quantity->unit);
    g_autofree char *high_text =
        text_with_unit(high, sweep_axis_parameter(&q->axis)->unit);
    say("%s %s %s for %s from %s to %s, %d runs\n", quantity->label, relation, bound_text,
        q->axis.name, low, high_text, q->found.done);
}

// One limit in words.
static void print_limit(const question *q, const solve_limit *limit)
{
    const summary_info *quantity = &summary_table[q->condition.quantity];
    const char *unit = sweep_axis_parameter(&q->axis)->unit;
    const char *side = limit->holds_below ? "up to" : "from";
    char value[64], reached[64];
    decimal_print(value, sizeof value, "%.7g", limit->value);
    decimal_print(reached, sizeof reached, "%.7g", limit->reached);
    g_autofree char *value_text = text_with_unit(value, unit);
    g_autofree char *reached_text = text_with_unit(reached, quantity->unit);

    // the limit, and what is known of its surroundings
    say("\n  %s %s = %s, where the %s is %s", side, q->axis.name, value_text,
        quantity->label, reached_text);
    if (limit->jumps) {
        say(" and jumps");
    }
    if (q->found.stopped) {
        say("; it does not hold at %.7g%s%s", limit->beyond, blank_before(unit), unit);
    }
}

// How many values of the range say nothing, and why.
static void print_unknown(const question *q)
{
    const solution *found = &q->found;
    if (found->missing > 0) {
        say("  in %d of %d runs there is no %s\n", found->missing, found->done,
            summary_table[q->condition.quantity].label);
    }
    if (found->unknown > 0) {
        say("  %d of %d runs say nothing; the first: %s\n", found->unknown, found->done,
            found->reason);
    }
    if (found->more) {
        say("  there are more limits than %d\n", SOLVE_MOST_LIMITS);
    }
}

// The question and its answer.
static void print_solution(const void *found)
{
    const question *q = found;
    const solution *s = &q->found;
    say_title(q->scenario);
    print_question(q);

    // each limit, or that there is none
    for (int i = 0; i < s->count; i++) {
        print_limit(q, &s->limits[i]);
    }
    if (s->count == 0) {
        say("\n  no limit: it holds in %d of these runs and does not in %d", s->holding,
            s->failing);
    }
    say("\n");
    print_unknown(q);
}

// Reads the question and finds its answer.
static status read_and_solve(const arguments *a, question *q, run_monitor *monitor,
                             fault *f)
{
    TRY(solve_condition_read(a->operands[2], &q->condition, f));
    TRY(solve_axis_read(&q->axis, a->operands[1], q->scenario, f));
    return solve(q->scenario, &q->axis, &q->condition, q->points, many_runs_jobs(a),
                 monitor, &q->found, f);
}

// The command: finds the limits and writes them.
static int solve_and_report(const arguments *a, scenario *s)
{
    static const command_results results = {
        .json = solution_json,
        .text = print_solution,
        .kept = "limits are located as far as these allow",
        .none = "there is nothing to show"};
    question q = {.scenario = s, .points = SOLVE_POINTS};
    if (a->runs > 0) {
        q.points = (int)a->runs;
    }

    fault f = {0};
    run_monitor *monitor = work_begin(a, "runs", q.points);
    const status code = read_and_solve(a, &q, monitor, &f);
    int result = work_finish(a, code, &f, &results, &q);
    sweep_axis_finish(&q.axis);

    // no limit is a failure, which is said where the text does not say it
    if (code == STATUS_OK && q.found.count == 0) {
        if (!summary_wanted(a)) {
            complain("no limit: it holds in %d of these runs and does not in %d",
                     q.found.holding, q.found.failing);
        }
        result = worse(result, EXIT_FAILED);
    }
    return result;
}

static const option_row rows[] = {
    OPTION(WHOLE, "runs", "N",
           "values of the range that are run before limits are located (65)", PLACE(runs),
           .low = 2, .high = SOLVE_MOST_POINTS),
    JOBS_OPTION,
};

const command solve_command = {
    .name = "solve",
    .group = GROUP_MANY_RUNS,
    .summary = "Find the limit of a parameter for a condition on a result",
    .operands = "SCENARIO PATH[=a:b] 'KEY<VALUE'",
    .least = 3,
    .most = 3,
    .takes_scenarios = true,
    .help =
        "Up to which voltage does the peak stay below 2 N? solve "
        "corrected/first-impact motor.voltage 'peak_force_N<2' runs the range, that "
        "of the parameter's slider unless a:b is given, and locates each limit within "
        "it. KEY is one of run --json; the condition may be <, <=, > or >=. A limit "
        "is the last value at which the condition holds. Where there is none the exit "
        "status is 1.\n",
    .options = {&set_options, &json_options, OWN_OPTIONS(rows), &quiet_options},
    .use = solve_and_report,
};
