#include "ui/explorer/panels/help_text.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>

#include "ui/explorer/state/command_list.h"
#include "ui/terminal/screen.h"

static const char first_visit[] =
    "A first visit: o lists the scenarios. Watch the arm bounce, Space stops it. I goes back to "
    "just "
    "before it touched, PgUp further. b keeps this run, Enter types another voltage from here on, "
    "Space plays on beside the old run, c compares their peaks, s saves a figure of both.";
static const char everywhere[] = "Esc goes back one level. : takes a command, Tab completes it, "
                                 "the beginning of a name will do.";
static const char mouse[] =
    "Mouse: click or drag in the curves to move the cursor, the wheel zooms there, Shift-wheel "
    "pans. Drag the time axis or an axis of values to move it, turn the wheel on it too. Click an "
    "event, a parameter or a scenario (once more opens it); drag a slider and let go. Shift-drag "
    "selects text in most terminals.";

// A page that is being written.
typedef struct page {
    help_line *lines;
    int count, most, width;
    int column; // where meanings begin, behind the keys
} page;

static help_line *new_line(page *p)
{
    static help_line beyond;
    help_line *line = p->count < p->most ? &p->lines[p->count++] : &beyond;
    *line = (help_line){0};
    return line;
}

// A text in as many lines as it takes, from a column on; the first line may be begun already.
static void add_text(page *p, int column, const char *text, help_line *begun)
{
    text_line parts[16];
    int room = p->width - column;
    int count = text_wrap(text, room < 1 ? 1 : room, parts, 16, NULL);

    // the first part may go on in the begun line, the others have lines of their own
    for (int i = 0; i < count; i++) {
        help_line *line = i == 0 && begun != NULL ? begun : new_line(p);
        size_t used = strlen(line->text);
        int blanks = column > (int)used ? column - (int)used : 0;
        int bytes = parts[i].bytes < LINE_TEXT / 2 ? parts[i].bytes : LINE_TEXT / 2;
        if (used < LINE_TEXT / 2) {
            snprintf(line->text + used, LINE_TEXT - used, "%*s%.*s", blanks, "", bytes,
                     parts[i].start);
        }
    }
}

static void add_heading(page *p, const char *title)
{
    if (p->count > 0) {
        new_line(p);
    }
    help_line *line = new_line(p);
    snprintf(line->text, sizeof line->text, "%s", title);
    line->heading = true;
}

// Keys in a column of their own, then what they do; many keys take a line for themselves.
static void add_entry(page *p, const char *keys, const char *text)
{
    help_line *line = new_line(p);
    snprintf(line->text, sizeof line->text, "%s", keys);
    line->keys = (int)strlen(keys);
    add_text(p, p->column, text, line->keys + 1 < p->column ? line : NULL);
}

// What the commands do, in groups, with the keys that carry each out.
static void add_commands(page *p, const key_bindings *b)
{
    // wide enough: keys, call and meaning are three columns; else the call goes before the meaning
    bool wide = p->width >= 96;

    // a group's heading before its first command
    for (int i = 0; i < explorer_command_count; i++) {
        const explorer_command *c = &explorer_command_table[i];
        char keys[64], call[64], text[LINE_TEXT];
        if (c->group[0] != '\0') {
            add_heading(p, c->group);
        }
        key_names_of(b, c->name, keys, sizeof keys);
        snprintf(call, sizeof call, ":%s%s%s", c->name, c->argument[0] ? " " : "", c->argument);
        snprintf(text, sizeof text, wide ? "%-32s %s" : "%s  %s", call, c->help);
        add_entry(p, keys, text);
    }
}

static void add_user_keys(page *p, const key_bindings *b)
{
    for (int i = 0; i < b->count; i++) {
        const user_key *own = &b->own[i];
        const char *before = key_built_in_line(own->key);
        char key[KEY_NAME], text[2 * LINE_TEXT + 32];

        // no heading without a key below it
        if (i == 0) {
            add_heading(p, "Keys of your own");
        }

        // what the key does now, and what it did before
        key_name(own->key, key, sizeof key);
        snprintf(text, sizeof text, "%s%s%s%s", own->line[0] ? own->line : "nothing",
                 before ? " (the lab's: " : "", before ? before : "", before ? ")" : "");
        add_entry(p, key, text);
    }
}

int help_write(const key_bindings *b, int width, help_line *lines, int most)
{
    assert(b != NULL && lines != NULL && most > 0);
    page p = {.lines = lines, .most = most, .width = width};
    p.column = width >= 96 ? 26 : width >= 60 ? 20 : 12;
    add_text(&p, 0, first_visit, NULL);
    new_line(&p);
    add_text(&p, 0, everywhere, NULL);
    add_commands(&p, b);
    add_user_keys(&p, b);
    new_line(&p);
    add_text(&p, 0, mouse, NULL);
    return p.count;
}
