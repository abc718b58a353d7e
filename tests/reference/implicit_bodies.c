// Dense equations of motion of the implicit simulation.
#include "tests/reference/implicit_parts.h"

void factor(int n, int width, double *m, int *pivot)
{
    for (int p = 0; p < n; p++) {
        int best = p;
        for (int i = p + 1; i < n; i++) {
            best = fabs(m[i * width + p]) > fabs(m[best * width + p]) ? i : best;
        }
        pivot[p] = best;
        double *row = m + p * width, *other = m + best * width;
        for (int k = 0; k < n && best != p; k++) {
            const double swap = row[k];
            row[k] = other[k];
            other[k] = swap;
        }
        for (int i = p + 1; i < n; i++) {
            double *below = m + i * width;
            below[p] /= row[p];
            for (int k = p + 1; k < n && below[p] != 0; k++) {
                below[k] -= below[p] * row[k];
            }
        }
    }
}

void solve_factored(int n, int width, const double *m, const int *pivot, double *b)
{
    for (int p = 0; p < n; p++) {
        const double swap = b[p];
        b[p] = b[pivot[p]];
        b[pivot[p]] = swap;
    }
    for (int i = 0; i < n; i++) {
        for (int k = 0; k < i; k++) {
            b[i] -= m[i * width + k] * b[k];
        }
    }
    for (int i = n - 1; i >= 0; i--) {
        for (int k = i + 1; k < n; k++) {
            b[i] -= m[i * width + k] * b[k];
        }
        b[i] /= m[i * width + i];
    }
}

static void solve(int n, double m[][ROWS], double *b)
{
    int pivot[ROWS];
    factor(n, ROWS, m[0], pivot);
    solve_factored(n, ROWS, m[0], pivot, b);
}

void build_chain(simulation *s)
{
    const arm *a = s->a;
    s->n = a->dof;
    s->first = a->first;
    for (int k = 0; k < a->links; k++) {
        for (int i = 0; i <= k; i++) {
            for (int j = 0; j <= k; j++) {
                const double li = arm_link_of(s->a, i).length * (i < k ? 1 : 0.5);
                const double lj = arm_link_of(s->a, j).length * (j < k ? 1 : 0.5);
                s->coupling[i][j] += arm_link_of(s->a, k).mass * li * lj;
            }
        }
        for (int j = 0; j < a->links; j++) {
            s->coupling[k][j] +=
                a->tip_mass * arm_link_of(s->a, k).length * arm_link_of(s->a, j).length;
        }
    }
}

touch touch_at(const simulation *s, const double *q, const double *w)
{
    const arm *a = s->a;
    const int N = a->links, f = s->first;
    touch t = {0};
    if (!wall_stands(&a->wall)) {
        t.g = -1;
        return t;
    }
    if (a->wall.kind ==
        WALL_PLANE) { // the tip's distance from a line through the hub's axis
        const double direction = atan2(a->wall.sine, a->wall.cosine);
        for (int k = 0; k < N; k++) {
            const double l = arm_link_of(s->a, k).length, z = q[f + k] - direction;
            t.g += l * sin(z);
            t.j[f + k] += l * cos(z);
            t.velocity_terms -= l * sin(z) * w[f + k] * w[f + k];
        }
    } else { // the distance of the point from the last link's line
        const double c = cos(q[f + N - 1]), si = sin(q[f + N - 1]), spin = w[f + N - 1];
        double x = a->wall.x, y = a->wall.y, vx = 0, vy = 0, ax = 0, ay = 0;
        for (int k = 0; k < N - 1; k++) {
            const double l = arm_link_of(s->a, k).length, ck = cos(q[f + k]),
                         sk = sin(q[f + k]), wk = w[f + k];
            x -= l * ck;
            y -= l * sk;
            vx -= l * sk * wk;
            vy += l * ck * wk;
            ax -= l * ck * wk * wk;
            ay -= l * sk * wk * wk;
            t.j[f + k] = l * (sk * si + ck * c);
        }
        t.g = si * x - c * y;
        t.j[f + N - 1] = c * x + si * y;
        t.velocity_terms =
            (c * ay - si * ax) - t.g * spin * spin - 2 * spin * (c * vx + si * vy);
    }
    for (int i = 0; i < s->n; i++) {
        t.rate += t.j[i] * w[i];
    }
    return t;
}

