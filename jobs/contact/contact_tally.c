#include "jobs/contact/contact_tally.h"
#include "jobs/contact/contact_measure.h"
#include <math.h>
#include <stdlib.h>

enum { SCALE_BITS_MOST = 16 };

double contact_tally_scale(const struct contact_case *one_case, enum contact_measure measure,
                           size_t load) {
    bool falls =
        measure != MEASURE_GAP && (measure <= MEASURE_STIFFNESS || measure == MEASURE_PATCH_MEAN ||
                                   measure == MEASURE_PATCH_LARGEST);
    int exponent;
    (void)frexp(fmin(one_case->loads[load], 1), &exponent);
    return falls ? ldexp(1, exponent < -SCALE_BITS_MOST ? SCALE_BITS_MOST : -exponent) : 1;
}

/* Levels on which pressures are counted. */
static size_t counted_levels(const struct contact_case *one_case) {
    return one_case->level_count > 1 ? 2 : 1;
}

static size_t pressure_cells(const struct contact_case *one_case) {
    return one_case->model_count * counted_levels(one_case) * one_case->pdf_count *
           contact_tally_bins(one_case);
}

bool contact_tally_counts(const struct contact_case *one_case, size_t level) {
    return level + counted_levels(one_case) >= one_case->level_count;
}

static int sums_create(struct contact_sums *out, size_t size, struct error *err) {
    int status = tally_sums_create(&out->sums, size, err);
    return status != 0 ? status : tally_create(&out->counts, size, size, err);
}

static void sums_clear(struct contact_sums *sums) {
    tally_sums_clear(&sums->sums);
    tally_clear(&sums->counts);
}

/* Adds a realisation's value, if it has one. */
static void sums_add(struct contact_sums *sums, size_t cell, double value) {
    if (isnan(value))
        return;
    tally_sums_add(&sums->sums, cell, value, 1);
    tally_add(&sums->counts, cell, 1, 1);
}

/* Over the realisations that have a value. */
static struct estimate sums_mean(const struct contact_sums *sums, size_t cell, double scale) {
    struct estimate mean = tally_sums_ratio(&sums->sums, &sums->counts, cell);
    return (struct estimate){mean.value / scale, mean.standard_error / scale};
}

/* Place of a level's difference from the next coarser one. */
static size_t level_pair(const struct contact_case *one_case, size_t model, size_t level,
                         size_t load) {
    return (model * (one_case->level_count - 1) + level - 1) * one_case->load_count + load;
}

/* Place of a model's difference from the most complete one, which has none, among those on the
 * finest level (level 0) and their changes from level - 1 to level. */
static size_t model_pair(const struct contact_case *one_case, size_t model, size_t level,
                         size_t load) {
    size_t other = model - (model > contact_case_complete(one_case));
    return (other * one_case->level_count + level) * one_case->load_count + load;
}

static size_t model_pairs(const struct contact_case *one_case) {
    return (one_case->model_count - 1) * one_case->level_count * one_case->load_count;
}

/* Differences of blocks, if any is probed. */
static size_t block_pairs(const struct contact_case *one_case) {
    return one_case->low_blocks ? one_case->model_count * one_case->load_count : 0;
}

/* Differences between the control and the probe, if there are both. */
static size_t probe_pairs(const struct contact_case *one_case) {
    bool both =
        contact_case_is_probed(one_case) && contact_case_control(one_case) < one_case->model_count;
    return both ? one_case->load_count : 0;
}

static void values_begin(struct contact_tally *tally) {
    size_t n = MEASURE_COUNT * contact_case_all_cells(tally->one_case);
    for (size_t a = 0; a < n; a++)
        tally->values[a] = NAN;
    for (size_t m = 0; m < CONTACT_MODELS_MOST; m++)
        for (size_t a = 0; a < MODEL_FACTS_MOST; a++)
            tally->facts[m][a] = NAN;
}

int contact_tally_create(struct contact_tally *out, const struct contact_case *one_case,
                         struct error *err) {
    size_t cells = contact_case_all_cells(one_case);
    *out = (struct contact_tally){.one_case = one_case,
                                  .values = array_create(cells, MEASURE_COUNT * sizeof(double))};
    int status = 0;
    if (out->values == NULL)
        status = error_memory(err, cells * MEASURE_COUNT * sizeof(double), "a tally");
    for (size_t a = 0; a < MEASURE_COUNT && status == 0; a++)
        status = sums_create(&out->sums[a], cells, err);
    for (size_t a = 0; a < MEASURE_PAIRED && status == 0; a++) {
        size_t pairs = level_pair(one_case, one_case->model_count, 1, 0);
        status = sums_create(&out->sums[SUMS_LEVELS + a], pairs, err);
        if (status == 0)
            status = sums_create(&out->sums[SUMS_MODELS + a], model_pairs(one_case), err);
        if (status == 0)
            status = sums_create(&out->sums[SUMS_BLOCKS + a], block_pairs(one_case), err);
        if (status == 0)
            status = sums_create(&out->sums[SUMS_PROBE + a], probe_pairs(one_case), err);
    }
    if (status == 0)
        status = tally_create(&out->pressures, pressure_cells(one_case),
                              contact_tally_bins(one_case), err);
    out->rows.width = contact_rows_width(one_case);
    if (status == 0)
        values_begin(out);
    else
        contact_tally_clear(out);
    return status;
}

