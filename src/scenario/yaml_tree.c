#include "src/scenario/yaml_tree.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <yaml.h>

// A map or list that the parser is within: its node, a key whose value is still to come
// (NULL: none), and the link that the next child is put into.
typedef struct open_node {
    tree_node *node, *key, **link;
} open_node;

typedef struct builder {
    yaml_parser_t parser;
    const char *text; // without a byte order mark
    size_t length;
    int nodes; // made so far
    tree_node *root;
    open_node open[TREE_MAX_DEPTH]; // the maps and lists that are open, outermost first
    int depth;                      // how many are open
    fault *fault;
} builder;

// Records a fault; printf-like. Always false.
#define refuse(b, line, column, ...)                                                     \
    (fault_set_place((b)->fault, STATUS_BAD_SCENARIO, line, column, __VA_ARGS__) ==      \
     STATUS_OK)
#define refuse_at(b, mark, ...)                                                          \
    refuse(b, (int)(mark).line + 1, (int)(mark).column + 1, __VA_ARGS__)

// Records that there is no memory. Always false.
static bool refuse_for_memory(const builder *b)
{
    fault_set_place(b->fault, STATUS_NO_MEMORY, 1, 1, "%s",
                    status_text(STATUS_NO_MEMORY));
    return false;
}

// Records a fault at a byte of the text. Lines end with \n, \r or both. Columns count
// characters: bytes 10xxxxxx of UTF-8 continue one and are not counted.
static bool refuse_at_byte(const builder *b, size_t offset, const char *sentence)
{
    int line = 1, column = 1;
    for (size_t i = 0; i < offset && i < b->length; i++) {
        bool new_line =
            b->text[i] == '\n' ||
            (b->text[i] == '\r' && (i + 1 == b->length || b->text[i + 1] != '\n'));
        if (new_line) {
            line++;
            column = 1;
        } else if (((unsigned char)b->text[i] & 0xc0) != 0x80) {
            column++;
        }
    }
    return refuse(b, line, column, "%s", sentence);
}

// The byte of the text that a mark of the parser points at; 0 at the end. A mark is an
// index of characters, so that bytes which continue one are not counted.
static char byte_at(const builder *b, yaml_mark_t mark)
{
    size_t characters = 0;
    for (size_t i = 0; i < b->length; i++) {
        if (((unsigned char)b->text[i] & 0xc0) != 0x80 && characters++ == mark.index) {
            return b->text[i];
        }
    }
    return '\0';
}

// Turns the parser's own error into a fault.
static bool refuse_syntax(const builder *b)
{
    const yaml_parser_t *p = &b->parser;
    const char *problem = p->problem != NULL ? p->problem : "unknown problem";
    int line = (int)p->problem_mark.line + 1, column = (int)p->problem_mark.column + 1;

    // no fault of the file's; then what is no text, and a tab, which the parser's words
    // do not explain
    if (p->error == YAML_MEMORY_ERROR) {
        return refuse_for_memory(b);
    }
    if (p->error == YAML_READER_ERROR) {
        char sentence[256];
        snprintf(sentence, sizeof sentence, "not text in UTF-8: %s, expected a YAML file",
                 problem);
        return refuse_at_byte(b, p->problem_offset, sentence);
    }
    if (byte_at(b, p->problem_mark) == '\t') {
        return refuse(b, line, column, "a tab, expected spaces for indentation");
    }

    // the parser's words, with what it was in the middle of
    if (p->context != NULL) {
        return refuse(b, line, column, "not valid YAML: %s, %s that began at line %d",
                      problem, p->context, (int)p->context_mark.line + 1);
    }
    return refuse(b, line, column, "not valid YAML: %s", problem);
}

// The sentence for a feature of YAML that scenarios may not use: an alias, an anchor or a
// tag. NULL if the event has none of them.
static const char *forbidden(const yaml_event_t *event)
{
    // events of scalars, lists and maps begin with the same fields, anchor and tag
    if (event->type == YAML_ALIAS_EVENT) {
        return "an alias (*name) is not allowed here, expected the value itself";
    }
    if (event->data.scalar.anchor != NULL) {
        return "an anchor (&name) is not allowed here, expected the value alone";
    }
    if (event->data.scalar.tag != NULL) {
        return "a tag (!name) is not allowed here, expected the value alone";
    }
    return NULL;
}

// The kind of node that begins with an event.
static tree_kind kind_of_event(const yaml_event_t *event)
{
    if (event->type == YAML_SCALAR_EVENT) {
        return TREE_SCALAR;
    }
    if (event->type == YAML_MAPPING_START_EVENT) {
        return TREE_MAP;
    }
    return TREE_LIST;
}

