#include "src/tables/control_laws.h"

const control_law_info control_law_table[LAW_COUNT] = {
    [LAW_NONE] = {"none", "no rig: the bare arm under motor.voltage"},
    [LAW_PLUGIN] = {"plugin", "a controller of one's own"},
    [LAW_PROCESS] = {"process", "a program of one's own, in any language"},
#define LAW(name, prefix, word, description) [LAW_##name] = {word, description},
    CONTROL_LAWS(LAW)
#undef LAW
};
