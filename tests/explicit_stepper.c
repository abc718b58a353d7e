// A Runge-Kutta formula at a fixed step, which the caller keeps well inside their
// accuracy from the arm's highest frequency: no error estimate is carried.
//
// Long strides: order 8 with twelve stages (Hairer, Norsett, Wanner: Solving Ordinary
// Differential Equations I, section II.5; the method of their DOP853). An oscillation of
// z = rate times stride loses 8e-12 of its amplitude and 5e-11 rad of its phase in one at
// z = 0.45.
//
// It takes the walls that give, with any number of links. Hunt-Crossley's x^n is not
// analytic at the touch unless n is whole: a step from there is of order n + 1 only,
// whatever the method. Steps are therefore graded: none is longer than half the time that
// the wall's face needs to or from the
// touch, x/|v|, down to a shortest step whose error is below rounding. A step over [t,
// 3t/2] sees a function that is analytic about t with radius t, and keeps the method's
// accuracy.
#include <math.h>
#include <string.h>

#include "src/contact/motion.h"
#include "tests/explicit_stepper.h"

// Steps over several time steps, which slow arms take, may go this far in (fastest rate)
// x (step): they are few, and what they lose in a second is less than the short ones of
// fast arms do.
#define LONG_RESOLUTION 0.45
// Steps of a fraction of a time step keep (fastest rate) x (step) below this; the method
// then loses a few parts in 1e12 of the fastest mode's energy in one.
#define EXPLICIT_RESOLUTION 0.36
// Of the time from or to a touch that is not analytic, one step may take this share ...
#define GRADING 0.5
// ... and, next to the touch, this in (fastest rate) x (step): the error of order n + 1
// is lost there.
#define SHORTEST_RESOLUTION 3e-5
// Rotation counts this many times: no small oscillation, it feeds errors from link to
// link.
#define TURNING 3
// At most this many time steps are taken at once.
#define MOST_AT_ONCE 12

enum { LONG_STAGES = 12 };

// Row i: weights of stages 0..i-1 for the argument of stage i; the last row: of the
// result.
typedef double weight_row[LONG_STAGES];

static const weight_row long_weights[LONG_STAGES + 1] = {
    {0},
    {5.26001519587677318785587544488e-2},
    {1.97250569845378994544595329183e-2, 5.91751709536136983633785987549e-2},
    {2.95875854768068491816892993775e-2, 0, 8.87627564304205475450678981324e-2},
    {2.41365134159266685502369798665e-1, 0, -8.84549479328286085344864962717e-1,
     9.24834003261792003115737966543e-1},
    {3.7037037037037037037037037037e-2, 0, 0, 1.70828608729473871279604482173e-1,
     1.25467687566822425016691814123e-1},
    {3.7109375e-2, 0, 0, 1.70252211019544039314978060272e-1,
     6.02165389804559606850219397283e-2, -1.7578125e-2},
    {3.70920001185047927108779319836e-2, 0, 0, 1.70383925712239993810214054705e-1,
     1.07262030446373284651809199168e-1, -1.53194377486244017527936158236e-2,
     8.27378916381402288758473766002e-3},
    {6.24110958716075717114429577812e-1, 0, 0, -3.36089262944694129406857109825,
     -8.68219346841726006818189891453e-1, 2.75920996994467083049415600797e1,
     2.01540675504778934086186788979e1, -4.34898841810699588477366255144e1},
    {4.77662536438264365890433908527e-1, 0, 0, -2.48811461997166764192642586468,
     -5.90290826836842996371446475743e-1, 2.12300514481811942347288949897e1,
     1.52792336328824235832596922938e1, -3.32882109689848629194453265587e1,
     -2.03312017085086261358222928593e-2},
    {-9.3714243008598732571704021658e-1, 0, 0, 5.18637242884406370830023853209,
     1.09143734899672957818500254654, -8.14978701074692612513997267357,
     -1.85200656599969598641566180701e1, 2.27394870993505042818970056734e1,
     2.49360555267965238987089396762, -3.0467644718982195003823669022},
    {2.27331014751653820792359768449, 0, 0, -1.05344954667372501984066689879e1,
     -2.00087205822486249909675718444, -1.79589318631187989172765950534e1,
     2.79488845294199600508499808837e1, -2.85899827713502369474065508674,
     -8.87285693353062954433549289258, 1.23605671757943030647266201528e1,
     6.43392746015763530355970484046e-1},
    {5.42937341165687622380535766363e-2, 0, 0, 0, 0, 4.45031289275240888144113950566,
     1.89151789931450038304281599044, -5.8012039600105847814672114227,
     3.1116436695781989440891606237e-1, -1.52160949662516078556178806805e-1,
     2.01365400804030348374776537501e-1, 4.47106157277725905176885569043e-2},
};

