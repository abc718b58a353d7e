// Answers over frequency, how far a loop gain stays from -1, and where a loop is stable.
#include <assert.h>
#include <math.h>
#include <stdlib.h>

#include "src/base/numbers.h"
#include "src/base/plain_math.h"
#include "src/base/sincos.h"
#include "src/run/run.h"
#include "src/study/linear/linear.h"

// Frequencies: so many in equal ratios, of a loop over so many decades below half its rate, and so
// many about each vibration, out to where it no longer shows.
enum { EVEN = 1500, ABOUT = 40, MOST_FREQUENCIES = 20000, BISECTIONS = 40, RUN_BISECTIONS = 12 };
#define DECADES 1e4

// Puts frequencies for a system with the given poles in order; returns how many.
static int choose_frequencies(const double complex *poles, int states, double period, double *w)
{
    double low = M_PI / period / DECADES, high = M_PI / period;
    int count = 0;
    if (period == 0) {
        low = high = 1;
        for (int i = states - 1; i >= 0; i--) { // the fastest first
            low = cabs(poles[i]) > 1e-6 ? cabs(poles[i]) : low;
        }
        high = 10 * fmax(high, states > 0 ? cabs(poles[states - 1]) : 0);
        low *= 0.01;
    }
    for (int i = 0; i < EVEN; i++) {
        w[count++] = high * plain_pow(low / high, (EVEN - 1 - i) / (EVEN - 1.0));
    }
    for (int i = 0; i < states && period > 0; i++) {
        const double size = cabs(poles[i]), at = size > 0 ? carg(poles[i]) / period : 0;
        const double width = size > 0 ? fabs(plain_log(size)) / period : 0;
        for (int k = -ABOUT / 2; k <= ABOUT / 2 && at > 0 && count < MOST_FREQUENCIES; k++) {
            const double off = fmax(width, 1e-9 * at) * (plain_exp(0.3 * abs(k)) - 1);
            const double near = k < 0 ? at - off : at + off;
            if (near > 0 && near < high) {
                w[count++] = near;
            }
        }
    }
    qsort(w, (size_t)count, sizeof *w, compare_numbers);
    return count;
}

status linear_respond(const linear_system *s, int output, double period, linear_response *r,
                      fault *f)
{
    assert(period >= 0);
    const size_t n = (size_t)s->states;
    *r = (linear_response){0};
    double *block = calloc(3 * MOST_FREQUENCIES, sizeof *block);
    double complex *scratch = calloc(n * (n + 2) + 1, sizeof *scratch);
    status code = block != NULL && scratch != NULL ? STATUS_OK : fault_no_memory(f);
    code = code == STATUS_OK ? linear_poles(s, scratch, f) : code;
    if (code == STATUS_OK) {
        *r = (linear_response){choose_frequencies(scratch, s->states, period, block), block,
                               (double complex *)(block + MOST_FREQUENCIES)};
        for (int i = 0; i < r->count; i++) {
            double sine, cosine;
            inline_sincos(r->frequency[i] * period, &sine, &cosine);
            r->gain[i] = period > 0 ? -linear_answer(s, output, complex_of(cosine, sine), scratch)
                                    : linear_answer(s, output, complex_of(0, block[i]), scratch);
        }
    } else {
        free(block);
    }
    free(scratch);
    return code;
}

// --- margins ----------------------------------------------------------------------------------

// Takes in a place at which the loop gain is real and negative.
static void cross_phase(linear_margins *m, double gain)
{
    const double db = 20 * plain_log(1 / gain) / plain_log(10);
    double *least = db >= 0 ? &m->gain_db : &m->gain_down_db;
    *least = fmin(*least, fabs(db));
}

linear_margins linear_margins_of(const linear_response *r)
{
    linear_margins m = {HUGE_VAL, HUGE_VAL, HUGE_VAL, HUGE_VAL, HUGE_VAL};
    for (int i = 0; i < r->count; i++) {
        const double complex here = r->gain[i];
        m.disk = fmin(m.disk, 2 * cabs(1 + here) / cabs(1 - here));

        // at both ends a sampled loop gain is real, up to rounding
        const bool real = fabs(cimag(here)) < 1e-9 * cabs(here);
        if ((i + 1 == r->count || i == 0) && real && creal(here) < 0) {
            cross_phase(&m, -creal(here));
        }
        if (i + 1 == r->count) {
            break;
        }

        const double complex next = r->gain[i + 1];
        const double size = cabs(here), then = cabs(next);
        if ((size - 1) * (then - 1) <= 0 && size != then) {
            const double share = plain_log(size) / (plain_log(size) - plain_log(then));
            const double complex one = here + share * (next - here);
            const double w = r->frequency[i] + share * (r->frequency[i + 1] - r->frequency[i]);
            const double left = plain_atan2(-cimag(one), -creal(one)); // beyond -180 degrees
            m.phase_deg = fmin(m.phase_deg, fabs(left) * 180 / M_PI);
            m.delay_s = fmin(m.delay_s, (left >= 0 ? left : left + 2 * M_PI) / w);
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

// --- where a loop is stable -------------------------------------------------------------------

static status growth_of(const scenario *s, linear_place place, double *growth, fault *f)
{
    linear_arm arm;
    linear_system loop = {0};
    status code = linear_arm_init(&arm, &s->parameters, place, f);
    code = code == STATUS_OK ? linear_loop(&loop, &arm, &s->parameters, f) : code;
    double complex *poles = calloc((size_t)loop.states + 1, sizeof *poles);
    if (code == STATUS_OK) {
        linear_close(&loop);
        code = poles != NULL ? linear_poles(&loop, poles, f) : fault_no_memory(f);
    }
    if (code == STATUS_OK) {
        *growth = plain_log(cabs(poles[loop.states - 1])) * s->parameters.control.rate;
    }
    free(poles);
    linear_system_finish(&loop);
    linear_system_finish(&arm.system);
    return code;
}

status linear_stability(const scenario *s, linear_place place, bool by_runs, double *number,
                        fault *f)
{
    *number = (double)NAN;
    if (!by_runs) {
        return growth_of(s, place, number, f);
    }
    run_result result;
    status code = run_scenario(s, false, &result);
    *number = result.summary.settling_time_s;
    code = code == STATUS_NO_MEMORY || code == STATUS_NOT_ALLOWED
               ? summary_fault(&result.summary, f)
               : STATUS_OK;
    run_finish(&result);
    return code;
}

status linear_growth(const scenario *s, double *growth, fault *f)
{
    return linear_stability(s, LINEAR_CONTACT, false, growth, f);
}

status linear_limit(const sweep *s, linear_place place, bool by_runs, double from, double to,
                    double *limit, fault *f)
{
    assert(s->axis_count == 1);
    bool at_start = false;
    for (int i = -1; i < (by_runs ? RUN_BISECTIONS : BISECTIONS); i++) {
        const double value = i < 0 ? from : (from + to) / 2;
        scenario derived;
        double number;
        TRY(sweep_axes_scenario(s->axes, 1, &value, s->base, &derived, f));
        TRY(linear_stability(&derived, place, by_runs, &number, f));
        const bool here = linear_is_stable(by_runs, number);
        at_start = i < 0 ? here : at_start;
        *(here == at_start ? &from : &to) = value;
    }
    *limit = (from + to) / 2;
    return STATUS_OK;
}
