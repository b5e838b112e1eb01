#include "interrupt.h"

#include <csignal>
#include <cstdio>

namespace replay {
namespace {

// A signal handler has no other way to tell the program.
volatile std::sig_atomic_t pressed = 0;

void onInterrupt(int signal) {
    pressed = 1;
    std::signal(signal, SIG_DFL);
}

}  // namespace

void catchInterrupts() {
    std::signal(SIGINT, onInterrupt);
}

bool interrupted() {
    return pressed != 0;
}

bool comparisonStopped() {
    if (interrupted()) std::fputs("interrupted: nothing was compared\n", stderr);
    return interrupted();
}

}  // namespace replay
