// impactlab solve: the limit of a parameter up to which a condition on a result holds.

#include "src/base/json.h"
#include "src/base/numbers.h"
#include "src/study/solve.h"
#include "ui/commands/progress.h"

// What is asked for, and the answer: SCENARIO, PATH[=a:b], 'KEY<VALUE'.
typedef struct question {
    sweep_axis axis;
    solve_condition condition;
    int points;
    solution found;
} question;

static json_t *answer(const scenario *s, const void *asked)
{
    const question *q = asked;
    const solution *found = &q->found;
    json_t *limits = json_array();
    for (int i = 0; i < found->count; i++) {
        const solve_limit *limit = &found->limits[i];
        json_t *line =
            json_of("path:t value:n quantity:t reached:n holds:t jumps:b", q->axis.name,
                    limit->value, summary_table[q->condition.quantity].key,
                    limit->reached, limit->holds_below ? "below" : "above", limit->jumps);
        if (found->stopped) {
            json_members(line, "beyond:n", limit->beyond);
        }
        json_add(limits, line);
    }
    return json_of("scenario:t solve:o", s->name, limits);
}

// How many values of the range say nothing, and why.
static void say_what_is_unknown(const question *q, const solution *found)
{
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

static void print_answer(const scenario *s, const void *asked)
{
    const question *q = asked;
    const solution *found = &q->found;
    const solve_condition *c = &q->condition;
    const summary_info *quantity = &summary_table[c->quantity];
    const char *unit = sweep_axis_parameter(&q->axis)->unit, *gap = blank_before(unit);
    char bound[NUMBER_TEXT], low[NUMBER_TEXT], high[NUMBER_TEXT];
    number_format_short(bound, c->bound);
    number_format_short(low, fmin(q->axis.low, q->axis.high));
    number_format_short(high, fmax(q->axis.low, q->axis.high));

    // the question, with the range that was looked at
    char relation[3] = ">";
    if (c->below) {
        relation[0] = '<';
    }
    if (c->equal) {
        relation[1] = '=';
    }
    say_title(s);
    say("%s %s %s%s%s for %s from %s to %s%s%s, %d runs\n", quantity->label, relation,
        bound, blank_before(quantity->unit), quantity->unit, q->axis.name, low, high, gap,
        unit, found->done);

    // the answer: each limit
    for (int i = 0; i < found->count; i++) {
        const solve_limit *limit = &found->limits[i];
        char value[64], reached[64];
        decimal_print(value, sizeof value, "%.7g", limit->value);
        decimal_print(reached, sizeof reached, "%.7g", limit->reached);
        say("\n  %s %s = %s%s%s, where the %s is %s%s%s",
            limit->holds_below ? "up to" : "from", q->axis.name, value, gap, unit,
            quantity->label, reached, blank_before(quantity->unit), quantity->unit);
        if (limit->jumps) {
            say(" and jumps");
        }
        if (found->stopped) {
            say("; it does not hold at %.7g%s%s", limit->beyond, gap, unit);
        }
    }
    if (found->count == 0) {
        say("\n  no limit: it holds in %d of these runs and does not in %d",
            found->holding, found->failing);
    }
    say("\n");
    say_what_is_unknown(q, found);
}

static int find_and_report(const arguments *a, scenario *s)
{
    static const command_results r = {answer, print_answer,
                                      .kept = "limits are told as near as these come",
                                      .none = "there is nothing to show"};
    question q = {.points = a->runs > 0 ? (int)a->runs : SOLVE_POINTS};
    fault f = {0};
    run_monitor *monitor = work_begin(a, "runs", q.points);
    status code = solve_condition_read(a->operands[2], &q.condition, &f);
    if (code == STATUS_OK) {
        code = solve_axis_read(&q.axis, a->operands[1], s, &f);
    }
    if (code == STATUS_OK) {
        code = solve(s, &q.axis, &q.condition, q.points, many_runs_jobs(a), monitor,
                     &q.found, &f);
    }
    const int written = work_finish(a, code, &f, &r, s, &q);
    sweep_axis_finish(&q.axis);
    const bool none = code == STATUS_OK && q.found.count == 0;
    if (none && !summary_wanted(a)) {
        complain("no limit: it holds in %d of these runs and does not in %d",
                 q.found.holding, q.found.failing);
    }
    if (none) {
        return worse(written, EXIT_FAILED);
    }
    return written;
}

static const option_row rows[] = {
    OPTION(WHOLE, "runs", "N",
           "values of the range that are run before limits are located (65)", PLACE(runs),
           .low = 2, .high = SOLVE_MOST_POINTS),
    JOBS_OPTION,
};

const command solve_command = {
    CALLED("solve", MANY_RUNS,
           "Find the limit of a parameter for a condition on a result"),
    SCENARIOS("SCENARIO PATH[=a:b] 'KEY<VALUE'", 3, 3),
    .help =
        "Up to which voltage does the peak stay below 2 N? solve corrected/first-impact\n"
        "motor.voltage 'peak_force_N<2' runs the range, that of the parameter's slider "
        "unless "
        "a:b is\ngiven, and locates each limit within it. KEY is one of run --json; the "
        "condition may be\n<, <=, > or >=. A limit is the last value at which the "
        "condition "
        "holds. Where there is\nnone the exit status is 1.\n",
    .options = {&set_options, &json_options, OWN_OPTIONS(rows), &quiet_options},
    .use = find_and_report,
};
