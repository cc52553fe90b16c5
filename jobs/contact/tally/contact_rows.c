#include "jobs/contact/tally/contact_rows.h"
#include <stdlib.h>
#include <string.h>

/* Counts the measures below one that are kept. */
static size_t kept_below(const struct contact_case *one_case, enum contact_measure measure) {
    size_t count = 0;
    for (size_t a = 0; a < (size_t)measure; a++)
        count += measure_row(a)->kept(one_case);
    return count;
}

static size_t model_width(const struct contact_case *one_case) {
    return kept_below(one_case, MEASURE_OWN) * contact_case_slots(one_case);
}

/* Returns the first column of the series of a companion. */
static size_t companion_first(const struct contact_case *one_case, size_t companion,
                              size_t series) {
    size_t columns = one_case->companions[companion].kept_count * series;
    for (size_t c = 0; c < companion; c++)
        columns += one_case->companions[c].kept_count * one_case->companions[c].series;
    return one_case->model_count * model_width(one_case) + columns * contact_case_slots(one_case);
}

size_t contact_rows_width(const struct contact_case *one_case) {
    const size_t last = COMPANION_COUNT - 1;
    return companion_first(one_case, last, one_case->companions[last].series);
}

size_t contact_rows_companion_column(const struct contact_case *one_case,
                                     enum companion_name companion, size_t series,
                                     enum contact_measure measure) {
    const struct companion_plan *plan = &one_case->companions[companion];
    size_t at = 0;
    while (at < plan->kept_count && plan->kept[at] != measure)
        at++;
    return companion_first(one_case, companion, series) + at * contact_case_slots(one_case);
}

double contact_rows_bytes(const struct contact_case *one_case) {
    return (double)sizeof(uint64_t) + (double)contact_rows_width(one_case) * sizeof(double);
}

bool contact_rows_column(const struct contact_case *one_case, size_t model,
                         enum contact_measure measure, size_t *column) {
    if (!measure_row(measure)->kept(one_case))
        return false;
    *column = model * model_width(one_case) +
              kept_below(one_case, measure) * contact_case_slots(one_case);
    return true;
}

void contact_rows_clear(struct contact_rows *rows) {
    free(rows->realisation);
    free(rows->values);
    *rows = (struct contact_rows){.width = rows->width};
}

int contact_rows_reserve(struct contact_rows *rows, size_t more, struct error *err) {
    size_t row = (rows->width > 0 ? rows->width : 1) * sizeof *rows->values;
    if (more <= rows->capacity - rows->count)
        return 0;
    size_t least = 2 * rows->capacity > 16 ? 2 * rows->capacity : 16;
    size_t capacity = rows->count + more > least ? rows->count + more : least;
    if (more > SIZE_MAX / 4 || capacity > SIZE_MAX / 2 / row)
        return error_memory(err, SIZE_MAX, "rows of realisations");
    uint64_t *realisation = realloc(rows->realisation, capacity * sizeof *realisation);
    if (realisation != NULL)
        rows->realisation = realisation;
    double *values = realisation != NULL ? realloc(rows->values, capacity * row) : NULL;
    if (values == NULL)
        return error_memory(err, capacity * row, "rows of realisations");
    rows->values = values;
    rows->capacity = capacity;
    return 0;
}

/* Copies the kept measures of a companion into a row. */
static void append_companion(double *row, const struct contact_case *one_case,
                             enum companion_name companion, const struct companion_tally *tally) {
    const struct companion_plan *plan = &one_case->companions[companion];
    for (size_t series = 0; series < plan->series; series++)
        for (size_t a = 0; a < plan->kept_count; a++)
            memcpy(row + contact_rows_companion_column(one_case, companion, series, plan->kept[a]),
                   tally->values + companion_cell(one_case, series, plan->kept[a], 0),
                   contact_case_slots(one_case) * sizeof *row);
}

void contact_rows_append(struct contact_rows *rows, const struct contact_case *one_case,
                         uint64_t realisation, const double *values,
                         const struct companion_tally *companions) {
    size_t all = contact_case_cells(one_case), finest = one_case->level_count - 1, column;
    double *row = rows->values + rows->count * rows->width;
    for (size_t m = 0; m < one_case->model_count; m++)
        for (size_t a = 0; a < MEASURE_OWN; a++)
            if (contact_rows_column(one_case, m, (enum contact_measure)a, &column))
                memcpy(row + column, values + a * all + contact_case_cell(one_case, m, finest, 0),
                       contact_case_slots(one_case) * sizeof *row);
    for (enum companion_name c = 0; c < COMPANION_COUNT; c++)
        append_companion(row, one_case, c, &companions[c]);
    rows->realisation[rows->count++] = realisation;
}

/* Merges from the last row to the first, so that none is overwritten before it is moved. */
void contact_rows_merge(struct contact_rows *into, const struct contact_rows *from) {
    size_t ours = into->count, theirs = from->count, row = into->width * sizeof *into->values;
    into->count = ours + theirs;
    for (size_t to = into->count; theirs > 0; to--) {
        bool own = ours > 0 && into->realisation[ours - 1] > from->realisation[theirs - 1];
        const struct contact_rows *source = own ? into : from;
        size_t at = own ? --ours : --theirs;
        into->realisation[to - 1] = source->realisation[at];
        memcpy(into->values + (to - 1) * into->width, source->values + at * into->width, row);
    }
}

/* --- bytes: the count, then of each row its realisation and its values --- */

void contact_rows_put(struct bytes *bytes, const struct contact_rows *rows) {
    bytes_put_unsigned(bytes, rows->count);
    for (size_t r = 0; r < rows->count; r++) {
        bytes_put_unsigned(bytes, rows->realisation[r]);
        for (size_t a = 0; a < rows->width; a++)
            bytes_put_double(bytes, rows->values[r * rows->width + a]);
    }
}

void contact_rows_get(struct byte_reader *reader, struct contact_rows *rows) {
    struct error err;
    uint64_t count = bytes_get_unsigned(reader);
    size_t left = (size_t)(reader->end - reader->at);
    if (reader->failed || count > left / (1 + rows->width * sizeof *rows->values)) {
        reader->failed = true;
        return;
    }
    if (contact_rows_reserve(rows, (size_t)count, &err) != 0) {
        reader->failed = reader->out_of_memory = true;
        return;
    }
    for (size_t r = 0; r < count && !reader->failed; r++) {
        rows->realisation[r] = bytes_get_unsigned(reader);
        if (r > 0 && rows->realisation[r] <= rows->realisation[r - 1])
            reader->failed = true;
        for (size_t a = 0; a < rows->width; a++)
            rows->values[r * rows->width + a] = bytes_get_double(reader);
        rows->count++;
    }
}
