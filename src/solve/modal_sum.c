#include "src/solve/modal_sum.h"

#include <math.h>
#include <string.h>

#include "src/base/sincos.h"
#include "src/solve/modal_response.h"

#define PHASE_A_STEP 1     // of the fastest vibration that matters [rad]
#define SHARE_A_STEP 0.25  // of the stride, in which no mode of the series turns by more than 1 rad
#define NEGLIGIBLE   1e-17 // share of all amplitudes that is passed over for good

enum { COARSEST = 6, LANES = 4 };

// --- the vibrations of a basis ------------------------------------------------------------------

size_t modal_vibrations_size(int n)
{
    const size_t entries = 2 * (size_t)n;
    return entries * (5 + 2 * MODAL_LEVELS);
}

void modal_vibrations_place(modal_vibrations *v, int n, double *storage)
{
    const size_t entries = 2 * (size_t)n;
    memset(v, 0, sizeof *v);
    v->limit = 2 * n;
    v->decay = storage;
    v->turn = storage + entries;
    v->square = storage + 2 * entries;
    v->octave = (int *)(storage + 3 * entries);
    v->entry = (int *)(storage + 4 * entries);
    v->cosine = storage + 5 * entries;
    v->sine = v->cosine + MODAL_LEVELS * entries;
}

static void set_entry(modal_vibrations *v, int entry, double decay, double turn)
{
    int octave = 0;
    v->decay[entry] = decay;
    v->turn[entry] = turn;
    v->square[entry] = decay * decay + turn * turn;
    if (v->square[entry] > 0) {
        (void)frexp(sqrt(v->square[entry]), &octave);
    }
    octave = octave < 0 ? 0 : octave;
    v->octave[entry] = octave < MODAL_OCTAVES ? octave : MODAL_OCTAVES - 1;
}

void modal_vibrations_compute(modal_vibrations *v, const modal_basis *b, const double *damping)
{
    const int modes = b->across >= 0 ? b->across : b->count;
    memset(v->known, 0, sizeof v->known);

    // vibrating modes
    v->vibrating = v->overdamped = 0;
    for (int k = 0; k < modes; k++) {
        const double w = b->rate[k], a = damping[k];
        v->entry[k] = -1;
        if (w > 0 && a < w) {
            v->entry[k] = v->vibrating++;
            set_entry(v, v->entry[k], a, fmax(sqrt((w - a) * (w + a)), MODAL_NEAR_CRITICAL * w));
        } else if (w > 0) {
            v->overdamped++;
        }
    }

    // overdamped ones
    for (int k = 0, i = 0; k < modes; k++) {
        const double w = b->rate[k], a = damping[k];
        if (w > 0 && a >= w) {
            const double root = fmax(sqrt((a - w) * (a + w)), MODAL_NEAR_CRITICAL * w);
            v->entry[k] = v->vibrating + i++;
            set_entry(v, v->entry[k], w * w / (a + root), 0);
            set_entry(v, v->entry[k] + v->overdamped, a + root, 0);
        }
    }
    v->count = v->vibrating + 2 * v->overdamped;
}

// What a step of 2^-level s does to every vibration, computed when it is first wanted.
static void know_level(modal_vibrations *v, int level)
{
    if (v->known[level]) {
        return;
    }

    // decay and turn in one complex factor
    const double step = ldexp(1, -level);
    double *cosine = v->cosine + (size_t)level * (size_t)v->limit;
    double *sine = v->sine + (size_t)level * (size_t)v->limit;
    for (int e = 0; e < v->count; e++) {
        double s, c;
        const double keep = modal_decay(-v->decay[e] * step);
        inline_sincos(v->turn[e] * step, &s, &c);
        cosine[e] = keep * c;
        sine[e] = keep * s;
    }
    v->known[level] = true;
}

// --- values -------------------------------------------------------------------------------------

static glance series_at(const modal_sum *f, double t, double *curve)
{
    const double x = t / f->length;
    double value = 0, slope = 0, half = 0;
    for (int j = f->terms - 1; j >= 0; j--) {
        half = half * x + slope;
        slope = slope * x + value;
        value = value * x + f->series[j];
    }
    if (curve != NULL) {
        *curve = 2 * half / (f->length * f->length);
    }
    return (glance){value, slope / f->length};
}

glance modal_sum_at(const modal_sum *f, double t)
{
    const modal_vibrations *v = f->vibrations;
    glance sum = series_at(f, t, NULL);
    for (int e = f->first; e < f->last; e++) {
        double s, c;
        const double keep = modal_decay(-v->decay[e] * t);
        inline_sincos(v->turn[e] * t, &s, &c);
        const double a = keep * (f->cosine[e] * c + f->sine[e] * s);
        const double b = keep * (f->sine[e] * c - f->cosine[e] * s);
        sum.value += a;
        sum.slope += v->turn[e] * b - v->decay[e] * a;
    }
    return sum;
}

// f where the walk is, from the amplitudes there; four sums at a time.
static void evaluate(modal_sum *f)
{
    const modal_vibrations *v = f->vibrations;
    double value[LANES] = {0}, slope[LANES] = {0};
    int e = f->first;

    // separate sums, so that no addition waits for another
    for (; e + LANES <= f->last; e += LANES) {
        for (int i = 0; i < LANES; i++) {
            value[i] += f->a[e + i];
            slope[i] += v->turn[e + i] * f->b[e + i] - v->decay[e + i] * f->a[e + i];
        }
    }
    for (; e < f->last; e++) {
        value[0] += f->a[e];
        slope[0] += v->turn[e] * f->b[e] - v->decay[e] * f->a[e];
    }

    // the series adds what does not vibrate
    f->now = series_at(f, f->time, NULL);
    f->now.value += (value[0] + value[1]) + (value[2] + value[3]);
    f->now.slope += (slope[0] + slope[1]) + (slope[2] + slope[3]);
}

