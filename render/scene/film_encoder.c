#include "render/scene/film_file.h"

#include <assert.h>
#include <errno.h>
#include <fcntl.h>
#include <glib.h>
#include <poll.h>
#include <spawn.h>
#include <string.h>
#include <strings.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "render/page/text.h"
#include "src/base/whole_file.h"

extern char **environ;

enum { PATIENCE = 200 }; // longest until a request to stop is seen [ms]

// Fixed numbers of threads and bitexact keep the bytes alike. Marks: ISO/IEC 14496-12, an ftyp box
// first; RFC 8794, the EBML mark; GIF89a, a trailer last; RFC 9649, WEBP in a RIFF file.
static const film_format formats[] = {
    {.ending = ".mp4",
     .codec = "-vf scale=out_color_matrix=bt709 -c:v libx264 -preset fast -crf 18 -threads 2 "
              "-pix_fmt yuv420p -colorspace bt709 -color_primaries bt709 -color_trc bt709 "
              "-movflags +faststart -f mp4",
     .marks = {{4, "ftyp"}}},
    {.ending = ".webm",
     .codec = "-vf scale=out_color_matrix=bt709 -c:v libvpx-vp9 -b:v 0 -crf 24 -deadline "
              "realtime -cpu-used 7 -row-mt 1 -threads 2 -pix_fmt yuv420p -colorspace bt709 "
              "-color_primaries bt709 -color_trc bt709 -f webm",
     .marks = {{0, "\x1a\x45\xdf\xa3"}}},
    // the first frame only gives the palette: no later one has to wait for the film's end
    {.ending = ".gif",
     .codec = "-filter_complex split[a][b];"
              "[a]trim=end_frame=1,palettegen[p];[b]trim=start_frame=1,"
              "setpts=PTS-STARTPTS[c];[c][p]paletteuse=dither=none:diff_mode=rectangle "
              "-loop 0 -f gif",
     .palette = true,
     .marks = {{0, "GIF8"}, {-1, ";"}}},
    {.ending = ".webp",
     .codec = "-c:v libwebp_anim -lossless 0 -q:v 82 -compression_level 4 -loop 0 -f webp",
     .marks = {{0, "RIFF"}, {8, "WEBP"}}},
};

const film_format *film_format_of(const char *path)
{
    assert(path != NULL);
    const char *slash = strrchr(path, '/'), *dot = strrchr(slash ? slash : path, '.');
    for (size_t i = 0; dot != NULL && i < sizeof formats / sizeof formats[0]; i++) {
        if (strcasecmp(dot, formats[i].ending) == 0) {
            return &formats[i];
        }
    }
    return NULL;
}

bool film_encoder_is_there(void)
{
    char *program = g_find_program_in_path("ffmpeg");
    g_free(program);
    return program != NULL;
}

// ---- its arguments

// Words separated by blanks.
static void add_words(GPtrArray *list, const char *words)
{
    char **each = g_strsplit(words, " ", -1);
    for (int i = 0; each[i] != NULL; i++) {
        g_ptr_array_add(list, each[i]);
    }
    g_free(each);
}

// The containers know few keys; a comment takes the parameters.
static const char *key_of(const char *keyword)
{
    return strcmp(keyword, "Title") == 0        ? "title"
           : strcmp(keyword, "Parameters") == 0 ? "comment"
           : strcmp(keyword, "Software") == 0   ? "artist"
                                                : "description";
}

// To be freed with g_strfreev.
static char **list_arguments(const film_format *format, const film_facts *facts, const char *target)
{
    GPtrArray *list = g_ptr_array_new();

    // raw frames from the pipe
    add_words(list, "ffmpeg -hide_banner -loglevel error -nostats -y -f rawvideo -pix_fmt bgr0 -s");
    g_ptr_array_add(list, text_printf("%dx%d", facts->width, facts->height));
    g_ptr_array_add(list, g_strdup("-r"));
    g_ptr_array_add(list, text_printf("%d", facts->frames_per_second));

    add_words(list, "-i pipe:0 -an");
    add_words(list, format->codec);
    add_words(list, "-fflags +bitexact -flags:v +bitexact");
    for (int i = 0; i < facts->note_count; i++) {
        const png_note *note = &facts->notes[i];
        if (note->text != NULL) {
            g_ptr_array_add(list, g_strdup("-metadata"));
            g_ptr_array_add(list, text_printf("%s=%s", key_of(note->keyword), note->text));
        }
    }

    g_ptr_array_add(list, g_strconcat("file:", target, NULL));
    g_ptr_array_add(list, NULL);
    return (char **)g_ptr_array_free(list, FALSE);
}

