#include "render/scene/film_file.h"

#include <assert.h>
#include <errno.h>
#include <dirent.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "src/base/whole_file.h"

extern char **environ;

typedef enum film_kind {
    FILM_UNKNOWN,
    FILM_MP4,
    FILM_WEBM,
    FILM_GIF,
    FILM_WEBP,
    FILM_FRAMES
} film_kind;

enum {
    ARGUMENTS_MOST = 64,
    FRAME_DPI = 144,
    PATIENCE = 200 // longest until a request to stop is seen [ms]
};

struct film_file {
    film_kind kind;
    film_facts facts;
    char *path;
    int frames;      // written so far
    whole_file file; // of a film
    pid_t encoder;   // 0: none runs
    int pipe;        // to it, -1 if closed
    FILE *words;     // what it says
};

static film_kind kind_of(const char *path)
{
    static const struct {
        const char *ending;
        film_kind kind;
    } known[] = {
        {".mp4", FILM_MP4}, {".webm", FILM_WEBM}, {".gif", FILM_GIF}, {".webp", FILM_WEBP}};

    struct stat found;
    const char *slash = strrchr(path, '/'), *dot = strrchr(slash ? slash : path, '.');
    for (size_t i = 0; dot != NULL && i < sizeof known / sizeof known[0]; i++) {
        if (strcasecmp(dot, known[i].ending) == 0) {
            return known[i].kind;
        }
    }

    // a name without an ending means a folder, as does one that is there
    bool folder = stat(path, &found) == 0 && S_ISDIR(found.st_mode);
    return folder || dot == NULL || dot[1] == '\0' || dot[1] == '/' ? FILM_FRAMES : FILM_UNKNOWN;
}

// ---- checks

static bool has_ffmpeg(void)
{
    const char *folders = getenv("PATH");
    bool found = false;
    while (folders != NULL && *folders != '\0' && !found) {
        char path[4096];
        int length = (int)strcspn(folders, ":");
        snprintf(path, sizeof path, "%.*s/ffmpeg", length, folders);
        found = access(path, X_OK) == 0;
        folders += length + (folders[length] == ':');
    }
    return found;
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
    film_kind kind = kind_of(path);

    if (kind == FILM_UNKNOWN || strcmp(path, "-") == 0) {
        return fault_set(f, STATUS_BAD_ARGUMENT,
                         "'%s' is no name for a film: expected one that ends in .mp4, .webm or "
                         ".gif, .webp, or a folder for PNG frames",
                         path);
    }

    if (kind == FILM_FRAMES) {
        return check_folder(path, f);
    }

    if (!has_ffmpeg()) {
        return fault_set(f, STATUS_CANNOT_WRITE,
                         "%s needs the program ffmpeg, which is not installed: install the package "
                         "ffmpeg, or give a folder to get PNG frames",
                         path);
    }
    return whole_file_check(path, f);
}

// ---- ffmpeg

typedef struct argument_list {
    char *words[ARGUMENTS_MOST];
    int count;
    bool out_of_memory;
} argument_list;

static void add_word(argument_list *list, const char *word)
{
    char *copy = list->count + 1 < ARGUMENTS_MOST ? strdup(word) : NULL;
    list->out_of_memory = list->out_of_memory || copy == NULL;
    if (copy != NULL) {
        list->words[list->count++] = copy;
    }
}

// Words separated by blanks.
static void add_words(argument_list *list, const char *words)
{
    while (*words != '\0') {
        char word[512];
        int length = (int)strcspn(words, " ");
        snprintf(word, sizeof word, "%.*s", length, words);
        add_word(list, word);
        words += length + (words[length] == ' ');
    }
}

static void add_notes(argument_list *list, const film_facts *facts)
{
    for (int i = 0; i < facts->note_count; i++) {
        const png_note *note = &facts->notes[i];
        char *word = malloc(strlen(note->keyword) + strlen(note->text ? note->text : "") + 16);
        if (word == NULL || note->text == NULL) {
            free(word);
            continue;
        }

        // the containers know few keys; a comment takes the parameters
        bool title = strcmp(note->keyword, "Title") == 0;
        bool parameters_note = strcmp(note->keyword, "Parameters") == 0;
        if (title || parameters_note) {
            sprintf(word, "%s=%s", title ? "title" : "comment", note->text);
        } else {
            sprintf(word, "%s=%s",
                    strcmp(note->keyword, "Software") == 0 ? "artist" : "description", note->text);
        }

        add_word(list, "-metadata");
        add_word(list, word);
        free(word);
    }
}

