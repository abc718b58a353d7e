#include "src/solve/modal_stride.h"

#include <math.h>
#include <string.h>

#include "src/arm/chain_momentum.h"
#include "src/solve/modal_response.h"

enum { COLUMNS = 2 * MODAL_NODES, LEAST_HUB_STEPS = 6, FEW_SWEEPS = 4, MOST_SWEEPS = 30 };

#define CONVERGED   3e-8 // change of a sweep that ends them, of the modes' momenta
#define SLOW_SWEEPS 0.6  // of the last change is left: a shorter stride costs less
#define HUB_TURN    0.75 // of the fastest of them from step to step [rad]
#define LOW_TURN    24   // rate times time up to which modes are taken together

// Lobatto's points on [0, 1].
static const double points[MODAL_NODES] = {0, 0.27639320225002103, 0.72360679774997897, 1};

// --- storage ----------------------------------------------------------------------------------

static size_t table_size(int n)
{
    return (size_t)n * (MODAL_POWERS + 2);
}

// Powers of time that are wanted at a point of collocation: all at the stride's end.
static int kept_powers(int point)
{
    return point < MODAL_NODES - 1 ? MODAL_NODES + 1 : MODAL_POWERS;
}

static size_t kept_size(int n)
{
    size_t doubles = 0;
    for (int i = 1; i < MODAL_NODES; i++) {
        doubles += (size_t)n * (size_t)(kept_powers(i) + 2);
    }
    return doubles;
}

size_t modal_stride_size(const arm *a)
{
    const size_t n = (size_t)a->dof;

    // bases and their scratch, tables, vectors
    size_t doubles =
        MODAL_CONTACT_STATES * (modal_basis_size(a->dof) + modal_vibrations_size(a->dof)) +
        modal_basis_scratch(a->dof);
    doubles += 2 * table_size(a->dof);
    doubles += (1 + MODAL_CONTACT_STATES * MODAL_KEPT_LEVELS) * kept_size(a->dof);
    doubles += n * (8 + 8 * MODAL_NODES + 3 * COLUMNS + 3);
    return sizeof(modal_stride) + doubles * sizeof(double);
}

static double *take(double **storage, size_t count)
{
    double *taken = *storage;
    *storage += count;
    return taken;
}

static void place_table(modal_table *at, double **storage, size_t n, int powers)
{
    at->impulse = take(storage, n);
    at->impulse_rate = take(storage, n);
    for (int j = 0; j < powers; j++) {
        at->power[j] = take(storage, n);
    }
}

static void place_kept(modal_kept *keep, double **storage, size_t n)
{
    for (int i = 1; i < MODAL_NODES; i++) {
        place_table(&keep->at[i], storage, n, kept_powers(i));
    }
}

void modal_stride_place(modal_stride *s, const arm *a)
{
    const size_t n = (size_t)a->dof;
    double *storage = (double *)(s + 1);
    memset(s, 0, sizeof *s);
    s->dof = a->dof;

    // bases
    for (int i = 0; i < MODAL_CONTACT_STATES; i++) {
        modal_basis_place(&s->basis[i], a->dof, take(&storage, modal_basis_size(a->dof)));
        modal_vibrations_place(&s->vibrations[i], a->dof,
                               take(&storage, modal_vibrations_size(a->dof)));
    }
    s->scratch = take(&storage, modal_basis_scratch(a->dof));

    // what there is once a point of collocation
    for (int i = 0; i < MODAL_NODES; i++) {
        s->point_angles[i] = take(&storage, n);
        s->point_velocities[i] = take(&storage, n);
        s->walk.force[i] = take(&storage, n);
        s->walk.drift[i] = take(&storage, n);
        s->drift[i] = take(&storage, n);
        s->force[i] = take(&storage, n);
        s->drifts[i] = take(&storage, n);
        s->forces[i] = take(&storage, n);
    }

    // what there is once a stride
    s->damping = take(&storage, n);
    s->viscous = take(&storage, n);
    s->start = take(&storage, n);
    s->momentum = take(&storage, n);
    s->columns = take(&storage, n * COLUMNS);
    s->more_columns = take(&storage, n * COLUMNS);
    s->modal = take(&storage, n * COLUMNS);

    // what there is once an instant
    s->angles = take(&storage, n);
    s->velocities = take(&storage, n);
    s->rates = take(&storage, n);
    s->place = take(&storage, n);
    s->momenta = take(&storage, n);
    s->walk.x = take(&storage, n);
    s->walk.y = take(&storage, n);
    place_table(&s->walk.at, &storage, n, MODAL_POWERS);
    place_table(&s->at[0], &storage, n, MODAL_POWERS);
    for (int i = 0; i < MODAL_CONTACT_STATES; i++) {
        for (int j = 0; j < MODAL_KEPT_LEVELS; j++) {
            place_kept(&s->kept[i][j], &storage, n);
        }
    }
    place_kept(&s->passing, &storage, n);
}

