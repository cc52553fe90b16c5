/* Protects: an open map with a hole is measured, or refused for want of memory, whichever
 * allocation fails; nothing leaks, and the next attempt gives the same. */
#include "tests/support/check.h"

#include "core/statistics/heights/areal.h"
#include "core/statistics/heights/roughness.h"
#include "core/statistics/spectra/spectrum_fit.h"
#include "core/statistics/spectra/windowed_psd.h"
#include "core/statistics/summits/local_wave.h"
#include "core/statistics/summits/open_summits.h"
#include "core/statistics/uncertainty/seam.h"
#include "tests/support/failing/each_allocation.h"

enum { SIDE = 24, POINTS = SIDE * SIDE };
static const struct grid GRID = {SIDE, SIDE, SIDE, SIDE};

/* Waves of 7.3 and 6.1 points, and one hole. */
static void heights_fill(double *z) {
    for (size_t point = 0; point < POINTS; point++) {
        size_t i = point % SIDE, j = point / SIDE;
        z[point] = cos(2 * M_PI * (double)i / 7.3) * cos(2 * M_PI * (double)j / 6.1);
    }
    z[0] = NAN;
}

static int find_summits(void *context, struct error *err) {
    const enum summit_stencil *stencil = context;
    double z[POINTS], searched;
    struct summit_list list = {0};
    const struct measured_map map = {&GRID, z, BOUNDARY_OPEN};
    heights_fill(z);
    int status = open_summits_find(&map, *stencil, &list, &searched, err);
    if (status == 0)
        assert_true(list.count > 0);
    summit_list_clear(&list);
    return status;
}

static void summits(void **state) {
    (void)state;
    for (enum summit_stencil stencil = SUMMITS_NINE_POINT; stencil <= SUMMITS_REFINED; stencil++)
        each_allocation(&(struct failing_call){.name = "open summits", find_summits, &stencil});
}

static int measure(void *context, struct error *err) {
    (void)context;
    double z[POINTS], wave_number[SIDE], density[SIDE];
    const struct measured_map map = {&GRID, z, BOUNDARY_OPEN};
    struct correlation *correlation = NULL;
    struct moments moments;
    struct roughness roughness;
    struct areal areal;
    struct seam seam;
    heights_fill(z);
    assert_true(radial_bins(&GRID) <= SIDE);
    int status = seam_measure(&GRID, z, &seam, err);
    if (status == 0)
        status = local_moments_measure(&map, &moments, err);
    if (status == 0)
        status = windowed_psd_measure(&map, wave_number, density, err);
    if (status == 0)
        status = correlation_create(&correlation, &map, err);
    open_roughness_measure(&map, &roughness);
    if (status == 0)
        status = areal_measure(&map, &roughness, correlation, NULL, &areal, err);
    if (status == 0)
        assert_true(areal.spd > 0 && areal.sal > 0);
    correlation_destroy(&correlation);
    return status;
}

static void measures(void **state) {
    (void)state;
    /* qsort sorts in place where it has no memory. */
    each_allocation(
        &(struct failing_call){.name = "measures of an open map", measure, NULL, .may_succeed = 1});
}

static int fit(void *context, struct error *err) {
    (void)context;
    double z[POINTS];
    const struct measured_map map = {&GRID, z, BOUNDARY_OPEN};
    struct map_spectrum *spectrum = NULL;
    struct spectrum_fit found;
    heights_fill(z);
    int status = map_spectrum_create(&spectrum, &map, err);
    if (status == 0)
        status = spectrum_fit_measure(spectrum, &(struct spectrum_fit_request){.shortest = 2.5},
                                      &found, err);
    if (status == 0)
        assert_true(found.fitted && found.hurst.low <= found.hurst.high);
    map_spectrum_destroy(&spectrum);
    return status;
}

static void fits(void **state) {
    (void)state;
    each_allocation(&(struct failing_call){.name = "the fit of a spectrum", fit, NULL});
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(summits),
        cmocka_unit_test(measures),
        cmocka_unit_test(fits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
