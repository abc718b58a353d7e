// The catalogue of figures: this file alone knows all of them, and how each is opened.
#include "render/figures/figures.h"

#include <assert.h>
#include <string.h>

// ---- panels of recorded signals

static const trace_panel contact_force[] = {
    {.signals = {"force"}, .with_zero = true, .inset = true, .weight = 1.6},
};

static const trace_panel hub_motion[] = {
    {.signals = {"hub_velocity"}},
    {.signals = {"hub_angle"}, .wall = true},
};

static const trace_panel last_link_motion[] = {
    {.signals = {"last_velocity"}},
    {.signals = {"last_angle"}, .wall = true},
};

static const trace_panel last_link_acceleration[] = {
    {.signals = {"last_acceleration"}, .weight = 1.6},
};

static const trace_panel last_link_with_acceleration[] = {
    {.signals = {"last_acceleration"}},
    {.signals = {"last_velocity"}},
    {.signals = {"last_angle"}, .wall = true},
};

// Panels of readings on the virtual rig beside what they are readings of.
#define HUB_ANGLE    .label = "Hub angle", .wall = true, .weight = 1.2
#define HUB_VELOCITY .label = "Hub velocity", .weight = 1.2
#define TIP_FORCE    .label = "Contact force", .with_zero = true, .weight = 1.4
#define MOTOR_COMMAND                                                                    \
    .label = "Command <i>u</i>", .signals = {"command"}, .with_zero = true, .weight = 1.2

static const trace_panel encoder[] = {{HUB_ANGLE, .signals = {"encoder", "hub_angle"}}};
static const trace_panel tachometer[] = {
    {HUB_VELOCITY, .signals = {"tachometer", "hub_velocity"}},
};
static const trace_panel force_reading[] = {
    {TIP_FORCE, .signals = {"force_reading", "force"}},
};
static const trace_panel calculated_force[] = {
    {TIP_FORCE, .signals = {"calculated_force", "force"}},
};

// The same beside what the controller asks for.
static const trace_panel followed_angle[] = {
    {HUB_ANGLE, .signals = {"encoder", "desired_angle"}},
};
static const trace_panel followed_velocity[] = {
    {HUB_VELOCITY, .signals = {"tachometer", "desired_velocity"}},
};
static const trace_panel motor_command[] = {{MOTOR_COMMAND}};
static const trace_panel followed_motion[] = {
    {HUB_ANGLE, .signals = {"encoder", "desired_angle"}},
    {HUB_VELOCITY, .signals = {"tachometer", "desired_velocity"}},
};
static const trace_panel force_and_command[] = {
    {TIP_FORCE, .signals = {"force_reading", "force"}},
    {MOTOR_COMMAND},
};

// ---- second runs of the same scenario

static const second_run corrected = {"arm.model=corrected", {"printed", "corrected"}};
static const second_run eight_links = {"arm.links=8", {"2 links", "8 links"}};

// ---- the catalogue, in the order of the report

