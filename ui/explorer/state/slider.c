#include "ui/explorer/state/slider.h"

#include <assert.h>
#include <math.h>

#include "src/tables/parameters.h"

bool slider_scale_of(int parameter, double value, slider_scale *scale)
{
    assert(scale != NULL);
    return parameter_usual_range(parameter, value, &scale->low, &scale->high, &scale->logarithmic);
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
