// The results of an exam of control laws, for people and for programs, and beside those
// of an exam before.
#include "src/study/robust/law_exam.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/csv.h"
#include "src/base/json.h"
#include "src/base/input_file.h"
#include "src/tables/parameters.h"

// The bounds in words: of a table, and as a key.
static const struct bound_words {
    const char *misses, *key;
} bound_words[EXAM_BOUNDS] = {
    [EXAM_OVERSHOOT] = {"overshoot", "overshoot"},
    [EXAM_SETTLING] = {"settle late or never", "settling"},
    [EXAM_ERROR] = {"keep a steady error", "steady_error"},
    [EXAM_LATENESS] = {"touch late or never", "late_contact"},
    [EXAM_RUN] = {"end by a fault", "failed"},
};

// How many runs of a law miss a bound at a force.
static int count_missed(const law_exam *e, int law, int force, exam_bound bound)
{
    int count = 0;
    for (size_t i = 0; i < e->asked.cases; i++) {
        if (law_exam_verdict(e, law, force, i)->missed[bound]) {
            count++;
        }
    }
    return count;
}

enum { MOST_BYTES = 64 << 20 };

static const char *law_word(const law_exam *e, int law)
{
    return control_law_table[e->asked.laws[law]].word;
}

// --- one exam beside another -----------------------------------------------------------

// How the same cases went under two laws.
typedef struct exam_pairs {
    size_t gained, lost;      // within the bounds now only, and before only
    double points, low, high; // what that is of all cases, with its 95 % interval [%]
} exam_pairs;

// The cases of a law at a force, and which of them were within the bounds before: by the
// rows of another exam, or without such rows under the first law of this exam.
typedef struct case_marks {
    const char *rows; // '1' for each case within the bounds, else '0'; NULL: none
    const law_exam *exam;
    int law, force;
} case_marks;

static bool was_within(const case_marks *m, size_t which)
{
    if (m->rows != NULL) {
        return m->rows[which] == '1';
    }
    return law_exam_verdict(m->exam, 0, m->force, which)->within;
}

// The difference of two shares of the same cases, with its interval by the normal
// distribution (Agresti, Categorical Data Analysis, 2013, section 11.1).
static exam_pairs pairs_of(const case_marks *m)
{
    const size_t cases = m->exam->asked.cases;
    exam_pairs p = {.gained = 0};
    for (size_t i = 0; i < cases; i++) {
        const bool before = was_within(m, i);
        const bool now = law_exam_verdict(m->exam, m->law, m->force, i)->within;
        if (now && !before) {
            p.gained++;
        }
        if (before && !now) {
            p.lost++;
        }
    }
    const double n = (double)cases, gained = (double)p.gained, lost = (double)p.lost;
    const double share = (gained - lost) / n;
    const double deviation = sqrt((gained + lost) / n - share * share) / sqrt(n);
    p.points = 100 * share;
    p.low = 100 * (share - 1.959963984540054 * deviation);
    p.high = 100 * (share + 1.959963984540054 * deviation);
    return p;
}

// A result of the rows: the first law's at that force, NULL if there is none.
static json_t *row_at(const exam_rows *rows, double force)
{
    json_t *results = json_object_get(rows->object, "results"), *row;
    size_t i;
    json_array_foreach(results, i, row)
    {
        const json_t *at = json_object_get(row, "force_N");
        if (json_is_number(at) && json_number_value(at) == force) {
            return row;
        }
    }
    return NULL;
}

// The marks of its cases, NULL if there are none.
static const char *row_marks(const exam_rows *rows, double force)
{
    return json_string_value(json_object_get(row_at(rows, force), "within_of_cases"));
}

void exam_rows_finish(exam_rows *rows)
{
    json_decref(rows->object);
    rows->object = NULL;
}

// What the scenario's fit says of the arms of the cases: an empty list without one.
static json_t *fit_json(const law_exam *e)
{
    const scenario *base = e->asked.base;
    json_t *list = json_array();
    for (int i = 0; base->fit != NULL && i < base->fit->count; i++) {
        const int parameter = base->fit->parameters[i];
        json_add(list, json_of("path:t value:n standard_error:n",
                               parameter_table[parameter].path,
                               parameter_get(&base->parameters, parameter),
                               base->fit->errors[i]));
    }
    return list;
}

