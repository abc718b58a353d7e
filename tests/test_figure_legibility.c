// Every figure and table at the widths of one column and of a page, judged by its pixels:
// texts against what is drawn round them, curves against their frames, colours against
// each other as people with colour blindness see them, and lines without colours.
//
// The program's own functions that draw a text or a legend's line are intercepted, so
// that texts can be left out, drawn alone, and asked for their looks.
#include "tests/plot_fixture.h"

#include <sys/wait.h>
#include <unistd.h>

#include "render/plot/drawing.h"
#include "render/plot/run_style.h"
#include "render/plot/study_plot.h"
#include "src/study/sweep.h"
#include "tests/colour_vision.h"
#include "ui/commands/command.h"

static const double widths[] = {85, 180}; // [mm]

#define SCALE 3.0 // pixels of a point

// ---- what is intercepted

// A text's pixels: which part of each is covered by letters.
typedef struct letter_mask {
    char *text;
    colour ink;
    int x, y, width, height; // [pixels]
    unsigned char *cover;
} letter_mask;

// A line or marker that a legend shows.
typedef struct swatch {
    const figure_panel *panel;
    int index;
    colour ink;
    double width, dashes[8];
    int dash_count;
    marker_kind marker;
} swatch;

enum { MOST_SWATCHES = 128 };

static GArray *masks;  // letter_mask; NULL: texts are drawn as ever
static cairo_t *alone; // where texts are drawn alone
static cairo_surface_t *of_alone;
static swatch swatches[MOST_SWATCHES];
static int swatch_count;

figure_rect __real_text_put(cairo_t *cr, PangoContext *context, const text_block *t,
                            double x, double y, anchor part, colour c);
figure_rect __wrap_text_put(cairo_t *cr, PangoContext *context, const text_block *t,
                            double x, double y, anchor part, colour c);
void __real_draw_swatch(drawing *d, panel_layout *l, int index, double x, double y);
void __wrap_draw_swatch(drawing *d, panel_layout *l, int index, double x, double y);

// Leaves the text out and keeps its letters.
figure_rect __wrap_text_put(cairo_t *cr, PangoContext *context, const text_block *t,
                            double x, double y, anchor part, colour c)
{
    if (masks == NULL) {
        return __real_text_put(cr, context, t, x, y, part, c);
    }

    // alone, where it would have been
    cairo_matrix_t place;
    letter_mask mask = {.text = text_plain(t->markup), .ink = c};
    cairo_get_matrix(cr, &place);
    cairo_save(alone);
    cairo_set_matrix(alone, &place);
    const figure_rect r = __real_text_put(alone, context, t, x, y, part, c);
    const double width = r.width, height = r.height;
    x = r.x;
    y = r.y;
    double left = x, top = y, right = x + width, bottom = y + height;
    cairo_path_extents(alone, &left, &top, &right, &bottom);
    cairo_restore(alone);
    cairo_surface_flush(of_alone);

    // its pixels, cut out and wiped away
    double corners[4][2] = {{x, y},
                            {x + width, y},
                            {x, y + height},
                            {x + width, y + height}};
    double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
    for (int i = 0; i < 4; i++) {
        cairo_matrix_transform_point(&place, &corners[i][0], &corners[i][1]);
        for (int k = 0; k < 2; k++) {
            low[k] = fmin(low[k], corners[i][k]);
            high[k] = fmax(high[k], corners[i][k]);
        }
    }
    int across = cairo_image_surface_get_width(of_alone);
    int down = cairo_image_surface_get_height(of_alone);
    mask.x = (int)fmax(0, SCALE * low[0] - 2);
    mask.y = (int)fmax(0, SCALE * low[1] - 2);
    mask.width = (int)fmin(across, SCALE * high[0] + 2) - mask.x;
    mask.height = (int)fmin(down, SCALE * high[1] + 2) - mask.y;
    assert_true(mask.width > 0 && mask.height > 0);
    mask.cover = g_malloc((size_t)mask.width * (size_t)mask.height);
    unsigned char *bytes = cairo_image_surface_get_data(of_alone);
    int stride = cairo_image_surface_get_stride(of_alone);
    for (int j = 0; j < mask.height; j++) {
        unsigned char *row = bytes + (ptrdiff_t)(mask.y + j) * stride + mask.x;
        memcpy(mask.cover + (ptrdiff_t)j * mask.width, row, (size_t)mask.width);
        memset(row, 0, (size_t)mask.width);
    }
    cairo_surface_mark_dirty(of_alone);
    g_array_append_val(masks, mask);
    return r;
}

