#include "src/study/robust/robust.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/numbers.h"
#include "src/base/input_file.h"

// --- the sets of arms ------------------------------------------------------------------

enum { MOST_SET_BYTES = 65536 };

// Reads a whole file as a text on the heap, which the caller frees in any case.
static status read_set_text(const char *path, char **text, fault *f)
{
    size_t length;
    fault why = {0};
    *text = input_file_read(path, MOST_SET_BYTES + 1, &length, &why);
    if (*text == NULL) {
        return input_file_fault(path, &why, f);
    }
    if (!(length <= MOST_SET_BYTES && strlen(*text) == length)) {
        return fault_set(
            f, STATUS_BAD_ARGUMENT,
            "'%s' is no set, expected lines PATH=a:b or PATH=v1,v2 of at most %d bytes",
            path, MOST_SET_BYTES);
    }
    return STATUS_OK;
}

// Cuts the blanks off both ends of a text, in place; returns where it then begins.
static char *trimmed(char *text)
{
    while (is_blank(*text)) {
        text++;
    }
    size_t length = strlen(text);
    while (length > 0 && is_blank(text[length - 1])) {
        text[--length] = '\0';
    }
    return text;
}

// Reads IMPULSE@TIME, both finite. False if the text is something else.
static bool read_push(robust_case *c, const char *text)
{
    const char *rest;
    double impulse, time;
    if (c->push_count == ROBUST_CASE_PUSHES || !decimal_read(text, &impulse, &rest) ||
        *rest != '@' || !decimal_read(rest + 1, &time, &rest) || *rest != '\0' ||
        time < 0 || !isfinite(impulse) || !isfinite(time)) {
        return false;
    }
    c->push_impulse[c->push_count] = impulse;
    c->push_time[c->push_count++] = time;
    return true;
}

// Reads a case, "TITLE: PATH=VALUE; push=IMPULSE@TIME". Its settings go to settings[],
// behind those of the cases before. False if a piece is neither a setting nor a push.
static bool read_case(robust_case *c, char *text, char **settings)
{
    char *rest = strchr(text, ':');
    c->settings = settings;
    if (rest == NULL) {
        return false;
    }
    *rest++ = '\0';
    c->title = trimmed(text);

    for (char *piece; (piece = strsep(&rest, ";")) != NULL;) {
        piece = trimmed(piece);
        if (strncmp(piece, "push=", strlen("push=")) == 0) {
            if (!read_push(c, piece + strlen("push="))) {
                return false;
            }
        } else if (*piece != '\0') {
            if (strchr(piece, '=') == NULL) {
                return false;
            }
            settings[c->setting_count++] = piece;
        }
    }
    return c->title[0] != '\0';
}

// Sorts the lines of the text into parameters to be drawn and cases.
static status sort_lines(robust_set *set, fault *f)
{
    static const char word[] = "case ";
    char *rest = set->text, **settings = set->settings;
    int number = 0;
    for (char *line; (line = strsep(&rest, "\n")) != NULL;) {
        number++;
        line = trimmed(line);
        if (line[0] == '\0' || line[0] == '#') {
            continue;
        }
        if (strncmp(line, word, strlen(word)) != 0) {
            if (set->count <= SWEEP_MOST_AXES) {
                set->line_numbers[set->count] = number;
                set->lines[set->count++] = line;
            }
            continue;
        }

        robust_case *c = &set->cases[set->case_count++];
        *c = (robust_case){.file = set->file, .line = number};
        if (!read_case(c, line + strlen(word), settings)) {
            return fault_set_place(
                f, STATUS_BAD_ARGUMENT, number, 1,
                "%s:%d: no case, expected 'case TITLE: PATH=VALUE; PATH=VALUE', or "
                "push=IMPULSE@TIME for a value",
                set->file, number);
        }
        settings += c->setting_count;
    }
    return STATUS_OK;
}

