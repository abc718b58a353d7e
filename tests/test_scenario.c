// Reading scenarios: what a file may say, and the place and sentence of everything it may not.
#include "src/scenario/scenario.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "src/run/run.h"
#include "src/scenario/yaml_tree.h"
#include "src/base/words.h"
#include "src/base/numbers.h"
#include "tests/check.h"

// All sentences of one reading, a line each.
typedef struct sentences {
    int count;
    size_t used;
    char text[16384];
} sentences;

static void keep_sentence(void *context, const char *sentence)
{
    sentences *all = context;
    assert_null(strchr(sentence, '\n'));
    int length = snprintf(all->text + all->used, sizeof all->text - all->used, "%s\n", sentence);
    all->used += (size_t)length < sizeof all->text - all->used ? (size_t)length : 0;
    all->count++;
}

static status parse(scenario *s, const char *text, sentences *all)
{
    *all = (sentences){0};
    return scenario_parse(s, text, strlen(text), "f.yaml", NULL, keep_sentence, all);
}

// The text is read without a fault.
static scenario good(const char *text)
{
    scenario s;
    sentences all;
    if (parse(&s, text, &all) != STATUS_OK || all.count != 0) {
        fail_msg("refused:\n%s", all.text);
    }
    return s;
}

// The text has exactly `count` faults, and each of the sentences' beginnings is among them.
static void check_faults(const char *text, int count, const char *const *beginnings)
{
    scenario s;
    sentences all;
    status result = parse(&s, text, &all);
    assert_int_equal(result, STATUS_BAD_SCENARIO);
    if (all.count != count) {
        fail_msg("%d faults, expected %d:\n%s", all.count, count, all.text);
    }
    for (int i = 0; i < count; i++) {
        char line[512];
        snprintf(line, sizeof line, "\n%s", beginnings[i]);
        bool first = strncmp(all.text, beginnings[i], strlen(beginnings[i])) == 0;
        if (!first && strstr(all.text, line) == NULL) {
            fail_msg("no '%s' in:\n%s", beginnings[i], all.text);
        }
    }
}

// The text has exactly one fault, at line:column, whose sentence mentions `what`.
static void check_fault(const char *text, int line, int column, const char *what)
{
    scenario s;
    sentences all;
    char place[64];
    assert_int_equal(parse(&s, text, &all), STATUS_BAD_SCENARIO);
    snprintf(place, sizeof place, "f.yaml:%d:%d: ", line, column);
    bool there = strncmp(all.text, place, strlen(place)) == 0;
    if (all.count != 1 || !there || strstr(all.text, what) == NULL) {
        fail_msg("%d faults, expected one at %d:%d about '%s':\n%s", all.count, line, column, what,
                 all.text);
    }
}

// ---- what a file may say ------------------------------------------------------------------------

static void a_whole_scenario_is_read(void **state)
{
    (void)state;
    scenario s = good("# a comment\n"
                      "title: 'Contact force: 1 V'\n"
                      "description: >\n"
                      "  Two lines\n"
                      "  become one.\n"
                      "arm:\n"
                      "  model: printed\n"
                      "  k2: 49.2 N m/rad # ten times\n"
                      "motor: {voltage: -2}\n"
                      "script:\n"
                      "  - at: 0.6 s\n"
                      "    set: {motor.voltage: 3 V, arm.k2: 5}\n"
                      "  - {at: 0.4, set: {motor.voltage: 2 V}}\n"
                      "expect:\n"
                      "  first_contact_s: {value: 0.312, tolerance: 0.002}\n"
                      "  first_pulse_s: null\n");
    assert_string_equal(s.name, "f.yaml");
    assert_string_equal(s.title, "Contact force: 1 V");
    assert_string_equal(s.description, "Two lines become one.");
    assert_int_equal(s.parameters.arm.model, ARM_PRINTED);
    assert_int_equal(s.parameters.arm.hub_joint, HUB_SPRING); // resolved, not given
    check_close(s.parameters.arm.k2, 49.2, 0);
    check_close(s.parameters.motor.voltage, -2, 0);
    // in the order of time, and of one instant in the order of the file
    assert_int_equal(s.action_count, 3);
    check_close(s.actions[0].time, 0.4, 0);
    check_close(s.actions[0].value, 2, 0);
    check_close(s.actions[1].value, 3, 0);
    assert_int_equal(s.actions[2].parameter, PARAMETER_INDEX(arm.k2));
    assert_int_equal(s.expectation_count, 2);
    assert_int_equal(s.expectations[0].quantity, SUMMARY_INDEX(first_contact_s));
    check_close(s.expectations[0].value, 0.312, 0);
    check_close(s.expectations[0].tolerance, 0.002, 0);
    assert_false(s.expectations[0].is_null);
    assert_int_equal(s.expectations[0].line, 15);
    assert_int_equal(s.expectations[0].column, 3);
    assert_true(s.expectations[1].is_null);
    scenario_finish(&s);
}

