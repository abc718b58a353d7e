#include "src/study/sweep.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "src/base/random.h"
#include "src/base/numbers.h"
#include "src/study/sweep_store.h"

const char *sweep_sampling_name(sweep_sampling sampling)
{
    static const char *const names[] = {"grid", "random", "latin"};
    return names[sampling];
}

static status no_memory(fault *f)
{
    return fault_set(f, STATUS_NO_MEMORY, "%s", status_text(STATUS_NO_MEMORY));
}

// --- what is varied -------------------------------------------------------------------------

static const parameter_info *axis_info(const sweep_axis *axis)
{
    return &parameter_table[axis->parameter];
}

// Checks and reads one value of the axis.
static status read_value(const sweep_axis *axis, const char *text, double *value, fault *f)
{
    parameters scratch = {0};
    status code = parameter_set_text(&scratch, axis->parameter, text, f);
    *value = parameter_get(&scratch, axis->parameter);
    return code;
}

// A value of the axis as text, exact.
static void format_value(const sweep_axis *axis, double value, char *text, size_t size)
{
    parameters scratch = {0};
    parameter_set_number(&scratch, axis->parameter, value, NULL);
    parameter_format(&scratch, axis->parameter, text, size);
}

// Cuts text at every separator. Returns the number of pieces, at most `most` + 1; those beyond
// `most` are not stored.
static size_t split(char *text, char separator, char **pieces, size_t most)
{
    size_t count = 0;
    for (char *next = text; next != NULL && count <= most; count++) {
        char *end = strchr(next, separator);
        if (count < most) {
            pieces[count] = next;
        }
        if (end != NULL) {
            *end++ = '\0';
        }
        next = end;
    }
    return count;
}

// Point number i of the n that span the range.
static double range_point(const sweep_axis *axis, size_t i, size_t n)
{
    double x = (double)i, last = (double)(n - 1), value;
    if (i == 0 || i == n - 1) {
        return i == 0 ? axis->low : axis->high;
    }
    if (axis->logarithmic) {
        value = axis->low * pow(axis->high / axis->low, x / last);
    } else {
        value = (axis->low * (last - x) + axis->high * x) / last;
    }
    // a whole number as near as there is one; an even spacing that misses them is refused instead
    return axis->logarithmic && axis_info(axis)->type == PARAMETER_INTEGER ? round(value) : value;
}

static status fill_range(sweep_axis *axis, size_t n, fault *f)
{
    axis->values = malloc(n * sizeof *axis->values);
    if (axis->values == NULL) {
        return no_memory(f);
    }
    axis->count = n;
    for (size_t i = 0; i < n; i++) {
        parameters scratch = {0};
        axis->values[i] = range_point(axis, i, n);
        status code = parameter_set_number(&scratch, axis->parameter, axis->values[i], f);
        if (code != STATUS_OK) {
            return code;
        }
        if (i > 0 && axis->values[i] == axis->values[i - 1]) {
            char text[128];
            format_value(axis, axis->values[i], text, sizeof text);
            return fault_set(f, STATUS_BAD_ARGUMENT, "%zu values give %s twice", n, text);
        }
    }
    return STATUS_OK;
}

// Reads the number of values in a range.
static status read_count(const char *text, size_t *count, fault *f)
{
    const char *rest;
    double value;
    if (!decimal_read(text, &value, &rest) || *rest != '\0' || value != floor(value) || value < 2 ||
        value > SWEEP_MOST_RUNS) {
        return fault_set(f, STATUS_BAD_ARGUMENT,
                         "'%.40s' is no number of values, expected a whole number from 2 to %d",
                         text, SWEEP_MOST_RUNS);
    }
    *count = (size_t)value;
    return STATUS_OK;
}

// The range's text in one way of writing, for comparing sweeps.
static status describe_range(sweep_axis *axis, size_t n, fault *f)
{
    char low[128], high[128], count[32] = "";
    format_value(axis, axis->low, low, sizeof low);
    format_value(axis, axis->high, high, sizeof high);
    if (n > 0) {
        snprintf(count, sizeof count, ":%zu", n);
    }
    if (asprintf(&axis->text, "%s:%s%s%s", low, high, count, axis->logarithmic ? ":log" : "") < 0) {
        axis->text = NULL;
        return no_memory(f);
    }
    return STATUS_OK;
}

