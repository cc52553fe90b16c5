/* Contact fractions of the double sine that contact areas are learnt from (F12.5): limits of a
 * half-space's on 256 x 256 and 512 x 512 points, of second order; what is learnt from them of
 * each model, with its time; and the errors of areas and gaps on rough surfaces, from which nothing
 * is learnt, at 8 points a shortest wave against the exact layer at 64. */
#include "core/contact/area.h"
#include "core/contact/area_law.h"
#include "core/surface/surface.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static const double PI = 3.14159265358979323846;
static const double LOAD[] = {0.05, 0.1, 0.2, 0.5, 0.7};
enum { LOADS = 5 };

static int fractions(size_t n, double *out, struct error *err) {
    struct grid grid = {n, n, 1, 1};
    struct block block = {.model = MODEL_HALFSPACE, .height = INFINITY};
    struct compliance *compliance = NULL;
    struct contact *contact = NULL;
    struct area_workspace *areas = NULL;
    double *z = array_create(n * n, sizeof *z);
    int status = z != NULL ? compliance_create(&compliance, &grid, &block, err)
                           : error_memory(err, n * n * sizeof *z, "heights");
    if (status == 0)
        status = contact_create(&contact, compliance, &CONTACT_DEFAULTS, err);
    if (status == 0)
        status = area_workspace_create(&areas, compliance, err);
    for (size_t i = 0; status == 0 && i < n * n; i++) {
        size_t row = i / n;
        z[i] = cos(2 * PI * ((double)(i % n) + 0.37) / (double)n) *
               cos(2 * PI * ((double)row + 0.21) / (double)n);
    }
    if (status == 0)
        status = contact_begin(contact, z, err);
    for (size_t k = 0; status == 0 && k < LOADS; k++) {
        struct contact_state state;
        struct contact_area area;
        status = contact_press(contact, LOAD[k] * sqrt(2) * PI, &state, err);
        if (status == 0)
            contact_area(areas, &state, &area);
        out[k] = status == 0 ? area.edges : 0;
    }
    area_workspace_destroy(&areas);
    contact_destroy(&contact);
    compliance_destroy(&compliance);
    free(z);
    return status;
}

static int laws(struct error *err) {
    static const double POISSON[] = {0, 0.3, 0.4999}, GROWTH[] = {1, 1.1, 1.3};
    struct grid grid = {64, 64, 1, 1};
    for (size_t a = 0; a < 19; a++) {
        struct block block = {.model = a == 0 ? MODEL_HALFSPACE : MODEL_LAYERED,
                              .poisson = POISSON[(a + 2) % 3],
                              .height = 1.5,
                              .layer_growth = GROWTH[(a + 2) / 3 % 3],
                              .weighting = a < 10 ? GAP_STANDARD : GAP_DUAL};
        struct area_law law;
        clock_t start = clock();
        int status = area_law_make(&grid, &block, &law, err);
        if (status != 0)
            return status;
        printf("%-10s %-8s nu %-6g growth %-4g overlap %+.4f  patch %+.3f  of nodes %+.3f  "
               "weighting %.3f  %5.1f ms\n",
               a == 0 ? "halfspace" : "layered",
               a == 0   ? ""
               : a < 10 ? "standard"
                        : "dual",
               block.poisson, block.layer_growth, law.overlap, law.patch, law.patch_of_nodes,
               law.weighting, 1e3 * (double)(clock() - start) / CLOCKS_PER_SEC);
    }
    return 0;
}

/* --- errors on rough surfaces --- */

static const double ROUGH_LOAD[] = {0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.5};
enum { ROUGH_LOADS = 8, SURFACES = 12, COARSE = 64, FINE = 512 };

struct means {
    double edges[ROUGH_LOADS], perimeter[ROUGH_LOADS], gap[ROUGH_LOADS];
};

static int press_all(struct contact *contact, struct area_workspace *areas, struct means *out,
                     struct error *err) {
    int status = 0;
    for (size_t k = 0; status == 0 && k < ROUGH_LOADS; k++) {
        struct contact_state state;
        struct contact_area area;
        status = contact_press(contact, ROUGH_LOAD[k], &state, err);
        if (status != 0)
            return status;
        contact_area(areas, &state, &area);
        out->edges[k] += area.edges;
        out->perimeter[k] += area.perimeter;
        out->gap[k] += area.mean_gap;
    }
    return status;
}

