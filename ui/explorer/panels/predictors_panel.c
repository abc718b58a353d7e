// The words of predictors: what each says would come of a touch now, and what then came.
#include "ui/explorer/panels/panel.h"

#include <math.h>

#include "src/base/text_stream.h"

#include "src/run/run.h"

enum { MOST_PREDICTED = 32 }; // links: more would take seconds

// What the linearised arm says of the state in a row. It is asked once for each row: with
// more links than two it takes milliseconds, too long for every frame of a run that
// plays.
static prediction_answer linearised_answer_at(const explorer_model *model,
                                              const explorer_view *view,
                                              linearised_answer *known,
                                              const prediction_question *question,
                                              size_t r)
{
    const unsigned long run = model_run_id(model);
    const int links = question->parameters->arm.links;
    if (known->run == run && known->row == r) {
        return known->answer;
    }
    if (links > MOST_PREDICTED || (links > 2 && view->playback.playing)) {
        return (prediction_answer){.short_label = "linearised",
                                   .outcome = PREDICTION_LINKS_UNKNOWN};
    }
    *known = (linearised_answer){run, r, predict_with(PREDICTOR_LINEARISED, question)};
    return known->answer;
}

// What a predictor says of the state in a row.
static prediction_answer predictor_answer_at(const explorer_model *model,
                                             const explorer_view *view, layout *lay,
                                             predictor which, size_t r)
{
    const trace *t = &model->session.run.trace;
    const sample *row = &t->rows[r];
    const size_t first_angle = r * (size_t)t->angle_count;

    // under a control law the voltage is the law's, and the amplifier gets no more than
    // its limit
    parameters p = session_parameters_at(&model->session, row->time);
    p.motor.voltage = row->voltage;
    const prediction_question question = {
        .parameters = &p,
        .bodies = {{row->hub_angle, row->first_angle, row->last_angle},
                   {row->hub_velocity, row->first_velocity, row->last_velocity}},
        .angles = t->angles + first_angle,
        .velocities = t->velocities + first_angle,
        .current = row_current(&p.motor, row)};
    if (which == PREDICTOR_LINEARISED) {
        return linearised_answer_at(model, view, &lay->linearised, &question, r);
    }
    return predict_with(which, &question);
}

// The row of the predicted touch: the present one in free flight, otherwise the last free
// one.
static size_t free_row(const session *s)
{
    const trace *t = &s->run.trace;
    if (t->rows[s->row].contact == 0) {
        return s->row;
    }

    // back to the last touch, and on to where the arm was free
    size_t r = s->row;
    for (size_t i = 0; i < t->event_count && t->events[i].time <= s->now; i++) {
        const event *v = &t->events[i];
        if (v->kind == EVENT_IMPACT || v->kind == EVENT_CONTACT) {
            r = trace_row_at(t, v->time);
        }
    }
    while (r > 0 && t->rows[r].contact != 0) {
        r--;
    }
    return r;
}

// The largest force of the contact that begins after a row, as far as it has been seen.
static prediction largest_force_after(const session *s, size_t free)
{
    const trace *t = &s->run.trace;
    prediction largest = {.holds = true, .force = 0, .delay = 0};
    for (size_t r = free + 1; r < t->row_count; r++) {
        const sample *row = &t->rows[r];
        if (row->contact == 0 || row->time > s->seen) {
            break;
        }
        if (row->force > largest.force) {
            largest.force = row->force;
            largest.delay = row->time - t->rows[free].time;
        }
    }
    return largest;
}

enum { ROWS = 4, WIDE = 40 }; // of the panel; width from which on there is more [cells]

// Draws a prediction and what follows it into the first row of an area, with its delay
// where that has room; returns what is below.
static area draw_prediction(screen *s, area a, const char *label, const prediction *p,
                            const char *rest)
{
    char delay[24] = "";
    int decimals = 2;
    if (a.width >= WIDE) {
        decimals = 3;
        if (isfinite(p->delay)) {
            snprintf(delay, sizeof delay, " in %.0f ms", 1e3 * p->delay);
        }
    }
    area_print(s, a, INK_TEXT, "%s %.*f N%s%s", label, decimals, p->force, delay, rest);
    return area_below(a, 1);
}

// What the predictors say of the state in a row: the forces of those that know one, else
// why there is none.
static void draw_answers(const explorer_model *model, const explorer_view *view,
                         layout *lay, screen *s, area a, size_t r)
{
    static const predictor asked[] = {PREDICTOR_ENERGY, PREDICTOR_IMPACT_DYNAMICS,
                                      PREDICTOR_LINEARISED};
    const char *reason = "no predictor knows it";
    bool any = false;

    // the first two are the thesis's, of two links
    const int links = model_parameters(model).arm.links;
    for (size_t i = links == 2 ? 0 : 2; i < sizeof asked / sizeof asked[0]; i++) {
        const prediction_answer answer =
            predictor_answer_at(model, view, lay, asked[i], r);
        loss_unless(answer.fault.code != STATUS_NO_MEMORY);
        if (!prediction_known(&answer)) {
            continue;
        }
        if (!answer.prediction.holds) {
            reason = "the contact would not hold";
            continue;
        }
        any = true;
        a = draw_prediction(s, a, answer.short_label, &answer.prediction, "");
    }
    if (!any) {
        area_text(s, a, INK_DIM, reason);
    }
}

// A few rows where the knobs have some to spare.
static int predictors_rows(const explorer_model *model, const explorer_view *view,
                           screen_size body)
{
    (void)model;
    (void)view;
    enum { LEAST = 12 };
    return body.height >= LEAST ? ROWS : 0;
}

// What a touch now would bring, or in contact what the one there was has brought, and
// what was predicted of it.
static void draw_predictors(const explorer_model *model, const explorer_view *view,
                            layout *lay, screen *s, area a)
{
    const session *e = &model->session;
    const size_t r = free_row(e);
    area line = {a.x + 2, a.y, a.width - 3, 1};
    if (session_sample(e)->contact != 0) {
        const prediction largest = largest_force_after(e, r);
        line = draw_prediction(s, line, "touched:", &largest, ", predicted:");
    } else {
        area_text(s, line, INK_DIM, "touching now would bring");
        line = area_below(line, 1);
    }
    draw_answers(model, view, lay, s, line, r);
}

const panel predictors_panel = {.name = "predictors",
                                .rows = predictors_rows,
                                .draw = draw_predictors};