void __wrap_draw_swatch(drawing *d, panel_layout *l, int index, double x, double y)
{
    assert_true(swatch_count < MOST_SWATCHES);
    const figure_series *s = &l->panel->series[index];
    swatch *into = &swatches[swatch_count++];
    *into = (swatch){.panel = l->panel, .index = index, .marker = s->marker};
    into->width = set_series(d, l, index) * !s->no_line;
    cairo_pattern_get_rgba(cairo_get_source(d->cr), &into->ink.red, &into->ink.green,
                           &into->ink.blue, NULL);
    into->dash_count = s->no_line ? 0 : cairo_get_dash_count(d->cr);
    if (into->dash_count > 0) {
        cairo_get_dash(d->cr, into->dashes, NULL);
    }
    __real_draw_swatch(d, l, index, x, y);
}

// ---- pictures

// Paints the picture without its texts. Instead, the wrapped drawing of texts appends the
// shape of each to the global `masks`, for which it paints each alone on the canvas
// `alone`. The caller frees the masks (free_masks).
static cairo_surface_t *without_texts(const artwork *a)
{
    of_alone = cairo_image_surface_create(CAIRO_FORMAT_A8, (int)ceil(a->width * SCALE),
                                          (int)ceil(a->height * SCALE));
    cairo_surface_set_device_scale(of_alone, SCALE, SCALE);
    alone = cairo_create(of_alone);
    masks = g_array_new(FALSE, FALSE, sizeof(letter_mask));
    cairo_surface_t *surface = page_pixels(a, SCALE, NULL);
    cairo_destroy(alone);
    cairo_surface_destroy(of_alone);
    return surface;
}

static void free_masks(void)
{
    for (guint i = 0; i < masks->len; i++) {
        letter_mask *m = &g_array_index(masks, letter_mask, i);
        g_free(m->text);
        g_free(m->cover);
    }
    g_array_free(masks, TRUE);
    masks = NULL;
}

static const unsigned char *bytes_at(cairo_surface_t *surface, int x, int y)
{
    return cairo_image_surface_get_data(surface) +
           (ptrdiff_t)y * cairo_image_surface_get_stride(surface) + 4 * (ptrdiff_t)x;
}

// ---- texts

// The colour that most of a text's surroundings have: pixels are counted by the upper
// four bits of red, green and blue, 4096 bins, and the last pixel of the fullest bin is
// taken.
static colour ground_of(cairo_surface_t *surface, const letter_mask *m)
{
    enum { BINS = 4096 };
    static int count[BINS];
    static unsigned char example[BINS][3];
    int best = 0;
    memset(count, 0, sizeof count);
    for (int j = 0; j < m->height; j++) {
        for (int i = 0; i < m->width; i++) {
            const unsigned char *p = bytes_at(surface, m->x + i, m->y + j);
            int bin = (p[2] >> 4) << 8 | (p[1] >> 4) << 4 | p[0] >> 4;
            memcpy(example[bin], p, 3);
            count[bin]++;
            best = count[bin] > count[best] ? bin : best;
        }
    }
    return (colour){example[best][2] / 255.0, example[best][1] / 255.0,
                    example[best][0] / 255.0};
}

// Share of a text's letters that lie on something that stands out from its ground.
static double crossed(cairo_surface_t *surface, const letter_mask *m, colour ground)
{
    const double most = 60 / 255.0; // grid lines and shades differ less from the page
    int letters = 0, on_ink = 0;
    for (int j = 0; j < m->height; j++) {
        for (int i = 0; i < m->width; i++) {
            const unsigned char *p = bytes_at(surface, m->x + i, m->y + j);
            if (m->cover[(ptrdiff_t)j * m->width + i] < 100) {
                continue; // hardly covered by the letter (of 255)
            }
            letters++;
            on_ink += fabs(p[2] / 255.0 - ground.red) > most ||
                      fabs(p[1] / 255.0 - ground.green) > most ||
                      fabs(p[0] / 255.0 - ground.blue) > most;
        }
    }
    return letters > 0 ? (double)on_ink / letters : 0;
}

static int complaints;

// A complaint is printed and counted, so that one run of the test shows all of them.
#define complain_of(format, ...) (print_error(format "\n", __VA_ARGS__), complaints++)

