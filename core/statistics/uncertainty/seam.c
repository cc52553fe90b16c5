#include "core/statistics/uncertainty/seam.h"
#include <math.h>
#include <stdlib.h>

enum { ORDERS = 3, ORDER_MOST = 4 };

/* Differences of these orders are compared: a low one sees a step in a rough map, a high one also a
 * small step in a smooth map, where slopes differ. */
static const size_t ORDER[ORDERS] = {1, 2, 4};
static const double WEIGHT[ORDERS][ORDER_MOST + 1] = {{-1, 1}, {1, -2, 1}, {1, -4, 6, -4, 1}};

/* Lines of heights across a seam: n points a line at this distance, `lines` of them. */
struct lines {
    const double *z;
    size_t n, step, lines, line_step;
};

/* Fills square[p] with the mean square, over the lines, of the difference that begins at point p;
 * those with p + order >= n cross the seam. NaN where no line has one. */
static void squares_fill(const struct lines *lines, size_t d, double *square) {
    for (size_t p = 0; p < lines->n; p++) {
        double total = 0, count = 0;
        for (size_t line = 0; line < lines->lines; line++) {
            double difference = 0;
            for (size_t k = 0; k <= ORDER[d]; k++)
                difference += WEIGHT[d][k] *
                              lines->z[line * lines->line_step + (p + k) % lines->n * lines->step];
            if (isnan(difference))
                continue;
            total += difference * difference;
            count++;
        }
        square[p] = total / count;
    }
}

/* Returns the mean over the `order` differences that cross the seam, over the largest mean of as
 * many in a row inside. */
static double seam_over_inside(const double *square, size_t n, size_t order) {
    double seam = 0, most = 0;
    for (size_t p = n - order; p < n; p++)
        seam += square[p];
    for (size_t first = 0; first + 2 * order <= n; first++) {
        double inside = 0;
        for (size_t p = first; p < first + order; p++)
            inside += square[p];
        most = inside > most ? inside : most; /* not so where NaN */
    }
    if (seam == 0)
        return 0;
    return isnan(seam) || most == 0 ? (double)INFINITY : sqrt(seam / most);
}

static double lines_seam(const struct lines *lines, double *square) {
    double largest = 0;
    if (lines->n < SEAM_POINTS)
        return (double)INFINITY;
    for (size_t d = 0; d < ORDERS; d++) {
        squares_fill(lines, d, square);
        largest = fmax(largest, seam_over_inside(square, lines->n, ORDER[d]));
    }
    return largest;
}

int seam_measure(const struct grid *grid, const double *z, struct seam *out, struct error *err) {
    size_t nx = grid->nx, ny = grid->ny, most = nx > ny ? nx : ny;
    const struct lines x = {z, nx, 1, ny, nx}, y = {z, ny, nx, nx, 1};
    double *square = array_create(most, sizeof *square);
    if (square == NULL)
        return error_memory(err, most * sizeof *square, "differences of heights");
    out->x = lines_seam(&x, square);
    out->y = grid_is_profile(grid) ? 0 : lines_seam(&y, square);
    free(square);
    return 0;
}
