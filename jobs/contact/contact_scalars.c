#include "jobs/contact/contact_scalars.h"
#include "core/statistics/fit.h"
#include "core/theory/contact.h"
#include "jobs/estimate.h"
#include "jobs/scalar.h"
#include <math.h>
#include <stdlib.h>

const char *const CONTACT_SCALARS[CONTACT_SCALAR_COUNT + 1] = {
    [CONTACT_SCALAR_KAPPA] = "kappa",
    [CONTACT_SCALAR_POWER_LAW_A] = "power_law_a",
    [CONTACT_SCALAR_POWER_LAW_B] = "power_law_b",
    [CONTACT_SCALAR_ERF_KAPPA] = "erf_kappa",
    [CONTACT_SCALAR_AREA_LAST] = "contact_area_last",
    [CONTACT_SCALAR_GAP_LAST] = "mean_gap_last",
    [CONTACT_SCALAR_ITERATIONS] = "iterations",
    [CONTACT_SCALAR_VIOLATION] = "violation",
    [CONTACT_SCALAR_FULL_LOAD_REACHED] = "full_load_reached",
    [CONTACT_SCALAR_FULL_ITERATIONS] = "full_iterations",
    [CONTACT_SCALAR_FULL_CUTS] = "full_load_cuts",
    [CONTACT_SCALAR_FULL_CHANGES] = "full_set_changes",
    [CONTACT_SCALAR_FULL_BALANCE] = "full_force_balance",
    [CONTACT_SCALAR_FULL_PENETRATION] = "full_penetration",
    [CONTACT_SCALAR_FULL_WEIGHTED_PENETRATION] = "full_weighted_penetration",
    [CONTACT_SCALAR_FULL_STRETCH] = "full_stretch",
    [CONTACT_SCALAR_FULL_SLOPE] = "full_steepest_slope",
    [CONTACT_SCALAR_FULL_QUALITY] = "full_mesh_quality",
    [CONTACT_SCALAR_RMS_HEIGHT] = "rms_height",
    [CONTACT_SCALAR_RMS_SLOPE] = "rms_slope",
    [CONTACT_SCALAR_NAYAK_ALPHA] = "nayak_alpha",
    [CONTACT_SCALAR_SKEWNESS] = "skewness",
    [CONTACT_SCALAR_KURTOSIS] = "kurtosis",
    [CONTACT_SCALAR_GENERATOR_ITERATIONS] = "generator_iterations",
    [CONTACT_SCALAR_EPS_H] = "eps_h",
    [CONTACT_SCALAR_EPS_S] = "eps_s",
    [CONTACT_SCALAR_EPS_S0] = "eps_s0",
};

/* Of a measure on the finest level, by load. */
static const double *finest_values(struct contact_tally *tally, enum contact_measure measure,
                                   size_t model) {
    const struct contact_case *study = tally->study;
    return contact_tally_values(tally, measure) +
           contact_case_cell(study, model, study->level_count - 1, 0);
}

/* Over the loads that have values, which come first; 0 without any. */
static double sum_of(size_t n, const double *values) {
    double sum = 0;
    for (size_t k = 0; k < n && !isnan(values[k]); k++)
        sum += values[k];
    return sum;
}

static double largest_of(size_t n, const double *values) {
    double largest = 0;
    for (size_t k = 0; k < n && !isnan(values[k]); k++)
        largest = fmax(largest, values[k]);
    return largest;
}

/* What the model full tells of itself. */
static void measure_full(struct contact_tally *tally, double *out) {
    const struct contact_case *study = tally->study;
    size_t full = contact_case_full(study), n = study->load_count, solved = 0;
    for (size_t a = CONTACT_SCALAR_FULL_LOAD_REACHED; a <= CONTACT_SCALAR_FULL_QUALITY; a++)
        out[a] = NAN;
    if (full == study->model_count)
        return;
    const double *iterations = finest_values(tally, MEASURE_ITERATIONS, full);
    while (solved < n && !isnan(iterations[solved]))
        solved++;
    out[CONTACT_SCALAR_FULL_LOAD_REACHED] = solved > 0 ? study->loads[solved - 1] : 0;
    out[CONTACT_SCALAR_FULL_ITERATIONS] = sum_of(n, iterations);
    out[CONTACT_SCALAR_FULL_CUTS] = sum_of(n, finest_values(tally, MEASURE_CUTS, full));
    out[CONTACT_SCALAR_FULL_CHANGES] = sum_of(n, finest_values(tally, MEASURE_CHANGES, full));
    out[CONTACT_SCALAR_FULL_BALANCE] = largest_of(n, finest_values(tally, MEASURE_BALANCE, full));
    out[CONTACT_SCALAR_FULL_PENETRATION] =
        largest_of(n, finest_values(tally, MEASURE_DEEPEST, full));
    out[CONTACT_SCALAR_FULL_WEIGHTED_PENETRATION] =
        largest_of(n, finest_values(tally, MEASURE_PENETRATION, full));
    if (solved > 0)
        out[CONTACT_SCALAR_FULL_STRETCH] = finest_values(tally, MEASURE_STRETCH, full)[solved - 1];
    out[CONTACT_SCALAR_FULL_SLOPE] = tally->slope;
    out[CONTACT_SCALAR_FULL_QUALITY] = tally->quality;
}

