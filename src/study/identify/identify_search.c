// Searches the least sum of squares.
//
// The sum of squares has minima besides the least one: a touch of the run may be taken
// for another one of the recording, and behind a touch little is left of what a wrong
// parameter does. So each search first fits the beginning of the traces, then more of
// them, until it has them whole: what the beginning tells brings the next touches near
// those that were recorded.
//
// The first two searches start with the scenario's parameters, each other one with the
// best of IDENTIFY_SCREENED sets that are drawn independently. The result is settled when
// the least of their minima was reached from IDENTIFY_CONFIRMED drawn starts: a false
// minimum that draws end in with probability a, while they end in the least with
// probability b, is taken for it with at most (a/(a + b))^IDENTIFY_CONFIRMED. Last is
// searched around it.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/build_config.h"
#include "src/base/dense.h"
#include "src/base/random.h"
#include "src/study/identify/identify.h"

#ifdef IMPACTLAB_MINPACK
#include <cminpack.h>
#endif

// Tolerances of a minimisation, relative, of the sum of squares and of the unknowns: of
// parts of the traces, of whole ones, and where the best is refined.
#define TOLERANCE_PART  1e-2
#define TOLERANCE_WHOLE 1e-4
#define TOLERANCE_BEST  1e-9
// Sums of squares of one minimum differ by less than this share and this number.
#define SAME_SHARE  1e-3
#define SAME_NUMBER 1.0
// Mean square of the residuals above which a part of the traces is not explained.
#define NOT_EXPLAINED 2.0
// By how much a round around a result has to lower the sum of squares.
#define GAIN 0.1
// By how many standard deviations sets are drawn around a result at most, to begin with,
// and how far, in the unknowns' scales.
#define SPREAD   3.0
#define FARTHEST 0.3

enum {
    MOST_STEPS = 60,     // of a minimisation
    PARTS = 4,           // in which a search takes the traces at least,
    MOST_PARTS = 12,     // and at most
    IDLE_ROUNDS = 6,     // around a result that end a search
    SCENARIOS_STARTS = 2 // with the scenario's parameters
};

typedef struct search {
    identification *id;
    random_generator random;
    double best[IDENTIFY_UNKNOWNS]; // of those that were evaluated, in their scales
    double least;                   // its sum of squares; NaN before the first
    double *residual, *jacobian;    // room for one set of unknowns
    double *sets, *set_residuals;   // room for those that are screened
    int held;    // unknown that a minimisation does not move; -1: it moves all
    status code; // of an evaluation, for MINPACK's caller
    fault *f;
} search;

status identify_available(fault *f)
{
#ifdef IMPACTLAB_MINPACK
    (void)f;
    return STATUS_OK;
#else
    return fault_set(f, STATUS_NOT_ALLOWED,
                     "identify needs MINPACK, which this program was built without: "
                     "install libcminpack-dev and build again");
#endif
}

// Keeps a set of unknowns as the best one if its sum of squares, of whole traces, is
// below the least one so far, or the first one.
static void keep_least(search *s, const double *x, double squares)
{
    if (s->id->part == 1 && !(squares >= s->least)) {
        s->least = squares;
        memcpy(s->best, x, (size_t)s->id->unknowns * sizeof *x);
    }
}

#ifdef IMPACTLAB_MINPACK
// MINPACK's function: with the flag 1 it asks for the residuals at x, else for the
// Jacobian. A negative result ends the search.
static int evaluate_for_minpack(void *context, int m, int n, const double *x,
                                double *residual, double *jacobian, int rows, int flag)
{
    search *s = context;
    const bool wants_residuals = flag == 1, judge = false;
    (void)m, (void)n;
    if (wants_residuals) {
        s->code = identify_evaluate(s->id, x, 1, NULL, judge, residual, NULL, s->f);
    } else {
        s->code = identify_jacobian(s->id, x, jacobian, s->f);
    }
    if (!wants_residuals && s->held >= 0) {
        memset(jacobian + (size_t)s->held * (size_t)rows, 0,
               (size_t)rows * sizeof *jacobian);
    }
    if (s->code == STATUS_OK && wants_residuals) {
        keep_least(s, x, identify_dot(residual, residual, s->id->residuals));
    }
    if (s->code == STATUS_OK) {
        return 0;
    }
    return -1;
}

