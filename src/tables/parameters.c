#include "src/tables/parameters.h"

#include <assert.h>
#include <limits.h>
#include <math.h>
#include <string.h>

#include "src/base/words.h"
#include "src/tables/control_laws.h"

// What a row of the table is written with; a range includes both its ends.
#define PATH(field)              .path = #field, .offset = offsetof(parameters, field)
#define REAL(in, from, to)       .type = PARAMETER_REAL, .unit = in, .minimum = from, .maximum = to
#define INTEGER(from, to)        .type = PARAMETER_INTEGER, .unit = "", .minimum = from, .maximum = to
#define BOOLEAN                  .type = PARAMETER_BOOLEAN, .unit = "", .maximum = 1
#define CHOICE(last, words)      .type = PARAMETER_CHOICE, .unit = "", .maximum = last, .choices = words
#define TEXT(without)            .type = PARAMETER_TEXT, .unit = "", .maximum = 1, .choices = without
#define LIST(in, from, to)       .type = PARAMETER_LIST, .unit = in, .minimum = from, .maximum = to
#define DEFAULT(value)           .default_corrected = value, .default_printed = value
#define DEFAULTS(ours, printed_) .default_corrected = ours, .default_printed = printed_
#define TIMED                    .timed = true
#define MEANING(sentence)        .description = sentence

// The default follows from other parameters, see parameters_resolve.
#define DERIVED (double)NAN

// k1 with which the printed model reproduces the thesis's tables. The thesis prints
// 169 468 N m/rad, with which its own algorithm at h = 1 ms chatters; 90 lies in the range
// 85-100 that matches Tables 4.1-4.3 best (docs/explanation/model.md).
#define K1_PRINTED_TABLES 90.0
#define K1_THESIS         169468.0882

// What the ledger of the event method may lack of the energy put in.
#define EVENT_RESIDUAL_BOUND 1e-6

// kT is printed as 0.249092 kg m/A; one kilogram-force is 9.80665 N.
#define TORQUE_CONSTANT (0.249092 * 9.80665)

