#include "core/surface/transform.h"
#include <fftw3.h>
#include <limits.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

/* FFTW's planner is its only part that is not safe from many threads. */
static pthread_mutex_t planner = PTHREAD_MUTEX_INITIALIZER;

enum { ROWS = TRANSFORM_ROWS }; /* a cache line of each column serves four of them */

struct transform {
    size_t nx, ny, columns; /* columns = mode_x + 1 */
    size_t mode_y;
    size_t half;  /* nx/2 + 1: values of one row's half spectrum */
    size_t batch; /* rows transformed together: ROWS, or ny where that is less */
    double complex *spectrum;
    double complex *rows; /* batch x half */
    double *lines;        /* batch x nx */
    double complex *line; /* ny: a single column between its two transforms */
    fftw_plan column_inverse, column_forward, row_inverse, row_forward;
    fftw_plan one_inverse, one_forward; /* a single column */
};

/* FFTW aborts the process where it runs out of memory in a plan. Its tables, and its buffers
 * as it transforms, took up to 193 bytes a point of the sides (a prime of 10^6) and 1 MB. */
static size_t plan_bytes(const struct transform *t) {
    return ((size_t)4 << 20) + 256 * (t->nx + t->ny);
}

/* FFTW makes thousands of small parts with its first plan of a process, each of which takes a page
 * where a heap cannot grow any more. Returns whether the system would give them. */
static bool has_memory_for_planner(void) {
    enum { PARTS = 4096, PART = 64 };
    void *parts[PARTS];
    size_t count = 0;
    while (count < PARTS && (parts[count] = malloc(PART)) != NULL)
        count++;
    for (size_t n = count; n > 0; n--)
        free(parts[n - 1]);
    return count == PARTS;
}

/* Returns whether the system would give what plans need; threads that do not plan may still take it
 * in between. The tables are asked for without malloc, whose thresholds a large array would move.
 */
static bool has_memory(size_t bytes) {
    static bool has_planner; /* under its lock */
    void *pages = mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (pages == MAP_FAILED)
        return false;
    has_planner = has_planner || has_memory_for_planner();
    return munmap(pages, bytes) == 0 && has_planner;
}

/* Under the lock of the planner. Returns false for want of memory. */
static bool plans_create(struct transform *t) {
    int nx = (int)t->nx, ny = (int)t->ny, half = (int)t->half, batch = (int)t->batch;
    if (!has_memory(plan_bytes(t)))
        return false;
    if (t->ny > 1) {
        int columns = (int)t->columns;
        t->column_inverse =
            fftw_plan_many_dft(1, &ny, columns, t->spectrum, NULL, 1, ny, t->spectrum, NULL, 1, ny,
                               FFTW_BACKWARD, FFTW_ESTIMATE);
        t->column_forward =
            fftw_plan_many_dft(1, &ny, columns, t->spectrum, NULL, 1, ny, t->spectrum, NULL, 1, ny,
                               FFTW_FORWARD, FFTW_ESTIMATE);
        t->one_inverse = fftw_plan_dft_1d(ny, t->line, t->spectrum, FFTW_BACKWARD,
                                          FFTW_ESTIMATE | FFTW_DESTROY_INPUT);
        t->one_forward = fftw_plan_dft_1d(ny, t->spectrum, t->line, FFTW_FORWARD,
                                          FFTW_ESTIMATE | FFTW_DESTROY_INPUT);
    }
    t->row_inverse = fftw_plan_many_dft_c2r(1, &nx, batch, t->rows, NULL, 1, half, t->lines, NULL,
                                            1, nx, FFTW_ESTIMATE);
    t->row_forward = fftw_plan_many_dft_r2c(1, &nx, batch, t->lines, NULL, 1, nx, t->rows, NULL, 1,
                                            half, FFTW_ESTIMATE | FFTW_DESTROY_INPUT);
    return t->row_inverse != NULL && t->row_forward != NULL &&
           (t->ny == 1 || (t->column_inverse != NULL && t->column_forward != NULL &&
                           t->one_inverse != NULL && t->one_forward != NULL));
}

