// Runs all peers that were built in turn, in several rounds, and prints their times and answers.
//
// Every round runs each peer once for at least SAMPLE_TIME, one after the other on one core; a
// peer's ratio is the median over the rounds of its time over impactlab's in the same round, so
// that a machine that slows down for a while does so for both.
#include <errno.h>
#include <math.h>
#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "src/base/clock.h"
#include "src/base/whole_file.h"
#include "tests/bench/peers/peer.h"

#define SAMPLE_TIME 0.02 // shortest time of one sample [s]
enum { MOST_PEERS = 64, FEWEST_ROUNDS = 9, USUAL_ROUNDS = 11, MOST_ROUNDS = 1001 };

typedef struct contestant {
    const peer *peer;
    void *instance;
    int repetitions; // runs in a sample
    int reference;   // index of the impactlab row it is compared with
    double *samples; // computing time per simulated second, one a round [s/s]
    double median, ratio;
    double smallest, largest;
    peer_answer answer;
} contestant;

typedef struct options {
    int rounds;
    const char *json; // file, "-" for the standard output, NULL for none
} options;

// All runs on the core this starts on.
static void stay_on_one_core(void)
{
    cpu_set_t set;
    int core = sched_getcpu();
    CPU_ZERO(&set);
    CPU_SET(core < 0 ? 0 : core, &set);
    if (sched_setaffinity(0, sizeof set, &set) != 0) {
        fprintf(stderr, "peers: cannot stay on one core: %s\n", strerror(errno));
    }
}

// Computing time of so many runs [s]; negative if one failed.
static double time_runs(contestant *c, int runs)
{
    double told = 0, start = clock_seconds(CLOCK_PROCESS_CPUTIME_ID);
    for (int i = 0; i < runs; i++) {
        peer_answer_clear(&c->answer);
        if (!c->peer->run(c->instance, &c->answer)) {
            return -1;
        }
        told += c->answer.computing_time;
    }
    return isnan(told) ? clock_seconds(CLOCK_PROCESS_CPUTIME_ID) - start : told;
}

