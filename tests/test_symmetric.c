// Eigenvalues and factors of symmetric matrices against what defines them.
#include "src/base/dense.h"

#include "tests/check.h"

enum { LARGEST = 24 };

// A symmetric matrix of numbers from -1 to 1, plus `diagonal` on its diagonal.
static void fill(int n, double diagonal, double *matrix)
{
    random_generator g = seeded((uint64_t)n);
    for (int i = 0; i < n; i++) {
        for (int j = 0; j <= i; j++) {
            matrix[i * n + j] = matrix[j * n + i] = 2 * random_uniform(&g) - 1;
        }
        matrix[i * n + i] += diagonal;
    }
}

TEST(vectors_and_values_make_the_matrix_again)
{
    for (int n = 1; n <= LARGEST; n++) {
        double matrix[LARGEST * LARGEST], vectors[LARGEST * LARGEST], values[LARGEST];
        double scratch[2 * LARGEST];
        fill(n, 0, matrix);
        memcpy(vectors, matrix, sizeof vectors);
        assert_true(symmetric_eigen(n, vectors, values, scratch));

        for (int i = 0; i < n; i++) {
            assert_true(i == 0 || values[i - 1] <= values[i]);
            for (int j = 0; j < n; j++) {
                double made = 0, product = 0;
                for (int k = 0; k < n; k++) {
                    made += values[k] * vectors[k * n + i] * vectors[k * n + j];
                    product += vectors[i * n + k] * vectors[j * n + k];
                }
                check_close(made, matrix[i * n + j], 1e-13);
                check_close(product, i == j, 1e-13);
            }
        }
    }
}

// The second difference with fixed ends has the values 2 - 2 cos(pi k / (n + 1)).
TEST(the_second_difference_has_its_closed_form)
{
    enum { N = 16 };
    double matrix[N * N] = {0}, values[N], scratch[2 * N];
    for (int i = 0; i < N; i++) {
        matrix[i * N + i] = 2;
        if (i > 0) {
            matrix[i * N + i - 1] = matrix[(i - 1) * N + i] = -1;
        }
    }
    assert_true(symmetric_eigen(N, matrix, values, scratch));
    for (int k = 0; k < N; k++) {
        check_close(values[k], 2 - 2 * cos(acos(-1) * (k + 1) / (N + 1)), 1e-14);
    }
}

TEST(equal_values_and_zero_matrices_are_fine)
{
    double matrix[9] = {3, 0, 0, 0, 3, 0, 0, 0, 3}, values[3], scratch[6];
    assert_true(symmetric_eigen(3, matrix, values, scratch));
    check_close(values[0], 3, 0);
    check_close(values[2], 3, 0);
    double zero[9] = {0}, none[3];
    assert_true(symmetric_eigen(3, zero, none, scratch));
    check_close(none[1], 0, 0);
    for (int i = 0; i < 9; i++) {
        check_close(fabs(matrix[i]), i % 4 == 0, 0);
        check_close(fabs(zero[i]), i % 4 == 0, 0);
    }
}

// Pairs of matrices: A x = value B x, and the vectors make both diagonal.
TEST(vectors_of_a_pair_make_both_diagonal)
{
    for (int n = 1; n <= LARGEST; n++) {
        double matrix[LARGEST * LARGEST], mass[LARGEST * LARGEST],
            vectors[LARGEST * LARGEST];
        double lost[LARGEST * LARGEST], values[LARGEST], scratch[2 * LARGEST];
        fill(n, 0, matrix);
        fill(n, n, mass);
        mass[0] += 0.5;
        memcpy(vectors, matrix, sizeof vectors);
        memcpy(lost, mass, sizeof lost);
        assert_true(symmetric_eigen_pair(n, vectors, lost, values, scratch));

        for (int i = 0; i < n; i++) {
            assert_true(i == 0 || values[i - 1] <= values[i]);
            for (int j = 0; j < n; j++) {
                double pulled = 0, length = 0;
                for (int k = 0; k < n * n; k++) {
                    double both = vectors[i * n + k / n] * vectors[j * n + k % n];
                    pulled += both * matrix[k];
                    length += both * mass[k];
                }
                check_close(pulled, i == j ? values[i] : 0, 1e-13);
                check_close(length, i == j, 1e-13);
            }
        }
    }

    double matrix[4] = {1, 0, 0, 1}, indefinite[4] = {1, 2, 2, 1}, values[2], scratch[4];
    assert_false(symmetric_eigen_pair(2, matrix, indefinite, values, scratch));
}

TEST(a_factor_solves_its_system)
{
    for (int n = 1; n <= LARGEST; n++) {
        double matrix[LARGEST * LARGEST], factor[LARGEST * LARGEST], x[LARGEST];
        fill(n, n, matrix);
        memcpy(factor, matrix, sizeof factor);
        assert_true(symmetric_factor(n, factor));
        for (int i = 0; i < n; i++) {
            x[i] = i - 0.5;
        }
        symmetric_forward(n, factor, x);
        symmetric_backward(n, factor, x);
        for (int i = 0; i < n; i++) {
            double right = 0;
            for (int j = 0; j < n; j++) {
                right += matrix[i * n + j] * x[j];
            }
            check_close(right, i - 0.5, 1e-12);
        }
    }
}

TEST(what_is_not_positive_definite_has_no_factor)
{
    double indefinite[4] = {1, 2, 2, 1}, singular[4] = {1, 1, 1, 1}, negative[1] = {-1};
    assert_false(symmetric_factor(2, indefinite));
    assert_false(symmetric_factor(2, singular));
    assert_false(symmetric_factor(1, negative));
}
