// impactlab robust --draw: control laws in cases that nobody chose.
#pragma once

#include "src/study/robust/law_exam.h"
#include "ui/commands/command.h"

// Reads the commands of --force, or the scenario's own, into an exam. Returns the exit
// status.
int read_exam_forces(const arguments *a, const scenario *s, exam_request *asked);

// Examines laws (control_law) around a scenario, in as many cases as --draw says, and
// writes what was asked for. Returns the exit status.
int robust_exam(const arguments *a, const scenario *s, const int *laws, int law_count);
