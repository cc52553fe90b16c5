#include "jobs/contact/contact_curves.h"
#include "core/theory/bin_averages.h"
#include "core/theory/contact.h"
#include "core/theory/translated_asperities.h"
#include "jobs/contact/coated_theory.h"
#include "jobs/contact/companion/companion_law.h"
#include "jobs/contact/contact_errors.h"
#include "jobs/contact/contact_measure.h"
#include "jobs/surface/translated_case.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* --- theories --- */

/* Values at the loads of the case, in a result's arena. Fractions above 1, which light-load
 * theories reach, are NaN. */
struct theories {
    double coating; /* coated_theory_factor */
    size_t count[THEORIES_KINDS];
    struct theory of[THEORIES_KINDS][THEORIES_MOST];
};

/* Returns whether a spectrum is one wave and its conjugate (or, at the Nyquist frequency,
 * itself). */
static bool is_one_wave(const struct contact_case *one_case, const struct modes *modes) {
    return one_case->surface.dimension == 1 && modes->count <= 2;
}

/* Returns whether Persson's theory is not known: of a wave, of grooves beside a random part, and of
 * a coating on a stratified face, whose slopes are known but not its spectrum. */
static bool lacks_theory(const struct contact_case *one_case, const struct modes *modes) {
    return is_one_wave(one_case, modes) || one_case->surface.grooves != NULL ||
           (contact_case_is_coated(one_case) && one_case->surface.plateau != NULL);
}

/* Returns whether theories of Gaussian isotropic asperities apply. */
static bool has_asperities(const struct contact_case *one_case, const struct moments *moments) {
    return one_case->surface.dimension == 2 && surface_case_gaussian(&one_case->surface) &&
           translated_case_applies(&one_case->surface, moments);
}

/* Returns p/p* of the wave sqrt(2 m0) cos: its RMS slope is pi sqrt(2) amplitude/wavelength, and p*
 * = pi E* amplitude/wavelength. */
static double westergaard_ratio(double load) {
    return fmin(sqrt(2) * load, 1);
}

/* A list of theories, with room for THEORIES_MOST of them. */
struct theory_list {
    const struct contact_case *one_case;
    struct theories *out;
    double *values;
};

static void put(struct theory_list *list, enum measure_theories of, const char *name) {
    list->out->of[of][list->out->count[of]++] = (struct theory){name, list->values};
    list->values += list->one_case->load_count;
}

/* Adds fractions of contact; those above 1 become NaN. */
static void put_area(struct theory_list *list, const char *name,
                     double (*area)(double load, double alpha), double alpha) {
    size_t n = list->one_case->load_count;
    for (size_t k = 0; k < n; k++) {
        double fraction = area(list->one_case->loads[k], alpha);
        list->values[k] = fraction <= 1 ? fraction : NAN;
    }
    put(list, THEORIES_AREA, name);
}

static double persson_at(double load, double factor) {
    return persson_area(factor * load);
}

static double line_at(double load, double kappa) {
    return kappa * load;
}

static double westergaard_at(double load, double alpha) {
    (void)alpha;
    return westergaard_area(westergaard_ratio(load));
}

static void put_wave(struct theory_list *list) {
    const struct contact_case *one_case = list->one_case;
    put_area(list, "westergaard", westergaard_at, 0);
    for (size_t k = 0; k < one_case->load_count; k++) /* the amplitude is sqrt(2 m0) */
        list->values[k] = sqrt(2) * westergaard_gap(westergaard_ratio(one_case->loads[k]));
    put(list, THEORIES_GAP, "westergaard");
}

/* Adds the theory, unless it has none of the areas. */
static int put_translated(struct theory_list *list, const struct translated_surface *surface,
                          enum translated_theory theory, const char *name, struct error *err) {
    struct translated_asperities *asperities = NULL;
    int status = translated_asperities_create(&asperities, surface, theory, err);
    bool any = false;
    for (size_t k = 0; k < list->one_case->load_count && status == 0; k++) {
        double fraction = translated_asperities_area(asperities, list->one_case->loads[k]);
        bool within = fraction > 0 && fraction <= 1;
        list->values[k] = within ? fraction : NAN;
        any = any || within;
    }
    translated_asperities_destroy(&asperities);
    if (any)
        put(list, THEORIES_AREA, name);
    return status;
}

