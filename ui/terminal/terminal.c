#include "ui/terminal/terminal.h"

#include <assert.h>
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>
#include <wchar.h>

#define NCURSES_WIDECHAR 1
#include <curses.h>
#include <term.h>

#include "src/base/clock.h"
#include "ui/terminal/escape_sequence.h"
#include "ui/terminal/ink_colours.h"
#include "ui/terminal/paint.h"

// One terminal a program has; the signal handlers need it too.
static struct {
    SCREEN *curses;
    struct termios saved; // as it was
    int wake[2];          // signals write here
    screen shown;         // what the terminal has
    colour_theme theme;   // whose colours are set
    colour_depth depth;
    bool bright[INK_COUNT]; // inks that are bold for want of bright colours
    bool colours, themed, mouse, has_mouse;
    bool painted;             // what is shown was not shown by ncurses
    escape_sequence sequence; // that has begun on the input
    double sequence_time;     // of its last character [s]
    char restore[256];        // what a crash sends
    size_t restore_length;
} tty = {.wake = {-1, -1}};

#define SEQUENCE_TIME 0.25 // after such a pause what is missing of a sequence does not come [s]

static volatile sig_atomic_t leaving;    // the signal that asks to leave
static volatile sig_atomic_t suspending; // ^Z was pressed

static const int polite_signals[] = {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGWINCH, SIGCONT, SIGTSTP};
static const int fatal_signals[] = {SIGSEGV, SIGABRT, SIGFPE,  SIGBUS,   SIGILL,  SIGTRAP,
                                    SIGXCPU, SIGSYS,  SIGUSR1, SIGUSR2,  SIGALRM, SIGVTALRM,
                                    SIGPROF, SIGIO,   SIGPWR,  SIGSTKFLT};
enum {
    POLITE = sizeof polite_signals / sizeof polite_signals[0],
    FATAL = sizeof fatal_signals / sizeof fatal_signals[0],
    SIGNAL_STACK = 64 * 1024
};
static struct sigaction polite_before[POLITE], fatal_before[FATAL];
static char signal_stack[SIGNAL_STACK];

// --- signals ----------------------------------------------------------------------------------

static void on_polite(int number)
{
    int kept = errno;
    char byte = 0;
    if (number == SIGTSTP) {
        suspending = 1;
    } else if (number != SIGWINCH && number != SIGCONT) {
        leaving = number;
    }
    ssize_t ignored = write(tty.wake[1], &byte, 1);
    (void)ignored;
    errno = kept;
}

// Last resort: gives the terminal back by prepared bytes, then lets the signal do what it did.
static void on_fatal(int number)
{
    ssize_t ignored = write(STDOUT_FILENO, tty.restore, tty.restore_length);
    (void)ignored;
    tcsetattr(STDIN_FILENO, TCSANOW, &tty.saved);
    for (int i = 0; i < FATAL; i++) {
        if (fatal_signals[i] == number) {
            sigaction(number, &fatal_before[i], NULL);
        }
    }
    raise(number);
}

static void take_signals(void)
{
    stack_t stack = {.ss_sp = signal_stack, .ss_size = sizeof signal_stack};
    sigaltstack(&stack, NULL);

    for (int i = 0; i < POLITE; i++) {
        struct sigaction act = {.sa_handler = on_polite};
        sigaction(polite_signals[i], &act, &polite_before[i]);
        // a shell without jobs asks for ^Z to be ignored
        if (polite_signals[i] == SIGTSTP && polite_before[i].sa_handler == SIG_IGN) {
            sigaction(SIGTSTP, &polite_before[i], NULL);
        }
    }

    for (int i = 0; i < FATAL; i++) {
        // one that is ignored ends nothing and stays ignored
        struct sigaction act = {.sa_handler = on_fatal, .sa_flags = SA_ONSTACK};
        sigaction(fatal_signals[i], NULL, &fatal_before[i]);
        if (fatal_before[i].sa_handler != SIG_IGN) {
            sigaction(fatal_signals[i], &act, NULL);
        }
    }
}

static void give_signals_back(void)
{
    for (int i = 0; i < POLITE; i++) {
        sigaction(polite_signals[i], &polite_before[i], NULL);
    }
    for (int i = 0; i < FATAL; i++) {
        sigaction(fatal_signals[i], &fatal_before[i], NULL);
    }
    stack_t none = {.ss_flags = SS_DISABLE};
    sigaltstack(&none, NULL);
}