// --- the linear part --------------------------------------------------------------------------

// Responses of all modes at t.
static void fill_table(const modal_stride *s, double t, int powers, int count,
                       const modal_table *at)
{
    for (int k = 0; k < count; k++) {
        modal_response r;
        modal_respond(s->damping[k], s->modes->rate[k], t, powers, &r);
        at->impulse[k] = r.impulse;
        at->impulse_rate[k] = r.impulse_rate;
        for (int j = 0; j < powers; j++) {
            at->power[j][k] = r.power[j];
        }
    }
}

// Across the constraint of a contact nothing vibrates: x' = r(t), while y' = s(t) less what the
// modes pull, x and its integral by K and C, carries the force's impulse.
static void state_across(const modal_stride *s, const modal_table *at, double *x, double *y)
{
    const int e = s->modes->across;

    // its own polynomials
    double place = 0, rate = s->start[e], lower = at->impulse[e];
    for (int j = 0; j < MODAL_NODES; j++) {
        place += s->drift[j][e] * lower;
        rate += s->force[j][e] * lower;
        lower = at->power[j][e];
    }

    // what the modes pull
    for (int k = 0; k < e; k++) {
        const double twice = 2 * s->damping[k];
        double integral = s->start[k] * at->power[0][k];
        for (int j = 0; j < MODAL_NODES; j++) {
            const double power = at->power[j + 1][k];
            integral += s->force[j][k] * power + s->drift[j][k] * (at->power[j][k] + twice * power);
        }
        rate -= s->modes->pull[k] * (integral + s->per_stiffness * x[k]);
    }
    x[e] = place;
    y[e] = rate;
}

// x and y of all modes.
static void modal_state(const modal_stride *s, const modal_table *at, double *x, double *y)
{
    // every mode for itself: from its start, then what the polynomials do to it
    for (int k = 0; k < s->count; k++) {
        const double twice = 2 * s->damping[k], stiff = s->modes->rate[k] * s->modes->rate[k];
        double place = s->start[k] * at->impulse[k], rate = s->start[k] * at->impulse_rate[k];
        double lower = at->impulse[k];
        for (int j = 0; j < MODAL_NODES; j++) {
            const double power = at->power[j][k], f = s->force[j][k], d = s->drift[j][k];
            place += f * power + d * (lower + twice * power);
            rate += f * lower - stiff * d * power;
            lower = power;
        }
        x[k] = place;
        y[k] = rate;
    }

    // across the constraint they add up
    if (s->modes->across >= 0) {
        state_across(s, at, x, y);
    }
}

// From x and y to what stands for angles and momenta: in `y` the change of V' P.
static void to_momenta(const modal_stride *s, const arm *a, const double *x, double *y)
{
    const double *hub = s->modes->by_dof;
    double turned = 0;
    for (int k = 0; k < s->count; k++) {
        turned += hub[k] * x[k];
    }
    for (int k = 0; k < s->count; k++) {
        y[k] += s->viscous[k] * x[k] - a->motor.damping * hub[k] * turned - s->start[k];
    }
}

void modal_stride_modes(modal_stride *s, double t)
{
    s->time = t;
    s->ending = t == s->length ? &s->at[MODAL_NODES - 1] : &s->at[0];
    if (t != s->length) {
        fill_table(s, t, MODAL_POWERS, s->count, &s->at[0]);
    }
    modal_state(s, s->ending, s->place, s->momenta);
}

