#include "render/page/picture_path.h"

#include <string.h>
#include <strings.h>

#include "render/page/text.h"
#include "src/base/whole_file.h"

const char *picture_ending(const char *path)
{
    // only in the last part of the path: a dot in a folder's name begins no ending
    const char *slash = strrchr(path, '/');
    const char *dot = strrchr(text_or(slash, path), '.');
    return text_or(dot, path + strlen(path));
}

// By the ending of a file, or by a word alone.
picture_format picture_format_of(const char *path)
{
    static const struct {
        const char *name;
        picture_format format;
    } known[] = {{"png", FORMAT_PNG}, {"pdf", FORMAT_PDF}, {"svg", FORMAT_SVG}};

    // the ending of a file, or a word
    const char *ending = picture_ending(path), *slash = strrchr(path, '/');
    const char *word = path;
    if (ending[0] == '.') {
        word = ending + 1;
    } else if (slash != NULL) {
        word = slash + 1;
    }
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
        if (strcasecmp(word, known[i].name) == 0) {
            return known[i].format;
        }
    }
    return FORMAT_NONE;
}

static status check_extension(const char *path, fault *f)
{
    FAULT_IF(
        picture_format_of(path) == FORMAT_NONE || strchr(path, '.') == NULL, f,
        STATUS_BAD_ARGUMENT,
        "'%s' is no name for a picture: expected one that ends in .png, .pdf or .svg",
        path);
    return STATUS_OK;
}

status picture_check_path(const char *path, fault *f)
{
    TRY(check_extension(path, f));
    return whole_file_check(path, f);
}

char *picture_beside(const char *file, const char *ending)
{
    return text_printf("%.*s%s", (int)(picture_ending(file) - file), file, ending);
}

char *picture_for_latex(const char *path)
{
    if (picture_format_of(path) == FORMAT_SVG) {
        return picture_beside(path, ".pdf");
    }
    return g_strdup(path);
}
