// Films as files: frames go to the standard input of the ffmpeg program, or to a folder
// as PNG.
#include "render/scene/film.h"

#include <assert.h>
#include <errno.h>
#include <poll.h>
#include <string.h>
#include <strings.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "render/page/text.h"
#include "src/base/whole_file.h"

enum {
    FRAME_DPI = 144,
    PATIENCE = 200 // longest until a request to stop is seen [ms]
};

// A kind of film.
typedef struct film_format {
    const char *ending; // of its files' names
    const char *codec;  // ffmpeg's arguments for it
    bool palette; // the first frame defines the colours of all others and is not shown
} film_format;

// Fixed numbers of threads and bitexact keep the bytes alike.
static const film_format formats[] = {
    {.ending = ".mp4",
     .codec = "-vf scale=out_color_matrix=bt709 -c:v libx264 -preset veryfast -crf "
              "18 -threads 2 -pix_fmt yuv420p -colorspace bt709 -color_primaries "
              "bt709 -color_trc bt709 -movflags +faststart -f mp4"},
    {.ending = ".webm",
     .codec = "-vf scale=out_color_matrix=bt709 -c:v libvpx-vp9 -b:v 0 -crf 24 "
              "-deadline realtime -cpu-used 7 -row-mt 1 -threads 2 -pix_fmt yuv420p "
              "-colorspace bt709 -color_primaries bt709 -color_trc bt709 -f webm"},
    // the first frame only gives the palette: no later one has to wait for the film's end
    {.ending = ".gif",
     .codec = "-filter_complex "
              "split[a][b];[a]trim=end_frame=1,palettegen[p];[b]trim=start_frame=1,"
              "setpts=PTS-STARTPTS[c];[c][p]paletteuse=dither=none:diff_mode=rectangle "
              "-loop 0 -f gif",
     .palette = true},
    {.ending = ".webp",
     .codec =
         "-c:v libwebp_anim -lossless 0 -q:v 82 -compression_level 4 -loop 0 -f webp"},
};

struct film_file {
    const film_format *format; // NULL: frames in a folder
    const film_options *options;
    const png_note *notes;
    int note_count;
    const char *path;
    int frames;      // written so far
    whole_file file; // of a film
    GPid encoder;    // 0: not running
    int pipe;        // to it; -1 if closed
    FILE *messages;  // of it
};

// ---- checks

// The format that a path's ending names, or NULL.
static const film_format *format_of(const char *path)
{
    for (size_t i = 0; i < G_N_ELEMENTS(formats); i++) {
        if (strcasecmp(picture_ending(path), formats[i].ending) == 0) {
            return &formats[i];
        }
    }
    return NULL;
}

// Whether a folder can take the frames: it is empty, or can be made.
static status check_folder(const char *path, fault *f)
{
    if (!g_file_test(path, G_FILE_TEST_EXISTS)) {
        // made later; its own folder must take it
        return whole_file_check(path, f);
    }

    FAULT_IF(!g_file_test(path, G_FILE_TEST_IS_DIR), f, STATUS_CANNOT_WRITE,
             "%s is a file: expected the name of a folder, or one that ends in "
             ".mp4, .webm, .gif or .webp",
             path);

    g_autoptr(GDir) folder = g_dir_open(path, 0, NULL);
    FAULT_IF(folder == NULL || g_dir_read_name(folder) != NULL, f, STATUS_CANNOT_WRITE,
             "the folder %s is not empty: frames of two films would mix, empty it "
             "or name another",
             path);
    return STATUS_OK;
}

// A film by its ending, else a folder of frames.
status film_file_check(const char *path, fault *f)
{
    const bool film = format_of(path) != NULL;

    // a name without an ending means a folder, as does one that is there
    const bool bare = strlen(picture_ending(path)) < 2;
    const bool folder = !film && (bare || g_file_test(path, G_FILE_TEST_IS_DIR));
    FAULT_IF((!film && !folder) || strcmp(path, "-") == 0, f, STATUS_BAD_ARGUMENT,
             "'%s' is no name for a film: expected one that ends in .mp4, .webm, "
             ".gif or .webp, or a folder for PNG frames",
             path);

    // PNG frames need nothing, films ffmpeg
    if (folder) {
        return check_folder(path, f);
    }
    g_autofree char *program = g_find_program_in_path("ffmpeg");
    FAULT_IF(program == NULL, f, STATUS_CANNOT_WRITE,
             "%s needs the program ffmpeg, which is not installed: install the "
             "package ffmpeg, or give a folder to get PNG frames",
             path);
    return whole_file_check(path, f);
}

