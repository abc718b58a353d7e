// Numbers of the summary, computed again from rows and events.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tests/rigs/random_rigs.h"

typedef struct touches {
    double first,
        release; // first contact, first release [s], (double)NAN if there is none
    int impacts;
    double impulse;  // of the first impact [N s]
    double impulses; // of all
} touches;

static touches touches_of(const motion *m)
{
    touches t = {.first = (double)NAN, .release = (double)NAN};
    for (size_t i = 0; i < impactlab_run_event_count(m->run); i++) {
        impactlab_event e;
        impactlab_run_event(m->run, i, &e);
        const bool impact = strcmp(e.kind, "impact") == 0;
        if (isnan(t.first) && (impact || strcmp(e.kind, "contact") == 0)) {
            t.first = e.time;
            t.release = impact ? e.time : (double)NAN;
        }
        if (strcmp(e.kind, "contact") == 0 && e.time == t.first) {
            t.release = (double)NAN; // contact goes on after the impact
        }
        if (isnan(t.release) && strcmp(e.kind, "release") == 0) {
            t.release = e.time;
        }
        if (impact) {
            t.impulse = t.impacts == 0 ? e.impulse : t.impulse;
            t.impacts++;
            t.impulses += e.impulse;
        }
    }
    return t;
}

// The largest value within an interval: of the lines, and of what may lie above them.
typedef struct largest {
    double low, high;
} largest;

static largest largest_within(const pieces *f, double from, double to)
{
    largest l = {-(double)INFINITY, -(double)INFINITY};
    for (size_t i = 0; i < f->count; i++) {
        const piece *p = &f->of[i];
        if (p->to >= from - INSTANT && p->from <= to + INSTANT) {
            if (p->from >= from - INSTANT && p->to <= to + INSTANT) {
                l.low = fmax(l.low, fmax(p->begin, p->end) - (p->drawn ? p->error : 0));
            }
            l.high = fmax(l.high, fmax(p->begin, p->end) + p->error);
        }
    }
    return l;
}

// The largest force of the run; 0 where only impacts gave one.
static double peak_of(const motion *m)
{
    const double peak = quantity(m, "peak_force_N");
    return isnan(peak) ? 0 : peak;
}

static void check_peak(rig *r, const motion *m, const pieces *force, const char *what,
                       const char *when, double first, double to)
{
    const double said = quantity(m, what), at = quantity(m, when);
    const double peak = isnan(said) ? 0 : said;
    const largest l = largest_within(force, first, to);
    const double slack = 1e-9 * fabs(l.high) + 1e-9;
    expect(r, what, first, peak, l.low - slack, l.high + slack);
    if (l.high > 1e-6 && !isnan(at)) {
        const largest there =
            largest_within(force, first + at - spacing, first + at + spacing);
        expect(r, when, first + at, peak, -(double)INFINITY, there.high + slack);
    }
}

// The gap to a wall's face, which may swing or come back on its own.
static double gap_to_face(const motion *m, size_t i)
{
    return m->of[GAP][i] + or_zero(m->of[FACE_DEPTH][i]);
}

// Leaves of the wall by more than 1 um after first contact: surely, and perhaps.
static void check_separations(rig *r, const motion *m, double first)
{
    const double far = 1e-6, unsure = 1e-9;
    int surely = 0, perhaps = 0;
    bool away_surely = false, away_perhaps = false;
    for (size_t i = 0; i < m->count; i++) {
        const double gap = m->of[CONTACT][i] != 0 ? 0 : gap_to_face(m, i);
        if (m->of[TIME][i] <= first) {
            continue;
        }
        if (gap > far + unsure && !away_surely) {
            surely++;
            away_surely = true;
        }
        if (gap > far - unsure && !away_perhaps) {
            perhaps++;
            away_perhaps = true;
        }
        if (gap <= unsure) {
            away_surely = away_perhaps = false;
        }
    }
    expect(r, "separations", first, quantity(m, "separations"), surely, perhaps);
}

