// Scenarios as files: reading one, finding one by name, listing the folder of those that
// ship.

#include <dirent.h>
#include <errno.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "src/base/shipped.h"
#include "src/base/input_file.h"
#include "src/scenario/scenario.h"
#include "src/scenario/yaml_tree.h"
#include "src/base/words.h"

enum { MAX_FOLDER_DEPTH = 8 }; // stops at links that lead in a circle

static const char suffix[] = ".yaml";

// A growing list of names, of scenarios or folders.
typedef struct name_list {
    char **names;
    int count;
} name_list;

// Formats onto the heap; NULL without memory.
__attribute__((format(printf, 1, 2))) static char *text_of(const char *format, ...)
{
    char *text;
    va_list args;
    va_start(args, format);
    int length = vasprintf(&text, format, args);
    va_end(args);
    if (length < 0) {
        return NULL;
    }
    return text;
}

// Whether the errno of a failed call says that there is nothing of that name.
static bool is_missing(int reason)
{
    return reason == ENOENT || reason == ENOTDIR || reason == ENAMETOOLONG ||
           reason == ELOOP;
}

// What a path leads to: HIDDEN is what may not be looked at, which may be anything. Bits,
// so that several can be asked for at once.
enum { NOTHING = 1, FOLDER = 2, FILE_OR_LIKE = 4, HIDDEN = 8 };

static int kind_of_path(const char *path)
{
    struct stat information;
    if (stat(path, &information) == 0) {
        if (S_ISDIR(information.st_mode)) {
            return FOLDER;
        }
        return FILE_OR_LIKE;
    }
    if (is_missing(errno)) {
        return NOTHING;
    }
    return HIDDEN;
}

static bool is_folder(const char *path)
{
    return kind_of_path(path) == FOLDER;
}

// Whether a path leads to a file, or may do so: reading it will show what is wrong.
static bool is_file(const char *path)
{
    return (kind_of_path(path) & (FILE_OR_LIKE | HIDDEN)) != 0;
}

// ---- reading --------------------------------------------------------------------------

static status report_no_memory(fault_handler report, void *context)
{
    report(context, status_text(STATUS_NO_MEMORY));
    return STATUS_NO_MEMORY;
}

// Reports a sentence, printf-like. Returns `code`, or STATUS_NO_MEMORY if there is no
// memory for the sentence.
__attribute__((format(printf, 4, 5))) static status
report_sentence(fault_handler report, void *context, status code, const char *format, ...)
{
    char *sentence;
    va_list args;
    va_start(args, format);
    const int length = vasprintf(&sentence, format, args);
    va_end(args);
    if (length < 0) {
        return report_no_memory(report, context);
    }
    report(context, sentence);
    free(sentence);
    return code;
}

// Reports what is wrong with a file as a whole, at its beginning.
static status report_file(scenario *s, const char *path, const char *what,
                          fault_handler report, void *context)
{
    s->refused = (fault_place){1, 1, NULL};
    return report_sentence(report, context, STATUS_CANNOT_READ,
                           "%s:1:1: %s, expected a scenario file", path, what);
}

status scenario_read(scenario *s, const char *path, const char *name,
                     fault_handler report, void *context)
{
    fault why = {0};
    if (is_folder(path)) {
        return report_file(s, path, "it is a folder", report, context);
    }

    // one byte more than is allowed, so that the parser sees what is too long
    size_t length;
    char *text = input_file_read(path, (size_t)TREE_MAX_BYTES + 1, &length, &why);
    if (why.code == STATUS_NO_MEMORY) {
        return report_no_memory(report, context);
    }
    if (why.code == STATUS_BAD_ARGUMENT) {
        return report_sentence(report, context, why.code, "'%s' %s", path, why.text);
    }
    if (text == NULL) {
        return report_file(s, path, why.text, report, context);
    }
    const status result = scenario_parse(s, text, length, path, name, report, context);
    free(text);
    return result;
}

