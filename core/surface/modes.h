/* Height spectra as prescribed, and their discrete form on a periodic cell (spectrum.h computes
 * it). */
#ifndef RUGO_CORE_SURFACE_MODES_H
#define RUGO_CORE_SURFACE_MODES_H

#include "core/rugo_lists.h"
#include "core/surface/grid.h"
#include <stdbool.h>

#define SPECTRUM_TYPE(type, name, value) SPECTRUM_##type,
enum spectrum_type { RUGO_SPECTRA(SPECTRUM_TYPE) };
#undef SPECTRUM_TYPE
struct translation;
struct counter_face;
struct plateau_face;
struct grooves;
enum spectrum_scale {
    SCALE_NONE,       /* m0 = 1 */
    SCALE_RMS_HEIGHT, /* sqrt(m00) = value */
    SCALE_RMS_SLOPE   /* profile sqrt(m2), surface sqrt(m20 + m02) = value */
};

struct spectrum {
    enum spectrum_type type;
    /* self-affine (FORMULAS.md, F2.1): wavelengths, long >= rolloff >= short > 0; the band lx/long
     * <= |m| <= lx/short includes both edges, with a relative guard of 1e-9 against rounding */
    double hurst; /* [0, 1] */
    double wavelength_long, wavelength_rolloff, wavelength_short;
    /* of self-affine surfaces and tables: ratio of the wavelengths along the lay to those across
     * it; 0 is as 1 */
    double anisotropy;
    double lay_angle; /* from the x axis to the lay, counter-clockwise, in radians */
    /* exponential autocorrelation exp(-sqrt((tx/bx)^2 + (ty/by)^2)) (F2.2) at the points of the
     * grid; it has no band limit and fills the grid */
    double correlation_x, correlation_y;
    /* table: density of any scale at rising |k|, of waves across the lay, interpolated in
     * logarithms, 0 outside; borrowed */
    size_t table_count;
    const double *table_wave_number; /* radians per length */
    const double *table_density;
    enum spectrum_scale scale;
    double scale_value; /* unused for SCALE_NONE */
    /* The law by which heights are translated from a Gaussian field (translation.h), borrowed;
     * NULL: the surface itself has the spectrum. It must be of this shape of spectrum. */
    const struct translation *translation;
    /* A second face (counter_face.h), borrowed: modes and moments are those of the sum of both, and
     * the scale above is of the first alone. NULL: there is one face. */
    const struct counter_face *counter;
    /* The plateau of a stratified face (plateau_face.h), borrowed: the scale above is of the
     * valleys alone. NULL: the face is of one surface. */
    const struct plateau_face *plateau;
    /* Grooves (grooves.h) that surfaces have beside what this spectrum makes of them, borrowed:
     * modes and moments are without them. NULL: none. Not with a translation or a counter face. */
    const struct grooves *grooves;
};

/* The discrete spectrum on a grid: power P(mx, my) = |Z|^2, mean square height = sum over all modes
 * of the full plane. Half plane mx >= 0 is stored, for |mx| <= mode_x, |my| <= mode_y:
 * power[mx*(2*mode_y + 1) + my + mode_y]. P(0,0) = 0. Callers read the fields and change none. */
struct modes {
    struct grid grid;
    size_t mode_x, mode_y; /* highest wave number present (mode_y = 0 for a profile) */
    double *power;         /* owned, (mode_x + 1) x (2 mode_y + 1) */
    size_t count;          /* non-null modes of the full plane */
    double clipped; /* share of the power that was omitted as negative: exponential_acf alone */
    /* Of a translated surface, else NULL: the spectrum is that of its Gaussian field, of unit
     * variance, and the surface has the RMS height below. Borrowed. */
    const struct translation *translation;
    double height;
    /* Of a stratified face powers are means over those of both surfaces, weighted by their shares
     * of the face: slopes are those of the face (F18.60), and `height` is its RMS height. */
    bool stratified;
};

static inline double modes_power(const struct modes *modes, size_t mx, long my) {
    return modes->power[mx * (2 * modes->mode_y + 1) + (size_t)(my + (long)modes->mode_y)];
}
/* Returns the number of modes of the full plane that a stored one stands for. Column 0 and, for
 * even nx, the Nyquist column hold both signs of my themselves; every other column stands for its
 * mirror image too. The Nyquist row of an even ny is stored once, at +ny/2. */
static inline unsigned modes_weight(const struct grid *grid, size_t mx) {
    return mx == 0 || 2 * mx == grid->nx ? 1 : 2;
}
/* Returns whether a mode is in the Nyquist column or row of an even grid. It is then its mirror
 * image, too, so that odd powers of either component of its wave vector are 0 in the mean. */
static inline bool modes_twin(const struct grid *grid, size_t mx, long my) {
    return 2 * mx == grid->nx || 2 * (size_t)(my < 0 ? -my : my) == grid->ny;
}

#endif
