#include <math.h>
#include <string.h>

#include "src/solve/modal_loops.h"
#include "src/solve/modal_parts.h"
#include "src/solve/modal_points.h"

enum { FEW_SWEEPS = 4, MOST_SWEEPS = 30 };

#define CONVERGED   1e-8 // change still to come that ends them, of the modes' momenta
#define SLOW_SWEEPS 0.6  // of the last change is left: a shorter stride costs less

// Lobatto's points on [0, 1].
static const double points[MODAL_NODES] = {0,
                                           0.11747233803526765357,
                                           0.35738424175967745184,
                                           0.64261575824032254816,
                                           0.88252766196473234643,
                                           1};

const double modal_to_powers[MODAL_NODES][MODAL_NODES] = {
    {1, 0, 0, 0, 0, 0},
    {-15, 20.2828318726393386, -8.07237454061069601, 4.48936929635233365, -2.6998266283809762, 1},
    {70, -131.581984462996828, 98.4982356860737689, -60.3544529094590041, 37.4382016863820634, -14},
    {-140, 299.687857326012612, -289.4574355386068, 220.335880473893995, -146.566302261299807, 56},
    {126, -288.460915381973069, 320.199031477787411, -285.638253945431009, 211.900137849616667,
     -84},
    {-42, 100.072210646317947, -121.167457084643684, 121.167457084643684, -100.072210646317947,
     42}};

void modal_polynomial(const double values[MODAL_NODES], double length, double out[MODAL_NODES])
{
    double scale = 1;
    for (int j = 0; j < MODAL_NODES; j++) {
        out[j] = 0;
        for (int i = 0; i < MODAL_NODES; i++) {
            out[j] += modal_to_powers[j][i] * values[i];
        }
        out[j] *= scale;
        scale *= (j + 1) / length;
    }
}

// Effect of the last Legendre coefficients of r and s on momenta and (times the modes' rates)
// coordinates, as if these terms were constant; in a mode that decays fast only for as long as it
// remembers. Across a constraint s is the contact force, which moves nothing.
static double last_terms(const modal_stride *s, double h)
{
    static const double leading = 252; // coefficient of x^5 in the fifth one on [0, 1]
    double square = 0;
    for (int k = 0; k < s->count; k++) {
        const double rate = s->modes->rate[k];
        const double reach = fmin(h, 1 / fmax(rate, 1e-300));
        const double lasting = fmin(reach, 0.5 / fmax(s->damping[k], 1e-300));
        double drift = 0, force = 0;
        for (int i = 0; i < MODAL_NODES; i++) {
            drift += modal_to_powers[MODAL_NODES - 1][i] * s->drifts[i][k];
            force += modal_to_powers[MODAL_NODES - 1][i] * s->forces[i][k];
        }
        force *= k == s->modes->across ? 0 : lasting;
        drift *= rate * reach;
        square += force * force + drift * drift;
    }
    return sqrt(square) / leading;
}

// Whether a mode vibrates too fast for the collocation points of the stride to resolve it in r and
// s.
static bool is_fast(const modal_stride *s, int k)
{
    const double rate = s->modes->rate[k];
    return k != s->modes->across && s->damping[k] < rate && rate > s->shown_turn / s->length;
}

// The modes' responses at the points of collocation: those of the lengths last met are kept.
static void take_tables(modal_stride *s, double length)
{
    const size_t state = (size_t)(s->modes - s->basis);
    modal_kept *keep = s->kept[state];
    int i = 0;
    while (i < MODAL_KEPT && keep[i].length != length) {
        i++;
    }

    // a new one in place of the one kept longest
    if (i == MODAL_KEPT) {
        i = s->oldest[state];
        s->oldest[state] = (i + 1) % MODAL_KEPT;
        keep[i].length = length;
        for (int j = 1; j < MODAL_NODES; j++) {
            modal_fill_table(s, points[j] * length, modal_kept_powers(j), s->count, &keep[i].at[j]);
        }
    }
    for (int j = 1; j < MODAL_NODES; j++) {
        s->at[j] = keep[i].at[j];
    }
}

// The first point at which sweeps compute r and s anew: those of the start hold in every sweep,
// unless vibrations are left out of them.
static int first_point(modal_stride *s)
{
    for (int k = 0; k < s->count && s->start_holds; k++) {
        s->start_holds = !is_fast(s, k);
    }
    return s->start_holds ? 1 : 0;
}

// r and s at the points of collocation from the present polynomials.
static void evaluate_points(modal_stride *s, const arm *a, const double *q)
{
    const modal_loops *loops = modal_loops_here();
    const int row = s->row, first = first_point(s);
    const size_t pair = 2 * (size_t)row;

    // the modes' places and momenta, as angles
    for (int i = first; i < MODAL_NODES; i++) {
        double *x = s->columns + (size_t)i * pair;
        if (i > 0) {
            modal_momenta_at(s, &s->at[i], x, x + row);
        } else {
            memset(x, 0, (size_t)row * sizeof *x);
            memcpy(x + row, s->start, (size_t)row * sizeof *x);
        }
        if (first == 0) {
            loops->leave_out(s, points[i] * s->length, x, x + row);
        }
        memcpy(s->modal + (size_t)i * pair, x, pair * sizeof *x);
        s->tip[i] = modal_to_momenta(s, a, x, x + row);
    }
    const size_t skipped = (size_t)first * pair;
    const int columns = 2 * (MODAL_NODES - first);
    modal_to_angles(s->modes, s->dof, columns, s->columns + skipped, s->more_columns + skipped,
                    row);

    // velocities and forces there by the sweeps
    modal_sweep_points(s, a, q, first);

    // brought back to the modes
    modal_from_angles(s->modes, s->dof, columns, s->more_columns + skipped, s->columns + skipped,
                      row);
    for (int i = first; i < MODAL_NODES; i++) {
        const double *x = s->modal + (size_t)i * pair;
        modal_take_remainders(s, i, x, x + row, s->columns + (size_t)i * pair);
    }
}

modal_fit modal_stride_fit(modal_stride *s, const arm *a, const double *q, double length)
{
    const size_t size = (size_t)s->row * sizeof(double);
    const modal_loops *loops = modal_loops_here();
    s->length = length;

    // of all momenta, were the energy all kinetic, with what the motor adds
    const double torque = fabs(a->motor.torque) + a->motor.stiction;
    const double most = sqrt(2 * s->start_energy) + torque * length * s->hub_response + 1e-15;

    // first guess: what holds at the start
    take_tables(s, length);
    for (int i = 1; i < MODAL_NODES; i++) {
        memcpy(s->drifts[i], s->drifts[0], size);
        memcpy(s->forces[i], s->forces[0], size);
    }

    // sweeps until nothing changes
    modal_fit fit = {0};
    double change = 0; // by a sweep
    (void)loops->fit(s);
    for (int i = 0; i < MOST_SWEEPS; i++) {
        evaluate_points(s, a, q);
        const double last = change;
        change = sqrt(loops->fit(s)) / most;
        fit.sweeps = i + 1;
        const double share = i > 0 ? change / last : 1;
        fit.left = share < 1 ? change * share / (1 - share) : change;
        const bool idle = i >= FEW_SWEEPS && share > SLOW_SWEEPS;
        if (!(change < 1e3) || fit.left < CONVERGED || idle) {
            break;
        }
    }
    fit.defect = last_terms(s, length) / most;
    return fit;
}