static void what_is_left_out_has_a_default(void **state)
{
    (void)state;
    scenario s = good("{}");
    parameters p;
    fault f;
    parameters_defaults(&p, ARM_CORRECTED);
    assert_int_equal(parameters_resolve(&p, &f), STATUS_OK);
    assert_memory_equal(&s.parameters, &p, sizeof p);
    assert_string_equal(s.title, "f.yaml");
    assert_string_equal(s.description, "");
    assert_int_equal(s.action_count, 0);
    assert_int_equal(s.expectation_count, 0);
    scenario_finish(&s);
    scenario_finish(&s); // a finished one may be finished again
}

static void the_order_of_groups_does_not_matter(void **state)
{
    (void)state;
    scenario s = good("script: [{at: 4 s, push: -0.02 N s}]\nrun: {duration: 5 s}\n");
    assert_int_equal(s.actions[0].kind, ACTION_PUSH);
    check_close(s.actions[0].value, -0.02, 0);
    scenario_finish(&s);
}

static void a_byte_order_mark_and_windows_lines_are_fine(void **state)
{
    (void)state;
    scenario s = good("\xef\xbb\xbf"
                      "title: x\r\narm:\r\n  k2: 5\r\n");
    assert_string_equal(s.title, "x");
    check_close(s.parameters.arm.k2, 5, 0);
    scenario_finish(&s);
    check_fault("\xef\xbb\xbf"
                "titel: x\r\n",
                1, 1, "'title'");
}

static void times_at_both_ends_of_the_run_are_inside(void **state)
{
    (void)state;
    scenario s = good("script: [{at: 0, push: 1}, {at: 1 s, push: 2}]");
    assert_int_equal(s.action_count, 2);
    scenario_finish(&s);
}

// ---- faults of parameters -----------------------------------------------------------------------

static void unknown_keys_suggest_what_was_meant(void **state)
{
    (void)state;
    check_fault("titel: x\n", 1, 1, "did you mean 'title'?");
    check_fault("title: x\nmotr: {voltage: 1}\n", 2, 1, "did you mean 'motor'?");
    check_fault("title: x\nqwertyuiop: 1\n", 2, 1,
                "expected title, description, panes, arm, motor, wall");
    check_fault("arm:\n  k3: 5\n", 2, 3, "in arm, did you mean 'k1'?");
    check_fault("wall:\n  kind: point\n  angel: 0.1\n", 3, 3, "did you mean 'angle'?");
    check_fault("wall: {kind: point, voltage: 1}\n", 1, 21, "did you mean motor.voltage?");
    check_fault("control: {k2_factor: 1}\n", 1, 11, "did you mean belief.k2_factor?");
    check_fault("wall: {height_above: 1}\n", 1, 8, "expected one of kind, angle, restitution");
    check_fault("wall: {stiffness: -1}\n", 1, 19, "out of range");
    check_fault("wall: {contact: kelvin-voigt, restitution: 0.5}\n", 1, 44,
                "for wall.contact = rigid");
    check_fault("arm.k2: 5\n", 1, 1, "expected 'k2:' under 'arm:'");
}

static void wrong_values_are_named_with_their_place(void **state)
{
    (void)state;
    check_fault("arm:\n  k2: stiff\n", 2, 7, "arm.k2 = 'stiff' is not a number");
    check_fault("arm:\n  k2: -1\n", 2, 7, "out of range, expected 1e-06 to 1e+09 N m/rad");
    check_fault("arm:\n  k2: 5 N/m\n", 2, 7, "expected N m/rad");
    check_fault("arm:\n  k2: .inf\n", 2, 7, "arm.k2");
    check_fault("arm:\n  k2: nan\n", 2, 7, "not finite");
    check_fault("arm:\n  k2: 1e999\n", 2, 7, "finite");
    check_fault("arm:\n  links: 2.5\n", 2, 10, "whole number");
    check_fault("arm: {model: prnted}\n", 1, 14, "corrected|printed");
    check_fault("printed: {sign_dead_band: perhaps}\n", 1, 27, "true nor false");
}

