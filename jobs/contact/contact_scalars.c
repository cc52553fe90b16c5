#include "jobs/contact/contact_scalars.h"
#include "core/statistics/fit.h"
#include "core/theory/contact.h"
#include "jobs/contact/companion/companion_law.h"
#include "jobs/contact/contact_errors.h"
#include "jobs/estimate.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Mean fractions up to these are fitted (FORMULAS.md, section 16). */
#define LIGHT_LOAD_MOST 0.1
#define POWER_LAW_MOST 0.5
#define ERF_MOST (1 - 1e-9)

const struct contact_fit CONTACT_FITS[CONTACT_FIT_COUNT] = {
    {"kappa", MEASURE_KAPPA, LIGHT_LOAD_MOST, "kappa_loads", "kappa_highest_load",
     "kappa_residual"},
    {"power_law_a", MEASURE_POWER_LAW_A, POWER_LAW_MOST, "power_law_loads",
     "power_law_highest_load", "power_law_residual"},
    {"power_law_b", MEASURE_POWER_LAW_B, POWER_LAW_MOST, NULL, NULL, NULL},
    {"erf_kappa", MEASURE_ERF_KAPPA, ERF_MOST, "erf_loads", "erf_highest_load", "erf_residual"},
};

/* Scalars that the tally has at a load, with errors by source, in place of the mean of
 * realisations: a measure at the last load, or a fit. */
static const struct own_scalar {
    const char *name;
    bool tallied;
    enum contact_measure measure;
    const struct contact_fit *fit; /* NULL: none */
} OWN[CONTACT_SCALAR_COUNT] = {
    [CONTACT_SCALAR_KAPPA] = {"kappa", true, MEASURE_KAPPA, &CONTACT_FITS[0]},
    [CONTACT_SCALAR_POWER_LAW_A] = {"power_law_a", true, MEASURE_POWER_LAW_A, &CONTACT_FITS[1]},
    [CONTACT_SCALAR_POWER_LAW_B] = {"power_law_b", true, MEASURE_POWER_LAW_B, &CONTACT_FITS[2]},
    [CONTACT_SCALAR_ERF_KAPPA] = {"erf_kappa", true, MEASURE_ERF_KAPPA, &CONTACT_FITS[3]},
    [CONTACT_SCALAR_AREA_LAST] = {"contact_area_last", true, MEASURE_EDGES, NULL},
    [CONTACT_SCALAR_GAP_LAST] = {"mean_gap_last", true, MEASURE_GAP, NULL},
    [CONTACT_SCALAR_ITERATIONS] = {.name = "iterations"},
    [CONTACT_SCALAR_VIOLATION] = {.name = "violation"},
    [CONTACT_SCALAR_RMS_HEIGHT] = {.name = "rms_height"},
    [CONTACT_SCALAR_RMS_SLOPE] = {.name = "rms_slope"},
    [CONTACT_SCALAR_NAYAK_ALPHA] = {.name = "nayak_alpha"},
    [CONTACT_SCALAR_SKEWNESS] = {.name = "skewness"},
    [CONTACT_SCALAR_KURTOSIS] = {.name = "kurtosis"},
    [CONTACT_SCALAR_GENERATOR_ITERATIONS] = {.name = "generator_iterations"},
    [CONTACT_SCALAR_EPS_H] = {.name = "eps_h"},
    [CONTACT_SCALAR_EPS_S] = {.name = "eps_s"},
    [CONTACT_SCALAR_EPS_S0] = {.name = "eps_s0"},
};

/* The origin of a scalar: number `at` of the model's own, or, without a model, an enum
 * contact_scalar. */
struct origin {
    const struct contact_model *model;
    size_t at;
};

static struct origin origin_of(size_t scalar) {
    if (scalar < CONTACT_SCALARS_OF_MODELS)
        return (struct origin){NULL, scalar};
    for (size_t m = 0; CONTACT_MODELS[m] != NULL; m++) {
        size_t at = scalar - CONTACT_SCALARS_OF_MODELS;
        if (at < CONTACT_MODELS[m]->scalar_count)
            return (struct origin){CONTACT_MODELS[m], at};
        scalar -= CONTACT_MODELS[m]->scalar_count;
    }
    return (struct origin){NULL, scalar};
}