void contact_tally_clear(struct contact_tally *tally) {
    for (size_t a = 0; a < CONTACT_SUMS; a++)
        sums_clear(&tally->sums[a]);
    tally_clear(&tally->pressures);
    contact_rows_clear(&tally->rows);
    free(tally->values);
    *tally = (struct contact_tally){0};
}

double contact_tally_bytes(const struct contact_case *one_case) {
    size_t cells = contact_case_all_cells(one_case);
    size_t pairs = level_pair(one_case, one_case->model_count, 1, 0) + model_pairs(one_case) +
                   block_pairs(one_case) + probe_pairs(one_case);
    double a_cell = tally_sums_bytes(1) + tally_bytes(1);
    return MEASURE_COUNT * (double)cells * (a_cell + sizeof(double)) +
           MEASURE_PAIRED * (double)pairs * a_cell + tally_bytes(pressure_cells(one_case));
}

/* Rounds where each bin ends, so that rounding adds nothing to all of them. */
void contact_tally_pressures(struct contact_tally *tally, size_t model, size_t level, size_t at,
                             const double *shares) {
    const struct contact_case *one_case = tally->one_case;
    size_t first = contact_tally_pressure_cell(tally, model, level, at);
    uint64_t parts = CONTACT_AREA_PARTS * grid_points(&one_case->levels[level].grid), before = 0;
    double sum = 0;
    for (size_t b = 0; b < contact_tally_bins(one_case); b++) {
        sum += shares[b];
        uint64_t end = (uint64_t)llround(sum * (double)parts);
        if (end > before)
            tally_add(&tally->pressures, first + b, end - before, parts);
        before = end;
    }
}

static void add_level_pairs(struct contact_tally *tally, enum contact_measure measure) {
    const struct contact_case *one_case = tally->one_case;
    const double *values = contact_tally_values(tally, measure);
    for (size_t m = 0; m < one_case->model_count; m++)
        for (size_t l = 1; l < one_case->level_count; l++)
            for (size_t k = 0; k < one_case->load_count; k++)
                sums_add(&tally->sums[SUMS_LEVELS + measure], level_pair(one_case, m, l, k),
                         (values[contact_case_cell(one_case, m, l, k)] -
                          values[contact_case_cell(one_case, m, l - 1, k)]) *
                             contact_tally_scale(one_case, measure, k));
}

static void add_model_pairs(struct contact_tally *tally, enum contact_measure measure) {
    const struct contact_case *one_case = tally->one_case;
    const double *values = contact_tally_values(tally, measure);
    struct contact_sums *sums = &tally->sums[SUMS_MODELS + measure];
    size_t levels = one_case->level_count, complete = contact_case_complete(one_case);
    for (size_t m = 0; m < one_case->model_count; m++)
        for (size_t k = 0; m != complete && k < one_case->load_count; k++) {
            double scale = contact_tally_scale(one_case, measure, k), before = 0, own = 0;
            for (size_t l = 0; l < levels; l++, before = own) {
                own = values[contact_case_cell(one_case, m, l, k)] -
                      values[contact_case_cell(one_case, complete, l, k)];
                if (l > 0)
                    sums_add(sums, model_pair(one_case, m, l, k), (own - before) * scale);
            }
            sums_add(sums, model_pair(one_case, m, 0, k), before * scale);
        }
}

static void add_block_pairs(struct contact_tally *tally, enum contact_measure measure) {
    const struct contact_case *one_case = tally->one_case;
    const double *values = contact_tally_values(tally, measure);
    for (size_t pair = 0; pair < block_pairs(one_case); pair++) {
        size_t m = pair / one_case->load_count, k = pair % one_case->load_count;
        sums_add(&tally->sums[SUMS_BLOCKS + measure], pair,
                 (values[contact_case_probe_cell(one_case, m + 1, k)] -
                  values[contact_case_probe_cell(one_case, 0, k)]) *
                     contact_tally_scale(one_case, measure, k));
    }
}

