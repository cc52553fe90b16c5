#include "core/contact/solver/pyramid.h"
#include "core/vectors.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* With 1, plain means, conjugate gradients took 25 to 40 steps on sparse contact, with 0.35 7. */
static const double FALL = 0.35;

static size_t half_of(size_t n) {
    return (n + 1) / 2;
}

/* Counts the cells of all levels from 1 on. */
static size_t cells_above(const struct grid *grid) {
    size_t cells = 0;
    for (size_t nx = grid->nx, ny = grid->ny; nx > 1 || ny > 1;) {
        nx = half_of(nx);
        ny = half_of(ny);
        cells += nx * ny;
    }
    return cells;
}

static size_t doubles_of(const struct grid *grid) {
    return 2 * cells_above(grid);
}

static size_t line_size(size_t nx) {
    return nx + 4;
}

double pyramid_bytes(const struct grid *grid) {
    return sizeof(double) * (double)(doubles_of(grid) + line_size(grid->nx));
}

int pyramid_create(struct pyramid *out, const struct grid *grid, struct error *err) {
    *out = (struct pyramid){.memory = array_create(doubles_of(grid), sizeof(double)),
                            .lines = array_create(line_size(grid->nx), sizeof(double))};
    if (out->memory == NULL || out->lines == NULL) {
        pyramid_clear(out);
        return error_memory(err, pyramid_bytes(grid), "a contact");
    }
    double *next = out->memory;
    size_t nx = grid->nx, ny = grid->ny;
    out->levels[out->count++] = (struct pyramid_level){.nx = nx, .ny = ny};
    while (nx > 1 || ny > 1) {
        nx = half_of(nx);
        ny = half_of(ny);
        out->levels[out->count++] =
            (struct pyramid_level){.nx = nx, .ny = ny, .sum = next, .value = next + nx * ny};
        next += 2 * nx * ny;
    }
    return 0;
}

int pyramid_set_team(struct pyramid *pyramid, struct team *team, struct error *err) {
    size_t count = team_threads(team) * line_size(pyramid->levels[0].nx);
    double *lines = array_create(count, sizeof *lines);
    if (lines == NULL)
        return error_memory(err, count * sizeof *lines, "a contact");
    free(pyramid->lines);
    pyramid->lines = lines;
    pyramid->team = team;
    return 0;
}

void pyramid_clear(struct pyramid *pyramid) {
    free(pyramid->memory);
    free(pyramid->lines);
    *pyramid = (struct pyramid){0};
}

/* The weight of a cell, and the part of its value that a child gives, by the sum of its children's
 * weights. */
static inline double weight_of(double sum) {
    double weight = FALL * sum;
    return weight < 1 ? weight : 1;
}
static inline double share_of(double sum) {
    return FALL * sum < 1 ? FALL : 1 / sum;
}

/* --- work on the rows of a level, shared by the team --- */

/* A level's rows and those of the level above it. The nodes of the grid itself are r and x. */
struct stage {
    const struct pyramid *pyramid;
    const struct pyramid_level *fine, *coarse;
    const double *r; /* NULL but of the grid itself */
    const double *from;
    double *to;
    void (*row)(const struct stage *stage, size_t j, double *line);
};
enum { PART = 1 << 14 }; /* cells of a part, about */

static void stage_rows(void *context, size_t first, size_t end, size_t thread) {
    const struct stage *stage = context;
    double *line = stage->pyramid->lines + thread * line_size(stage->pyramid->levels[0].nx) + 1;
    for (size_t j = first; j < end; j++)
        stage->row(stage, j, line);
}

/* Works on so many rows of one of the levels l - 1 and l. The stage has r, from, to and row. */
static void share_rows(const struct pyramid *pyramid, size_t l, size_t rows, struct stage stage) {
    stage.pyramid = pyramid;
    stage.fine = &pyramid->levels[l - 1];
    stage.coarse = &pyramid->levels[l];
    team_share_ranges(pyramid->team, rows, PART / stage.fine->nx + 1, stage_rows, &stage);
}

/* --- upwards --- */

/* to[I] = the sum over the two rows a and b (NULL: one alone) of a cell's children. */
WIDE_VECTORS static void sum_rows(size_t nx, const double *a, const double *b, double *to) {
    size_t pairs = nx / 2;
    if (b != NULL)
        for (size_t i = 0; i < pairs; i++)
            to[i] = (a[2 * i] + a[2 * i + 1]) + (b[2 * i] + b[2 * i + 1]);
    else
        for (size_t i = 0; i < pairs; i++)
            to[i] = a[2 * i] + a[2 * i + 1];
    if (nx % 2 == 1)
        to[pairs] = a[nx - 1] + (b != NULL ? b[nx - 1] : 0);
}

