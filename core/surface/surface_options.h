/* Options of the generation of a surface, and its report. */
#ifndef RUGO_CORE_SURFACE_SURFACE_OPTIONS_H
#define RUGO_CORE_SURFACE_SURFACE_OPTIONS_H

#include "core/surface/heights.h"
#include <stdbool.h>

/* What is random in a wave (FORMULAS.md, F3.1 and F3.4): its phase alone, so that every surface of
 * a cell has the prescribed spectrum; or its amplitude too, so that the spectrum is that of the
 * mean over surfaces, and a cell is like a part of an infinite Gaussian surface. */
enum surface_amplitudes { AMPLITUDES_FIXED, AMPLITUDES_RANDOM };
/* What heights that are not Gaussian mean (FORMULAS.md, F5): surfaces that are iterated towards a
 * spectrum and heights, or translations of a Gaussian field. */
enum height_law { LAW_ITERATED, LAW_TRANSLATION };
enum surface_keep { KEEP_SPECTRUM, KEEP_HEIGHTS };
/* The iteration towards spectrum and heights (FORMULAS.md, F5.3 to F5.6). */
enum surface_iteration {
    ITERATION_RELAXED,     /* 43 iterations of a fixed schedule, whatever the tolerance */
    ITERATION_PLAIN,       /* alternation, as in the reference */
    ITERATION_REFLECTIONS, /* the default: a little momentum, then relaxed reflections */
    ITERATION_MOMENTUM     /* momentum alone */
};
enum surface_draw { DRAW_RANDOM, DRAW_QUANTILES };

/* Gaussian heights need `amplitudes` alone, and so does the law of translation. The others are of
 * the iteration of Perez-Rafols & Almqvist (2019; FORMULAS.md, F5.1 to F5.6). */
struct surface_options {
    struct heights heights;
    enum height_law law; /* LAW_TRANSLATION: of these heights by spectrum.translation */
    enum surface_amplitudes amplitudes; /* random, not Gaussian: heights have the deviation and the
                                           spectrum of the Gaussian start of each surface */
    enum surface_keep keep;             /* which of the two last iterates is returned */
    enum surface_iteration iteration;
    enum surface_draw draw; /* target heights drawn at random, or exact quantiles */
    double
        tolerance; /* on eps_h, eps_s and eps_s0 (F5.2); default 1e-3; 0 iterates until it stalls */
    /* On eps_h, eps_s and eps_s0 alone, in place of it; 0: as it, which is above 0 where one is. */
    double tolerance_h, tolerance_s, tolerance_s0;
    double stall_gain; /* default 0.05: it stalls when the largest error has not fallen by this
                          share */
    size_t stall_iterations;   /* default 10: ... in this many iterations */
    size_t max_iterations;     /* default 1000, of all kinds together */
    size_t relaxed_iterations; /* of ITERATION_RELAXED, default 40 */
    double relaxation;         /* of ITERATION_RELAXED, default 0.8 */
    /* Asked before each iteration: non-zero stops the run with ERROR_STOPPED. NULL: none is. */
    int (*stop)(void *context);
    void *stop_context;
};
extern const struct surface_options SURFACE_DEFAULTS; /* Gaussian, and the defaults above */

/* Returns whether surfaces are made by iteration. */
static inline bool surface_is_iterated(const struct surface_options *options) {
    return options->heights.type != HEIGHTS_GAUSSIAN && options->law == LAW_ITERATED;
}

/* Tolerances and limits of a generator's next runs, in place of those of its options. iteration is
 * ITERATION_REFLECTIONS or ITERATION_MOMENTUM, as that of the options must be. */
struct surface_aim {
    enum surface_iteration iteration;
    double tolerance;
    size_t stall_iterations, max_iterations; /* at least 1 each */
};

/* END_DIRECT: Gaussian. END_CONVERGED: all errors are within the tolerance. END_LIMIT: the schedule
 * of ITERATION_RELAXED, or max_iterations, ended it; the errors are those reached. */
enum surface_end { END_DIRECT, END_CONVERGED, END_STALLED, END_LIMIT };
/* Statistics of a generation. Errors are those of the returned pair of iterates. */
struct surface_report {
    size_t iterations;
    enum surface_end end;
    double eps_h, eps_s, eps_s0;              /* of the PSD, compared with the tolerances */
    double eps_s_amplitude, eps_s0_amplitude; /* of the amplitude, as in the authors' code */
};

#endif
