// Values of recipes: texts, numbers, maps and lists, with faults that name their place.
#include "render/figures/recipe_parts.h"

#include <string.h>

#include "src/base/words.h"

const char *recipe_text(recipe_context *c, const tree_node *node, const char *what)
{
    if (!node_is_scalar(node) || node_is_empty(node)) {
        report_node(&c->reader, node, "%s is %s, expected text", what, node_kind_name(node));
        return NULL;
    }
    char *copy = g_strdup(node->text);
    g_ptr_array_add(c->recipe->owned, copy);
    return copy;
}

static bool read_truth(recipe_context *c, const tree_node *node, const char *what)
{
    bool yes = node_is_scalar(node) && strcmp(node->text, "true") == 0;
    if (!yes && !(node_is_scalar(node) && strcmp(node->text, "false") == 0)) {
        report_node(&c->reader, node, "%s is not true or false", what);
    }
    return yes;
}

void recipe_number(recipe_context *c, const tree_node *node, const char *what, double *value)
{
    reader_quantity(&c->reader, node, what, "", value);
}

static bool read_pair(recipe_context *c, const tree_node *node, const char *what, double *a,
                      double *b)
{
    bool pair = node->kind == TREE_LIST && node->first != NULL && node->first->next != NULL &&
                node->first->next->next == NULL;
    if (!pair) {
        report_node(&c->reader, node, "%s is %s, expected two numbers such as [0, 1]", what,
                    node_kind_name(node));
        return false;
    }
    bool first = reader_quantity(&c->reader, node->first, what, "", a);
    return reader_quantity(&c->reader, node->first->next, what, "", b) && first;
}

// Takes the value under a key that was found.
static void take_value(recipe_context *c, const tree_node *node, const recipe_key *key, void *into)
{
    void *field = (char *)into + key->offset, *second = (char *)into + key->second;
    switch (key->kind) {
    case VALUE_OWN:
        key->take(c, node, into);
        break;
    case VALUE_TEXT:
        *(const char **)field = recipe_text(c, node, key->key);
        break;
    case VALUE_TRUTH:
        *(bool *)field = read_truth(c, node, key->key);
        break;
    case VALUE_NUMBER:
        recipe_number(c, node, key->key, field);
        break;
    case VALUE_PAIR:
        read_pair(c, node, key->key, field, second);
        break;
    case VALUE_TAKEN:
        break;
    }
}

void recipe_map(recipe_context *c, const tree_node *map, const char *what, const recipe_key *keys,
                void *into)
{
    if (!reader_expect_map(&c->reader, map, what, keys[0].example)) {
        return;
    }

    for (const tree_node *child = map->first; child != NULL; child = child->next) {
        const char *key = reader_key(&c->reader, map, child);
        const recipe_key *found = NULL;
        nearest_word near = key != NULL ? nearest_begin(key) : (nearest_word){0};
        for (int i = 0; key != NULL && keys[i].key != NULL; i++) {
            nearest_try(&near, keys[i].key);
            found = strcmp(keys[i].key, key) == 0 ? &keys[i] : found;
        }

        if (found != NULL) {
            take_value(c, child, found, into);
        } else if (key != NULL) {
            report_node(&c->reader, child->key, "unknown key '%.60s' in %s, did you mean '%s'?",
                        key, what, near.best != NULL ? near.best : keys[0].key);
        }
    }
}

void recipe_list(recipe_context *c, const tree_node *list, const char *what, recipe_taker *take,
                 void *into)
{
    if (list->kind != TREE_LIST) {
        report_node(&c->reader, list, "%s is %s, expected a list", what, node_kind_name(list));
        return;
    }
    for (const tree_node *item = list->first; item != NULL; item = item->next) {
        take(c, item, into);
    }
}

int recipe_add(recipe_context *c, const tree_node *node, int *count, recipe_room room)
{
    if (*count >= room.most) {
        report_node(&c->reader, node, "%s has more than %d %s", room.holder, room.most,
                    room.things);
        return -1;
    }
    return (*count)++;
}

const tree_node *recipe_child(const tree_node *map, const char *key)
{
    for (const tree_node *child = map->first; child != NULL; child = child->next) {
        if (node_is_scalar(child->key) && strcmp(child->key->text, key) == 0) {
            return child;
        }
    }
    return NULL;
}