// No curve, line or mark crosses a letter, and every letter stands out from its ground.
static void check_texts(const artwork *a, const char *id, double width)
{
    PIXELS(surface) = without_texts(a);
    for (guint i = 0; i < masks->len; i++) {
        const letter_mask *m = &g_array_index(masks, letter_mask, i);
        colour ground = ground_of(surface, m);
        double share = crossed(surface, m, ground);
        if (share > 0.01) {
            complain_of("%s at %g mm: %.0f %% of '%.30s' is crossed by what is drawn", id,
                        width, 100 * share, m->text);
        }
        if (contrast(m->ink, ground) < 4.5) { // the least of WCAG 2 for text
            complain_of("%s at %g mm: '%.30s' has a contrast of %.1f", id, width, m->text,
                        contrast(m->ink, ground));
        }
    }
    free_masks();
}

// Nothing leaves the page, no text covers another, none is smaller than can be read.
static void check_page(const artwork *a, const figure_report *r, const char *id,
                       double width)
{
    const figure_rect ink = record_page(a, NULL), page = {0, 0, a->width, a->height};
    check_close(a->width, width / 25.4 * 72, 1e-6); // millimetres in points
    if (!rect_is_within(&ink, &page, 1)) {
        complain_of("%s at %g mm: its ink leaves the page", id, width);
    }

    for (int i = 0; i < r->text_count; i++) {
        const figure_text *t = &r->texts[i];
        if (!rect_is_within(&t->place, &page, 0.5)) {
            complain_of("%s at %g mm: '%s' leaves the page", id, width, t->text);
        }
        if (t->size < LETTERS_LEAST - 1e-9 || t->size > 12) {
            complain_of("%s at %g mm: '%s' has letters of %.2f pt", id, width, t->text,
                        t->size);
        }
        for (int k = 0; k < i; k++) {
            // side by side, two words need room between them, too
            figure_rect wider = t->place;
            wider.x -= 1.5;
            wider.width += 3;
            if (overlap(&wider, &r->texts[k].place)) {
                complain_of("%s at %g mm: '%s' covers '%s'", id, width, t->text,
                            r->texts[k].text);
            }
        }
    }
}

// ---- curves

// A figure with other colours of its curves, all else as it is.
typedef struct recoloured {
    figure figure;
    figure_panel panels[FIGURE_PANELS];
    figure_series series[FIGURE_PANELS][PANEL_SERIES];
} recoloured;

static void recolour(recoloured *out, const figure *fig, int shift)
{
    out->figure = *fig;
    out->figure.panels = out->panels;
    for (int p = 0; p < fig->panel_count; p++) {
        out->panels[p] = fig->panels[p];
        out->panels[p].series = out->series[p];
        for (int i = 0; i < fig->panels[p].series_count; i++) {
            out->series[p][i] = fig->panels[p].series[i];
            figure_series *other = &out->series[p][i];
            other->colour = (other->colour + shift) % 8;
            if (other->run > 0) {
                other->run += shift;
            }
        }
    }
}

// Whether ink of curves may be at a point of the page [pt].
static bool may_have_ink(const figure *fig, const figure_report *r, double x, double y)
{
    for (int i = 0; i < r->panel_count; i++) {
        // the width of a line above and below, of a marker all round
        double room = 1;
        for (int k = 0; k < fig->panels[i].series_count; k++) {
            const figure_series *s = &fig->panels[i].series[k];
            room = fmax(room,
                        s->marker == MARKER_NONE ? 0 : 1.3 * fmax(s->radius, 1.6) + 0.5);
        }
        figure_rect spot = {x, y, 0, 0};
        if (rect_is_within(&spot, &r->panels[i], room) ||
            rect_is_within(&spot, &r->legends[i], 1)) {
            return true;
        }
    }
    return fig->common_legend && y < r->panels[0].y;
}

// Curves end at their panel's frame: a pixel that changes with their colours is within
// one.
static void check_frames(const figure *fig, const char *id, double width)
{
    static figure_report r;
    static recoloured other;
    recolour(&other, fig, 1);
    PIXELS(one) = paint_pixels(fig, SCALE, &r),
    *two = paint_pixels(&other.figure, SCALE, NULL);
    int outside = 0, inside = 0;
    for (int j = 0; j < cairo_image_surface_get_height(one); j++) {
        for (int i = 0; i < cairo_image_surface_get_width(one); i++) {
            if (memcmp(bytes_at(one, i, j), bytes_at(two, i, j), 3) != 0) {
                bool allowed =
                    may_have_ink(fig, &r, (i + 0.5) / SCALE, (j + 0.5) / SCALE);
                inside += allowed;
                outside += !allowed;
            }
        }
    }
    if (outside > 0 || inside < 50) {
        complain_of("%s at %g mm: %d pixels of curves inside, %d outside their frames",
                    id, width, inside, outside);
    }
}