// Torques of the joints into Q, and the power that their dampers and the air take.
static double passive_torques(const simulation *s, const double *q, const double *w,
                              double *Q)
{
    const arm *a = s->a;
    const int N = a->links, f = s->first;
    double power = 0;
    for (int k = f == 1 ? 0 : 1; k < N; k++) {
        const int i = f + k;
        const double bend = q[i] - q[i - 1], rate = w[i] - w[i - 1];
        const arm_link link = arm_link_of(a, k);
        // a joint stands for a whole link's bending, a beam's root for half a link's
        const double share = k > 0           ? a->amount.stiffening
                             : a->root_bends ? 4 * a->amount.stiffening
                                             : 0;
        double torque =
            link.stiffness * bend * (1 + share * bend * bend) + link.damping * rate;
        power += link.damping * rate * rate;
        for (int row = 0; row < a->damped_modes; row++) {
            double sum = 0;
            for (int j = f == 1 ? 0 : 1; j < N; j++) {
                sum += a->modal_damping[row][j] * (w[f + j] - w[f + j - 1]);
            }
            torque += a->modal_damping[row][k] * sum;
            power += a->modal_damping[row][k] * sum * rate;
        }
        Q[i] -= torque;
        Q[i - 1] += torque;
    }
    // air: a force against the velocity of each piece of the beam
    double vx = 0, vy = 0, velocity_x[MOST_BODIES], velocity_y[MOST_BODIES];
    for (int k = 0; k < N && a->amount.air_drag > 0; k++) {
        const double l = arm_link_of(s->a, k).length, c = cos(q[f + k]),
                     si = sin(q[f + k]), wk = w[f + k];
        velocity_x[k] = vx - l / 2 * si * wk;
        velocity_y[k] = vy + l / 2 * c * wk;
        vx -= l * si * wk;
        vy += l * c * wk;
        const double whole = a->amount.air_drag * l,
                     spin = a->amount.air_drag * l * l * l / 12;
        power += whole * (velocity_x[k] * velocity_x[k] + velocity_y[k] * velocity_y[k]) +
                 spin * wk * wk;
        Q[f + k] -= spin * wk;
        for (int i = 0; i <= k; i++) {
            const double lever = i < k ? arm_link_of(s->a, i).length : l / 2;
            Q[f + i] -= whole * lever *
                        (cos(q[f + i]) * velocity_y[k] - sin(q[f + i]) * velocity_x[k]);
        }
    }
    return power;
}

void mass_matrix(const simulation *s, const double *q, double m[][ROWS])
{
    const int f = s->first;
    for (int i = 0; i < s->n; i++) {
        for (int j = 0; j < s->n; j++) {
            m[i][j] = i >= f && j >= f ? s->coupling[i - f][j - f] * cos(q[i] - q[j]) : 0;
        }
        m[i][i] += i >= f ? arm_link_of(s->a, i - f).inertia : 0;
    }
    m[0][0] += s->a->hub_inertia;
}

double yield_of(const simulation *s, const touch *t, bool held, double change[ROWS])
{
    double m[ROWS][ROWS] = {{0}}, yields = 0;
    mass_matrix(s, s->y, m);
    for (int i = 0; i < s->n && held; i++) {
        m[0][i] = m[i][0] = i == 0;
    }
    memcpy(change, t->j, (size_t)s->n * sizeof(double));
    change[0] = held ? 0 : change[0];
    solve(s->n, m, change);
    for (int i = 0; i < s->n; i++) {
        yields += t->j[i] * change[i];
    }
    return yields;
}

// By the law's own: no force is on it.
double face_return(const wall_model *w, double depth)
{
    if (depth <= 0) {
        return 0;
    }
    return w->law == WALL_KELVIN_VOIGT ? -w->stiffness / w->damping * depth
                                       : -w->stiffness / w->damping;
}

static double law_force(const wall_model *w, double depth, double rate)
{
    return w->law == WALL_KELVIN_VOIGT ? w->stiffness * depth + w->damping * rate
           : depth <= 0                ? 0
                        : pow(depth, w->exponent) * (w->stiffness + w->damping * rate);
}

