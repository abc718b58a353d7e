// impactlab list: name and title of every scenario.
#include "ui/commands/scenario_listing.h"

#include <string.h>

#include "src/base/json.h"

// The length of the longest name.
static int longest_name(const scenario_listing *l)
{
    int longest = 0;
    for (int i = 0; i < l->count; i++) {
        const int length = (int)strlen(l->names[i]);
        if (length > longest) {
            longest = length;
        }
    }
    return longest;
}

// Prints a scenario's line, its title behind a name of `width` characters, or adds an
// object for --json, in which the title of a scenario with faults is null. Returns the
// exit status.
static int list_scenario(scenario_listing *l, const char *name, int width)
{
    scenario_heading heading;
    const int result = scenario_heading_read(name, &heading);
    if (result != EXIT_DONE) {
        return result;
    }

    // an object, a complaint or a line
    if (l->entries != NULL) {
        json_t *title;
        if (heading.faulty) {
            title = json_null();
        } else {
            title = json_text(heading.title);
        }
        json_add(l->entries, json_of("name:t title:o", name, title));
    } else if (heading.faulty) {
        say("%-*s  (has faults, see impactlab check %s)\n", width, name, name);
    } else {
        say("%-*s  %s\n", width, name, heading.title);
    }
    return EXIT_DONE;
}

// The command: all scenarios, whose titles stand in one column.
static int list_scenarios(const arguments *a)
{
    scenario_listing l;
    int result = scenario_listing_open(&l, a);
    if (result != EXIT_DONE) {
        return result;
    }

    const int width = longest_name(&l);
    for (int i = 0; i < l.count; i++) {
        if (a->quiet && l.entries == NULL) {
            say("%s\n", l.names[i]);
        } else {
            result = worse(result, list_scenario(&l, l.names[i], width));
        }
    }
    return scenario_listing_close(&l, a, result);
}

static const option_row rows[] = {
    OPTION(FLAG, "quiet", NULL, "print the names alone", PLACE(quiet), .letter = 'q'),
};

const command list_command = {
    .name = "list",
    .group = GROUP_ONE_RUN,
    .summary = "Name and title of every scenario",
    .operands = "",
    .help = "",
    .options = {&json_options, OWN_OPTIONS(rows)},
    .run = list_scenarios,
};
