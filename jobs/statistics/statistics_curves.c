#include "jobs/statistics/statistics_curves.h"
#include "jobs/curve.h"
#include "jobs/statistics/statistics_spectra.h"
#include "jobs/statistics/statistics_theory.h"
#include <stdlib.h>

/* What all curves of a case are made from, and room for one at a time. */
struct workshop {
    const struct statistics_case *study;
    const struct statistics_tally *tally;
    const char *theory_name; /* of summits; NULL: does not apply */
    cJSON *curves;
    double *x, *x2, *y, *standard_error; /* owned; x2 equivalent.count, others the largest curve */
    double *pdf, *cdf, *curvature;       /* theory, likewise */
};

static int workshop_create(struct workshop *shop, struct error *err) {
    size_t heights = shop->study->height.count, columns = shop->study->equivalent.count;
    size_t cells = heights * columns; /* at least as many as either */
    double **const arrays[] = {&shop->x,   &shop->x2,  &shop->y,        &shop->standard_error,
                               &shop->pdf, &shop->cdf, &shop->curvature};
    for (size_t a = 0; a < sizeof arrays / sizeof *arrays; a++) {
        *arrays[a] = array_create(cells, sizeof(double));
        if (*arrays[a] == NULL) {
            error_memory(err, cells * sizeof(double), "curves");
            return ERROR_MEMORY;
        }
    }
    shop->curves = cJSON_CreateArray();
    return shop->curves != NULL ? 0 : error_memory(err, sizeof(cJSON), "curves");
}

static void workshop_clear(struct workshop *shop) {
    double *const arrays[] = {shop->x,   shop->x2,  shop->y,        shop->standard_error,
                              shop->pdf, shop->cdf, shop->curvature};
    for (size_t a = 0; a < sizeof arrays / sizeof *arrays; a++)
        free(arrays[a]);
    cJSON_Delete(shop->curves);
}

static void centres(const struct bins *bins, double *x) {
    for (size_t b = 0; b < bins->count; b++)
        x[b] = bins_centre(bins, b);
}

static const char *height_label(void) {
    return "z/sqrt(m0)";
}

static const char *equivalent_label(const struct workshop *shop) {
    return shop->study->surface.dimension == 2 ? "-sqrt(3/m4) kappa_m" : "z''/sqrt(m4)";
}

/* A histogram as a density over its bins. */
static bool density(struct workshop *shop, const char *quantity, const char *x_label,
                    const struct bins *bins, const struct tally *cells,
                    const struct tally_total *total, const char *theory_name) {
    double width = bins_width(bins);
    centres(bins, shop->x);
    for (size_t b = 0; b < bins->count; b++) {
        struct estimate share = tally_share(cells, b + 1, total);
        shop->y[b] = share.value / width;
        shop->standard_error[b] = share.standard_error / width;
    }
    return curve_append(shop->curves,
                        &(struct curve){.quantity = quantity,
                                        .x_label = x_label,
                                        .y_label = "probability density",
                                        .n = bins->count,
                                        .x = shop->x,
                                        .y = shop->y,
                                        .standard_error = shop->standard_error,
                                        .theories = {{theory_name, shop->pdf}},
                                        .counted = true,
                                        .underflow = (double)cells->count[0],
                                        .overflow = (double)cells->count[bins->count + 1]});
}

/* Cumulative probability at the upper edges of the bins. */
static bool cumulative(struct workshop *shop, const char *quantity, const struct tally *below,
                       const struct tally_total *total, const char *theory_name) {
    const struct bins *bins = &shop->study->height;
    for (size_t b = 0; b < bins->count; b++) {
        struct estimate share = tally_share(below, b + 1, total);
        shop->x[b] = bins->low + (double)(b + 1) * bins_width(bins);
        shop->y[b] = share.value;
        shop->standard_error[b] = share.standard_error;
    }
    return curve_append(shop->curves, &(struct curve){.quantity = quantity,
                                                      .x_label = height_label(),
                                                      .y_label = "cumulative probability",
                                                      .n = bins->count,
                                                      .x = shop->x,
                                                      .y = shop->y,
                                                      .standard_error = shop->standard_error,
                                                      .theories = {{theory_name, shop->cdf}}});
}

