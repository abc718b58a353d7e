// The parameters: every number, word and text of a run, in the order of `impactlab show`.
//
// Read twice: parameters.h makes of each row the field of its struct, parameters.c its
// line of parameter_table. A row is
//     REAL(group, field, meaning, unit, from, to, ...)  BOOLEAN(group, field, meaning,
//     ...) CHOICE(group, field, meaning, last, words, ...)   TEXT(group, field, meaning,
//     without, ...) INTEGER(group, field, meaning, from, to, ...)     LIST(group, field,
//     meaning, unit, from, to)
// with its default, one for both models or DEFAULTS(corrected, printed), TIMED where it
// may change during a run, and a SYMBOL where papers have one, its index behind "_"; a
// text says what it is `without` anybody giving it. The path is group.field, a range
// includes both its ends, a meaning is one sentence without a full stop. A parameter is
// added here and nowhere else. A row wraps where it reads best, so that the formatter is
// off.

// clang-format off
GROUP(arm_parameters)
CHOICE(arm, model, "equations of motion: derived anew, or as the thesis prints them",
    1, "corrected|printed", DEFAULTS(ARM_CORRECTED, ARM_PRINTED))
INTEGER(arm, links, "number of rigid links the beam is cut into (N)",
    1, PARAMETER_LINKS_MOST, DEFAULT(2), SYMBOL("N"))
CHOICE(arm, hub_joint, "joint between hub and first link: one body, the spring k1, or the beam's "
    "own root, a spring k2 N", 2, "rigid|spring|beam", DEFAULTS(HUB_RIGID, HUB_SPRING))
REAL(arm, length, "length of the beam, all links together", "m", 0.01, 100, DEFAULT(1.0),
    SYMBOL("L"))
REAL(arm, mass, "mass of the beam, all links together", "kg", 1e-4, 1e4, DEFAULT(0.40108),
    SYMBOL("m"))
REAL(arm, hub_inertia, "moment of inertia of hub and motor shaft (I1)",
    "kg m2", 0, 1e4, DEFAULT(5.2e-3), SYMBOL("I_1"))
REAL(arm, link_inertia, "moment of inertia of a link about its centre of mass (I2 = I3, N = 2 "
    "only)", "kg m2", 0, 1e4, DEFAULTS(DERIVED, 1.67e-5), SYMBOL("I_2"))
REAL(arm, k1, "stiffness of the hub joint (arm.hub_joint = spring; with beam it is k2 N)",
    "N m/rad", 1e-6, 1e9, DEFAULTS(K1_THESIS, K1_PRINTED_TABLES), TIMED, SYMBOL("k_1"))
REAL(arm, k2, "stiffness of the middle joint of the two-link beam; each joint of N links has k2 "
    "N/2", "N m/rad", 1e-6, 1e9, DEFAULT(4.92), TIMED, SYMBOL("k_2"))
REAL(arm, EI, "bending stiffness of the beam, in place of arm.k2 = 2 EI/length",
    "N m2", 1e-9, 1e12, DEFAULT(DERIVED), TIMED, SYMBOL("EI"))
LIST(arm, joint_stiffness, "stiffness of every joint between links from the hub outwards, of a "
    "beam the root's first, in place of arm.k2", "N m/rad", 1e-6, 1e9)
LIST(arm, link_lengths, "length of every link from the hub outwards, in place of arm.length; "
    "masses go with the lengths, unless arm.link_masses gives them", "m", 1e-4, 100)
LIST(arm, link_masses, "mass of every link from the hub outwards, in place of arm.mass",
    "kg", 1e-6, 1e4)
LIST(arm, link_inertias, "moment of inertia of every link about its centre of mass, its middle, in "
    "place of a uniform rod's m l^2/12", "kg m2", 0, 1e4)
LIST(arm, joint_damping, "viscous damping of every joint from the hub outwards, of a hub spring or "
    "a beam's root first, in place of arm.damping_ratio; one number holds for all",
    "N m s/rad", 0, 1e6)
REAL(arm, damping_ratio, "structural damping ratio of the first clamped-free mode",
    "", 0, 1, DEFAULT(0), SYMBOL("ζ"))
LIST(arm, modal_ratios, "damping ratios of the modes with the hub held, from the slowest on, in "
    "place of arm.damping_ratio; modes beyond the list have none", "", 0, 1000)