// Rate of the motor's current where it is a state of its own [A/s], w [rad/s] being the
// hub's velocity; none at the limit, as long as the voltage would drive it beyond.
static double current_rate(const motor_model *m, double state, double w)
{
    if (m->inductance == 0) {
        return 0;
    }
    const double rate =
        (m->gain * m->voltage - m->resistance * state - m->back_emf * w) / m->inductance;
    return fabs(state) >= m->current_limit && rate * state > 0 ? 0 : rate;
}

// One step of the method.
static void explicit_step(const arm *a, motion *m, double h)
{
    // whether more than velocities and the plain arm's quadratures have rates
    const bool loaded = !arm_is_plain(a) || wall_gives(&a->wall);
    const int n = a->dof, length = 2 * n + QUADRATURE_COUNT;
    const int wanted = loaded ? length : length - (QUADRATURE_COUNT - QUADRATURE_WALL);
    const int current =
        2 * n + QUADRATURE_CURRENT; // the one that enters the accelerations
    const int moving = loaded && m->electric ? length : 2 * n;
    contact_state mode = contact_state_of(m->state);
    const double *y0 = state_angles(m, m->state);
    double *y = state_angles(m, m->trial);
    double *rate =
        m->memory; // rate[i * length]: derivative of the smooth part in stage i
    chain_reaction reaction;

    // the first stage was evaluated with the state itself
    const double *a0 = state_accelerations(m, m->state);
    double *quadrature = rate + 2 * n;
    for (int i = 0; i < n; i++) {
        rate[i] = y0[n + i];
        rate[n + i] = a0[i];
    }
    if (loaded) {
        quadrature[QUADRATURE_CURRENT] = current_rate(&a->motor, y0[current], y0[n]);
        quadrature[QUADRATURE_MOTOR] = m->state[SLOT_MOTOR_TORQUE] * y0[n];
    }
    quadrature[QUADRATURE_VISCOUS] = m->state[SLOT_VISCOUS_POWER];
    quadrature[QUADRATURE_DAMPING] = m->state[SLOT_DAMPING_POWER];
    quadrature[QUADRATURE_FORCE] = m->state[SLOT_FORCE];
    quadrature[QUADRATURE_WALL] = m->state[SLOT_WALL_POWER];
    quadrature[QUADRATURE_PUSHED] = m->state[SLOT_WALL_WORK];

#pragma GCC unroll 12
    for (int stage = 1; stage <= LONG_STAGES; stage++) {
        // the quadratures do not enter the accelerations: only their result is wanted
        for (int i = 0; i < (stage < LONG_STAGES ? moving : wanted); i++) {
            double sum = long_weights[stage][0] * rate[i];
#pragma GCC unroll 12
            for (int j = 1; j < stage; j++) {
                if (long_weights[stage][j] != 0) {
                    sum += long_weights[stage][j] * rate[j * length + i];
                }
            }
            y[i] = y0[i] + h * sum;
        }
        if (stage == LONG_STAGES) {
            break;
        }
        double *k = rate + stage * length;
        mode.current = loaded && m->electric ? y[current] : 0;
        double node = 0;
        for (int j = 0; j < stage; j++) {
            node += long_weights[stage][j];
        }
        const arm *now = motion_arm_at(a, m, m->state[SLOT_TIME] + node * h);
        chain_accelerations(now, m->links, y, y + n, mode, k + n, &reaction);
        for (int i = 0; i < n; i++) {
            k[i] = y[n + i];
        }
        if (loaded) {
            k[current] = current_rate(&a->motor, y[current], y[n]);
            k[2 * n + QUADRATURE_MOTOR] = reaction.motor_torque * y[n];
        }
        k[2 * n + QUADRATURE_VISCOUS] = reaction.viscous_power;
        k[2 * n + QUADRATURE_DAMPING] = reaction.damping_power;
        k[2 * n + QUADRATURE_FORCE] = reaction.force;
        k[2 * n + QUADRATURE_WALL] = reaction.wall_power;
        k[2 * n + QUADRATURE_PUSHED] = reaction.wall_work;
    }
}