void rate_of(const simulation *s, const phase *p, const double *y, double *dy, answer *r)
{
    const arm *a = s->a;
    const wall_model *wall = &a->wall;
    const motor_model *motor = &a->motor;
    const int n = s->n, f = s->first;
    const double *q = y, *w = y + n, *other = y + 2 * n;
    double m[ROWS][ROWS] = {{0}}, Q[ROWS] = {0};
    *r = (answer){0};
    mass_matrix(s, q, m);
    r->damping = passive_torques(s, q, w, Q);
    for (int i = f; i < n; i++) {
        for (int j = f; j < n; j++) {
            Q[i] -= s->coupling[i - f][j - f] * sin(q[i] - q[j]) * w[j] * w[j];
        }
    }

    // motor
    double torque = motor->torque - motor->damping * w[0], current_rate = 0;
    r->viscous = motor->damping * w[0] * w[0];
    r->work = motor->torque * w[0];
    if (motor->electric) {
        const double drive = motor->gain * motor->voltage - motor->back_emf * w[0];
        r->free_current = motor->inductance > 0 ? other[0] : drive / motor->resistance;
        r->current =
            p->limited != 0 ? p->limited * motor->current_limit : r->free_current;
        if (motor->inductance > 0) {
            current_rate = (drive - motor->resistance * r->current) / motor->inductance;
            r->free_current = r->current + (p->limited != 0 ? current_rate : 0);
            current_rate = p->limited != 0 ? 0 : current_rate;
        }
        torque += motor->torque_constant * r->current;
        r->work += motor->torque_constant * r->current * w[0];
    }
    const bool held = p->contact && !wall_gives(wall) && n == 1; // friction has no say
    r->friction = held ? 0 : p->friction * motor->stiction;
    Q[0] += torque - r->friction;

    // wall
    const touch t = touch_at(s, q, w);
    const bool gives = wall_gives(wall), face = wall_has_face(wall);
    const bool rigid = p->contact && !gives;
    double pressed = 0, face_rate = 0, face_acceleration = 0;
    if (p->contact && gives && !face) {
        pressed = law_force(wall, t.g, t.rate);
        r->wall =
            (pressed - wall->stiffness * pow(fmax(t.g, 0), wall->exponent)) * t.rate;
    } else if (p->contact && face) { // arm and face move as one
        const double pushed = wall->stiffness * t.g + wall->damping * t.rate;
        for (int i = 0; i < n; i++) {
            Q[i] -= t.j[i] * (wall->face_mass * t.velocity_terms + pushed);
            for (int j = 0; j < n; j++) {
                m[i][j] += wall->face_mass * t.j[i] * t.j[j];
            }
        }
        r->wall = wall->damping * t.rate * t.rate;
    } else if (!p->contact && face) {
        face_rate = other[2];
        face_acceleration =
            -(wall->stiffness * other[1] + wall->damping * other[2]) / wall->face_mass;
        r->wall = wall->damping * other[2] * other[2];
    } else if (p->parted) {
        face_rate = face_return(wall, other[1]);
        r->wall = -wall->stiffness * pow(fmax(other[1], 0), wall->exponent) * face_rate;
    }
    for (int i = 0; i < n; i++) {
        Q[i] -= t.j[i] * pressed;
    }

    // accelerations, with the force of a rigid wall as one more unknown
    const bool stuck = p->friction == 0 && motor->stiction > 0 && !held;
    const double hub_row = Q[0];
    double first_row[ROWS];
    memcpy(first_row, m[0], sizeof first_row);
    int size = n;
    if (rigid) {
        size = n + 1;
        for (int i = 0; i < n; i++) {
            m[i][n] = m[n][i] = t.j[i];
        }
        m[n][n] = 0;
        Q[n] = -t.velocity_terms;
    }
    if (stuck) {
        for (int i = 0; i < size; i++) {
            m[0][i] = i == 0;
        }
        Q[0] = 0;
    }
    solve(size, m, Q);
    r->force = rigid ? Q[n] : pressed;
    double g2 = t.velocity_terms;
    for (int i = 0; i < n; i++) {
        g2 += t.j[i] * Q[i];
    }
    if (p->contact && face) {
        r->force = wall->face_mass * g2 + wall->stiffness * t.g + wall->damping * t.rate;
    }
    if (stuck) {
        double needs = 0;
        for (int i = 0; i < n; i++) {
            needs += first_row[i] * Q[i];
        }
        r->friction = hub_row - needs - (rigid ? t.j[0] * Q[n] : 0);
    }
    r->gap = -t.g;
    r->gap_rate = -t.rate;
    r->gap_acceleration = -g2;

    for (int i = 0; i < n; i++) {
        dy[i] = w[i];
        dy[n + i] = Q[i];
    }
    dy[2 * n] = current_rate;
    dy[2 * n + 1] = face_rate;
    dy[2 * n + 2] = face_acceleration;
}