static void wrong_shapes_are_named_with_their_place(void **state)
{
    (void)state;
    check_fault("arm: 3\n", 1, 6, "arm is a single value, expected keys");
    check_fault("arm: [1]\n", 1, 6, "arm is a list, expected keys");
    check_fault("title: x\narm:\n", 2, 5, "arm is empty, expected keys");
    check_fault("arm:\n  k2: {a: 1}\n", 2, 7, "arm.k2 is a map of keys, expected a value");
    check_fault("arm:\n  k2: [5]\n", 2, 7, "arm.k2 is a list, expected a value");
    check_fault("arm:\n  k2:\n", 2, 6, "arm.k2 is empty, expected a value");
    check_fault("- arm\n", 1, 1, "the file is a list");
    check_fault("just words\n", 1, 1, "the file is a single value");
    check_fault("title: [x]\n", 1, 8, "title is a list, expected text");
    check_fault("title: |\n  a\n  b\n", 1, 8, "several lines");
    check_fault("title: \"a\\eb\"\n", 1, 8, "control character");
    check_fault("description: \"a\\x85b\"\n", 1, 14, "control character");
    check_fault("? [a, b]\n: 1\n", 1, 3, "the key is a list, expected a word");
}

static void a_key_may_be_there_once(void **state)
{
    (void)state;
    check_fault("arm:\n  k2: 5\n  k1: 7\n  k2: 6\n", 4, 3, "first at line 2");
    check_fault("arm: {k2: 5}\nmotor: {voltage: 1}\narm: {k1: 7}\n", 3, 1, "'arm' is there twice");
    check_fault("title: x\ntitle: x\n", 2, 1, "first at line 1");
}

static void impossible_combinations_point_at_the_key(void **state)
{
    (void)state;
    check_fault("arm:\n  model: printed\n  links: 5\n", 3, 10, "the printed model has two links");
    check_fault("arm: {model: printed}\nwall: {kind: plane}\n", 2, 14, "not plane");
    check_fault("arm:\n  links: 3\n  link_inertia: 1e-5\n", 3, 17, "two links only");
    check_fault("arm:\n  EI: 2.46\n  k2: 4.92\n", 2, 7, "both given");
    check_fault("arm: {hub_joint: beam, k1: 90}\n", 1, 28, "arm.hub_joint = spring");
    // lists of the beam
    check_fault("arm:\n  links: 4\n  joint_stiffness: [10, 12]\n", 3, 20, "expected 3");
    check_fault("arm:\n  links: 4\n  joint_stiffness: [10, -3, 9]\n", 3, 25, "-3 is out of range");
    check_fault("arm:\n  links: 3\n  link_lengths:\n    - 0.3\n    - long\n    - 1\n", 5, 7,
                "'long' is not a number");
    check_fault("arm:\n  k2: 5\n  joint_stiffness: [7]\n", 3, 20, "both given");
    check_fault("arm: {hub_joint: beam}\nscript:\n  - at: 0.1 s\n    set: {arm.k1: 90}\n", 4, 19,
                "arm.k1 is for arm.hub_joint = spring");
    check_fault("arm: {joint_stiffness: [7]}\nscript:\n  - at: 0.1 s\n    set: {arm.EI: 9}\n", 4,
                19, "follows from arm.joint_stiffness");
    // all of them, not the first one only
    check_faults(
        "arm: {model: printed, links: 5, hub_joint: rigid}\n"
        "wall: {kind: plane}\n"
        "method: {name: event}\n",
        4,
        (const char *const[]){"f.yaml:1:30: ", "f.yaml:1:44: ", "f.yaml:2:14: ", "f.yaml:3:16: "});
}

static void a_title_has_a_limit(void **state)
{
    (void)state;
    char text[400] = "title: ";
    memset(text + 7, 'x', 300);
    check_fault(text, 1, 8, "at most 200");
}

// ---- faults of script and expect ----------------------------------------------------------------

static void faults_of_actions(void **state)
{
    (void)state;
    check_fault("script: {at: 1}\n", 1, 9, "script is a map of keys, expected a list");
    check_fault("script:\n  - at\n", 2, 5, "an action is a single value");
    check_fault("script:\n  - push: 1\n", 2, 5, "without a time");
    check_fault("script:\n  - at: 0.5 s\n", 2, 5, "does nothing");
    check_fault("script:\n  - at: soon\n    push: 1\n", 2, 9, "at = 'soon'");
    check_fault("script:\n  - at: [1]\n    push: 1\n", 2, 9,
                "at is a list, expected a number in s");
    check_fault("script:\n  - at:\n    push: 1\n", 2, 8, "at is empty");
    check_fault("script:\n  - at: 1.5 s\n    push: 1\n", 2, 9, "expected 0 to 1 s");
    check_fault("script:\n  - at: -1 s\n    push: 1\n", 2, 9, "outside the run");
    check_fault("script:\n  - at: 500 ms\n    push: 1\n", 2, 9, "expected s");
    check_fault("script:\n  - at: 0.5\n    push: 1 N\n", 3, 11, "expected N s");
    check_fault("script:\n  - at: 0.5\n    push: inf\n", 3, 11, "finite");
    check_fault("script:\n  - at: 0.5\n    push: 1e999\n", 3, 11, "finite");
    check_fault("script:\n  - at: 0.5\n    pish: 1\n", 3, 5, "did you mean 'push'?");
    check_fault("script:\n  - at: 0.5\n    push: 1\n    set: {motor.voltage: 1}\n", 4, 5,
                "'set' after 'push' in one action");
    check_fault("script:\n  - at: 0.5\n    at: 0.6\n    push: 1\n", 3, 5, "twice");
    check_fault("arm: {model: printed}\nscript:\n  - at: 0.5\n    push: 1\n", 4, 5,
                "takes no pushes");
}

