#include "src/engines/stiff/stiff_function.h"

#include <math.h>
#include <string.h>

#include "src/base/extremes.h"

// A slope at the start is ignored if it differs from the polynomial's by more than this
// many times the function's change in the step: it is then rounding, or belongs to a
// transient that ends before the first stage.
#define STEEP 10

void function_through(stiff_function *f, const double *nodes)
{
    f->degree = RADAU_LANES - 1;
    bool varies = false;
    for (int i = 0; i < RADAU_LANES; i++) {
        f->b[i] = 0;
        for (int k = 0; k < RADAU_LANES; k++) {
            f->b[i] += radau_bernstein[i][k] * nodes[k];
        }
        varies = varies || nodes[i] != nodes[0];
    }

    // what does not change stays the same to the last bit
    for (int i = 0; i < RADAU_LANES && !varies; i++) {
        f->b[i] = nodes[0];
    }

    // to the last bit at both ends
    f->b[0] = nodes[RADAU_LANES - 1];
    f->b[f->degree] = nodes[RADAU_STAGES - 1];
}

void function_through_rising(stiff_function *f, const double *nodes, double slope)
{
    stiff_function through;
    function_through(&through, nodes);
    const int n = through.degree;

    // the difference between the slope wanted and that of the polynomial through the
    // nodes
    double rise = 0;
    for (int i = 0; i < RADAU_STAGES; i++) {
        rise = larger(fabs(nodes[i] - nodes[RADAU_LANES - 1]), rise);
    }
    double more = slope - n * (through.b[1] - through.b[0]);
    if (!(fabs(more) <= STEEP * rise)) {
        more = 0;
    }

    // raised by one degree, plus the polynomial that is zero at all nodes and has slope 1
    f->degree = n + 1;
    for (int i = 0; i <= n + 1; i++) {
        const double share = (double)i / (n + 1);
        const double below = i > 0 ? through.b[i - 1] : 0,
                     own = i <= n ? through.b[i] : 0;
        f->b[i] = share * below + (1 - share) * own + more * radau_slope[i];
    }
}

void function_integrate(stiff_function *f, double start, double factor)
{
    // coefficients of an integral are the sums of those before, over the new degree
    const int n = ++f->degree;
    double sum = start;
    for (int i = 0; i <= n; i++) {
        const double next = i < n ? f->b[i] : 0;
        f->b[i] = sum;
        sum += factor / n * next;
    }
}

void function_scale(stiff_function *f, double factor, double offset)
{
    for (int i = 0; i <= f->degree; i++) {
        f->b[i] = factor * f->b[i] + offset;
    }
}

void function_divide(stiff_function *f)
{
    const int n = f->degree--;
    const double start = f->b[0];
    for (int i = 1; i <= n; i++) {
        f->b[i - 1] = (f->b[i] - start) * n / i;
    }
}

void function_start(const stiff_function *f, double powers[4])
{
    const int n = f->degree;
    const double *b = f->b;
    powers[0] = b[0];
    powers[1] = n * (b[1] - b[0]);
    powers[2] = 0.5 * n * (n - 1) * ((b[2] - b[1]) - (b[1] - b[0]));
    powers[3] = n * (n - 1) * (n - 2) / 6.0 * ((b[3] - b[0]) - 3 * (b[2] - b[1]));
}

value_and_slope function_at(const stiff_function *f, double x)
{
    // de Casteljau's algorithm; its last step but one has value and slope
    double b[FUNCTION_MOST];
    const int n = f->degree;
    const double y = 1 - x;
    memcpy(b, f->b, sizeof b);
    for (int k = n; k > 1; k--) {
        for (int i = 0; i < k; i++) {
            b[i] = y * b[i] + x * b[i + 1];
        }
    }
    return (value_and_slope){y * b[0] + x * b[1], n * (b[1] - b[0])};
}

double function_curvature(const stiff_function *f, double from, double to)
{
    // the coefficients of the second derivative are the second differences
    double b[FUNCTION_MOST];
    const int n = f->degree - 2;
    for (int i = 0; i <= n; i++) {
        b[i] = (f->b[i + 2] - f->b[i + 1]) - (f->b[i + 1] - f->b[i]);
    }

    // those of its part between `from` and `to`: cut at the end, then at the start
    for (int k = 0; k < n && to < 1; k++) {
        for (int i = n; i > k; i--) {
            b[i] = (1 - to) * b[i - 1] + to * b[i];
        }
    }
    const double share = to > 0 ? from / to : 0;
    for (int k = 0; k < n && share > 0; k++) {
        for (int i = 0; i < n - k; i++) {
            b[i] = (1 - share) * b[i] + share * b[i + 1];
        }
    }

    // a polynomial is nowhere larger than its largest coefficient
    double most = 0;
    for (int i = 0; i <= n; i++) {
        most = larger(fabs(b[i]), most);
    }
    return f->degree * (f->degree - 1) * most;
}

double function_least(const stiff_function *f)
{
    double least = f->b[0];
    for (int i = 1; i <= f->degree; i++) {
        least = smaller(f->b[i], least);
    }
    return least;
}

double function_greatest(const stiff_function *f)
{
    double most = f->b[0];
    for (int i = 1; i <= f->degree; i++) {
        most = larger(f->b[i], most);
    }
    return most;
}
