// A program without the rendering libraries.
#include "ui/rendering.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "src/base/shipped.h"

static char **words;

void rendering_begin(char **argv, void (*end)(const char *reason))
{
    (void)end;
    words = argv;
}

bool rendering_in_libraries(void)
{
    return false;
}

void rendering_needed(void)
{
    char *program = shipped_path(SHIPPED_DRAWING_PROGRAM);
    fflush(stdout);
    if (program != NULL) {
        execv(program, words);
    }
    fprintf(stderr, "impactlab: the program that draws cannot be started as %s: %s\n",
            program != NULL ? program : "impactlab-draw", strerror(errno));
    exit(EXIT_FAILURE);
}

// What the commands call of the lab and of rendering, room by room. None of it is reached
// where rendering_needed was called in time, and a call that comes first begins anew, too. A
// function that is missing here links its libraries (tests/test_start.sh).
#define ABSENT(name)                                                                               \
    _Noreturn void name(void);                                                                     \
    _Noreturn void name(void)                                                                      \
    {                                                                                              \
        rendering_needed();                                                                        \
        abort();                                                                                   \
    }

// the lab (ui/commands/explore.h, ui/terminal/terminal.h)
ABSENT(explore)
ABSENT(terminal_usable)

// render/page
ABSENT(picture_check_path)
ABSENT(text_check_family)

// render/plot
ABSENT(owned_figure_destroy)
ABSENT(robust_figure_create)
ABSENT(sweep_figure_create)
ABSENT(sweep_plot_check)

// render/scene
ABSENT(film_file_check)
ABSENT(film_write)
ABSENT(scene_check_path)
ABSENT(scene_renderer_find)
ABSENT(scene_write)

// render/figures
ABSENT(artwork_finish)
ABSENT(artwork_of_figure)
ABSENT(artwork_publish)
ABSENT(figure_draw)
ABSENT(figure_publish)
ABSENT(recipe_open)
ABSENT(report_length)
ABSENT(report_write)
ABSENT(run_figure_finish)
ABSENT(run_figure_init)
ABSENT(thesis_figure_at)
ABSENT(thesis_figure_count)
ABSENT(thesis_figure_find)
