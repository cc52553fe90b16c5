#include "core/theory/sampled_field.h"
#include "core/sum.h"
#include "core/surface/translation/translation.h"
#include <math.h>
#include <stdlib.h>

/* Sines and cosines of half the phase between neighbours, of the waves along one side. */
struct half_phase {
    double sine, cosine;
};

static struct half_phase half_phase(double wave, size_t points) {
    double angle = M_PI * wave / (double)points;
    return (struct half_phase){sin(angle), cos(angle)};
}

/* Fills the contribution of a mode to the vectors, per unit of its amplitude: s is 2 sin^2 of half
 * the phase between the point and its neighbour, t the sine of that phase. */
static void mode_fill(struct half_phase x, struct half_phase y, size_t pairs, double *even,
                      double *odd) {
    struct half_phase up = {x.sine * y.cosine + x.cosine * y.sine,
                            x.cosine * y.cosine - x.sine * y.sine};
    struct half_phase down = {x.sine * y.cosine - x.cosine * y.sine,
                              x.cosine * y.cosine + x.sine * y.sine};
    const struct half_phase all[PAIRS_MOST] = {x, y, up, down};
    for (size_t a = 0; a < pairs; a++) {
        even[a] = 2 * all[a].sine * all[a].sine;
        odd[a] = 2 * all[a].sine * all[a].cosine;
    }
}

/* Sums of one column of modes, and of all columns. */
struct field_sums {
    double even[EVEN_MOST][EVEN_MOST], odd[PAIRS_MOST][PAIRS_MOST];
};
struct field_totals {
    struct sum even[EVEN_MOST][EVEN_MOST], odd[PAIRS_MOST][PAIRS_MOST];
};

static void sums_add(struct field_sums *sums, size_t pairs, double power, const double *even,
                     const double *odd) {
    for (size_t a = 0; a < pairs + 2; a++)
        for (size_t b = 0; b <= a; b++)
            sums->even[a][b] += power * even[a] * even[b];
    for (size_t a = 0; a < pairs; a++)
        for (size_t b = 0; b <= a; b++)
            sums->odd[a][b] += power * odd[a] * odd[b];
}

static void totals_add(struct field_totals *totals, const struct field_sums *sums, double weight) {
    for (size_t a = 0; a < EVEN_MOST; a++)
        for (size_t b = 0; b <= a; b++)
            sum_add(&totals->even[a][b], weight * sums->even[a][b]);
    for (size_t a = 0; a < PAIRS_MOST; a++)
        for (size_t b = 0; b <= a; b++)
            sum_add(&totals->odd[a][b], weight * sums->odd[a][b]);
}

static void column_add(const struct modes *modes, size_t mx, const struct half_phase *along_y,
                       size_t pairs, double curvature_unit, struct field_totals *totals) {
    const struct grid *grid = &modes->grid;
    struct half_phase x = half_phase((double)mx, grid->nx);
    long mode_y = (long)modes->mode_y;
    struct field_sums sums = {0};
    double even[EVEN_MOST], odd[PAIRS_MOST];
    bool profile = grid_is_profile(grid);
    double kx = 2 * M_PI * (double)mx / grid->lx;
    for (long my = -mode_y; my <= mode_y; my++) {
        double power = modes_power(modes, mx, my);
        if (power == 0)
            continue;
        double ky = profile ? 0 : 2 * M_PI * (double)my / grid->ly;
        mode_fill(x, along_y[my + mode_y], pairs, even, odd);
        even[pairs] = 1;
        even[pairs + 1] = (profile ? kx * kx : (kx * kx + ky * ky) / 2) * curvature_unit;
        sums_add(&sums, pairs, power, even, odd);
    }
    totals_add(totals, &sums, modes_weight(grid, mx));
}

static void totals_take(const struct field_totals *totals, double m0, struct sampled_field *out) {
    for (size_t a = 0; a < EVEN_MOST; a++)
        for (size_t b = 0; b <= a; b++)
            out->even[a][b] = out->even[b][a] = sum_value(&totals->even[a][b]) / m0;
    for (size_t a = 0; a < PAIRS_MOST; a++)
        for (size_t b = 0; b <= a; b++)
            out->odd[a][b] = out->odd[b][a] = sum_value(&totals->odd[a][b]) / m0;
}

int sampled_field_fill(const struct modes *modes, const struct moments *moments, size_t pairs,
                       struct sampled_field *out, struct error *err) {
    const struct grid *grid = &modes->grid;
    size_t rows = 2 * modes->mode_y + 1;
    struct half_phase *along_y = array_create(rows, sizeof *along_y);
    if (along_y == NULL)
        return error_memory(err, rows * sizeof *along_y, "phases of a spectrum");
    for (size_t row = 0; row < rows; row++)
        along_y[row] = half_phase((double)row - (double)modes->mode_y, grid->ny);
    double unit = sqrt(moments->m0 / moments->m4); /* of curvatures of heights in sqrt(m0) */
    struct field_totals totals = {0};
    for (size_t mx = 0; mx <= modes->mode_x; mx++)
        column_add(modes, mx, along_y, pairs, unit, &totals);
    free(along_y);
    *out = (struct sampled_field){.pairs = pairs};
    totals_take(&totals, moments->m0, out);
    out->bend[0] = (pairs == PAIRS_PROFILE ? 2 : 1) * unit / (grid_dx(grid) * grid_dx(grid));
    out->bend[1] = pairs == PAIRS_PROFILE ? 0 : unit / (grid_dy(grid) * grid_dy(grid));
    return 0;
}

