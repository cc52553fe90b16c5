/* The rows of /surface/... */
#include "jobs/surface/surface_parameters.h"
#include "core/surface/grooves/groove_profile.h"
#include "core/surface/surface.h"

static const struct choice ALPHA_FORMULAS[] = {
    {"discrete", ALPHA_DISCRETE}, {"continuous", ALPHA_CONTINUOUS}, {0}};
#define SPECTRUM(type, name, value) {name, SPECTRUM_##type},
static const struct choice SPECTRA[] = {RUGO_SPECTRA(SPECTRUM){"acf_table", SPECTRUM_GIVEN_ACF},
                                        {0}};
static const struct choice AMPLITUDES[] = {
    {"fixed", AMPLITUDES_FIXED}, {"random", AMPLITUDES_RANDOM}, {0}};
#define CHOICE(type, name, value) {name, HEIGHTS_##type},
#define GIVEN(type, name) {name, GIVEN_##type},
static const struct choice DISTRIBUTIONS[] = {RUGO_DISTRIBUTIONS(CHOICE) GIVEN(SAMPLES, "samples")
                                                  GIVEN(QUANTILES, "quantiles"){0}};

static const struct choice KEPT[] = {{"spectrum", KEEP_SPECTRUM}, {"heights", KEEP_HEIGHTS}, {0}};
static const struct choice ITERATIONS[] = {{"relaxed", ITERATION_RELAXED},
                                           {"plain", ITERATION_PLAIN},
                                           {"reflections", ITERATION_REFLECTIONS},
                                           {"momentum", ITERATION_MOMENTUM},
                                           {0}};
static const struct choice LAWS[] = {
    {"iterated", LAW_ITERATED}, {"translation", LAW_TRANSLATION}, {0}};
static const struct choice DRAWS[] = {{"random", DRAW_RANDOM}, {"quantiles", DRAW_QUANTILES}, {0}};

static const struct choice GROOVES[] = {{"sine", GROOVE_SINE},           {"arcs", GROOVE_ARCS},
                                        {"triangle", GROOVE_TRIANGLE},   {"saw", GROOVE_SAW},
                                        {"harmonics", GROOVE_HARMONICS}, {0}};

/* The tolerance on one error of the iteration. */
#define OWN_TOLERANCE(error, what)                                                                 \
    {                                                                                              \
        .path = FACE "/heights/tolerances/" error, .later = true, .type = PARAMETER_NUMBER,        \
        .minimum = 0, .maximum = 1, .above_minimum = true, .sweep = true, .example_json = "0.01",  \
        .help = "on " error " alone, " what "; as tolerance, above 0, unless given"                \
    }

#define FACE "/surface"
#define FACE_NAME ""
#define USUAL(json) json
#define SECOND false
#define ABOUT ""
#define PLATEAU_ROW(name, of_type, least, most, example, words)                                    \
    {                                                                                              \
        .path = "/surface/plateau/" name, .later = true, .type = (of_type), .minimum = (least),    \
        .maximum = (most), .sweep = true, .example_json = (example), .help = (words)               \
    }
static const struct parameter ROWS[] = {
#include "jobs/surface/surface_groove_rows.h"
#include "jobs/surface/surface_rows.h"
    PLATEAU_ROW(
        "rms_ratio", PARAMETER_NUMBER, 0.01, 1, "0.25",
        "makes a stratified face, as honing leaves it: at each point the lower of /surface, "
        "which has the valleys, and of a plateau with this RMS height over that of /surface "
        "(Spq/Svq); rms_slope and rms_height are those of /surface alone"),
    PLATEAU_ROW("offset", PARAMETER_NUMBER, -10, 10, "-0.5",
                "mean of the plateau above that of /surface, in RMS heights of /surface; or give "
                "material_ratio"),
    {.path = "/surface/plateau/material_ratio",
     .later = true,
     .type = PARAMETER_NUMBER,
     .minimum = 0,
     .maximum = 1,
     .above_minimum = true,
     .below_maximum = true,
     .sweep = true,
     .example_json = "0.8",
     .help = "share of the points above the height where plateau and valleys meet (Smq), in place "
             "of offset"},
    {.path = "/surface/plateau/hurst",
     .later = true,
     .type = PARAMETER_NUMBER,
     .minimum = 0,
     .maximum = 1,
     .above_minimum = true,
     .sweep = true,
     .example_json = "0.5",
     .help = "Hurst exponent of the plateau; as /surface unless given"},
    PLATEAU_ROW("wavelength_ratio", PARAMETER_NUMBER, 1, 1e5, "8",
                "longest over shortest wavelength of the plateau; as /surface unless given"),
    PLATEAU_ROW("rolloff_ratio", PARAMETER_NUMBER, 1, 1e5, "2",
                "longest over roll-off wavelength of the plateau; 1 unless given"),
    PLATEAU_ROW("length_ratio", PARAMETER_NUMBER, 1, 1e5, "16",
                "side of the cell over the longest wavelength of the plateau; as /surface unless "
                "given"),
    PLATEAU_ROW("anisotropy", PARAMETER_NUMBER, 1, 1000, "1",
                "of the plateau, as /surface unless given"),
    PLATEAU_ROW("lay_angle", PARAMETER_NUMBER, -90, 90, "45",
                "of the plateau, with anisotropy, in degrees; as /surface unless given"),
};
const struct parameter_table SURFACE_PARAMETERS = {"surface", ROWS, sizeof ROWS / sizeof *ROWS};

/* The second face has the defaults of the first, where it is given at all. */
#undef FACE
#undef FACE_NAME
#undef USUAL
#undef SECOND
#undef ABOUT
#define COUNTER_FACE
#define FACE "/counter_surface"
#define FACE_NAME "counter "
#define USUAL(json) NULL
#define SECOND true
#define ABOUT                                                                                      \
    "of a second rough face that /surface is pressed on, in the same cell, with the defaults of "  \
    "/surface and lengths in its lambda_s: "
static const struct parameter COUNTER_ROWS[] = {
#include "jobs/surface/surface_rows.h"
    {.path = FACE "/young",
     .later = true,
     .symbol = "counter E",
     .type = PARAMETER_NUMBER,
     .minimum = 0,
     .maximum = 1e100,
     .above_minimum = true,
     .sweep = true,
     .unit = "any",
     .example_json = "200",
     .help = "Young's modulus of the counter body, in the unit of /contact/young: 1/E* is the sum "
             "of (1 - nu^2)/E of both bodies, which must be infinite half-spaces without a "
             "coating; unless given the counter body is rigid"},
    {.path = FACE "/poisson",
     .later = true,
     .symbol = "counter nu",
     .type = PARAMETER_NUMBER,
     .minimum = 0,
     .maximum = 0.4999,
     .sweep = true,
     .example_json = "0.25",
     .help = "Poisson's ratio of an elastic counter body; unless given that of the block"},
};
const struct parameter_table COUNTER_PARAMETERS = {"counter_surface", COUNTER_ROWS,
                                                   sizeof COUNTER_ROWS / sizeof *COUNTER_ROWS};
