// impactlab merge: the parts of a sweep, computed apart, in one database.
#include "ui/commands/command.h"

#include "src/base/json.h"
#include "src/study/store/sweep_store.h"

static json_t *merged_object(const char *path, const sweep_merged *merged)
{
    json_t *object = json_object();
    json_put(object, "file", json_text(path));
    json_put(object, "runs", json_integer((json_int_t)merged->runs));
    json_put(object, "runs_of_sweep", json_integer((json_int_t)merged->total));
    return object;
}

static int merge(const arguments *a)
{
    fault f = {0};
    sweep_merged merged;
    if (a->output == NULL) {
        return complain("merge: expected -o FILE, the database to write");
    }
    if (sweep_merge(a->operands, a->operand_count, a->output, &merged, &f) != STATUS_OK) {
        return complain_fault(&f);
    }

    // a sweep with missing runs is a valid file: the same sweep continues in it
    if (summary_wanted(a)) {
        say("%s: %zu of %zu runs from %d part%s\n", a->output, merged.runs, merged.total,
            a->operand_count, a->operand_count == 1 ? "" : "s");
    }
    return a->json != NULL ? write_json(a->json, merged_object(a->output, &merged)) : EXIT_DONE;
}

static const option_row rows[] = {
    {.name = "output",
     .letter = 'o',
     .type = OPTION_PLACE,
     .value = "FILE.sqlite",
     .help = "the database to write",
     PLACE(output)},
};
static const option_table options = OPTION_TABLE("Options", rows);

const command merge_command = {
    .name = "merge",
    .group = GROUP_MANY_RUNS,
    .operands = "FILE...",
    .summary = "The parts of a sweep in one database",
    .help = "The files are databases of impactlab sweep --part K/N --db FILE, in any order. Parts "
            "of another sweep,\nand parts that hold the same run, are refused. "
            "impactlab sweep with the same scenario and --vary, and\n--db of the merged file, "
            "computes what may be missing and writes CSV and pictures.\n",
    .least = 1,
    .most = 1 << 20,
    .options = {&json_options, &options, &quiet_options},
    .run = merge,
};
