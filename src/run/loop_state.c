// States of loops as bytes.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/run/loop.h"
#include "src/run/loop_parts.h"

// The head of a saved state; the run, the rig's memory and its values follow.
typedef struct saved_head {
    uint64_t check; // of all that follows it
    uint64_t fingerprint;
    size_t size;
    bool ended;
    double volts;
    size_t rows, events, force_steps;
    recording_state recording;
    recorded_command command;
    summary summary;
    parameters now;
    rig rig;
} saved_head;

static size_t memory_size(const rig *r)
{
    return r != NULL ? r->law->memory_size : 0;
}

static size_t values_size(const rig *r)
{
    return r != NULL ? (size_t)r->law->parameter_count * sizeof *r->values : 0;
}

size_t loop_saved_size(const run_loop *l)
{
    const rig *r = l->recording.rig;
    return sizeof(saved_head) + driver_saved_size(&l->driver) + memory_size(r) + values_size(r);
}

// A number that other bytes behind the head's `check` would not give, but for one in 2^64: eight
// bytes a turn are mixed in as by FNV-1a, and the upper half down into the lower one.
static uint64_t check_of(const char *bytes, size_t size)
{
    uint64_t check = 0xcbf29ce484222325u;
    for (size_t at = sizeof check; at < size; at += sizeof check) {
        uint64_t word = 0;
        memcpy(&word, bytes + at, size - at < sizeof word ? size - at : sizeof word);
        check = (check ^ word) * 0x100000001b3u;
        check ^= check >> 32;
    }
    return check;
}

// Gives a rig the addresses of another.
static void keep_places(rig *r, const rig *own)
{
    r->law = own->law;
    r->plugin = own->plugin;
    r->process = own->process;
    r->memory = own->memory;
    r->values = own->values;
}

void loop_save(const run_loop *l, void *bytes)
{
    const recording *r = &l->recording;
    saved_head head;
    memset(&head, 0, sizeof head);
    head.fingerprint = l->fingerprint;
    head.size = loop_saved_size(l);
    head.ended = l->ended;
    head.volts = l->volts;

    // what was recorded
    head.rows = l->result.trace.row_count;
    head.events = l->result.trace.event_count;
    head.force_steps = l->result.history.forces.count;
    head.recording = r->state;
    head.command = r->command;
    head.summary = l->result.summary;
    head.summary.path = NULL;
    head.now = r->now;

    // the rig and the run; where things lie is their loop's own, and no part of a state
    char *at = bytes;
    if (r->rig != NULL) {
        head.rig = *r->rig;
        keep_places(&head.rig, &(rig){.law = NULL});
    }
    memcpy(at, &head, sizeof head);
    at += sizeof head;
    driver_save(&l->driver, at);
    at += driver_saved_size(&l->driver);
    if (r->rig != NULL) {
        memcpy(at, r->rig->memory, memory_size(r->rig));
        if (l->law.law != NULL) { // which begins with its program's address
            memset(at, 0, sizeof l->law.context);
        }
        memcpy(at + memory_size(r->rig), r->rig->values, values_size(r->rig));
    }
    head.check = check_of(bytes, head.size);
    memcpy(bytes, &head.check, sizeof head.check);
}

// Puts the rig back; where its law, memory and values lie stays. The memory of a law that a program
// gave begins with that program's address.
static void restore_rig(run_loop *l, const rig *saved, const char *at)
{
    rig *r = l->recording.rig;
    const rig own = *r;

    // all but where things lie
    *r = *saved;
    keep_places(r, &own);

    // the contents, which were saved one after the other
    memcpy(r->memory, at, memory_size(r));
    memcpy(r->values, at + memory_size(r), values_size(r));

    // the program's address is the present one
    if (l->law.law != NULL) {
        memcpy(r->memory, &l->law.context, sizeof l->law.context);
    }
}

status loop_restore(run_loop *l, const void *bytes, size_t size, fault *f)
{
    saved_head head;
    FAIL_IF(size != loop_saved_size(l),
            fault_set(f, STATUS_BAD_ARGUMENT,
                      "a state of this loop has %zu bytes, but %zu were given", loop_saved_size(l),
                      size));
    memcpy(&head, bytes, sizeof head);
    FAIL_IF(head.fingerprint != l->fingerprint || head.size != size,
            fault_set(f, STATUS_BAD_ARGUMENT,
                      "the state is of another scenario, another controller or another version"));
    FAIL_IF(head.check != check_of(bytes, size),
            fault_set(f, STATUS_BAD_ARGUMENT,
                      "the state is damaged, expected the bytes as they were saved"));

    // what was recorded, as far as this loop has it
    recording *r = &l->recording;
    run_result *result = &l->result;
    result->trace.row_count =
        head.rows < result->trace.row_count ? head.rows : result->trace.row_count;
    result->trace.event_count =
        head.events < result->trace.event_count ? head.events : result->trace.event_count;
    result->history.forces.count = head.force_steps < result->history.forces.count
                                       ? head.force_steps
                                       : result->history.forces.count;
    r->state = head.recording;
    r->command = head.command;
    result->summary = head.summary;
    result->summary.path = "";
    if (head.recording.landing.time == 0) {
        free(result->before_impact); // of a contact that is yet to come
        result->before_impact = NULL;
        result->before_impact_size = 0;
    }
    r->now = head.now;
    l->volts = head.volts;
    l->ended = head.ended;
    l->failed = STATUS_OK;
    l->fault = (fault){.text = "", .path = ""};

    // the rig first: the run's arm has its voltage
    const char *at = (const char *)bytes + sizeof head;
    if (r->rig != NULL) {
        restore_rig(l, &head.rig, at + driver_saved_size(&l->driver));
    }
    driver_restore(&l->driver, at);
    return STATUS_OK;
}
