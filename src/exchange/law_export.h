// A control law as C for a board: law.h, law.c, a program that replays the lab's readings
// through it, and these readings. The law's source is the lab's own file
// (src/exchange/board/amalgamate.py), the design's numbers stand in tables.
#pragma once

#include <stdbool.h>
#include <stdio.h>

#include "src/base/fault.h"
#include "src/rig/rig.h"
#include "src/scenario/scenario.h"

enum { IN_DOUBLE, IN_SINGLE, PRECISIONS };

// A law's file, the names in it, and what it costs on a Cortex-M4F, compiled by gcc -O2
// (tests/law_on_board measures it).
typedef struct exported_law {
    int law;                        // of control_law
    const char *name, *memory;      // of its controller and of the type of its memory
    const char *source[PRECISIONS]; // its text with double and with float
    int instructions[PRECISIONS];   // of a sample, at most
    int stack[PRECISIONS];          // bytes of its largest frame
} exported_law;

typedef struct law_export {
    const scenario *scenario; // borrowed
    const exported_law *law;
    int precision; // IN_DOUBLE or IN_SINGLE
    rig *rig;      // whose law is exported, with what it is told at the start

    // of the run that gave the readings
    long samples;
    bool told_again; // its script tells the law other values; readings end there
} law_export;

// Takes a scenario's law and what it is told. STATUS_BAD_SCENARIO, with a sentence in f,
// where the law is none of those that a board can hold, or refuses; law_export_finish in
// either case.
status law_export_init(law_export *e, const scenario *s, int precision, fault *f);
void law_export_finish(law_export *e);

// The interface, the names of the law's parameters and its functions (law.h).
void law_export_header(const law_export *e, FILE *stream);
// The law and the numbers of its design (law.c).
void law_export_source(const law_export *e, FILE *stream);
// The program that compares (replay.c).
void law_export_replay(const law_export *e, FILE *stream);

// Runs the scenario and writes what the law read and answered at each sample
// (readings.csv), with 17 digits, until its script tells the law other values. What the
// run failed with, with a sentence in f.
status law_export_readings(law_export *e, FILE *stream, fault *f);