static size_t scalar_count(void) {
    size_t count = CONTACT_SCALAR_COUNT;
    for (size_t m = 0; CONTACT_MODELS[m] != NULL; m++)
        count += CONTACT_MODELS[m]->scalar_count;
    return count;
}

const char *contact_scalar_name(size_t scalar) {
    if (scalar >= scalar_count())
        return NULL;
    struct origin origin = origin_of(scalar);
    return origin.model != NULL ? origin.model->scalars[origin.at] : OWN[origin.at].name;
}

/* "layered_kappa": the name of a scalar of a model. */
struct model_text {
    char text[64];
};
static struct model_text model_text(const char *model, const char *name) {
    struct model_text out;
    (void)snprintf(out.text, sizeof out.text, "%s_%s", model, name);
    return out;
}

/* Returns the position of a model in a case; model_count if the case does not have it. */
static size_t position_of(const struct contact_case *one_case, const struct contact_model *model) {
    size_t m = 0;
    while (m < one_case->model_count && one_case->models[m] != model)
        m++;
    return m;
}

/* Returns the values of a measure on the finest level, by load. */
static const double *finest_values(struct contact_tally *tally, enum contact_measure measure,
                                   size_t model) {
    const struct contact_case *one_case = tally->one_case;
    return contact_tally_values(tally, measure) +
           contact_case_cell(one_case, model, one_case->level_count - 1, 0);
}

/* Measures the scalars of each model of the case, behind the scalars of all; NaN of other
 * models. */
static void measure_models(struct contact_tally *tally, double *out) {
    const struct contact_case *one_case = tally->one_case;
    double *at = out + CONTACT_SCALARS_OF_MODELS;
    for (size_t t = 0; CONTACT_MODELS[t] != NULL; t++) {
        const struct contact_model *model = CONTACT_MODELS[t];
        size_t m = position_of(one_case, model);
        for (size_t a = 0; a < model->scalar_count; a++)
            at[a] = NAN;
        if (m < one_case->model_count && model->measure != NULL) {
            struct model_values values = {.load_count = one_case->load_count,
                                          .loads = one_case->loads,
                                          .facts = tally->facts[m]};
            for (size_t a = 0; a < MEASURE_COUNT; a++)
                values.of[a] = finest_values(tally, (enum contact_measure)a, m);
            model->measure(&values, at);
        }
        at += model->scalar_count;
    }
}

/* Fits the fraction against the load. */
static int measure_fits(const struct contact_case *one_case, const double *fraction, double *out,
                        struct error *err) {
    struct fit line = {NAN, NAN, NAN, NAN, 0}, power = line, erf = line;
    size_t n = one_case->load_count;
    int status = fit_light_load(n, one_case->loads, fraction, &line, err);
    if (status == 0)
        status = fit_power_law(n, one_case->loads, fraction, &power, err);
    if (status == 0)
        status = fit_erf(n, one_case->loads, fraction, &erf, err);
    out[CONTACT_SCALAR_KAPPA] = line.a;
    out[CONTACT_SCALAR_POWER_LAW_A] = power.a;
    out[CONTACT_SCALAR_POWER_LAW_B] = power.b;
    out[CONTACT_SCALAR_ERF_KAPPA] = erf.a;
    return status;
}

int contact_scalars_measure(struct contact_tally *tally, const struct roughness *roughness,
                            double nayak_alpha, const struct surface_report *report, double *out,
                            struct error *err) {
    const struct contact_case *one_case = tally->one_case;
    size_t n = one_case->load_count;
    const double *fraction = finest_values(tally, MEASURE_EDGES, 0);
    bool iterated = report->end != END_DIRECT;
    double scalars[CONTACT_SCALAR_COUNT] = {
        [CONTACT_SCALAR_AREA_LAST] = fraction[n - 1],
        [CONTACT_SCALAR_GAP_LAST] = finest_values(tally, MEASURE_GAP, 0)[n - 1],
        [CONTACT_SCALAR_ITERATIONS] = model_sum(n, finest_values(tally, MEASURE_ITERATIONS, 0)),
        [CONTACT_SCALAR_VIOLATION] = model_largest(n, finest_values(tally, MEASURE_VIOLATION, 0)),
        [CONTACT_SCALAR_RMS_HEIGHT] = roughness->rms_height,
        [CONTACT_SCALAR_RMS_SLOPE] = roughness->rms_slope,
        [CONTACT_SCALAR_NAYAK_ALPHA] = nayak_alpha,
        [CONTACT_SCALAR_SKEWNESS] = roughness->skewness,
        [CONTACT_SCALAR_KURTOSIS] = roughness->kurtosis,
        [CONTACT_SCALAR_GENERATOR_ITERATIONS] = (double)report->iterations,
        [CONTACT_SCALAR_EPS_H] = iterated ? report->eps_h : NAN,
        [CONTACT_SCALAR_EPS_S] = iterated ? report->eps_s : NAN,
        [CONTACT_SCALAR_EPS_S0] = iterated ? report->eps_s0 : NAN,
    };
    int status = measure_fits(one_case, fraction, scalars, err);
    size_t count = scalar_count();
    for (size_t a = 0; a < count; a++) {
        struct origin origin = origin_of(a);
        if (origin.model == NULL)
            out[a] = scalars[origin.at];
    }
    measure_models(tally, out);
    return status;
}

