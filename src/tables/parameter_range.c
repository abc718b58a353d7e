// The range in which a value of a parameter is usually tried: that of its slider.
#include <assert.h>
#include <math.h>
#include <stdlib.h>

#include "src/base/plain_math.h"
#include "src/tables/parameters.h"

#define FEWEST_DECADES 3    // a range of at least as many decades is logarithmic
#define MOST_DECADES   6    // of a wider range only decades near the default are shown
#define WIDE           40.0 // a range above this many times the default is cut

// 10^k for a whole number k.
static double power_of_ten(int k)
{
    double power = 1;
    for (int i = 0; i < abs(k); i++) {
        power *= 10;
    }
    if (k < 0) {
        return 1 / power;
    }
    return power;
}

// The largest whole number k for which 10^k is not above a positive number.
static int decade_of(double x)
{
    int k = (int)floor(plain_log(x) / M_LN10);

    // the logarithm may be off by its rounding
    if (power_of_ten(k) > x) {
        k--;
    }
    if (power_of_ten(k + 1) <= x) {
        k++;
    }
    return k;
}

// The smallest of 1, 2, 5, 10, 20... that is not below a positive number.
static double round_up(double x)
{
    double decade = power_of_ten(decade_of(x));
    static const double steps[] = {1, 2, 5, 10};
    for (int i = 0; i < 4; i++) {
        if (steps[i] * decade >= x * (1 - 1e-9)) {
            return steps[i] * decade;
        }
    }
    return 10 * decade;
}

bool parameter_usual_range(int parameter, double value, double *range_low,
                           double *range_high, bool *logarithmic)
{
    assert(parameter >= 0 && parameter < parameter_count);
    const parameter_info *info = &parameter_table[parameter];
    if ((info->type != PARAMETER_REAL && info->type != PARAMETER_INTEGER) ||
        !isfinite(value)) {
        return false;
    }

    // the default, and the range of the table
    parameters defaults;
    parameters_defaults(&defaults, ARM_CORRECTED);
    double usual = fabs(parameter_get(&defaults, parameter));
    double low = info->minimum, high = info->maximum;
    if (!isfinite(usual)) {
        usual = 0;
    }

    // a logarithmic range is cut to two decades on both sides of the default, and further
    // to the value
    *logarithmic = low > 0 && high / low >= power_of_ten(FEWEST_DECADES) * (1 - 1e-9);
    const double magnitude = fmax(usual, fabs(value));
    if (*logarithmic && high / low > power_of_ten(MOST_DECADES) * (1 + 1e-9) &&
        usual > 0) {
        const int below = decade_of(usual), above = below + (power_of_ten(below) < usual);
        low = fmax(low, fmin(value, power_of_ten(below - 2)));
        high = fmin(high, fmax(value, power_of_ten(above + 2)));
    } else if (!*logarithmic && high - low > WIDE * fmax(magnitude, 1e-12)) {
        // a linear range that is much wider than default and value is cut to a round
        // number above four times the default, or above the value if that is larger
        double reach = info->type == PARAMETER_REAL ? 0.1 : 10;
        if (usual > 0) {
            reach = 4 * usual;
        }
        reach = round_up(reach);
        if (fabs(value) > reach) {
            reach = round_up(fabs(value));
        }
        high = fmin(high, reach);
        low = fmax(low, -reach);
    }
    *range_low = low;
    *range_high = high;
    return true;
}
