// Errors of parameters where the model lacks something: residuals that stay correlated
// are no noise, so they say themselves how far they could lead.
//
// What an arm does at an instant changes all that it does later. So what is lacking is
// taken for a command u that nobody recorded, constant over stretches of time and
// independent from one to the next, beside the noise of the readings. With D, how the
// residuals r change with u in each stretch, their covariance is
//
//     V = s^2 (1 + g^2 D D'),
//
// and s and g are those under which r is most likely, as far as the unknowns' columns
// leave it open (restricted maximum likelihood; Patterson and Thompson, Biometrika 58,
// 1971). Residuals move the parameters by J^-1 A' r, A being the parameters' columns
// freed of what the traces' own unknowns explain and J = A'A, so the errors' covariance
// is
//
//     J^-1 A' V A J^-1 = s^2 J^-1 + s^2 g^2 (J^-1 A' D)(J^-1 A' D)'.
//
// A command s g beyond what the amplifier takes explains nothing: then there are no
// errors.
//
// A hub that gives or has play does what no such command does: the arm bends as if its
// stiffness were less. So a rigid hub is given a spring and the fit goes on from its
// result. The way d that the parameters go with the softest spring that the readings
// allow is an error that could be: it counts as the 95 % point of an independent one, d
// d'/1.96^2.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/dense.h"
#include "src/base/numbers.h"
#include "src/base/plain_math.h"
#include "src/scenario/scenario.h"
#include "src/study/identify/identify.h"

#define PUSH         0.02 // of the largest command
#define MOST_NUMBERS 3e7  // in the stretches' columns
// In k2: how stiff the first spring of a hub begins that is tried, and a spring at most.
#define HUB_SOFTEST 50.0
#define HUB_RANGE   1e4

enum {
    HUB_SPRINGS = 7,      // that are tried at most
    MOST_STRETCHES = 400, // of all traces; those of long ones are longer
    SHARES = 60           // of commands and noise that are tried, four a decade
};

// Stretches of the traces, and what a command in each does.
typedef struct stretches {
    int count;
    double length;   // of each [s]
    double *columns; // changes of the residuals by it [count * residuals]
    double *shares;  // changes of the parameters, in their scales [count * parameters]
} stretches;

// --- the command that nobody recorded --------------------------------------------------

static int stretches_of(const recorded_trace *t, double length)
{
    return (int)(t->time[t->rows - 1] / length) + 1;
}

// Sets how long the stretches are, longer than LACK_STRETCH where there would be too many
// of them, and how many all traces have.
static void lay_out_stretches(const identification *id, stretches *all)
{
    double time = 0; // of all traces
    for (int k = 0; k < id->trace_count; k++) {
        const recorded_trace *t = &id->traces[k];
        time += t->time[t->rows - 1];
    }
    const double most = fmin(MOST_STRETCHES, MOST_NUMBERS / (double)id->residuals);
    all->length = fmax(LACK_STRETCH, time / most);
    for (int k = 0; k < id->trace_count; k++) {
        all->count += stretches_of(&id->traces[k], all->length);
    }
}

// Finds how the residuals of a trace change with the command in each of its stretches, by
// runs that are pushed there; the columns begin at `column`.
static status push_stretches(identification *id, int number, double length,
                             const double *x, double *column, fault *f)
{
    recorded_trace *t = &id->traces[number];
    const size_t m = id->residuals;
    double *const recorded = t->command;
    SCOPED(free_kept) double *pushed = calloc(t->rows, sizeof *pushed);
    if (pushed == NULL) {
        return fault_no_memory(f);
    }
    double largest = 0;
    for (size_t i = 0; i < t->rows; i++) {
        largest = fmax(largest, fabs(recorded[i]));
    }
    if (largest == 0) {
        largest = id->base->parameters.motor.voltage_limit;
    }
    const double volts = PUSH * largest;
    const int count = stretches_of(t, length);
    for (int stretch = 0; stretch < count && volts > 0; stretch++, column += m) {
        for (size_t i = 0; i < t->rows; i++) {
            pushed[i] = recorded[i];
            if ((int)(t->time[i] / length) == stretch) {
                pushed[i] += volts;
            }
        }
        memcpy(column, id->residual, m * sizeof *column);
        t->command = pushed;
        const status code = identify_evaluate(id, x, 1, &number, false, column, NULL, f);
        t->command = recorded;
        if (code != STATUS_OK) {
            return code;
        }
        identify_add_scaled(column, -1, id->residual, m);
        for (size_t i = 0; i < m; i++) {
            column[i] /= volts;
        }
    }
    return STATUS_OK;
}

// Turns what moves the parameters, A' r in sums[count], into how far it does: J^-1 times
// it, J with its eigenvalues, without directions that are not determined.
static void solve_information(const identification *id, const double *values,
                              double *sums)
{
    const int p = id->count;
    double share[IDENTIFY_PATHS] = {0};
    for (int k = id->undetermined; k < p; k++) {
        const double *v = id->direction + k * p;
        const double along = identify_dot(v, sums, (size_t)p) / values[k];
        identify_add_scaled(share, along, v, (size_t)p);
    }
    memcpy(sums, share, (size_t)p * sizeof *sums);
}