// Whether the rows are of the cases of an exam, each force with a mark for every case.
static status check_rows(const exam_rows *rows, const law_exam *e, fault *f)
{
    const json_t *cases = json_object_get(rows->object, "cases"),
                 *seed = json_object_get(rows->object, "seed");
    FAULT_IF(!json_is_integer(cases) || !json_is_integer(seed), f, STATUS_BAD_ARGUMENT,
             "'%s' is no exam of control laws, expected what robust --draw --json wrote",
             rows->path);
    FAULT_IF((size_t)json_integer_value(cases) < e->asked.cases ||
                 (uint64_t)json_integer_value(seed) != e->asked.seed,
             f, STATUS_BAD_ARGUMENT,
             "'%s' has %lld cases from seed %lld, expected %zu from %llu", rows->path,
             (long long)json_integer_value(cases), (long long)json_integer_value(seed),
             e->asked.cases, (unsigned long long)e->asked.seed);

    // drawn around the same arm
    json_t *fit = fit_json(e);
    const json_t *other = json_object_get(rows->object, "fit");
    const bool none = json_array_size(other) == 0 && json_array_size(fit) == 0;
    const bool same = none || json_equal(other, fit);
    json_decref(fit);
    FAULT_IF(!same, f, STATUS_BAD_ARGUMENT,
             "'%s' is of cases around another fit, expected those of this scenario",
             rows->path);
    for (int k = 0; k < e->asked.force_count; k++) {
        const char *marks = row_marks(rows, e->asked.forces[k]);
        FAULT_IF(marks == NULL || strlen(marks) < e->asked.cases, f, STATUS_BAD_ARGUMENT,
                 "'%s' has no row of each case at %g N", rows->path, e->asked.forces[k]);
    }
    return STATUS_OK;
}

status exam_rows_read(exam_rows *rows, const char *path, const law_exam *e, fault *f)
{
    size_t length;
    fault why = {.path = ""};
    json_error_t wrong;
    *rows = (exam_rows){.path = path};
    SCOPED(free_kept) char *text = input_file_read(path, MOST_BYTES, &length, &why);
    if (text == NULL) {
        return input_file_fault(path, &why, f);
    }
    rows->object = json_loadb(text, length, 0, &wrong);
    if (rows->object == NULL) {
        return fault_set_place(f, STATUS_BAD_ARGUMENT, wrong.line, wrong.column,
                               "%s:%d:%d: no JSON: %.200s", path, wrong.line,
                               wrong.column, wrong.text);
    }
    const status code = check_rows(rows, e, f);
    if (code != STATUS_OK) {
        exam_rows_finish(rows);
    }
    return code;
}

// --- for people ------------------------------------------------------------------------

static void print_forces(FILE *stream, const law_exam *e, int width)
{
    for (int k = 0; k < e->asked.force_count; k++) {
        fprintf(stream, "%*g N", width - 2, e->asked.forces[k]);
    }
    fputc('\n', stream);
}

static void print_share(FILE *stream, exam_share s)
{
    char text[32];
    snprintf(text, sizeof text, "%.1f (%.1f to %.1f)", 100 * s.share, 100 * s.low,
             100 * s.high);
    fprintf(stream, "%24s", text);
}

// A law's shares of all cases, a column for each force, and those where it may touch the
// wall later.
static void print_shares(FILE *stream, const law_exam *e, int law)
{
    fprintf(stream, "  %-20s", law_word(e, law));
    for (int k = 0; k < e->asked.force_count; k++) {
        print_share(stream, law_exam_share(e, law, k, -1));
    }
    fprintf(stream, "\n    %g times as late", EXAM_LATER);
    for (int k = 0; k < e->asked.force_count; k++) {
        print_share(stream, law_exam_share_later(e, law, k));
    }
    fputc('\n', stream);
}

// What a law gains on another one, a column for each force.
static void print_pairs(FILE *stream, const char *than, const case_marks *marks,
                        int force_count)
{
    fprintf(stream, "    than %-13.13s", than);
    for (int k = 0; k < force_count; k++) {
        const exam_pairs p = pairs_of(&marks[k]);
        char text[32];
        snprintf(text, sizeof text, "%+.1f (%+.1f to %+.1f)", p.points, p.low, p.high);
        fprintf(stream, "%24s", text);
    }
    fputc('\n', stream);
}

// How many runs of a law miss each bound; a run may miss several.
static void print_missed(FILE *stream, const law_exam *e, int law)
{
    for (exam_bound bound = 0; bound < EXAM_BOUNDS; bound++) {
        fprintf(stream, "  %-22s", bound_words[bound].misses);
        for (int k = 0; k < e->asked.force_count; k++) {
            fprintf(stream, "%10d", count_missed(e, law, k, bound));
        }
        fputc('\n', stream);
    }
}

