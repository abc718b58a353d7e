// The tables of parameters, signals and quantities as the library shows them.
#include "src/api/api_handles.h"
#include "src/base/shipped.h"
#include "src/tables/summary.h"

enum { PARAMETERS_AT_MOST = sizeof((parameters *)0)->set };

static impactlab_parameter parameter_rows[PARAMETERS_AT_MOST];
static impactlab_signal signal_rows[SIGNALS_AT_MOST];
static impactlab_quantity quantity_rows[SUMMARY_NUMBERS];

// A parameter as the library shows it.
static impactlab_parameter parameter_row(const parameter_info *info)
{
    static const char *const types[] = {
        [PARAMETER_REAL] = "real",       [PARAMETER_INTEGER] = "integer",
        [PARAMETER_BOOLEAN] = "boolean", [PARAMETER_CHOICE] = "choice",
        [PARAMETER_TEXT] = "text",       [PARAMETER_LIST] = "list"};

    impactlab_parameter row = {.path = info->path,
                               .type = types[info->type],
                               .unit = info->unit,
                               .choices = "",
                               .description = info->description,
                               .timed = info->timed};
    if (info->type == PARAMETER_CHOICE) {
        row.choices = info->choices;
    }

    // a text has no number as its default, and no bounds
    if (!parameter_is_text(info)) {
        row.initial = info->default_corrected;
        row.minimum = info->minimum;
        row.maximum = info->maximum;
    }
    return row;
}

// Fills in the library's tables before the program begins. Their rows point to the texts
// of the program's own tables, which have the same contents under other names.
static __attribute__((constructor)) void fill_tables(void)
{
    for (int i = 0; i < parameter_count; i++) {
        parameter_rows[i] = parameter_row(&parameter_table[i]);
    }

    // the signals of a run, and the quantities of its summary
    for (int i = 0; i < signal_count; i++) {
        const signal_info *info = &signal_table[i];
        signal_rows[i] =
            (impactlab_signal){info->name, info->ascii, info->unit, info->description};
    }
    for (int i = 0; i < summary_count; i++) {
        const summary_info *info = &summary_table[i];
        quantity_rows[i] = (impactlab_quantity){info->key, info->label, info->unit,
                                                info->description, info->timing};
    }
}

const impactlab_parameter *impactlab_parameter_at(size_t index)
{
    if (index < (size_t)parameter_count) {
        return &parameter_rows[index];
    }
    return NULL;
}

const impactlab_signal *impactlab_signal_at(size_t index)
{
    if (index < (size_t)signal_count) {
        return &signal_rows[index];
    }
    return NULL;
}

const impactlab_quantity *impactlab_quantity_at(size_t index)
{
    if (index < (size_t)summary_count) {
        return &quantity_rows[index];
    }
    return NULL;
}

const char *impactlab_version(void)
{
    return lab_version();
}