static int theories(const struct contact_case *one_case, const struct moments *moments,
                    double *theory, struct error *err) {
    struct height_moments heights;
    bool known;
    for (size_t a = 0; a < CONTACT_SCALAR_COUNT; a++)
        theory[a] = NAN;
    /* A single wave has alpha = 1, and no light-load line. */
    if (!contact_case_is_coated(one_case) &&
        (one_case->surface.dimension == 2 || moments->nayak_alpha > 1 + 1e-9))
        theory[CONTACT_SCALAR_KAPPA] = theory[CONTACT_SCALAR_ERF_KAPPA] = persson_light_load();
    theory[CONTACT_SCALAR_RMS_HEIGHT] = moments->rms_height;
    theory[CONTACT_SCALAR_RMS_SLOPE] = moments->rms_slope;
    if (!surface_case_exact(&one_case->surface) && one_case->surface.plateau == NULL)
        theory[CONTACT_SCALAR_NAYAK_ALPHA] = moments->nayak_alpha;
    if (one_case->surface.grooves != NULL) {
        const struct groove_moments grooves = grooves_cumulants(one_case->surface.grooves);
        const double slope = moments->rms_slope * moments->rms_slope + moments->m0 * grooves.slope;
        theory[CONTACT_SCALAR_KAPPA] = theory[CONTACT_SCALAR_ERF_KAPPA] = NAN;
        theory[CONTACT_SCALAR_NAYAK_ALPHA] = NAN;
        theory[CONTACT_SCALAR_RMS_HEIGHT] = sqrt(moments->m0 * (1 + grooves.second));
        theory[CONTACT_SCALAR_RMS_SLOPE] = isfinite(slope) ? sqrt(slope) : (double)NAN;
    }
    int status = surface_case_heights(&one_case->surface, &heights, &known, err);
    if (status == 0 && known) {
        theory[CONTACT_SCALAR_SKEWNESS] = heights.skewness;
        theory[CONTACT_SCALAR_KURTOSIS] = heights.kurtosis;
    }
    return status;
}

/* --- scalars of the tally --- */

/* Returns the mean of a measure of a model on the finest level. */
static struct estimate mean_of(const struct contact_tally *tally, enum contact_measure measure,
                               size_t model, size_t load) {
    return contact_mean(tally, measure, model, tally->one_case->level_count - 1, load);
}

/* Returns the number of loads, from the lightest on, at which the mean area of a model is at most
 * this. */
static size_t loads_within(const struct contact_tally *tally, size_t model, double most) {
    size_t n = 0;
    while (n < tally->one_case->load_count && mean_of(tally, MEASURE_EDGES, model, n).value <= most)
        n++;
    return n;
}

/* Sets a scalar to a measure of a model at the last of the first `loads` loads; none without
 * loads. */
