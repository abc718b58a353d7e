#include "ui/terminal.h"

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

// One terminal a program has; the signal handlers need it too.
static struct {
    SCREEN *curses;
    struct termios saved; // as it was
    int wake[2];          // signals write here
    screen shown;         // what the terminal has
    lab_theme theme;      // whose colours are set
    bool colours, themed, mouse;
    char restore[256]; // what a crash sends
    size_t restore_length;
} tty = {.wake = {-1, -1}};

static volatile sig_atomic_t leaving; // the signal that asks to leave

static const int polite_signals[] = {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGWINCH, SIGCONT};
static const int fatal_signals[] = {SIGSEGV, SIGABRT, SIGFPE, SIGBUS, SIGILL};
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
    if (number != SIGWINCH && number != SIGCONT) {
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
    }
    for (int i = 0; i < FATAL; i++) {
        struct sigaction act = {.sa_handler = on_fatal, .sa_flags = SA_ONSTACK};
        sigaction(fatal_signals[i], &act, &fatal_before[i]);
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
    if (!isatty(STDIN_FILENO) || !isatty(STDOUT_FILENO)) {
        fault_set(f, STATUS_BAD_ARGUMENT,
                  "the lab needs a terminal for its input and its output "
                  "(--size 120x40 --keys '...' prints a screen without)");
        return false;
    }
    bool known = name != NULL && name[0] != '\0' && setupterm(name, STDOUT_FILENO, &code) == OK;
    const char *place = known ? tigetstr("cup") : NULL;
    bool usable = place != NULL && place != (const char *)-1;
    if (known) {
        del_curterm(cur_term);
    }
    if (!usable) {
        fault_set(f, STATUS_BAD_ARGUMENT,
                  "TERM is '%s', %s; the lab needs a terminal that can place its cursor",
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
    } keys[] = {
        {"\033[A", KEY_UP},    {"\033[B", KEY_DOWN}, {"\033[C", KEY_RIGHT},  {"\033[D", KEY_LEFT},
        {"\033OA", KEY_UP},    {"\033OB", KEY_DOWN}, {"\033OC", KEY_RIGHT},  {"\033OD", KEY_LEFT},
        {"\033[H", KEY_HOME},  {"\033[F", KEY_END},  {"\033OH", KEY_HOME},   {"\033OF", KEY_END},
        {"\033[1~", KEY_HOME}, {"\033[4~", KEY_END}, {"\033[5~", KEY_PPAGE}, {"\033[6~", KEY_NPAGE},
        {"\033[3~", KEY_DC},   {"\033OP", KEY_F(1)}, {"\033[11~", KEY_F(1)}};
    for (size_t i = 0; i < sizeof keys / sizeof keys[0]; i++) {
        define_key(keys[i].sequence, keys[i].key);
    }
}

status terminal_open(fault *f)
{
    if (!terminal_usable(f)) {
        return STATUS_BAD_ARGUMENT;
    }
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
    tty.restore_length = 0;
    prepare(tigetstr("rmkx"));
    prepare("\033[?1000l\033[?1002l\033[?1006l\033[?2026l");
    prepare(tigetstr("sgr0"));
    prepare(tigetstr("cnorm"));
    prepare(tigetstr("rmcup"));
    cbreak();
    noecho();
    nonl();
    keypad(stdscr, TRUE);
    define_common_keys();
    nodelay(stdscr, TRUE);
    set_escdelay(25);
    typeahead(-1);
    curs_set(0);
    const char *no_colour = getenv("NO_COLOR");
    tty.colours = has_colors() && (no_colour == NULL || no_colour[0] == '\0');
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
        erase();
        refresh();
        curs_set(1);
        endwin();
        delscreen(tty.curses);
        tty.curses = NULL;
    }
    tcsetattr(STDIN_FILENO, TCSANOW, &tty.saved);
    screen_finish(&tty.shown);
    give_signals_back();
    for (int i = 0; i < 2 && tty.wake[0] >= 0; i++) {
        close(tty.wake[i]);
    }
    tty.wake[0] = tty.wake[1] = -1;
    if (leaving != 0) {
        signal(leaving, SIG_DFL);
        raise(leaving);
    }
}