// How each kind of film is made. Fixed numbers of threads and bitexact keep the bytes alike.
static void add_codec(argument_list *list, film_kind kind)
{
    static const char *const words[] = {
        [FILM_MP4] =
            "-vf scale=out_color_matrix=bt709 -c:v libx264 -preset fast -crf 18 -threads 2 "
            "-pix_fmt yuv420p -colorspace bt709 -color_primaries bt709 -color_trc bt709 "
            "-movflags +faststart -f mp4",

        [FILM_WEBM] =
            "-vf scale=out_color_matrix=bt709 -c:v libvpx-vp9 -b:v 0 -crf 24 -deadline "
            "realtime -cpu-used 7 -row-mt 1 -threads 2 -pix_fmt yuv420p -colorspace bt709 "
            "-color_primaries bt709 -color_trc bt709 -f webm",
        // the first frame only gives the palette: no later one has to wait for the film's end
        [FILM_GIF] = "-filter_complex split[a][b];"
                     "[a]trim=end_frame=1,palettegen[p];[b]trim=start_frame=1,"
                     "setpts=PTS-STARTPTS[c];[c][p]paletteuse=dither=none:diff_mode=rectangle "
                     "-loop 0 -f gif",
        [FILM_WEBP] = "-c:v libwebp_anim -lossless 0 -q:v 82 -compression_level 4 -loop 0 -f webp",
    };
    add_words(list, words[kind]);
    add_words(list, "-fflags +bitexact -flags:v +bitexact");
}

static void list_arguments(argument_list *list, const film_file *film)
{
    char word[4096 + 8];

    // raw frames from the pipe
    add_words(list, "ffmpeg -hide_banner -loglevel error -nostats -y -f rawvideo -pix_fmt bgr0 -s");
    snprintf(word, sizeof word, "%dx%d", film->facts.width, film->facts.height);
    add_word(list, word);
    add_word(list, "-r");
    snprintf(word, sizeof word, "%d", film->facts.frames_per_second);
    add_word(list, word);

    add_words(list, "-i pipe:0 -an");
    add_codec(list, film->kind);
    add_notes(list, &film->facts);

    // to the temporary, which is renamed once it is whole
    const char *target = film->file.temporary ? film->file.temporary : film->file.path;
    snprintf(word, sizeof word, "file:%s", target);
    add_word(list, word);
    list->words[list->count] = NULL;
}

// Starts ffmpeg with its input from `input` and its words going to film->words.
static status spawn(film_file *film, char **words, int input, fault *f)
{
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    sigset_t defaults;

    // frames come in, complaints go to a file of ours
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, input, 0);
    posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, fileno(film->words), 2);

    // a group of its own: an interrupt of the terminal reaches us, and we end it in order
    posix_spawnattr_init(&attributes);
    sigemptyset(&defaults);
    sigaddset(&defaults, SIGPIPE);
    posix_spawnattr_setsigdefault(&attributes, &defaults);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);

    int failed = posix_spawnp(&film->encoder, words[0], &actions, &attributes, words, environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    if (failed != 0) {
        film->encoder = 0;
        return fault_set(f, STATUS_CANNOT_WRITE, "the program ffmpeg could not be started: %s",
                         strerror(failed));
    }
    return STATUS_OK;
}

static status start_encoder(film_file *film, fault *f)
{
    argument_list list = {.count = 0};
    int ends[2];
    status code = STATUS_NO_MEMORY;
    list_arguments(&list, film);
    film->words = tmpfile();

    if (list.out_of_memory) {
        fault_set(f, code, "no memory for a film");
    } else if (film->words == NULL ||
               socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) {
        code = fault_set(f, STATUS_CANNOT_WRITE, "the program ffmpeg could not be started: %s",
                         strerror(errno));
    } else {
        code = spawn(film, list.words, ends[0], f);
        close(ends[0]);
        film->pipe = ends[1];
    }

    for (int i = 0; i < list.count; i++) {
        free(list.words[i]);
    }
    return code;
}

static bool is_asked_to_stop(const film_file *film)
{
    return film->facts.stop != NULL && *film->facts.stop != 0;
}

// Waits for the encoder's end and returns its status. One that hangs is ended when we are asked to
// stop.
static int wait_for_encoder(film_file *film)
{
    const struct timespec moment = {.tv_nsec = 5000000};
    int result = -1;
    while (waitpid(film->encoder, &result, WNOHANG) == 0) {
        if (is_asked_to_stop(film)) {
            kill(film->encoder, SIGKILL);
        }
        nanosleep(&moment, NULL);
    }
    film->encoder = 0;
    return result;
}

