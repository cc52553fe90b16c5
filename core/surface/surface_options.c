#include "core/surface/surface_options.h"

const struct surface_options SURFACE_DEFAULTS = {
    .heights = {.type = HEIGHTS_GAUSSIAN},
    .amplitudes = AMPLITUDES_FIXED,
    .keep = KEEP_SPECTRUM,
    .iteration = ITERATION_REFLECTIONS,
    .draw = DRAW_RANDOM,
    .tolerance = 1e-3,
    .stall_gain = 0.05,
    .stall_iterations = 10,
    .max_iterations = 1000,
    .relaxed_iterations = 40,
    .relaxation = 0.8,
};
