// Which engine takes an arm, and the storage of its motion: one block of the state and
// one that is the engine's own.

#include "src/engines/motion_create.h"

#include <assert.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

// Arms with a faster decay than this are not computed by two-link series [1/s], whose
// steps it shortens. These are cheap: half a million steps take a third of a second.
#define FASTEST_OF_PAIR 2e6

// The engine of the event method, whatever the time step: the two-link series for two
// equal links with any hub joint and damping and a rigid wall or none, the stiff engine
// for all other arms.
static const engine *event_engine(const arm *a)
{
    if (motion_suits_pair(a)) {
        return &taylor_engine;
    }
    return &stiff_engine;
}

bool motion_suits_pair(const arm *a)
{
    return features_suit_pair(a->features) && a->fastest_decay <= FASTEST_OF_PAIR;
}

// Sets what a motion knows of its arm and chooses its engine: `chosen` if that is not
// NULL, else by the method.
static void choose_engine(const arm *a, motion *m, const method_parameters *method,
                          const engine *chosen)
{
    double rho = method->spectral_radius;
    m->electric = a->motor.electric;
    m->wall_moves = wall_moves(&a->wall);
    m->wall_has_face = wall_stands(&a->wall) && wall_has_face(&a->wall);
    m->wall_is_shaken = m->wall_has_face && m->wall_moves;
    m->wall_gives = wall_stands(&a->wall) && wall_gives(&a->wall) && !m->wall_has_face;

    // the engine, and its coefficients
    if (method->name == METHOD_NEWMARK) {
        m->engine = &newmark_engine;
        m->implicit =
            (implicit_coefficients){.beta = method->beta, .gamma = method->gamma};
    } else if (method->name == METHOD_GENERALIZED_ALPHA) {
        m->engine = &generalized_alpha_engine;
        // Chung and Hulbert (1993), equations (17), (18), (25)
        const double alpha_m = (2 * rho - 1) / (rho + 1), alpha_f = rho / (rho + 1);
        const double more = 1 - alpha_m + alpha_f;
        m->implicit = (implicit_coefficients){alpha_m, alpha_f, 0.25 * more * more,
                                              0.5 - alpha_m + alpha_f};
    } else {
        static const engine *const named[] = {[ENGINE_AUTO] = NULL,
                                              [ENGINE_PAIR] = &taylor_engine,
                                              [ENGINE_STIFF] = &stiff_engine};
        const engine *wanted = chosen != NULL ? chosen : named[method->engine];
        if (wanted != NULL) {
            m->engine = wanted;
        } else {
            m->engine = event_engine(a);
        }
        m->chosen = wanted != NULL;
        m->tolerance = method->tolerance;
    }
}

// Lays out what belongs to the engine.
static void lay_out_engine(const arm *a, motion *m, layout *l)
{
    const engine *e = m->engine;
    const size_t state = (size_t)m->size * sizeof(double);
    m->memory = layout_add(l, e->init(a, NULL));
    m->between = layout_add(l, e->states_at != NULL ? MOTION_TOGETHER * state : state);
}

// Lays out everything else.
static void lay_out_motion(const arm *a, motion *m, layout *l)
{
    const size_t state = (size_t)m->most_size * sizeof(double);
    m->state = layout_add(l, state);
    m->trial = layout_add(l, state);
    m->scratch = layout_add(l, 4 * (size_t)a->dof * sizeof(double));
    m->links = layout_add(l, (size_t)a->links * sizeof(chain_link));
    if (m->wall_moves) {
        m->moved = layout_add(l, sizeof *m->moved);
    } else {
        m->moved = NULL;
    }
}

// Lays out what belongs to a block from its first whole cache line on.
static void lay_out_in(const arm *a, motion *m,
                       void (*lay_out)(const arm *a, motion *m, layout *l), void *block)
{
    const size_t beyond = (uintptr_t)block % CACHE_LINE;
    layout l = {.block = (char *)block + (CACHE_LINE - beyond) % CACHE_LINE};
    lay_out(a, m, &l);
}

// Allocates a zeroed block for what the function lay_out lays out in it; its length, or 0
// if out of memory. With calloc the pages of a large block take no memory until they are
// touched, which with many links most never are.
static size_t open_block(const arm *a, motion *m,
                         void (*lay_out)(const arm *a, motion *m, layout *l),
                         void **block)
{
    layout l = {0};
    lay_out(a, m, &l);
    *block = calloc(1, l.length + CACHE_LINE - 1);
    if (*block == NULL) {
        return 0;
    }
    lay_out_in(a, m, lay_out, *block);
    return l.length;
}

// The engine's storage, ready; false, with nothing allocated, if out of memory.
static bool open_engine(const arm *a, motion *m)
{
    m->engine_length = open_block(a, m, lay_out_engine, &m->engine_block);
    if (m->engine_length > 0) {
        m->engine->init(a, m->memory);
    }
    return m->engine_length > 0;
}

