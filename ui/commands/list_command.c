// The commands that look at scenarios: list, lesson, show, check.
#include "ui/commands/command.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "src/base/json.h"
#include "src/base/numbers.h"
#include "src/base/words.h"
#include "src/rig/controller_values.h"
#include "src/rig/rig.h"
#include "src/run/export.h"
#include "src/scenario/effect.h"
#include "src/tables/settings.h"
#include "src/tables/summary.h"

// --- list ------------------------------------------------------------------------------

// The names of all scenarios, and what --json writes of them.
typedef struct listing {
    char **names;
    int count;
    json_t *all; // NULL: they are listed on the screen
} listing;

// Returns the exit status.
static int open_listing(listing *l, const arguments *a)
{
    fault f = {0};
    status code = STATUS_OK;
    *l = (listing){0};
    if (a->json != NULL) {
        l->all = json_array();
        if (l->all == NULL) {
            code = fault_no_memory(&f);
        }
    }
    if (code == STATUS_OK) {
        code = scenario_list(&l->names, &l->count, &f);
    }
    if (code != STATUS_OK) {
        json_decref(l->all);
        return complain_fault(&f);
    }
    return EXIT_DONE;
}

// Writes what --json asks for. Returns the exit status, `result` if that is worse.
static int close_listing(listing *l, const arguments *a, int result)
{
    for (int i = 0; i < l->count; i++) {
        free(l->names[i]);
    }
    free(l->names);
    if (a->json != NULL) {
        return worse(result, write_json(a->json, l->all));
    }
    return result;
}

// What a list says of a scenario.
typedef struct listed {
    bool faulty; // it has faults, which are reported when it is opened, and no title
    bool is_lesson;
    char title[SCENARIO_TITLE + 1];
} listed;

// Keeps the last of several.
static void keep_fault(void *context, const char *sentence)
{
    fault_set(context, STATUS_OK, "%s", sentence);
}

// Reads what a list says of a scenario. Returns the exit status if it could not be read.
static int read_listed(const char *name, listed *l)
{
    scenario s;
    fault f = {0};
    f.code = scenario_open(&s, name, keep_fault, &f);
    *l = (listed){.faulty = f.code != STATUS_OK};
    if (!l->faulty) {
        l->is_lesson = s.lesson.step_count > 0;
        snprintf(l->title, sizeof l->title, "%s", s.title != NULL ? s.title : "");
        scenario_finish(&s);
    }
    if (!(!l->faulty || f.code == STATUS_BAD_SCENARIO)) {
        return complain_fault(&f);
    }
    return EXIT_DONE;
}

// A line of each or, for a program, an object of name and title, which is null of one
// with faults.
static int list(const arguments *a)
{
    listing l;
    int width = 0, result = EXIT_DONE;
    int ended = open_listing(&l, a);
    if (ended != EXIT_DONE) {
        return ended;
    }

    // the titles of all stand in a column
    for (int i = 0; i < l.count; i++) {
        const int length = (int)strlen(l.names[i]);
        if (length > width) {
            width = length;
        }
    }
    for (int i = 0; i < l.count; i++) {
        const char *name = l.names[i];
        listed here;
        const int read = read_listed(name, &here);
        result = worse(result, read);
        if (read == EXIT_DONE && l.all != NULL) {
            json_add(l.all, json_of("name:t title:o", name,
                                    here.faulty ? json_null() : json_text(here.title)));
        } else if (read == EXIT_DONE && here.faulty) {
            say("%-*s  (has faults, see impactlab check %s)\n", width, name, name);
        } else if (read == EXIT_DONE) {
            say("%-*s  %s\n", width, name, here.title);
        }
    }
    return close_listing(&l, a, result);
}

const command list_command = {
    CALLED("list", ONE_RUN, "Name and title of every scenario"),
    NO_OPERANDS,
    .help = "",
    .options = {&json_options},
    .run = list,
};

// --- lesson ----------------------------------------------------------------------------

