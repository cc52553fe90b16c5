#include "core/statistics/spectra/map_spectrum.h"
#include "core/error.h"
#include "core/statistics/heights/roughness.h"
#include "core/statistics/spectra/windowed_psd.h"
#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stdlib.h>

/* How the modes of a ring are spread, and how many of them are independent. */

/* The squared correlation of two modes d apart along one axis, under Hann's window. */
static inline double window_correlation(long d) {
    d = d < 0 ? -d : d;
    return d == 0 ? 1 : d == 1 ? 4. / 9 : d == 2 ? 1. / 36 : 0;
}

/* Modes of which each stands for its mirror images: of circles the quarter of the plane with mx and
 * my >= 0, of ellipses the half with mx >= 0. */
struct sheet {
    size_t nx, ny;  /* modes along each axis */
    long lowest_y;  /* my of the first */
    size_t *ring;   /* nx * ny; `rings` beyond them */
    double *weight; /* density expected over that of the ring */
    double *total;  /* of weights by ring */
};

static double mode_distance(const struct map_spectrum *s, size_t mx, long my) {
    const struct grid *grid = &s->modes.grid;
    double x = (double)mx * (s->side / grid->lx);
    double y = grid_is_profile(grid) ? 0 : (double)my * (s->side / grid->ly);
    return lay_length(&s->frame, x, y);
}

/* How many modes of the full plane a mode of the sheet stands for. */
static double images(const struct sheet *sheet, size_t mx, long my) {
    return (mx > 0 ? 2 : 1) * (my > 0 && sheet->lowest_y == 0 ? 2 : 1);
}

/* Counts circles, or ellipses, up to the Nyquist wave number of both axes, but half a ring. */
static size_t whole_rings(const struct map_spectrum *s) {
    const struct grid *grid = &s->modes.grid;
    /* of the ring of radius 1 along an axis: the inverse of the frame has the determinant 1/ratio
     */
    double along_x = hypot(s->frame.across_y, s->frame.along_y) / s->lay.ratio;
    double along_y = hypot(s->frame.across_x, s->frame.along_x) / s->lay.ratio;
    double reach = (double)grid->nx / 2 * (s->side / grid->lx) / along_x;
    if (!grid_is_profile(grid))
        reach = fmin(reach, (double)grid->ny / 2 * (s->side / grid->ly) / along_y);
    size_t rings = (size_t)fmax(reach + 0.5, 1);
    return rings < s->bins ? rings : s->bins;
}

enum { SLOPE_RINGS = 3, SLOPED_RINGS = 16 };

/* Returns the exponent by which the density falls about ring r, by the rings nearby, 0 to 4. */
static double ring_slope(const struct map_spectrum *s, size_t r) {
    double n = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (size_t b = r > SLOPE_RINGS ? r - SLOPE_RINGS : 1; b <= r + SLOPE_RINGS && b < s->rings;
         b++)
        if (s->density[b] > 0) {
            double u = log((double)b), v = log(s->density[b]);
            n++;
            x += u;
            y += v;
            xx += u * u;
            xy += u * v;
        }
    double spread = n * xx - x * x;
    return spread > 0 ? fmin(fmax((x * y - n * xy) / spread, 0), 4) : 0;
}

/* Makes shares and means of counts and sums. */
static void parts_divide(struct map_spectrum *s) {
    for (size_t r = 0; r < s->rings; r++) {
        double count = 0;
        for (size_t part = 0; part < RING_PARTS; part++) {
            count += s->share[r][part];
            if (s->share[r][part] > 0)
                s->distance[r][part] /= s->share[r][part];
        }
        for (size_t part = 0; part < RING_PARTS && count > 0; part++)
            s->share[r][part] /= count;
    }
}

/* Sorts the modes into rings and their parts. Small ellipses may have none. */
static void modes_sort(struct map_spectrum *s, const struct sheet *sheet) {
    for (size_t mx = 0; mx < sheet->nx; mx++)
        for (size_t row = 0; row < sheet->ny; row++) {
            const long my = sheet->lowest_y + (long)row;
            const double count = images(sheet, mx, my);
            double distance = mode_distance(s, mx, my), slope = 0;
            size_t r = (size_t)(distance + 0.5), at = mx * sheet->ny + row;
            sheet->ring[at] = r < s->rings ? r : s->rings;
            if (r >= s->rings)
                continue;
            if (r > 0 && r < SLOPED_RINGS)
                slope = ring_slope(s, r);
            sheet->weight[at] = slope > 0 ? pow(distance / (double)r, -slope) : 1;
            sheet->total[r] += count * sheet->weight[at];
            size_t part = (size_t)((distance + 0.5 - (double)r) * RING_PARTS);
            part = part < RING_PARTS ? part : RING_PARTS - 1;
            s->share[r][part] += count;
            s->distance[r][part] += count * distance;
        }
}

