// impactlab predict: what methods predict of a contact before it is simulated.
#include "ui/commands/command.h"

#include <math.h>

#include "src/base/json.h"
#include "src/base/numbers.h"
#include "src/run/run.h"
#include "ui/commands/command_pictures.h"
#include "ui/commands/progress.h"

// Commands of --then.
enum { MOST_COMMANDS = 64 };
typedef struct voltage_commands {
    double times[MOST_COMMANDS], volts[MOST_COMMANDS];
    int count;
} voltage_commands;

// Reads "TIME:VOLTS,TIME:VOLTS", times since the touch in seconds, from 0 on and growing.
static bool read_commands(const char *text, voltage_commands *list)
{
    const char *rest = text;
    *list = (voltage_commands){0};
    while (rest != NULL && *rest != '\0') {
        const int i = list->count;
        double time, volts;
        bool read = i < MOST_COMMANDS && decimal_read(rest, &time, &rest) &&
                    *rest == ':' && decimal_read(rest + 1, &volts, &rest) &&
                    (*rest == ',' || *rest == '\0');
        if (!read || !isfinite(time) || !isfinite(volts) || time < 0 ||
            (i > 0 && !(time > list->times[i - 1]))) {
            complain("--then %s: expected TIME:VOLTS,... such as 0:2,0.01:-3, at most %d "
                     "of them, times in seconds from the touch on and growing",
                     text, MOST_COMMANDS);
            return false;
        }

        list->times[i] = time;
        list->volts[i] = volts;
        list->count++;
        rest += *rest == ',';
    }
    return true;
}

// What the predictors say of a run.
typedef struct predicted {
    const run_result *result;
    const sample *row; // the last one before the contact
    prediction_answer answers[PREDICTOR_COUNT];
} predicted;

static json_t *predict_object(const scenario *s, const void *found)
{
    const predicted *p = found;
    const landing *came = &p->result->landing;
    json_t *array = json_array();

    // one entry each, even where a predictor has no answer
    for (int i = 0; i < PREDICTOR_COUNT; i++) {
        const prediction_answer *answer = &p->answers[i];
        const prediction *said = &answer->prediction;
        const bool known = prediction_known(answer);
        json_add(
            array,
            json_of("method:t message:t holds:o peak_N:n time_to_peak_s:n impulse_Ns:n "
                    "equivalent_restitution:n inductance_changes_peak_N:n",
                    answer->name, known ? answer->note : prediction_reason(answer),
                    known ? json_boolean(said->holds) : json_null(), said->force,
                    said->delay, said->impulse, said->restitution, said->inductance));
    }

    // the same pulse in the run
    json_t *simulation = json_of("peak_N:n time_to_peak_s:n impulse_Ns:n", came->peak,
                                 came->time_to_peak, came->impulse);
    return json_of("scenario:t t_s:n predictions:o simulation:o", s->name, p->row->time,
                   array, simulation);
}

static void print_line(const char *label, double force, double delay, double impulse)
{
    printf("  %-30s", label);
    print_cell(14, "%.5g", force);
    print_cell(14, "%.5g", 1e3 * delay);
    print_cell(14, "%.5g", impulse);
    printf("\n");
}

// What the motor's inductance does to the peak.
static void print_inductance(const scenario *s, const prediction *linearised)
{
    const motor_parameters *motor = &s->parameters.motor;
    printf("\n  The current lags by L/R = %.3g ms",
           1e3 * motor->inductance / motor->resistance);
    if (!isnan(linearised->inductance)) {
        printf(", which changes the peak by %.3g N (%.2g %%)", linearised->inductance,
               100 * linearised->inductance /
                   (linearised->force - linearised->inductance));
    }
    printf(
        ";\n  only the linearised arm follows it, to the others it follows at once.\n");
}

