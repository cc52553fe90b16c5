#include "jobs/contact/tally/contact_tally.h"
#include "jobs/contact/contact_measure.h"
#include "jobs/contact/quantity/quantity.h"
#include <math.h>
#include <stdlib.h>

/* --- offsets of the sums --- */

/* Returns the number of levels on which pressures are counted. */
static size_t offsets_counted_levels(const struct contact_case *one_case) {
    return one_case->pdf_pairs || one_case->level_count < 2 ? one_case->level_count : 2;
}

static size_t offsets_pressures(const struct contact_case *one_case) {
    return one_case->model_count * offsets_counted_levels(one_case) * one_case->pdf_count *
           contact_case_bins(one_case);
}

/* Return the offset of a level's difference from the next coarser one, and the number of these. */
static size_t offsets_level(const struct contact_case *one_case, size_t model, size_t level,
                            size_t load) {
    return (model * (one_case->level_count - 1) + level - 1) * contact_case_slots(one_case) + load;
}

static size_t offsets_levels(const struct contact_case *one_case) {
    return offsets_level(one_case, one_case->model_count, 1, 0);
}

/* Returns the offset of a model's difference from the most complete one. It is among those on the
 * finest level (level 0) and their changes from level - 1 to level. */
static size_t offsets_model(const struct contact_case *one_case, size_t model, size_t level,
                            size_t load) {
    size_t other = model - (model > contact_case_complete(one_case));
    return (other * one_case->level_count + level) * contact_case_slots(one_case) + load;
}

static size_t offsets_models(const struct contact_case *one_case) {
    return (one_case->model_count - 1) * one_case->level_count * contact_case_slots(one_case);
}

/* --- a realisation --- */

bool contact_tally_counts(const struct contact_case *one_case, size_t level) {
    return level + offsets_counted_levels(one_case) >= one_case->level_count;
}

static void values_begin(struct contact_tally *tally) {
    size_t n = MEASURE_COUNT * contact_case_cells(tally->one_case);
    for (size_t a = 0; a < n; a++)
        tally->values[a] = NAN;
    for (size_t m = 0; m < CONTACT_MODELS_MOST; m++)
        for (size_t a = 0; a < MODEL_FACTS_MOST; a++)
            tally->facts[m][a] = NAN;
    for (size_t c = 0; c < COMPANION_COUNT; c++)
        companion_tally_begin(&tally->companions[c]);
}

int contact_tally_create(struct contact_tally *out, const struct contact_case *one_case,
                         struct error *err) {
    size_t cells = contact_case_cells(one_case);
    *out = (struct contact_tally){.one_case = one_case,
                                  .values = array_create(cells, MEASURE_COUNT * sizeof(double))};
    int status = 0;
    if (out->values == NULL)
        status = error_memory(err, cells * MEASURE_COUNT * sizeof(double), "a tally");
    for (size_t a = 0; a < MEASURE_COUNT && status == 0; a++)
        if (measure_is_of(one_case, a))
            status = contact_sums_create(&out->sums[a], cells, err);
    for (size_t a = 0; a < MEASURE_PAIRED && status == 0; a++) {
        if (!measure_is_of(one_case, a))
            continue;
        status = contact_sums_create(&out->sums[SUMS_LEVELS + a], offsets_levels(one_case), err);
        if (status == 0)
            status =
                contact_sums_create(&out->sums[SUMS_MODELS + a], offsets_models(one_case), err);
    }
    for (enum companion_name c = 0; c < COMPANION_COUNT && status == 0; c++)
        if (contact_case_has(one_case, c))
            status = companion_tally_create(&out->companions[c], one_case, &one_case->companions[c],
                                            err);
    if (status == 0)
        status = tally_create(&out->pressures, offsets_pressures(one_case),
                              contact_case_bins(one_case), err);
    if (status == 0)
        status = contact_densities_create(&out->densities, one_case, err);
    out->rows.width = contact_rows_width(one_case);
    if (status == 0)
        values_begin(out);
    else
        contact_tally_clear(out);
    return status;
}

void contact_tally_clear(struct contact_tally *tally) {
    for (size_t a = 0; a < CONTACT_SUMS; a++)
        contact_sums_clear(&tally->sums[a]);
    for (size_t c = 0; c < COMPANION_COUNT; c++)
        companion_tally_clear(&tally->companions[c]);
    tally_clear(&tally->pressures);
    contact_densities_clear(&tally->densities);
    contact_rows_clear(&tally->rows);
    free(tally->values);
    *tally = (struct contact_tally){0};
}

