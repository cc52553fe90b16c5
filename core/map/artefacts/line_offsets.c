#include "core/map/artefacts/line_offsets.h"
#include "core/statistics/heights/roughness.h"
#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stdlib.h>

/* WAVES: along a line, to which the mean of a line is compared, each as a cosine and a sine. */
enum { WAVES = 4, SERIES = 1 + 2 * WAVES, LINES_LEAST = 32, POINTS_LEAST = 16 };

/* The lines of a map. */
struct lines {
    const double *z;
    size_t count, points, across, along; /* strides between lines, and between points */
};

static struct lines lines_of(const struct grid *grid, const double *z, enum scan_axis along) {
    return along == SCAN_ALONG_X ? (struct lines){z, grid->ny, grid->nx, grid->nx, 1}
                                 : (struct lines){z, grid->nx, grid->ny, 1, grid->nx};
}

/* Fills the waves of all series at each point, of mean square 1. */
static void waves_fill(const struct lines *lines, double *wave) {
    for (size_t i = 0; i < lines->points; i++) {
        double *at = wave + i * SERIES;
        at[0] = 1;
        for (int m = 1; m <= WAVES; m++) {
            const double phase = 2 * M_PI * m * ((double)i + 0.5) / (double)lines->points;
            at[2 * m - 1] = M_SQRT2 * cos(phase);
            at[2 * m] = M_SQRT2 * sin(phase);
        }
    }
}

/* Fills series[s*n + l] with the means over a line of differences across the lines, times each
 * wave: of the first ones, n = count - 1, or of the second ones, n = count - 2. */
static void series_fill(const struct lines *lines, const double *wave, int order, double *series) {
    const size_t n = lines->count - (size_t)order;
    for (size_t l = 0; l < n; l++) {
        const double *at = lines->z + (l + (size_t)order - 1) * lines->across;
        double total[SERIES] = {0};
        size_t count = 0;
        for (size_t i = 0; i < lines->points; i++, at += lines->along) {
            const double value =
                order == 1 ? at[lines->across] - at[0] : second_difference(at, lines->across);
            if (isnan(value))
                continue;
            count++;
            for (int s = 0; s < SERIES; s++)
                total[s] += wave[i * SERIES + (size_t)s] * value;
        }
        for (int s = 0; s < SERIES; s++)
            series[(size_t)s * n + l] = count > 0 ? total[s] / (double)count : 0;
    }
}

/* Returns the mean square of a series of n about its means over REACH values on either side. */
static double square_about(const double *series, size_t n) {
    enum { REACH = 4 };
    double square = 0;
    for (size_t l = 0; l < n; l++) {
        const size_t first = l > REACH ? l - REACH : 0, last = l + REACH < n ? l + REACH : n - 1;
        double total = 0;
        for (size_t k = first; k <= last; k++)
            total += series[k];
        square += pow(series[l] - total / (double)(last - first + 1), 2) / (double)n;
    }
    return square;
}

/* Returns by how much the mean square of the means of first differences is above that of the other
 * series, without what changes slowly from line to line. */
static double first_excess(const double *series, size_t n) {
    double excess = square_about(series, n);
    for (size_t s = 1; s < SERIES; s++)
        excess -= square_about(series + s * n, n) / (SERIES - 1);
    return fmax(excess, 0);
}

/* Returns the mean square that waves from mode `first` on have in a series. */
static double short_square(const struct modes *modes, double mean_square, size_t first) {
    double all = 0, part = 0;
    for (size_t m = 1; m <= modes->mode_x; m++) {
        all += modes->power[m];
        part += m >= first ? modes->power[m] : 0;
    }
    return all > 0 ? mean_square * (part / all) : 0;
}

/* Puts Hann's window over a series of n; returns the mean square that it had under it. */
static double window_apply(double *series, size_t n) {
    double total = 0, weights = 0;
    for (size_t l = 0; l < n; l++) {
        const double root = sin(M_PI * ((double)l + 0.5) / (double)n), weight = root * root;
        series[l] *= weight;
        total += series[l] * series[l];
        weights += weight * weight;
    }
    return total / weights;
}

/* Mean squares of the mean of lines and of the other series, in short waves, and the degrees of
 * freedom of the first. */
