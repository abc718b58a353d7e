// The chain at all points of a stride, as many at once as the processor's vectors hold; the same
// bits in all of them.
#pragma once

#include "src/solve/modal_stride.h"

// Velocities and forces from angles and V y of the points from `first` on, in s->more_columns: what
// is to be brought to the modes takes their place; angles and velocities go into s->point_angles
// and s->point_velocities.
void modal_sweep_points(modal_stride *s, const arm *a, const double *q, int first);

// Doubles of s->lanes, a whole number of cache lines.
size_t modal_points_size(int dof);

// As many points as the name says (modal_points_kernel.h).
void modal_sweep_points_1(modal_stride *s, const arm *a, const double *q, int first);
void modal_sweep_points_2(modal_stride *s, const arm *a, const double *q, int first);
void modal_sweep_points_4(modal_stride *s, const arm *a, const double *q, int first);
void modal_sweep_points_8(modal_stride *s, const arm *a, const double *q, int first);