static void faults_of_set(void **state)
{
    (void)state;
    check_fault("script:\n  - at: 0.5\n    set: 3\n", 3, 10, "set is a single value");
    check_fault("script:\n  - at: 0.5\n    set: {arm.links: 3}\n", 3, 11, "cannot change during");
    check_fault("script:\n  - at: 0.5\n    set: {motor.voltag: 3}\n", 3, 11,
                "did you mean 'motor.voltage'?");
    check_fault("script:\n  - at: 0.5\n    set: {x: 3}\n", 3, 11, "unknown parameter 'x'");
    check_fault("script:\n  - at: 0.5\n    set: {motor.voltage: 1e9}\n", 3, 26, "out of range");
    check_fault("script:\n  - at: 0.5\n    set: {motor.voltage: [1]}\n", 3, 26, "is a list");
    check_fault("script:\n  - at: 0.5\n    set: {motor.voltage: 1, motor.voltage: 2}\n", 3, 29,
                "twice");
}

static void faults_of_expectations(void **state)
{
    (void)state;
    check_fault("expect: 3\n", 1, 9, "expect is a single value");
    check_fault("expect:\n  impact: {value: 1, tolerance: 0}\n", 2, 3, "did you mean 'impacts'?");
    check_fault("expect:\n  beauty_of_it_all: null\n", 2, 3, "unknown quantity");
    check_fault("expect:\n  wall_time_s: null\n", 2, 3, "depends on the computer");
    check_fault("expect:\n  impacts: 3\n", 2, 12, "expected {value: ..., tolerance: ...} or null");
    check_fault("expect:\n  impacts: \"null\"\n", 2, 12, "expected {value");
    check_fault("expect:\n  impacts: {value: 3}\n", 2, 12, "no tolerance");
    check_fault("expect:\n  impacts: {value: 3, tolerance: 1, value: 2}\n", 2, 37, "twice");
    check_fault("expect:\n  impacts: {tolerance: 3}\n", 2, 12, "no value");
    check_fault("expect:\n  impacts: {value: 3, tolerance: -1}\n", 2, 34, "negative");
    check_fault("expect:\n  impacts: {value: nan, tolerance: 1}\n", 2, 20, "finite");
    check_fault("expect:\n  impacts: {value: 3 N, tolerance: 1}\n", 2, 20, "without a unit");
    check_fault("expect:\n  impacts: {value: 3, tolerance: 1, by: 2}\n", 2, 37, "unknown key 'by'");
}

static void several_faults_are_all_reported(void **state)
{
    (void)state;
    check_faults(
        "titel: x\n"
        "arm:\n"
        "  k2: stiff\n"
        "  links: 0\n"
        "  k22: 1\n"
        "motor: 5\n"
        "run: {duration: 2 s}\n"
        "script:\n"
        "  - at: 9 s\n"
        "    set: {arm.links: 3, motor.voltage: x}\n"
        "  - push: 3\n"
        "expect:\n"
        "  impacts: {value: 3, tolerance: -1}\n"
        "  nonsense: null\n",
        11,
        (const char *const[]){"f.yaml:1:1: unknown key 'titel'", "f.yaml:3:7: arm.k2 = 'stiff'",
                              "f.yaml:4:10: arm.links = 0", "f.yaml:5:3: unknown key 'k22'",
                              "f.yaml:6:8: motor is", "f.yaml:10:11: arm.links cannot change",
                              "f.yaml:10:40: motor.voltage = 'x'",
                              "f.yaml:11:5: an action without a time", "f.yaml:13:34: tolerance",
                              "f.yaml:14:3: unknown quantity", "f.yaml:9:9: at = 9 s is outside"});
}

// ---- faults of the text -------------------------------------------------------------------------

static void what_yaml_has_beyond_a_scenario_is_refused(void **state)
{
    (void)state;
    check_fault("arm: &a\n  k2: 5\n", 1, 6, "anchor");
    check_fault("title: x\narm: *a\n", 2, 6, "alias");
    check_fault("arm: {k2: !!float 5}\n", 1, 11, "tag");
    check_fault("arm: !x {k2: 5}\n", 1, 6, "tag");
    check_fault("title: x\n---\ntitle: y\n", 2, 1, "second document");
    check_fault("title: \"a\\0b\"\n", 1, 8, "NUL");
}

