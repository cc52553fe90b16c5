#include "core/statistics/uncertainty/low_modes.h"
#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stdlib.h>

static const double LEVEL = 0.2, REACH_LENGTHS = 2.5;

double correlation_length(const struct correlation *correlation) {
    double shortest, longest;
    correlation_lengths(correlation, LEVEL, &shortest, &longest);
    return longest;
}

/* Returns the correlation at a lag that is a length; 0 beyond half a side. */
static double value_at(const struct correlation *correlation, const struct grid *grid, double x,
                       double y) {
    double value = correlation_at(correlation, x / grid_dx(grid),
                                  grid_is_profile(grid) ? 0 : y / grid_dy(grid));
    return isnan(value) ? 0 : value;
}

static double laplacian_at(const struct correlation *correlation, const struct grid *grid, double x,
                           double y, double lag) {
    double at = value_at(correlation, grid, x, y);
    double bend =
        value_at(correlation, grid, x + lag, y) - 2 * at + value_at(correlation, grid, x - lag, y);
    if (grid_is_profile(grid))
        return bend;
    return bend + value_at(correlation, grid, x, y + lag) - 2 * at +
           value_at(correlation, grid, x, y - lag);
}

/* lag: 0 for a power. */
static void field_fill(const struct correlation *correlation, const struct grid *grid, double reach,
                       int power, double lag, struct correlation_field *out) {
    *out = (struct correlation_field){.step = reach / FIELD_LAGS};
    long most_y = grid_is_profile(grid) ? 0 : FIELD_LAGS;
    for (long b = -most_y; b <= most_y; b++)
        for (long a = -FIELD_LAGS; a <= FIELD_LAGS; a++) {
            double x = (double)a * out->step, y = (double)b * out->step;
            if (hypot((double)a, (double)b) > FIELD_LAGS)
                continue;
            out->value[b + FIELD_LAGS][a + FIELD_LAGS] =
                lag > 0 ? pow(laplacian_at(correlation, grid, x, y, lag), 2)
                        : pow(value_at(correlation, grid, x, y), power);
        }
}

void correlation_field_power(const struct correlation *correlation, const struct grid *grid,
                             double length, int power, struct correlation_field *out) {
    field_fill(correlation, grid, REACH_LENGTHS * length, power, 0, out);
}

void correlation_field_slopes(const struct correlation *correlation, const struct grid *grid,
                              double length, double lag, struct correlation_field *out) {
    field_fill(correlation, grid, REACH_LENGTHS * length + lag, 0, lag, out);
}

enum { CELLS_SURFACE = 16, CELLS_PROFILE = 64 };
enum { WAVES_PERIODIC = 10, WAVES_OPEN = 19, WAVES_PROFILE_PERIODIC = 5, WAVES_PROFILE_OPEN = 10 };
static const double EXCESS_MOST = 2; /* more is not believed */
enum { REACH = 8, CANDIDATES = (REACH + 1) * (2 * REACH + 1) };

/* x and y in waves a side, of open maps in half waves. */
struct wave {
    long x, y;
    double square; /* of its wave number */
};

/* Lists waves of a half plane, or of a quarter of it where they are cosines. Tilts are left out of
 * open maps, which mostly have lost them with their trend. */
static size_t waves_list(const struct measured_map *map, struct wave *list) {
    bool open = map->boundary == BOUNDARY_OPEN, profile = grid_is_profile(map->grid);
    long most_x = profile ? 2L * REACH : REACH, most_y = profile ? 0 : REACH;
    double aspect = profile ? 0 : map->grid->lx / map->grid->ly;
    size_t count = 0;
    for (long x = 0; x <= most_x; x++)
        for (long y = open || x == 0 ? 0 : -most_y; y <= most_y; y++)
            if (x + labs(y) > (open ? 1 : 0))
                list[count++] =
                    (struct wave){x, y, (double)(x * x) + (double)(y * y) * aspect * aspect};
    return count;
}

/* Takes the slowest wave out of the list. */
static struct wave slowest_take(struct wave *list, size_t *count) {
    size_t slowest = 0;
    for (size_t a = 1; a < *count; a++)
        if (list[a].square < list[slowest].square)
            slowest = a;
    struct wave wave = list[slowest];
    list[slowest] = list[--*count];
    return wave;
}

static void wave_add(struct low_modes *out, const struct grid *grid, bool open, struct wave wave,
                     bool sine) {
    double unit = open ? M_PI : 2 * M_PI;
    out->wave_x[out->count] = unit * (double)wave.x / grid->lx;
    out->wave_y[out->count] = wave.y != 0 ? unit * (double)wave.y / grid->ly : 0;
    double *value = out->value[out->count++];
    double size = open ? (wave.x > 0 ? M_SQRT2 : 1) * (wave.y > 0 ? M_SQRT2 : 1) : M_SQRT2;
    for (size_t cy = 0; cy < out->cells_y; cy++)
        for (size_t cx = 0; cx < out->cells_x; cx++) {
            double x = (double)wave.x * ((double)cx + 0.5) / (double)out->cells_x;
            double y = (double)wave.y * ((double)cy + 0.5) / (double)out->cells_y;
            double phase = 2 * M_PI * (x + y);
            value[cy * out->cells_x + cx] = size * (open   ? cos(M_PI * x) * cos(M_PI * y)
                                                    : sine ? sin(phase)
                                                           : cos(phase));
        }
}