double contact_tally_bytes(const struct contact_case *one_case) {
    size_t pairs = offsets_levels(one_case) + offsets_models(one_case);
    size_t unasked = MEASURE_PAIRED - measure_paired(one_case);
    double bytes =
        (double)(MEASURE_COUNT - unasked) * contact_sums_bytes(contact_case_cells(one_case)) +
        MEASURE_COUNT * sizeof(double) * (double)contact_case_cells(one_case) +
        (double)(MEASURE_PAIRED - unasked) * contact_sums_bytes(pairs) +
        tally_bytes(offsets_pressures(one_case)) + contact_densities_bytes(one_case);
    for (size_t c = 0; c < COMPANION_COUNT; c++)
        bytes += companion_tally_bytes(one_case, &one_case->companions[c]);
    return bytes;
}

/* Rounds the ends of the bins, so that the sum over all bins has no rounding. */
void contact_tally_pressures(struct contact_tally *tally, size_t model, size_t level, size_t at,
                             const double *shares) {
    const struct contact_case *one_case = tally->one_case;
    size_t first = contact_tally_pressure_cell(tally, model, level, at);
    uint64_t parts = CONTACT_AREA_PARTS * grid_points(&one_case->levels[level].grid), before = 0;
    double sum = 0;
    for (size_t b = 0; b < contact_case_bins(one_case); b++) {
        sum += shares[b];
        uint64_t end = (uint64_t)llround(sum * (double)parts);
        if (end > before)
            tally_add(&tally->pressures, first + b, end - before, parts);
        before = end;
    }
    contact_densities_set(&tally->densities, density_state(one_case, model, level), at, shares);
}

/* Returns the load, or the point of a curve by sliding, of a cell. */
static size_t slot_of(const struct contact_case *one_case, size_t cell) {
    return cell % contact_case_slots(one_case);
}

static size_t values_of(const struct contact_case *one_case, enum contact_measure measure) {
    return contact_case_values(one_case, measure_row(measure)->by);
}

static void add_level_pairs(struct contact_tally *tally, enum contact_measure measure) {
    const struct contact_case *one_case = tally->one_case;
    const double *values = contact_tally_values(tally, measure);
    for (size_t m = 0; m < one_case->model_count; m++)
        for (size_t l = 1; l < one_case->level_count; l++)
            for (size_t k = 0; k < values_of(one_case, measure); k++)
                contact_sums_add(&tally->sums[SUMS_LEVELS + measure],
                                 offsets_level(one_case, m, l, k),
                                 (values[contact_case_cell(one_case, m, l, k)] -
                                  values[contact_case_cell(one_case, m, l - 1, k)]) *
                                     contact_sums_scale(one_case, measure, k));
}

static void add_model_pairs(struct contact_tally *tally, enum contact_measure measure) {
    const struct contact_case *one_case = tally->one_case;
    const double *values = contact_tally_values(tally, measure);
    struct contact_sums *sums = &tally->sums[SUMS_MODELS + measure];
    size_t levels = one_case->level_count, complete = contact_case_complete(one_case);
    for (size_t m = 0; m < one_case->model_count; m++)
        for (size_t k = 0; m != complete && k < values_of(one_case, measure); k++) {
            double scale = contact_sums_scale(one_case, measure, k), before = 0, own = 0;
            for (size_t l = 0; l < levels; l++, before = own) {
                own = values[contact_case_cell(one_case, m, l, k)] -
                      values[contact_case_cell(one_case, complete, l, k)];
                if (l > 0)
                    contact_sums_add(sums, offsets_model(one_case, m, l, k),
                                     (own - before) * scale);
            }
            contact_sums_add(sums, offsets_model(one_case, m, 0, k), before * scale);
        }
}

/* Computes the fits of every series of loads from its areas. */
static void fill_fits(struct contact_tally *tally) {
    const struct contact_case *one_case = tally->one_case;
    for (size_t cell = 0; cell < contact_case_cells(one_case); cell += contact_case_slots(one_case))
        contact_measure_fits(one_case->load_count, one_case->loads,
                             contact_tally_values(tally, MEASURE_EDGES) + cell,
                             contact_tally_values(tally, MEASURE_KAPPA) + cell,
                             contact_case_cells(one_case));
}

