// A terminal lab without a terminal, for tests: opened, its keys pressed, its screen as text.
#pragma once

#include "tests/check.h"

#include <stdlib.h>
#include <string.h>

#include "ui/explorer/lab.h"

static inline void fail_on_fault(void *context, const char *sentence)
{
    (void)context;
    fail_msg("%s", sentence);
}

static inline void open_lab(lab *l, const char *name)
{
    scenario s;
    fault f = {0};
    assert_int_equal(scenario_open(&s, name, fail_on_fault, NULL), STATUS_OK);
    if (lab_init(l, &s, &f) != STATUS_OK) {
        fail_msg("%s", f.text);
    }
}

static inline void press(lab *l, const char *keys)
{
    fault f = {0};
    if (!lab_keys(l, keys, &f)) {
        fail_msg("%s", f.text);
    }
}

// The screen as text, to be freed.
static inline char *picture(lab *l, int width, int height, glyph_set set)
{
    screen s = {0};
    char *text = NULL;
    size_t size = 0;
    assert_true(screen_resize(&s, width, height));
    lab_draw(l, &s);
    FILE *stream = open_memstream(&text, &size);
    assert_non_null(stream);
    screen_dump(&s, set, stream);
    fclose(stream);
    screen_finish(&s);
    return text;
}

static inline void assert_shows(lab *l, const char *wanted)
{
    char *text = picture(l, 120, 40, GLYPHS_BRAILLE);
    if (strstr(text, wanted) == NULL) {
        fail_msg("'%s' is not on the screen:\n%s", wanted, text);
    }
    free(text);
}

static inline void assert_hides(lab *l, const char *unwanted)
{
    char *text = picture(l, 120, 40, GLYPHS_BRAILLE);
    if (strstr(text, unwanted) != NULL) {
        fail_msg("'%s' is on the screen:\n%s", unwanted, text);
    }
    free(text);
}
