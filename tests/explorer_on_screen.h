// An explorer without a terminal, for tests: opened, its keys pressed, its screen as text.
#pragma once

#include "tests/session_fixture.h"

#include "ui/explorer/explorer.h"
#include "ui/terminal/keys.h"

static inline void open_explorer(explorer *ex, const char *name)
{
    scenario s = shipped(name);
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

// Keys with values in them, as printf writes them.
__attribute__((format(printf, 2, 3))) static inline void press_text(explorer *ex,
                                                                    const char *format, ...)
{
    char keys[1024];
    va_list values;
    va_start(values, format);
    assert_in_range(vsnprintf(keys, sizeof keys, format, values), 0, sizeof keys - 1);
    va_end(values);
    press(ex, keys);
}

// Keys that leave a warning which says this.
static inline void press_warns(explorer *ex, const char *keys, const char *says)
{
    press(ex, keys);
    fail_if(!ex->state.message.warning || strstr(ex->state.message.text, says) == NULL,
            "%s leaves '%s', no warning that says '%s'", keys, ex->state.message.text, says);
}

// Keys that leave this in the prompt.
static inline void press_prompts(explorer *ex, const char *keys, const char *wanted)
{
    press(ex, keys);
    assert_string_equal(ex->state.prompt.text, wanted);
}

// The screen as text, to be freed.
static inline char *picture(explorer *ex, int width, int height, glyph_set set)
{
    SCOPED(screen_finish) screen s = {0};
    assert_true(screen_resize(&s, width, height));
    explorer_draw(ex, &s);
    WRITTEN(text, screen_dump(&s, set, stream));
    return text;
}

static inline void assert_shows_at(explorer *ex, int width, int height, const char *wanted)
{
    KEPT_TEXT(text) = picture(ex, width, height, GLYPHS_BRAILLE);
    const bool hidden = wanted[0] == '!' && wanted[1] != '\0';
    fail_if((strstr(text, wanted + hidden) == NULL) != hidden, "'%s' is %son the screen:\n%s",
            wanted + hidden, hidden ? "" : "not ", text);
}

static inline void all_shown(explorer *ex, const char *const *wanted)
{
    for (; *wanted != NULL; wanted++) {
        assert_shows_at(ex, 120, 40, *wanted);
    }
}

// Each text is on a screen of 120 x 40; one that begins with ! is not.
#define assert_shows(ex, ...) all_shown(ex, (const char *const[]){__VA_ARGS__, NULL})

// The same after keys.
#define press_shows(ex, keys, ...) (press(ex, keys), assert_shows(ex, __VA_ARGS__))

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