/* Returns where the sheet has a mode, or an image of it; its size where it has none. */
static size_t sheet_at(const struct sheet *sheet, long mx, long my) {
    my = sheet->lowest_y == 0 ? labs(my) : mx < 0 ? -my : my;
    long row = my - sheet->lowest_y;
    return labs(mx) < (long)sheet->nx && row >= 0 && row < (long)sheet->ny
               ? (size_t)labs(mx) * sheet->ny + (size_t)row
               : sheet->nx * sheet->ny;
}

/* Adds the correlations of one mode with those nearby to the covariance of their rings. */
static void mode_correlate(struct map_spectrum *s, const struct sheet *sheet, size_t mx, long my,
                           long reach_x, long reach_y) {
    const size_t ny = sheet->ny, row = (size_t)(my - sheet->lowest_y);
    const size_t at = mx * ny + row, r = sheet->ring[at];
    const bool inside = mx >= (size_t)reach_x && mx + (size_t)reach_x < sheet->nx &&
                        row >= (size_t)reach_y && row + (size_t)reach_y < ny;
    double weight = images(sheet, mx, my) * sheet->weight[at];
    for (long dx = -reach_x; dx <= reach_x; dx++)
        for (long dy = -reach_y; dy <= reach_y; dy++) {
            size_t beside = inside ? (size_t)((long)at + dx * (long)ny + dy)
                                   : sheet_at(sheet, (long)mx + dx, my + dy);
            if (beside == sheet->nx * sheet->ny || sheet->ring[beside] < r ||
                sheet->ring[beside] >= s->rings || sheet->ring[beside] - r >= RING_REACH)
                continue;
            s->covariance[r][sheet->ring[beside] - r] +=
                weight * sheet->weight[beside] * window_correlation(dx) * window_correlation(dy);
        }
}

static void modes_correlate(struct map_spectrum *s, const struct sheet *sheet) {
    bool profile = grid_is_profile(&s->modes.grid);
    long reach = s->windowed ? 2 : 0;
    for (size_t mx = 0; mx < sheet->nx; mx++)
        for (size_t row = 0; row < sheet->ny; row++)
            if (sheet->ring[mx * sheet->ny + row] < s->rings)
                mode_correlate(s, sheet, mx, sheet->lowest_y + (long)row, reach,
                               profile ? 0 : reach);
    for (size_t r = 0; r < s->rings; r++)
        for (size_t d = 0; d < RING_REACH && r + d < s->rings; d++)
            s->covariance[r][d] *= s->covariance[r][d] > 0
                                       ? 2 / (sheet->total[r] * sheet->total[r + d] * s->heights)
                                       : 1;
}

/* squares: the sum over `count` modes, of the rings first to last - 1, of the squared power over
 * the ring's mean. Returns its ratio to that of waves of one mean and random amplitudes, 2 count,
 * where that is significantly above 1, as where densities differ by direction; else 1. */
static double excess(const struct map_spectrum *s, size_t first, size_t last, double count,
                     double squares) {
    double independent = 0;
    for (size_t r = first; r < last; r++)
        independent += s->covariance[r][0] > 0 ? 1 / s->covariance[r][0] : 0;
    double found = count > 0 ? squares / (2 * count) : 1;
    return found > 1 + 2 * sqrt(5 / independent) ? found : 1;
}

static void ring_squares(const struct map_spectrum *s, const struct sheet *sheet, double *squares) {
    const struct modes *modes = &s->modes;
    for (size_t mx = 0; mx < sheet->nx; mx++)
        for (size_t row = 0; row < sheet->ny; row++) {
            const long my = sheet->lowest_y + (long)row;
            size_t r = sheet->ring[mx * sheet->ny + row];
            double one = modes_power(modes, mx, my), other = one;
            if (sheet->lowest_y == 0)
                other = modes_power(modes, mx, 2 * my == (long)modes->grid.ny ? my : -my);
            if (r < s->rings)
                squares[r] += images(sheet, mx, my) * (one * one + other * other) / 2;
        }
}

