// Every parameter is tried on scenarios of every kind: two values of it either come to
// other results, or the scenario says that the parameter has no effect in it, or refuses
// it.
#include "src/scenario/effect.h"
#include "tests/shipped_scenario.h"

typedef struct base {
    const char *scenario; // one that ships
    const char *changes;  // "PATH=VALUE ..." between blanks
} base;

static const base bases[] = {
    {"thesis/fig-3-4", ""},
    {"thesis/fig-2-4", ""},
    {"corrected/first-impact", ""},
    {"corrected/first-impact",
     "wall.restitution=0.5 arm.damping_ratio=0.02 motor.inductance=0.002"},
    {"corrected/spring-hub", "method.step=0.001"},
    {"corrected/free-vibration", ""},
    {"corrected/twenty-links", ""},
    {"corrected/hertz-wall", ""},
    {"corrected/wall-with-a-face", ""},
    {"corrected/sensor-on-soft-wall", ""},
    {"corrected/plane-wall", "wall.motion=sine wall.motion_time=0.05 arm.tilt=-0.1"},
    {"corrected/newmark", ""},
    {"corrected/generalized-alpha", ""},
    {"corrected/first-impact", "arm.links=1 motor.drive=current"},
    {"corrected/five-links", "arm.hub_joint=beam wall.contact=hunt-crossley"},
    {"compare/open-loop", ""},
    {"compare/hybrid", ""},
    {"compare/hybrid", "sensor.ideal=true"},
    {"compare/force-pd", "sensor.force=piezo"},
    {"compare/observer", ""},
    {"compare/inverse-dynamics", ""},
    {"compare/bang-bang", ""},
    {"compare/speed-limit", ""},
    {"compare/impedance", ""},
    {"compare/admittance", ""},
    {"compare/force-integral", ""},
    {"workflow/bench", "control.law=playback control.playback_file=workflow/press.csv"},
};

// Texts that a parameter may be, of those that are one.
static const struct {
    const char *path, *values[2];
} texts[] = {
    {"arm.joint_stiffness", {"4", "6"}},
    {"arm.link_lengths", {"0.4,0.6", "0.55,0.45"}},
    {"arm.link_masses", {"0.1,0.3", "0.2,0.25"}},
    {"arm.link_inertias", {"0.002,0.004", "0.001,0.003"}},
    {"arm.joint_damping", {"0.01", "0.05"}},
    {"arm.modal_ratios", {"0.02", "0.1"}},
    {"wall.motion_file", {"workflow/free.csv", "workflow/check.csv"}},
    {"control.plugin", {"one.so", "other.so"}},
    {"control.command", {"false", "true"}},
    {"control.playback_file", {"workflow/press.csv", "workflow/strike.csv"}},
    {"control.playback_column", {"command", "tachometer"}},
    {"control.settings", {"a=1", "a=2"}},
    {"control.lock", {"none", "approach"}},
    {"control.k2_table", {"1:4 2:7", "1:8 2:9"}},
};

// Bounds, thresholds and recordings that a run need not reach: they are never called
// without effect.
static const char bounds[] =
    " method.residual_bound motor.voltage_limit control.contact_threshold "
    "sensor.fsr_saturation sensor.piezo_range printed.force_after_release "
    "control.playback_shift control.playback_hold control.approach_voltage ";

enum { MOST_VALUES = 8 };

// The values to try, as texts; returns how many.
static int values_to_try(const parameters *p, int parameter, char values[MOST_VALUES][64])
{
    const parameter_info *info = &parameter_table[parameter];
    if (parameter_is_text(info)) {
        for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
            if (strcmp(texts[i].path, info->path) == 0) {
                snprintf(values[0], 64, "%s", texts[i].values[0]);
                snprintf(values[1], 64, "%s", texts[i].values[1]);
                return 2;
            }
        }
        fail_msg("no text to try for %s", info->path);
    }
    if (info->type == PARAMETER_CHOICE || info->type == PARAMETER_BOOLEAN) {
        const int count = (int)(info->maximum - info->minimum) + 1;
        for (int i = 0; i < count && i < MOST_VALUES; i++) {
            parameters tried = *p;
            fault f = {0};
            parameter_set_number(&tried, parameter, info->minimum + i, &f);
            parameter_format(&tried, parameter, values[i], 64);
        }
        return count < MOST_VALUES ? count : MOST_VALUES;
    }
    double low, high;
    bool logarithmic;
    const double value = parameter_get(p, parameter);
    if (!parameter_usual_range(parameter, value, &low, &high, &logarithmic)) {
        return 0;
    }
    const double shares[] = {0.31, 0.78};
    for (int i = 0; i < 2; i++) {
        double number = logarithmic ? low * pow(high / low, shares[i])
                                    : low + (high - low) * shares[i];
        number = info->type == PARAMETER_INTEGER ? floor(number) : number;
        snprintf(values[i], 64, "%.6g", number);
    }
    return 2;
}

