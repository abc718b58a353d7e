#include "render/figures/artwork.h"

#include <assert.h>
#include <errno.h>
#include <glib.h>
#include <string.h>
#include <sys/stat.h>

#include "render/page/text.h"
#include "render/plot/plot.h"
#include "src/base/version.h"

status make_folder(const char *folder, fault *f)
{
    assert(folder != NULL);
    if (mkdir(folder, 0777) != 0 && errno != EEXIST) {
        return fault_set(f, STATUS_CANNOT_WRITE, "the folder '%s' cannot be made: %s", folder,
                         strerror(errno));
    }
    return STATUS_OK;
}

status artwork_check_formats(char *const *formats, fault *f)
{
    assert(formats != NULL);
    for (int i = 0; formats[i] != NULL; i++) {
        if (picture_format_of(formats[i]) == FORMAT_NONE) {
            return fault_set(f, STATUS_BAD_ARGUMENT,
                             "there is no figure format '%s', expected png, pdf or svg",
                             formats[i]);
        }
    }
    return STATUS_OK;
}

static status paint_artwork(cairo_t *cr, const void *what, fault *f)
{
    const artwork *a = what;
    return a->paint(cr, a->what, NULL, f);
}

picture artwork_picture(const artwork *a, const figure_options *options)
{
    assert(a != NULL && options != NULL);

    // the same string for every picture, made by whichever thread comes first
    static gsize software;
    if (g_once_init_enter(&software)) {
        char *named = g_strdup_printf("impactlab %s", lab_version());
        g_once_init_leave(&software, (gsize)g_intern_string(named));
        g_free(named);
    }

    // without an alternative text the title stands in for it
    return (picture){.width = a->width,
                     .height = a->height,
                     .dpi = options->look.dpi,
                     .transparent = options->look.transparent,
                     .command = options->command,
                     .alternative = a->alternative != NULL ? a->alternative : a->title,
                     .title = a->title,
                     .software = (const char *)software,
                     .parameters = a->parameters,
                     .paint = paint_artwork,
                     .what = a};
}

void artwork_finish(artwork *a)
{
    if (a->release != NULL) {
        a->release(a->what);
    }
    g_free(a->alternative);
    memset(a, 0, sizeof *a);
}

status artwork_write(const artwork *a, const figure_options *options, const char *folder,
                     const char *file, char *const *formats, fault *f)
{
    assert(a != NULL && options != NULL && folder != NULL && file != NULL && formats != NULL);
    picture p = artwork_picture(a, options);
    status code = make_folder(folder, f);

    // every form of the picture
    for (int i = 0; formats[i] != NULL && code == STATUS_OK; i++) {
        char *path = g_strdup_printf("%s/%s.%s", folder, file, formats[i]);
        code = picture_write(&p, path, f);
        g_free(path);
    }

    // and its numbers
    if (code == STATUS_OK) {
        char *path = g_strdup_printf("%s/%s.csv", folder, file);
        code = a->write_csv(a->what, path, f);
        g_free(path);
    }
    return code;
}

// ---- plotted figures

typedef struct plotted {
    const figure *figure;
    void *owner;
    void (*release)(void *owner);
} plotted;

static status paint_plotted(cairo_t *cr, const void *what, figure_report *report, fault *f)
{
    const plotted *p = what;
    return figure_paint(cr, p->figure, report, f);
}

static status write_plotted(const void *what, const char *path, fault *f)
{
    const plotted *p = what;
    return figure_write_csv(p->figure, path, f);
}

static void release_plotted(void *what)
{
    plotted *p = what;
    p->release(p->owner);
    g_free(p);
}

// Appends a plain text that was given as markup.
static void append_plain(GString *out, const char *before, const char *markup)
{
    if (markup != NULL && markup[0] != '\0') {
        char *plain = text_plain(markup);
        g_string_append_printf(out, "%s%s", before, plain);
        g_free(plain);
    }
}

static void append_axis(GString *out, const char *before, const figure_axis *a)
{
    append_plain(out, before, a->label != NULL ? a->label : a->name);
    if (a->unit != NULL && a->unit[0] != '\0') {
        char unit[64];
        text_unit(a->unit, unit, sizeof unit);
        g_string_append_printf(out, " in %s", unit);
    }
}

// What a figure shows, in words: its panels, their axes and what is drawn.
static char *describe_figure(const figure *fig)
{
    GString *out = g_string_new(fig->title != NULL ? fig->title : "Figure");
    g_string_append_printf(out, ". %d panel%s", fig->panel_count, fig->panel_count == 1 ? "" : "s");
    append_axis(out, " over ", &fig->x);

    // panel by panel: its axis, heading, colours and curves
    for (int i = 0; i < fig->panel_count; i++) {
        const figure_panel *p = &fig->panels[i];
        append_axis(out, i == 0 ? ": " : "; ", &p->y);
        append_plain(out, ", ", p->heading);
        if (p->map != NULL && p->colours != NULL) {
            append_axis(out, ", coloured by ", &p->colours->axis);
        }

        const char *before = ", curves: ";
        for (int k = 0; k < p->series_count; k++) {
            append_plain(out, before, p->series[k].label);
            before = p->series[k].label != NULL ? ", " : before;
        }
    }

    g_string_append(out, ".");
    return g_string_free(out, FALSE);
}

artwork artwork_of_figure(const figure *fig, void *owner, void (*release)(void *owner))
{
    assert(fig != NULL && release != NULL);

    // what paints and releases it later; the figure stays its owner's
    plotted *p = g_new0(plotted, 1);
    *p = (plotted){fig, owner, release};

    // everything but its size and alternative text
    artwork a = {.title = fig->title,
                 .caption = fig->caption,
                 .parameters = fig->parameters,
                 .plotted = fig,
                 .what = p,
                 .paint = paint_plotted,
                 .write_csv = write_plotted,
                 .release = release_plotted};
    a.alternative = describe_figure(fig);
    figure_size(fig, &a.width, &a.height);
    return a;
}
