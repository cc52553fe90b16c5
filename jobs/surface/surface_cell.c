/* The grid of the cell of a case (surface_case.h): sides that transform fast, and rectangles whose
 * sides have the same spacing. */
#include "jobs/surface/surface_case.h"
#include <math.h>

static const double ROUNDING = 1e-9; /* relative: guards integers behind divisions */

static bool is_smooth(size_t n) {
    for (size_t prime = 2; prime <= 7; prime += prime == 2 ? 1 : 2)
        while (n % prime == 0)
            n /= prime;
    return n == 1;
}

size_t surface_case_side(double points) {
    double nearest = round(points);
    if (fabs(points - nearest) <= ROUNDING * points)
        return (size_t)nearest;
    size_t n = (size_t)ceil(points);
    for (n += n % 2; !is_smooth(n);)
        n += 2;
    return n;
}

static bool is_whole(double number) {
    return fabs(number - round(number)) <= ROUNDING * number;
}

/* Finds sides of at least `shorter` and `longer` points in that ratio, with the same spacing. False
 * if the ratio is not one of whole numbers of which the smaller is at most RATIO_MOST. */
static bool sides_of(double shorter, double longer, size_t *few, size_t *many) {
    enum { RATIO_MOST = 64 };
    if (is_whole(shorter) && is_whole(longer)) {
        *few = (size_t)round(shorter);
        *many = (size_t)round(longer);
        return true;
    }
    for (size_t parts = 1; parts <= RATIO_MOST; parts++) {
        double times = longer / shorter * (double)parts;
        size_t side = surface_case_side(shorter / (double)parts);
        if (is_whole(times)) {
            *few = parts * side;
            *many = (size_t)round(times) * side;
            return true;
        }
    }
    return false;
}

/* Makes the grid of a surface that is no square. */
static bool rectangle_of(const struct surface_case *surface, double points, const char *path,
                         struct values *values, struct grid *out) {
    double lx = surface->length_ratio * surface->wavelength_ratio;
    double ly = surface->length_ratio_y * surface->wavelength_ratio;
    size_t few, many;
    if (lx * points * ly * points > SURFACE_POINTS_MOST * (1 + ROUNDING)) {
        values_fault(values, path,
                     "a grid of %.0f by %.0f points is too large: at most %.0f in all", lx * points,
                     ly * points, SURFACE_POINTS_MOST);
        return false;
    }
    if (!sides_of(fmin(lx, ly) * points, fmax(lx, ly) * points, &few, &many)) {
        values_fault(values, "/surface/length_ratio_y",
                     "a cell of %g by %g longest waves: %g by %g points cannot be rounded to whole "
                     "numbers with the same distances along x and y; take sides in a simple ratio",
                     surface->length_ratio, surface->length_ratio_y, lx * points, ly * points);
        return false;
    }
    *out = lx < ly ? (struct grid){few, many, lx, ly} : (struct grid){many, few, lx, ly};
    return true;
}

bool surface_case_grid(const struct surface_case *surface, double points_of_wave, const char *path,
                       struct values *values, struct grid *out) {
    double points = points_of_wave * surface_case_times_shortest(surface);
    bool profile = surface->dimension == 1;
    double length = surface->length_ratio * surface->wavelength_ratio;
    if (!surface_case_is_square(surface))
        return rectangle_of(surface, points, path, values, out);
    double wanted = length * points, total = profile ? wanted : wanted * wanted;
    if (total > SURFACE_POINTS_MOST * (1 + ROUNDING)) {
        values_fault(values, path, "a grid of %.0f points a side is too large: at most %.0f",
                     wanted, profile ? SURFACE_POINTS_MOST : floor(sqrt(SURFACE_POINTS_MOST)));
        return false;
    }
    size_t side = surface_case_side(wanted);
    *out = (struct grid){side, profile ? 1 : side, length, length};
    return true;
}
