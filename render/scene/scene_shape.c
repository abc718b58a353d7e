// The arm's shape over time: its joints at an instant, the curve of its beam, and the
// instants at which a picture shows it.
#include <assert.h>
#include <math.h>

#include "render/scene/scene_parts.h"

enum { CURVE_PIECES = 96 }; // of a beam with few links

#define LARGEST_BEND (1 / 12.0) // of a bend that is enlarged by itself [beam lengths]

static double between(double a, double b, double share)
{
    return a + share * (b - a);
}

// Joints and row at an instant, linear between two rows of the trace.
sample scene_joints(const trace *t, const parameters *p, double time, vector *joints)
{
    assert(t->row_count > 0 && isfinite(time));
    size_t links = (size_t)p->arm.links, first = (size_t)t->angle_count - links;
    double lengths[PARAMETER_LINKS_MOST];

    // the rows on both sides of the instant, one row before the first and after the last
    const size_t until = trace_rows_until(t, time);
    size_t before = 0, after = 0;
    if (until > 0) {
        before = until - 1;
        after = MIN(until, t->row_count - 1);
    }

    // and the share of the second
    const double span = t->rows[after].time - t->rows[before].time;
    double share = 0;
    if (span > 0) {
        share = (time - t->rows[before].time) / span;
    }
    const double *a = t->angles + before * (size_t)t->angle_count + first;
    const double *b = t->angles + after * (size_t)t->angle_count + first;
    parameters_link_lengths(&p->arm, lengths);

    // link by link from the hub
    joints[0] = (vector){0};
    for (size_t k = 0; k < links; k++) {
        double angle = between(a[k], b[k], share);
        joints[k + 1] =
            vector_sum(joints[k], lengths[k], (vector){cos(angle), sin(angle), 0});
    }

    // the row between the two
    sample row = t->rows[before];
    const sample *next = &t->rows[after];
    row.time = time;
    row.hub_angle = between(row.hub_angle, next->hub_angle, share);
    row.first_angle = between(row.first_angle, next->first_angle, share);
    row.last_angle = between(row.last_angle, next->last_angle, share);
    row.force = between(row.force, next->force, share);
    row.wall_place = between(row.wall_place, next->wall_place, share);
    return row;
}

vector scene_wall_shift(const parameters *p, const sample *row)
{
    if (isnan(row->wall_place)) {
        return (vector){0};
    }
    const double place = row->wall_place;
    return (vector){place * sin(p->wall.angle), -place * cos(p->wall.angle), 0};
}

void scene_exaggerate(vector *joints, int links, double factor)
{
    assert(links > 0 && factor >= 0);
    const vector along = vector_unit(vector_sum(joints[links], -1, joints[0]));
    const vector across = {-along.y, along.x, 0};
    for (int i = 0; i <= links && factor > 0; i++) {
        const double off = vector_dot(vector_sum(joints[i], -1, joints[0]), across);
        joints[i] = vector_sum(joints[i], (factor - 1) * off, across);
    }
}

// The largest distance of a beam's curve from the line from hub to tip [m]. A factor
// enlarges it as it does the joints' distances.
static double bend_of(const vector *joints, int links, vector *curve)
{
    const int count = scene_curve(joints, links, curve);
    const vector along = vector_unit(joints[links]);
    double bend = 0;
    for (int i = 0; i < count; i++) {
        bend = fmax(bend, fabs(along.x * curve[i].y - along.y * curve[i].x));
    }
    return bend;
}

