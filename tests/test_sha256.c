// SHA-256 against the examples of the standard (FIPS 180-4), and in pieces.
#include "tests/check.h"

#include "src/base/sha256.h"

static void check_digest(const void *bytes, size_t size, size_t piece,
                         const char *expected)
{
    sha256 h;
    char text[SHA256_TEXT];
    sha256_init(&h);
    for (size_t at = 0; at < size; at += piece) {
        sha256_add(&h, (const char *)bytes + at, at + piece < size ? piece : size - at);
    }
    sha256_finish(&h, text);
    assert_string_equal(text, expected);
}

TEST(the_standards_examples_come_out)
{
    static char many_a[1000000];
    memset(many_a, 'a', sizeof many_a);
    const char *const two_blocks =
        "abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq";
    check_digest("", 0, 1,
                 "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    check_digest("abc", 3, 3,
                 "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    check_digest(two_blocks, 56, 56,
                 "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
    check_digest(many_a, sizeof many_a, sizeof many_a,
                 "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(pieces_make_no_difference)
{
    const char *const two_blocks =
        "abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq";
    for (size_t piece = 1; piece <= 56; piece++) {
        check_digest(two_blocks, 56, piece,
                     "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
    }
}