static status step(const arm *a, motion *m, double h, state_extent extent)
{
    (void)extent;
    explicit_step(a, m, h);
    if (m->electric) { // what a step that ends at the limit goes beyond it
        double *current = &state_quadratures(m, m->trial)[QUADRATURE_CURRENT];
        *current = fmax(-a->motor.current_limit, fmin(*current, a->motor.current_limit));
    }
    motion_evaluate(a, m, m->trial);
    if (m->trial[SLOT_CONTACT] != 0 && motion_wall_is_rigid(m)) {
        motion_project(a, m, m->trial);
    }
    return STATUS_OK;
}

// Square of the largest bend of a joint that stiffens, of a root as one of a whole joint
// [rad2]; it may grow a little within a stride.
static double most_bend(const arm *a, const motion *m)
{
    const double *q = state_angles(m, m->state);
    double most = 0;
    for (int k = 1; k < a->dof && a->amount.stiffening > 0; k++) {
        const double bend = (k == a->first ? 2 : 1) * (q[k] - q[k - 1]);
        most = fmax(most, bend * bend);
    }
    return 1.5 * most;
}

// Upper estimate of how fast the state can change [1/s]: by the arm's own rate, and by
// its rotation, which stretches the chain. A chain that hangs in the field of its own
// rotation at rate w vibrates in the plane at w sqrt(n (2 n - 1) - 1), n = 1..N, its
// springs apart; squares of frequencies add. Velocities are taken as they are and as
// accelerations make them within a stride. `slowest` is the rate of an arm that does not
// turn.
static double rate_of_change(const arm *a, const motion *m, double slowest)
{
    const double *w = state_velocities(m, m->state),
                 *al = state_accelerations(m, m->state);
    const double n = a->links, stretched = n * (2 * n - 1);
    double fastest = 0, own = fmax(slowest, 1e-3);
    own *= sqrt(1 + 3 * a->amount.stiffening *
                        most_bend(a, m)); // slope of b + stiffening b^3
    for (int i = 0; i < a->dof; i++) {
        double gained = fabs(al[i]) * LONG_RESOLUTION / own;
        fastest = fmax(fastest, fabs(w[i]));
        fastest = fmax(fastest, fmin(fabs(w[i]) + gained, sqrt(fabs(al[i]))));
    }
    fastest *= TURNING;
    return sqrt(own * own + stretched * fastest * fastest);
}

// The same with a wall that gives, which the arm is in.
static double rate_within_wall(const arm *a, motion *m, double own)
{
    double depth = fmax(-m->state[SLOT_GAP], 0), rate = -m->state[SLOT_GAP_VELOCITY];
    const bool locked = contact_state_of(m->state).friction == HUB_STICK && m->dof > 1;
    double compliance = chain_contact_response(a, m->links, state_angles(m, m->state),
                                               locked, m->scratch);
    compliance /= 1 + a->wall.face_mass * compliance; // both masses on the spring
    double wall = wall_rate(&a->wall, compliance, depth, rate);
    return sqrt(own * own + wall * wall);
}

