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

enum {
    ROWS = TRANSFORM_ROWS, /* transformed by one plan where rows are short */
    GROUP = 2 * ROWS,      /* rows that go to columns, or come from them, together */
    LONG = 256,            /* points of a line from which FFTW plans one alone as well as many */
    SHARE = 16             /* columns of a part, for a thread */
};

/* Scratch of a thread. */
struct desk {
    double complex *rows; /* GROUP x half */
    double *lines;        /* GROUP x nx */
    double complex *line; /* ny: a single column between its two transforms */
};

struct transform {
    size_t nx, ny, columns; /* columns = mode_x + 1 */
    size_t mode_y;
    size_t half;  /* nx/2 + 1: values of one row's half spectrum */
    size_t batch; /* rows of a plan: 1 where they are long, else ROWS, or ny where that is less */
    size_t group; /* rows of a desk: GROUP, or ny where that is less than ROWS */
    double complex *spectrum;
    struct team *team; /* borrowed; NULL: this thread alone */
    size_t threads;    /* that have desks */
    struct desk *desks;
    fftw_plan column_inverse, column_forward; /* all columns, NULL where they are long */
    fftw_plan row_inverse, row_forward;
    fftw_plan one_inverse, one_forward; /* a single column */
};

static size_t least(size_t a, size_t b) {
    return a < b ? a : b;
}

/* Returns the rows of a desk. */
static size_t group_of(size_t ny) {
    return ny < ROWS ? ny : GROUP;
}

static size_t desk_bytes(const struct transform *t) {
    return (t->group * t->half + t->ny) * sizeof(double complex) +
           t->group * t->nx * sizeof(double);
}

/* Of tables and buffers of FFTW, for a point of the sides, where these have small factors. */
static const double PLAN_BYTES = 8;

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

static bool columns_plan(struct transform *t) {
    int ny = (int)t->ny, columns = (int)t->columns;
    double complex *line = t->desks->line, *all = t->spectrum;
    t->one_inverse =
        fftw_plan_dft_1d(ny, line, all, FFTW_BACKWARD, FFTW_ESTIMATE | FFTW_DESTROY_INPUT);
    t->one_forward =
        fftw_plan_dft_1d(ny, all, line, FFTW_FORWARD, FFTW_ESTIMATE | FFTW_DESTROY_INPUT);
    bool planned = t->one_inverse != NULL && t->one_forward != NULL;
    if (ny >= LONG)
        return planned;
    t->column_inverse = fftw_plan_many_dft(1, &ny, columns, all, NULL, 1, ny, all, NULL, 1, ny,
                                           FFTW_BACKWARD, FFTW_ESTIMATE);
    t->column_forward = fftw_plan_many_dft(1, &ny, columns, all, NULL, 1, ny, all, NULL, 1, ny,
                                           FFTW_FORWARD, FFTW_ESTIMATE);
    return planned && t->column_inverse != NULL && t->column_forward != NULL;
}

/* Under the lock of the planner. Returns false for want of memory. */
static bool plans_create(struct transform *t) {
    int nx = (int)t->nx, half = (int)t->half, batch = (int)t->batch;
    if (!has_memory(plan_bytes(t)) || (t->ny > 1 && !columns_plan(t)))
        return false;
    t->row_inverse = fftw_plan_many_dft_c2r(1, &nx, batch, t->desks->rows, NULL, 1, half,
                                            t->desks->lines, NULL, 1, nx, FFTW_ESTIMATE);
    t->row_forward =
        fftw_plan_many_dft_r2c(1, &nx, batch, t->desks->lines, NULL, 1, nx, t->desks->rows, NULL, 1,
                               half, FFTW_ESTIMATE | FFTW_DESTROY_INPUT);
    return t->row_inverse != NULL && t->row_forward != NULL;
}

double transform_bytes(const struct grid *grid, size_t mode_x) {
    const double nx = (double)grid->nx, ny = (double)grid->ny, group = (double)group_of(grid->ny);
    double desk = group * ((nx / 2 + 1) * sizeof(double complex) + nx * sizeof(double)) +
                  ny * sizeof(double complex);
    return (double)(mode_x + 1) * ny * sizeof(double complex) + desk + PLAN_BYTES * (nx + ny);
}

static bool desk_create(const struct transform *t, struct desk *out) {
    out->rows = fftw_alloc_complex(t->group * t->half);
    out->lines = fftw_alloc_real(t->group * t->nx);
    out->line = fftw_alloc_complex(t->ny);
    return out->rows != NULL && out->lines != NULL && out->line != NULL;
}