// The mean over the last 0.1 s, and what is made of it.
static void check_steady(rig *r, const motion *m, const pieces *force, const touches *t)
{
    double error;
    const double span = fmin(0.1, m->ends);
    const double steady = integral(force, m->ends - span, m->ends, &error) / span;
    const double said = quantity(m, "steady_force_N"), peak = peak_of(m);
    error = error / span + 1e-9 * (1 + fabs(steady));
    expect_near(r, "steady_force_N", m->ends, said, steady, error);
    expect(r, "steady within peak", m->ends, said, -1e-9, peak * (1 + 1e-9) + 1e-9);

    // overshoot
    if (steady > 1e-3) {
        const double over = 100 * (peak - steady) / steady;
        expect_near(r, "force_overshoot_percent", m->ends,
                    quantity(m, "force_overshoot_percent"), over,
                    100 * peak / steady * (error / steady + 1e-9));
    }

    // settled once the force stays within 5 % of its final value: with a wider and a
    // narrower band
    if (steady > 1e-3) {
        double earliest = t->first, latest = t->first;
        for (size_t i = 0; i < force->count; i++) {
            const piece *p = &force->of[i];
            const double off = fmax(fabs(p->begin - steady), fabs(p->end - steady));
            if (p->from < t->first - INSTANT) {
                continue;
            }
            if (off - p->error > 0.05 * steady + error) {
                earliest = fabs(p->end - steady) > 0.05 * steady + error + p->error
                               ? p->to
                               : p->from;
            }
            if (off + p->error > 0.05 * steady - error) {
                latest = p->to;
            }
        }
        const double settled = quantity(m, "settling_time_s");
        if (isnan(settled)) {
            expect(r, "settling_time_s is null, settled", m->ends, latest,
                   m->ends - 2 * spacing, (double)INFINITY);
        } else {
            expect(r, "settling_time_s", m->ends, settled, earliest - t->first - INSTANT,
                   latest - t->first + INSTANT);
        }
    }
}

// Whether the commanded force is the same all the time.
static bool commands_one_force(const rig *r)
{
    bool one = number(r, "control.force_amplitude") == 0;
    for (int k = 0; k < r->change_count; k++) {
        one = one && strcmp(r->changes[k].path, "control.force") != 0;
    }
    return one;
}

// The largest mean of the force over 5 ms, impulses included, with windows from 20 ms
// after first contact on: bounds of it.
static void check_smoothed(rig *r, const motion *m, const pieces *force,
                           const blow_list *impulses, const touches *t)
{
    const double window = 0.005, from = t->first + 0.02;
    const double said = quantity(m, "smoothed_over_command_N");
    const double wanted = quantity(m, "force_command_N");
    if (isnan(said) || m->ends < from + window || !commands_one_force(r)) {
        return;
    }

    // running integral at the ends of pieces
    double *sum = malloc((force->count + 1) * sizeof(double)), low = -(double)INFINITY,
           high = -(double)INFINITY;
    double error = 0;
    sum[0] = 0;
    for (size_t i = 0; i < force->count; i++) {
        const piece *p = &force->of[i];
        sum[i + 1] = sum[i] + (p->to - p->from) * (p->begin + p->end) / 2;
        error = fmax(error, p->error);
    }

    // windows that end with a piece or begin with one, and with each impulse at an end
    size_t tail = 0;
    for (size_t i = 0; i < force->count; i++) {
        const double end = force->of[i].to, begin = end - window;
        if (begin < from - spacing) {
            continue;
        }
        while (force->of[tail].to < begin) {
            tail++;
        }
        const piece *p = &force->of[tail];
        const double part = (p->to - begin) * (value_within(p, begin) + p->end) / 2 +
                            sum[i + 1] - sum[tail + 1];
        double struck = 0, perhaps = 0;
        for (size_t k = 0; k < impulses->count; k++) {
            const double at = impulses->of[k].time;
            struck += at > begin + 1e-12 && at < end + 1e-12 ? impulses->of[k].size : 0;
            perhaps +=
                at > begin - spacing && at < end + spacing ? impulses->of[k].size : 0;
        }
        if (begin >= from) {
            low = fmax(low, (part + struck) / window);
        }
        const double rest = 2 * spacing * (fabs(force->of[i].end) + fabs(p->begin));
        high = fmax(high, (part + perhaps + rest) / window);
    }
    free(sum);
    const double slack = error + 1e-9 * fabs(high) + 1e-9;
    expect(r, "smoothed_over_command_N", from, said + wanted, low - slack, high + slack);
    expect(r, "smoothed within peak and impulses", from, said + wanted, -(double)INFINITY,
           peak_of(m) + t->impulses / window + 1e-9);
}

// The largest reading of a sensor of 1 ms, of all that the force does.
static void check_sensor_peak(rig *r, const motion *m, const pieces *force,
                              const blow_list *impulses)
{
    const char *key = "sensor_1ms_peak_N";
    if (!has_quantity(m, key)) {
        return;
    }
    double low = -(double)INFINITY, high = -(double)INFINITY;
    follower f = {.of = force, .blows = impulses, .state = {.T = 1e-3}};
    for (size_t i = 0; i < force->count; i++) {
        const double end = force->of[i].to;
        follower_reach(&f, end);
        lag after = f.state;
        for (size_t k = f.blow;
             k < impulses->count && impulses->of[k].time <= end + 1e-13; k++) {
            lag_take_blow(&after, impulses->of[k].size);
        }
        const double above =
            turning(&f.state, &force->of[i], force->of[i].to - force->of[i].from);
        low = fmax(low, after.y - after.y_error);
        high = fmax(high, fmax(after.y, f.state.y + above) + after.y_error);
    }
    if (impulses->count == 0 && high < 1e-9) {
        return;
    }
    const double slack = FOLLOWED_PEAK * fabs(high) + 1e-9;
    expect(r, key, 0, quantity(m, key), low - slack, high + slack);
}

