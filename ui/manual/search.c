#include "ui/manual/search.h"

#include <ctype.h>
#include <sqlite3.h>
#include <stdio.h>
#include <string.h>

#include "src/base/text_stream.h"
#include "src/base/words.h"

enum { WORDS = 16, WORD = 32, TERMS = WORDS * (WORD + 8) };

// All things and their passages, words without their endings (Porter 1980), and the words
// of titles as they are spelt. Passages of the thing with number n have the numbers from
// n PASSAGES on.
static const char tables[] =
    "BEGIN;CREATE VIRTUAL TABLE thing USING fts5(source UNINDEXED, item UNINDEXED, "
    "title, above, body, tokenize = 'porter');CREATE VIRTUAL TABLE passage USING "
    "fts5(body, tokenize = 'porter');CREATE VIRTUAL TABLE title USING "
    "fts5(body);CREATE VIRTUAL TABLE spelling USING fts5vocab(title, row);";
#define PASSAGES "10000"

// The best things for the terms ?1, at most ?2, each with its best passage. The score is
// Okapi BM25 (Robertson and Zaragoza 2009), where a word in a title counts as twelve.
static const char best_things[] =
    "SELECT source, item, (SELECT passage.rowid % " PASSAGES " FROM passage "
    "WHERE passage MATCH ?1 AND passage.rowid / " PASSAGES
    " = thing.rowid ORDER BY bm25(passage), passage.rowid LIMIT 1) FROM thing WHERE "
    "thing MATCH ?1 ORDER BY bm25(thing, 0, 0, 12, 4, 1), rowid LIMIT ?2";
static const char titled_things[] =
    "SELECT source, item, NULL FROM thing "
    "WHERE thing MATCH 'title:' || ?1 ORDER BY rowid LIMIT ?2";

typedef struct question_words {
    char words[WORDS][WORD];
    int count;
} question_words;

// Words of which questions are made, whatever they are about.
static bool says_little(const char *word)
{
    static const char little[] =
        " a an and are at be by can do does for from get has have how i if in is it "
        "make me mean my need of on one or should so take that the then there this to "
        "use used want was what when where which why will with write you your ";
    char padded[WORD + 2];
    snprintf(padded, sizeof padded, " %s ", word);
    return strstr(little, padded) != NULL;
}

// The words of a question in small letters, all of them or those that say something.
static void read_words(question_words *q, const char *question, bool all)
{
    q->count = 0;
    while (q->count < WORDS && *question != '\0') {
        char *word = q->words[q->count];
        int length = 0;
        for (; isalnum((unsigned char)*question) || (unsigned char)*question >= 0x80;
             question++) {
            if (length < WORD - 1) {
                word[length++] = (char)tolower((unsigned char)*question);
            }
        }
        word[length] = '\0';
        if (length > 0 && (all || !says_little(word))) {
            q->count++;
        }
        if (*question != '\0') {
            question++;
        }
    }
}

// The tables of all entries in memory; NULL, and a loss is noted, without memory.
static sqlite3 *open_tables(const search_source *sources, int source_count)
{
    sqlite3 *database = NULL;
    sqlite3_open(":memory:", &database);
    sqlite3_str *script = sqlite3_str_new(database);
    sqlite3_str_appendall(script, tables);
    for (int s = 0, thing = 1; s < source_count; s++) {
        for (int i = 0; i < sources[s].count; i++, thing++) {
            const search_entry e = search_entry_of(&sources[s], i);
            for (int t = 0; t < e.text_count; t++) {
                sqlite3_str_appendf(
                    script,
                    "INSERT INTO passage(rowid, body) VALUES (%d * " PASSAGES
                    " + %d, %Q);",
                    thing, t, e.texts[t]);
            }
            sqlite3_str_appendf(
                script,
                "INSERT INTO thing SELECT %d, %d, %Q, %Q, group_concat(body, ' ') "
                "FROM passage WHERE rowid >= %d * " PASSAGES ";"
                "INSERT INTO title VALUES (%Q);",
                s, i, e.title, e.above, thing, e.title);
        }
    }
    sqlite3_str_appendall(script, "COMMIT;");
    char *sql = sqlite3_str_finish(script);
    const bool made =
        sql != NULL && sqlite3_exec(database, sql, NULL, NULL, NULL) == SQLITE_OK;
    sqlite3_free(sql);
    loss_unless(made);
    if (!made) {
        sqlite3_close(database);
        return NULL;
    }
    return database;
}

