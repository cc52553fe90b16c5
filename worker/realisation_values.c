#include "worker/realisation_values.h"
#include "core/memory_file.h"
#include "jobs/merger.h"
#include "jobs/realisations.h"
#include <math.h>
#include <stdio.h>

/* Prints so many commas and nulls for realisations that are missing before one. */
static void skip(FILE *file, uint64_t *next, uint64_t number) {
    for (; *next < number; ++*next)
        fputs(*next > 0 ? ",null" : "null", file);
    if (*next > 0)
        fputc(',', file);
    ++*next;
}

/* Ten digits say which realisation is extreme; whoever needs all has the block. */
static void print(FILE *file, const struct realisations *set, const struct point_values *values) {
    uint64_t next = 0;
    size_t row = 0;
    fputc('[', file);
    for (size_t b = 0; b < set->block_count; b++)
        for (uint64_t r = 0; r < set->blocks[b].count; r++, row++) {
            double value = values->values[row * values->stride];
            skip(file, &next, set->blocks[b].first + r);
            if (isfinite(value))
                fprintf(file, "%.10g", value);
            else
                fputs("null", file);
        }
    fputc(']', file);
}

static int make_text(const void *context, const struct curve *curve, size_t at, char **out,
                     struct error *err) {
    const struct job_merger *merger = context;
    struct point_values values;
    struct memory_file memory;
    *out = NULL;
    if (!merger_point(merger, curve, at, &values))
        return 0;
    if (memory_file_open(&memory)) {
        print(memory.file, merger_realisations(merger), &values);
        *out = memory_file_close(&memory, NULL);
    }
    return *out != NULL ? 0 : error_memory(err, 0, "values of realisations");
}

struct point_texts realisation_values(const struct job_merger *merger) {
    return (struct point_texts){merger, make_text};
}
