// The numbers of Radau IIA of seven stages are what they are said to be.
#include "src/engines/stiff/stiff_function.h"
#include "tests/check.h"

// x^n as products.
static double power(double x, int n)
{
    double p = 1;
    for (int i = 0; i < n; i++) {
        p *= x;
    }
    return p;
}

TEST(stages_integrate_polynomials_to_degree_12)
{
    for (int n = 0; n <= 2 * RADAU_STAGES - 2; n++) {
        for (int i = 0; i < RADAU_STAGES && (n < RADAU_STAGES || i == RADAU_STAGES - 1);
             i++) {
            const bool last = i == RADAU_STAGES - 1;
            double sum = 0;
            for (int j = 0; j < RADAU_STAGES && (last || n < RADAU_STAGES); j++) {
                sum += radau_matrix[j][i] * power(radau_node[j], n);
            }
            check_close(sum, power(radau_node[i], n + 1) / (n + 1), 1e-15);
        }
    }
}

TEST(the_embedded_formula_has_degree_6)
{
    for (int n = 0; n < RADAU_STAGES; n++) {
        double sum = n == 0 ? radau_start : 0;
        for (int j = 0; j < RADAU_STAGES; j++) {
            sum += radau_difference[j] * power(radau_node[j], n);
        }
        check_close(sum, 0, 1e-15);
    }
    check_close(radau_start * radau_root_real[0], 1, 1e-15);
}

// a x = T diag(1/root) T^-1 x.
TEST(systems_are_the_formula)
{
    for (int i = 0; i < RADAU_STAGES; i++) {
        for (int k = 0; k < RADAU_STAGES; k++) {
            double one = 0, matrix = 0;
            for (int j = 0; j < RADAU_SYSTEMS; j++) {
                const double re = radau_to_real[k][j], im = radau_to_imaginary[k][j];
                const double from_re = radau_from_real[j][i],
                             from_im = radau_from_imaginary[j][i];
                const double a = radau_root_real[j], b = radau_root_imaginary[j];
                const double square = a * a + b * b;
                one += from_re * re + from_im * im;
                matrix +=
                    (from_re * (re * a + im * b) + from_im * (im * a - re * b)) / square;
            }
            check_close(one, i == k ? 1 : 0, 1e-12);
            check_close(matrix, radau_matrix[k][i], 1e-13);
        }
    }
}

TEST(weights_are_those_of_the_polynomial)
{
    for (double x = 0; x < 1.6; x += 0.19) {
        radau_weights w;
        radau_weights_at(x, &w);
        for (int n = 0; n < RADAU_STAGES; n++) {
            double value = 0, once = 0, twice = 0;
            for (int j = 0; j < RADAU_STAGES; j++) {
                const double f = power(radau_node[j], n);
                value += w.value[j] * f;
                once += w.integral[j] * f;
                twice += w.twice[j] * f;
            }
            check_close(value, power(x, n), 1e-11);
            check_close(once, power(x, n + 1) / (n + 1), 1e-12);
            check_close(twice, power(x, n + 2) / ((n + 1) * (n + 2)), 1e-12);
        }

        // of the degree 7 the integral with the start's value, too
        double from[RADAU_LANES], start = 0, once = 0;
        radau_values_at(0, from);
        for (int j = 0; j < RADAU_STAGES; j++) {
            start -= from[j] * power(radau_node[j], RADAU_STAGES);
            once += w.integral[j] * power(radau_node[j], RADAU_STAGES);
        }
        check_close(once + start * w.start, power(x, RADAU_LANES) / RADAU_LANES, 1e-12);
    }
}

// 0.5 + 3 x - 4 x^2 + 2 x^3 + 5 x^7, with its first two derivatives.
static double polynomial(double x, double *slope, double *bend)
{
    *slope = 3 - 8 * x + 6 * x * x + 35 * power(x, 6);
    *bend = -8 + 12 * x + 210 * power(x, 5);
    return 0.5 + 3 * x - 4 * x * x + 2 * x * x * x + 5 * power(x, 7);
}

// Through nodes, integrated, divided: values, slopes and bounds of a polynomial of degree
// 7.
TEST(functions_are_their_polynomials)
{
    double nodes[RADAU_LANES], slope, bend, terms[4];
    for (int i = 0; i < RADAU_LANES; i++) {
        nodes[i] = polynomial(radau_node[i], &slope, &bend);
    }
    stiff_function f, rising, sum, divided;
    function_through(&f, nodes);
    function_through_rising(&rising, nodes, 3);
    sum = f;
    function_integrate(&sum, 0.25, 2);
    divided = f;
    function_scale(&divided, 2, -1);
    function_divide(&divided);
    // what it has at the start, value or slope, is taken off it all along
    stiff_function lifted = f;
    function_divide(&lifted);
    function_divide(&lifted);
    for (double x = 0.05; x <= 1; x += 0.095) {
        const double value = polynomial(x, &slope, &bend);
        check_close(function_at(&f, x).value, value, 1e-13);
        check_close(function_at(&f, x).slope, slope, 1e-12);
        check_close(function_at(&rising, x).value, value, 1e-13);
        check_close(function_at(&sum, x).slope, 2 * value, 1e-13);
        check_close(function_at(&divided, x).value, (2 * value - 1) / x, 1e-11);
        check_close(function_at(&lifted, x).value, (value - 0.5 - 3 * x) / (x * x), 1e-9);
        assert_true(function_curvature(&f, x - 0.05, x) * (1 + 1e-12) >= fabs(bend));
        assert_true(value >= function_least(&f));
        assert_true(function_greatest(&f) >= value);
    }
    check_close(function_at(&sum, 0).value, 0.25, 1e-15);
    function_start(&f, terms);
    check_close(terms[1], 3, 1e-12);
    check_close(terms[2], -4, 1e-11);
    check_close(terms[3], 2, 1e-10);
}
