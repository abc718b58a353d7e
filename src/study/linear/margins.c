// Loop gain over frequency, and how far it stays from -1.
#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/plain_math.h"
#include "src/base/sincos.h"
#include "src/study/linear/linear.h"

// Frequencies: so many in equal ratios over so many decades below half the rate, and so many about
// each vibration, out to where it no longer shows.
enum { EVEN = 1500, DECADES = 4, ABOUT = 40, MOST_FREQUENCIES = 20000 };

static const double pi = 3.14159265358979323846;

static int rising(const void *a, const void *b)
{
    double one, other;
    memcpy(&one, a, sizeof one);
    memcpy(&other, b, sizeof other);
    return (one > other) - (one < other);
}

// Puts the frequencies of a loop with the given poles in order; returns how many.
static int choose_frequencies(const double complex *poles, int states, double period, double *w)
{
    const double most = pi / period;
    int count = 0;
    for (int i = 0; i < EVEN; i++) {
        w[count++] = most * plain_exp(-DECADES * plain_log(10) * (EVEN - 1 - i) / (EVEN - 1.0));
    }
    for (int i = 0; i < states; i++) {
        const double size = cabs(poles[i]), at = size > 0 ? carg(poles[i]) / period : 0;
        const double width = size > 0 ? fabs(plain_log(size)) / period : 0;
        for (int k = -ABOUT / 2; k <= ABOUT / 2 && at > 0 && count < MOST_FREQUENCIES; k++) {
            const double off = fmax(width, 1e-9 * at) * (plain_exp(0.3 * abs(k)) - 1);
            const double near = k < 0 ? at - off : at + off;
            if (near > 0 && near < most) {
                w[count++] = near;
            }
        }
    }
    qsort(w, (size_t)count, sizeof *w, rising);
    return count;
}

status linear_loop_response(const linear_system *loop, double period, linear_response *r, fault *f)
{
    assert(loop != NULL && period > 0 && r != NULL);
    const size_t n = (size_t)loop->states;
    *r = (linear_response){0};
    double *block = calloc(3 * MOST_FREQUENCIES, sizeof *block);
    double complex *scratch = calloc(n * (n + 1) + n + 1, sizeof *scratch);
    status code = block != NULL && scratch != NULL ? STATUS_OK : fault_no_memory(f);
    code = code == STATUS_OK ? linear_poles(loop, scratch, f) : code;
    if (code == STATUS_OK) {
        *r = (linear_response){choose_frequencies(scratch, loop->states, period, block), block,
                               (double complex *)(block + MOST_FREQUENCIES)};
        for (int i = 0; i < r->count; i++) {
            double s, c;
            inline_sincos(r->frequency[i] * period, &s, &c);
            r->gain[i] = -linear_answer(loop, 0, complex_of(c, s), scratch);
        }
    } else {
        free(block);
    }
    free(scratch);
    return code;
}

status linear_arm_response(const linear_system *s, int output, linear_response *r, fault *f)
{
    const size_t n = (size_t)s->states;
    *r = (linear_response){0};
    double *block = calloc(3 * EVEN, sizeof *block);
    double complex *scratch = calloc(n * (n + 1) + n + 1, sizeof *scratch);
    status code = block != NULL && scratch != NULL ? STATUS_OK : fault_no_memory(f);
    code = code == STATUS_OK ? linear_poles(s, scratch, f) : code;
    if (code != STATUS_OK) {
        free(block);
        free(scratch);
        return code;
    }

    // poles come in rising order of their size
    double low = 1, high = 1;
    for (size_t i = n; i-- > 0;) {
        low = cabs(scratch[i]) > 1e-6 ? cabs(scratch[i]) : low;
        high = fmax(high, cabs(scratch[i]));
    }
    *r = (linear_response){EVEN, block, (double complex *)(block + EVEN)};
    for (int i = 0; i < EVEN; i++) {
        block[i] = 0.01 * low * plain_pow(1000 * high / low, i / (EVEN - 1.0));
        r->gain[i] = linear_answer(s, output, complex_of(0, block[i]), scratch);
    }
    free(scratch);
    return STATUS_OK;
}

static double decibels(double ratio)
{
    return 20 * plain_log(ratio) / plain_log(10);
}

// Takes in a place at which the loop gain is real and negative.
static void cross_phase(linear_margins *m, double gain)
{
    const double db = decibels(1 / gain);
    if (db >= 0) {
        m->gain_db = fmin(m->gain_db, db);
    } else {
        m->gain_down_db = fmin(m->gain_down_db, -db);
    }
}

// And one at which its size is one.
static void cross_gain(linear_margins *m, double complex gain, double w)
{
    const double left = plain_atan2(-cimag(gain), -creal(gain)); // beyond -180 degrees
    m->phase_deg = fmin(m->phase_deg, fabs(left) * 180 / pi);
    m->delay_s = fmin(m->delay_s, (left >= 0 ? left : left + 2 * pi) / w);
}

linear_margins linear_margins_of(const linear_response *r)
{
    assert(r != NULL);
    linear_margins m = {HUGE_VAL, HUGE_VAL, HUGE_VAL, HUGE_VAL, HUGE_VAL};
    for (int i = 0; i < r->count; i++) {
        const double complex here = r->gain[i];
        m.disk = fmin(m.disk, 2 * cabs(1 + here) / cabs(1 - here));

        // at both ends a sampled loop gain is real, up to rounding
        const bool real = fabs(cimag(here)) < 1e-9 * cabs(here);
        if (i + 1 >= r->count || i == 0) {
            if (real && creal(here) < 0) {
                cross_phase(&m, -creal(here));
            }
        }
        if (i + 1 >= r->count) {
            break;
        }

        const double complex next = r->gain[i + 1];
        const double size = cabs(here), then = cabs(next);
        if ((size - 1) * (then - 1) <= 0 && size != then) {
            const double share = plain_log(size) / (plain_log(size) - plain_log(then));
            cross_gain(&m, here + share * (next - here),
                       r->frequency[i] + share * (r->frequency[i + 1] - r->frequency[i]));
        }
        if (cimag(here) * cimag(next) <= 0 && cimag(here) != cimag(next)) {
            const double share = cimag(here) / (cimag(here) - cimag(next));
            const double at = creal(here) + share * (creal(next) - creal(here));
            if (at < 0) {
                cross_phase(&m, -at);
            }
        }
    }
    return m;
}
