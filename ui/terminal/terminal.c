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

// First those that ask for something, then those that end the program at once.
static const int signals[] = {SIGINT,    SIGTERM, SIGHUP,  SIGQUIT, SIGWINCH, SIGCONT,
                              SIGTSTP,   SIGSEGV, SIGABRT, SIGFPE,  SIGBUS,   SIGILL,
                              SIGTRAP,   SIGXCPU, SIGSYS,  SIGUSR1, SIGUSR2,  SIGALRM,
                              SIGVTALRM, SIGPROF, SIGIO,   SIGPWR,  SIGSTKFLT};
enum {
    SIGNALS = sizeof signals / sizeof signals[0],
    POLITE_SIGNALS = 7, // the first ones
    SIGNAL_STACK = 64 * 1024
};
static struct sigaction before[SIGNALS];
static char signal_stack[SIGNAL_STACK];

// Wakes terminal_wait, which does what the signal asks for.
static void on_polite(int number)
{
    const int errno_before = errno;
    if (number == SIGTSTP) {
        terminal_suspending = 1;
    } else if (number != SIGWINCH && number != SIGCONT) {
        terminal_leaving = number;
    }
    const char byte = 0;
    ssize_t ignored = write(tty.wake[1], &byte, 1);
    (void)ignored;
    errno = errno_before;
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
    for (int i = POLITE_SIGNALS; i < SIGNALS; i++) {
        if (signals[i] == number) {
            sigaction(number, &before[i], NULL);
        }
    }
    raise(number);
}

// Catches the signals, and remembers what they did before.
static void take_signals(void)
{
    const struct sigaction polite = {.sa_handler = on_polite};
    const struct sigaction fatal = {.sa_handler = on_fatal, .sa_flags = SA_ONSTACK};
    stack_t stack = {.ss_sp = signal_stack, .ss_size = sizeof signal_stack};
    sigaltstack(&stack, NULL);
    for (int i = 0; i < SIGNALS; i++) {
        sigaction(signals[i], NULL, &before[i]);

        // a fatal signal that is ignored stays ignored, and so does ^Z of a shell without
        // jobs; the other polite ones are caught anyway
        const bool is_ignored = before[i].sa_handler == SIG_IGN;
        const bool may_stay_ignored = i >= POLITE_SIGNALS || signals[i] == SIGTSTP;
        if (is_ignored && may_stay_ignored) {
            continue;
        }
        if (i < POLITE_SIGNALS) {
            sigaction(signals[i], &polite, NULL);
        } else {
            sigaction(signals[i], &fatal, NULL);
        }
    }
}

// Lets signals do what they did before take_signals.
static void give_signals_back(void)
{
    for (int i = 0; i < SIGNALS; i++) {
        sigaction(signals[i], &before[i], NULL);
    }
    stack_t none = {.ss_flags = SS_DISABLE};
    sigaltstack(&none, NULL);
}

// --- opening and closing ---------------------------------------------------------------

// Whether tigetstr has found a text: NULL and -1 are two ways of "no".
static bool is_capability(const char *text)
{
    return text != NULL && text != (const char *)-1;
}

bool terminal_usable(fault *f)
{
    if (!isatty(STDIN_FILENO) || !isatty(STDOUT_FILENO)) {
        fault_set(f, STATUS_BAD_ARGUMENT,
                  "the lab needs a terminal for its input and its output "
                  "(--size 120x40 --keys '...' prints a screen without)");
        return false;
    }

    // one that is known and can place its cursor
    const char *name = getenv("TERM"), *reason = "which is not known";
    bool usable = false;
    int code;
    if (name == NULL) {
        name = "";
    }
    if (name[0] != '\0' && setupterm(name, STDOUT_FILENO, &code) == OK) {
        usable = is_capability(tigetstr("cup"));
        reason = "which cannot place its cursor";
        del_curterm(cur_term);
    }
    if (!usable) {
        fault_set(f, STATUS_BAD_ARGUMENT,
                  "TERM is '%s', %s; the lab needs a terminal that can place its "
                  "cursor: TERM=xterm-256color suits most (TERM=xterm-256color "
                  "impactlab)",
                  name, reason);
    }
    return usable;
}

