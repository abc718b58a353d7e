// Growing arrays: elements stay what they are, shared ones where they are, and memory
// goes back.
#include "tests/check.h"
#include "tests/shared_memory.h"

#include <sys/resource.h>

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

static shared_array reserved(size_t few, size_t most)
{
    shared_array a;
    assert_true(shared_array_reserve(&a, sizeof(uint64_t), few, most));
    return a;
}

static shared_array filled(size_t count)
{
    shared_array a = reserved(MANY, 4 * MANY);
    fill(&a, 0, count);
    return a;
}

TEST(plain_arrays_keep_their_elements_as_they_grow)
{
    SCOPED(shared_array_finish) shared_array a;
    shared_array_init(&a, sizeof(uint64_t));
    int moves = 0;
    for (size_t count = 1; count < 5000; count++) {
        const size_t room = a.capacity;
        fill(&a, count - 1, count);
        moves += a.capacity != room;
        assert_int_equal(a.capacity != room, count > room);
    }
    check_numbers(&a, 4999);

    // twice as much each time, so that an element is moved a few times only
    assert_in_range(moves, 1, 8);
}

TEST(shared_arrays_keep_their_place_as_they_grow)
{
    SCOPED(shared_array_finish) shared_array a = filled(1);
    const void *place = a.base;
    fill(&a, 1, MANY);
    assert_ptr_equal(a.base, place);
    check_numbers(&a, MANY);

    // what it has room for takes no memory
    const size_t memory = shared_array_memory(), room = a.capacity;
    assert_true(shared_array_grow(&a, room));
    assert_int_equal(shared_array_memory(), memory);
    assert_true(shared_array_grow(&a, room + 1));
    assert_int_equal(shared_array_memory(), memory + ARRAY_CHUNK);
}

// An array of many chunks.
TEST(a_long_array_keeps_its_elements)
{
    const size_t many = 40 * PER_CHUNK;
    SCOPED(shared_array_finish) shared_array a = reserved(many, many);
    fill(&a, 0, many);
    check_numbers(&a, many);
    assert_int_equal(a.mapped, 40 * ARRAY_CHUNK);
}

// Where the address space is limited, one array leaves it to the others.
TEST(a_limited_address_space_is_shared)
{
    const size_t most = (size_t)1 << 45, limit = (size_t)1 << 32;
    struct rlimit before;
    getrlimit(RLIMIT_AS, &before);
    setrlimit(RLIMIT_AS, &(struct rlimit){limit, before.rlim_max});
    SCOPED(shared_array_finish) shared_array a = {0};
    const bool there = shared_array_reserve(&a, sizeof(uint64_t), MANY, most);
    setrlimit(RLIMIT_AS, &before);
    if (!there) {
        skip(); // a sanitizer has taken it all
    }
    check_below((double)a.reserved, (double)limit / 16);
    fill(&a, 0, MANY);
}

TEST(growing_beyond_the_address_space_fails_and_changes_nothing)
{
    SCOPED(shared_array_finish) shared_array a = reserved(10, 10);
    fill(&a, 0, 10);
    assert_false(shared_array_grow(&a, 10 * PER_CHUNK));
    check_numbers(&a, 10);
}

TEST(a_beginning_is_shared_and_the_rest_is_each_ones_own)
{
    shared_array a = filled(MANY);
    size_t alone = shared_array_memory();
    SCOPED(shared_array_finish) shared_array b = reserved(MANY, 4 * MANY);
    assert_true(shared_array_share(&b, &a, MANY));
    check_numbers(&b, MANY);

    // two whole chunks are common, the third is a copy
    assert_int_equal(shared_array_memory() - alone, ARRAY_CHUNK);
    numbers(&b)[MANY - 1] = 7;
    check_numbers(&a, MANY);

    // the beginning stays when the first array goes
    shared_array_finish(&a);
    check_numbers(&b, MANY - 1);
}

// A plain array has no chunks that others could have too.
TEST(the_beginning_of_a_plain_array_is_copied)
{
    shared_array plain;
    SCOPED(shared_array_finish) shared_array a = reserved(MANY, 4 * MANY);
    shared_array_init(&plain, sizeof(uint64_t));
    fill(&plain, 0, MANY);
    assert_true(shared_array_share(&a, &plain, MANY));
    check_numbers(&a, MANY);
    shared_array_finish(&plain);
    check_numbers(&a, MANY);
}

