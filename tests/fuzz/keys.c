// Keys as lab --keys takes them, made from the table of commands: each command with
// arguments of the kind that its help names and with others, keys by their names, and any
// letters. The lab draws after each piece, cells that a terminal may show; a text with a
// key that is none says so. Files are written into a folder of the target's own.
#include "tests/fuzz/fuzz_lab.h"

#include "src/tables/signals.h"
#include "src/tables/summary.h"
#include "ui/explorer/state/command_list.h"

enum { MOST_PIECES = 24, PIECE = 200 };

// An argument for a command: a word of its help, something that such words stand for, or
// letters.
static void add_argument(source *s, const explorer_command *c, char *text, size_t room)
{
    const size_t used = strlen(text);
    const char *word = c->argument;
    switch (next(s) % 6) {
    case 0:
        return;
    case 1:
        fuzz_letters(s, text + used, 12);
        return;
    case 2: // one of the alternatives
        for (int skip = next(s) % 6; skip > 0 && strchr(word, '|') != NULL; skip--) {
            word = strchr(word, '|') + 1;
        }
        word += *word == '[';
        snprintf(text + used, room - used, "%.*s", (int)strcspn(word, "|]"), word);
        return;
    case 3:
        snprintf(text + used, room - used, "%s",
                 signal_table[next(s) % signal_count].name);
        return;
    case 4:
        snprintf(text + used, room - used, "%s",
                 summary_table[next(s) % summary_count].key);
        return;
    default:
        snprintf(text + used, room - used, "%s",
                 ONE_OF(s, "0.05", "end", "-1", "2", "0", "nan", "1e9", "0.02 0.08",
                        "auto", "off", "next", "up", "motor.voltage 3", "arm.k2=3:5:3",
                        "wall.angle 0.2", "wall.angle 9", "control.law hybrid",
                        "run.duration 0.05", "force gap", "force", "out.csv", "out.yaml",
                        "out.svg", "out.png", "out.txt", "none/out.csv", "1 a name",
                        "x step 5", "x nothing", "F2 set motor.voltage 2", "impact",
                        "hybrid", "1 2", "134", "Control", "2 0.5"));
    }
}

// Whether a command goes through scenarios that take seconds.
static bool is_left_out(const char *command)
{
    char word[64];
    snprintf(word, sizeof word, " %s ", command);
    return strstr(" open find lesson palette extend ", word) != NULL;
}

// The next piece: a command with its argument, a key by its name, or letters.
static void make_piece(source *s, char text[PIECE])
{
    const explorer_command *c;
    text[0] = '\0';
    switch (next(s) % 4) {
    case 0:
        snprintf(text, PIECE, "%s",
                 ONE_OF(s, "<Space>", "<Enter>", "<Esc>", "<Tab>", "<Up>", "<Down>",
                        "<Left>", "<Right>", "<PgUp>", "<S-Up>", "<S-Left>", "<C-r>",
                        "<F1>", "<Home>", "<End>", "<Delete>", "<Backspace>", "<C-l>",
                        "<", "<no key>", "<>"));
        return;
    case 1:
        // not the keys that open scenarios
        fuzz_letters(s, text, 12);
        for (char *at = text; *at != '\0'; at++) {
            *at = strchr("o[]x\x10", *at) != NULL ? ' ' : *at;
        }
        return;
    default:
        c = &explorer_command_table[next(s) % explorer_command_count];
        snprintf(text, PIECE, ":%s ", is_left_out(c->name) ? "undo" : c->name);
        add_argument(s, c, text, PIECE - 10);
        strcat(text, next(s) % 8 == 0 ? "<Esc>" : "<Enter>");
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    source s = {data, size, 0};
    explorer ex;
    screen shown = {0};
    fault f;
    fuzz_folder();
    setenv("XDG_CONFIG_HOME", ".", 1);
    fuzz_open_lab(&ex);

    for (int i = 0; i < MOST_PIECES && s.at < s.size && !ex.input.quit; i++) {
        char piece[PIECE];
        make_piece(&s, piece);
        f = (fault){.code = STATUS_OK};
        const bool pressed = explorer_keys(&ex, piece, &f);
        FUZZ_CHECK(pressed == (f.code == STATUS_OK) && (pressed || f.text[0] != '\0'));
        fuzz_draw(&ex, &shown);
    }
    screen_finish(&shown);
    explorer_finish(&ex);
    return 0;
}