void modal_stride_state(modal_stride *s, const arm *a, chain_link *links, double t, const double *q,
                        double *qt, double *wt, double *impulse)
{
    const int n = s->dof;
    double *x = s->columns, *y = x + n, *turn = s->more_columns, *momentum = turn + n;

    // of the modes
    modal_stride_modes(s, t);
    memcpy(x, s->place, (size_t)n * sizeof *x);
    memcpy(y, s->momenta, (size_t)n * sizeof *y);
    to_momenta(s, a, x, y);

    // of the links
    modal_to_angles(s->modes, n, 2, x, turn, n);
    modal_mass_times(a, momentum, y);
    for (int i = 0; i < n; i++) {
        qt[i] = q[i] + turn[i];
        y[i] += s->momentum[i];
    }
    chain_from_momentum(a, links, s->mode, qt, y, wt, s->rates, impulse);
}

// --- start ------------------------------------------------------------------------------------

// Damping of all modes, and the hub's part of it.
static void take_damping(modal_stride *s, const arm *a)
{
    s->per_stiffness = a->joint_stiffness > 0 ? a->joint_damping / a->joint_stiffness : 0;
    for (int k = 0; k < s->modes->count; k++) {
        const double rate = s->modes->rate[k], hub = s->modes->by_dof[k];
        s->viscous[k] = k == s->modes->across ? 0 : a->motor.damping * hub * hub;
        s->damping[k] = (s->per_stiffness * rate * rate + s->viscous[k]) / 2;
    }
}

// Takes the basis of a contact state, computed when it is first wanted. False if it is singular.
static bool take_basis(modal_stride *s, const arm *a, contact_state mode)
{
    const double now[5] = {a->hub_stiffness, a->joint_stiffness, a->hub_joint_damping,
                           a->joint_damping, a->motor.damping};

    // springs that changed make all bases wrong
    if (memcmp(now, s->stiffness, sizeof now) != 0) {
        memcpy(s->stiffness, now, sizeof now);
        memset(s->known, 0, sizeof s->known);
    }

    const bool stuck = mode.friction == HUB_STICK;
    const int i = mode.contact + 2 * stuck;
    if (!s->known[i]) {
        if (modal_basis_compute(&s->basis[i], a, mode.contact, stuck, s->scratch) != STATUS_OK) {
            return false;
        }
    }

    s->modes = &s->basis[i];
    s->now = &s->vibrations[i];
    take_damping(s, a);
    if (!s->known[i]) {
        for (int j = 0; j < MODAL_KEPT_LEVELS; j++) {
            s->kept[i][j].known = false;
        }
        modal_vibrations_compute(s->now, s->modes, s->damping);
        s->known[i] = true;
    }
    return true;
}

// r and s of one instant from x, y, the velocities there and dT/dq + J'^T L in s->rates; columns
// are two vectors of dof doubles for what is to be brought to the modes.
static void prepare_remainders(modal_stride *s, const arm *a, const double *w, double *columns)
{
    const int n = s->dof;
    double *force = columns + n;
    modal_mass_times(a, w, columns);

    // forces beyond the springs' at small angles: what the sweeps say, structural damping, motor
    modal_stiffness_times(a, s->angles, force);
    double inner = 0; // torque of structural damping in the joint before
    for (int k = 0; k < n; k++) {
        double outer = 0;
        if (k + 1 < n) {
            double c = k + 1 == a->first ? a->hub_joint_damping : a->joint_damping;
            outer = c * (w[k + 1] - w[k]);
        }
        force[k] = s->rates[k] - force[k] + outer - inner;
        inner = outer;
    }
    force[0] += a->motor.torque - s->mode.friction * a->motor.stiction;
}

static void take_remainders(const modal_stride *s, int point, const double *x, const double *y,
                            const double *modal)
{
    const double *v = modal, *force = modal + s->dof;

    // less what the modes' own equations have
    for (int k = 0; k < s->count; k++) {
        const double rate = s->modes->rate[k];
        s->drifts[point][k] = v[k] - y[k];
        s->forces[point][k] =
            force[k] - s->viscous[k] * v[k] + rate * rate * x[k] + 2 * s->damping[k] * y[k];
    }

    // across the constraint there is only what the modes pull
    const int e = s->modes->across;
    if (e >= 0) {
        double sum = force[e];
        for (int k = 0; k < e; k++) {
            sum += s->modes->pull[k] * (x[k] + s->per_stiffness * v[k]);
        }
        s->drifts[point][e] = v[e];
        s->forces[point][e] = sum;
    }
}