/* Adds the theories by the summits of the translated surface: that of the case, or the one beside
 * it. */
static int put_summits(struct theory_list *list, const struct modes *modes,
                       const struct moments *moments, struct error *err) {
    struct translated_case translated;
    if (list->one_case->surface.dimension != 2 || list->one_case->surface.counter != NULL ||
        !translated_case_applies(&list->one_case->surface, moments))
        return 0;
    int status = translated_case_create(&translated, &list->one_case->surface, modes, err);
    if (status != 0)
        return status;
    const struct translated_surface *surface = &translated.surface;
    if (translated.exists)
        status = put_translated(list, surface, TRANSLATED_GW, "gw_translation", err);
    if (translated.exists && status == 0)
        status = put_translated(list, surface, TRANSLATED_BGT, "bgt_translation", err);
    translated_case_clear(&translated);
    return status;
}

static void put_plastic(struct theory_list *list, double factor) {
    const struct contact_case *one_case = list->one_case;
    for (size_t k = 0; k < one_case->load_count; k++)
        list->values[k] =
            persson_plastic_area(factor * one_case->loads[k], factor * one_case->hardness);
    put(list, THEORIES_PLASTIC, "persson");
}

/* Theories of asperities are those of one material. */
static void put_rough(struct theory_list *list, const struct moments *moments) {
    double factor = list->out->coating;
    put_area(list, "persson", persson_at, factor);
    if (list->one_case->hardness > 0)
        put_plastic(list, factor);
    put_area(list, "persson_light_load", line_at, factor * persson_light_load());
    if (contact_case_is_coated(list->one_case))
        return;
    if (list->one_case->surface.dimension == 2)
        put_area(list, "bgt_light_load", line_at, bgt_light_load());
    if (has_asperities(list->one_case, moments)) {
        put_area(list, "gw_mccool", gw_mccool_area, moments->nayak_alpha);
        put_area(list, "bgt", bgt_area, moments->nayak_alpha);
    }
}

/* Makes the theories. modes, moments: of the prescribed spectrum. A profile of one wave has
 * Westergaard's solution; all others have Persson's theory and those of asperities that apply. With
 * a coating there is Persson's alone. */
static int theories_make(struct theories *out, const struct contact_case *one_case,
                         const struct modes *modes, const struct moments *moments,
                         struct case_result *result, struct error *err) {
    *out = (struct theories){.coating = coated_theory_factor(one_case, modes)};
    struct theory_list list = {one_case, out,
                               result_numbers(result, THEORIES_MOST * one_case->load_count)};
    if (list.values == NULL)
        return error_memory(err, THEORIES_MOST * one_case->load_count * sizeof(double), "theories");
    /* No theory here has the mean of a wave of random amplitude. */
    bool coated = contact_case_is_coated(one_case);
    if (is_one_wave(one_case, modes) && surface_case_exact(&one_case->surface) && !coated)
        put_wave(&list);
    if (lacks_theory(one_case, modes))
        return 0;
    put_rough(&list, moments);
    return coated ? 0 : put_summits(&list, modes, moments, err);
}

/* --- curves --- */

/* What all curves of a case are made from. */
struct contact_curve_maker {
    const struct contact_case *one_case;
    const struct modes *modes;
    const struct contact_tally *tally;
    struct theories theories;
    struct case_result *result;   /* its arena owns all arrays */
    struct contact_error *errors; /* scratch: one for each load, as the next */
    struct estimate *differences;
};

