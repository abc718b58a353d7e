// The thesis's tables as pages.
#include <assert.h>
#include <math.h>
#include <string.h>

#include "render/figures/figures.h"
#include "src/arm/modes.h"

G_LOCK_DEFINE_STATIC(tables);

// The thesis's tables, computed at the first call. Six pages use them, perhaps on several
// threads, and computing them takes a while. NULL, with a fault, if they cannot be.
const thesis_tables *computed_tables(fault *f)
{
    static thesis_tables tables;
    static bool done;
    const thesis_tables *computed = NULL;
    G_LOCK(tables);
    if (!done) {
        done = tables_compute(&tables, f) == STATUS_OK;
    }
    if (done) {
        computed = &tables;
    }
    G_UNLOCK(tables);
    return computed;
}

const table_row *computed_row(const thesis_tables *t, const char *table,
                              const char *model, const char *quantity)
{
    for (int i = 0; i < t->row_count; i++) {
        const table_row *row = &t->rows[i];
        if (strcmp(row->table, table) == 0 && strcmp(row->model, model) == 0 &&
            strcmp(row->quantity, quantity) == 0) {
            return row;
        }
    }
    assert(false && "no such row");
    return NULL;
}

// ==== pages

// Makes a page with an empty table, with the title and the look of an order.
static table_page *new_table(const figure_order *order, const table_column *columns,
                             size_t count)
{
    table_page *t = table_create(order->title, columns, count);
    t->look = order->options->look;
    return t;
}

// Gives a table its caption, printed as by text_printf, and opens it.
__attribute__((format(printf, 3, 4))) static status
open_table(table_page *t, artwork *out, const char *caption, ...)
{
    va_list list;
    va_start(list, caption);
    t->caption = text_vprintf(caption, list);
    va_end(list);
    *out = artwork_of_table(t);
    return STATUS_OK;
}

// ---- 2.1: the motor

// Below this width a parameter's description stands above its row [mm].
#define DESCRIPTIONS_BESIDE 120.0

// Parameters of the lab with what the thesis prints for them.
static const struct {
    const char *symbol, *printed, *path;
} constants[] = {
    {"<i>k</i><sub>B</sub>", "2.443\u2009V·s/rad", "motor.back_emf"},
    {"<i>k</i><sub>T</sub>", "0.249092\u2009kg·m/A", "motor.torque_constant"},
    {"<i>R</i><sub>a</sub>", "33.6\u2009Ω", "motor.resistance"},
    {"<i>k</i><sub>fr</sub>", "5.4192·10<sup>−3</sup>\u2009N·m·s/rad",
     "motor.viscous_friction"},
    {"<i>k</i><sub>st</sub>", "0.045\u2009N·m", "motor.stiction"},
    {"", "6.02 (section 2.3)", "motor.amplifier_gain"},
    {"", "10\u2009V (section 2.3)", "motor.voltage_limit"},
};

// A parameter's value with six digits and its unit.
static char *used_value(const parameters *p, const parameter_info *info)
{
    g_autofree char *unit = text_unit(info->unit);
    const char *sign = unit;
    if (strcmp(unit, "ohm") == 0) {
        sign = "Ω";
    }
    const double value = parameter_get(p, parameter_find(info->path));
    return text_printf("%.6g\u2009%s", value, sign);
}

// Makes table 2.1: the constants of the motor.
status table_motor(const figure_order *order, artwork *out, fault *f)
{
    static const table_column columns[] = {{"Symbol", 0.75},
                                           {"Thesis", 1.75},
                                           {"As used", 1.75},
                                           {"Parameter", 3.2}};
    parameters p;
    parameters_defaults(&p, ARM_CORRECTED);
    TRY(parameters_resolve(&p, f));

    // a parameter's description beside its row, or above it
    const page_look *look = &order->options->look;
    const bool above = look->width > 0 && look->width < DESCRIPTIONS_BESIDE;
    size_t column_count = G_N_ELEMENTS(columns);
    if (above) {
        column_count--;
    }

    table_page *t = new_table(order, columns, column_count);
    for (size_t i = 0; i < G_N_ELEMENTS(constants); i++) {
        const parameter_info *info = &parameter_table[parameter_find(constants[i].path)];
        g_autofree char *used = used_value(&p, info);
        g_autofree char *name = text_printf("%s: %s", info->path, info->description);
        if (above) {
            table_add_group(t, name);
        }
        table_add_row(t, (const char *[]){constants[i].symbol, constants[i].printed, used,
                                          name});
    }
    return open_table(t, out,
                      "The printed <i>k</i><sub>T</sub> counts kilograms of force; times "
                      "9.80665\u2009m/s² it is equal to <i>k</i><sub>B</sub>, as it must "
                      "be.");
}

