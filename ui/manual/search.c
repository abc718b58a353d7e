// The search as a full-text index of SQLite in memory, which each question fills anew.
#include "ui/manual/search.h"

#include <ctype.h>
#include <sqlite3.h>
#include <stdio.h>
#include <string.h>

#include "src/base/text_stream.h"
#include "src/base/words.h"
#include "ui/manual/synonyms.h"

enum { MOST_WORDS = 16, WORD_SIZE = 32, TERMS_SIZE = MOST_WORDS * (WORD_SIZE + 8) };

// All things and their passages, words without their endings (Porter 1980), synonyms by
// the words that are asked, and the words of titles as they are spelt. Passages of the
// thing with number n have the numbers from n PASSAGES on. A question is the terms of its
// words, whose points for things and passages stand in `found` and `said`.
static const char tables[] =
    "BEGIN;CREATE VIRTUAL TABLE thing USING fts5(source UNINDEXED, item UNINDEXED, "
    "title, above, body, questions, tokenize = 'porter');CREATE VIRTUAL TABLE passage "
    "USING "
    "fts5(body, tokenize = 'porter');CREATE VIRTUAL TABLE synonym USING fts5(asked, "
    "meant UNINDEXED, tokenize = 'porter');CREATE VIRTUAL TABLE title USING "
    "fts5(body);CREATE VIRTUAL TABLE spelling USING fts5vocab(title, row);"
    "CREATE TABLE asked(word, term, weight);CREATE TABLE found(word, thing, points);"
    "CREATE TABLE said(word, passage, points);";
#define PASSAGES "10000"

// A term of a question with its number and weight, and what it may mean, which counts
// less. Terms below 0 only decide between things that have others.
static const char ask_term[] = "INSERT INTO asked VALUES (?2, ?1, ?3)";
static const char ask_synonyms[] =
    "INSERT INTO asked SELECT ?2, meant, ?3 FROM synonym WHERE synonym MATCH ?1";

// The points of each word's terms are Okapi BM25 (Robertson and Zaragoza 2009), where a
// word in a title counts as twelve, one in a question that the thing answers as four.
static const char give_points[] =
    "INSERT INTO found SELECT word, thing.rowid, -weight * bm25(thing, 0, 0, 12, 4, 1, "
    "4) "
    "FROM asked CROSS JOIN thing WHERE thing MATCH term;"
    "INSERT INTO said SELECT word, passage.rowid, -weight * bm25(passage) "
    "FROM asked CROSS JOIN passage WHERE passage MATCH term;";

// The best things, at most ?2, each with its best passage and the share of the question
// that it has. A word counts by its best term; a thing by what it has, and up to half
// as much more for what its best passage has. The share of a word is the most points that
// it gives anything; of one that occurs nowhere half as much again as any other gives.
static const char best_things[] =
    "WITH term AS (SELECT thing, word, max(points) AS points FROM found "
    "GROUP BY thing, word), "
    "worth AS (SELECT word, max(points) AS points FROM term WHERE word >= 0 "
    "GROUP BY word), "
    "whole AS (SELECT sum(points) + 1.5 * max(points) * ((SELECT count(DISTINCT word) "
    "FROM asked WHERE word >= 0) - count(*)) AS points FROM worth), "
    "score AS (SELECT thing, sum(term.points) AS points, sum(worth.points) / "
    "(SELECT points FROM whole) AS share FROM term LEFT JOIN worth USING (word) "
    "GROUP BY thing), "
    "sentence AS (SELECT passage, sum(points) AS points FROM (SELECT passage, word, "
    "max(points) AS points FROM said GROUP BY passage, word) GROUP BY passage), "
    "best AS (SELECT passage / " PASSAGES " AS thing, passage % " PASSAGES
    " AS item, max(points) AS points FROM sentence GROUP BY 1) "
    "SELECT source, thing.item, best.item, share FROM score JOIN thing ON thing.rowid = "
    "score.thing LEFT JOIN best ON best.thing = score.thing WHERE share > 0 ORDER BY "
    "share * score.points * (1 + coalesce(best.points / (SELECT 2 * max(points) "
    "FROM best), 0)) DESC, score.thing LIMIT ?2";
static const char titled_things[] =
    "SELECT source, item, NULL, 1 FROM thing "
    "WHERE thing MATCH 'title:' || ?1 ORDER BY rowid LIMIT ?2";
static const char occurring[] = "SELECT 0, 0, 0, 1 FROM thing WHERE thing MATCH ?1 "
                                "UNION SELECT 0, 0, 0, 1 FROM synonym WHERE synonym "
                                "MATCH ?1 LIMIT ?2";

// Weights of terms beside those of words, which are 1.
static const double SYNONYM = 0.8, PAIR = 0.25, LITTLE_WORD = 0.1;

typedef struct question_words {
    char words[MOST_WORDS][WORD_SIZE];
    int count;
    bool all_little;
} question_words;

// Words of which questions are made, whatever they are about.
static bool says_little(const char *word)
{
    static const char little[] =
        " a about add again all also am an and any are as at be been between but by can "
        "choose could did difference different do does doesn don explain for from get "
        "give "
        "given go got had happen happens has have how i if in instead into is isn it "
        "its just know let like ll look make many may me mean might much must my "
        "need no not of off on one only or other our out over pick please possible "
        "really s say see select should show so some something still such t take "
        "tell than that the their them then there these they thing this those to too "
        "under up us use used using ve want was way we were what when where whether "
        "which while who why will with without work would write you your ";
    char between_blanks[WORD_SIZE + 2];
    snprintf(between_blanks, sizeof between_blanks, " %s ", word);
    return strstr(little, between_blanks) != NULL;
}