/* Computes the mean density of the pressures in each bin; false without a theory. */
static bool theory_pressures(const struct contact_curve_maker *maker, double load, double *pdf) {
    const struct contact_case *one_case = maker->one_case;
    if (lacks_theory(one_case, maker->modes))
        return false;
    /* Of pressures times the factor, as the load is. */
    double factor = maker->theories.coating;
    const struct bins *bins = &one_case->pressure;
    const struct bins scaled = {factor * bins->low, factor * bins->high, bins->count};
    bin_averages_persson(factor * load, &scaled, pdf);
    for (size_t b = 0; b < bins->count; b++)
        pdf[b] *= factor;
    return true;
}

static int no_room(struct error *err) {
    return error_set(err, ERROR_MEMORY, "no memory left for curves");
}

/* A curve over the loads. */
struct row {
    const char *quantity, *series, *y_label;
    enum contact_measure measure;
    double factor; /* y is the measure times this */
};

/* Returns the kinematics of strain; NULL where there is nothing to choose. */
static const char *kinematics_of(const struct contact_case *one_case, size_t model) {
    const struct contact_model *of = one_case->models[model];
    return of->kinematics != NULL ? of->kinematics(one_case) : NULL;
}

/* Makes a curve with the attributes of its model and level. */
static struct curve curve_of(const struct contact_case *one_case, size_t model, size_t level,
                             const char *quantity, const char *x_label, const char *y_label) {
    struct curve curve = curve_named(quantity, x_label, y_label);
    curve.model = contact_model_name(one_case->models[model]);
    curve.kinematics = kinematics_of(one_case, model);
    curve.level = one_case->levels[level].points;
    curve.points = (double)grid_points(&one_case->levels[level].grid);
    return curve;
}

/* Returns the mean of the orders observed on the levels; NaN without any. */
static double mean_order(size_t n, const struct contact_error *errors) {
    double sum = 0, count = 0;
    for (size_t k = 0; k < n; k++)
        if (!isnan(errors[k].order)) {
            sum += errors[k].order;
            count++;
        }
    return sum / count;
}

/* Adds the error of one source, `factor` times that of the measure. */
static int put_errors(struct contact_curve_maker *maker, enum measure_by by, double factor,
                      const struct contact_error *errors, struct curve_error *out,
                      struct error *err) {
    const struct contact_case *one_case = maker->one_case;
    size_t n = contact_case_points(one_case, by);
    double *value = result_numbers(maker->result, 3 * n);
    if (value == NULL)
        return no_room(err);
    double *bound = value + n, *standard_error = bound + n;
    for (size_t i = 0; i < n; i++) {
        const struct contact_error *at = &errors[contact_case_point(one_case, by, i)];
        value[i] = factor * at->value;
        bound[i] = factor * at->bound;
        standard_error[i] = factor * at->standard_error;
    }
    double order = mean_order(contact_case_values(one_case, by), errors);
    *out = (struct curve_error){.applies = true,
                                .value = value,
                                .bound = bound,
                                .standard_error = standard_error,
                                .order = order,
                                .order_observed = !isnan(order)};
    return 0;
}

/* Adds all sources that bear on a measure; their errors are known on the finest level. */
static int add_errors(struct contact_curve_maker *maker, const struct row *row, size_t model,
                      size_t level, struct curve *curve, struct error *err) {
    const struct contact_case *one_case = maker->one_case;
    bool finest = level + 1 == one_case->level_count;
    int status = 0;
    for (enum error_source s = 0; s < ERROR_SOURCES && status == 0; s++) {
        curve->errors[s].applies =
            contact_error_applies(maker->tally, row->measure, model, level, s);
        if (finest && contact_errors(maker->tally, row->measure, model, s, maker->errors))
            status = put_errors(maker, measure_row(row->measure)->by, row->factor, maker->errors,
                                &curve->errors[s], err);
    }
    return status;
}

