// Why a law is out of bounds on drawn cases (law_cases.h), and what physics has to do
// with it.
//
//     law_bounds [SEED [COUNT [LAW [CAUSES [OPEN]]]]]
//
// Of every run that is out of bounds a line tells: which error of the case, were it not
// there, would bring the law within them; and how a law comes out that sees the whole arm
// and is told all but the push (law_informed.h). Where that is within the bounds no
// argument from physics can excuse a run: what another law lacks is knowledge. Where it
// is not, nothing is proved: the run is open. Last, the classes and how many are in each;
// without CAUSES also in how many of all cases that law is within the bounds with the
// same tuning for all, told all or less. Exit status 1 if fewer than CAUSES runs have
// such an error or more than OPEN are open.
#include <limits.h>

#include "tests/law_informed.h"

// The case without one of its errors.
static drawn_case without(const drawn_case *c, int kind)
{
    drawn_case less = *c;
    less.setting_count = 0;
    for (int i = 0; i < c->setting_count; i++) {
        if (c->of[i] != kind) {
            const int to = less.setting_count++;
            memcpy(less.settings[to], c->settings[i], sizeof c->settings[i]);
            less.of[to] = c->of[i];
        }
    }
    if (strcmp(law_error_name(kind), "push") == 0) {
        less.push = 0;
    }
    return less;
}

typedef struct tally {
    const char *law;
    int out, lost, slow, high, wrong, late; // runs out of bounds, and by which of them
    int found;                    // of which the law that sees all is within them
    int by[LAW_ERRORS], several;  // an error without which the run is within; none is
    bool surveys;                 // what knowledge is worth, too:
    int one[KNOWLEDGE][COMMANDS]; // cases in which that law is with one tuning for all
} tally;

static void count_bounds(tally *t, const verdict *v)
{
    t->out++;
    t->lost += v->lost > 0;
    t->slow += !(v->settling <= (v->lost > 0 ? 0.6 : 0.3));
    t->high += v->over > 30;
    t->wrong += fabs(v->error) > 5;
    t->late += v->late > 1.5;
}

static void print_tally(const tally *t)
{
    printf(
        "%d runs out of bounds: %d lose contact; %d slow, %d over, %d wrong, %d late\n",
        t->out, t->lost, t->slow, t->high, t->wrong, t->late);
    printf("a law that sees all is within them in %d; %d are open\n", t->found,
           t->out - t->found);
    for (int i = 0; t->surveys && i < KNOWLEDGE; i++) {
        printf("with one tuning it is in %d, %d, %d cases at 0.5, 1, 3 N: %s\n",
               t->one[i][0], t->one[i][1], t->one[i][2], knowledge_names[i]);
    }
    for (int e = 0; e < LAW_ERRORS; e++) {
        if (t->by[e] > 0) {
            printf("%4d within the bounds without: %s\n", t->by[e], law_error_name(e));
        }
    }
    printf("%4d out of them whichever one error is missing\n", t->several);
}

// Prints which error of a run brings it within the bounds when it is missing, and counts
// it.
static void print_causes(tally *t, const drawn_case *c, double command)
{
    bool alone = false;
    for (int i = 0; i < c->error_count; i++) {
        const int kind = c->errors[i];
        const drawn_case less = without(c, kind);
        const double open_loop = run_case(&less, "open-loop", NULL, 1).first_contact_s;
        const bool cause = judge(&less, t->law, command, open_loop).within;
        t->by[kind] += cause;
        alone = alone || cause;
        printf(" %s%s", law_error_name(kind), cause ? " (cause)," : ",");
    }
    t->several += !alone;
}

static void explain_case(void *to, int number, const drawn_case *c, int command,
                         double open_loop, const verdict *v)
{
    tally *t = to;
    for (int i = 0; t->surveys && i < KNOWLEDGE; i++) {
        t->one[i][command] += informed_once(c, commands[command], open_loop, i).within;
    }
    if (v->within) {
        return;
    }
    count_bounds(t, v);
    printf("case %2d at %g N: over %.3g %%, %.3g s, %.2g %%, lost %g;", number,
           commands[command], v->over, v->settling, v->error, v->lost);
    print_causes(t, c, commands[command]);

    // and who sees all
    const verdict best = informed_search(c, commands[command], open_loop);
    t->found += best.within;
    printf(" %s: over %.3g %%, %.3g s, %.2g %%, lost %g",
           best.within ? "no matter of physics" : "open", best.over, best.settling,
           best.error, best.lost);
    putchar('\n');
    fflush(stdout);
}

int main(int count, char **words)
{
    const int seed = count > 1 ? atoi(words[1]) : 1,
              cases = count > 2 ? atoi(words[2]) : 40;
    const int causes = count > 4 ? atoi(words[4]) : 0,
              open = count > 5 ? atoi(words[5]) : INT_MAX;
    tally t = {.law = count > 3 ? words[3] : "observer", .surveys = count <= 4};
    judge_cases(seed, cases, t.law, explain_case, &t);
    print_tally(&t);
    return t.out - t.several < causes || t.out - t.found > open;
}