const parameter_info parameter_table[] = {
    {PATH(arm.model), CHOICE(1, "corrected|printed"), DEFAULTS(ARM_CORRECTED, ARM_PRINTED),
     MEANING("equations of motion: derived anew, or as the thesis prints them")},
    {PATH(arm.links), INTEGER(1, PARAMETER_LINKS_MOST), DEFAULT(2),
     MEANING("number of rigid links the beam is cut into (N)")},
    {PATH(arm.hub_joint), CHOICE(2, "rigid|spring|beam"), DEFAULTS(HUB_RIGID, HUB_SPRING),
     MEANING("joint between hub and first link: one body, the spring k1, or the beam's own root, a "
             "spring k2 N")},
    {PATH(arm.length), REAL("m", 0.01, 100), DEFAULT(1.0),
     MEANING("length of the beam, all links together")},
    {PATH(arm.mass), REAL("kg", 1e-4, 1e4), DEFAULT(0.40108),
     MEANING("mass of the beam, all links together")},
    {PATH(arm.hub_inertia), REAL("kg m2", 0, 1e4), DEFAULT(5.2e-3),
     MEANING("moment of inertia of hub and motor shaft (I1)")},
    {PATH(arm.link_inertia), REAL("kg m2", 0, 1e4), DEFAULTS(DERIVED, 1.67e-5),
     MEANING("moment of inertia of a link about its centre of mass (I2 = I3, N = 2 only)")},
    {PATH(arm.k1), REAL("N m/rad", 1e-6, 1e9), DEFAULTS(K1_THESIS, K1_PRINTED_TABLES), TIMED,
     MEANING("stiffness of the hub joint (arm.hub_joint = spring; with beam it is k2 N)")},
    {PATH(arm.k2), REAL("N m/rad", 1e-6, 1e9), DEFAULT(4.92), TIMED,
     MEANING(
         "stiffness of the middle joint of the two-link beam; each joint of N links has k2 N/2")},
    {PATH(arm.EI), REAL("N m2", 1e-9, 1e12), DEFAULT(DERIVED), TIMED,
     MEANING("bending stiffness of the beam, in place of arm.k2 = 2 EI/length")},
    {PATH(arm.joint_stiffness), LIST("N m/rad", 1e-6, 1e9),
     MEANING("stiffness of every joint between links from the hub outwards, of a beam the root's "
             "first, in place of arm.k2")},
    {PATH(arm.link_lengths), LIST("m", 1e-4, 100),
     MEANING("length of every link from the hub outwards, in place of arm.length; masses go with "
             "the lengths")},
    {PATH(arm.damping_ratio), REAL("", 0, 1), DEFAULT(0),
     MEANING("structural damping ratio of the first clamped-free mode")},
    {PATH(arm.modal_ratios), LIST("", 0, 1000),
     MEANING("damping ratios of the modes with the hub held, from the slowest on, in place of "
             "arm.damping_ratio; modes beyond the list have none")},
    {PATH(arm.air_drag), REAL("N s/m2", 0, 1e6), DEFAULT(0),
     MEANING("drag of the air on the beam per length and velocity")},
    {PATH(arm.stiffening), REAL("1/rad2", 0, 1e6), DEFAULT(0),
     MEANING("share by which k2 grows with the square of its bend, the torque being k2 b (1 + "
             "stiffening b^2); of N links the same curvature counts")},
    {PATH(arm.tip_mass), REAL("kg", 0, 1000), DEFAULT(0),
     MEANING("mass that the tip carries, such as a sensor")},
    {PATH(arm.tilt), REAL("rad", -3.2, 3.2), DEFAULT(0),
     MEANING("tilt of the arm's plane to the level: g sin(tilt) acts along the angle -pi/2")},

    {PATH(motor.voltage), REAL("V", -1000, 1000), DEFAULT(1), TIMED,
     MEANING("command to the amplifier, held constant")},
    {PATH(motor.voltage_limit), REAL("V", 0, 1000), DEFAULT(10), TIMED,
     MEANING("largest command either way; beyond it the command saturates")},
    {PATH(motor.amplifier_gain), REAL("", 0, 1000), DEFAULT(6.02),
     MEANING("volts at the motor per volt of command")},
    {PATH(motor.torque_constant), REAL("N m/A", 0, 1000), DEFAULT(TORQUE_CONSTANT),
     MEANING("torque per ampere (kT)")},
    {PATH(motor.back_emf), REAL("V s/rad", 0, 1000), DEFAULT(2.443),
     MEANING("back electromotive force (kB)")},
    {PATH(motor.resistance), REAL("ohm", 1e-3, 1e6), DEFAULT(33.6),
     MEANING("armature resistance (Ra)")},
    {PATH(motor.inductance), REAL("H", 0, 1000), DEFAULT(0),
     MEANING("armature inductance (motor.drive = voltage); 0: the current follows at once")},
    {PATH(motor.viscous_friction), REAL("N m s/rad", 0, 1000), DEFAULT(5.4192e-3), TIMED,
     MEANING("viscous friction at the hub (kfr)")},
    {PATH(motor.stiction), REAL("N m", 0, 1000), DEFAULT(0.045), TIMED,
     MEANING("Coulomb friction torque at the hub, sliding and sticking (kst)")},
    {PATH(motor.drive), CHOICE(1, "voltage|current"), DEFAULT(DRIVE_VOLTAGE),
     MEANING("what the amplifier gives for a command: a voltage, against which back EMF works, or "
             "a current, which it holds")},
    {PATH(motor.transconductance), REAL("A/V", 0, 1000), DEFAULT(DERIVED),
     MEANING("current per volt of command (motor.drive = current), amplifier_gain/resistance if "
             "not given: the same torque at rest")},
    {PATH(motor.current_limit), REAL("A", 0, 1e6), DEFAULT(0),
     MEANING("largest current that the amplifier gives either way; 0: none")},

    {PATH(wall.kind), CHOICE(2, "point|plane|none"), DEFAULT(WALL_POINT),
     MEANING("a fixed point the last link's line may not pass, a flat wall the tip may not pass, "
             "or none")},
    {PATH(wall.angle), REAL("rad", -3, 3), DEFAULT(0.1), TIMED,
     MEANING("direction of contact point or flat wall as seen from the hub axis")},
    {PATH(wall.restitution), REAL("", 0, 1), DEFAULT(0), TIMED,
     MEANING("coefficient of restitution e of an impact on a rigid wall or a face with a mass (0: "
             "plastic)")},
    {PATH(wall.contact), CHOICE(2, "rigid|kelvin-voigt|hunt-crossley"), DEFAULT(WALL_RIGID),
     MEANING(
         "how the wall answers: it does not give, or it is a spring and a damper with the force "
         "k x + c v or x^n (k + c v) at the depth x")},
    {PATH(wall.stiffness), REAL("N/m", 1, 1e15), DEFAULT(DERIVED),
     MEANING("stiffness k of a wall that gives, in N/m^n for hunt-crossley")},
    {PATH(wall.damping), REAL("N s/m", 0, 1e15), DEFAULT(DERIVED),
     MEANING("damping c of a wall that gives, in N s/m^(n+1) for hunt-crossley")},
    {PATH(wall.exponent), REAL("", 1, 5), DEFAULT(1.5),
     MEANING("exponent n of hunt-crossley; 1.5 is Hertz's for a ball on a plane")},
    {PATH(wall.mass), REAL("kg", 0, 1e6), DEFAULT(0),
     MEANING("mass of the face in front of the spring and damper of kelvin-voigt, which the arm "
             "strikes as a rigid body; 0: none")},
    {PATH(wall.motion), CHOICE(MOTION_FILE, "none|sine|step|file"), DEFAULT(MOTION_NONE),
     MEANING("how the wall moves along its normal: not, A sin(2 pi f (t - t0)), by A within "
             "1/(2 f) from t0 on, smoothly up to the acceleration, or as wall.motion_file says")},
    {PATH(wall.motion_amplitude), REAL("m", -10, 10), DEFAULT(0.001),
     MEANING("amplitude A of that motion, positive towards the arm")},
    {PATH(wall.motion_frequency), REAL("Hz", 1e-3, 1e4), DEFAULT(1),
     MEANING("frequency f of that motion, half a period of which a step takes")},
    {PATH(wall.motion_time), REAL("s", -1e6, 1e6), DEFAULT(0),
     MEANING("t0 of that motion: where a sine passes zero, where a step or a file begins")},
    {PATH(wall.motion_file), TEXT(NULL),
     MEANING("CSV with columns time [s] and place [m], towards the arm; between its rows a spline, "
             "before and after them the wall rests (wall.motion = file)")},

    {PATH(method.name), CHOICE(2, "event|newmark|generalized-alpha"),
     DEFAULTS(METHOD_EVENT, METHOD_NEWMARK), MEANING("time integration")},
    {PATH(method.step), REAL("s", 1e-7, 1), DEFAULT(1e-3),
     MEANING("time step h; under event only the spacing of the recorded rows")},
    {PATH(method.beta), REAL("", 0.01, 2), DEFAULT(0.4), MEANING("Newmark's beta")},
    {PATH(method.gamma), REAL("", 0, 2), DEFAULT(0.5), MEANING("Newmark's gamma")},
    {PATH(method.spectral_radius), REAL("", 0, 1), DEFAULT(0.8),
     MEANING("what generalised-alpha leaves of the highest modes in one step (rho at infinity)")},
    {PATH(method.rest_speed), REAL("m/s", 0, 1), DEFAULT(1e-4),
     MEANING("rest rule: an impact slower than this is plastic whatever e is")},
    {PATH(method.residual_bound), REAL("", 0, 1), DEFAULT(EVENT_RESIDUAL_BOUND),
     MEANING("share of the energy put in that the ledger may lack before a run counts as "
             "inaccurate (event 1e-6, newmark and generalized-alpha 1e-2)")},
    {PATH(method.engine), CHOICE(2, "auto|pair|stiff"), DEFAULT(ENGINE_AUTO),
     MEANING("what the event method integrates with: the arm decides, power series of two equal "
             "links on a rigid wall, a stiff formula of order 13 for any arm")},
    {PATH(method.tolerance), REAL("", 1e-13, 1e-3), DEFAULT(1e-10),
     MEANING("error of the stiff engine's steps as its embedded formula of order 7 sees it, as a "
             "share of the arm's largest momentum; ten times that where decays are faster than "
             "vibrations, the motor's current and 3e4 1/s, a tenth where an undamped arm bounces")},

    {PATH(printed.spring_counted_twice), BOOLEAN, DEFAULT(true),
     MEANING("printed model: (2.16) carries the spring k2 that belongs in (2.17) alone")},
    {PATH(printed.force_at_link_end), BOOLEAN, DEFAULT(true),
     MEANING(
         "printed model: the contact force acts at the link's end instead of the contact point")},
    {PATH(printed.sign_dead_band), BOOLEAN, DEFAULT(true),
     MEANING(
         "printed model: sign() takes -0.01 for the lower edge of its dead band instead of -1e-5")},
    {PATH(printed.energy_cross_term), BOOLEAN, DEFAULT(true),
     MEANING("printed model: kinetic energy of the predictor has eps w2 w3 for 2 l eps w2 w3")},
    {PATH(printed.reevaluation), CHOICE(2, "rhs|listing|none"), DEFAULT(REEVALUATE_RHS),
     MEANING("printed model: where the re-evaluation puts 2 l sin(d) w2 w3, as (3.13) has it or as "
             "the listing has it; none: the single run of 3.1.3, whose force is Newmark's own")},
    {PATH(printed.clamp_force), BOOLEAN, DEFAULT(true),
     MEANING("printed model: a force that comes out negative is set to zero")},
    {PATH(printed.force_after_release), BOOLEAN, DEFAULT(true),
     MEANING(
         "printed model: the force is evaluated from the constrained system after release too")},
    {PATH(printed.feed_newmark_acceleration), BOOLEAN, DEFAULT(false),
     MEANING("printed model: the next step starts from Newmark's own acceleration, not the "
             "re-evaluated one")},
    {PATH(printed.newton_iterations), INTEGER(1, 100), DEFAULT(2),
     MEANING("printed model: Newton solves per time step")},

    {PATH(initial.angle), REAL("rad", -3, 3), DEFAULT(0),
     MEANING("angle of hub and all links at the start")},
    {PATH(initial.velocity), REAL("rad/s", -1000, 1000), DEFAULT(0),
     MEANING("angular velocity of hub and all links at the start")},

    {PATH(run.duration), REAL("s", 1e-6, 1e5), DEFAULT(1), MEANING("simulated time")},

    {PATH(control.law), CHOICE(LAW_PLAYBACK, CONTROL_LAW_CHOICES), DEFAULT(LAW_NONE),
     MEANING("control law on the rig, or none: the bare arm under motor.voltage")},
    {PATH(control.plugin), TEXT(NULL),
     MEANING("shared object with a controller of one's own (control.law = plugin)")},
    {PATH(control.command), TEXT(NULL),
     MEANING("program that is the controller, as a shell takes it (control.law = process)")},
    {PATH(control.answer_time), REAL("s", 0.01, 3600), DEFAULT(10),
     MEANING("for which a process may keep the lab waiting, by the clock, before the run fails")},
    {PATH(control.playback_file), TEXT(NULL),
     MEANING("CSV with the command to play back and its times in a column t or time "
             "(control.law = playback)")},
    {PATH(control.playback_column), TEXT("command"),
     MEANING("heading of the command's column there, name or name[unit]; V without a unit")},
    {PATH(control.playback_shift), REAL("s", -1e5, 1e5), DEFAULT(0),
     MEANING("by which the command comes later than it was recorded")},
    {PATH(control.playback_hold), CHOICE(PLAYBACK_LINEAR, "hold|linear"), DEFAULT(PLAYBACK_HOLD),
     MEANING("between two rows the earlier one's command, or on the straight line; outside the "
             "recording that of the first or last row")},
    {PATH(control.settings), TEXT(NULL), TIMED,
     MEANING("parameters that only this law, plug-in or process has, written name=value and "
             "separated by spaces; control.settings.NAME is one of them")},
    {PATH(control.lock), TEXT("none"), TIMED,
     MEANING("mode that the law is held in, by its name, or none: the law chooses")},
    {PATH(control.rate), REAL("Hz", 1, 1e5), DEFAULT(200), TIMED, MEANING("samples a second")},
    {PATH(control.delay), REAL("s", 0, 1), DEFAULT(0), TIMED,
     MEANING("from a sample to the instant its command takes effect, at most five periods")},
    {PATH(control.delay_periods), REAL("", 0, 5), DEFAULT(0), TIMED,
     MEANING("further delay in sampling periods, five at most in all; 1: a command goes "
             "out with the next sample")},
    {PATH(control.jitter), REAL("s", 0, 1), DEFAULT(0), TIMED,
     MEANING("width over which the sampling instants scatter, at most one period")},
    {PATH(control.seed), INTEGER(0, 2147483647), DEFAULT(1),
     MEANING("seed of all noise of the rig")},
    {PATH(control.force), REAL("N", 0, 1000), DEFAULT(1), TIMED,
     MEANING("commanded contact force")},
    {PATH(control.force_rate), REAL("N/s", 0, 1e6), DEFAULT(0), TIMED,
     MEANING("how fast the commanded force goes to control.force, a ramp; 0: at once, a step")},
    {PATH(control.force_amplitude), REAL("N", 0, 1000), DEFAULT(0), TIMED,
     MEANING("amplitude of a sine on the commanded force")},
    {PATH(control.force_frequency), REAL("Hz", 0, 1e4), DEFAULT(1), TIMED,
     MEANING("frequency of that sine")},
    {PATH(control.approach_voltage), REAL("V", -1000, 1000), DEFAULT(1), TIMED,
     MEANING("constant command of the approach")},
    {PATH(control.kp), REAL("", -1e6, 1e6), DEFAULT(10.15), TIMED,
     MEANING("position gain, per rad, of a torque in N m or of volts (control.gains)")},
    {PATH(control.kv), REAL("", -1e6, 1e6), DEFAULT(0.75), TIMED,
     MEANING("velocity gain, per rad/s, of a torque in N m or of volts (control.gains)")},
    {PATH(control.gains), CHOICE(2, "torque|volts|printed"), DEFAULT(0), TIMED,
     MEANING("hybrid: what kp and kv give; printed: torque in the impact mode and volts in the "
             "force mode")},
    {PATH(control.coefficients), CHOICE(1, "corrected|printed"), DEFAULT(0), TIMED,
     MEANING("hybrid: factors of its model, 4 k2 and 2 f l, or 6 k2 and 3 f l as printed")},
    {PATH(control.transition_time), REAL("s", 1e-3, 100), DEFAULT(0.35), TIMED,
     MEANING(
         "hybrid: length of the impact mode (t_f); inverse-dynamics: how long the force rises")},
    {PATH(control.contact_threshold), REAL("N", 0, 1000), DEFAULT(0.05), TIMED,
     MEANING("force reading that a controller takes for contact")},
    {PATH(control.k2_table), TEXT(NULL),
     MEANING("k2 by commanded force as calibrate measures it, written FORCE:K2 and separated by "
             "spaces")},
    {PATH(control.force_gain), REAL("V/N", -1000, 1000), DEFAULT(1), TIMED,
     MEANING("gain of the force error")},
    {PATH(control.integral_gain), REAL("V/(N s)", -1e4, 1e4), DEFAULT(5), TIMED,
     MEANING("gain of the integrated force error")},
    {PATH(control.speed_limit), REAL("rad/s", 0, 1000), DEFAULT(0.3), TIMED,
     MEANING("speed-limit: hub velocity of the approach")},
    {PATH(control.reverse_time), REAL("s", 0, 10), DEFAULT(0.02), TIMED,
     MEANING("reverse-torque: how long the motor pulls back after contact")},
    {PATH(control.switch_share), REAL("", 0, 1), DEFAULT(0.5), TIMED,
     MEANING("bang-bang: share of the way to the wall at which the command is reversed")},
    {PATH(control.force_limit), REAL("N", 0, 1000), DEFAULT(0), TIMED,
     MEANING(
         "predictive, observer, speed-limit: force that is not to be exceeded, 0 for none; with "
         "one the rig predicts at every sample how hard a touch would be")},
    {PATH(control.travel_time), REAL("s", 1e-3, 100), DEFAULT(0.35),
     MEANING("inverse-dynamics: how long the tip moves to the wall")},
    {PATH(control.arrival_speed), REAL("m/s", 0, 1000), DEFAULT(0),
     MEANING("inverse-dynamics: speed with which the tip is to meet the wall")},
    {PATH(control.impact_angle), CHOICE(2, "told|film|accelerometer"), DEFAULT(IMPACT_ANGLE_TOLD),
     MEANING("hybrid: where it has the wall's angle from in contact; a sensor is fitted with it")},

    {PATH(belief.links), INTEGER(2, 64), DEFAULT(2),
     MEANING("number of links of the beam in the controller's model, where it can have several")},
    {PATH(belief.mass_factor), REAL("", 0.01, 100), DEFAULT(1), TIMED,
     MEANING("beam's mass, with its moments of inertia, that the controller believes in, divided "
             "by the true one")},
    {PATH(belief.inertia_factor), REAL("", 0.01, 100), DEFAULT(1), TIMED,
     MEANING("hub's moment of inertia that the controller believes in, divided by the true one")},
    {PATH(belief.friction_factor), REAL("", 0, 100), DEFAULT(1), TIMED,
     MEANING("Coulomb and viscous friction that the controller believes in, divided by the true "
             "one")},
    {PATH(belief.torque_factor), REAL("", 0.01, 100), DEFAULT(1), TIMED,
     MEANING("torque constant kT that the controller believes in, divided by the true one")},
    {PATH(belief.k2_factor), REAL("", 0.01, 100), DEFAULT(1), TIMED,
     MEANING(
         "k2 that the controller believes in, divided by the arm's (by that of control.k2_table)")},
    {PATH(belief.hub_spring_factor), REAL("", 0.01, 100), DEFAULT(1), TIMED,
     MEANING("stiffness of the hub's spring that the controller believes in, divided by the true "
             "one (arm.hub_joint = spring)")},
    {PATH(belief.wall_error), REAL("rad", -3, 3), DEFAULT(0), TIMED,
     MEANING("wall angle that the controller believes in, minus the wall's")},
    {PATH(belief.delay_error), REAL("s", -2, 2), DEFAULT(0), TIMED,
     MEANING("delay of its commands that the controller believes in, at least 0, minus the true "
             "one")},

    {PATH(sensor.ideal), BOOLEAN, DEFAULT(false), TIMED,
     MEANING("switches off every imperfection of sensors and converters")},
    {PATH(sensor.force), CHOICE(1, "fsr|piezo"), DEFAULT(FORCE_BY_FSR),
     MEANING("force sensor whose reading the controller gets as the force")},
    {PATH(sensor.encoder_counts), INTEGER(0, 1000000000), DEFAULT(8000),
     MEANING("counts of the encoder per revolution, 0 for a continuous reading")},
    {PATH(sensor.encoder_gain_error), REAL("", -0.9, 9), DEFAULT(0), TIMED,
     MEANING("share by which the encoder shows more than there is, which no controller is told")},
    {PATH(sensor.encoder_offset), REAL("rad", -3, 3), DEFAULT(0), TIMED,
     MEANING("what the encoder adds to that, untold too")},
    {PATH(sensor.tachometer_gain), REAL("V s/rad", 1e-6, 1000), DEFAULT(2),
     MEANING("volts of the tachometer per hub velocity")},
    {PATH(sensor.tachometer_ripple), REAL("", 0, 1), DEFAULT(0.01), TIMED,
     MEANING("amplitude of the tachometer's ripple as a share of its reading")},
    {PATH(sensor.tachometer_ripple_count), INTEGER(0, 100000), DEFAULT(79),
     MEANING("ripples a revolution")},
    {PATH(sensor.tachometer_noise), REAL("V", 0, 10), DEFAULT(0.01), TIMED,
     MEANING("standard deviation of the tachometer's noise")},
    {PATH(sensor.tachometer_gain_error), REAL("", -0.9, 9), DEFAULT(0), TIMED,
     MEANING(
         "share by which the tachometer shows more than there is, which no controller is told")},
    {PATH(sensor.tachometer_offset), REAL("rad/s", -100, 100), DEFAULT(0), TIMED,
     MEANING("what the tachometer adds to that, untold too")},
    {PATH(sensor.fsr_rise_time), REAL("s", 0, 1), DEFAULT(1.5e-3), TIMED,
     MEANING("rise time of the force sensor from 10 % to 90 %, 0 for an instant one")},
    {PATH(sensor.fsr_resistance), REAL("ohm", 1, 1e9), DEFAULT(30e3),
     MEANING("resistance of the force sensor at 1 N")},
    {PATH(sensor.fsr_exponent), REAL("", 0.1, 3), DEFAULT(0.75),
     MEANING("exponent of its power law, resistance = fsr_resistance (force/1 N)^-fsr_exponent")},
    {PATH(sensor.fsr_divider), REAL("ohm", 1, 1e9), DEFAULT(40e3),
     MEANING("measuring resistor of the voltage divider (R_M)")},
    {PATH(sensor.fsr_supply), REAL("V", 1e-3, 1000), DEFAULT(5),
     MEANING("voltage across the divider")},
    {PATH(sensor.fsr_gain), REAL("", 1e-3, 1000), DEFAULT(2),
     MEANING("gain of the stage behind the divider, 1 + R5/R6")},
    {PATH(sensor.fsr_saturation), REAL("N", 1e-3, 1e6), DEFAULT(10),
     MEANING("force beyond which the sensor's resistance falls no further")},
    {PATH(sensor.fsr_noise), REAL("V", 0, 10), DEFAULT(0.02), TIMED,
     MEANING("standard deviation of the force channel's noise")},
    {PATH(sensor.fsr_gain_error), REAL("", -0.9, 9), DEFAULT(0), TIMED,
     MEANING("share by which the FSR shows more than there is, which no controller is told")},
    {PATH(sensor.fsr_offset), REAL("N", -1000, 1000), DEFAULT(0), TIMED,
     MEANING("what the FSR adds to that, untold too")},
    {PATH(sensor.fsr_hysteresis), REAL("", 0, 0.9), DEFAULT(0), TIMED,
     MEANING("share by which the FSR shows less than a rising force and more than a falling one")},
    {PATH(sensor.piezo), BOOLEAN, DEFAULT(false),
     MEANING("fits a piezoelectric force sensor at the tip (sensor.force = piezo fits it too)")},
    {PATH(sensor.piezo_gain), REAL("V/N", 1e-6, 1e6), DEFAULT(1),
     MEANING("volts of its charge amplifier per force")},
    {PATH(sensor.piezo_rise_time), REAL("s", 0, 1), DEFAULT(5e-5),
     MEANING(
         "rise time of the piezoelectric force sensor from 10 % to 90 %, 0 for an instant one")},
    {PATH(sensor.piezo_leak_time), REAL("s", 0, 1e6), DEFAULT(5),
     MEANING("time constant with which its charge leaks away, 0 for a charge that stays")},
    {PATH(sensor.piezo_range), REAL("N", 0, 1e6), DEFAULT(10),
     MEANING("force beyond which it is off scale either way, 0 for no such limit")},
    {PATH(sensor.piezo_noise), REAL("V", 0, 10), DEFAULT(5e-3), TIMED,
     MEANING("standard deviation of the piezoelectric force sensor's noise")},
    {PATH(sensor.piezo_gain_error), REAL("", -0.9, 9), DEFAULT(0), TIMED,
     MEANING("share by which the piezoelectric force sensor shows more than there is, which no "
             "controller is told")},
    {PATH(sensor.piezo_offset), REAL("N", -1000, 1000), DEFAULT(0), TIMED,
     MEANING("what the piezoelectric force sensor adds to that, untold too")},
    {PATH(sensor.film), BOOLEAN, DEFAULT(false),
     MEANING("fits a piezo film along the beam that shows its bending, last link's angle minus the "
             "first's (control.impact_angle = film fits it too)")},
    {PATH(sensor.film_gain), REAL("V/rad", 1e-6, 1e6), DEFAULT(10),
     MEANING("volts of the film's amplifier per bending")},
    {PATH(sensor.film_leak_time), REAL("s", 0, 1e6), DEFAULT(1),
     MEANING("time constant with which the film's charge leaks away, 0 for a charge that stays")},
    {PATH(sensor.film_noise), REAL("V", 0, 10), DEFAULT(0.01), TIMED,
     MEANING("standard deviation of the film's noise")},
    {PATH(sensor.accelerometer), BOOLEAN, DEFAULT(false),
     MEANING("fits a tangential accelerometer to the hub that shows its angular acceleration")},
    {PATH(sensor.accelerometer_gain), REAL("V s2/rad", 1e-9, 1e6), DEFAULT(0.02),
     MEANING("volts of the accelerometer per angular acceleration of the hub")},
    {PATH(sensor.accelerometer_rise_time), REAL("s", 0, 1), DEFAULT(3.5e-4),
     MEANING("rise time of the accelerometer from 10 % to 90 % (0.35 over its bandwidth), 0 for an "
             "instant one")},
    {PATH(sensor.accelerometer_range), REAL("rad/s2", 0, 1e9), DEFAULT(500),
     MEANING("angular acceleration beyond which it is off scale either way, 0 for no such limit")},
    {PATH(sensor.accelerometer_noise), REAL("V", 0, 10), DEFAULT(5e-3), TIMED,
     MEANING("standard deviation of the accelerometer's noise")},
    {PATH(sensor.adc_bits), INTEGER(0, 32), DEFAULT(12),
     MEANING("bits of the A/D converter, 0 for a continuous one")},
    {PATH(sensor.dac_bits), INTEGER(0, 32), DEFAULT(12),
     MEANING("bits of the D/A converter, 0 for a continuous one")},
    {PATH(sensor.adc_range), REAL("V", 1e-3, 1000), DEFAULT(10),
     MEANING("range of the A/D converter either way")},
};