// Allocates room for the most cases and settings that the set's text may have: a case is
// a line, and a setting has at least one character. False without memory.
static bool allocate_cases(robust_set *set)
{
    const size_t most_settings = strlen(set->text) + 1;
    size_t lines = 1;
    for (const char *c = set->text; *c != '\0'; c++) {
        if (*c == '\n') {
            lines++;
        }
    }
    set->settings = calloc(most_settings, sizeof *set->settings);
    set->cases = calloc(lines, sizeof *set->cases);
    return set->settings != NULL && set->cases != NULL;
}

status robust_set_read(robust_set *set, const char *path, fault *f)
{
    *set = (robust_set){.file = scenario_file_or_folder_file(path)};
    status code;
    if (set->file != NULL) {
        code = read_set_text(set->file, &set->text, f);
    } else {
        code = fault_no_memory(f);
    }
    if (code == STATUS_OK) {
        if (allocate_cases(set)) {
            code = sort_lines(set, f);
        } else {
            code = fault_no_memory(f);
        }
    }
    if (code == STATUS_OK && set->count == 0) {
        code = fault_set(
            f, STATUS_BAD_ARGUMENT,
            "the set '%s' names no parameter, expected lines PATH=a:b or PATH=v1,v2",
            path);
    }
    if (code != STATUS_OK) {
        robust_set_finish(set);
    }
    return code;
}

void robust_set_finish(robust_set *set)
{
    if (set != NULL) {
        free(set->file);
        free(set->text);
        free(set->settings);
        free(set->cases);
        *set = (robust_set){0};
    }
}

status robust_case_fault(const robust_case *c, const fault *why, fault *f)
{
    if (why->code == STATUS_NO_MEMORY) {
        return fault_no_memory(f);
    }
    return fault_set_place(f, why->code, c->line, 1, "%.200s:%d: case '%.60s': %.600s",
                           c->file, c->line, c->title, why->text);
}

// Applies the settings and pushes of a case to a scenario, and checks that they go
// together.
static status apply_case(scenario *derived, const robust_case *c, fault *f)
{
    f->code = scenario_override_all(derived, c->settings, c->setting_count,
                                    keep_first_fault, f);
    TRY(f->code);
    const double duration = derived->parameters.run.duration;
    for (int i = 0; i < c->push_count; i++) {
        FAULT_IF(c->push_time[i] > duration, f, STATUS_BAD_ARGUMENT,
                 "a push at %g s is outside the run, expected 0 to %g s (run.duration)",
                 c->push_time[i], duration);
        scenario_insert_action(derived, (action){.time = c->push_time[i],
                                                 .kind = ACTION_PUSH,
                                                 .parameter = -1,
                                                 .value = c->push_impulse[i],
                                                 .added = true});
    }
    return scenario_resolve(derived, f);
}

status robust_case_scenario(scenario *derived, const scenario *base, const robust_case *c,
                            fault *f)
{
    *derived = *base;
    int pushes = c != NULL ? c->push_count : 0;
    derived->actions = calloc((size_t)(base->action_count + pushes + 1), sizeof(action));
    if (derived->actions == NULL) {
        return fault_no_memory(f);
    }
    if (base->action_count > 0) {
        memcpy(derived->actions, base->actions,
               (size_t)base->action_count * sizeof(action));
    }

    fault why = {.code = STATUS_OK};
    if (c != NULL && apply_case(derived, c, &why) != STATUS_OK) {
        robust_case_finish(derived);
        return robust_case_fault(c, &why, f);
    }
    return STATUS_OK;
}

void robust_case_finish(scenario *derived)
{
    if (derived != NULL) {
        free(derived->actions);
        derived->actions = NULL;
        derived->action_count = 0;
    }
}

static const double robust_levels[ROBUST_QUANTILES] = {
    [ROBUST_MEDIAN] = 0.5, [ROBUST_NINE_TENTHS] = 0.9, [ROBUST_WORST] = 1};