// ---- the encoder

// The containers know few keys; a comment takes the parameters.
static const char *key_of(const char *keyword)
{
    if (strcmp(keyword, "Title") == 0) {
        return "title";
    }
    if (strcmp(keyword, "Parameters") == 0) {
        return "comment";
    }
    if (strcmp(keyword, "Software") == 0) {
        return "artist";
    }
    return "description";
}

// The encoder's command line. To be freed with g_strfreev.
static char **list_arguments(const film_file *film, const char *target)
{
    const film_options *o = film->options;
    g_autoptr(GStrvBuilder) arguments = g_strv_builder_new();

    // raw frames from the pipe
    g_autofree char *fixed =
        text_printf("ffmpeg -hide_banner -loglevel error -nostats -y -f rawvideo "
                    "-pix_fmt bgr0 -s %dx%d -r %d -i pipe:0 -an %s -fflags +bitexact "
                    "-flags:v +bitexact",
                    o->width, o->height, o->frames_per_second, film->format->codec);
    g_auto(GStrv) words = g_strsplit(fixed, " ", -1);
    g_strv_builder_addv(arguments, (const char **)words);

    // the metadata, and the place of the film
    for (int i = 0; i < film->note_count; i++) {
        const png_note *note = &film->notes[i];
        g_autofree char *value = text_printf("%s=%s", key_of(note->keyword), note->text);
        g_strv_builder_add_many(arguments, "-metadata", value, NULL);
    }
    g_autofree char *output = g_strconcat("file:", target, NULL);
    g_strv_builder_add(arguments, output);
    return g_strv_builder_end(arguments);
}

// In the child: a group of its own, as an interrupt of the terminal reaches us, and we
// end it in order; if we are killed, it is too.
static void prepare_encoder(gpointer context)
{
    (void)context;
    setpgid(0, 0);
    signal(SIGPIPE, SIG_DFL);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
}

// Starts the encoder: raw frames (0xAARRGGBB without the alpha) become the film,
// complaints go to a file of ours.
static status start_encoder(film_file *film, fault *f)
{
    int ends[2];
    g_autoptr(GError) error = NULL;
    const char *target = film->file.temporary;
    if (target[0] == '\0') {
        target = film->file.path; // a pipe that is written in place
    }
    g_auto(GStrv) arguments = list_arguments(film, target);

    film->messages = tmpfile();
    FAULT_IF(film->messages == NULL ||
                 socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0,
             f, STATUS_CANNOT_WRITE, "the program ffmpeg could not be started: %s",
             strerror(errno));

    const bool started =
        g_spawn_async_with_fds(NULL, arguments, NULL,
                               G_SPAWN_SEARCH_PATH | G_SPAWN_DO_NOT_REAP_CHILD |
                                   G_SPAWN_STDOUT_TO_DEV_NULL,
                               prepare_encoder, NULL, &film->encoder, ends[0], -1,
                               fileno(film->messages), &error);
    close(ends[0]);
    film->pipe = ends[1];
    FAULT_IF(!started, f, STATUS_CANNOT_WRITE,
             "the program ffmpeg could not be started: %s", error->message);
    return STATUS_OK;
}

static bool is_asked_to_stop(const film_file *film)
{
    return film->options->stop != NULL && *film->options->stop != 0;
}

// Ends the frames and waits for the encoder's end, the status of which is returned. One
// that hangs is killed when we are asked to stop.
static int wait_for_encoder(film_file *film)
{
    int result = -1;
    if (film->pipe >= 0) {
        close(film->pipe);
        film->pipe = -1;
    }

    while (film->encoder > 0 && waitpid(film->encoder, &result, WNOHANG) == 0) {
        if (is_asked_to_stop(film)) {
            kill(film->encoder, SIGKILL);
        }
        g_usleep(5000);
    }
    film->encoder = 0;
    return result;
}

// Waits for the encoder. STATUS_OK if it succeeded without a complaint and left a film;
// of several complaints the first is the cause, later ones follow from it.
static status end_encoder(film_file *film, fault *f)
{
    char said[512] = "";
    const int result = wait_for_encoder(film);
    rewind(film->messages);
    while (said[0] == '\0' && fgets(said, sizeof said, film->messages) != NULL) {
        said[strcspn(said, "\r\n")] = '\0';
    }

    // a stop also makes it fail, so that is asked for first
    FAULT_IF(is_asked_to_stop(film), f, STATUS_STOPPED,
             "stopped: %d frames were painted, no film is left", film->frames);
    if (result != 0 && said[0] == '\0') {
        strcpy(said, "nothing");
    }
    FAULT_IF(said[0] != '\0', f, STATUS_CANNOT_WRITE,
             "%s could not be made, ffmpeg says: %s", film->path, said);
    FAULT_IF(lseek(film->file.descriptor, 0, SEEK_END) == 0, f, STATUS_CANNOT_WRITE,
             "%s could not be made: ffmpeg left no film", film->path);
    return STATUS_OK;
}