status modal_stride_start(modal_stride *s, const arm *a, chain_link *links, contact_state mode,
                          const double *q, const double *w)
{
    const int n = a->dof;
    if (!take_basis(s, a, mode)) {
        return STATUS_SINGULAR;
    }

    // momenta, and what the sweeps say
    s->mode = mode;
    s->count = s->modes->count;
    chain_momentum(a, q, w, s->momentum);
    double impulse;
    chain_from_momentum(a, links, mode, q, s->momentum, s->velocities, s->rates, &impulse);
    memcpy(s->angles, q, (size_t)n * sizeof *q);
    prepare_remainders(s, a, w, s->columns);
    memcpy(s->columns + 2 * n, s->momentum, (size_t)n * sizeof *q);
    modal_from_angles(s->modes, n, 3, s->columns, s->more_columns, n);

    // the same of the modes
    for (int k = 0; k < s->count; k++) {
        s->start[k] = s->more_columns[2 * n + k];
    }
    memset(s->columns, 0, (size_t)n * sizeof *q);
    take_remainders(s, 0, s->columns, s->start, s->more_columns);
    return STATUS_OK;
}

// --- collocation ------------------------------------------------------------------------------

// Coefficients of the polynomial through values at the points: row j gives that of (t/h)^j.
static const double to_powers[MODAL_NODES][MODAL_NODES] = {
    {1, 0, 0, 0},
    {-6, 8.0901699437494742, -3.0901699437494742, 1},
    {10, -19.270509831248423, 14.270509831248423, -5},
    {-5, 11.180339887498949, -11.180339887498949, 5}};

void modal_polynomial(const double values[MODAL_NODES], double length, double out[MODAL_NODES])
{
    double scale = 1;
    for (int j = 0; j < MODAL_NODES; j++) {
        out[j] = 0;
        for (int i = 0; i < MODAL_NODES; i++) {
            out[j] += to_powers[j][i] * values[i];
        }
        out[j] *= scale;
        scale *= (j + 1) / length;
    }
}

// The polynomials of r and s from their values; returns what changed, as the momenta and, times
// their rates, coordinates that it makes in the stride.
static double fit_polynomials(modal_stride *s, double h)
{
    const modal_table *end = &s->at[MODAL_NODES - 1];
    double square = 0;
    for (int k = 0; k < s->count; k++) {
        const double twice = 2 * s->damping[k], rate = s->modes->rate[k];
        double scale = 1, moved = 0, placed = 0, lower = end->impulse[k];

        // power by power: the new coefficients, and what their change does until the end
        for (int j = 0; j < MODAL_NODES; j++) {
            double drift = 0, force = 0;
            for (int i = 0; i < MODAL_NODES; i++) {
                drift += to_powers[j][i] * s->drifts[i][k];
                force += to_powers[j][i] * s->forces[i][k];
            }
            drift *= scale;
            force *= scale;
            const double dd = drift - s->drift[j][k], df = force - s->force[j][k];
            const double power = end->power[j][k];
            placed += df * power + dd * (lower + twice * power);
            moved += df * lower - rate * rate * dd * power;
            lower = power;
            s->drift[j][k] = drift;
            s->force[j][k] = force;
            scale *= (j + 1) / h;
        }

        square += moved * moved + rate * rate * placed * placed;
    }
    return sqrt(square);
}

// Whether a mode vibrates too fast in the stride to be seen in r and s.
static bool is_fast(const modal_stride *s, int k)
{
    const double rate = s->modes->rate[k];
    return k != s->modes->across && s->damping[k] < rate && rate * s->length > MODAL_FAST;
}

// What a mode with a spring does under the polynomials without vibrating: x = sum p[j] t^j / j!.
static void follow(const modal_stride *s, int k, double p[MODAL_NODES + 2])
{
    const double twice = 2 * s->damping[k], stiff = s->modes->rate[k] * s->modes->rate[k];
    p[MODAL_NODES] = p[MODAL_NODES + 1] = 0;
    for (int j = MODAL_NODES - 1; j >= 0; j--) {
        const double turn = j + 1 < MODAL_NODES ? s->drift[j + 1][k] : 0;
        const double n = s->force[j][k] + twice * s->drift[j][k] + turn;
        p[j] = (n - twice * p[j + 1] - p[j + 2]) / stiff;
    }
}