int contact_tally_add(struct contact_tally *tally, struct error *err) {
    const struct contact_case *one_case = tally->one_case;
    size_t cells = contact_case_cells(one_case);
    int status = contact_rows_reserve(&tally->rows, 1, err);
    if (status != 0)
        return status;
    contact_rows_append(&tally->rows, one_case, tally->realisation++, tally->values,
                        tally->companions);
    fill_fits(tally);
    for (size_t a = 0; a < MEASURE_COUNT; a++) {
        if (!measure_is_of(one_case, a))
            continue;
        const double *values = contact_tally_values(tally, (enum contact_measure)a);
        for (size_t cell = 0; cell < cells; cell++)
            contact_sums_add(&tally->sums[a], cell,
                             values[cell] * contact_sums_scale(one_case, (enum contact_measure)a,
                                                               slot_of(one_case, cell)));
    }
    for (size_t a = 0; a < MEASURE_PAIRED; a++) {
        if (!measure_is_of(one_case, a))
            continue;
        add_level_pairs(tally, (enum contact_measure)a);
        if (one_case->model_count > 1)
            add_model_pairs(tally, (enum contact_measure)a);
    }
    for (size_t c = 0; c < COMPANION_COUNT; c++)
        companion_tally_add(&tally->companions[c], one_case, &one_case->companions[c]);
    contact_densities_add(&tally->densities);
    tally_total_add(&tally->points, grid_points(&contact_case_finest(one_case)->grid));
    tally->realisations++;
    values_begin(tally);
    return 0;
}

/* Returns whether a case has the sums of this index. */
static bool has_sums(const struct contact_case *one_case, size_t sums) {
    size_t measure = sums < SUMS_LEVELS   ? sums
                     : sums < SUMS_MODELS ? sums - SUMS_LEVELS
                                          : sums - SUMS_MODELS;
    return measure_is_of(one_case, measure);
}

void contact_tally_put(struct bytes *bytes, const struct contact_tally *tally) {
    bytes_put_unsigned(bytes, tally->realisations);
    for (size_t a = 0; a < CONTACT_SUMS; a++)
        if (has_sums(tally->one_case, a))
            contact_sums_put(bytes, &tally->sums[a]);
    for (size_t c = 0; c < COMPANION_COUNT; c++)
        companion_tally_put(bytes, &tally->companions[c]);
    tally_total_put(bytes, &tally->points);
    tally_put(bytes, &tally->pressures);
    contact_densities_put(bytes, &tally->densities);
    notes_put(bytes, &tally->notes);
    contact_rows_put(bytes, &tally->rows);
}

void contact_tally_get(struct byte_reader *reader, struct contact_tally *tally) {
    tally->realisations = bytes_get_unsigned(reader);
    for (size_t a = 0; a < CONTACT_SUMS; a++)
        if (has_sums(tally->one_case, a))
            contact_sums_get(reader, &tally->sums[a]);
    for (size_t c = 0; c < COMPANION_COUNT; c++)
        companion_tally_get(reader, &tally->companions[c]);
    tally_total_get(reader, &tally->points);
    tally_get_weighed(reader, &tally->pressures);
    contact_densities_get(reader, &tally->densities);
    notes_get(reader, &tally->notes);
    contact_rows_get(reader, &tally->rows);
}

int contact_tally_merge(struct contact_tally *into, const struct contact_tally *from,
                        struct error *err) {
    int status = contact_rows_reserve(&into->rows, from->rows.count, err);
    if (status != 0)
        return status;
    contact_rows_merge(&into->rows, &from->rows);
    into->realisations += from->realisations;
    for (size_t a = 0; a < CONTACT_SUMS; a++)
        contact_sums_merge(&into->sums[a], &from->sums[a]);
    for (size_t c = 0; c < COMPANION_COUNT; c++)
        companion_tally_merge(&into->companions[c], &from->companions[c]);
    tally_total_merge(&into->points, &from->points);
    tally_merge(&into->pressures, &from->pressures);
    contact_densities_merge(&into->densities, &from->densities);
    notes_merge(&into->notes, &from->notes);
    return 0;
}

/* --- means --- */

