// impactlab tables: Tables 4.1 to 4.3 of the thesis, printed and computed.
#include "ui/commands/progress.h"

#include <math.h>
#include <string.h>

#include "src/study/thesis_tables.h"
#include "src/base/json.h"

static json_t *tables_object(const scenario *s, const void *found)
{
    const thesis_tables *t = found;
    json_t *rows = json_array();
    for (int i = 0; i < t->row_count; i++) {
        const table_row *row = &t->rows[i];
        json_t *line = json_of("table:t k2_factor:n model:t quantity:t", row->table,
                               row->k2_factor, row->model, row->quantity);
        json_add(rows, json_members(line, "voltage_V:o printed:o computed:o",
                                    json_numbers(t->voltage, TABLE_VOLTAGES),
                                    json_numbers(row->printed, TABLE_VOLTAGES),
                                    json_numbers(row->computed, TABLE_VOLTAGES)));
    }
    return json_of("tables:o", rows);
}

static const struct {
    const char *quantity, *label;
} labels[] = {
    {"max_force_energy", "peak force, energy principle"},
    {"max_force_dynamics", "peak force, impact dynamics"},
    {"max_force_simulation", "peak force, simulation"},
    {"delay_dynamics", "delay of the peak, impact dynamics"},
    {"delay_simulation", "delay of the peak, simulation"},
};

static void print_cells(const char *name, const double *values, double scale,
                        const char *format)
{
    printf("    %-12s", name);
    for (int i = 0; i < TABLE_VOLTAGES; i++) {
        print_cell(9, format, values[i] * scale);
    }
    printf("\n");
}

static void print_row(const thesis_tables *t, const table_row *row)
{
    bool delay = strncmp(row->quantity, "delay", 5) == 0;
    double scale = delay ? 1e3 : 1, percent[TABLE_VOLTAGES];
    for (int i = 0; i < TABLE_VOLTAGES; i++) {
        percent[i] = 100 * (row->computed[i] / row->printed[i] - 1);
    }
    size_t k = 0;
    while (strcmp(labels[k].quantity, row->quantity) != 0) {
        k++;
    }
    printf("  %s [%s]\n", labels[k].label, delay ? "ms" : "N");
    print_cells("voltage", t->voltage, 1, "%g V");
    print_cells("thesis", row->printed, scale, "%.4g");
    print_cells("computed", row->computed, scale, "%.4g");
    print_cells("difference", percent, 1, "%+.1f %%");
}

// Constants the thesis never prints, inferred from its tables (errata A), and why.
static const char *const inferred[] = {
    "k1 = 90 N m/rad: with the printed 169 468 the thesis's own "
    "algorithm chatters at 1 ms; 85 to 100 bring its tables out",
    "torque per volt of command 0.4377 N m/V: amplifier gain 6.02 times kT/Ra; matches "
    "the forces",
    "kT = 2.443 N m/A: the printed 0.249092 kg m/A in SI units, equal to kB as it must "
    "be",
    "links of 0.5 m and a contact point at 1 m in the direction of 0.1 "
    "rad: from the listing's formulas",
};
enum { INFERRED = sizeof inferred / sizeof inferred[0] };

static void print_tables(const scenario *s, const void *found)
{
    const thesis_tables *t = found;
    const bool fitted = strcmp(t->rows[0].model, "fitted") == 0;

    // a heading where table or model changes, and the rows below it
    for (int i = 0; i < t->row_count; i++) {
        const table_row *row = &t->rows[i], *before = i > 0 ? row - 1 : NULL;
        if (before == NULL || strcmp(before->table, row->table) != 0 ||
            strcmp(before->model, row->model) != 0) {
            printf("%sTable %s, %g times the nominal k2, %s%s\n", i > 0 ? "\n" : "",
                   row->table, row->k2_factor, row->model, fitted ? "" : " model");
        }
        print_row(t, row);
    }

    printf("\nMean error over the 12 cells of a row kind%s:\n",
           fitted ? "" : " (printed model, corrected model)");
    for (size_t i = 0; i < sizeof labels / sizeof labels[0]; i++) {
        const char *quantity = labels[i].quantity;
        const double error = 100 * tables_mean_error(t, t->rows[0].model, quantity);
        if (isnan(error)) {
            continue;
        }
        printf("  %-36s %6.1f %%", labels[i].label, error);
        if (!fitted) {
            printf(" %6.1f %%", 100 * tables_mean_error(t, "corrected", quantity));
        }
        printf("\n");
    }
    if (fitted) {
        return;
    }

    printf("\nInferred, since the thesis does not print them "
           "(docs/explanation/model.md):\n");
    for (int i = 0; i < INFERRED; i++) {
        printf("  %s\n", inferred[i]);
    }
}

static int tables(const arguments *a)
{
    static const command_results r = {tables_object, print_tables};
    thesis_tables t;
    fault f = {0};
    status code = STATUS_OK;
    interrupts_catch();
    if (a->fitted) {
        tables_compute_fitted(&t);
    } else {
        code = tables_compute(&t, &f);
    }
    if (code != STATUS_OK && code != STATUS_STOPPED) {
        return complain_fault(&f);
    }
    const int result = write_results(a, &r, NULL, &t, code == STATUS_OK);
    if (code == STATUS_OK) {
        return result;
    }
    complain("stopped: the cells that were not computed are empty");
    return worse(result, EXIT_FAILED);
}

static const option_row rows[] = {
    OPTION(FLAG, "fitted", NULL, "what comes nearest to the printed delays instead",
           PLACE(fitted)),
};

const command tables_command = {
    CALLED("tables", THESIS,
           "Tables 4.1-4.3 of the thesis: printed, computed, difference"),
    NO_OPERANDS,
    .help = "Each row is computed with the equations as the thesis prints them "
            "and with the corrected ones. --fitted shows the delays of the "
            "simulation with seven numbers and switches of the printed\nmodel "
            "fitted to them, and those of the impact dynamics by the integral "
            "that belongs to (4.19)\n(docs/explanation/thesis.md).\n",
    .options = {&json_options, OWN_OPTIONS(rows), &quiet_options},
    .run = tables,
};
