/* Contact under a hardness on surfaces of 512 x 512 points, Hurst exponent 0.8, ratio 8, 8 points a
 * shortest wave: Fourier transforms over those of the elastic solution of the same load, with and
 * without tangents, alone and in a path of loads. */
#include "core/contact/contact.h"
#include "core/surface/surface.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const double HARDNESS[] = {0.01, 0.05, 0.1, 0.25, 0.5, 1, 3, 10};
static const double LOADS[] = {0.03, 0.1, 0.3, 0.6, 0.9}; /* over the hardness */
enum { HARDNESSES = sizeof HARDNESS / sizeof *HARDNESS, COUNT = sizeof LOADS / sizeof *LOADS };

struct setting {
    size_t side;
    bool bare, path;
};

static int press(const struct compliance *compliance, const double *z, double hardness,
                 const double *load, const struct setting *setting, struct contact_state *out,
                 struct error *err) {
    struct contact *contact = NULL;
    struct contact_options options = CONTACT_DEFAULTS;
    options.hardness = hardness;
    options.without_tangent = setting->bare;
    int status = contact_create(&contact, compliance, &options, err);
    for (size_t l = 0; status == 0 && l < COUNT; l++) {
        if (l == 0 || !setting->path)
            status = contact_begin(contact, z, err);
        if (status == 0)
            status = contact_press(contact, load[l], &out[l], err);
    }
    contact_destroy(&contact);
    return status;
}

static int row(const struct compliance *compliance, const double *z, double slope, double hardness,
               const struct setting *setting, struct error *err) {
    struct contact_state plain[COUNT], limited[COUNT];
    double load[COUNT], work[2] = {0};
    for (size_t l = 0; l < COUNT; l++)
        load[l] = LOADS[l] * hardness * slope;
    int status = press(compliance, z, INFINITY, load, setting, plain, err);
    if (status == 0)
        status = press(compliance, z, hardness * slope, load, setting, limited, err);
    if (status != 0)
        return status;
    printf("%5.2f", hardness);
    for (size_t l = 0; l < COUNT; l++) {
        double n = (double)grid_points(&compliance->grid);
        work[0] += plain[l].work;
        work[1] += limited[l].work;
        printf("  %5.2f (%.0f/%.0f, %zu it, %.2f)", limited[l].work / plain[l].work,
               limited[l].work / n, plain[l].work / n, limited[l].iterations,
               (double)limited[l].yielded / n);
    }
    printf("  all %.2f\n", work[1] / work[0]);
    return 0;
}

int main(int argc, char **argv) {
    struct error err = {0};
    struct setting setting = {.side = argc > 1 ? strtoul(argv[1], NULL, 10) : 512};
    size_t n = setting.side;
    int dimension = argc > 2 ? 1 : 2;
    double cell = (double)n / 8;
    struct grid grid = {n, dimension == 1 ? 1 : n, cell, cell};
    struct spectrum spectrum = {SPECTRUM_SELF_AFFINE, .hurst = 0.8, .wavelength_long = cell / 8,
                                .wavelength_rolloff = cell / 8, .wavelength_short = 1};
    struct block block = {.model = MODEL_HALFSPACE, .poisson = 0.3, .height = INFINITY};
    struct generator *generator = NULL;
    struct compliance *compliance = NULL;
    double *z = array_create(grid_points(&grid), sizeof *z);
    int status = z == NULL ? ERROR_MEMORY : 0;
    if (status == 0)
        status = generator_create(&generator, &spectrum, &grid, &SURFACE_DEFAULTS, &err);
    if (status == 0)
        status = generator_run(generator, (struct random_key){1, 0, 0}, z, NULL, &err);
    if (status == 0)
        status = compliance_create(&compliance, &grid, &block, &err);
    for (size_t a = 0; status == 0 && a < 4; a++) {
        struct moments moments;
        modes_moments(generator_modes(generator), &moments);
        setting.bare = a % 2 == 1;
        setting.path = a / 2 == 1;
        printf("%s tangents, %s\n", setting.bare ? "without" : "with",
               setting.path ? "loads in a path" : "each load alone");
        for (size_t h = 0; status == 0 && h < HARDNESSES; h++)
            status = row(compliance, z, moments.rms_slope, HARDNESS[h], &setting, &err);
    }
    if (status != 0)
        fprintf(stderr, "%s\n", err.text);
    compliance_destroy(&compliance);
    generator_destroy(&generator);
    free(z);
    return status != 0;
}