REAL(arm, air_drag, "drag of the air on the beam per length and velocity",
    "N s/m2", 0, 1e6, DEFAULT(0))
REAL(arm, stiffening, "share by which k2 grows with the square of its bend, the torque being k2 b "
    "(1 + stiffening b^2); of N links the same curvature counts", "1/rad2", 0, 1e6, DEFAULT(0))
REAL(arm, tip_mass, "mass that the tip carries, such as a sensor", "kg", 0, 1000, DEFAULT(0),
    SYMBOL("m_t"))
REAL(arm, tilt, "tilt of the arm's plane to the level: g sin(tilt) acts along the angle -pi/2",
    "rad", -3.2, 3.2, DEFAULT(0), SYMBOL("α"))
END_GROUP(arm_parameters)

GROUP(motor_parameters)
REAL(motor, voltage, "voltage commanded to the amplifier, held constant",
    "V", -1000, 1000, DEFAULT(1), TIMED, SYMBOL("v"))
REAL(motor, voltage_limit, "largest command either way; beyond it the command saturates",
    "V", 0, 1000, DEFAULT(10), TIMED)
REAL(motor, amplifier_gain, "volts at the motor per volt of command", "", 0, 1000, DEFAULT(6.02))
REAL(motor, torque_constant, "torque per ampere (kT)", "N m/A", 0, 1000, DEFAULT(TORQUE_CONSTANT),
    SYMBOL("k_T"))
REAL(motor, back_emf, "back electromotive force (kB)", "V s/rad", 0, 1000, DEFAULT(2.443),
    SYMBOL("k_B"))
REAL(motor, resistance, "armature resistance (Ra)", "ohm", 1e-3, 1e6, DEFAULT(33.6), SYMBOL("R_a"))
REAL(motor, inductance, "armature inductance (motor.drive = voltage); 0: the current follows at "
    "once", "H", 0, 1000, DEFAULT(0), SYMBOL("L_a"))
REAL(motor, viscous_friction, "viscous friction at the hub (kfr)",
    "N m s/rad", 0, 1000, DEFAULT(5.4192e-3), TIMED, SYMBOL("k_fr"))
REAL(motor, stiction, "Coulomb friction torque at the hub, sliding and sticking (kst)",
    "N m", 0, 1000, DEFAULT(0.045), TIMED, SYMBOL("k_st"))
CHOICE(motor, drive, "what the amplifier gives for a command: a voltage, against which back EMF "
    "works, or a current, which it holds", 1, "voltage|current", DEFAULT(DRIVE_VOLTAGE))
REAL(motor, transconductance, "current per volt of command (motor.drive = current), "
    "amplifier_gain/resistance if not given: the same torque at rest",
    "A/V", 0, 1000, DEFAULT(DERIVED))
REAL(motor, current_limit, "largest current that the amplifier gives either way; 0: none",
    "A", 0, 1e6, DEFAULT(0))
END_GROUP(motor_parameters)

GROUP(wall_parameters)
CHOICE(wall, kind, "a fixed point the last link's line may not pass, a flat wall the tip may not "
    "pass, or none", 2, "point|plane|none", DEFAULT(WALL_POINT))
REAL(wall, angle, "direction of contact point or flat wall as seen from the hub axis",
    "rad", -3, 3, DEFAULT(0.1), TIMED, SYMBOL("θ_w"))
REAL(wall, restitution, "coefficient of restitution e of an impact on a rigid wall or a face with "
    "a mass (0: plastic)", "", 0, 1, DEFAULT(0), TIMED, SYMBOL("e"))
CHOICE(wall, contact, "how the wall answers: it does not give, or it is a spring and a damper with "
    "the force k x + c v or x^n (k + c v) at the depth x",
    2, "rigid|kelvin-voigt|hunt-crossley", DEFAULT(WALL_RIGID))
REAL(wall, stiffness, "stiffness k of a wall that gives, in N/m^n for hunt-crossley",
    "N/m", 1, 1e15, DEFAULT(DERIVED), SYMBOL("k"))
REAL(wall, damping, "damping c of a wall that gives, in N s/m^(n+1) for hunt-crossley",
    "N s/m", 0, 1e15, DEFAULT(DERIVED), SYMBOL("c"))