/* --- moments --- */

/* Sums of squares of forward differences and of central second ones, and of fourth cumulants. */
struct moment_sums {
    struct sum power, slope_x, slope_y, bend_x, bend_y, both, cumulant;
};

static void moments_add(struct moment_sums *sums, double power, double weight, double x, double y,
                        bool single) {
    double weighted = power * weight;
    sum_add(&sums->power, weighted);
    sum_add(&sums->slope_x, weighted * x);
    sum_add(&sums->slope_y, weighted * y);
    sum_add(&sums->bend_x, weighted * x * x);
    sum_add(&sums->bend_y, weighted * y * y);
    sum_add(&sums->both, weighted * x * y);
    /* A wave A cos(phase), of two modes, has the variance A^2/2 = 2 P and the fourth cumulant
     * -3 A^4/8. A mode that is its own conjugate is A or -A, with the fourth cumulant -2 A^4. */
    sum_add(&sums->cumulant, (single ? 2 : 3) * weighted * power);
}

/* Fills the moments from the mean squares of differences, which are in the fields of a spectrum's
 * moments. */
static void moments_fill(const struct moments *m, bool profile, struct sampled_moments *out) {
    out->m2 = profile ? m->m20 : (m->m20 + m->m02) / 2;
    out->m4 = profile ? m->m40 : (m->m40 + m->m04) / 2;
    out->nayak_alpha = m->m00 / out->m2 * (out->m4 / out->m2);
    out->rms_slope = sqrt(m->m20 + m->m02);
    out->rms_curvature = profile ? sqrt(m->m40) : sqrt(m->m40 + 2 * m->m22 + m->m04) / 2;
    out->isotropy = profile ? (double)NAN : 3 * m->m22 / out->m4;
}

/* Of a translated surface, the share of the variance that its autocorrelation has lost at a lag of
 * so many points. */
static double decorrelation(const struct modes *modes, long i, long j) {
    const struct grid *grid = &modes->grid;
    long mode_y = (long)modes->mode_y;
    struct sum sum = {0}, all = {0};
    for (size_t mx = 0; mx <= modes->mode_x; mx++)
        for (long my = -mode_y; my <= mode_y; my++) {
            double power = modes_power(modes, mx, my) * modes_weight(grid, mx);
            double waves = (double)mx * (double)i / (double)grid->nx +
                           (double)my * (double)j / (double)grid->ny;
            sum_add(&all, power);
            sum_add(&sum, power * cos(2 * M_PI * waves));
        }
    return 1 - hermite_correlation(height_function_powers(translation_function(modes->translation)),
                                   sum_value(&sum) / sum_value(&all));
}

/* Mean squares of differences are sums of the autocorrelation at their lags. */
static void translated_moments(const struct modes *modes, struct sampled_moments *out) {
    const struct grid *grid = &modes->grid;
    bool profile = grid_is_profile(grid);
    double height = modes->height * modes->height;
    double dx = grid_dx(grid) * grid_dx(grid), dy = profile ? 1 : grid_dy(grid) * grid_dy(grid);
    double x = decorrelation(modes, 1, 0), y = profile ? 0 : decorrelation(modes, 0, 1);
    struct moments m = {.m00 = height, .m20 = 2 * height * x / dx, .m02 = 2 * height * y / dy};
    m.m40 = height * (8 * x - 2 * decorrelation(modes, 2, 0)) / (dx * dx);
    if (!profile) {
        double across = decorrelation(modes, 1, 1) + decorrelation(modes, 1, -1);
        m.m04 = height * (8 * y - 2 * decorrelation(modes, 0, 2)) / (dy * dy);
        m.m22 = height * (4 * x + 4 * y - 2 * across) / (dx * dy);
    }
    moments_fill(&m, profile, out);
    out->kurtosis = NAN;
}

void sampled_moments(const struct modes *modes, struct sampled_moments *out) {
    const struct grid *grid = &modes->grid;
    bool profile = grid_is_profile(grid);
    double dx = grid_dx(grid), dy = profile ? 1 : grid_dy(grid);
    long mode_y = (long)modes->mode_y;
    struct moment_sums sums = {0};
    if (modes->translation != NULL) {
        translated_moments(modes, out);
        return;
    }
    for (size_t mx = 0; mx <= modes->mode_x; mx++) {
        double x = 2 * half_phase((double)mx, grid->nx).sine / dx;
        for (long my = -mode_y; my <= mode_y; my++) {
            double power = modes_power(modes, mx, my);
            if (power == 0)
                continue;
            double y = profile ? 0 : 2 * half_phase((double)my, grid->ny).sine / dy;
            bool single =
                (mx == 0 || 2 * mx == grid->nx) && (my == 0 || 2 * (size_t)labs(my) == grid->ny);
            moments_add(&sums, power, modes_weight(grid, mx), x * x, y * y, single);
        }
    }
    const struct moments m = {.m00 = sum_value(&sums.power),
                              .m20 = sum_value(&sums.slope_x),
                              .m02 = sum_value(&sums.slope_y),
                              .m40 = sum_value(&sums.bend_x),
                              .m04 = sum_value(&sums.bend_y),
                              .m22 = sum_value(&sums.both)};
    moments_fill(&m, profile, out);
    out->kurtosis = 3 - sum_value(&sums.cumulant) / (m.m00 * m.m00);
}