static void broken_text_is_placed_exactly(void **state)
{
    (void)state;
    check_fault("", 1, 1, "empty");
    check_fault("# only a comment\n", 1, 1, "empty");
    check_fault("title: x\narm: {k2: 5\n", 3, 1, "not valid YAML");
    check_fault("title: x\narm:\n\tk2: 5\n", 3, 1, "a tab, expected spaces");
    check_fault("title: a: b\n", 1, 9, "not valid YAML");
    check_fault("title: x\ndescription: \xc3\xa4\xff\n", 2, 15, "UTF-8");
    check_fault("title: \x01\n", 1, 8, "control characters");
    check_fault("title: \xc3\n", 1, 9, "UTF-8"); // where the character should go on
}

static void a_nul_byte_is_refused(void **state)
{
    (void)state;
    static const char text[] = "title: a\0b\n";
    scenario s;
    sentences all = {0};
    assert_int_equal(scenario_parse(&s, text, sizeof text - 1, "f.yaml", NULL, keep_sentence, &all),
                     STATUS_BAD_SCENARIO);
    assert_int_equal(strncmp(all.text, "f.yaml:1:9: ", 12), 0);
}

static void columns_count_characters(void **state)
{
    (void)state;
    check_faults("wall: {\"\xc3\xa4\xc3\xb6\xc3\xbc\": 1, angle: x}\n", 2,
                 (const char *const[]){"f.yaml:1:8: unknown key", "f.yaml:1:25: wall.angle"});
    check_fault("{title: \"\xce\xb8\xcc\x87\", arm: 3}\n", 1, 20, "arm is a single value");
}

// No sentence may carry what a terminal would obey.
static void sentences_are_printable(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "arm: {k2: \"\\e[31m\"}\n", "\"\\a\\e]0;x\": 1\n", "arm: {\"a\\nb\": 1}\n",
        "arm: {model: \"\\x9b31m\"}\n",
        "arm: {k2: aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa\xc3\xa4}\n"};
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        scenario s;
        sentences all;
        assert_int_equal(parse(&s, texts[i], &all), STATUS_BAD_SCENARIO);
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

static void depth_and_size_have_limits(void **state)
{
    (void)state;
    char *text = nested(1000000);
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
    free(text);
}

// ---- files --------------------------------------------------------------------------------------

// A folder for one test, with a file in it.
static char folder[64];

static void write_file(const char *name, const char *text)
{
    char path[128];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

static int make_folder(void **state)
{
    (void)state;
    char path[128];
    strcpy(folder, "/tmp/impactlab-scenario-XXXXXX");
    if (mkdtemp(folder) == NULL) {
        return -1;
    }
    snprintf(path, sizeof path, "%s/deep", folder);
    mkdir(path, 0700);
    write_file("beta.yaml", "title: Beta\n");
    write_file("deep/alpha-10.yaml", "title: Ten\n");
    write_file("deep/alpha-9.yaml", "title: Nine\n");
    write_file("deep/notes.txt", "not a scenario\n");
    write_file(".hidden.yaml", "title: Hidden\n");
    return 0;
}

static int remove_folder(void **state)
{
    (void)state;
    static const char *const files[] = {"beta.yaml",
                                        "deep/alpha-10.yaml",
                                        "deep/alpha-9.yaml",
                                        "deep/notes.txt",
                                        ".hidden.yaml",
                                        "deep",
                                        ""};
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
        char path[128];
        snprintf(path, sizeof path, "%s/%s", folder, files[i]);
        remove(path);
    }
    return 0;
}

// Opens with the folder of this test as the scenario folder.
static status open_here(scenario *s, const char *name, sentences *all)
{
    char *before = strdup(getenv("IMPACTLAB_SCENARIOS") ? getenv("IMPACTLAB_SCENARIOS") : "");
    *all = (sentences){0};
    setenv("IMPACTLAB_SCENARIOS", folder, 1);
    status result = scenario_open(s, name, keep_sentence, all);
    setenv("IMPACTLAB_SCENARIOS", before, 1);
    free(before);
    return result;
}

static void scenarios_open_by_name_and_by_file(void **state)
{
    (void)state;
    scenario s;
    sentences all;
    char path[128];
    assert_int_equal(open_here(&s, "deep/alpha-9", &all), STATUS_OK);
    assert_string_equal(s.name, "deep/alpha-9");
    assert_string_equal(s.title, "Nine");
    snprintf(path, sizeof path, "%s/deep/alpha-9.yaml", folder);
    assert_string_equal(s.file, path);
    scenario_finish(&s);
    assert_int_equal(open_here(&s, path, &all), STATUS_OK);
    assert_string_equal(s.name, path);
    scenario_finish(&s);
    snprintf(path, sizeof path, "%s/deep/alpha-10", folder);
    assert_int_equal(open_here(&s, path, &all), STATUS_OK);
    assert_string_equal(s.title, "Ten");
    scenario_finish(&s);
}

