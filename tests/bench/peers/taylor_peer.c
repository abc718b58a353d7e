// A general Taylor integrator in the manner of Jorba and Zou's `taylor` and of heyoka: equations of
// motion as a list of operations whose Taylor coefficients follow from one another, order by order
// (automatic differentiation). It is independent of arms; the two-link arm is written down for it
// below, a list for each combination of contact and hub friction. Events are roots of polynomials,
// since what they watch is an operation of the list like any other.
//
// Jorba, Zou: A software package for the numerical integration of ODEs by means of high-order
// Taylor methods, Experimental Mathematics 14 (2005) 99-117: order and step from the tolerance and
// the last two terms. The equations are those that sundials_peer.c tells, solved by hand.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "tests/bench/peers/peer.h"

// ORDER is 1 - ln(TOLERANCE)/2, rounded up, for a tolerance of one rounding of a number near 1.
enum { ORDER = 20, MOST_NODES = 80 };
#define COOLDOWN 1e-5 // after an event its like is not looked for: rounding could repeat it [s]

// --- lists of operations and their series ---------------------------------------------------

typedef enum operation_kind {
    STATE, // the derivative of node n is node rate[n]
    CONSTANT,
    SCALED, // value times a
    PLUS,
    MINUS,
    TIMES,
    OVER,
    SINE,  // its cosine is the node after it
    COSINE // its sine is the node before it
} operation_kind;

typedef struct node {
    operation_kind kind;
    int a, b; // operands, earlier nodes
    double value;
} node;

enum { ANGLE_1, ANGLE_2, SPEED_1, SPEED_2, STATES };

// The first nodes are the states.
typedef struct operations {
    int count, rate[STATES];
    node nodes[MOST_NODES];
    double series[MOST_NODES][ORDER + 1];
} operations;

static int add(operations *l, operation_kind kind, int a, int b, double value)
{
    if (l->count == MOST_NODES) {
        fprintf(stderr, "peers: Taylor: the list of operations is full\n");
        abort();
    }
    l->nodes[l->count] = (node){kind, a, b, value};
    return l->count++;
}

static int constant(operations *l, double value)
{
    return add(l, CONSTANT, 0, 0, value);
}

static int scaled(operations *l, double value, int a)
{
    return add(l, SCALED, a, 0, value);
}

static int plus(operations *l, int a, int b)
{
    return add(l, PLUS, a, b, 0);
}

static int minus(operations *l, int a, int b)
{
    return add(l, MINUS, a, b, 0);
}

static int times(operations *l, int a, int b)
{
    return add(l, TIMES, a, b, 0);
}

static int over(operations *l, int a, int b)
{
    return add(l, OVER, a, b, 0);
}

// Sine; the cosine is the next node.
static int sine_and_cosine(operations *l, int a)
{
    int sine = add(l, SINE, a, 0, 0);
    add(l, COSINE, a, 0, 0);
    return sine;
}

