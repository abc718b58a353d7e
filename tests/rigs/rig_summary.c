// Numbers of the summary, computed again from rows and events.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tests/rigs/random_rigs.h"

// What the events of a run say of its contacts.
typedef struct touches {
    double first;    // the first contact [s]; NaN if there is none
    double release;  // the end of that contact [s]; NaN if it lasts
    int impacts;     // how many there were
    double impulse;  // of the first impact [N s]
    double impulses; // of all impacts [N s]
} touches;

// Goes through the events of a run. An impact is the first contact and its end in one,
// unless an event "contact" at the same instant says that contact goes on after it.
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
            t.release = (double)NAN;
        }
        if (isnan(t.release) && strcmp(e.kind, "release") == 0) {
            t.release = e.time;
        }
        if (impact) {
            if (t.impacts == 0) {
                t.impulse = e.impulse;
            }
            t.impacts++;
            t.impulses += e.impulse;
        }
    }
    return t;
}

// Bounds of the largest value of a function.
typedef struct largest {
    double low, high;
} largest;

// Bounds of the largest value within an interval. It is not below the ends of the lines
// that lie in the interval (which may be wrong where they are drawn on), and not above
// the lines that touch it and their errors.
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

// The largest force that the summary tells; 0 if it tells none, as after impacts alone.
static double peak_of(const motion *m)
{
    const double peak = quantity(m, "peak_force_N");
    return isnan(peak) ? 0 : peak;
}

// A peak of the summary, `what`, is the largest force between two instants, and the time
// it tells of it, `when`, counted from the first of them, is one at which the force may
// be that large.
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

// How often the arm leaves the wall by more than 1 um after the first contact: bounds, as
// a gap of 1 um may be told either way within a nanometre.
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

        // each leave counts once, until the arm is back at the wall
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

// The settling time: since the first contact, until the force stays within 5 % of its
// final value. A wider and a narrower band, by the error of that value and of the force,
// bound it.
static void check_settling(rig *r, const motion *m, const pieces *force, double contact,
                           double steady, double steady_error)
{
    const double wide = 0.05 * steady + steady_error,
                 narrow = 0.05 * steady - steady_error;
    double earliest = contact, latest = contact;
    for (size_t i = 0; i < force->count; i++) {
        const piece *p = &force->of[i];
        if (p->from < contact - INSTANT) {
            continue;
        }

        // outside the wide band at an end of this piece
        const double off_at_end = fabs(p->end - steady);
        const double farthest = fmax(fabs(p->begin - steady), off_at_end);
        if (farthest - p->error > wide) {
            earliest = off_at_end > wide + p->error ? p->to : p->from;
        }

        // perhaps outside the narrow band
        if (farthest + p->error > narrow) {
            latest = p->to;
        }
    }

    // a summary without a settling time: the force leaves the band until the end
    const double settled = quantity(m, "settling_time_s");
    if (isnan(settled)) {
        expect(r, "settling_time_s is null, settled", m->ends, latest,
               m->ends - 2 * spacing, (double)INFINITY);
    } else {
        expect(r, "settling_time_s", m->ends, settled, earliest - contact - INSTANT,
               latest - contact + INSTANT);
    }
}

// The steady force, which is the mean over the last 0.1 s; overshoot and settling time,
// which are relative to it.
static void check_steady(rig *r, const motion *m, const pieces *force, const touches *t)
{
    // the mean
    double error;
    const double span = fmin(0.1, m->ends);
    const double steady = integral(force, m->ends - span, m->ends, &error) / span;
    const double said = quantity(m, "steady_force_N"), peak = peak_of(m);
    error = error / span + 1e-9 * (1 + fabs(steady));
    expect_near(r, "steady_force_N", m->ends, said, steady, error);
    expect(r, "steady within peak", m->ends, said, -1e-9, peak * (1 + 1e-9) + 1e-9);

    // shares of a force near zero say nothing
    if (steady > 1e-3) {
        const double over = 100 * (peak - steady) / steady;
        expect_near(r, "force_overshoot_percent", m->ends,
                    quantity(m, "force_overshoot_percent"), over,
                    100 * peak / steady * (error / steady + 1e-9));
        check_settling(r, m, force, t->first, steady, error);
    }
}

// Whether the commanded force is constant: no wave upon it, and no change of it.
static bool has_constant_command(const rig *r)
{
    for (int k = 0; k < r->change_count; k++) {
        if (strcmp(r->changes[k].path, "control.force") == 0) {
            return false;
        }
    }
    return number(r, "control.force_amplitude") == 0;
}

