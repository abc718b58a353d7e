// The search as a full-text index of SQLite in memory, which each question fills anew.
#include "ui/manual/search.h"

#include <ctype.h>
#include <sqlite3.h>
#include <stdio.h>
#include <string.h>

#include "src/base/text_stream.h"
#include "src/base/words.h"

enum { MOST_WORDS = 16, WORD_SIZE = 32, TERMS_SIZE = MOST_WORDS * (WORD_SIZE + 8) };

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
    char words[MOST_WORDS][WORD_SIZE];
    int count;
} question_words;

// Words of which questions are made, whatever they are about.
static bool says_little(const char *word)
{
    static const char little[] =
        " a an and are at be by can do does for from get has have how i if in is it "
        "make me mean my need of on one or should so take that the then there this to "
        "use used want was what when where which why will with write you your ";
    char between_blanks[WORD_SIZE + 2];
    snprintf(between_blanks, sizeof between_blanks, " %s ", word);
    return strstr(little, between_blanks) != NULL;
}

// Whether a byte is of a word: a letter, a digit, or a part of a character beyond ASCII.
static bool is_of_word(unsigned char byte)
{
    return isalnum(byte) || byte >= 0x80;
}

// The words of a question in small letters, all of them or those that say something.
static void read_words(question_words *q, const char *question, bool all)
{
    q->count = 0;
    while (q->count < MOST_WORDS && *question != '\0') {
        // a word, whose end is lost if it is very long
        char *word = q->words[q->count];
        int length = 0;
        for (; is_of_word((unsigned char)*question); question++) {
            if (length < WORD_SIZE - 1) {
                word[length++] = (char)tolower((unsigned char)*question);
            }
        }
        word[length] = '\0';
        if (length > 0 && (all || !says_little(word))) {
            q->count++;
        }

        // and what ends it
        if (*question != '\0') {
            question++;
        }
    }
}

// Adds the statements that insert a thing with its passages.
static void insert_thing(sqlite3_str *script, int source, int item, int thing,
                         const search_entry *e)
{
    for (int t = 0; t < e->text_count; t++) {
        sqlite3_str_appendf(script,
                            "INSERT INTO passage(rowid, body) VALUES (%d * " PASSAGES
                            " + %d, %Q);",
                            thing, t, e->texts[t]);
    }
    sqlite3_str_appendf(
        script,
        "INSERT INTO thing SELECT %d, %d, %Q, %Q, group_concat(body, ' ') "
        "FROM passage WHERE rowid >= %d * " PASSAGES ";"
        "INSERT INTO title VALUES (%Q);",
        source, item, e->title, e->above, thing, e->title);
}

// The tables of all entries in memory; NULL, and a loss is noted, without memory.
static sqlite3 *open_tables(const search_source *sources, int source_count)
{
    sqlite3 *database = NULL;
    sqlite3_open(":memory:", &database);

    // one script for all of them
    sqlite3_str *script = sqlite3_str_new(database);
    sqlite3_str_appendall(script, tables);
    int thing = 1;
    for (int s = 0; s < source_count; s++) {
        for (int i = 0; i < sources[s].count; i++) {
            const search_entry e = search_entry_of(&sources[s], i);
            insert_thing(script, s, i, thing++, &e);
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

// Runs a statement on the terms and takes its rows as hits, at most `most`; returns how
// many there are.
static int take_hits(sqlite3 *database, const char *sql, const char *terms,
                     search_hit *hits, int most)
{
    sqlite3_stmt *rows = NULL;
    int count = 0, code = sqlite3_prepare_v2(database, sql, -1, &rows, NULL);
    if (code == SQLITE_OK) {
        sqlite3_bind_text(rows, 1, terms, -1, SQLITE_STATIC);
        sqlite3_bind_int(rows, 2, most);

        // a thing without a passage that fits gives NULL, which reads as the first one
        while ((code = sqlite3_step(rows)) == SQLITE_ROW) {
            hits[count++] = (search_hit){.source = sqlite3_column_int(rows, 0),
                                         .index = sqlite3_column_int(rows, 1),
                                         .text = sqlite3_column_int(rows, 2)};
        }
    }
    sqlite3_finalize(rows);
    loss_unless(code == SQLITE_DONE);
    return count;
}

// Whether a word occurs in any of the things.
static bool occurs(sqlite3 *database, const char *word)
{
    search_hit found;
    char term[WORD_SIZE + 3];
    snprintf(term, sizeof term, "\"%s\"", word);
    return take_hits(database, best_things, term, &found, 1) > 0;
}

// Puts the nearest word of a title in the place of one that occurs nowhere, if one is
// near: one letter in four.
static void correct_word(sqlite3 *database, char word[WORD_SIZE])
{
    if (occurs(database, word)) {
        return;
    }

    sqlite3_stmt *rows = NULL;
    int least = (int)strlen(word) / 4 + 1;
    char best[WORD_SIZE];
    strcpy(best, word);
    sqlite3_prepare_v2(database, "SELECT term FROM spelling", -1, &rows, NULL);
    while (sqlite3_step(rows) == SQLITE_ROW) {
        const char *candidate = (const char *)sqlite3_column_text(rows, 0);
        if (candidate == NULL) {
            continue;
        }
        const int distance = edit_distance(word, candidate, least);
        if (distance < least) {
            least = distance;
            snprintf(best, sizeof best, "%s", candidate);
        }
    }
    sqlite3_finalize(rows);
    strcpy(word, best);
}

// Writes the words, each in quotation marks, with a joint between them: ("a" OR "b").
static void write_terms(const question_words *q, const char *joint,
                        char terms[TERMS_SIZE])
{
    int length = 0;
    for (int i = 0; i < q->count; i++) {
        const char *before = i == 0 ? "(" : joint;
        length += snprintf(terms + length, (size_t)(TERMS_SIZE - length), "%s\"%s\"",
                           before, q->words[i]);
    }
    snprintf(terms + length, (size_t)(TERMS_SIZE - length), ")");
}

int search_find(const search_source *sources, int source_count, const char *question,
                search_hit *hits, int most)
{
    question_words q;
    char terms[TERMS_SIZE];
    int count = 0;

    // a question of little words only is about these
    read_words(&q, question, false);
    if (q.count == 0) {
        read_words(&q, question, true);
    }

    sqlite3 *database = open_tables(sources, source_count);
    if (database != NULL && q.count > 0) {
        for (int i = 0; i < q.count; i++) {
            correct_word(database, q.words[i]);
        }
        write_terms(&q, " OR ", terms);
        count = take_hits(database, best_things, terms, hits, most);
    }
    sqlite3_close(database);
    return count;
}

int search_titles(const search_source *sources, int source_count, const char *words,
                  search_hit *hits, int most)
{
    question_words q;
    char terms[TERMS_SIZE];
    int count = 0;
    read_words(&q, words, true);

    sqlite3 *database = open_tables(sources, source_count);
    if (database != NULL && q.count > 0) {
        write_terms(&q, " AND ", terms);
        count = take_hits(database, titled_things, terms, hits, most);
    }
    sqlite3_close(database);
    return count;
}