// Minimises the sum of squares by Levenberg and Marquardt's method, from x on, until
// steps gain and change less than the tolerance. *squares receives the sum of squares.
static status minimise(search *s, double tolerance, double *x, double *squares)
{
    const int m = (int)s->id->residuals, n = s->id->unknowns;
    double diagonal[IDENTIFY_UNKNOWNS], work[4][IDENTIFY_UNKNOWNS];
    SCOPED(free_kept) double *more = calloc((size_t)m, sizeof *more);
    int pivots[IDENTIFY_UNKNOWNS], evaluations, jacobians;
    if (more == NULL) {
        return fault_no_memory(s->f);
    }
    s->code = STATUS_OK;
    lmder(evaluate_for_minpack, s, m, n, x, s->residual, s->jacobian, m, tolerance,
          tolerance, 0, MOST_STEPS, diagonal, 1, 1, 0, &evaluations, &jacobians, pivots,
          work[0], work[1], work[2], work[3], more);
    *squares = identify_dot(s->residual, s->residual, (size_t)m);
    return s->code;
}
#else
static status minimise(search *s, double tolerance, double *x, double *squares)
{
    (void)tolerance, (void)x, (void)squares;
    return identify_available(s->f);
}
#endif

// --- parts of the traces --------------------------------------------------------------

// The trace with the most touches.
static const recorded_trace *trace_of_most_touches(const identification *id)
{
    const recorded_trace *most = &id->traces[0];
    for (int k = 1; k < id->trace_count; k++) {
        if (id->traces[k].contact_count > most->contact_count) {
            most = &id->traces[k];
        }
    }
    return most;
}

// Lists the shares of the traces that a search compares one after the other, each with
// one touch more, or with some more where there are many: they end in the middle between
// two touches of the trace that has the most. Of few touches they are equal parts.
// Returns how many.
static int list_parts(const identification *id, double parts[MOST_PARTS])
{
    const recorded_trace *t = trace_of_most_touches(id);
    const double end = t->time[t->rows - 1];
    const int step = (t->contact_count + MOST_PARTS - 1) / MOST_PARTS;
    int count = 0;
    for (int i = step; t->contact_count >= PARTS && i < t->contact_count; i += step) {
        parts[count++] = (t->contacts[i - 1] + t->contacts[i]) / 2 / end;
    }
    while (t->contact_count < PARTS && count < PARTS - 1) {
        count++;
        parts[count - 1] = (double)count / PARTS;
    }
    parts[count++] = 1;
    return count;
}

// --- starts ----------------------------------------------------------------------------

// Sets the unknowns x to start from: the scenario's parameters, and for each trace its
// own first guess. That takes the angle at the start from the encoder. With
// `offset_unknown` the encoder may count from any angle: the scenario tells the angle,
// and the difference goes to the encoder's offset.
static void begin_with(const identification *id, bool offset_unknown, double *x)
{
    const double angle = id->base->parameters.initial.angle;
    for (int n = 0; n < id->unknowns; n++) {
        const unknown *u = &id->unknown[n];
        double value = *u->value;
        if (offset_unknown && u->trace >= 0) {
            const double *own = id->traces[u->trace].own;
            if (u->index == OWN_ANGLE) {
                value = angle;
            } else if (u->index == OWN_OFFSET) {
                value = own[OWN_OFFSET] + (own[OWN_ANGLE] - angle);
            }
        }
        x[n] = value / u->scale;
    }
}

// Draws the parameters of a start from their ranges, or from half to twice the scenario's
// value.
static void draw_parameters(search *s, double *x)
{
    for (int i = 0; i < s->id->count; i++) {
        const fitted_parameter *fit = &s->id->fit[i];
        const double u = random_uniform(&s->random);
        if (fit->axis.is_range) {
            x[i] = sweep_axis_value_at(&fit->axis, u) / fit->scale;
        } else if (u < 0.5) {
            x[i] *= 0.5 + u;
        } else {
            x[i] *= 2 * u;
        }
    }
}