// ---- 3.1: stability

// Adds the row of a pair (beta, gamma). It is stable at any step if 2 beta >= gamma, else
// for w h up to 1/sqrt(gamma/2 - beta); `fastest` is the arm's highest w [rad/s].
static void add_pair(table_page *t, const char *name, double beta, double gamma,
                     double fastest)
{
    g_autofree char *pair = text_printf("%.4g, %.4g", beta, gamma);
    const char *consistency = gamma > 0.5 ? "1" : "2";
    if (2 * beta >= gamma) {
        table_add_row(t, (const char *[]){name, pair, "none", "any", consistency});
        return;
    }

    // a pair with a bound has a longest step, that of the fastest mode
    const double critical = 1 / sqrt(gamma / 2 - beta);
    g_autofree char *bound = text_printf("%.4g", critical);
    g_autofree char *step = text_printf("%.3g\u2009ms", 1e3 * critical / fastest);
    table_add_row(t, (const char *[]){name, pair, bound, step, consistency});
}

// Frequency of the fastest mode of hub and two links with a hub spring [rad/s].
static status find_fastest_mode(double *fastest, fault *f)
{
    arm a;
    parameters p;
    parameters_defaults(&p, ARM_CORRECTED);
    TRY(parameter_set_text(&p, PARAMETER_INDEX(arm.hub_joint), "spring", f));
    TRY(parameters_resolve(&p, f));
    arm_init(&a, &p);

    // three bodies have three modes, the last is the fastest
    double frequencies[3], shapes[9];
    int count = 0;
    const status code =
        modes_compute(&a, HUB_FREE, TIP_FREE, &count, frequencies, shapes);
    FAULT_IF(code != STATUS_OK || count < 1, f, STATUS_SINGULAR,
             "the modes of the two-link arm cannot be computed");
    *fastest = frequencies[count - 1];
    return STATUS_OK;
}

// Makes table 3.1: the stability of Newmark's method.
status table_stability(const figure_order *order, artwork *out, fault *f)
{
    double fastest = 0;
    TRY(find_fastest_mode(&fastest, f));

    static const table_column columns[] = {{"Method", 2.3},
                                           {"<i>β</i>, <i>γ</i>", 1.5},
                                           {"Largest <i>ωh</i>", 1.1, TEXT_RIGHT},
                                           {"Longest step", 1.2, TEXT_RIGHT},
                                           {"Order", 0.7, TEXT_RIGHT}};
    table_page *t = new_table(order, columns, G_N_ELEMENTS(columns));
    table_add_group(t, "Stable at any step: 2<i>β</i> ≥ <i>γ</i> ≥ ½");
    add_pair(t, "trapezoidal rule", 0.25, 0.5, fastest);
    add_pair(t, "the thesis's choice", 0.4, 0.5, fastest);
    add_pair(t, "with damping of fast modes", 0.36, 0.7, fastest);

    table_add_group(t, "Stable up to <i>ωh</i> = (<i>γ</i>/2 − <i>β</i>)<sup>−1/2</sup>: "
                       "<i>γ</i> ≥ ½, <i>β</i> &lt; <i>γ</i>/2");
    add_pair(t, "linear acceleration", 1.0 / 6, 0.5, fastest);
    add_pair(t, "Fox and Goodwin", 1.0 / 12, 0.5, fastest);
    add_pair(t, "central differences", 0, 0.5, fastest);

    return open_table(
        t, out,
        "Without damping; <i>ω</i> is the fastest mode, for the two-link arm "
        "with the printed hub spring %.4g\u2009rad/s. <i>γ</i> > ½ damps "
        "fast modes and costs one order. In contact <i>β</i> has to exceed ¼ "
        "as well, whatever the step: figure beta-gamma.",
        fastest);
}

// ---- 3.2: the algorithm

