/* Real transforms of band-limited periodic fields: only columns that hold modes are transformed.
 *
 * A plan belongs to one grid and one band and is made once a case; it is FFTW_ESTIMATE, so that a
 * realisation has the same digits in every process. Planning takes a lock; execution is safe from
 * many threads with many plans.
 *
 * Half-spectrum layout, complex, column after column: Z[mx*ny + row], mx = 0..mode_x, row = my for
 * my >= 0 and ny + my for my < 0. Z is normalised so that z(x, y) = sum over the full plane of
 * Z exp(i k.r): forward divides by the number of points. */
#ifndef RUGO_CORE_SURFACE_TRANSFORM_H
#define RUGO_CORE_SURFACE_TRANSFORM_H

#include "core/surface/grid.h"
#include "core/team.h"
#include <complex.h>
#include <math.h>

struct transform;

/* Returns |my| of a row of the half spectrum. */
static inline size_t transform_row_mode(const struct grid *grid, size_t row) {
    return row <= grid->ny / 2 ? row : grid->ny - row;
}
/* Returns the wave number |k| of a mode of the half spectrum; ly of a profile does not enter. */
static inline double transform_wave_number(const struct grid *grid, size_t mx, size_t row) {
    double qx = (double)mx / grid->lx;
    double qy = row == 0 ? 0 : (double)transform_row_mode(grid, row) / grid->ly;
    return 2 * M_PI * hypot(qx, qy);
}

/* Returns the least even number of 2, 3 and 5 alone, above 0, that is n or more: transforms of so
 * many points are fast. */
size_t transform_fast_count(size_t n);

/* Makes a plan for the band |mx| <= mode_x <= nx/2, |my| <= mode_y <= ny/2. Memory: about one band
 * of columns. */
int transform_create(struct transform **out, const struct grid *grid, size_t mode_x, size_t mode_y,
                     struct error *err);
void transform_destroy(struct transform **transform);
/* Returns the bytes of a plan without a team. */
double transform_bytes(const struct grid *grid, size_t mode_x);
/* Lets a team work along, in all but strips, with the same digits; it is borrowed until the plan is
 * destroyed or has another one. NULL: the caller alone. ERROR_MEMORY. */
int transform_set_team(struct transform *transform, struct team *team, struct error *err);

/* Returns the plan's own half spectrum, (mode_x + 1) * ny values, aligned; valid as long as the
 * plan. */
double complex *transform_spectrum(struct transform *transform);
/* Computes z[ny*nx] from the plan's spectrum, which it destroys. Rows beyond mode_y count, too:
 * the caller sets them to 0. Self-conjugate modes must be real; the mx = 0 column must be
 * conjugate-symmetric. */
void transform_inverse(struct transform *transform, double *z);
/* As transform_inverse, in two steps, for surfaces larger than memory: the columns once, then any
 * rows first .. first + count - 1 into z[count*nx], as often as needed. */
void transform_inverse_columns(struct transform *transform);
void transform_inverse_rows(struct transform *transform, size_t first, size_t count, double *z);
/* As transform_inverse_rows, of at most TRANSFORM_ROWS rows, into memory of the plan, which the
 * caller may change until the plan is used again. */
enum { TRANSFORM_ROWS = 8 };
double *transform_inverse_strip(struct transform *transform, size_t first, size_t count);
/* As transform_inverse_rows, of all rows on this thread, each of which `row` is given in cache and
 * may change. */
typedef void transform_row(void *context, size_t j, double *line);
void transform_inverse_each(struct transform *transform, transform_row *row, void *context);
/* As transform_forward_rows, of all rows on this thread, each of which `row` fills. */
void transform_forward_each(struct transform *transform, transform_row *row, void *context);
/* Copies the spectrum of `from` into that of `to`, which has the same band and another grid: zero
 * padding. A Nyquist mode of an even grid stands for two modes of a finer one, each of half its
 * amplitude, and for the sum of two of them. */
void transform_pad(struct transform *from, struct transform *to);
/* Computes the plan's spectrum (all rows, columns up to mode_x) from z, which it keeps. */
void transform_forward(struct transform *transform, const double *z);
/* As transform_forward, in two steps: rows first .. first + count - 1 from z[count*nx], all of them
 * in any order, then the columns once. The columns of transform_inverse are lost. */
void transform_forward_rows(struct transform *transform, size_t first, size_t count,
                            const double *z);
void transform_forward_columns(struct transform *transform);
/* Between transform_forward_rows() and transform_inverse_rows(): transforms each column, of ny
 * values, hands it to `change` with its mx, and transforms it back while it is in cache. The same
 * digits as by transform_forward_columns(), the change, and transform_inverse_columns(). `change`
 * may be called from any thread of the team. */
typedef void transform_change(const void *context, size_t mx, double complex *column);
void transform_change_columns(struct transform *transform, transform_change *change,
                              const void *context);
/* out = the real field whose spectrum is factor * symbol * that of in (symbol real and even, one
 * value a wave of the half spectrum): forward, product and inverse with each column in cache.
 * Needs the whole band in y; in and out may be the same. */
void transform_filter(struct transform *transform, const double *symbol, double factor,
                      const double *in, double *out);
/* As transform_filter, of a field in the first ny rows of nx points of the transform's grid that is
 * 0 elsewhere; out holds as many points. */
void transform_filter_part(struct transform *transform, const double *symbol, double factor,
                           size_t nx, size_t ny, const double *in, double *out);

#endif
