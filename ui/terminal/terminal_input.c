// Keys, the mouse and answers from the terminal.
#include "ui/terminal/terminal.h"
#include "ui/terminal/terminal_state.h"

#include <poll.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>
#include <wchar.h>

#include "src/base/clock.h"

// after such a pause what is missing of a sequence does not come [s]
#define SEQUENCE_TIME 0.25

// The code of a key of ncurses, 0 for one that has no meaning here.
static int key_of_curses(int key)
{
    static const struct {
        int curses, code;
    } codes[] = {
#define CURSES_AND_CODE(code, name, curses) {curses, KEY_CODE_##code},
        KEY_LIST(CURSES_AND_CODE)
#undef CURSES_AND_CODE
            {KEY_ENTER, KEY_CODE_ENTER}};
    for (size_t i = 0; i < sizeof codes / sizeof codes[0]; i++) {
        if (codes[i].curses == key) {
            return codes[i].code;
        }
    }
    return 0;
}

// Reads an answer of the terminal; true if the screen should be redrawn.
static bool take_answer(void)
{
    const terminal_pixels before = terminal_pixels_known();
    const bool asking = tty.pixels.stage != PIXELS_ANSWERED;
    const char *next = pixel_answers_take(&tty.pixels, &tty.sequence);
    terminal_send(next, strlen(next));
    tty.sequence.awaits = tty.pixels.stage != PIXELS_ANSWERED;

    // when all is said: what the questions may have left on the screen goes
    const terminal_pixels now = terminal_pixels_known();
    if (asking && tty.pixels.stage == PIXELS_ANSWERED) {
        if (tty.pixels.kitty) {
            terminal_prepare_crash("\033_Ga=d,d=A,q=2\033\\");
        }
        return true;
    }
    return before.cell_width != now.cell_width || before.cell_height != now.cell_height;
}

// Goes on with a sequence by the next character. False if that is a key of its own; *in
// is then the escape before it, if that stood alone.
static bool take_sequence(wint_t key, int kind, terminal_input *in)
{
    bool escaped = tty.sequence.state == SEQUENCE_ESCAPED;
    sequence_result result = SEQUENCE_OTHER_KEY;

    if (kind == OK &&
        (escaped || clock_seconds(CLOCK_MONOTONIC) - tty.sequence_time < SEQUENCE_TIME)) {
        result = escape_sequence_take(&tty.sequence, (int)key, &in->pointer);
    }
    tty.sequence_time = clock_seconds(CLOCK_MONOTONIC);

    // a key after the escape: it was no sequence, and the escape a key of its own
    if (result == SEQUENCE_OTHER_KEY) {
        tty.sequence.state = SEQUENCE_NONE;
        *in = (terminal_input){.kind = escaped ? TERMINAL_KEY : TERMINAL_NONE,
                               .code = KEY_CODE_ESCAPE};
        return false;
    }

    // an answer that changes what can be shown has all drawn anew
    if (result == SEQUENCE_ANSWER) {
        if (take_answer()) {
            in->kind = TERMINAL_RESIZE;
        } else {
            in->kind = TERMINAL_NONE;
        }
        return true;
    }
    if (result == SEQUENCE_PASTE || result == SEQUENCE_PASTED) {
        tty.pasting = result == SEQUENCE_PASTE;
    }
    if (result == SEQUENCE_MOUSE) {
        in->kind = TERMINAL_POINTER;
    } else {
        in->kind = TERMINAL_NONE;
    }
    return true;
}

// A key, which is one of pasted text until that ends: however long it takes, or with a
// key that no terminal pastes where the end was lost.
static terminal_input key_input(int code)
{
    tty.pasting = tty.pasting && code != KEY_CODE_ESCAPE && code != ('c' & 0x1f);
    return (terminal_input){.kind = TERMINAL_KEY, .code = code, .pasted = tty.pasting};
}

