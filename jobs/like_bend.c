/* A smooth change of a table spectrum that gives it moments (like_spectrum.h). */
#include "jobs/like_spectrum.h"
#include <math.h>

enum { STEPS = 30, PARTS = 16 }; /* of Newton's method; of an interval between rows */
static const double BEND_MOST = 1.4, ENOUGH = 1e-10; /* of the logarithm */

/* Where wave numbers stand between the ends of the table: -1 to 1 by their logarithms. */
static double place(const struct like_table *table, double low, double wave_number) {
    double high = table->wave_number[table->count - 1];
    return 2 * log(wave_number / low) / log(high / low) - 1;
}

static double bend_at(const double c[LIKE_MOMENTS], double x) {
    return c[0] + x * (c[1] + x * c[2]);
}

/* sums[m][q]: of the moment of order 2 m, times x^q. */
static void sum_moments(const struct like_table *table, double low, bool profile,
                        const double c[LIKE_MOMENTS], double sums[LIKE_MOMENTS][LIKE_MOMENTS]) {
    for (size_t m = 0; m < LIKE_MOMENTS; m++)
        for (size_t q = 0; q < LIKE_MOMENTS; q++)
            sums[m][q] = 0;
    for (size_t row = 0; row + 1 < table->count; row++) {
        double from = fmax(table->wave_number[row], low), to = table->wave_number[row + 1];
        double ratio = table->density[row + 1] / table->density[row];
        double whole = log(to / table->wave_number[row]);
        if (!(to > from) || !(ratio > 0) || !isfinite(ratio))
            continue;
        double step = log(to / from) / PARTS;
        for (size_t part = 0; part < PARTS; part++) {
            double k = from * exp(((double)part + 0.5) * step), x = place(table, low, k);
            double density = table->density[row] *
                             pow(ratio, log(k / table->wave_number[row]) / whole) *
                             exp(bend_at(c, x));
            double weight = density * step * (profile ? k : k * k);
            for (size_t m = 0; m < LIKE_MOMENTS; m++, weight *= k * k)
                for (size_t q = 0; q < LIKE_MOMENTS; q++)
                    sums[m][q] += weight * pow(x, (double)q);
        }
    }
}

/* Cramer's rule; false where the moments do not tell the change. */
static bool solve(const double a[LIKE_MOMENTS][LIKE_MOMENTS], const double b[LIKE_MOMENTS],
                  double x[LIKE_MOMENTS]) {
    double whole = 0;
    for (int column = -1; column < LIKE_MOMENTS; column++) {
        double d[LIKE_MOMENTS][LIKE_MOMENTS];
        for (int m = 0; m < LIKE_MOMENTS; m++)
            for (int q = 0; q < LIKE_MOMENTS; q++)
                d[m][q] = q == column ? b[m] : a[m][q];
        double value = d[0][0] * (d[1][1] * d[2][2] - d[1][2] * d[2][1]) -
                       d[0][1] * (d[1][0] * d[2][2] - d[1][2] * d[2][0]) +
                       d[0][2] * (d[1][0] * d[2][1] - d[1][1] * d[2][0]);
        if (column < 0)
            whole = value;
        else
            x[column] = value / whole;
    }
    return fabs(whole) > 1e-12;
}

/* Newton's method on the logarithms of the moments. */
static bool find_bend(const struct like_table *table, double low, bool profile,
                      const double factors[LIKE_MOMENTS], double c[LIKE_MOMENTS]) {
    double before[LIKE_MOMENTS][LIKE_MOMENTS], now[LIKE_MOMENTS][LIKE_MOMENTS];
    sum_moments(table, low, profile, c, before);
    for (int step = 0; step < STEPS; step++) {
        double lacking[LIKE_MOMENTS], change[LIKE_MOMENTS], most = 0;
        sum_moments(table, low, profile, c, now);
        for (int m = 0; m < LIKE_MOMENTS; m++) {
            lacking[m] = log(factors[m] * before[m][0] / now[m][0]);
            most = fmax(most, fabs(lacking[m]));
            for (int q = LIKE_MOMENTS; q-- > 0;)
                now[m][q] /= now[m][0];
        }
        if (most < ENOUGH)
            return true;
        if (!isfinite(most) || !solve((const double(*)[LIKE_MOMENTS])now, lacking, change))
            return false;
        for (int q = 0; q < LIKE_MOMENTS; q++)
            c[q] += change[q];
    }
    return false;
}

void like_table_bend(struct like_table *table, const struct grid *cell,
                     const double factors[LIKE_MOMENTS]) {
    bool profile = grid_is_profile(cell);
    double c[LIKE_MOMENTS] = {0}, side = profile ? cell->lx : fmax(cell->lx, cell->ly);
    double low = fmax(2 * M_PI / side, table->wave_number[0]);
    bool found = find_bend(table, low, profile, factors, c);
    for (size_t row = 0; found && row < table->count; row++)
        found = fabs(bend_at(c, fmax(place(table, low, table->wave_number[row]), -1))) < BEND_MOST;
    for (size_t row = 0; found && row < table->count; row++)
        table->density[row] *=
            exp(bend_at(c, fmax(place(table, low, table->wave_number[row]), -1)));
}
