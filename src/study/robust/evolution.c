#include "src/study/robust/evolution.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/dense.h"
#include "src/base/plain_math.h"
#include "src/base/sincos.h"

// 4 + 3 ln n points, the better half of which are parents.
static void choose_population(evolution *e)
{
    e->points = 4 + (int)(3 * plain_log(e->n));
    e->parents = e->points / 2;
    double sum = 0, squares = 0;
    for (int i = 0; i < e->parents; i++) {
        e->weights[i] = plain_log(e->points / 2.0 + 0.5) - plain_log(i + 1);
        sum += e->weights[i];
    }
    for (int i = 0; i < e->parents; i++) {
        e->weights[i] /= sum;
        squares += e->weights[i] * e->weights[i];
    }
    e->mass = 1 / squares;
}

status evolution_init(evolution *e, int n, const double *start, double step,
                      uint64_t seed, fault *f)
{
    assert(n >= 1 && n <= EVOLUTION_MOST);
    const size_t size = (size_t)n * (size_t)n;
    *e = (evolution){.n = n,
                     .step = step,
                     .covariance = calloc(size, sizeof *e->covariance),
                     .axes = calloc(size, sizeof *e->axes)};
    if (e->covariance == NULL || e->axes == NULL) {
        return fault_no_memory(f);
    }
    choose_population(e);
    random_seed(&e->random, seed);
    memcpy(e->mean, start, (size_t)n * sizeof *start);
    for (int i = 0; i < n; i++) {
        e->covariance[i * n + i] = e->axes[i * n + i] = 1;
        e->lengths[i] = 1;
    }
    return STATUS_OK;
}

void evolution_finish(evolution *e)
{
    free(e->covariance);
    free(e->axes);
    *e = (evolution){.n = 0};
}

// A number of the normal distribution (Box and Muller, Ann. Math. Stat. 29, 1958).
static double draw_normal(random_generator *random)
{
    const double radius = sqrt(-2 * plain_log(1 - random_uniform(random)));
    return radius * inline_cos(2 * M_PI * random_uniform(random));
}

void evolution_draw(evolution *e, double *drawn)
{
    const int n = e->n;
    for (int p = 0; p < e->points; p++) {
        double *point = drawn + p * n;
        memcpy(point, e->mean, (size_t)n * sizeof *point);
        for (int k = 0; k < n; k++) {
            const double along = e->step * e->lengths[k] * draw_normal(&e->random);
            for (int i = 0; i < n; i++) {
                point[i] += along * e->axes[k * n + i];
            }
        }
        for (int i = 0; i < n; i++) {
            point[i] = fmin(1, fmax(0, point[i]));
        }
    }
}

// The points from the best to the worst.
static void rank_points(const evolution *e, const double *losses, int order[])
{
    for (int i = 0; i < e->points; i++) {
        int place = i;
        for (; place > 0 && losses[order[place - 1]] > losses[i]; place--) {
            order[place] = order[place - 1];
        }
        order[place] = i;
    }
}

// C^(-1/2) times a vector.
static void whiten(const evolution *e, const double *vector, double *white)
{
    const int n = e->n;
    memset(white, 0, (size_t)n * sizeof *white);
    for (int k = 0; k < n; k++) {
        const double *axis = e->axes + k * n;
        double along = 0;
        for (int i = 0; i < n; i++) {
            along += axis[i] * vector[i];
        }
        for (int i = 0; i < n; i++) {
            white[i] += along / e->lengths[k] * axis[i];
        }
    }
}

// Moves the step's path on, and returns its length over what chance alone gives.
static double follow_step_path(evolution *e, const double *moved)
{
    const int n = e->n;
    const double memory = (e->mass + 2) / (n + e->mass + 5); // c_sigma
    double white[EVOLUTION_MOST], square = 0;
    whiten(e, moved, white);
    for (int i = 0; i < n; i++) {
        e->step_path[i] = (1 - memory) * e->step_path[i] +
                          sqrt(memory * (2 - memory) * e->mass) * white[i];
        square += e->step_path[i] * e->step_path[i];
    }
    const double chance = sqrt(n) * (1 - 1 / (4.0 * n) + 1 / (21.0 * n * n));
    return sqrt(square) / chance;
}

// Adds to C what the path and the parents' steps show. `moved` is the mean's way in
// steps, `before` where it came from.
static void adapt_covariance(evolution *e, const double *drawn, const int *order,
                             const double *before, const double *moved, bool stalls)
{
    const int n = e->n;
    const double mass = e->mass;
    const double memory = (4 + mass / n) / (n + 4 + 2 * mass / n); // c_c
    const double one = 2 / ((n + 1.3) * (n + 1.3) + mass);         // c_1
    const double many =
        fmin(1 - one, 2 * (mass - 2 + 1 / mass) / ((n + 2.0) * (n + 2.0) + mass)); // c_mu
    const double grown = stalls ? 0 : sqrt(memory * (2 - memory) * mass);
    const double lost = stalls ? one * memory * (2 - memory) : 0;
    for (int i = 0; i < n; i++) {
        e->path[i] = (1 - memory) * e->path[i] + grown * moved[i];
    }

    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            double steps = 0;
            for (int p = 0; p < e->parents; p++) {
                const double *point = drawn + order[p] * n;
                steps += e->weights[p] * (point[i] - before[i]) * (point[j] - before[j]);
            }
            double *c = &e->covariance[i * n + j];
            *c = (1 - one - many + lost) * *c + one * e->path[i] * e->path[j] +
                 many * steps / (e->step * e->step);
        }
    }
}

// The axes and lengths of C.
static bool find_axes(evolution *e)
{
    const int n = e->n;
    double values[EVOLUTION_MOST], scratch[2 * EVOLUTION_MOST];
    memcpy(e->axes, e->covariance, (size_t)n * (size_t)n * sizeof *e->axes);
    if (!symmetric_eigen(n, e->axes, values, scratch)) {
        return false;
    }
    for (int i = 0; i < n; i++) {
        e->lengths[i] = sqrt(fmax(values[i], 1e-20));
    }
    return true;
}

bool evolution_take(evolution *e, const double *drawn, const double *losses)
{
    const int n = e->n;
    int order[EVOLUTION_MOST];
    double before[EVOLUTION_MOST], moved[EVOLUTION_MOST];
    rank_points(e, losses, order);

    // the mean
    memcpy(before, e->mean, sizeof before);
    for (int i = 0; i < n; i++) {
        e->mean[i] = 0;
        for (int p = 0; p < e->parents; p++) {
            e->mean[i] += e->weights[p] * drawn[order[p] * n + i];
        }
        moved[i] = (e->mean[i] - before[i]) / e->step;
    }

    // step and covariance; a path that grows long leaves the covariance alone
    const double length = follow_step_path(e, moved);
    const double memory = (e->mass + 2) / (n + e->mass + 5);
    const double damping =
        1 + 2 * fmax(0, sqrt((e->mass - 1) / (n + 1)) - 1) + memory; // d_sigma
    e->generation++;
    adapt_covariance(e, drawn, order, before, moved, length > 1.4 + 2.0 / (n + 1));
    e->step *= plain_exp(fmin(1, memory / damping * (length - 1)));
    return find_axes(e);
}