// Reads "a:b", "a:b:n" or either with ":log".
static status read_range(sweep_axis *axis, char *text, bool drawn, fault *f)
{
    char *pieces[4];
    size_t count = split(text, ':', pieces, 4), n = 0;
    axis->is_range = true;
    if (axis_info(axis)->choices != NULL || axis_info(axis)->type == PARAMETER_BOOLEAN) {
        char words[128];
        snprintf(words, sizeof words, "%s",
                 axis_info(axis)->choices ? axis_info(axis)->choices : "true|false");
        for (char *c = words; *c != '\0'; c++) {
            *c = *c == '|' ? ',' : *c;
        }
        return fault_set(f, STATUS_BAD_ARGUMENT,
                         "%s takes words, which have no range; expected a list such as %s",
                         axis_info(axis)->path, words);
    }
    axis->logarithmic = count > 2 && count <= 4 && strcmp(pieces[count - 1], "log") == 0;
    count -= axis->logarithmic;
    if (count > 3 || (count < 3 && !drawn)) {
        return fault_set(f, STATUS_BAD_ARGUMENT,
                         "expected %s (first, last, number of values), with :log for an even "
                         "spacing of the logarithm",
                         drawn ? "a:b or a:b:n" : "a:b:n");
    }
    status code = read_value(axis, pieces[0], &axis->low, f);
    code = code == STATUS_OK ? read_value(axis, pieces[1], &axis->high, f) : code;
    code = code == STATUS_OK && count == 3 ? read_count(pieces[2], &n, f) : code;
    if (code != STATUS_OK) {
        return code;
    }
    if (axis->low == axis->high) {
        return fault_set(f, STATUS_BAD_ARGUMENT, "a range needs two different ends");
    }
    if (axis->logarithmic && !(axis->low > 0 && axis->high > 0)) {
        return fault_set(f, STATUS_BAD_ARGUMENT, "a logarithmic range needs ends above zero");
    }
    code = describe_range(axis, drawn ? 0 : n, f);
    return code == STATUS_OK && !drawn ? fill_range(axis, n, f) : code;
}

// Reads "v1,v2,v3".
static status read_list(sweep_axis *axis, char *text, fault *f)
{
    size_t most = 1;
    for (const char *c = text; *c != '\0'; c++) {
        most += *c == ',';
    }
    char **pieces = malloc(most * sizeof *pieces);
    axis->values = malloc(most * sizeof *axis->values);
    axis->text = calloc(most, 128);
    status code = pieces && axis->values && axis->text ? STATUS_OK : no_memory(f);
    axis->count = code == STATUS_OK ? split(text, ',', pieces, most) : 0;
    char *end = axis->text;
    for (size_t i = 0; i < axis->count && code == STATUS_OK; i++) {
        code = read_value(axis, pieces[i], &axis->values[i], f);
        for (size_t j = 0; j < i && code == STATUS_OK; j++) {
            if (axis->values[i] == axis->values[j]) {
                code = fault_set(f, STATUS_BAD_ARGUMENT, "'%.60s' stands there twice", pieces[i]);
            }
        }
        if (code == STATUS_OK) {
            char value[127];
            format_value(axis, axis->values[i], value, sizeof value);
            end += sprintf(end, "%s%s", i > 0 ? "," : "", value);
        }
    }
    free(pieces);
    return code;
}

static status find_parameter(const sweep *s, sweep_axis *axis, const char *path, fault *f)
{
    axis->parameter = parameter_find(path);
    if (axis->parameter < 0) {
        const char *near = parameter_suggest(path);
        return fault_set(f, STATUS_BAD_ARGUMENT, "there is no parameter '%.60s'%s%s%s", path,
                         near ? ", did you mean '" : "", near ? near : "", near ? "'?" : "");
    }
    if (axis_info(axis)->type == PARAMETER_TEXT) {
        return fault_set(f, STATUS_BAD_ARGUMENT, "%s is a text, only numbers and words are varied",
                         path);
    }
    for (int i = 0; i < s->axis_count; i++) {
        if (s->axes[i].parameter == axis->parameter) {
            return fault_set(f, STATUS_BAD_ARGUMENT, "%s is varied twice", path);
        }
    }
    return STATUS_OK;
}

