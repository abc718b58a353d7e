// impactlab predict: what methods predict of a contact before it is simulated.
#include "ui/commands/command.h"

#include <math.h>
#include <stdio.h>

#include "src/base/json.h"
#include "src/base/numbers.h"
#include "src/run/export.h"
#include "src/run/run.h"
#include "ui/commands/command_pictures.h"
#include "ui/commands/progress.h"

// Commands of --then.
enum { MOST_COMMANDS = 64 };
typedef struct voltage_commands {
    double times[MOST_COMMANDS], volts[MOST_COMMANDS];
    int count;
} voltage_commands;

// Whether a command may stand behind those of the list: its time is finite and grows.
static bool is_next_command(const voltage_commands *list, double time, double volts)
{
    if (!isfinite(time) || !isfinite(volts) || time < 0) {
        return false;
    }
    return list->count == 0 || time > list->times[list->count - 1];
}

// Reads "TIME:VOLTS,TIME:VOLTS", times since the touch in seconds, from 0 on and growing;
// NULL: none. Complains and returns false if it is something else.
static bool read_commands(const char *text, voltage_commands *list)
{
    const char *rest = text;
    *list = (voltage_commands){0};
    while (rest != NULL && *rest != '\0') {
        double time, volts;
        const bool is_read = list->count < MOST_COMMANDS &&
                             decimal_read(rest, &time, &rest) && *rest == ':' &&
                             decimal_read(rest + 1, &volts, &rest) &&
                             (*rest == ',' || *rest == '\0');
        if (!is_read || !is_next_command(list, time, volts)) {
            complain("--then %s: expected TIME:VOLTS,... such as 0:2,0.01:-3, at most %d "
                     "of them, times in seconds from the touch on and growing",
                     text, MOST_COMMANDS);
            return false;
        }

        list->times[list->count] = time;
        list->volts[list->count] = volts;
        list->count++;
        if (*rest == ',') {
            rest++;
        }
    }
    return true;
}

// What the predictors say of a run.
typedef struct predicted_contact {
    const scenario *scenario;
    const run_result *result;
    const sample *row; // the last one before the contact
    prediction_answer answers[PREDICTOR_COUNT];
} predicted_contact;

// --- numbers ---------------------------------------------------------------------------

// What all predictors say, beside the simulation.
static json_t *predictions_json(const void *found)
{
    const predicted_contact *p = found;
    return export_predictions(p->scenario, p->result, p->row, p->answers);
}

// The contact, and the instant from which it is predicted.
static void print_contact(const predicted_contact *p)
{
    const double time = p->result->landing.time;
    const char *contact = "first contact after a flight";
    if (time == p->result->summary.first_contact_s) {
        contact = "first contact";
    }
    say_title(p->scenario);
    printf("%s at %.6g s, predicted from the instant before it\n\n", contact, time);

    // the motion just before it
    const sample *row = p->row;
    printf(
        "  last free row at %.6g s: hub, first and last link at %.5g, %.5g, %.5g rad,\n"
        "  turning with %.5g, %.5g, %.5g rad/s\n\n",
        row->time, row->hub_angle, row->first_angle, row->last_angle, row->hub_velocity,
        row->first_velocity, row->last_velocity);
}

static void print_pulse(const char *label, double force, double delay, double impulse)
{
    printf("  %-30s", label);
    print_cell(14, "%.5g", force);
    print_cell(14, "%.5g", 1e3 * delay);
    print_cell(14, "%.5g", impulse);
    printf("\n");
}

// The line of a predictor, or why it has no answer.
static void print_prediction(const prediction_answer *answer)
{
    const prediction *p = &answer->prediction;
    if (answer->outcome == PREDICTION_HOLDS) {
        print_pulse(answer->label, p->force, p->delay, p->impulse);
        return;
    }
    say("  %-30s %s", answer->label, prediction_reason(answer));
    if (!isnan(p->impulse)) {
        say(", its impulse is %.5g N s", p->impulse);
    }
    say("\n");
}

// What the motor's inductance does to the peak.
static void print_inductance(const scenario *s, const prediction *linearised)
{
    const motor_parameters *motor = &s->parameters.motor;
    printf("\n  The current lags by L/R = %.3g ms",
           1e3 * motor->inductance / motor->resistance);
    if (!isnan(linearised->inductance)) {
        const double without = linearised->force - linearised->inductance;
        printf(", which changes the peak by %.3g N (%.2g %%)", linearised->inductance,
               100 * linearised->inductance / without);
    }
    printf(
        ";\n  only the linearised arm follows it, to the others it follows at once.\n");
}

// The contact, what all predictors say of it, and the simulation.
static void print_predictions(const void *found)
{
    const predicted_contact *p = found;
    print_contact(p);

    // the predictors, then what they should have found
    const landing *simulated = &p->result->landing;
    printf("  %-30s %14s %14s %14s\n", "first pulse", "peak [N]", "after [ms]",
           "impulse [N s]");
    for (int i = 0; i < PREDICTOR_COUNT; i++) {
        print_prediction(&p->answers[i]);
    }
    print_pulse("simulation", simulated->peak, simulated->time_to_peak,
                simulated->impulse);

    // what has to be said of them
    const parameters *given = &p->scenario->parameters;
    const prediction *linearised = &p->answers[PREDICTOR_LINEARISED].prediction;
    if (!isnan(linearised->restitution)) {
        printf("\n  Kinetic energy given back by the end of the pulse, of the largest "
               "energy in the\n"
               "  springs (e_eq of 4.1.1): %.4g\n",
               linearised->restitution);
    }
    if (given->motor.inductance > 0) {
        print_inductance(p->scenario, linearised);
    }
    if (given->arm.links != 2) {
        printf("\n  The thesis's predictors know two links, the simulation has %d.\n",
               given->arm.links);
    }
}

