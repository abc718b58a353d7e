// Recipes of figures: each is read or refused with sentences that name the place, and
// what is read keeps the promises of its model; its caller ends it in both cases. Now and
// then one is opened, with its runs, and drawn.
#include "tests/fuzz/fuzz.h"

#include "render/figures/figures.h"
#include "render/figures/recipe_parts.h"

enum { DRAWN_OF = 4 };

static void check_sentence(void *count, const char *sentence)
{
    fuzz_count_placed(count, sentence, "recipe.yaml");
}

static void check_panel(const recipe *r, const recipe_panel *p)
{
    FUZZ_CHECK(p->signal_count >= 0 && p->signal_count <= TRACE_SIGNALS);
    FUZZ_CHECK(p->source_count >= 0 && p->source_count <= RECIPE_SOURCES);
    FUZZ_CHECK(p->of < r->source_count && p->less < r->source_count);
    FUZZ_CHECK(isfinite(p->shown.weight) && isfinite(p->shown.y.low) &&
               isfinite(p->shown.y.high));
    for (int i = 0; i < p->source_count; i++) {
        FUZZ_CHECK(p->sources[i] >= 0 && p->sources[i] < r->source_count);
    }
    for (int i = 0; i < p->shown.note_count; i++) {
        FUZZ_CHECK(isfinite(p->notes[i].x) && isfinite(p->notes[i].y) &&
                   p->notes[i].text != NULL);
    }
}

static void check_recipe(const recipe *r)
{
    FUZZ_CHECK(r->source_count > 0 && r->source_count <= RECIPE_SOURCES);
    FUZZ_CHECK(r->shown.panel_count > 0 && r->shown.panel_count <= FIGURE_PANELS);
    FUZZ_CHECK(isfinite(r->shown.x.low) && isfinite(r->shown.x.high));
    for (int i = 0; i < r->source_count; i++) {
        const recipe_source *s = &r->sources[i];
        FUZZ_CHECK(s->name != NULL && isfinite(s->shift) && s->at.line > 0);
        FUZZ_CHECK((s->kind == SOURCE_RUN ? s->scenario : s->file) != NULL);
    }
    for (int i = 0; i < r->shown.panel_count; i++) {
        check_panel(r, &r->panels[i]);
    }
    for (int i = 0; i < r->shown.mark_count; i++) {
        FUZZ_CHECK(isfinite(r->marks[i].x));
    }
}

// Opens one that was read as the command does, and draws what comes out of it.
static void draw(const uint8_t *data, size_t size)
{
    artwork art;
    fault f = {0};
    int reported = 0;
    const figure_options options = {.look = {.width = 0}};
    const char *path = fuzz_file(data, size);
    FUZZ_CHECK(recipe_is(path));
    if (recipe_open(path, &options, fuzz_count, &reported, &art, &f) != STATUS_OK) {
        FUZZ_CHECK(reported > 0 || f.text[0] != '\0');
        return;
    }

    cairo_surface_t *surface =
        cairo_recording_surface_create(CAIRO_CONTENT_COLOR_ALPHA, NULL);
    cairo_t *cr = cairo_create(surface);
    fuzz_done(artwork_paint(&art, cr, NULL, &f), &f);
    cairo_destroy(cr);
    cairo_surface_destroy(surface);
    artwork_finish(&art);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static int inputs;
    recipe r = {0};
    int reported = 0;
    char *text = fuzz_text(data, size);
    const bool is_read =
        recipe_read(&r, "recipe.yaml", text, size, check_sentence, &reported);
    FUZZ_CHECK(is_read == (reported == 0));
    if (is_read) {
        check_recipe(&r);
    }
    owned_figure_destroy(r.plot);
    free(text);

    if (is_read && inputs++ % DRAWN_OF == 0) {
        draw(data, size);
    }
    return 0;
}