static void an_unknown_name_suggests_the_nearest(void **state)
{
    (void)state;
    scenario s;
    sentences all;
    assert_int_equal(open_here(&s, "deep/alpha-8", &all), STATUS_BAD_ARGUMENT);
    assert_int_equal(all.count, 1);
    assert_non_null(strstr(all.text, "did you mean 'deep/alpha-9'?"));
    assert_int_equal(open_here(&s, "alpha-10", &all), STATUS_BAD_ARGUMENT);
    assert_non_null(strstr(all.text, "did you mean 'deep/alpha-10'?"));
    assert_int_equal(open_here(&s, "alpha-9.yaml", &all), STATUS_BAD_ARGUMENT);
    assert_non_null(strstr(all.text, "did you mean 'deep/alpha-9'?"));
    assert_int_equal(open_here(&s, "zzzzzzzzzz", &all), STATUS_BAD_ARGUMENT);
    assert_non_null(strstr(all.text, "impactlab list"));
    assert_int_equal(open_here(&s, "../etc/passwd", &all), STATUS_BAD_ARGUMENT);
    assert_int_equal(open_here(&s, "", &all), STATUS_BAD_ARGUMENT);
}

static void files_that_cannot_be_read(void **state)
{
    (void)state;
    scenario s;
    sentences all = {0};
    assert_int_equal(scenario_read(&s, "/nonexistent/x.yaml", NULL, keep_sentence, &all),
                     STATUS_CANNOT_READ);
    assert_non_null(strstr(all.text, "/nonexistent/x.yaml:1:1: cannot be opened (No such file"));
    all = (sentences){0};
    assert_int_equal(scenario_read(&s, folder, NULL, keep_sentence, &all), STATUS_CANNOT_READ);
    assert_non_null(strstr(all.text, ":1:1: it is a folder"));
    assert_int_equal(open_here(&s, folder, &all), STATUS_CANNOT_READ);
    assert_int_equal(all.count, 1);
    all = (sentences){0};
    assert_int_equal(scenario_read(&s, "/dev/zero", NULL, keep_sentence, &all),
                     STATUS_BAD_SCENARIO);
    assert_non_null(strstr(all.text, "/dev/zero:1:1: the file is larger"));
}

static void the_list_is_complete_and_sorted(void **state)
{
    (void)state;
    char **names;
    int count;
    fault f;
    char *before = strdup(getenv("IMPACTLAB_SCENARIOS") ? getenv("IMPACTLAB_SCENARIOS") : "");
    setenv("IMPACTLAB_SCENARIOS", folder, 1);
    assert_int_equal(scenario_list(&names, &count, &f), STATUS_OK);
    const char *const own[] = {"beta", "deep/alpha-9", "deep/alpha-10"};
    int found = 0, shipped = 0;
    for (int i = 0; i < count; i++) {
        found += found < 3 && strcmp(names[i], own[found]) == 0;
        shipped += strcmp(names[i], "corrected/first-impact") == 0;
    }
    assert_int_equal(found, 3);
    assert_int_equal(shipped, 1);
    for (int i = 0; i < count; i++) {
        free(names[i]);
    }
    free(names);
    setenv("IMPACTLAB_SCENARIOS", "/nonexistent", 1);
    assert_int_equal(scenario_list(&names, &count, &f), STATUS_CANNOT_READ);
    assert_non_null(strstr(f.text, "/nonexistent: no such folder"));
    assert_int_equal(count, 0);
    assert_null(names);
    setenv("IMPACTLAB_SCENARIOS", before, 1);
    free(before);
}

static void every_shipped_scenario_reads_clean(void **state)
{
    (void)state;
    char **names;
    int count, thesis = 0;
    fault f;
    assert_int_equal(scenario_list(&names, &count, &f), STATUS_OK);
    for (int i = 0; i < count; i++) {
        scenario s;
        sentences all = {0};
        if (scenario_open(&s, names[i], keep_sentence, &all) != STATUS_OK || all.count != 0) {
            fail_msg("%s", all.text);
        }
        // a title of its own, a description, and the thesis's figures on the thesis's model
        assert_string_not_equal(s.title, names[i]);
        assert_in_range(strlen(s.title), 8, 72);
        assert_true(strlen(s.description) > 20);
        bool of_thesis = strncmp(names[i], "thesis/", 7) == 0;
        thesis += of_thesis;
        // (what the thesis measured comes from the rig, on whatever arm it is; lessons are about
        // both)
        if (s.parameters.control.law == LAW_NONE && s.lesson.step_count == 0) {
            assert_int_equal(s.parameters.arm.model, of_thesis ? ARM_PRINTED : ARM_CORRECTED);
        }
        scenario_finish(&s);
        free(names[i]);
    }
    free(names);
    assert_in_range(thesis, 14, 1000);
    assert_in_range(count - thesis, 10, 1000);
}