/* Takes directions of unlike densities into account, octave by octave. */
static void rings_widen(struct map_spectrum *s, const struct sheet *sheet, double *squares) {
    const struct grid *grid = &s->modes.grid;
    double cell =
        grid_is_profile(grid) ? grid->lx / (2 * M_PI) : grid->lx * grid->ly / (4 * M_PI * M_PI);
    enum { LOWEST = 8 };
    static const double STEEP = 0.6, DEEP = 0.03; /* below, a ring is beyond an end */
    ring_squares(s, sheet, squares);
    for (size_t first = LOWEST; first < s->rings; first *= 2) {
        size_t last = 2 * first < s->rings ? 2 * first : s->rings;
        double count = 0, sum = 0;
        for (size_t r = first; r < last; r++)
            if (s->density[r] > STEEP * s->density[r - 1] &&
                s->density[r] > DEEP * s->density[first]) {
                count += sheet->total[r];
                sum += squares[r] * pow(cell / (s->density[r] * s->power), 2);
            }
        double factor = excess(s, first, last, count, sum);
        for (size_t r = first == LOWEST ? 0 : first; r < last; r++)
            for (size_t d = 0; d < RING_REACH; d++)
                s->covariance[r][d] *= factor;
    }
}

/* Fills rings, freedom, covariance, share and distance of a spectrum that has its densities
 * (FORMULAS.md, F18.12). ERROR_MEMORY alone. */
static int ring_modes_measure(struct map_spectrum *s, struct error *err) {
    const struct grid *grid = &s->modes.grid;
    const bool circles = lay_is_plain(&s->lay);
    struct sheet sheet = {.nx = grid->nx / 2 + 1,
                          .ny = circles ? grid->ny / 2 + 1 : grid->ny,
                          .lowest_y = circles ? 0 : -(long)((grid->ny - 1) / 2)};
    size_t count = sheet.nx * sheet.ny;
    sheet.ring = array_create(count, sizeof *sheet.ring);
    sheet.weight = array_create(count, sizeof *sheet.weight);
    sheet.total = array_create(2 * s->bins, sizeof *sheet.total);
    bool made = sheet.ring != NULL && sheet.weight != NULL && sheet.total != NULL;
    if (made) {
        modes_sort(s, &sheet);
        parts_divide(s);
        modes_correlate(s, &sheet);
        rings_widen(s, &sheet, sheet.total + s->bins);
        for (size_t r = 0; r < s->rings; r++)
            s->freedom[r] = s->covariance[r][0] > 0 ? 2 / s->covariance[r][0] : 0;
    }
    free(sheet.ring);
    free(sheet.weight);
    free(sheet.total);
    return made ? 0 : error_memory(err, count * sizeof *sheet.weight, "rings of modes");
}

static int arrays_create(struct map_spectrum *s, struct error *err) {
    s->wave_number = array_create(s->bins, sizeof *s->wave_number);
    s->density = array_create(s->bins, sizeof *s->density);
    s->freedom = array_create(s->bins, sizeof *s->freedom);
    s->covariance = array_create(s->bins, sizeof *s->covariance);
    s->share = array_create(s->bins, sizeof *s->share);
    s->distance = array_create(s->bins, sizeof *s->distance);
    return s->wave_number != NULL && s->density != NULL && s->freedom != NULL &&
                   s->covariance != NULL && s->share != NULL && s->distance != NULL
               ? 0
               : error_memory(err, s->bins * sizeof *s->covariance, "rings of a spectrum");
}

static int modes_fill(struct map_spectrum *s, const struct measured_map *map, struct error *err) {
    if (!s->windowed)
        return map_modes_measure(map->grid, map->z, &s->modes, err);
    double *z = array_create(grid_points(map->grid), sizeof *z);
    if (z == NULL)
        return error_memory(err, grid_points(map->grid) * sizeof *z, "a map under a window");
    int status = windowed_heights(map, z, &s->power, err);
    if (status == 0)
        status = map_modes_measure(map->grid, z, &s->modes, err);
    free(z);
    return status;
}

/* Returns the share of the points of a map that are no holes. */
static double heights_share(const struct measured_map *map) {
    size_t points = grid_points(map->grid), there = 0;
    for (size_t point = 0; point < points; point++)
        there += isnan(map->z[point]) ? 0 : 1;
    return (double)there / (double)points;
}

static int check_holes(const struct measured_map *map, double share, struct error *err) {
    return share < 1 && map->boundary == BOUNDARY_PERIODIC
               ? error_set(err, ERROR_INPUT, "a periodic map with holes has no spectrum")
               : 0;
}