void terminal_size(int *width, int *height)
{
    *width = COLS > 0 ? COLS : 1;
    *height = LINES > 0 ? LINES : 1;
}

void terminal_mouse(bool on)
{
    if (on != tty.mouse) {
        mousemask(on ? BUTTON1_PRESSED | BUTTON1_CLICKED | BUTTON4_PRESSED | BUTTON5_PRESSED |
                           REPORT_MOUSE_POSITION
                     : 0,
                  NULL);
        mouseinterval(0);
        // ncurses asks for presses only; dragging needs the motion between them
        const char *motion = on ? "\033[?1002h" : "\033[?1002l";
        ssize_t ignored = write(STDOUT_FILENO, motion, strlen(motion));
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
        {KEY_LEFT, KEY_CODE_LEFT},     {KEY_RIGHT, KEY_CODE_RIGHT},
        {KEY_UP, KEY_CODE_UP},         {KEY_DOWN, KEY_CODE_DOWN},
        {KEY_HOME, KEY_CODE_HOME},     {KEY_END, KEY_CODE_END},
        {KEY_PPAGE, KEY_CODE_PAGE_UP}, {KEY_NPAGE, KEY_CODE_PAGE_DOWN},
        {KEY_DC, KEY_CODE_DELETE},     {KEY_BACKSPACE, KEY_CODE_BACKSPACE},
        {KEY_F(1), KEY_CODE_F1},       {KEY_ENTER, KEY_CODE_ENTER},
    };
    for (size_t i = 0; i < sizeof keys / sizeof keys[0]; i++) {
        if (keys[i].curses == key) {
            return keys[i].ours;
        }
    }
    return 0;
}

static terminal_input mouse_input(void)
{
    MEVENT m;
    terminal_input in = {INPUT_NONE, 0, 0, 0};
    if (getmouse(&m) == OK) {
        bool wheel = m.bstate & (BUTTON4_PRESSED | BUTTON5_PRESSED);
        in.kind = wheel ? INPUT_WHEEL : INPUT_CLICK;
        in.code = m.bstate & BUTTON4_PRESSED ? -1 : 1;
        in.x = m.x;
        in.y = m.y;
    }
    return in;
}

// Takes an unknown key's sequence off the input after its escape, so that its letters are not taken
// for keys. Returns the key that is meant: the escape if it stood alone, 0 for a sequence.
static int drop_sequence(void)
{
    wint_t key = 0;
    if (get_wch(&key) != OK) {
        return KEY_CODE_ESCAPE;
    }
    if (key != '[' && key != 'O') {
        unget_wch((wchar_t)key);
        return KEY_CODE_ESCAPE;
    }
    while (get_wch(&key) == OK && (key < 0x40 || key > 0x7e)) {
    }
    return 0;
}

// What ncurses has read already; INPUT_NONE if that is nothing.
static terminal_input pending_input(void)
{
    wint_t key = 0;
    int kind = get_wch(&key);
    if (kind == KEY_CODE_YES && key == KEY_RESIZE) {
        return (terminal_input){INPUT_RESIZE, 0, 0, 0};
    }
    if (kind == KEY_CODE_YES && key == KEY_MOUSE) {
        return mouse_input();
    }
    if (kind == KEY_CODE_YES) {
        return (terminal_input){INPUT_KEY, key_of_curses((int)key), 0, 0};
    }
    if (kind == OK && key == KEY_CODE_ESCAPE) {
        return (terminal_input){INPUT_KEY, drop_sequence(), 0, 0};
    }
    return kind == OK ? (terminal_input){INPUT_KEY, (int)key, 0, 0}
                      : (terminal_input){INPUT_NONE, 0, 0, 0};
}

