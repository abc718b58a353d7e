// The arm's shape over time: joints, the beam's curve through them, and instants along its way.
#include <assert.h>
#include <math.h>

#include "render/scene/scene.h"

enum { CURVE_PIECES = 96 }; // of a beam with few links

// The rows on both sides of t and the share of the second.
static size_t bracket(const trace *t, double time, size_t *after, double *share)
{
    size_t until = trace_rows_until(t, time), before = until > 0 ? until - 1 : 0;
    *after = until > 0 && until < t->row_count ? until : before;
    double span = t->rows[*after].time - t->rows[before].time;
    *share = span > 0 ? (time - t->rows[before].time) / span : 0;
    return before;
}

static double between(double a, double b, double share)
{
    return a + share * (b - a);
}

sample scene_joints(const trace *t, const parameters *p, double time, vector *joints)
{
    assert(t != NULL && t->row_count > 0 && p != NULL && joints != NULL && isfinite(time));
    size_t after, links = (size_t)p->arm.links, first = (size_t)t->angle_count - links;
    double share, lengths[PARAMETER_LINKS_MOST];
    size_t before = bracket(t, time, &after, &share);
    const double *a = t->angles + before * (size_t)t->angle_count + first;
    const double *b = t->angles + after * (size_t)t->angle_count + first;
    parameters_link_lengths(&p->arm, lengths);

    // link by link from the hub
    joints[0] = (vector){0};
    for (size_t k = 0; k < links; k++) {
        double angle = between(a[k], b[k], share);
        joints[k + 1] = vector_sum(joints[k], lengths[k], (vector){cos(angle), sin(angle), 0});
    }

    // the row between the two
    sample row = t->rows[before];
    const sample *next = &t->rows[after];
    row.time = time;
    row.hub_angle = between(row.hub_angle, next->hub_angle, share);
    row.first_angle = between(row.first_angle, next->first_angle, share);
    row.last_angle = between(row.last_angle, next->last_angle, share);
    row.force = between(row.force, next->force, share);
    return row;
}

void scene_exaggerate(vector *joints, int links, double factor)
{
    assert(joints != NULL && links > 0 && factor >= 0);
    const vector along = vector_unit(vector_sum(joints[links], -1, joints[0]));
    const vector across = {-along.y, along.x, 0};
    for (int i = 0; i <= links && factor > 0; i++) {
        const double off = vector_dot(vector_sum(joints[i], -1, joints[0]), across);
        joints[i] = vector_sum(joints[i], (factor - 1) * off, across);
    }
}

static int pieces_of_span(int links)
{
    int spans = links > 1 ? links - 1 : 1, pieces = CURVE_PIECES / spans;
    return pieces > 1 ? pieces : 1;
}

int scene_curve_length(int links)
{
    return (links > 1 ? links - 1 : 1) * pieces_of_span(links) + 1;
}

int scene_curve(const vector *joints, int links, vector *curve)
{
    assert(joints != NULL && curve != NULL && links > 0);
    int spans = links > 1 ? links - 1 : 1, pieces = pieces_of_span(links), count = 0;

    for (int span = 0; span < spans; span++) {
        // a parabola from a link's middle to the next one's, with the joint as its control point
        vector bend =
            links > 1 ? joints[span + 1] : vector_scaled(vector_add(joints[0], joints[1]), 0.5);

        // it starts at a joint of its own only where the arm starts, and ends at one where it ends
        vector from = joints[span], to = joints[links];
        if (span > 0) {
            from = vector_scaled(vector_add(joints[span], bend), 0.5);
        }
        if (span + 1 < spans) {
            to = vector_scaled(vector_add(bend, joints[span + 2]), 0.5);
        }

        // neighbouring pieces share their point
        for (int i = span > 0; i <= pieces; i++) {
            double s = (double)i / pieces, r = 1 - s;
            vector place = vector_sum(vector_scaled(from, r * r), 2 * r * s, bend);
            curve[count++] = vector_sum(place, s * s, to);
        }
    }
    return count;
}

void scene_instants(const run_result *result, double *times, int count)
{
    assert(result != NULL && result->trace.row_count > 0 && times != NULL && count > 0);
    const trace *t = &result->trace;
    const summary *m = &result->summary;
    double end = t->rows[t->row_count - 1].time, path = 0, done = 0;

    // until the force is largest, or the end of a run without contact
    if (!isnan(m->first_contact_s)) {
        double delay = isnan(m->first_pulse_time_to_peak_s) ? m->time_to_peak_s
                                                            : m->first_pulse_time_to_peak_s;
        end = fmin(end, m->first_contact_s + (isnan(delay) ? 0 : delay));
    }

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
        times[k] = path > 0 ? t->rows[row].time : end * k / (count - 1);
    }
    times[count - 1] = end;
}
