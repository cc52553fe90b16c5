#include "core/statistics/correlation_field.h"
#include <math.h>

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
