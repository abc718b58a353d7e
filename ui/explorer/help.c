// The help page, made from the tables of keys and commands.
#include <string.h>

#include "ui/explorer/lab.h"

// What a group of commands, from the named one on, is about.
static const struct {
    const char *command, *title;
} groups[] = {
    {"play", "Time"},      {"set", "Changing the run"},       {"branch", "Two runs, undo"},
    {"mark", "Looking"},   {"zoom", "Curves and their axes"}, {"open", "Scenarios and files"},
    {"glyphs", "The lab"},
};

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
    lab_help_line *lines;
    int count, most, width;
} page;

static lab_help_line *new_line(page *p)
{
    static lab_help_line beyond;
    lab_help_line *line = p->count < p->most ? &p->lines[p->count++] : &beyond;
    *line = (lab_help_line){0};
    return line;
}

// A text in as many lines as it takes, from a column on; the first line may be begun already.
static void add_text(page *p, int column, const char *text, lab_help_line *begun)
{
    text_line parts[16];
    int room = p->width - column;
    int count = text_wrap(text, room < 1 ? 1 : room, parts, 16, NULL);
    for (int i = 0; i < count; i++) {
        lab_help_line *line = i == 0 && begun != NULL ? begun : new_line(p);
        size_t used = strlen(line->text);
        int blanks = column > (int)used ? column - (int)used : 0;
        int bytes = parts[i].bytes < LAB_TEXT / 2 ? parts[i].bytes : LAB_TEXT / 2;
        if (used < LAB_TEXT / 2) {
            snprintf(line->text + used, LAB_TEXT - used, "%*s%.*s", blanks, "", bytes,
                     parts[i].start);
        }
    }
}

static void add_heading(page *p, const char *title)
{
    if (p->count > 0) {
        new_line(p);
    }
    lab_help_line *line = new_line(p);
    snprintf(line->text, sizeof line->text, "%s", title);
    line->heading = true;
}

// Keys in a column of their own, then what they do; many keys take a line for themselves.
static void add_entry(page *p, int column, const char *keys, const char *text)
{
    lab_help_line *line = new_line(p);
    snprintf(line->text, sizeof line->text, "%s", keys);
    line->keys = (int)strlen(keys);
    add_text(p, column, text, line->keys + 1 < column ? line : NULL);
}

int lab_write_help(const lab *l, int width, lab_help_line *lines, int most)
{
    page p = {lines, 0, most, width};
    const char *name, *argument, *help;
    // wide enough: keys, call and meaning are three columns; else the call goes before the meaning
    bool wide = width >= 96;
    int column = wide ? 26 : width >= 60 ? 20 : 12;
    add_text(&p, 0, first_visit, NULL);
    new_line(&p);
    add_text(&p, 0, everywhere, NULL);
    for (int i = 0; (name = lab_command_help(i, &argument, &help)) != NULL; i++) {
        char keys[64], call[64], text[LAB_TEXT];
        for (size_t g = 0; g < sizeof groups / sizeof groups[0]; g++) {
            if (strcmp(groups[g].command, name) == 0) {
                add_heading(&p, groups[g].title);
            }
        }
        lab_keys_of(l, name, keys, sizeof keys);
        snprintf(call, sizeof call, ":%s%s%s", name, argument[0] ? " " : "", argument);
        snprintf(text, sizeof text, wide ? "%-32s %s" : "%s  %s", call, help);
        add_entry(&p, column, keys, text);
    }
    for (int i = 0; i < l->user_key_count; i++) {
        const lab_user_key *own = &l->user_keys[i];
        const char *before = lab_overridden_line(own);
        char key[16], text[2 * LAB_TEXT + 32];
        if (i == 0) {
            add_heading(&p, "Keys of your own");
        }
        lab_key_name(own->key, key, sizeof key);
        snprintf(text, sizeof text, "%s%s%s%s", own->line[0] ? own->line : "nothing",
                 before ? " (the lab's: " : "", before ? before : "", before ? ")" : "");
        add_entry(&p, column, key, text);
    }
    new_line(&p);
    add_text(&p, 0, mouse, NULL);
    return p.count;
}