static void print_predictions(const scenario *s, const void *found)
{
    const run_result *result = ((const predicted *)found)->result;
    const sample *row = ((const predicted *)found)->row;
    const prediction_answer *answers = ((const predicted *)found)->answers;
    const landing *came = &result->landing;
    const bool first = came->time == result->summary.first_contact_s;
    say_title(s);
    printf("%s at %.6g s, predicted from the instant before it\n\n",
           first ? "first contact" : "first contact after a flight", came->time);

    printf(
        "  last free row at %.6g s: hub, first and last link at %.5g, %.5g, %.5g rad,\n"
        "  turning with %.5g, %.5g, %.5g rad/s\n\n",
        row->time, row->hub_angle, row->first_angle, row->last_angle, row->hub_velocity,
        row->first_velocity, row->last_velocity);

    // the predictors, then what they should have found
    printf("  %-30s %14s %14s %14s\n", "first pulse", "peak [N]", "after [ms]",
           "impulse [N s]");
    for (int i = 0; i < PREDICTOR_COUNT; i++) {
        const prediction *p = &answers[i].prediction;
        if (answers[i].outcome == PREDICTION_HOLDS) {
            print_line(answers[i].label, p->force, p->delay, p->impulse);
        } else {
            say("  %-30s %s", answers[i].label, prediction_reason(&answers[i]));
            say(isnan(p->impulse) ? "\n" : ", its impulse is %.5g N s\n", p->impulse);
        }
    }

    print_line("simulation", came->peak, came->time_to_peak, came->impulse);

    const prediction *pulse = &answers[PREDICTOR_LINEARISED].prediction;
    if (!isnan(pulse->restitution)) {
        printf("\n  Kinetic energy given back by the end of the pulse, of the largest "
               "energy in the\n"
               "  springs (e_eq of 4.1.1): %.4g\n",
               pulse->restitution);
    }
    if (s->parameters.motor.inductance > 0) {
        print_inductance(s, pulse);
    }
    if (s->parameters.arm.links != 2) {
        printf("\n  The thesis's predictors know two links, the simulation has %d.\n",
               s->parameters.arm.links);
    }
}

// The peak that each predictor says, one below the other, with that of the simulation as
// a line.
static int plot_predictions(const arguments *a, const scenario *s, const void *found)
{
    const prediction_answer *answers = ((const predicted *)found)->answers;
    double peak[PREDICTOR_COUNT], place[PREDICTOR_COUNT], line_y[2], line_x[2];
    figure_tick ticks[PREDICTOR_COUNT];

    // a tick for each, but no point where a predictor does not hold
    for (int i = 0; i < PREDICTOR_COUNT; i++) {
        bool holds = answers[i].outcome == PREDICTION_HOLDS;
        if (holds) {
            peak[i] = answers[i].prediction.force;
        } else {
            peak[i] = (double)NAN;
        }
        place[i] = PREDICTOR_COUNT - i; // the first one uppermost
        ticks[PREDICTOR_COUNT - 1 - i] = (figure_tick){place[i], answers[i].label};
    }

    // the simulation as an upright line past all of them
    line_x[0] = line_x[1] = ((const predicted *)found)->result->landing.peak;
    line_y[0] = 0.4;
    line_y[1] = PREDICTOR_COUNT + 0.6;
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
    return publish_titled(a, s, "peak of the first pulse, predicted and simulated", &fig);
}

static int report(const arguments *a, const scenario *s, const run_result *result)
{
    static const command_results r = {predict_object, print_predictions,
                                      plot_predictions};
    predicted p = {.result = result};
    voltage_commands then;
    if (!read_commands(a->then, &then)) {
        return EXIT_BAD_ARGUMENTS;
    }

    p.row = predict_first_contact(s, result,
                                  &(voltage_profile){then.count, then.times, then.volts},
                                  p.answers);
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
    return write_results(a, &r, s, &p, true);
}

static int predict_and_report(const arguments *a, scenario *s)
{
    run_result result;
    int code = EXIT_FAILED;
    status ran = run_with_progress(a, s, true, &result);
    if (ran == STATUS_OK) {
        code = report(a, s, &result);
    } else if (ran == STATUS_STOPPED) {
        code = run_stopped(s, "nothing is predicted");
    } else {
        complain("%s failed: %s", s->name, result.summary.message);
    }

    run_finish(&result);
    return code;
}

static const option_row rows[] = {
    PLOT_OPTION("draw the predicted peaks beside the simulated one"),
    OPTION(TEXT, "then", "TIME:VOLTS,...",
           "what if the motor got these commands from the touch on (s, V)", PLACE(then)),
};

const command predict_command = {
    CALLED("predict", ONE_RUN,
           "Predict the peak force from the instant before contact, beside what then "
           "happens"),
    ONE_SCENARIO,
    .help = "On a terminal a run of more than a second tells how far it is; ^C "
            "ends it (exit status 130), and nothing\nis predicted.\n",
    .options = {&set_options, &json_options, OWN_OPTIONS(rows), &quiet_options,
                &page_options},
    .use = predict_and_report,
};
