// An explorer without a terminal, for tests: opened, its keys pressed, its screen as
// text.
#pragma once

#include "tests/session_fixture.h"

#include "ui/explorer/explorer.h"
#include "ui/terminal/keys.h"

// Of a shipped scenario with changes, that waits so long for its run.
static inline void open_changed(explorer *ex, const char *name, const char *changes,
                                double wait)
{
    scenario s = shipped_with(name, changes);
    DONE(explorer_init(ex, &s, wait, &f));
}

// Of one as it is, whose runs are waited for; for as long as its block.
#define OPEN_EXPLORER(ex, name)                                                          \
    SCOPED(explorer_finish) explorer ex;                                                 \
    open_changed(&ex, name, "", HUGE_VAL)

static inline void press(explorer *ex, const char *keys)
{
    fault f = {0};
    fail_if(!explorer_keys(ex, keys, &f), "%s", f.text);
}

// The value of a parameter where the cursor is, and the run's largest force.
static inline double value_of(const explorer *ex, int parameter)
{
    parameters p = session_parameters_at(&ex->model.session, ex->model.session.now);
    return parameter_get(&p, parameter);
}

static inline double peak(const explorer *ex)
{
    return ex->model.session.run.summary.peak_force_N;
}

// Keys with values in them, as printf writes them.
#define press_text(ex, ...) press(ex, formatted(__VA_ARGS__))

// Keys that leave a warning which says this.
static inline void press_warns(explorer *ex, const char *keys, const char *says)
{
    press(ex, keys);
    fail_if(!ex->input.message.warning || strstr(ex->input.message.text, says) == NULL,
            "%s leaves '%s', no warning that says '%s'", keys, ex->input.message.text,
            says);
}

// Keys that leave this in the prompt.
static inline void press_prompts(explorer *ex, const char *keys, const char *wanted)
{
    press(ex, keys);
    assert_string_equal(ex->input.prompt.text, wanted);
}

// The screen as text, to be freed.
static inline char *picture(explorer *ex, int width, int height, glyph_set set)
{
    SCOPED(screen_finish) screen s = {0};
    screen_resize(&s, width, height);
    explorer_draw(ex, &s);
    WRITTEN(text, screen_dump(&s, set, stream));
    return text;
}

// Presses, drags or turns the wheel of the mouse on its screen.
static inline void point(explorer *ex, pointer_kind kind, int x, int y)
{
    explorer_point(ex, (pointer_event){.kind = kind, .x = x, .y = y});
    free(picture(ex, 120, 40, GLYPHS_BRAILLE));
}

static inline void assert_shows_at(explorer *ex, int width, int height,
                                   const char *wanted)
{
    KEPT_TEXT(text) = picture(ex, width, height, GLYPHS_BRAILLE);
    const bool hidden = wanted[0] == '!' && wanted[1] != '\0';
    fail_if((strstr(text, wanted + hidden) == NULL) != hidden,
            "'%s' is %son the screen:\n%s", wanted + hidden, hidden ? "" : "not ", text);
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

// The same drawn only.
static inline void press_draws(explorer *ex, const char *keys)
{
    press(ex, keys);
    free(picture(ex, 120, 40, GLYPHS_BRAILLE));
}

// Screens of three sizes, each of which shows this.
static const int screen_sizes[][2] = {{80, 24}, {100, 30}, {200, 60}};

static inline void assert_shows_everywhere(explorer *ex, const char *wanted)
{
    for (EACH(size, screen_sizes)) {
        assert_shows_at(ex, (*size)[0], (*size)[1], wanted);
    }
}

// Keys that lead to a scenario.
static inline void press_opens(explorer *ex, const char *keys, const char *name)
{
    press(ex, keys);
    assert_string_equal(ex->model.session.base.name, name);
}

// How many keys a text of them has, <Name> being one.
static inline int count_keys(const char *keys)
{
    int count = 0;
    for (; *keys != '\0'; count++) {
        const char *close = *keys == '<' ? strchr(keys, '>') : NULL;
        keys = close != NULL ? close + 1 : keys + 1;
    }
    return count;
}

// Keys that leave the lab, or do not.
static inline void press_quits(explorer *ex, const char *keys, bool quits)
{
    press(ex, keys);
    assert_int_equal(ex->input.quit, quits);
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