REAL(wall, exponent, "exponent n of hunt-crossley; 1.5 is Hertz's for a ball on a plane",
    "", 1, 5, DEFAULT(1.5), SYMBOL("n"))
REAL(wall, mass, "mass of the face in front of the spring and damper of kelvin-voigt, which the "
    "arm strikes as a rigid body; 0: none", "kg", 0, 1e6, DEFAULT(0), SYMBOL("M_f"))
CHOICE(wall, motion, "how the wall moves along its normal: not, A sin(2 pi f (t - t0)), by A "
    "within 1/(2 f) from t0 on, smoothly up to the acceleration, or as wall.motion_file says",
    MOTION_FILE, "none|sine|step|file", DEFAULT(MOTION_NONE))
REAL(wall, motion_amplitude, "amplitude A of that motion, positive towards the arm",
    "m", -10, 10, DEFAULT(0.001))
REAL(wall, motion_frequency, "frequency f of that motion, half a period of which a step takes",
    "Hz", 1e-3, 1e4, DEFAULT(1))
REAL(wall, motion_time, "t0 of that motion: where a sine passes zero, where a step or a file "
    "begins", "s", -1e10, 1e10, DEFAULT(0))
TEXT(wall, motion_file, "CSV with columns time [s] and place [m], towards the arm; between its "
    "rows a spline, before and after them the wall rests (wall.motion = file)", NULL)
END_GROUP(wall_parameters)

GROUP(method_parameters)
CHOICE(method, name, "time integration",
    2, "event|newmark|generalized-alpha", DEFAULTS(METHOD_EVENT, METHOD_NEWMARK))
REAL(method, step, "time step h; under event only the spacing of the recorded rows",
    "s", 1e-7, 1, DEFAULT(1e-3), SYMBOL("h"))
REAL(method, beta, "Newmark's beta", "", 0.01, 2, DEFAULT(0.4), SYMBOL("β"))
REAL(method, gamma, "Newmark's gamma", "", 0, 2, DEFAULT(0.5), SYMBOL("γ"))
REAL(method, spectral_radius, "what generalised-alpha leaves of the highest modes in one step (rho "
    "at infinity)", "", 0, 1, DEFAULT(0.8), SYMBOL("ρ_∞"))
REAL(method, rest_speed, "rest rule: an impact slower than this is plastic whatever e is",
    "m/s", 0, 1, DEFAULT(1e-4))
REAL(method, residual_bound, "share of the energy put in that the ledger may lack before a run "
    "counts as inaccurate (event 1e-6, newmark and generalized-alpha 1e-2)",
    "", 0, 1, DEFAULT(EVENT_RESIDUAL_BOUND))
CHOICE(method, engine, "what the event method integrates with: the arm decides, power series of "
    "two equal links on a rigid wall, a stiff formula of order 13 for any arm",
    2, "auto|pair|stiff", DEFAULT(ENGINE_AUTO))
REAL(method, tolerance, "error of the stiff engine's steps as its embedded formula of order 7 sees "
    "it, as a share of the arm's largest momentum; a hundredth of it on a wall that gives, a "
    "thousandth where an undamped arm bounces or a wall moves, ten times that where decays are "
    "faster than vibrations, the motor's current and 3e4 1/s; these shares leave at least 1e-12",
    "", 1e-13, 1e-3, DEFAULT(1e-8))
END_GROUP(method_parameters)

GROUP(printed_parameters)
CHOICE(printed, program, "printed model: what it follows where the thesis's equations and its "
    "listing differ; listing stands for printed.reevaluation = listing and "
    "printed.feed_newmark_acceleration = true unless these are given",
    1, "equations|listing", DEFAULT(PROGRAM_EQUATIONS))
BOOLEAN(printed, spring_counted_twice, "printed model: (2.16) carries the spring k2 that belongs "
    "in (2.17) alone", DEFAULT(true))
BOOLEAN(printed, force_at_link_end, "printed model: the contact force acts at the link's end "
    "instead of the contact point", DEFAULT(true))
BOOLEAN(printed, sign_dead_band, "printed model: sign() names -0.01 for the lower edge of its dead "
    "band instead of -1e-5; its last test overrules that, so that this changes no result",
    DEFAULT(true))
BOOLEAN(printed, energy_cross_term, "printed model: kinetic energy of the predictor has eps w2 w3 "
    "for 2 l eps w2 w3", DEFAULT(true))
