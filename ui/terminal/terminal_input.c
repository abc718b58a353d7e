// Keys, the mouse and answers from the terminal.
#include "ui/terminal/terminal.h"
#include "ui/terminal/terminal_state.h"

#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>
#include <wchar.h>

#include "src/base/clock.h"

// After such a pause what is missing of a sequence does not come [s].
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

// The key of an escape and a character that came at once, 0 for none: Alt and that key.
static int key_of_alt(wint_t key, int kind)
{
    const bool backspace = (kind == KEY_CODE_YES && key == KEY_BACKSPACE) ||
                           (kind == OK && (key == 127 || key == '\b'));
    if (backspace) {
        return KEY_CODE_ALT_BACKSPACE;
    }
    if (kind != OK) {
        return 0;
    }
    switch (key) {
    case 'b':
        return KEY_CODE_ALT_B;
    case 'd':
        return KEY_CODE_ALT_D;
    case 'f':
        return KEY_CODE_ALT_F;
    default:
        return 0;
    }
}

// Reads an answer of the terminal; true if the screen should be redrawn.
static bool take_answer(void)
{
    const terminal_pixels before = terminal_pixels_known();
    const bool asking = tty.pixels.stage != PIXELS_ANSWERED;
    const char *next_question = pixel_answers_take(&tty.pixels, &tty.sequence);
    const bool answered = tty.pixels.stage == PIXELS_ANSWERED;
    terminal_send(next_question, strlen(next_question));
    tty.sequence.awaits_answers = !answered;

    // with the last answer what the questions may have left on the screen goes
    if (asking && answered) {
        if (tty.pixels.kitty) {
            terminal_prepare_crash("\033_Ga=d,d=A,q=2\033\\");
        }
        return true;
    }
    const terminal_pixels now = terminal_pixels_known();
    return before.cell_width != now.cell_width || before.cell_height != now.cell_height;
}

// Passes the next character to the sequence that has begun, unless that was broken off.
static sequence_result continue_sequence(wint_t key, int kind, pointer_event *pointer)
{
    const double now = clock_seconds(CLOCK_MONOTONIC);
    const bool in_time =
        tty.sequence.state == SEQUENCE_ESCAPED || now - tty.sequence_time < SEQUENCE_TIME;
    tty.sequence_time = now;
    if (kind == OK && in_time) {
        return escape_sequence_take(&tty.sequence, (int)key, pointer);
    }
    return SEQUENCE_OTHER_KEY;
}

// Takes the next character of a sequence. False if that is a key of its own; *in is then
// the escape before it, if that stood alone.
static bool take_sequence(wint_t key, int kind, terminal_input *in)
{
    const bool escaped = tty.sequence.state == SEQUENCE_ESCAPED;
    in->kind = TERMINAL_NONE;
    switch (continue_sequence(key, kind, &in->pointer)) {
    case SEQUENCE_OTHER_KEY:
        // the escape was a key of its own
        tty.sequence.state = SEQUENCE_NONE;
        *in = (terminal_input){.kind = TERMINAL_NONE, .code = KEY_CODE_ESCAPE};
        if (escaped) {
            in->kind = TERMINAL_KEY;
        }
        return false;
    case SEQUENCE_ANSWER:
        // one that changes what can be shown has all drawn again
        if (take_answer()) {
            in->kind = TERMINAL_RESIZE;
        }
        break;
    case SEQUENCE_MOUSE:
        in->kind = TERMINAL_POINTER;
        break;
    case SEQUENCE_PASTE:
        tty.pasting = true;
        break;
    case SEQUENCE_PASTED:
        tty.pasting = false;
        break;
    case SEQUENCE_CONTINUES:
    case SEQUENCE_OVER:
        break;
    }
    return true;
}

// A key, which is one of pasted text until that ends: however long it takes, or with a
// key that no terminal pastes where the end was lost.
static terminal_input key_input(int code)
{
    if (code == KEY_CODE_ESCAPE || code == ('c' & 0x1f)) {
        tty.pasting = false;
    }
    return (terminal_input){.kind = TERMINAL_KEY, .code = code, .pasted = tty.pasting};
}

// Returns a key to ncurses, as the next one that it gives.
static void put_back(wint_t key, int kind)
{
    if (kind == KEY_CODE_YES) {
        ungetch((int)key);
    } else {
        unget_wch((wchar_t)key);
    }
}