// Whether a byte is of a word: a letter, a digit, or a part of a character beyond ASCII.
static bool is_of_word(unsigned char byte)
{
    return isalnum(byte) || byte >= 0x80;
}

// The words of a question in small letters.
static void read_words(question_words *q, const char *question)
{
    *q = (question_words){.all_little = true};
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
        if (length > 0) {
            q->count++;
            q->all_little = q->all_little && says_little(word);
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
    const char *title = e->title;
    if (e->aside) {
        title = "";
    }
    const char *asked = e->asked;
    if (asked == NULL) {
        asked = "";
    }
    sqlite3_str_appendf(
        script,
        "INSERT INTO thing SELECT %d, %d, %Q, %Q, group_concat(body, ' '), %Q "
        "FROM passage WHERE rowid >= %d * " PASSAGES ";"
        "INSERT INTO title VALUES (%Q);",
        source, item, title, e->above, asked, thing, e->title);
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
    for (int i = 0; i < synonym_count; i++) {
        sqlite3_str_appendf(script,
                            "INSERT INTO synonym VALUES (%Q, '\"' || replace(%Q, '|', "
                            "'\" OR \"') || '\"');",
                            synonym_table[i].asked, synonym_table[i].meant);
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

// Runs a statement on terms and a number, and takes its rows as hits, at most `most`;
// returns how many there are.
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
                                         .text = sqlite3_column_int(rows, 2),
                                         .share = sqlite3_column_double(rows, 3)};
        }
    }
    sqlite3_finalize(rows);
    loss_unless(code == SQLITE_DONE);
    return count;
}

// Whether a word occurs in any of the things, or is asked for one that does.
static bool occurs(sqlite3 *database, const char *word)
{
    search_hit found;
    char term[WORD_SIZE + 3];
    snprintf(term, sizeof term, "\"%s\"", word);
    return take_hits(database, occurring, term, &found, 1) > 0;
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

// Notes a term under a number.
static void ask(sqlite3 *database, const char *sql, const char *term, int number,
                double weight)
{
    sqlite3_stmt *asked = NULL;
    int code = sqlite3_prepare_v2(database, sql, -1, &asked, NULL);
    if (code == SQLITE_OK) {
        sqlite3_bind_text(asked, 1, term, -1, SQLITE_STATIC);
        sqlite3_bind_int(asked, 2, number);
        sqlite3_bind_double(asked, 3, weight);
        code = sqlite3_step(asked);
    }
    sqlite3_finalize(asked);
    loss_unless(code == SQLITE_DONE);
}

// Notes what a comparative compares, "soft" of "softer", which Porter's stems leave.
static void ask_positive(sqlite3 *database, const char *word, int number)
{
    const size_t length = text_stem(word, "er");
    char term[WORD_SIZE + 3];
    if (length < strlen(word)) {
        snprintf(term, sizeof term, "\"%.*s\"", (int)length, word);
        ask(database, ask_term, term, number, SYNONYM);
    }
}

// Notes the words of a question, with what they may mean and pairs of neighbours. Little
// words count beside others only where these leave it open.
static void ask_words(sqlite3 *database, question_words *q)
{
    const char *before = NULL;
    for (int i = 0; i < q->count; i++) {
        char term[2 * WORD_SIZE + 16];
        char *word = q->words[i];
        if (says_little(word) && !q->all_little) {
            snprintf(term, sizeof term, "\"%s\"", word);
            ask(database, ask_term, term, -1 - i, LITTLE_WORD);
            continue;
        }

        // corrected if it is misspelt
        correct_word(database, word);
        snprintf(term, sizeof term, "\"%s\"", word);
        ask(database, ask_term, term, i, 1);
        ask(database, ask_synonyms, term, i, SYNONYM);
        ask_positive(database, word, i);

        // near the word before it that says something
        if (before != NULL) {
            snprintf(term, sizeof term, "NEAR(\"%s\" \"%s\", 3)", before, word);
            ask(database, ask_term, term, -1 - i - MOST_WORDS, PAIR);
        }
        before = word;
    }
}

int search_find(const search_source *sources, int source_count, const char *question,
                search_hit *hits, int most)
{
    question_words q;
    int count = 0;
    read_words(&q, question);

    sqlite3 *database = open_tables(sources, source_count);
    if (database != NULL && q.count > 0) {
        ask_words(database, &q);
        loss_unless(sqlite3_exec(database, give_points, NULL, NULL, NULL) == SQLITE_OK);
        count = take_hits(database, best_things, "", hits, most);
    }
    sqlite3_close(database);
    return count;
}

int search_titles(const search_source *sources, int source_count, const char *words,
                  search_hit *hits, int most)
{
    question_words q;
    char terms[TERMS_SIZE] = "(";
    size_t length = 1;
    int count = 0;
    read_words(&q, words);

    // each in quotation marks: ("a" AND "b")
    for (int i = 0; i < q.count; i++) {
        const char *joint = i > 0 ? " AND " : "";
        length += (size_t)snprintf(terms + length, sizeof terms - length, "%s\"%s\"",
                                   joint, q.words[i]);
    }
    snprintf(terms + length, sizeof terms - length, ")");

    sqlite3 *database = open_tables(sources, source_count);
    if (database != NULL && q.count > 0) {
        count = take_hits(database, titled_things, terms, hits, most);
    }
    sqlite3_close(database);
    return count;
}
