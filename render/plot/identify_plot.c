#include "render/plot/study_plot.h"

#include <assert.h>

#include "render/page/palette.h"
#include "render/page/text.h"

owned_figure *identify_figure_create(const identification *id)
{
    assert(id->trace_count > 0 && id->trace_count <= FIGURE_PANELS);
    char changes[SCENARIO_CHANGES];
    owned_figure *o =
        owned_figure_create(id->trace_count, "%s: what the fit leaves of the readings%s",
                            id->base->name, scenario_changes(id->base, changes));
    const double *residual = id->residual;
    for (int k = 0; k < id->trace_count; k++) {
        const recorded_trace *t = &id->traces[k];
        figure_panel *panel = &o->panels[k];

        // a dot for each reading that counts
        for (int c = 0; c < CHANNELS; c++) {
            const signal_info *signal = &signal_table[identify_signals[c]];
            if (t->reading[c] == NULL) {
                continue;
            }
            double *x = owned_figure_numbers(o, t->rows), *y = owned_figure_numbers(o, t->rows);
            size_t count = 0;
            for (size_t i = 0; i < t->rows; i++) {
                if (t->deviation[c][i] > 0) {
                    x[count] = t->time[i];
                    y[count++] = *residual++;
                }
            }
            o->series[k][panel->series_count++] = (figure_series){.name = signal->name,
                                                                  .label = signal->symbol,
                                                                  .x = x,
                                                                  .y = y,
                                                                  .count = count,
                                                                  .colour = palette_slot(c),
                                                                  .marker = MARKER_CIRCLE,
                                                                  .radius = 0.5,
                                                                  .no_line = true};
        }
        residual += t->contact_count;
        panel->heading = owned_figure_keep(o, g_markup_escape_text(t->file, -1));
        panel->y =
            (figure_axis){"residual", "Residual over its deviation", .symbol = "r/σ", .room = 0.05};
    }

    o->figure.x = (figure_axis){.name = "time", .label = "Time", .symbol = "t", .unit = "s"};
    return o;
}