// --- opening and closing ----------------------------------------------------------------------

bool terminal_usable(fault *f)
{
    const char *name = getenv("TERM");
    int code;

    // both ends must be one
    if (!isatty(STDIN_FILENO) || !isatty(STDOUT_FILENO)) {
        fault_set(f, STATUS_BAD_ARGUMENT,
                  "the lab needs a terminal for its input and its output "
                  "(--size 120x40 --keys '...' prints a screen without)");
        return false;
    }

    // one that can place its cursor
    bool known = name != NULL && name[0] != '\0' && setupterm(name, STDOUT_FILENO, &code) == OK;
    const char *place = known ? tigetstr("cup") : NULL;
    bool usable = place != NULL && place != (const char *)-1;
    if (known) {
        del_curterm(cur_term);
    }
    if (!usable) {
        fault_set(f, STATUS_BAD_ARGUMENT,
                  "TERM is '%s', %s; the lab needs a terminal that can place its cursor: "
                  "TERM=xterm-256color suits most (TERM=xterm-256color impactlab)",
                  name ? name : "", known ? "which cannot place its cursor" : "which is not known");
    }
    return usable;
}

// Appends a terminal's string to what a crash sends, without its padding marks.
static void prepare(const char *text)
{
    for (; text != NULL && text != (const char *)-1 && *text; text++) {
        if (text[0] == '$' && text[1] == '<' && strchr(text, '>') != NULL) {
            text = strchr(text, '>');
        } else if (tty.restore_length < sizeof tty.restore) {
            tty.restore[tty.restore_length++] = *text;
        }
    }
}

// What terminals send for these keys whatever TERM says.
static void define_common_keys(void)
{
    static const struct {
        const char *sequence;
        int key;
    } keys[] = {{"\033[A", KEY_UP},     {"\033[B", KEY_DOWN},     {"\033[C", KEY_RIGHT},
                {"\033[D", KEY_LEFT},   {"\033OA", KEY_UP},       {"\033OB", KEY_DOWN},
                {"\033OC", KEY_RIGHT},  {"\033OD", KEY_LEFT},     {"\033[H", KEY_HOME},
                {"\033[F", KEY_END},    {"\033OH", KEY_HOME},     {"\033OF", KEY_END},
                {"\033[1~", KEY_HOME},  {"\033[4~", KEY_END},     {"\033[5~", KEY_PPAGE},
                {"\033[6~", KEY_NPAGE}, {"\033[3~", KEY_DC},      {"\033OP", KEY_F(1)},
                {"\033[11~", KEY_F(1)}, {"\033[1;2D", KEY_SLEFT}, {"\033[1;2C", KEY_SRIGHT},
                {"\033[1;2A", KEY_SR},  {"\033[1;2B", KEY_SF}};

    for (size_t i = 0; i < sizeof keys / sizeof keys[0]; i++) {
        define_key(keys[i].sequence, keys[i].key);
    }
}

status terminal_open(fault *f)
{
    if (!terminal_usable(f)) {
        return STATUS_BAD_ARGUMENT;
    }
    assert(tty.curses == NULL);
    leaving = 0;
    tcgetattr(STDIN_FILENO, &tty.saved);
    if (pipe2(tty.wake, O_NONBLOCK | O_CLOEXEC) != 0) {
        return fault_set(f, STATUS_NO_MEMORY, "no pipe for signals: %s", strerror(errno));
    }

    // before ncurses, which then leaves the resizing to us
    take_signals();
    tty.curses = newterm(NULL, stdout, stdin);
    if (tty.curses == NULL) {
        terminal_close();
        return fault_set(f, STATUS_BAD_ARGUMENT, "the terminal cannot be used");
    }

    // what a crash sends to give the terminal back
    tty.restore_length = 0;
    prepare(tigetstr("rmkx"));
    prepare("\033[?1000l\033[?1002l\033[?1006l\033[?2026l");
    prepare(tigetstr("sgr0"));
    prepare(tigetstr("cnorm"));
    prepare(tigetstr("rmcup"));

    // keys come one by one, and unseen
    cbreak();
    noecho();
    nonl();
    keypad(stdscr, TRUE);
    define_common_keys();

    // we read mouse reports ourselves, where the terminal has any
    const char *reports = tigetstr("kmous");
    tty.has_mouse = reports != NULL && reports != (const char *)-1;
    keyok(KEY_MOUSE, FALSE);
    tty.sequence.state = SEQUENCE_NONE;

    // no waiting in ncurses: terminal_wait does that
    nodelay(stdscr, TRUE);
    set_escdelay(25);
    typeahead(-1);
    curs_set(0);

    tty.colours = has_colors();
    if (tty.colours) {
        start_color();
        use_default_colors();
    }
    tty.themed = false;
    return STATUS_OK;
}

