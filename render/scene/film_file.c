#include "render/scene/film_file.h"

#include <assert.h>
#include <dirent.h>
#include <errno.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "src/base/whole_file.h"

enum { FRAME_DPI = 144 };

struct film_file {
    const film_format *format; // NULL: frames in a folder
    film_facts facts;
    char *path;
    int frames;           // written so far
    whole_file file;      // of a film
    film_encoder encoder; // of a film
};

// ---- checks

// A name without an ending means a folder, as does one that is there.
static bool means_folder(const char *path)
{
    struct stat found;
    const char *slash = strrchr(path, '/'), *dot = strrchr(slash ? slash : path, '.');
    bool folder = stat(path, &found) == 0 && S_ISDIR(found.st_mode);
    return folder || dot == NULL || dot[1] == '\0' || dot[1] == '/';
}

static bool is_empty_folder(const char *path)
{
    DIR *folder = opendir(path);
    int entries = 0;
    while (folder != NULL && readdir(folder) != NULL) {
        entries++;
    }
    if (folder != NULL) {
        closedir(folder);
    }
    return folder != NULL && entries <= 2;
}

static status check_folder(const char *path, fault *f)
{
    struct stat found;
    if (stat(path, &found) != 0) {
        // made later; its own folder must take it
        return whole_file_check(path, f);
    }

    // a folder, and an empty one
    if (!S_ISDIR(found.st_mode)) {
        return fault_set(f, STATUS_CANNOT_WRITE,
                         "%s is a file: expected the name of a folder, or one that ends in .mp4, "
                         ".webm, .gif or .webp",
                         path);
    }
    whole_file_clean_folder(path);
    if (!is_empty_folder(path)) {
        return fault_set(f, STATUS_CANNOT_WRITE,
                         "the folder %s is not empty: frames of two films would mix, empty it or "
                         "name another",
                         path);
    }
    return STATUS_OK;
}

status film_file_check(const char *path, fault *f)
{
    assert(path != NULL);
    bool folder = film_format_of(path) == NULL && means_folder(path);

    if ((film_format_of(path) == NULL && !folder) || strcmp(path, "-") == 0) {
        return fault_set(f, STATUS_BAD_ARGUMENT,
                         "'%s' is no name for a film: expected one that ends in .mp4, .webm, "
                         ".gif or .webp, or a folder for PNG frames",
                         path);
    }

    if (folder) {
        return check_folder(path, f);
    }

    if (!film_encoder_is_there()) {
        return fault_set(f, STATUS_CANNOT_WRITE,
                         "%s needs the program ffmpeg, which is not installed: install the package "
                         "ffmpeg, or give a folder to get PNG frames",
                         path);
    }
    return whole_file_check(path, f);
}

// Whether the finished file has the marks of its format.
static bool looks_whole(const film_file *film)
{
    FILE *file = fopen(film->file.temporary ? film->file.temporary : film->file.path, "rb");
    bool whole = file != NULL;

    for (int i = 0; i < FILM_MARKS && whole && film->format->marks[i].bytes != NULL; i++) {
        char found[8];
        const long offset = film->format->marks[i].offset;
        const char *mark = film->format->marks[i].bytes;
        const size_t length = strlen(mark);
        assert(length <= sizeof found);
        whole = fseek(file, offset, offset < 0 ? SEEK_END : SEEK_SET) == 0 &&
                fread(found, 1, length, file) == length && memcmp(found, mark, length) == 0;
    }
    if (file != NULL) {
        fclose(file);
    }
    return whole;
}

// ---- the film

static status make_folder(const film_file *film, fault *f)
{
    if (mkdir(film->path, 0777) != 0 && errno != EEXIST) {
        return fault_set(f, STATUS_CANNOT_WRITE, "the folder %s could not be made: %s", film->path,
                         strerror(errno));
    }
    return STATUS_OK;
}

static void film_file_free(film_file *film)
{
    film_encoder_finish(&film->encoder);
    free(film->path);
    free(film);
}

