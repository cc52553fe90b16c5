#include "jobs/contact/contact_theory.h"
#include "core/theory/bin_averages.h"
#include "core/theory/contact.h"
#include <math.h>
#include <stdlib.h>

/* Says whether a spectrum is one wave and its conjugate (or, at the Nyquist frequency, itself). */
static bool is_one_wave(const struct contact_case *one_case, const struct modes *modes) {
    return one_case->surface.dimension == 1 && modes->count <= 2;
}

/* Returns whether theories of Gaussian isotropic asperities apply. */
static bool has_asperities(const struct contact_case *one_case, const struct moments *moments) {
    return one_case->surface.dimension == 2 && moments->nayak_alpha > 1.5 &&
           one_case->surface.options.heights.type == HEIGHTS_GAUSSIAN &&
           one_case->surface.spectrum.type != SPECTRUM_EXPONENTIAL_ACF && /* no finite moments */
           moments_isotropic(moments);
}

/* p/p* of the wave sqrt(2 m0) cos: its RMS slope is pi sqrt(2) amplitude/wavelength, and
 * p* = pi E* amplitude/wavelength. */
static double westergaard_ratio(double load) {
    return fmin(sqrt(2) * load, 1);
}

/* The next theory's values go here, where there is room for THEORIES_MOST of them. */
struct theory_list {
    const struct contact_case *one_case;
    struct contact_theories *out;
    double *values;
};

/* Puts fractions of contact; those beyond 1 become NaN. */
static void put_area(struct theory_list *list, const char *name,
                     double (*area)(double load, double alpha), double alpha) {
    size_t n = list->one_case->load_count;
    for (size_t k = 0; k < n; k++) {
        double fraction = area(list->one_case->loads[k], alpha);
        list->values[k] = fraction <= 1 ? fraction : NAN;
    }
    list->out->area[list->out->area_count++] = (struct theory){name, list->values};
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

static void put_wave(struct theory_list *list) {
    const struct contact_case *one_case = list->one_case;
    put_area(list, "westergaard", westergaard_at, 0);
    for (size_t k = 0; k < one_case->load_count; k++) /* the amplitude is sqrt(2 m0) */
        list->values[k] = sqrt(2) * westergaard_gap(westergaard_ratio(one_case->loads[k]));
    list->out->gap[list->out->gap_count++] = (struct theory){"westergaard", list->values};
}

static void put_rough(struct theory_list *list, const struct moments *moments) {
    put_area(list, "persson", persson_at, 0);
    put_area(list, "persson_light_load", line_at, persson_light_load());
    if (list->one_case->surface.dimension == 2)
        put_area(list, "bgt_light_load", line_at, bgt_light_load());
    if (has_asperities(list->one_case, moments)) {
        put_area(list, "gw_mccool", gw_mccool_area, moments->nayak_alpha);
        put_area(list, "bgt", bgt_area, moments->nayak_alpha);
    }
}

int contact_theories_make(struct contact_theories *out, const struct contact_case *one_case,
                          const struct modes *modes, const struct moments *moments,
                          struct case_result *result, struct error *err) {
    *out = (struct contact_theories){0};
    struct theory_list list = {one_case, out,
                               result_numbers(result, THEORIES_MOST * one_case->load_count)};
    if (list.values == NULL)
        return error_memory(err, THEORIES_MOST * one_case->load_count * sizeof(double), "theories");
    /* Of a wave of random amplitude no theory here tells the mean. */
    if (is_one_wave(one_case, modes) && surface_case_exact(&one_case->surface))
        put_wave(&list);
    else if (!is_one_wave(one_case, modes))
        put_rough(&list, moments);
    return 0;
}

bool contact_theory_pressures(const struct contact_case *one_case, const struct modes *modes,
                              double load, double *pdf) {
    if (is_one_wave(one_case, modes))
        return false;
    bin_averages_persson(load, &one_case->pressure, pdf);
    return true;
}