// --- walks --------------------------------------------------------------------------------------

// Entries at the end of what takes part that will never matter again.
static void drop_negligible(modal_sum *f)
{
    const double limit = NEGLIGIBLE * modal_sum_reach(f);
    while (f->last > f->first && fabs(f->a[f->last - 1]) + fabs(f->b[f->last - 1]) <= limit) {
        f->last--;
    }
}

void modal_sum_begin(modal_sum *f)
{
    const size_t size = (size_t)(f->last - f->first) * sizeof(double);
    f->time = 0;
    memcpy(f->a + f->first, f->cosine + f->first, size);
    memcpy(f->b + f->first, f->sine + f->first, size);

    // a bound on the third derivative of the series
    f->bend = 0;
    for (int j = 3; j < f->terms; j++) {
        f->bend += fabs(f->series[j]) * j * (j - 1) * (j - 2);
    }
    f->bend /= f->length * f->length * f->length;
    drop_negligible(f);
    evaluate(f);
}

void modal_sum_step(modal_sum *f, int level)
{
    modal_vibrations *v = f->vibrations;
    know_level(v, level);
    const double *restrict cosine = v->cosine + (size_t)level * (size_t)v->limit;
    const double *restrict sine = v->sine + (size_t)level * (size_t)v->limit;
    double *restrict a = f->a, *restrict b = f->b;

    // each turns and decays by its own factor
    for (int e = f->first; e < f->last; e++) {
        const double x = a[e], y = b[e];
        a[e] = x * cosine[e] + y * sine[e];
        b[e] = y * cosine[e] - x * sine[e];
    }
    f->time += ldexp(1, -level);
    evaluate(f);
}

double modal_sum_reach(const modal_sum *f)
{
    double all = 0;
    for (int e = f->first; e < f->last; e++) {
        all += sqrt(f->a[e] * f->a[e] + f->b[e] * f->b[e]);
    }
    return all;
}

// --- how far to leap
// ------------------------------------------------------------------------------

// The level of the longest step that is not beyond h.
static int level_of(double h)
{
    int level;
    if (!(h > 0)) {
        return MODAL_LEVELS;
    }
    (void)frexp(h, &level); // 2^(level-1) <= h < 2^level
    level = 1 - level;
    return level < COARSEST ? COARSEST : level > MODAL_LEVELS ? MODAL_LEVELS : level;
}

// Largest h with value + slope h - bend h^2 / 2 > 0 in (0, h].
static double leap_of(double value, double slope, double bend)
{
    if (!(value > 0)) {
        return 0;
    }
    const double root = sqrt(slope * slope + 2 * bend * value);
    return slope > 0 ? (slope + root) / fmax(bend, 1e-300) : 2 * value / fmax(root - slope, 1e-300);
}

// The same where the bend itself grows by no more than `growth` a second, as far as `most`.
static double certain_leap(double value, double slope, double bend, double growth, double most)
{
    double h = fmin(leap_of(value, slope, bend), most);
    h = fmin(leap_of(value, slope, bend + growth * h), h);
    return fmin(leap_of(value, slope, bend + growth * h), most);
}

int modal_sum_leap(const modal_sum *f, double sign, double edge, double slack, int *fine)
{
    const modal_vibrations *v = f->vibrations;
    double size[MODAL_OCTAVES] = {0}, bend[MODAL_OCTAVES] = {0}, value[MODAL_OCTAVES] = {0};
    double slope[MODAL_OCTAVES] = {0};

    // amplitudes, values and bends by octave of the rate
    for (int e = f->first; e < f->last; e++) {
        const int o = v->octave[e];
        const double amplitude = sqrt(f->a[e] * f->a[e] + f->b[e] * f->b[e]);
        size[o] += amplitude;
        bend[o] += amplitude * v->square[e];
        value[o] += f->a[e];
        slope[o] += v->turn[e] * f->b[e] - v->decay[e] * f->a[e];
    }

    // the fastest that matter
    double passed = 0;
    int top = MODAL_OCTAVES - 1;
    while (top > 0 && passed + size[top] <= slack) {
        passed += size[top--];
    }
    *fine = level_of(fmin(size[top] > 0 ? ldexp(PHASE_A_STEP, -top) : 1, SHARE_A_STEP * f->length));
    *fine = *fine < MODAL_LEVELS ? *fine : MODAL_LEVELS - 1;

    // the series, and more and more octaves, as they bend; the others by their amplitudes
    double curve, beyond = 0;
    const glance slow = series_at(f, f->time, &curve);
    for (int o = 0; o < MODAL_OCTAVES; o++) {
        beyond += size[o];
    }
    double height = sign * (slow.value - edge), climb = sign * slow.slope, bends = fabs(curve);
    double farthest = certain_leap(height - beyond, climb, bends, f->bend, f->length);
    for (int o = 0; o < MODAL_OCTAVES; o++) {
        if (size[o] > 0) {
            beyond = fmax(beyond - size[o], 0);
            height += sign * value[o];
            climb += sign * slope[o];
            bends += bend[o];
            farthest =
                fmax(farthest, certain_leap(height - beyond, climb, bends, f->bend, f->length));
        }
    }
    return level_of(farthest);
}