int map_spectrum_create(struct map_spectrum **out, const struct measured_map *map,
                        struct error *err) {
    const struct grid *grid = map->grid;
    double share = heights_share(map);
    int status = check_holes(map, share, err);
    if (status != 0)
        return status;
    struct map_spectrum *s = array_create(1, sizeof *s);
    if (s == NULL)
        return error_memory(err, sizeof *s, "a spectrum");
    s->windowed = map->boundary == BOUNDARY_OPEN;
    s->lay = LAY_NONE;
    s->frame = lay_frame_of(&s->lay);
    s->power = 1;
    s->heights = share;
    s->side = grid_is_profile(grid) ? grid->lx : fmin(grid->lx, grid->ly);
    s->bins = radial_bins(grid);
    status = arrays_create(s, err);
    if (status == 0)
        status = modes_fill(s, map, err);
    if (status == 0) {
        psd_of_modes(&s->modes, s->wave_number, s->density);
        for (size_t r = 0; r < s->bins; r++)
            s->density[r] /= s->power;
        s->rings = whole_rings(s);
        status = ring_modes_measure(s, err);
    }
    if (status == 0)
        *out = s;
    else
        map_spectrum_destroy(&s);
    return status;
}

/* Fills the densities of ellipses. */
static void ellipses_fill(struct map_spectrum *s) {
    const struct grid *grid = &s->modes.grid;
    const long last_y = (long)grid->ny / 2;
    double cell = grid->lx * grid->ly / (4 * M_PI * M_PI) / s->power;
    for (size_t mx = 0; mx <= grid->nx / 2; mx++)
        for (long my = -(long)((grid->ny - 1) / 2); my <= last_y; my++) {
            size_t r = (size_t)(mode_distance(s, mx, my) + 0.5);
            double weight = modes_weight(grid, mx);
            if (r >= s->bins)
                continue;
            s->wave_number[r] += weight; /* first the number of modes */
            s->density[r] += weight * modes_power(&s->modes, mx, my) * cell;
        }
    for (size_t r = 0; r < s->bins; r++) {
        s->density[r] /= s->wave_number[r] > 0 ? s->wave_number[r] : 1;
        s->wave_number[r] = 2 * M_PI * (double)r / s->side;
    }
}

int map_spectrum_create_along(struct map_spectrum **out, const struct map_spectrum *circles,
                              const struct lay *lay, struct error *err) {
    struct map_spectrum *s = array_create(1, sizeof *s);
    if (s == NULL)
        return error_memory(err, sizeof *s, "a spectrum");
    *s = (struct map_spectrum){.modes = circles->modes,
                               .borrows_modes = true,
                               .windowed = circles->windowed,
                               .lay = *lay,
                               .frame = lay_frame_of(lay),
                               .power = circles->power,
                               .side = circles->side,
                               .heights = circles->heights,
                               .bins = circles->bins};
    s->bins = s->rings = whole_rings(s);
    int status = arrays_create(s, err);
    if (status == 0) {
        ellipses_fill(s);
        status = ring_modes_measure(s, err);
    }
    if (status == 0)
        *out = s;
    else
        map_spectrum_destroy(&s);
    return status;
}

void map_spectrum_destroy(struct map_spectrum **spectrum) {
    struct map_spectrum *s = *spectrum;
    if (s == NULL)
        return;
    if (!s->borrows_modes)
        free(s->modes.power);
    free(s->wave_number);
    free(s->density);
    free(s->freedom);
    free(s->covariance);
    free(s->share);
    free(s->distance);
    free(s);
    *spectrum = NULL;
}

/* Adds the densities of one more part, number `count` of them. */
static void piece_add(struct map_spectrum *total, const struct map_spectrum *piece, double count) {
    for (size_t r = 0; r < total->bins; r++)
        total->density[r] += (piece->density[r] - total->density[r]) / count;
}

int profile_spectrum_create(struct map_spectrum **out, const struct measured_map *profile,
                            struct error *err) {
    const struct grid *whole = profile->grid;
    const struct grid grid = {PROFILE_PIECE, 1, grid_dx(whole) * PROFILE_PIECE, 1};
    struct map_spectrum *total = NULL;
    size_t pieces = 0;
    int status = 0;
    for (size_t i = 0; i + PROFILE_PIECE <= whole->nx && status == 0; i += PROFILE_PIECE) {
        const struct measured_map part = {&grid, profile->z + i, BOUNDARY_OPEN};
        struct map_spectrum *piece = NULL;
        if (heights_share(&part) == 0)
            continue;
        status = map_spectrum_create(&piece, &part, err);
        if (status != 0)
            break;
        pieces++;
        if (total != NULL)
            piece_add(total, piece, (double)pieces);
        else {
            total = piece;
            piece = NULL;
        }
        map_spectrum_destroy(&piece);
    }
    if (status == 0 && total == NULL)
        status = error_set(err, ERROR_INPUT, "the profile has no heights, only holes");
    for (size_t r = 0; status == 0 && r < total->rings; r++) {
        total->freedom[r] *= (double)pieces;
        for (size_t d = 0; d < RING_REACH; d++)
            total->covariance[r][d] /= (double)pieces;
    }
    if (status == 0)
        *out = total;
    else
        map_spectrum_destroy(&total);
    return status;
}

