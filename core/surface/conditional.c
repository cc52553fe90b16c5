#include "core/surface/conditional.h"
#include "core/error.h"
#include "core/surface/transform.h"
#include <math.h>
#include <stdlib.h>

/* Equations are solved where what they lack is this share of the noise, or this one where no more
 * steps are allowed. */
static const double ACCURACY = 1e-3, ACCURACY_LEAST = 1e-2;
/* Noise in the approximate inverse, over that of the equations: waves beyond the law's shortest
 * have more power by mirror images. 10 to 100 take half the steps of 1. */
static const double NOISE_SHARE = 30;
enum { STEPS_MOST = 10000, UNIFORMS = 1024, TERMS_MOST = 6 };

struct equations {
    const struct conditional_law *law;
    const struct conditional_patch *patch;
    struct transform *transform;
    double *covariance; /* of the waves: power times the points of the cell */
    double *inverse;    /* of covariance and noise */
    double *mirrors;    /* one cell */
    double *solution, *residual, *direction, *image; /* one patch each; 0 in holes */
    size_t terms;                                    /* of the trend that was taken out */
    double *term; /* terms patches: orthonormal over the points that were measured */
};

static void equations_clear(struct equations *e) {
    transform_destroy(&e->transform);
    free(e->covariance);
    free(e->mirrors);
    free(e->solution);
    free(e->term);
}

static double dot(const double *a, const double *b, size_t n) {
    double total = 0;
    for (size_t i = 0; i < n; i++)
        total += a[i] * b[i];
    return total;
}

/* Sets what is in holes to 0. */
static void leave_holes(const struct equations *e, double *values) {
    for (size_t p = 0; p < e->patch->nx * e->patch->ny; p++)
        if (isnan(e->patch->z[p]))
            values[p] = 0;
}

/* --- the trend --- */

/* Takes the first `terms` terms out of values that are 0 in holes. */
static void take_out(const struct equations *e, size_t terms, double *values) {
    const size_t n = e->patch->nx * e->patch->ny;
    for (size_t t = 0; t < terms; t++) {
        const double *term = e->term + t * n, part = dot(term, values, n);
        for (size_t p = 0; p < n; p++)
            values[p] -= part * term[p];
    }
}

/* Fills u^x v^y, u and v from -1 to 1 over the patch. */
static void power_fill(const struct conditional_patch *patch, int x, int y, double *out) {
    for (size_t j = 0; j < patch->ny; j++)
        for (size_t i = 0; i < patch->nx; i++) {
            const double u = (2 * (double)i + 1) / (double)patch->nx - 1;
            const double v = (2 * (double)j + 1) / (double)patch->ny - 1;
            out[j * patch->nx + i] = pow(u, x) * pow(v, y);
        }
}

/* Makes the terms by Gram and Schmidt; those that the points do not distinguish are left out. */
static int terms_make(struct equations *e, struct error *err) {
    static const double LEAST = 1e-12;
    const struct conditional_patch *patch = e->patch;
    const size_t n = patch->nx * patch->ny;
    if (patch->trend == 0)
        return 0;
    e->term = array_create(TERMS_MOST * n, sizeof *e->term);
    if (e->term == NULL)
        return error_memory(err, TERMS_MOST * n * sizeof *e->term, "the trend of a patch");
    for (int degree = 0; degree < patch->trend; degree++)
        for (int y = 0; y <= (patch->ny == 1 ? 0 : degree); y++) {
            double *term = e->term + e->terms * n;
            power_fill(patch, degree - y, y, term);
            leave_holes(e, term);
            const double before = dot(term, term, n);
            take_out(e, e->terms, term);
            take_out(e, e->terms, term);
            const double square = dot(term, term, n);
            if (!(square > LEAST * before))
                continue;
            for (size_t p = 0; p < n; p++)
                term[p] /= sqrt(square);
            e->terms++;
        }
    return 0;
}

/* --- the equations --- */

static int equations_make(struct equations *e, const struct conditional_law *law,
                          const struct conditional_patch *patch, struct error *err) {
    const struct grid *cell = law->cell;
    const size_t modes = (cell->nx / 2 + 1) * cell->ny, points = patch->nx * patch->ny;
    *e = (struct equations){.law = law, .patch = patch};
    int status = transform_create(&e->transform, cell, cell->nx / 2, cell->ny / 2, err);
    if (status != 0)
        return status;
    e->covariance = array_create(2 * modes, sizeof *e->covariance);
    e->mirrors = array_create(grid_points(cell), sizeof *e->mirrors);
    e->solution = array_create(4 * points, sizeof *e->solution);
    if (e->covariance == NULL || e->mirrors == NULL || e->solution == NULL) {
        equations_clear(e);
        return error_memory(err, (2 * modes + grid_points(cell) + 4 * points) * sizeof(double),
                            "a surface that holds a patch");
    }
    e->inverse = e->covariance + modes;
    e->residual = e->solution + points;
    e->direction = e->residual + points;
    e->image = e->direction + points;
    for (size_t m = 0; m < modes; m++) {
        e->covariance[m] = law->power[m] * (double)grid_points(cell);
        e->inverse[m] = 1 / (e->covariance[m] + NOISE_SHARE * law->noise);
    }
    status = terms_make(e, err);
    if (status != 0)
        equations_clear(e);
    return status;
}

