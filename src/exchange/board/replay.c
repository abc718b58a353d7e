// Runs the readings of a run of the lab through the exported law and compares the
// commands:
//
//     cc -O2 -ffp-contract=off -o replay law.c replay.c -lm && ./replay <readings.csv
//
// In double precision every command has the lab's bits, in single the largest difference
// is said. Ends with 1 where a command differs by more than the law's precision allows.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "law.h"

enum { COLUMNS = 10 }; // of a controller's input but wanted_mode, and the lab's command

// The numbers of a line, NaN where a cell is empty. False unless there are enough.
static int read_numbers(const char *line, double numbers[COLUMNS])
{
    for (int i = 0; i < COLUMNS; i++) {
        char *end;
        numbers[i] = strtod(line, &end);
        if (end == line) {
            numbers[i] = NAN;
        }
        if (i < COLUMNS - 1 && *end != ',') {
            return 0;
        }
        line = end + 1;
    }
    return 1;
}

int main(void)
{
    char line[1024];
    long samples = 0, differing = 0;
    double largest = 0;
    const char *refusal = law_start();
    if (refusal != NULL) {
        fprintf(stderr, "replay: the law refuses: %s\n", refusal);
        return 1;
    }

    while (fgets(line, sizeof line, stdin) != NULL) {
        double n[COLUMNS];
        if (samples == 0 && line[0] == 't') {
            continue; // the line of names
        }
        if (!read_numbers(line, n)) {
            fprintf(stderr, "replay: sample %ld is no line of ten numbers\n", samples);
            return 1;
        }
        const controller_input in = {.time = n[0],
                                     .encoder = n[1],
                                     .tachometer = n[2],
                                     .force = n[3],
                                     .voltage = n[4],
                                     .piezo_force = n[5],
                                     .film = n[6],
                                     .accelerometer = n[7],
                                     .wanted_mode = -1,
                                     .predicted_force = n[8]};
        controller_output out;
        law_sample(&in, &out);
        samples++;
        const double off = fabs(out.command - n[9]);
        differing += off != 0;
        largest = fmax(largest, off);
    }

    printf("%ld samples, %ld commands differ, by %.3g V at most\n", samples, differing,
           largest);
    return samples == 0 || !(largest <= LAW_TOLERANCE);
}
