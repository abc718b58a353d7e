// Reads what a fit to recordings leaves open of a scenario's parameters.
#include <math.h>
#include <stdlib.h>

#include "src/scenario/fitted_arm.h"
#include "src/scenario/reader.h"

// Reads a fitted parameter's line, a list of its error and of its correlations with those
// above: row[k] with parameter k. False after a fault.
static bool read_line(reader *r, const tree_node *list, int parameter, double *error,
                      double row[SCENARIO_FIT])
{
    const char *path = parameter_table[parameter].path;
    const int above = r->s->fit->count;
    int read = 0;
    const tree_node *child = list->kind == TREE_LIST ? list->first : NULL;
    for (; child != NULL && read <= above; child = child->next, read++) {
        double *to = read == 0 ? error : &row[read - 1];
        const char *unit = read == 0 ? parameter_table[parameter].unit : "";
        if (!reader_quantity(r, child, path, unit, to)) {
            return false;
        }
        if (read == 0 && !(*to > 0)) {
            return report_node(r, child,
                               "fit of %s: %g, expected a standard error "
                               "above 0",
                               path, *to);
        }
        if (read > 0 && !(fabs(*to) <= 1)) {
            return report_node(r, child,
                               "fit of %s: %g, expected a correlation of -1 to "
                               "1",
                               path, *to);
        }
    }
    if (read != above + 1 || child != NULL) {
        return report_node(r, list,
                           "fit of %s: expected a list of its standard error and %d "
                           "correlations, with those above",
                           path, above);
    }
    return true;
}

// The parameter that a line is about; -1 after a fault.
static int read_parameter(reader *r, const tree_node *map, const tree_node *line)
{
    const char *path = reader_key(r, map, line);
    if (path == NULL) {
        return -1;
    }
    const int parameter = parameter_find(path);
    if (parameter < 0 || parameter_table[parameter].type != PARAMETER_REAL) {
        report_node(r, line->key, "fit: '%.60s' is no parameter with a real value", path);
        return -1;
    }
    if (r->s->fit->count == SCENARIO_FIT) {
        report_node(r, line->key, "fit: more than %d parameters", SCENARIO_FIT);
        return -1;
    }
    return parameter;
}

void reader_fit(reader *r, const tree_node *map)
{
    if (!reader_expect_map(r, map, "fit", "arm.k2: [0.01]")) {
        return;
    }
    scenario_fit *fit = calloc(1, sizeof *fit);
    r->s->fit = fit;
    if (!reader_have_memory(r, fit)) {
        return;
    }

    // the lines, one below the other
    double rows[SCENARIO_FIT][SCENARIO_FIT] = {{0}};
    for (const tree_node *line = map->first; line != NULL; line = line->next) {
        const int parameter = read_parameter(r, map, line), row = fit->count;
        if (parameter < 0 ||
            !read_line(r, line, parameter, &fit->errors[row], rows[row])) {
            return;
        }
        fit->parameters[fit->count++] = parameter;
    }

    if (fit->count == 0) {
        report_node(r, map, "fit is empty, expected keys such as 'arm.k2: [0.01]'");
        return;
    }

    // the whole matrix
    for (int i = 0; i < fit->count; i++) {
        for (int k = 0; k < i; k++) {
            fit->correlation[i * fit->count + k] = rows[i][k];
            fit->correlation[k * fit->count + i] = rows[i][k];
        }
        fit->correlation[i * fit->count + i] = 1;
    }
    double factor[SCENARIO_FIT * SCENARIO_FIT];
    if (!fitted_arm_factor(fit, factor)) {
        report_node(r, map,
                    "fit: no parameters have such correlations, expected a "
                    "matrix without negative eigenvalues");
    }
}