// Copies the drawn set with the least sum of squares to x.
static status take_best_set(search *s, double *x)
{
    const size_t m = s->id->residuals, n = (size_t)s->id->unknowns;
    const bool judge = false;
    double least = HUGE_VAL;
    TRY(identify_evaluate(s->id, s->sets, IDENTIFY_SCREENED, NULL, judge,
                          s->set_residuals, NULL, s->f));
    for (size_t k = 0; k < IDENTIFY_SCREENED; k++) {
        const double squares =
            identify_dot(s->set_residuals + k * m, s->set_residuals + k * m, m);
        if (squares < least) {
            least = squares;
            memcpy(x, s->sets + k * n, n * sizeof *x);
        }
    }
    return STATUS_OK;
}

// Draws sets of unknowns, and copies the one with the least sum of squares over the first
// part of the traces to x.
static status draw_start(search *s, double *x)
{
    identification *id = s->id;
    const size_t n = (size_t)id->unknowns;
    for (size_t k = 0; k < IDENTIFY_SCREENED; k++) {
        const bool offset_unknown = k % 2 != 0;
        begin_with(id, offset_unknown, s->sets + k * n);
        draw_parameters(s, s->sets + k * n);
    }
    double parts[MOST_PARTS];
    list_parts(id, parts);
    id->part = parts[0];
    return take_best_set(s, x);
}

// --- searches --------------------------------------------------------------------------

// The mean square of the residuals that are compared: those behind a part are 0.
static double mean_square(const search *s, double squares)
{
    double count = 0;
    for (size_t i = 0; i < s->id->residuals; i++) {
        if (s->residual[i] != 0) {
            count++;
        }
    }
    return squares / fmax(count, 1);
}

// Draws sets of unknowns around x from what the part that was compared last leaves open:
// along each eigenvector v of J'J, J being the Jacobian and l the eigenvalue, `spread`
// standard deviations 1/sqrt(l) or less, and not beyond FARTHEST. Copies the one with the
// least sum of squares over the next part to x.
static status draw_around(search *s, double spread, double next_part, double *x)
{
    identification *id = s->id;
    const size_t m = id->residuals, n = (size_t)id->unknowns;
    double products[IDENTIFY_UNKNOWNS * IDENTIFY_UNKNOWNS], values[IDENTIFY_UNKNOWNS];
    double scratch[2 * IDENTIFY_UNKNOWNS];
    TRY(identify_jacobian(id, x, s->jacobian, s->f));
    for (size_t i = 0; i < n; i++) {
        for (size_t j = 0; j < n; j++) {
            products[i * n + j] =
                identify_dot(s->jacobian + i * m, s->jacobian + j * m, m);
        }
    }
    FAULT_IF(!symmetric_eigen((int)n, products, values, scratch), s->f, STATUS_SINGULAR,
             "the unknowns' errors cannot be computed");
    for (size_t k = 0; k < IDENTIFY_SCREENED; k++) {
        double *set = s->sets + k * n;
        memcpy(set, x, n * sizeof *x);
        for (size_t e = 0; e < n; e++) {
            const double most = fmin(spread / sqrt(fmax(values[e], 1)), FARTHEST);
            const double along = most * (2 * random_uniform(&s->random) - 1);
            identify_add_scaled(set, along, products + e * n, n);
        }
    }
    id->part = next_part;
    return take_best_set(s, x);
}

// Minimises over one more part of the traces. Where that loses what explained the part
// before, a touch that comes with it was taken for another one, or missed: then from the
// best of sets drawn around the result before it.
static status minimise_next_part(search *s, double part, double *x, double *mean)
{
    identification *id = s->id;
    const double part_before = id->part, mean_before = *mean;
    double before[IDENTIFY_UNKNOWNS], squares;
    memcpy(before, x, sizeof before);
    id->part = part;
    TRY(minimise(s, TOLERANCE_PART, x, &squares));
    *mean = mean_square(s, squares);
    if (mean_before > NOT_EXPLAINED || *mean < NOT_EXPLAINED) {
        return STATUS_OK;
    }

    double other;
    id->part = part_before;
    TRY(draw_around(s, SPREAD, part, before));
    TRY(minimise(s, TOLERANCE_PART, before, &other));
    if (other < squares) {
        *mean = mean_square(s, other);
        memcpy(x, before, sizeof before);
    }
    return STATUS_OK;
}

// Minimises over the first part of the traces, then over more and more of them.
static status minimise_in_parts(search *s, double *x, double *squares)
{
    double parts[MOST_PARTS], mean = HUGE_VAL;
    const int count = list_parts(s->id, parts);
    for (int i = 0; i < count - 1; i++) {
        TRY(minimise_next_part(s, parts[i], x, &mean));
    }
    s->id->part = 1;
    return minimise(s, TOLERANCE_WHOLE, x, squares);
}