/* Returns the second row of fine cells below a row of coarse ones; NULL where there is none. */
static const double *second_row(const struct stage *s, const double *from, size_t j) {
    return 2 * j + 1 < s->fine->ny ? from + (2 * j + 1) * s->fine->nx : NULL;
}

/* line = 1 for nodes of the set. */
WIDE_VECTORS static void mark(size_t nx, const double *r, double *line) {
    for (size_t i = 0; i < nx; i++)
        line[i] = r[i] != 0 ? 1 : 0;
}

WIDE_VECTORS static void to_weights(size_t nx, const double *sum, double *line) {
    for (size_t i = 0; i < nx; i++)
        line[i] = weight_of(sum[i]);
}

WIDE_VECTORS static void add_pairs(size_t nx, const double *from, double *to) {
    for (size_t i = 0; i < nx / 2; i++)
        to[i] += from[2 * i] + from[2 * i + 1];
    if (nx % 2 == 1)
        to[nx / 2] += from[nx - 1];
}

WIDE_VECTORS static void scale_by_share(size_t nx, const double *sum, double *value) {
    for (size_t i = 0; i < nx; i++)
        value[i] *= share_of(sum[i]);
}

static void weigh_row(const struct stage *s, size_t j, double *line) {
    const size_t nx = s->fine->nx;
    double *to = s->to + j * s->coarse->nx;
    void (*weigh)(size_t, const double *, double *) = s->r != NULL ? mark : to_weights;
    weigh(nx, s->from + 2 * j * nx, line);
    sum_rows(nx, line, NULL, to);
    if (2 * j + 1 < s->fine->ny) {
        weigh(nx, s->from + (2 * j + 1) * nx, line);
        add_pairs(nx, line, to);
    }
}

void pyramid_set(struct pyramid *pyramid, const double *r) {
    const struct pyramid_level *levels = pyramid->levels;
    for (size_t l = 1; l < pyramid->count; l++)
        share_rows(pyramid, l, levels[l].ny,
                   (struct stage){.r = l == 1 ? r : NULL,
                                  .from = l == 1 ? r : levels[l - 1].sum,
                                  .to = levels[l].sum,
                                  .row = weigh_row});
}

static void push_row(const struct stage *s, size_t j, double *line) {
    (void)line;
    const size_t nx = s->coarse->nx;
    double *to = s->to + j * nx;
    sum_rows(s->fine->nx, s->from + 2 * j * s->fine->nx, second_row(s, s->from, j), to);
    scale_by_share(nx, s->coarse->sum + j * nx, to);
}

/* --- downwards --- */

/* line[-1 .. n] = three quarters of a, a quarter of b, periodic. */
WIDE_VECTORS static void blend(size_t n, const double *a, const double *b, double *line) {
    for (size_t i = 0; i < n; i++)
        line[i] = 0.75 * a[i] + 0.25 * b[i];
    line[-1] = line[n - 1];
    line[n] = line[0];
}

/* out = r in the set, interpolated from the line elsewhere. */
WIDE_VECTORS static void fill_row(size_t nx, const double *line, const double *r, double *out) {
    const double *before = line - 1;
    for (size_t i = 0; i < nx / 2; i++) {
        double even = 0.75 * line[i] + 0.25 * before[i];
        double odd = 0.75 * line[i] + 0.25 * line[i + 1];
        out[2 * i] = r[2 * i] != 0 ? r[2 * i] : even;
        out[2 * i + 1] = r[2 * i + 1] != 0 ? r[2 * i + 1] : odd;
    }
    if (nx % 2 == 1)
        out[nx - 1] = r[nx - 1] != 0 ? r[nx - 1] : 0.75 * line[nx / 2] + 0.25 * before[nx / 2];
}

/* value += (1 - weight) times what is interpolated from the line. */
WIDE_VECTORS static void complete_row(size_t nx, const double *line, const double *sum,
                                      double *value) {
    const double *before = line - 1;
    for (size_t i = 0; i < nx / 2; i++) {
        double even = 0.75 * line[i] + 0.25 * before[i];
        double odd = 0.75 * line[i] + 0.25 * line[i + 1];
        value[2 * i] += (1 - weight_of(sum[2 * i])) * even;
        value[2 * i + 1] += (1 - weight_of(sum[2 * i + 1])) * odd;
    }
    if (nx % 2 == 1)
        value[nx - 1] +=
            (1 - weight_of(sum[nx - 1])) * (0.75 * line[nx / 2] + 0.25 * before[nx / 2]);
}

static void pull_row(const struct stage *s, size_t j, double *line) {
    const size_t nx = s->coarse->nx, last = s->coarse->ny - 1, near = j / 2;
    size_t far = j % 2 == 0 ? (near > 0 ? near - 1 : last) : (near < last ? near + 1 : 0);
    size_t row = j * s->fine->nx;
    blend(nx, s->from + near * nx, s->from + far * nx, line);
    if (s->r != NULL)
        fill_row(s->fine->nx, line, s->r + row, s->to + row);
    else
        complete_row(s->fine->nx, line, s->fine->sum + row, s->to + row);
}