/* image = Q (A C A^T + N) direction, A being the restriction to what was measured, and Q that to
 * what has no trend. */
static void multiply(struct equations *e) {
    const size_t points = e->patch->nx * e->patch->ny;
    transform_filter_part(e->transform, e->covariance, 1, e->patch->nx, e->patch->ny, e->direction,
                          e->image);
    for (size_t p = 0; p < points; p++)
        e->image[p] += e->law->noise * e->direction[p];
    leave_holes(e, e->image);
    take_out(e, e->terms, e->image);
}

static size_t mirrored(size_t i, size_t n) {
    return i < n ? i : 2 * n - 1 - i;
}

/* image = an approximate inverse of the equations times the residual: that of a patch that goes on
 * as its mirror images, as an average over them. */
static void precondition(struct equations *e) {
    const size_t nx = e->patch->nx, ny = e->patch->ny, cell_nx = e->law->cell->nx;
    const size_t rows = e->law->cell->ny;
    for (size_t j = 0; j < rows; j++)
        for (size_t i = 0; i < cell_nx; i++)
            e->mirrors[j * cell_nx + i] = e->residual[mirrored(j, ny) * nx + mirrored(i, nx)];
    transform_filter(e->transform, e->inverse, 1, e->mirrors, e->mirrors);
    for (size_t p = 0; p < nx * ny; p++)
        e->image[p] = 0;
    for (size_t j = 0; j < rows; j++)
        for (size_t i = 0; i < cell_nx; i++)
            e->image[mirrored(j, ny) * nx + mirrored(i, nx)] += e->mirrors[j * cell_nx + i];
    leave_holes(e, e->image);
    take_out(e, e->terms, e->image);
}

/* Solves by conjugate gradients from 0; the residual is the right side at first. */
static int solve(struct equations *e, struct conditional_report *report, struct error *err) {
    const size_t n = e->patch->nx * e->patch->ny;
    const double one = e->law->noise * (double)report->points; /* square of the noise's length */
    double before = 0;
    size_t step = 0;
    for (; step < STEPS_MOST && dot(e->residual, e->residual, n) > ACCURACY * ACCURACY * one;
         step++) {
        precondition(e);
        const double product = dot(e->residual, e->image, n);
        for (size_t p = 0; p < n; p++)
            e->direction[p] = e->image[p] + (step > 0 ? product / before * e->direction[p] : 0);
        multiply(e);
        const double length = product / dot(e->direction, e->image, n);
        for (size_t p = 0; p < n; p++) {
            e->solution[p] += length * e->direction[p];
            e->residual[p] -= length * e->image[p];
        }
        before = product;
    }
    report->steps = step;
    report->residual = sqrt(dot(e->residual, e->residual, n) / one);
    if (!(report->residual <= ACCURACY_LEAST))
        return error_set(err, ERROR_NUMERIC,
                         "a surface that holds %zu points is not found within %d steps: the "
                         "equations lack %.3g of the noise",
                         report->points, (int)STEPS_MOST, report->residual);
    return 0;
}

/* Fills independent Gaussian numbers of mean 0 and mean square 1, number p from words 2 (p/2) and
 * the next (Box and Muller 1958). */
static void gaussian_fill(struct random_key key, enum random_stream stream, size_t n, double *out) {
    double u[UNIFORMS];
    for (size_t first = 0; first < n; first += UNIFORMS) {
        random_uniform(key, stream, first, UNIFORMS, u);
        for (size_t p = 0; p < UNIFORMS && first + p < n; p++) {
            const double size = sqrt(-2 * log(1 - u[p / 2 * 2])); /* 1 - u is above 0 */
            const double angle = 2 * M_PI * u[p / 2 * 2 + 1];
            out[first + p] = size * (p % 2 == 0 ? cos(angle) : sin(angle));
        }
    }
}

void conditional_noise(struct random_key key, size_t n, double *out) {
    gaussian_fill(key, STREAM_EXTENSION_NOISE, n, out);
}

/* Fills z with a surface of the law that knows nothing of the patch. */
static int draw_free(const struct conditional_law *law, struct transform *transform,
                     struct random_key key, double *z, struct error *err) {
    const struct grid *cell = law->cell;
    const size_t modes = (cell->nx / 2 + 1) * cell->ny;
    double *root = array_create(modes, sizeof *root);
    if (root == NULL)
        return error_memory(err, modes * sizeof *root, "a surface that holds a patch");
    for (size_t m = 0; m < modes; m++)
        root[m] = sqrt(law->power[m] * (double)grid_points(cell));
    gaussian_fill(key, STREAM_EXTENSION, grid_points(cell), z);
    transform_filter(transform, root, 1, z, z);
    free(root);
    return 0;
}