bool scenario_is(const char *path)
{
    scenario s;
    fault unused = {0};
    const bool is = scenario_read(&s, path, NULL, keep_first_fault, &unused) == STATUS_OK;
    if (is) {
        scenario_finish(&s);
    }
    return is;
}

// ---- the folder -----------------------------------------------------------------------

// Appends a copy of the first `length` bytes of a name to the list. False without memory.
static bool add_name(name_list *list, const char *name, size_t length)
{
    char **grown = realloc(list->names, (size_t)(list->count + 1) * sizeof *grown);
    if (grown == NULL) {
        return false;
    }
    list->names = grown;
    grown[list->count] = strndup(name, length);
    if (grown[list->count] == NULL) {
        return false;
    }
    list->count++;
    return true;
}

static void free_names(char **names, int count)
{
    for (int i = 0; i < count; i++) {
        free(names[i]);
    }
    free(names);
}

// Lists the folders of scenarios in the order of search: those of IMPACTLAB_SCENARIOS,
// then the one that ships. STATUS_CANNOT_READ if one of them does not exist; the list is
// complete nevertheless. STATUS_NO_MEMORY leaves the list empty, as with one folder less
// a name could mean another scenario.
static status name_folders(name_list *all, fault *f)
{
    const char *chosen = getenv("IMPACTLAB_SCENARIOS");
    bool good = true;
    *all = (name_list){0};

    // the user's, with colons between them
    while (good && chosen != NULL && *chosen != '\0') {
        size_t length = strcspn(chosen, ":");
        good = length == 0 || add_name(all, chosen, length);
        chosen += length + (chosen[length] == ':');
    }

    // the one that ships comes last
    char *shipped = good ? shipped_path(SHIPPED_SCENARIOS) : NULL;
    good = shipped != NULL && add_name(all, shipped, strlen(shipped));
    free(shipped);
    if (!good) {
        free_names(all->names, all->count);
        *all = (name_list){0};
        return fault_no_memory(f);
    }

    // all must exist, but for the one that ships if the user has others
    status result = STATUS_OK;
    for (int i = 0; i < all->count && result == STATUS_OK; i++) {
        const bool needed = i < all->count - 1 || i == 0;
        if (needed && (kind_of_path(all->names[i]) & (FILE_OR_LIKE | NOTHING)) != 0) {
            result = fault_set(f, STATUS_CANNOT_READ,
                               "%.500s: no such folder, expected the scenarios there "
                               "(IMPACTLAB_SCENARIOS adds folders, separated by colons)",
                               all->names[i]);
        }
    }
    return result;
}

// The path of a file in the first folder that has it; in the last folder if none has it.
// NULL without memory, or without a list of folders.
static char *find_file(const char *name, const char *ending)
{
    name_list all;
    char *path = NULL;
    bool found = name_folders(&all, NULL) == STATUS_NO_MEMORY; // or nothing to look in
    for (int i = 0; !found && i < all.count; i++) {
        free(path);
        path = text_of("%s/%s%s", all.names[i], name, ending);
        found = path == NULL || is_file(path);
    }
    free_names(all.names, all.count);
    return path;
}

char *scenario_folder_file(const char *name)
{
    return find_file(name, "");
}

// A folder among the scenarios that holds none: the recipes of figures.
static const char no_scenarios[] = "recipes";

static status walk(name_list *list, const char *folder, const char *prefix, int depth,
                   fault *f);

// Reports that a folder cannot be listed, for the reason in errno.
static status cannot_list(const char *folder, fault *f)
{
    if (errno == ENOMEM) {
        return fault_no_memory(f);
    }
    return fault_set(f, STATUS_CANNOT_READ,
                     "%.500s cannot be listed (%s), expected scenarios there", folder,
                     strerror(errno));
}