CHOICE(printed, reevaluation, "printed model: where the re-evaluation puts 2 l sin(d) w2 w3, as "
    "(3.13) has it or as the listing has it; none: the single run of 3.1.3, whose force is "
    "Newmark's own", 2, "rhs|listing|none", DEFAULT(REEVALUATE_RHS))
BOOLEAN(printed, clamp_force, "printed model: a force that comes out negative is set to zero",
    DEFAULT(true))
BOOLEAN(printed, force_after_release, "printed model: the force is evaluated from the constrained "
    "system after release too", DEFAULT(true))
BOOLEAN(printed, feed_newmark_acceleration, "printed model: the next step starts from Newmark's "
    "own acceleration, not the re-evaluated one", DEFAULT(false))
INTEGER(printed, newton_iterations, "printed model: Newton solves per time step",
    1, 100, DEFAULT(2))
END_GROUP(printed_parameters)

GROUP(initial_parameters)
REAL(initial, angle, "angle of hub and all links at the start", "rad", -3, 3, DEFAULT(0),
    SYMBOL("θ_0"))
REAL(initial, velocity, "angular velocity of hub and all links at the start",
    "rad/s", -1000, 1000, DEFAULT(0), SYMBOL("θ̇_0"))
END_GROUP(initial_parameters)

GROUP(run_parameters)
REAL(run, duration, "simulated time", "s", 1e-6, 1e5, DEFAULT(1))
END_GROUP(run_parameters)

GROUP(control_parameters)
CHOICE(control, law, "control law on the rig, or none: the bare arm under motor.voltage",
    LAW_PLAYBACK, CONTROL_LAW_CHOICES, DEFAULT(LAW_NONE))
TEXT(control, plugin, "shared object with a controller of one's own (control.law = plugin)", NULL)
TEXT(control, command, "program that is the controller, as a shell takes it (control.law = "
    "process)", NULL)
REAL(control, answer_time, "for which a process may keep the lab waiting, by the clock, before the "
    "run fails", "s", 0.01, 3600, DEFAULT(10))
TEXT(control, playback_file, "CSV with the command to play back and its times in a column t or "
    "time (control.law = playback)", NULL)
TEXT(control, playback_column, "heading of the command's column there, name or name[unit]; V "
    "without a unit", "command")
REAL(control, playback_shift, "by which the command comes later than it was recorded",
    "s", -1e10, 1e10, DEFAULT(0))
CHOICE(control, playback_hold, "between two rows the earlier one's command, or on the straight "
    "line; outside the recording that of the first or last row",
    PLAYBACK_LINEAR, "hold|linear", DEFAULT(PLAYBACK_HOLD))
TEXT(control, settings, "parameters that only this law, plug-in or process has, written name=value "
    "and separated by spaces; control.settings.NAME is one of them", NULL, TIMED)
TEXT(control, lock, "mode that the law is held in, by its name, or none: the law chooses",
    "none", TIMED)
REAL(control, rate, "samples a second", "Hz", 1, 1e5, DEFAULT(200), TIMED, SYMBOL("f_s"))
REAL(control, delay, "from a sample to the instant its command takes effect, at most five periods",
    "s", 0, 1, DEFAULT(0), TIMED)
REAL(control, delay_periods, "further delay in nominal periods, 1/control.rate whatever the "
    "jitter, five at most in all; 1 without jitter: a command goes out with the next sample",
    "", 0, 5, DEFAULT(0), TIMED)
REAL(control, jitter, "width over which the sampling instants scatter, at most one period",
    "s", 0, 1, DEFAULT(0), TIMED)
INTEGER(control, seed, "seed of all noise of the rig", 0, 2147483647, DEFAULT(1))
REAL(control, force, "commanded contact force", "N", 0, 1000, DEFAULT(1), TIMED, SYMBOL("f_d"))
REAL(control, force_rate, "how fast the commanded force goes to control.force, a ramp; 0: at once, "
    "a step", "N/s", 0, 1e6, DEFAULT(0), TIMED)
REAL(control, force_amplitude, "amplitude of a sine on the commanded force",
    "N", 0, 1000, DEFAULT(0), TIMED)
