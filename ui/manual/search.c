#include "ui/manual/search.h"

#include <assert.h>
#include <ctype.h>
#include <math.h>
#include <string.h>

#include "src/base/words.h"

enum { WORDS = 16, WORD = 32 };

// Okapi BM25: how fast further occurrences of a word stop to count, how much a long text needs more
// of them, and how many occurrences one in a title of one word is worth, in a longer one by the
// root of its length less.
static const double SATURATION = 1.2;
static const double LENGTH_SHARE = 0.6;
static const double USUAL_LENGTH = 60;
static const double TITLE_WEIGHT = 12;
static const double ABOVE_WEIGHT = 2;

// The words that a question is about, each once.
typedef struct question_words {
    char words[WORDS][WORD];
    int count;
    double weight[WORDS]; // the rarer a word is, the more it says
} question_words;

// How often each of them occurs somewhere, and how many words there are in all.
typedef struct occurrences {
    double of[WORDS];
    double length;
} occurrences;

static bool is_word_byte(char c)
{
    return isalnum((unsigned char)c) || (unsigned char)c >= 0x80;
}

// Takes an ending off if at least three letters are left.
static bool take_ending(char *word, const char *ending, const char *instead)
{
    const size_t length = strlen(word), end = strlen(ending);
    if (length < end + 3 || strcmp(word + length - end, ending) != 0) {
        return false;
    }
    strcpy(word + length - end, instead);
    return true;
}

// "settling", "settled", "settles" and "settle" become one word.
static void take_endings(char *word)
{
    if (!take_ending(word, "ies", "y") && !take_ending(word, "ss", "ss")) {
        take_ending(word, "s", "");
    }
    if (!take_ending(word, "ing", "")) {
        take_ending(word, "ed", "");
    }
    take_ending(word, "er", "");
    take_ending(word, "e", "");

    // "fitting" and "fitted" as "fit", "controller" as "control"
    const size_t length = strlen(word);
    if (length > 3 && word[length - 1] == word[length - 2] &&
        strchr("bdglmnprt", word[length - 1])) {
        word[length - 1] = '\0';
    }
}

// Takes the next word off *text, in small letters and without its ending; false after the last.
static bool next_word(const char **text, char word[WORD])
{
    int length = 0;
    while (**text != '\0' && !is_word_byte(**text)) {
        (*text)++;
    }
    for (; is_word_byte(**text); (*text)++) {
        if (length < WORD - 1) {
            word[length++] = (char)tolower((unsigned char)**text);
        }
    }
    word[length] = '\0';
    take_endings(word);
    return length > 0;
}

// Words of which questions are made, whatever they are about.
static bool says_little(const char *word)
{
    static const char *const little[] = {
        "a",    "an",   "and", "are",  "at",     "be",   "by",   "can",  "do",    "doe",  "for",
        "get",  "from", "go",  "ha",   "have",   "how",  "i",    "if",   "in",    "is",   "it",
        "mak",  "me",   "my",  "need", "of",     "on",   "or",   "so",   "that",  "the",  "ther",
        "thi",  "to",   "use", "used", "wa",     "want", "what", "wher", "which", "why",  "will",
        "with", "writ", "you", "your", "should", "take", "tak",  "mean", "one",   "when", "then",
    };
    for (size_t i = 0; i < sizeof little / sizeof little[0]; i++) {
        if (strcmp(little[i], word) == 0) {
            return true;
        }
    }
    return false;
}

static bool is_among(const question_words *q, const char *word)
{
    for (int i = 0; i < q->count; i++) {
        if (strcmp(q->words[i], word) == 0) {
            return true;
        }
    }
    return false;
}

static void read_words(question_words *q, const char *question, bool all)
{
    char word[WORD];
    q->count = 0;
    while (q->count < WORDS && next_word(&question, word)) {
        if ((all || !says_little(word)) && !is_among(q, word)) {
            strcpy(q->words[q->count++], word);
        }
    }
}

static void count_words(occurrences *o, const question_words *q, const char *text, double weight)
{
    char word[WORD];
    while (next_word(&text, word)) {
        o->length++;
        for (int i = 0; i < q->count; i++) {
            o->of[i] += strcmp(q->words[i], word) == 0 ? weight : 0;
        }
    }
}

// How many words a title has that say something, at least one.
static double title_length(const char *title)
{
    char word[WORD];
    int count = 0;
    while (next_word(&title, word)) {
        count += !says_little(word);
    }
    return count > 0 ? count : 1;
}