// The input that has arrived; TERMINAL_NONE if there is none, or only a part of a
// sequence.
static terminal_input pending_input(void)
{
    terminal_input in = {.kind = TERMINAL_NONE};
    wint_t key = 0;
    int kind;
    while ((kind = get_wch(&key)) != ERR) {
        // in the middle of a sequence
        bool taken = false;
        if (tty.sequence.state != SEQUENCE_NONE) {
            taken = take_sequence(key, kind, &in);

            // the key after an escape that stood alone is the next one
            if (!taken && in.kind != TERMINAL_NONE && kind == KEY_CODE_YES) {
                ungetch((int)key);
            } else if (!taken && in.kind != TERMINAL_NONE) {
                unget_wch((wchar_t)key);
            }
        }
        if (in.kind != TERMINAL_NONE) {
            return in;
        }
        if (!taken && kind == KEY_CODE_YES) {
            if (key == KEY_RESIZE) {
                return (terminal_input){.kind = TERMINAL_RESIZE};
            }
            return key_input(key_of_curses((int)key));
        }
        if (!taken && key != KEY_CODE_ESCAPE) {
            return key_input((int)key);
        }
        if (!taken) {
            tty.sequence.state = SEQUENCE_ESCAPED;
        }
    }

    // no more came after an escape: it was the key
    if (tty.sequence.state == SEQUENCE_ESCAPED) {
        tty.sequence.state = SEQUENCE_NONE;
        in = key_input(KEY_CODE_ESCAPE);
    }
    return in;
}

// Gives the terminal back, mouse included, stops until the shell lets us go on, and takes
// the terminal over again.
static void suspend(void)
{
    struct sigaction ours, plain = {.sa_handler = SIG_DFL};
    terminal_mouse(false);
    terminal_bracket_pastes(false);
    terminal_remove_pictures();
    erase();
    refresh();
    endwin();

    // nothing stops a program that no shell could wake
    sigaction(SIGTSTP, &plain, &ours);
    raise(SIGTSTP);
    sigaction(SIGTSTP, &ours, NULL);

    // what is shown is the shell's
    clearok(stdscr, TRUE);
    refresh();
    curs_set(0);
    terminal_bracket_pastes(true);
}

// Takes the bytes that signals left, and the terminal's new size.
static terminal_input after_signal(void)
{
    char bytes[64];
    struct winsize size;

    // the bytes only woke the loop, the flags tell why
    while (read(tty.wake[0], bytes, sizeof bytes) > 0) {
    }

    // after a stop it continues below, perhaps in another size
    if (terminal_suspending != 0) {
        terminal_suspending = 0;
        suspend();
    }
    if (terminal_leaving != 0) {
        return (terminal_input){.kind = TERMINAL_LEAVE};
    }

    // whatever the signal was, the size is asked for
    if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 &&
        size.ws_row > 0) {
        resizeterm(size.ws_row, size.ws_col);
    }
    // of a cell again, too, which a change of size may change, if it was known
    if (tty.pixels.stage == PIXELS_ANSWERED && tty.pixels.cell_width > 0) {
        tty.sequence.awaits = true;
        terminal_send(pixel_ask_cell, strlen(pixel_ask_cell));
    }
    return (terminal_input){.kind = TERMINAL_RESIZE};
}

terminal_input terminal_wait(double seconds)
{
    terminal_input in = pending_input();
    if (in.kind != TERMINAL_NONE) {
        return in;
    }

    // for a key, or for a signal's byte
    struct pollfd watched[2] = {{STDIN_FILENO, POLLIN, 0}, {tty.wake[0], POLLIN, 0}};
    int ready = poll(watched, 2, seconds < 0 ? -1 : (int)(1e3 * seconds + 0.999));
    if (ready > 0 && watched[1].revents != 0) {
        return after_signal();
    }
    if (ready > 0 && watched[0].revents & POLLIN) {
        in = pending_input();

        // readable, but there is nothing: its other end was closed
        int waiting = 0;
        bool ended = in.kind == TERMINAL_NONE &&
                     ioctl(STDIN_FILENO, FIONREAD, &waiting) == 0 && waiting == 0 &&
                     watched[0].revents & (POLLHUP | POLLERR);
        if (ended) {
            in.kind = TERMINAL_LEAVE;
        }
        return in;
    }

    // neither has anything and yet something happened: the terminal is gone
    if (ready > 0) {
        in.kind = TERMINAL_LEAVE;
    }
    return in;
}