// Adds one entry of a folder to the list: a scenario, or all scenarios of a folder below
// it. `prefix` is the folder's name as the list has it.
static status add_entry(name_list *list, const char *folder, const char *prefix,
                        const char *entry, int depth, fault *f)
{
    char *path = text_of("%s/%s", folder, entry);
    char *name = text_of("%s%s%s", prefix, prefix[0] != '\0' ? "/" : "", entry);
    status code = STATUS_OK;
    if (!(path != NULL && name != NULL)) {
        code = fault_no_memory(f);
    }

    // what the entry is; a link that leads nowhere counts as a file
    struct stat about = {0};
    if (code == STATUS_OK && stat(path, &about) != 0 && !is_missing(errno)) {
        code = cannot_list(folder, f);
    }

    // the scenarios of a folder have its name before theirs; only .yaml files are
    // scenarios
    if (code == STATUS_OK && S_ISDIR(about.st_mode)) {
        if (depth < MAX_FOLDER_DEPTH) {
            code = walk(list, path, name, depth + 1, f);
        }
    } else if (code == STATUS_OK && entry[text_stem(entry, suffix)] != '\0') {
        if (!add_name(list, name, text_stem(name, suffix))) {
            code = fault_no_memory(f);
        }
    }

    free(path);
    free(name);
    return code;
}

// Adds the scenarios in a folder and in those below it. A folder below that the user may
// not read counts as empty.
static status walk(name_list *list, const char *folder, const char *prefix, int depth,
                   fault *f)
{
    DIR *directory = opendir(folder);
    if (directory == NULL) {
        const bool hidden = errno == EACCES && depth > 0;
        if (hidden || errno == ENOENT) {
            return STATUS_OK;
        }
        return cannot_list(folder, f);
    }

    // every entry that may be a scenario or a folder of them
    status code = STATUS_OK;
    struct dirent *entry;
    while (code == STATUS_OK && (errno = 0, entry = readdir(directory)) != NULL) {
        bool skipped = depth == 0 && strcmp(entry->d_name, no_scenarios) == 0;
        if (entry->d_name[0] != '.' && !skipped) {
            code = add_entry(list, folder, prefix, entry->d_name, depth, f);
        }
    }
    if (code == STATUS_OK && errno != 0) {
        code = cannot_list(folder, f);
    }

    closedir(directory);
    return code;
}

// Digits are compared as numbers: fig-3-2 comes before fig-3-10.
static int compare_names(const void *a, const void *b)
{
    return strverscmp(*(char *const *)a, *(char *const *)b);
}

// Sorts the names and removes duplicates, which come from several folders.
static void sort_without_duplicates(name_list *list)
{
    if (list->count == 0) {
        return;
    }

    // equal names become neighbours
    qsort(list->names, (size_t)list->count, sizeof *list->names, compare_names);
    int unique = 1;
    for (int i = 1; i < list->count; i++) {
        if (strcmp(list->names[i], list->names[unique - 1]) == 0) {
            free(list->names[i]);
        } else {
            list->names[unique++] = list->names[i];
        }
    }
    list->count = unique;
}

status scenario_list(char ***names, int *count, fault *f)
{
    name_list list = {0};
    *names = NULL;
    *count = 0;

    // those of every folder
    name_list all;
    status result = name_folders(&all, f);
    for (int i = 0; i < all.count && result == STATUS_OK; i++) {
        result = walk(&list, all.names[i], "", 0, f);
    }
    free_names(all.names, all.count);
    if (result != STATUS_OK) {
        free_names(list.names, list.count);
        return result;
    }

    sort_without_duplicates(&list);
    *names = list.names;
    *count = list.count;
    return STATUS_OK;
}

// ---- finding --------------------------------------------------------------------------