// Waits for the encoder and takes its last words. True if it succeeded without any.
static bool end_encoder(film_file *film, char *said, size_t size)
{
    int result = -1;
    said[0] = '\0';

    // the end of the frames is what ends it
    if (film->pipe >= 0) {
        close(film->pipe);
        film->pipe = -1;
    }
    if (film->encoder > 0) {
        result = wait_for_encoder(film);
    }

    // what it complained about; the first complaint is the cause, later ones follow from it
    rewind(film->words);
    char line[512];
    while (fgets(line, sizeof line, film->words) != NULL) {
        line[strcspn(line, "\r\n")] = '\0';
        if (said[0] == '\0') {
            snprintf(said, size, "%s", line);
        }
    }
    return WIFEXITED(result) && WEXITSTATUS(result) == 0 && said[0] == '\0';
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

static status send_bytes(film_file *film, const unsigned char *bytes, size_t length, fault *f)
{
    while (length > 0) {
        // not longer than a moment, in case the encoder hangs
        struct pollfd ready = {.fd = film->pipe, .events = POLLOUT};
        poll(&ready, 1, PATIENCE);
        if (is_asked_to_stop(film)) {
            return stopped(film, f);
        }

        // a reader that went away is an error, not a signal
        ssize_t sent = send(film->pipe, bytes, length, MSG_NOSIGNAL | MSG_DONTWAIT);
        if (sent < 0 && errno != EINTR && errno != EAGAIN) {
            char said[512];
            end_encoder(film, said, sizeof said);
            return complain_encoder(film, said, f);
        }
        bytes += sent > 0 ? sent : 0;
        length -= sent > 0 ? (size_t)sent : 0;
    }
    return STATUS_OK;
}

// Whether the bytes at a place of a file are those of `mark`.
static bool has_mark(FILE *file, long offset, int from, const char *mark, size_t length)
{
    char found[8];
    return fseek(file, offset, from) == 0 && fread(found, 1, length, file) == length &&
           memcmp(found, mark, length) == 0;
}

// Whether the finished file begins, and where its kind has an end of its own ends, as it should.
static bool looks_whole(const film_file *film)
{
    FILE *file = fopen(film->file.temporary ? film->file.temporary : film->file.path, "rb");
    bool whole = false;
    if (file == NULL) {
        return false;
    }

    // ISO/IEC 14496-12, an ftyp box first; RFC 8794, the EBML mark; GIF89a, a trailer last
    switch (film->kind) {
    case FILM_MP4:
        whole = has_mark(file, 4, SEEK_SET, "ftyp", 4);
        break;
    case FILM_WEBM:
        whole = has_mark(file, 0, SEEK_SET, "\x1a\x45\xdf\xa3", 4);
        break;
    case FILM_GIF:
        whole = has_mark(file, 0, SEEK_SET, "GIF8", 4) && has_mark(file, -1, SEEK_END, ";", 1);
        break;
    default:
        break;
    }
    fclose(file);
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
    if (film->words != NULL) {
        fclose(film->words);
    }
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
    film->kind = kind_of(path);
    film->facts = *facts;
    film->pipe = -1;
    if (film->kind == FILM_FRAMES) {
        code = make_folder(film, f);
    } else {
        code = whole_file_open(&film->file, path, f);
        if (code == STATUS_OK) {
            code = start_encoder(film, f);
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
    return film->kind == FILM_GIF;
}

status film_file_add(film_file *film, cairo_surface_t *frame, fault *f)
{
    assert(film != NULL && frame != NULL);
    status code = STATUS_OK;

    // a folder gets pictures, the encoder bytes
    if (film->kind == FILM_FRAMES) {
        code = add_to_folder(film, frame, f);
    } else {
        // row by row, as a surface's rows may be longer than the picture
        cairo_surface_flush(frame);
        const unsigned char *data = cairo_image_surface_get_data(frame);
        ptrdiff_t stride = cairo_image_surface_get_stride(frame);
        for (int row = 0; row < film->facts.height && code == STATUS_OK; row++) {
            code = send_bytes(film, data + row * stride, 4 * (size_t)film->facts.width, f);
        }
    }
    film->frames++;
    return code;
}

status film_file_commit(film_file *film, fault *f)
{
    assert(film != NULL);
    status code = STATUS_OK;

    // only an encoder can fail this late, frames are there already
    if (film->kind != FILM_FRAMES) {
        // its words, then its work
        char said[512];
        bool content = end_encoder(film, said, sizeof said);

        // a stop also makes the encoder fail, so it is asked for first
        if (is_asked_to_stop(film)) {
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
    if (film->kind != FILM_FRAMES) {
        char said[512];
        if (film->encoder > 0) {
            kill(film->encoder, SIGKILL);
        }
        end_encoder(film, said, sizeof said);
        whole_file_abandon(&film->file);
    }
    film_file_free(film);
}
