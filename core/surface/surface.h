/* Random rough surfaces with a prescribed spectrum and height distribution.
 *
 * A generator is made once a case and used for every realisation of it, by one thread at a time.
 * Phases belong to wave numbers in units of 2 pi/L, not to points. So the same realisation on a
 * finer grid is the same surface where the coarser one has more than two points a wave; with
 * another H or scale it has the same phases; with shorter waves added it keeps the phases of the
 * longer ones. Random amplitudes, over the prescribed ones, behave alike. Target heights are
 * quantiles of the same uniform numbers, as many as the grid has points. */
#ifndef RUGO_CORE_SURFACE_SURFACE_H
#define RUGO_CORE_SURFACE_SURFACE_H

#include "core/random.h"
#include "core/surface/spectrum.h"
#include "core/surface/surface_options.h"
#include "core/team.h"

struct generator;

/* Copies its arguments (table spectra are sampled here). With a counter face (counter_face.h) of
 * the spectrum surfaces are the sum of both faces, with a plateau (plateau_face.h) the lower of
 * both about its mean, with grooves (grooves.h) they have them beside their random part.
 * ERROR_INPUT, ERROR_MEMORY. */
int generator_create(struct generator **out, const struct spectrum *spectrum,
                     const struct grid *grid, const struct surface_options *options,
                     struct error *err);
/* Lets a team of threads work along in transforms of whole surfaces, with the same digits; it is
 * borrowed until the next call or generator_destroy. ERROR_MEMORY. */
int generator_set_team(struct generator *generator, struct team *team, struct error *err);
void generator_destroy(struct generator **generator);
/* Returns the prescribed spectrum, which lives as long as the generator. It is that of every
 * surface, or with random amplitudes that of the mean. */
const struct modes *generator_modes(const struct generator *generator);
/* Returns the spectrum that was drawn for the last run: the prescribed one, or with random
 * amplitudes or a counter face its own; of a stratified face, the prescribed one. The surface has
 * it, to rounding, where it keeps its spectrum (KEEP_SPECTRUM). Of a translated surface it is that
 * of the Gaussian field; grooves come on top of it. Lives as long, and changes with the next run.
 */
const struct modes *generator_drawn(const struct generator *generator);
/* Peak bytes of a generator of one face with these settings, including the caller's z of
 * grid_points doubles; and those that a generator of two faces takes beside both, with all modes of
 * the sum. */
double generator_bytes(const struct grid *grid, size_t mode_x, size_t mode_y,
                       const struct surface_options *options);
double generator_sum_bytes(const struct grid *grid, size_t mode_x, size_t mode_y);

/* Fills z[grid_points] (from any aligned allocation). report may be NULL. Non-Gaussian generation
 * converges on the generator's grid; surface_resample gives the same realisation on a finer one.
 * ERROR_NUMERIC where the heights that were drawn are all equal or not finite; ERROR_STOPPED where
 * stop of the options, or of generator_set_stop, says so; ERROR_MEMORY. z is undefined after an
 * error. */
int generator_run(struct generator *generator, struct random_key key, double *z,
                  struct surface_report *report, struct error *err);

/* From now on runs fill gaussian[grid_points], too, with the Gaussian field of unit variance that a
 * translated surface is a function of; of other surfaces they leave it as it is. NULL: not wanted.
 * Borrowed. */
void generator_keep_gaussian(struct generator *generator, double *gaussian);

/* Changes the tolerances and limits of the next runs; without effect where heights are Gaussian. */
void generator_aim(struct generator *generator, const struct surface_aim *aim);

/* Changes what the next runs ask before each iteration, in place of stop and stop_context of the
 * options; NULL: nothing. The context is borrowed until the next call. */
void generator_set_stop(struct generator *generator, int (*stop)(void *context), void *context);

/* Samples the band-limited surface z on grid `from` exactly on grid `to` (same cell, any grid with
 * two points a wave of the band mode_x, mode_y, or more), by zero padding. */
int surface_resample(const struct grid *from, const double *z, const struct grid *to, double *out,
                     size_t mode_x, size_t mode_y, struct error *err);

#endif
