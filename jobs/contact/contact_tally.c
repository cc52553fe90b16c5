#include "jobs/contact/contact_tally.h"
#include "jobs/contact/contact_measure.h"
#include "jobs/contact/contact_places.h"
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

bool contact_tally_counts(const struct contact_case *one_case, size_t level) {
    return level + places_counted_levels(one_case) >= one_case->level_count;
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

static void values_begin(struct contact_tally *tally) {
    size_t n = MEASURE_COUNT * contact_case_all_cells(tally->one_case);
    for (size_t a = 0; a < n; a++)
        tally->values[a] = NAN;
    tally->halvings = NAN;
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
        size_t pairs = places_level(one_case, one_case->model_count, 1, 0);
        status = sums_create(&out->sums[SUMS_LEVELS + a], pairs, err);
        if (status == 0)
            status = sums_create(&out->sums[SUMS_MODELS + a], places_models(one_case), err);
        if (status == 0)
            status = sums_create(&out->sums[SUMS_BLOCKS + a], places_blocks(one_case), err);
        if (status == 0)
            status = sums_create(&out->sums[SUMS_PROBE + a], places_probe(one_case), err);
        if (status == 0)
            status = sums_create(&out->sums[SUMS_PATHS + a], places_paths(one_case), err);
    }
    if (status == 0)
        status = sums_create(&out->sums[SUMS_HALVINGS], contact_case_has_paths(one_case), err);
    if (status == 0)
        status = tally_create(&out->pressures, places_pressures(one_case),
                              contact_case_bins(one_case), err);
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
    size_t pairs = places_level(one_case, one_case->model_count, 1, 0) + places_models(one_case) +
                   places_blocks(one_case) + places_probe(one_case) + places_paths(one_case);
    double a_cell = tally_sums_bytes(1) + tally_bytes(1);
    return MEASURE_COUNT * (double)cells * (a_cell + sizeof(double)) +
           MEASURE_PAIRED * (double)pairs * a_cell + tally_bytes(places_pressures(one_case));
}

/* Rounds where each bin ends, so that rounding adds nothing to all of them. */
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
}

static void add_level_pairs(struct contact_tally *tally, enum contact_measure measure) {
    const struct contact_case *one_case = tally->one_case;
    const double *values = contact_tally_values(tally, measure);
    for (size_t m = 0; m < one_case->model_count; m++)
        for (size_t l = 1; l < one_case->level_count; l++)
            for (size_t k = 0; k < one_case->load_count; k++)
                sums_add(&tally->sums[SUMS_LEVELS + measure], places_level(one_case, m, l, k),
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
                    sums_add(sums, places_model(one_case, m, l, k), (own - before) * scale);
            }
            sums_add(sums, places_model(one_case, m, 0, k), before * scale);
        }
}

static void add_block_pairs(struct contact_tally *tally, enum contact_measure measure) {
    const struct contact_case *one_case = tally->one_case;
    const double *values = contact_tally_values(tally, measure);
    for (size_t pair = 0; pair < places_blocks(one_case); pair++) {
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
    for (size_t k = 0; k < places_probe(one_case); k++)
        sums_add(&tally->sums[SUMS_PROBE + measure], k,
                 (values[contact_case_cell(one_case, control, 0, k)] -
                  values[contact_case_probe_cell(one_case, 0, k)]) *
                     contact_tally_scale(one_case, measure, k));
}

static void add_path_pairs(struct contact_tally *tally, enum contact_measure measure) {
    const struct contact_case *one_case = tally->one_case;
    const double *values = contact_tally_values(tally, measure);
    for (size_t pair = 0; pair < places_paths(one_case); pair++) {
        size_t path = pair / one_case->load_count, k = pair % one_case->load_count;
        sums_add(&tally->sums[SUMS_PATHS + measure], pair,
                 (values[contact_case_path_cell(one_case, PATHS_FOUND + path, k)] -
                  values[contact_case_path_cell(one_case, PATHS_OWN, k)]) *
                     contact_tally_scale(one_case, measure, k));
    }
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
        add_path_pairs(tally, (enum contact_measure)a);
    }
    sums_add(&tally->sums[SUMS_HALVINGS], 0, tally->halvings);
    tally_total_add(&tally->points, grid_points(&contact_case_finest(one_case)->grid));
    tally->realisations++;
    values_begin(tally);
    return 0;
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
