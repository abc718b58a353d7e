// impactlab tables: Tables 4.1 to 4.3 of the thesis, printed and computed.
#include "ui/commands/command.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "src/base/json.h"
#include "src/study/thesis_tables.h"
#include "ui/commands/interrupts.h"
#include "ui/commands/results.h"

// The rows of all tables.
static json_t *tables_json(const void *found)
{
    const thesis_tables *t = found;
    json_t *rows = json_array();

    // a row for each table, model and quantity
    for (int i = 0; i < t->row_count; i++) {
        const table_row *row = &t->rows[i];
        json_t *line = json_of("table:t k2_factor:n model:t quantity:t", row->table,
                               row->k2_factor, row->model, row->quantity);
        json_members(line, "voltage_V:o printed:o computed:o",
                     json_numbers(t->voltage, TABLE_VOLTAGES),
                     json_numbers(row->printed, TABLE_VOLTAGES),
                     json_numbers(row->computed, TABLE_VOLTAGES));
        json_add(rows, line);
    }
    return json_of("tables:o", rows);
}

// --- rows ------------------------------------------------------------------------------

// The quantities of the rows; `scale` takes them from SI units to those that are printed.
typedef struct table_quantity {
    const char *key, *label, *unit;
    double scale;
} table_quantity;

static const table_quantity quantities[] = {
    {"max_force_energy", "peak force, energy principle", "N", 1},
    {"max_force_dynamics", "peak force, impact dynamics", "N", 1},
    {"max_force_simulation", "peak force, simulation", "N", 1},
    {"delay_dynamics", "delay of the peak, impact dynamics", "ms", 1e3},
    {"delay_simulation", "delay of the peak, simulation", "ms", 1e3},
};
enum { QUANTITIES = sizeof quantities / sizeof quantities[0] };

static const table_quantity *quantity_of_row(const table_row *row)
{
    int i = 0;
    while (strcmp(quantities[i].key, row->quantity) != 0) {
        i++;
        assert(i < QUANTITIES);
    }
    return &quantities[i];
}

static void print_cells(const char *name, const double *values, double scale,
                        const char *format)
{
    printf("    %-12s", name);
    for (int i = 0; i < TABLE_VOLTAGES; i++) {
        print_cell(9, format, values[i] * scale);
    }
    printf("\n");
}

// A row: the voltages, what the thesis prints and what was computed, and by how much
// these differ.
static void print_row(const thesis_tables *t, const table_row *row)
{
    const table_quantity *quantity = quantity_of_row(row);
    double percent[TABLE_VOLTAGES];
    for (int i = 0; i < TABLE_VOLTAGES; i++) {
        percent[i] = 100 * (row->computed[i] / row->printed[i] - 1);
    }

    printf("  %s [%s]\n", quantity->label, quantity->unit);
    print_cells("voltage", t->voltage, 1, "%g V");
    print_cells("thesis", row->printed, quantity->scale, "%.4g");
    print_cells("computed", row->computed, quantity->scale, "%.4g");
    print_cells("difference", percent, 1, "%+.1f %%");
}

// --- tables ----------------------------------------------------------------------------

// Whether the tables hold what is fitted to the printed delays, not the two models.
static bool is_fitted(const thesis_tables *t)
{
    return strcmp(t->rows[0].model, "fitted") == 0;
}

// Whether a row belongs to the same table and model as the one before it.
static bool continues_table(const thesis_tables *t, int i)
{
    if (i == 0) {
        return false;
    }
    const table_row *row = &t->rows[i], *before = row - 1;
    return strcmp(before->table, row->table) == 0 &&
           strcmp(before->model, row->model) == 0;
}

// The tables one below the other, each with its heading.
static void print_rows(const thesis_tables *t)
{
    const char *model_word = is_fitted(t) ? "" : " model";
    for (int i = 0; i < t->row_count; i++) {
        const table_row *row = &t->rows[i];
        if (!continues_table(t, i)) {
            if (i > 0) {
                printf("\n");
            }
            printf("Table %s, %g times the nominal k2, %s%s\n", row->table,
                   row->k2_factor, row->model, model_word);
        }
        print_row(t, row);
    }
}

// How far the computed cells are from the printed ones, by quantity.
static void print_mean_errors(const thesis_tables *t)
{
    const char *columns = is_fitted(t) ? "" : " (printed model, corrected model)";
    printf("\nMean error over the 12 cells of a row kind%s:\n", columns);

    // quantities that these tables do not have are left out
    for (int i = 0; i < QUANTITIES; i++) {
        const char *key = quantities[i].key;
        const double error = 100 * tables_mean_error(t, t->rows[0].model, key);
        if (isnan(error)) {
            continue;
        }
        printf("  %-36s %6.1f %%", quantities[i].label, error);
        if (!is_fitted(t)) {
            printf(" %6.1f %%", 100 * tables_mean_error(t, "corrected", key));
        }
        printf("\n");
    }
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

// The tables, how near they come out, and what had to be inferred for that.
static void print_tables(const void *found)
{
    const thesis_tables *t = found;
    print_rows(t);
    print_mean_errors(t);
    if (is_fitted(t)) {
        return;
    }

    printf("\nInferred, since the thesis does not print them "
           "(docs/explanation/model.md):\n");
    for (int i = 0; i < INFERRED; i++) {
        printf("  %s\n", inferred[i]);
    }
}

// --- the command -----------------------------------------------------------------------

// The command: computes the tables and writes them.
static int compute_and_report_tables(const arguments *a)
{
    static const command_results results = {.json = tables_json, .text = print_tables};
    thesis_tables t;
    fault f = {0};
    status code = STATUS_OK;

    // the tables, of which an interrupt leaves some cells empty
    interrupts_catch();
    if (a->fitted) {
        tables_compute_fitted(&t);
    } else {
        code = tables_compute(&t, &f);
    }
    if (code != STATUS_OK && code != STATUS_STOPPED) {
        return complain_fault(&f);
    }

    // what there is
    int result = write_results(a, &results, &t, code == STATUS_OK);
    if (code == STATUS_STOPPED) {
        complain("stopped: the cells that were not computed are empty");
        result = worse(result, EXIT_FAILED);
    }
    return result;
}

static const option_row rows[] = {
    OPTION(FLAG, "fitted", NULL, "what comes nearest to the printed delays instead",
           PLACE(fitted)),
};

const command tables_command = {
    .name = "tables",
    .group = GROUP_THESIS,
    .summary = "Tables 4.1-4.3 of the thesis: printed, computed, difference",
    .operands = "",
    .help =
        "Each row is computed with the equations as the thesis prints them and with the "
        "corrected ones. --fitted shows the delays of the simulation with seven numbers "
        "and switches of the printed\n"
        "model fitted to them, and those of the impact dynamics by the integral that "
        "belongs to (4.19)\n"
        "(docs/explanation/thesis.md).\n",
    .options = {&json_options, OWN_OPTIONS(rows), &quiet_options},
    .run = compute_and_report_tables,
};
