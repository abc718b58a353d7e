// Linked into the programs that tests/coverage counts: a process that ends by _exit, as
// the children of a fork do, or becomes another program leaves its counts like any other
// (ld's
// --wrap=_exit, execv and execl), and so does one in which tests/fail_kth.c lets
// something fail, or which may write short files only: not while they are written.
#include <dlfcn.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

_Noreturn void __wrap__exit(int status);
_Noreturn void __real__exit(int status);
void __gcov_dump(void);
void __gcov_reset(void);

// gcc writes the counts after this.
__attribute__((destructor)) static void let_nothing_fail(void)
{
    struct rlimit files;
    getrlimit(RLIMIT_FSIZE, &files);
    files.rlim_cur = files.rlim_max;
    setrlimit(RLIMIT_FSIZE, &files);
    if (getenv("FAIL_CALL") != NULL) {
        void *found = dlsym(RTLD_DEFAULT, "fail_nothing_more");
        void (*tell)(void) = NULL;
        memcpy(&tell, &found, sizeof tell);
        if (tell != NULL) {
            tell();
        }
    }
}

void __wrap__exit(int status)
{
    let_nothing_fail();
    __gcov_dump();
    __real__exit(status);
}

int __wrap_execv(const char *path, char *const words[]);
int __real_execv(const char *path, char *const words[]);
int __wrap_execl(const char *path, const char *first, ...);

// Without that program this one continues, and counts anew.
int __wrap_execv(const char *path, char *const words[])
{
    struct rlimit short_files;
    getrlimit(RLIMIT_FSIZE, &short_files);
    let_nothing_fail();
    __gcov_dump();
    setrlimit(RLIMIT_FSIZE, &short_files);
    const int failed = __real_execv(path, words);
    __gcov_reset();
    return failed;
}

int __wrap_execl(const char *path, const char *first, ...)
{
    enum { MOST_WORDS = 16 };
    char *words[MOST_WORDS] = {(char *)first};
    va_list list;
    va_start(list, first);
    for (int i = 1; i < MOST_WORDS - 1 && words[i - 1] != NULL; i++) {
        words[i] = va_arg(list, char *);
    }
    va_end(list);
    return __wrap_execv(path, words);
}