// Such a mode without its vibration, at t within the stride: what follows the polynomials.
static void without_vibration(const modal_stride *s, int k, double t, double *x, double *y)
{
    double p[MODAL_NODES + 2], place = 0, speed = 0, drift = 0, power = 1;
    follow(s, k, p);
    for (int j = 0; j < MODAL_NODES; j++) {
        place += p[j] * power;
        speed += p[j + 1] * power;
        drift += s->drift[j][k] * power;
        power *= t / (j + 1);
    }
    *x = place;
    *y = speed - drift;
}

// The modes' responses at the points of collocation: of a length that is a power of two they are
// computed once a basis.
static void take_tables(modal_stride *s, double length)
{
    int exponent;
    const bool round = frexp(length, &exponent) == 0.5;
    const int slot = 1 - exponent - MODAL_LONGEST_LEVEL;
    const bool kept = round && slot >= 0 && slot < MODAL_KEPT_LEVELS;
    modal_kept *keep = kept ? &s->kept[s->modes - s->basis][slot] : &s->passing;

    // a kept table is filled once, the passing one every time
    if (!kept || !keep->known) {
        for (int i = 1; i < MODAL_NODES; i++) {
            fill_table(s, points[i] * length, kept_powers(i), s->count, &keep->at[i]);
        }
        keep->known = true;
    }

    // from here on it makes no difference where they are kept
    for (int i = 1; i < MODAL_NODES; i++) {
        s->at[i] = keep->at[i];
    }
}

// r and s at the points of collocation from the present polynomials.
static void evaluate_points(modal_stride *s, const arm *a, chain_link *links, const double *q)
{
    const int n = s->dof;
    const size_t pair = 2 * (size_t)n;

    // the modes' places and momenta, as angles
    for (int i = 0; i < MODAL_NODES; i++) {
        double *x = s->columns + (size_t)i * pair;
        if (i > 0) {
            modal_state(s, &s->at[i], x, x + n);
        } else {
            memset(x, 0, (size_t)n * sizeof *x);
            memcpy(x + n, s->start, (size_t)s->count * sizeof *x);
        }
        for (int k = 0; k < s->count; k++) {
            if (is_fast(s, k)) {
                without_vibration(s, k, points[i] * s->length, x + k, x + n + k);
            }
        }
        memcpy(s->modal + (size_t)i * pair, x, pair * sizeof *x);
        to_momenta(s, a, x, x + n);
    }
    modal_to_angles(s->modes, n, COLUMNS, s->columns, s->more_columns, n);

    // velocities and forces there by the sweeps
    for (int i = 0; i < MODAL_NODES; i++) {
        double *turn = s->more_columns + (size_t)i * pair;
        double *momentum = s->columns + (size_t)i * pair, impulse;
        modal_mass_times(a, turn + n, momentum);
        for (int k = 0; k < n; k++) {
            s->angles[k] = q[k] + turn[k];
            momentum[k] += s->momentum[k];
        }
        chain_from_momentum(a, links, s->mode, s->angles, momentum, s->velocities, s->rates,
                            &impulse);
        memcpy(s->point_angles[i], s->angles, (size_t)n * sizeof *q);
        memcpy(s->point_velocities[i], s->velocities, (size_t)n * sizeof *q);
        prepare_remainders(s, a, s->velocities, turn);
    }

    // brought back to the modes
    modal_from_angles(s->modes, n, COLUMNS, s->more_columns, s->columns, n);
    for (int i = 0; i < MODAL_NODES; i++) {
        const double *x = s->modal + (size_t)i * pair;
        take_remainders(s, i, x, x + n, s->columns + (size_t)i * pair);
    }
}

modal_fit modal_stride_fit(modal_stride *s, const arm *a, chain_link *links, const double *q,
                           double length)
{
    const size_t size = (size_t)s->count * sizeof(double);
    s->length = length;

    // first guess: what holds at the start
    double speed = 1e-30;
    take_tables(s, length);
    for (int i = 1; i < MODAL_NODES; i++) {
        memcpy(s->drifts[i], s->drifts[0], size);
        memcpy(s->forces[i], s->forces[0], size);
    }
    for (int k = 0; k < s->count; k++) {
        speed += s->start[k] * s->start[k];
    }

    // sweeps until nothing changes
    modal_fit fit = {0};
    fit_polynomials(s, length);
    for (int i = 0; i < MOST_SWEEPS; i++) {
        evaluate_points(s, a, links, q);
        const double last = fit.change;
        fit.change = fit_polynomials(s, length) / sqrt(speed);
        fit.sweeps = i + 1;
        bool idle = i >= FEW_SWEEPS && fit.change > SLOW_SWEEPS * last;
        if (!(fit.change < 1e3) || fit.change < CONVERGED || idle) {
            break;
        }
    }

    // what the highest power does
    for (int k = 0; k < s->count; k++) {
        const int top = MODAL_NODES - 1;
        double y = s->force[top][k] * s->at[top].power[top - 1][k];
        double x = s->drift[top][k] * s->at[top].power[top - 1][k] * s->modes->rate[k];
        fit.cut += y * y + x * x;
    }
    fit.cut = sqrt(fit.cut / speed);
    return fit;
}