// All that an entry says, its title and the page's as many times as they count.
static occurrences entry_words(const question_words *q, const search_entry *e)
{
    occurrences o = {.length = 0};
    count_words(&o, q, e->title, TITLE_WEIGHT / sqrt(title_length(e->title)));
    count_words(&o, q, e->above, ABOVE_WEIGHT);
    for (int i = 0; i < e->text_count; i++) {
        count_words(&o, q, e->texts[i], 1);
    }
    return o;
}

// BM25 of one field, times how much of the question is met.
static double score_of(const question_words *q, const occurrences *o)
{
    const double room = 1 - LENGTH_SHARE + LENGTH_SHARE * o->length / USUAL_LENGTH;
    double score = 0, met = 0, all = 0;
    for (int i = 0; i < q->count; i++) {
        const double often = o->of[i] / room;
        score += q->weight[i] * often / (often + SATURATION);
        met += o->of[i] > 0 ? q->weight[i] : 0;
        all += q->weight[i];
    }
    return all > 0 ? score * (met / all) : 0;
}

// Number of entries, and of those that have each word.
static double count_entries(const question_words *q, const search_source *sources, int source_count,
                            double with[WORDS])
{
    double entries = 0;
    memset(with, 0, WORDS * sizeof with[0]);
    for (int s = 0; s < source_count; s++) {
        for (int i = 0; i < sources[s].count; i++) {
            const search_entry e = sources[s].entry(i);
            const occurrences o = entry_words(q, &e);
            for (int w = 0; w < q->count; w++) {
                with[w] += o.of[w] > 0;
            }
            entries++;
        }
    }
    return entries;
}

// Takes the word of a title that is nearest to a misspelt one in its place, if one is near: one
// letter in four.
static void correct_word(char word[WORD], const search_source *sources, int source_count)
{
    char best[WORD], candidate[WORD];
    int least = (int)strlen(word) / 4 + 1;
    strcpy(best, word);
    for (int s = 0; s < source_count; s++) {
        for (int i = 0; i < sources[s].count; i++) {
            const char *title = sources[s].entry(i).title;
            while (next_word(&title, candidate)) {
                const int distance = edit_distance(word, candidate, least);
                if (distance < least) {
                    least = distance;
                    strcpy(best, candidate);
                }
            }
        }
    }
    strcpy(word, best);
}

// How much each word says: the fewer entries have it, the more. One that none has is taken for a
// misspelt one.
static void weigh(question_words *q, const search_source *sources, int source_count)
{
    double with[WORDS];
    count_entries(q, sources, source_count, with);
    for (int w = 0; w < q->count; w++) {
        if (with[w] == 0) {
            correct_word(q->words[w], sources, source_count);
        }
    }

    const double entries = count_entries(q, sources, source_count, with);
    for (int w = 0; w < q->count; w++) {
        q->weight[w] = log(1 + (entries - with[w] + 0.5) / (with[w] + 0.5));
    }
}

// The paragraph that fits best; the first of equals.
static int best_text(const question_words *q, const search_entry *e)
{
    int best = e->text_count > 0 ? 0 : -1;
    double highest = 0;
    for (int i = 0; i < e->text_count; i++) {
        occurrences o = {.length = 0};
        count_words(&o, q, e->texts[i], 1);
        const double score = score_of(q, &o);
        if (score > highest) {
            highest = score;
            best = i;
        }
    }
    return best;
}

// Puts a hit in its place among the best; the first of equals stays in front. Returns how many
// there are then.
static int keep_hit(search_hit *hits, int count, int most, search_hit hit)
{
    int at = count;
    for (; at > 0 && hits[at - 1].score < hit.score; at--) {
        if (at < most) {
            hits[at] = hits[at - 1];
        }
    }
    if (at < most) {
        hits[at] = hit;
    }
    return count < most ? count + 1 : most;
}

int search_find(const search_source *sources, int source_count, const char *question,
                search_hit *hits, int most)
{
    assert(most > 0);
    question_words q;
    int count = 0;

    // a question of little words only is about these
    read_words(&q, question, false);
    if (q.count == 0) {
        read_words(&q, question, true);
    }
    weigh(&q, sources, source_count);

    for (int s = 0; s < source_count; s++) {
        for (int i = 0; i < sources[s].count; i++) {
            const search_entry e = sources[s].entry(i);
            const occurrences o = entry_words(&q, &e);
            const double score = score_of(&q, &o);
            if (score > 0) {
                const search_hit hit = {s, i, best_text(&q, &e), score};
                count = keep_hit(hits, count, most, hit);
            }
        }
    }
    return count;
}

bool search_names(const char *title, const char *question)
{
    question_words q;
    occurrences o = {.length = 0};
    read_words(&q, question, true);
    count_words(&o, &q, title, 1);
    for (int i = 0; i < q.count; i++) {
        if (o.of[i] == 0) {
            return false;
        }
    }
    return q.count > 0;
}
