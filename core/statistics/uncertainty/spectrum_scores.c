#include "core/statistics/uncertainty/spectrum_scores.h"
#include "core/statistics/heights/roughness.h"
#include "core/statistics/spectra/spectrum_range.h"
#include "core/statistics/spectra/windowed_psd.h"
#include "core/surface/transform.h"
#include <stdlib.h>

/* The cell that repeats: of an open map with its mirror images. */
static struct grid repeated_cell(const struct measured_map *map) {
    struct grid cell = *map->grid;
    if (map->boundary != BOUNDARY_OPEN)
        return cell;
    cell.nx *= 2;
    cell.lx *= 2;
    if (!grid_is_profile(&cell)) {
        cell.ny *= 2;
        cell.ly *= 2;
    }
    return cell;
}

static size_t mirrored(size_t i, size_t n) {
    return i < n ? i : 2 * n - 1 - i;
}

enum { CHANGES = 2 }; /* of scale and of slope */
typedef double change_matrix[CHANGES][CHANGES];

/* What the parts of a computation share. */
struct scores {
    const struct law_problem *problem;
    const struct law *law;
    const struct measured_map *map;
    const struct low_modes *modes;
    struct grid cell;
    struct transform *transform;    /* owned, as the arrays */
    double *heights;                /* of the map about their mean; 0 in holes */
    double *field, *filtered;       /* of the cell */
    double *symbol;                 /* a value a wave */
    double (*sums)[LOW_CELLS_MOST]; /* by change */
    double count;                   /* of heights */
};

static void heights_fill(struct scores *s) {
    const size_t points = grid_points(s->map->grid);
    struct average mean = {0};
    for (size_t point = 0; point < points; point++)
        average_add(&mean, s->map->z[point]);
    for (size_t point = 0; point < points; point++)
        s->heights[point] = isnan(s->map->z[point]) ? 0 : s->map->z[point] - average_value(&mean);
    s->count = (double)mean.count;
}

/* Returns how the logarithm of the density of ring number r of the problem changes, as far as it
 * does with the amplitude. */
static double change_at(const struct scores *s, size_t change, size_t r) {
    const struct law_problem *p = s->problem;
    const double ring = (double)(p->leakage->first + r);
    const double governed = p->slope[LAW_AMPLITUDE * p->rings + r];
    if (s->law->free[LAW_SHORT] && ring > exp(s->law->p[LAW_SHORT]) - SPECTRUM_BLURRED)
        return 0;
    return governed * (change == 0 ? 1 : log(ring) - p->reference_logarithm);
}

/* Returns what the likelihood's gradient along a change weighs the density of a ring by. */
static double weight_at(const struct scores *s, size_t change, size_t ring) {
    const struct law_problem *p = s->problem;
    const size_t first = p->leakage->first, count = p->leakage->count;
    if (ring < first || ring >= first + count)
        return 0;
    const size_t r = ring - first;
    const double unit = 2 * M_PI / p->spectrum->side;
    const double area = p->dimension == 1
                            ? 2 * unit
                            : 2 * M_PI * (double)ring * unit * unit / p->spectrum->lay.ratio;
    return change_at(s, change, r) * p->freedom[r] / (2 * p->expected[r] * area);
}

static void symbol_fill(struct scores *s, size_t change) {
    const struct map_spectrum *spectrum = s->problem->spectrum;
    const struct grid *cell = &s->cell;
    const bool profile = grid_is_profile(cell);
    const double x = spectrum->side / cell->lx, y = profile ? 0 : spectrum->side / cell->ly;
    double *out = s->symbol;
    for (size_t mx = 0; mx <= cell->nx / 2; mx++)
        for (size_t row = 0; row < cell->ny; row++) {
            const double my = row <= cell->ny / 2 ? (double)row : (double)row - (double)cell->ny;
            const double length =
                profile ? (double)mx * x : lay_length(&spectrum->frame, (double)mx * x, my * y);
            *out++ = weight_at(s, change, (size_t)(length + 0.5));
        }
}

/* Sums the product of heights and filtered heights in cells, about its mean. */
static void sums_fill(struct scores *s, double sums[LOW_CELLS_MOST]) {
    const struct grid *grid = s->map->grid;
    const size_t nx = grid->nx, cells = s->modes->cells_x * s->modes->cells_y;
    double counts[LOW_CELLS_MOST] = {0}, total = 0;
    for (size_t j = 0; j < s->cell.ny; j++)
        for (size_t i = 0; i < s->cell.nx; i++)
            s->field[j * s->cell.nx + i] = s->heights[mirrored(j, grid->ny) * nx + mirrored(i, nx)];
    transform_filter(s->transform, s->symbol, 1, s->field, s->filtered);
    for (size_t cell = 0; cell < cells; cell++)
        sums[cell] = 0;
    for (size_t j = 0; j < grid->ny; j++)
        for (size_t i = 0; i < nx; i++) {
            const size_t cell = cell_of(j, s->modes->cells_y, grid->ny) * s->modes->cells_x +
                                cell_of(i, s->modes->cells_x, nx);
            const double product = s->heights[j * nx + i] * s->filtered[j * s->cell.nx + i];
            sums[cell] += product;
            total += product;
            counts[cell] += isnan(s->map->z[j * nx + i]) ? 0 : 1;
        }
    for (size_t cell = 0; cell < cells; cell++)
        sums[cell] = (sums[cell] - total * counts[cell] / s->count) / s->count;
}

