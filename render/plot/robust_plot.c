#include "render/plot/robust_plot.h"

#include <assert.h>
#include <glib.h>

#include "render/page/text.h"
#include "src/base/version.h"

struct robust_figure {
    figure figure;
    figure_panel panel;
    figure_series series[ROBUST_MOST_CURVES];
    GPtrArray *owned; // blocks
};

static void *own(robust_figure *r, void *block)
{
    g_ptr_array_add(r->owned, block);
    return block;
}

// The curve of a law: run i of n, in the order of their overshoots, is at (i + 1)/n.
static figure_series describe_law(robust_figure *r, const robust_law *law, int colour)
{
    double *share = own(r, g_new(double, law->runs));
    for (size_t i = 0; i < law->runs; i++) {
        share[i] = 100 * (double)(i + 1) / (double)law->runs;
    }
    return (figure_series){.name = law->law,
                           .label = own(r, text_escape(law->law)),
                           .x = law->overshoots,
                           .y = share,
                           .count = law->runs,
                           .colour = colour};
}

robust_figure *robust_figure_create(const robust_table *t)
{
    assert(t != NULL && t->count >= 1 && t->count <= ROBUST_MOST_CURVES);
    static const int colours[ROBUST_MOST_CURVES] = {0, 5, 2, 4, 1, 3, 6, 7};
    robust_figure *r = g_new0(robust_figure, 1);
    r->owned = g_ptr_array_new_with_free_func(g_free);
    for (int i = 0; i < t->count; i++) {
        r->series[i] = describe_law(r, &t->laws[i], colours[i]);
    }

    r->panel = (figure_panel){.y = {.name = "share",
                                    .label = "runs with at most this overshoot",
                                    .unit = "%",
                                    .low = 0,
                                    .high = 100},
                              .series = r->series,
                              .series_count = t->count,
                              .weight = 2.4};
    r->figure = (figure){
        .title = own(
            r, g_strdup_printf("%s: what the laws make of what they were not told", t->scenario)),
        .caption = own(
            r, g_strdup_printf("%zu runs a law. impactlab %s.", t->laws[0].runs, lab_version())),
        .x = {.name = "overshoot",
              .label = "overshoot over the commanded force",
              .unit = "%",
              .room = 0.02},
        .panels = &r->panel,
        .panel_count = 1,
        .software = own(r, g_strconcat("impactlab ", lab_version(), NULL)),
    };
    return r;
}

const figure *robust_figure_of(const robust_figure *r)
{
    return &r->figure;
}

void robust_figure_destroy(robust_figure *r)
{
    if (r != NULL) {
        g_ptr_array_free(r->owned, TRUE);
        g_free(r);
    }
}