REAL(control, force_frequency, "frequency of that sine", "Hz", 0, 1e4, DEFAULT(1), TIMED)
REAL(control, approach_voltage, "constant command of the approach",
    "V", -1000, 1000, DEFAULT(1), TIMED)
REAL(control, kp, "position gain, per rad, of a torque in N m or of volts (control.gains)",
    "", -1e6, 1e6, DEFAULT(10.15), TIMED, SYMBOL("k_p"))
REAL(control, kv, "velocity gain, per rad/s, of a torque in N m or of volts (control.gains)",
    "", -1e6, 1e6, DEFAULT(0.75), TIMED, SYMBOL("k_v"))
CHOICE(control, gains, "hybrid: what kp and kv give; printed: torque in the impact mode and volts "
    "in the force mode", 2, "torque|volts|printed", DEFAULT(0), TIMED)
CHOICE(control, coefficients, "hybrid: factors of its model, 4 k2 and 2 f l, or 6 k2 and 3 f l as "
    "printed", 1, "corrected|printed", DEFAULT(0), TIMED)
REAL(control, transition_time, "hybrid: length of the impact mode (t_f); inverse-dynamics: how "
    "long the force rises", "s", 1e-3, 100, DEFAULT(0.35), TIMED, SYMBOL("t_f"))
REAL(control, contact_threshold, "force reading that a controller takes for contact",
    "N", 0, 1000, DEFAULT(0.05), TIMED)
TEXT(control, k2_table, "k2 by commanded force as calibrate measures it, written FORCE:K2 and "
    "separated by spaces", NULL)
REAL(control, force_gain, "gain of the force error", "V/N", -1000, 1000, DEFAULT(1), TIMED)
REAL(control, integral_gain, "gain of the integrated force error",
    "V/(N s)", -1e4, 1e4, DEFAULT(5), TIMED)
REAL(control, speed_limit, "speed-limit: hub velocity of the approach",
    "rad/s", 0, 1000, DEFAULT(0.3), TIMED)
REAL(control, reverse_time, "reverse-torque: how long the motor pulls back after contact",
    "s", 0, 10, DEFAULT(0.02), TIMED)
REAL(control, switch_share, "bang-bang: share of the way to the wall at which the command is "
    "reversed", "", 0, 1, DEFAULT(0.5), TIMED)
REAL(control, force_limit, "touch, observer, speed-limit: limit that the force is to keep, 0 "
    "for none; with one the rig predicts at every sample how hard a touch would be",
    "N", 0, 1000, DEFAULT(0), TIMED)
REAL(control, travel_time, "inverse-dynamics: how long the tip moves to the wall",
    "s", 1e-3, 100, DEFAULT(0.35))
REAL(control, arrival_speed, "inverse-dynamics: speed with which the tip is to meet the wall",
    "m/s", 0, 1000, DEFAULT(0))
CHOICE(control, impact_angle, "hybrid: where it has the wall's angle from in contact; a sensor is "
    "fitted with it", 2, "told|film|accelerometer", DEFAULT(IMPACT_ANGLE_TOLD))
END_GROUP(control_parameters)

GROUP(nominal_model_parameters)
INTEGER(belief, links, "number of links of the beam in the controller's model, where it can have "
    "several", 2, 64, DEFAULT(2))
REAL(belief, mass_factor, "beam's mass, with its moments of inertia, that the controller believes "
    "in, divided by the true one", "", 0.01, 100, DEFAULT(1), TIMED)
REAL(belief, inertia_factor, "hub's moment of inertia that the controller believes in, divided by "
    "the true one", "", 0.01, 100, DEFAULT(1), TIMED)
REAL(belief, friction_factor, "Coulomb and viscous friction that the controller believes in, "
    "divided by the true one", "", 0, 100, DEFAULT(1), TIMED)
REAL(belief, torque_factor, "torque constant kT that the controller believes in, divided by the "
    "true one", "", 0.01, 100, DEFAULT(1), TIMED)
REAL(belief, k2_factor, "k2 that the controller believes in, divided by the arm's (by that of "
    "control.k2_table)", "", 0.01, 100, DEFAULT(1), TIMED)
REAL(belief, hub_spring_factor, "stiffness of the hub's spring that the controller believes in, "
    "divided by the true one (arm.hub_joint = spring)", "", 0.01, 100, DEFAULT(1), TIMED)