// Splits what each stretch does to the residuals into what it does to the parameters, its
// shares, and what no unknown explains, which stays in its column.
static bool split_columns(const identification *id, const double *jacobian,
                          const double *alone, const double *values, stretches *all)
{
    const size_t m = id->residuals, p = (size_t)id->count;
    for (int b = 0; b < all->count; b++) {
        double *share = all->shares + (size_t)b * p;
        for (size_t a = 0; a < p; a++) {
            share[a] = identify_dot(alone + a * m, all->columns + (size_t)b * m, m);
        }
        solve_information(id, values, share);
    }
    if (!identify_leave_own(id, jacobian, all->columns, all->count)) {
        return false;
    }
    for (int b = 0; b < all->count; b++) {
        for (size_t a = 0; a < p; a++) {
            identify_add_scaled(all->columns + (size_t)b * m,
                                -all->shares[(size_t)b * p + a], alone + a * m, m);
        }
    }
    return true;
}

// The columns' products D'D, products[count * count], and D'r.
static void multiply_columns(const identification *id, const stretches *all,
                             double *products, double *along)
{
    const size_t m = id->residuals, n = (size_t)all->count;
    for (size_t i = 0; i < n; i++) {
        const double *column = all->columns + i * m;
        along[i] = identify_dot(column, id->residual, m);
        for (size_t j = 0; j <= i; j++) {
            products[i * n + j] = products[j * n + i] =
                identify_dot(column, all->columns + j * m, m);
        }
    }
}

// Finds the share g of the command and the scale s of the noise under which the residuals
// are most likely, of n degrees of freedom: where twice the negative logarithm of the
// likelihood is least,
//
//     log det(1 + g^2 D'D) + n log s^2 + Q/s^2,
//     Q = r'r - g^2 (D'r)' (1 + g^2 D'D)^-1 D'r,  s^2 = Q/n, but no less than 1
//
// Leaves both as they are where no reading changes with the command.
static status find_scales(const identification *id, const stretches *all, double *command,
                          double *noise, fault *f)
{
    const size_t n = (size_t)all->count;
    SCOPED(free_kept) double *room = calloc(2 * n * n + 2 * n, sizeof *room);
    if (room == NULL) {
        return fault_no_memory(f);
    }
    double *products = room, *factor = products + n * n;
    double *along = factor + n * n, *solved = along + n;
    multiply_columns(id, all, products, along);
    double most, size = 0;
    const double freedom = id->chi_square / identify_misfit(id, &most);
    for (size_t i = 0; i < n; i++) {
        size += products[i * n + i];
    }

    // from a command that does next to nothing to one that does all
    double least = HUGE_VAL;
    for (int i = 0; i < SHARES && size > 0; i++) {
        const double share = plain_pow(10, i / 4.0 - 2) / size; // g^2
        for (size_t k = 0; k < n * n; k++) {
            factor[k] = share * products[k];
        }
        for (size_t k = 0; k < n; k++) {
            factor[k * n + k] += 1;
        }
        memcpy(solved, along, n * sizeof *solved);
        if (!symmetric_factor((int)n, factor)) {
            continue;
        }
        symmetric_forward((int)n, factor, solved);
        const double taken = share * identify_dot(solved, solved, n);
        const double scale = fmax((id->chi_square - taken) / freedom, 1);
        double likelihood = freedom * plain_log(scale) + (id->chi_square - taken) / scale;
        for (size_t k = 0; k < n; k++) {
            likelihood += 2 * plain_log(factor[k * n + k]);
        }
        if (likelihood < least) {
            least = likelihood;
            *command = sqrt(share);
            *noise = sqrt(scale);
        }
    }
    return STATUS_OK;
}

// Sets the covariance to what noise and the command give.
static void set_covariance(identification *id, const double *values, const stretches *all,
                           double command, double noise)
{
    const size_t p = (size_t)id->count;
    memset(id->covariance, 0, sizeof id->covariance);
    for (size_t a = 0; a < p; a++) {
        double *row = id->covariance + a * p;
        row[a] = noise * noise;
        solve_information(id, values, row);
        for (size_t b = 0; b < p * (size_t)all->count; b += p) {
            const double moved = noise * noise * command * command * all->shares[b + a];
            identify_add_scaled(row, moved, all->shares + b, p);
        }
    }
}

