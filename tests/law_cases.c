// A control law on cases that nobody chose: two or three errors at once, drawn from the ranges
// below, none of which the law is told unless the case says so. Prints every case that is out of
// bounds and how many are within them.
//
//     law_cases [SEED [COUNT [LAW [LEAST...]]]]
//
// Each case is run with commands of 0.5, 1 and 3 N. Within the bounds: 30 % overshoot of the mean
// over 5 ms, settled in 0.3 s, in 0.6 s where contact is lost, from first contact or a push after
// it, and 5 % steady error; first contact at most 1.5 times as late as open-loop's. A push p on a
// tip that presses on a wall is p/5 ms of force whatever a law does, 12 N at 0.06 N s: the
// overshoot is that of the same case without the push. Exit status 1 if fewer than LEAST cases are
// within them at a command. Beyond the last ones: over 120 % or 0.8 s.
#include "tests/law_cases.h"

int main(int count, char **words)
{
    const int seed = count > 1 ? atoi(words[1]) : 1, cases = count > 2 ? atoi(words[2]) : 40;
    const char *law = count > 3 ? words[3] : "observer";
    int within[COMMANDS] = {0}, beyond[COMMANDS] = {0}, failed = 0;
    random_seed(&generator, (uint64_t)seed);
    for (int i = 0; i < cases; i++) {
        const law_case c = draw_case(seed);
        const double open_loop = run_case(&c, "open-loop", 1).first_contact_s;
        for (int k = 0; k < COMMANDS; k++) {
            const verdict v = judge(&c, law, commands[k], open_loop);
            within[k] += v.within;
            beyond[k] += v.beyond;
            if (v.within) {
                continue;
            }
            printf("%s case %d at %g N: over %.3g %%, settled %.3g s, error %.2g %%, lost %g, "
                   "late %.2f:",
                   v.beyond ? "BEYOND" : "out   ", i, commands[k], v.over, v.settling, v.error,
                   v.lost, v.late);
            for (int j = 0; j < c.count; j++) {
                printf(" %s", c.settings[j]);
            }
            printf(c.push != 0 ? " push=%.3g@%.3g\n" : "\n", c.push, c.push_time);
        }
    }
    for (int k = 0; k < COMMANDS; k++) {
        printf("%s, seed %d, %g N: %d of %d within the bounds, %d beyond the last ones\n", law,
               seed, commands[k], within[k], cases, beyond[k]);
        const int least = count > 4 + k ? atoi(words[4 + k]) : 0;
        failed = failed || within[k] < least;
    }
    return failed;
}