// The mark of the peak stands at a point of the force's curve that none near it exceeds,
// that of the contact where the force begins.
static void check_marks(const figure *fig, const char *id)
{
    for (int m = 0; m < fig->mark_count; m++) {
        const figure_mark *mark = &fig->marks[m];
        bool peak = mark->label != NULL && g_str_has_prefix(mark->label, "peak");
        for (int p = 0; p < fig->panel_count && peak; p++) {
            const figure_series *s = &fig->panels[p].series[0];
            if (s->name == NULL || strcmp(s->name, "force") != 0) {
                continue;
            }
            double at = (double)NAN, highest = -HUGE_VAL;
            for (size_t i = 0; i < s->count; i++) {
                double x = series_x(s, i), y = series_y(s, i);
                at = x == mark->x ? y : at;
                highest = fabs(x - mark->x) < 0.01 ? fmax(highest, y) : highest;
            }
            if (!(at >= highest)) {
                complain_of("%s: the mark '%s' is at %g of a curve that reaches %g", id,
                            mark->label, at, highest);
            }
        }
    }
}

// ---- lines told apart

static bool same_dashes(const swatch *a, const swatch *b)
{
    bool same = a->dash_count == b->dash_count;
    for (int i = 0; i < a->dash_count && same; i++) {
        same = fabs(a->dashes[i] / a->dashes[0] - b->dashes[i] / b->dashes[0]) < 0.2;
    }
    return same;
}

// Whether two entries of a legend differ in what needs no colour.
static bool differ_in_form(const swatch *a, const swatch *b)
{
    double wider = fmax(a->width, b->width), narrower = fmin(a->width, b->width);
    return a->marker != b->marker || (narrower == 0) != (wider == 0) ||
           !same_dashes(a, b) || (narrower > 0 && wider / narrower > 1.6);
}

// Colours of one legend are far from each other for everybody; without colours, greys or
// forms are.
static void check_legends(const figure *fig, figure_theme theme, const char *id,
                          double width)
{
    const double least_colours = 15, least_greys = 25;
    figure copy = *fig;
    copy.theme = theme;
    swatch_count = 0;
    cairo_surface_destroy(paint_pixels(&copy, SCALE, NULL));
    for (int i = 0; i < swatch_count; i++) {
        for (int k = 0; k < i; k++) {
            const swatch *a = &swatches[i], *b = &swatches[k];
            if (a->panel != b->panel) {
                continue;
            }
            bool form = differ_in_form(a, b);
            for (int sight = 0; sight < (int)G_N_ELEMENTS(sights); sight++) {
                double seen = distance_seen(a->ink, b->ink, sight);
                bool told = theme == THEME_MONO
                                ? form || seen > least_greys
                                : seen > least_colours || (form && seen < 1e-9);
                if (!told) {
                    complain_of(
                        "%s at %g mm, theme %d: '%s' and '%s' are %.1f apart in %s%s", id,
                        width, (int)theme, a->panel->series[a->index].label,
                        b->panel->series[b->index].label, seen, sight_names[sight],
                        form ? "" : ", alike in form");
                }
            }
        }
    }
}

// ---- tests

// Checks all of an artwork; marks are those of a single run.
static void check_artwork(const artwork *drawn, const char *id, double width)
{
    static figure_report r;
    cairo_surface_destroy(page_pixels(drawn, SCALE, &r));
    check_page(drawn, &r, id, width);
    check_texts(drawn, id, width);
    if (drawn->plotted != NULL) {
        if (drawn->plotted->panels[0].series_count > 0) {
            check_frames(drawn->plotted, id, width);
        }
        check_marks(drawn->plotted, id);
        for (figure_theme theme = THEME_COLOUR; theme <= THEME_DARK; theme++) {
            check_legends(drawn->plotted, theme, id, width);
        }
    }
}

