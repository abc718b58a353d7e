// What the parts share that find the errors of a model that lacks something.
#pragma once

#include "src/study/identify/identify.h"

// How large a command that nobody recorded and the noise most likely are.
typedef struct lack_scales {
    double strength;     // g^2; NaN where no reading changes with the command
    double scale;        // s^2
    double unlikelihood; // twice the negative logarithm of the residuals' likelihood
} lack_scales;

// What the fit tells of its unknowns, to be given, and what each stretch of such a
// command does.
typedef struct lack_model {
    const double *jacobian; // [unknowns * residuals]
    const double *alone;    // A, the parameters' columns, freed of what the traces' own
                            // unknowns explain [parameters * residuals]
    const double *values;   // eigenvalues of A'A [parameters]
    int count;              // of stretches
    double length;          // of each [s]
    double *columns;        // D, changes of the residuals by each [count * residuals]
    double *shares;     // changes of the parameters, in their scales [count * parameters]
    double *vectors;    // eigenvectors of D'D, row by row [count * count]
    double *sizes;      // its eigenvalues [count]
    double *room;       // [count]
    lack_scales scales; // of the fit's residuals
} lack_model;

// Sets the covariance to what a command that nobody recorded could make, and
// `lack.command`; neither where the amplifier does not take such a command. The model is
// to be finished in either case. Fails as identify_evaluate does.
status lack_find_command(identification *id, lack_model *model, fault *f);
void lack_finish(lack_model *model);

// Finds the scales under which residuals[] are most likely, of which what the unknowns
// could explain is taken out. False without memory.
bool lack_find_scales(const identification *id, const lack_model *model, double *residual,
                      lack_scales *found);

// Adds the error that a hub which gives could make to the covariance, where the scenario
// takes it for rigid, and sets `lack.hub_spring` and what follows. Not where joints'
// damping is fitted: one joint more would change their numbers. Fails as
// identify_evaluate does.
status lack_allow_for_hub(identification *id, const lack_model *model, fault *f);
