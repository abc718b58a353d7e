#include "ui/explorer/state/slider.h"

#include <assert.h>
#include <math.h>

#include "src/tables/parameters.h"

#define FEWEST_DECADES 3    // from this many on a range is logarithmic
#define MOST_DECADES   6    // a wider range shows those near the default
#define WIDE           40.0 // times its default a range is shown in part

static double default_of(int parameter)
{
    parameters p;
    parameters_defaults(&p, ARM_CORRECTED);
    double value = parameter_get(&p, parameter);
    return isfinite(value) ? value : 0;
}

// The smallest of 1, 2, 5, 10, 20... that is not below a positive number.
static double round_up(double x)
{
    double decade = pow(10, floor(log10(x)));
    static const double steps[] = {1, 2, 5, 10};
    for (int i = 0; i < 4; i++) {
        if (steps[i] * decade >= x * (1 - 1e-9)) {
            return steps[i] * decade;
        }
    }
    return 10 * decade;
}

bool slider_scale_of(int parameter, double value, slider_scale *scale)
{
    assert(parameter >= 0 && parameter < parameter_count && scale != NULL);
    const parameter_info *info = &parameter_table[parameter];
    if ((info->type != PARAMETER_REAL && info->type != PARAMETER_INTEGER) || !isfinite(value)) {
        return false;
    }
    double usual = fabs(default_of(parameter)), low = info->minimum, high = info->maximum;

    // decades: all of them, or some near the default up to the value
    if (low > 0 && log10(high / low) >= FEWEST_DECADES) {
        if (log10(high / low) > MOST_DECADES && usual > 0) {
            low = fmax(low, fmin(value, pow(10, floor(log10(usual)) - 2)));
            high = fmin(high, fmax(value, pow(10, ceil(log10(usual)) + 2)));
        }
        *scale = (slider_scale){low, high, true};
        return true;
    }

    // a range much wider than the default is shown in part
    double size = fmax(usual, fabs(value));
    if (high - low > WIDE * fmax(size, 1e-12)) {
        // a range that suits the default, or the value once that is far from it
        double reach = round_up(usual > 0 ? 4 * usual : info->type == PARAMETER_REAL ? 0.1 : 10);
        reach = fabs(value) > reach ? round_up(fabs(value)) : reach;
        high = fmin(high, reach);
        low = fmax(low, -reach);
    }
    *scale = (slider_scale){low, high, false};
    return true;
}

double slider_share(const slider_scale *scale, double value)
{
    assert(scale != NULL && scale->high > scale->low);
    double share = scale->logarithmic ? log(value / scale->low) / log(scale->high / scale->low)
                                      : (value - scale->low) / (scale->high - scale->low);
    return fmax(0, fmin(1, share));
}

double slider_value(const slider_scale *scale, int parameter, double share, int cells)
{
    assert(scale != NULL && parameter >= 0 && parameter < parameter_count);
    const parameter_info *info = &parameter_table[parameter];
    double value, step;
    share = fmax(0, fmin(1, share));

    // the share on its scale, and the step that a cell can tell
    if (scale->logarithmic) {
        value = scale->low * pow(scale->high / scale->low, share);
        step = pow(10, floor(log10(value)) - 1);
    } else {
        double width = scale->high - scale->low;
        value = scale->low + share * width;
        step = pow(10, floor(log10(width / (cells > 1 ? cells : 1))));
    }

    // whole steps, within what the table allows
    step = info->type == PARAMETER_INTEGER ? 1 : step;
    value = step * round(value / step);
    return fmax(info->minimum, fmin(info->maximum, value));
}
