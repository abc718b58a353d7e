// A long line from which cairo omits a piece for lack of memory: the drawing reports it.
// The functions below take the allocator's place in cairo, too, so that each request of a
// stroke can be refused.
#include <signal.h>

#include "render/page/picture_file.h"
#include "tests/check.h"

#define SIZE   200
#define POINTS 1000
#define NEVER  (-1)

static long granted = NEVER; // requests until one is refused

void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *old, size_t size);

static bool refuses(void)
{
    if (granted == NEVER || granted-- > 0) {
        return false;
    }
    granted = NEVER;
    errno = ENOMEM;
    return true;
}

void *malloc(size_t size)
{
    return refuses() ? NULL : __libc_malloc(size);
}

void *calloc(size_t count, size_t size)
{
    return refuses() ? NULL : __libc_calloc(count, size);
}

void *realloc(void *old, size_t size)
{
    return refuses() ? NULL : __libc_realloc(old, size);
}

// Draws a force that rings, the given number of its requests for memory granted.
static status draw(cairo_surface_t *onto, long requests)
{
    cairo_t *cr = cairo_create(onto);
    cairo_set_line_join(cr, CAIRO_LINE_JOIN_ROUND);
    for (int i = 0; i < POINTS; i++) {
        const double t = (double)i / POINTS;
        cairo_line_to(cr, SIZE * t, SIZE / 2.0 * (1 + exp(-2 * t) * sin(300 * t)));
    }
    granted = requests;
    picture_stroke(cr);
    granted = NEVER;
    return picture_end_drawing(cr, STATUS_OK, NULL);
}

typedef enum outcome { WHOLE, SAID, LACKING, CRASHED, OUTCOMES } outcome;

// The result of a drawing with a refused request, in a separate process because cairo
// crashes where it does not get some of them.
static outcome try_drawing(const unsigned char *wanted, size_t size, long requests)
{
    const pid_t child = fork();
    if (child == 0) {
        signal(SIGSEGV, SIG_DFL);
        signal(SIGABRT, SIG_DFL);
        cairo_surface_t *onto =
            cairo_image_surface_create(CAIRO_FORMAT_RGB24, SIZE, SIZE);
        const bool drawn = draw(onto, requests) == STATUS_OK;
        const bool same = memcmp(cairo_image_surface_get_data(onto), wanted, size) == 0;
        _exit(!drawn ? SAID : same ? WHOLE : LACKING);
    }
    int state;
    assert_int_equal(waitpid(child, &state, 0), child);
    return WIFEXITED(state) ? (outcome)WEXITSTATUS(state) : CRASHED;
}

TEST(a_line_that_lacks_a_piece_is_said)
{
    cairo_surface_t *whole = cairo_image_surface_create(CAIRO_FORMAT_RGB24, SIZE, SIZE);
    assert_int_equal(draw(whole, NEVER), STATUS_OK);
    const unsigned char *wanted = cairo_image_surface_get_data(whole);
    const size_t size = (size_t)cairo_image_surface_get_stride(whole) * SIZE;

    int count[OUTCOMES] = {0};
    for (long requests = 0; requests < 200; requests++) {
        count[try_drawing(wanted, size, requests)]++;
    }
    assert_int_equal(count[LACKING], 0);
    assert_true(count[SAID] > 0 && count[WHOLE] > 0);
    cairo_surface_destroy(whole);
}
