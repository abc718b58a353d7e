// impactlab linear: poles, zeros and margins of the arm near rest, and where its loop is
// stable.
#include "ui/commands/command.h"

#include <glib.h>
#include <string.h>

#include "render/page/picture_path.h"
#include "src/base/whole_file.h"
#include "ui/commands/command_pictures.h"
#include "ui/commands/studies/loop_analysis.h"
#include "ui/commands/studies/loop_survey.h"

// The place of rest that a word of --at names.
static linear_place read_place(const char *word)
{
    if (strcmp(word, "free") == 0) {
        return LINEAR_FREE;
    }
    if (strcmp(word, "contact") == 0) {
        return LINEAR_CONTACT;
    }
    return LINEAR_STUCK;
}

// Whether the numbers of both pictures would stand in one file.
static bool share_numbers(const arguments *a)
{
    g_autofree char *of_plot = picture_beside(a->plot, ".csv");
    g_autofree char *of_nyquist = picture_beside(a->nyquist, ".csv");
    return whole_file_same_place(of_plot, of_nyquist);
}

// Checks which options go together. Returns the exit status.
static int check_linear_options(const arguments *a, const scenario *s, linear_place place)
{
    const bool varies = a->varies.count > 0;
    if (place != LINEAR_FREE && s->parameters.wall.kind == WALL_NONE) {
        return complain("there is no wall to press on, try --at free");
    }

    // what is of one loop
    if (varies && (a->mat != NULL || a->nyquist != NULL || a->injects)) {
        return complain("--mat, --nyquist and --inject are of one loop, not of --vary");
    }
    if (varies && s->parameters.control.law == LAW_NONE) {
        return complain("--vary needs a control law, such as --set control.law=hybrid");
    }

    // what needs a loop
    if ((a->nyquist != NULL || a->injects) && !a->looped) {
        return complain("--nyquist and --inject are of the loop of --law");
    }

    // two pictures
    if (a->plot != NULL && a->nyquist != NULL && (a->latex != NULL || share_numbers(a))) {
        return complain(
            "--plot and --nyquist are two pictures: expected names that differ "
            "in more than their ending, and --latex for one of them");
    }
    return EXIT_DONE;
}

// The command: looks at one loop or, with --vary, at many.
static int linearise_and_report(const arguments *a, scenario *s)
{
    const char *word = "contact";
    if (a->place != NULL) {
        word = a->place;
    }
    const linear_place place = read_place(word);
    const int ended = check_linear_options(a, s, place);
    if (ended != EXIT_DONE) {
        return ended;
    }
    if (a->varies.count > 0) {
        return survey_and_report(a, s, place, word);
    }
    return analyse_and_report(a, s, place, word);
}

static const option_row rows[] = {
    OPTION(CHOICE, "at", "free|contact|stuck",
           "the arm in the air, pressing, or pressing with its hub held by friction "
           "(contact)",
           PLACE(place)),
    OPTION(FLAG, "law", NULL, "in the loop of its law: closed poles and margins",
           PLACE(looped)),
    OPTION(FLAG, "inject", NULL,
           "measure the loop by small sines, as is done for laws that are not linear",
           PLACE(injects)),
    OPTION(RESULT, "csv", "FILE|-", "write poles and zeros, one a row", PLACE(csv)),
    PLOT_OPTION("draw gain and phase, with --vary where the loop is stable"),
    OPTION(PICTURE, "nyquist", "FILE.{png,pdf,svg}", "draw the loop gain in the plane",
           PLACE(nyquist)),
    OPTION(RESULT, "mat", "FILE.mat",
           "write A, B, C, D, poles and zeros for MATLAB or Octave", PLACE(mat)),
};

const command linear_command = {
    .name = "linear",
    .group = GROUP_CONTROL,
    .summary = "Poles, zeros and margins of the arm near rest",
    .operands = "SCENARIO",
    .least = 1,
    .most = 1,
    .takes_scenarios = true,
    .help =
        "Linearises the arm at rest, x' = A x + B u from the command u, with back EMF, "
        "viscous friction and damping.\n"
        "It presses with control.force where a law is to hold it, else under "
        "motor.voltage; Coulomb friction is left out.\n"
        "--law closes the sampled loop of its law; one that does not answer linearly is "
        "measured by small sines.\n"
        "--vary shows where the loop is stable, by its poles and, with friction, by runs "
        "that settle.\n",
    .options = {&set_options, &vary_options, &json_options, OWN_OPTIONS(rows),
                &quiet_options, &page_options},
    .use = linearise_and_report,
};
