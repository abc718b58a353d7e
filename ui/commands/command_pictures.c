#include "ui/commands/command_pictures.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "src/base/numbers.h"
#include "src/base/result_places.h"

#define SERIF "DejaVu Serif"

// Reads --theme, or its other spellings --mono and --dark. Returns the exit status.
static int read_theme(const arguments *a, figure_theme *theme)
{
    int spellings = 0;
    *theme = THEME_COLOUR;
    if (a->theme != NULL) {
        spellings++;
        if (strcmp(a->theme, "mono") == 0) {
            *theme = THEME_MONO;
        } else if (strcmp(a->theme, "dark") == 0) {
            *theme = THEME_DARK;
        }
    }

    // the same by other options
    if (a->mono) {
        spellings++;
        *theme = THEME_MONO;
    }
    if (a->dark) {
        spellings++;
        *theme = THEME_DARK;
    }

    if (spellings > 1) {
        return complain("--theme, --mono and --dark cannot go together");
    }
    return EXIT_DONE;
}

// The family of --font, NULL for the usual one, without serifs.
static const char *read_font(const arguments *a)
{
    if (a->font == NULL || strcasecmp(a->font, "sans") == 0) {
        return NULL;
    }
    if (strcasecmp(a->font, "serif") == 0) {
        return SERIF;
    }
    return a->font;
}

// Reads --from and --to. Returns the exit status.
static int read_axis_range(const arguments *a, figure_options *o)
{
    if (isnan(a->from) && isnan(a->to)) {
        return EXIT_DONE;
    }
    if (!(a->from < a->to)) { // one of them may be NaN
        return complain("--from and --to go together, the first below the second");
    }
    o->from = a->from;
    o->to = a->to;
    return EXIT_DONE;
}

// Reads --zoom. Returns the exit status.
static int read_zoom(const arguments *a, figure_options *o)
{
    const char *rest;
    if (a->zoom == NULL) {
        return EXIT_DONE;
    }
    const bool whole = decimal_read(a->zoom, &o->zoom.from, &rest) && *rest == ':' &&
                       decimal_read(rest + 1, &o->zoom.to, &rest) && *rest == '\0';
    if (!whole || !(o->zoom.from < o->zoom.to)) {
        return complain("--zoom %s: expected A:B, where the stretch begins and ends",
                        a->zoom);
    }
    return EXIT_DONE;
}

int read_picture_options(const arguments *a, figure_options *o)
{
    *o = (figure_options){.look = {.width = a->width,
                                   .height = a->height,
                                   .dpi = a->dpi,
                                   .font = read_font(a),
                                   .letters = a->font_size,
                                   .bare = a->bare,
                                   .transparent = a->transparent},
                          .overlay = a->overlay,
                          .signals = a->signals,
                          .latex = a->latex,
                          .command = a->command_line};

    // what may be wrong
    int ended = read_theme(a, &o->look.theme);
    if (ended != EXIT_DONE) {
        return ended;
    }
    ended = read_zoom(a, o);
    if (ended != EXIT_DONE) {
        return ended;
    }
    ended = read_axis_range(a, o);
    if (ended != EXIT_DONE) {
        return ended;
    }

    fault f = {0};
    if (o->look.font != NULL &&
        (drawing_open(&f) != STATUS_OK ||
         drawing()->text_check_family(o->look.font, &f) != STATUS_OK)) {
        return complain_fault(&f);
    }
    return EXIT_DONE;
}

// --- figures ---------------------------------------------------------------------------

// Draws a figure to --plot according to the options. Returns the exit status.
static int publish_figure(const arguments *a, const figure *fig)
{
    figure_options o;
    int ended = read_picture_options(a, &o);
    if (ended != EXIT_DONE) {
        return ended;
    }

    // its numbers stand beside it, unless another result is written there
    g_autofree char *csv = picture_beside(a->plot, ".csv");
    const bool with_csv = result_places_find(csv) == NULL;
    fault f = {0};
    if (drawing()->figure_publish(fig, &o, a->plot, with_csv, &f) != STATUS_OK) {
        return complain_fault(&f);
    }
    return EXIT_DONE;
}

int publish_titled(const arguments *a, const scenario *s, const char *shows,
                   const figure *fig)
{
    char title[256 + SCENARIO_TITLED], changes[SCENARIO_CHANGES];
    snprintf(title, sizeof title, "%s: %s%s", s->title, shows,
             scenario_changes(s, changes));
    figure titled = *fig;
    titled.title = title;
    return publish_figure(a, &titled);
}

int publish_study(const arguments *a, const scenario *s, const char *shows,
                  const figure *fig)
{
    figure drawn = *fig;
    drawn.x.scale = SCALE_LOGARITHMIC;
    drawn.x.room = 0.04;
    drawn.columns = fig->panel_count;
    drawn.common_legend = true;
    return publish_titled(a, s, shows, &drawn);
}

int publish_owned(const arguments *a, owned_figure *o)
{
    const int result = publish_figure(a, &o->figure);
    drawing()->owned_figure_destroy(o);
    return result;
}

