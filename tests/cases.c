// The cases of a test program, which TEST adds before main, in the order in which they are written.
#include "tests/check.h"

#include <errno.h>

enum { MOST_CASES = 128 };
static struct CMUnitTest cases[MOST_CASES];
static int lines[MOST_CASES], count;

// fontconfig keeps a little memory until the end, whatever its user does
const char *__lsan_default_suppressions(void);
const char *__lsan_default_suppressions(void)
{
    return "leak:libfontconfig\n";
}

// no memory is requested: some programs count or refuse every request
void add_case(struct CMUnitTest added, int line)
{
    int i = count++;
    if (count > MOST_CASES) {
        abort();
    }
    for (; i > 0 && lines[i - 1] > line; i--) {
        cases[i] = cases[i - 1];
        lines[i] = lines[i - 1];
    }
    cases[i] = added;
    lines[i] = line;
}

int run_cases(CMFixtureFunction set_up, CMFixtureFunction tear_down)
{
    return _cmocka_run_group_tests(program_invocation_short_name, cases, (size_t)count, set_up,
                                   tear_down) != 0;
}

__attribute__((weak)) int main(void)
{
    return run_cases(NULL, NULL);
}
