// One experiment for several simulators: its definition, their answers and interface.
//
// The arm of the laboratory (corrected model, two links, rigid hub) is driven by a constant command
// against a flat wall: first impact, bounce, second contact, rest. A second experiment swings
// chains of N links in free flight. A peer is one program in one set-up; it is created once
// (reading models, allocating) and then run many times, and only the runs are timed.
#pragma once

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

// The experiment in SI units, the same for every program.
#define EXPERIMENT_STEP            1e-3    // of fixed-step programs, two links [s]
#define EXPERIMENT_DURATION        1.0     // [s]
#define EXPERIMENT_VOLTAGE         1.0     // command before the amplifier [V]
#define EXPERIMENT_WALL            0.1     // direction of the wall from the hub axis [rad]
#define EXPERIMENT_BEAM_LENGTH     1.0     // all links together [m]
#define EXPERIMENT_BEAM_MASS       0.40108 // all links together [kg]
#define EXPERIMENT_HUB_INERTIA     5.2e-3  // added to the first link [kg m2]
#define EXPERIMENT_SPRING          4.92  // inner joint of two links; N links: SPRING N/2 [N m/rad]
#define EXPERIMENT_STICTION        0.045 // Coulomb friction at the hub [N m]
#define EXPERIMENT_TORQUE_CONSTANT (0.249092 * 9.80665)                       // [N m/A]
#define EXPERIMENT_TORQUE          (6.02 * EXPERIMENT_TORQUE_CONSTANT / 33.6) // per volt [N m/V]
#define EXPERIMENT_HUB_DAMPING                                                                     \
    (5.4192e-3 + EXPERIMENT_TORQUE_CONSTANT * 2.443 / 33.6) // [N m s/rad]

// Simulators with soft contact or impulses smeared over steps have their first pulse's peak taken
// this long after first contact, when the impact itself is over [s].
#define EXPERIMENT_SETTLING 0.01

// What a run gives. A quantity that did not occur, or that the program does not tell, is NaN.
typedef struct peer_answer {
    double first_contact;  // [s]
    double impulse;        // of the first impact [N s]
    double peak;           // largest force of the first pulse, the impact excluded [N]
    double peak_delay;     // of that force, after first contact [s]
    double spike;          // largest force with the impact included [N]
    double release;        // end of the first pulse [s]
    double second_contact; // [s]
    double final_force;    // at the end of the run [N]
    double hub_angle;      // at the end of the run [rad]
    double steps;          // time steps taken
    double computing_time; // as the program itself tells it, NaN if it does not [s]
} peer_answer;

typedef struct peer {
    const char *program; // "MuJoCo"
    const char *version; // "2.2.2"
    const char *setup;   // "tendon limit, Euler": one line
    int links;           // 2: the impact; more: a chain in free flight
    int variant;         // the program's own number of the set-up
    // Whatever can be prepared before the first run. NULL if it could not be.
    void *(*create)(const struct peer *self);
    void (*destroy)(void *instance);
    // One run from the start. False if it failed.
    bool (*run)(void *instance, peer_answer *answer);
    // Step of a fixed-step program, 0 if it chooses its steps [s], and the time it simulates [s].
    double (*step)(const void *instance);
    double (*duration)(const void *instance);
} peer;

// Each simulator offers its peers; returns how many.
int peers_impactlab(const peer **list);
int peers_mujoco(const peer **list);
int peers_siconos(const peer **list);

// Fills everything with NaN.
void peer_answer_clear(peer_answer *answer);

// For programs that choose their steps, and for those that simulate the experiment as it is.
double peer_own_steps(const void *instance);
double peer_duration(const void *instance);

// A force of the first pulse at a time [s], [N]: kept if it is the largest so far.
void peer_note_peak(double time, double force, peer_answer *answer);

// A contact that begins at a time with an impulse [s], [N s]: the first, the second, or none of
// those that are told.
void peer_note_contact(double time, double impulse, peer_answer *answer);

// Watches the samples of a fixed-step simulator and finds contact times and peaks in them.
typedef struct contact_watch {
    peer_answer *answer;
    double step; // between two samples [s]
    double into,
        rate; // how far the angles' sum was beyond the wall at the sample before [rad], [rad/s]
    bool released;
} contact_watch;

void contact_watch_begin(contact_watch *watch, double step, peer_answer *answer);

// A sample: time [s], sum of the two links' angles [rad] (the tip lies in the wall when it is twice
// the wall's angle), its rate [rad/s] and the force from `time` to the next sample [N]. Contact
// times are extrapolated from the last sample before the wall, which no force has touched yet.
void contact_watch_sample(contact_watch *watch, double time, double angles, double rate,
                          double force);

#ifdef __cplusplus
}
#endif