double largest_of(const motion *m, const double *column, double sign)
{
    double most = -(double)INFINITY;
    for (size_t i = 0; i < m->count; i++) {
        most = fmax(most, sign * column[i]);
    }
    return most;
}

// The largest speed towards the wall up to an instant, or beyond it without contact.
static largest speed_towards(const motion *m, bool before, double t)
{
    largest l = {-(double)INFINITY, -(double)INFINITY};
    pieces gap_rate = pieces_of(m, m->of[GAP_VELOCITY]);
    for (size_t i = 0; i < m->count; i++) {
        const double at = m->of[TIME][i];
        if (before ? at <= t && m->of[CONTACT][i] == 0
                   : at > t && m->of[CONTACT][i] == 0) {
            l.low = fmax(l.low, -m->of[GAP_VELOCITY][i]);
        }
    }
    double error = 0;
    for (size_t i = 0; i < gap_rate.count; i++) {
        error = fmax(error, gap_rate.of[i].error);
    }
    free(gap_rate.of);
    l.high = l.low + error;
    return l;
}

// The largest speed towards a face in flights after an instant: a mean between two rows
// is below it, by no more than means of neighbours differ.
static largest speed_towards_face(const motion *m, double t)
{
    double before = (double)NAN, apart = 0, most = 0;
    for (size_t i = 0; i + 1 < m->count; i++) {
        const double h = m->of[TIME][i + 1] - m->of[TIME][i];
        const bool flight = m->of[CONTACT][i] == 0 && m->of[CONTACT][i + 1] == 0;
        if (m->of[TIME][i] <= t || !flight || h < spacing / 4) {
            before = flight ? before : (double)NAN;
            continue;
        }
        const double speed = (gap_to_face(m, i) - gap_to_face(m, i + 1)) / h;
        most = fmax(most, speed);
        apart = fmax(apart, or_zero(fabs(speed - before)));
        before = speed;
    }
    return (largest){most, most + 2 * apart};
}

// Numbers of the command and of the speeds.
static void check_law(rig *r, const motion *m, const touches *t)
{
    // what was commanded; with a law only
    if (m->sample_count == 0) {
        return;
    }
    const double wanted = number_at(r, "control.force", m->ends),
                 peak = quantity(m, "peak_force_N");
    expect_near(r, "force_command_N", m->ends, quantity(m, "force_command_N"), wanted,
                1e-9);
    if (!isnan(peak) && commands_one_force(r)) {
        expect_near(r, "force_over_command_N", 0, quantity(m, "force_over_command_N"),
                    peak - wanted, 1e-9);
    }
    if (!isnan(t->first) && commands_one_force(r)) {
        expect_near(r, "steady_error_N", 0, quantity(m, "steady_error_N"),
                    quantity(m, "steady_force_N") - wanted, 1e-9);
    }
    const double command =
        fmax(largest_of(m, m->of[VOLTAGE], 1), largest_of(m, m->of[VOLTAGE], -1));
    expect_near(r, "largest_command_V", 0, quantity(m, "largest_command_V"), command,
                1e-9);

    // speeds
    largest l = speed_towards(m, true, isnan(t->first) ? m->ends : t->first);
    expect(r, "approach_speed_m_s", 0, quantity(m, "approach_speed_m_s"), l.low - 1e-9,
           l.high + 1e-9);
    if (!isnan(t->first)) {
        const bool gives = !isnan(m->of[FACE_DEPTH][m->count - 1]);
        l = gives ? speed_towards_face(m, t->first) : speed_towards(m, false, t->first);
        const double said = or_zero(quantity(m, "return_speed_m_s"));
        expect(r, "return_speed_m_s", 0, said, fmax(0, l.low) - 1e-9,
               fmax(0, l.high) + 1e-9);
    }
}