TEST(every_figure_can_be_read)
{
    complaints = 0;
    for (int i = 0; i < thesis_figure_count(); i++) {
        for (size_t k = 0; k < G_N_ELEMENTS(widths); k++) {
            const char *id = thesis_figure_at(i)->id;
            SCOPED(artwork_finish)
            artwork drawn = open_figure(id, (figure_options){.look.width = widths[k]});
            check_artwork(&drawn, id, widths[k]);
        }
    }
    assert_int_equal(complaints, 0);
}

// Runs side by side: two, as many as one panel shows, and small multiples, in all themes.
TEST(every_comparison_can_be_read)
{
    static const char *const names[] = {"compare/hybrid",       "compare/observer",
                                        "compare/force-pd",     "compare/impedance",
                                        "compare/admittance",   "compare/touch",
                                        "compare/discontinuous"};
    enum { MOST = G_N_ELEMENTS(names) };
    static const int counts[] = {2, RUNS_TOGETHER, MOST};
    opened_run *opened[MOST];
    trace_run runs[MOST];
    fault f = {0};
    for (int i = 0; i < MOST; i++) {
        opened[i] = run_open(names[i], NULL, &f);
        assert_non_null(opened[i]);
        runs[i] = (trace_run){&opened[i]->scenario, &opened[i]->result, names[i],
                              .rank = i + 1};
    }

    complaints = 0;
    for (size_t c = 0; c < G_N_ELEMENTS(counts); c++) {
        for (size_t k = 0; k < G_N_ELEMENTS(widths); k++) {
            for (figure_theme theme = THEME_COLOUR; theme <= THEME_DARK; theme++) {
                const figure_options o = {.look = {.width = widths[k], .theme = theme}};
                owned_figure *made =
                    run_figure_create("Runs", NULL, 0, runs, counts[c], &o, &f);
                assert_non_null(made);
                SCOPED(artwork_finish) artwork drawn = artwork_of_owned(made);
                check_artwork(&drawn, formatted("%d runs", counts[c]), widths[k]);
            }
        }
    }
    for (int i = 0; i < MOST; i++) {
        run_close(opened[i]);
    }
    assert_int_equal(complaints, 0);
}

enum { LOOP_POINTS = 2001, LOOPS = 3 };

// Answers of a loop from 0.01 to 100 Hz: of three equal lags, of a resonance with a delay
// as of force control, or of an integral part, which leaves the plane.
static linear_response loop_of(int kind, double complex *block)
{
    linear_response r = {LOOP_POINTS, (double *)block, block + LOOP_POINTS};
    for (int i = 0; i < LOOP_POINTS; i++) {
        const double frequency = pow(10, -2 + 4.0 * i / (LOOP_POINTS - 1));
        const double complex s = complex_of(0, frequency / 3.5), lag = 1 + s / 2;
        const double late = -0.02 * frequency; // [rad]
        r.frequency[i] = 2 * M_PI * frequency;
        if (kind == 0) {
            r.gain[i] = 4 / (lag * lag * lag);
        } else if (kind == 1) {
            r.gain[i] = 0.5 * (1 + 1.5 * s) / (1 + 0.2 * s + s * s) *
                        complex_of(cos(late), sin(late));
        } else {
            r.gain[i] = (0.5 + 0.2 / s) / lag;
        }
    }
    return r;
}

// The axis of every parameter that a sweep varies, in a column of a journal.
TEST(every_axis_of_a_sweep_fits_a_column)
{
    static figure_report r;
    KEPT_SCENARIO(s) = shipped("corrected/first-impact");
    double values[] = {1, 3, 2};
    int drawn_axes = 0;
    complaints = 0;
    for (int i = 0; i < parameter_count; i++) {
        const parameter_info *info = &parameter_table[i];
        if (info->type != PARAMETER_REAL) {
            continue;
        }
        const char *vary =
            formatted("%s=%.17g:%.17g:3", info->path, info->minimum, info->maximum);
        sweep varied;
        fault f = {0};
        const sweep_request request = {.vary = (char *[]){(char *)vary}, .vary_count = 1};
        if (sweep_init(&varied, &s, &request, &f) != STATUS_OK) {
            continue; // values that go with others only
        }

        owned_figure *made = sweep_figure_create(
            &(sweep_picture){.sweep = &varied, .key = "peak_force_N", .values = values});
        made->figure.width = widths[0];
        SCOPED(artwork_finish) artwork drawn = artwork_of_owned(made);
        cairo_surface_destroy(page_pixels(&drawn, SCALE, &r));
        check_page(&drawn, &r, info->path, widths[0]);
        sweep_finish(&varied);
        drawn_axes++;
    }
    assert_int_equal(complaints, 0);
    assert_true(drawn_axes > 60);
}

