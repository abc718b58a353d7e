// The program's only terminal, and what signals left for it.
#include "ui/terminal/terminal_state.h"

terminal_state tty = {.wake = {-1, -1}};

volatile sig_atomic_t terminal_leaving;
volatile sig_atomic_t terminal_suspending;