/* Returns how many times higher the density of a field at 0 is than the mean over the waves. */
static double excess_at(const struct low_modes *modes, const struct correlation_field *field) {
    double all = 0, waves = 0;
    for (long b = 0; b < FIELD_SIDE; b++)
        for (long a = 0; a < FIELD_SIDE; a++) {
            double x = (double)(a - FIELD_LAGS) * field->step, mean = 0;
            double y = (double)(b - FIELD_LAGS) * field->step;
            for (size_t m = 0; m < modes->count && field->value[b][a] != 0; m++)
                mean +=
                    cos(modes->wave_x[m] * x) * cos(modes->wave_y[m] * y) / (double)modes->count;
            all += field->value[b][a];
            waves += field->value[b][a] * mean;
        }
    return waves > all / EXCESS_MOST ? fmax(all / waves, 1) : EXCESS_MOST;
}

double low_modes_excess_slopes(const struct low_modes *modes, const struct correlation *correlation,
                               const struct grid *grid, double lag) {
    struct correlation_field field;
    double length = correlation_length(correlation);
    if (isnan(length))
        return 1;
    correlation_field_slopes(correlation, grid, length, lag, &field);
    return excess_at(modes, &field);
}

/* Returns the correlation of a field at a lag; 0 beyond its reach. */
static double field_at(const struct correlation_field *field, double x, double y) {
    const double at_x = x / field->step + FIELD_LAGS, at_y = y / field->step + FIELD_LAGS;
    const double last = FIELD_SIDE - 1;
    if (!(at_x >= 0 && at_x < last && at_y >= 0 && at_y < last))
        return 0;
    const size_t a = (size_t)at_x, b = (size_t)at_y;
    const double u = at_x - (double)a, v = at_y - (double)b;
    const double *here = field->value[b], *above = field->value[b + 1];
    return (1 - v) * ((1 - u) * here[a] + u * here[a + 1]) +
           v * ((1 - u) * above[a] + u * above[a + 1]);
}

/* Offsets between cells. */
enum { OFFSETS_X = 2 * CELLS_PROFILE - 1, OFFSETS_Y = 2 * CELLS_SURFACE - 1 };
typedef double cell_offsets[OFFSETS_Y][OFFSETS_X];

/* Returns the mean correlation of points of two cells of these sides, whose middles are x and y
 * apart. Cells of a profile have no height. */
static double cells_correlation(const struct correlation_field *field, double width, double height,
                                double x, double y) {
    enum { PARTS = 4 };
    static const double PART[PARTS] = {-0.75, -0.25, 0.25, 0.75};
    static const double SHARE[PARTS] = {0.125, 0.375, 0.375, 0.125}; /* of pairs so far apart */
    double mean = 0;
    for (size_t u = 0; u < PARTS; u++)
        for (size_t v = 0; v < PARTS; v++)
            mean +=
                SHARE[u] * SHARE[v] * field_at(field, x + PART[u] * width, y + PART[v] * height);
    return mean;
}

/* Fills in the correlations of cells that are so many cells apart. */
static void cells_correlate(const struct low_modes *modes, const struct correlation_field *field,
                            const struct grid *grid, cell_offsets out) {
    const double width = grid->lx / (double)modes->cells_x;
    const double height = grid_is_profile(grid) ? 0 : grid->ly / (double)modes->cells_y;
    const long most_x = (long)modes->cells_x - 1, most_y = (long)modes->cells_y - 1;
    for (long y = -most_y; y <= most_y; y++)
        for (long x = -most_x; x <= most_x; x++)
            out[y + most_y][x + most_x] =
                cells_correlation(field, width, height, (double)x * width, (double)y * height);
}

/* Fills in what the sums over cells, each times its weight, have to do with those of all others. */
static void cells_spread(const struct low_modes *modes, cell_offsets correlation,
                         const double *weight, double *out) {
    const size_t nx = modes->cells_x, ny = modes->cells_y;
    for (size_t cell = 0; cell < nx * ny; cell++) {
        const size_t x = cell % nx, y = cell / nx;
        out[cell] = 0;
        for (size_t b = 0; b < ny; b++)
            for (size_t a = 0; a < nx; a++)
                out[cell] += weight[b * nx + a] * correlation[ny - 1 + y - b][nx - 1 + x - a];
    }
}

/* Fills in the waves that weigh enough, about their means, times the counts and over the roots of
 * what they weigh; returns how many. */
static size_t waves_within(const struct low_modes *modes, const double *counts,
                           double out[LOW_MODES_MOST][LOW_CELLS_MOST]) {
    const size_t cells = modes->cells_x * modes->cells_y;
    size_t waves = 0;
    for (size_t m = 0; m < modes->count; m++) {
        const double weight = low_mode_weight(modes, m, counts);
        double n = 0, mean = 0;
        if (!(weight > LOW_MODE_WEIGHT_LEAST))
            continue;
        for (size_t cell = 0; cell < cells; cell++) {
            n += counts[cell];
            mean += counts[cell] * modes->value[m][cell];
        }
        for (size_t cell = 0; cell < cells; cell++)
            out[waves][cell] = counts[cell] * (modes->value[m][cell] - mean / n) / sqrt(weight);
        waves++;
    }
    return waves;
}

