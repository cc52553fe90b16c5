/* How far areas in contact (edges) of non-Gaussian surfaces of several iterations differ: they are
 * pressed on a half-space. Differences are of pairs, in percent of the area of the default's
 * surfaces.
 *
 *   bench_nongaussian_contact [n [points]]
 *
 * n (4) surfaces of 128 x 128 and 4 n profiles of `points` (512) points a case: Weibull minimum
 * and maximum, C = 1 and 3.602, H = 0.8, ratio 4 and 8, 8 points a shortest wave. Other points:
 * profiles alone.
 *
 * "other" is momentum down to the error of the default, "longer" the default down to half of it;
 * "bound" is |other| and the change by the longer ones, continued with the logarithm of eps_h to
 * half of it. "plain" is 1500 plain iterations.
 */
#include "core/contact/area.h"
#include "core/contact/contact.h"
#include "core/surface/surface.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { LOADS = 3 };
static const double PRESSURES[LOADS] = {0.01, 0.03, 0.1}; /* p/(E* h') */

enum path { PATH_OWN, PATH_OTHER, PATH_LONGER, PATH_PLAIN, PATHS };

struct bench {
    struct grid grid;
    struct generator *fast, *plain; /* owned, as all below */
    struct compliance *compliance;
    struct contact *solver;
    struct area_workspace *area;
    double *z;
    double rms_slope;
};

/* Mean and scatter of a change in percent. */
struct change {
    double sum, square;
};

static void change_add(struct change *change, double percent) {
    change->sum += percent;
    change->square += percent * percent;
}

static double standard_error(const struct change *change, double n) {
    return sqrt(fmax(0, change->square / n - change->sum * change->sum / n / n) / (n - 1));
}

/* points: a side. */
static int bench_create(struct bench *bench, int dimension, size_t points, double ratio,
                        const struct heights *heights, struct error *err) {
    const struct spectrum spectrum = {.type = SPECTRUM_SELF_AFFINE,
                                      .hurst = 0.8,
                                      .wavelength_long = ratio,
                                      .wavelength_rolloff = ratio,
                                      .wavelength_short = 1};
    const struct block block = {.model = MODEL_HALFSPACE, .height = INFINITY, .layer_growth = 1};
    struct surface_options options = SURFACE_DEFAULTS;
    struct contact_options solver = CONTACT_DEFAULTS;
    struct moments moments;
    double length = (double)points / 8;
    *bench = (struct bench){.grid = {points, dimension == 1 ? 1 : points, length, length}};
    options.heights = *heights;
    solver.without_tangent = true;
    bench->z = array_create(grid_points(&bench->grid), sizeof *bench->z);
    int status = bench->z != NULL ? 0 : error_memory(err, points * sizeof *bench->z, "heights");
    if (status == 0)
        status = generator_create(&bench->fast, &spectrum, &bench->grid, &options, err);
    options.iteration = ITERATION_PLAIN;
    options.max_iterations = options.stall_iterations = 1500;
    options.tolerance = 0;
    if (status == 0)
        status = generator_create(&bench->plain, &spectrum, &bench->grid, &options, err);
    if (status == 0)
        status = compliance_create(&bench->compliance, &bench->grid, &block, err);
    if (status == 0)
        status = contact_create(&bench->solver, bench->compliance, &solver, err);
    if (status == 0)
        status = area_workspace_create(&bench->area, bench->compliance, err);
    if (status != 0)
        return status;
    modes_moments(generator_modes(bench->fast), &moments);
    bench->rms_slope = moments.rms_slope;
    return 0;
}

static void bench_destroy(struct bench *bench) {
    generator_destroy(&bench->fast);
    generator_destroy(&bench->plain);
    area_workspace_destroy(&bench->area);
    contact_destroy(&bench->solver);
    compliance_destroy(&bench->compliance);
    free(bench->z);
}

static int press(struct bench *bench, double area[LOADS], struct error *err) {
    int status = contact_begin(bench->solver, bench->z, err);
    for (size_t k = 0; k < LOADS && status == 0; k++) {
        struct contact_state state;
        struct contact_area found;
        status = contact_press(bench->solver, PRESSURES[k] * bench->rms_slope, &state, err);
        if (status != 0)
            break;
        contact_area(bench->area, &state, &found);
        area[k] = found.edges;
    }
    return status;
}

