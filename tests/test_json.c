// JSON files: read back by jansson, with the intended order and digits.
#include "src/base/json.h"
#include "src/base/text_stream.h"

#include "tests/check.h"

// What json_write writes of a value, on the heap; takes over the value.
static char *written(json_t *value)
{
    WRITTEN(text, json_write(stream, value));
    json_decref(value);
    return text;
}

TEST(json_is_what_jansson_reads)
{
    const char *source =
        "{\"b\": [1, 0.1, null, true], \"a\": {\"quote\\\" \\u00e9\\n\": \"\"}, "
        "\"empty\": {}, \"none\": [], \"list\": [{\"x\": -1e-300}, []]}";
    json_t *value = json_loads(source, 0, NULL);
    KEPT_TEXT(text) = written(json_deep_copy(value));
    json_t *again = json_loads(text, 0, NULL);
    assert_non_null(again);
    assert_true(json_equal(value, again));
    // keys stay in the order in which they were given
    assert_true(strstr(text, "\"b\"") < strstr(text, "\"a\""));
    json_decref(value);
    json_decref(again);
}

TEST(text_without_utf8_is_made_readable)
{
    KEPT_TEXT(text) = written(json_text("a\xff\x80\x7f"
                                        "b"));
    assert_string_equal(text, "\"a??\x7f"
                              "b\"\n");
    KEPT_TEXT(other) = written(json_text("\u00e9"));
    assert_string_equal(other, "\"\u00e9\"\n");
}

TEST(numbers_that_are_missing_are_null)
{
    const double values[] = {1.5, (double)NAN, (double)INFINITY, 0.1};
    KEPT_TEXT(text) = written(json_numbers(values, 4));
    assert_string_equal(text, "[1.5, null, null, 0.1]\n");
    free(text);
    text = written(json_numbers(NULL, 0));
    assert_string_equal(text, "[]\n");
}

TEST(objects_have_a_line_a_member)
{
    KEPT_TEXT(text) =
        written(json_loads("{\"a\": 1, \"b\": {}, \"c\": [{\"d\": 2}]}", 0, NULL));
    assert_string_equal(
        text, "{\n  \"a\": 1,\n  \"b\": {},\n  \"c\": [\n    {\n      \"d\": 2\n"
              "    }\n  ]\n}\n");
}

TEST(lists_within_lists_have_lines_of_their_own)
{
    KEPT_TEXT(text) = written(json_loads("[[1, 2], [], {}]", 0, NULL));
    assert_string_equal(text, "[\n  [1, 2],\n  [],\n  {}\n]\n");
}

TEST(what_cannot_be_put_is_noted_once)
{
    json_t *object = json_object(), *array = json_array();
    loss_forget();
    json_put(object, "a", json_number(1));
    json_add(array, json_text("b"));
    assert_false(loss_noted());

    // texts that are written are not lost
    free(written(json_text("as it is")));
    assert_false(loss_noted());

    // no value, as without memory, and no container
    json_put(object, "c", NULL);
    json_put(object, "d", json_number(2));
    assert_true(loss_noted());
    assert_false(loss_noted());
    json_add(NULL, json_number(3));
    assert_true(loss_noted());
    json_decref(object);
    json_decref(array);
}

// A member that there is no memory for leaves its place empty, and that is noted.
TEST(a_member_that_is_lost_is_noted)
{
    char text[32] = "";
    FILE *stream = fmemopen(text, sizeof text, "w");
    assert_non_null(stream);
    json_t *value = json_real(1.5);
    loss_forget();
    json_write_member(stream, value, 1);
    assert_false(loss_noted());
    json_write_member(stream, NULL, 1);
    assert_true(loss_noted());
    assert_false(loss_noted());
    fclose(stream);
    assert_string_equal(text, "1.5");
    json_decref(value);
}
