#include "core/statistics/grooves/groove_extension.h"
#include <math.h>
#include <stdlib.h>

/* Returns the periods at s sides of the map from its middle along an axis with m of them across the
 * map: s is in [-1/2, 3/2), and the map ends at 1/2. */
static double periods_at(double m, double s) {
    return s <= 0.5 ? m * s : m / 2 + (round(2 * m) - m) * (s - 0.5);
}

/* Returns where point n of the cell is along an axis, in sides of the map from its middle: point i
 * of the map is at (i + 1/2)/count - 1/2. */
static double side_of(size_t n, size_t cell_count, size_t map_count) {
    return 2 * (double)n / (double)cell_count + 0.5 / (double)map_count - 0.5;
}

/* Returns the height of the lines, t periods from the middle of the map. */
static double lines_height(const struct groove_lines *lines, double t) {
    const double complex turn = cos(2 * M_PI * t) + sin(2 * M_PI * t) * I;
    double complex sum = 0;
    for (size_t h = lines->count; h-- > 0;)
        sum = (sum + lines->coefficient[h]) * turn;
    return 2 * creal(sum);
}

static void family_add(const struct map_groove *family, const double *along_x,
                       const double *along_y, const struct grid *cell, double times, double *z) {
    const struct groove_shape_fit *fit = &family->fit;
    const bool endless = groove_shape_endless(fit);
    const struct groove_lines beyond = groove_lines_beyond(&family->lines, fit, 0);
    for (size_t j = 0; j < cell->ny; j++)
        for (size_t i = 0; i < cell->nx; i++) {
            const double t = along_x[i] + along_y[j];
            const double shape = endless ? groove_shape_height(fit, t, 0) : 0;
            z[j * cell->nx + i] += times * (shape + lines_height(&beyond, t));
        }
}

int groove_extension_add(const struct map_grooves *grooves, const struct grid *map,
                         const struct grid *cell, double times, double *z, struct error *err) {
    double *along = array_create(cell->nx + cell->ny, sizeof *along);
    if (along == NULL)
        return error_memory(err, (cell->nx + cell->ny) * sizeof *along, "grooves of a cell");
    for (size_t f = 0; f < grooves->families; f++) {
        const struct groove_lines *lines = &grooves->family[f].lines;
        for (size_t i = 0; i < cell->nx; i++)
            along[i] = periods_at(lines->mx, side_of(i, cell->nx, map->nx));
        for (size_t j = 0; j < cell->ny; j++)
            along[cell->nx + j] =
                grid_is_profile(map) ? 0 : periods_at(lines->my, side_of(j, cell->ny, map->ny));
        family_add(&grooves->family[f], along, along + cell->nx, cell, times, z);
    }
    free(along);
    return 0;
}

double groove_extension_period(const struct map_groove *family, const struct grid *map) {
    const double mx = family->lines.mx, my = family->lines.my;
    const double x = (round(2 * mx) - mx) / map->lx;
    const double y = grid_is_profile(map) ? 0 : (round(2 * my) - my) / map->ly;
    return 1 / hypot(x, y);
}