void terminal_prepare_crash(const char *text)
{
    if (!is_capability(text)) {
        return;
    }
    for (; *text != '\0'; text++) {
        // padding, "$<5>", is left out
        const char *padding_end = NULL;
        if (text[0] == '$' && text[1] == '<') {
            padding_end = strchr(text, '>');
        }
        if (padding_end != NULL) {
            text = padding_end;
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

// Whether what shows the terminal passes strings on or prints them, as multiplexers and
// old consoles do.
static bool is_multiplexer_or_console(void)
{
    const char *name = getenv("TERM");
    return getenv("TMUX") != NULL || getenv("STY") != NULL || name == NULL ||
           strncmp(name, "screen", 6) == 0 || strncmp(name, "tmux", 4) == 0 ||
           strcmp(name, "linux") == 0;
}

// Asks whether the terminal draws pictures; what it answers comes with the keys.
static void ask_for_pixels(void)
{
    const char *question = pixel_answers_begin(&tty.pixels, is_multiplexer_or_console());
    tty.sequence.awaits_answers = true;
    terminal_send(question, strlen(question));
}

void terminal_bracket_pastes(bool on)
{
    static const char marked[] = "\033[?2004h", unmarked[] = "\033[?2004l";

    // a console that does not know it may print it
    const char *name = getenv("TERM");
    if (name == NULL || strcmp(name, "linux") == 0) {
        return;
    }
    if (on) {
        terminal_send(marked, strlen(marked));
    } else {
        terminal_send(unmarked, strlen(unmarked));
    }
}

// What a crash sends to give the terminal back.
static void prepare_crashes(void)
{
    tty.restore_length = 0;
    terminal_prepare_crash("\033\\"); // ends a picture that is cut off
    terminal_prepare_crash(tigetstr("rmkx"));
    terminal_prepare_crash("\033[?1000l\033[?1002l\033[?1006l\033[?2004l\033[?2026l");
    terminal_prepare_crash(tigetstr("sgr0"));
    terminal_prepare_crash(tigetstr("cnorm"));
    terminal_prepare_crash(tigetstr("rmcup"));
}

// Sets how ncurses reads: keys one by one and unseen, no waiting.
static void set_up_input(void)
{
    cbreak();
    noecho();
    nonl();
    keypad(stdscr, TRUE);
    define_common_keys();

    // we read mouse reports ourselves, where the terminal has any
    tty.has_mouse = is_capability(tigetstr("kmous"));
    keyok(KEY_MOUSE, FALSE);
    tty.sequence.state = SEQUENCE_NONE;
    tty.pasting = false;

    // terminal_wait does the waiting
    nodelay(stdscr, TRUE);
    set_escdelay(25);
    typeahead(-1);
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
    prepare_crashes();
    set_up_input();
    curs_set(0);

    // colours and pictures, if there are any
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
    if (tty.wake[0] >= 0) {
        close(tty.wake[0]);
        close(tty.wake[1]);
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
    *width = COLS > 0 ? COLS : 1;
    *height = LINES > 0 ? LINES : 1;
}

void terminal_mouse(bool on)
{
    // presses, drags, and coordinates in decimals
    static const char reports_on[] = "\033[?1000h\033[?1002h\033[?1006h";
    static const char reports_off[] = "\033[?1006l\033[?1002l\033[?1000l";
    if (on == tty.mouse || !tty.has_mouse) {
        return;
    }

    // ncurses has to wait for the end of a report that it has begun to read, so it is not
    // asked
    const char *reports = on ? reports_on : reports_off;
    ssize_t ignored = write(STDOUT_FILENO, reports, strlen(reports));
    (void)ignored;
    tty.mouse = on;
}
