// The keys of the terminal lab: what each carries out, and how the prompt, the list and the pages
// take them.
#include <limits.h>
#include <string.h>

#include "ui/explorer/lab.h"

bool lab_keys(lab *l, const char *text, fault *f)
{
    while (*text != '\0' && !l->quit) {
        const char *close = *text == '<' ? strchr(text, '>') : NULL;
        if (close == NULL) {
            bool plain = (unsigned char)*text < 0x80;
            lab_key(l, plain ? *text++ : (int)glyph_decode(&text));
            continue;
        }
        int key = lab_key_of(text + 1, (size_t)(close - text - 1));
        if (key == 0) {
            fault_set(f, STATUS_BAD_ARGUMENT, "there is no key '%.*s'", (int)(close - text + 1),
                      text);
            return false;
        }
        lab_key(l, key);
        text = close + 1;
    }
    return true;
}

// Puts a character at a text's end or takes the last one off. False if the key does neither.
static bool type(char *text, int key)
{
    size_t length = strlen(text);
    if (key == KEY_CODE_BACKSPACE || key == 127 || key == 8) {
        while (length > 0 && (text[length - 1] & 0xc0) == 0x80) {
            length--;
        }
        text[length > 0 ? length - 1 : 0] = '\0';
        return true;
    }
    if (key == ('u' & 0x1f)) {
        text[0] = '\0';
        return true;
    }
    if (key < ' ' || key >= KEY_CODE_FIRST || length + 5 >= LAB_TEXT) {
        return false;
    }
    glyph_encode((uint32_t)key, text + length);
    return true;
}

// The i-th control law, then "off"; NULL beyond it.
static const char *law_name(int i)
{
    return i < LAW_COUNT ? control_law_table[i].word : i == LAW_COUNT ? "off" : NULL;
}

// Candidates for the word that is being typed: the i-th, or NULL.
static const char *candidate(lab *l, const char *command, int i)
{
    if (command == NULL) {
        return lab_command_name(i);
    }
    if (strcmp(command, "set") == 0) {
        return i < parameter_count ? parameter_table[i].path : NULL;
    }
    if (strcmp(command, "trace") == 0) {
        return i < signal_count ? signal_table[i].name : NULL;
    }
    if (strcmp(command, "law") == 0) {
        return law_name(i);
    }
    if (strcmp(command, "lock") == 0) {
        static const char *const others[] = {"next", "off"};
        int modes = lab_law_modes(l)->count;
        return i < modes ? l->modes.names[i] : i < modes + 2 ? others[i - modes] : NULL;
    }
    if (strcmp(command, "open") == 0) {
        return i < l->name_count ? l->names[i] : NULL;
    }
    return NULL;
}

// Completes the prompt's last word as far as its candidates agree, and lists them.
static void complete(lab *l)
{
    char *space = strrchr(l->prompt, ' '), *word = space ? space + 1 : l->prompt;
    char command[32] = "", common[LAB_TEXT] = "", listed[512] = "";
    snprintf(command, sizeof command, "%.*s", (int)strcspn(l->prompt, " "), l->prompt);
    const char *name;
    size_t used = 0;
    int count = 0;
    for (int i = 0; (name = candidate(l, space ? command : NULL, i)) != NULL; i++) {
        if (strncmp(name, word, strlen(word)) != 0) {
            continue;
        }
        if (count++ == 0) {
            snprintf(common, sizeof common, "%s", name);
        }
        size_t same = 0;
        while (common[same] != '\0' && common[same] == name[same]) {
            same++;
        }
        common[same] = '\0';
        if (used < sizeof listed) {
            used += (size_t)snprintf(listed + used, sizeof listed - used, "%s ", name);
        }
    }
    if (count == 0) {
        return;
    }
    size_t room = sizeof l->prompt - (size_t)(word - l->prompt);
    snprintf(word, room, "%s%s", common, count == 1 ? " " : "");
    lab_say(l, false, "%s", count > 1 ? listed : "");
}

static void key_in_prompt(lab *l, int key)
{
    char line[LAB_TEXT];
    switch (key) {
    case KEY_CODE_ESCAPE:
    case 'c' & 0x1f:
        l->prompting = false;
        l->message[0] = '\0';
        break;
    case KEY_CODE_ENTER:
    case '\n':
        l->prompting = false;
        l->message[0] = '\0';
        snprintf(line, sizeof line, "%s", l->prompt);
        snprintf(l->history, sizeof l->history, "%s", line);
        lab_carry_out(l, line);
        break;
    case KEY_CODE_TAB:
        complete(l);
        break;
    case KEY_CODE_UP:
        snprintf(l->prompt, sizeof l->prompt, "%s", l->history);
        break;
    default:
        type(l->prompt, key);
    }
}

