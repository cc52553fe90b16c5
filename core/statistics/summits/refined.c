#include "core/statistics/summits/refined.h"
#include "core/statistics/summits/grid_summits.h"
#include "core/statistics/summits/summit_climb.h"
#include "core/surface/transform.h"
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    POINTS = 8, /* of the interpolant along an axis: 3 before its cell, 4 behind */
    MARGIN = CLIMB_TRAVEL + POINTS / 2, /* rows that a search may need beyond its start */
    STRIP = 8,                          /* rows searched at a time */
    WINDOW = STRIP + 2 * MARGIN,
};

static const double SHIFT_X = 0.2371, SHIFT_Y = 0.3119; /* of the fine points, in cells */

struct refined {
    struct grid grid, fine;
    size_t mode_x, mode_y;
    struct transform *coarse, *dense;
    double *window;    /* WINDOW x fine.nx: rows first - MARGIN .. first + STRIP + MARGIN - 1 */
    size_t *columns;   /* starts of one row */
    double mean, unit; /* heights of the present surface are mean + unit * window */
};

static size_t fine_points(size_t points, size_t mode, size_t points_a_wave) {
    size_t wanted = points_a_wave * (mode != 0 ? mode : 1);
    return points * ((wanted + points - 1) / points);
}

static struct grid fine_grid(const struct grid *grid, size_t mode_x, size_t mode_y) {
    struct grid fine = *grid;
    if (grid_is_profile(grid)) {
        fine.nx = fine_points(grid->nx, mode_x, REFINED_PROFILE_POINTS);
        return fine;
    }
    fine.nx = fine_points(grid->nx, mode_x, REFINED_POINTS);
    fine.ny = fine_points(grid->ny, mode_y, REFINED_POINTS);
    return fine;
}

int refined_create(struct refined **out, const struct grid *grid, size_t mode_x, size_t mode_y,
                   struct error *err) {
    struct refined *r = array_create(1, sizeof *r);
    if (r == NULL)
        return error_memory(err, sizeof *r, "a summit search");
    r->grid = *grid;
    r->fine = fine_grid(grid, mode_x, mode_y);
    r->mode_x = mode_x;
    r->mode_y = mode_y;
    int status = transform_create(&r->coarse, grid, mode_x, mode_y, err);
    if (status == 0)
        status = transform_create(&r->dense, &r->fine, mode_x, mode_y, err);
    size_t rows = grid_is_profile(grid) ? 1 : WINDOW;
    r->window = array_create(rows * r->fine.nx, sizeof *r->window);
    r->columns = array_create(r->fine.nx, sizeof *r->columns);
    if (status == 0 && (r->window == NULL || r->columns == NULL))
        status = error_memory(err, rows * r->fine.nx * sizeof *r->window, "rows of a surface");
    if (status != 0) {
        refined_destroy(&r);
        return status;
    }
    *out = r;
    return 0;
}

void refined_destroy(struct refined **refined) {
    struct refined *r = *refined;
    if (r == NULL)
        return;
    transform_destroy(&r->coarse);
    transform_destroy(&r->dense);
    free(r->window);
    free(r->columns);
    free(r);
    *refined = NULL;
}

double refined_bytes(const struct grid *grid, size_t mode_x, size_t mode_y) {
    struct grid fine = fine_grid(grid, mode_x, mode_y);
    double columns = (double)(mode_x + 1) * (double)(grid->ny + fine.ny);
    double rows = grid_is_profile(grid) ? 1 : WINDOW;
    return columns * sizeof(double complex) + (rows + 1) * (double)fine.nx * sizeof(double);
}

double refined_points(const struct grid *grid, size_t mode_x, size_t mode_y) {
    const struct grid fine = fine_grid(grid, mode_x, mode_y);
    return (double)fine.nx * (double)fine.ny;
}

/* Lagrange basis on the points -3..4 at t in [-1/4, 5/4], with first and second derivatives. */
struct basis {
    double value[POINTS], slope[POINTS], bend[POINTS];
};