// ---- the program

// Starts ffmpeg with its input from `input` and its words going to e->words.
static status spawn(film_encoder *e, char **words, int input, fault *f)
{
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    sigset_t defaults;

    // frames come in, complaints go to a file of ours
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, input, 0);
    posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, fileno(e->words), 2);

    // a group of its own: an interrupt of the terminal reaches us, and we end it in order
    posix_spawnattr_init(&attributes);
    sigemptyset(&defaults);
    sigaddset(&defaults, SIGPIPE);
    posix_spawnattr_setsigdefault(&attributes, &defaults);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);

    int failed = posix_spawnp(&e->process, words[0], &actions, &attributes, words, environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    if (failed != 0) {
        e->process = 0;
        return fault_set(f, STATUS_CANNOT_WRITE, "the program ffmpeg could not be started: %s",
                         strerror(failed));
    }
    whole_file_set_writer(e->process);
    return STATUS_OK;
}

status film_encoder_start(film_encoder *e, const film_format *format, const film_facts *facts,
                          const char *target, fault *f)
{
    int ends[2];
    status code = STATUS_CANNOT_WRITE;
    *e = (film_encoder){.pipe = -1, .stop = facts->stop, .words = tmpfile()};

    if (e->words == NULL || socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) {
        return fault_set(f, code, "the program ffmpeg could not be started: %s", strerror(errno));
    }
    char **words = list_arguments(format, facts, target);
    code = spawn(e, words, ends[0], f);
    close(ends[0]);
    e->pipe = ends[1];
    g_strfreev(words);
    return code;
}

static bool is_asked_to_stop(const film_encoder *e)
{
    return e->stop != NULL && *e->stop != 0;
}

// Waits for the encoder's end and returns its status. One that hangs is ended when we are asked to
// stop.
static int wait_for_encoder(film_encoder *e)
{
    const struct timespec moment = {.tv_nsec = 5000000};
    int result = -1;
    while (waitpid(e->process, &result, WNOHANG) == 0) {
        if (is_asked_to_stop(e)) {
            kill(e->process, SIGKILL);
        }
        nanosleep(&moment, NULL);
    }
    whole_file_set_writer(0);
    e->process = 0;
    return result;
}

bool film_encoder_end(film_encoder *e, char *said, size_t size)
{
    int result = -1;
    said[0] = '\0';

    // the end of the frames is what ends it
    if (e->pipe >= 0) {
        close(e->pipe);
        e->pipe = -1;
    }
    if (e->process > 0) {
        result = wait_for_encoder(e);
    }

    // what it complained about; the first complaint is the cause, later ones follow from it
    rewind(e->words);
    char line[512];
    while (fgets(line, sizeof line, e->words) != NULL) {
        line[strcspn(line, "\r\n")] = '\0';
        if (said[0] == '\0') {
            snprintf(said, size, "%s", line);
        }
    }
    return WIFEXITED(result) && WEXITSTATUS(result) == 0 && said[0] == '\0';
}

status film_encoder_send(film_encoder *e, const unsigned char *bytes, size_t length)
{
    while (length > 0) {
        // not longer than a moment, in case the encoder hangs
        struct pollfd ready = {.fd = e->pipe, .events = POLLOUT};
        poll(&ready, 1, PATIENCE);
        if (is_asked_to_stop(e)) {
            return STATUS_STOPPED;
        }

        // a reader that went away is an error, not a signal
        ssize_t sent = send(e->pipe, bytes, length, MSG_NOSIGNAL | MSG_DONTWAIT);
        if (sent < 0 && errno != EINTR && errno != EAGAIN) {
            return STATUS_CANNOT_WRITE;
        }
        bytes += sent > 0 ? sent : 0;
        length -= sent > 0 ? (size_t)sent : 0;
    }
    return STATUS_OK;
}

void film_encoder_finish(film_encoder *e)
{
    if (e->process > 0) {
        char said[512];
        kill(e->process, SIGKILL);
        film_encoder_end(e, said, sizeof said);
    }
    if (e->pipe >= 0) {
        close(e->pipe);
    }
    if (e->words != NULL) {
        fclose(e->words);
    }
    *e = (film_encoder){.pipe = -1};
}