/* Other threads' arrays wait, too: they would take what these plans were just promised. */
static bool parts_create(struct transform *t) {
    pthread_mutex_lock(&planner);
    t->spectrum = fftw_alloc_complex(t->columns * t->ny);
    t->rows = fftw_alloc_complex(t->batch * t->half);
    t->lines = fftw_alloc_real(t->batch * t->nx);
    t->line = fftw_alloc_complex(t->ny);
    bool created = t->spectrum != NULL && t->rows != NULL && t->lines != NULL && t->line != NULL &&
                   plans_create(t);
    pthread_mutex_unlock(&planner);
    return created;
}

size_t transform_fast_count(size_t n) {
    for (size_t candidate = n + n % 2;; candidate += 2) {
        size_t rest = candidate;
        for (size_t factor = 2; factor <= 5; factor++)
            while (rest % factor == 0)
                rest /= factor;
        if (rest == 1)
            return candidate;
    }
}

int transform_create(struct transform **out, const struct grid *grid, size_t mode_x, size_t mode_y,
                     struct error *err) {
    if (grid_check(grid, err) != 0)
        return err != NULL ? err->code : ERROR_INPUT;
    if (mode_x > grid->nx / 2 || mode_y > grid->ny / 2)
        return error_set(
            err, ERROR_INPUT,
            "a band of %zu by %zu waves on a grid of %zu by %zu points; allowed: up to "
            "half the points",
            mode_x, mode_y, grid->nx, grid->ny);
    if (grid->nx > INT_MAX / (2 * ROWS) || grid->ny > INT_MAX / 2)
        return error_set(err, ERROR_INPUT, "a grid of %zu by %zu points has too long a side",
                         grid->nx, grid->ny);
    struct transform *t = array_create(1, sizeof *t);
    if (t == NULL)
        return error_memory(err, sizeof *t, "a transform");
    t->nx = grid->nx;
    t->ny = grid->ny;
    t->columns = mode_x + 1;
    t->mode_y = mode_y;
    t->half = grid->nx / 2 + 1;
    t->batch = t->ny < ROWS ? t->ny : ROWS;
    if (!parts_create(t)) {
        size_t bytes = ((t->columns + 1) * t->ny + t->batch * t->half) * sizeof *t->spectrum +
                       t->batch * t->nx * sizeof *t->lines + plan_bytes(t);
        transform_destroy(&t);
        return error_memory(err, bytes, "a transform");
    }
    *out = t;
    return 0;
}

void transform_destroy(struct transform **transform) {
    struct transform *t = *transform;
    if (t == NULL)
        return;
    pthread_mutex_lock(&planner);
    fftw_plan plans[] = {t->column_inverse, t->column_forward, t->row_inverse,
                         t->row_forward,    t->one_inverse,    t->one_forward};
    for (size_t p = 0; p < sizeof plans / sizeof *plans; p++)
        if (plans[p] != NULL)
            fftw_destroy_plan(plans[p]);
    pthread_mutex_unlock(&planner);
    fftw_free(t->spectrum);
    fftw_free(t->rows);
    fftw_free(t->lines);
    fftw_free(t->line);
    free(t);
    *transform = NULL;
}

double complex *transform_spectrum(struct transform *transform) {
    return transform->spectrum;
}

void transform_inverse_columns(struct transform *t) {
    if (t->ny > 1)
        fftw_execute(t->column_inverse);
}

/* Computes the lines of rows j .. j + rows - 1, at most ROWS of them, from the spectrum. */
static void inverse_lines(struct transform *t, size_t j, size_t rows) {
    for (size_t row = 0; row < t->batch; row++)
        memset(t->rows + row * t->half + t->columns, 0, (t->half - t->columns) * sizeof *t->rows);
    for (size_t i = 0; i < t->columns; i++)
        for (size_t row = 0; row < rows; row++)
            t->rows[row * t->half + i] = t->spectrum[i * t->ny + j + row];
    fftw_execute(t->row_inverse);
}

double *transform_inverse_strip(struct transform *t, size_t first, size_t count) {
    inverse_lines(t, first, count);
    return t->lines;
}

void transform_inverse_rows(struct transform *t, size_t first, size_t count, double *z) {
    for (size_t j = first; j < first + count; j += ROWS) {
        size_t rows = first + count - j < ROWS ? first + count - j : ROWS;
        inverse_lines(t, j, rows);
        memcpy(z + (j - first) * t->nx, t->lines, rows * t->nx * sizeof *z);
    }
}

void transform_inverse(struct transform *t, double *z) {
    transform_inverse_columns(t);
    transform_inverse_rows(t, 0, t->ny, z);
}