static void basis_at(double t, struct basis *basis) {
    static const double SCALE[POINTS] = {-1.0 / 5040, 1.0 / 720, -1.0 / 240, 1.0 / 144,
                                         -1.0 / 144,  1.0 / 240, -1.0 / 720, 1.0 / 5040};
    for (int a = 0; a < POINTS; a++) {
        double value = SCALE[a], slope = 0, bend = 0;
        for (int b = 0; b < POINTS; b++) {
            if (b == a)
                continue;
            double factor = t - (b - 3);
            bend = bend * factor + 2 * slope;
            slope = slope * factor + value;
            value *= factor;
        }
        basis->value[a] = value;
        basis->slope[a] = slope;
        basis->bend[a] = bend;
    }
}

static void jet_of_profile(const struct refined *r, double x, const struct climb_cell *cell,
                           struct jet *jet) {
    long nx = (long)r->fine.nx;
    struct basis bx;
    basis_at(x - (double)cell->x, &bx);
    *jet = (struct jet){0};
    for (int a = 0; a < POINTS; a++) {
        long i = ((cell->x + a - 3) % nx + nx) % nx;
        jet->z += bx.value[a] * r->window[i];
        jet->x += bx.slope[a] * r->window[i];
        jet->xx += bx.bend[a] * r->window[i];
    }
}

/* Interpolates at (x, y); y counts from the first row of the window. */
static void jet_at(const void *surface, double x, double y, struct climb_cell *cell,
                   struct jet *jet) {
    const struct refined *r = surface;
    cell_follow(x, &cell->x);
    cell_follow(y, &cell->y);
    if (grid_is_profile(&r->fine)) {
        jet_of_profile(r, x, cell, jet);
        return;
    }
    long nx = (long)r->fine.nx;
    struct basis bx, by;
    basis_at(x - (double)cell->x, &bx);
    basis_at(y - (double)cell->y, &by);
    long column[POINTS];
    for (int a = 0; a < POINTS; a++)
        column[a] = ((cell->x + a - 3) % nx + nx) % nx;
    *jet = (struct jet){0};
    for (int b = 0; b < POINTS; b++) {
        const double *row = r->window + (cell->y + b - 3) * nx;
        double z = 0, slope = 0, bend = 0;
        for (int a = 0; a < POINTS; a++) {
            double value = row[column[a]];
            z += bx.value[a] * value;
            slope += bx.slope[a] * value;
            bend += bx.bend[a] * value;
        }
        jet->z += by.value[b] * z;
        jet->x += by.value[b] * slope;
        jet->xx += by.value[b] * bend;
        jet->y += by.slope[b] * z;
        jet->xy += by.slope[b] * slope;
        jet->yy += by.bend[b] * z;
    }
}

static double wrapped(double x, double period) {
    double inside = x - period * floor(x / period);
    return inside < period ? inside : 0;
}

/* Searches from the maxima of one fine row, `row` rows into the window, which starts at fine row
 * first. */
static int row_search(struct refined *r, double first, size_t row, struct summit_list *list,
                      struct error *err) {
    const struct grid *fine = &r->fine;
    size_t nx = fine->nx;
    bool profile = grid_is_profile(fine);
    const double *middle = r->window + row * nx;
    size_t found = row_summits(profile ? NULL : middle - nx, middle, profile ? NULL : middle + nx,
                               nx, false, r->columns);
    double dx = grid_dx(fine), dy = profile ? 1 : grid_dy(fine);
    const struct climb climb = {r, jet_at, profile};
    for (size_t s = 0; s < found; s++) {
        double x, y;
        struct jet jet;
        if (!summit_climb(&climb, (double)r->columns[s], (double)row, &x, &y, &jet))
            continue;
        double bend = profile ? jet.xx / (dx * dx) : (jet.xx / (dx * dx) + jet.yy / (dy * dy)) / 2;
        struct summit summit = {
            .x = wrapped(x + SHIFT_X, (double)nx) * dx,
            .y = profile ? 0 : wrapped(first + y + SHIFT_Y, (double)fine->ny) * dy,
            .height = r->mean + r->unit * jet.z,
            .curvature = -r->unit * bend,
        };
        int status = summit_list_add(list, &summit, err);
        if (status != 0)
            return status;
    }
    return 0;
}

