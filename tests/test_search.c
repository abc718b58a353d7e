// Search by words: what is found, in which order, and that every section of the manual
// can be.
#include "tests/check.h"

#include "ui/manual/search.h"

static const char *const about_walls[] = {"a wall may give",
                                          "how stiff the settled wall is"};
static const char *const about_beams[] = {"a beam bends",
                                          "its frequencies, with the hub held"};
static const char *const about_hubs[] = {"the hub turns, the beam with it"};

static const search_entry things[] = {
    {"A soft wall", "Walls", about_walls, 2},
    {"The beam", "Arms", about_beams, 2},
    {"Hub", "Arms", about_hubs, 1, "which motor drives it?"},
    {"arm.beam_length", "parameter", NULL, 0},
};

static search_entry thing(const void *context, int i)
{
    (void)context;
    return things[i];
}

static const search_source source = {4, thing, NULL};

// Index of the best hit, -1 if nothing is found.
static int best(const char *question)
{
    search_hit hit;
    return search_find(&source, 1, question, &hit, 1) > 0 ? hit.index : -1;
}

TEST(finds_what_fits_best)
{
    assert_int_equal(best("soft wall"), 0);
    assert_int_equal(best("What is the beam that bends?"), 1);
    assert_int_equal(best("length"), 3);
    assert_int_equal(best("beam_length"), 3);
    assert_int_equal(best("frequency held"), 1);
    assert_int_equal(best("nonsense"), -1);
    assert_int_equal(best(""), -1);
    assert_int_equal(best("?"), -1);
}

TEST(compares_without_endings_and_case)
{
    assert_int_equal(best("SETTLING"), 0);
    assert_int_equal(best("bending"), 1);
    assert_int_equal(best("turned"), 2);
}

TEST(finds_what_a_thing_says_it_answers)
{
    assert_int_equal(best("what motor do I need"), 2);
    assert_int_equal(best("driving the beam"), 2);
}

TEST(corrects_misspelt_words)
{
    assert_int_equal(best("lenght"), 3);
    assert_int_equal(best("hubb"), 2);
    assert_int_equal(best("zzzz"), -1);
}

TEST(knows_synonyms)
{
    assert_int_equal(best("obstacles"), 0);
    assert_int_equal(best("a rod"), 1);
}

// A hit has the share of the question's words that it has, in which little words are not.
TEST(tells_what_share_of_a_question_is_found)
{
    search_hit hit;
    assert_int_equal(search_find(&source, 1, "what is a soft wall", &hit, 1), 1);
    check_close(hit.share, 1, 1e-12);
    assert_int_equal(search_find(&source, 1, "soft zeppelin", &hit, 1), 1);
    check_close(hit.share, 1 / 2.5, 1e-12); // a word that occurs nowhere counts 1.5
    assert_int_equal(search_find(&source, 1, "what is a zeppelin", &hit, 1), 0);
}

TEST(keeps_the_best_in_order)
{
    search_hit hits[4];

    // all that has the word, the one that is called so first
    const int count = search_find(&source, 1, "hub", hits, 4);
    assert_int_equal(count, 2);
    assert_int_equal(hits[0].index, 2);
    assert_int_equal(hits[1].index, 1);
    assert_int_equal(hits[1].text, 1);

    // no more than there is room for, and the same ones
    assert_int_equal(search_find(&source, 1, "hub", hits, 1), 1);
    assert_int_equal(hits[0].index, 2);
}

TEST(takes_long_questions)
{
    char *question = repeated('a', 4095);
    for (int i = 30; i < 4095; i += 40) {
        question[i] = ' ';
    }
    memcpy(question, "wall ", 5);
    assert_int_equal(best(question), 0);
}

// Whether all words stand in the title of the thing with that index, and of no other.
static bool only_titled(const char *words, int index)
{
    search_hit hits[4];
    return search_titles(&source, 1, words, hits, 4) == 1 && hits[0].index == index;
}

TEST(knows_titles)
{
    search_hit hit;
    assert_true(only_titled("beam_length", 3));
    assert_true(only_titled("walls soft", 0));
    assert_true(only_titled("the beam", 1));
    assert_int_equal(search_titles(&source, 1, "soft beam", &hit, 1), 0);
    assert_int_equal(search_titles(&source, 1, ".", &hit, 1), 0);
}

static search_entry heading(const void *context, int i)
{
    (void)context;
    const manual_section s = manual_section_at(i);
    return (search_entry){s.heading, s.title, s.texts, s.text_count, s.asked};
}

// A search for the titles of a page's section leads to one that is called so.
TEST(finds_every_section_by_its_title)
{
    const search_source sections = {manual_sections(), heading, NULL};
    assert_true(manual_sections() > 100);
    for (int i = 0; i < manual_sections(); i++) {
        const manual_section s = manual_section_at(i);
        search_hit hits[12];
        bool met = false;
        const char *question = formatted("%s %s", s.title, s.heading);
        const int count = search_find(&sections, 1, question, hits, 12);
        for (int k = 0; k < count; k++) {
            met = met || strcmp(manual_section_at(hits[k].index).heading, s.heading) == 0;
        }
        const bool in_docs = strncmp(s.page, "docs/", 5) == 0;
        assert_true(in_docs || strcmp(s.page, "README.md") == 0);
        assert_true(met || !in_docs); // README's headings are words that say little
    }
}
