#include "ui/commands/pictures.h"

#include <assert.h>
#include <math.h>
#include <string.h>
#include <strings.h>

#include "render/page/text.h"

#define SERIF "DejaVu Serif"

// The family given by --font; NULL for the default.
static const char *family_of(const char *font)
{
    if (font == NULL || strcasecmp(font, "sans") == 0) {
        return NULL;
    }
    return strcasecmp(font, "serif") == 0 ? SERIF : font;
}

// --theme, or its older spellings.
static int read_theme(const arguments *a, figure_theme *theme)
{
    const char *word = a->theme != NULL ? a->theme : a->mono ? "mono" : a->dark ? "dark" : "light";
    if (a->mono + a->dark + (a->theme != NULL) > 1) {
        return complain("--theme, --mono and --dark cannot go together");
    }
    *theme = strcmp(word, "mono") == 0   ? THEME_MONO
             : strcmp(word, "dark") == 0 ? THEME_DARK
                                         : THEME_COLOUR;
    return EXIT_DONE;
}

int read_picture_options(const arguments *a, figure_options *o)
{
    assert(a != NULL && o != NULL);
    fault f = {0};
    bool ranged = !isnan(a->from) || !isnan(a->to);
    *o = (figure_options){.look = {.width = a->width,
                                   .height = a->height,
                                   .dpi = a->dpi,
                                   .font = family_of(a->font),
                                   .letters = a->font_size,
                                   .bare = a->bare,
                                   .transparent = a->transparent},
                          .overlay = a->overlay,
                          .signals = a->signals,
                          .latex = a->latex,
                          .command = a->command_line};

    int code = read_theme(a, &o->look.theme);
    if (code == EXIT_DONE && ranged && !(a->from < a->to)) {
        code = complain("--from and --to go together, the first below the second");
    }

    if (ranged) {
        o->from = a->from;
        o->to = a->to;
    }

    if (code == EXIT_DONE && o->look.font != NULL &&
        text_check_family(o->look.font, &f) != STATUS_OK) {
        code = complain_fault(&f);
    }
    return code;
}

int publish_figure(const arguments *a, const figure *fig)
{
    assert(a != NULL && a->plot != NULL && fig != NULL);
    figure_options o;
    fault f = {0};
    int code = read_picture_options(a, &o);
    if (code == EXIT_DONE && figure_publish(fig, &o, a->plot, true, &f) != STATUS_OK) {
        code = complain_fault(&f);
    }
    return code;
}

static void borrow_nothing(void *owner)
{
    (void)owner;
}

int publish_runs(const arguments *a, const char *title, const trace_run *runs, int run_count)
{
    assert(a != NULL && a->plot != NULL && runs != NULL && run_count > 0);
    figure_options o;
    run_figure r;
    fault f = {0};

    int code = read_picture_options(a, &o);
    if (code != EXIT_DONE) {
        return code;
    }

    if (run_figure_init(&r, title, NULL, 0, runs, run_count, &o, &f) != STATUS_OK) {
        return complain_fault(&f);
    }

    artwork drawn = artwork_of_figure(&r.traces.figure, NULL, borrow_nothing);
    if (artwork_publish(&drawn, &o, a->plot, false, &f) != STATUS_OK) {
        code = complain_fault(&f);
    }

    artwork_finish(&drawn);
    run_figure_finish(&r);
    return code;
}