// Takes the bytes that signals left, and the terminal's new size.
static terminal_input after_signal(void)
{
    char bytes[64];
    struct winsize size;
    while (read(tty.wake[0], bytes, sizeof bytes) > 0) {
    }
    if (leaving != 0) {
        return (terminal_input){INPUT_LEAVE, 0, 0, 0};
    }
    if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 && size.ws_row > 0) {
        resizeterm(size.ws_row, size.ws_col);
    }
    return (terminal_input){INPUT_RESIZE, 0, 0, 0};
}

terminal_input terminal_wait(double seconds)
{
    terminal_input in = pending_input();
    if (in.kind != INPUT_NONE) {
        return in;
    }
    struct pollfd watched[2] = {{STDIN_FILENO, POLLIN, 0}, {tty.wake[0], POLLIN, 0}};
    int ready = poll(watched, 2, seconds < 0 ? -1 : (int)(1e3 * seconds + 0.999));
    if (ready > 0 && watched[1].revents != 0) {
        return after_signal();
    }
    if (ready > 0 && watched[0].revents & POLLIN) {
        in = pending_input();
        // readable, but there is nothing: its other end was closed
        int waiting = 0;
        bool ended = in.kind == INPUT_NONE && ioctl(STDIN_FILENO, FIONREAD, &waiting) == 0 &&
                     waiting == 0 && watched[0].revents & (POLLHUP | POLLERR);
        in.kind = ended ? INPUT_LEAVE : in.kind;
        return in;
    }
    if (ready > 0) {
        in.kind = INPUT_LEAVE;
    }
    return in;
}

// --- output -----------------------------------------------------------------------------------

// Colours of the inks: with 256 of them on dark and on light ground, and with eight.
static const short palette[3][INK_COUNT] = {
    {-1, 245, 240, -1,  -1,  117, 223, 250, 208, 220, 87, 203, 141, //
     75, 214, 43,  175, 227, 208, 117, 250},
    {-1, 243, 248, -1,  -1, 25,  94, 240, 160, 130, 30, 160, 91, //
     25, 166, 29,  132, 94, 160, 31, 240},
    {-1,
     -1,
     -1,
     -1,
     -1,
     COLOR_CYAN,
     COLOR_YELLOW,
     -1,
     COLOR_RED,
     COLOR_YELLOW,
     COLOR_CYAN,
     COLOR_RED,
     COLOR_MAGENTA, //
     COLOR_CYAN,
     COLOR_YELLOW,
     COLOR_GREEN,
     COLOR_MAGENTA,
     COLOR_YELLOW,
     COLOR_RED,
     COLOR_CYAN,
     -1},
};

static void set_colours(lab_theme theme)
{
    int row = COLORS >= 256 ? (theme == COLOURS_LIGHT ? 1 : 0) : 2;
    for (int i = 0; i < INK_COUNT && tty.colours; i++) {
        init_pair((short)(i + 1), palette[row][i], -1);
    }
    tty.theme = theme;
    tty.themed = true;
}

static attr_t attributes_of(ink colour, bool coloured)
{
    switch (colour) {
    case INK_SELECTED:
        return A_REVERSE;
    case INK_TITLE:
    case INK_EVENT:
        return A_BOLD;
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
    setcchar(&out, text, attributes_of(c.ink, coloured), coloured ? (short)(c.ink + 1) : 0, NULL);
    mvadd_wch(y, x, &out);
}

void terminal_show(const screen *s, glyph_set glyphs, lab_theme theme, bool whole)
{
    bool same_size = tty.shown.width == s->width && tty.shown.height == s->height;
    bool coloured = tty.colours && theme != COLOURS_MONO;
    if (!tty.themed || tty.theme != theme) {
        set_colours(theme);
        whole = true;
    }
    if (!same_size && !screen_resize(&tty.shown, s->width, s->height)) {
        return;
    }
    if (whole || !same_size) {
        clearok(stdscr, TRUE);
        erase();
    }
    for (int y = 0; y < s->height; y++) {
        for (int x = 0; x < s->width; x++) {
            long i = (long)y * s->width + x;
            cell c = s->cells[i], old = tty.shown.cells[i];
            if (whole || !same_size || c.glyph != old.glyph || c.ink != old.ink) {
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
