/* Host time that a tick hands to the library. */
#pragma once
#include <math.h>

/* `left`: what earlier ticks did not hand over [ns]. A tween may overshoot the scale at any tick: below 0 and no number are no time, and
 * what is more than any host means is dropped by the library and told by time_dropped. */
static inline double due_nanoseconds(double seconds, double scale, double left) {
    const double most = 1e15, due = seconds * scale * 1e9 + left;
    return due >= 0 ? fmin(due, most) : 0;
}