struct estimate contact_tally_mean(const struct contact_tally *tally, enum contact_measure measure,
                                   size_t cell) {
    double scale = contact_sums_scale(tally->one_case, measure, slot_of(tally->one_case, cell));
    return contact_sums_mean(&tally->sums[measure], cell, scale);
}

double contact_tally_total(const struct contact_tally *tally, enum contact_measure measure,
                           size_t cell) {
    double scale = contact_sums_scale(tally->one_case, measure, slot_of(tally->one_case, cell));
    return exact_sum_value(&tally->sums[measure].sums.sum[cell]) / scale;
}

uint64_t contact_tally_valueless(const struct contact_tally *tally, enum contact_measure measure,
                                 size_t cell) {
    return tally->realisations - tally->sums[measure].counts.count[cell];
}

struct estimate contact_tally_level(const struct contact_tally *tally, enum contact_measure measure,
                                    size_t model, size_t level, size_t load) {
    return contact_sums_mean(&tally->sums[SUMS_LEVELS + measure],
                             offsets_level(tally->one_case, model, level, load),
                             contact_sums_scale(tally->one_case, measure, load));
}

static struct estimate model_mean(const struct contact_tally *tally, enum contact_measure measure,
                                  size_t model, size_t level, size_t load) {
    if (model == contact_case_complete(tally->one_case))
        return (struct estimate){NAN, NAN};
    return contact_sums_mean(&tally->sums[SUMS_MODELS + measure],
                             offsets_model(tally->one_case, model, level, load),
                             contact_sums_scale(tally->one_case, measure, load));
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

struct estimate contact_tally_companion(const struct contact_tally *tally,
                                        enum companion_name companion, size_t series,
                                        enum contact_measure measure, size_t load) {
    return contact_sums_mean(&tally->companions[companion].sums,
                             companion_cell(tally->one_case, series, measure, load),
                             contact_sums_scale(tally->one_case, measure, load));
}

uint64_t contact_tally_draws(const struct contact_tally *tally, enum companion_name companion,
                             size_t series, enum contact_measure measure, size_t load) {
    return tally->companions[companion]
        .sums.counts.count[companion_cell(tally->one_case, series, measure, load)];
}

uint64_t contact_tally_pairs(const struct contact_tally *tally, enum companion_name companion,
                             size_t pair, enum contact_measure measure, size_t load) {
    return tally->companions[companion]
        .differences.counts.count[companion_cell(tally->one_case, pair, measure, load)];
}

struct estimate contact_tally_pair(const struct contact_tally *tally, enum companion_name companion,
                                   size_t pair, enum contact_measure measure, size_t load) {
    return contact_sums_mean(&tally->companions[companion].differences,
                             companion_cell(tally->one_case, pair, measure, load),
                             contact_sums_scale(tally->one_case, measure, load));
}

size_t contact_tally_pressure_cell(const struct contact_tally *tally, size_t model, size_t level,
                                   size_t at) {
    const struct contact_case *one_case = tally->one_case;
    size_t step = one_case->level_count - 1 - level;
    return ((model * offsets_counted_levels(one_case) + step) * one_case->pdf_count + at) *
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

/* Returns the most complete of the other models that has a value of every realisation at this load
 * of the level; model_count without one. */
static size_t whole_model(const struct contact_tally *tally, enum contact_measure measure,
                          size_t level, size_t load) {
    const struct contact_case *one_case = tally->one_case;
    size_t found = one_case->model_count;
    for (size_t m = 0; m < one_case->model_count; m++) {
        size_t cell = contact_case_cell(one_case, m, level, load);
        bool better = found == one_case->model_count ||
                      one_case->models[m]->rank > one_case->models[found]->rank;
        if (m != contact_case_complete(one_case) && better &&
            contact_tally_valueless(tally, measure, cell) == 0)
            found = m;
    }
    return found;
}

size_t contact_mean_control(const struct contact_tally *tally, enum contact_measure measure,
                            size_t model, size_t level, size_t load) {
    const struct contact_case *one_case = tally->one_case;
    size_t cell = contact_case_cell(one_case, model, level, load);
    uint64_t valueless = contact_tally_valueless(tally, measure, cell);
    bool controlled = measure < MEASURE_PAIRED && valueless > 0 &&
                      valueless < tally->realisations && model == contact_case_complete(one_case) &&
                      level + 1 == one_case->level_count;
    return controlled ? whole_model(tally, measure, level, load) : one_case->model_count;
}

struct estimate contact_mean(const struct contact_tally *tally, enum contact_measure measure,
                             size_t model, size_t level, size_t load) {
    const struct contact_case *one_case = tally->one_case;
    size_t control = contact_mean_control(tally, measure, model, level, load);
    if (control == one_case->model_count)
        return contact_tally_mean(tally, measure, contact_case_cell(one_case, model, level, load));
    struct estimate all =
        contact_tally_mean(tally, measure, contact_case_cell(one_case, control, level, load));
    struct estimate less = contact_tally_model(tally, measure, control, load);
    /* The two errors may be correlated. */
    return (struct estimate){all.value - less.value, all.standard_error + less.standard_error};
}

/* --- whether a tally that was read is possible --- */

/* Returns whether a cell has a possible number of values: no more than realisations; one of each
 * where all must have one; of a model that may fail no more than at the load before. */
static bool count_fits(const struct contact_tally *tally, enum contact_measure measure,
                       size_t cell) {
    const struct contact_case *one_case = tally->one_case;
    const uint64_t *count = tally->sums[measure].counts.count;
    size_t slot = slot_of(one_case, cell);
    size_t model = cell / (one_case->level_count * contact_case_slots(one_case));
    if (slot >= values_of(one_case, measure))
        return count[cell] == 0;
    if (measure_row(measure)->values != VALUES_ALL)
        return count[cell] <= tally->realisations;
    if (one_case->models[model]->may_fail)
        return count[cell] <= (slot > 0 ? count[cell - 1] : tally->realisations);
    return count[cell] == tally->realisations;
}

/* Number of (realisation, level) pairs that did not converge up to the last load, and the last
 * point of sliding; each has one note. */
static uint64_t unsolved(const struct contact_tally *tally) {
    const struct contact_case *one_case = tally->one_case;
    uint64_t count = 0;
    for (size_t m = 0; m < one_case->model_count; m++) {
        bool slides = one_case->slide_count > 0 && one_case->models[m]->slides;
        size_t last = (slides ? one_case->slide_count : one_case->load_count) - 1;
        for (size_t l = 0; l < one_case->level_count && one_case->models[m]->may_fail; l++)
            count += contact_tally_valueless(
                tally, slides ? (enum contact_measure)SLIDING_FORCE : MEASURE_NODES,
                contact_case_cell(one_case, m, l, last));
    }
    return count;
}

/* Returns whether the pressures of a load cover the area by edges, but for rounding. */
static bool pressures_fit(const struct contact_tally *tally, size_t model, size_t level,
                          size_t at) {
    const struct contact_case *one_case = tally->one_case;
    size_t cell = contact_case_cell(one_case, model, level, one_case->pdf_loads[at]);
    const uint64_t *count =
        tally->pressures.count + contact_tally_pressure_cell(tally, model, level, at);
    double parts = (double)CONTACT_AREA_PARTS * (double)grid_points(&one_case->levels[level].grid);
    double area = parts * contact_tally_total(tally, MEASURE_EDGES, cell), sum = 0;
    for (size_t b = 0; b < contact_case_bins(one_case); b++)
        sum += (double)count[b];
    return fabs(sum - area) <= 1e-6 * area + (double)tally->realisations;
}

/* Returns whether the densities of pairs are of the realisations that all models and levels have,
 * and are those of the pressures where these are all realisations. */
static bool densities_fit(const struct contact_tally *tally, size_t model, size_t level,
                          size_t at) {
    const struct contact_case *one_case = tally->one_case;
    const struct contact_densities *densities = &tally->densities;
    size_t cell = contact_case_cell(one_case, model, level, one_case->pdf_loads[at]);
    uint64_t solved = tally->sums[MEASURE_NODES].counts.count[cell];
    double parts = (double)CONTACT_AREA_PARTS * (double)grid_points(&one_case->levels[level].grid);
    const uint64_t *count =
        tally->pressures.count + contact_tally_pressure_cell(tally, model, level, at) + 1;
    static const double ROUNDING = 1e-6; /* of shares and realisations */
    if (densities->states == 0)
        return true;
    bool fit = densities->realisations[at] <= solved;
    for (size_t b = 0; b < one_case->pressure.count && fit; b++) {
        double all = (double)count[b] / parts,
               own =
                   contact_densities_total(densities, density_state(one_case, model, level), at, b),
               rounding = ROUNDING * (double)solved;
        fit = densities->realisations[at] == solved ? fabs(own - all) <= rounding
                                                    : own <= all + rounding;
    }
    return fit;
}

/* Returns whether the values of a column of the rows, multiplied by `scale`, add up to the sum of a
 * cell. */
static bool column_fits(const struct contact_rows *rows, size_t column, double scale,
                        const struct contact_sums *sums, size_t cell) {
    const struct exact_sum *told = &sums->sums.sum[cell];
    struct exact_sum sum = {0};
    uint64_t count = 0;
    for (size_t r = 0; r < rows->count; r++) {
        double value = rows->values[r * rows->width + column];
        if (isnan(value))
            continue;
        exact_sum_add(&sum, value * scale);
        count++;
    }
    return count == sums->counts.count[cell] && sum.total == told->total && sum.lost == told->lost;
}

static bool model_rows_fit(const struct contact_tally *tally, size_t model,
                           enum contact_measure measure) {
    const struct contact_case *one_case = tally->one_case;
    size_t column;
    bool fit = true;
    if (!contact_rows_column(one_case, model, measure, &column))
        return true;
    for (size_t k = 0; k < values_of(one_case, measure) && fit; k++)
        fit = column_fits(&tally->rows, column + k, contact_sums_scale(one_case, measure, k),
                          &tally->sums[measure],
                          contact_case_cell(one_case, model, one_case->level_count - 1, k));
    return fit;
}

static bool companion_rows_fit(const struct contact_tally *tally, enum companion_name companion,
                               size_t series) {
    const struct contact_case *one_case = tally->one_case;
    const struct companion_plan *plan = &one_case->companions[companion];
    bool fit = true;
    for (size_t a = 0; a < plan->kept_count; a++) {
        enum contact_measure measure = plan->kept[a];
        size_t column = contact_rows_companion_column(one_case, companion, series, measure);
        for (size_t k = 0; k < values_of(one_case, measure) && fit; k++)
            fit = column_fits(&tally->rows, column + k, contact_sums_scale(one_case, measure, k),
                              &tally->companions[companion].sums,
                              companion_cell(one_case, series, measure, k));
    }
    return fit;
}

static bool rows_fit(const struct contact_tally *tally) {
    const struct contact_case *one_case = tally->one_case;
    bool fit = tally->rows.count == tally->realisations;
    for (size_t m = 0; m < one_case->model_count; m++)
        for (enum contact_measure a = 0; a < MEASURE_OWN; a++)
            fit = fit && model_rows_fit(tally, m, a);
    for (enum companion_name c = 0; c < COMPANION_COUNT; c++)
        for (size_t series = 0; series < one_case->companions[c].series; series++)
            fit = fit && companion_rows_fit(tally, c, series);
    return fit;
}

static bool counts_fit(const struct contact_tally *tally) {
    const struct contact_case *one_case = tally->one_case;
    for (size_t a = 0; a < MEASURE_COUNT; a++)
        for (size_t cell = 0; measure_is_of(one_case, a) && cell < contact_case_cells(one_case);
             cell++)
            if (!count_fits(tally, (enum contact_measure)a, cell))
                return false;
    return true;
}

bool contact_tally_adds_up(const struct contact_tally *tally) {
    const struct contact_case *one_case = tally->one_case;
    if (!counts_fit(tally))
        return false;
    for (size_t a = MEASURE_COUNT; a < CONTACT_SUMS; a++)
        if (!contact_sums_fit(&tally->sums[a], tally->realisations))
            return false;
    for (size_t c = 0; c < COMPANION_COUNT; c++)
        if (!companion_tally_fits(&tally->companions[c], &one_case->companions[c],
                                  tally->realisations))
            return false;
    for (size_t m = 0; m < one_case->model_count; m++)
        for (size_t l = 0; l < one_case->level_count; l++)
            for (size_t a = 0; a < one_case->pdf_count && contact_tally_counts(one_case, l); a++)
                if (!pressures_fit(tally, m, l, a) || !densities_fit(tally, m, l, a))
                    return false;
    return tally->points.realisations == tally->realisations && rows_fit(tally) &&
           tally->notes.count == unsolved(tally);
}