// --- the picture -----------------------------------------------------------------------

// The peak that each predictor says, one below the other, with that of the simulation as
// a line.
static int plot_predictions(const arguments *a, const void *found)
{
    const predicted_contact *p = found;

    // a tick for each, but no point where a predictor does not hold; the first one
    // uppermost
    double peak[PREDICTOR_COUNT], place[PREDICTOR_COUNT];
    figure_tick ticks[PREDICTOR_COUNT];
    for (int i = 0; i < PREDICTOR_COUNT; i++) {
        const prediction_answer *answer = &p->answers[i];
        peak[i] = (double)NAN;
        if (answer->outcome == PREDICTION_HOLDS) {
            peak[i] = answer->prediction.force;
        }
        place[i] = PREDICTOR_COUNT - i;
        ticks[PREDICTOR_COUNT - 1 - i] = (figure_tick){place[i], answer->label};
    }

    // the simulation as an upright line past all of them
    const double simulated = p->result->landing.peak;
    const double line_x[2] = {simulated, simulated};
    const double line_y[2] = {0.4, PREDICTOR_COUNT + 0.6};
    figure_series series[] = {
        curve_of("predicted", "predicted", peak, place, PREDICTOR_COUNT, 0),
        curve_of("simulation", "simulation", line_x, line_y, 2, 5),
    };
    series[0].marker = MARKER_CIRCLE;
    series[0].radius = 2.6;
    series[0].no_line = true;
    series[1].style = LINE_DASHED;

    // names instead of numbers next to the rows
    const figure_panel panel = {.y = {.name = "predictor",
                                      .ticks = ticks,
                                      .tick_count = PREDICTOR_COUNT,
                                      .low = line_y[0],
                                      .high = line_y[1]},
                                .series = series,
                                .series_count = 2,
                                .weight = 1.6};

    // zero is on the axis, so that peaks compare by their distance from it
    const figure fig = {.x = {.name = "peak",
                              .label = "Peak force",
                              .unit = "N",
                              .room = 0.06,
                              .with_zero = true},
                        .panels = &panel,
                        .panel_count = 1,
                        .common_legend = true};
    return publish_titled(a, p->scenario,
                          "peak of the first pulse, predicted and simulated", &fig);
}

// --- the command -----------------------------------------------------------------------

// Asks the predictors about a run and writes what they say. Returns the exit status.
static int predict_and_report(const arguments *a, const scenario *s,
                              const run_result *result)
{
    voltage_commands then;
    if (!read_commands(a->then, &then)) {
        return EXIT_BAD_ARGUMENTS;
    }

    // from the last row before the contact
    predicted_contact p = {.scenario = s, .result = result};
    const voltage_profile profile = {then.count, then.times, then.volts};
    p.row = predict_first_contact(s, result, &profile, p.answers);
    if (p.row == NULL) {
        complain(
            "%s has no free flight that ends in a contact, there is nothing to predict",
            s->name);
        return EXIT_FAILED;
    }

    // what there was no memory for is no answer
    for (int i = 0; i < PREDICTOR_COUNT; i++) {
        if (p.answers[i].fault.code == STATUS_NO_MEMORY) {
            return complain_fault(&p.answers[i].fault);
        }
    }

    static const command_results results = {.json = predictions_json,
                                            .text = print_predictions,
                                            .plot = plot_predictions};
    return write_results(a, &results, &p, true);
}

// The command: runs the scenario, and asks the predictors about its contact.
static int run_and_predict(const arguments *a, scenario *s)
{
    run_result simulated;
    int result;

    switch (run_with_progress(a, s, (run_options){.keep_trace = true}, &simulated)) {
    case STATUS_OK:
        result = predict_and_report(a, s, &simulated);
        break;
    case STATUS_STOPPED:
        result = run_stopped(s, "nothing is predicted");
        break;
    default:
        complain("%s failed: %s", s->name, simulated.summary.message);
        result = EXIT_FAILED;
    }
    run_finish(&simulated);
    return result;
}

static const option_row rows[] = {
    PLOT_OPTION("draw the predicted peaks beside the simulated one"),
    OPTION(TEXT, "then", "TIME:VOLTS,...",
           "what if the motor got these commands from the touch on (s, V)", PLACE(then)),
};

const command predict_command = {
    .name = "predict",
    .group = GROUP_ONE_RUN,
    .summary = "Predict the peak force from the instant before contact, beside what then "
               "happens",
    .operands = "SCENARIO",
    .least = 1,
    .most = 1,
    .takes_scenarios = true,
    .help =
        "On a terminal a run of more than a second shows its progress; ^C ends it (exit "
        "status 130), and nothing\n"
        "is predicted.\n",
    .options = {&set_options, &json_options, OWN_OPTIONS(rows), &quiet_options,
                &page_options},
    .use = run_and_predict,
};