/* Fits of the fraction against the load. */
static int measure_fits(const struct contact_case *study, const double *fraction, double *out,
                        struct error *err) {
    struct fit line = {NAN, NAN, NAN, NAN, 0}, power = line, erf = line;
    size_t n = study->load_count;
    int status = fit_light_load(n, study->loads, fraction, &line, err);
    if (status == 0)
        status = fit_power_law(n, study->loads, fraction, &power, err);
    if (status == 0)
        status = fit_erf(n, study->loads, fraction, &erf, err);
    out[CONTACT_SCALAR_KAPPA] = line.a;
    out[CONTACT_SCALAR_POWER_LAW_A] = power.a;
    out[CONTACT_SCALAR_POWER_LAW_B] = power.b;
    out[CONTACT_SCALAR_ERF_KAPPA] = erf.a;
    return status;
}

int contact_scalars_measure(struct contact_tally *tally, const struct roughness *roughness,
                            double nayak_alpha, const struct surface_report *report,
                            double out[CONTACT_SCALAR_COUNT], struct error *err) {
    const struct contact_case *study = tally->study;
    size_t n = study->load_count;
    const double *fraction = finest_values(tally, MEASURE_EDGES, 0);
    bool iterated = report->end != END_DIRECT;
    out[CONTACT_SCALAR_AREA_LAST] = fraction[n - 1];
    out[CONTACT_SCALAR_GAP_LAST] = finest_values(tally, MEASURE_GAP, 0)[n - 1];
    out[CONTACT_SCALAR_ITERATIONS] = sum_of(n, finest_values(tally, MEASURE_ITERATIONS, 0));
    out[CONTACT_SCALAR_VIOLATION] = largest_of(n, finest_values(tally, MEASURE_VIOLATION, 0));
    measure_full(tally, out);
    out[CONTACT_SCALAR_RMS_HEIGHT] = roughness->rms_height;
    out[CONTACT_SCALAR_RMS_SLOPE] = roughness->rms_slope;
    out[CONTACT_SCALAR_NAYAK_ALPHA] = nayak_alpha;
    out[CONTACT_SCALAR_SKEWNESS] = roughness->skewness;
    out[CONTACT_SCALAR_KURTOSIS] = roughness->kurtosis;
    out[CONTACT_SCALAR_GENERATOR_ITERATIONS] = (double)report->iterations;
    out[CONTACT_SCALAR_EPS_H] = iterated ? report->eps_h : NAN;
    out[CONTACT_SCALAR_EPS_S] = iterated ? report->eps_s : NAN;
    out[CONTACT_SCALAR_EPS_S0] = iterated ? report->eps_s0 : NAN;
    return measure_fits(study, fraction, out, err);
}

static void theories(const struct contact_case *study, const struct moments *moments,
                     double *theory) {
    struct height_moments heights;
    for (size_t a = 0; a < CONTACT_SCALAR_COUNT; a++)
        theory[a] = NAN;
    /* One wave alone has alpha = 1, and no light-load line. */
    if (study->surface.dimension == 2 || moments->nayak_alpha > 1 + 1e-9)
        theory[CONTACT_SCALAR_KAPPA] = theory[CONTACT_SCALAR_ERF_KAPPA] = persson_light_load();
    theory[CONTACT_SCALAR_RMS_HEIGHT] = moments->rms_height;
    theory[CONTACT_SCALAR_RMS_SLOPE] = moments->rms_slope;
    if (!surface_case_exact(&study->surface))
        theory[CONTACT_SCALAR_NAYAK_ALPHA] = moments->nayak_alpha;
    if (heights_moments(&study->surface.options.heights, &heights, NULL) == 0) {
        theory[CONTACT_SCALAR_SKEWNESS] = heights.skewness;
        theory[CONTACT_SCALAR_KURTOSIS] = heights.kurtosis;
    }
}

int contact_scalars_json(const struct contact_case *study, const struct moments *moments,
                         const struct realisations *realisations, cJSON **out, struct error *err) {
    double theory[CONTACT_SCALAR_COUNT];
    size_t n = (size_t)realisations->count;
    double *column = array_create(n, sizeof *column);
    cJSON *scalars = cJSON_CreateObject();
    bool done = column != NULL && scalars != NULL;
    theories(study, moments, theory);
    bool full = contact_case_full(study) < study->model_count;
    for (size_t a = 0; a < CONTACT_SCALAR_COUNT && done; a++) {
        bool of_full = a >= CONTACT_SCALAR_FULL_LOAD_REACHED && a <= CONTACT_SCALAR_FULL_QUALITY;
        if (of_full && !full)
            continue;
        realisations_column(realisations, a, column);
        struct estimate estimate = estimate_mean(n, column);
        if (a == CONTACT_SCALAR_NAYAK_ALPHA && surface_case_exact(&study->surface))
            estimate = (struct estimate){moments->nayak_alpha, 0};
        done = scalar_put(scalars, CONTACT_SCALARS[a], estimate, theory[a]);
    }
    /* as given, or as solved for nayak_alpha */
    done = done && scalar_put(scalars, "wavelength_ratio",
                              (struct estimate){study->surface.wavelength_ratio, 0}, NAN);
    free(column);
    if (!done) {
        cJSON_Delete(scalars);
        return error_memory(err, n * sizeof *column, "scalars");
    }
    *out = scalars;
    return 0;
}
