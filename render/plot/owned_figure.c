#include "render/plot/owned_figure.h"

#include <assert.h>

#include "src/base/version.h"

owned_figure *owned_figure_create(void)
{
    owned_figure *o = g_new0(owned_figure, 1);
    o->kept = g_ptr_array_new_with_free_func(g_free);
    o->panel.series = o->series;
    o->figure.panels = &o->panel;
    o->figure.panel_count = 1;
    o->figure.software = owned_figure_keep(o, g_strconcat("impactlab ", lab_version(), NULL));
    return o;
}

void owned_figure_destroy(owned_figure *o)
{
    if (o != NULL) {
        g_ptr_array_free(o->kept, TRUE);
        g_free(o);
    }
}

void *owned_figure_keep(owned_figure *o, void *block)
{
    assert(o != NULL && block != NULL);
    g_ptr_array_add(o->kept, block);
    return block;
}