double modal_stride_fastest(const modal_stride *s)
{
    double fastest = 1e-300;
    for (int k = 0; k < s->count; k++) {
        if (k != s->modes->across && s->damping[k] < s->modes->rate[k]) {
            fastest = fmax(fastest, s->modes->rate[k]);
        }
    }
    return fastest;
}

double modal_stride_quickest(const modal_stride *s)
{
    double quickest = 1e-300;
    for (int e = 0; e < s->now->count; e++) {
        quickest = fmax(quickest, s->now->square[e]);
    }
    return sqrt(quickest);
}

bool modal_stride_vibration(modal_stride *s, const arm *a, chain_link *links, const double *q,
                            double *along)
{
    const int n = s->dof;
    double *y = s->columns, *turn = s->more_columns, *momentum = turn + n, impulse;
    bool any = false;

    // momenta of the modes, beyond what follows the polynomials
    for (int k = 0; k < s->count; k++) {
        double x = 0, slow = 0;
        bool fast = is_fast(s, k);
        if (fast) {
            without_vibration(s, k, s->time, &x, &slow);
        }
        y[k] = fast ? s->momenta[k] - slow : 0;
        any |= fast;
    }
    if (!any) {
        return false;
    }

    // velocities that belong to them
    modal_to_angles(s->modes, n, 1, y, turn, n);
    modal_mass_times(a, turn, momentum);
    chain_from_momentum(a, links, s->mode, q, momentum, along, s->rates, &impulse);
    return true;
}

// --- walks ------------------------------------------------------------------------------------

void modal_walk_begin(modal_stride *s, int count)
{
    modal_walk *w = &s->walk;
    const size_t size = (size_t)count * sizeof(double);
    const int e = s->modes->across;
    w->count = count;
    w->step = w->time = 0;

    // from rest at the stride's start, under its polynomials
    memset(w->x, 0, size);
    memcpy(w->y, s->start, size);
    for (int j = 0; j < MODAL_NODES; j++) {
        memcpy(w->force[j], s->force[j], size);
        memcpy(w->drift[j], s->drift[j], size);
        if (e >= 0 && e < count) {
            w->force[j][e] = w->y[e] = 0;
        }
    }
}

void modal_walk_set_step(modal_stride *s, double step)
{
    if (s->walk.step != step) {
        s->walk.step = step;
        fill_table(s, step, MODAL_NODES, s->walk.count, &s->walk.at);
    }
}

void modal_walk_on(modal_stride *s)
{
    modal_walk *w = &s->walk;
    const double t = w->step, t2 = t * t / 2, t3 = t * t2 / 3;
    const modal_table *at = &w->at;

    // the modes
    for (int k = 0; k < w->count; k++) {
        const double twice = 2 * s->damping[k], stiff = s->modes->rate[k] * s->modes->rate[k];
        const double x = w->x[k], y = w->y[k], g = at->impulse[k], gr = at->impulse_rate[k];
        double place = x * (gr + twice * g) + y * g, rate = y * gr - stiff * g * x, lower = g;
        for (int j = 0; j < MODAL_NODES; j++) {
            const double power = at->power[j][k], f = w->force[j][k], d = w->drift[j][k];
            place += f * power + d * (lower + twice * power);
            rate += f * lower - stiff * d * power;
            lower = power;
        }
        w->x[k] = place;
        w->y[k] = rate;
    }

    // the polynomials about the next instant
    for (int i = 0; i < 2; i++) {
        double **p = i == 0 ? w->force : w->drift;
        for (int k = 0; k < w->count; k++) {
            const double p1 = p[1][k], p2 = p[2][k], p3 = p[3][k];
            p[0][k] += t * p1 + t2 * p2 + t3 * p3;
            p[1][k] += t * p2 + t2 * p3;
            p[2][k] += t * p3;
        }
    }
    w->time += t;
}

