#include "ui/commands/command.h"

#include <math.h>

#include "src/predict/linearised.h"
#include "src/predict/predict.h"
#include "src/base/json.h"

typedef struct predictor {
    const char *name; // key of --json
    const char *label;
    // NULL: the linearised arm, which asks for the state of all links
    status (*predict)(const parameters *p, const three_body_state *s, prediction *out, fault *f);
} predictor;

static const predictor predictors[] = {
    {"energy", "energy principle", predict_energy},
    {"impact_dynamics", "impact dynamics", predict_impact_dynamics},
    {"impact_quadratic", "impact dynamics, closed form", predict_impact_quadratic},
    {"linearised", "linearised constrained arm", NULL},
};
enum { PREDICTORS = sizeof predictors / sizeof predictors[0] };

typedef struct outcome {
    prediction prediction;
    fault fault; // why there is none; code STATUS_OK if there is one
} outcome;

// The last row in free flight before the first contact, or NULL if there was no contact.
static const sample *last_free_row(const trace *t)
{
    for (size_t i = 0; i < t->row_count; i++) {
        bool touches = t->rows[i].contact != 0 || t->rows[i].impulse != 0;
        if (touches) {
            return i > 0 ? &t->rows[i - 1] : NULL;
        }
    }
    return NULL;
}

static three_body_state state_of(const sample *row)
{
    return (three_body_state){
        .angle = {row->hub_angle, row->first_angle, row->last_angle},
        .velocity = {row->hub_velocity, row->first_velocity, row->last_velocity},
    };
}

static status predict_by_linearised_arm(const parameters *p, const run_result *result,
                                        prediction *out, fault *f)
{
    if (result->before_impact == NULL) {
        return fault_set(f, STATUS_BAD_ARGUMENT, "for the corrected model only");
    }
    arm a;
    arm_init(&a, p);
    motion *work = motion_create(&a, &p->method);
    if (work == NULL) {
        return fault_set(f, STATUS_NO_MEMORY, "%s", status_text(STATUS_NO_MEMORY));
    }
    status code =
        predict_linearised(&a, work, result->before_impact, result->before_impact + a.dof, out);
    motion_destroy(work);
    return code == STATUS_OK ? code : fault_set(f, code, "%s", status_text(code));
}

static void predict_all(const scenario *s, const run_result *result, const sample *row,
                        outcome *outcomes)
{
    three_body_state state = state_of(row);
    parameters now = scenario_parameters_at(s, row->time);
    for (int i = 0; i < PREDICTORS; i++) {
        outcomes[i] = (outcome){.fault = {.code = STATUS_OK}};
        outcome *o = &outcomes[i];
        o->fault.code = predictors[i].predict != NULL
                            ? predictors[i].predict(&now, &state, &o->prediction, &o->fault)
                            : predict_by_linearised_arm(&now, result, &o->prediction, &o->fault);
    }
}

static json_t *prediction_object(const char *method, const outcome *o)
{
    json_t *object = json_object();
    json_object_set_new(object, "method", json_string(method));
    json_object_set_new(object, "message", json_text(o->fault.text));
    bool known = o->fault.code == STATUS_OK;
    const prediction none = {.force = (double)NAN, .delay = (double)NAN, .impulse = (double)NAN};
    const prediction *p = known ? &o->prediction : &none;
    json_object_set_new(object, "holds", known ? json_boolean(p->holds) : json_null());
    json_object_set_new(object, "peak_N", json_number(p->force));
    json_object_set_new(object, "time_to_peak_s", json_number(p->delay));
    json_object_set_new(object, "impulse_Ns", json_number(p->impulse));
    return object;
}

