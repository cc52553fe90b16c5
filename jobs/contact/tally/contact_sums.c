#include "jobs/contact/tally/contact_sums.h"
#include <math.h>

enum { SCALE_BITS_MOST = 16 };

int contact_sums_create(struct contact_sums *out, size_t size, struct error *err) {
    int status = tally_sums_create(&out->sums, size, err);
    return status != 0 ? status : tally_create(&out->counts, size, size, err);
}

void contact_sums_clear(struct contact_sums *sums) {
    tally_sums_clear(&sums->sums);
    tally_clear(&sums->counts);
}

double contact_sums_bytes(size_t size) {
    return tally_sums_bytes(size) + tally_bytes(size);
}

void contact_sums_add(struct contact_sums *sums, size_t cell, double value) {
    if (isnan(value))
        return;
    tally_sums_add(&sums->sums, cell, value, 1);
    tally_add(&sums->counts, cell, 1, 1);
}

struct estimate contact_sums_mean(const struct contact_sums *sums, size_t cell, double scale) {
    struct estimate mean = tally_sums_ratio(&sums->sums, &sums->counts, cell);
    return (struct estimate){mean.value / scale, mean.standard_error / scale};
}

bool contact_sums_fit(const struct contact_sums *sums, uint64_t realisations) {
    bool fit = true;
    for (size_t cell = 0; cell < sums->counts.size; cell++)
        fit = fit && sums->counts.count[cell] <= realisations;
    return fit;
}

void contact_sums_put(struct bytes *bytes, const struct contact_sums *sums) {
    tally_sums_put(bytes, &sums->sums);
    tally_put(bytes, &sums->counts);
}

void contact_sums_get(struct byte_reader *reader, struct contact_sums *sums) {
    tally_sums_get(reader, &sums->sums);
    tally_get(reader, &sums->counts);
}

void contact_sums_merge(struct contact_sums *into, const struct contact_sums *from) {
    tally_sums_merge(&into->sums, &from->sums);
    tally_merge(&into->counts, &from->counts);
}

double contact_sums_scale(const struct contact_case *one_case, enum contact_measure measure,
                          size_t load) {
    int exponent;
    if (measure_row(measure)->load != LOAD_FALLS || load >= one_case->load_count)
        return 1;
    (void)frexp(fmin(one_case->loads[load], 1), &exponent);
    return ldexp(1, exponent < -SCALE_BITS_MOST ? SCALE_BITS_MOST : -exponent);
}
