// Pictures of the arm as the command line asks for them.
#pragma once

#include "render/scene/scene.h"
#include "ui/commands/command.h"

typedef struct scene_request {
    scene_options options;
    double times[SCENE_INSTANTS]; // of --at, ascending [s]
    int count;                    // 0: the picture chooses
} scene_request;

// Takes --gl, --camera, --size and --at. Returns EXIT_DONE, or complains and returns the exit
// status.
int read_scene_request(const arguments *a, scene_request *r);

// The same, and whether run --scene could write its file.
int check_scene(const arguments *a);

// Writes the picture of run --scene. Returns the exit status.
int write_scene(const arguments *a, const scenario *s, const run_result *result);

// Reads a number from low to high; *value stays if text is NULL. Returns EXIT_DONE, or complains.
int read_number_between(const char *option, const char *text, double low, double high,
                        double *value);