TEST(memory_goes_back_with_the_last_array)
{
    size_t before = shared_array_memory();
    shared_array a = filled(MANY);
    assert_int_equal(shared_array_memory() - before, 3 * ARRAY_CHUNK);
    shared_array_finish(&a);
    assert_int_equal(shared_array_memory(), before);
}

// Many arrays that grow, begin like others and go, in any order: each keeps its
// elements, and there is memory for as many different chunks as there are.
TEST(any_number_of_arrays_share_their_chunks)
{
    enum {
        ARRAYS = 60,
        MOST = 40,
        WORDS = ARRAY_CHUNK / 4 / sizeof(uint64_t),
        STEPS = 1500
    };
    static shared_array arrays[ARRAYS];
    static uint64_t values[ARRAYS][MOST + 4];
    size_t counts[ARRAYS] = {0};
    bool live[ARRAYS] = {false};
    const size_t before = shared_array_memory();
    size_t largest = 0, made = 0, ids[ARRAYS][MOST / 4 + 1] = {{0}}; // of chunks
    random_generator g = seeded(5);
    for (int step = 0; step < STEPS; step++) {
        const size_t i = random_below(&g, ARRAYS), j = random_below(&g, ARRAYS);
        shared_array *a = &arrays[i];
        const uint64_t what = random_below(&g, 8);
        if (live[i] && what == 0) {
            shared_array_finish(a);
            live[i] = false;
            counts[i] = 0;
        } else if (!live[i]) {
            // from nothing, or as another one begins
            live[i] = true;
            assert_true(shared_array_reserve(a, ARRAY_CHUNK / 4, 1, MOST));
            if (live[j] && j != i) {
                counts[i] = random_below(&g, counts[j] + 1);
                assert_true(shared_array_share(a, &arrays[j], counts[i]));
                memcpy(values[i], values[j], counts[i] * sizeof values[i][0]);
                memcpy(ids[i], ids[j], counts[i] / 4 * sizeof ids[i][0]);
                assert_true(a->capacity >= counts[i]);
            }
        } else if (what < 5) {
            // a few elements more, often the same ones in all arrays
            const size_t more = random_below(&g, 12), until = counts[i] + more;
            const size_t count = until < MOST ? until : (size_t)MOST;
            assert_true(shared_array_grow(a, count));
            assert_int_equal(a->capacity, a->mapped / ARRAY_CHUNK * 4);
            for (; counts[i] < count; counts[i]++) {
                const uint64_t value =
                    random_below(&g, 20) == 0 ? (uint64_t)step : counts[i];
                uint64_t *element = (uint64_t *)a->base + counts[i] * WORDS;
                values[i][counts[i]] = element[0] = element[WORDS - 1] = value;
            }
        }

        // chunks that it has not had before, or that it has no more
        for (size_t c = 0; c <= MOST / 4; c++) {
            const bool has = live[i] && c < a->mapped / ARRAY_CHUNK;
            ids[i][c] = !has ? 0 : ids[i][c] != 0 ? ids[i][c] : ++made;
        }

        // every now and then all of them
        size_t different = 0, seen[ARRAYS * 11];
        for (size_t k = 0; k < ARRAYS; k++) {
            for (size_t e = 0; live[k] && e < counts[k] && step % 10 == 0; e++) {
                const uint64_t *element = (const uint64_t *)arrays[k].base + e * WORDS;
                assert_true(element[0] == values[k][e] &&
                            element[WORDS - 1] == values[k][e]);
            }
            for (size_t c = 0; c <= MOST / 4 && ids[k][c] != 0; c++) {
                seen[different] = ids[k][c];
                size_t known = 0;
                while (seen[known] != ids[k][c]) {
                    known++;
                }
                different += known == different;
            }
        }
        assert_int_equal(shared_array_memory() - before, different * ARRAY_CHUNK);
        largest = different > largest ? different : largest;
    }
    assert_true(largest > 130);

    // to the last chunk of the place that was reserved, and no further
    for (size_t k = 0; k < ARRAYS; k++) {
        if (live[k] && k % 2 == 0) {
            assert_true(shared_array_grow(&arrays[k], MOST + 4));
            assert_false(shared_array_grow(&arrays[k], MOST + 5));
            assert_int_equal(arrays[k].capacity, MOST + 4);
        }
        if (live[k]) {
            shared_array_finish(&arrays[k]);
        }
    }
    assert_int_equal(shared_array_memory(), before);
}
