// The panel of predictors: what each says would come of a touch now, and what then came.
#include "ui/explorer/panels/panel.h"

#include <math.h>
#include <string.h>

#include "src/base/text_stream.h"
#include "src/run/run.h"

enum { MOST_PREDICTED = 32 }; // links: more would take seconds
enum { ROWS = 6 };            // of the panel [cells]

// What a predictor says of the state in a row. The linearised arm is asked once for each
// row: with more links than two it takes milliseconds, too long for every frame of a run
// that plays.
static prediction_answer ask(const explorer_model *model, const explorer_view *view,
                             layout *lay, predictor which, size_t r)
{
    const trace *t = &model->session.run.trace;
    const sample *row = &t->rows[r];
    const size_t state = r * (size_t)t->angle_count;
    // under a control law the voltage is the law's, and the amplifier gets no more than
    // its limit
    parameters p = session_parameters_at(&model->session, row->time);
    p.motor.voltage = row->voltage;
    const prediction_question question = {
        .parameters = &p,
        .bodies = {{row->hub_angle, row->first_angle, row->last_angle},
                   {row->hub_velocity, row->first_velocity, row->last_velocity}},
        .angles = t->angles + state,
        .velocities = t->velocities + state,
        .current = row_current(&p.motor, row)};
    if (which != PREDICTOR_LINEARISED) {
        return predict_with(which, &question);
    }

    linearised_answer *known = &lay->linearised;
    const unsigned long run = model_run_id(model);
    if (known->run != run || known->row != r) {
        const bool waits = view->playback.playing && p.arm.links > 2;
        if (waits || p.arm.links > MOST_PREDICTED) {
            return (prediction_answer){.short_label = "linearised",
                                       .outcome = PREDICTION_LINKS_UNKNOWN};
        }
        *known = (linearised_answer){run, r, predict_with(which, &question)};
    }
    return known->answer;
}

// The row of the predicted touch: the present one in free flight, otherwise the last free
// one.
static size_t free_row(const session *s)
{
    const trace *t = &s->run.trace;
    size_t r = s->row;

    // in contact: back to the last touch, and on to where the arm was free
    if (t->rows[r].contact != 0) {
        for (size_t i = 0; i < t->event_count && t->events[i].time <= s->now; i++) {
            bool touches =
                t->events[i].kind == EVENT_IMPACT || t->events[i].kind == EVENT_CONTACT;
            if (touches) {
                r = trace_row_at(t, t->events[i].time);
            }
        }
        while (r > 0 && t->rows[r].contact != 0) {
            r--;
        }
    }
    return r;
}

// The largest force of the contact that begins after a row, as far as it has been seen.
static prediction what_came(const session *s, size_t r)
{
    const trace *t = &s->run.trace;
    prediction came = {.holds = true, .force = 0, .delay = 0};
    double start = t->rows[r].time;
    for (r++; r < t->row_count && t->rows[r].contact != 0 && t->rows[r].time <= s->seen;
         r++) {
        if (t->rows[r].force > came.force) {
            came.force = t->rows[r].force;
            came.delay = t->rows[r].time - start;
        }
    }
    return came;
}

// The reason why a predictor has no answer, in as many words as fit. Links whose state is
// not known are those of a run that plays: it will say something when that pauses.
static const char *reason_of(const prediction_answer *answer, area a)
{
    const char *reason = prediction_reason(answer);
    loss_unless(answer->fault.code != STATUS_NO_MEMORY);
    if (answer->outcome == PREDICTION_LINKS_UNKNOWN) {
        return "-";
    }
    if (a.width - 20 >= (int)strlen(reason)) {
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

// A line of the panel; `unknown` is shown instead of a force that is not known, otherwise
// NULL.
static void predictor_line(screen *s, area a, int line, const char *label,
                           const prediction *p, const char *unknown)
{
    const int y = a.y + 1 + line, room = line < a.height - 2 ? a.width : 0;
    screen_text(s, a.x + 2, y, room - 4, INK_TEXT, label);

    // force and delay as far as they are known and there is room
    if (unknown != NULL || !p->holds) {
        screen_text(s, a.x + 18, y, room - 20, INK_DIM,
                    unknown != NULL ? unknown : "would not hold");
    } else {
        const double delay = 1e3 * p->delay; // [ms]
        char text[64];
        if (!isfinite(delay)) {
            snprintf(text, sizeof text, "%.3f N", p->force);
        } else if (a.width < 36) {
            snprintf(text, sizeof text, "%.2f N, %.0f ms", p->force, delay);
        } else {
            snprintf(text, sizeof text, "%.3f N in %.0f ms", p->force, delay);
        }
        screen_text(s, a.x + 18, y, room - 20, INK_FORCE, text);
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

static void draw(const explorer_model *model, const explorer_view *view, layout *lay,
                 screen *s, area a)
{
    const session *e = &model->session;
    size_t r = free_row(e);
    bool touches = session_sample(e)->contact != 0;
    screen_frame(s, a.x, a.y, a.width, a.height, INK_FRAME,
                 touches ? "when it touched: peak" : "if it touched now: peak");

    // the thesis's two know no other number of links
    if (session_parameters_at(e, e->now).arm.links != 2) {
        screen_text(s, a.x + 2, a.y + a.height - 1, a.width - 4, INK_DIM,
                    " the first two know two links ");
    }

    // what the predictors say
    static const predictor asked[] = {PREDICTOR_ENERGY, PREDICTOR_IMPACT_DYNAMICS,
                                      PREDICTOR_LINEARISED};
    for (int i = 0; i < 3; i++) {
        const prediction_answer answer = ask(model, view, lay, asked[i], r);
        predictor_line(s, a, i, answer.short_label, &answer.prediction,
                       prediction_known(&answer) ? NULL : reason_of(&answer, a));
    }

    // and beside it what came
    prediction out;
    if (touches) {
        out = what_came(e, r);
        predictor_line(s, a, 3, "what came", &out, NULL);
    } else {
        const summary *m = &e->run.summary;
        out = (prediction){.holds = true,
                           .force = m->first_pulse_peak_N,
                           .delay = m->first_pulse_time_to_peak_s};
        bool seen = e->seen >= m->first_contact_s + m->first_pulse_time_to_peak_s;
        predictor_line(s, a, 3, "first pulse", &out, seen ? NULL : "-");
    }
}

const panel predictors_panel = {.name = "predictors",
                                .rows = predictors_rows,
                                .draw = draw};