// Counts how often the least minimum was reached, after a search has ended in another
// one, `squares`; before that the least was `least`.
static void count_minimum(identification *id, double squares, double least, bool is_drawn)
{
    const double same = SAME_SHARE * least + SAME_NUMBER;
    if (!(squares > least - same)) {
        id->reached = 0;
    }
    if (is_drawn && !(squares > least + same)) {
        id->reached++;
    }
}

// Goes on from the best of sets that are drawn around the result, and refines what comes
// of it: behind many touches the sum of squares has several minima whose parameters
// differ by some thousandths, and searches from afar end in any of them. Each round that
// gains nothing draws twice as far, until IDLE_ROUNDS of them have gained nothing.
static status search_around_best(search *s)
{
    double x[IDENTIFY_UNKNOWNS], squares;
    int idle = 0;
    while (idle < IDLE_ROUNDS) {
        const double before = s->least;
        memcpy(x, s->best, sizeof x);
        TRY(draw_around(s, SPREAD * ldexp(1, idle), 1, x));
        TRY(minimise(s, TOLERANCE_WHOLE, x, &squares));
        if (s->least < before - GAIN) {
            idle = 0;
        } else {
            idle++;
        }
    }
    memcpy(x, s->best, sizeof x);
    return minimise(s, TOLERANCE_BEST, x, &squares);
}

// Searches from one start after the other, then around the best result.
static status search_from_starts(search *s)
{
    identification *id = s->id;
    double x[IDENTIFY_UNKNOWNS], squares;
    random_seed(&s->random, id->seed);
    id->searches = id->reached = 0;

    // a search that is stopped soon has the scenario's values
    const bool offset_unknown = false, judge = false;
    begin_with(id, offset_unknown, x);
    TRY(identify_evaluate(id, x, 1, NULL, judge, s->residual, NULL, s->f));
    keep_least(s, x, identify_dot(s->residual, s->residual, id->residuals));

    double least = (double)NAN; // of the minima
    while (id->searches < id->starts && id->reached < IDENTIFY_CONFIRMED) {
        const bool is_drawn = id->searches >= SCENARIOS_STARTS;
        if (is_drawn) {
            TRY(draw_start(s, x));
        } else {
            begin_with(id, id->searches == 1, x);
        }
        TRY(minimise_in_parts(s, x, &squares));
        count_minimum(id, squares, least, is_drawn);
        least = fmin(least, squares);
        id->searches++;
    }
    return search_around_best(s);
}

status identify_minimise_held(identification *id, int held, double *x, double *squares,
                              fault *f)
{
    const size_t m = id->residuals, n = (size_t)id->unknowns;
    SCOPED(free_kept) double *room = calloc(m + m * n, sizeof *room);
    if (room == NULL) {
        return fault_no_memory(f);
    }
    search s = {.id = id, .held = held, .least = 0, .f = f};
    s.residual = room;
    s.jacobian = room + m;
    return minimise(&s, TOLERANCE_WHOLE, x, squares);
}

status identify_minimise(identification *id, double *x, double *squares, fault *f)
{
    const int none = -1;
    return identify_minimise_held(id, none, x, squares, f);
}

bool identify_settled(const identification *id)
{
    return id->starts <= SCENARIOS_STARTS || id->reached >= IDENTIFY_CONFIRMED;
}

status identify_search(identification *id, double *x, double *least, fault *f)
{
    const size_t m = id->residuals, n = (size_t)id->unknowns;
    SCOPED(free_kept)
    double *room = calloc(IDENTIFY_SCREENED * (n + m) + m + m * n, sizeof *room);
    if (room == NULL) {
        return fault_no_memory(f);
    }
    search s = {.id = id, .held = -1, .least = (double)NAN, .f = f};
    s.sets = room;
    s.set_residuals = s.sets + IDENTIFY_SCREENED * n;
    s.residual = s.set_residuals + IDENTIFY_SCREENED * m;
    s.jacobian = s.residual + m;
    const status code = search_from_starts(&s);
    memcpy(x, s.best, n * sizeof *x);
    *least = s.least;
    return code;
}
