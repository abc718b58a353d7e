// impactlab study: one of several studies of the lab itself.
#include "ui/commands/command.h"

#include <string.h>

#include "ui/commands/studies/study_topics.h"

static const study_topic *const topics[] = {&methods_topic, &links_topic, &follow_topic};
enum { TOPICS = sizeof topics / sizeof topics[0] };

static const char *topic_word(const command_list *all, int i)
{
    (void)all;
    if (i < TOPICS) {
        return topics[i]->name;
    }
    return NULL;
}

// The study of that name, NULL if there is none.
static const study_topic *find_topic(const char *name)
{
    for (int i = 0; i < TOPICS; i++) {
        if (strcmp(topics[i]->name, name) == 0) {
            return topics[i];
        }
    }
    return NULL;
}

// The command: makes the study that the first operand names, of the second or of its own
// scenario.
static int make_study(const arguments *a)
{
    const study_topic *topic = find_topic(a->operands[0]);
    if (topic == NULL) {
        return complain("there is no study '%s', expected methods, links or follow",
                        a->operands[0]);
    }
    const char *name = topic->scenario;
    if (a->operand_count > 1) {
        name = a->operands[1];
    }
    return with_scenario(name, a, topic->make);
}

const command study_command = {
    .name = "study",
    .group = GROUP_MANY_RUNS,
    .summary = "Error against cost; links against a beam; laws over frequency",
    .operands = "methods|links|follow [SCENARIO]",
    .least = 1,
    .most = 2,
    .takes_scenarios = true,
    .help = "methods: the scenario (corrected/first-impact) by every method of time "
            "integration at steps from 1e-2 down to 1e-6 s, with the error of first "
            "contact, first pulse's peak and steady force. links: the scenario "
            "(corrected/damped-beam) with 2 to 64 links: its blow and what a first-order "
            "sensor of 0.5, 1 or 2 ms reads of it, frequencies, statics; Richardson's "
            "limit and the Euler-Bernoulli beam, and how many links are enough for which "
            "question. follow: the scenario (compare/observer) under six laws with a "
            "set-point and a wall that swing, from 0.2 to 25 Hz: error and phase of the "
            "force, beside what delay and arm allow. See docs/explanation/methods.md and "
            "docs/explanation/trust.md. ^C ends any of them with what it has until then "
            "(exit status 130).\n",
    .operand_word = topic_word,
    .options = {&set_options, &json_options, &drawn_options, &quiet_options,
                &page_options},
    .run = make_study,
};
