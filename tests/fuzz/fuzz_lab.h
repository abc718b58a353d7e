// A lab that a fuzz target opens, and what its screen must hold: cells that a terminal
// may show.
#pragma once

#include <math.h>

#include "src/base/words.h"
#include "tests/force_means.h"
#include "tests/fuzz/fuzz.h"
#include "ui/explorer/explorer.h"

// The lab on a brief run.
static inline void fuzz_open_lab(explorer *ex)
{
    scenario base;
    fault f = {0};
    fuzz_scenario(&base, "title: base\nrun: {duration: 0.1 s}\n");
    FUZZ_CHECK(explorer_init(ex, &base, HUGE_VAL, &f) == STATUS_OK);
    ex->view.size = (screen_size){120, 40};
}

static inline void fuzz_draw(explorer *ex, screen *shown)
{
    screen_resize(shown, ex->view.size.width, ex->view.size.height);
    explorer_draw(ex, shown);
    FUZZ_CHECK(impossible_mean(&ex->model.session.run) == NULL);
    for (long place = 0; place < (long)shown->width * shown->height; place++) {
        FUZZ_CHECK(!is_unprintable(shown->cells[place].glyph));
    }
}