// Whether the storage of a finished motion is enough for the next one, of as many bodies.
static bool storage_fits(const arm *a, const motion *m, const motion *next)
{
    layout l = {0};
    motion sized = *next;
    lay_out_engine(a, &sized, &l);
    return next->engine == m->engine && next->most_size <= m->most_size &&
           next->wall_moves == m->wall_moves && l.length <= m->engine_length;
}

// Makes the storage ready for a run with the same engine. One that keeps its steps in the
// state finds as little of the run before as in new storage.
static void clear_engine(const arm *a, motion *m)
{
    if (m->engine->kept > 0) {
        memset(m->trial, 0, (size_t)m->most_size * sizeof *m->trial);
        memset(m->memory, 0, m->engine->init(a, NULL));
    }
    lay_out_in(a, m, lay_out_engine, m->engine_block);
    m->engine->init(a, m->memory);
}

// How many numbers a state of this arm has with an engine.
static int size_of_states(const arm *a, const motion *m, const engine *e)
{
    return m->head_size + e->kept + e->kept_for_body * a->dof;
}

// The largest such number among the engines that a changed arm may get.
static int most_size(const arm *a, const motion *m)
{
    const bool stays = motion_is_implicit(m) || m->chosen;
    return size_of_states(a, m, stays ? m->engine : &stiff_engine);
}

motion *motion_create(const arm *a, const method_parameters *method)
{
    return motion_create_by(a, method, NULL);
}

motion *motion_create_by(const arm *a, const method_parameters *method,
                         const engine *chosen)
{
    assert(a->dof > 0 && method->step > 0);
    motion *m = calloc(1, sizeof *m);
    if (m == NULL) {
        return NULL;
    }
    m->dof = a->dof;
    m->link_count = a->links;
    m->nominal_step = method->step;
    m->record.tstop = HUGE_VAL;
    m->head_size = SLOT_COUNT + 4 * a->dof + QUADRATURE_COUNT + KEPT_COUNT;
    choose_engine(a, m, method, chosen);
    m->size = size_of_states(a, m, m->engine);
    m->most_size = most_size(a, m);

    // its storage: all of it or none
    if (open_block(a, m, lay_out_motion, &m->block) == 0 || !open_engine(a, m)) {
        motion_destroy(m);
        return NULL;
    }
    return m;
}

motion *motion_renew(motion *m, const arm *a, const method_parameters *method)
{
    assert(m == NULL || (a != NULL && method != NULL && method->step > 0));
    if (m == NULL || m->dof != a->dof || a->links != m->link_count || m->out_of_memory) {
        motion_destroy(m);
        return motion_create(a, method);
    }

    // storage that is large enough can be used again
    motion next = *m;
    next.nominal_step = method->step;
    next.chosen = false;
    next.record = (motion_record){.tstop = HUGE_VAL};
    next.step = (motion_steps){.history_invalid = true};
    choose_engine(a, &next, method, NULL);
    next.most_size = most_size(a, &next);
    if (!storage_fits(a, m, &next)) {
        motion_destroy(m);
        return motion_create(a, method);
    }
    *m = next;
    clear_engine(a, m);
    return m;
}

void motion_destroy(motion *m)
{
    if (m != NULL) {
        free(m->engine_block);
        free(m->block);
        free(m);
    }
}

void motion_follow_arm(const arm *a, motion *m)
{
    assert(a->dof == m->dof);
    const bool stays = motion_is_implicit(m) || m->chosen;
    const engine *wanted = stays ? m->engine : event_engine(a);
    if (wanted == m->engine && !m->out_of_memory) {
        return;
    }
    free(m->engine_block);
    m->step.coming.known = false;
    m->engine = wanted;
    m->size = size_of_states(a, m, wanted);
    m->out_of_memory = !open_engine(a, m);
    motion_end_internal_step(m);

    // it knows nothing yet of the steps to come
    memset(m->state + m->head_size, 0,
           (size_t)(m->size - m->head_size) * sizeof *m->state);
}

// --- copies ----------------------------------------------------------------------------

size_t motion_saved_size(const motion *m)
{
    return sizeof m->record + (size_t)m->most_size * sizeof *m->state;
}

void motion_save(const motion *m, void *bytes)
{
    const size_t size = (size_t)m->size * sizeof *m->state;
    memset(bytes, 0, motion_saved_size(m));
    memcpy(bytes, &m->record, sizeof m->record);
    memcpy((char *)bytes + sizeof m->record, m->state, size);
}

void motion_restore(const arm *a, motion *m, const void *bytes)
{
    motion_follow_arm(a, m);
    memcpy(&m->record, bytes, sizeof m->record);
    memcpy(m->state, (const char *)bytes + sizeof m->record,
           (size_t)m->size * sizeof *m->state);
    motion_invalidate_history(m);
}
