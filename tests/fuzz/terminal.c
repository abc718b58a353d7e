// The lab under any bytes: two a step. The first chooses a key, a piece of a command, the
// mouse, a byte of an escape sequence or a new size, the second which; then the screen is
// drawn, of cells that a terminal may show.
#include "tests/fuzz/fuzz_lab.h"

#include "ui/terminal/escape_sequence.h"

enum { MOST_STEPS = 60 };

static void step(explorer *ex, escape_sequence *sequence, uint8_t kind, uint8_t which)
{
    pointer_event report;
    switch (kind % 5) {
    case 0:
        // not those that leave, and no files are written: s and the prompt's own words
        if (which >= ' ' && which != 'q' && which != 'Q' && which != 's' &&
            which != ':') {
            explorer_key(ex, which);
        }
        break;
    case 1:
        explorer_carry_out(ex,
                           FUZZ_PICK(which, "set motor.voltage 2", "set wall.angle 0.1",
                                     "seek 0.05", "branch", "undo", "set motor.voltage x",
                                     "panes 27", "theme mono", "law hybrid", "law none",
                                     "set run.duration 0.2", "mouse off", "key x seek 0",
                                     "redo"));
        break;
    case 2:
        report = (pointer_event){.kind = (pointer_kind)(kind / 5 % 5),
                                 .x = which % 130,
                                 .y = which / 3};
        explorer_point(ex, report);
        break;
    case 3:
        if (sequence->state == SEQUENCE_NONE) {
            sequence->state = SEQUENCE_ESCAPED;
        }
        if (escape_sequence_take(sequence, which, &report) == SEQUENCE_MOUSE) {
            explorer_point(ex, report);
        }
        break;
    default:
        ex->view.size = (screen_size){1 + which, 1 + kind / 5};
        break;
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    explorer ex;
    screen shown = {0};
    escape_sequence sequence = {.state = SEQUENCE_NONE};
    fuzz_open_lab(&ex);

    for (size_t i = 0; i + 1 < size && i < 2 * MOST_STEPS && !ex.input.quit; i += 2) {
        step(&ex, &sequence, data[i], data[i + 1]);
        fuzz_draw(&ex, &shown);
    }
    screen_finish(&shown);
    explorer_finish(&ex);
    return 0;
}