// The list's selected line moved on to one that the filter lets through.
static void move_in_list(lab *l, int direction)
{
    for (int i = l->scroll + direction; i >= 0 && i < l->name_count; i += direction) {
        if (lab_listed(l, i)) {
            l->scroll = i;
            return;
        }
    }
}

static void key_in_filter(lab *l, int key)
{
    if (key == KEY_CODE_ENTER || key == '\n' || key == KEY_CODE_ESCAPE) {
        l->filtering = false;
    } else {
        type(l->filter, key);
    }
    if (l->scroll < l->name_count && !lab_listed(l, l->scroll)) {
        l->scroll = -1;
        move_in_list(l, 1);
        l->scroll = l->scroll < 0 ? 0 : l->scroll;
    }
}

static void key_in_list(lab *l, int key)
{
    if (l->filtering) {
        key_in_filter(l, key);
    } else if (key == '/') {
        l->filtering = true;
        l->filter[0] = '\0';
    } else if (key == KEY_CODE_UP || key == 'k') {
        move_in_list(l, -1);
    } else if (key == KEY_CODE_DOWN || key == 'j') {
        move_in_list(l, 1);
    } else if (key == KEY_CODE_PAGE_UP || key == KEY_CODE_PAGE_DOWN) {
        for (int i = 0; i < 10; i++) {
            move_in_list(l, key == KEY_CODE_PAGE_UP ? -1 : 1);
        }
    } else if (key == KEY_CODE_ENTER || key == '\n') {
        l->overlay = OVERLAY_NONE;
        if (l->scroll < l->name_count && lab_listed(l, l->scroll)) {
            lab_open(l, l->names[l->scroll]);
        }
    } else if (key == KEY_CODE_ESCAPE || key == 'q' || key == 'o') {
        l->overlay = OVERLAY_NONE;
    }
}

// In help and comparison: scrolling and leaving.
static void key_in_page(lab *l, int key)
{
    // drawing keeps it within the page
    if (key == KEY_CODE_DOWN || key == 'j') {
        l->scroll++;
    } else if (key == KEY_CODE_UP || key == 'k') {
        l->scroll -= l->scroll > 0;
    } else if (key == KEY_CODE_PAGE_DOWN || key == ' ') {
        l->scroll += l->page_lines;
    } else if (key == KEY_CODE_PAGE_UP) {
        l->scroll = l->scroll > l->page_lines ? l->scroll - l->page_lines : 0;
    } else if (key == KEY_CODE_END || key == 'G') {
        l->scroll = INT_MAX / 2;
    } else if (key == KEY_CODE_HOME || key == 'g') {
        l->scroll = 0;
    } else {
        l->overlay = OVERLAY_NONE;
    }
}

static void key_by_table(lab *l, int key)
{
    key = key == '\n' ? KEY_CODE_ENTER : key == 127 || key == 8 ? KEY_CODE_BACKSPACE : key;
    const char *bound = lab_bound_line(l, key);
    if (bound != NULL) {
        // a copy: the command may be one that binds keys
        char line[LAB_TEXT];
        snprintf(line, sizeof line, "%s", bound);
        l->message[0] = '\0';
        lab_carry_out(l, line);
    } else if (key == KEY_CODE_ESCAPE && l->session.computing != NULL) {
        lab_carry_out(l, "stop");
    } else if (key == KEY_CODE_ESCAPE) {
        l->message[0] = '\0';
        l->has_mark = false;
    } else if (key > ' ' && key < KEY_CODE_FIRST && key != 127) {
        char name[8];
        glyph_encode((uint32_t)key, name);
        lab_say(l, true, "'%s' does nothing here, ? lists the keys", name);
    }
}

void lab_key(lab *l, int key)
{
    if (l->prompting) {
        key_in_prompt(l, key);
    } else if (key == ':') {
        l->prompting = true;
        l->prompt[0] = '\0';
        l->message[0] = '\0';
    } else if (l->overlay == OVERLAY_OPEN) {
        key_in_list(l, key);
    } else if (l->overlay != OVERLAY_NONE && key != ('c' & 0x1f)) {
        key_in_page(l, key);
    } else {
        key_by_table(l, key);
    }
}