static void every_figure_and_table_of_the_thesis_has_its_scenario(void **state)
{
    (void)state;
    for (int i = 1; i <= 14; i++) {
        scenario s;
        sentences all = {0};
        char name[64];
        snprintf(name, sizeof name, i <= 11 ? "thesis/fig-3-%d" : "thesis/table-4-%d",
                 i <= 11 ? i : i - 11);
        assert_int_equal(scenario_open(&s, name, keep_sentence, &all), STATUS_OK);
        bool coarse = i >= 6 && i <= 8, fast = i >= 9 && i <= 11;
        check_close(s.parameters.method.step, coarse ? 0.01 : 0.001, 0);
        check_close(s.parameters.motor.voltage, fast ? 5 : 1, 0);
        check_close(s.parameters.method.beta, 0.4, 0);
        check_close(s.parameters.method.gamma, 0.5, 0);
        check_close(s.parameters.wall.angle, 0.1, 0);
        double factor = i == 12 ? 100 : i == 13 ? 10 : 1;
        check_relative(s.parameters.arm.k2, 4.92 * factor, 1e-12);
        scenario_finish(&s);
    }
}

// ---- --set --------------------------------------------------------------------------------------

static void an_override_sets_and_resolves(void **state)
{
    (void)state;
    scenario s = good("arm: {k2: 5}\n");
    fault f;
    assert_int_equal(scenario_override(&s, "arm.k2=49.2 N m/rad", &f), STATUS_OK);
    check_close(s.parameters.arm.k2, 49.2, 0);
    assert_int_equal(scenario_override(&s, "arm.model=printed", &f), STATUS_OK);
    assert_int_equal(s.parameters.arm.hub_joint, HUB_SPRING);
    check_close(s.parameters.arm.link_inertia, 1.67e-5, 0);
    scenario_finish(&s);
}

// The assignment is refused with a sentence that says `what`, and nothing changes.
static void check_override(const char *text, const char *assignment, const char *what)
{
    scenario s = good(text);
    parameters before = s.parameters;
    fault f = {0};
    char beginning[128];
    assert_int_not_equal(scenario_override(&s, assignment, &f), STATUS_OK);
    assert_int_not_equal(f.code, STATUS_OK);
    snprintf(beginning, sizeof beginning, "--set %s: ", assignment);
    if (strncmp(f.text, beginning, strlen(beginning)) != 0 || strstr(f.text, what) == NULL) {
        fail_msg("'%s' does not begin with '%s' and say '%s'", f.text, beginning, what);
    }
    assert_memory_equal(&s.parameters, &before, sizeof before);
    scenario_finish(&s);
}

static void a_wrong_override_changes_nothing(void **state)
{
    (void)state;
    check_override("{}", "arm.k2", "PATH=VALUE");
    check_override("{}", "=3", "PATH=VALUE");
    check_override("{}", "", "PATH=VALUE");
    check_override("{}", "arm.k22=3", "did you mean 'arm.k2'?");
    check_override("{}", "completely.unknown=3", "'show' lists");
    check_override("{}", "arm.k2=stiff", "not a number");
    check_override("{}", "arm.k2=", "no value");
    check_override("{}", "arm.k2=-1", "out of range");
    check_override("{}", "arm.k2=1=2", "expected N m/rad");
    check_override("arm: {links: 5}", "arm.model=printed", "two links");
    check_override("script: [{at: 0.5, push: 1}]", "arm.model=printed", "push");
}

static void an_endless_override_is_refused(void **state)
{
    (void)state;
    scenario s = good("{}");
    fault f;
    char text[5000];
    memset(text, 'a', sizeof text - 1);
    text[sizeof text - 1] = '\0';
    assert_int_equal(scenario_override(&s, text, &f), STATUS_BAD_ARGUMENT);
    memcpy(text, "arm.k2=", 7);
    assert_int_not_equal(scenario_override(&s, text, &f), STATUS_OK);
    assert_int_not_equal(scenario_override(&s, text, NULL), STATUS_OK);
    scenario_finish(&s);
}

// ---- words --------------------------------------------------------------------------------------

static void distances_of_words(void **state)
{
    (void)state;
    assert_int_equal(edit_distance("", "", 9), 0);
    assert_int_equal(edit_distance("abc", "", 9), 3);
    assert_int_equal(edit_distance("kitten", "sitting", 9), 3);
    assert_int_equal(edit_distance("sitting", "kitten", 9), 3);
    assert_int_equal(edit_distance("kitten", "sitting", 2), 2);
}

