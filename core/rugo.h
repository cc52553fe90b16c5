/* librugo: rough surfaces, their statistics, and their elastic contact with a rigid flat.
 *
 * Conventions. Lengths are in any one unit; pressures are in units of E* = E/(1 - nu^2), the plane
 * strain modulus of the block (a half-space depends on neither E nor nu). A map z has grid.nx *
 * grid.ny doubles, x fastest: z[j*nx + i] is the height at (i*lx/nx, j*ly/ny); it is periodic. A
 * profile has ny == 1, and ly is ignored.
 *
 * Errors. A function that returns int returns 0, or one of the negative codes below. With a code it
 * has filled *err (which may be NULL) with a sentence that names what is at fault, and outputs are
 * untouched unless a comment says otherwise. Functions of theory return NaN outside their domain.
 *
 * Ownership. x_destroy frees what x_create has made. It accepts a pointer to NULL and leaves NULL.
 * Arrays that are passed in are borrowed for the call, or copied.
 *
 * Threads. One object belongs to one thread at a time; different objects are independent. FFTW
 * plans are made behind a lock of the library. A program that makes such plans itself, in other
 * threads, calls fftw_make_planner_thread_safe.
 *
 * Locale. Numbers in files and errors have a decimal point, whatever the program's locale. No
 * locale is changed but the calling thread's, during a call. An error may quote the system in the
 * program's language.
 *
 * Choices (enum rugo_...) are listed and explained in rugo_lists.h, which the program reads as
 * well.
 *
 * Sources are named by author and year; core/theory/BIBLIOGRAPHY.md lists them, and
 * core/theory/FORMULAS.md the formulas. */
#ifndef RUGO_H
#define RUGO_H

#include "rugo_lists.h"
#include <stddef.h>
#include <stdint.h>

#define RUGO_VERSION "0.1.0"
#define RUGO_API __attribute__((visibility("default")))
#define RUGO_ENTRY(type, name, value) RUGO_##type = (value),

