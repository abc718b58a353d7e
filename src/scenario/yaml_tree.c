#include "src/scenario/yaml_tree.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <yaml.h>

typedef struct builder {
    yaml_parser_t parser;
    const char *text; // without a byte order mark
    size_t length;
    int nodes;
    fault *fault;
} builder;

static tree_node *no_node(status code)
{
    (void)code;
    return NULL;
}

// Records a fault and returns NULL, so that it can end any function that makes a node; printf-like.
#define refuse(b, line, column, ...)                                                               \
    no_node(fault_set_place((b)->fault, STATUS_BAD_SCENARIO, line, column, __VA_ARGS__))

static tree_node *refuse_at(builder *b, yaml_mark_t mark, const char *sentence)
{
    return refuse(b, (int)mark.line + 1, (int)mark.column + 1, "%s", sentence);
}

static tree_node *refuse_for_memory(builder *b)
{
    fault_set_place(b->fault, STATUS_NO_MEMORY, 1, 1, "%s", status_text(STATUS_NO_MEMORY));
    return NULL;
}

// Refuses at a byte of the text; a column counts characters, that is, bytes that begin one.
static tree_node *refuse_at_byte(builder *b, size_t offset, const char *sentence)
{
    int line = 1, column = 1;
    for (size_t i = 0; i < offset && i < b->length; i++) {
        bool new_line = b->text[i] == '\n' ||
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

// The byte that a mark points at, 0 at the end; a mark counts characters, the text is in bytes.
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
static tree_node *refuse_syntax(builder *b)
{
    const yaml_parser_t *p = &b->parser;
    const char *problem = p->problem != NULL ? p->problem : "unknown problem";
    int line = (int)p->problem_mark.line + 1, column = (int)p->problem_mark.column + 1;

    // no fault of the file's; then what is no text, and a tab, which the parser's words do not
    // explain
    if (p->error == YAML_MEMORY_ERROR) {
        return refuse_for_memory(b);
    }
    if (p->error == YAML_READER_ERROR) {
        char sentence[256];
        snprintf(sentence, sizeof sentence, "not text in UTF-8: %s, expected a YAML file", problem);
        return refuse_at_byte(b, p->problem_offset, sentence);
    }
    if (byte_at(b, p->problem_mark) == '\t') {
        return refuse(b, line, column, "a tab, expected spaces for indentation");
    }

    // the parser's words, with what it was in the middle of
    if (p->context != NULL) {
        return refuse(b, line, column, "not valid YAML: %s, %s that began at line %d", problem,
                      p->context, (int)p->context_mark.line + 1);
    }
    return refuse(b, line, column, "not valid YAML: %s", problem);
}

// The next event; false (and nothing to delete) after an error.
static bool next_event(builder *b, yaml_event_t *event)
{
    if (!yaml_parser_parse(&b->parser, event)) {
        refuse_syntax(b);
        return false;
    }
    return true;
}

// What a scenario may not use although YAML has it, as a sentence, or NULL.
static const char *forbidden(const yaml_event_t *event)
{
    const void *anchor = NULL, *tag = NULL;

    // where the parser keeps both depends on the kind of event
    switch (event->type) {
    case YAML_ALIAS_EVENT:
        return "an alias (*name) is not allowed here, expected the value itself";
    case YAML_SCALAR_EVENT:
        anchor = event->data.scalar.anchor;
        tag = event->data.scalar.tag;
        break;
    case YAML_SEQUENCE_START_EVENT:
        anchor = event->data.sequence_start.anchor;
        tag = event->data.sequence_start.tag;
        break;
    case YAML_MAPPING_START_EVENT:
        anchor = event->data.mapping_start.anchor;
        tag = event->data.mapping_start.tag;
        break;
    default:
        break;
    }

    if (anchor != NULL) {
        return "an anchor (&name) is not allowed here, expected the value alone";
    }
    if (tag != NULL) {
        return "a tag (!name) is not allowed here, expected the value alone";
    }
    return NULL;
}

// An empty node; NULL, after a fault, if there are too many or there is no memory.
static tree_node *new_node(builder *b, tree_kind kind, yaml_mark_t mark)
{
    if (++b->nodes > TREE_MAX_NODES) {
        char sentence[96];
        snprintf(sentence, sizeof sentence, "too many keys and values, expected at most %d",
                 TREE_MAX_NODES);
        return refuse_at(b, mark, sentence);
    }

    tree_node *node = calloc(1, sizeof *node);
    if (node == NULL) {
        return refuse_for_memory(b);
    }
    node->kind = kind;
    node->line = (int)mark.line + 1;
    node->column = (int)mark.column + 1;
    return node;
}

static tree_node *build_scalar(builder *b, const yaml_event_t *event)
{
    const char *value = (const char *)event->data.scalar.value;
    size_t length = event->data.scalar.length;
    if (memchr(value, '\0', length) != NULL) {
        return refuse_at(b, event->start_mark, "a NUL character, expected text without it");
    }

    tree_node *node = new_node(b, TREE_SCALAR, event->start_mark);
    if (node == NULL) {
        return NULL;
    }
    node->plain = event->data.scalar.style == YAML_PLAIN_SCALAR_STYLE;
    node->text = strndup(value, length);
    if (node->text == NULL) {
        tree_free(node);
        return refuse_for_memory(b);
    }
    return node;
}

static tree_node *build(builder *b, const yaml_event_t *event, int depth);

// Reads the children of a map or list up to its end event.
static bool build_children(builder *b, tree_node *parent, int depth)
{
    tree_node **link = &parent->first;
    tree_node *key = NULL;
    for (;;) {
        yaml_event_t event;
        if (!next_event(b, &event)) {
            break;
        }

        // the end, or a child with all that is below it
        if (event.type == YAML_MAPPING_END_EVENT || event.type == YAML_SEQUENCE_END_EVENT) {
            yaml_event_delete(&event);
            return true;
        }
        tree_node *child = build(b, &event, depth);
        yaml_event_delete(&event);
        if (child == NULL) {
            break;
        }

        // in a map every other node is the key of the one that follows
        if (parent->kind == TREE_MAP && key == NULL) {
            key = child;
            continue;
        }
        child->key = key;
        key = NULL;
        *link = child;
        link = &child->next;
    }
    tree_free(key);
    return false;
}

// The node that begins with an event, and what is below it.
static tree_node *build(builder *b, const yaml_event_t *event, int depth)
{
    const char *reason = forbidden(event);
    if (reason != NULL) {
        return refuse_at(b, event->start_mark, reason);
    }
    if (event->type == YAML_SCALAR_EVENT) {
        return build_scalar(b, event);
    }

    // a list or a map, not so deep that the recursion exhausts the stack

    if (depth >= TREE_MAX_DEPTH) {
        char sentence[96];
        snprintf(sentence, sizeof sentence, "nested too deeply, expected at most %d levels",
                 TREE_MAX_DEPTH);
        return refuse_at(b, event->start_mark, sentence);
    }

    tree_kind kind = event->type == YAML_MAPPING_START_EVENT ? TREE_MAP : TREE_LIST;
    tree_node *node = new_node(b, kind, event->start_mark);
    if (node != NULL && !build_children(b, node, depth + 1)) {
        tree_free(node);
        return NULL;
    }
    return node;
}

// Reads stream start, document start, the root, and makes sure that nothing follows.
static tree_node *build_document(builder *b)
{
    tree_node *root = NULL;
    for (;;) {
        yaml_event_t event;
        if (!next_event(b, &event)) {
            break;
        }

        // one document with one root
        yaml_event_type_t type = event.type;
        bool good = true;
        if (type == YAML_DOCUMENT_START_EVENT && root != NULL) {
            refuse_at(b, event.start_mark, "a second document, expected one per file");
            good = false;
        } else if (type == YAML_STREAM_END_EVENT && root == NULL) {
            refuse(b, 1, 1, "the file is empty, expected keys such as 'title: ...'");
            good = false;
        } else if (type != YAML_STREAM_START_EVENT && type != YAML_STREAM_END_EVENT &&
                   type != YAML_DOCUMENT_START_EVENT && type != YAML_DOCUMENT_END_EVENT) {
            root = build(b, &event, 0);
            good = root != NULL;
        }
        yaml_event_delete(&event);

        if (!good) {
            break;
        }
        if (type == YAML_STREAM_END_EVENT) {
            return root;
        }
    }

    tree_free(root);
    return NULL;
}

tree_node *tree_parse(const char *text, size_t length, fault *f)
{
    assert(text != NULL && f != NULL);
    builder b = {.text = text, .length = length, .fault = f};
    if (length > TREE_MAX_BYTES) {
        return refuse(&b, 1, 1, "the file is larger than %d bytes, expected a scenario",
                      TREE_MAX_BYTES);
    }

    // a byte order mark would shift every column of the first line
    if (length >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0) {
        b.text += 3;
        b.length -= 3;
    }

    // the parser looks for nothing but UTF-8
    if (!yaml_parser_initialize(&b.parser)) {
        return refuse_for_memory(&b);
    }
    yaml_parser_set_encoding(&b.parser, YAML_UTF8_ENCODING);
    yaml_parser_set_input_string(&b.parser, (const unsigned char *)b.text, b.length);
    tree_node *root = build_document(&b);
    yaml_parser_delete(&b.parser);
    return root;
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