int conditional_free_draw(const struct conditional_law *law, struct random_key key, double *z,
                          struct error *err) {
    const struct grid *cell = law->cell;
    struct transform *transform = NULL;
    int status = transform_create(&transform, cell, cell->nx / 2, cell->ny / 2, err);
    if (status == 0)
        status = draw_free(law, transform, key, z, err);
    transform_destroy(&transform);
    return status;
}

static int check(const struct conditional_law *law, const struct conditional_patch *patch,
                 struct conditional_report *report, struct error *err) {
    *report = (struct conditional_report){.points = 0};
    const size_t rows = grid_is_profile(law->cell) ? 1 : 2;
    if (law->cell->nx != 2 * patch->nx || law->cell->ny != rows * patch->ny)
        return error_set(err, ERROR_INPUT,
                         "a patch of %zu by %zu points in a cell of %zu by %zu; allowed: a cell of "
                         "twice the sides",
                         patch->nx, patch->ny, law->cell->nx, law->cell->ny);
    for (size_t p = 0; p < patch->nx * patch->ny; p++)
        report->points += isnan(patch->z[p]) ? 0 : 1;
    if (report->points == 0)
        return error_set(err, ERROR_INPUT, "the patch has no heights, only holes");
    if (!(law->noise > 0) || !isfinite(law->noise))
        return error_set(err, ERROR_INPUT,
                         "the noise of a patch has a mean square of %g; allowed: above 0",
                         law->noise);
    return 0;
}

/* Right side of the equations: the patch less a surface of the law with noise, without a trend. */
static void compare(struct equations *e, struct random_key key, const double *z) {
    const struct conditional_patch *patch = e->patch;
    const double deviation = sqrt(e->law->noise);
    gaussian_fill(key, STREAM_EXTENSION_NOISE, patch->nx * patch->ny, e->residual);
    for (size_t j = 0; j < patch->ny; j++)
        for (size_t i = 0; i < patch->nx; i++) {
            const size_t p = j * patch->nx + i;
            e->residual[p] = isnan(patch->z[p]) ? 0
                                                : patch->z[p] - z[j * e->law->cell->nx + i] -
                                                      deviation * e->residual[p];
        }
    take_out(e, e->terms, e->residual);
}

/* z += C A^T solution. */
static void add_correction(struct equations *e, double *z) {
    const struct grid *cell = e->law->cell;
    for (size_t p = 0; p < grid_points(cell); p++)
        e->mirrors[p] = 0;
    for (size_t j = 0; j < e->patch->ny; j++)
        for (size_t i = 0; i < e->patch->nx; i++)
            e->mirrors[j * cell->nx + i] = e->solution[j * e->patch->nx + i];
    transform_filter(e->transform, e->covariance, 1, e->mirrors, e->mirrors);
    for (size_t p = 0; p < grid_points(cell); p++)
        z[p] += e->mirrors[p];
}

static double difference_of(struct equations *e, const double *z, size_t points) {
    const size_t n = e->patch->nx * e->patch->ny;
    for (size_t p = 0; p < n; p++) {
        const double height = e->patch->z[p];
        const size_t j = p / e->patch->nx, i = p % e->patch->nx;
        e->image[p] = isnan(height) ? 0 : height - z[j * e->law->cell->nx + i];
    }
    take_out(e, e->terms, e->image);
    return sqrt(dot(e->image, e->image, n) / (double)points);
}

int conditional_draw(const struct conditional_law *law, const struct conditional_patch *patch,
                     struct random_key key, double *z, struct conditional_report *report,
                     struct error *err) {
    struct equations e;
    int status = check(law, patch, report, err);
    if (status == 0)
        status = equations_make(&e, law, patch, err);
    if (status != 0)
        return status;
    status = draw_free(law, e.transform, key, z, err);
    if (status == 0) {
        compare(&e, key, z);
        const size_t n = patch->nx * patch->ny;
        double *right = array_create(n, sizeof *right);
        if (right == NULL)
            status = error_memory(err, n * sizeof *right, "a surface that holds a patch");
        for (size_t p = 0; p < n && right != NULL; p++)
            right[p] = e.residual[p];
        if (status == 0)
            status = solve(&e, report, err);
        if (status == 0) {
            report->power = dot(right, e.solution, n) / (double)report->points - 1;
            add_correction(&e, z);
            report->difference = difference_of(&e, z, report->points);
            report->held = report->difference / sqrt(law->noise);
        }
        free(right);
    }
    equations_clear(&e);
    return status;
}
