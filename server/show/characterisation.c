#include "server/show/characterisation.h"
#include "core/statistics/roughness.h"
#include "core/statistics/summits.h"
#include "schema/json/json.h"
#include <math.h>
#include <string.h>

static void add(struct characterisation *out, const char *group, const char *name, double value) {
    if (out->count < CHARACTERISTICS_MOST)
        out->list[out->count++] = (struct characteristic){group, name, value};
}

static void add_grid(struct characterisation *out, const struct grid *grid) {
    static const char GROUP[] = "grid";
    add(out, GROUP, "nx", (double)grid->nx);
    add(out, GROUP, "ny", (double)grid->ny);
    add(out, GROUP, "dx", grid_dx(grid));
    add(out, GROUP, "dy", grid_is_profile(grid) ? (double)NAN : grid_dy(grid));
}

static void add_heights(struct characterisation *out, const struct roughness *roughness) {
    static const char GROUP[] = "heights";
    add(out, GROUP, "mean", roughness->mean);
    add(out, GROUP, "rms", roughness->rms_height);
    add(out, GROUP, "skewness", roughness->skewness);
    add(out, GROUP, "kurtosis", roughness->kurtosis);
    add(out, GROUP, "lowest", roughness->lowest);
    add(out, GROUP, "highest", roughness->highest);
}

static void add_differences(struct characterisation *out, const struct roughness *roughness) {
    static const char GROUP[] = "finite_difference";
    add(out, GROUP, "rms_slope", roughness->rms_slope);
    add(out, GROUP, "rms_curvature", roughness->rms_curvature);
    add(out, GROUP, "m2", roughness->m2);
    add(out, GROUP, "m4", roughness->m4);
    add(out, GROUP, "nayak_alpha", roughness->nayak_alpha);
}

static void add_moments(struct characterisation *out, const struct moments *moments) {
    static const char GROUP[] = "spectral";
    add(out, GROUP, "rms_slope", moments->rms_slope);
    add(out, GROUP, "rms_curvature", moments->rms_curvature);
    add(out, GROUP, "m0", moments->m0);
    add(out, GROUP, "m2", moments->m2);
    add(out, GROUP, "m4", moments->m4);
    add(out, GROUP, "nayak_alpha", moments->nayak_alpha);
}

static void add_summits(struct characterisation *out, const char *group, const struct grid *grid,
                        const struct summit_list *list) {
    double n = (double)list->count, height = 0, variance = 0, curvature = 0;
    for (size_t a = 0; a < list->count; a++) {
        height += list->summits[a].height / n;
        curvature += list->summits[a].curvature / n;
    }
    for (size_t a = 0; a < list->count; a++)
        variance += pow(list->summits[a].height - height, 2) / n;
    double area = grid_is_profile(grid) ? grid->lx : grid->lx * grid->ly;
    double none = list->count > 0 ? 0 : NAN;
    add(out, group, "count", n);
    add(out, group, "density", n / area);
    add(out, group, "height_mean", height + none);
    add(out, group, "height_deviation", sqrt(variance) + none);
    add(out, group, "curvature_mean", curvature + none);
}

static int find_summits(struct characterisation *out, const struct grid *grid, const double *z,
                        size_t mode_x, size_t mode_y, struct error *err) {
    static const char *const NAMES[] = {"summits_nine_point", "summits_five_point",
                                        "summits_refined"};
    static const char *const PROFILE_NAMES[] = {"peaks", NULL, "peaks_refined"};
    struct summit_list list = {0};
    int status = 0;
    for (int stencil = SUMMITS_NINE_POINT; stencil <= SUMMITS_REFINED && status == 0; stencil++) {
        const char *group = grid_is_profile(grid) ? PROFILE_NAMES[stencil] : NAMES[stencil];
        struct summit_finder *finder = NULL;
        if (group == NULL)
            continue;
        status = summit_finder_create(&finder, grid, (enum summit_stencil)stencil,
                                      CURVATURE_FINITE_DIFFERENCE, mode_x, mode_y, err);
        if (status == 0)
            status = summits_find(finder, z, &list, err);
        summit_finder_destroy(&finder);
        if (status == 0)
            add_summits(out, group, grid, &list);
    }
    summit_list_clear(&list);
    return status;
}

int characterise_heights(struct characterisation *out, const struct grid *grid, const double *z,
                         size_t mode_x, size_t mode_y, struct error *err) {
    struct roughness roughness;
    struct moments moments;
    int status = roughness_spectral(grid, z, &moments, err);
    if (status != 0)
        return status;
    roughness_measure(grid, z, &roughness);
    out->count = 0;
    add_grid(out, grid);
    add_heights(out, &roughness);
    add_differences(out, &roughness);
    add_moments(out, &moments);
    return find_summits(out, grid, z, mode_x, mode_y, err);
}

/* Returns whether entry n is the first one of its group. */
static bool begins_group(const struct characterisation *characterisation, size_t n) {
    const struct characteristic *list = characterisation->list;
    return n == 0 || strcmp(list[n].group, list[n - 1].group) != 0;
}

void characterisation_print(FILE *file, const struct characterisation *characterisation) {
    for (size_t n = 0; n < characterisation->count; n++) {
        const struct characteristic *entry = &characterisation->list[n];
        if (begins_group(characterisation, n))
            fprintf(file, "%s\n", entry->group);
        if (isfinite(entry->value))
            fprintf(file, "  %-18s %.10g\n", entry->name, entry->value);
        else
            fprintf(file, "  %-18s -\n", entry->name);
    }
}

bool characterisation_print_json(FILE *file, const struct characterisation *characterisation) {
    bool done = true;
    fputc('{', file);
    for (size_t n = 0; n < characterisation->count && done; n++) {
        const struct characteristic *entry = &characterisation->list[n];
        bool begins = begins_group(characterisation, n);
        if (begins) {
            fputs(n > 0 ? "}," : "", file);
            done = json_print_text(file, entry->group);
            fputs(":{", file);
        }
        fputs(begins ? "" : ",", file);
        done = done && json_print_text(file, entry->name);
        fputc(':', file);
        json_print_number(file, entry->value);
    }
    fputs(characterisation->count > 0 ? "}}" : "}", file);
    return done;
}