void terminal_close(void)
{
    if (tty.curses != NULL) {
        terminal_mouse(false);
        // where there is no alternate screen the prompt comes back to an empty one
        if (tty.painted) {
            clearok(stdscr, TRUE);
        }
        erase();
        refresh();
        curs_set(1);
        endwin();
        delscreen(tty.curses);
        tty.curses = NULL;
    }

    // as it was before terminal_open
    tcsetattr(STDIN_FILENO, TCSANOW, &tty.saved);
    screen_finish(&tty.shown);
    give_signals_back();
    for (int i = 0; i < 2 && tty.wake[0] >= 0; i++) {
        close(tty.wake[i]);
    }
    tty.wake[0] = tty.wake[1] = -1;

    // the signal that asked to leave does what it would have done
    if (leaving != 0) {
        signal(leaving, SIG_DFL);
        raise(leaving);
    }
}

void terminal_size(int *width, int *height)
{
    assert(width != NULL && height != NULL);
    *width = COLS > 0 ? COLS : 1;
    *height = LINES > 0 ? LINES : 1;
}

void terminal_mouse(bool on)
{
    if (on != tty.mouse && tty.has_mouse) {
        // ncurses has to wait for the end of a report that it has begun to read, so it is not asked
        const char *reports =
            on ? "\033[?1000h\033[?1002h\033[?1006h" : "\033[?1006l\033[?1002l\033[?1000l";
        ssize_t ignored = write(STDOUT_FILENO, reports, strlen(reports));
        (void)ignored;
        tty.mouse = on;
    }
}

// --- input ------------------------------------------------------------------------------------

static int key_of_curses(int key)
{
    static const struct {
        int curses, ours;
    } keys[] = {
        {KEY_LEFT, KEY_CODE_LEFT},
        {KEY_RIGHT, KEY_CODE_RIGHT},
        {KEY_UP, KEY_CODE_UP},
        {KEY_DOWN, KEY_CODE_DOWN},
        {KEY_HOME, KEY_CODE_HOME},
        {KEY_END, KEY_CODE_END},
        {KEY_PPAGE, KEY_CODE_PAGE_UP},
        {KEY_NPAGE, KEY_CODE_PAGE_DOWN},
        {KEY_DC, KEY_CODE_DELETE},
        {KEY_BACKSPACE, KEY_CODE_BACKSPACE},
        {KEY_F(1), KEY_CODE_F1},
        {KEY_ENTER, KEY_CODE_ENTER},
        {KEY_SLEFT, KEY_CODE_SHIFT_LEFT},
        {KEY_SRIGHT, KEY_CODE_SHIFT_RIGHT},
        {KEY_SR, KEY_CODE_SHIFT_UP},
        {KEY_SF, KEY_CODE_SHIFT_DOWN},
    };

    for (size_t i = 0; i < sizeof keys / sizeof keys[0]; i++) {
        if (keys[i].curses == key) {
            return keys[i].ours;
        }
    }
    return 0;
}

// Goes on with a sequence by the next character. False if that is a key of its own; *in is then the
// escape before it, if that stood alone.
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

    in->kind = result == SEQUENCE_MOUSE ? TERMINAL_POINTER : TERMINAL_NONE;
    return true;
}

