#include "core/surface/impose.h"
#include <math.h>
#include <string.h>

/* Returns a mode with the given amplitude and the phase of `mode`, or the phase 0 where that is 0.
 */
static double complex with_amplitude(double complex mode, double amplitude) {
    double size = sqrt(creal(mode) * creal(mode) + cimag(mode) * cimag(mode));
    return size > 0 ? amplitude / size * mode : amplitude;
}

/* A column that is its own mirror image (mx = 0, and Nyquist of an even nx): rows my > 0 decide, so
 * that the symmetry is exact; modes that are their own conjugates keep their sign. */
static void mirror_column_impose(double complex *column, const double *amplitude, size_t ny,
                                 size_t mode_y) {
    for (size_t my = 0; my <= mode_y; my++) {
        if (my == 0 || 2 * my == ny) {
            column[my] = creal(column[my]) < 0 ? -amplitude[mode_y + my] : amplitude[mode_y + my];
            continue;
        }
        column[my] = with_amplitude(column[my], amplitude[mode_y + my]);
        column[ny - my] = conj(column[my]);
    }
}

void amplitudes_impose(const struct modes *modes, const double *amplitude,
                       double complex *spectrum) {
    const struct grid *grid = &modes->grid;
    size_t mode_x = modes->mode_x;
    size_t mode_y = modes->mode_y;
    size_t ny = grid->ny;
    for (size_t mx = 0; mx <= mode_x; mx++) {
        double complex *column = spectrum + mx * ny;
        const double *wanted = amplitude + mx * (2 * mode_y + 1);
        if (2 * mode_y + 1 < ny)
            memset(column + mode_y + 1, 0, (ny - 2 * mode_y - 1) * sizeof *column);
        if (mx == 0 || 2 * mx == grid->nx) {
            mirror_column_impose(column, wanted, ny, mode_y);
            continue;
        }
        for (size_t my = 0; my <= mode_y; my++)
            column[my] = with_amplitude(column[my], wanted[mode_y + my]);
        for (size_t my = 1; my <= mode_y && 2 * my != ny; my++)
            column[ny - my] = with_amplitude(column[ny - my], wanted[mode_y - my]);
    }
}