// The input that has arrived; TERMINAL_NONE if there is none, or only a part of a
// sequence.
static terminal_input pending_input(void)
{
    terminal_input in = {.kind = TERMINAL_NONE};
    wint_t key = 0;
    int kind;
    while ((kind = get_wch(&key)) != ERR) {
        // in the middle of a sequence; the key after an escape that stood alone is the
        // next one
        if (tty.sequence.state != SEQUENCE_NONE) {
            const bool taken = take_sequence(key, kind, &in);
            const int alt = key_of_alt(key, kind);
            if (!taken && in.kind != TERMINAL_NONE && alt != 0) {
                return key_input(alt);
            }
            if (!taken && in.kind != TERMINAL_NONE) {
                put_back(key, kind);
            }
            if (in.kind != TERMINAL_NONE) {
                return in;
            }
            if (taken) {
                continue;
            }
        }

        // a key by itself, or an escape, which may begin a sequence
        if (kind == KEY_CODE_YES && key == KEY_RESIZE) {
            return (terminal_input){.kind = TERMINAL_RESIZE};
        }
        if (kind == KEY_CODE_YES) {
            return key_input(key_of_curses((int)key));
        }
        if (key != KEY_CODE_ESCAPE) {
            return key_input((int)key);
        }
        tty.sequence.state = SEQUENCE_ESCAPED;
    }

    // no more came after an escape: it was the key
    if (tty.sequence.state == SEQUENCE_ESCAPED) {
        tty.sequence.state = SEQUENCE_NONE;
        in = key_input(KEY_CODE_ESCAPE);
    }
    return in;
}

// Gives the terminal back, mouse included, and takes it over again.
static void give_back(void)
{
    terminal_mouse(false);
    terminal_bracket_pastes(false);
    terminal_remove_pictures();
    erase();
    refresh();
    endwin();
}

static void take_over(void)
{
    clearok(stdscr, TRUE);
    refresh();
    curs_set(0);
    terminal_bracket_pastes(true);
}

int terminal_run(const char *line)
{
    give_back();
    const int result = system(line);
    take_over();
    return result;
}

// Stops until the shell continues the program.
static void suspend(void)
{
    struct sigaction ours, plain = {.sa_handler = SIG_DFL};
    give_back();

    // nothing stops a program that no shell could wake
    sigaction(SIGTSTP, &plain, &ours);
    raise(SIGTSTP);
    sigaction(SIGTSTP, &ours, NULL);

    // what is shown is the shell's
    take_over();
}

// Asks for the terminal's size, and for that of a cell if it was known: it may change
// with it.
static void ask_for_size(void)
{
    struct winsize size;
    if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 &&
        size.ws_row > 0) {
        resizeterm(size.ws_row, size.ws_col);
    }
    if (tty.pixels.stage == PIXELS_ANSWERED && tty.pixels.cell_width > 0) {
        tty.sequence.awaits_answers = true;
        terminal_send(pixel_ask_cell, strlen(pixel_ask_cell));
    }
}

// Does what signals have asked for.
static terminal_input after_signal(void)
{
    // the bytes only woke terminal_wait, the flags tell why
    char bytes[64];
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
    ask_for_size();
    return (terminal_input){.kind = TERMINAL_RESIZE};
}

// Whether standard input, which can be read but gave nothing, was closed at its other
// end.
static bool input_has_ended(short events)
{
    int waiting = 0;
    return ioctl(STDIN_FILENO, FIONREAD, &waiting) == 0 && waiting == 0 &&
           (events & (POLLHUP | POLLERR)) != 0;
}

terminal_input terminal_wait(double seconds)
{
    terminal_input in = pending_input();
    if (in.kind != TERMINAL_NONE) {
        return in;
    }

    // for a key, or for a signal's byte
    struct pollfd watched[2] = {{STDIN_FILENO, POLLIN, 0}, {tty.wake[0], POLLIN, 0}};
    int milliseconds = -1;
    if (seconds >= 0) {
        milliseconds = (int)(1e3 * seconds + 0.999);
    }
    const int ready = poll(watched, 2, milliseconds);
    if (ready <= 0) {
        return in;
    }
    if (watched[1].revents != 0) {
        return after_signal();
    }

    // something happened to the input: a key, or the terminal is gone
    const bool readable = (watched[0].revents & POLLIN) != 0;
    if (readable) {
        in = pending_input();
    }
    if (!readable || (in.kind == TERMINAL_NONE && input_has_ended(watched[0].revents))) {
        in.kind = TERMINAL_LEAVE;
    }
    return in;
}
