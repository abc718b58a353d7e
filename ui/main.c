// impactlab on the command line: finds the command and hands over to it.
#include "ui/commands/command.h"

#include <errno.h>
#include <locale.h>
#include <signal.h>
#include <string.h>

#include "src/base/whole_file.h"
#include "src/base/words.h"
#include "src/base/version.h"
#include "ui/terminal/terminal.h"

static const command *const command_table[] = {
    &lab_command,    &list_command,      &show_command,    &check_command,    &run_command,
    &tables_command, &figures_command,   &animate_command, &predict_command,  &modes_command,
    &sweep_command,  &compare_command,   &bench_command,   &converge_command, &study_command,
    &report_command, &calibrate_command,
};
enum { COMMANDS = sizeof command_table / sizeof command_table[0] };

static void print_commands(void)
{
    printf("impactlab %s: impact and force control of a flexible robot arm\n\n"
           "usage: impactlab COMMAND [ARGUMENT]...\n\nCommands:\n",
           lab_version());
    for (int i = 0; i < COMMANDS; i++) {
        printf("  %-9s  %s\n", command_table[i]->name, command_table[i]->summary);
    }
    printf("\nimpactlab COMMAND --help tells more about a command.\n"
           "Exit status: 0 done; 1 the run failed or a file could not be written; 2 bad arguments "
           "or a bad\nscenario.\n");
}

// Without a command: what there is to run, and how.
static int print_welcome(void)
{
    const arguments none = {0};
    printf("impactlab %s: impact and force control of a flexible robot arm\n\nScenarios:\n",
           lab_version());
    int result = list_command.run(&none);
    printf("\nRun one:        impactlab run SCENARIO\n"
           "Its parameters: impactlab show SCENARIO\n"
           "All commands:   impactlab --help\n");
    return result;
}

static int complain_command(const char *name)
{
    nearest_word near = nearest_begin(name);
    for (int i = 0; i < COMMANDS; i++) {
        nearest_try(&near, command_table[i]->name);
    }
    if (near.best != NULL) {
        return complain("there is no command '%s', did you mean '%s'?", name, near.best);
    }
    char known[256] = "";
    size_t length = 0;
    for (int i = 0; i < COMMANDS && length < sizeof known; i++) {
        length += (size_t)snprintf(known + length, sizeof known - length, "%s%s", i ? ", " : "",
                                   command_table[i]->name);
    }
    return complain("there is no command '%s', only %s", name, known);
}

static const command *find_command(const char *name)
{
    for (int i = 0; i < COMMANDS; i++) {
        if (strcmp(command_table[i]->name, name) == 0) {
            return command_table[i];
        }
    }
    return NULL;
}

// --keys, --script and --size may stand without a command.
static bool is_lab_option(const char *word)
{
    static const char *const options[] = {"--keys", "--script", "--size"};
    for (int i = 0; i < 3; i++) {
        size_t length = strlen(options[i]);
        if (strncmp(word, options[i], length) == 0 && strchr("=", word[length]) != NULL) {
            return true;
        }
    }
    return false;
}

// Runs the command that argv asks for. Returns the exit status.
static int dispatch(int argc, char **argv)
{
    int result;
    arguments a;
    fault f = {0};
    const char *word = argc > 1 ? argv[1] : NULL;
    if (word == NULL && !terminal_usable(&f)) {
        return print_welcome();
    }
    // without a command, or with options of its own, it is the lab
    if (word == NULL || is_lab_option(word)) {
        char *call[] = {"lab", NULL};
        char **own = word == NULL ? call : argv;
        if (!arguments_read(&a, &lab_command, word == NULL ? 1 : argc, own, &result)) {
            return result;
        }
        result = lab_command.run(&a);
        arguments_finish(&a);
        return result;
    }
    if (strcmp(word, "--version") == 0) {
        printf("impactlab %s\n", lab_version());
        return EXIT_DONE;
    }
    bool help = strcmp(word, "help") == 0;
    if ((help && argc == 2) || strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0) {
        print_commands();
        return EXIT_DONE;
    }
    const command *found = find_command(help ? argv[2] : word);
    if (found == NULL) {
        return complain_command(help ? argv[2] : word);
    }
    if (help) {
        print_help(found);
        return EXIT_DONE;
    }
    if (!arguments_read(&a, found, argc - 1, argv + 1, &result)) {
        return result;
    }
    result = found->run(&a);
    arguments_finish(&a);
    return result;
}

// What was printed must have arrived, unless its reader went away first (impactlab list | head).
static int close_output(int result)
{
    int reason = stream_failure(stdout);
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

static void catch_endings(void)
{
    static const int endings[] = {SIGINT, SIGTERM, SIGHUP};
    for (size_t i = 0; i < sizeof endings / sizeof endings[0]; i++) {
        struct sigaction before;
        struct sigaction wanted = {.sa_handler = end_cleanly};
        // nohup and shells' background jobs ask for a signal to be ignored
        if (sigaction(endings[i], NULL, &before) == 0 && before.sa_handler != SIG_IGN) {
            sigaction(endings[i], &wanted, NULL);
        }
    }
}

int main(int argc, char **argv)
{
    // numbers keep their decimal point: only the character set follows the locale
    setlocale(LC_CTYPE, "");
    // a write that fails is reported where it is made, not by a signal
    signal(SIGPIPE, SIG_IGN);
    signal(SIGXFSZ, SIG_IGN);
    catch_endings();
    return close_output(dispatch(argc, argv));
}