/* Fills window rows row .. row + count - 1 with the fine rows from `first` on, periodic. */
static void window_fill(struct refined *r, long first, size_t row, size_t count) {
    long ny = (long)r->fine.ny;
    for (size_t done = 0; done < count;) {
        size_t at = (size_t)((((first + (long)done) % ny) + ny) % ny);
        size_t rows = count - done;
        if (rows > r->fine.ny - at)
            rows = r->fine.ny - at;
        transform_inverse_rows(r->dense, at, rows, r->window + (row + done) * r->fine.nx);
        done += rows;
    }
}

static int strips_search(struct refined *r, struct summit_list *list, struct error *err) {
    size_t nx = r->fine.nx, ny = r->fine.ny, kept = WINDOW - STRIP;
    window_fill(r, -MARGIN, STRIP, kept);
    for (size_t first = 0; first < ny; first += STRIP) {
        memmove(r->window, r->window + STRIP * nx, kept * nx * sizeof *r->window);
        window_fill(r, (long)first + MARGIN, kept, STRIP);
        for (size_t row = 0; row < STRIP && first + row < ny; row++) {
            int status = row_search(r, (double)first - MARGIN, MARGIN + row, list, err);
            if (status != 0)
                return status;
        }
    }
    return 0;
}

/* Takes the mean out of the coarse spectrum, of the surface z or of the mirrored one -z, and scales
 * it by a power of two to about 1. So rounding does not disturb the search, whatever the offset and
 * the unit. What is no more than the rounding of the mean is flat. */
static void spectrum_normalise(struct refined *r, bool mirrored) {
    double complex *mode = transform_spectrum(r->coarse);
    size_t count = (r->mode_x + 1) * r->grid.ny;
    double largest = 0;
    r->mean = mirrored ? -creal(mode[0]) : creal(mode[0]);
    mode[0] = 0;
    for (size_t k = 0; k < count; k++)
        largest = fmax(largest, fmax(fabs(creal(mode[k])), fabs(cimag(mode[k]))));
    int exponent = 0;
    (void)frexp(largest, &exponent);
    r->unit = ldexp(1, exponent > -1000 ? exponent : -1000);
    double factor = largest > DBL_EPSILON * fabs(r->mean) ? 1 / r->unit : 0;
    for (size_t k = 0; k < count; k++)
        mode[k] *= mirrored ? -factor : factor;
}

/* Moves the fine points by SHIFT_X, SHIFT_Y of a cell: a symmetric map may have a maximum midway
 * between two of them, whose equal heights would start no search. */
static void samples_shift(struct refined *r) {
    size_t ny = r->fine.ny;
    double complex unit_x = cexp(2 * M_PI * SHIFT_X / (double)r->fine.nx * I);
    double complex unit_y = ny > 1 ? cexp(2 * M_PI * SHIFT_Y / (double)ny * I) : 1;
    double complex turn_x = 1;
    for (size_t mx = 0; mx <= r->mode_x; mx++, turn_x *= unit_x) {
        double complex *column = transform_spectrum(r->dense) + mx * ny, turn_y = 1;
        for (size_t my = 0; my <= r->mode_y; my++, turn_y *= unit_y) {
            column[my] *= turn_x * turn_y;
            if (my > 0)
                column[ny - my] *= turn_x * conj(turn_y);
        }
    }
}

static int find(struct refined *r, const double *z, bool mirrored, struct summit_list *list,
                struct error *err) {
    transform_forward(r->coarse, z);
    spectrum_normalise(r, mirrored);
    transform_pad(r->coarse, r->dense);
    samples_shift(r);
    transform_inverse_columns(r->dense);
    int status;
    if (grid_is_profile(&r->fine)) {
        transform_inverse_rows(r->dense, 0, 1, r->window);
        status = row_search(r, 0, 0, list, err);
    } else {
        status = strips_search(r, list, err);
    }
    if (status == 0)
        summits_merge(&r->fine, list);
    return status;
}

int refined_find(struct refined *r, const double *z, struct summit_list *list, struct error *err) {
    return find(r, z, false, list, err);
}

int refined_find_pits(struct refined *r, const double *z, struct summit_list *list,
                      struct error *err) {
    return find(r, z, true, list, err);
}