// Table 3.2.
status table_algorithm(const figure_order *order, artwork *out, fault *f)
{
    static const char *const rows[][3] = {
        {"1", "Start from given angles and velocities; accelerations are zero.",
         "printed_motion_start"},
        {"2", "Not in contact in the step before: would a free step end behind the wall?",
         "solve_step"},
        {"2.1",
         "It would not: Newmark's rule and Newton's method for the three "
         "bodies; the next state is found.",
         "solve_step"},
        {"2.2",
         "It would: the step is repeated with the constraint (3.9) and the force as a "
         "fourth unknown; then accelerations and force are computed once more, from the "
         "linear system with (3.13), the constraint's second derivative.",
         "solve_step, printed_reevaluate"},
        {"3", "In contact in the step before: does the force still push?",
         "printed_motion_step"},
        {"3.1", "It does: as in 2.2.", "printed_motion_step"},
        {"3.2", "It would pull, contact is over: as in 2.1.", "printed_motion_step"},
        {"4", "The next time step.", "printed_motion_step"},
    };
    static const table_column columns[] = {{"", 0.35},
                                           {"What happens in a step", 4},
                                           {"In the lab", 1.2}};
    (void)f;

    table_page *t = new_table(order, columns, G_N_ELEMENTS(columns));
    for (size_t i = 0; i < G_N_ELEMENTS(rows); i++) {
        table_add_row(t, rows[i]);
    }

    return open_table(
        t, out,
        "Numbered as in the thesis, in the form that the lab runs for the printed "
        "model. The corrected model locates contact and release in time instead "
        "(docs/explanation/model.md).");
}

// ---- 4.1 to 4.3: predictions

#define NOMINAL_K2 4.92 // stiffness of the beam's spring [N m/rad]

static const struct {
    const char *quantity, *label;
} quantities[] = {
    {"max_force_energy", "Peak force by the energy principle (N)"},
    {"max_force_dynamics", "Peak force by impact dynamics (N)"},
    {"max_force_simulation", "Peak force by simulation (N)"},
    {"delay_dynamics", "Delay of the peak by impact dynamics (ms)"},
    {"delay_simulation", "Delay of the peak by simulation (ms)"},
};

static char *cell_text(const char *format, double value)
{
    if (!isfinite(value)) {
        return g_strdup("–");
    }
    g_autofree char *text = text_printf(format, fabs(value));
    return text_printf("%s%s", text_sign(value), text);
}

// A row of four values, each times `scale`.
static void add_values(table_page *t, const char *name, const double *values,
                       double scale, const char *format)
{
    g_auto(GStrv) cells = g_new0(char *, TABLE_VOLTAGES + 2);
    cells[0] = g_strdup(name);
    for (int i = 0; i < TABLE_VOLTAGES; i++) {
        cells[i + 1] = cell_text(format, scale * values[i]);
    }
    table_add_row(t, (const char *const *)cells);
}

// A model's values, and below them the differences from the thesis.
static void add_model(table_page *t, const table_row *row, double scale,
                      const char *format)
{
    double difference[TABLE_VOLTAGES];
    for (int i = 0; i < TABLE_VOLTAGES; i++) {
        difference[i] = row->computed[i] / row->printed[i] - 1;
    }
    g_autofree char *name = text_printf("%s model", row->model);
    add_values(t, name, row->computed, scale, format);
    add_values(t, "  difference (%)", difference, 100, "%.1f");
}

// A quantity as the thesis prints it, and by both models.
static void add_predictions(table_page *t, const thesis_tables *all, const char *table,
                            const char *quantity)
{
    const table_row *printed = computed_row(all, table, "printed", quantity);
    const table_row *corrected = computed_row(all, table, "corrected", quantity);
    if (g_str_has_prefix(quantity, "delay")) {
        // in milliseconds, which the thesis rounds
        add_values(t, "thesis", printed->printed, 1e3, "%.0f");
        add_model(t, printed, 1e3, "%.1f");
        add_model(t, corrected, 1e3, "%.1f");
    } else {
        add_values(t, "thesis", printed->printed, 1, "%.2f");
        add_model(t, printed, 1, "%.2f");
        add_model(t, corrected, 1, "%.2f");
    }
}

