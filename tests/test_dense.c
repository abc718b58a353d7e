// Dense systems of linear equations against their residuals.
#include "src/base/dense.h"

#include "tests/check.h"

enum { LARGEST = 12, COLUMNS = 3 };

TEST(what_is_solved_gives_the_right_sides_again)
{
    random_generator g = seeded(5);
    for (int n = 1; n <= LARGEST; n++) {
        double matrix[LARGEST * LARGEST], lost[LARGEST * LARGEST];
        double right[LARGEST * COLUMNS], x[LARGEST * COLUMNS], alone[LARGEST];
        for (int i = 0; i < n * n; i++) {
            matrix[i] = 2 * random_uniform(&g) - 1;
        }
        for (int i = 0; i < n * COLUMNS; i++) {
            right[i] = x[i] = 2 * random_uniform(&g) - 1;
        }
        memcpy(lost, matrix, sizeof lost);
        assert_true(dense_solve_columns(n, COLUMNS, lost, x));

        for (int i = 0; i < n * COLUMNS; i++) {
            double made = 0;
            for (int k = 0; k < n; k++) {
                made += matrix[i / COLUMNS * n + k] * x[k * COLUMNS + i % COLUMNS];
            }
            check_close(made, right[i], 1e-11);
        }

        // a right-hand side alone has the same solution to the bit
        for (int i = 0; i < n; i++) {
            alone[i] = right[i * COLUMNS + 1];
        }
        memcpy(lost, matrix, sizeof lost);
        assert_true(dense_solve(n, lost, alone));
        for (int i = 0; i < n; i++) {
            check_close(alone[i], x[i * COLUMNS + 1], 0);
        }
    }
}

// Without an exchange of rows a zero ends the elimination, and a tiny pivot loses all
// digits.
TEST(the_largest_entry_is_the_pivot)
{
    double zero[4] = {0, 1, 1, 1}, x[2] = {2, 5};
    assert_true(dense_solve(2, zero, x));
    check_close(x[0], 3, 0);
    check_close(x[1], 2, 0);
    double tiny[4] = {1e-20, 1, 1, 1}, y[2] = {1, 2};
    assert_true(dense_solve(2, tiny, y));
    check_close(y[0], 1, 1e-15);
    check_close(y[1], 1, 1e-15);

    // in the last columns of more, too
    double late[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1e-20, 1, 0, 0, 1, 1},
           z[4] = {3, 4, 1, 2};
    assert_true(dense_solve(4, late, z));
    check_close(z[2], 1, 1e-15);
    check_close(z[3], 1, 1e-15);
}

TEST(a_singular_matrix_is_refused)
{
    double singular[9] = {1, 2, 3, 2, 4, 6, 1, 0, 1}, x[3] = {1, 1, 1};
    assert_false(dense_solve(3, singular, x));
    double endless[1] = {(double)INFINITY}, y[1] = {1};
    assert_false(dense_solve(1, endless, y));
}