static void column_pad(const double complex *from, size_t from_ny, double complex *to, size_t to_ny,
                       size_t mode_y, double factor) {
    memset(to, 0, to_ny * sizeof *to);
    for (size_t my = 0; my <= mode_y; my++) {
        bool split = my > 0 && 2 * my == from_ny && 2 * my < to_ny;
        double part = split ? factor / 2 : factor;
        to[my] = part * from[my];
        if (my > 0 && 2 * my != to_ny)
            to[to_ny - my] = part * from[from_ny - my];
    }
}

void transform_pad(struct transform *from, struct transform *to) {
    for (size_t mx = 0; mx < from->columns; mx++) {
        bool split = mx > 0 && 2 * mx == from->nx && 2 * mx < to->nx;
        column_pad(from->spectrum + mx * from->ny, from->ny, to->spectrum + mx * to->ny, to->ny,
                   from->mode_y, split ? 0.5 : 1);
    }
}

/* Transforms the lines as rows j .. j + rows - 1, at most ROWS of them, into the spectrum. */
static void forward_lines(struct transform *t, size_t j, size_t rows, double scale) {
    fftw_execute(t->row_forward);
    for (size_t i = 0; i < t->columns; i++)
        for (size_t row = 0; row < rows; row++)
            t->spectrum[i * t->ny + j + row] = scale * t->rows[row * t->half + i];
}

static void forward_rows(struct transform *t, size_t first, size_t count, const double *z,
                         double scale) {
    for (size_t j = first; j < first + count; j += ROWS) {
        size_t rows = first + count - j < ROWS ? first + count - j : ROWS;
        memcpy(t->lines, z + (j - first) * t->nx, rows * t->nx * sizeof *z);
        forward_lines(t, j, rows, scale);
    }
}

void transform_forward_rows(struct transform *t, size_t first, size_t count, const double *z) {
    forward_rows(t, first, count, z, 1 / ((double)t->nx * (double)t->ny));
}

void transform_forward_columns(struct transform *t) {
    if (t->ny > 1)
        fftw_execute(t->column_forward);
}

void transform_forward(struct transform *t, const double *z) {
    transform_forward_rows(t, 0, t->ny, z);
    transform_forward_columns(t);
}

/* Multiplies each column by its symbol, in cache; rows from ny on are 0 before. In place FFTW would
 * take a buffer from the heap for each transform of a long column, of which the heap gives back the
 * pages: half of the time of 2048 x 2048 points in free space went into page faults. */
static void filter_columns(struct transform *t, const double *symbol, size_t ny) {
    for (size_t i = 0; i < t->columns; i++) {
        double complex *column = t->spectrum + i * t->ny;
        memset(column + ny, 0, (t->ny - ny) * sizeof *column);
        double complex *line = t->ny > 1 ? t->line : column;
        if (t->ny > 1)
            fftw_execute_dft(t->one_forward, column, line);
        for (size_t row = 0; row < t->ny; row++)
            line[row] *= symbol[i * t->ny + row];
        if (t->ny > 1)
            fftw_execute_dft(t->one_inverse, line, column);
    }
}

void transform_filter(struct transform *t, const double *symbol, double factor, const double *in,
                      double *out) {
    forward_rows(t, 0, t->ny, in, factor / ((double)t->nx * (double)t->ny));
    filter_columns(t, symbol, t->ny);
    transform_inverse_rows(t, 0, t->ny, out);
}

void transform_filter_part(struct transform *t, const double *symbol, double factor, size_t nx,
                           size_t ny, const double *in, double *out) {
    double scale = factor / ((double)t->nx * (double)t->ny);
    for (size_t j = 0; j < ny; j += ROWS) {
        size_t rows = ny - j < ROWS ? ny - j : ROWS;
        memset(t->lines, 0, t->batch * t->nx * sizeof *t->lines);
        for (size_t row = 0; row < rows; row++)
            memcpy(t->lines + row * t->nx, in + (j + row) * nx, nx * sizeof *in);
        forward_lines(t, j, rows, scale);
    }
    filter_columns(t, symbol, ny);
    for (size_t j = 0; j < ny; j += ROWS) {
        size_t rows = ny - j < ROWS ? ny - j : ROWS;
        inverse_lines(t, j, rows);
        for (size_t row = 0; row < rows; row++)
            memcpy(out + (j + row) * nx, t->lines + row * t->nx, nx * sizeof *out);
    }
}