/* Returns the value below which chi squared is with a probability, by Wilson and Hilferty's
 * approximation, within 1e-5, of many degrees of freedom, where the library's does not always end.
 */
static double chi_squared(double probability, double freedom) {
    static const double MANY = 200;
    double exact = freedom <= MANY ? gsl_cdf_chisq_Pinv(probability, freedom) : (double)NAN;
    double part = 2 / (9 * freedom), score = gsl_cdf_ugaussian_Pinv(probability);
    return isfinite(exact) ? exact : freedom * pow(1 - part + score * sqrt(part), 3);
}

/* The ends of what a value has as its mean, where it is distributed as chi squared. */
static void band(double value, double freedom, double *low, double *high) {
    bool known = freedom > 0 && value >= 0;
    *low = known ? value * freedom / chi_squared(0.975, freedom) : (double)NAN;
    *high = known ? value * freedom / chi_squared(0.025, freedom) : (double)NAN;
}

void map_spectrum_band(const struct map_spectrum *s, size_t ring, double *low, double *high) {
    bool inside = ring > 0 && ring < s->rings;
    band(s->density[ring], inside ? s->freedom[ring] : 0, low, high);
}

size_t line_psd_count(const struct map_spectrum *s, int axis) {
    const struct grid *grid = &s->modes.grid;
    size_t n = axis == 0 ? grid->nx : grid->ny;
    return (n - 1) / 2;
}

/* |Z|^2 at any signs of mx and my; 0 outside. */
static double power_at(const struct modes *modes, long mx, long my) {
    if (labs(mx) > (long)modes->mode_x)
        return 0;
    my = mx < 0 ? -my : my;
    if (2 * my == -(long)modes->grid.ny)
        my = -my;
    return labs(my) > (long)modes->mode_y ? 0 : modes_power(modes, (size_t)labs(mx), my);
}

/* Adds up the powers of the modes of one wave number along the axis. *variance: what its relative
 * variance is by these powers: of two modes of correlation c, the mean product is 1 + c^2 times
 * that of their means. */
static double line_power(const struct map_spectrum *s, int axis, long m, double *variance) {
    const struct grid *grid = &s->modes.grid;
    long n = axis == 0 ? (long)grid->ny : (long)grid->nx, reach = s->windowed && n > 1 ? 2 : 0;
    double total = 0, square = 0;
    for (long a = -((n - 1) / 2); a <= n / 2; a++) {
        double at[3] = {0};
        for (long d = 0; d <= reach; d++)
            at[d] = axis == 0 ? power_at(&s->modes, m, a + d) : power_at(&s->modes, a + d, m);
        total += at[0];
        for (long d = 0; d <= reach; d++) {
            double correlation = window_correlation(d);
            square += (d == 0 ? 1 : 2) * at[0] * at[d] * correlation / (1 + correlation);
        }
    }
    *variance = total > 0 ? square / (total * total) : (double)NAN;
    return total / s->power;
}

/* Returns the relative variance about wave number m. It is a mean over wave numbers nearby, since
 * its own error would be correlated with that of the density. */
static double variance_about(const double *variance, size_t m, size_t count) {
    enum { NEARBY = 4 };
    struct average mean = {0};
    for (size_t a = m > NEARBY ? m - NEARBY : 1; a <= m + NEARBY && a <= count; a++)
        average_add(&mean, variance[a - 1]);
    return average_value(&mean);
}

void line_psd_measure(const struct map_spectrum *s, int axis, double *wave_number, double *density,
                      double *low, double *high) {
    /* measured on 600 sub-maps of surfaces whose density changes within the reach of the window */
    static const double WINDOWED = 1.12;
    const struct grid *grid = &s->modes.grid;
    double length = axis == 0 ? grid->lx : grid->ly, excess = s->windowed ? WINDOWED : 1;
    size_t count = line_psd_count(s, axis);
    for (size_t m = 1; m <= count; m++) {
        wave_number[m - 1] = 2 * M_PI * (double)m / length;
        density[m - 1] = line_power(s, axis, (long)m, &high[m - 1]) * length / (2 * M_PI);
    }
    for (size_t m = 1; m <= count; m++)
        low[m - 1] = 2 / (variance_about(high, m, count) * excess);
    for (size_t m = 1; m <= count; m++)
        band(density[m - 1], low[m - 1], &low[m - 1], &high[m - 1]);
}
