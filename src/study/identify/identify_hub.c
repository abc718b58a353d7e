// Errors of parameters where a hub may give that the scenario takes for rigid.
//
// A hub that gives or has play does what no command does that was not recorded: the arm
// bends as if its stiffness were less. So a rigid hub is given a spring, and the fit goes
// on with softer and softer ones. The readings speak against a spring where its sum of
// squares is larger than a rigid hub's, and where the residuals are less likely, too, by
// more than chance has it once in 20 times: where twice the logarithm of their likelihood
// (identify_lack.c), of a command and noise of any size, is less by 1.96^2. The way d
// that the parameters go with the softest spring of the others is an error that could be:
// it counts as the 95 % point of an independent one, d d'/1.96^2.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/arm/arm.h"
#include "src/base/numbers.h"
#include "src/scenario/scenario.h"
#include "src/study/identify/identify_lack.h"

// Of the springs of a hub that are tried: the first one's stiffness, in k2, how much the
// next one is softer, and their damping ratio with the hub on them and the beam held.
#define HUB_FIRST   400.0
#define HUB_SOFTER  M_SQRT1_2
#define HUB_DAMPING 0.2

enum {
    HUB_SPRINGS = 9, // that are tried at least,
    HUB_MOST = 18    // and at most, while the readings allow them
};

// A fit that goes on with a spring of the hub.
typedef struct sprung_fit {
    scenario base;
    identification id;
    double x[IDENTIFY_UNKNOWNS]; // its result
    double chi_square;
    double *residual; // with it
} sprung_fit;

// Lists the damping of all joints, the hub's first, then those of the arm. False where
// that is too long.
static bool list_damping(double hub, const arm *a, char list[PARAMETER_VALUE_SIZE])
{
    int length = decimal_print(list, PARAMETER_VALUE_SIZE, "%.6g", hub);
    for (int k = 1; k < a->links && length < PARAMETER_VALUE_SIZE; k++) {
        const size_t room = PARAMETER_VALUE_SIZE - (size_t)length;
        length += decimal_print(list + length, room, ",%.6g", arm_link_of(a, k).damping);
    }
    return a->links <= PARAMETER_LIST_MOST && length < PARAMETER_VALUE_SIZE;
}

// Whether a parameter, or one of its numbers, is fitted.
static bool is_fitted(const identification *id, int parameter)
{
    for (int i = 0; i < id->count; i++) {
        if (id->fit[i].axis.parameter == parameter) {
            return true;
        }
    }
    return false;
}

// Makes the scenario of a fit with the spring k1 of a hub that it takes for rigid. The
// spring is damped, and the other joints are as they were: one that rings makes the sum
// of squares rough. It is not where joints are not damped one by one. Fails where the
// scenario cannot have a spring.
static status give_hub_spring(const identification *id, double k1, scenario *sprung)
{
    const parameters *p = &id->base->parameters;
    const double hub = 2 * HUB_DAMPING * sqrt(k1 * p->arm.hub_inertia);
    char list[PARAMETER_VALUE_SIZE];
    const parameter_change changes[] = {
        {.parameter = PARAMETER_INDEX(arm.hub_joint), .number = HUB_SPRING},
        {.parameter = PARAMETER_INDEX(arm.k1), .number = k1},
        {.parameter = PARAMETER_INDEX(arm.damping_ratio), .number = 0},
        {.parameter = PARAMETER_INDEX(arm.joint_damping), .text = list}};
    size_t count = sizeof changes / sizeof *changes;
    arm rigid;
    arm_init(&rigid, p);
    if (p->arm.modal_ratios[0] != '\0' ||
        is_fitted(id, PARAMETER_INDEX(arm.damping_ratio)) ||
        !list_damping(hub, &rigid, list)) {
        count -= 2;
    }
    return scenario_with(id->base, changes, count, sprung, NULL);
}