static bool same_number(double a, double b)
{
    return a == b || (isnan(a) && isnan(b));
}

// Whether two runs came to the same, but for their times of computing.
static bool same_results(const run_result *a, const run_result *b)
{
    if (strcmp(a->summary.message, b->summary.message) != 0 ||
        a->trace.row_count != b->trace.row_count ||
        a->trace.event_count != b->trace.event_count) {
        return false;
    }
    for (int i = 0; i < summary_count; i++) {
        if (!summary_table[i].timing &&
            !same_number(summary_value(&a->summary, i), summary_value(&b->summary, i))) {
            return false;
        }
    }
    const double *x = (const double *)a->trace.rows, *y = (const double *)b->trace.rows;
    for (size_t i = 0; i < a->trace.row_count * (sizeof(sample) / sizeof(double)); i++) {
        if (!same_number(x[i], y[i])) {
            return false;
        }
    }
    return true;
}

// Where the texts' files lie.
static const char *within_folder(const char *value)
{
    return strstr(value, ".csv") != NULL
               ? formatted("%s/%s", getenv("IMPACTLAB_SCENARIOS"), value)
               : value;
}

// Gives a base its changes, and a run of at most 0.7 s.
static scenario changed_base(const base *b)
{
    scenario s = shipped(b->scenario);
    char *const *words = (char *const *)words_of(b->changes);
    char changes[16][256];
    char *given[16];
    int count = 0;
    for (; words[count] != NULL; count++) {
        const char *file = strstr(words[count], "workflow/");
        const int before =
            (int)(file != NULL ? file - words[count] : (int)strlen(words[count]));
        snprintf(changes[count], sizeof changes[count], "%.*s%s", before, words[count],
                 file != NULL ? within_folder(file) : "");
        given[count] = changes[count];
    }
    given[count++] = formatted("run.duration=%g", fmin(0.7, s.parameters.run.duration));
    assert_int_equal(scenario_override_all(&s, given, count, fail_on_fault, NULL),
                     STATUS_OK);
    return s;
}

// Tries the values of one parameter against the run without them.
static void try_parameter(const base *b, const scenario *s, const run_result *untouched,
                          int i)
{
    char values[MOST_VALUES][64], own[64], path[64];
    const int tried = values_to_try(&s->parameters, i, values);
    bool acts = false, named = false;
    int others = 0;
    parameter_format(&s->parameters, i, own, sizeof own);
    snprintf(path, sizeof path, " %s ", parameter_table[i].path);
    for (int k = 0; k < tried; k++) {
        scenario changed;
        fault f = {0};
        const parameter_change change = {.parameter = i,
                                         .text = within_folder(values[k])};
        if (scenario_with(s, &change, 1, &changed, &f) != STATUS_OK) {
            continue;
        }
        const char *why = effect_none_from(&changed, i, -1);
        if (acts && why == NULL) {
            continue; // seen already
        }
        KEPT_RUN(r) = (run_result){0};
        const status code = run_scenario(&changed, true, &r);
        const bool differs = code != STATUS_OK || !same_results(untouched, &r);
        fail_if(differs && why != NULL && code == STATUS_OK,
                "%s %s: %s = %s acts, but: %s", b->scenario, b->changes,
                parameter_table[i].path, values[k], why);
        acts = acts || differs;
        named = named || why != NULL;
        others += strcmp(values[k], own) != 0;
    }
    fail_if(others > 0 && !acts && !named && strstr(bounds, path) == NULL,
            "%s %s: %s has no effect, and nothing says so", b->scenario, b->changes,
            parameter_table[i].path);
}

TEST(what_has_no_effect_is_named)
{
    for (EACH(b, bases)) {
        KEPT_SCENARIO(s) = changed_base(b);
        KEPT_RUN(untouched) = (run_result){0};
        assert_int_equal(run_scenario(&s, true, &untouched), STATUS_OK);
        for (int i = 0; i < parameter_count; i++) {
            try_parameter(b, &s, &untouched, i);
        }
    }
}
