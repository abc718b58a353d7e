#include "src/study/sensor_view.h"

#include <assert.h>
#include <math.h>

#include "src/contact/contact_machine.h"
#include "src/contact/pace.h"
#include "src/base/instant.h"
#include "src/base/plain_math.h"

// A parabola is right to 1e-4 of the fastest mode's force over so much of (fastest rate) x (time).
#define PARABOLA_REACH 0.25

#define BRIEF_SHARE    1e-3 // of a time constant, below which a force is its mean and its tilt
#define MOST_WORK      2e7  // strides in the window times links; more takes minutes
#define RESOLVING      20.0 // fastest rate times step, at most

const double sensor_constants[SENSOR_CONSTANTS] = {0.5e-3, 1e-3, 2e-3};

// --- the lag --------------------------------------------------------------------------------

void sensor_lag_start(sensor_lag *s, double time_constant, double time)
{
    assert(s != NULL && time_constant > 0);
    *s = (sensor_lag){.time_constant = time_constant, .time = time, .peak_time = time};
}

// Remembers the largest value.
static void look(sensor_lag *s, double time, double value)
{
    if (value > s->peak) {
        s->peak = value;
        s->peak_time = time;
    }
}

void sensor_lag_impulse(sensor_lag *s, double impulse)
{
    assert(s != NULL);
    s->value += impulse / s->time_constant;
    look(s, s->time, s->value);
}

// y(t) = a + b t + c t^2 + d exp(-t / tau), the response to a parabola.
typedef struct response {
    double a, b, c, d, rate;
} response;

static double response_value(const response *r, double t)
{
    return r->a + t * (r->b + t * r->c) + r->d * plain_exp(-r->rate * t);
}

static double response_slope(const response *r, double t)
{
    return r->b + 2 * r->c * t - r->rate * r->d * plain_exp(-r->rate * t);
}

void sensor_lag_force(sensor_lag *s, double length, double first, double last, double mean)
{
    assert(s != NULL);
    if (!(length > 0)) {
        return;
    }

    // over a small share of the time constant the polynomials below suffer cancellation: mean and
    // tilt are enough, with an error of the cube of that share
    const double share = length / s->time_constant;
    if (share < BRIEF_SHARE) {
        const double gained = share * (1 - share / 2 * (1 - share / 3 * (1 - share / 4)));
        s->value += gained * (mean - s->value) + share * share * (last - first) / 12;
        s->time += length;
        look(s, s->time, s->value);
        return;
    }

    // f = first + linear t + square t^2 with the given end and mean
    double square = (3 * (first + last) - 6 * mean) / (length * length);
    double linear = (last - first) / length - square * length, tau = s->time_constant;

    // and its response
    response r = {.c = square, .b = linear - 2 * tau * square, .rate = 1 / tau};
    r.a = first - tau * r.b;
    r.d = s->value - r.a;

    // a peak within the step, where the response turns round
    if (response_slope(&r, 0) > 0 && response_slope(&r, length) < 0) {
        double low = 0, high = length;
        for (int i = 0; i < 60; i++) {
            double middle = 0.5 * (low + high);
            if (response_slope(&r, middle) > 0) {
                low = middle;
            } else {
                high = middle;
            }
        }
        look(s, s->time + low, response_value(&r, low));
    }

    s->time += length;
    s->value = response_value(&r, length);
    look(s, s->time, s->value);
}

// --- the run --------------------------------------------------------------------------------

// What a run in progress remembers.
typedef struct watching {
    sensor_view *view;
    const run_monitor *monitor;
    sensor_lag lags[SENSOR_CONSTANTS];
    double touched; // first contact [s], NaN before it
} watching;

// The force over a stride, as sensors and momentum see it.
static void watch_stride(watching *w, motion *m)
{
    const double *start = m->trial; // where the stride left its beginning
    double from = start[SLOT_TIME], to = m->state[SLOT_TIME], length = to - from;
    if (isnan(w->touched) || !(length > 0)) {
        return;
    }

    // its integral is exact, however it went between the stride's ends
    double integral = state_quadratures(m, m->state)[QUADRATURE_FORCE] -
                      state_quadratures(m, m->trial)[QUADRATURE_FORCE];
    for (int i = 0; i < SENSOR_CONSTANTS; i++) {
        sensor_lag_force(&w->lags[i], length, start[SLOT_FORCE], m->state[SLOT_FORCE],
                         integral / length);
    }

    // strides end at MOMENTUM_WINDOW
    if (!instant_after(to, w->touched + MOMENTUM_WINDOW)) {
        w->view->momentum += integral;
    }
}