// How long a step may be for the touch's sake, where the law of the wall is not analytic
// there.
static double graded(const arm *a, const motion *m, double rate, double longest)
{
    if (a->wall.exponent == floor(a->wall.exponent) || m->state[SLOT_GAP_VELOCITY] == 0) {
        return longest;
    }
    double to_touch = fabs(m->state[SLOT_GAP] / m->state[SLOT_GAP_VELOCITY]);
    return fmin(longest, fmax(GRADING * to_touch, SHORTEST_RESOLUTION / rate));
}

// How long a step may be for the arm to meet a face that swings on its own where the ends
// of the step tell of it.
static double graded_face(const arm *a, const motion *m, double longest)
{
    const wall_model wall = wall_at(&a->wall, m->state[SLOT_TIME]);
    const double rate = wall_face_rate(&wall, state_face(m->state));
    longest = fmin(longest, wall_face_lasts(&a->wall, state_face(m->state)));
    return rate > 0 ? fmin(longest, EXPLICIT_RESOLUTION / rate) : longest;
}

// How long a step may be for the sake of the current's limit, on either side of which the
// equations are smooth.
static double graded_current(const arm *a, const motion *m, double rate, double longest)
{
    const motor_model *motor = &a->motor;
    const double w = state_velocities(m, m->state)[0],
                 al = state_accelerations(m, m->state)[0];
    const double state = state_quadratures(m, m->state)[QUADRATURE_CURRENT];
    const double limit = motor->current_limit,
                 free = motor->gain * motor->voltage - motor->back_emf * w;
    if (!m->electric || limit == HUGE_VAL) {
        return longest;
    }

    // the current without a limit, and how fast it goes there; at the limit the voltage
    // left over
    const bool held = motor->inductance > 0 && fabs(state) >= limit;
    const double now = motor->inductance > 0 && !held ? state : free / motor->resistance;
    const double slope = motor->inductance > 0 && !held
                             ? current_rate(motor, state, w)
                             : -motor->back_emf * al / motor->resistance;
    const double to_limit = slope != 0 ? fabs((fabs(now) - limit) / slope) : HUGE_VAL;
    return fmin(longest, fmax(GRADING * to_limit, SHORTEST_RESOLUTION / rate));
}

// How long the next step may be of an arm that changes at least at a rate [1/s].
static double longest_step(const arm *a, motion *m, double rate, double remaining,
                           double step_length)
{
    const bool pressed = !motion_wall_is_rigid(m) && m->state[SLOT_CONTACT] != 0;
    rate = rate_of_change(a, m, rate);
    rate = pressed ? rate_within_wall(a, m, rate) : rate;
    double steps = floor(LONG_RESOLUTION / (step_length * rate));
    double longest = steps >= 2
                         ? fmin(steps, MOST_AT_ONCE) * step_length
                         : step_length / ceil(step_length * rate / EXPLICIT_RESOLUTION);
    longest = pressed ? graded(a, m, rate, longest) : longest;
    longest = state_face_swings(m, m->state) ? graded_face(a, m, longest) : longest;
    longest = m->electric ? graded_current(a, m, rate, longest) : longest;
    longest = fmin(longest, wall_motion_lasts(&a->wall.motion, m->state[SLOT_TIME]));

    return remaining < longest * (1 + 1e-9) ? remaining : longest;
}

static double advance(const arm *a, motion *m, double remaining, double step_length)
{
    return longest_step(a, m, a->fastest_rate, remaining, step_length);
}

// Steps that follow decays, too, and half as long.
static double advance_fine(const arm *a, motion *m, double remaining, double step_length)
{
    const double rate = 2 * fmax(a->fastest_rate, a->fastest_decay);
    return longest_step(a, m, rate, remaining, step_length);
}

// The stages' derivatives of the state's smooth part.
static size_t init(const arm *a, void *memory)
{
    (void)memory; // scratch
    return (LONG_STAGES + 1) * (size_t)(2 * a->dof + QUADRATURE_COUNT) * sizeof(double);
}

const engine explicit_engine = {.name = "Runge-Kutta 8",
                                .init = init,
                                .advance = advance,
                                .state_at = step};
const engine explicit_fine_engine = {.name = "Runge-Kutta 8, fine",
                                     .init = init,
                                     .advance = advance_fine,
                                     .state_at = step};
