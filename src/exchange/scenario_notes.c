#include "src/exchange/scenario_notes.h"

#include "src/base/shipped.h"

void parquet_end_with_scenario(parquet_file *p, const scenario *s)
{
    SCOPED(free_kept) char *yaml = scenario_as_text(s);
    parquet_note notes[] = {{"impactlab.version", lab_version()},
                            {"impactlab.scenario", ""}};
    if (yaml != NULL) {
        notes[1].value = yaml;
    }
    parquet_end(p, notes, 2);
}