static void check_depth(rig *r, const motion *m)
{
    const bool rigid = is(r, "wall.contact", "rigid");
    const double deepest = fmax(0, largest_of(m, m->of[GAP], -1));
    pieces gap = pieces_of(m, m->of[GAP]);
    double error = 1e-12;
    for (size_t i = 0; i < gap.count; i++) {
        error = fmax(error, gap.of[i].begin < 0 ? gap.of[i].error : 0);
    }
    free(gap.of);
    expect(r, "max_penetration_m", 0, quantity(m, "max_penetration_m"), deepest - 1e-12,
           rigid ? 1e-9 : deepest + error);
    const double loss = quantity(m, "wall_loss_J");
    if (!isnan(loss)) {
        expect_near(r, "wall_loss_J", m->ends, loss, m->of[WALL_LOSS][m->count - 1],
                    1e-15);
    }
}

// Impulses and losses of impacts on a wall at rest: those of events, of rows, and by the
// formula.
static void check_impacts(rig *r, const motion *m)
{
    double impulses = 0, losses = 0, of_rows = 0, heaviest = 0;
    const bool at_rest = is(r, "wall.motion", "none") && number(r, "wall.mass") == 0;
    const double rest_speed = number(r, "method.rest_speed");
    bool chatter = false;
    for (size_t i = 0; i < impactlab_run_event_count(m->run); i++) {
        impactlab_event e;
        impactlab_run_event(m->run, i, &e);
        chatter = chatter || strcmp(e.kind, "chatter") == 0;
    }
    for (size_t i = 0; i < impactlab_run_event_count(m->run); i++) {
        impactlab_event e;
        impactlab_run_event(m->run, i, &e);
        if (strcmp(e.kind, "impact") != 0) {
            continue;
        }
        impulses += e.impulse;
        losses += e.loss;
        heaviest = fmax(heaviest, e.impulse);
        if (at_rest && !chatter) {
            const double restitution =
                e.speed < rest_speed ? 0 : number(r, "wall.restitution");
            const double loss = e.impulse * (1 - restitution) * e.speed / 2;
            expect_near(r, "loss of an impact", e.time, e.loss, loss,
                        1e-9 * loss + 1e-15);
        }
    }
    for (size_t i = 0; i < m->count; i++) {
        of_rows += or_zero(m->of[IMPULSE][i]);
    }
    expect_near(r, "impulses of the rows", m->ends, of_rows, impulses,
                1e-12 * (1 + impulses));
    expect_near(r, "impact_loss", m->ends, m->of[IMPACT_LOSS][m->count - 1], losses,
                1e-12 * (1 + losses));
}

void check_contact_law(rig *r, const motion *m)
{
    const bool linear = is(r, "wall.contact", "kelvin-voigt");
    if (is(r, "wall.contact", "rigid") || number(r, "wall.mass") > 0) {
        return;
    }
    const double k = number(r, "wall.stiffness"), c = number(r, "wall.damping");
    const double n = number(r, "wall.exponent");
    for (size_t i = 0; i < m->count; i++) {
        const double x = -m->of[GAP][i], v = -m->of[GAP_VELOCITY][i];
        if (m->of[CONTACT][i] != 0 && x > 0) {
            const double power = linear ? 1 : pow(x, n);
            const double force = linear ? k * x + c * v : power * (k + c * v);
            const double parts = (linear ? k * x : k * power) + c * power * fabs(v);
            expect_near(r, "force of the wall", m->of[TIME][i], m->of[FORCE][i], force,
                        1e-9 * parts + 1e-9);
        }
    }
}

void check_summary(rig *r, const motion *m, const pieces *force,
                   const blow_list *impulses)
{
    const touches t = touches_of(m);
    expect_near(r, "first_contact_s", 0, quantity(m, "first_contact_s"), t.first, 1e-12);
    expect_near(r, "impacts", 0, quantity(m, "impacts"), t.impacts, 0);
    expect_near(r, "contact_impulse_Ns", 0, quantity(m, "contact_impulse_Ns"),
                isnan(t.first) ? (double)NAN : t.impulse, 1e-12);
    check_depth(r, m);
    check_impacts(r, m);
    check_law(r, m, &t);
    if (isnan(t.first)) {
        return;
    }
    const double until = isnan(t.release) ? m->ends : t.release;
    check_peak(r, m, force, "peak_force_N", "time_to_peak_s", t.first, m->ends);
    if (quantity(m, "first_pulse_peak_N") > 0) {
        check_peak(r, m, force, "first_pulse_peak_N", "first_pulse_time_to_peak_s",
                   t.first, until);
    }
    expect_near(r, "first_pulse_s", 0, quantity(m, "first_pulse_s"), t.release - t.first,
                1e-12);
    check_separations(r, m, t.first);
    check_steady(r, m, force, &t);
    check_smoothed(r, m, force, impulses, &t);
    check_sensor_peak(r, m, force, impulses);
}