// Reads one --vary into the next axis.
static status read_axis(sweep *s, const char *given, fault *f)
{
    if (s->axis_count == SWEEP_MOST_AXES) {
        return fault_set(f, STATUS_BAD_ARGUMENT, "at most %d parameters can be varied",
                         SWEEP_MOST_AXES);
    }
    char *text = strdup(given);
    if (text == NULL) {
        return no_memory(f);
    }
    sweep_axis *axis = &s->axes[s->axis_count];
    char *values = strchr(text, '=');
    status code;
    if (values == NULL) {
        code = fault_set(f, STATUS_BAD_ARGUMENT, "expected PATH=a:b:n or PATH=v1,v2,v3");
    } else {
        *values++ = '\0';
        code = find_parameter(s, axis, text, f);
        s->axis_count++;
    }
    if (code == STATUS_OK) {
        // a list of ranges is none: the comma wins, and the value with the colon is complained
        // about
        bool range = strchr(values, ':') != NULL && strchr(values, ',') == NULL;
        code = range ? read_range(axis, values, s->sampling != SWEEP_GRID, f)
                     : read_list(axis, values, f);
    }
    free(text);
    return code;
}

// --- which values a run has -----------------------------------------------------------------

// The value at share u of the axis, 0 <= u < 1.
static double value_at_share(const sweep_axis *axis, double u)
{
    double low = fmin(axis->low, axis->high), high = fmax(axis->low, axis->high);
    if (!axis->is_range) {
        return axis->values[(size_t)(u * (double)axis->count)];
    }
    bool whole = axis_info(axis)->type == PARAMETER_INTEGER;
    // each whole number owns the unit interval round it
    double from = whole ? low - 0.5 : low, to = whole ? high + 0.5 : high;
    double value = axis->logarithmic ? from * exp(u * log(to / from)) : from + u * (to - from);
    return fmin(fmax(whole ? floor(value + 0.5) : value, low), high);
}

static void draw_random(sweep *s, random_generator *g)
{
    for (size_t run = 0; run < s->run_count; run++) {
        for (int i = 0; i < s->axis_count; i++) {
            s->drawn[run * (size_t)s->axis_count + (size_t)i] =
                value_at_share(&s->axes[i], random_uniform(g));
        }
    }
}

// Latin hypercube (McKay, Beckman and Conover 1979): for each parameter its range falls into
// run_count parts of equal chance, which the runs take in random order, each at a random place.
static status draw_latin(sweep *s, random_generator *g, fault *f)
{
    size_t *part = malloc(s->run_count * sizeof *part);
    if (part == NULL) {
        return no_memory(f);
    }
    for (int i = 0; i < s->axis_count; i++) {
        random_permutation(g, part, s->run_count);
        for (size_t run = 0; run < s->run_count; run++) {
            double u = ((double)part[run] + random_uniform(g)) / (double)s->run_count;
            // the sum may round up to the next part
            double above = (double)(part[run] + 1) / (double)s->run_count;
            s->drawn[run * (size_t)s->axis_count + (size_t)i] =
                value_at_share(&s->axes[i], fmin(u, nextafter(above, 0)));
        }
    }
    free(part);
    return STATUS_OK;
}

static status count_runs(sweep *s, size_t runs, fault *f)
{
    if (s->sampling != SWEEP_GRID) {
        if (runs < 1 || runs > SWEEP_MOST_RUNS) {
            return fault_set(f, STATUS_BAD_ARGUMENT,
                             "--sample %s needs --runs with a number from 1 to %d",
                             sweep_sampling_name(s->sampling), SWEEP_MOST_RUNS);
        }
        s->run_count = runs;
        return STATUS_OK;
    }
    s->run_count = 1;
    for (int i = 0; i < s->axis_count; i++) {
        // both factors are small enough for the product to fit
        s->run_count *= s->axes[i].count;
        if (s->run_count > SWEEP_MOST_RUNS) {
            return fault_set(f, STATUS_BAD_ARGUMENT, "the grid has more than %d runs",
                             SWEEP_MOST_RUNS);
        }
    }
    if (runs != 0) {
        return fault_set(f, STATUS_BAD_ARGUMENT,
                         "--runs goes with --sample random or latin; a grid is as large as it is, "
                         "here %zu",
                         s->run_count);
    }
    return STATUS_OK;
}