#ifdef __cplusplus
extern "C" {
#endif

/* Returns the version of the linked library, as RUGO_VERSION; not to be freed. */
RUGO_API const char *rugo_version(void);
/* Returns the name, as studies write it, of choice n (from 0) of a list of rugo_lists.h: "spectra",
 * "distributions", "summit_rules", "trends" or "models"; NULL behind the last and for another list.
 * *value, unless NULL, becomes that of its enumeration. It serves programs that cannot include this
 * header; the name is not to be freed. */
RUGO_API const char *rugo_choice(const char *list, size_t n, int *value);

enum {
    RUGO_ERROR_INPUT = -1,   /* an argument or a file is wrong */
    RUGO_ERROR_MEMORY = -2,  /* an allocation failed */
    RUGO_ERROR_SYSTEM = -3,  /* a file could not be opened, read or written */
    RUGO_ERROR_NUMERIC = -4, /* no result of the required accuracy: no convergence, out of domain */
};
struct rugo_error {
    int code; /* one of the above */
    char text[480];
};

struct rugo_grid {
    size_t nx, ny; /* points along x, at least 2, and y, at least 1 */
    double lx, ly; /* lengths of the periodic cell */
};

/* --- spectra --- */

/* RUGO_SELF_AFFINE, RUGO_EXPONENTIAL_ACF, RUGO_TABLE. */
enum rugo_spectrum_type { RUGO_SPECTRA(RUGO_ENTRY) };
struct rugo_spectrum {
    enum rugo_spectrum_type type;
    double hurst;                             /* self-affine, in [0, 1] */
    double wavelength_long, wavelength_short; /* self-affine: the band; > 0 */
    double wavelength_rolloff;                /* self-affine: between the two */
    double correlation_x, correlation_y;      /* exponential: lengths bx, by */
    size_t table_count;                       /* table: its length */
    const double *table_wave_number;          /* rising, radians per length; borrowed */
    const double *table_density;              /* at these, in any unit; borrowed */
    double rms_height, rms_slope; /* scale: one of them above 0, the other 0; both 0: height 1 */
};
/* Returns a self-affine spectrum without roll-off, of a given RMS slope h' (surface: of the
 * gradient). */
RUGO_API struct rugo_spectrum rugo_spectrum_self_affine(double hurst, double wavelength_long,
                                                        double wavelength_short, double rms_slope);

/* Spectral moments m_pq, the sums of kx^p ky^q P(k) over all waves, P(k) the mean square of a wave;
 * a profile has m20 = m2 and m40 = m4, those with y are 0. */
struct rugo_moments {
    double m00, m20, m02, m11, m22, m40, m04, m31, m13;
    double m0, m2, m4;                           /* isotropic: m00, (m20 + m02)/2, (m40 + m04)/2 */
    double nayak_alpha;                          /* m0 m4/m2^2 (Nayak 1971); NaN for a flat map */
    double rms_height, rms_slope, rms_curvature; /* curvature: (z_xx + z_yy)/2; profile z_xx */
};
/* Moments of the surfaces with this spectrum on this grid: the same for each of them, or with
 * random amplitudes those of their mean. INPUT where the grid holds no wave of the spectrum or does
 * not resolve its shortest one. */
RUGO_API int rugo_spectrum_moments(const struct rugo_spectrum *spectrum,
                                   const struct rugo_grid *grid, struct rugo_moments *out,
                                   struct rugo_error *err);
/* Returns Nayak's alpha of a continuous self-affine spectrum; dimension 1 (profile) or 2, ratio the
 * longest over the shortest wavelength, rolloff the longest over that of the roll-off, at least
 * 1. */
RUGO_API double rugo_alpha_of_ratio(int dimension, double hurst, double ratio, double rolloff);
/* The inverse: finds the ratio of an alpha. INPUT for another dimension, hurst outside [0, 1],
 * rolloff below 1 or an alpha that is not finite; NUMERIC, with the range, where no ratio has this
 * alpha. */
RUGO_API int rugo_ratio_of_alpha(int dimension, double hurst, double rolloff, double alpha,
                                 double *ratio, struct rugo_error *err);

/* --- random surfaces --- */

/* RUGO_GAUSSIAN, RUGO_WEIBULL_MIN, RUGO_WEIBULL_MAX, RUGO_LOGNORMAL, RUGO_GAMMA, RUGO_BETA,
 * RUGO_QUANTILE. */
enum rugo_heights_type { RUGO_DISTRIBUTIONS(RUGO_ENTRY) RUGO_QUANTILE = RUGO_QUANTILE_VALUE };
/* Heights are scaled to mean 0 and to the RMS height of the spectrum, whatever the distribution. A
 * non-Gaussian surface is made by alternating between the spectrum and the heights (Perez-Rafols &
 * Almqvist 2019). */
struct rugo_surface_options {
    enum rugo_heights_type heights;
    double shape; /* Weibull's, [0.5, 20]; of the log-normal one, [0.01, 1]; gamma, [0.25, 1000];
                     beta, [0.5, 100] */
    double (*quantile)(double probability, const void *context); /* rising on (0, 1) */
    const void *quantile_context;                                /* borrowed */
    int keep_heights;      /* which is exact in the result: 0 the spectrum, 1 the heights */
    double tolerance;      /* of the iteration, on its three errors */
    size_t max_iterations; /* of the iteration */
    int random_amplitudes; /* 0: each surface has the spectrum; 1: their mean has it, and waves have
                              Rayleigh's amplitudes, as a part of an infinite surface has */
    double second_shape;   /* of beta, [0.5, 100]; 0: as the first */
};
/* Returns options for Gaussian surfaces, with a tolerance of 1e-3 and at most 1000 iterations. */
RUGO_API struct rugo_surface_options rugo_surface_defaults(void);

/* Errors of a generation: of heights, of the spectrum and of waves outside it; all 0 for Gaussian
 * heights, which need no iteration. */
struct rugo_surface_report {
    size_t iterations;
    double error_heights, error_spectrum, error_outside;
};

/* A workspace for all realisations of one kind of surface. */
struct rugo_generator;
/* Makes a generator; options may be NULL for the defaults. Fails with INPUT as
 * rugo_spectrum_moments does, or for options out of range, or with MEMORY. */
RUGO_API int rugo_generator_create(struct rugo_generator **out,
                                   const struct rugo_spectrum *spectrum,
                                   const struct rugo_grid *grid,
                                   const struct rugo_surface_options *options,
                                   struct rugo_error *err);
RUGO_API void rugo_generator_destroy(struct rugo_generator **generator);
/* Fills z, nx*ny heights. The surface depends on (seed, sequence, realisation) alone, by counted
 * random words (Salmon et al. 2011), with uniform phases (Wu 2000). A Gaussian surface is the same
 * on every grid with more than two points a wave. All cases of a study have sequence 0; those of an
 * independent study have their number. report: NULL where not wanted. z is filled in place, and
 * undefined after a failure. NUMERIC where the heights that were drawn are all equal or not finite;
 * MEMORY. */
RUGO_API int rugo_generator_run(struct rugo_generator *generator, uint64_t seed, uint64_t sequence,
                                uint64_t realisation, double *z, struct rugo_surface_report *report,
                                struct rugo_error *err);
/* Samples the map z of the grid `from` on the grid `to` of the same cell. This is exact for waves
 * up to mode_x, mode_y a cell, at most half the points of either grid; others are removed. out may
 * not overlap z; whatever can fail does so before out is written. */
RUGO_API int rugo_resample(const struct rugo_grid *from, const double *z,
                           const struct rugo_grid *to, size_t mode_x, size_t mode_y, double *out,
                           struct rugo_error *err);

/* --- height maps in files --- */

struct rugo_map {
    struct rugo_grid grid;
    double *z; /* owned: rugo_map_clear */
};
/* Reads NumPy's npy, csv (a grid row a line) or xyz (x y z lines), by the ending of the name. dx:
 * the spacing of points where the file has none (0: 1). INPUT names the line at fault, or the first
 * hole (NaN), which rugo_open_map_read takes; SYSTEM. */
RUGO_API int rugo_map_read(struct rugo_map *out, const char *path, double dx,
                           struct rugo_error *err);
/* Frees the heights; NULL and {0} are accepted. */
RUGO_API void rugo_map_clear(struct rugo_map *map);
/* Writes in the format of the ending of the name; reading returns the same heights. */
RUGO_API int rugo_map_write(const char *path, const struct rugo_grid *grid, const double *z,
                            struct rugo_error *err);

/* --- statistics of a periodic map: INPUT, too, where a height is NaN --- */

/* Moments are about the mean; slopes and curvatures are finite differences on the grid. */
struct rugo_roughness {
    double mean, rms_height, rms_slope, rms_curvature;
    double skewness, kurtosis; /* NaN for a flat map; a Gaussian has 0 and 3 */
    double lowest, highest;    /* heights, including the mean */
};
RUGO_API int rugo_roughness(const struct rugo_grid *grid, const double *z,
                            struct rugo_roughness *out, struct rugo_error *err);
/* Spectral moments of a map: exact for band-limited ones, where finite differences are not. */
RUGO_API int rugo_moments(const struct rugo_grid *grid, const double *z, struct rugo_moments *out,
                          struct rugo_error *err);
/* Returns the number of values of rugo_psd on a grid; 0 for no grid. */
RUGO_API size_t rugo_psd_size(const struct rugo_grid *grid);
/* Power spectral density over |k| (radians per length), in rings: m00 is its integral over the
 * plane of k, of a profile over both signs. Both arrays have room for rugo_psd_size. */
RUGO_API int rugo_psd(const struct rugo_grid *grid, const double *z, double *wave_number,
                      double *density, struct rugo_error *err);

/* RUGO_NINE_POINT, RUGO_FIVE_POINT, RUGO_REFINED. */
enum rugo_summit_rule { RUGO_SUMMIT_RULES(RUGO_ENTRY) };
struct rugo_summit {
    double x, y, height;
    double curvature; /* -(z_xx + z_yy)/2, profile -z_xx; positive */
};
struct rugo_summits {
    struct rugo_summit *summits; /* owned: rugo_summits_clear */
    size_t count;
};
/* Finds the summits of a surface, or the peaks of a profile, in the order of rows. Curvatures are
 * finite differences, those of refined summits are exact. */
RUGO_API int rugo_summits_find(struct rugo_summits *out, const struct rugo_grid *grid,
                               const double *z, enum rugo_summit_rule rule, struct rugo_error *err);
RUGO_API void rugo_summits_clear(struct rugo_summits *summits);

/* --- statistics of a map that is not periodic, or has holes --- */

/* Here a map ends at its sides, NaN is a height that was not measured, and sums run over the
 * heights there are; lx is nx times the spacing, as for periodic maps. */

/* RUGO_MEAN, RUGO_PLANE, RUGO_QUADRATIC. */
enum rugo_trend { RUGO_TRENDS(RUGO_ENTRY) };
/* As rugo_map_read, with holes, which stay NaN in z. */
RUGO_API int rugo_open_map_read(struct rugo_map *out, const char *path, double dx,
                                struct rugo_error *err);
/* Subtracts the trend of least squares from z in place. INPUT, z unchanged, where there are too few
 * heights. */
RUGO_API int rugo_detrend(const struct rugo_grid *grid, double *z, enum rugo_trend trend,
                          struct rugo_error *err);
/* The roughness at the seam of the map, if it were repeated, over that of the roughest part inside;
 * the larger ratio of both axes. Above 1.2 the map is not periodic. Infinite where there is nothing
 * to compare with. */
RUGO_API int rugo_seam(const struct rugo_grid *grid, const double *z, double *seam,
                       struct rugo_error *err);
/* As rugo_roughness; NaN where the heights do not determine a value. */
RUGO_API int rugo_open_roughness(const struct rugo_grid *grid, const double *z,
                                 struct rugo_roughness *out, struct rugo_error *err);
/* As rugo_moments, by derivatives of polynomials through the points nearby. */
RUGO_API int rugo_open_moments(const struct rugo_grid *grid, const double *z,
                               struct rugo_moments *out, struct rugo_error *err);
/* As rugo_psd, under Hann's window. */
RUGO_API int rugo_open_psd(const struct rugo_grid *grid, const double *z, double *wave_number,
                           double *density, struct rugo_error *err);
/* As rugo_summits_find; *searched is the area (of a profile: the length) in which they were
 * found. */
RUGO_API int rugo_open_summits_find(struct rugo_summits *out, double *searched,
                                    const struct rugo_grid *grid, const double *z,
                                    enum rugo_summit_rule rule, struct rugo_error *err);
/* Areal parameters of ISO 25178-2, of a surface that is periodic (open 0) or not (1), as defined in
 * core/theory/GLOSSARY.md; NaN where the heights do not determine a value. INPUT for profiles, and
 * for a periodic map with holes. */
struct rugo_areal {
    double sa, sq, ssk, sku, sp, sv, sz, sdq, sdr, sal, str, spd, spc;
};
RUGO_API int rugo_areal(const struct rugo_grid *grid, const double *z, int open,
                        struct rugo_areal *out, struct rugo_error *err);

/* --- theory of Gaussian isotropic surfaces (Nayak 1971), alpha > 3/2 --- */

/* These return the density of the summits' heights z, in units of sqrt(m0), and its integral from
 * below. */
RUGO_API double rugo_nayak_summit_pdf(double z, double alpha);
RUGO_API double rugo_nayak_summit_cdf(double z, double alpha);
/* Returns the joint density of height z and t1 = -sqrt(3/m4) kappa, kappa the mean curvature; 0 for
 * t1 >= 0. */
RUGO_API double rugo_nayak_joint_pdf(double z, double t1, double alpha);
/* Returns the mean curvature of the summits at height z, over sqrt(m4). */
RUGO_API double rugo_nayak_mean_curvature(double z, double alpha);
/* Returns summits per area, from the isotropic moments; NaN unless both are finite, m2 > 0 and m4
 * >= 0. */
RUGO_API double rugo_nayak_summit_density(double m2, double m4);

/* --- theories of contact; load = p/(E* h') --- */

/* These return the contact fraction by Persson (2001), load >= 0, and the density of the local
 * pressure over E* h'. */
RUGO_API double rugo_persson_area(double load);
RUGO_API double rugo_persson_pressure_pdf(double pressure, double load);
/* These return the contact fraction by asperities pressed alone, load in [1e-250, 1e6], alpha >
 * 3/2; it may exceed 1. Bush, Gibson & Thomas (1975); Greenwood & Williamson (1966) with the
 * parameters of McCool (1986). */
RUGO_API double rugo_bgt_area(double load, double alpha);
RUGO_API double rugo_gw_mccool_area(double load, double alpha);
/* One wave, amplitude Delta (Westergaard 1939), by ratio = p/p* in [0, 1], p* = pi E* Delta/lambda:
 * the contact fraction; the local over the mean pressure at x wavelengths from a crest; the mean
 * gap over Delta. The pressure is NaN at a ratio of 0. */
RUGO_API double rugo_westergaard_area(double ratio);
RUGO_API double rugo_westergaard_pressure(double x, double ratio);
RUGO_API double rugo_westergaard_gap(double ratio);

/* --- contact --- */

/* RUGO_HALFSPACE, RUGO_LAYERED, RUGO_FULL. */
enum rugo_model { RUGO_MODELS(RUGO_ENTRY) };
struct rugo_block {
    enum rugo_model model;
    double poisson;      /* [0, 0.5); without influence on a half-space */
    double height;       /* in the unit of the grid; HUGE_VAL for a half-space alone */
    double layer_growth; /* finite elements: thickness of a layer over that above it, [1, 2] */
};
/* Returns a block of Poisson's ratio 0.3 and growth 1.1, whose height is infinite for a half-space,
 * else 1.5 lx of a profile, and of a surface 1.5 times the longer one of lx and ly. */
RUGO_API struct rugo_block rugo_block_defaults(enum rugo_model model, const struct rugo_grid *grid);

/* One load. Fractions are of the cell, and those of the full model are as the face stretches under
 * the load; arrays have nx*ny values and are the solver's, valid until its next call. */
struct rugo_contact_state {
    double pressure;               /* mean */
    const double *p;               /* local pressures; 0 where open */
    const double *gap;             /* between surface and flat */
    double area;                   /* contact fraction by edges between nodes: the best estimate */
    double area_nodes;             /* share of nodes in contact: too large ... */
    double area_lower, area_upper; /* ... and bounds of the contact fraction */
    double mean_gap;
    /* -d pressure/d mean_gap, infinite in full contact; in free space d pressure/d approach. */
    double stiffness;
    size_t patches;    /* islands of contact */
    size_t iterations; /* of the solver */
    double violation;  /* largest penetration or gap inside of the contact, over the RMS height */
};
/* A solver for one grid and one block. */
struct rugo_contact;
/* INPUT for a block out of range, too deep a mesh, or points that are more than 100 times as far
 * apart along one axis as along the other; MEMORY. */
RUGO_API int rugo_contact_create(struct rugo_contact **out, const struct rugo_grid *grid,
                                 const struct rugo_block *block, struct rugo_error *err);
/* For a map that is not periodic: an elastic half-space in free space, in contact within the grid's
 * lx by ly alone. Fails as rugo_contact_create. */
RUGO_API int rugo_contact_create_open(struct rugo_contact **out, const struct rugo_grid *grid,
                                      struct rugo_error *err);
RUGO_API void rugo_contact_destroy(struct rugo_contact **contact);
/* Copies a surface (any mean height) without contact: its highest points touch first. INPUT for a
 * height that is not finite, and for the full model where the surface is too steep, or too high for
 * the block; there is then no surface to press. */
RUGO_API int rugo_contact_begin(struct rugo_contact *contact, const double *z,
                                struct rugo_error *err);
/* Presses to a mean pressure >= 0 over E*, without friction or adhesion: linear models by active
 * sets (Hintermueller, Ito & Kunisch 2003), the full model by Newton's method with one. Loads may
 * rise and fall. INPUT where rugo_contact_begin has not succeeded before. NUMERIC, with the
 * accuracy reached, where there is no convergence; linear models then begin the next load anew. */
RUGO_API int rugo_contact_press(struct rugo_contact *contact, double pressure,
                                struct rugo_contact_state *out, struct rugo_error *err);
/* Returns the approach of the flat under the last load, since it first touched: towards the mean
 * plane of a periodic face; in free space towards far points. A profile has no far points at rest,
 * and its approach is towards a point on the face at a distance lx from a line load. NaN before a
 * load, and for the full model. */
RUGO_API double rugo_contact_approach(const struct rugo_contact *contact);
/* Returns the least mean pressure of full contact of the surface begun; NaN without a
 * surface, in free space, and for the full model. */
RUGO_API double rugo_contact_full_pressure(const struct rugo_contact *contact);

#ifdef __cplusplus
}
#endif

#endif