static const thesis_figure thesis_figures[] = {
    {.id = "2.1",
     .file = "fig-2-1",
     .caption = "Force sensor: interface circuit and its curve",
     .model = "the rig's sensor",
     .open = diagram_sensor},
    {.id = "2.2",
     .file = "fig-2-2",
     .caption = "The arm as a hub and two links",
     .model = "corrected",
     .open = diagram_links},
    {.id = "2.3",
     .file = "fig-2-3",
     .caption = "Torques and forces on each body",
     .model = "corrected",
     .open = diagram_free_bodies},
    {.id = "2.4",
     .file = "fig-2-4",
     .caption = "Optical encoder under a constant 1 V",
     .scenario = "thesis/fig-2-4",
     .model = "corrected, on the rig",
     .panels = encoder,
     .panel_count = 1,
     .from = 0,
     .to = 1},
    {.id = "2.5",
     .file = "fig-2-5",
     .caption = "Tachometer under a constant 1 V",
     .scenario = "thesis/fig-2-5",
     .model = "corrected, on the rig",
     .panels = tachometer,
     .panel_count = 1,
     .from = 0,
     .to = 1},
    {.id = "2.6",
     .file = "fig-2-6",
     .caption = "Force sensor under a constant 1 V",
     .scenario = "thesis/fig-2-6",
     .model = "corrected, on the rig",
     .panels = force_reading,
     .panel_count = 1,
     .from = 0,
     .to = 1},
    {.id = "T2.1",
     .file = "table-2-1",
     .caption = "Constants of the motor",
     .model = "both",
     .open = table_motor},
    {.id = "3.1",
     .file = "fig-3-1",
     .caption = "The arm in contact at two successive steps",
     .scenario = "thesis/fig-3-1",
     .model = "printed",
     .open = diagram_contact},
    {.id = "3.2",
     .file = "fig-3-2",
     .caption = "Motion of the hub at 1 V, step 1 ms",
     .scenario = "thesis/fig-3-2",
     .model = "printed; corrected dashed",
     .second = &corrected,
     .panels = hub_motion,
     .panel_count = 2},
    {.id = "3.3",
     .file = "fig-3-3",
     .caption = "Motion of the last link at 1 V, step 1 ms",
     .scenario = "thesis/fig-3-3",
     .model = "printed; corrected dashed",
     .second = &corrected,
     .panels = last_link_motion,
     .panel_count = 2},
    {.id = "3.4",
     .file = "fig-3-4",
     .caption = "Contact force at 1 V, step 1 ms",
     .scenario = "thesis/fig-3-4",
     .model = "printed; corrected dashed",
     .second = &corrected,
     .panels = contact_force,
     .panel_count = 1,
     .printed_voltage = 1},
    {.id = "3.5",
     .file = "fig-3-5",
     .caption = "Acceleration of the last link at 1 V, step 1 ms",
     .scenario = "thesis/fig-3-5",
     .model = "printed; corrected dashed",
     .second = &corrected,
     .panels = last_link_acceleration,
     .panel_count = 1},
    {.id = "3.6",
     .file = "fig-3-6",
     .caption = "Motion of the hub at 1 V, step 10 ms",
     .scenario = "thesis/fig-3-6",
     .model = "printed; corrected dashed",
     .second = &corrected,
     .panels = hub_motion,
     .panel_count = 2,
     .steps = true},
    {.id = "3.7",
     .file = "fig-3-7",
     .caption = "Contact force at 1 V, step 10 ms",
     .scenario = "thesis/fig-3-7",
     .model = "printed; corrected dashed",
     .second = &corrected,
     .panels = contact_force,
     .panel_count = 1,
     .steps = true},
    {.id = "3.8",
     .file = "fig-3-8",
     .caption = "Motion of the last link at 1 V, step 10 ms",
     .scenario = "thesis/fig-3-8",
     .model = "printed; corrected dashed",
     .second = &corrected,
     .panels = last_link_with_acceleration,
     .panel_count = 3,
     .steps = true},
    {.id = "3.9",
     .file = "fig-3-9",
     .caption = "Motion of the hub at 5 V, step 1 ms",
     .scenario = "thesis/fig-3-9",
     .model = "printed; corrected dashed",
     .second = &corrected,
     .panels = hub_motion,
     .panel_count = 2},
    {.id = "3.10",
     .file = "fig-3-10",
     .caption = "Contact force at 5 V, step 1 ms",
     .scenario = "thesis/fig-3-10",
     .model = "printed; corrected dashed",
     .second = &corrected,
     .panels = contact_force,
     .panel_count = 1,
     .printed_voltage = 3},
    {.id = "3.11",
     .file = "fig-3-11",
     .caption = "Motion of the last link at 5 V, step 1 ms",
     .scenario = "thesis/fig-3-11",
     .model = "printed; corrected dashed",
     .second = &corrected,
     .panels = last_link_with_acceleration,
     .panel_count = 3},
    {.id = "T3.1",
     .file = "table-3-1",
     .caption = "Stability of Newmark's method",
     .model = "both",
     .open = table_stability},
    {.id = "T3.2",
     .file = "table-3-2",
     .caption = "The algorithm of the constrained motion",
     .model = "printed",
     .open = table_algorithm},
    {.id = "beta-gamma",
     .file = "beta-gamma",
     .caption = "Force error over Newmark's parameters",
     .scenario = "corrected/first-impact",
     .model = "corrected",
     .open = stability_map,
     .slow = true},
    {.id = "beta-gamma-printed",
     .file = "beta-gamma-printed",
     .caption = "Largest force over Newmark's parameters, the printed arm",
     .scenario = "thesis/fig-3-4",
     .model = "printed",
     .open = printed_stability_map,
     .slow = true},
    {.id = "4.1",
     .file = "fig-4-1",
     .caption = "Springs in series against the wall",
     .scenario = "corrected/first-impact",
     .model = "corrected",
     .open = diagram_springs},
    {.id = "4.2",
     .file = "fig-4-2",
     .caption = "The arm at the instant of the collision",
     .scenario = "corrected/first-impact",
     .model = "corrected",
     .open = diagram_collision},
    {.id = "4.3",
     .file = "fig-4-3",
     .caption = "Contact force of an impact: impulse, then pulse",
     .scenario = "corrected/first-impact",
     .model = "corrected",
     .open = figure_force_profile},
    {.id = "4.4",
     .file = "fig-4-4",
     .caption = "Angular velocity during the pulse, assumed and computed",
     .scenario = "corrected/first-impact",
     .model = "corrected",
     .open = assumed_motion},
    {.id = "4.5",
     .file = "fig-4-5",
     .caption = "Angle during the pulse, assumed and computed",
     .scenario = "corrected/first-impact",
     .model = "corrected",
     .open = assumed_motion,
     .variant = 1},
    {.id = "4.6",
     .file = "fig-4-6",
     .caption = "The arm at its largest deformation",
     .scenario = "corrected/first-impact",
     .model = "corrected",
     .open = diagram_deformation},
    {.id = "T4.1",
     .file = "table-4-1",
     .caption = "Peak force and delay, 100 times the nominal stiffness",
     .scenario = "thesis/table-4-1",
     .model = "printed and corrected",
     .open = table_predictions},
    {.id = "T4.2",
     .file = "table-4-2",
     .caption = "Peak force and delay, 10 times the nominal stiffness",
     .scenario = "thesis/table-4-2",
     .model = "printed and corrected",
     .open = table_predictions},
    {.id = "T4.3",
     .file = "table-4-3",
     .caption = "Peak force and delay, the nominal stiffness",
     .scenario = "thesis/table-4-3",
     .model = "printed and corrected",
     .open = table_predictions},
    {.id = "forces",
     .file = "table-4-forces",
     .caption = "Peak forces of Tables 4.1 to 4.3, printed and computed",
     .model = "printed",
     .open = printed_values_figure},
    {.id = "delays",
     .file = "table-4-delays",
     .caption = "Delays of the peak of Tables 4.1 to 4.3, printed and computed",
     .model = "printed",
     .open = printed_values_figure,
     .variant = 1},
    {.id = "errors",
     .file = "table-4-errors",
     .caption = "Deviations from Tables 4.1 to 4.3",
     .model = "printed and corrected",
     .open = table_errors},
    {.id = "5.1",
     .file = "fig-5-1",
     .caption = "Hybrid control at 1 N: encoder and desired angle",
     .scenario = "thesis/fig-5-1",
     .model = "corrected, on the rig",
     .second = &eight_links,
     .panels = followed_angle,
     .panel_count = 1,
     .modes = true},
    {.id = "5.2",
     .file = "fig-5-2",
     .caption = "Hybrid control at 1 N: tachometer and desired velocity",
     .scenario = "thesis/fig-5-2",
     .model = "corrected, on the rig",
     .second = &eight_links,
     .panels = followed_velocity,
     .panel_count = 1,
     .modes = true},
    {.id = "5.3",
     .file = "fig-5-3",
     .caption = "Hybrid control at 1 N: force sensor",
     .scenario = "thesis/fig-5-3",
     .model = "corrected, on the rig",
     .panels = force_reading,
     .panel_count = 1,
     .modes = true},
    {.id = "5.4",
     .file = "fig-5-4",
     .caption = "Hybrid control at 1 N: calculated tip force",
     .scenario = "thesis/fig-5-4",
     .model = "corrected, on the rig",
     .panels = calculated_force,
     .panel_count = 1,
     .modes = true,
     .note =
         "The notch after the largest force is due to friction, which changes its sign "
         "where the hub turns back: the controller compensates for it one sample later, "
         "and a rigid contact transmits every change of the hub's torque at once."},
    {.id = "5.5",
     .file = "fig-5-5",
     .caption = "Hybrid control at 1 N: command to the motor",
     .scenario = "thesis/fig-5-5",
     .model = "corrected, on the rig",
     .panels = motor_command,
     .panel_count = 1,
     .modes = true},
    {.id = "5.6",
     .file = "fig-5-6",
     .caption = "Hybrid control at 2 N: angle and velocity of the hub",
     .scenario = "thesis/fig-5-6",
     .model = "corrected, on the rig",
     .panels = followed_motion,
     .panel_count = 2,
     .modes = true},
    {.id = "5.7",
     .file = "fig-5-7",
     .caption = "Hybrid control at 2 N: force and command",
     .scenario = "thesis/fig-5-7",
     .model = "corrected, on the rig",
     .panels = force_and_command,
     .panel_count = 2,
     .modes = true},
};
enum { FIGURES = G_N_ELEMENTS(thesis_figures) };

int thesis_figure_count(void)
{
    return FIGURES;
}

const thesis_figure *thesis_figure_at(int i)
{
    assert(i >= 0);
    if (i < FIGURES) {
        return &thesis_figures[i];
    }
    return NULL;
}

const thesis_figure *thesis_figure_find(const char *id)
{
    for (int i = 0; i < FIGURES; i++) {
        if (g_ascii_strcasecmp(thesis_figures[i].id, id) == 0 ||
            strcmp(thesis_figures[i].file, id) == 0) {
            return &thesis_figures[i];
        }
    }
    return NULL;
}