int publish_runs(const arguments *a, const char *title, const trace_run *runs,
                 int run_count)
{
    assert(run_count > 0);
    figure_options o;
    const int ended = read_picture_options(a, &o);
    if (ended != EXIT_DONE) {
        return ended;
    }

    // the figure, drawn once it is made
    fault f = {0};
    owned_figure *created =
        drawing()->run_figure_create(title, NULL, 0, runs, run_count, &o, &f);
    if (created == NULL) {
        return complain_fault(&f);
    }

    SCOPED(artwork_finish) artwork drawn = drawing()->artwork_of_owned(created);
    if (drawing()->artwork_publish(&drawn, &o, a->plot, false, &f) != STATUS_OK) {
        return complain_fault(&f);
    }
    return EXIT_DONE;
}

// --- the arm in space ------------------------------------------------------------------

enum { DEFAULT_INSTANTS = 5, SCENE_DPI = 200 };

#define SCENE_POINTS 7.0  // letters of a scene on a page [pt]
#define SCENE_SHAPE  0.62 // its height, as a share of its width
#define NARROW_SHAPE 0.80 // of one in a column, with its texts below
#define NARROW       120  // widest column [mm]

// Reads --exaggerate: "auto", as without it, is 0. False if it is neither that nor a
// factor.
static bool read_exaggeration(const char *text, double *factor)
{
    const char *rest;
    *factor = 0;
    return text == NULL || strcmp(text, "auto") == 0 ||
           (decimal_read(text, factor, &rest) && *rest == '\0' && *factor >= 1 &&
            *factor <= 1000);
}

// The size of a scene on a page: pixels and letters from --width, --height, --dpi and
// --font-size.
static void read_page_size(const arguments *a, scene_options *o)
{
    double points = SCENE_POINTS, height = a->height;
    o->dpi = SCENE_DPI;
    if (a->dpi > 0) {
        o->dpi = a->dpi;
    }
    if (a->font_size > 0) {
        points = a->font_size;
    }
    if (!(height > 0)) {
        height = (a->width > NARROW ? SCENE_SHAPE : NARROW_SHAPE) * a->width;
    }
    o->width = (int)round(a->width / 25.4 * o->dpi);
    o->height = (int)round(height / 25.4 * o->dpi);
    o->letters = points / 72 * o->dpi / SCENE_LETTERS;
}

scene_options read_view(const arguments *a)
{
    scene_options o = {.width = a->size.width,
                       .height = a->size.height,
                       .inset = a->inset,
                       .plain = a->bare,
                       .transparent = a->transparent};
    if (a->width > 0) {
        read_page_size(a, &o);
    }

    // all words were checked before
    bool known = read_theme(a, &o.theme) == EXIT_DONE &&
                 read_exaggeration(a->exaggerate, &o.exaggerate);
    if (a->gl != NULL) {
        known = drawing()->scene_renderer_find(a->gl, &o.renderer);
    }
    if (a->camera != NULL) {
        known = camera_read(a->camera, &o.camera) && known;
    }
    assert(known);
    (void)known;
    return o;
}

int check_view(const arguments *a)
{
    camera_view unused;
    if (a->camera != NULL && !camera_read(a->camera, &unused)) {
        return complain(
            "there is no camera '%s', expected three-quarter, top, side, tip, or "
            "two angles such as -60,40 (elevation 1 to 90 degrees)",
            a->camera);
    }
    double factor;
    if (!read_exaggeration(a->exaggerate, &factor)) {
        return complain("--exaggerate %s: expected auto or a factor, 1 to 1000",
                        a->exaggerate);
    }
    return EXIT_DONE;
}

int check_scene(const arguments *a)
{
    const int ended = check_view(a);
    if (ended != EXIT_DONE) {
        return ended;
    }
    figure_theme theme;
    if (a->scene != NULL && read_theme(a, &theme) != EXIT_DONE) {
        return EXIT_BAD_ARGUMENTS;
    }
    if (a->scene != NULL && a->width > 0 && a->size.width > 0) {
        return complain("--width and --size cannot go together: both are the scene's");
    }
    if (a->instants.count > SCENE_INSTANTS) {
        return complain("--at was given %d times, expected at most %d", a->instants.count,
                        SCENE_INSTANTS);
    }

    fault f = {0};
    if (a->scene != NULL && (drawing_open(&f) != STATUS_OK ||
                             drawing()->scene_check_path(a->scene, &f) != STATUS_OK)) {
        return complain_fault(&f);
    }
    return EXIT_DONE;
}

int write_scene(const arguments *a, const scenario *s, const run_result *result)
{
    double times[SCENE_INSTANTS];
    int count = a->instants.count;
    assert(count <= SCENE_INSTANTS);

    // the instants asked for in their order, or some that show the approach
    if (count > 0) {
        memcpy(times, a->instants.numbers, (size_t)count * sizeof *times);
        qsort(times, (size_t)count, sizeof *times, compare_numbers);
    } else if (result->trace.row_count > 0) {
        count = DEFAULT_INSTANTS;
        scene_instants(result, times, count);
    }

    const scene_picture shown = {.scenario = s,
                                 .result = result,
                                 .options = read_view(a),
                                 .times = times,
                                 .count = count};
    fault f = {0};
    if (drawing()->scene_write(&shown, a->scene, &f) != STATUS_OK) {
        return complain_fault(&f);
    }
    return EXIT_DONE;
}