// The largest mean of the force over a window of 5 ms, impulses included, of all windows
// that begin 20 ms after the first contact or later. It lies between the largest mean of
// the windows that end with a piece, and the same with all that a window which lies
// elsewhere by less than a spacing may have more.
static void check_smoothed(rig *r, const motion *m, const pieces *force,
                           const blow_list *impulses, const touches *t)
{
    const double window = 0.005, from = t->first + 0.02;
    const double said = quantity(m, "smoothed_over_command_N");
    const double wanted = quantity(m, "force_command_N");
    if (isnan(said) || m->ends < from + window || !has_constant_command(r)) {
        return;
    }

    // integrals of the force from the start to the ends of pieces
    double *sum = malloc((force->count + 1) * sizeof(double));
    double error = 0;
    sum[0] = 0;
    for (size_t i = 0; i < force->count; i++) {
        const piece *p = &force->of[i];
        sum[i + 1] = sum[i] + (p->to - p->from) * (p->begin + p->end) / 2;
        error = fmax(error, p->error);
    }

    // a window for each piece, from `begin` to the end of the piece
    double low = -(double)INFINITY, high = -(double)INFINITY;
    size_t tail = 0;
    for (size_t i = 0; i < force->count; i++) {
        const double end = force->of[i].to, begin = end - window;
        if (begin < from - spacing) {
            continue;
        }

        // the force: what is left of the piece in which the window begins, and the pieces
        // after it
        while (force->of[tail].to < begin) {
            tail++;
        }
        const piece *p = &force->of[tail];
        const double part = (p->to - begin) * (value_within(p, begin) + p->end) / 2 +
                            sum[i + 1] - sum[tail + 1];

        // the impulses within the window, and those within a spacing of it as well
        double within = 0, nearby = 0;
        for (size_t k = 0; k < impulses->count; k++) {
            const double at = impulses->of[k].time, size = impulses->of[k].size;
            if (at > begin + 1e-12 && at < end + 1e-12) {
                within += size;
            }
            if (at > begin - spacing && at < end + spacing) {
                nearby += size;
            }
        }

        // both bounds
        if (begin >= from) {
            low = fmax(low, (part + within) / window);
        }
        const double rest = 2 * spacing * (fabs(force->of[i].end) + fabs(p->begin));
        high = fmax(high, (part + nearby + rest) / window);
    }
    free(sum);
    const double slack = error + 1e-9 * fabs(high) + 1e-9;
    expect(r, "smoothed_over_command_N", from, said + wanted, low - slack, high + slack);
    expect(r, "smoothed within peak and impulses", from, said + wanted, -(double)INFINITY,
           peak_of(m) + t->impulses / window + 1e-9);
}

// The peak that a sensor with a lag of 1 ms would read: the follower's largest value,
// before and after the impulses at the end of each piece. Between these ends it may be
// higher where it turns.
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
        // just before the end of the piece, and just after the impulses there
        const double end = force->of[i].to;
        follower_reach(&f, end);
        lag after = f.state;
        for (size_t k = f.blow;
             k < impulses->count && impulses->of[k].time <= end + 1e-13; k++) {
            lag_take_blow(&after, impulses->of[k].size);
        }

        // both bounds
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

// Bounds of the largest speed towards the wall in free flight, over the instants with
// after < t <= until.
static largest speed_towards_wall(const motion *m, double after, double until)
{
    largest l = {-(double)INFINITY, -(double)INFINITY};
    pieces gap_rate = pieces_of(m, m->of[GAP_VELOCITY]);
    for (size_t i = 0; i < m->count; i++) {
        const double t = m->of[TIME][i];
        if (t > after && t <= until && m->of[CONTACT][i] == 0) {
            l.low = fmax(l.low, -m->of[GAP_VELOCITY][i]);
        }
    }

    // between two rows it may be higher
    double error = 0;
    for (size_t i = 0; i < gap_rate.count; i++) {
        error = fmax(error, gap_rate.of[i].error);
    }
    free(gap_rate.of);
    l.high = l.low + error;
    return l;
}