/* Adds the law difference, which is known on the finest level. */
static int add_law(struct contact_curve_maker *maker, const struct row *row, size_t model,
                   struct curve *curve, struct error *err) {
    const struct contact_case *one_case = maker->one_case;
    enum measure_by by = measure_row(row->measure)->by;
    size_t n = contact_case_points(one_case, by);
    if (!companion_law_difference(maker->tally, row->measure, model, maker->differences))
        return 0;
    double *difference = result_numbers(maker->result, 2 * n);
    if (difference == NULL)
        return no_room(err);
    double *standard_error = difference + n;
    for (size_t i = 0; i < n; i++) {
        const struct estimate *at = &maker->differences[contact_case_point(one_case, by, i)];
        difference[i] = row->factor * at->value;
        standard_error[i] = row->factor * at->standard_error;
    }
    curve->law_difference = difference;
    curve->law_standard_error = standard_error;
    return 0;
}

/* Returns what a curve runs over at a load, or at a point of sliding. */
static double abscissa(const struct contact_case *one_case, enum measure_by by, size_t k) {
    if (by == BY_SLIDING)
        return contact_case_slid(one_case, k);
    double load = one_case->loads[k];
    return by == BY_SLIP ? 1 - load / one_case->loads[one_case->slip_load] : load;
}

static int append(struct contact_curve_maker *maker, const struct row *row, size_t model,
                  size_t level, struct error *err) {
    const struct contact_case *one_case = maker->one_case;
    const struct theories *theories = &maker->theories;
    const struct measure *of = measure_row(row->measure);
    static const char *const X_LABELS[] = {
        [BY_LOAD] = "p/(E* h'_rms)", [BY_SLIP] = "Q/(mu P)", [BY_SLIDING] = "sliding/sqrt(m0)"};
    struct curve curve =
        curve_of(one_case, model, level, row->quantity, X_LABELS[of->by], row->y_label);
    size_t n = contact_case_points(one_case, of->by);
    double *x = result_numbers(maker->result, 4 * n), factor = row->factor;
    if (x == NULL)
        return no_room(err);
    double *y = x + n, *standard_error = y + n, *valueless = standard_error + n;
    if (of->cell == CELL_POINT)
        factor *= curve.points;
    for (size_t i = 0; i < n; i++) {
        size_t k = contact_case_point(one_case, of->by, i);
        size_t cell = contact_case_cell(one_case, model, level, k);
        struct estimate mean = contact_mean(maker->tally, row->measure, model, level, k);
        x[i] = abscissa(one_case, of->by, k);
        y[i] = factor * mean.value;
        standard_error[i] = factor * mean.standard_error;
        valueless[i] = (double)contact_tally_valueless(maker->tally, row->measure, cell);
    }
    if (of->by != BY_LOAD)
        curve.pressure = one_case->loads[one_case->slip_load];
    curve.series = row->series;
    curve_set_points(&curve, n, x, y, standard_error);
    if (of->values == VALUES_REPORTED || one_case->models[model]->may_fail)
        curve.valueless = valueless;
    curve.theory_count = theories->count[of->theories];
    memcpy(curve.theories, theories->of[of->theories], sizeof curve.theories);
    int status = add_errors(maker, row, model, level, &curve, err);
    if (status == 0 && level + 1 == one_case->level_count)
        status = add_law(maker, row, model, &curve, err);
    return status != 0 ? status : result_add_curve(maker->result, &curve, err);
}

/* Appends every level of a model, the finest first. */
static int append_model(struct contact_curve_maker *maker, const struct row *row, size_t model,
                        struct error *err) {
    int status = 0;
    for (size_t l = maker->one_case->level_count; l > 0 && status == 0; l--)
        status = append(maker, row, model, l - 1, err);
    return status;
}

/* Appends the curves of all models that show the measure. */
static int append_row(struct contact_curve_maker *maker, const struct row *row, struct error *err) {
    const struct contact_case *one_case = maker->one_case;
    int status = 0;
    for (size_t m = 0; m < one_case->model_count && status == 0; m++)
        if (measure_row(row->measure)->shown(one_case, m))
            status = append_model(maker, row, m, err);
    return status;
}