static int put_measure(const struct contact_tally *tally, enum contact_measure measure,
                       size_t model, size_t loads, struct scalar *out, struct error *err) {
    const struct contact_case *one_case = tally->one_case;
    struct estimate mean = {NAN, NAN};
    struct contact_error *errors = array_create(one_case->load_count, sizeof *errors);
    if (errors == NULL)
        return error_memory(err, one_case->load_count * sizeof *errors, "errors of a scalar");
    out->effective = 0;
    if (loads > 0) {
        const size_t last =
            contact_case_cell(one_case, model, one_case->level_count - 1, loads - 1);
        const uint64_t valueless = contact_tally_valueless(tally, measure, last);
        mean = mean_of(tally, measure, model, loads - 1);
        if (valueless > 0)
            out->effective = (double)(tally->realisations - valueless);
    }
    out->value = mean.value;
    out->standard_error = mean.standard_error;
    for (enum error_source s = 0; s < ERROR_SOURCES; s++) {
        struct scalar_error *to = &out->errors[s];
        to->applies = contact_error_applies(tally, measure, model, one_case->level_count - 1, s);
        if (loads == 0 || !contact_errors(tally, measure, model, s, errors))
            continue;
        const struct contact_error *from = &errors[loads - 1];
        *to = (struct scalar_error){.applies = true,
                                    .known = !isnan(from->value),
                                    .value = from->value,
                                    .bound = from->bound,
                                    .standard_error = from->standard_error};
    }
    free(errors);
    return 0;
}

/* Sets the law difference of the same. */
static int put_law(const struct contact_tally *tally, enum contact_measure measure, size_t model,
                   size_t loads, struct scalar *out, struct error *err) {
    size_t count = tally->one_case->load_count;
    struct estimate *differences = array_create(count, sizeof *differences);
    if (differences == NULL)
        return error_memory(err, count * sizeof *differences, "differences of a scalar");
    if (loads > 0 && companion_law_difference(tally, measure, model, differences)) {
        out->law_difference = differences[loads - 1].value;
        out->law_standard_error = differences[loads - 1].standard_error;
    }
    free(differences);
    return 0;
}

bool contact_scalar_fit(const struct contact_tally *tally, size_t scalar, enum contact_measure *fit,
                        size_t *loads) {
    if (scalar >= CONTACT_SCALARS_OF_MODELS || OWN[scalar].fit == NULL)
        return false;
    *fit = OWN[scalar].measure;
    *loads = loads_within(tally, 0, OWN[scalar].fit->area_most);
    return true;
}

/* Replaces the mean over realisations of a scalar that the tally has at a load. */
static int put_tallied(const struct contact_tally *tally, size_t scalar, struct scalar *out,
                       struct error *err) {
    const struct own_scalar *own = &OWN[scalar];
    if (!own->tallied)
        return 0;
    size_t loads = own->fit != NULL ? loads_within(tally, 0, own->fit->area_most)
                                    : tally->one_case->load_count;
    int status = put_measure(tally, own->measure, 0, loads, out, err);
    return status != 0 ? status : put_law(tally, own->measure, 0, loads, out, err);
}

/* --- fits of each model --- */

static double fitted(enum contact_measure fit, double a, double b, double load) {
    if (fit == MEASURE_POWER_LAW_A)
        return a * pow(load, b);
    return fit == MEASURE_KAPPA ? a * load : erf(sqrt(M_PI) / 2 * a * load);
}

/* Appends a scalar whose name begins with that of the model. */
static int put_of_model(struct case_result *out, const char *model, struct scalar scalar,
                        struct error *err) {
    if (model != NULL)
        scalar.name = result_text(out, model_text(model, scalar.name).text);
    return scalar.name != NULL ? result_add_scalar(out, &scalar, err)
                               : error_set(err, ERROR_MEMORY, "no memory left for scalars");
}

static int put_named(struct case_result *out, const char *model, const char *name, double value,
                     double standard_error, struct error *err) {
    return put_of_model(out, model, scalar_named(name, value, standard_error, NAN), err);
}

int contact_scalars_put_range(const struct contact_fit *fit, const char *model,
                              const struct contact_case *one_case, size_t loads, const double *area,
                              double a, double b, struct case_result *out, struct error *err) {
    double squares = 0, size = 0;
    if (fit->count == NULL)
        return 0;
    int status = put_named(out, model, fit->count, (double)loads, 0, err);
    if (status != 0 || loads == 0)
        return status;
    for (size_t k = 0; k < loads; k++) {
        double residual = area[k] - fitted(fit->measure, a, b, one_case->loads[k]);
        squares += residual * residual;
        size += area[k] * area[k];
    }
    status = put_named(out, model, fit->highest, one_case->loads[loads - 1], 0, err);
    return status != 0 ? status
                       : put_named(out, model, fit->residual, sqrt(squares / size), NAN, err);
}

/* Appends the value of a fit of a model that is not the first, whose values are scalars of each
 * realisation. */