double low_modes_freedom_slopes(const struct low_modes *modes,
                                const struct correlation *correlation, const struct grid *grid,
                                double lag, const double *counts) {
    const double length = correlation_length(correlation), most = (double)modes->count;
    const size_t cells = modes->cells_x * modes->cells_y;
    double wave[LOW_MODES_MOST][LOW_CELLS_MOST] = {{0}}, spread[LOW_CELLS_MOST];
    double trace = 0, squares = 0;
    struct correlation_field field;
    cell_offsets between = {{0}};
    if (isnan(length) || !modes->open)
        return most;
    correlation_field_slopes(correlation, grid, length, lag, &field);
    cells_correlate(modes, &field, grid, between);
    const size_t waves = waves_within(modes, counts, wave);
    for (size_t m = 0; m < waves; m++) {
        cells_spread(modes, between, wave[m], spread);
        for (size_t other = 0; other < waves; other++) {
            double both = 0;
            for (size_t cell = 0; cell < cells; cell++)
                both += wave[other][cell] * spread[cell];
            trace += other == m ? both : 0;
            squares += both * both;
        }
    }
    return squares > 0 ? fmin(trace * trace / squares, most) : most;
}

bool low_modes_fill(const struct measured_map *map, const struct correlation *correlation,
                    struct low_modes *out) {
    struct wave list[CANDIDATES];
    bool profile = grid_is_profile(map->grid), open = map->boundary == BOUNDARY_OPEN;
    out->cells_x = profile ? CELLS_PROFILE : CELLS_SURFACE;
    out->cells_y = profile ? 1 : CELLS_SURFACE;
    out->open = open;
    out->count = 0;
    for (size_t power = 0; power < sizeof out->excess / sizeof *out->excess; power++)
        out->excess[power] = 1;
    if (map->grid->nx < out->cells_x || map->grid->ny < out->cells_y)
        return false;
    size_t count = waves_list(map, list);
    size_t wanted = profile ? (open ? WAVES_PROFILE_OPEN : WAVES_PROFILE_PERIODIC)
                            : (open ? WAVES_OPEN : WAVES_PERIODIC);
    for (size_t n = 0; n < wanted; n++) {
        struct wave wave = slowest_take(list, &count);
        wave_add(out, map->grid, open, wave, false);
        if (!open)
            wave_add(out, map->grid, open, wave, true);
    }
    double length = correlation != NULL ? correlation_length(correlation) : (double)NAN;
    for (int power = 2; power <= 3 && !isnan(length); power++) {
        struct correlation_field field;
        correlation_field_power(correlation, map->grid, length, power, &field);
        out->excess[power] = excess_at(out, &field);
    }
    return true;
}

double low_mode_amplitude(const struct low_modes *modes, size_t m, const double *sums) {
    double amplitude = 0;
    for (size_t cell = 0; cell < modes->cells_x * modes->cells_y; cell++)
        amplitude += modes->value[m][cell] * sums[cell];
    return amplitude;
}

double low_modes_variance(const struct low_modes *modes, const double *sums, double n) {
    double power = 0;
    for (size_t m = 0; m < modes->count; m++)
        power += pow(low_mode_amplitude(modes, m, sums) / n, 2);
    return power / (double)modes->count;
}

double low_mode_weight(const struct low_modes *modes, size_t m, const double *counts) {
    double n = 0, mean = 0, square = 0;
    for (size_t cell = 0; cell < modes->cells_x * modes->cells_y; cell++) {
        const double value = modes->value[m][cell];
        n += counts[cell];
        mean += counts[cell] * value;
        square += counts[cell] * value * value;
    }
    return square / n - (mean / n) * (mean / n);
}

double low_modes_variance_within(const struct low_modes *modes, const double *sums,
                                 const double *counts, double n) {
    double power = 0;
    size_t waves = 0;
    for (size_t m = 0; m < modes->count; m++) {
        const double weight = low_mode_weight(modes, m, counts);
        if (!(weight > LOW_MODE_WEIGHT_LEAST))
            continue;
        power += pow(low_mode_amplitude(modes, m, sums) / n, 2) / weight;
        waves++;
    }
    return waves > 0 ? power / (double)waves : (double)NAN;
}

double low_modes_factor(size_t count) {
    return gsl_cdf_tdist_Pinv(0.975, (double)count);
}

double low_modes_factor_over(const struct low_modes *modes, double freedom) {
    return gsl_cdf_tdist_Pinv(0.975, freedom) / low_modes_factor(modes->count);
}

double correlation_lengths_inside(const struct correlation *correlation, const struct grid *grid) {
    double side = grid_is_profile(grid) ? grid->lx : fmin(grid->lx, grid->ly);
    double length = correlation_length(correlation);
    return isnan(length) ? 0 : side / length;
}