// --- losses -----------------------------------------------------------------------------------

// Integral from 0 to t of the product of two polynomials sum p[j] t^j / j!.
static double product_integral(const double *p, const double *q, double t)
{
    static const double factorial[MODAL_NODES] = {1, 1, 2, 6};
    double powers[2 * MODAL_NODES], sum = 0;
    powers[0] = t;
    for (int i = 1; i < 2 * MODAL_NODES; i++) {
        powers[i] = powers[i - 1] * t;
    }
    for (int i = 0; i < MODAL_NODES; i++) {
        for (int j = 0; j < MODAL_NODES; j++) {
            sum += p[i] * q[j] * powers[i + j] / ((i + j + 1) * factorial[i] * factorial[j]);
        }
    }
    return sum;
}

// Moments of a mode: of x, integral of t^j / j! x, and of v = x', the same.
static void moments(const modal_stride *s, int k, double t, double *of_x, double *of_v)
{
    const modal_table *at = s->ending;
    const double twice = 2 * s->damping[k];

    // x integrated i times
    double repeated[MODAL_NODES + 1];
    for (int i = 1; i <= MODAL_NODES; i++) {
        double sum = s->start[k] * at->power[i - 1][k];
        for (int j = 0; j < MODAL_NODES; j++) {
            const double power = at->power[j + i][k];
            sum +=
                s->force[j][k] * power + s->drift[j][k] * (at->power[j + i - 1][k] + twice * power);
        }
        repeated[i] = sum;
    }

    // by parts
    double term[MODAL_NODES] = {1};
    for (int j = 1; j < MODAL_NODES; j++) {
        term[j] = term[j - 1] * t / j;
    }
    for (int j = 0; j < MODAL_NODES; j++) {
        of_x[j] = 0;
        for (int i = 0; i <= j; i++) {
            of_x[j] += (i % 2 ? -term[j - i] : term[j - i]) * repeated[i + 1];
        }
        of_v[j] = term[j] * s->place[k] - (j > 0 ? of_x[j - 1] : 0);
    }
}

// The hub's velocity without what vibrates fast, beyond the low modes: a polynomial, and decays.
typedef struct hub_motion {
    double power[MODAL_NODES]; // sum power[j] t^j / j! [rad/s]
    double *slow, *rate;       // decays [rad/s], [1/s]
    int decays;
} hub_motion;

// Adds a mode that is not a low one; returns the loss of its own that is in its vibration alone, of
// the `loss` of all its motion.
static double add_to_hub(const modal_stride *s, int k, double t, double loss, hub_motion *h)
{
    const double hub = s->modes->by_dof[k], damping = s->damping[k], rate = s->modes->rate[k];
    double p[MODAL_NODES + 2];
    follow(s, k, p);
    for (int j = 0; j < MODAL_NODES; j++) {
        h->power[j] += hub * p[j + 1];
    }

    // a vibration
    if (damping < rate) {
        const double own = loss - 2 * damping * product_integral(p + 1, p + 1, t);
        return damping > 0 ? own * s->viscous[k] / (2 * damping) : 0;
    }

    // two decays, of which the fast one is over in no time
    const double root = fmax(sqrt((damping - rate) * (damping + rate)), 1e-4 * rate);
    const double slow = rate * rate / (damping + root), fast = damping + root;
    const double place = -p[0], speed = s->start[k] + s->drift[0][k] - p[1];
    const double kept = (fast * place + speed) / (fast - slow);
    const double lost = fast * (slow * place + speed) / (fast - slow);
    h->slow[h->decays] = -hub * slow * kept;
    h->rate[h->decays++] = slow;
    return s->viscous[k] * lost * lost * (1 - modal_decay(-2 * fast * t)) / (2 * fast);
}

