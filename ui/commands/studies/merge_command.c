// impactlab merge: the parts of a sweep in one database.
#include "ui/commands/command.h"

#include "src/base/json.h"
#include "src/study/store/sweep_store.h"
#include "ui/commands/results.h"

// The command: joins the parts and says how many runs there are.
static int merge_parts(const arguments *a)
{
    sweep_merged merged;
    if (a->output == NULL) {
        return complain("merge: expected -o FILE, the database to write");
    }
    fault f = {0};
    if (sweep_merge(a->operands, a->operand_count, a->output, &merged, &f) != STATUS_OK) {
        return complain_fault(&f);
    }

    // a sweep with missing runs is a valid file: the same sweep continues in it
    if (summary_wanted(a)) {
        say("%s: %zu of %zu runs from %d part%s\n", a->output, merged.runs, merged.total,
            a->operand_count, plural_ending((size_t)a->operand_count));
    }
    if (a->json != NULL) {
        return write_json_file(a->json,
                               json_of("file:t runs:o runs_of_sweep:o", a->output,
                                       json_integer((json_int_t)merged.runs),
                                       json_integer((json_int_t)merged.total)));
    }
    return EXIT_DONE;
}

static const option_row merge_rows[] = {
    OUTPUT_OPTION(PLACE, "FILE.sqlite", "the database to write",
                  .replaces = sweep_store_is),
};

const command merge_command = {
    .name = "merge",
    .group = GROUP_MANY_RUNS,
    .summary = "The parts of a sweep in one database",
    .operands = "FILE...",
    .least = 1,
    .most = 1 << 20,
    .help =
        "The files are databases of impactlab sweep --part K/N --db FILE, in any order. "
        "Parts of another sweep,\n"
        "and parts that hold the same run, are refused. impactlab sweep with the same "
        "scenario and --vary, and\n"
        "--db of the merged file, computes what may be missing and writes CSV and "
        "pictures.\n",
    .options = {&json_options, OWN_OPTIONS(merge_rows), &quiet_options},
    .run = merge_parts,
};
