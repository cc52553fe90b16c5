/* Reads the values of one case by its parameter table: an absent value is its default, and one that
 * does not fit its row is a fault. */
#ifndef RUGO_JOBS_CASE_READER_H
#define RUGO_JOBS_CASE_READER_H

#include "core/error.h"
#include "core/statistics/histogram.h"
#include "schema/study/fault.h"
#include "schema/study/parameter.h"
#include <cjson/cJSON.h>
#include <stdint.h>

struct case_reader {
    const cJSON *parameters;       /* borrowed, as all below */
    const struct parameter *table; /* rows of every path that is read */
    size_t count;
    struct fault_list *faults;
};

/* NaN where the value is absent, or does not fit (a fault then). */
double case_number(const struct case_reader *reader, const char *path);
/* Position among the row's choices; 0 where it does not fit (a fault then). */
size_t case_choice(const struct case_reader *reader, const char *path);
/* Positions among the row's choices, in the order given, into out (room for all of them); how many,
 * 0 where the value is absent or does not fit (a fault then). */
size_t case_choices(const struct case_reader *reader, const char *path, size_t *out);
/* A measure's number, and *unit its position among the row's units; INFINITY for a choice (whose
 * position is then *unit), NaN where absent or unfit (a fault then). */
double case_measure(const struct case_reader *reader, const char *path, size_t *unit);
/* [low, high, count]: at most `most` bins. *out is left alone where the value does not fit (a fault
 * then). Fails only with ERROR_MEMORY. */
int case_bins(const struct case_reader *reader, const char *path, size_t most, struct bins *out,
              struct error *err);
/* The array's values into *out (owned by the caller, NULL where absent or at fault) and *n.
 * Fails only with ERROR_MEMORY. */
int case_numbers(const struct case_reader *reader, const char *path, double **out, size_t *n,
                 struct error *err);

/* 0, or ERROR_INPUT with the first fault behind the first `before` ones as its text. */
int case_status(const struct fault_list *faults, size_t before, struct error *err);

/* A 64-bit mark of all values of the table, whatever the order of keys: tells cases apart. */
uint64_t case_fingerprint(const struct case_reader *reader);

#endif