static status draw_values(sweep *s, fault *f)
{
    random_generator g;
    if (s->sampling == SWEEP_GRID) {
        return STATUS_OK;
    }
    s->drawn = malloc(s->run_count * (size_t)s->axis_count * sizeof *s->drawn);
    if (s->drawn == NULL) {
        return no_memory(f);
    }
    random_seed(&g, s->seed);
    if (s->sampling == SWEEP_LATIN) {
        return draw_latin(s, &g, f);
    }
    draw_random(s, &g);
    return STATUS_OK;
}

double sweep_value(const sweep *s, size_t run, int axis)
{
    if (s->drawn != NULL) {
        return s->drawn[run * (size_t)s->axis_count + (size_t)axis];
    }
    for (int i = s->axis_count - 1; i > axis; i--) {
        run /= s->axes[i].count;
    }
    return s->axes[axis].values[run % s->axes[axis].count];
}

void sweep_value_text(const sweep *s, size_t run, int axis, char *text, size_t size)
{
    format_value(&s->axes[axis], sweep_value(s, run, axis), text, size);
}

status sweep_scenario(const sweep *s, size_t run, scenario *derived, fault *f)
{
    *derived = *s->base;
    for (int i = 0; i < s->axis_count; i++) {
        status code = parameter_set_number(&derived->parameters, s->axes[i].parameter,
                                           sweep_value(s, run, i), f);
        if (code != STATUS_OK) {
            return code;
        }
    }
    return parameters_resolve(&derived->parameters, f);
}

// Tells before anything is computed if values do not go together (links and the printed model).
static status check_combinations(const sweep *s, fault *f)
{
    // what a very large sweep has beyond these is told in the rows of the runs
    enum { CHECKED = 100000 };
    for (size_t run = 0; run < s->run_count && run < CHECKED; run++) {
        scenario derived;
        fault why = {0};
        if (sweep_scenario(s, run, &derived, &why) != STATUS_OK) {
            char values[512] = "";
            size_t length = 0;
            for (int i = 0; i < s->axis_count && length < sizeof values; i++) {
                char text[128];
                sweep_value_text(s, run, i, text, sizeof text);
                length += (size_t)snprintf(values + length, sizeof values - length, "%s%s = %s",
                                           i > 0 ? ", " : "", axis_info(&s->axes[i])->path, text);
            }
            return fault_set(f, STATUS_BAD_ARGUMENT, "run %zu (%s): %.400s", run + 1, values,
                             why.text);
        }
    }
    return STATUS_OK;
}

status sweep_init(sweep *s, const scenario *base, const sweep_request *request, fault *f)
{
    status code = STATUS_OK;
    memset(s, 0, sizeof *s);
    s->base = base;
    s->sampling = request->sampling;
    s->seed = request->seed;
    if (request->vary_count == 0) {
        return fault_set(f, STATUS_BAD_ARGUMENT,
                         "sweep needs at least one --vary PATH=a:b:n or --vary PATH=v1,v2,v3");
    }
    for (int i = 0; i < request->vary_count && code == STATUS_OK; i++) {
        fault why = {0};
        code = read_axis(s, request->vary[i], &why);
        if (code != STATUS_OK) {
            code = fault_set(f, code == STATUS_NO_MEMORY ? code : STATUS_BAD_ARGUMENT,
                             "--vary %.200s: %.700s", request->vary[i], why.text);
        }
    }
    code = code == STATUS_OK ? count_runs(s, request->runs, f) : code;
    code = code == STATUS_OK ? draw_values(s, f) : code;
    code = code == STATUS_OK ? check_combinations(s, f) : code;
    if (code != STATUS_OK) {
        sweep_finish(s);
    }
    return code;
}

void sweep_finish(sweep *s)
{
    for (int i = 0; i < s->axis_count; i++) {
        free(s->axes[i].values);
        free(s->axes[i].text);
    }
    free(s->drawn);
    memset(s, 0, sizeof *s);
}

