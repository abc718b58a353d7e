// Events of the implicit simulation: what ends a phase, where, and what follows.
#include "tests/reference/implicit_parts.h"

#define TINY_RATE  1e-13 // of a velocity of the hub [rad/s]
#define TINY_FORCE 1e-10 // [N]

// The value whose fall below zero is the event; HUGE_VAL where it cannot come.
static double event_value(const simulation *s, const double *y, event e)
{
    const arm *a = s->a;
    const phase *p = &s->now;
    const int n = s->n;
    double dy[MOST];
    answer r;
    rate_of(s, p, y, dy, &r);
    const bool gives = wall_gives(&a->wall), face = wall_has_face(&a->wall);
    const double depth = face || p->parted ? y[2 * n + 1] : 0;
    switch (e) {
    case TOUCHES:
        return !p->contact && wall_stands(&a->wall) ? r.gap + depth : HUGE_VAL;
    case RELEASES:
        return !p->contact ? HUGE_VAL
               : gives && !face
                   ? (r.gap >= 0 && a->wall.law == WALL_HUNT_CROSSLEY ? -r.gap : r.force)
                   : r.force;
    case STICKS:
        return p->friction != 0 && a->motor.stiction > 0 ? p->friction * y[n] : HUGE_VAL;
    case SLIPS_FORWARD: // friction holds back a forward torque: positive
        return p->friction == 0 && a->motor.stiction > 0 ? a->motor.stiction - r.friction
                                                         : HUGE_VAL;
    case SLIPS_BACKWARD:
        return p->friction == 0 && a->motor.stiction > 0 ? a->motor.stiction + r.friction
                                                         : HUGE_VAL;
    case LIMIT:
        if (!a->motor.electric || a->motor.current_limit == HUGE_VAL) {
            return HUGE_VAL;
        }
        return p->limited == 0 ? a->motor.current_limit - fabs(r.free_current)
                               : p->limited * r.free_current - a->motor.current_limit;
    case EVENTS:
        break;
    }
    return HUGE_VAL;
}
static double least_of(event e)
{
    return e == TOUCHES ? TINY_GAP : e == STICKS ? TINY_RATE : TINY_FORCE;
}

// Where an event's value vanishes between `from` and `to` of the step, by shorter steps.
static double locate(simulation *s, event e, double h, double from, double to)
{
    double y[MOST];
    between_stages(s, from, y);
    double fa = from > 0 ? event_value(s, y, e) : event_value(s, s->y, e), a = from * h,
           b = to * h;
    try_step(s, b);
    double fb = event_value(s, s->end, e);
    fa = fa > 0 ? fa : least_of(e);
    for (int i = 0, side = 0; i < 100 && b - a > 1e-15 && fb < 0; i++) {
        double x = i % 3 == 2 ? (a + b) / 2 : (fa * b - fb * a) / (fa - fb);
        x = fmin(fmax(x, a + 0.01 * (b - a)), b - 0.01 * (b - a));
        try_step(s, x);
        const double f = event_value(s, s->end, e);
        if (f < 0) {
            b = x;
            fb = f;
            fa = side == 1 ? fa / 2 : fa;
            side = 1;
        } else {
            a = x;
            fa = fmax(f, 1e-300);
            fb = side == -1 ? fb / 2 : fb;
            side = -1;
        }
    }
    return b;
}

event first_event(simulation *s, double h, double *at, bool *too_long)
{
    double y[MOST], value[EVENTS][SAMPLES + 1];
    int first = SAMPLES + 1;
    *too_long = false;
    for (int e = 0; e < EVENTS; e++) {
        value[e][0] = event_value(s, s->y, (event)e);
        for (int i = 1; i <= SAMPLES && value[e][0] != HUGE_VAL; i++) {
            between_stages(s, (double)i / SAMPLES, y);
            value[e][i] = event_value(s, i == SAMPLES ? s->end : y, (event)e);
            if (value[e][i] < -least_of((event)e) && i < first) {
                first = i;
            }
        }
        // a dip between samples that may reach zero
        for (int i = 1; i < SAMPLES && value[e][0] != HUGE_VAL && first > SAMPLES; i++) {
            const double u = value[e][i - 1], v = value[e][i], w = value[e][i + 1];
            const double bend = u - 2 * v + w,
                         dip = bend > 0 ? v - (w - u) * (w - u) / (8 * bend) : v;
            if (v > 0 && v < u && v < w && dip < 0.05 * v) {
                *too_long = h > 1e-9;
            }
        }
    }
    if (first > SAMPLES || *too_long) {
        return EVENTS;
    }
    event found = EVENTS;
    *at = h;
    for (int e = 0; e < EVENTS; e++) {
        if (value[e][0] == HUGE_VAL || !(value[e][first] < -least_of((event)e))) {
            continue;
        }
        // began at zero: the root at the start must be left behind first
        if (first == 1 && value[e][0] < 10 * least_of((event)e) && h > 1e-11) {
            *too_long = true;
            return EVENTS;
        }
        if (try_step(s, h) == HUGE_VAL) {
            *too_long = true;
            return EVENTS;
        }
        const double x = locate(s, (event)e, h, (double)(first - 1) / SAMPLES,
                                (double)first / SAMPLES);
        if (found == EVENTS || x < *at) {
            *at = x;
            found = (event)e;
        }
    }
    return found;
}

