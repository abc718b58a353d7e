#include <assert.h>
#include <string.h>

#include "render/page/picture_file.h"
#include "render/page/png_file.h"
#include "render/plot/trace_plot.h"
#include "render/scene/scene_parts.h"
#include "src/base/instant.h"
#include "src/base/version.h"
#include "src/base/whole_file.h"

enum { PICTURE_DPI = 144 };

status scene_check_path(const char *path, fault *f)
{
    assert(path != NULL);
    if (picture_format_of(path) != FORMAT_PNG || strchr(path, '.') == NULL) {
        return fault_set(f, STATUS_BAD_ARGUMENT,
                         "'%s' is no name for a scene: expected one that ends in .png", path);
    }
    return whole_file_check(path, f);
}

static status check_instants(const scene_picture *p, fault *f)
{
    const trace *t = &p->result->trace;

    if (p->count < 1 || p->count > SCENE_INSTANTS) {
        return fault_set(f, STATUS_BAD_ARGUMENT, "a scene of %d instants, expected 1 to %d",
                         p->count, SCENE_INSTANTS);
    }

    for (int i = 0; i < p->count; i++) {
        double end = t->row_count > 0 ? t->rows[t->row_count - 1].time : 0;
        if (!(p->times[i] >= 0 && !instant_after(p->times[i], end))) {
            return fault_set(f, STATUS_BAD_ARGUMENT,
                             "a scene at %g s, expected an instant of the run, 0 to %g s",
                             p->times[i], end);
        }
    }
    return STATUS_OK;
}

static status write_surface(const scene *sc, cairo_surface_t *surface, const char *path, fault *f)
{
    whole_file file;
    char software[64], *values = parameters_line(sc->scenario);
    char *title = scenario_title(sc->scenario);
    snprintf(software, sizeof software, "impactlab %s", lab_version());
    const png_note notes[] = {{"Title", title},
                              {"Software", software},
                              {"Parameters", values},
                              {"Renderer", scene_renderer_name(sc)}};

    status code = whole_file_open(&file, path, f);
    if (code == STATUS_OK) {
        code = png_file_write(file.stream, surface, PICTURE_DPI, notes, 4, f);
        code = whole_file_close(&file, code, f);
    }
    g_free(title);
    g_free(values);
    return code;
}

status scene_write(const scene_picture *p, const char *path, fault *f)
{
    assert(p != NULL && p->scenario != NULL && p->result != NULL && p->times != NULL);
    assert(path != NULL);
    scene *sc;

    status code = scene_check_path(path, f);
    if (code == STATUS_OK) {
        code = check_instants(p, f);
    }
    if (code == STATUS_OK) {
        code = scene_create(&sc, p->scenario, p->result, &p->options, f);
    }
    if (code != STATUS_OK) {
        return code;
    }

    cairo_surface_t *surface = cairo_image_surface_create(
        p->options.transparent ? CAIRO_FORMAT_ARGB32 : CAIRO_FORMAT_RGB24, sc->options.width,
        sc->options.height);
    code = scene_paint(sc, p->times, p->count, surface, f);
    if (code == STATUS_OK) {
        code = write_surface(sc, surface, path, f);
    }
    cairo_surface_destroy(surface);
    scene_destroy(sc);
    return code;
}
