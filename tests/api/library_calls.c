// The calls as a program, for tests/api/test_memory.sh.
#include "calls.h"

int main(void)
{
    call_everything(stdout);
    return 0;
}
