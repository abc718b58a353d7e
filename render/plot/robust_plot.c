#include "render/plot/robust_plot.h"

#include <assert.h>
#include <glib.h>

#include "render/page/text.h"
#include "src/base/version.h"

// The curve of a law: run i of n, in the order of their overshoots, is at (i + 1)/n.
static figure_series describe_law(owned_figure *o, const robust_law *law, int colour)
{
    double *share = owned_figure_keep(o, g_new(double, law->runs));
    for (size_t i = 0; i < law->runs; i++) {
        share[i] = 100 * (double)(i + 1) / (double)law->runs;
    }
    return (figure_series){.name = law->law,
                           .label = owned_figure_keep(o, text_escape(law->law)),
                           .x = law->overshoots,
                           .y = share,
                           .count = law->runs,
                           .colour = colour};
}

owned_figure *robust_figure_create(const robust_table *t, const char *changes)
{
    assert(t != NULL && t->count >= 1 && t->count <= ROBUST_MOST_CURVES);
    static const int colours[ROBUST_MOST_CURVES] = {0, 5, 2, 4, 1, 3, 6, 7};
    owned_figure *o = owned_figure_create();

    // a curve for each law: the same runs, and so the same kind of overshoot
    for (int i = 0; i < t->count; i++) {
        o->series[i] = describe_law(o, &t->laws[i], colours[i]);
    }
    o->panel.series_count = t->count;
    o->panel.weight = 2.4;
    o->panel.y = (figure_axis){.name = "share",
                               .label = "Runs with at most this overshoot",
                               .unit = "%",
                               .low = 0,
                               .high = 100};

    // the page
    o->figure.title =
        owned_figure_keep(o, g_strdup_printf("%s: what the laws make of what they were not told%s",
                                             t->scenario, changes));
    o->figure.caption = owned_figure_keep(
        o, g_strdup_printf("%zu runs a law. Overshoot of the force: %s%s. impactlab %s.",
                           t->laws[0].runs, robust_overshoot_of(&t->laws[0]),
                           t->laws[0].by_smoothed > 0 ? " (mean over 5 ms)" : "", lab_version()));
    o->figure.x = (figure_axis){.name = "overshoot",
                                .label = "Overshoot over the commanded force",
                                .unit = "%",
                                .room = 0.02};
    return o;
}