status film_file_open(film_file **out, const char *path, const film_facts *facts, fault *f)
{
    assert(out != NULL && path != NULL && facts != NULL && facts->width > 0 && facts->height > 0);
    *out = NULL;
    status code = film_file_check(path, f);
    if (code != STATUS_OK) {
        return code;
    }

    film_file *film = calloc(1, sizeof *film);
    if (film != NULL) {
        film->path = strdup(path);
    }
    if (film == NULL || film->path == NULL) {
        free(film);
        return fault_set(f, STATUS_NO_MEMORY, "no memory for a film");
    }

    // into a folder of frames, or through the encoder
    film->format = film_format_of(path);
    film->facts = *facts;
    film->encoder.pipe = -1;
    if (film->format == NULL) {
        code = make_folder(film, f);
    } else {
        code = whole_file_open(&film->file, path, f);
        if (code == STATUS_OK) {
            // to the temporary, which is renamed once it is whole
            const char *target = film->file.temporary ? film->file.temporary : film->file.path;
            code = film_encoder_start(&film->encoder, film->format, facts, target, f);
            if (code != STATUS_OK) {
                whole_file_abandon(&film->file);
            }
        }
    }
    if (code != STATUS_OK) {
        film_file_free(film);
        return code;
    }
    *out = film;
    return STATUS_OK;
}

static status add_to_folder(film_file *film, cairo_surface_t *frame, fault *f)
{
    char path[4096];
    whole_file file;
    snprintf(path, sizeof path, "%s/frame-%05d.png", film->path, film->frames + 1);
    status code = whole_file_open(&file, path, f);
    if (code != STATUS_OK) {
        return code;
    }
    code =
        png_file_write(file.stream, frame, FRAME_DPI, film->facts.notes, film->facts.note_count, f);
    return whole_file_close(&file, code, f);
}

bool film_file_wants_palette(const film_file *film)
{
    assert(film != NULL);
    return film->format != NULL && film->format->palette;
}

static status stopped(const film_file *film, fault *f)
{
    return fault_set(f, STATUS_STOPPED, "interrupted after %d frames", film->frames);
}

static status complain_encoder(const film_file *film, const char *said, fault *f)
{
    return fault_set(f, STATUS_CANNOT_WRITE, "%s could not be made, ffmpeg says: %s", film->path,
                     said[0] ? said : "nothing");
}

// Row by row, as a surface's rows may be longer than the picture.
static status send_frame(film_file *film, cairo_surface_t *frame, fault *f)
{
    status code = STATUS_OK;
    cairo_surface_flush(frame);
    const unsigned char *data = cairo_image_surface_get_data(frame);
    ptrdiff_t stride = cairo_image_surface_get_stride(frame);
    for (int row = 0; row < film->facts.height && code == STATUS_OK; row++) {
        code =
            film_encoder_send(&film->encoder, data + row * stride, 4 * (size_t)film->facts.width);
    }

    // the fault gets its sentence here, where the film is known
    if (code == STATUS_STOPPED) {
        return stopped(film, f);
    }
    if (code != STATUS_OK) {
        char said[512];
        film_encoder_end(&film->encoder, said, sizeof said);
        return complain_encoder(film, said, f);
    }
    return STATUS_OK;
}

status film_file_add(film_file *film, cairo_surface_t *frame, fault *f)
{
    assert(film != NULL && frame != NULL);
    status code = film->format == NULL ? add_to_folder(film, frame, f) : send_frame(film, frame, f);
    film->frames++;
    return code;
}

status film_file_commit(film_file *film, fault *f)
{
    assert(film != NULL);
    status code = STATUS_OK;

    // only an encoder can fail this late, frames are there already
    if (film->format != NULL) {
        // its words, then its work
        char said[512];
        bool content = film_encoder_end(&film->encoder, said, sizeof said);

        // a stop also makes the encoder fail, so it is asked for first
        if (film->facts.stop != NULL && *film->facts.stop != 0) {
            code = stopped(film, f);
        } else if (!content) {
            code = complain_encoder(film, said, f);
        } else if (film->file.temporary != NULL && !looks_whole(film)) {
            code = fault_set(f, STATUS_CANNOT_WRITE,
                             "%s could not be made: ffmpeg left a file that is no such film",
                             film->path);
        }
        code = whole_file_close(&film->file, code, f);
    }

    // of no more use, whatever came of it
    film_file_free(film);
    return code;
}

void film_file_abandon(film_file *film)
{
    assert(film != NULL);
    if (film->format != NULL) {
        film_encoder_finish(&film->encoder);
        whole_file_abandon(&film->file);
    }
    film_file_free(film);
}