// Sum of a[j] b[k - j] for j from `from` to `to`, in four sums that do not wait for each other.
static double convolution(const double *a, const double *b, int k, int from, int to)
{
    double sums[4] = {0, 0, 0, 0};
    int j = from;
    for (; j + 3 <= to; j += 4) {
        for (int i = 0; i < 4; i++) {
            sums[i] += a[j + i] * b[k - j - i];
        }
    }
    for (; j <= to; j++) {
        sums[0] += a[j] * b[k - j];
    }
    return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

// Sum of (j/k) a[j] b[k - j] for j from 1 to k: the derivative of a sine or cosine of a.
static double chain_rule(const double *a, const double *b, int k)
{
    double slope[ORDER + 1];
    for (int j = 1; j <= k; j++) {
        slope[j] = j * a[j];
    }
    return convolution(slope, b, k, 1, k) / k;
}

// Coefficient k of node n; those of lower order, and of earlier nodes of this order, are there.
static double coefficient(const operations *l, int n, int k, const double *state)
{
    node o = l->nodes[n];
    const double *a = l->series[o.a], *b = l->series[o.b];
    switch (o.kind) {
    case STATE:
        return k == 0 ? state[n] : l->series[l->rate[n]][k - 1] / k;
    case CONSTANT:
        return k == 0 ? o.value : 0;
    case SCALED:
        return o.value * a[k];
    case PLUS:
        return a[k] + b[k];
    case MINUS:
        return a[k] - b[k];
    case TIMES:
        return convolution(a, b, k, 0, k);
    case OVER:
        return (a[k] - convolution(l->series[n], b, k, 0, k - 1)) / b[0];
    case SINE:
        return k == 0 ? sin(a[0]) : chain_rule(a, l->series[n + 1], k);
    case COSINE:
        return k == 0 ? cos(a[0]) : -chain_rule(a, l->series[n - 1], k);
    }
    return (double)NAN;
}

// The series of all nodes at a state up to an order.
static void expand(operations *l, const double *state, int order)
{
    for (int k = 0; k <= order; k++) {
        for (int n = 0; n < l->count; n++) {
            l->series[n][k] = coefficient(l, n, k, state);
        }
    }
}

// Jorba and Zou's step for the series that are there, with an absolute tolerance where the state is
// below 1 and a relative one beyond [s].
static double step_length(const operations *l)
{
    double radius = HUGE_VAL, largest[3] = {1, 0, 0};
    static const int orders[] = {0, ORDER - 1, ORDER};
    for (int i = 0; i < 3; i++) {
        for (int n = 0; n < STATES; n++) {
            largest[i] = fmax(largest[i], fabs(l->series[n][orders[i]]));
        }
    }
    for (int i = 1; i < 3; i++) {
        radius = fmin(radius, pow(largest[0] / largest[i], 1.0 / orders[i]));
    }
    return radius * exp(-2 - 0.7 / (ORDER - 1));
}

// --- polynomials ----------------------------------------------------------------------------

static double value_at(const double *c, int degree, double t)
{
    double value = c[degree];
    for (int k = degree - 1; k >= 0; k--) {
        value = value * t + c[k];
    }
    return value;
}

// The polynomial of t + by.
static void shift(double *c, int degree, double by)
{
    for (int i = 0; i < degree; i++) {
        for (int k = degree - 1; k >= i; k--) {
            c[k] += by * c[k + 1];
        }
    }
}

// Where a polynomial that falls all the way from 0 to `end` is zero.
static double only_root(const double *c, int degree, double end)
{
    double low = 0, high = end;
    for (int i = 0; i < 60 && high - low > 1e-16; i++) {
        double middle = (low + high) / 2;
        *(value_at(c, degree, middle) > 0 ? &low : &high) = middle;
    }
    return high;
}

// First instant in [0, end] at which the polynomial falls through zero, NaN if there is none.
// Bounds of value and slope rule roots out or leave one; where they don't, the halves are asked.
static double first_fall(const double *c, int degree, double end)
{
    double away = 0, bend = 0, power = 1;
    for (int k = 1; k <= degree; k++) {
        bend += k > 1 ? k * fabs(c[k]) * power : 0;
        power *= end;
        away += fabs(c[k]) * power;
    }
    bool none = c[0] > away || c[0] < -away || c[1] > bend;
    if (none || c[1] < -bend || end < 1e-15) {
        bool falls = !none && c[0] >= 0 && value_at(c, degree, end) < 0;
        return falls ? only_root(c, degree, end) : (double)NAN;
    }
    double half = end / 2, root = first_fall(c, degree, half), right[ORDER + 1];
    if (isnan(root)) {
        for (int k = 0; k <= degree; k++) {
            right[k] = c[k];
        }
        shift(right, degree, half);
        root = half + first_fall(right, degree, half);
    }
    return root;
}

// The same from `from` on.
static double next_fall(const double *c, int degree, double from, double end)
{
    double later[ORDER + 1];
    if (from <= 0 || from >= end) {
        return from <= 0 ? first_fall(c, degree, end) : (double)NAN;
    }
    for (int k = 0; k <= degree; k++) {
        later[k] = c[k];
    }
    shift(later, degree, from);
    return from + first_fall(later, degree, end - from);
}

// --- the arm --------------------------------------------------------------------------------

enum { STUCK, FORWARD, BACKWARD, FRICTIONS };
enum { WALL_EVENT, HUB_EVENT, EVENTS };

// A combination of contact and hub friction: its equations, and nodes of interest. What an event
// watches falls through zero there: gap or force, the hub's speed or friction's reserve.
typedef struct mode {
    operations list;
    int watched[EVENTS];
    int force, holding;       // [N], hub friction's torque [N m]
    int x1, x2, det, through; // of an impact, see hit_wall
} mode;

typedef struct simulation {
    mode modes[2][FRICTIONS]; // free or in contact
    bool contact;
    int friction;
    double state[STATES]; // [rad], [rad/s]
    double since[EVENTS]; // each kind's last event [s]
} simulation;

static const double link_length = EXPERIMENT_BEAM_LENGTH / 2, link_mass = EXPERIMENT_BEAM_MASS / 2;

static void write_mode(mode *m, bool contact, int friction)
{
    // nothing but numbers, which are the same in all modes
    operations *l = &m->list;
    const double length = link_length, square = link_mass * length * length;
    const double m11 = EXPERIMENT_HUB_INERTIA + square * (1.0 / 12 + 1.25);
    const double m22 = square * (1.0 / 12 + 0.25);
    const double sliding = friction == FORWARD    ? EXPERIMENT_STICTION
                           : friction == BACKWARD ? -EXPERIMENT_STICTION
                                                  : 0;
    for (int n = 0; n < STATES; n++) {
        add(l, STATE, 0, 0, 0);
    }

    // inertia, torques without the wall, the wall's direction
    int d = minus(l, ANGLE_2, ANGLE_1), s = sine_and_cosine(l, d);
    int m12 = scaled(l, square / 2, s + 1), bend = scaled(l, EXPERIMENT_SPRING, d);
    int b = scaled(l, square / 2, s), w1_w1 = times(l, SPEED_1, SPEED_1);
    int w2_w2 = times(l, SPEED_2, SPEED_2);
    int drive = minus(l, constant(l, EXPERIMENT_TORQUE * EXPERIMENT_VOLTAGE - sliding),
                      scaled(l, EXPERIMENT_HUB_DAMPING, SPEED_1));
    int r1 = plus(l, plus(l, drive, bend), times(l, b, w2_w2));
    int r2 = scaled(l, -1, plus(l, bend, times(l, b, w1_w1)));
    int s1 = sine_and_cosine(l, plus(l, ANGLE_1, constant(l, -EXPERIMENT_WALL)));
    int s2 = sine_and_cosine(l, plus(l, ANGLE_2, constant(l, -EXPERIMENT_WALL)));
    int j1 = scaled(l, length, s1 + 1), j2 = scaled(l, length, s2 + 1);
    int gap = scaled(l, -length, plus(l, s1, s2)), j_rate = -1;
    if (contact) {
        j_rate = scaled(l, -length, plus(l, times(l, s1, w1_w1), times(l, s2, w2_w2)));
    }

    // accelerations, force and friction
    int a1 = constant(l, 0), a2;
    m->force = a1;
    m->holding = constant(l, sliding);
    if (friction == STUCK) {
        a2 = contact ? scaled(l, -1, over(l, j_rate, j2)) : scaled(l, 1 / m22, r2);
        m->holding = minus(l, r1, times(l, m12, a2));
        if (contact) {
            m->force = over(l, minus(l, r2, scaled(l, m22, a2)), j2);
            m->holding = minus(l, m->holding, times(l, j1, m->force));
        }
    } else {
        m->det = minus(l, constant(l, m11 * m22), times(l, m12, m12));
        a1 = minus(l, scaled(l, m22, r1), times(l, m12, r2));
        a2 = minus(l, scaled(l, m11, r2), times(l, m12, r1));
        if (contact) {
            m->x1 = minus(l, scaled(l, m22, j1), times(l, m12, j2));
            m->x2 = minus(l, scaled(l, m11, j2), times(l, m12, j1));
            m->through = plus(l, times(l, j1, m->x1), times(l, j2, m->x2));
            int into = plus(l, times(l, j1, a1), times(l, j2, a2));
            m->force = over(l, plus(l, into, times(l, m->det, j_rate)), m->through);
            a1 = minus(l, a1, times(l, m->force, m->x1));
            a2 = minus(l, a2, times(l, m->force, m->x2));
        }
        a1 = over(l, a1, m->det);
        a2 = over(l, a2, m->det);
    }
    const int rates[STATES] = {SPEED_1, SPEED_2, a1, a2};
    for (int n = 0; n < STATES; n++) {
        l->rate[n] = rates[n];
    }

    // what events watch
    const double most = EXPERIMENT_STICTION * EXPERIMENT_STICTION;
    m->watched[WALL_EVENT] = contact ? m->force : gap;
    m->watched[HUB_EVENT] = friction == FORWARD ? SPEED_1
                            : friction == BACKWARD
                                ? scaled(l, -1, SPEED_1)
                                : minus(l, constant(l, most), times(l, m->holding, m->holding));
}

static mode *now(simulation *s)
{
    return &s->modes[s->contact][s->friction];
}

static double number(const mode *m, int n)
{
    return m->list.series[n][0];
}

// Plastic impact: M dw = -J' p with J (w + dw) = 0; friction is no match for an impulse [N s].
static double hit_wall(simulation *s)
{
    mode *m = &s->modes[true][FORWARD];
    double *w = s->state + SPEED_1;
    expand(&m->list, s->state, 0);
    double j1 = link_length * cos(s->state[ANGLE_1] - EXPERIMENT_WALL);
    double j2 = link_length * cos(s->state[ANGLE_2] - EXPERIMENT_WALL);
    double share = (j1 * w[0] + j2 * w[1]) / number(m, m->through);
    w[0] -= share * number(m, m->x1);
    w[1] -= share * number(m, m->x2);
    return share * number(m, m->det);
}

// The friction that goes with the hub's speed, and whether a touched wall pushes at all.
static void settle_mode(simulation *s)
{
    double hub = s->state[SPEED_1];
    s->friction = hub > 0 ? FORWARD : hub < 0 ? BACKWARD : STUCK;
    expand(&now(s)->list, s->state, 0);
    double holding = number(now(s), now(s)->holding);
    if (s->friction == STUCK && fabs(holding) > EXPERIMENT_STICTION) {
        s->friction = holding > 0 ? FORWARD : BACKWARD;
        expand(&now(s)->list, s->state, 0);
    }
    s->contact = s->contact && number(now(s), now(s)->force) > 0;
}

// The force's maxima within a stride of the first pulse: where its slope falls through zero.
static void watch_peak(const mode *m, double t, double stride, peer_answer *answer)
{
    const double *force = m->list.series[m->force];
    double slope[ORDER], at;
    for (int k = 1; k <= ORDER; k++) {
        slope[k - 1] = k * force[k];
    }
    peer_note_peak(t, force[0], answer);
    for (double from = 0; !isnan(at = next_fall(slope, ORDER - 1, from, stride));
         from = at + COOLDOWN) {
        peer_note_peak(t + at, value_at(force, ORDER, at), answer);
    }
}

static void pass_event(simulation *s, int kind, double t, peer_answer *answer)
{
    s->since[kind] = t;
    if (kind == HUB_EVENT && s->friction != STUCK) {
        s->state[SPEED_1] = 0;
    }
    if (kind == WALL_EVENT && !s->contact) {
        double impulse = hit_wall(s);
        s->contact = true;
        peer_note_contact(t, impulse, answer);
    } else if (kind == WALL_EVENT) {
        s->contact = false;
    }
    if (s->contact && s->state[SPEED_1] == 0) {
        s->state[SPEED_2] = 0; // the wall and a resting hub hold the second link
    }
    settle_mode(s);
    if (!s->contact && !isnan(answer->first_contact) && isnan(answer->release)) {
        answer->release = t;
    }
}

static bool run(void *instance, peer_answer *answer)
{
    simulation *s = instance;
    double t = 0;
    long steps = 0;
    s->contact = false;
    for (int n = 0; n < STATES; n++) {
        s->state[n] = 0;
    }
    for (int k = 0; k < EVENTS; k++) {
        s->since[k] = -1;
    }
    settle_mode(s);

    // held by wall and friction nothing moves any more
    while (t < EXPERIMENT_DURATION && !(s->contact && s->friction == STUCK)) {
        mode *m = now(s);
        expand(&m->list, s->state, ORDER);
        double stride = fmin(step_length(&m->list), EXPERIMENT_DURATION - t);

        // the first event ends the stride
        int event = -1;
        for (int k = 0; k < EVENTS; k++) {
            double root =
                next_fall(m->list.series[m->watched[k]], ORDER, s->since[k] + COOLDOWN - t, stride);
            if (!isnan(root)) {
                stride = root;
                event = k;
            }
        }
        if (s->contact && isnan(answer->release)) {
            watch_peak(m, t, stride, answer);
        }
        for (int n = 0; n < STATES; n++) {
            s->state[n] = value_at(m->list.series[n], ORDER, stride);
        }
        bool over_now = event < 0 && stride >= EXPERIMENT_DURATION - t;
        t = over_now ? EXPERIMENT_DURATION : t + stride;
        steps++;
        if (event >= 0) {
            pass_event(s, event, t, answer);
        }
        if (!isfinite(s->state[ANGLE_1]) || !(stride > 0)) {
            return false;
        }
    }
    expand(&now(s)->list, s->state, 0);
    answer->steps = (double)steps;
    answer->final_force = number(now(s), now(s)->force);
    answer->hub_angle = s->state[ANGLE_1];
    return true;
}

static void *create(const peer *self)
{
    (void)self;
    simulation *s = calloc(1, sizeof *s);
    for (int k = 0; s != NULL && k < 2 * FRICTIONS; k++) {
        write_mode(&s->modes[k / FRICTIONS][k % FRICTIONS], k / FRICTIONS != 0, k % FRICTIONS);
    }
    return s;
}

static const peer list_of_peers[] = {
    {"Taylor", "-", "list of operations, order 20", 2, 0, create, free, run, peer_own_steps,
     peer_duration},
};

int peers_taylor(const peer **list)
{
    *list = list_of_peers;
    return (int)(sizeof list_of_peers / sizeof list_of_peers[0]);
}