static void desk_clear(struct desk *desk) {
    fftw_free(desk->rows);
    fftw_free(desk->lines);
    fftw_free(desk->line);
}

/* Other threads' arrays wait, too: they would take what these plans were just promised. */
static bool parts_create(struct transform *t) {
    pthread_mutex_lock(&planner);
    t->spectrum = array_create(t->columns * t->ny, sizeof *t->spectrum);
    bool created = t->spectrum != NULL && desk_create(t, t->desks) && plans_create(t);
    pthread_mutex_unlock(&planner);
    return created;
}

size_t transform_fast_count(size_t n) {
    for (size_t candidate = n > 0 ? n + n % 2 : 2;; candidate += 2) {
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
    if (grid->nx > INT_MAX / (2 * GROUP) || grid->ny > INT_MAX / 2)
        return error_set(err, ERROR_INPUT, "a grid of %zu by %zu points has too long a side",
                         grid->nx, grid->ny);
    struct transform *t = array_create(1, sizeof *t);
    struct desk *desks = array_create(1, sizeof *desks);
    if (t == NULL || desks == NULL) {
        free(t);
        free(desks);
        return error_memory(err, sizeof *t, "a transform");
    }
    /* Rows of an odd length would not be aligned as the first one is. */
    bool alone = grid->nx >= LONG && grid->nx % 2 == 0;
    *t = (struct transform){.nx = grid->nx,
                            .ny = grid->ny,
                            .columns = mode_x + 1,
                            .mode_y = mode_y,
                            .half = grid->nx / 2 + 1,
                            .batch = alone ? 1 : least(grid->ny, ROWS),
                            .group = group_of(grid->ny),
                            .threads = 1,
                            .desks = desks};
    if (!parts_create(t)) {
        size_t bytes = t->columns * t->ny * sizeof *t->spectrum + desk_bytes(t) + plan_bytes(t);
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
    for (size_t n = 0; n < t->threads; n++)
        desk_clear(&t->desks[n]);
    free(t->desks);
    free(t->spectrum);
    free(t);
    *transform = NULL;
}

int transform_set_team(struct transform *t, struct team *team, struct error *err) {
    size_t threads = team_threads(team);
    struct desk *desks = array_create(threads, sizeof *desks);
    if (desks == NULL)
        return error_memory(err, threads * sizeof *desks, "a transform");
    for (size_t n = 1; n < threads; n++)
        if (!desk_create(t, &desks[n])) {
            for (; n > 0; n--)
                desk_clear(&desks[n]);
            free(desks);
            return error_memory(err, desk_bytes(t), "a transform");
        }
    for (size_t n = 1; n < t->threads; n++)
        desk_clear(&t->desks[n]);
    desks[0] = t->desks[0];
    free(t->desks);
    t->desks = desks;
    t->threads = threads;
    t->team = team;
    return 0;
}

double complex *transform_spectrum(struct transform *transform) {
    return transform->spectrum;
}

static double scale_of(const struct transform *t) {
    return 1 / ((double)t->nx * (double)t->ny);
}

/* --- lines of a group of rows, on one thread's desk --- */

/* Gathers the half spectra of rows j .. j + rows - 1, at most a group. */
static void rows_gather(const struct transform *t, const struct desk *desk, size_t j, size_t rows) {
    for (size_t row = 0; row < rows; row++)
        memset(desk->rows + row * t->half + t->columns, 0,
               (t->half - t->columns) * sizeof *desk->rows);
    for (size_t i = 0; i < t->columns; i++)
        for (size_t row = 0; row < rows; row++)
            desk->rows[row * t->half + i] = t->spectrum[i * t->ny + j + row];
}

static void rows_scatter(const struct transform *t, const struct desk *desk, size_t j, size_t rows,
                         double scale) {
    for (size_t i = 0; i < t->columns; i++)
        for (size_t row = 0; row < rows; row++)
            t->spectrum[i * t->ny + j + row] = scale * desk->rows[row * t->half + i];
}

/* Transforms a batch of the half spectra of a desk into lines, from this row on, or back. */
static void batch_inverse(const struct transform *t, const struct desk *desk, size_t row) {
    fftw_execute_dft_c2r(t->row_inverse, desk->rows + row * t->half, desk->lines + row * t->nx);
}
static void batch_forward(const struct transform *t, const struct desk *desk, size_t row) {
    fftw_execute_dft_r2c(t->row_forward, desk->lines + row * t->nx, desk->rows + row * t->half);
}

/* Computes the lines of rows j .. j + rows - 1, at most a group, from the spectrum. */
static void inverse_lines(const struct transform *t, const struct desk *desk, size_t j,
                          size_t rows) {
    rows_gather(t, desk, j, rows);
    for (size_t row = 0; row < rows; row += t->batch)
        batch_inverse(t, desk, row);
}

/* Transforms the lines as rows j .. j + rows - 1, at most a group, into the spectrum. */
static void forward_lines(const struct transform *t, const struct desk *desk, size_t j, size_t rows,
                          double scale) {
    for (size_t row = 0; row < rows; row += t->batch)
        batch_forward(t, desk, row);
    rows_scatter(t, desk, j, rows, scale);
}

/* --- rows and columns of a field, shared by the team --- */

/* Rows first .. first + count - 1 of the transform's grid, and the nx first points of them. */
struct field {
    struct transform *transform;
    size_t first, count, nx;
    const double *in;
    double *out;
    double scale;
    const double *symbol;
};

static void forward_rows(void *context, size_t first, size_t end, size_t thread) {
    const struct field *f = context;
    struct transform *t = f->transform;
    const struct desk *desk = &t->desks[thread];
    size_t rows = end - first;
    for (size_t row = 0; row < rows; row++) {
        memcpy(desk->lines + row * t->nx, f->in + (first + row) * f->nx, f->nx * sizeof *f->in);
        memset(desk->lines + row * t->nx + f->nx, 0, (t->nx - f->nx) * sizeof *f->in);
    }
    forward_lines(t, desk, f->first + first, rows, f->scale);
}

static void inverse_rows(void *context, size_t first, size_t end, size_t thread) {
    const struct field *f = context;
    struct transform *t = f->transform;
    const struct desk *desk = &t->desks[thread];
    size_t rows = end - first;
    inverse_lines(t, desk, f->first + first, rows);
    for (size_t row = 0; row < rows; row++)
        memcpy(f->out + (first + row) * f->nx, desk->lines + row * t->nx, f->nx * sizeof *f->out);
}

static void share_rows(const struct field *field, team_range_work *work) {
    struct field f = *field;
    team_share_ranges(f.transform->team, f.count, f.transform->group, work, &f);
}

static void columns_transform(struct transform *t, fftw_plan all, team_range_work *one) {
    if (t->ny == 1)
        return;
    if (all != NULL)
        fftw_execute(all);
    else
        team_share_ranges(t->team, t->columns, SHARE, one, t);
}

/* Transforms columns first .. end - 1. In place, FFTW would take a buffer from the heap for each of
 * them, of which the heap gives back the pages: half of the time of 2048 x 2048 points in free
 * space went into page faults. */
static void transform_columns(struct transform *t, size_t first, size_t end, size_t thread,
                              fftw_plan plan) {
    double complex *line = t->desks[thread].line;
    for (size_t i = first; i < end; i++) {
        double complex *column = t->spectrum + i * t->ny;
        memcpy(line, column, t->ny * sizeof *line);
        fftw_execute_dft(plan, line, column);
    }
}

static void inverse_columns(void *context, size_t first, size_t end, size_t thread) {
    struct transform *t = context;
    transform_columns(t, first, end, thread, t->one_inverse);
}

static void forward_columns(void *context, size_t first, size_t end, size_t thread) {
    struct transform *t = context;
    transform_columns(t, first, end, thread, t->one_forward);
}

void transform_inverse_columns(struct transform *t) {
    columns_transform(t, t->column_inverse, inverse_columns);
}

/* What becomes of columns between their transforms. */
struct changed {
    struct transform *transform;
    transform_change *change;
    const void *context;
};

static void change_columns(void *context, size_t first, size_t end, size_t thread) {
    const struct changed *c = context;
    const struct transform *t = c->transform;
    double complex *line = t->desks[thread].line;
    for (size_t i = first; i < end; i++) {
        double complex *column = t->spectrum + i * t->ny;
        fftw_execute_dft(t->one_forward, column, line);
        c->change(c->context, i, line);
        fftw_execute_dft(t->one_inverse, line, column);
    }
}

void transform_change_columns(struct transform *t, transform_change *change, const void *context) {
    struct changed changed = {t, change, context};
    if (t->ny > 1 && t->column_forward == NULL) {
        team_share_ranges(t->team, t->columns, SHARE, change_columns, &changed);
        return;
    }
    transform_forward_columns(t);
    for (size_t i = 0; i < t->columns; i++)
        change(context, i, t->spectrum + i * t->ny);
    transform_inverse_columns(t);
}

double *transform_inverse_strip(struct transform *t, size_t first, size_t count) {
    inverse_lines(t, t->desks, first, count);
    return t->desks->lines;
}

void transform_inverse_each(struct transform *t, transform_row *row, void *context) {
    const struct desk *desk = t->desks;
    for (size_t j = 0; j < t->ny; j += t->group) {
        size_t rows = least(t->ny - j, t->group);
        rows_gather(t, desk, j, rows);
        for (size_t r = 0; r < rows; r++) {
            if (r % t->batch == 0)
                batch_inverse(t, desk, r);
            row(context, j + r, desk->lines + r * t->nx);
        }
    }
}

void transform_forward_each(struct transform *t, transform_row *row, void *context) {
    const struct desk *desk = t->desks;
    for (size_t j = 0; j < t->ny; j += t->group) {
        size_t rows = least(t->ny - j, t->group);
        for (size_t r = 0; r < rows; r++) {
            row(context, j + r, desk->lines + r * t->nx);
            if ((r + 1) % t->batch == 0 || r + 1 == rows)
                batch_forward(t, desk, r - r % t->batch);
        }
        rows_scatter(t, desk, j, rows, scale_of(t));
    }
}

void transform_inverse_rows(struct transform *t, size_t first, size_t count, double *z) {
    share_rows(&(struct field){t, first, count, t->nx, .out = z}, inverse_rows);
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
        bool joined = my > 0 && 2 * my == to_ny && 2 * my < from_ny;
        double part = split ? factor / 2 : factor;
        to[my] = joined ? part * (from[my] + from[from_ny - my]) : part * from[my];
        if (my > 0 && 2 * my != to_ny)
            to[to_ny - my] = part * from[from_ny - my];
    }
}

/* Adds the mirror images of the waves of a Nyquist column, which are the same at its points. */
static void column_join(double complex *column, size_t ny) {
    for (size_t row = 0; 2 * row <= ny; row++) {
        const size_t mirror = row > 0 ? ny - row : 0;
        const double complex sum = column[row] + conj(column[mirror]);
        column[row] = sum;
        column[mirror] = conj(sum);
    }
}

void transform_pad(struct transform *from, struct transform *to) {
    for (size_t mx = 0; mx < from->columns; mx++) {
        bool split = mx > 0 && 2 * mx == from->nx && 2 * mx < to->nx;
        column_pad(from->spectrum + mx * from->ny, from->ny, to->spectrum + mx * to->ny, to->ny,
                   from->mode_y, split ? 0.5 : 1);
        if (mx > 0 && 2 * mx == to->nx && 2 * mx < from->nx)
            column_join(to->spectrum + mx * to->ny, to->ny);
    }
}

void transform_forward_rows(struct transform *t, size_t first, size_t count, const double *z) {
    share_rows(&(struct field){t, first, count, t->nx, .in = z, .scale = scale_of(t)},
               forward_rows);
}

void transform_forward_columns(struct transform *t) {
    columns_transform(t, t->column_forward, forward_columns);
}

void transform_forward(struct transform *t, const double *z) {
    transform_forward_rows(t, 0, t->ny, z);
    transform_forward_columns(t);
}

/* Multiplies columns by their symbol, in cache; rows from count on are 0 before. */
static void filter_columns(void *context, size_t first, size_t end, size_t thread) {
    const struct field *f = context;
    struct transform *t = f->transform;
    for (size_t i = first; i < end; i++) {
        double complex *column = t->spectrum + i * t->ny;
        memset(column + f->count, 0, (t->ny - f->count) * sizeof *column);
        double complex *line = t->ny > 1 ? t->desks[thread].line : column;
        if (t->ny > 1)
            fftw_execute_dft(t->one_forward, column, line);
        for (size_t row = 0; row < t->ny; row++)
            line[row] *= f->symbol[i * t->ny + row];
        if (t->ny > 1)
            fftw_execute_dft(t->one_inverse, line, column);
    }
}

void transform_filter_part(struct transform *t, const double *symbol, double factor, size_t nx,
                           size_t ny, const double *in, double *out) {
    struct field f = {t, 0, ny, nx, in, out, factor / ((double)t->nx * (double)t->ny), symbol};
    share_rows(&f, forward_rows);
    team_share_ranges(t->team, t->columns, SHARE, filter_columns, &f);
    share_rows(&f, inverse_rows);
}

void transform_filter(struct transform *t, const double *symbol, double factor, const double *in,
                      double *out) {
    transform_filter_part(t, symbol, factor, t->nx, t->ny, in, out);
}