// What has come already; TERMINAL_NONE if that is nothing, or not yet all of a sequence.
static terminal_input pending_input(void)
{
    terminal_input in = {.kind = TERMINAL_NONE};
    wint_t key = 0;
    int kind;
    while ((kind = get_wch(&key)) != ERR) {
        // in the middle of a sequence
        if (tty.sequence.state != SEQUENCE_NONE) {
            if (take_sequence(key, kind, &in)) {
                if (in.kind != TERMINAL_NONE) {
                    return in;
                }
                continue;
            }
            if (in.kind != TERMINAL_NONE) {
                // the key after the escape is the next one
                if (kind == KEY_CODE_YES) {
                    ungetch((int)key);
                } else {
                    unget_wch((wchar_t)key);
                }
                return in;
            }
        }

        if (kind == KEY_CODE_YES) {
            return key == KEY_RESIZE
                       ? (terminal_input){.kind = TERMINAL_RESIZE}
                       : (terminal_input){.kind = TERMINAL_KEY, .code = key_of_curses((int)key)};
        }

        if (key != KEY_CODE_ESCAPE) {
            return (terminal_input){.kind = TERMINAL_KEY, .code = (int)key};
        }
        tty.sequence.state = SEQUENCE_ESCAPED;
    }

    // no more came after an escape: it was the key
    if (tty.sequence.state == SEQUENCE_ESCAPED) {
        tty.sequence.state = SEQUENCE_NONE;
        return (terminal_input){.kind = TERMINAL_KEY, .code = KEY_CODE_ESCAPE};
    }

    return (terminal_input){.kind = TERMINAL_NONE};
}

// Gives the terminal back, mouse included, stops until the shell lets us go on, and takes the
// terminal over again.
static void suspend(void)
{
    struct sigaction ours, plain = {.sa_handler = SIG_DFL};
    terminal_mouse(false);
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
}

// Takes the bytes that signals left, and the terminal's new size.
static terminal_input after_signal(void)
{
    char bytes[64];
    struct winsize size;

    // the bytes only woke the loop, the flags tell why
    while (read(tty.wake[0], bytes, sizeof bytes) > 0) {
    }

    // after a stop it goes on below, perhaps in another size
    if (suspending != 0) {
        suspending = 0;
        suspend();
    }
    if (leaving != 0) {
        return (terminal_input){.kind = TERMINAL_LEAVE};
    }

    // whatever the signal was, the size is asked for
    if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 && size.ws_row > 0) {
        resizeterm(size.ws_row, size.ws_col);
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
        bool ended = in.kind == TERMINAL_NONE && ioctl(STDIN_FILENO, FIONREAD, &waiting) == 0 &&
                     waiting == 0 && watched[0].revents & (POLLHUP | POLLERR);
        in.kind = ended ? TERMINAL_LEAVE : in.kind;
        return in;
    }

    // neither has anything and yet something happened: the terminal is gone
    if (ready > 0) {
        in.kind = TERMINAL_LEAVE;
    }
    return in;
}

// --- output -----------------------------------------------------------------------------------

colour_depth terminal_depth(void)
{
    const char *none = getenv("NO_COLOR"), *claim = getenv("COLORTERM"), *name = getenv("TERM");
    const char *direct = tigetstr("RGB");
    if (!tty.colours || (none != NULL && none[0] != '\0')) {
        return DEPTH_MONO;
    }

    // what the terminal's description says, and what the terminal says of itself
    bool described = tigetflag("RGB") == 1 || tigetnum("RGB") > 0 || tigetflag("Tc") == 1 ||
                     (direct != NULL && direct != (const char *)-1) || COLORS > 256;
    bool claimed =
        claim != NULL && (strcmp(claim, "truecolor") == 0 || strcmp(claim, "24bit") == 0);
    // GNU screen and the console hand the claim of the terminal they were started from on
    bool hearsay = name != NULL && (strcmp(name, "linux") == 0 ||
                                    (strncmp(name, "screen", 6) == 0 && getenv("TMUX") == NULL));
    if (described || (claimed && !hearsay)) {
        return DEPTH_TRUE;
    }
    return COLORS >= 256 ? DEPTH_256 : DEPTH_16;
}

bool terminal_is_light(void)
{
    // "foreground;background", with the background's number among the 16 colours at the end
    const char *claim = getenv("COLORFGBG"), *last = claim ? strrchr(claim, ';') : NULL;
    return last != NULL && (strcmp(last, ";7") == 0 || strcmp(last, ";15") == 0);
}