TEST(every_loop_can_be_read)
{
    static double complex block[2 * LOOP_POINTS];
    const scenario s = {.name = (char *)"a loop"};
    complaints = 0;
    for (int kind = 0; kind < LOOPS; kind++) {
        const linear_curve loop = {"loop gain", loop_of(kind, block)};
        const linear_margins m = linear_margins_of(&loop.response);
        for (size_t k = 0; k < G_N_ELEMENTS(widths); k++) {
            owned_figure *both[] = {nyquist_figure_create(&s, &loop.response, &m),
                                    bode_figure_create(&s, &loop, 1, &m)};
            for (int i = 0; i < 2; i++) {
                both[i]->figure.width = widths[k];
                SCOPED(artwork_finish) artwork drawn = artwork_of_owned(both[i]);
                check_artwork(&drawn,
                              formatted("%s of loop %d", i == 0 ? "plane" : "bode", kind),
                              widths[k]);
            }
        }
    }
    assert_int_equal(complaints, 0);
}

// What every command draws, as a person asks for it: what it would write is checked on
// the way to its file.
static const char *asked_for; // NULL: nothing is
static int published;

status __real_figure_publish(const figure *fig, const figure_options *o, const char *path,
                             bool with_csv, fault *f);
status __wrap_figure_publish(const figure *fig, const figure_options *o, const char *path,
                             bool with_csv, fault *f);
status __real_artwork_publish(const artwork *a, const figure_options *o, const char *path,
                              bool with_csv, fault *f);
status __wrap_artwork_publish(const artwork *a, const figure_options *o, const char *path,
                              bool with_csv, fault *f);

status __wrap_figure_publish(const figure *fig, const figure_options *o, const char *path,
                             bool with_csv, fault *f)
{
    figure shown = *fig;
    figure_take_look(&shown, &o->look);
    SCOPED(artwork_finish) artwork drawn = artwork_of_figure(&shown);
    if (asked_for != NULL) {
        check_artwork(&drawn, asked_for, shown.width);
        published++;
    }
    return __real_figure_publish(fig, o, path, with_csv, f);
}

status __wrap_artwork_publish(const artwork *a, const figure_options *o, const char *path,
                              bool with_csv, fault *f)
{
    if (asked_for != NULL) {
        check_artwork(a, asked_for, o->look.width);
        published++;
    }
    return __real_artwork_publish(a, o, path, with_csv, f);
}

// Complains unless a command line of the program, which runs once in a process, draws one
// picture that can be read.
static void check_command(const char *line, double width)
{
    g_auto(GStrv) words =
        g_strsplit(formatted("impactlab %s --width %g", line, width), " ", -1);
    asked_for = line;
    const pid_t child = fork();
    if (child == 0) {
        complaints = 0;
        const int ended = program_run((int)g_strv_length(words), words);
        _exit(ended != 0 || published != 1 || complaints > 0);
    }
    int ending;
    assert_int_equal(waitpid(child, &ending, 0), child);
    if (ending != 0) {
        complaints++;
        print_error("%s at %g mm\n", line, width);
    }
}

TEST(every_command_draws_what_can_be_read)
{
    static const char *const commands[] = {
        "run corrected/first-impact",
        "run compare/hybrid",
        "run corrected/five-links",
        "run corrected/free-vibration",
        "compare compare/hybrid compare/observer",
        ("compare compare/hybrid compare/observer compare/touch compare/force-pd "
         "compare/open-loop"),
        "sweep corrected/first-impact --vary motor.voltage=1:5:5",
        "sweep corrected/first-impact --vary motor.voltage=1:5:5 --vary arm.k2=2:20:4",
        "robust compare/hybrid --runs 8",
        "linear compare/hybrid --at contact",
        "linear compare/hybrid --law",
        "linear compare/hybrid --law --vary control.settings.kp=0.1:10:3",
        "modes corrected/five-links",
        "predict corrected/first-impact",
        "converge corrected/first-impact",
        "tune compare/hybrid --vary control.kv=0.1:4 --minimise settling_time_s --runs 8",
        "study links corrected/damped-beam",
        "study follow compare/observer",
    };
    complaints = 0;
    for (size_t i = 0; i < G_N_ELEMENTS(commands); i++) {
        for (size_t k = 0; k < G_N_ELEMENTS(widths); k++) {
            check_command(formatted("%s --quiet --plot drawn.svg", commands[i]),
                          widths[k]);
        }
    }
    assert_int_equal(complaints, 0);
}

