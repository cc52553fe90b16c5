#include "core/surface/grooves/grooves.h"
#include <math.h>

struct groove_fit groove_fit_cell(double wave_x, double wave_y, double lx, double ly) {
    const double x = wave_x * lx, y = wave_y * ly;
    return (struct groove_fit){round(x), round(y), fmax(fabs(x - round(x)), fabs(y - round(y)))};
}

size_t groove_harmonics_most(const struct grid *grid, double along_x, double along_y) {
    static const double ROUNDING = 1e-9;
    const double y = grid_is_profile(grid) ? 0 : fabs(along_y) / (double)grid->ny;
    const double shortest = fmax(fabs(along_x) / (double)grid->nx, y);
    const double most = (1 - ROUNDING) / (2 * shortest);
    return most < GROOVE_HARMONICS_MOST ? (size_t)most : GROOVE_HARMONICS_MOST;
}

bool grooves_fit(const struct grooves *grooves, double lx, double ly) {
    static const double ROUNDING = 1e-6;
    for (size_t f = 0; f < grooves->families; f++) {
        const struct groove_family *family = &grooves->family[f];
        if (groove_fit_cell(family->wave_x, family->wave_y, lx, ly).off > ROUNDING)
            return false;
    }
    return true;
}

/* Adds one family: whole periods along both sides, so that rounding does not grow along them. */
static void family_add(const struct groove_family *family, const struct grid *grid, double phase,
                       double height, double *z) {
    const bool profile = grid_is_profile(grid);
    const struct groove_fit fit = groove_fit_cell(family->wave_x, profile ? 0 : family->wave_y,
                                                  grid->lx, profile ? 1 : grid->ly);
    const double by_i = fit.along_x / (double)grid->nx, by_j = fit.along_y / (double)grid->ny;
    const double depth = height * family->depth;
    for (size_t j = 0; j < grid->ny; j++) {
        const double start = phase + by_j * (double)j;
        for (size_t i = 0; i < grid->nx; i++)
            z[j * grid->nx + i] +=
                depth * groove_profile_height(&family->profile, start + by_i * (double)i);
    }
}

void grooves_add(const struct grooves *grooves, const struct grid *grid, struct random_key key,
                 double height, double *z) {
    for (size_t f = 0; f < grooves->families && f < GROOVE_FAMILIES_MOST; f++) {
        double phase = grooves->phase;
        if (isnan(phase))
            random_uniform(key, STREAM_GROOVES, f, 1, &phase);
        family_add(&grooves->family[f], grid, phase, height, z);
    }
}

bool grooves_independent(const struct grooves *grooves) {
    static const double ROUNDING = 1e-9;
    const struct groove_family *one = &grooves->family[0], *other = &grooves->family[1];
    const double waves = hypot(one->wave_x, one->wave_y) * hypot(other->wave_x, other->wave_y);
    const double across = one->wave_x * other->wave_y - one->wave_y * other->wave_x;
    return grooves->families < 2 || isnan(grooves->phase) || fabs(across) > ROUNDING * waves;
}

struct groove_moments grooves_cumulants(const struct grooves *grooves) {
    const double none = (double)NAN;
    struct groove_moments out = {0};
    if (!grooves_independent(grooves))
        return (struct groove_moments){none, none, none, none};
    for (size_t f = 0; f < grooves->families; f++) {
        const struct groove_family *family = &grooves->family[f];
        const struct groove_moments one = groove_profile_moments(&family->profile);
        const double d = family->depth, square = d * d;
        const double wave = hypot(family->wave_x, family->wave_y);
        out.second += square * one.second;
        out.third += square * d * one.third;
        out.fourth += square * square * (one.fourth - 3 * one.second * one.second);
        out.slope += square * one.slope * wave * wave;
    }
    return out;
}