REAL(belief, wall_error, "wall angle that the controller believes in, minus the wall's",
    "rad", -3, 3, DEFAULT(0), TIMED)
REAL(belief, delay_error, "delay of its commands that the controller believes in, at least 0, "
    "minus the true one", "s", -2, 2, DEFAULT(0), TIMED)
END_GROUP(nominal_model_parameters)

GROUP(sensor_parameters)
BOOLEAN(sensor, ideal, "switches off every imperfection of sensors and converters",
    DEFAULT(false), TIMED)
CHOICE(sensor, force, "force sensor whose reading the controller gets as the force",
    1, "fsr|piezo", DEFAULT(FORCE_BY_FSR))
INTEGER(sensor, encoder_counts, "resolution of the encoder, counts a revolution, 0 for a continuous reading",
    0, 1000000000, DEFAULT(8000))
REAL(sensor, encoder_gain_error, "share by which the encoder shows more than there is, which no "
    "controller is told", "", -0.9, 9, DEFAULT(0), TIMED)
REAL(sensor, encoder_offset, "what the encoder adds to that, untold too",
    "rad", -3, 3, DEFAULT(0), TIMED)
REAL(sensor, tachometer_gain, "volts of the tachometer per hub velocity",
    "V s/rad", 1e-6, 1000, DEFAULT(2))
REAL(sensor, tachometer_ripple, "amplitude of the tachometer's ripple as a share of its reading",
    "", 0, 1, DEFAULT(0.01), TIMED)
INTEGER(sensor, tachometer_ripple_count, "ripples a revolution", 0, 100000, DEFAULT(79))
REAL(sensor, tachometer_noise, "standard deviation of the tachometer's noise",
    "V", 0, 10, DEFAULT(0.01), TIMED)
REAL(sensor, tachometer_gain_error, "share by which the tachometer shows more than there is, which "
    "no controller is told", "", -0.9, 9, DEFAULT(0), TIMED)
REAL(sensor, tachometer_offset, "what the tachometer adds to that, untold too",
    "rad/s", -100, 100, DEFAULT(0), TIMED)
REAL(sensor, fsr_rise_time, "rise time of the force sensor from 10 % to 90 %, 0 for an instant one",
    "s", 0, 1, DEFAULT(1.5e-3), TIMED)
REAL(sensor, fsr_resistance, "resistance of the force sensor at 1 N", "ohm", 1, 1e9, DEFAULT(30e3))
REAL(sensor, fsr_exponent, "exponent of its power law, resistance = fsr_resistance (force/1 "
    "N)^-fsr_exponent", "", 0.1, 3, DEFAULT(0.75))
REAL(sensor, fsr_divider, "measuring resistor of the voltage divider (R_M)",
    "ohm", 1, 1e9, DEFAULT(40e3))
REAL(sensor, fsr_supply, "voltage across the divider", "V", 1e-3, 1000, DEFAULT(5))
REAL(sensor, fsr_gain, "gain of the stage behind the divider, 1 + R5/R6",
    "", 1e-3, 1000, DEFAULT(2))
REAL(sensor, fsr_saturation, "force beyond which the sensor's resistance falls no further",
    "N", 1e-3, 1e6, DEFAULT(10))
REAL(sensor, fsr_noise, "standard deviation of the force channel's noise",
    "V", 0, 10, DEFAULT(0.02), TIMED)
REAL(sensor, fsr_gain_error, "share by which the FSR shows more than there is, which no controller "
    "is told", "", -0.9, 9, DEFAULT(0), TIMED)
REAL(sensor, fsr_offset, "what the FSR adds to that, untold too",
    "N", -1000, 1000, DEFAULT(0), TIMED)
REAL(sensor, fsr_hysteresis, "share by which the FSR shows less than a rising force and more than "
    "a falling one: a play, which extremes between samples and impulses move, too",
    "", 0, 0.9, DEFAULT(0), TIMED)
BOOLEAN(sensor, piezo, "fits a piezoelectric force sensor at the tip (sensor.force = piezo fits it "
    "too)", DEFAULT(false))
REAL(sensor, piezo_gain, "volts of its charge amplifier per force", "V/N", 1e-6, 1e6, DEFAULT(1))
REAL(sensor, piezo_rise_time, "rise time of the piezoelectric force sensor from 10 % to 90 %, 0 "
    "for an instant one", "s", 0, 1, DEFAULT(5e-5))