// Labels of levels that lie together are apart, or left out; the axis of a parameter with
// a long description goes by its symbol in a column.
TEST(recipes_draw_what_can_be_read)
{
    put_file(
        "levels.yaml",
        "runs: [{name: a, scenario: compare/hybrid}]\n"
        "panels:\n"
        "  - signals: [force, force_reading]\n"
        "    levels: [{at: 1, label: command}, {at: 0.95, label: less},\n"
        "             {at: 1.05, label: more}, {at: 1.06, label: much more},\n"
        "             {at: 0.94, label: much less}, {at: 1.01, label: a bit more}]\n");
    put_file("map.yaml",
             "tables:\n"
             "  - {name: sweep, x: arm.k2, y: motor.voltage, z: peak_force_N,\n"
             "     rows: [[4, 1, 1], [6, 1, 2], [4, 2, 3], [6, 2, 5]]}\n"
             "panels:\n"
             "  - {from: [sweep]}\n");
    complaints = 0;
    for (size_t k = 0; k < G_N_ELEMENTS(widths); k++) {
        check_command("plot levels.yaml -o drawn.svg", widths[k]);
        check_command("plot map.yaml -o drawn.svg", widths[k]);
    }
    assert_int_equal(complaints, 0);
}

// A line has one dash wherever it shows, though in one panel it turns too often for any.
TEST(a_line_has_one_dash_in_all_panels)
{
    static double x[ROWS], slow[ROWS], busy[ROWS];
    for (int i = 0; i < ROWS; i++) {
        x[i] = 1e-3 * i;
        slow[i] = sin(5 * x[i]);
        busy[i] = sin(900 * x[i]);
    }
    const figure_series calm[] = {{"hub", "hub", x, slow, ROWS},
                                  {"tip", "tip", x, x, ROWS, .colour = SLOT_GREEN}};
    const figure_series quick[] = {{"hub", "hub", x, slow, ROWS},
                                   {"tip", "tip", x, busy, ROWS, .colour = SLOT_GREEN}};
    const figure_panel panels[] = {{.y = {"angle"}, .series = calm, .series_count = 2},
                                   {.y = {"velocity"},
                                    .series = quick,
                                    .series_count = 2}};
    for (figure_theme theme = THEME_COLOUR; theme <= THEME_DARK; theme++) {
        const figure fig = {.x = {"time"},
                            .panels = panels,
                            .panel_count = 2,
                            .theme = theme};
        swatch_count = 0;
        cairo_surface_destroy(paint_pixels(&fig, SCALE, NULL));
        assert_int_equal(swatch_count, 4);
        for (int i = 0; i < 2; i++) {
            assert_int_equal(swatches[i].index, swatches[i + 2].index);
            assert_true(same_dashes(&swatches[i], &swatches[i + 2]));
            check_close(swatches[i].ink.red, swatches[i + 2].ink.red, 0);
            check_close(swatches[i].width, swatches[i + 2].width, 0);
        }
    }
}

// Every colour of the palette differs from every other for everyone, and contrasts with
// the page.
TEST(colours_are_far_from_each_other)
{
    static const figure_theme coloured[] = {THEME_COLOUR, THEME_DARK};
    complaints = 0;
    for (int t = 0; t < 2; t++) {
        for (int i = 0; i < 8; i++) {
            colour a = palette_series(coloured[t], i, 0);
            if (contrast(a, palette_of(coloured[t])->page) < 2) {
                complain_of("theme %d: slot %d has a contrast of %.2f", t, i,
                            contrast(a, palette_of(coloured[t])->page));
            }
            for (int k = 0; k < i; k++) {
                for (int sight = 0; sight < (int)G_N_ELEMENTS(sights); sight++) {
                    double seen =
                        distance_seen(a, palette_series(coloured[t], k, 0), sight);
                    if (seen < 10) {
                        complain_of("theme %d: slots %d and %d are %.1f apart in %s", t,
                                    k, i, seen, sight_names[sight]);
                    }
                }
            }
        }
    }
    assert_int_equal(complaints, 0);
}

ALL_BETWEEN(enter_folder, leave_plot_folder)
