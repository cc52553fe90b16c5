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

double correlation_lengths_inside(const struct correlation *correlation, const struct grid *grid) {
    double side = grid_is_profile(grid) ? grid->lx : fmin(grid->lx, grid->ly);
    double length = correlation_length(correlation);
    return isnan(length) ? 0 : side / length;
}
