#include "core/statistics/summits/summit_climb.h"
#include <math.h>
#include <stdlib.h>

enum { STEPS = 40 };

void cell_follow(double x, long *cell) {
    double t = x - (double)*cell;
    if (!(t >= -0.25 && t <= 1.25))
        *cell = (long)floor(x);
}

/* Negative definite Hessian, its determinant above `share` of its squared trace (which is at most a
 * quarter). */
static bool is_concave(const struct climb *climb, const struct jet *jet, double share) {
    if (climb->profile)
        return jet->xx < 0;
    double trace = jet->xx + jet->yy;
    return trace < 0 && jet->xx * jet->yy - jet->xy * jet->xy > share * trace * trace;
}

/* Second derivatives of the interpolant are good to 1e-5: on the ridge of a single wave they do not
 * distinguish a maximum from a saddle. Maxima of random surfaces are as flat as this once in
 * 1e7. */
static const double RIDGE = 1e-4;

/* Newton's step where the surface is concave, a climb along the gradient elsewhere; at most half a
 * cell. */
static void step_up(const struct climb *climb, const struct jet *jet, double *dx, double *dy) {
    bool concave = is_concave(climb, jet, 0);
    if (!concave) {
        *dx = jet->x;
        *dy = jet->y;
    } else if (climb->profile) {
        *dx = -jet->x / jet->xx;
        *dy = 0;
    } else {
        double determinant = jet->xx * jet->yy - jet->xy * jet->xy;
        *dx = (jet->xy * jet->y - jet->yy * jet->x) / determinant;
        *dy = (jet->xy * jet->x - jet->xx * jet->y) / determinant;
    }
    double length = hypot(*dx, *dy);
    if (length > 0.5 || (!concave && length > 0)) {
        *dx *= 0.5 / length;
        *dy *= 0.5 / length;
    }
}

bool summit_climb(const struct climb *climb, double x0, double y0, double *x, double *y,
                  struct jet *jet) {
    struct climb_cell cell = {(long)x0, (long)y0};
    *x = x0;
    *y = y0;
    for (int step = 0; step < STEPS; step++) {
        double dx, dy;
        climb->jet(climb->surface, *x, *y, &cell, jet);
        step_up(climb, jet, &dx, &dy);
        *x += dx;
        *y += dy;
        if (!(fabs(*x - x0) < CLIMB_TRAVEL && fabs(*y - y0) < CLIMB_TRAVEL))
            return false;
        if (hypot(dx, dy) < 1e-7) {
            climb->jet(climb->surface, *x, *y, &cell, jet);
            return is_concave(climb, jet, RIDGE);
        }
    }
    return false;
}

static int by_row(const void *a, const void *b) {
    const struct summit *s = a, *t = b;
    if (s->y != t->y)
        return s->y < t->y ? -1 : 1;
    return (s->x > t->x) - (s->x < t->x);
}

/* Returns the distance of two positions on a circle. */
static double apart(double a, double b, double period) {
    double distance = fabs(a - b);
    return fmin(distance, period - distance);
}

/* Sorted by row, copies are near neighbours in the list. A dropped one is marked by x < 0 until the
 * list is closed up. */
void summits_merge(const struct grid *fine, struct summit_list *list) {
    /* In fine cells: copies of one maximum found by interpolants of neighbouring cells are at most
     * this far apart, and two different maxima are never so near. */
    const double near = 0.02;
    struct summit *s = list->summits;
    bool profile = grid_is_profile(fine);
    double near_x = near * grid_dx(fine), near_y = profile ? 1 : near * grid_dy(fine);
    double ly = profile ? 2 : fine->ly;
    if (list->count > 1)
        qsort(s, list->count, sizeof *s, by_row);
    for (size_t i = 0; i < list->count; i++) {
        for (size_t step = 1; s[i].x >= 0 && step < list->count; step++) {
            struct summit *other = &s[(i + step) % list->count];
            double along = profile ? apart(other->x, s[i].x, fine->lx) - near_x
                                   : apart(other->y, s[i].y, ly) - near_y;
            if (other->x >= 0 && !(along < 0))
                break;
            if (other->x >= 0 && apart(other->x, s[i].x, fine->lx) < near_x)
                other->x = -1;
        }
    }
    size_t kept = 0;
    for (size_t i = 0; i < list->count; i++)
        if (s[i].x >= 0)
            s[kept++] = s[i];
    list->count = kept;
}
