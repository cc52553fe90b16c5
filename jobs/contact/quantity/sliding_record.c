#include "jobs/contact/quantity/sliding_record.h"
#include <math.h>

/* A point is met within this part of a step. */
static const double REACH = 1e-6;

struct sliding_sample sliding_sample_none(void) {
    struct sliding_sample out = {.sliding = 0};
    for (size_t a = 0; a < SLIDING_VALUES; a++)
        out.of[a] = NAN;
    return out;
}

/* Returns the number of the measure of a value. */
static size_t measure_of(size_t value) {
    return value < SLIDING_BY_NODES ? (size_t)SLIDING_MEASURE + value
                                    : (size_t)SLIDING_EDGES_MEASURE + value - SLIDING_BY_NODES;
}

static void put(struct sliding_record *record, const struct sliding_sample *sample, double share) {
    for (size_t a = 0; a < SLIDING_VALUES; a++) {
        double from = record->last.of[a], value = from + share * (sample->of[a] - from);
        record->values[measure_of(a) * record->stride + record->next] = measure_limited(value);
    }
    record->next++;
}

void sliding_record_begin(struct sliding_record *record, const struct sliding_sample *start) {
    record->next = 0;
    record->last = *start;
    put(record, start, 1);
}

size_t sliding_record_turn(const struct sliding_record *record) {
    size_t steps = record->one_case->slide_steps;
    return (record->next + steps - 1) / steps * steps;
}

void sliding_record_add(struct sliding_record *record, const struct sliding_sample *sample) {
    const double *at = record->one_case->slide;
    const size_t turn = sliding_record_is_full(record) ? 0 : sliding_record_turn(record);
    while (record->next <= turn && turn > 0) {
        const double step = at[record->next] - at[record->next - 1];
        const double left = (at[record->next] - sample->sliding) / step;
        const double span = sample->sliding - record->last.sliding;
        if (!(left <= REACH))
            break;
        double share = (at[record->next] - record->last.sliding) / span;
        put(record, sample, span != 0 ? fmin(1, fmax(0, share)) : 1);
    }
    record->last = *sample;
}