// --- a law -----------------------------------------------------------------------------

// Sorts the values and finds their quantiles, interpolated linearly between two values.
static void find_quantiles(double *values, size_t count, double *quantiles)
{
    qsort(values, count, sizeof *values, compare_numbers);
    for (int i = 0; i < ROBUST_QUANTILES; i++) {
        const double place = robust_levels[i] * (double)(count - 1);
        const double below = floor(place), part = place - below;
        const size_t k = (size_t)below, next = k + 1 < count ? k + 1 : k;
        if (part > 0) {
            quantiles[i] = (1 - part) * values[k] + part * values[next];
        } else {
            quantiles[i] = values[k];
        }
    }
}

// The quantities of a run by which a law is judged. STEPS is there to tell a run that
// failed, which has none.
#define JUDGED(QUANTITY)                                                                 \
    QUANTITY(COMMAND, "force_command_N")                                                 \
    QUANTITY(OVER, "force_over_command_N")                                               \
    QUANTITY(SMOOTHED, "smoothed_over_command_N")                                        \
    QUANTITY(PEAK, "peak_force_N")                                                       \
    QUANTITY(CONTACT, "first_contact_s")                                                 \
    QUANTITY(SETTLING, "settling_time_s")                                                \
    QUANTITY(ERROR, "steady_error_N")                                                    \
    QUANTITY(SEPARATIONS, "separations")                                                 \
    QUANTITY(APPROACH, "approach_speed_m_s")                                             \
    QUANTITY(BACK, "return_speed_m_s")                                                   \
    QUANTITY(STEPS, "steps")
#define NUMBER(name, key) name,
#define KEY(name, key)    key,
enum { JUDGED(NUMBER) QUANTITIES };
static const char *const keys[QUANTITIES] = {JUDGED(KEY)};

// The quantities of the runs of a law, and how many of the runs settled, lost contact,
// and exceeded the force allowed.
typedef struct judged_runs {
    double *of[QUANTITIES]; // of each run
    double pushed;          // instant of the script's last push [s], 0: none
    size_t settled, separated, exceeded;
} judged_runs;

// The instant of the last push in a scenario's script [s]; 0 without one.
static double last_push(const scenario *s)
{
    double pushed = 0;
    for (int i = 0; i < s->action_count; i++) {
        const action *a = &s->actions[i];
        if (a->kind == ACTION_PUSH) {
            pushed = fmax(pushed, a->time);
        }
    }
    return pushed;
}

// Counts what run i did, and converts its quantities to the units of the table:
// overshoots and error in percent of the command, the speed of return over that of the
// approach. `s` is its scenario, NULL where it cannot be made.
static void count_run(judged_runs *j, robust_law *out, size_t i, const scenario *s)
{
    double *const *quantity = j->of;
    const double command = quantity[COMMAND][i];
    const bool many_links = s != NULL && s->parameters.arm.links > 2;

    // the largest force, of an arm with many links the smoothed one, without vibrations
    double largest = quantity[PEAK][i], allowed = ROBUST_EXCESS * command;
    if (many_links) {
        largest = quantity[SMOOTHED][i] + command;
    }
    if (s != NULL && s->parameters.control.force_limit > 0) {
        allowed = s->parameters.control.force_limit;
    }
    if (largest > allowed) {
        j->exceeded++;
    }
    if (isnan(quantity[STEPS][i])) {
        out->failed++;
    }
    if (!isnan(quantity[SETTLING][i])) {
        j->settled++;
    }
    if (quantity[SEPARATIONS][i] > 0) {
        j->separated++;
    }

    // in the units of the table
    quantity[OVER][i] *= 100 / command;
    quantity[SMOOTHED][i] *= 100 / command;
    out->overshoots[i] = quantity[OVER][i];
    if (many_links) {
        out->overshoots[i] = quantity[SMOOTHED][i];
        out->by_smoothed++;
    }
    quantity[ERROR][i] = 100 * fabs(quantity[ERROR][i]) / command;
    quantity[BACK][i] /= quantity[APPROACH][i];
}