REAL(sensor, piezo_leak_time, "time constant with which its charge leaks away, 0 for a charge that "
    "stays", "s", 0, 1e6, DEFAULT(5))
REAL(sensor, piezo_range, "force beyond which it is off scale either way, 0 for no such limit",
    "N", 0, 1e6, DEFAULT(10))
REAL(sensor, piezo_noise, "standard deviation of the piezoelectric force sensor's noise",
    "V", 0, 10, DEFAULT(5e-3), TIMED)
REAL(sensor, piezo_gain_error, "share by which the piezoelectric force sensor shows more than "
    "there is, which no controller is told", "", -0.9, 9, DEFAULT(0), TIMED)
REAL(sensor, piezo_offset, "what the piezoelectric force sensor adds to that, untold too",
    "N", -1000, 1000, DEFAULT(0), TIMED)
BOOLEAN(sensor, film, "fits a piezo film along the beam that shows its bending, last link's angle "
    "minus the first's (control.impact_angle = film fits it too)", DEFAULT(false))
REAL(sensor, film_gain, "volts of the film's amplifier per bending",
    "V/rad", 1e-6, 1e6, DEFAULT(10))
REAL(sensor, film_leak_time, "time constant with which the film's charge leaks away, 0 for a "
    "charge that stays", "s", 0, 1e6, DEFAULT(1))
REAL(sensor, film_noise, "standard deviation of the film's noise", "V", 0, 10, DEFAULT(0.01), TIMED)
BOOLEAN(sensor, accelerometer, "fits a tangential accelerometer to the hub that shows its angular "
    "acceleration", DEFAULT(false))
REAL(sensor, accelerometer_gain, "volts of the accelerometer per angular acceleration of the hub",
    "V s2/rad", 1e-9, 1e6, DEFAULT(0.02))
REAL(sensor, accelerometer_rise_time, "rise time of the accelerometer from 10 % to 90 % (0.35 over "
    "its bandwidth), 0 for an instant one", "s", 0, 1, DEFAULT(3.5e-4))
REAL(sensor, accelerometer_range, "angular acceleration beyond which it is off scale either way, 0 "
    "for no such limit", "rad/s2", 0, 1e9, DEFAULT(500))
REAL(sensor, accelerometer_noise, "standard deviation of the accelerometer's noise",
    "V", 0, 10, DEFAULT(5e-3), TIMED)
BOOLEAN(sensor, tip_deflection, "fits a sensor of the tip's deflection from the tangent to the "
    "hub, such as a camera on the hub; no controller is told", DEFAULT(false))
REAL(sensor, tip_deflection_gain, "volts of that sensor per deflection", "V/m", 1e-6, 1e6, DEFAULT(50))
REAL(sensor, tip_deflection_noise, "standard deviation of its noise", "V", 0, 10, DEFAULT(0.01), TIMED)
REAL(sensor, tip_deflection_rate, "how often it looks, at samples of the rig; 0: at every one",
    "Hz", 0, 1e5, DEFAULT(0))
BOOLEAN(sensor, root_strain, "fits a strain gauge at the root of the beam; no controller is told",
    DEFAULT(false))
REAL(sensor, root_strain_distance, "distance of the gauge from the neutral line: strain = distance "
    "times curvature", "m", 1e-6, 1, DEFAULT(1e-3))
REAL(sensor, root_strain_gain, "volts of the gauge's amplifier per strain", "V", 1e-6, 1e9,
    DEFAULT(5000))
REAL(sensor, root_strain_noise, "standard deviation of the gauge's noise", "V", 0, 10,
    DEFAULT(0.01), TIMED)
REAL(sensor, root_strain_rate, "how often it looks, at samples of the rig; 0: at every one", "Hz", 0,
    1e5, DEFAULT(0))
INTEGER(sensor, adc_bits, "bits of the A/D converter, 0 for a continuous one", 0, 32, DEFAULT(12))
INTEGER(sensor, dac_bits, "bits of the D/A converter, 0 for a continuous one", 0, 32, DEFAULT(12))
REAL(sensor, adc_range, "range of the A/D converter either way", "V", 1e-3, 1000, DEFAULT(10))
END_GROUP(sensor_parameters)
