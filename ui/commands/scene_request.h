// Pictures of the arm as the command line asks for them.
#pragma once

#include "render/scene/scene.h"
#include "ui/commands/command.h"

// The view that --gl, --camera and --size ask for.
scene_options read_view(const arguments *a);

// Whether --camera says something. Returns the exit status.
int check_view(const arguments *a);

// Whether run --scene could write its file, and --at does not ask for too many instants. Returns
// the exit status.
int check_scene(const arguments *a);

// Writes the picture of run --scene. Returns the exit status.
int write_scene(const arguments *a, const scenario *s, const run_result *result);