void quantity_name(const char *key, char *name, size_t size, const char **unit)
{
    static const struct {
        const char *suffix, *unit;
    } units[] = {{"_Ns", "N s"}, {"_percent", "%"}, {"_s", "s"}, {"_N", "N"},
                 {"_J", "J"},    {"_m", "m"},       {"_V", "V"}};
    size_t length = strlen(key);
    *unit = "";
    for (size_t i = 0; i < sizeof units / sizeof units[0]; i++) {
        size_t tail = strlen(units[i].suffix);
        if (length > tail && strcmp(key + length - tail, units[i].suffix) == 0) {
            length -= tail;
            *unit = units[i].unit;
            break;
        }
    }
    snprintf(name, size, "%.*s", (int)length, key);
}

// --- computing ------------------------------------------------------------------------------

#define COMMIT_INTERVAL 0.5 // [s]
#define REPORT_INTERVAL 0.1 // [s]

enum { QUEUE_LENGTH = 256 };

typedef struct finished_run {
    size_t run;
    summary summary;
} finished_run;

// What the threads that compute share with the one that stores. The mutex guards everything that
// changes.
typedef struct pool {
    const sweep *sweep;
    const unsigned char *present; // runs that need not be computed
    pthread_mutex_t mutex;
    pthread_cond_t changed; // a run was finished, or room was made, or a thread has ended
    size_t next;            // the first run that no thread has taken
    int working;            // threads that have not ended
    bool stop;
    finished_run *queue; // QUEUE_LENGTH of them
    int queued;
} pool;

