/* A second rough face, which the first is pressed on: its spectrum, with a scale of its own, and
 * its options. A surface with a counter face is the sum of both, each with heights towards the
 * other. The faces are independent: their random numbers differ (random.h), so that powers and
 * moments of the sum are sums. Neither face may be translated, nor have a counter face or a
 * plateau. */
#ifndef RUGO_CORE_SURFACE_COUNTER_FACE_H
#define RUGO_CORE_SURFACE_COUNTER_FACE_H

#include "core/surface/modes.h"
#include "core/surface/surface_options.h"

struct counter_face {
    struct spectrum spectrum;
    struct surface_options options; /* but for stop, which is that of the surface */
};

#endif