struct compared {
    double mean, other, freedom;
};

static int compare(double *series, size_t n, struct compared *out, struct error *err) {
    const struct grid line = {n, 1, (double)n, 1};
    const size_t first = n / 4 + 1, last = n / 2;
    double *density = array_create(last + 1, sizeof *density), total = 0, squares = 0;
    int status = density != NULL ? 0 : error_memory(err, (last + 1) * sizeof *density, "a density");
    *out = (struct compared){0};
    for (size_t s = 0; s < SERIES && status == 0; s++) {
        struct modes modes = {0};
        const double mean_square = window_apply(series + s * n, n);
        status = map_modes_measure(&line, series + s * n, &modes, err);
        if (status != 0)
            break;
        const double part = short_square(&modes, mean_square, first);
        out->mean += s == 0 ? part : 0;
        out->other += s == 0 ? 0 : part / (SERIES - 1);
        for (size_t m = first; m <= last && s > 0; m++)
            density[m] += modes.power[m];
        free(modes.power);
    }
    for (size_t m = first; m <= last && status == 0; m++) {
        total += density[m];
        squares += density[m] * density[m];
    }
    free(density);
    /* a density of 2 WAVES series scatters; neighbours under Hann's window are alike */
    static const double HANN = 1.944;
    if (squares > 0)
        out->freedom = 2 * total * total / squares * (1 + 1. / (SERIES - 1)) / HANN;
    return status;
}

/* Returns the RMS slope without a part of the mean square of differences over that with it. */
static double slope_without(const struct grid *grid, const struct map_differences *differences,
                            int across, double part) {
    const double with[2] = {differences->axis[0].first, differences->axis[1].first};
    double without[2] = {with[0], with[1]};
    without[across] = fmax(without[across] - part, 0);
    return sqrt(differences_square(grid, without) / differences_square(grid, with));
}

/* What the offsets add to slopes and curvatures across the lines. Of the size, independent ones
 * count, by what their short waves show. */
static void effect_measure(const struct grid *grid, int across,
                           const struct map_differences *differences, double short_waves,
                           double excess, struct line_offsets *out) {
    /* mean squares of second differences and of first ones of independent offsets of unit square,
     * and the share of short waves in the second */
    static const double BEND = 6, STEP = 2, SHORT = (3 * M_PI + 8) / (6 * M_PI);
    static const double AGREED = 0.5; /* of the first differences with the second */
    const double square = short_waves / (BEND * SHORT);
    out->rms = sqrt(excess / STEP);
    out->slope = slope_without(grid, differences, across, excess);
    out->curvature = fmin(BEND * square / differences->axis[across].second, 1);
    out->found =
        out->p_value < LINE_OFFSETS_LEVEL && excess > AGREED * STEP * square &&
        artefact_counts(slope_without(grid, differences, across, STEP * square), out->curvature);
}

int line_offsets_measure(const struct grid *grid, const double *z, enum scan_axis along,
                         const struct map_differences *differences, struct line_offsets *out,
                         struct error *err) {
    const struct lines lines = lines_of(grid, z, along);
    struct compared found;
    *out = (struct line_offsets){.p_value = (double)NAN, .slope = 1};
    if (grid_is_profile(grid) || lines.count < LINES_LEAST || lines.points < POINTS_LEAST)
        return 0;
    const size_t room = SERIES * (lines.count - 1 + lines.points);
    double *series = array_create(room, sizeof *series);
    if (series == NULL)
        return error_memory(err, room * sizeof *series, "means of lines");
    double *wave = series + SERIES * (lines.count - 1);
    waves_fill(&lines, wave);
    series_fill(&lines, wave, 1, series);
    const double excess = first_excess(series, lines.count - 1);
    series_fill(&lines, wave, 2, series);
    int status = compare(series, lines.count - 2, &found, err);
    free(series);
    if (status != 0 || !(found.other > 0))
        return status;
    out->p_value =
        gsl_cdf_fdist_Q(found.mean / found.other, found.freedom, (SERIES - 1) * found.freedom);
    effect_measure(grid, along == SCAN_ALONG_X ? 1 : 0, differences,
                   fmax(found.mean - found.other, 0), excess, out);
    return 0;
}