// Sends bytes of a frame. False if the encoder accepts no more, or if we are asked to
// stop while it accepts nothing.
static bool send_bytes(const film_file *film, const unsigned char *bytes, size_t length)
{
    while (length > 0) {
        // not longer than a moment, in case the encoder hangs
        struct pollfd ready = {.fd = film->pipe, .events = POLLOUT};
        poll(&ready, 1, PATIENCE);
        if (is_asked_to_stop(film)) {
            return false;
        }

        // a reader that went away is an error, not a signal
        const ssize_t sent = send(film->pipe, bytes, length, MSG_NOSIGNAL | MSG_DONTWAIT);
        if (sent >= 0) {
            bytes += sent;
            length -= (size_t)sent;
        } else if (errno != EINTR && errno != EAGAIN) {
            return false;
        }
    }
    return true;
}

// Row by row, as a surface's rows may be longer than the picture.
static status send_frame(film_file *film, cairo_surface_t *frame, fault *f)
{
    cairo_surface_flush(frame);
    const unsigned char *data = cairo_image_surface_get_data(frame);
    const ptrdiff_t stride = cairo_image_surface_get_stride(frame);

    for (int row = 0; row < film->options->height; row++) {
        if (!send_bytes(film, data + row * stride, 4 * (size_t)film->options->width)) {
            TRY(end_encoder(film, f));
            return fault_set(f, STATUS_CANNOT_WRITE,
                             "%s could not be made: ffmpeg ended before the last frame",
                             film->path);
        }
    }
    return STATUS_OK;
}

// ---- the film

void film_file_abandon(film_file *film)
{
    if (film->encoder > 0) {
        kill(film->encoder, SIGKILL);
    }
    wait_for_encoder(film);
    whole_file_abandon(&film->file);
    g_clear_pointer(&film->messages, fclose);
    g_free(film);
}

// Opens the folder of frames, or the encoder to what is renamed once it is whole.
static status open_target(film_file *film, fault *f)
{
    if (film->format != NULL) {
        TRY(whole_file_open(&film->file, film->path, f));
        return start_encoder(film, f);
    }
    FAULT_IF(mkdir(film->path, 0777) != 0 && errno != EEXIST, f, STATUS_CANNOT_WRITE,
             "the folder %s could not be made: %s", film->path, strerror(errno));
    return STATUS_OK;
}

status film_file_open(film_file **out, const char *path, const film_options *options,
                      const png_note *notes, int note_count, fault *f)
{
    assert(options->width > 0 && options->height > 0);
    *out = NULL;
    TRY(film_file_check(path, f));

    // a film that fails to open is abandoned
    g_autoptr(film_file) film = g_new0(film_file, 1);
    film->format = format_of(path);
    film->options = options;
    film->notes = notes;
    film->note_count = note_count;
    film->path = path;
    film->pipe = -1;

    TRY(open_target(film, f));
    *out = g_steal_pointer(&film);
    return STATUS_OK;
}

bool film_file_wants_palette(const film_file *film)
{
    return film->format != NULL && film->format->palette;
}

// Writes a frame as a picture of its own, with the next number.
static status add_to_folder(film_file *film, cairo_surface_t *frame, fault *f)
{
    whole_file file;
    g_autofree char *path =
        text_printf("%s/frame-%05d.png", film->path, film->frames + 1);
    TRY(whole_file_open(&file, path, f));
    const status code =
        png_file_write(file.stream, frame, FRAME_DPI, film->notes, film->note_count, f);
    return whole_file_close(&file, code, f);
}

status film_file_add(film_file *film, cairo_surface_t *frame, fault *f)
{
    if (film->format == NULL) {
        TRY(add_to_folder(film, frame, f));
    } else {
        TRY(send_frame(film, frame, f));
    }
    film->frames++;
    return STATUS_OK;
}

status film_file_commit(film_file *film, fault *f)
{
    // of no more use, whatever comes of it; frames in a folder are there already
    G_GNUC_UNUSED g_autoptr(film_file) ended = film;
    if (film->format == NULL) {
        return STATUS_OK;
    }
    return whole_file_close(&film->file, end_encoder(film, f), f);
}