// The first contact, at `speed` [m/s] and with `impulse` [N s], starts the sensors.
static void open_window(watching *w, motion *m, double speed, double impulse)
{
    w->touched = m->state[SLOT_TIME];
    w->view->impulse = impulse;
    w->view->speed = speed;
    for (int i = 0; i < SENSOR_CONSTANTS; i++) {
        sensor_lag_start(&w->lags[i], sensor_constants[i], w->touched);
    }
    motion_watch(m);
}

// An impact's impulse.
static void watch_impact(watching *w, motion *m, const motion_report *report)
{
    const double impulse = report->impulse;
    double now = m->state[SLOT_TIME];
    if (isnan(w->touched)) {
        open_window(w, m, report->speed, impulse);
    }
    for (int i = 0; i < SENSOR_CONSTANTS; i++) {
        sensor_lag_impulse(&w->lags[i], impulse);
    }
    if (now <= w->touched + MOMENTUM_WINDOW) {
        w->view->momentum += impulse;
    }
    w->view->impacts += impulse > 0;
}

// The next instant a stride must not pass.
static double next_end(const watching *w, double now, double duration)
{
    if (isnan(w->touched)) {
        return duration;
    }
    double early = w->touched + MOMENTUM_WINDOW;
    return now < early ? early : w->touched + SENSOR_WINDOW;
}

static status watch_motion(const arm *a, motion *m, double step, double duration, watching *w,
                           fault *f)
{
    double last = 0; // instant of the last event
    pace strides = pace_begin();

    // an arm that starts against the wall has touched it
    if (motion_starts_in_contact(m)) {
        open_window(w, m, 0, 0);
    }
    double end = isnan(w->touched) ? duration : SENSOR_WINDOW;

    // steps that resolve the modes are asked for, shorter ones are not
    const double resolved = RESOLVING / fmax(a->highest_frequency, 1);
    while (m->state[SLOT_TIME] < end) {
        motion_report report;
        if (run_monitor_stops(w->monitor)) {
            return fault_set(f, STATUS_STOPPED, "%s", status_text(STATUS_STOPPED));
        }

        // a stride
        double until = fmin(end, next_end(w, m->state[SLOT_TIME], duration));
        if (!isnan(w->touched) && engine_is_dense(m->engine)) {
            const double now = m->state[SLOT_TIME]; // its strides are no parabolas
            const double vibrating = PARABOLA_REACH / motion_vibration(a, m, m->state);
            const double decaying = motion_decay_length(a, PARABOLA_REACH, now - last);
            until = fmin(until, now + fmin(vibrating, decaying));
        }
        status code = motion_step(a, m, until, step, &report);
        if (code != STATUS_OK) {
            return fault_set(f, code, "%d links, at t = %.9g s: %s", a->links, m->failure_time,
                             status_text(code));
        }

        watch_stride(w, m);
        code = pace_keep(&strides, a, m, duration, resolved, f);
        if (code != STATUS_OK) {
            return code;
        }
        if (report.event == MOTION_REACHED) {
            continue;
        }

        // an event at its end; the window opens with the first contact
        motion_apply(a, m, &report);
        last = m->state[SLOT_TIME];
        if (report.event == MOTION_IMPACT || report.event == MOTION_TOUCH) {
            watch_impact(w, m, &report);
            end = w->touched + SENSOR_WINDOW;
        }
    }
    return STATUS_OK;
}

static status check_scenario(const scenario *s, fault *f)
{
    if (s->parameters.arm.model == ARM_PRINTED) {
        return fault_set(f, STATUS_BAD_SCENARIO,
                         "%s: the printed model has no impulses a sensor could see, expected "
                         "arm.model = corrected",
                         s->name);
    }
    if (s->action_count > 0) {
        return fault_set(f, STATUS_BAD_SCENARIO,
                         "%s has a script, expected a scenario without actions", s->name);
    }
    return STATUS_OK;
}

// The scenario's parameters and arm with another number of links. STATUS_NO_PROGRESS, with a
// sentence, where its modes are too fast to follow through the window.
static status change_links(const scenario *s, int links, parameters *p, arm *a, fault *f)
{
    *p = s->parameters;
    status code = check_scenario(s, f);
    if (code == STATUS_OK) {
        code = parameter_set_number(p, PARAMETER_INDEX(arm.links), links, f);
    }
    if (code == STATUS_OK) {
        code = parameters_resolve(p, f);
    }
    if (code != STATUS_OK) {
        return code;
    }

    arm_init(a, p);
    const double strides = SENSOR_WINDOW * a->highest_frequency / PARABOLA_REACH;
    return strides * links <= MOST_WORK
               ? STATUS_OK
               : fault_set(f, STATUS_NO_PROGRESS,
                           "%s: with %d links the fastest mode vibrates at %.3g rad/s, which asks "
                           "for %.2g strides in the %g s after contact; expected a smaller arm.k2 "
                           "or arm.EI",
                           s->name, links, a->highest_frequency, strides, SENSOR_WINDOW);
}