static bool curvature(struct workshop *shop) {
    const struct bins *bins = &shop->study->height;
    const struct statistics_tally *tally = shop->tally;
    centres(bins, shop->x);
    for (size_t b = 0; b < bins->count; b++) {
        struct estimate mean =
            tally_sums_ratio(&tally->curvature, &tally->summit, b + 1, tally->summits.realisations);
        shop->y[b] = mean.value;
        shop->standard_error[b] = mean.standard_error;
    }
    return curve_append(shop->curves,
                        &(struct curve){.quantity = "summit_mean_curvature",
                                        .x_label = height_label(),
                                        .y_label = shop->study->surface.dimension == 2
                                                       ? "kappa_m/sqrt(m4)"
                                                       : "-z''/sqrt(m4)",
                                        .n = bins->count,
                                        .x = shop->x,
                                        .y = shop->y,
                                        .standard_error = shop->standard_error,
                                        .theories = {{shop->theory_name, shop->curvature}}});
}

static bool joint(struct workshop *shop) {
    const struct bins *height = &shop->study->height, *equivalent = &shop->study->equivalent;
    const struct tally *cells = &shop->tally->joint;
    double area = bins_width(height) * bins_width(equivalent), inside = 0;
    centres(height, shop->x);
    centres(equivalent, shop->x2);
    for (size_t zb = 0; zb < height->count; zb++) {
        for (size_t tb = 0; tb < equivalent->count; tb++) {
            size_t cell = (zb + 1) * (equivalent->count + 2) + tb + 1;
            size_t at = zb * equivalent->count + tb;
            struct estimate share = tally_share(cells, cell, &shop->tally->summits);
            shop->y[at] = share.value / area;
            shop->standard_error[at] = share.standard_error / area;
            inside += (double)cells->count[cell];
        }
    }
    return curve_append(shop->curves,
                        &(struct curve){.quantity = "summit_joint_pdf",
                                        .x_label = height_label(),
                                        .y_label = "probability density",
                                        .n = height->count,
                                        .x = shop->x,
                                        .columns = equivalent->count,
                                        .x2 = shop->x2,
                                        .x2_label = equivalent_label(shop),
                                        .y = shop->y,
                                        .standard_error = shop->standard_error,
                                        .theories = {{shop->theory_name, shop->pdf}},
                                        .counted = true,
                                        .underflow = 0,
                                        .overflow = (double)shop->tally->summits.sum - inside});
}

static bool append_summits(struct workshop *shop, double alpha) {
    const struct statistics_case *study = shop->study;
    const struct statistics_tally *tally = shop->tally;
    if (shop->theory_name != NULL)
        statistics_theory_summits(study, alpha, shop->pdf, shop->cdf, shop->curvature);
    if (!density(shop, "summit_height_pdf", height_label(), &study->height, &tally->summit,
                 &tally->summits, shop->theory_name) ||
        !cumulative(shop, "summit_height_cdf", &tally->summit_below, &tally->summits,
                    shop->theory_name) ||
        !curvature(shop))
        return false;
    if (shop->theory_name != NULL)
        statistics_theory_equivalent(study, shop->pdf);
    if (!density(shop, "summit_curvature_pdf", equivalent_label(shop), &study->equivalent,
                 &tally->equivalent, &tally->summits, shop->theory_name))
        return false;
    if (shop->theory_name != NULL)
        statistics_theory_joint(study, alpha, shop->pdf);
    return joint(shop);
}

static int append_all(struct workshop *shop, const struct modes *modes,
                      const struct moments *moments, struct error *err) {
    const struct statistics_tally *tally = shop->tally;
    const char *name =
        shop->study->surface.options.heights.type == HEIGHTS_GAUSSIAN ? "gaussian" : "weibull";
    int status = statistics_theory_heights(shop->study, shop->pdf, shop->cdf, err);
    if (status != 0)
        return status;
    if (!density(shop, "height_pdf", height_label(), &shop->study->height, &tally->height,
                 &tally->points, name) ||
        !cumulative(shop, "height_cdf", &tally->height_below, &tally->points, name) ||
        !append_summits(shop, moments->nayak_alpha))
        return error_memory(err, tally->joint.size * 3 * sizeof(cJSON), "curves");
    return spectra_curves(shop->study, modes, tally, shop->curves, err);
}

int statistics_curves(const struct statistics_case *study, const struct modes *modes,
                      const struct moments *moments, const struct statistics_tally *tally,
                      cJSON **out, struct error *err) {
    bool applies = statistics_theory_applies(study, moments);
    struct workshop shop = {.study = study,
                            .tally = tally,
                            .theory_name = applies ? statistics_theory_name(study) : NULL};
    int status = workshop_create(&shop, err);
    if (status == 0)
        status = append_all(&shop, modes, moments, err);
    if (status == 0) {
        *out = shop.curves;
        shop.curves = NULL;
    }
    workshop_clear(&shop);
    return status;
}
