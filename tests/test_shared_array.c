// Growing arrays: elements stay what they are, shared ones where they are, and memory goes back.
#include "tests/check.h"

#include <stdint.h>

#include "src/base/shared_array.h"

enum { PER_CHUNK = ARRAY_CHUNK / sizeof(uint64_t), MANY = 5 * PER_CHUNK / 2 };

static uint64_t *numbers(const shared_array *a)
{
    return a->base;
}

// Appends i for element i, up to `count` elements.
static void fill(shared_array *a, size_t from, size_t count)
{
    assert_true(shared_array_grow(a, count));
    for (size_t i = from; i < count; i++) {
        numbers(a)[i] = i;
    }
}

static void check_numbers(const shared_array *a, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        assert_true(numbers(a)[i] == i);
    }
}

static shared_array filled(size_t count)
{
    shared_array a;
    assert_true(shared_array_reserve(&a, sizeof(uint64_t), MANY, 4 * MANY));
    fill(&a, 0, count);
    return a;
}

static void plain_arrays_keep_their_elements_as_they_grow(void **state)
{
    (void)state;
    shared_array a;
    shared_array_init(&a, sizeof(uint64_t));
    for (size_t count = 1; count < 5000; count++) {
        fill(&a, count - 1, count);
    }
    check_numbers(&a, 4999);
    shared_array_finish(&a);
}

static void shared_arrays_keep_their_place_as_they_grow(void **state)
{
    (void)state;
    shared_array a = filled(1);
    const void *place = a.base;
    fill(&a, 1, MANY);
    assert_ptr_equal(a.base, place);
    check_numbers(&a, MANY);
    shared_array_finish(&a);
}

static void growing_beyond_the_address_space_fails_and_changes_nothing(void **state)
{
    (void)state;
    shared_array a;
    assert_true(shared_array_reserve(&a, sizeof(uint64_t), 10, 10));
    fill(&a, 0, 10);
    assert_false(shared_array_grow(&a, 10 * PER_CHUNK));
    check_numbers(&a, 10);
    shared_array_finish(&a);
}

static void a_beginning_is_shared_and_the_rest_is_each_ones_own(void **state)
{
    (void)state;
    shared_array a = filled(MANY), b;
    size_t alone = shared_array_memory();
    assert_true(shared_array_reserve(&b, sizeof(uint64_t), MANY, 4 * MANY));
    assert_true(shared_array_share(&b, &a, MANY));
    check_numbers(&b, MANY);

    // two whole chunks are common, the third is a copy
    assert_int_equal(shared_array_memory() - alone, ARRAY_CHUNK);
    numbers(&b)[MANY - 1] = 7;
    check_numbers(&a, MANY);

    // the beginning stays when the first array goes
    shared_array_finish(&a);
    check_numbers(&b, MANY - 1);
    shared_array_finish(&b);
}

// A plain array has no chunks that others could have too.
static void the_beginning_of_a_plain_array_is_copied(void **state)
{
    (void)state;
    shared_array plain, a;
    shared_array_init(&plain, sizeof(uint64_t));
    fill(&plain, 0, MANY);
    assert_true(shared_array_reserve(&a, sizeof(uint64_t), MANY, 4 * MANY));
    assert_true(shared_array_share(&a, &plain, MANY));
    check_numbers(&a, MANY);
    assert_int_equal(shared_array_same_chunks(&a, &plain, MANY), 0);
    shared_array_finish(&plain);
    check_numbers(&a, MANY);
    shared_array_finish(&a);
}

static void equal_beginnings_are_found_and_merged(void **state)
{
    (void)state;
    shared_array a = filled(MANY), b = filled(MANY);
    size_t both = shared_array_memory();
    assert_int_equal(shared_array_same_chunks(&a, &b, MANY), 2);
    shared_array_merge(&b, &a, 2);
    assert_int_equal(both - shared_array_memory(), 2 * ARRAY_CHUNK);
    check_numbers(&b, MANY);
    shared_array_finish(&a);
    check_numbers(&b, MANY);
    shared_array_finish(&b);
}

static void a_difference_ends_what_is_equal(void **state)
{
    (void)state;
    shared_array a = filled(MANY), b = filled(MANY);
    numbers(&b)[PER_CHUNK + 3] = 0;
    assert_int_equal(shared_array_same_chunks(&a, &b, MANY), 1);
    numbers(&b)[0] = 1;
    assert_int_equal(shared_array_same_chunks(&a, &b, MANY), 0);
    shared_array_finish(&a);
    shared_array_finish(&b);
}

// As many as the shorter one has: neither is looked at beyond its end.
static void the_shorter_array_ends_what_is_equal(void **state)
{
    (void)state;
    shared_array a = filled(MANY), b = filled(PER_CHUNK);
    assert_int_equal(shared_array_same_chunks(&a, &b, MANY), 1);
    assert_int_equal(shared_array_same_chunks(&b, &a, MANY), 1);
    shared_array_finish(&a);
    shared_array_finish(&b);
}

static void memory_goes_back_with_the_last_array(void **state)
{
    (void)state;
    size_t before = shared_array_memory();
    shared_array a = filled(MANY);
    assert_int_equal(shared_array_memory() - before, 3 * ARRAY_CHUNK);
    shared_array_finish(&a);
    assert_int_equal(shared_array_memory(), before);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(plain_arrays_keep_their_elements_as_they_grow),
        cmocka_unit_test(shared_arrays_keep_their_place_as_they_grow),
        cmocka_unit_test(growing_beyond_the_address_space_fails_and_changes_nothing),
        cmocka_unit_test(a_beginning_is_shared_and_the_rest_is_each_ones_own),
        cmocka_unit_test(the_beginning_of_a_plain_array_is_copied),
        cmocka_unit_test(equal_beginnings_are_found_and_merged),
        cmocka_unit_test(a_difference_ends_what_is_equal),
        cmocka_unit_test(the_shorter_array_ends_what_is_equal),
        cmocka_unit_test(memory_goes_back_with_the_last_array),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