// Runs a statement on the terms and takes its rows as hits; returns how many there are.
static int take_hits(sqlite3 *database, const char *sql, const char *terms,
                     search_hit *hits, int most)
{
    sqlite3_stmt *rows = NULL;
    int count = 0, code = sqlite3_prepare_v2(database, sql, -1, &rows, NULL);
    sqlite3_bind_text(rows, 1, terms, -1, SQLITE_STATIC);
    sqlite3_bind_int(rows, 2, most);
    while (code == SQLITE_OK && (code = sqlite3_step(rows)) == SQLITE_ROW) {
        const bool fits = sqlite3_column_type(rows, 2) != SQLITE_NULL;
        hits[count++] = (search_hit){.source = sqlite3_column_int(rows, 0),
                                     .index = sqlite3_column_int(rows, 1),
                                     .text = fits ? sqlite3_column_int(rows, 2) : 0};
        code = SQLITE_OK;
    }
    sqlite3_finalize(rows);
    loss_unless(code == SQLITE_DONE);
    return count;
}

// Takes the word of a title that is nearest to one that occurs nowhere in its place, if
// one is near: one letter in four.
static void correct_word(sqlite3 *database, char word[WORD])
{
    search_hit found;
    char term[WORD + 3];
    snprintf(term, sizeof term, "\"%s\"", word);
    if (take_hits(database, best_things, term, &found, 1) > 0) {
        return;
    }

    sqlite3_stmt *rows = NULL;
    int least = (int)strlen(word) / 4 + 1;
    char best[WORD];
    strcpy(best, word);
    sqlite3_prepare_v2(database, "SELECT term FROM spelling", -1, &rows, NULL);
    while (sqlite3_step(rows) == SQLITE_ROW) {
        const char *candidate = (const char *)sqlite3_column_text(rows, 0);
        const int distance =
            candidate != NULL ? edit_distance(word, candidate, least) : least;
        if (distance < least) {
            least = distance;
            snprintf(best, sizeof best, "%s", candidate);
        }
    }
    sqlite3_finalize(rows);
    strcpy(word, best);
}

// What search_titles (`titled`) and search_find give.
static int find(const search_source *sources, int source_count, const char *question,
                search_hit *hits, int most, bool titled)
{
    question_words q;
    char terms[TERMS] = "(";
    const char *sql = best_things, *joint = " OR ";
    if (titled) {
        sql = titled_things;
        joint = " AND ";
    }
    sqlite3 *database = open_tables(sources, source_count);

    // a question of little words only is about these
    read_words(&q, question, titled);
    if (q.count == 0) {
        read_words(&q, question, true);
    }
    for (int i = 0; i < q.count && database != NULL; i++) {
        if (!titled) {
            correct_word(database, q.words[i]);
        }
        const size_t length = strlen(terms);
        snprintf(terms + length, sizeof terms - length, "%s\"%s\"", i > 0 ? joint : "",
                 q.words[i]);
    }
    const size_t length = strlen(terms);
    snprintf(terms + length, sizeof terms - length, ")");

    int count = 0;
    if (database != NULL && q.count > 0) {
        count = take_hits(database, sql, terms, hits, most);
    }
    sqlite3_close(database);
    return count;
}

int search_find(const search_source *sources, int source_count, const char *question,
                search_hit *hits, int most)
{
    return find(sources, source_count, question, hits, most, false);
}

int search_titles(const search_source *sources, int source_count, const char *words,
                  search_hit *hits, int most)
{
    return find(sources, source_count, words, hits, most, true);
}