// Replaces the times of run i by those of the table: SETTLING counts from the contact or,
// if later, from the last push; CONTACT becomes the time from the start until the force
// is settled, which a script with a push does not have.
static void time_run(judged_runs *j, size_t i)
{
    double *contact = &j->of[CONTACT][i], *settling = &j->of[SETTLING][i];
    const double settled = *contact + *settling;
    if (settled > j->pushed) {
        *settling = settled - fmax(*contact, j->pushed);
    } else if (isnan(settled)) {
        *settling = settled;
    } else {
        *settling = 0;
    }
    if (j->pushed > 0) {
        *contact = (double)NAN;
    } else {
        *contact = settled;
    }
}

// Judges the runs of a law: values[] holds `most` numbers for each quantity, which are
// sorted in place.
static void judge_runs(robust_law *out, const sweep *s, const size_t *runs, size_t most,
                       double *values)
{
    const size_t n = out->runs;
    judged_runs j = {.pushed = last_push(s->base)};
    for (int q = 0; q < QUANTITIES; q++) {
        j.of[q] = values + (size_t)q * most;
    }
    for (size_t i = 0; i < n; i++) {
        scenario derived;
        const bool known = sweep_scenario(s, runs[i], &derived, NULL) == STATUS_OK;
        count_run(&j, out, i, known ? &derived : NULL);
        time_run(&j, i);
    }

    // the shares of all runs, and the quantiles
    if (out->by_smoothed == 0) {
        out->overshoot_of = "peak";
    } else if (out->by_smoothed == n) {
        out->overshoot_of = "smoothed";
    } else {
        out->overshoot_of = "peak and smoothed";
    }
    out->settled = (double)j.settled / (double)n;
    out->separated = (double)j.separated / (double)n;
    out->exceeded = (double)j.exceeded / (double)n;
    find_quantiles(out->overshoots, n, out->overshoot);
    find_quantiles(j.of[OVER], n, out->raw);
    find_quantiles(j.of[SMOOTHED], n, out->smoothed);
    find_quantiles(j.of[SETTLING], n, out->settling);
    find_quantiles(j.of[CONTACT], n, out->from_start);
    find_quantiles(j.of[ERROR], n, out->error);
    find_quantiles(j.of[BACK], n, out->back);
}

// The runs of a law that there are, and a quantity of each.
typedef struct law_column {
    size_t *runs;
    double *values;
    size_t count;
} law_column;

// A sweep_value_taker.
static bool take_run(void *context, size_t run, double value)
{
    law_column *c = context;
    c->runs[c->count] = run;
    c->values[c->count++] = value;
    return true;
}

status robust_law_of(robust_law *out, const char *law, const sweep *s, sweep_share share,
                     sweep_store *store, fault *f)
{
    assert(s->run_count > 0);
    const size_t n = sweep_share_count(share, s->run_count);
    *out = (robust_law){.law = law, .runs = n, .against = (double)NAN};

    // each quantity of the runs of the share that are there
    SCOPED(free_kept) size_t *runs = calloc(n, sizeof *runs);
    SCOPED(free_kept) double *values = calloc(n, QUANTITIES * sizeof *values);
    out->overshoots = calloc(n, sizeof *out->overshoots);
    if (!(runs != NULL && values != NULL && out->overshoots != NULL)) {
        return fault_no_memory(f);
    }
    for (int q = 0; q < QUANTITIES; q++) {
        law_column column = {runs, values + (size_t)q * n, 0};
        TRY(store->values(store, share, keys[q], take_run, &column, NULL, f));
        out->runs = column.count;
    }
    judge_runs(out, s, runs, n, values);
    return STATUS_OK;
}

void robust_law_finish(robust_law *law)
{
    if (law != NULL) {
        free(law->overshoots);
        law->overshoots = NULL;
    }
}
