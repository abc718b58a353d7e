#include "render/figures/artwork.h"

#include <assert.h>
#include <errno.h>
#include <glib.h>
#include <string.h>
#include <sys/stat.h>

#include "render/plot/figure_file.h"
#include "src/base/version.h"

status make_folder(const char *folder, fault *f)
{
    if (mkdir(folder, 0777) != 0 && errno != EEXIST) {
        return fault_set(f, STATUS_CANNOT_WRITE, "the folder '%s' cannot be made: %s", folder,
                         strerror(errno));
    }
    return STATUS_OK;
}

status artwork_check_formats(char *const *formats, fault *f)
{
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
    static char software[32];
    g_snprintf(software, sizeof software, "impactlab %s", lab_version());
    return (picture){.width = a->width,
                     .height = a->height,
                     .dpi = options->dpi,
                     .title = a->title,
                     .software = software,
                     .parameters = a->parameters,
                     .paint = paint_artwork,
                     .what = a};
}

void artwork_finish(artwork *a)
{
    if (a->release != NULL) {
        a->release(a->what);
    }
    memset(a, 0, sizeof *a);
}

status artwork_write(const artwork *a, const figure_options *options, const char *folder,
                     const char *file, char *const *formats, fault *f)
{
    assert(a != NULL && options != NULL && folder != NULL && file != NULL && formats != NULL);
    picture p = artwork_picture(a, options);
    status code = make_folder(folder, f);
    for (int i = 0; formats[i] != NULL && code == STATUS_OK; i++) {
        char *path = g_strdup_printf("%s/%s.%s", folder, file, formats[i]);
        code = picture_write(&p, path, f);
        g_free(path);
    }
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

artwork artwork_of_figure(const figure *fig, void *owner, void (*release)(void *owner))
{
    plotted *p = g_new0(plotted, 1);
    *p = (plotted){fig, owner, release};
    artwork a = {.title = fig->title,
                 .parameters = fig->parameters,
                 .what = p,
                 .paint = paint_plotted,
                 .write_csv = write_plotted,
                 .release = release_plotted};
    figure_size(fig, &a.width, &a.height);
    return a;
}
