#include "ui/commands/scene_request.h"
#include "src/base/numbers.h"

#include <stdlib.h>

enum { DEFAULT_INSTANTS = 5 };

int read_number_between(const char *option, const char *text, double low, double high,
                        double *value)
{
    double number;
    const char *rest;
    if (text == NULL) {
        return EXIT_DONE;
    }
    if (!decimal_read(text, &number, &rest) || *rest != '\0' || !(number >= low) ||
        !(number <= high)) {
        return complain("--%s %s: expected a number from %g to %g", option, text, low, high);
    }
    *value = number;
    return EXIT_DONE;
}

static int read_size(const char *text, scene_options *o)
{
    char *rest = NULL;
    if (text == NULL) {
        return EXIT_DONE;
    }
    long width = strtol(text, &rest, 10), height = 0;
    if (*rest == 'x') {
        height = strtol(rest + 1, &rest, 10);
    }
    if (*rest != '\0' || width < 1 || width > 100000 || height < 1 || height > 100000) {
        return complain("--size %s: expected width x height in pixels, like 1280x720", text);
    }
    o->width = (int)width;
    o->height = (int)height;
    return EXIT_DONE;
}

static int ascending(const void *a, const void *b)
{
    const double *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

static int read_instants(const arguments *a, scene_request *r)
{
    if (a->at_count > SCENE_INSTANTS) {
        return complain("--at was given %d times, expected at most %d", a->at_count,
                        SCENE_INSTANTS);
    }
    for (int i = 0; i < a->at_count; i++) {
        int code = read_number_between("at", a->ats[i], 0, 1e5, &r->times[i]);
        if (code != EXIT_DONE) {
            return code;
        }
    }
    r->count = a->at_count;
    qsort(r->times, (size_t)r->count, sizeof *r->times, ascending);
    return EXIT_DONE;
}

int read_scene_request(const arguments *a, scene_request *r)
{
    *r = (scene_request){.count = 0};
    if (a->gl != NULL && !scene_renderer_find(a->gl, &r->options.renderer)) {
        return complain("--gl %s: expected osmesa, egl, cairo or auto", a->gl);
    }
    if (a->camera != NULL && !camera_kind_find(a->camera, &r->options.camera)) {
        return complain("--camera %s: expected three-quarter, top or side", a->camera);
    }
    int code = read_size(a->size, &r->options);
    return code == EXIT_DONE ? read_instants(a, r) : code;
}

int check_scene(const arguments *a)
{
    scene_request r;
    fault f = {0};
    int code = read_scene_request(a, &r);
    if (code == EXIT_DONE && a->scene != NULL && scene_check_path(a->scene, &f) != STATUS_OK) {
        code = complain_fault(&f);
    }
    return code;
}

int write_scene(const arguments *a, const scenario *s, const run_result *result)
{
    scene_request r;
    fault f = {0};
    int code = read_scene_request(a, &r);
    if (code != EXIT_DONE) {
        return code;
    }
    if (r.count == 0 && result->trace.row_count > 0) {
        r.count = DEFAULT_INSTANTS;
        scene_instants(result, r.times, r.count);
    }
    if (scene_write(s, result, &r.options, r.times, r.count, a->scene, &f) != STATUS_OK) {
        return complain_fault(&f);
    }
    return EXIT_DONE;
}
