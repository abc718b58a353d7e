// Calls of the library on a loop, one a line: each does what it says or is refused with a
// sentence and changes nothing; bytes of a state are put back whole, and refused when
// damaged. What comes after a refusal is the next line.
#include "tests/fuzz/fuzz.h"

#include "src/api/impactlab/impactlab.h"
#include "tests/force_means.h"

enum { MOST_CALLS = 40, MOST_STATE = 1 << 16 };

static const char *const scenarios[] = {"corrected/first-impact", "compare/hybrid",
                                        "compare/hybrid-printed-arm",
                                        "corrected/twenty-links"};

// The loop in hand, with a state of it that was kept.
typedef struct hand {
    impactlab_loop *loop;
    unsigned char kept[MOST_STATE], before[MOST_STATE], now[MOST_STATE];
    size_t kept_size;
} hand;

static size_t save(const hand *h, unsigned char *bytes)
{
    impactlab_error error;
    const size_t size = impactlab_loop_state_size(h->loop);
    FUZZ_CHECK(size > 0 && size <= MOST_STATE);
    FUZZ_CHECK(impactlab_loop_save_state(h->loop, bytes, size, &error) == IMPACTLAB_OK);
    return size;
}

// Whether the call was refused; it then says why, and the loop is as it was before.
static bool refused(hand *h, int code, const impactlab_error *error)
{
    FUZZ_CHECK(code == error->status);
    FUZZ_CHECK((code == IMPACTLAB_OK) == (error->sentence[0] == '\0'));
    if (code == IMPACTLAB_BAD_ARGUMENT || code == IMPACTLAB_BAD_SCENARIO) {
        const size_t size = save(h, h->now);
        FUZZ_CHECK(memcmp(h->now, h->before, size) == 0);
    }
    return code != IMPACTLAB_OK;
}

// Puts the kept state back, whole or with one bit another.
static void restore(hand *h, long damaged)
{
    impactlab_error error;
    if (h->kept_size == 0) {
        return;
    }
    if (damaged >= 0) {
        h->kept[(size_t)damaged % h->kept_size] ^= (unsigned char)(1u << damaged % 8);
    }
    const int code = impactlab_loop_restore_state(h->loop, h->kept, h->kept_size, &error);
    FUZZ_CHECK(refused(h, code, &error) == (damaged >= 0));
    if (damaged >= 0) {
        h->kept[(size_t)damaged % h->kept_size] ^= (unsigned char)(1u << damaged % 8);
    } else {
        FUZZ_CHECK(save(h, h->now) == h->kept_size);
        FUZZ_CHECK(memcmp(h->now, h->kept, h->kept_size) == 0);
    }
}

// What the loop has come to, as a run of its own.
static void look(hand *h)
{
    impactlab_error error;
    impactlab_run *run;
    impactlab_table table;
    char *text = NULL;
    FUZZ_CHECK(impactlab_loop_state(h->loop, &table, &error) == IMPACTLAB_OK);
    for (size_t i = 0; i < table.rows * table.columns; i++) {
        FUZZ_CHECK(isfinite(table.values[i]));
    }
    FUZZ_CHECK(impactlab_loop_run(h->loop, &run, &error) == IMPACTLAB_OK);
    double steady, peak;
    FUZZ_CHECK(impactlab_run_quantity(run, "steady_force_N", &steady, &error) ==
               IMPACTLAB_OK);
    FUZZ_CHECK(impactlab_run_quantity(run, "peak_force_N", &peak, &error) ==
               IMPACTLAB_OK);
    FUZZ_CHECK(mean_is_within(steady, peak, 0, 1));
    FUZZ_CHECK(impactlab_run_json(run, &text, &error) == IMPACTLAB_OK && text[0] == '{');
    impactlab_text_free(text);
    impactlab_run_destroy(run);

    // which changes nothing
    const size_t size = save(h, h->now);
    FUZZ_CHECK(memcmp(h->now, h->before, size) == 0);
}

// One line.
static void act(hand *h, char *line)
{
    impactlab_error error = {.status = 0};
    impactlab_reading reading;
    char *rest = strchr(line, ' ');
    rest = rest != NULL ? rest : line + strlen(line);
    const double number = strtod(rest, NULL);
    char path[64] = "";
    int length = 0;
    sscanf(rest, "%63s %n", path, &length);
    save(h, h->before);

    if (strncmp(line, "step", 4) == 0) {
        refused(h, impactlab_loop_step(h->loop, &error), &error);
    } else if (strncmp(line, "until", 5) == 0) {
        refused(h, impactlab_loop_step_until(h->loop, number, &error), &error);
    } else if (strncmp(line, "volts", 5) == 0) {
        refused(h, impactlab_loop_command(h->loop, number, &error), &error);
    } else if (strncmp(line, "push", 4) == 0) {
        refused(h, impactlab_loop_push(h->loop, number, &error), &error);
    } else if (strncmp(line, "text", 4) == 0) {
        refused(h, impactlab_loop_set_text(h->loop, path, rest + length, &error), &error);
    } else if (strncmp(line, "number", 6) == 0) {
        const double value = strtod(rest + length, NULL);
        refused(h, impactlab_loop_set_input(h->loop, path, value, &error), &error);
    } else if (strncmp(line, "read", 4) == 0) {
        refused(h, impactlab_loop_read_sensors(h->loop, &reading, &error), &error);
    } else if (strncmp(line, "signal", 6) == 0) {
        double value;
        refused(h, impactlab_loop_signal(h->loop, path, &value, &error), &error);
    } else if (strncmp(line, "save", 4) == 0) {
        h->kept_size = save(h, h->kept);
    } else if (strncmp(line, "restore", 7) == 0) {
        restore(h, -1);
    } else if (strncmp(line, "damage", 6) == 0) {
        restore(h, labs(strtol(rest, NULL, 10) % 1000000));
    } else if (strncmp(line, "look", 4) == 0) {
        look(h);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static hand h;
    impactlab_error error;
    impactlab_scenario *chosen;
    char *text = fuzz_text(data, size), *rest = text, *line = strsep(&rest, "\n");

    // the first line chooses the loop, which is short
    const char *name =
        scenarios[(size_t)line[0] % (sizeof scenarios / sizeof scenarios[0])];
    const int flags =
        line[0] != '\0' ? line[1] & (IMPACTLAB_KEEP_ROWS | IMPACTLAB_COMMAND) : 0;
    FUZZ_CHECK(impactlab_scenario_open(&chosen, name, &error) == IMPACTLAB_OK);
    FUZZ_CHECK(impactlab_scenario_set(chosen, "run.duration", "0.4 s", &error) ==
               IMPACTLAB_OK);
    FUZZ_CHECK(impactlab_loop_create(&h.loop, chosen, flags, &error) == IMPACTLAB_OK);
    impactlab_scenario_destroy(chosen);
    h.kept_size = 0;

    for (int i = 0; i < MOST_CALLS && (line = strsep(&rest, "\n")) != NULL; i++) {
        act(&h, line);
        const double time = impactlab_loop_time(h.loop);
        FUZZ_CHECK(time >= 0 && time <= 0.4 + 1e-9);
    }
    impactlab_loop_destroy(h.loop);
    free(text);
    return 0;
}