// "T4.2" and its like.
status table_predictions(const figure_order *order, artwork *out, fault *f)
{
    const char *table = order->which->id + 1;
    const thesis_tables *all = computed_tables(f);
    if (all == NULL) {
        return f->code;
    }

    // a column for each voltage
    static const table_column columns[TABLE_VOLTAGES + 1] = {{"Command", 2.2},
                                                             {"1\u2009V", 1, TEXT_RIGHT},
                                                             {"2\u2009V", 1, TEXT_RIGHT},
                                                             {"5\u2009V", 1, TEXT_RIGHT},
                                                             {"10\u2009V", 1,
                                                              TEXT_RIGHT}};
    table_page *t = new_table(order, columns, G_N_ELEMENTS(columns));

    for (size_t q = 0; q < G_N_ELEMENTS(quantities); q++) {
        table_add_group(t, quantities[q].label);
        add_predictions(t, all, table, quantities[q].quantity);
    }

    t->parameters = text_printf("table=%s", table);
    return open_table(
        t, out,
        "<i>k</i><sub>2</sub> = %g\u2009N·m/rad, wall at 0.1\u2009rad. Differences are "
        "from what the thesis prints. The printed model has the constants inferred "
        "from these tables (docs/explanation/model.md); the corrected one is "
        "derived again from mechanics and is not meant to agree. –: the arm swings away "
        "as it touches, there is no pulse.",
        NOMINAL_K2 * computed_row(all, table, "printed", "max_force_energy")->k2_factor);
}

// ---- how near the computed tables come

// Deviations from Tables 4.1 to 4.3, row by row.
status table_errors(const figure_order *order, artwork *out, fault *f)
{
    const thesis_tables *all = computed_tables(f);
    if (all == NULL) {
        return f->code;
    }

    static const table_column columns[] = {{"Row", 3},
                                           {"Printed (%)", 1.2, TEXT_RIGHT},
                                           {"Corrected (%)", 1.2, TEXT_RIGHT}};
    table_page *t = new_table(order, columns, G_N_ELEMENTS(columns));
    for (size_t q = 0; q < G_N_ELEMENTS(quantities); q++) {
        g_autofree char *printed =
            cell_text("%.1f",
                      100 * tables_mean_error(all, "printed", quantities[q].quantity));
        g_autofree char *corrected =
            cell_text("%.1f",
                      100 * tables_mean_error(all, "corrected", quantities[q].quantity));
        table_add_row(t, (const char *[]){quantities[q].label, printed, corrected});
    }

    return open_table(
        t, out,
        "Mean size of the difference from the thesis over the cells of a row "
        "that have a value, three stiffnesses at four voltages.");
}

// ---- the lab's own parameters

// Parameters of one group with the defaults of both models.
table_page *defaults_table(int *next)
{
    static const table_column columns[] = {{"Parameter", 3.7},
                                           {"Corrected", 1.1},
                                           {"Printed", 1.1},
                                           {"Unit", 0.9},
                                           {"Meaning", 3.2}};
    parameters corrected, printed;
    parameters_defaults(&corrected, ARM_CORRECTED);
    parameters_defaults(&printed, ARM_PRINTED);
    parameters_resolve(&corrected, NULL);
    parameters_resolve(&printed, NULL);

    // all whose paths begin alike: "arm." or "motor."
    const char *group = parameter_table[*next].path;
    const size_t length = strcspn(group, ".");
    g_autofree char *title = text_printf("Parameters: %.*s", (int)length, group);
    table_page *t = table_create(title, columns, G_N_ELEMENTS(columns));
    for (; *next < parameter_count &&
           strncmp(parameter_table[*next].path, group, length + 1) == 0;
         ++*next) {
        const parameter_info *info = &parameter_table[*next];
        char of_corrected[128], of_printed[128];
        parameter_format(&corrected, *next, of_corrected, sizeof of_corrected);
        parameter_format(&printed, *next, of_printed, sizeof of_printed);
        g_autofree char *unit = text_unit(info->unit);

        // a row of plain texts
        const char *const texts[] = {info->path, of_corrected, of_printed, unit,
                                     info->description};
        g_auto(GStrv) cells = g_new0(char *, G_N_ELEMENTS(columns) + 1);
        for (size_t k = 0; k < G_N_ELEMENTS(texts); k++) {
            cells[k] = text_escape(texts[k]);
        }
        table_add_row(t, (const char *const *)cells);
    }
    return t;
}
