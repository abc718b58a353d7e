// The text of a scenario file before anything is known of its meaning: what of YAML is
// read, where a fault of it is, in which order faults come.
#include "tests/scenario_fixture.h"

#include "src/scenario/yaml_tree.h"

TEST(what_yaml_has_beyond_a_scenario_is_refused)
{
    check_fault("arm: &a\n  k2: 5\n", 1, 6, "anchor");
    check_fault("title: x\narm: *a\n", 2, 6, "alias");
    check_fault("arm: {k2: !!float 5}\n", 1, 11, "tag");
    check_fault("arm: !x {k2: 5}\n", 1, 6, "tag");
    check_fault("title: x\n---\ntitle: y\n", 2, 1, "second document");
    check_fault("title: \"a\\0b\"\n", 1, 8, "NUL");
}

TEST(broken_text_is_placed_exactly)
{
    check_fault("", 1, 1, "empty");
    check_fault("# only a comment\n", 1, 1, "empty");
    check_fault("title: x\narm: {k2: 5\n", 3, 1, "not valid YAML");
    check_fault("title: x\narm:\n\tk2: 5\n", 3, 1, "a tab, expected spaces");
    check_fault("title: a: b\n", 1, 9, "not valid YAML");
    check_fault("title: x\ndescription: \xc3\xa4\xff\n", 2, 15, "UTF-8");
    check_fault("title: \x01\n", 1, 8, "control characters");

    // for any line ends
    check_fault("title: x\r\ndescription: \x01\r\n", 2, 14, "control characters");
    check_fault("title: x\rdescription: \x01\r", 2, 14, "control characters");
    check_fault("title: \xc3\n", 1, 9, "UTF-8"); // where the character should go on
}

TEST(a_nul_byte_is_refused)
{
    static const char text[] = "title: a\0b\n";
    scenario s;
    sentences all = {0};
    assert_int_equal(scenario_parse(&s, text, sizeof text - 1, "f.yaml", NULL,
                                    keep_sentence, &all),
                     STATUS_BAD_SCENARIO);
    assert_int_equal(strncmp(all.text, "f.yaml:1:9: ", 12), 0);
}

TEST(columns_count_characters)
{
    check_faults("wall: {\"\xc3\xa4\xc3\xb6\xc3\xbc\": 1, angle: x}\n", 2,
                 (const char *const[]){"f.yaml:1:8: unknown key",
                                       "f.yaml:1:25: wall.angle"});
    check_fault("{title: \"\xce\xb8\xcc\x87\", arm: 3}\n", 1, 20,
                "arm is a single value");
}

// No sentence may carry what a terminal would obey.
TEST(sentences_are_printable)
{
    for (EACH_TEXT(
             one, "arm: {k2: \"\\e[31m\"}\n", "\"\\a\\e]0;x\": 1\n",
             "arm: {\"a\\nb\": 1}\n", "arm: {model: \"\\x9b31m\"}\n",
             "arm: {k2: "
             "aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa\xc3\xa4}\n")) {
        scenario s;
        sentences all;
        assert_int_equal(parse(&s, *one, &all), STATUS_BAD_SCENARIO);
        assert_int_equal(all.count, 1);
        for (size_t k = 0; k + 1 < all.used; k++) {
            unsigned char c = (unsigned char)all.text[k];
            assert_in_range(c, 0x20, 0x7e);
        }
    }
}

// Opens `depth` brackets after "title: ".
static char *nested(int depth)
{
    char *text = calloc((size_t)depth + 16, 1);
    assert_non_null(text);
    strcpy(text, "title: ");
    memset(text + 7, '[', (size_t)depth);
    return text;
}

TEST(depth_and_size_have_limits)
{
    KEPT_TEXT(text) = nested(1000000);
    check_fault(text, 1, 8 + TREE_MAX_DEPTH - 1, "nested too deeply");
    free(text);
    // one byte too long
    size_t length = (size_t)TREE_MAX_BYTES + 1;
    text = malloc(length + 1);
    assert_non_null(text);
    memset(text, '#', length);
    text[length] = '\0';
    check_fault(text, 1, 1, "larger than 1048576 bytes");
    text[length - 1] = '\0';
    check_fault(text, 1, 1, "empty");
    free(text);
    // many small nodes
    text = malloc(8 + 2 * (size_t)TREE_MAX_NODES + 8);
    assert_non_null(text);
    strcpy(text, "title: [");
    for (int i = 0; i < TREE_MAX_NODES; i++) {
        strcpy(text + 8 + 2 * (size_t)i, "1,");
    }
    strcpy(text + 8 + 2 * (size_t)TREE_MAX_NODES, "]\n");
    // the map, the key and the list are nodes as well
    check_fault(text, 1, 9 + 2 * (TREE_MAX_NODES - 3), "too many keys and values");
}

TEST(faults_come_in_the_order_of_their_places)
{
    scenario s;
    sentences all;
    assert_int_equal(
        parse(&s, "title: t\nrun: {duration: -1}\narm: {links: x, k2: y}\nnothing: 1\n",
              &all),
        STATUS_BAD_SCENARIO);
    const char *before = all.text;
    for (int i = 1; i < all.count; i++) {
        const char *next = strchr(before, '\n') + 1;
        int line[2], column[2];
        assert_int_equal(sscanf(before, "f.yaml:%d:%d", &line[0], &column[0]), 2);
        assert_int_equal(sscanf(next, "f.yaml:%d:%d", &line[1], &column[1]), 2);
        assert_true(line[0] < line[1] || (line[0] == line[1] && column[0] < column[1]));
        before = next;
    }
    assert_int_equal(all.count, 4);
}