static int by_size(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(double *values, int count)
{
    qsort(values, (size_t)count, sizeof *values, by_size);
    return count % 2 ? values[count / 2] : (values[count / 2 - 1] + values[count / 2]) / 2;
}

static void dismiss(contestant *c)
{
    c->peer->destroy(c->instance);
    free(c->samples);
}

// Creates the peers of one simulator and runs each once to warm up; those that fail stay out.
static int enlist(contestant *all, int count, int (*offer)(const peer **), int rounds)
{
    const peer *list;
    int offered = offer(&list);
    for (int i = 0; i < offered && count < MOST_PEERS; i++) {
        contestant *c = &all[count];
        *c = (contestant){.peer = &list[i], .instance = list[i].create(&list[i])};
        if (c->instance == NULL) {
            fprintf(stderr, "peers: %s, %s: could not be set up\n", list[i].program, list[i].setup);
            continue;
        }
        c->samples = calloc((size_t)rounds, sizeof *c->samples);
        double first = c->samples != NULL ? time_runs(c, 1) : -1, second = time_runs(c, 1);
        if (first < 0 || second < 0) {
            fprintf(stderr, "peers: %s, %s: the run failed\n", list[i].program, list[i].setup);
            dismiss(c);
            continue;
        }
        c->repetitions = (int)fmax(1, ceil(SAMPLE_TIME / fmax(second, 1e-7)));
        count++;
    }
    return count;
}

// Compared with the first row of impactlab that has as many links.
static void find_references(contestant *all, int count)
{
    for (int i = 0; i < count; i++) {
        int j = 0;
        while (j < i && all[j].peer->links != all[i].peer->links) {
            j++;
        }
        all[i].reference = j;
    }
}

static bool run_rounds(contestant *all, int count, int rounds)
{
    for (int round = 0; round < rounds; round++) {
        for (int i = 0; i < count; i++) {
            contestant *c = &all[i];
            double time = time_runs(c, c->repetitions);
            if (time < 0) {
                fprintf(stderr, "peers: %s, %s: the run failed\n", c->peer->program,
                        c->peer->setup);
                return false;
            }
            c->samples[round] = time / (c->repetitions * c->peer->duration(c->instance));
        }
    }
    return true;
}

static bool evaluate(contestant *all, int count, int rounds)
{
    double *ratios = calloc((size_t)rounds, sizeof *ratios);
    if (ratios == NULL) {
        fprintf(stderr, "peers: out of memory\n");
        return false;
    }
    for (int i = 0; i < count; i++) {
        contestant *c = &all[i];
        for (int round = 0; round < rounds; round++) {
            ratios[round] = c->samples[round] / all[c->reference].samples[round];
        }
        c->ratio = median(ratios, rounds);
    }
    free(ratios);
    // only now, since the ratios needed the order of the rounds
    for (int i = 0; i < count; i++) {
        contestant *c = &all[i];
        c->median = median(c->samples, rounds);
        c->smallest = c->samples[0];
        c->largest = c->samples[rounds - 1];
    }
    return true;
}

// --- output ---------------------------------------------------------------------------------

// A number in a column, "-" if there is none.
static void print_cell(FILE *out, int width, const char *format, double value)
{
    char text[40] = "-";
    if (!isnan(value)) {
        snprintf(text, sizeof text, format, value);
    }
    fprintf(out, " %*s", width, text);
}

static double time_per_step(const contestant *c)
{
    double step = c->peer->step(c->instance);
    return step > 0 ? c->median * step : (double)NAN;
}

static void print_speed(FILE *out, const contestant *c)
{
    double step = c->peer->step(c->instance);
    fprintf(out, "%-9s %-7s %-34s", c->peer->program, c->peer->version, c->peer->setup);
    print_cell(out, 9, "%.4g", step > 0 ? 1e3 * step : (double)NAN);
    print_cell(out, 9, "%.3f", 1e6 * time_per_step(c));
    print_cell(out, 11, "%.3f", 1e3 * c->median);
    print_cell(out, 11, c->median < 1e-3 ? "%.1f" : "%.0f", 1e6 * c->median);
    print_cell(out, 10, c->ratio < 100 ? "%.2f" : "%.0f", c->ratio);
    fprintf(out, "\n");
}

static void print_speeds(FILE *out, const contestant *all, int count, int links)
{
    fprintf(out, "%-9s %-7s %-34s %9s %9s %11s %11s %10s\n", "program", "version", "set-up", "step",
            "us per", "us per", "us per", "times");
    fprintf(out, "%-9s %-7s %-34s %9s %9s %11s %11s %10s\n", "", "", "", "[ms]", "step", "1 ms",
            "1 s", "impactlab");
    for (int i = 0; i < count; i++) {
        if (all[i].peer->links == links) {
            print_speed(out, &all[i]);
        }
    }
}

static void print_answers(FILE *out, const contestant *all, int count)
{
    fprintf(out, "%-9s %-34s %8s %13s %9s %11s %9s %9s %13s %9s\n", "program", "set-up", "steps",
            "1st contact", "impulse", "peak", "delay", "release", "2nd contact", "end");
    fprintf(out, "%-9s %-34s %8s %13s %9s %11s %9s %9s %13s %9s\n", "", "", "", "[s]", "[N s]",
            "[N]", "[ms]", "[s]", "[s]", "[N]");
    for (int i = 0; i < count; i++) {
        const contestant *c = &all[i];
        const peer_answer *a = &c->answer;
        if (c->peer->links != 2) {
            continue;
        }
        fprintf(out, "%-9s %-34s", c->peer->program, c->peer->setup);
        print_cell(out, 8, "%.0f", a->steps);
        print_cell(out, 13, "%.10f", a->first_contact);
        print_cell(out, 9, "%.6f", a->impulse);
        print_cell(out, 11, "%.8f", a->peak);
        print_cell(out, 9, "%.4f", 1e3 * a->peak_delay);
        print_cell(out, 9, "%.6f", a->release);
        print_cell(out, 13, "%.10f", a->second_contact);
        print_cell(out, 9, "%.6f", a->final_force);
        fprintf(out, "\n");
    }
}

static void print_differences(FILE *out, const contestant *all, int count)
{
    fprintf(out, "%-9s %-34s %11s %11s %11s %11s %11s\n", "program", "set-up", "1st contact",
            "peak", "delay", "release", "2nd contact");
    fprintf(out, "%-9s %-34s %11s %11s %11s %11s %11s\n", "", "", "[s]", "[N]", "[s]", "[s]",
            "[s]");
    const peer_answer *ours = &all[0].answer;
    for (int i = 1; i < count; i++) {
        const peer_answer *a = &all[i].answer;
        if (all[i].peer->links != 2) {
            continue;
        }
        fprintf(out, "%-9s %-34s", all[i].peer->program, all[i].peer->setup);
        print_cell(out, 11, "%+.1e", a->first_contact - ours->first_contact);
        print_cell(out, 11, "%+.1e", a->peak - ours->peak);
        print_cell(out, 11, "%+.1e", a->peak_delay - ours->peak_delay);
        print_cell(out, 11, "%+.1e", a->release - ours->release);
        print_cell(out, 11, "%+.1e", a->second_contact - ours->second_contact);
        fprintf(out, "\n");
    }
}

static void print_tables(FILE *out, const contestant *all, int count, int rounds)
{
    static const int chains[] = {8, 32, 128};
    fprintf(out, "Two links against a flat wall, %g V, 1 s; medians of %d rounds on one core\n\n",
            EXPERIMENT_VOLTAGE, rounds);
    print_speeds(out, all, count, 2);
    fprintf(out, "\nWhat they answer\n\n");
    print_answers(out, all, count);
    fprintf(out, "\nDifferences from impactlab's event method\n\n");
    print_differences(out, all, count);
    for (size_t i = 0; i < sizeof chains / sizeof chains[0]; i++) {
        fprintf(out, "\nFree flight of %d links\n\n", chains[i]);
        print_speeds(out, all, count, chains[i]);
    }
}

static void write_number(FILE *out, const char *key, double value)
{
    if (isfinite(value)) {
        fprintf(out, ", \"%s\": %.12g", key, value);
    } else {
        fprintf(out, ", \"%s\": null", key);
    }
}

static void write_answers(FILE *out, const contestant *all, int count, int rounds)
{
    fprintf(out, "{\"rounds\": %d, \"peers\": [", rounds);
    for (int i = 0; i < count; i++) {
        const contestant *c = &all[i];
        const peer_answer *a = &c->answer;
        double step = c->peer->step(c->instance);
        fprintf(out,
                "%s\n  {\"program\": \"%s\", \"version\": \"%s\", \"setup\": \"%s\", \"links\": %d",
                i > 0 ? "," : "", c->peer->program, c->peer->version, c->peer->setup,
                c->peer->links);
        write_number(out, "step_s", step > 0 ? step : (double)NAN);
        write_number(out, "us_per_step", 1e6 * time_per_step(c));
        write_number(out, "us_per_simulated_s", 1e6 * c->median);
        write_number(out, "us_per_simulated_s_min", 1e6 * c->smallest);
        write_number(out, "us_per_simulated_s_max", 1e6 * c->largest);
        write_number(out, "ratio_to_impactlab", c->ratio);
        write_number(out, "steps", a->steps);
        write_number(out, "first_contact_s", a->first_contact);
        write_number(out, "contact_impulse_Ns", a->impulse);
        write_number(out, "first_pulse_peak_N", a->peak);
        write_number(out, "first_pulse_time_to_peak_s", a->peak_delay);
        write_number(out, "largest_force_with_impact_N", a->spike);
        write_number(out, "release_s", a->release);
        write_number(out, "second_contact_s", a->second_contact);
        write_number(out, "final_force_N", a->final_force);
        fprintf(out, "}");
    }
    fprintf(out, "\n]}\n");
}

static bool write_json(const contestant *all, int count, const options *o)
{
    fault f;
    whole_file file;
    bool good = whole_file_open(&file, o->json, &f) == STATUS_OK;
    if (good) {
        write_answers(file.stream, all, count, o->rounds);
        good = whole_file_commit(&file, &f) == STATUS_OK;
    }
    if (!good) {
        fprintf(stderr, "peers: %s\n", f.text);
    }
    return good;
}

// --- command line ---------------------------------------------------------------------------

static bool read_options(options *o, int argc, char **argv)
{
    *o = (options){.rounds = USUAL_ROUNDS};
    for (int i = 1; i < argc; i++) {
        char *end = NULL;
        if (strcmp(argv[i], "--json") == 0 && i + 1 < argc) {
            o->json = argv[++i];
        } else if (strcmp(argv[i], "--rounds") == 0 && i + 1 < argc) {
            long rounds = strtol(argv[++i], &end, 10);
            if (*end != '\0' || rounds < FEWEST_ROUNDS || rounds > MOST_ROUNDS) {
                fprintf(stderr, "peers: --rounds %s: expected a number from %d to %d\n", argv[i],
                        FEWEST_ROUNDS, MOST_ROUNDS);
                return false;
            }
            o->rounds = (int)rounds;
        } else {
            fprintf(stderr,
                    "peers: unknown or incomplete argument '%s', expected --json FILE|- or "
                    "--rounds N\n",
                    argv[i]);
            return false;
        }
    }
    return true;
}

int main(int argc, char **argv)
{
    options o;
    if (!read_options(&o, argc, argv)) {
        return 2;
    }
    stay_on_one_core();
    static contestant all[MOST_PEERS];
    int count = enlist(all, 0, peers_impactlab, o.rounds);
    bool good = count > 0;
#ifdef PEERS_MUJOCO
    count = enlist(all, count, peers_mujoco, o.rounds);
#endif
#ifdef PEERS_SICONOS
    count = enlist(all, count, peers_siconos, o.rounds);
#endif
    find_references(all, count);
    good = good && run_rounds(all, count, o.rounds) && evaluate(all, count, o.rounds);
    if (good) {
        bool json_only = o.json != NULL && strcmp(o.json, "-") == 0;
        if (!json_only) {
            print_tables(stdout, all, count, o.rounds);
        }
        good = o.json == NULL || write_json(all, count, &o);
    }
    for (int i = 0; i < count; i++) {
        dismiss(&all[i]);
    }
    return good ? 0 : 1;
}