double scene_bending_auto(const scenario *s, const run_result *result)
{
    enum { LOOKS = 500, FACTORS = 7 };
    static const double factors[FACTORS] = {1, 2, 5, 10, 20, 50, 100};
    const trace *t = &result->trace;
    const int links = s->parameters.arm.links;
    g_autofree vector *joints = g_new(vector, links + 1);
    g_autofree vector *curve = g_new(vector, scene_curve_length(links));

    // the largest bend of the run
    double bend = 0;
    for (int i = 0; i < LOOKS && t->row_count > 0; i++) {
        const size_t row = (t->row_count - 1) * (size_t)i / (LOOKS - 1);
        scene_joints(t, &s->parameters, t->rows[row].time, joints);
        bend = fmax(bend, bend_of(joints, links, curve));
    }

    // the largest factor that leaves the arm an arm; of a rigid one rounding is no bend
    double factor = 1;
    for (int i = 0; i < FACTORS && bend > 1e-6 * s->parameters.arm.length; i++) {
        if (factors[i] * bend <= LARGEST_BEND * s->parameters.arm.length) {
            factor = factors[i];
        }
    }
    return factor;
}

// The parabolas of a beam's curve: one for each joint between two links.
static int span_count(int links)
{
    return MAX(links - 1, 1);
}

static int pieces_of_span(int links)
{
    return MAX(CURVE_PIECES / span_count(links), 1);
}

int scene_curve_length(int links)
{
    return span_count(links) * pieces_of_span(links) + 1;
}

// A quadratic B-spline over the joints: a parabola from each link's middle to the next's.
int scene_curve(const vector *joints, int links, vector *curve)
{
    assert(links > 0);
    const int spans = span_count(links), pieces = pieces_of_span(links);
    int count = 0;

    for (int span = 0; span < spans; span++) {
        // a parabola from a link's middle to the next one's, with the joint as its
        // control point
        vector bend = joints[span + 1];
        if (links == 1) {
            bend = vector_scaled(vector_add(joints[0], joints[1]), 0.5);
        }

        // it starts at a joint of its own only where the arm starts, and ends at one
        // where it ends
        vector from = joints[span], to = joints[links];
        if (span > 0) {
            from = vector_scaled(vector_add(joints[span], bend), 0.5);
        }
        if (span + 1 < spans) {
            to = vector_scaled(vector_add(bend, joints[span + 2]), 0.5);
        }

        // neighbouring pieces share their point
        const int first = span == 0 ? 0 : 1;
        for (int i = first; i <= pieces; i++) {
            double s = (double)i / pieces, r = 1 - s;
            vector place = vector_sum(vector_scaled(from, r * r), 2 * r * s, bend);
            curve[count++] = vector_sum(place, s * s, to);
        }
    }
    return count;
}

// When the approach ends: where the force is largest, or at the end of a run without
// contact.
static double end_of_approach(const run_result *result)
{
    const summary *m = &result->summary;
    const double end = result->trace.rows[result->trace.row_count - 1].time;
    if (isnan(m->first_contact_s)) {
        return end;
    }

    // of the first pulse; of one that never ends the peak of the whole run
    double delay = m->first_pulse_time_to_peak_s;
    if (isnan(delay)) {
        delay = m->time_to_peak_s;
    }
    if (isnan(delay)) {
        delay = 0;
    }
    return fmin(end, m->first_contact_s + delay);
}

// Instants at which the tip has gone even parts of its path to the largest force.
void scene_instants(const run_result *result, double *times, int count)
{
    assert(result->trace.row_count > 0 && count > 0);
    const trace *t = &result->trace;
    const double end = end_of_approach(result);
    double path = 0, done = 0;

    // the length of the tip's path, as an angle
    size_t last = trace_row_at(t, end);
    for (size_t i = 1; i <= last; i++) {
        path += fabs(t->rows[i].last_angle - t->rows[i - 1].last_angle);
    }

    // instants at even parts of it
    times[0] = t->rows[0].time;
    size_t row = 0;
    for (int k = 1; k < count; k++) {
        double wanted = path * k / (count - 1);
        while (row < last && done + 1e-12 < wanted) {
            row++;
            done += fabs(t->rows[row].last_angle - t->rows[row - 1].last_angle);
        }
        if (path > 0) {
            times[k] = t->rows[row].time;
        } else {
            times[k] = end * k / (count - 1);
        }
    }
    times[count - 1] = end;
}
