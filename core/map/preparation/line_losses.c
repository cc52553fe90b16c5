#include "core/map/preparation/line_losses.h"
#include "core/error.h"
#include "core/statistics/heights/roughness.h"
#include <math.h>
#include <stdlib.h>

enum { WAVES = 8 }; /* cosine and sine of one to four waves a line */

/* How many terms of a polynomial are taken from each line. */
static double terms_of(enum scan_lines kind) {
    return kind == SCAN_LINES_NONE        ? 0
           : kind == SCAN_LINES_LINEAR    ? 2
           : kind == SCAN_LINES_QUADRATIC ? 3
                                          : 1;
}

/* Fills the amplitudes of a line's waves, of mean square 1. Holes count as the mean. */
static void line_fill(const double *z, size_t n, size_t step, double mean, double out[WAVES]) {
    for (size_t w = 0; w < WAVES; w++) {
        const size_t wave = w / 2 + 1;
        const double turn = 2 * M_PI * (double)wave / (double)n;
        double sum = 0;
        for (size_t i = 0; i < n; i++) {
            const double y = isnan(z[i * step]) ? 0 : z[i * step] - mean;
            const double phase = turn * ((double)i + 0.5);
            sum += y * (w % 2 == 0 ? cos(phase) : sin(phase));
        }
        out[w] = M_SQRT2 * sum / (double)n;
    }
}

/* Mean squares over lines and waves of amplitudes, of their differences from line to line, and of
 * second differences. */
struct squares {
    struct average height, slope, bend;
};

static void squares_add(const double *amplitudes, size_t lines, double spacing,
                        struct squares *out) {
    for (size_t l = 0; l < lines; l++)
        for (size_t w = 0; w < WAVES; w++) {
            const double at = amplitudes[l * WAVES + w];
            average_add(&out->height, at * at);
            if (l + 1 == lines)
                continue;
            const double next = amplitudes[(l + 1) * WAVES + w];
            average_add(&out->slope, pow((next - at) / spacing, 2));
            if (l == 0)
                continue;
            const double before = amplitudes[(l - 1) * WAVES + w];
            average_add(&out->bend, pow((next - 2 * at + before) / (spacing * spacing), 2));
        }
}

/* Returns what is lost of a square that is left. */
static double share_of(double lost, double left) {
    return left > 0 ? lost / left : 0;
}

int line_losses_measure(const struct measured_map *map, enum scan_lines kind, enum scan_axis along,
                        struct line_losses *out, struct error *err) {
    const struct grid *grid = map->grid;
    const bool along_x = along == SCAN_ALONG_X;
    const size_t n = along_x ? grid->nx : grid->ny, lines = along_x ? grid->ny : grid->nx;
    const double terms = terms_of(kind);
    *out = (struct line_losses){0};
    if (terms == 0 || grid_is_profile(grid))
        return 0;
    double *amplitudes = array_create(lines * WAVES, sizeof *amplitudes);
    if (amplitudes == NULL)
        return error_memory(err, lines * WAVES * sizeof *amplitudes, "waves of scan lines");
    struct roughness roughness;
    struct squares squares = {0};
    map_roughness_measure(map, &roughness);
    for (size_t l = 0; l < lines; l++)
        line_fill(map->z + (along_x ? l * grid->nx : l), n, along_x ? 1 : grid->nx, roughness.mean,
                  amplitudes + l * WAVES);
    squares_add(amplitudes, lines, along_x ? grid_dy(grid) : grid_dx(grid), &squares);
    free(amplitudes);
    const double bend = terms * average_value(&squares.bend);
    out->height = share_of(terms * average_value(&squares.height), pow(roughness.rms_height, 2));
    out->slope = share_of(terms * average_value(&squares.slope), pow(roughness.rms_slope, 2));
    out->bend = share_of(bend, 2 * roughness.m4);
    out->curvature = share_of(bend / 4, pow(roughness.rms_curvature, 2));
    return 0;
}
