// Pictures of studies: of a sweep, and of the result of impactlab robust.
#pragma once

#include "render/plot/figure_description.h"
#include "src/study/identify/identify.h"
#include "src/study/linear/linear.h"
#include "src/study/robust/robust.h"
#include "src/study/sweep.h"
#include "src/study/robust/tune.h"

// --- robust: the distribution of the overshoot, a curve for each law

// The largest number of laws in a picture.
enum { ROBUST_MOST_CURVES = 8 };

// Describes the picture: the share of runs (upwards) whose overshoot is at most x. Its
// title ends with what was changed of the scenario. The table is borrowed; at most
// ROBUST_MOST_CURVES laws. To be freed with owned_figure_destroy.
owned_figure *robust_figure_create(const robust_table *t, const char *changes);

// --- tune: what each evaluation came to, and the least so far, over the evaluations. The
// title ends with what was changed of the scenario. To be freed with
// owned_figure_destroy.
owned_figure *tune_figure_create(const tuning *t, const char *changes);

// --- Pictures of a sweep: one quantity over one or two varied parameters.
//
// One parameter: a line with markers (dots alone if the values were drawn at random or
// are words). Two: a map with contour lines and a colour bar (coloured dots if the values
// were drawn at random). A logarithmic range has a logarithmic axis.

typedef struct sweep_picture {
    const sweep *sweep;
    const char *key; // of the summary, "peak_force_N"
    const summary_info
        *info;            // of a quantity that the summary does not have; NULL: the key's
    const double *values; // of each run, NaN where there is none
} sweep_picture;

// Checks in advance whether a picture of the sweep can be written to path:
// STATUS_BAD_ARGUMENT if more than two parameters are varied or for an unknown extension,
// STATUS_CANNOT_WRITE if the path cannot be written, STATUS_CANNOT_READ if the font is
// missing.
status sweep_plot_check(const sweep *s, const char *path, fault *f);

// Describes the picture, to be freed with owned_figure_destroy. The sweep and the values
// are borrowed.
owned_figure *sweep_figure_create(const sweep_picture *p);

// --- of numbers over varied parameters, in any picture

// The radius of markers of so many points [pt].
double marker_radius(size_t points);

// The marker of the points of curve number `index` of a panel; none where a line has so
// many points that they could not be told apart.
marker_kind marker_of(size_t points, size_t index);

// An axis with a name, its label the beginning of a description (NULL: the name); name
// and unit are borrowed.
figure_axis described_axis(owned_figure *o, const char *name, const char *description,
                           const char *unit);

// Gives an axis its symbol, behind its label too; one without (NULL) goes by its name
// where the label has no room.
void axis_name_shortly(owned_figure *o, figure_axis *a, const char *symbol);

// The map of z over the grid that points make, with contours and hatched where there is
// no point, kept by the figure. NULL if most of the grid would be: the points make none.
figure_map *figure_grid(owned_figure *o, const double *x, const double *y,
                        const double *z, size_t count);

// --- identify: residuals of the fit

// Describes the picture: a panel for each trace, the residuals of every channel over time
// in standard deviations. At most FIGURE_PANELS traces. To be freed with
// owned_figure_destroy.
owned_figure *identify_figure_create(const identification *id);

// --- linear: answers over frequency, and a loop gain in the complex plane: loop_plot.c

typedef struct linear_curve {
    const char *name;
    linear_response response;
} linear_curve;

// Describe gain and phase of at most FIGURE_PANELS curves, and the loop gain with equal
// axes, frequencies along it and the points of size 1 and -1; the title ends with what
// was changed. Finite margins are drawn, those of a Bode plot with their crossovers, half
// the rate, and the levels of 0 dB and half a revolution; margins of a Bode plot are
// those of its only curve, a loop gain, and NULL for answers of an arm. To be freed with
// owned_figure_destroy.
owned_figure *bode_figure_create(const scenario *s, const linear_curve *curves, int count,
                                 const linear_margins *margins);
owned_figure *nyquist_figure_create(const scenario *s, const linear_response *loop,
                                    const linear_margins *margins);
