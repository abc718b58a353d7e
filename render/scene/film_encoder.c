#include "render/scene/film_file.h"

#include <assert.h>
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "src/base/whole_file.h"

extern char **environ;

enum {
    ARGUMENTS_MOST = 64,
    PATIENCE = 200 // longest until a request to stop is seen [ms]
};

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

// ---- its arguments

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

static void list_arguments(argument_list *list, const film_format *format, const film_facts *facts,
                           const char *target)
{
    char word[4096 + 8];

    // raw frames from the pipe
    add_words(list, "ffmpeg -hide_banner -loglevel error -nostats -y -f rawvideo -pix_fmt bgr0 -s");
    snprintf(word, sizeof word, "%dx%d", facts->width, facts->height);
    add_word(list, word);
    add_word(list, "-r");
    snprintf(word, sizeof word, "%d", facts->frames_per_second);
    add_word(list, word);

    add_words(list, "-i pipe:0 -an");
    add_words(list, format->codec);
    add_words(list, "-fflags +bitexact -flags:v +bitexact");
    add_notes(list, facts);

    snprintf(word, sizeof word, "file:%s", target);
    add_word(list, word);
    list->words[list->count] = NULL;
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
    argument_list list = {.count = 0};
    int ends[2];
    status code = STATUS_NO_MEMORY;
    *e = (film_encoder){.pipe = -1, .stop = facts->stop, .words = tmpfile()};
    list_arguments(&list, format, facts, target);

    if (list.out_of_memory) {
        fault_set(f, code, "no memory for a film");
    } else if (e->words == NULL || socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) {
        code = fault_set(f, STATUS_CANNOT_WRITE, "the program ffmpeg could not be started: %s",
                         strerror(errno));
    } else {
        code = spawn(e, list.words, ends[0], f);
        close(ends[0]);
        e->pipe = ends[1];
    }

    for (int i = 0; i < list.count; i++) {
        free(list.words[i]);
    }
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
