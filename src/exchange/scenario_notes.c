#include "src/exchange/scenario_notes.h"

#include "src/base/shipped.h"
#include "src/base/text_stream.h"

char *scenario_note(const scenario *s)
{
    text_stream text;
    char *written = NULL;
    if (text_stream_open(&text)) {
        scenario_write(text.stream, s);
        written = text_stream_close(&text, NULL);
    }
    loss_unless(written != NULL);
    return written;
}

void parquet_end_with_scenario(parquet_file *p, const scenario *s)
{
    SCOPED(free_kept) char *yaml = scenario_note(s);
    parquet_note notes[] = {{"impactlab.version", lab_version()},
                            {"impactlab.scenario", ""}};
    if (yaml != NULL) {
        notes[1].value = yaml;
    }
    parquet_end(p, notes, 2);
}