// Fits with the spring k1, from the result with the one before it. *possible: the
// scenario can have one.
static status fit_with_spring(sprung_fit *sprung, const identification *rigid, double k1,
                              bool *possible, fault *f)
{
    identification *id = &sprung->id;
    const status made = give_hub_spring(rigid, k1, &sprung->base);
    const bool judge = false;
    if (made == STATUS_NO_MEMORY) {
        return fault_no_memory(f);
    }
    *possible = made == STATUS_OK;
    if (!*possible) {
        return STATUS_OK;
    }
    TRY(identify_minimise(id, sprung->x, &sprung->chi_square, f));
    return identify_evaluate(id, sprung->x, 1, NULL, judge, sprung->residual, NULL, f);
}

// Notes a spring and the parameters with it.
static void note_spring(identification *id, const sprung_fit *sprung, double k1)
{
    double damping[PARAMETER_LINKS_MOST];
    parameters_joint_damping(&sprung->base.parameters.arm, damping);
    id->lack.hub_spring = k1;
    id->lack.hub_damping = damping[0];
    id->lack.chi_square = sprung->chi_square;
    for (int i = 0; i < id->count; i++) {
        id->lack.with_spring[i] = identify_unknown_value(id, i, sprung->x[i]);
    }
}

// Finds whether the readings allow the spring.
static status judge_spring(const identification *rigid, const lack_model *model,
                           const sprung_fit *sprung, bool *allowed, fault *f)
{
    const double chance = IDENTIFY_QUANTILE * IDENTIFY_QUANTILE;
    lack_scales scales;
    if (!lack_find_scales(rigid, model, sprung->residual, &scales)) {
        return fault_no_memory(f);
    }
    *allowed = sprung->chi_square <= rigid->chi_square ||
               scales.unlikelihood <= model->scales.unlikelihood + chance;
    return STATUS_OK;
}

// Looks for the softest spring that the readings allow.
static status find_softest_hub(identification *id, const lack_model *model,
                               sprung_fit *sprung, fault *f)
{
    double k1 = HUB_FIRST * id->base->parameters.arm.k2;
    bool possible, allowed = false;
    for (int i = 0; i < HUB_SPRINGS || (allowed && i < HUB_MOST); i++) {
        TRY(fit_with_spring(sprung, id, k1, &possible, f));
        if (!possible) {
            break;
        }
        TRY(judge_spring(id, model, sprung, &allowed, f));
        if (allowed) {
            note_spring(id, sprung, k1);
        }
        k1 *= HUB_SOFTER;
    }
    return STATUS_OK;
}

// Counts how far a hub with a spring moves the parameters as one more independent error.
static void add_difference(identification *id)
{
    const size_t p = (size_t)id->count;
    double difference[IDENTIFY_PATHS];
    for (size_t i = 0; i < p; i++) {
        difference[i] = (id->lack.with_spring[i] - id->fit[i].value) / id->fit[i].scale;
    }
    for (size_t i = 0; i < p; i++) {
        const double share = difference[i] / (IDENTIFY_QUANTILE * IDENTIFY_QUANTILE);
        identify_add_scaled(id->covariance + i * p, share, difference, p);
    }
}

status lack_allow_for_hub(identification *id, const lack_model *model, fault *f)
{
    if (id->base->parameters.arm.hub_joint != HUB_RIGID ||
        is_fitted(id, PARAMETER_INDEX(arm.joint_damping))) {
        return STATUS_OK;
    }
    SCOPED(free_kept) sprung_fit *sprung = malloc(sizeof *sprung);
    SCOPED(free_kept)
    double *residual = calloc(id->residuals, sizeof *residual);
    if (sprung == NULL || residual == NULL) {
        return fault_no_memory(f);
    }
    sprung->id = *id;
    sprung->id.base = &sprung->base;
    sprung->residual = residual;
    identify_list_unknowns(&sprung->id);
    identify_result(id, sprung->x);
    const status code = find_softest_hub(id, model, sprung, f);
    id->runs = sprung->id.runs;
    if (code == STATUS_OK && !isnan(id->lack.hub_spring)) {
        add_difference(id);
    }
    return code;
}
