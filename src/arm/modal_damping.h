// Damping that is given mode by mode: torques in the joints that couple them.
#pragma once

#include "src/arm/arm.h"

// Rows g of arm.modal_damping for the damping ratios of a list as parameters have it: with the hub
// held, mode i of the straight arm decays as exp(-ratio_i w_i t). In the bends b of the joints,
//
//     M b" + C b' + K b = 0,      C = sum of g g',      g = (2 ratio/w)^(1/2) K^(1/2) y,
//
// y the unit eigenvectors of K^(-1/2) M K^(-1/2) with the values 1/w^2. C takes nothing from an arm
// that turns as a whole; ratios that grow with w make it proportional to K. Returns how many rows
// there are, 0 for the empty list. At most PARAMETER_LIST_MOST links.
int modal_damping_rows(const arm *a, const char *ratios, double rows[][PARAMETER_LIST_MOST]);