static void decimals(void **state)
{
    (void)state;
    double value;
    const char *rest;
    assert_true(decimal_read("-1.5e2  N", &value, &rest));
    check_close(value, -150, 0);
    assert_string_equal(rest, "N");
    static const char *const none[] = {"",     "x",   "-",    ".",   "+-1",
                                       "0x10", "inf", ".inf", "nan", " 1"};
    for (size_t i = 0; i < sizeof none / sizeof none[0]; i++) {
        assert_false(decimal_read(none[i], &value, &rest));
    }
}

// Everything but the expectations comes back from what scenario_write writes.
static void check_written(const scenario *s)
{
    char *text = NULL;
    size_t size;
    FILE *stream = open_memstream(&text, &size);
    scenario_write(stream, s);
    fclose(stream);
    scenario back = good(text);
    assert_string_equal(back.title, s->title);
    assert_string_equal(back.description, s->description);
    assert_int_equal(back.action_count, s->action_count);
    for (int i = 0; i < s->action_count; i++) {
        const action *a = &s->actions[i], *b = &back.actions[i];
        assert_true(a->time == b->time && a->kind == b->kind && a->value == b->value);
        assert_true(a->kind == ACTION_PUSH || a->parameter == b->parameter);
    }
    for (int i = 0; i < parameter_count; i++) {
        char one[PARAMETER_TEXT_SIZE], other[PARAMETER_TEXT_SIZE];
        parameter_format(&s->parameters, i, one, sizeof one);
        parameter_format(&back.parameters, i, other, sizeof other);
        assert_string_equal(one, other);
        assert_int_equal(s->parameters.set[i], back.parameters.set[i]);
    }
    scenario_finish(&back);
    free(text);
}

static void written_scenarios_read_back(void **state)
{
    (void)state;
    char **names;
    int count;
    assert_int_equal(scenario_list(&names, &count, NULL), STATUS_OK);
    for (int i = 0; i < count; i++) {
        scenario s;
        assert_int_equal(scenario_open(&s, names[i], NULL, NULL), STATUS_OK);
        check_written(&s);
        scenario_finish(&s);
        free(names[i]);
    }
    free(names);
    scenario odd = good("title: '\"a\\b\" # no comment: {'\ndescription: \"one\\ntwo\\t'\"\n"
                        "control: {plugin: \"a b: 'c'\"}\n"
                        "script: [{at: 0.1 s, push: -0.02 N s}, {at: 0.2, set: {wall.restitution: "
                        "0.5}}]\n");
    check_written(&odd);
    scenario_finish(&odd);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_whole_scenario_is_read),
        cmocka_unit_test(what_is_left_out_has_a_default),
        cmocka_unit_test(the_order_of_groups_does_not_matter),
        cmocka_unit_test(a_byte_order_mark_and_windows_lines_are_fine),
        cmocka_unit_test(times_at_both_ends_of_the_run_are_inside),
        cmocka_unit_test(unknown_keys_suggest_what_was_meant),
        cmocka_unit_test(wrong_values_are_named_with_their_place),
        cmocka_unit_test(wrong_shapes_are_named_with_their_place),
        cmocka_unit_test(a_key_may_be_there_once),
        cmocka_unit_test(a_title_has_a_limit),
        cmocka_unit_test(impossible_combinations_point_at_the_key),
        cmocka_unit_test(faults_of_actions),
        cmocka_unit_test(faults_of_set),
        cmocka_unit_test(faults_of_expectations),
        cmocka_unit_test(several_faults_are_all_reported),
        cmocka_unit_test(what_yaml_has_beyond_a_scenario_is_refused),
        cmocka_unit_test(broken_text_is_placed_exactly),
        cmocka_unit_test(a_nul_byte_is_refused),
        cmocka_unit_test(columns_count_characters),
        cmocka_unit_test(sentences_are_printable),
        cmocka_unit_test(depth_and_size_have_limits),
        cmocka_unit_test_setup_teardown(scenarios_open_by_name_and_by_file, make_folder,
                                        remove_folder),
        cmocka_unit_test_setup_teardown(an_unknown_name_suggests_the_nearest, make_folder,
                                        remove_folder),
        cmocka_unit_test_setup_teardown(files_that_cannot_be_read, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(the_list_is_complete_and_sorted, make_folder,
                                        remove_folder),
        cmocka_unit_test(every_shipped_scenario_reads_clean),
        cmocka_unit_test(every_figure_and_table_of_the_thesis_has_its_scenario),
        cmocka_unit_test(an_override_sets_and_resolves),
        cmocka_unit_test(a_wrong_override_changes_nothing),
        cmocka_unit_test(an_endless_override_is_refused),
        cmocka_unit_test(distances_of_words),
        cmocka_unit_test(decimals),
        cmocka_unit_test(written_scenarios_read_back),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