static int put_value(const struct contact_tally *tally, const struct contact_fit *fit, size_t model,
                     size_t loads, struct case_result *out, struct error *err) {
    const char *name = contact_model_name(tally->one_case->models[model]);
    struct scalar scalar = scalar_named(fit->name, NAN, NAN, NAN);
    int status = put_measure(tally, fit->measure, model, loads, &scalar, err);
    if (status == 0)
        status = put_law(tally, fit->measure, model, loads, &scalar, err);
    return status == 0 ? put_of_model(out, name, scalar, err) : status;
}

/* Appends the fits of a model with what they were made on. area: scratch, a value a load. */
static int put_fits(const struct contact_tally *tally, size_t model, double *area,
                    struct case_result *out, struct error *err) {
    const struct contact_case *one_case = tally->one_case;
    const char *name = model > 0 ? contact_model_name(one_case->models[model]) : NULL;
    int status = 0;
    for (size_t k = 0; k < one_case->load_count; k++)
        area[k] = mean_of(tally, MEASURE_EDGES, model, k).value;
    for (size_t f = 0; f < CONTACT_FIT_COUNT && status == 0; f++) {
        const struct contact_fit *fit = &CONTACT_FITS[f];
        size_t loads = loads_within(tally, model, fit->area_most), last = loads > 0 ? loads - 1 : 0;
        if (model > 0)
            status = put_value(tally, fit, model, loads, out, err);
        if (status == 0)
            status = contact_scalars_put_range(
                fit, name, one_case, loads, area, mean_of(tally, fit->measure, model, last).value,
                mean_of(tally, MEASURE_POWER_LAW_B, model, last).value, out, err);
    }
    return status;
}

static int put_all_fits(const struct contact_tally *tally, struct case_result *out,
                        struct error *err) {
    const struct contact_case *one_case = tally->one_case;
    double *area = array_create(one_case->load_count, sizeof *area);
    int status = area != NULL ? 0 : error_memory(err, sizeof *area, "fits");
    for (size_t m = 0; m < one_case->model_count && status == 0; m++)
        status = put_fits(tally, m, area, out, err);
    free(area);
    return status;
}

static int add_scalars(const struct contact_case *one_case, const struct moments *moments,
                       const struct contact_tally *tally, const struct realisations *realisations,
                       double *column, struct case_result *out, struct error *err) {
    double theory[CONTACT_SCALAR_COUNT];
    size_t count = scalar_count();
    int status = theories(one_case, moments, theory, err);
    for (size_t a = 0; a < count && status == 0; a++) {
        struct origin origin = origin_of(a);
        bool own = origin.model != NULL;
        if (own && position_of(one_case, origin.model) == one_case->model_count)
            continue;
        realisations_column(realisations, a, column);
        struct estimate mean = estimate_mean((size_t)realisations->count, column);
        if (!own && origin.at == CONTACT_SCALAR_NAYAK_ALPHA &&
            surface_case_exact(&one_case->surface))
            mean = (struct estimate){moments->nayak_alpha, 0};
        struct scalar scalar = scalar_named(contact_scalar_name(a), mean.value, mean.standard_error,
                                            own ? (double)NAN : theory[origin.at]);
        scalar.effective = estimate_effective((size_t)realisations->count, column, NULL);
        if (!own)
            status = put_tallied(tally, origin.at, &scalar, err);
        if (status == 0)
            status = result_add_scalar(out, &scalar, err);
    }
    if (status == 0)
        status = put_all_fits(tally, out, err);
    const struct scalar hurst = scalar_named("hurst", one_case->surface.spectrum.hurst, 0, NAN);
    if (status == 0 && one_case->surface.hurst_solved)
        status = result_add_scalar(out, &hurst, err);
    if (status != 0)
        return status;
    /* as given, or as solved for nayak_alpha */
    const struct scalar ratio =
        scalar_named("wavelength_ratio", one_case->surface.wavelength_ratio, 0, NAN);
    return result_add_scalar(out, &ratio, err);
}

int contact_scalars(const struct contact_case *one_case, const struct moments *moments,
                    const struct contact_tally *tally, const struct realisations *realisations,
                    struct case_result *out, struct error *err) {
    size_t n = (size_t)realisations->count;
    double *column = array_create(n, sizeof *column);
    if (column == NULL)
        return error_memory(err, n * sizeof *column, "scalars");
    int status = add_scalars(one_case, moments, tally, realisations, column, out, err);
    free(column);
    return status;
}
