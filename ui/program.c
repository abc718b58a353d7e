// impactlab on the command line: finds the command and executes it.

#include <errno.h>
#include <fcntl.h>
#include <locale.h>
#include <signal.h>
#include <string.h>
#include <unistd.h>

#include "render/page/text.h"
#include "src/base/text_stream.h"
#include "src/base/whole_file.h"
#include "src/base/shipped.h"
#include "ui/command_table.h"
#include "ui/commands/arguments.h"
#include "ui/commands/help_pages.h"
#include "ui/commands/results.h"
#include "ui/terminal/terminal.h"

// Without a command: what there is to run, and how.
static int print_welcome(void)
{
    const command *list = command_find(&command_table, "list");
    const arguments none = {.command = list, .commands = &command_table};
    printf(
        "impactlab %s: impact and force control of a flexible robot arm\n\nScenarios:\n",
        lab_version());
    int result = list->run(&none);
    printf("\nRun one:        impactlab run SCENARIO\n"
           "Its parameters: impactlab show SCENARIO\n"
           "All commands:   impactlab --help\n");
    return result;
}

// Whether a word is "--NAME" or "--NAME=VALUE".
static bool is_option_named(const char *word, const char *name)
{
    if (name == NULL || strncmp(word, "--", 2) != 0) {
        return false;
    }
    const char *rest = word + 2;
    const size_t length = strlen(name);
    return strncmp(rest, name, length) == 0 &&
           (rest[length] == '\0' || rest[length] == '=');
}

// The lab's own options may stand without a command.
static bool is_lab_option(const char *word)
{
    const option_row *o;
    for (int i = 0; (o = command_option(&lab_command, i)) != NULL; i++) {
        const bool named =
            is_option_named(word, o->name) || is_option_named(word, o->alias);
        if (named && o != help_options.rows) {
            return true;
        }
    }
    return false;
}

// Reads what follows the command's name argv[0] and runs it. Returns the exit status.
static int call_command(const command *c, int argc, char **argv)
{
    arguments a = {.command = c, .commands = &command_table};
    int result;
    if (!arguments_read(&a, argc, argv, &result)) {
        if (result == EXIT_DONE) {
            print_help(stdout, c);
        }
        return result;
    }

    // nothing is computed whose results could not be written
    result = check_results(&a);
    if (result == EXIT_DONE) {
        result = command_run(&a);
    }
    arguments_finish(&a);
    return result;
}

// Without arguments it is the lab, or a welcome where there is no terminal.
static int run_without_arguments(void)
{
    fault f = {0};
    char *lab[] = {"lab", NULL};
    if (terminal_usable(&f)) {
        return call_command(&lab_command, 1, lab);
    }
    return print_welcome();
}

// A fault_handler for faults that are told elsewhere.
static void ignore_fault(void *context, const char *sentence)
{
    (void)context;
    (void)sentence;
}

// Whether a word that is no command is a scenario: written as a path, or the name of one
// without faults.
static bool names_scenario(const char *word)
{
    scenario s;
    if (strpbrk(word, "/.") != NULL) {
        return true;
    }
    if (scenario_open(&s, word, ignore_fault, NULL) != STATUS_OK) {
        return false;
    }
    scenario_finish(&s);
    return true;
}

// Runs the command that argv asks for. Returns the exit status.
static int dispatch(int argc, char **argv)
{
    if (argc < 2) {
        return run_without_arguments();
    }
    const char *word = argv[1];
    if (is_lab_option(word)) {
        return call_command(&lab_command, argc, argv);
    }

    // what is asked of the program as a whole
    if (strcmp(word, "--version") == 0) {
        printf("impactlab %s\n", lab_version());
        return EXIT_DONE;
    }
    if (strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0) {
        print_commands(stdout, &command_table);
        return EXIT_DONE;
    }

    // a command by its name
    const command *found = command_find(&command_table, word);
    if (found != NULL) {
        return call_command(found, argc - 1, argv + 1);
    }

    // the lab on a scenario
    if (names_scenario(word)) {
        return call_command(&lab_command, argc, argv);
    }
    return complain_command(&command_table, word);
}

// What was printed must be whole and have arrived, unless its reader went away first
// (impactlab list | head).
static int close_output(int result)
{
    int reason = stream_failure(stdout);
    if (loss_noted()) {
        reason = ENOMEM;
    }
    if (reason == 0 || reason == EPIPE || result != EXIT_DONE) {
        return result;
    }
    complain("the standard output cannot be written: %s", strerror(reason));
    return EXIT_FAILED;
}

// A signal that ends the program leaves no half-written file behind.
static void end_cleanly(int number)
{
    whole_file_remove_unfinished();
    signal(number, SIG_DFL);
    raise(number);
}

// GLib found no memory, or Pango no font: our sentence, no half-written
// file, no signal.
static void end_without_memory(const char *reason)
{
    whole_file_remove_unfinished();
    terminal_give_back();
    complain("the program has to end: %s", reason);
    _exit(EXIT_FAILED);
}

// A crash: no half-written file, and a sentence.
static void end_crashed(int number)
{
    static const char sentence[] =
        "impactlab: crashed, for want of memory in a library or by a "
        "fault of its own; no half-written file is left\n";
    const ssize_t ignored = write(STDERR_FILENO, sentence, sizeof sentence - 1);
    (void)ignored;
    end_cleanly(number);
}

// Ends the program by `handler` unless the signal is ignored, as nohup and shells'
// background jobs ask for, or a sanitizer or a debugger has a handler of its own.
static void catch_ending(int number, void (*handler)(int))
{
    struct sigaction before;
    const struct sigaction wanted = {.sa_handler = handler};
    if (sigaction(number, NULL, &before) == 0 && before.sa_handler == SIG_DFL) {
        sigaction(number, &wanted, NULL);
    }
}

// Catches crashes and the signals that ask to end.
static void catch_endings(void)
{
    static const int crashes[] = {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGTRAP};
    static const int endings[] = {SIGINT, SIGTERM, SIGHUP};
    for (size_t i = 0; i < sizeof crashes / sizeof crashes[0]; i++) {
        catch_ending(crashes[i], end_crashed);
    }
    for (size_t i = 0; i < sizeof endings / sizeof endings[0]; i++) {
        catch_ending(endings[i], end_cleanly);
    }
}

// Standard descriptors that whoever started the program left closed become /dev/null, or
// else the first file opened would take their number and what is printed would end in it.
static bool open_missing_descriptors(void)
{
    int opened;
    do {
        opened = open("/dev/null", O_RDWR);
    } while (opened >= 0 && opened <= STDERR_FILENO);
    return opened >= 0 && close(opened) == 0;
}

int program_run(int argc, char **argv)
{
    if (!open_missing_descriptors()) {
        complain("/dev/null cannot be opened: %s", strerror(errno));
        return EXIT_FAILED;
    }

    // numbers keep their decimal point: only the character set follows the locale
    setlocale(LC_CTYPE, "");

    // a write that fails is reported where it is made, not by a signal
    signal(SIGPIPE, SIG_IGN);
    signal(SIGXFSZ, SIG_IGN);

    // however it ends, no half-written file is left
    catch_endings();
    text_when_giving_up(end_without_memory);
    return close_output(dispatch(argc, argv));
}