void pyramid_continue(struct pyramid *pyramid, const double *r, double *out) {
    const struct pyramid_level *levels = pyramid->levels;
    out[0] = r[0]; /* all of a grid of one node, which has no level above */
    for (size_t l = 1; l < pyramid->count; l++)
        share_rows(pyramid, l, levels[l].ny,
                   (struct stage){.from = l == 1 ? r : levels[l - 1].value,
                                  .to = levels[l].value,
                                  .row = push_row});
    for (size_t l = pyramid->count - 1; l > 0; l--)
        share_rows(pyramid, l, levels[l - 1].ny,
                   (struct stage){.r = l == 1 ? r : NULL,
                                  .from = levels[l].value,
                                  .to = l == 1 ? out : levels[l - 1].value,
                                  .row = pull_row});
}

/* --- the transpose --- */

/* line += factor times x outside of the set. */
WIDE_VECTORS static void add_outside(size_t nx, double factor, const double *r, const double *x,
                                     double *line) {
    for (size_t i = 0; i < nx; i++)
        line[i] += r[i] != 0 ? 0 : factor * x[i];
}

/* line += factor (1 - weight) x. */
WIDE_VECTORS static void add_unknown(size_t nx, double factor, const double *sum, const double *x,
                                     double *line) {
    for (size_t i = 0; i < nx; i++)
        line[i] += factor * ((1 - weight_of(sum[i])) * x[i]);
}

/* Gives the values of a line to the nearest cells above. */
WIDE_VECTORS static void give_line(size_t nx, double *line, double *to) {
    size_t cells = half_of(nx);
    double first = line[0];
    line[-1] = nx % 2 == 0 ? line[nx - 1] : 0;
    line[nx] = 0;
    line[2 * cells] = first;
    for (size_t i = 0; i < cells; i++) {
        const double *at = line + 2 * i;
        to[i] = 0.75 * (at[0] + at[1]) + 0.25 * (at[-1] + at[2]);
    }
}

static void add_line(const struct stage *s, double factor, size_t j, double *line) {
    const size_t nx = s->fine->nx;
    if (j >= s->fine->ny)
        return;
    if (s->r != NULL)
        add_outside(nx, factor, s->r + j * nx, s->from + j * nx, line);
    else
        add_unknown(nx, factor, s->fine->sum + j * nx, s->from + j * nx, line);
}

/* A transpose of pull_row: row j of coarse cells is nearest to two rows of fine ones, and second
 * nearest to the rows beside these. */
static void return_row(const struct stage *s, size_t j, double *line) {
    const size_t last = s->coarse->ny - 1;
    memset(line, 0, s->fine->nx * sizeof *line);
    add_line(s, 0.75, 2 * j, line);
    add_line(s, 0.75, 2 * j + 1, line);
    add_line(s, 0.25, 2 * (j > 0 ? j - 1 : last) + 1, line);
    add_line(s, 0.25, j < last ? 2 * j + 2 : 0, line);
    give_line(s->fine->nx, line, s->to + j * s->coarse->nx);
}

/* Adds to each child its cell's value. */
WIDE_VECTORS static void spread(size_t nx, const double *cells, double *value) {
    for (size_t i = 0; i < nx / 2; i++) {
        value[2 * i] += cells[i];
        value[2 * i + 1] += cells[i];
    }
    if (nx % 2 == 1)
        value[nx - 1] += cells[nx / 2];
}

/* A transpose of push_row, for a row of coarse cells. */
static void spread_row(const struct stage *s, size_t j, double *line) {
    const size_t nx = s->fine->nx, above = s->coarse->nx;
    memcpy(line, s->from + j * above, above * sizeof *line);
    scale_by_share(above, s->coarse->sum + j * above, line);
    spread(nx, line, s->to + 2 * j * nx);
    if (2 * j + 1 < s->fine->ny)
        spread(nx, line, s->to + (2 * j + 1) * nx);
}

void pyramid_transpose(struct pyramid *pyramid, const double *r, double *x) {
    const struct pyramid_level *levels = pyramid->levels;
    for (size_t l = 1; l < pyramid->count; l++)
        share_rows(pyramid, l, levels[l].ny,
                   (struct stage){.r = l == 1 ? r : NULL,
                                  .from = l == 1 ? x : levels[l - 1].value,
                                  .to = levels[l].value,
                                  .row = return_row});
    for (size_t l = pyramid->count - 1; l > 0; l--)
        share_rows(pyramid, l, levels[l].ny,
                   (struct stage){.from = levels[l].value,
                                  .to = l == 1 ? x : levels[l - 1].value,
                                  .row = spread_row});
}
