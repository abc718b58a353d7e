// A first-order lag, as force sensors and amplifiers have: time_constant value' = input -
// value.
#pragma once

typedef struct first_order_lag {
    double time_constant; // [s], 0 for a sensor without it
    double value;         // in the input's unit
    // the factor by which a transient decays over that interval, kept because
    // most intervals are, up to rounding, as long as the one before
    double interval; // [s], 0: none
    double left;     // exp(-interval/time_constant)
} first_order_lag;

// An input over an interval: the parabola through its ends that has that mean.
typedef struct lag_input {
    double length; // [s]
    double first, last, mean;
} lag_input;

// The lag's value at the end of the input: exact.
void lag_follow(first_order_lag *y, const lag_input *input);

// Under a pulse of the input, given by its integral.
void lag_strike(first_order_lag *y, double pulse);

// What comes out of the lag, one without a time constant letting its input through.
static inline double lag_output(const first_order_lag *y, double input)
{
    return y->time_constant > 0 ? y->value : input;
}

// The values at which what comes out turns within an input that is still to be followed,
// the earlier one first. Returns how many those are.
enum { LAG_MOST_TURNS = 2 };
int lag_turns(const first_order_lag *y, const lag_input *input,
              double turns[LAG_MOST_TURNS]);