// A law's shares of the cases with each kind of error.
static void print_kinds(FILE *stream, const law_exam *e, int law)
{
    for (int kind = 0; kind < LAW_ERRORS; kind++) {
        const size_t cases = law_exam_share(e, law, 0, kind).cases;
        if (cases == 0) {
            continue;
        }
        fprintf(stream, "  %-22s", law_error_name(kind));
        for (int k = 0; k < e->asked.force_count; k++) {
            fprintf(stream, "%10.0f", 100 * law_exam_share(e, law, k, kind).share);
        }
        fprintf(stream, "%10zu\n", cases);
    }
}

// Prints what a law gains on the rows of an earlier exam, and on the first law of this
// one.
static void print_gains(FILE *stream, const law_exam *e, int law, const exam_rows *beside)
{
    const int forces = e->asked.force_count;
    case_marks marks[EXAM_MOST_FORCES];
    if (beside != NULL) {
        for (int k = 0; k < forces; k++) {
            marks[k] = (case_marks){row_marks(beside, e->asked.forces[k]), e, law, k};
        }
        print_pairs(stream, beside->path, marks, forces);
    }
    if (law > 0) {
        for (int k = 0; k < forces; k++) {
            marks[k] = (case_marks){NULL, e, law, k};
        }
        print_pairs(stream, law_word(e, 0), marks, forces);
    }
}

// Says that the arms of the cases are those that a fit leaves possible.
static void print_fit(FILE *stream, const scenario *base)
{
    if (base->fit == NULL) {
        return;
    }
    fputs("the arm of each case is drawn from the fit to your recordings", stream);
    for (int i = 0; i < base->fit->count; i++) {
        const int parameter = base->fit->parameters[i];
        const parameter_info *info = &parameter_table[parameter];
        fprintf(stream, "%s\n  %-24s%12.5g, standard error %.2g %s", i == 0 ? ":" : "",
                info->path, parameter_get(&base->parameters, parameter),
                base->fit->errors[i], info->unit);
    }
    fputc('\n', stream);
}

void law_exam_text(FILE *stream, const law_exam *e, const exam_rows *beside)
{
    fprintf(stream,
            "%s: %zu cases from seed %llu, each with two or three errors of %swall, "
            "sensors, computer or beliefs\n",
            e->asked.base->name, e->asked.cases, (unsigned long long)e->asked.seed,
            e->asked.base->fit == NULL ? "arm, " : "");
    print_fit(stream, e->asked.base);
    fputc('\n', stream);
    fprintf(stream,
            "cases within the bounds [%%], and the 95 %% interval of the share; "
            "differences case by case\n%22s",
            "");
    print_forces(stream, e, 24);
    for (int law = 0; law < e->asked.law_count; law++) {
        print_shares(stream, e, law);
        print_gains(stream, e, law, beside);
    }

    // why, and where
    for (int law = 0; law < e->asked.law_count; law++) {
        fprintf(stream, "\n%s: runs that miss a bound\n%24s", law_word(e, law), "");
        print_forces(stream, e, 10);
        print_missed(stream, e, law);
        fprintf(stream, "\n%s: cases within the bounds by kind of error [%%]\n%24s",
                law_word(e, law), "");
        print_forces(stream, e, 10);
        print_kinds(stream, e, law);
    }
}

// --- for programs ----------------------------------------------------------------------