// Bounds of the largest speed towards the wall's own face, which moves, in flights after
// an instant. The speed between two rows is the difference of their gaps over the time.
// It is a mean, below the largest speed by no more than neighbouring means differ.
static largest speed_towards_face(const motion *m, double t)
{
    double speed_before = (double)NAN, largest_change = 0, most = 0;
    for (size_t i = 0; i + 1 < m->count; i++) {
        const double h = m->of[TIME][i + 1] - m->of[TIME][i];
        const bool flight = m->of[CONTACT][i] == 0 && m->of[CONTACT][i + 1] == 0;
        if (m->of[TIME][i] <= t || !flight || h < spacing / 4) {
            if (!flight) {
                speed_before = (double)NAN;
            }
            continue;
        }
        const double speed = (gap_to_face(m, i) - gap_to_face(m, i + 1)) / h;
        most = fmax(most, speed);
        largest_change = fmax(largest_change, or_zero(fabs(speed - speed_before)));
        speed_before = speed;
    }
    return (largest){most, most + 2 * largest_change};
}

// What the summary says of the command, and of the speeds before and after first contact.
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
    if (!isnan(peak) && has_constant_command(r)) {
        expect_near(r, "force_over_command_N", 0, quantity(m, "force_over_command_N"),
                    peak - wanted, 1e-9);
    }
    if (!isnan(t->first) && has_constant_command(r)) {
        expect_near(r, "steady_error_N", 0, quantity(m, "steady_error_N"),
                    quantity(m, "steady_force_N") - wanted, 1e-9);
    }
    const double command =
        fmax(largest_of(m, m->of[VOLTAGE], 1), largest_of(m, m->of[VOLTAGE], -1));
    expect_near(r, "largest_command_V", 0, quantity(m, "largest_command_V"), command,
                1e-9);

    // speeds
    const double contact = isnan(t->first) ? m->ends : t->first;
    largest l = speed_towards_wall(m, -(double)INFINITY, contact);
    expect(r, "approach_speed_m_s", 0, quantity(m, "approach_speed_m_s"), l.low - 1e-9,
           l.high + 1e-9);
    if (!isnan(t->first)) {
        const bool gives = !isnan(m->of[FACE_DEPTH][m->count - 1]);
        if (gives) {
            l = speed_towards_face(m, t->first);
        } else {
            l = speed_towards_wall(m, t->first, (double)INFINITY);
        }
        const double said = or_zero(quantity(m, "return_speed_m_s"));
        expect(r, "return_speed_m_s", 0, said, fmax(0, l.low) - 1e-9,
               fmax(0, l.high) + 1e-9);
    }
}

// How deep the tip enters the wall: not at all if it is rigid, and else as deep as the
// rows say, or deeper between two rows by the error of the gap there. The loss of the
// wall is that of the last row.
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

// Impulses and losses of impacts: the rows add up to what the events say, and on a wall
// at rest the loss of an impact with the speed v and the impulse J is J (1 - e) v / 2
// with the restitution e, which is 0 below the rest speed. Chatter, a series of impacts
// taken as one event, has no such formula.
static void check_impacts(rig *r, const motion *m)
{
    double impulses = 0, losses = 0, impulses_of_rows = 0;
    const bool at_rest = is(r, "wall.motion", "none") && number(r, "wall.mass") == 0;
    const double rest_speed = number(r, "method.rest_speed");

    // is there any chatter?
    bool chatter = false;
    for (size_t i = 0; i < impactlab_run_event_count(m->run); i++) {
        impactlab_event e;
        impactlab_run_event(m->run, i, &e);
        chatter = chatter || strcmp(e.kind, "chatter") == 0;
    }

    // the events
    for (size_t i = 0; i < impactlab_run_event_count(m->run); i++) {
        impactlab_event e;
        impactlab_run_event(m->run, i, &e);
        if (strcmp(e.kind, "impact") != 0) {
            continue;
        }
        impulses += e.impulse;
        losses += e.loss;
        if (at_rest && !chatter) {
            const double restitution =
                e.speed < rest_speed ? 0 : number(r, "wall.restitution");
            const double loss = e.impulse * (1 - restitution) * e.speed / 2;
            expect_near(r, "loss of an impact", e.time, e.loss, loss,
                        1e-9 * loss + 1e-15);
        }
    }

    // the rows
    for (size_t i = 0; i < m->count; i++) {
        impulses_of_rows += or_zero(m->of[IMPULSE][i]);
    }
    expect_near(r, "impulses of the rows", m->ends, impulses_of_rows, impulses,
                1e-12 * (1 + impulses));
    expect_near(r, "impact_loss", m->ends, m->of[IMPACT_LOSS][m->count - 1], losses,
                1e-12 * (1 + losses));
}

// With the depth x and its rate v a Kelvin-Voigt wall pushes with k x + c v, a
// Hunt-Crossley wall with x^n (k + c v).
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
