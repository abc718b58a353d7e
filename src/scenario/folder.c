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

// Whether a call that failed says that there is nothing of that name.
static bool is_missing(int reason)
{
    return reason == ENOENT || reason == ENOTDIR || reason == ENAMETOOLONG ||
           reason == ELOOP;
}

// What a name is of; what cannot be looked at may be anything.
enum { NOTHING = 1, FOLDER = 2, FILE_OR_LIKE = 4, HIDDEN = 8 };

static int kind_of(const char *path)
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
    return kind_of(path) == FOLDER;
}

// Whether there is a file of that name, or what cannot be looked at: its reader will
// tell.
static bool is_file(const char *path)
{
    return (kind_of(path) & (FILE_OR_LIKE | HIDDEN)) != 0;
}

// ---- reading --------------------------------------------------------------------------

static status report_no_memory(fault_handler report, void *context)
{
    report(context, status_text(STATUS_NO_MEMORY));
    return STATUS_NO_MEMORY;
}

// Reports a sentence, printf-like. Returns `code`; STATUS_NO_MEMORY where there is none
// for it.
__attribute__((format(printf, 4, 5))) static status
tell(fault_handler report, void *context, status code, const char *format, ...)
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

// What is wrong with a file as a whole.
static status report_file(scenario *s, const char *path, const char *what,
                          fault_handler report, void *context)
{
    s->refused = (fault_place){1, 1, NULL};
    return tell(report, context, STATUS_CANNOT_READ,
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
        return tell(report, context, why.code, "'%s' %s", path, why.text);
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

// The folders to look in: those of IMPACTLAB_SCENARIOS, then that of the scenarios that
// ship. STATUS_CANNOT_READ if one is not there, all are named nevertheless.
// STATUS_NO_MEMORY, and then none is: a folder less would be another scenario of the same
// name.
static status name_folders(name_list *all, fault *f)
{
    const char *chosen = getenv("IMPACTLAB_SCENARIOS");
    bool good = true;
    *all = (name_list){0};

    // the user's
    while (good && chosen != NULL && *chosen != '\0') {
        size_t length = strcspn(chosen, ":");
        good = length == 0 || add_name(all, chosen, length);
        chosen += length + (chosen[length] == ':');
    }

    // the one that ships comes last, behind all that the user has
    char *shipped = good ? shipped_path(SHIPPED_SCENARIOS) : NULL;
    good = shipped != NULL && add_name(all, shipped, strlen(shipped));
    free(shipped);
    if (!good) {
        free_names(all->names, all->count);
        *all = (name_list){0};
        return fault_no_memory(f);
    }

    // those that were named are enough
    status result = STATUS_OK;
    for (int i = 0; i < all->count && result == STATUS_OK; i++) {
        const bool needed = i < all->count - 1 || i == 0;
        if (needed && (kind_of(all->names[i]) & (FILE_OR_LIKE | NOTHING)) != 0) {
            result = fault_set(f, STATUS_CANNOT_READ,
                               "%.500s: no such folder, expected the scenarios there "
                               "(IMPACTLAB_SCENARIOS adds folders, separated by colons)",
                               all->names[i]);
        }
    }
    return result;
}

// The file of that name in the first folder that has it, else in the last; NULL without
// memory.
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

static const char no_scenarios[] = "recipes"; // a folder of what belongs to figures

static status walk(name_list *list, const char *folder, const char *prefix, int depth,
                   fault *f);

// Why a folder's scenarios are not known.
static status cannot_list(const char *folder, fault *f)
{
    if (errno == ENOMEM) {
        return fault_no_memory(f);
    }
    return fault_set(f, STATUS_CANNOT_READ,
                     "%.500s cannot be listed (%s), expected scenarios there", folder,
                     strerror(errno));
}

// Adds one entry of a folder, or what is below it.
static status add_entry(name_list *list, const char *folder, const char *prefix,
                        const char *entry, int depth, fault *f)
{
    char *path = text_of("%s/%s", folder, entry);
    char *name = text_of("%s%s%s", prefix, prefix[0] != '\0' ? "/" : "", entry);
    status code = STATUS_OK;
    if (!(path != NULL && name != NULL)) {
        code = fault_no_memory(f);
    }
    struct stat about = {0};
    if (code == STATUS_OK && stat(path, &about) != 0 && !is_missing(errno)) {
        code = cannot_list(folder, f);
    }

    // a folder's scenarios have its name before theirs; other files than .yaml are none
    if (code == STATUS_OK && S_ISDIR(about.st_mode)) {
        if (depth < MAX_FOLDER_DEPTH) {
            code = walk(list, path, name, depth + 1, f);
        } else {
            code = STATUS_OK;
        }
    } else if (code == STATUS_OK && entry[text_stem(entry, suffix)] != '\0') {
        if (add_name(list, name, text_stem(name, suffix))) {
            code = STATUS_OK;
        } else {
            code = fault_no_memory(f);
        }
    }

    free(path);
    free(name);
    return code;
}

// Adds the scenarios in and below a folder; one below that is not the user's to read
// counts as empty.
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

// Sorts the names; one that several folders have stays once.
static void sort_once(name_list *list)
{
    if (list->count == 0) {
        return;
    }

    // equal names become neighbours
    qsort(list->names, (size_t)list->count, sizeof *list->names, compare_names);
    int kept = 1;
    for (int i = 1; i < list->count; i++) {
        if (strcmp(list->names[i], list->names[kept - 1]) == 0) {
            free(list->names[i]);
        } else {
            list->names[kept++] = list->names[i];
        }
    }
    list->count = kept;
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

    sort_once(&list);
    *names = list.names;
    *count = list.count;
    return STATUS_OK;
}

// ---- finding --------------------------------------------------------------------------

// Says what is wrong with a name that is neither listed nor a file.
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
    status told;
    if (unread.text[0] != '\0') {
        told = tell(report, context, code,
                    "'%s' is no file, and no scenario can be found: %s", wanted,
                    unread.text);
    } else if (near != NULL) {
        told = tell(report, context, code,
                    "'%s' is neither a scenario nor a file, did you mean '%s'?", wanted,
                    near);
    } else {
        told = tell(report, context, code,
                    "'%s' is neither a scenario nor a file, expected a name that "
                    "'impactlab list' shows or the path of a file",
                    wanted);
    }
    free_names(names, count);
    free(stem);
    return told;
}

// Whether the list may show a name: none of its parts is empty or hidden, nor are they
// too many.
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
            part = part + 1;
        } else {
            part = NULL;
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

// The file of a scenario that the list has, on the heap; *path is NULL if it has none of
// that name. It has none at all if a folder is not there; STATUS_NO_MEMORY is the only
// failure.
static status find_name(const char *wanted, char **path)
{
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

    // a link that leads nowhere is listed, too; of one that cannot be looked at its
    // reader tells
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