static json_t *predict_object(const scenario *s, const sample *row, const outcome *outcomes,
                              const summary *m)
{
    json_t *object = json_object(), *array = json_array(), *simulation = json_object();
    json_object_set_new(object, "scenario", json_text(s->name));
    json_object_set_new(object, "t_s", json_number(row->time));
    for (int i = 0; i < PREDICTORS; i++) {
        json_array_append_new(array, prediction_object(predictors[i].name, &outcomes[i]));
    }
    json_object_set_new(object, "predictions", array);
    json_object_set_new(simulation, "peak_N", json_number(m->first_pulse_peak_N));
    json_object_set_new(simulation, "time_to_peak_s", json_number(m->first_pulse_time_to_peak_s));
    json_object_set_new(simulation, "impulse_Ns", json_number(m->contact_impulse_Ns));
    json_object_set_new(object, "simulation", simulation);
    return object;
}

static void print_cell(double value, double scale)
{
    if (isnan(value)) {
        printf(" %14s", "-");
    } else {
        printf(" %14.5g", scale * value);
    }
}

static void print_line(const char *label, double force, double delay, double impulse)
{
    printf("  %-30s", label);
    print_cell(force, 1);
    print_cell(delay, 1e3);
    print_cell(impulse, 1);
    printf("\n");
}

static void print_predictions(const scenario *s, const sample *row, const outcome *outcomes,
                              const summary *m)
{
    printf("%s: %s\nfirst contact at %.6g s, predicted from the instant before it\n\n", s->name,
           s->title, m->first_contact_s);
    printf("  last free row at %.6g s: hub, first and last link at %.5g, %.5g, %.5g rad,\n"
           "  turning with %.5g, %.5g, %.5g rad/s\n\n",
           row->time, row->hub_angle, row->first_angle, row->last_angle, row->hub_velocity,
           row->first_velocity, row->last_velocity);
    printf("  %-30s %14s %14s %14s\n", "first pulse", "peak [N]", "after [ms]", "impulse [N s]");
    for (int i = 0; i < PREDICTORS; i++) {
        const outcome *o = &outcomes[i];
        if (o->fault.code != STATUS_OK) {
            printf("  %-30s %s\n", predictors[i].label, o->fault.text);
        } else if (!o->prediction.holds) {
            printf("  %-30s the touch would not hold\n", predictors[i].label);
        } else {
            print_line(predictors[i].label, o->prediction.force, o->prediction.delay,
                       o->prediction.impulse);
        }
    }
    print_line("simulation", m->first_pulse_peak_N, m->first_pulse_time_to_peak_s,
               m->contact_impulse_Ns);
    if (s->parameters.arm.links != 2) {
        printf("\n  The thesis's predictors know two links, the simulation has %d.\n",
               s->parameters.arm.links);
    }
}

static int report(const arguments *a, const scenario *s, const run_result *result)
{
    outcome outcomes[PREDICTORS];
    const sample *row = last_free_row(&result->trace);
    if (row == NULL) {
        complain("%s has no free flight that ends in a contact, there is nothing to predict",
                 s->name);
        return EXIT_FAILED;
    }
    predict_all(s, result, row, outcomes);
    int code = EXIT_DONE;
    if (a->json != NULL) {
        code = write_json(a->json, predict_object(s, row, outcomes, &result->summary));
    }
    if (summary_wanted(a)) {
        print_predictions(s, row, outcomes, &result->summary);
    }
    return code;
}

static int predict_and_report(const arguments *a, scenario *s)
{
    run_result result;
    int code = EXIT_FAILED;
    if (run_scenario(s, true, &result) == STATUS_OK) {
        code = report(a, s, &result);
    } else {
        complain("%s failed: %s", s->name, result.summary.message);
    }
    run_finish(&result);
    return code;
}

static int predict(const arguments *a)
{
    return with_scenario(a->operands[0], a, predict_and_report);
}

const command predict_command = {
    .name = "predict",
    .group = GROUP_ONE_RUN,
    .operands = "SCENARIO",
    .summary = "Predict the peak force from the instant before contact, beside what then happens",
    .help = "",
    .least = 1,
    .most = 1,
    .takes_scenarios = true,
    .options = {&set_options, &json_options, &quiet_options},
    .run = predict,
};