static double seconds(clockid_t clock)
{
    struct timespec t;
    clock_gettime(clock, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void compute(const sweep *s, finished_run *result)
{
    scenario derived;
    fault f = {0};
    // the computing time of this thread alone
    double start = seconds(CLOCK_THREAD_CPUTIME_ID);
    status code = sweep_scenario(s, result->run, &derived, &f);
    if (code == STATUS_OK) {
        run_result run;
        run_scenario(&derived, false, &run);
        result->summary = run.summary;
        run_finish(&run);
    } else {
        memset(&result->summary, 0, sizeof result->summary);
        for (int i = 0; i < summary_count; i++) {
            double none = (double)NAN;
            memcpy((char *)&result->summary + summary_table[i].offset, &none, sizeof none);
        }
        result->summary.status = code;
        snprintf(result->summary.message, sizeof result->summary.message, "%s", f.text);
    }
    result->summary.wall_time_s = seconds(CLOCK_THREAD_CPUTIME_ID) - start;
}

// Takes the next missing run; false if there is none. The mutex is held.
static bool take_run(pool *p, size_t *run)
{
    while (p->next < p->sweep->run_count && p->present[p->next]) {
        p->next++;
    }
    if (p->stop || p->next >= p->sweep->run_count) {
        return false;
    }
    *run = p->next++;
    return true;
}

static void *work(void *context)
{
    pool *p = context;
    finished_run result;
    pthread_mutex_lock(&p->mutex);
    while (take_run(p, &result.run)) {
        pthread_mutex_unlock(&p->mutex);
        compute(p->sweep, &result);
        pthread_mutex_lock(&p->mutex);
        while (p->queued == QUEUE_LENGTH) {
            pthread_cond_wait(&p->changed, &p->mutex);
        }
        p->queue[p->queued++] = result;
        pthread_cond_broadcast(&p->changed);
    }
    p->working--;
    pthread_cond_broadcast(&p->changed);
    pthread_mutex_unlock(&p->mutex);
    return NULL;
}

// Moves what is finished to `batch`, waiting a little for it. Returns the number moved, -1 if all
// threads have ended and nothing is left.
static int take_batch(pool *p, finished_run *batch, bool stop)
{
    struct timespec until;
    clock_gettime(CLOCK_MONOTONIC, &until);
    until.tv_nsec += (long)(1e9 * REPORT_INTERVAL);
    if (until.tv_nsec >= 1000000000) {
        until.tv_sec++;
        until.tv_nsec -= 1000000000;
    }
    pthread_mutex_lock(&p->mutex);
    p->stop = p->stop || stop;
    int waited = 0;
    while (p->queued == 0 && p->working > 0 && waited == 0) {
        waited = pthread_cond_timedwait(&p->changed, &p->mutex, &until);
    }
    int count = p->queued == 0 && p->working == 0 ? -1 : p->queued;
    if (count > 0) {
        memcpy(batch, p->queue, (size_t)count * sizeof *batch);
        p->queued = 0;
        pthread_cond_broadcast(&p->changed);
    }
    pthread_mutex_unlock(&p->mutex);
    return count;
}

static status put_batch(sweep_store *store, const finished_run *batch, int count,
                        sweep_progress *progress, fault *f)
{
    for (int i = 0; i < count; i++) {
        const summary *result = &batch[i].summary;
        if (result->status == STATUS_NO_MEMORY) {
            // says nothing about the scenario: the run has to be done again
            return fault_set(f, STATUS_NO_MEMORY, "run %zu: %s", batch[i].run + 1, result->message);
        }
        status code = sweep_store_put(store, batch[i].run, result, f);
        if (code != STATUS_OK) {
            return code;
        }
        progress->done++;
        progress->done_now++;
        progress->failed += result->status != STATUS_OK;
    }
    return STATUS_OK;
}

// Stores what the threads finish until they have ended. After a failure they are only waited for.
static status store_results(pool *p, sweep_store *store, const sweep_options *o,
                            finished_run *batch, sweep_progress *progress, fault *f)
{
    status code = STATUS_OK;
    double start = seconds(CLOCK_MONOTONIC), committed = start, reported = start;
    for (;;) {
        bool stop = code != STATUS_OK || (o->stop != NULL && *o->stop);
        int count = take_batch(p, batch, stop);
        double now = seconds(CLOCK_MONOTONIC);
        progress->elapsed_s = now - start;
        if (code == STATUS_OK && count > 0) {
            code = put_batch(store, batch, count, progress, f);
        }
        if (code == STATUS_OK && (count < 0 || now - committed >= COMMIT_INTERVAL)) {
            code = sweep_store_commit(store, f);
            committed = seconds(CLOCK_MONOTONIC);
        }
        if (o->report != NULL && (count < 0 || now - reported >= REPORT_INTERVAL)) {
            o->report(o->context, progress);
            reported = now;
        }
        if (count < 0) {
            return code;
        }
    }
}

// Starts up to `jobs` threads, which leave signals to the calling one. Returns how many there are.
static int start_threads(pool *p, pthread_t *threads, int jobs)
{
    sigset_t all, before;
    int started = 0;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    pthread_mutex_lock(&p->mutex);
    while (started < jobs && pthread_create(&threads[started], NULL, work, p) == 0) {
        started++;
    }
    p->working = started;
    pthread_mutex_unlock(&p->mutex);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return started;
}

// Computes what is not present.
static status run_missing(const sweep *s, sweep_store *store, const sweep_options *o,
                          const unsigned char *present, sweep_progress *progress, fault *f)
{
    pthread_t threads[SWEEP_MOST_JOBS];
    pthread_condattr_t monotonic;
    pool p = {.sweep = s, .present = present};
    finished_run *batches = malloc(2 * QUEUE_LENGTH * sizeof *batches);
    if (batches == NULL) {
        return no_memory(f);
    }
    p.queue = batches + QUEUE_LENGTH;
    pthread_mutex_init(&p.mutex, NULL);
    pthread_condattr_init(&monotonic);
    pthread_condattr_setclock(&monotonic, CLOCK_MONOTONIC);
    pthread_cond_init(&p.changed, &monotonic);
    pthread_condattr_destroy(&monotonic);
    size_t missing = s->run_count - progress->done;
    int jobs = missing < (size_t)o->jobs ? (int)missing : o->jobs;
    int started = start_threads(&p, threads, jobs);
    status code = store_results(&p, store, o, batches, progress, f);
    for (int i = 0; i < started; i++) {
        pthread_join(threads[i], NULL);
    }
    if (started == 0 && jobs > 0 && code == STATUS_OK) {
        code = fault_set(f, STATUS_NO_MEMORY, "no thread could be started");
    }
    pthread_cond_destroy(&p.changed);
    pthread_mutex_destroy(&p.mutex);
    free(batches);
    return code;
}

status sweep_run(const sweep *s, sweep_store *store, const sweep_options *options,
                 sweep_progress *progress, fault *f)
{
    memset(progress, 0, sizeof *progress);
    progress->total = s->run_count;
    unsigned char *present = malloc(s->run_count);
    if (present == NULL) {
        return no_memory(f);
    }
    status code = sweep_store_present(store, present, &progress->done, f);
    if (code == STATUS_OK) {
        code = run_missing(s, store, options, present, progress, f);
    }
    free(present);
    return code;
}
