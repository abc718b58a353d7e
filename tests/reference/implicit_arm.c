#include "tests/reference/implicit_parts.h"

enum { MOST_STEPS = 2000000 };

#define SHORTEST 1e-14 // step [s]

// Momentum at the instants of the outcome that lie within the step just tried, by shorter
// steps.
static void take_samples(simulation *s, double h)
{
    chain_outcome *o = s->o;
    while (!isnan(o->first_contact) && o->samples < REFERENCE_SAMPLES) {
        const double time = o->first_contact + o->samples * REFERENCE_INTERVAL;
        if (time > s->t + h) {
            return;
        }
        try_step(s, fmax(time - s->t, 1e-15));
        o->momentum[o->samples++] =
            s->impulses + s->sums[SUM_FORCE] + s->added[SUM_FORCE];
    }
}

static double force_at(simulation *s, const double *y)
{
    double dy[MOST];
    answer r;
    rate_of(s, &s->now, y, dy, &r);
    return r.force;
}

// The largest force of a step in contact: the best sample, refined by shorter steps.
static void note_peak(simulation *s, double h)
{
    double y[MOST], best = force_at(s, s->y), x = 0;
    for (int i = 1; i <= SAMPLES; i++) {
        between_stages(s, (double)i / SAMPLES, y);
        const double f = force_at(s, i == SAMPLES ? s->end : y);
        if (f > best) {
            best = f;
            x = (double)i / SAMPLES;
        }
    }
    if (!(best > s->o->peak * 0.99)) {
        return;
    }
    double a = fmax(x - 1.0 / SAMPLES, 0) * h, b = fmin(x + 1.0 / SAMPLES, 1) * h;
    best = force_at(s, s->y);
    double when = 0;
    try_step(s, h);
    if (force_at(s, s->end) > best) {
        best = force_at(s, s->end);
        when = h;
    }
    for (int i = 0; i < 34 && x > 0; i++) { // golden section
        const double u = b - 0.6180339887498949 * (b - a),
                     v = a + 0.6180339887498949 * (b - a);
        try_step(s, u);
        const double fu = force_at(s, s->end);
        try_step(s, v);
        const double fv = force_at(s, s->end);
        if (fmax(fu, fv) > best) {
            best = fmax(fu, fv);
            when = fu > fv ? u : v;
        }
        *(fu > fv ? &b : &a) = fu > fv ? v : u;
    }
    if (best > s->o->peak) {
        s->o->peak = best;
        s->o->peak_time = s->t + when;
    }
}

static void project(simulation *s)
{
    if (!s->now.contact || wall_gives(&s->a->wall)) {
        return;
    }
    const int n = s->n;
    for (int pass = 0; pass < 2; pass++) {
        const touch t = touch_at(s, s->y, s->y + n);
        double change[ROWS];
        const double yields = yield_of(s, &t, s->now.friction == 0, change);
        for (int i = 0; i < n && yields > 0; i++) {
            s->y[i] -= change[i] * t.g / yields;
            s->y[n + i] -= change[i] * t.rate / yields;
        }
    }
}

static void follow_scales(simulation *s)
{
    for (int i = 0; i < s->n; i++) {
        s->largest_angle = fmax(s->largest_angle, fabs(s->y[i]));
        s->largest_rate = fmax(s->largest_rate, fabs(s->y[s->n + i]));
        s->turned[i] = fmax(s->turned[i], fabs(s->y[i] - s->start));
        s->rate[i] = fmax(s->rate[i], fabs(s->y[s->n + i]));
    }
}

static void begin(simulation *s, const chain_start *start)
{
    const arm *a = s->a;
    build_chain(s);
    for (int i = 0; i < s->n; i++) {
        s->y[i] = start->angle;
        s->y[s->n + i] = start->velocity;
        s->turned[i] = 1e-6;
        s->rate[i] = 1e-4;
    }
    s->start = start->angle;
    s->largest_angle = 1e-3;
    s->largest_rate = 1e-3;
    follow_scales(s);
    if (a->motor.electric) {
        double dy[MOST];
        answer r;
        rate_of(s, &s->now, s->y, dy, &r);
        s->now.limited = fabs(r.free_current) > a->motor.current_limit
                             ? (r.free_current > 0 ? 1 : -1)
                             : 0;
    }

    // at rest on the wall
    const touch t = touch_at(s, s->y, s->y + s->n);
    resolve(s, t.g >= -TINY_GAP && t.rate == 0, EVENTS);
    if (s->now.contact) {
        s->o->first_contact = 0;
        s->o->momentum[s->o->samples++] = 0;
    }
}

chain_outcome implicit_outcome_of(const chain_start *start, double tolerance)
{
    arm a;
    arm_init(&a, start->parameters);
    chain_outcome o = {.first_contact = (double)NAN, .status = STATUS_OK};
    static simulation s;
    s = (simulation){.a = &a, .tolerance = tolerance, .o = &o};
    begin(&s, start);
    double end = isnan(o.first_contact) ? start->duration : start->after_contact,
           next = 1e-6;
    bool know = false;
    for (long steps = 0; s.t < end; steps++) {
        if (steps > MOST_STEPS || next < SHORTEST) {
            o.status = STATUS_NO_PROGRESS;
            break;
        }
        double h = fmin(next, end - s.t);
        if (!know) {
            find_jacobian(&s);
            know = true;
        }
        const double error = try_step(&s, h);
        if (!(error <= 1)) {
            next = h * (error < HUGE_VAL ? fmax(0.1, 0.8 * pow(error, -0.25)) : 0.25);
            continue;
        }
        bool too_long = false;
        double at = h;
        const event e = first_event(&s, h, &at, &too_long);
        if (too_long) {
            next = h / 4;
            continue;
        }
        try_step(&s, at);
        if (s.now.contact && s.n > 1) {
            note_peak(&s, at);
        }
        take_samples(&s, at);
        try_step(&s, at);
        s.t += at;
        memcpy(s.y, s.end, sizeof s.y);
        for (int i = 0; i < SUMS; i++) {
            s.sums[i] += s.added[i];
        }
        project(&s);
        follow_scales(&s);
        know = false;
        next = h * fmin(3, 0.8 * pow(fmax(error, 1e-8), -0.25));
        if (e != EVENTS) {
            const bool had = !isnan(o.first_contact);
            const bool touched = s.now.contact || e == TOUCHES;
            happen(&s, e);
            if (touched && !s.now.contact) {
                s.left = s.t;
                chain_outcome_forget(&o, s.impulses + s.sums[SUM_FORCE]);
            }
            next = fmin(h, 1e-6);
            if (!had && !isnan(o.first_contact)) {
                o.momentum[o.samples++] = s.impulses;
            }
            end = isnan(o.first_contact)
                      ? start->duration
                      : fmin(start->duration, o.first_contact + start->after_contact);
        }
        if (start->most_contacts > 0 && o.contacts >= start->most_contacts) {
            break;
        }
    }
    const double lost[] = {s.sums[SUM_FRICTION], s.impact_loss, s.sums[SUM_VISCOUS],
                           s.sums[SUM_DAMPING], s.sums[SUM_WALL]};
    memcpy(o.lost, lost, sizeof lost);
    o.motor_work = s.sums[SUM_WORK];
    o.put_in = fabs(o.motor_work);
    o.ended = s.t;
    return o;
}
