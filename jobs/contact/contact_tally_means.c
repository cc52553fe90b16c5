/* Means over the realisations that a tally holds, with their standard errors. */
#include "jobs/contact/contact_places.h"
#include "jobs/contact/contact_tally.h"
#include <math.h>

/* Over the realisations that have a value. */
static struct estimate sums_mean(const struct contact_sums *sums, size_t cell, double scale) {
    struct estimate mean = tally_sums_ratio(&sums->sums, &sums->counts, cell);
    return (struct estimate){mean.value / scale, mean.standard_error / scale};
}

struct estimate contact_tally_mean(const struct contact_tally *tally, enum contact_measure measure,
                                   size_t cell) {
    double scale =
        contact_tally_scale(tally->one_case, measure, cell % tally->one_case->load_count);
    return sums_mean(&tally->sums[measure], cell, scale);
}

double contact_tally_total(const struct contact_tally *tally, enum contact_measure measure,
                           size_t cell) {
    double scale =
        contact_tally_scale(tally->one_case, measure, cell % tally->one_case->load_count);
    return exact_sum_value(&tally->sums[measure].sums.sum[cell]) / scale;
}

uint64_t contact_tally_valueless(const struct contact_tally *tally, enum contact_measure measure,
                                 size_t cell) {
    return tally->realisations - tally->sums[measure].counts.count[cell];
}

struct estimate contact_tally_level(const struct contact_tally *tally, enum contact_measure measure,
                                    size_t model, size_t level, size_t load) {
    return sums_mean(&tally->sums[SUMS_LEVELS + measure],
                     places_level(tally->one_case, model, level, load),
                     contact_tally_scale(tally->one_case, measure, load));
}

static struct estimate model_mean(const struct contact_tally *tally, enum contact_measure measure,
                                  size_t model, size_t level, size_t load) {
    if (model == contact_case_complete(tally->one_case))
        return (struct estimate){NAN, NAN};
    return sums_mean(&tally->sums[SUMS_MODELS + measure],
                     places_model(tally->one_case, model, level, load),
                     contact_tally_scale(tally->one_case, measure, load));
}

struct estimate contact_tally_model(const struct contact_tally *tally, enum contact_measure measure,
                                    size_t model, size_t load) {
    return model_mean(tally, measure, model, 0, load);
}

struct estimate contact_tally_model_level(const struct contact_tally *tally,
                                          enum contact_measure measure, size_t model, size_t level,
                                          size_t load) {
    return model_mean(tally, measure, model, level, load);
}

struct estimate contact_tally_block(const struct contact_tally *tally, enum contact_measure measure,
                                    size_t model, size_t load) {
    if (places_blocks(tally->one_case) == 0)
        return (struct estimate){NAN, NAN};
    return sums_mean(&tally->sums[SUMS_BLOCKS + measure],
                     model * tally->one_case->load_count + load,
                     contact_tally_scale(tally->one_case, measure, load));
}

/* Of the few realisations that have a value, as if there were no others. */
static struct estimate mean_of_few(const struct contact_tally *tally,
                                   const struct contact_sums *sums, enum contact_measure measure,
                                   size_t cell, size_t load) {
    uint64_t count = sums->counts.count[cell];
    if (count < 2)
        return (struct estimate){NAN, NAN};
    return sums_mean(sums, cell, contact_tally_scale(tally->one_case, measure, load));
}

/* On all realisations the control is known: its mean less that of the difference, which scatters
 * little. The two errors may go together. */
struct estimate contact_tally_own_length(const struct contact_tally *tally,
                                         enum contact_measure measure, size_t load) {
    const struct contact_case *one_case = tally->one_case;
    if (places_probe(one_case) == 0)
        return mean_of_few(tally, &tally->sums[measure], measure,
                           contact_case_probe_cell(one_case, 0, load), load);
    size_t control = contact_case_cell(one_case, contact_case_control(one_case), 0, load);
    struct estimate all = contact_tally_mean(tally, measure, control);
    struct estimate less =
        mean_of_few(tally, &tally->sums[SUMS_PROBE + measure], measure, load, load);
    return (struct estimate){all.value - less.value, all.standard_error + less.standard_error};
}

struct estimate contact_tally_other_length(const struct contact_tally *tally,
                                           enum contact_measure measure, enum contact_length length,
                                           size_t load) {
    return mean_of_few(tally, &tally->sums[measure], measure,
                       contact_case_length_cell(tally->one_case, length, load), load);
}

size_t contact_tally_pressure_cell(const struct contact_tally *tally, size_t model, size_t level,
                                   size_t at) {
    const struct contact_case *one_case = tally->one_case;
    size_t step = one_case->level_count - 1 - level;
    return ((model * places_counted_levels(one_case) + step) * one_case->pdf_count + at) *
           contact_case_bins(one_case);
}

static struct tally_total pressure_total(const struct contact_tally *tally, size_t model,
                                         size_t level, size_t at) {
    const struct contact_case *one_case = tally->one_case;
    size_t cell = contact_case_cell(one_case, model, level, one_case->pdf_loads[at]);
    fixed_point parts =
        (fixed_point)grid_points(&one_case->levels[level].grid) * CONTACT_AREA_PARTS;
    uint64_t solved = tally->sums[MEASURE_NODES].counts.count[cell];
    return (struct tally_total){solved, parts * solved, parts * parts * solved};
}

void contact_tally_pressure_shares(const struct contact_tally *tally, size_t model, size_t level,
                                   size_t at, struct estimate *out) {
    const struct tally_total total = pressure_total(tally, model, level, at);
    tally_shares(&tally->pressures, contact_tally_pressure_cell(tally, model, level, at) + 1,
                 tally->one_case->pressure.count, &total, out);
}

struct estimate contact_tally_path(const struct contact_tally *tally, enum contact_measure measure,
                                   enum surface_path path, size_t load) {
    return mean_of_few(tally, &tally->sums[SUMS_PATHS + measure], measure,
                       places_path(tally->one_case, path, load), load);
}

double contact_tally_halvings(const struct contact_tally *tally) {
    return sums_mean(&tally->sums[SUMS_HALVINGS], 0, 1).value;
}