/* Makes the surface of a path and presses it. own: what the default did. */
static int run(struct bench *bench, enum path path, uint64_t realisation,
               const struct surface_report *own, struct surface_report *report, double area[LOADS],
               struct error *err) {
    const struct random_key key = {1, 0, realisation};
    double worst = fmax(own->eps_h, fmax(own->eps_s, own->eps_s0));
    size_t most = (size_t)fmin(fmax(2 * (double)own->iterations, 100), 300);
    struct surface_aim aim = {ITERATION_REFLECTIONS, SURFACE_DEFAULTS.tolerance,
                              SURFACE_DEFAULTS.stall_iterations, SURFACE_DEFAULTS.max_iterations};
    if (path == PATH_OTHER)
        aim = (struct surface_aim){ITERATION_MOMENTUM, worst, most, most};
    else if (path == PATH_LONGER)
        aim = (struct surface_aim){ITERATION_REFLECTIONS, worst / 2, most, most};
    struct generator *generator = path == PATH_PLAIN ? bench->plain : bench->fast;
    if (path != PATH_PLAIN)
        generator_aim(generator, &aim);
    int status = generator_run(generator, key, bench->z, report, err);
    return status != 0 ? status : press(bench, area, err);
}

/* The bound of F15.14: only what exceeds the standard error is extrapolated to half of eps_h. */
static void print_rows(struct change changes[PATHS][LOADS], double halvings, double n) {
    double factor = halvings / n > 0.25 ? n / halvings : 4;
    for (size_t k = 0; k < LOADS; k++) {
        double other = standard_error(&changes[PATH_OTHER][k], n);
        double longer = standard_error(&changes[PATH_LONGER][k], n);
        double seen = fabs(changes[PATH_LONGER][k].sum / n);
        double beyond = factor * fmax(0, seen - longer);
        printf("  p %.2f:", PRESSURES[k]);
        for (enum path path = PATH_OTHER; path < PATHS; path++)
            printf(" %+6.2f (%.2f)", changes[path][k].sum / n,
                   standard_error(&changes[path][k], n));
        printf("; bound %.2f (%.2f)\n", fabs(changes[PATH_OTHER][k].sum / n) + fmax(seen, beyond),
               hypot(other, beyond > seen ? factor * longer : longer));
    }
    fflush(stdout);
}

static int bench_case(int dimension, size_t points, double ratio, const struct heights *heights,
                      size_t n, struct error *err) {
    struct bench bench;
    struct change changes[PATHS][LOADS] = {0};
    double eps_h[PATHS] = {0}, iterations[PATHS] = {0}, halvings = 0;
    int status = bench_create(&bench, dimension, points, ratio, heights, err);
    for (size_t r = 0; r < n && status == 0; r++) {
        struct surface_report reports[PATHS] = {0};
        double area[PATHS][LOADS];
        for (enum path path = 0; path < PATHS && status == 0; path++) {
            status = run(&bench, path, r, &reports[PATH_OWN], &reports[path], area[path], err);
            eps_h[path] += reports[path].eps_h / (double)n;
            iterations[path] += (double)reports[path].iterations / (double)n;
            for (size_t k = 0; k < LOADS && status == 0; k++)
                change_add(&changes[path][k], 100 * (area[path][k] / area[PATH_OWN][k] - 1));
        }
        halvings += log2(reports[PATH_OWN].eps_h / reports[PATH_LONGER].eps_h);
    }
    printf("%s, ratio %g, %s, C = %g: own, other, longer, plain: iterations %.0f %.0f %.0f %.0f, "
           "eps_h %.4f %.4f %.4f %.4f\n",
           dimension == 1 ? "profiles" : "surfaces", ratio,
           heights->type == HEIGHTS_WEIBULL_MIN ? "minimum" : "maximum", heights->shape,
           iterations[0], iterations[1], iterations[2], iterations[3], eps_h[0], eps_h[1], eps_h[2],
           eps_h[3]);
    if (status == 0)
        print_rows(changes, halvings, (double)n);
    bench_destroy(&bench);
    return status;
}

int main(int argc, char **argv) {
    struct error err = {0};
    size_t n = argc > 1 ? strtoul(argv[1], NULL, 10) : 4;
    size_t points = argc > 2 ? strtoul(argv[2], NULL, 10) : 0;
    int status = 0;
    printf("change of the area in percent of the default's: other, longer, plain (standard "
           "error)\n");
    for (int c = 0; c < (points > 0 ? 8 : 16) && status == 0; c++) {
        const struct heights heights = {.type = c & 1 ? HEIGHTS_WEIBULL_MAX : HEIGHTS_WEIBULL_MIN,
                                        .shape = c & 2 ? 3.602 : 1};
        double ratio = c & 4 ? 8 : 4;
        if (c & 8)
            status = bench_case(2, 128, ratio, &heights, n, &err);
        else
            status = bench_case(1, points > 0 ? points : 512, ratio, &heights, 4 * n, &err);
    }
    if (status != 0)
        fprintf(stderr, "bench_nongaussian_contact: %s\n", err.text);
    return status != 0 ? 1 : 0;
}