static int run_lesson(const arguments *a)
{
    listing l;
    bool found = false;
    if (a->json != NULL && a->operand_count > 0) {
        return complain("--json lists the lessons, expected no name beside it");
    }
    int code = EXIT_DONE;
    int ended = open_listing(&l, a);
    if (ended != EXIT_DONE) {
        return ended;
    }

    // without a name all of them, otherwise the one with that name
    const char *wanted = a->operand_count > 0 ? a->operands[0] : NULL;
    for (int i = 0; i < l.count && !found; i++) {
        const char *name = l.names[i], *slash = strrchr(name, '/');
        const char *leaf = slash != NULL ? slash + 1 : name;
        listed here = {0};
        if (wanted == NULL || strcmp(name, wanted) == 0 || strcmp(leaf, wanted) == 0) {
            code = worse(code, read_listed(name, &here));
        }
        found = here.is_lesson && wanted != NULL;
        if (found) {
            // as the lab command opens a scenario
            arguments opened = *a;
            opened.operands = &l.names[i];
            opened.operand_count = 1;
            code = command_find(a->commands, "lab")->run(&opened);
        } else if (here.is_lesson && l.all != NULL) {
            json_add(l.all, json_of("name:t scenario:t title:t", leaf, name, here.title));
        } else if (here.is_lesson) {
            say("%-20s %s\n", leaf, here.title);
        }
    }
    if (wanted != NULL && !found && code == EXIT_DONE) {
        code = complain("there is no lesson '%s', 'impactlab lesson' lists them", wanted);
    }
    return close_listing(&l, a, code);
}

const command lesson_command = {
    CALLED("lesson", ONE_RUN, "Experiments step by step, on the terminal"),
    OPERANDS("[NAME]", 0, 1),
    .help = "Opens a lesson in the lab: steps with questions, checked by the run "
            "itself. Without a name it lists them.\nIn the lab y goes on and A "
            "answers; :lesson lists the lessons there.\n",
    .options = {&set_options, &json_options, &lab_options, &quiet_options},
    .run = run_lesson,
};

// --- show ------------------------------------------------------------------------------

// Each number of control.settings under its path: where the law is known with its unit
// and range.
static void print_settings(const scenario *s)
{
    const controller *law = controller_of(s->parameters.control.law);
    for (int i = 0; law != NULL && i < law->parameter_count; i++) {
        // one that is a parameter of its own stands in the table
        const controller_parameter c = controller_parameter_at(law, i);
        char path[PARAMETER_TEXT_SIZE], value[NUMBER_TEXT], range[64];
        double given;
        const bool is_given = settings_get(&s->parameters, c.name, &given);
        snprintf(path, sizeof path, "control.%s", c.name);
        if (!is_given && parameter_find(path) >= 0) {
            continue;
        }
        snprintf(path, sizeof path, "control.settings.%s", c.name);
        number_format_short(value, is_given ? given : c.initial);
        snprintf(range, sizeof range, "%g to %g", c.minimum, c.maximum);
        say("%-33s %c %18s %-9s  %-29s  %s\n", path, is_given ? '=' : ' ', value, c.unit,
            range, c.description);
    }

    // of a controller that is loaded when the run starts what was given
    const char *rest = law == NULL ? s->parameters.control.settings : "";
    setting given;
    while (settings_next(&rest, &given)) {
        char path[2 * PARAMETER_TEXT_SIZE];
        snprintf(path, sizeof path, "control.settings.%s", given.name);
        say("%-33s = %18s %-9s  %-29s  %s\n", path, given.value, "", "",
            setting_info.description);
    }
}

static void print_actions(const scenario *s)
{
    for (int i = 0; i < s->action_count; i++) {
        const action *a = &s->actions[i];
        if (a->kind == ACTION_PUSH) {
            printf("  at %g s: push the tip with %g N s\n", a->time, a->value);
        } else {
            char value[128], path[ACTION_PATH];
            action_format_value(a, value, sizeof value);
            say("  at %g s: %s = %s\n", a->time, action_path(a, path), value);
        }
    }
}

static void print_expectations(const scenario *s)
{
    for (int i = 0; i < s->expectation_count; i++) {
        const expectation *e = &s->expectations[i];
        if (e->is_null) {
            printf("  %s does not occur\n", summary_table[e->quantity].key);
        } else {
            printf("  %s = %g within %g\n", summary_table[e->quantity].key, e->value,
                   e->tolerance);
        }
    }
}

// The same for a program: values by path, and which of them were given.
static json_t *show_object(const scenario *s)
{
    json_t *given = json_array();
    char title[SCENARIO_TITLED];

    // defaults are not named
    for (int i = 0; i < parameter_count; i++) {
        if (s->parameters.set[i]) {
            json_add(given, json_string(parameter_table[i].path));
        }
    }

    // what describes it, and all values whether given or not
    return json_of("scenario:t title:t description:t parameters:o given:o", s->name,
                   scenario_titled(s, title), s->description,
                   export_parameters(&s->parameters), given);
}