static void set_colours(colour_theme theme, colour_depth depth)
{
    for (int i = 0; i < INK_COUNT && tty.colours; i++) {
        int index = depth == DEPTH_256 ? ink_256(theme, (ink)i) : ink_16(theme, (ink)i);
        // eight colours are bright where they are bold
        tty.bright[i] = index >= COLORS;
        init_pair((short)(i + 1), (short)(tty.bright[i] ? index & 7 : index), -1);
    }
    tty.theme = theme;
    tty.depth = depth;
    tty.themed = true;
}

static attr_t attributes_of(ink colour, bool coloured)
{
    // weight tells apart what colours do, where there are any
    switch (colour) {
    case INK_SELECTED:
        return A_REVERSE;
    case INK_TITLE:
    case INK_EVENT:
        return A_BOLD;

    // what a colour tells needs another sign where there is none
    case INK_DIM:
    case INK_OTHER:
        return coloured ? A_NORMAL : A_DIM;
    case INK_WARNING:
        return coloured ? A_BOLD : A_BOLD | A_UNDERLINE;
    case INK_FORCE:
        return coloured ? A_NORMAL : A_BOLD;
    default:
        return A_NORMAL;
    }
}

static void show_cell(int x, int y, cell c, glyph_set glyphs, bool coloured)
{
    cchar_t out;
    wchar_t text[2] = {(wchar_t)glyph_in_set(c.glyph, glyphs), 0};
    // what takes no cell or two would break the grid
    if (wcwidth(text[0]) != 1) {
        text[0] = '?';
    }

    // bold stands for bright where there are eight colours
    attr_t attributes = attributes_of(c.ink, coloured);
    rgb ignored;
    if (coloured && tty.bright[c.ink]) {
        attributes |= A_BOLD;
    } else if (coloured && tty.theme == COLOURS_LIGHT && tty.depth == DEPTH_16 &&
               ink_rgb(tty.theme, c.ink, &ignored)) {
        // many terminals show bold dark colours as bright ones: unreadable on light ground
        attributes &= ~(attr_t)A_BOLD;
    }

    setcchar(&out, text, attributes, coloured ? (short)(c.ink + 1) : 0, NULL);
    mvadd_wch(y, x, &out);
}

// Shows the cells through ncurses.
static void show_by_curses(const screen *s, glyph_set glyphs, bool coloured, bool whole)
{
    // what has changed since the last picture
    for (int y = 0; y < s->height; y++) {
        for (int x = 0; x < s->width; x++) {
            long i = (long)y * s->width + x;
            cell c = s->cells[i], old = tty.shown.cells[i];
            if (whole || c.glyph != old.glyph || c.ink != old.ink) {
                show_cell(x, y, c, glyphs, coloured);
                tty.shown.cells[i] = c;
            }
        }
    }

    // a terminal that knows synchronised output shows the frame at once, others ignore it
    ssize_t ignored = write(STDOUT_FILENO, "\033[?2026h", 8);
    refresh();
    ignored += write(STDOUT_FILENO, "\033[?2026l", 8);
    (void)ignored;
}

void terminal_show(const screen *s, glyph_set glyphs, colour_theme theme, colour_depth depth,
                   bool whole)
{
    assert(s != NULL && s->width > 0 && s->height > 0 && tty.curses != NULL);

    // another size, theme or depth: everything anew
    bool same_size = tty.shown.width == s->width && tty.shown.height == s->height;
    depth = depth == DEPTH_AUTO ? terminal_depth() : depth;
    if (!tty.themed || tty.theme != theme || tty.depth != depth) {
        set_colours(theme, depth);
        whole = true;
    }
    if (!same_size && !screen_resize(&tty.shown, s->width, s->height)) {
        return;
    }
    whole = whole || !same_size;

    // ncurses has numbers for the colours that the terminal's description has, no others
    bool coloured = theme != COLOURS_MONO && depth != DEPTH_MONO;
    bool numbered =
        tty.colours && COLORS <= 256 && depth != DEPTH_TRUE && (depth == DEPTH_16 || COLORS == 256);
    tty.painted = coloured && !numbered;

    // ncurses keeps count of what is on the screen even where it does not paint
    if (whole) {
        clearok(stdscr, TRUE);
        erase();
    }
    if (tty.painted) {
        // so that it finds nothing to do by itself later
        refresh();
        paint_cells(s, &tty.shown, glyphs, theme, depth, whole);
    } else {
        show_by_curses(s, glyphs, coloured, whole);
    }
}
