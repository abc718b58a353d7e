// Linked into the programs that tests/coverage counts: a process that ends by _exit, as the
// children of a fork do, leaves its counts like any other (ld's --wrap=_exit).
_Noreturn void __wrap__exit(int status);
_Noreturn void __real__exit(int status);
void __gcov_dump(void);

void __wrap__exit(int status)
{
    __gcov_dump();
    __real__exit(status);
}