const int parameter_count = (int)(sizeof parameter_table / sizeof parameter_table[0]);

_Static_assert(sizeof parameter_table / sizeof parameter_table[0] <= sizeof(((parameters *)0)->set),
               "parameters.set has room for every parameter");
_Static_assert(sizeof parameter_table / sizeof parameter_table[0] <= UCHAR_MAX + 1,
               "a byte has room for every index");

// The index of the parameter that begins at each offset, filled in before the program begins:
// resolving a set of parameters asks a hundred times.
static unsigned char index_at[sizeof(parameters)];

static __attribute__((constructor)) void fill_indices(void)
{
    for (int i = 0; i < parameter_count; i++) {
        index_at[parameter_table[i].offset] = (unsigned char)i;
    }
}

int parameter_at(size_t offset)
{
    assert(offset < sizeof index_at);
    const int index = index_at[offset];
    assert(parameter_table[index].offset == offset);
    return index;
}

int parameter_find(const char *path)
{
    assert(path != NULL);
    for (int i = 0; i < parameter_count; i++) {
        if (strcmp(parameter_table[i].path, path) == 0) {
            return i;
        }
    }
    return -1;
}

int parameter_index(const char *path)
{
    int index = parameter_find(path);
    assert(index >= 0);
    return index;
}

int parameter_look_up(const char *path, fault *f)
{
    int index = parameter_find(path);
    if (index < 0) {
        const char *near = parameter_suggest(path);
        fault_set(f, STATUS_BAD_ARGUMENT, "unknown parameter '%.60s'%s%s%s", path,
                  near ? ", did you mean '" : ", expected one that 'show' lists", near ? near : "",
                  near ? "'?" : "");
    }
    return index;
}

const char *parameter_suggest(const char *path)
{
    // the right name, perhaps in a wrong group or in none
    const char *dot = strrchr(path, '.'), *name = dot != NULL ? dot + 1 : path;
    nearest_word nearest = nearest_begin(path);
    for (int i = 0; i < parameter_count; i++) {
        if (strcmp(strchr(parameter_table[i].path, '.') + 1, name) == 0) {
            return parameter_table[i].path;
        }
        nearest_try(&nearest, parameter_table[i].path);
    }
    return nearest.best;
}

const control_law_info control_law_table[LAW_COUNT] = {
    [LAW_NONE] = {"none", "no rig: the bare arm under motor.voltage"},
    [LAW_PLUGIN] = {"plugin", "a controller of one's own"},
    [LAW_PROCESS] = {"process", "a program of one's own, in any language"},
    [LAW_PLAYBACK] = {"playback", "a recorded command, from a CSV file"},
#define LAW(name, prefix, word, description) [LAW_##name] = {word, description},
    CONTROL_LAWS(LAW)
#undef LAW
};
