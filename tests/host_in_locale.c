// The program as a host that sets the whole locale before it uses the library, as GUI
// toolkits do: the linker puts this in the place of the C library's setlocale.
#include <locale.h>

char *__real_setlocale(int category, const char *locale);
char *__wrap_setlocale(int category, const char *locale);

char *__wrap_setlocale(int category, const char *locale)
{
    (void)category;
    return __real_setlocale(LC_ALL, locale);
}