status identify_unrecorded_command(identification *id, const double *jacobian,
                                   const double *alone, const double *values, fault *f)
{
    const size_t m = id->residuals;
    double x[IDENTIFY_UNKNOWNS], command = (double)NAN, noise = 1;
    stretches all = {.count = 0};
    lay_out_stretches(id, &all);
    SCOPED(free_kept)
    double *room = calloc((size_t)all.count * (m + (size_t)id->count), sizeof *room);
    if (room == NULL) {
        return fault_no_memory(f);
    }
    all.columns = room;
    all.shares = room + (size_t)all.count * m;
    for (int n = 0; n < id->unknowns; n++) {
        x[n] = *id->unknown[n].value / id->unknown[n].scale;
    }
    double *column = all.columns;
    for (int k = 0; k < id->trace_count; k++) {
        TRY(push_stretches(id, k, all.length, x, column, f));
        column += (size_t)stretches_of(&id->traces[k], all.length) * m;
    }
    FAULT_IF(!split_columns(id, jacobian, alone, values, &all), f, STATUS_SINGULAR,
             "the parameters' errors cannot be computed");
    TRY(find_scales(id, &all, &command, &noise, f));
    if (command * noise < id->base->parameters.motor.voltage_limit) {
        set_covariance(id, values, &all, command, noise);
        id->lack.command = command * noise;
        id->lack.stretch = all.length;
    }
    return STATUS_OK;
}

// --- a hub that gives ------------------------------------------------------------------

// Counts how far a hub with a spring moves the parameters, whose values with it are
// value[], as one more independent error.
static void add_difference(identification *id, const double *value)
{
    const size_t p = (size_t)id->count;
    double difference[IDENTIFY_PATHS];
    for (size_t i = 0; i < p; i++) {
        difference[i] = (value[i] - id->fit[i].value) / id->fit[i].scale;
    }
    for (size_t i = 0; i < p; i++) {
        const double share = difference[i] / (IDENTIFY_QUANTILE * IDENTIFY_QUANTILE);
        identify_add_scaled(id->covariance + i * p, share, difference, p);
    }
}

// Goes on from the fit with the spring k1 of the hub as one unknown more, the last of the
// parameters, which begins at `begins`. Sets the parameters and chi square of `sprung`.
static status try_hub_spring(identification *sprung, const identification *id,
                             double begins, fault *f)
{
    double x[IDENTIFY_UNKNOWNS];
    for (int i = 0; i < id->count; i++) {
        sprung->fit[i].value = id->fit[i].value;
    }
    sprung->fit[id->count].value = begins;
    for (int n = 0; n < sprung->unknowns; n++) {
        x[n] = *sprung->unknown[n].value / sprung->unknown[n].scale;
    }
    TRY(identify_minimise(sprung, x, &sprung->chi_square, f));
    for (int i = 0; i < sprung->count; i++) {
        sprung->fit[i].value = identify_unknown_value(sprung, i, x[i]);
    }
    return STATUS_OK;
}

// Looks for the softest spring that the readings allow, half an octave stiffer each time:
// its ringing makes the sum of squares rough, so that a minimisation finds the other
// parameters, but k1 only near where it began. Those are allowed with which chi square is
// above that of a rigid hub by no more than chance has it once in 20 times. *found: there
// is one.
static status find_softest_hub(identification *sprung, const identification *id,
                               bool *found, fault *f)
{
    const double k2 = id->base->parameters.arm.k2;
    double most;
    const double chance =
        IDENTIFY_QUANTILE * IDENTIFY_QUANTILE * identify_misfit(id, &most);
    char path[100];
    *found = false;
    decimal_print(path, sizeof path, "arm.k1=%.17g:%.17g", k2, HUB_RANGE * k2);
    TRY(identify_add_path(sprung, path, f));
    sprung->residuals = id->residuals + 1;
    identify_list_unknowns(sprung);
    double begins = HUB_SOFTEST * k2;
    for (int i = 0; i < HUB_SPRINGS && !*found; i++) {
        TRY(try_hub_spring(sprung, id, begins, f));
        *found = sprung->chi_square < id->chi_square + chance;
        begins *= M_SQRT2;
    }
    return STATUS_OK;
}

status identify_hub_spring(identification *id, fault *f)
{
    const arm_parameters *arm = &id->base->parameters.arm;
    if (arm->hub_joint != HUB_RIGID || id->count == IDENTIFY_PATHS) {
        return STATUS_OK;
    }
    const parameter_change change = {PARAMETER_INDEX(arm.hub_joint), HUB_SPRING};
    scenario base;
    SCOPED(free_kept) identification *sprung = malloc(sizeof *sprung);
    if (sprung == NULL) {
        return fault_no_memory(f);
    }

    // not every scenario can have one
    const status made = scenario_with(id->base, &change, 1, &base, NULL);
    if (made == STATUS_NO_MEMORY) {
        return fault_no_memory(f);
    }
    if (made != STATUS_OK) {
        return STATUS_OK;
    }
    *sprung = *id;
    sprung->base = &base;
    bool found;
    const status code = find_softest_hub(sprung, id, &found, f);
    id->runs = sprung->runs;
    if (code == STATUS_OK && found) {
        for (int i = 0; i < id->count; i++) {
            id->lack.with_spring[i] = sprung->fit[i].value;
        }
        add_difference(id, id->lack.with_spring);
        id->lack.hub_spring = sprung->fit[id->count].value;
        id->lack.chi_square = sprung->chi_square;
    }
    sweep_axis_finish(&sprung->fit[id->count].axis);
    return code;
}