/* A measure that grows with the cell is reported for the cell, and for a longest wave. */
static int append_measure(struct contact_curve_maker *maker, enum contact_measure measure,
                          struct error *err) {
    const struct surface_case *surface = &maker->one_case->surface;
    const struct measure *of = measure_row(measure);
    if (of->quantity == NULL)
        return 0;
    const char *in_cell = measure_label(of, UNIT_CELL, surface->dimension, maker->result);
    const struct row cell = {of->quantity, of->series, in_cell, measure, 1};
    int status = in_cell != NULL ? append_row(maker, &cell, err) : no_room(err);
    if (status != 0 || of->cell != CELL_GROWS)
        return status;
    const char *of_wave = measure_label(of, UNIT_WAVE, surface->dimension, maker->result);
    const struct row wave = {of->quantity, "wave", of_wave, measure,
                             measure_factor(of->cell, surface_case_waves(surface))};
    return of_wave != NULL ? append_row(maker, &wave, err) : no_room(err);
}

/* Appends the curves that a model alone has. */
static int append_own(struct contact_curve_maker *maker, size_t m, struct error *err) {
    const struct contact_model *model = maker->one_case->models[m];
    int status = 0;
    for (size_t a = 0; a < model->curve_count && status == 0; a++) {
        const struct model_curve *own = &model->curves[a];
        enum contact_measure measure = (enum contact_measure)(MEASURE_OWN + own->measure);
        const struct row row = {own->quantity, "", own->y_label, measure, 1};
        status = append_model(maker, &row, m, err);
    }
    return status;
}

/* Adds the error of the density of pressures by the patch: that by the change of the area. */
static int put_patch(struct contact_curve_maker *maker, size_t model, size_t at,
                     struct curve *curve, struct error *err) {
    const struct contact_case *one_case = maker->one_case;
    const size_t n = curve->n, load = one_case->pdf_loads[at];
    if (!contact_errors(maker->tally, MEASURE_EDGES, model, ERROR_PATCH, maker->errors) ||
        isnan(maker->errors[load].value))
        return 0;
    double *value = result_numbers(maker->result, 3 * n);
    if (value == NULL)
        return no_room(err);
    const struct contact_error *of_area = &maker->errors[load];
    const double area =
        contact_mean(maker->tally, MEASURE_EDGES, model, one_case->level_count - 1, load).value;
    for (size_t b = 0; b < n; b++) {
        const double by = contact_errors_stretch(n, curve->x, curve->y, b) / area;
        value[b] = by * of_area->value;
        value[n + b] = fabs(by) * of_area->bound;
        value[2 * n + b] = fabs(by) * of_area->standard_error;
    }
    curve->errors[ERROR_PATCH] = (struct curve_error){.applies = true,
                                                      .value = value,
                                                      .bound = value + n,
                                                      .standard_error = value + 2 * n,
                                                      .order = NAN};
    return 0;
}

/* Adds the law difference of the density of pressures, which is x and y of the curve: that by the
 * change of the area. */
static int put_law(struct contact_curve_maker *maker, size_t model, size_t at, struct curve *curve,
                   struct error *err) {
    const struct contact_case *one_case = maker->one_case;
    size_t n = curve->n, load = one_case->pdf_loads[at];
    if (!companion_law_difference(maker->tally, MEASURE_EDGES, model, maker->differences) ||
        isnan(maker->differences[load].value))
        return 0;
    double *difference = result_numbers(maker->result, 2 * n);
    if (difference == NULL)
        return no_room(err);
    const struct estimate *of_area = &maker->differences[load];
    double area =
        contact_mean(maker->tally, MEASURE_EDGES, model, one_case->level_count - 1, load).value;
    for (size_t b = 0; b < n; b++) {
        double by = contact_errors_stretch(n, curve->x, curve->y, b) / area;
        difference[b] = by * of_area->value;
        difference[n + b] = fabs(by) * of_area->standard_error;
    }
    curve->law_difference = difference;
    curve->law_standard_error = difference + n;
    return 0;
}

/* Appends the density over the nominal area. Its integral is the fraction in contact by edges, its
 * first moment the load. Under- and overflow are in undeformed areas of nodes. */
