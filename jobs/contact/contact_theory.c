#include "jobs/contact/contact_theory.h"
#include "core/theory/bin_averages.h"
#include "core/theory/contact.h"
#include <math.h>
#include <stdlib.h>

/* One wave and its conjugate (or, at the Nyquist frequency, itself). */
static bool is_one_wave(const struct contact_case *study, const struct modes *modes) {
    return study->surface.dimension == 1 && modes->count <= 2;
}

/* Whether theories of Gaussian isotropic asperities apply. */
static bool has_asperities(const struct contact_case *study, const struct moments *moments) {
    const struct spectrum *spectrum = &study->surface.spectrum;
    return study->surface.dimension == 2 && moments->nayak_alpha > 1.5 &&
           study->surface.options.heights.type == HEIGHTS_GAUSSIAN &&
           (spectrum->type != SPECTRUM_EXPONENTIAL_ACF ||
            spectrum->correlation_x == spectrum->correlation_y);
}

/* p/p* of the wave sqrt(2 m0) cos: its RMS slope is pi sqrt(2) amplitude/wavelength, and
 * p* = pi E* amplitude/wavelength. */
static double westergaard_ratio(double load) {
    return fmin(sqrt(2) * load, 1);
}

/* Rows of theories: their values are put one behind the other. */
struct theory_list {
    const struct contact_case *study;
    struct curve_theory *rows;
    double *values;
};

/* Fractions beyond 1 are none. */
static void put_area(struct theory_list *list, const char *name,
                     double (*area)(double load, double alpha), double alpha) {
    size_t n = list->study->load_count;
    for (size_t k = 0; k < n; k++) {
        double fraction = area(list->study->loads[k], alpha);
        list->values[k] = fraction <= 1 ? fraction : NAN;
    }
    *list->rows++ = (struct curve_theory){name, list->values};
    list->values += n;
}

static double persson_at(double load, double alpha) {
    (void)alpha;
    return persson_area(load);
}

static double line_at(double load, double kappa) {
    return kappa * load;
}

static double westergaard_at(double load, double alpha) {
    (void)alpha;
    return westergaard_area(westergaard_ratio(load));
}

static void put_wave(struct contact_theories *out, const struct contact_case *study) {
    struct theory_list list = {study, out->area, out->values};
    put_area(&list, "westergaard", westergaard_at, 0);
    for (size_t k = 0; k < study->load_count; k++) /* the amplitude is sqrt(2 m0) */
        list.values[k] = sqrt(2) * westergaard_gap(westergaard_ratio(study->loads[k]));
    out->gap[0] = (struct curve_theory){"westergaard", list.values};
}

static void put_rough(struct contact_theories *out, const struct contact_case *study,
                      const struct moments *moments) {
    struct theory_list list = {study, out->area, out->values};
    put_area(&list, "persson", persson_at, 0);
    put_area(&list, "persson_light_load", line_at, persson_light_load());
    if (study->surface.dimension == 2)
        put_area(&list, "bgt_light_load", line_at, bgt_light_load());
    if (has_asperities(study, moments)) {
        put_area(&list, "gw_mccool", gw_mccool_area, moments->nayak_alpha);
        put_area(&list, "bgt", bgt_area, moments->nayak_alpha);
    }
}

int contact_theories_create(struct contact_theories *out, const struct contact_case *study,
                            const struct modes *modes, const struct moments *moments,
                            struct error *err) {
    size_t bytes = CURVE_THEORIES_MOST * sizeof(double);
    *out = (struct contact_theories){.values = array_create(study->load_count, bytes)};
    if (out->values == NULL)
        return error_memory(err, study->load_count * bytes, "theories");
    if (is_one_wave(study, modes))
        put_wave(out, study);
    else
        put_rough(out, study, moments);
    return 0;
}

void contact_theories_clear(struct contact_theories *theories) {
    free(theories->values);
    *theories = (struct contact_theories){0};
}

bool contact_theory_pressures(const struct contact_case *study, const struct modes *modes,
                              double load, double *pdf) {
    if (is_one_wave(study, modes))
        return false;
    bin_averages_persson(load, &study->pressure, pdf);
    return true;
}