// What the hub's viscous damping takes from the low modes and the rest's slow motion together: the
// trapezoidal rule with corrected ends on a walk that resolves them.
static double hub_loss(modal_stride *s, const arm *a, double t, int low, const hub_motion *rest)
{
    const double *hub = s->modes->by_dof;
    double sum = 0, first_slope = 0, last_slope = 0;
    modal_walk *w = &s->walk;

    // hub's velocity and its slope from step to step
    modal_walk_begin(s, low);
    const double turn = low > 0 ? s->modes->rate[low - 1] * t : 0;
    const int steps = (int)fmax(LEAST_HUB_STEPS, ceil(turn / HUB_TURN));
    modal_walk_set_step(s, t / steps);
    for (int i = 0; i <= steps; i++) {
        const double *p = rest->power, x = w->time, x2 = x * x / 2;
        double speed = p[0] + x * p[1] + x2 * p[2] + x * x2 / 3 * p[3];
        double slope = p[1] + x * p[2] + x2 * p[3];
        for (int k = 0; k < rest->decays; k++) {
            const double now = rest->slow[k] * modal_decay(-rest->rate[k] * x);
            speed += now;
            slope -= rest->rate[k] * now;
        }
        for (int k = 0; k < low; k++) {
            const double rate = s->modes->rate[k];
            speed += hub[k] * (w->y[k] + w->drift[0][k]);
            slope += hub[k] * (w->force[0][k] + w->drift[1][k] - rate * rate * w->x[k] -
                               2 * s->damping[k] * w->y[k]);
        }
        sum += (i == 0 || i == steps ? 0.5 : 1) * speed * speed;
        first_slope = i == 0 ? 2 * speed * slope : first_slope;
        last_slope = 2 * speed * slope;
        if (i < steps) {
            modal_walk_on(s);
        }
    }

    return a->motor.damping * w->step * (sum + w->step * (first_slope - last_slope) / 12);
}

modal_losses modal_stride_losses(modal_stride *s, const arm *a, double t)
{
    const int e = s->modes->across;
    modal_losses lost = {0};

    // modes slow enough to be taken together
    int low = 0;
    while (low < s->count && low != e && s->modes->rate[low] * t < LOW_TURN &&
           s->damping[low] * t < LOW_TURN) {
        low++;
    }

    // the hub's motion beyond them
    hub_motion rest = {.slow = s->columns, .rate = s->more_columns};
    for (int j = 0; e >= 0 && j < MODAL_NODES; j++) {
        rest.power[j] = s->modes->by_dof[e] * s->drift[j][e];
    }

    for (int k = 0; k < s->count; k++) {
        const double rate = s->modes->rate[k], twice = 2 * s->damping[k];
        if (k == e || (twice == 0 && (e < 0 || s->per_stiffness == 0))) {
            continue;
        }

        // 2 a v^2, from the change of y^2 + w^2 x^2
        double of_x[MODAL_NODES], of_v[MODAL_NODES], drift[MODAL_NODES], sum[MODAL_NODES];
        moments(s, k, t, of_x, of_v);
        double x = s->place[k], y = s->momenta[k], y0 = s->start[k];
        double loss = -0.5 * ((y - y0) * (y + y0) + rate * rate * x * x);
        for (int j = 0; j < MODAL_NODES; j++) {
            drift[j] = s->drift[j][k];
            sum[j] = s->force[j][k] + twice * drift[j];
            loss += (sum[j] + twice * drift[j]) * of_v[j] + rate * rate * drift[j] * of_x[j];
        }
        loss -= product_integral(sum, drift, t);

        // in the springs, and at the hub beyond what the slow modes do together
        if (twice > 0) {
            lost.damping += loss * s->per_stiffness * rate * rate / twice;
        }
        if (a->motor.damping > 0 && k >= low) {
            lost.viscous += add_to_hub(s, k, t, loss, &rest);
        }

        // between this mode and the vector across the constraint
        double with_across = 0;
        for (int j = 0; j < MODAL_NODES; j++) {
            with_across += e >= 0 ? s->drift[j][e] * of_v[j] : 0;
        }
        lost.damping += 2 * s->per_stiffness * s->modes->pull[k] * with_across;
    }

    // that vector's own, and the slow modes' at the hub
    if (e >= 0) {
        double across[MODAL_NODES];
        for (int j = 0; j < MODAL_NODES; j++) {
            across[j] = s->drift[j][e];
        }
        lost.damping += s->per_stiffness * s->modes->pull[e] * product_integral(across, across, t);
    }
    lost.viscous += a->motor.damping > 0 ? hub_loss(s, a, t, low, &rest) : 0;
    return lost;
}