static int print_scenario(const arguments *a, scenario *s)
{
    if (a->json != NULL) {
        return write_json(a->json, show_object(s));
    }
    say_title(s);
    print_indented(stdout, s->description, (int)strlen(s->description), 96, 0);

    printf("\n= was given, all else is a default\n\n%-33s   %12s %-9s  %-18s\n",
           "parameter", "value", "unit", "range");
    for (int i = 0; i < parameter_count; i++) {
        const parameter_info *info = &parameter_table[i];
        char value[128], range[RANGE_TEXT];
        parameter_format(&s->parameters, i, value, sizeof value);
        say("%-33s %c %18s %-9s  %-29s  %s\n", info->path,
            s->parameters.set[i] ? '=' : ' ', value, info->unit,
            format_range(info, "|", range), info->description);
        if (i == PARAMETER_INDEX(control.settings)) {
            print_settings(s);
        }
    }

    if (s->action_count > 0) {
        printf("\nScript:\n");
        print_actions(s);
    }

    if (s->expectation_count > 0) {
        printf("\nExpected:\n");
        print_expectations(s);
    }

    return EXIT_DONE;
}

static int show(const arguments *a)
{
    const int result = with_scenario(a->operands[0], a, print_scenario);

    // "show k2" asks for something that has no file
    if (result == EXIT_BAD_ARGUMENTS && strpbrk(a->operands[0], "/ ") == NULL) {
        print_meanings(stderr, a->commands, a->operands[0]);
    }
    return result;
}

const command show_command = {
    CALLED("show", ONE_RUN,
           "The resolved parameters of a scenario, with units and ranges"),
    ONE_SCENARIO,
    .help = "A parameter marked with = was given by the scenario or by --set, "
            "the others have their defaults.\n",
    .options = {&set_options, &json_options},
    .run = show,
};

// --- check -----------------------------------------------------------------------------

// What came of the files so far.
typedef struct checking {
    json_t *files;  // an object each
    json_t *faults; // the sentences of the present file
    opening_faults opening;
} checking;

// Tells and keeps a fault.
static void take_fault(void *context, const char *sentence)
{
    checking *c = context;
    report_opening_fault(&c->opening, sentence);
    json_add(c->faults, json_text(sentence));
}

// Warns of what a file gives without effect.
static void warn_of_idle(const scenario *s, const char *file)
{
    idle_value idle;
    for (int place = 0; effect_next_idle(s, &place, &idle);) {
        print_printable(stderr, "%s:%d: warning: %s has no effect: %s\n", file, idle.line,
                        idle.path, idle.why);
    }
}

// Reads one file (or a scenario by its name). Returns the exit status.
static int check_one(const char *file, const arguments *a, checking *c)
{
    scenario s;
    int result = EXIT_DONE;
    c->opening = (opening_faults){0};
    c->faults = json_array();

    // a file under test, or the name of a scenario
    status code;
    if (access(file, F_OK) == 0) {
        code = scenario_read(&s, file, NULL, take_fault, c);
    } else {
        code = scenario_open(&s, file, take_fault, c);
    }
    json_t *idle = json_array();
    if (code == STATUS_OK) {
        warn_of_idle(&s, file);
        json_decref(idle);
        idle = export_without_effect(&s);
        scenario_finish(&s);
        report_first_fault(&c->opening);
        if (summary_wanted(a)) {
            say("%s: no fault\n", file);
        }
    } else {
        if (c->opening.count == 0) {
            json_add(c->faults, json_text(status_text(code)));
        }
        result = report_unopened(&c->opening, code, file);
    }

    json_add(c->files,
             json_of("file:t faults:o without_effect:o", file, c->faults, idle));
    return result;
}

static int check(const arguments *a)
{
    checking c = {.files = json_array()};
    int result = EXIT_DONE;
    for (int i = 0; i < a->operand_count; i++) {
        result = worse(result, check_one(a->operands[i], a, &c));
    }
    if (a->json != NULL) {
        return worse(result, write_json(a->json, c.files));
    }
    json_decref(c.files);
    return result;
}

const command check_command = {
    CALLED("check", ONE_RUN, "Validate scenario files"),
    SCENARIOS("FILE...", 1, 1 << 20),
    .help = "Every fault is printed as FILE:LINE:COLUMN: what is wrong and what "
            "was expected. A value that has\nno effect is warned of by "
            "FILE:LINE, and is no fault (exit status 0).\n",
    .options = {&json_options},
    .run = check,
};
