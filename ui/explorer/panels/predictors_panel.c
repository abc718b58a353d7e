// The panel of predictors: what each says would come of a touch now, and what then came.
#include "ui/explorer/panels/panel.h"

#include <math.h>
#include <string.h>

#include "src/base/text_stream.h"
#include "src/run/run.h"

enum { MOST_PREDICTED = 32 }; // links: more would take seconds
enum { ROWS = 6 };            // of the panel [cells]
enum { ANSWERS_AT = 16 };     // column behind the labels [cells]

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

// The reason why a predictor has no answer, in as many words as there is room for. Links
// whose state is not known are those of a run that plays: it will say something when that
// pauses.
static const char *reason_of(const prediction_answer *answer, int room)
{
    const char *reason = prediction_reason(answer);
    loss_unless(answer->fault.code != STATUS_NO_MEMORY);
    if (answer->outcome == PREDICTION_LINKS_UNKNOWN) {
        return "-";
    }
    if ((int)strlen(reason) <= room) {
        return reason;
    }
    if (answer->outcome == PREDICTION_DOUBTFUL) {
        return "cannot be told";
    }
    if (answer->outcome == PREDICTION_FAILED) {
        return "failed";
    }
    return "does not apply";
}

// A force with its delay, as far as it is known and there is room.
static void draw_prediction(screen *s, area a, const prediction *p)
{
    enum { NARROW = 16 };                // cells
    const double delay = 1e3 * p->delay; // [ms]
    if (!p->holds) {
        area_text(s, a, INK_DIM, "would not hold");
    } else if (!isfinite(delay)) {
        area_print(s, a, INK_FORCE, "%.3f N", p->force);
    } else if (a.width < NARROW) {
        area_print(s, a, INK_FORCE, "%.2f N, %.0f ms", p->force, delay);
    } else {
        area_print(s, a, INK_FORCE, "%.3f N in %.0f ms", p->force, delay);
    }
}

int predictors_rows(const explorer_model *model, const explorer_view *view,
                    screen_size body)
{
    (void)model;
    (void)view;
    if (body.width >= SIDE_WIDTH && body.height >= 15) {
        return ROWS;
    }
    return 0;
}

// What the predictors say, a line each, and how many lines that are.
static int draw_answers(const explorer_model *model, const explorer_view *view,
                        layout *lay, screen *s, area a, size_t r)
{
    static const predictor asked[] = {PREDICTOR_ENERGY, PREDICTOR_IMPACT_DYNAMICS,
                                      PREDICTOR_LINEARISED};
    enum { ASKED = sizeof asked / sizeof asked[0] };
    for (int i = 0; i < ASKED && i < a.height; i++) {
        const prediction_answer answer =
            predictor_answer_at(model, view, lay, asked[i], r);
        const area line = area_row(a, i), beside = area_right(line, ANSWERS_AT);
        area_text(s, line, INK_TEXT, answer.short_label);
        if (prediction_known(&answer)) {
            draw_prediction(s, beside, &answer.prediction);
        } else {
            area_text(s, beside, INK_DIM, reason_of(&answer, beside.width));
        }
    }
    return ASKED;
}

// What came of the contact that there is, or else of the run's first one.
static void draw_outcome(const session *e, screen *s, area line, bool touches, size_t r)
{
    const area beside = area_right(line, ANSWERS_AT);
    if (touches) {
        const prediction largest = largest_force_after(e, r);
        area_text(s, line, INK_TEXT, "what came");
        draw_prediction(s, beside, &largest);
        return;
    }

    // not before it has been seen
    const summary *m = &e->run.summary;
    const prediction pulse = {.holds = true,
                              .force = m->first_pulse_peak_N,
                              .delay = m->first_pulse_time_to_peak_s};
    area_text(s, line, INK_TEXT, "first pulse");
    if (e->seen >= m->first_contact_s + m->first_pulse_time_to_peak_s) {
        draw_prediction(s, beside, &pulse);
    } else {
        area_text(s, beside, INK_DIM, "-");
    }
}

// What the predictors say of a touch now, or in contact of the one that there was, a line
// each, and below them what came.
static void draw_predictors(const explorer_model *model, const explorer_view *view,
                            layout *lay, screen *s, area a)
{
    const session *e = &model->session;
    const bool touches = session_sample(e)->contact != 0;
    const size_t r = free_row(e);
    const char *title = touches ? "when it touched: peak" : "if it touched now: peak";
    area_frame(s, a, INK_FRAME, title);

    // the thesis's two know no other number of links
    const area inside = area_inside(a);
    if (session_parameters_at(e, e->now).arm.links != 2) {
        area_text(s, area_row(inside, inside.height), INK_DIM,
                  " the first two know two links ");
    }
    const int answers = draw_answers(model, view, lay, s, inside, r);
    if (answers < inside.height) {
        draw_outcome(e, s, area_row(inside, answers), touches, r);
    }
}

const panel predictors_panel = {.name = "predictors",
                                .rows = predictors_rows,
                                .draw = draw_predictors};
