#include "src/lab/compare.h"

#include <string.h>

#include "src/lab/export.h"
#include "src/rig/rig.h"

enum { PEAK, OVERSHOOT, SETTLING, IMPACTS, SEPARATIONS, STEADY_ERROR, COMMAND, ENERGY };

const compare_quantity compare_quantities[COMPARE_QUANTITIES] = {
    [PEAK] = {"peak_force_N", "peak", "N"},
    [OVERSHOOT] = {"overshoot_percent", "over", "%"},
    [SETTLING] = {"settling_time_s", "settled", "s"},
    [IMPACTS] = {"impacts", "impacts", ""},
    [SEPARATIONS] = {"separations", "separations", ""},
    [STEADY_ERROR] = {"steady_error_N", "error", "N"},
    [COMMAND] = {"largest_command_V", "command", "V"},
    [ENERGY] = {"electrical_energy_J", "energy", "J"},
};

static const char *law_of(const parameters *p)
{
    const controller *law = p->control.law == LAW_NONE ? NULL : controller_of(p->control.law);
    return law != NULL ? law->name : p->control.law == LAW_PLUGIN ? "plugin" : "none";
}

compare_row compare_row_of(const scenario *s, const summary *m)
{
    double command = m->force_command_N;
    bool commanded = !isnan(command) && command > 0;
    return (compare_row){
        .scenario = s->name,
        .law = law_of(&s->parameters),
        .ok = m->status == STATUS_OK,
        .values = {[PEAK] = m->peak_force_N,
                   [OVERSHOOT] = commanded ? 100 * m->force_over_command_N / command
                                           : m->force_overshoot_percent,
                   [SETTLING] = m->settling_time_s,
                   [IMPACTS] = m->impacts,
                   [SEPARATIONS] = m->separations,
                   [STEADY_ERROR] = m->steady_error_N,
                   [COMMAND] = m->largest_command_V,
                   [ENERGY] = m->electrical_energy_J},
    };
}

bool compare_differs(double value, double reference, double tolerance)
{
    if (isnan(value) || isnan(reference)) {
        return isnan(value) != isnan(reference);
    }
    return fabs(value - reference) > tolerance * fmax(fabs(value), fabs(reference));
}

void compare_text(FILE *stream, const compare_row *rows, int count, const compare_row *against,
                  double tolerance)
{
    int width = (int)strlen("scenario");
    for (int i = 0; i < count; i++) {
        int length = (int)strlen(rows[i].scenario);
        width = length > width ? length : width;
    }
    fprintf(stream, "%-*s", width, "scenario");
    for (int k = 0; k < COMPARE_QUANTITIES; k++) {
        char heading[32];
        const compare_quantity *quantity = &compare_quantities[k];
        snprintf(heading, sizeof heading, "%s%s%s", quantity->heading, quantity->unit[0] ? "/" : "",
                 quantity->unit);
        fprintf(stream, "  %11s ", heading);
    }
    fputc('\n', stream);
    for (int i = 0; i < count; i++) {
        fprintf(stream, "%-*s", width, rows[i].scenario);
        for (int k = 0; k < COMPARE_QUANTITIES; k++) {
            double value = rows[i].values[k];
            bool differs = against != NULL && compare_differs(value, against->values[k], tolerance);
            if (isnan(value)) {
                fprintf(stream, "  %11s%c", "-", differs ? '*' : ' ');
            } else {
                fprintf(stream, "  %11.4g%c", value, differs ? '*' : ' ');
            }
        }
        fprintf(stream, "%s\n", rows[i].ok ? "" : " failed");
    }
}

json_t *compare_json(const compare_row *rows, int count, const compare_row *against,
                     double tolerance)
{
    json_t *array = json_array();
    for (int i = 0; i < count; i++) {
        json_t *object = json_object(), *differs = json_array();
        json_object_set_new(object, "scenario", json_text(rows[i].scenario));
        json_object_set_new(object, "law", json_text(rows[i].law));
        json_object_set_new(object, "status", json_string(rows[i].ok ? "ok" : "failed"));
        for (int k = 0; k < COMPARE_QUANTITIES; k++) {
            const char *key = compare_quantities[k].key;
            json_object_set_new(object, key, json_number(rows[i].values[k]));
            if (against != NULL &&
                compare_differs(rows[i].values[k], against->values[k], tolerance)) {
                json_array_append_new(differs, json_string(key));
            }
        }
        if (against != NULL) {
            json_object_set(object, "differs", differs);
        }
        json_decref(differs);
        json_array_append_new(array, object);
    }
    json_t *whole = json_object();
    if (against != NULL) {
        json_object_set_new(whole, "against", json_text(against->scenario));
        json_object_set_new(whole, "tolerance", json_number(tolerance));
    }
    json_object_set_new(whole, "runs", array);
    return whole;
}

void compare_csv(FILE *stream, const compare_row *rows, int count)
{
    fputs("scenario,law,status", stream);
    for (int k = 0; k < COMPARE_QUANTITIES; k++) {
        fprintf(stream, ",%s", compare_quantities[k].key);
    }
    fputc('\n', stream);
    for (int i = 0; i < count; i++) {
        // quotes double in a quoted field
        fputc('"', stream);
        for (const char *c = rows[i].scenario; *c != '\0'; c++) {
            fputs(*c == '"' ? "\"\"" : (const char[]){*c, 0}, stream);
        }
        fprintf(stream, "\",%s,%s", rows[i].law, rows[i].ok ? "ok" : "failed");
        for (int k = 0; k < COMPARE_QUANTITIES; k++) {
            char text[NUMBER_TEXT] = "";
            if (!isnan(rows[i].values[k])) {
                number_format(text, rows[i].values[k]);
            }
            fprintf(stream, ",%s", text);
        }
        fputc('\n', stream);
    }
}
