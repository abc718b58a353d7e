// A control law on cases that nobody chose (src/study/robust/law_errors.h): two or three
// errors at once, none of which the law is told unless the case says so. Prints every
// case that is out of bounds and how many are within them.
//
//     law_cases [SEED [COUNT [LAW [LEAST...]]]]
//
// COUNT cases of the seeds SEED, SEED + 1 ...
//
// Each case is run with commands of 0.5, 1 and 3 N. Within the bounds: 30 % overshoot of
// the mean over 5 ms, settled in 0.3 s, in 0.6 s where contact is lost, from first
// contact or a push after it, and 5 % steady error; first contact at most 1.5 times as
// late as open-loop's. A push p on a tip that presses on a wall is p/5 ms of force
// whatever a law does, 12 N at 0.06 N s: the overshoot is that of the same case without
// the push. Exit status 1 if fewer than LEAST cases are within them at a command. Beyond
// the last ones: over 120 % or 0.8 s.
#include "tests/law_cases.h"

typedef struct tally {
    int within[COMMANDS], beyond[COMMANDS];
} tally;

static void count_case(void *to, int number, const drawn_case *c, int command,
                       double open_loop, const verdict *v)
{
    (void)open_loop;
    tally *t = to;
    t->within[command] += v->within;
    t->beyond[command] += v->beyond;
    if (v->within) {
        return;
    }
    printf("%s case %d at %g N: over %.3g %%, settled %.3g s, error %.2g %%, lost %g, "
           "late %.2f:",
           v->beyond ? "BEYOND" : "out   ", number, commands[command], v->over,
           v->settling, v->error, v->lost, v->late);
    for (int j = 0; j < c->setting_count; j++) {
        printf(" %s", c->settings[j]);
    }
    printf(c->push != 0 ? " push=%.3g@%.3g\n" : "\n", c->push, c->push_time);
}

int main(int count, char **words)
{
    const int seed = count > 1 ? atoi(words[1]) : 1,
              cases = count > 2 ? atoi(words[2]) : 40;
    const char *law = count > 3 ? words[3] : "observer";
    tally t = {0};
    judge_cases(seed, cases, law, count_case, &t);

    bool failed = false;
    for (int k = 0; k < COMMANDS; k++) {
        printf("%s, seed %d, %g N: %d of %d within the bounds, %d beyond the last ones\n",
               law, seed, commands[k], t.within[k], cases, t.beyond[k]);
        failed = failed || t.within[k] < (count > 4 + k ? atoi(words[4 + k]) : 0);
    }
    return failed;
}