// Makes the node that begins with an event, with nothing below it yet. False after a
// fault.
static bool make_node(builder *b, const yaml_event_t *event, tree_node **made)
{
    const bool scalar = event->type == YAML_SCALAR_EVENT;
    const char *value = scalar ? (const char *)event->data.scalar.value : "";
    const size_t length = scalar ? event->data.scalar.length : 0;

    // what is not allowed, and limits
    const char *reason = forbidden(event);
    if (reason != NULL) {
        return refuse_at(b, event->start_mark, "%s", reason);
    }
    if (memchr(value, '\0', length) != NULL) {
        return refuse_at(b, event->start_mark,
                         "a NUL character, expected text without it");
    }
    if (!scalar && b->depth >= TREE_MAX_DEPTH) {
        return refuse_at(b, event->start_mark,
                         "nested too deeply, expected at most %d levels", TREE_MAX_DEPTH);
    }
    if (++b->nodes > TREE_MAX_NODES) {
        return refuse_at(b, event->start_mark,
                         "too many keys and values, expected at most %d", TREE_MAX_NODES);
    }

    // the node, with a copy of its text
    tree_node *node = calloc(1, sizeof *node);
    char *text = node != NULL && scalar ? strndup(value, length) : NULL;
    if (node == NULL || (scalar && text == NULL)) {
        free(node);
        return refuse_for_memory(b);
    }
    *node = (tree_node){.kind = kind_of_event(event),
                        .line = (int)event->start_mark.line + 1,
                        .column = (int)event->start_mark.column + 1,
                        .plain =
                            scalar && event->data.scalar.style == YAML_PLAIN_SCALAR_STYLE,
                        .text = text};
    *made = node;
    return true;
}

// Adds a node to the innermost open map or list, or as the root. A node that is a map or
// list is then open itself.
static void add_node(builder *b, tree_node *node)
{
    open_node *parent = b->depth > 0 ? &b->open[b->depth - 1] : NULL;
    if (parent == NULL) {
        b->root = node;
    } else if (parent->node->kind == TREE_MAP && parent->key == NULL) {
        // in a map every other node is the key of the one that follows
        parent->key = node;
    } else {
        node->key = parent->key;
        parent->key = NULL;
        *parent->link = node;
        parent->link = &node->next;
    }
    if (node->kind != TREE_SCALAR) {
        b->open[b->depth++] = (open_node){.node = node, .link = &node->first};
    }
}

// Takes the next event of the parser into the tree. False after a fault.
static bool take_event(builder *b, const yaml_event_t *event)
{
    tree_node *node = NULL;
    switch (event->type) {
    case YAML_STREAM_START_EVENT:
    case YAML_DOCUMENT_END_EVENT:
        return true;
    case YAML_DOCUMENT_START_EVENT:
        return b->root == NULL || refuse_at(b, event->start_mark,
                                            "a second document, expected one per file");
    case YAML_STREAM_END_EVENT:
        return b->root != NULL ||
               refuse(b, 1, 1, "the file is empty, expected keys such as 'title: ...'");
    case YAML_SEQUENCE_END_EVENT:
    case YAML_MAPPING_END_EVENT:
        b->depth--;
        return true;
    default:
        if (make_node(b, event, &node)) {
            add_node(b, node);
        }
        return node != NULL;
    }
}

// Builds the tree from all events of the parser; NULL after a fault.
static tree_node *build_document(builder *b)
{
    // one event after the other
    bool good = true, ended = false;
    while (good && !ended) {
        yaml_event_t event;
        if (yaml_parser_parse(&b->parser, &event)) {
            good = take_event(b, &event);
            ended = event.type == YAML_STREAM_END_EVENT;
            yaml_event_delete(&event);
        } else {
            good = refuse_syntax(b);
        }
    }
    if (good) {
        return b->root;
    }

    // keys that wait for their value are not in the tree yet
    for (int i = 0; i < b->depth; i++) {
        tree_free(b->open[i].key);
    }
    tree_free(b->root);
    return NULL;
}

tree_node *tree_parse(const char *text, size_t length, fault *f)
{
    builder b = {.text = text, .length = length, .fault = f};
    if (length > TREE_MAX_BYTES) {
        (void)refuse(&b, 1, 1, "the file is larger than %d bytes, expected a scenario",
                     TREE_MAX_BYTES);
        return NULL;
    }

    // a byte order mark would shift every column of the first line
    if (length >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0) {
        b.text += 3;
        b.length -= 3;
    }

    // the parser looks for nothing but UTF-8
    if (!yaml_parser_initialize(&b.parser)) {
        refuse_for_memory(&b);
        return NULL;
    }
    yaml_parser_set_encoding(&b.parser, YAML_UTF8_ENCODING);
    yaml_parser_set_input_string(&b.parser, (const unsigned char *)b.text, b.length);
    tree_node *root = build_document(&b);
    yaml_parser_delete(&b.parser);
    return root;
}

tree_node *tree_child(const tree_node *map, const char *key)
{
    tree_node *child = map->first;
    while (child != NULL &&
           (child->key->kind != TREE_SCALAR || strcmp(child->key->text, key) != 0)) {
        child = child->next;
    }
    return child;
}

void tree_free(tree_node *node)
{
    while (node != NULL) {
        tree_node *next = node->next;
        tree_free(node->key);
        tree_free(node->first);
        free(node->text);
        free(node);
        node = next;
    }
}