/* The covariance of the gradient by the slow waves of the map. */
static void by_map_fill(const struct scores *s, change_matrix out) {
    const double along = s->problem->spectrum->windowed ? WINDOWED_ALIKE : 1;
    const double alike = s->problem->dimension == 1 ? along : along * along;
    const double share = s->modes->excess[2] * alike / (double)s->modes->count;
    for (size_t m = 0; m < s->modes->count; m++)
        for (size_t a = 0; a < CHANGES; a++)
            for (size_t b = 0; b < CHANGES; b++)
                out[a][b] += share * low_mode_amplitude(s->modes, m, s->sums[a]) *
                             low_mode_amplitude(s->modes, m, s->sums[b]);
}

/* That of a Gaussian surface, and Fisher's information. */
static void gaussian_fill(const struct scores *s, change_matrix out, change_matrix information) {
    const struct law_problem *p = s->problem;
    const size_t count = p->leakage->count;
    for (size_t r = 0; r < count; r++)
        for (size_t a = 0; a < CHANGES; a++)
            for (size_t b = 0; b < CHANGES; b++) {
                information[a][b] += change_at(s, a, r) * change_at(s, b, r) * p->freedom[r] / 2;
                for (size_t q = r; q < count && q < r + RING_REACH; q++) {
                    const double both = change_at(s, a, r) * change_at(s, b, q) +
                                        (q > r ? change_at(s, a, q) * change_at(s, b, r) : 0);
                    out[a][b] += both * p->spectrum->covariance[p->leakage->first + r][q - r] *
                                 p->freedom[r] * p->freedom[q] / 4;
                }
            }
}

/* Fills the excess of the changes that are most likely; none where it is not positive. */
static void scatter_fill(const struct scores *s, struct spectrum_scatter *out) {
    change_matrix by_map = {{0}}, gaussian = {{0}}, information = {{0}}, excess = {{0}};
    by_map_fill(s, by_map);
    gaussian_fill(s, gaussian, information);
    const double determinant =
        information[0][0] * information[1][1] - information[0][1] * information[1][0];
    const change_matrix inverse = {
        {information[1][1] / determinant, -information[0][1] / determinant},
        {-information[1][0] / determinant, information[0][0] / determinant}};
    for (size_t a = 0; a < CHANGES; a++)
        for (size_t b = 0; b < CHANGES; b++)
            for (size_t c = 0; c < CHANGES; c++)
                for (size_t d = 0; d < CHANGES; d++)
                    excess[a][b] += inverse[a][c] * (by_map[c][d] - gaussian[c][d]) * inverse[d][b];
    out->density = fmax(excess[0][0], 0);
    out->slope = fmax(excess[1][1], 0);
    const double most = sqrt(out->density * out->slope);
    out->both = fmin(fmax(excess[0][1], -most), most);
}

int spectrum_scatter_measure(const struct law_problem *problem, const struct law *law,
                             const struct measured_map *map, const struct low_modes *modes,
                             struct spectrum_scatter *out, struct error *err) {
    struct scores s = {
        .problem = problem, .law = law, .map = map, .modes = modes, .cell = repeated_cell(map)};
    const size_t points = grid_points(map->grid), all = grid_points(&s.cell);
    const size_t waves = (s.cell.nx / 2 + 1) * s.cell.ny;
    *out = (struct spectrum_scatter){0};
    s.heights = array_create(points + 2 * all + waves, sizeof *s.heights);
    s.sums = array_create(CHANGES, sizeof *s.sums);
    int status = s.heights != NULL && s.sums != NULL
                     ? transform_create(&s.transform, &s.cell, s.cell.nx / 2, s.cell.ny / 2, err)
                     : error_memory(err, (points + 2 * all + waves) * sizeof *s.heights,
                                    "the scatter of a spectrum");
    if (status == 0) {
        s.field = s.heights + points;
        s.filtered = s.field + all;
        s.symbol = s.filtered + all;
        heights_fill(&s);
        for (size_t change = 0; change < CHANGES; change++) {
            symbol_fill(&s, change);
            sums_fill(&s, s.sums[change]);
        }
        scatter_fill(&s, out);
    }
    transform_destroy(&s.transform);
    free(s.heights);
    free(s.sums);
    return status;
}