// Reports a name that is neither that of a scenario nor of a file, with the nearest name
// that is.
static status report_unknown(const char *wanted, fault_handler report, void *context)
{
    char **names;
    int count;
    char *stem = strndup(wanted, text_stem(wanted, suffix));
    fault unread = {0};
    if (stem == NULL || scenario_list(&names, &count, &unread) == STATUS_NO_MEMORY) {
        free(stem);
        return report_no_memory(report, context);
    }

    // the nearest of the shipped scenarios, if their folder can be read
    const char *near = name_nearest(names, sizeof *names, count, stem);
    const status code = STATUS_BAD_ARGUMENT;
    status reported;
    if (unread.text[0] != '\0') {
        reported = report_sentence(report, context, code,
                                   "'%s' is no file, and no scenario can be found: %s",
                                   wanted, unread.text);
    } else if (near != NULL) {
        reported =
            report_sentence(report, context, code,
                            "'%s' is neither a scenario nor a file, did you mean '%s'?",
                            wanted, near);
    } else {
        reported =
            report_sentence(report, context, code,
                            "'%s' is neither a scenario nor a file, expected a name that "
                            "'impactlab list' shows or the path of a file",
                            wanted);
    }
    free_names(names, count);
    free(stem);
    return reported;
}

// Whether the list of scenarios could have a name: it has no empty or hidden part, is not
// too deep, and is not in the folder that holds no scenarios.
static bool may_be_listed(const char *name)
{
    const size_t skipped = sizeof no_scenarios - 1;
    int depth = 0;
    for (const char *part = name; part != NULL; depth++) {
        if (*part == '/' || *part == '.' || *part == '\0') {
            return false;
        }
        part = strchr(part, '/');
        if (part != NULL) {
            part++;
        }
    }
    return depth <= MAX_FOLDER_DEPTH + 1 &&
           !(strncmp(name, no_scenarios, skipped) == 0 && name[skipped] == '/');
}

char *scenario_file_or_folder_file(const char *name)
{
    if (is_file(name) || !may_be_listed(name)) {
        return strdup(name);
    }
    char *path = find_file(name, "");
    if (path == NULL || is_file(path)) {
        return path;
    }
    free(path);
    return strdup(name);
}

// Finds the file of a scenario by its name in the list. *path is on the heap, and NULL if
// the list has no such scenario or a folder of scenarios does not exist. STATUS_NO_MEMORY
// is the only failure.
static status find_name(const char *wanted, char **path)
{
    // the folders must exist, and the name must be possible
    struct stat about;
    name_list all;
    *path = NULL;
    status folders = name_folders(&all, NULL);
    free_names(all.names, all.count);
    if (folders != STATUS_OK || !may_be_listed(wanted)) {
        if (folders == STATUS_NO_MEMORY) {
            return folders;
        }
        return STATUS_OK;
    }

    // a file, also one that cannot be looked at or a link that leads nowhere: both are
    // listed, and reading them will show what is wrong
    *path = find_file(wanted, suffix);
    const bool missing = *path != NULL && lstat(*path, &about) != 0 && is_missing(errno);
    if (*path != NULL && (missing || is_folder(*path))) {
        free(*path);
        *path = NULL;
        return STATUS_OK;
    }
    if (*path == NULL) {
        return STATUS_NO_MEMORY;
    }
    return STATUS_OK;
}

status scenario_open(scenario *s, const char *name_or_file, fault_handler report,
                     void *context)
{
    // a scenario of the folder
    char *path;
    status result = find_name(name_or_file, &path);
    if (result != STATUS_OK) {
        return report_no_memory(report, context);
    }
    if (path != NULL) {
        result = scenario_read(s, path, name_or_file, report, context);
        free(path);
        return result;
    }

    // a file, with its ending or without
    path = text_of("%s%s", name_or_file, suffix);
    if (path == NULL) {
        return report_no_memory(report, context);
    }
    const char *file;
    if (is_file(name_or_file)) {
        file = name_or_file;
    } else if (is_file(path)) {
        file = path;
    } else if (is_folder(name_or_file)) {
        file = name_or_file;
    } else {
        file = NULL;
    }
    if (file != NULL) {
        result = scenario_read(s, file, NULL, report, context);
    } else {
        result = report_unknown(name_or_file, report, context);
    }
    free(path);
    return result;
}