static int append_pressures(struct contact_curve_maker *maker, size_t model, size_t at,
                            struct error *err) {
    const struct contact_case *one_case = maker->one_case;
    const struct bins *bins = &one_case->pressure;
    size_t n = bins->count, finest = one_case->level_count - 1;
    double load = one_case->loads[one_case->pdf_loads[at]], width = bins_width(bins);
    double parts = (double)CONTACT_AREA_PARTS;
    size_t cell = contact_case_cell(one_case, model, finest, one_case->pdf_loads[at]);
    const uint64_t *count = maker->tally->pressures.count +
                            contact_tally_pressure_cell(maker->tally, model, finest, at);
    double *x = result_numbers(maker->result, 11 * n);
    struct estimate *shares = result_room(maker->result, 2 * n, sizeof *shares);
    if (x == NULL || shares == NULL)
        return no_room(err);
    double *y = x + n, *standard_error = y + n, *valueless = standard_error + n;
    double *pdf = valueless + n, *none = pdf + n, *bound = none + n, *chance = bound + n;
    double *of_model = chance + n;
    contact_tally_pressure_shares(maker->tally, model, finest, at, shares);
    for (size_t b = 0; b < n; b++) {
        x[b] = bins_centre(bins, b);
        y[b] = shares[b].value / width;
        standard_error[b] = shares[b].standard_error / width;
        valueless[b] = (double)contact_tally_valueless(maker->tally, MEASURE_NODES, cell);
    }
    struct curve curve = curve_of(one_case, model, finest, "contact_pressure_pdf",
                                  "local p/(E* h'_rms)", "probability density");
    curve.pressure = load;
    for (enum error_source s = 0; s < ERROR_SOURCES; s++)
        curve.errors[s].applies =
            contact_error_applies(maker->tally, MEASURE_NODES, model, finest, s);
    if (contact_errors_pressures(maker->tally, model, at, shares, shares + n, bound, chance)) {
        curve.errors[ERROR_DISCRETISATION] = (struct curve_error){
            .applies = true, .value = none, .bound = bound, .standard_error = chance, .order = NAN};
    }
    if (contact_errors_density_model(maker->tally, model, at, shares, shares + n, of_model,
                                     of_model + n, of_model + 2 * n))
        curve.errors[ERROR_MODEL] = (struct curve_error){.applies = true,
                                                         .value = of_model,
                                                         .bound = of_model + n,
                                                         .standard_error = of_model + 2 * n,
                                                         .order = NAN};
    curve_set_points(&curve, n, x, y, standard_error);
    if (theory_pressures(maker, load, pdf))
        curve.theories[curve.theory_count++] = (struct theory){"persson", pdf};
    if (one_case->models[model]->may_fail)
        curve.valueless = valueless;
    curve.counted = true;
    curve.underflow = (double)count[0] / parts;
    curve.overflow = (double)count[n + 1] / parts;
    int status = put_patch(maker, model, at, &curve, err);
    if (status == 0)
        status = put_law(maker, model, at, &curve, err);
    return status != 0 ? status : result_add_curve(maker->result, &curve, err);
}

int contact_curves(const struct contact_case *one_case, const struct modes *modes,
                   const struct moments *moments, const struct contact_tally *tally,
                   struct case_result *out, struct error *err) {
    struct contact_curve_maker maker = {
        .one_case = one_case, .modes = modes, .tally = tally, .result = out};
    maker.errors = result_room(out, contact_case_slots(one_case), sizeof *maker.errors);
    maker.differences = result_room(out, contact_case_slots(one_case), sizeof *maker.differences);
    if (maker.errors == NULL || maker.differences == NULL)
        return no_room(err);
    int status = theories_make(&maker.theories, one_case, modes, moments, out, err);
    for (size_t a = 0; a < MEASURE_OWN && status == 0; a++)
        status = append_measure(&maker, MEASURE_CURVES[a], err);
    for (size_t m = 0; m < one_case->model_count && status == 0; m++)
        status = append_own(&maker, m, err);
    for (size_t m = 0; m < one_case->model_count; m++)
        for (size_t a = 0; a < one_case->pdf_count && status == 0; a++)
            status = append_pressures(&maker, m, a, err);
    return status;
}
