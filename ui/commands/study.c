#include "ui/commands/study_topics.h"

#include <assert.h>
#include <stdio.h>

#include <string.h>

#include "src/base/shipped.h"

int publish_study(const arguments *a, figure *fig)
{
    assert(a != NULL && fig != NULL);
    char software[64];
    snprintf(software, sizeof software, "impactlab %s", lab_version());
    fig->x.scale = SCALE_LOGARITHMIC;
    fig->x.room = 0.04;
    fig->columns = fig->panel_count;
    fig->common_legend = true;
    fig->software = software;
    return publish_figure(a, fig);
}

typedef struct topic {
    const char *name, *scenario; // the scenario if none is given
    int (*study)(const arguments *a, scenario *s);
} topic;

static const topic topics[] = {
    {"methods", "corrected/first-impact", study_of_methods},
    {"sensor", "corrected/plane-wall-fast", study_of_sensor},
};
enum { TOPICS = sizeof topics / sizeof topics[0] };

static const topic *find_topic(const char *name)
{
    for (int i = 0; i < TOPICS; i++) {
        if (strcmp(topics[i].name, name) == 0) {
            return &topics[i];
        }
    }
    return NULL;
}

static const char *topic_word(int i)
{
    return i < TOPICS ? topics[i].name : NULL;
}

static int study(const arguments *a)
{
    const topic *t = find_topic(a->operands[0]);
    if (t == NULL) {
        return complain("there is no study '%s', expected methods or sensor", a->operands[0]);
    }
    return with_scenario(a->operand_count > 1 ? a->operands[1] : t->scenario, a, t->study);
}

const command study_command = {
    .name = "study",
    .group = GROUP_MANY_RUNS,
    .operands = "methods|sensor [SCENARIO]",
    .summary = "Error against cost of the methods; what a force sensor would see",
    .help = "methods: the scenario (corrected/first-impact) by every method of time integration at "
            "steps from 1e-2\ndown to 1e-6 s, with the error of first contact, first pulse's peak "
            "and steady force.\nsensor: the scenario (corrected/plane-wall-fast) with 2 to 32 "
            "links; the force itself has no limit,\nwhat a first-order sensor of 0.5, 1 or 2 ms "
            "reads has one. See docs/explanation/methods.md and\ndocs/explanation/trust.md. ^C "
            "ends either "
            "with what it "
            "has until then (exit status 130).\n",
    .least = 1,
    .most = 2,
    .takes_scenarios = true,
    .operand_word = topic_word,
    .options = {&set_options, &json_options, &drawn_options, &quiet_options, &page_options},
    .run = study,
};