void law_exam_csv(FILE *stream, const law_exam *e)
{
    static const struct {
        const char *name, *unit;
    } headings[] = {{"law", ""},
                    {"force", "N"},
                    {"seed", ""},
                    {"within", ""},
                    {"smoothed overshoot", "%"},
                    {"settling", "s"},
                    {"steady error", "%"},
                    {"separations", ""},
                    {"first contact over open-loop's", ""},
                    {"errors", ""}};
    csv_writer w = csv_begin(stream);
    for (size_t i = 0; i < sizeof headings / sizeof headings[0]; i++) {
        csv_heading(&w, headings[i].name, headings[i].unit);
    }
    csv_end_row(&w);

    for (int law = 0; law < e->asked.law_count; law++) {
        for (int k = 0; k < e->asked.force_count; k++) {
            for (size_t i = 0; i < e->asked.cases; i++) {
                const exam_verdict *v = law_exam_verdict(e, law, k, i);
                csv_text(&w, law_word(e, law));
                csv_number(&w, e->asked.forces[k]);
                csv_number(&w, (double)(e->asked.seed + i));
                csv_number(&w, v->within);
                csv_number(&w, v->overshoot);
                csv_number(&w, v->settling);
                csv_number(&w, v->error);
                csv_number(&w, v->separations);
                csv_number(&w, v->late);

                // the settings, which the program takes back by --set
                const drawn_case *c = &e->cases[i];
                char errors[DRAWN_CASE_SETTINGS * DRAWN_SETTING_LENGTH] = "";
                size_t used = 0;
                for (int s = 0; s < c->setting_count; s++) {
                    used += (size_t)snprintf(errors + used, sizeof errors - used, "%s%s",
                                             s > 0 ? " " : "", c->settings[s]);
                }
                if (c->push != 0) {
                    snprintf(errors + used, sizeof errors - used, " push=%.6g@%.6g",
                             c->push, c->push_time);
                }
                csv_text(&w, errors);
                csv_end_row(&w);
            }
        }
    }
}

// What a law missed at a force, by bound.
static json_t *missed_json(const law_exam *e, int law, int force)
{
    json_t *missed = json_object();
    for (exam_bound bound = 0; bound < EXAM_BOUNDS; bound++) {
        json_put(missed, bound_words[bound].key,
                 json_integer(count_missed(e, law, force, bound)));
    }
    return missed;
}

// Its shares by kind of error.
static json_t *kinds_json(const law_exam *e, int law, int force)
{
    json_t *kinds = json_array();
    for (int kind = 0; kind < LAW_ERRORS; kind++) {
        const exam_share s = law_exam_share(e, law, force, kind);
        if (s.cases > 0) {
            json_add(kinds, json_of("kind:t cases:i within:i share:n low:n high:n",
                                    law_error_name(kind), (int)s.cases, (int)s.within,
                                    s.share, s.low, s.high));
        }
    }
    return kinds;
}

static json_t *pairs_json(const char *than, const case_marks *m)
{
    const exam_pairs p = pairs_of(m);
    return json_of("beside:t gained:i lost:i points:n low:n high:n", than, (int)p.gained,
                   (int)p.lost, p.points, p.low, p.high);
}

// All of a law at a force: '1' in within_of_cases is a case within the bounds.
static json_t *exam_result_json(const law_exam *e, int law, int force,
                                const exam_rows *beside)
{
    const double at = e->asked.forces[force];
    const exam_share all = law_exam_share(e, law, force, -1);
    const exam_share later = law_exam_share_later(e, law, force);
    json_t *result =
        json_of("law:t force_N:n within:i share:n low:n high:n missed:o "
                "kinds:o",
                law_word(e, law), at, (int)all.within, all.share, all.low, all.high,
                missed_json(e, law, force), kinds_json(e, law, force));

    // with first contact as late as it may be at most
    json_put(result, "later",
             json_of("late:n within:i share:n low:n high:n", EXAM_LATER,
                     (int)later.within, later.share, later.low, later.high));

    // beside what there was before, and the first law
    json_t *paired = json_array();
    if (beside != NULL) {
        const case_marks marks = {row_marks(beside, at), e, law, force};
        json_add(paired, pairs_json(beside->path, &marks));
    }
    if (law > 0) {
        const case_marks marks = {NULL, e, law, force};
        json_add(paired, pairs_json(law_word(e, 0), &marks));
    }
    json_put(result, "paired", paired);

    SCOPED(free_kept) char *marks = calloc(e->asked.cases + 1, 1);
    for (size_t i = 0; i < e->asked.cases && marks != NULL; i++) {
        marks[i] = law_exam_verdict(e, law, force, i)->within ? '1' : '0';
    }
    json_put(result, "within_of_cases", marks != NULL ? json_text(marks) : NULL);
    return result;
}

json_t *law_exam_json(const law_exam *e, const exam_rows *beside)
{
    json_t *results = json_array();
    for (int law = 0; law < e->asked.law_count; law++) {
        for (int force = 0; force < e->asked.force_count; force++) {
            json_add(results, exam_result_json(e, law, force, beside));
        }
    }
    json_t *whole = json_of("scenario:t", e->asked.base->name);
    json_put(whole, "cases", json_integer((json_int_t)e->asked.cases));
    json_put(whole, "seed", json_integer((json_int_t)e->asked.seed));
    json_put(whole, "fit", fit_json(e));
    json_put(whole, "results", results);
    return whole;
}
