// Opening and closing the terminal, and the signals that end or stop the program
// meanwhile.
#include "ui/terminal/terminal.h"
#include "ui/terminal/terminal_state.h"

#include <assert.h>
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <term.h>

// --- signals ---------------------------------------------------------------------------

// those that ask for something, then those that end the program at once
static const int signals[] = {SIGINT,    SIGTERM, SIGHUP,  SIGQUIT, SIGWINCH, SIGCONT,
                              SIGTSTP,   SIGSEGV, SIGABRT, SIGFPE,  SIGBUS,   SIGILL,
                              SIGTRAP,   SIGXCPU, SIGSYS,  SIGUSR1, SIGUSR2,  SIGALRM,
                              SIGVTALRM, SIGPROF, SIGIO,   SIGPWR,  SIGSTKFLT};
enum {
    SIGNALS = sizeof signals / sizeof signals[0],
    POLITE = 7,
    SIGNAL_STACK = 64 * 1024
};
static struct sigaction before[SIGNALS];
static char signal_stack[SIGNAL_STACK];

static void on_polite(int number)
{
    int kept = errno;
    char byte = 0;
    if (number == SIGTSTP) {
        terminal_suspending = 1;
    } else if (number != SIGWINCH && number != SIGCONT) {
        terminal_leaving = number;
    }
    ssize_t ignored = write(tty.wake[1], &byte, 1);
    (void)ignored;
    errno = kept;
}

void terminal_give_back(void)
{
    if (tty.curses != NULL) {
        ssize_t ignored = write(STDOUT_FILENO, tty.restore, tty.restore_length);
        (void)ignored;
        tcsetattr(STDIN_FILENO, TCSANOW, &tty.saved);
    }
}

// Last resort: gives the terminal back, then lets the signal do what it did.
static void on_fatal(int number)
{
    terminal_give_back();
    for (int i = POLITE; i < SIGNALS; i++) {
        if (signals[i] == number) {
            sigaction(number, &before[i], NULL);
        }
    }
    raise(number);
}

static void take_signals(void)
{
    stack_t stack = {.ss_sp = signal_stack, .ss_size = sizeof signal_stack};
    sigaltstack(&stack, NULL);
    for (int i = 0; i < SIGNALS; i++) {
        const struct sigaction polite = {.sa_handler = on_polite};
        const struct sigaction fatal = {.sa_handler = on_fatal, .sa_flags = SA_ONSTACK};
        sigaction(signals[i], NULL, &before[i]);

        // one that is ignored ends nothing and stays ignored; so does ^Z of a shell
        // without jobs
        const bool stays = i >= POLITE || signals[i] == SIGTSTP;
        if (!stays || before[i].sa_handler != SIG_IGN) {
            sigaction(signals[i], i < POLITE ? &polite : &fatal, NULL);
        }
    }
}

static void give_signals_back(void)
{
    for (int i = 0; i < SIGNALS; i++) {
        sigaction(signals[i], &before[i], NULL);
    }
    stack_t none = {.ss_flags = SS_DISABLE};
    sigaltstack(&none, NULL);
}

// --- opening and closing ---------------------------------------------------------------

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
    bool known =
        name != NULL && name[0] != '\0' && setupterm(name, STDOUT_FILENO, &code) == OK;
    const char *place = known ? tigetstr("cup") : NULL;
    bool usable = place != NULL && place != (const char *)-1;
    if (known) {
        del_curterm(cur_term);
    }
    if (!usable) {
        fault_set(f, STATUS_BAD_ARGUMENT,
                  "TERM is '%s', %s; the lab needs a terminal that can place its "
                  "cursor: TERM=xterm-256color suits most (TERM=xterm-256color "
                  "impactlab)",
                  name ? name : "",
                  known ? "which cannot place its cursor" : "which is not known");
    }
    return usable;
}

void terminal_prepare_crash(const char *text)
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
        {"\033[A", KEY_UP},     {"\033[B", KEY_DOWN},     {"\033[C", KEY_RIGHT},
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

// Asks whether the terminal draws pictures; what it answers comes with the keys.
static void ask_for_pixels(void)
{
    const char *name = getenv("TERM");

    // a multiplexer passes strings on or shows them, and old consoles print them
    const bool careful = getenv("TMUX") != NULL || getenv("STY") != NULL ||
                         name == NULL || strncmp(name, "screen", 6) == 0 ||
                         strncmp(name, "tmux", 4) == 0 || strcmp(name, "linux") == 0;
    const char *question = pixel_answers_begin(&tty.pixels, careful);
    tty.sequence.awaits = true;
    terminal_send(question, strlen(question));
}

void terminal_bracket_pastes(bool on)
{
    // a console that does not know it may print it
    const char *name = getenv("TERM");
    if (name != NULL && strcmp(name, "linux") != 0) {
        terminal_send(on ? "\033[?2004h" : "\033[?2004l", 8);
    }
}

status terminal_open(fault *f)
{
    if (!terminal_usable(f)) {
        return STATUS_BAD_ARGUMENT;
    }
    assert(tty.curses == NULL);
    terminal_leaving = 0;
    tcgetattr(STDIN_FILENO, &tty.saved);
    FAULT_IF(pipe2(tty.wake, O_NONBLOCK | O_CLOEXEC) != 0, f, STATUS_NO_MEMORY,
             "no pipe for signals: %s", strerror(errno));

    // before ncurses, which then leaves the resizing to us
    take_signals();
    tty.curses = newterm(NULL, stdout, stdin);
    if (tty.curses == NULL) {
        terminal_close();
        return fault_set(f, STATUS_BAD_ARGUMENT, "the terminal cannot be used");
    }

    // what a crash sends to give the terminal back
    tty.restore_length = 0;
    terminal_prepare_crash("\033\\"); // ends a picture that is cut off
    terminal_prepare_crash(tigetstr("rmkx"));
    terminal_prepare_crash("\033[?1000l\033[?1002l\033[?1006l\033[?2004l\033[?2026l");
    terminal_prepare_crash(tigetstr("sgr0"));
    terminal_prepare_crash(tigetstr("cnorm"));
    terminal_prepare_crash(tigetstr("rmcup"));

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
    tty.pasting = false;

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
    terminal_bracket_pastes(true);
    ask_for_pixels();
    return STATUS_OK;
}

void terminal_close(void)
{
    if (tty.curses != NULL) {
        terminal_mouse(false);
        terminal_bracket_pastes(false);
        terminal_remove_pictures();
        // where there is no alternate screen the prompt comes back to an empty one
        clearok(stdscr, TRUE);
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
    if (terminal_leaving != 0) {
        signal(terminal_leaving, SIG_DFL);
        raise(terminal_leaving);
    }
}

void terminal_size(int *width, int *height)
{
    if (COLS > 0) {
        *width = COLS;
    } else {
        *width = 1;
    }
    if (LINES > 0) {
        *height = LINES;
    } else {
        *height = 1;
    }
}

void terminal_mouse(bool on)
{
    if (on != tty.mouse && tty.has_mouse) {
        // ncurses has to wait for the end of a report that it has begun to read, so it is
        // not asked
        const char *reports = on ? "\033[?1000h\033[?1002h\033[?1006h"
                                 : "\033[?1006l\033[?1002l\033[?1000l";
        ssize_t ignored = write(STDOUT_FILENO, reports, strlen(reports));
        (void)ignored;
        tty.mouse = on;
    }
}
