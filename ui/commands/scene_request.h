// Pictures of the arm requested on the command line.
#pragma once

#include "render/scene/scene.h"
#include "ui/commands/command.h"

// The view set by --gl, --camera and --size.
scene_options read_view(const arguments *a);

// Checks --camera. Returns the exit status.
int check_view(const arguments *a);

// Checks that run --scene can write its file and that --at does not give too many instants. Returns
// the exit status.
int check_scene(const arguments *a);

// Writes the picture of run --scene. Returns the exit status.
int write_scene(const arguments *a, const scenario *s, const run_result *result);
