// An explorer without a terminal, for tests: opened, its keys pressed, its screen as text.
#pragma once

#include "tests/session_fixture.h"

#include "ui/explorer/explorer.h"
#include "ui/terminal/keys.h"

static inline void open_explorer(explorer *ex, const char *name)
{
    scenario s;
    assert_int_equal(scenario_open(&s, name, fail_on_fault, NULL), STATUS_OK);
    DONE(explorer_init(ex, &s, HUGE_VAL, &f));
}

// The same for as long as its block.
#define OPEN_EXPLORER(ex, name)                                                                    \
    SCOPED(explorer_finish) explorer ex;                                                           \
    open_explorer(&ex, name)

static inline void press(explorer *ex, const char *keys)
{
    fault f = {0};
    fail_if(!explorer_keys(ex, keys, &f), "%s", f.text);
}

// The screen as text, to be freed.
static inline char *picture(explorer *ex, int width, int height, glyph_set set)
{
    SCOPED(screen_finish) screen s = {0};
    char *text = NULL;
    size_t size = 0;
    assert_true(screen_resize(&s, width, height));
    explorer_draw(ex, &s);
    FILE *stream = open_memstream(&text, &size);
    assert_non_null(stream);
    screen_dump(&s, set, stream);
    fclose(stream);
    return text;
}

static inline void assert_shows_at(explorer *ex, int width, int height, const char *wanted)
{
    SCOPED(free_kept) char *text = picture(ex, width, height, GLYPHS_BRAILLE);
    fail_if(strstr(text, wanted) == NULL, "'%s' is not on the screen:\n%s", wanted, text);
}

static inline void assert_shows(explorer *ex, const char *wanted)
{
    assert_shows_at(ex, 120, 40, wanted);
}

static inline void assert_hides(explorer *ex, const char *unwanted)
{
    SCOPED(free_kept) char *text = picture(ex, 120, 40, GLYPHS_BRAILLE);
    fail_if(strstr(text, unwanted) != NULL, "'%s' is on the screen:\n%s", unwanted, text);
}

// The uppermost part of this kind on a screen of 120 x 40.
static inline hit_area part_on_screen(explorer *ex, panel_id id, hit_part part)
{
    free(picture(ex, 120, 40, GLYPHS_BRAILLE));
    for (int i = ex->layout.hit_count; i-- > 0;) {
        const hit_area *h = &ex->layout.hits[i];
        if (h->panel == id && h->part == part) {
            return *h;
        }
    }
    fail_msg("part %d of panel %d is not on the screen", (int)part, (int)id);
    return (hit_area){.panel = PANEL_NONE};
}

// A click at a cell.
static inline void click_at(explorer *ex, int x, int y)
{
    explorer_point(ex, (pointer_event){.kind = POINTER_PRESS, .x = x, .y = y});
    explorer_point(ex, (pointer_event){.kind = POINTER_RELEASE, .x = x, .y = y});
}
