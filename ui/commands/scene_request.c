#include "ui/commands/scene_request.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

enum { DEFAULT_INSTANTS = 5 };

static int ascending(const void *a, const void *b)
{
    const double *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

scene_options read_view(const arguments *a)
{
    scene_options o = {.width = a->size.width,
                       .height = a->size.height,
                       .exaggerate = a->exaggerate,
                       .inset = a->inset,
                       .transparent = a->transparent};
    o.theme = a->theme != NULL && strcmp(a->theme, "dark") == 0 ? THEME_DARK : THEME_COLOUR;

    // the words were checked before
    bool known = (a->gl == NULL || scene_renderer_find(a->gl, &o.renderer)) &&
                 (a->camera == NULL || camera_read(a->camera, &o.camera));
    assert(known);
    (void)known;
    return o;
}

int check_view(const arguments *a)
{
    camera_view unused;
    if (a->camera != NULL && !camera_read(a->camera, &unused)) {
        return complain("there is no camera '%s', expected three-quarter, top, side, tip, or two "
                        "angles such as -60,40 (elevation 1 to 90 degrees)",
                        a->camera);
    }
    return EXIT_DONE;
}

int check_scene(const arguments *a)
{
    assert(a != NULL);
    fault f = {0};
    if (check_view(a) != EXIT_DONE) {
        return EXIT_BAD_ARGUMENTS;
    }

    // there is a picture for each instant, and a limit to them
    if (a->instants.count > SCENE_INSTANTS) {
        return complain("--at was given %d times, expected at most %d", a->instants.count,
                        SCENE_INSTANTS);
    }

    // before the run, which may take long
    if (a->scene != NULL && scene_check_path(a->scene, &f) != STATUS_OK) {
        return complain_fault(&f);
    }
    return EXIT_DONE;
}

int write_scene(const arguments *a, const scenario *s, const run_result *result)
{
    double times[SCENE_INSTANTS];
    int count = a->instants.count;
    fault f = {0};
    assert(count <= SCENE_INSTANTS);

    // the instants asked for in their order, or some that show the approach
    if (count > 0) {
        memcpy(times, a->instants.items, (size_t)count * sizeof *times);
        qsort(times, (size_t)count, sizeof *times, ascending);
    } else if (result->trace.row_count > 0) {
        count = DEFAULT_INSTANTS;
        scene_instants(result, times, count);
    }
    const scene_picture picture = {
        .scenario = s, .result = result, .options = read_view(a), .times = times, .count = count};
    if (scene_write(&picture, a->scene, &f) != STATUS_OK) {
        return complain_fault(&f);
    }
    return EXIT_DONE;
}
