// impactlab-mpi: the same program as one of several processes that MPI has started.
#include <mpi.h>
#include <stdio.h>
#include <unistd.h>

#include "src/base/clock.h"
#include "ui/program.h"

#define PAUSE_US 500 // between two polls for a message [us]

enum { TAG = 1, POLLS = 5 }; // polls before the first pause

// MPI's own waiting would keep a processor busy that others compute on: what has to be waited for
// is polled, with pauses after the first few polls.
static void pause_between(int polls)
{
    if (polls >= POLLS) {
        usleep(PAUSE_US);
    }
}

static void send_message(void *context, int to, const void *bytes, size_t size)
{
    int sent = 0;
    MPI_Request request;
    (void)context;
    MPI_Isend(bytes, (int)size, MPI_BYTE, to, TAG, MPI_COMM_WORLD, &request);
    for (int polls = 0; !sent; polls++) {
        MPI_Test(&request, &sent, MPI_STATUS_IGNORE);
        if (!sent) {
            pause_between(polls);
        }
    }
}

static bool wait_for_message(void *context, double seconds, int *from, size_t *size)
{
    const double until = clock_seconds(CLOCK_MONOTONIC) + seconds;
    (void)context;
    for (int polls = 0;; polls++) {
        int there = 0, bytes;
        MPI_Status what;
        MPI_Iprobe(MPI_ANY_SOURCE, TAG, MPI_COMM_WORLD, &there, &what);
        if (there) {
            MPI_Get_count(&what, MPI_BYTE, &bytes);
            *from = what.MPI_SOURCE;
            *size = (size_t)bytes;
            return true;
        }
        if (seconds == 0 || clock_seconds(CLOCK_MONOTONIC) >= until) {
            return false;
        }
        pause_between(polls);
    }
}

static void receive_message(void *context, int from, void *bytes, size_t size)
{
    (void)context;
    MPI_Recv(bytes, (int)size, MPI_BYTE, from, TAG, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
}

int main(int argc, char **argv)
{
    bool dismissed = false;
    int gone = 0;
    rank_group group = {.send = send_message,
                        .wait = wait_for_message,
                        .receive = receive_message,
                        .dismissed = &dismissed,
                        .gone = &gone};
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &group.rank);
    MPI_Comm_size(MPI_COMM_WORLD, &group.count);

    // errors common to all processes are reported once
    if (group.rank > 0 &&
        (freopen("/dev/null", "w", stdout) == NULL || freopen("/dev/null", "w", stderr) == NULL)) {
        MPI_Abort(MPI_COMM_WORLD, 1);
    }

    int result = program_run(argc, argv, group.count > 1 ? &group : NULL);
    if (group.count > 1) {
        ranks_part(&group);
    }
    MPI_Finalize();
    return group.rank == 0 ? result : 0;
}
