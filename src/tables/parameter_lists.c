// Parameters that are lists of numbers, and what of the arm they give.
#include <assert.h>
#include <stdlib.h>

#include "src/base/numbers.h"
#include "src/tables/parameters.h"

int parameter_list_numbers(const char *list, double numbers[PARAMETER_LIST_MOST])
{
    assert(list != NULL && numbers != NULL);
    int count = 0;

    // the text is canonical: numbers with commas between them
    while (*list != '\0') {
        char *end;
        assert(count < PARAMETER_LIST_MOST);
        numbers[count++] = decimal_parse(list, &end);
        assert(end > list);
        list = end + (*end == ',');
    }
    return count;
}

void parameters_link_lengths(const arm_parameters *a, double *lengths)
{
    assert(a != NULL && a->links > 0 && lengths != NULL);
    double listed[PARAMETER_LIST_MOST];
    const int count = parameter_list_numbers(a->link_lengths, listed);
    for (int k = 0; k < a->links; k++) {
        lengths[k] = count == a->links ? listed[k] : a->length / a->links;
    }
}

void parameters_joint_stiffness(const arm_parameters *a, double *stiffness)
{
    assert(a != NULL && a->links > 0 && stiffness != NULL);
    double listed[PARAMETER_LIST_MOST], length[PARAMETER_LIST_MOST];
    const bool beam = a->hub_joint == HUB_BEAM;
    const int count = parameter_list_numbers(a->joint_stiffness, listed);

    // the root of its own, and what the list says; else the beam between the middles of two links
    stiffness[0] = a->hub_joint == HUB_RIGID ? 0 : beam && count > 0 ? listed[0] : a->k1;
    if (a->link_lengths[0] != '\0') {
        parameters_link_lengths(a, length);
    }
    for (int k = 1; k < a->links; k++) {
        stiffness[k] = count > 0                    ? listed[beam ? k : k - 1]
                       : a->link_lengths[0] != '\0' ? a->EI / ((length[k - 1] + length[k]) / 2)
                                                    : a->k2 * a->links / 2;
    }
}

bool parameters_even_links(const arm_parameters *a)
{
    assert(a != NULL && a->links > 0);
    double length[PARAMETER_LIST_MOST], stiffness[PARAMETER_LIST_MOST];
    if (a->joint_stiffness[0] == '\0' && a->link_lengths[0] == '\0') {
        return true;
    }

    // the root is half a joint
    parameters_link_lengths(a, length);
    parameters_joint_stiffness(a, stiffness);
    const double joint = stiffness[a->links - 1];
    bool even = a->links == 1 || a->hub_joint != HUB_BEAM || stiffness[0] / 2 == joint;
    for (int k = 1; k < a->links; k++) {
        even = even && length[k] == length[0] && stiffness[k] == joint;
    }
    return even;
}