void resolve(simulation *s, bool touching, event left)
{
    const arm *a = s->a;
    double dy[MOST], least = HUGE_VAL;
    answer r;
    phase best = s->now;
    const double hub = s->y[s->n], stiction = a->motor.stiction;
    const bool rests = hub == 0 && stiction > 0,
               choice = touching && (!wall_gives(&a->wall) || wall_has_face(&a->wall));
    for (int contact = 1; contact >= 0; contact--) {
        for (int friction = -1; friction <= 1; friction++) {
            phase p = s->now;
            if ((!choice && contact != p.contact) ||
                (choice && left == RELEASES && contact) ||
                (rests && left == SLIPS_FORWARD && friction != 1) ||
                (rests && left == SLIPS_BACKWARD && friction != -1) ||
                (!rests && friction != (stiction == 0 ? 1
                                        : hub < 0     ? -1
                                                      : 1))) {
                continue;
            }
            p.contact = contact;
            p.friction = friction;
            rate_of(s, &p, s->y, dy, &r);
            double bad = 0;
            if (choice && contact) {
                bad = fmax(bad, -r.force);
            } else if (choice) {
                const double face = wall_has_face(&a->wall) ? dy[2 * s->n + 2] : 0;
                bad = fmax(bad, -(r.gap_acceleration + face));
            }
            if (rests && friction == 0) {
                bad = fmax(bad, fabs(r.friction) - stiction);
            } else if (rests) {
                bad = fmax(bad, -friction * dy[s->n]);
            }
            bad = bad < 1e-12 ? 0 : bad;
            if (bad < least) {
                least = bad;
                best = p;
            }
        }
    }
    s->now = best;
}

// The jump of an impact; returns the speed of approach [m/s].
static double impact(simulation *s)
{
    const arm *a = s->a;
    const int n = s->n;
    const touch t = touch_at(s, s->y, s->y + n);
    double change[ROWS], yields = yield_of(s, &t, false, change);
    const bool face = wall_has_face(&a->wall);
    yields += face ? 1 / a->wall.face_mass : 0;
    const double speed = t.rate - (face ? s->y[2 * n + 2] : 0);
    const double e = speed < a->wall.rest_speed ? 0 : a->wall.restitution;
    const double p = (1 + e) * speed / yields;
    for (int i = 0; i < n; i++) {
        s->y[n + i] -= p * change[i];
    }
    s->y[2 * n + 2] += face ? p / a->wall.face_mass : 0;
    s->impulses += p;
    s->impact_loss += 0.5 * p * (1 - e) * speed;
    s->now.contact = false;
    resolve(s, e == 0, EVENTS);
    return speed;
}

static void note_contact(simulation *s, double speed, double impulse)
{
    if (isnan(s->o->first_contact)) {
        s->o->first_impulse = impulse;
    }
    chain_outcome_note(s->o, s->t, speed, s->left);
}

void happen(simulation *s, event e)
{
    const arm *a = s->a;
    const int n = s->n;
    const bool gives = wall_gives(&a->wall), face = wall_has_face(&a->wall);
    double dy[MOST];
    answer r;
    if (e == TOUCHES && (!gives || face)) {
        const double before = s->impulses;
        s->o->impacts++;
        const double speed = impact(s);
        note_contact(s, speed, s->impulses - before);
    } else if (e == TOUCHES) {
        const double face_rate =
            s->now.parted ? face_return(&a->wall, s->y[2 * n + 1]) : 0;
        s->now.contact = true;
        s->now.parted = false;
        note_contact(s, touch_at(s, s->y, s->y + n).rate - face_rate, 0);
        resolve(s, false, EVENTS);
    } else if (e == RELEASES && gives && !face) {
        const touch t = touch_at(s, s->y, s->y + n);
        s->now.contact = false;
        s->now.parted = t.g > 0 && a->wall.damping > 0;
        s->y[2 * n + 1] = fmax(t.g, 0);
        resolve(s, false, EVENTS);
    } else if (e == RELEASES) {
        const touch t = touch_at(s, s->y, s->y + n);
        if (face) {
            s->y[2 * n + 1] = t.g;
            s->y[2 * n + 2] = t.rate;
        }
        resolve(s, true, RELEASES);
    } else if (e == STICKS) {
        s->y[n] = 0;
        resolve(s, s->now.contact, EVENTS);
    } else if (e == SLIPS_FORWARD || e == SLIPS_BACKWARD) {
        s->y[n] = 0;
        resolve(s, s->now.contact, e);
    } else if (e == LIMIT) {
        rate_of(s, &s->now, s->y, dy, &r);
        s->now.limited = s->now.limited != 0 ? 0 : r.free_current > 0 ? 1 : -1;
        if (s->now.limited != 0 && a->motor.inductance > 0) {
            s->y[2 * n] = s->now.limited * a->motor.current_limit;
        }
        if (s->now.limited == 0 || a->motor.inductance > 0) {
            resolve(s, s->now.contact, EVENTS);
        }
    }
}
