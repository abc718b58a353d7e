// A Cortex-M4F board as the emulator's machine mps2-an386 has it, without any system: the
// exported law goes through the lab's readings, and each sample's instructions are
// counted by the system timer, which under -icount shift=0 ticks once in 40 instructions
// (25 MHz).
#include <math.h>
#include <stdint.h>
#include <stdio.h>

#include "law.h"
#include "readings.h" // static const double readings[][10]

#define REGISTER(address) (*(volatile uint32_t *)(address))
#define TIMER_CONTROL     REGISTER(0xE000E010)
#define TIMER_RELOAD      REGISTER(0xE000E014)
#define TIMER_VALUE       REGISTER(0xE000E018)
#define COPROCESSORS      REGISTER(0xE000ED88)
enum { NANOSECONDS_PER_TICK = 40 };

extern uint32_t stack_top[];

// An operation of the emulator's host, by number.
static int host(int operation, const void *argument)
{
    register int number __asm__("r0") = operation;
    register const void *where __asm__("r1") = argument;
    __asm__ volatile("bkpt 0xAB" : "+r"(number) : "r"(where) : "memory");
    return number;
}

static void run(void)
{
    const int count = sizeof readings / sizeof readings[0];
    const char *refusal = law_start();
    if (refusal != NULL) {
        host(0x04, refusal);
        return;
    }

    int differing = 0;
    double largest = 0;
    uint32_t worst = 0, sum = 0;
    for (int i = 0; i < count; i++) {
        const double *n = readings[i];
        const controller_input in = {.time = n[0],
                                     .encoder = n[1],
                                     .tachometer = n[2],
                                     .force = n[3],
                                     .voltage = n[4],
                                     .piezo_force = n[5],
                                     .film = n[6],
                                     .accelerometer = n[7],
                                     .wanted_mode = -1,
                                     .predicted_force = n[8]};
        controller_output out;
        const uint32_t before = TIMER_VALUE;
        law_sample(&in, &out);
        const uint32_t ticks = (before - TIMER_VALUE) & 0xFFFFFF;
        worst = ticks > worst ? ticks : worst;
        sum += ticks;
        const double off = fabs(out.command - n[9]);
        differing += off != 0;
        largest = fmax(largest, off);
    }

    char text[160];
    snprintf(
        text, sizeof text,
        "%d samples, %d commands differ, by %d uV at most; %lu instructions a sample "
        "at most, %lu in the mean\n",
        count, differing, (int)(1e6 * largest),
        (unsigned long)worst * NANOSECONDS_PER_TICK,
        (unsigned long)(sum / (uint32_t)count) * NANOSECONDS_PER_TICK);
    host(0x04, text);
    if (worst * NANOSECONDS_PER_TICK > LAW_INSTRUCTIONS) {
        host(0x04, "more than law.h says\n");
    }
}

void reset(void)
{
    COPROCESSORS |= 0xF << 20; // the floating-point unit
    __asm__ volatile("dsb\n\tisb");
    TIMER_RELOAD = 0xFFFFFF;
    TIMER_VALUE = 0;
    TIMER_CONTROL = 5;
    run();
    host(0x18, (const void *)0x20026); // ends the emulator
    for (;;) {
    }
}

__attribute__((section(".vectors"),
               used)) static const void *const vectors[] = {stack_top,
                                                            (const void *)reset};