static void add_probe_pairs(struct contact_tally *tally, enum contact_measure measure) {
    const struct contact_case *one_case = tally->one_case;
    const double *values = contact_tally_values(tally, measure);
    size_t control = contact_case_control(one_case);
    for (size_t k = 0; k < probe_pairs(one_case); k++)
        sums_add(&tally->sums[SUMS_PROBE + measure], k,
                 (values[contact_case_cell(one_case, control, 0, k)] -
                  values[contact_case_probe_cell(one_case, 0, k)]) *
                     contact_tally_scale(one_case, measure, k));
}

/* Of every series of loads, from its areas. */
static void fill_fits(struct contact_tally *tally) {
    const struct contact_case *one_case = tally->one_case;
    for (size_t cell = 0; cell < contact_case_all_cells(one_case); cell += one_case->load_count)
        contact_measure_fits(one_case->load_count, one_case->loads,
                             contact_tally_values(tally, MEASURE_EDGES) + cell,
                             contact_tally_values(tally, MEASURE_KAPPA) + cell,
                             contact_tally_values(tally, MEASURE_POWER_LAW_A) + cell,
                             contact_tally_values(tally, MEASURE_POWER_LAW_B) + cell);
}

int contact_tally_add(struct contact_tally *tally, struct error *err) {
    const struct contact_case *one_case = tally->one_case;
    size_t cells = contact_case_all_cells(one_case);
    int status = contact_rows_reserve(&tally->rows, 1, err);
    if (status != 0)
        return status;
    contact_rows_append(&tally->rows, one_case, tally->realisation++, tally->values);
    fill_fits(tally);
    for (size_t a = 0; a < MEASURE_COUNT; a++) {
        const double *values = contact_tally_values(tally, (enum contact_measure)a);
        for (size_t cell = 0; cell < cells; cell++)
            sums_add(&tally->sums[a], cell,
                     values[cell] * contact_tally_scale(one_case, (enum contact_measure)a,
                                                        cell % one_case->load_count));
    }
    for (size_t a = 0; a < MEASURE_PAIRED; a++) {
        add_level_pairs(tally, (enum contact_measure)a);
        if (one_case->model_count > 1)
            add_model_pairs(tally, (enum contact_measure)a);
        add_block_pairs(tally, (enum contact_measure)a);
        add_probe_pairs(tally, (enum contact_measure)a);
    }
    tally_total_add(&tally->points, grid_points(&contact_case_finest(one_case)->grid));
    tally->realisations++;
    values_begin(tally);
    return 0;
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
                     level_pair(tally->one_case, model, level, load),
                     contact_tally_scale(tally->one_case, measure, load));
}

static struct estimate model_mean(const struct contact_tally *tally, enum contact_measure measure,
                                  size_t model, size_t level, size_t load) {
    if (model == contact_case_complete(tally->one_case))
        return (struct estimate){NAN, NAN};
    return sums_mean(&tally->sums[SUMS_MODELS + measure],
                     model_pair(tally->one_case, model, level, load),
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
    if (block_pairs(tally->one_case) == 0)
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
    if (probe_pairs(one_case) == 0)
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
    return ((model * counted_levels(one_case) + step) * one_case->pdf_count + at) *
           contact_tally_bins(one_case);
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

void contact_tally_put(struct bytes *bytes, const struct contact_tally *tally) {
    bytes_put_unsigned(bytes, tally->realisations);
    for (size_t a = 0; a < CONTACT_SUMS; a++) {
        tally_sums_put(bytes, &tally->sums[a].sums);
        tally_put(bytes, &tally->sums[a].counts);
    }
    tally_total_put(bytes, &tally->points);
    tally_put(bytes, &tally->pressures);
    notes_put(bytes, &tally->notes);
    contact_rows_put(bytes, &tally->rows);
}

void contact_tally_get(struct byte_reader *reader, struct contact_tally *tally) {
    tally->realisations = bytes_get_unsigned(reader);
    for (size_t a = 0; a < CONTACT_SUMS; a++) {
        tally_sums_get(reader, &tally->sums[a].sums);
        tally_get(reader, &tally->sums[a].counts);
    }
    tally_total_get(reader, &tally->points);
    tally_get_weighed(reader, &tally->pressures);
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
    for (size_t a = 0; a < CONTACT_SUMS; a++) {
        tally_sums_merge(&into->sums[a].sums, &from->sums[a].sums);
        tally_merge(&into->sums[a].counts, &from->sums[a].counts);
    }
    tally_total_merge(&into->points, &from->points);
    tally_merge(&into->pressures, &from->pressures);
    notes_merge(&into->notes, &from->notes);
    return 0;
}