status sensor_view_compute(const scenario *s, int links, run_monitor *monitor, sensor_view *view,
                           fault *f)
{
    assert(s != NULL && view != NULL && links > 0);
    parameters p;
    arm a;
    *view = (sensor_view){.links = links};
    status code = change_links(s, links, &p, &a, f);
    if (code != STATUS_OK) {
        return code;
    }

    // by the event method, in steps that resolve every mode
    p.method.name = METHOD_EVENT;
    p.method.step = fmin(p.method.step, RESOLVING / a.fastest_rate);
    motion *m = motion_create(&a, &p.method);
    if (m == NULL) {
        return fault_set(f, STATUS_NO_MEMORY, "no memory for an arm of %d links", links);
    }

    // its motion until the window is over
    watching w = {.view = view, .monitor = monitor, .touched = (double)NAN};
    motion_start(&a, m, p.initial.angle, p.initial.velocity);
    code = watch_motion(&a, m, p.method.step, p.run.duration, &w, f);
    if (code == STATUS_OK && isnan(w.touched)) {
        code =
            fault_set(f, STATUS_BAD_SCENARIO, "%s: with %d links there is no contact within %g s",
                      s->name, links, p.run.duration);
    }

    view->peak = m->record.pulse_peak >= 0 ? m->record.pulse_peak : 0;
    for (int i = 0; i < SENSOR_CONSTANTS; i++) {
        view->sensed[i] = w.lags[i].peak;
        view->delay[i] = w.lags[i].peak_time - w.touched;
    }
    motion_destroy(m);
    return code;
}

// --- the limit of many links ----------------------------------------------------------------

#define DAWSON_LARGEST 0.5410442246351817 // of Dawson's integral, at 0.9241388730

// K [N s^(1/2)].
static double beam_constant(const parameters *p, double speed)
{
    double bending = p->arm.k2 * p->arm.length / 2, density = p->arm.mass / p->arm.length;
    return speed * plain_pow(bending, 0.25) * plain_pow(density, 0.75) / sqrt(2 * M_PI);
}

double sensor_beam_momentum(const parameters *p, double speed, double time)
{
    return 2 * beam_constant(p, speed) * sqrt(time);
}

double sensor_beam_peak(const parameters *p, double speed, double time_constant)
{
    return 2 * beam_constant(p, speed) / sqrt(time_constant) * DAWSON_LARGEST;
}

// --- the study ------------------------------------------------------------------------------

status sensor_study_compute(const scenario *s, run_monitor *monitor, sensor_study *study, fault *f)
{
    static const int links[SENSOR_LENGTHS] = {2, 3, 5, 8, 12, 16, 24, 32};
    assert(s != NULL && study != NULL);
    *study = (sensor_study){0};

    // the chain with the most links decides beforehand whether the study is feasible
    parameters longest;
    arm a;
    status possible = change_links(s, links[SENSOR_LENGTHS - 1], &longest, &a, f);
    if (possible != STATUS_OK) {
        return possible;
    }

    for (int i = 0; i < SENSOR_LENGTHS; i++) {
        sensor_view *view = &study->views[i];
        status code = sensor_view_compute(s, links[i], monitor, view, f);
        if (code != STATUS_OK) {
            return code;
        }
        study->count++;
        run_monitor_count(monitor);

        // the chain
        study->links[i] = links[i];
        study->impulse[i] = view->impulse;
        study->peak[i] = view->peak;
        study->momentum[i] = view->momentum;
        for (int k = 0; k < SENSOR_CONSTANTS; k++) {
            study->sensed[k][i] = view->sensed[k];
        }

        // the beam that is stopped from the same speed
        study->beam_momentum[i] =
            sensor_beam_momentum(&s->parameters, view->speed, MOMENTUM_WINDOW);
        for (int k = 0; k < SENSOR_CONSTANTS; k++) {
            study->beam_peak[k][i] =
                sensor_beam_peak(&s->parameters, view->speed, sensor_constants[k]);
        }
    }
    return STATUS_OK;
}
