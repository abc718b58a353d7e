// The signals that a scenario is to be looked at by.
#include "src/scenario/reader.h"

#include "src/tables/signals.h"

void reader_panes(reader *r, const tree_node *list)
{
    if (list->kind != TREE_LIST) {
        report_node(r, list, "panes is %s, expected a list of signals: [force, hub_angle]",
                    node_kind_name(list));
        return;
    }

    for (const tree_node *child = list->first; child != NULL; child = child->next) {
        const int signal = node_is_scalar(child) ? signal_find(child->text) : -1;
        if (signal < 0) {
            report_node(r, child, "panes: there is no signal '%.60s'",
                        node_is_scalar(child) ? child->text : node_kind_name(child));
        } else if (r->s->pane_count == SCENARIO_PANES) {
            report_node(r, child, "panes: more than %d signals", SCENARIO_PANES);
            return;
        } else {
            r->s->panes[r->s->pane_count++] = signal;
        }
    }
}