static int rough(size_t n, double hurst, const struct block *block, struct means *out,
                 struct error *err) {
    struct grid grid = {n, n, 1, 1};
    struct spectrum spectrum = {.type = SPECTRUM_SELF_AFFINE,
                                .hurst = hurst,
                                .wavelength_long = 0.5,
                                .wavelength_rolloff = 0.5,
                                .wavelength_short = 0.125,
                                .scale = SCALE_RMS_SLOPE,
                                .scale_value = 1};
    struct generator *generator = NULL;
    struct compliance *compliance = NULL;
    struct contact *contact = NULL;
    struct area_workspace *areas = NULL;
    double *z = array_create(n * n, sizeof *z);
    *out = (struct means){0};
    int status = z != NULL ? compliance_create(&compliance, &grid, block, err)
                           : error_memory(err, n * n * sizeof *z, "heights");
    if (status == 0)
        status = generator_create(&generator, &spectrum, &grid, &SURFACE_DEFAULTS, err);
    if (status == 0)
        status = contact_create(&contact, compliance, &CONTACT_DEFAULTS, err);
    if (status == 0)
        status = area_workspace_create(&areas, compliance, err);
    for (uint64_t r = 0; status == 0 && r < SURFACES; r++) {
        struct random_key key = {.seed = 777, .realisation = r};
        status = generator_run(generator, key, z, NULL, err);
        if (status == 0)
            status = contact_begin(contact, z, err);
        if (status == 0)
            status = press_all(contact, areas, out, err);
    }
    area_workspace_destroy(&areas);
    contact_destroy(&contact);
    compliance_destroy(&compliance);
    generator_destroy(&generator);
    free(z);
    return status;
}

static void print_errors(const char *name, const double *few, const double *many) {
    printf("  %-9s", name);
    for (size_t k = 0; k < ROUGH_LOADS; k++)
        printf(" %+6.2f", 100 * (few[k] / many[k] - 1));
    printf(" %%\n");
}

static int errors(double hurst, struct error *err) {
    static const struct {
        enum gap_weighting weighting;
        double growth, poisson;
    } cases[] = {{GAP_STANDARD, 1, 0.3}, {GAP_STANDARD, 1.1, 0.3},    {GAP_STANDARD, 1.3, 0.3},
                 {GAP_STANDARD, 1.1, 0}, {GAP_STANDARD, 1.3, 0.4999}, {GAP_DUAL, 1, 0.3},
                 {GAP_DUAL, 1.1, 0.3},   {GAP_DUAL, 1.3, 0.3},        {GAP_DUAL, 1.1, 0},
                 {GAP_DUAL, 1.3, 0.4999}};
    struct block block = {.model = MODEL_HALFSPACE, .height = 1.5};
    struct means few, many;
    int status = rough(FINE, hurst, &block, &many, err);
    printf("H = %g, fractions", hurst);
    for (size_t k = 0; k < ROUGH_LOADS; k++)
        printf(" %.4f", many.edges[k] / SURFACES);
    printf("\n");
    for (size_t a = 0; status == 0 && a <= sizeof cases / sizeof *cases; a++) {
        if (a > 0)
            block = (struct block){MODEL_LAYERED,       cases[a - 1].poisson,   1.5,
                                   cases[a - 1].growth, cases[a - 1].weighting, {0, 0, 0}};
        status = rough(COARSE, hurst, &block, &few, err);
        if (a == 0)
            printf(" halfspace\n");
        else
            printf(" layered, %s, growth %g, nu %g\n",
                   block.weighting == GAP_DUAL ? "dual" : "standard", block.layer_growth,
                   block.poisson);
        print_errors("edges", few.edges, many.edges);
        print_errors("perimeter", few.perimeter, many.perimeter);
        print_errors("mean gap", few.gap, many.gap);
    }
    return status;
}

int main(void) {
    double coarse[LOADS], fine[LOADS];
    struct error err = {0};
    if (fractions(256, coarse, &err) != 0 || fractions(512, fine, &err) != 0) {
        fprintf(stderr, "%s\n", err.text);
        return 1;
    }
    for (size_t k = 0; k < LOADS; k++)
        printf("p/p* %.2f: %.6f, %.6f, limit %.6f\n", LOAD[k], coarse[k], fine[k],
               fine[k] + (fine[k] - coarse[k]) / 3);
    if (laws(&err) != 0 || errors(0.8, &err) != 0 || errors(0.3, &err) != 0) {
        fprintf(stderr, "%s\n", err.text);
        return 1;
    }
    return 0;
}
