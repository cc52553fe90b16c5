/* Partial results of both kinds, as someone might send them on purpose: the first byte chooses the
 * case, the second the number of realisations, the rest is the data, under a checksum made for it.
 * Data that fit are merged and make curves; others are refused by both. */
#include "jobs/merger.h"
#include "schema/result/bytes/bytes.h"
#include "tests/support/fuzz/fuzz.h"

enum { CASES = 5, REALISATIONS_MOST = 4, SCALARS_MOST = 128 };
static const struct {
    const char *kind, *text;
} STUDIES[CASES] = {
    {"statistics", "{\"surface\":{\"dimension\":1,\"hurst\":0.6,\"wavelength_ratio\":4},"
                   "\"statistics\":{\"bins\":{\"height\":[-3,3,6],\"curvature\":[-6,0,6]}}}"},
    {"statistics", "{\"surface\":{\"hurst\":0.6,\"wavelength_ratio\":2,\"length_ratio\":2},"
                   "\"statistics\":{\"bins\":{\"height\":[-3,3,6],\"curvature\":[-6,0,6]}}}"},
    {"contact", "{\"surface\":{\"dimension\":1,\"hurst\":0.8,\"wavelength_ratio\":2},"
                "\"contact\":{\"levels\":[2,4],\"pressures\":{\"values\":[0.1]},"
                "\"pressure_pdf\":{\"at\":[0.1],\"bins\":[0,1,4]}}}"},
    {"contact", "{\"surface\":{\"hurst\":0.8,\"wavelength_ratio\":2,\"points_per_wavelength\":4},"
                "\"contact\":{\"pressures\":{\"values\":[0.1,0.2]},"
                "\"pressure_pdf\":{\"at\":[0.1],\"bins\":[0,1,4]}}}"},
    /* all companions that need no measured map */
    {"contact",
     "{\"surface\":{\"dimension\":1,\"hurst\":0.8,\"wavelength_ratio\":2,\"rms_slope\":0.1,"
     "\"points_per_wavelength\":4,\"heights\":{\"distribution\":\"weibull_min\",\"shape\":2}},"
     "\"contact\":{\"block_height\":{\"lengths\":0.25},\"pressures\":{\"values\":[0.1]},"
     "\"pressure_pdf\":{\"bins\":[0,1,4]}}}"},
};
static cJSON *parameters[CASES];
static struct job_merger *empty[CASES]; /* into which nothing was merged */
static double scalars[REALISATIONS_MOST * SCALARS_MOST];

static void seal(unsigned char *data, size_t size) {
    uint64_t hash = hash_bytes(HASH_START, size, data);
    for (size_t a = 0; a < 8; a++)
        data[size + a] = (unsigned char)(hash >> (8 * a));
}

/* What fits is merged by a merger of its own, and makes curves. */
static void merge_and_show(const struct job_kind *kind, size_t which,
                           const struct block_result *result) {
    struct job_merger *merger = NULL;
    struct case_result out = {0};
    struct error err = {0};
    MUST(merger_create(&merger, kind, parameters[which], &err) == 0);
    MUST(merger_add(merger, result, &err) == 0);
    MUST(merger_fits(merger, result, &err) == ERROR_INPUT); /* its realisations are there now */
    MUST(merger_result(merger, &out, &err) == 0);
    result_clear(&out);
    merger_destroy(&merger);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (size < 2)
        return 0;
    size_t which = data[0] % CASES;
    const struct job_kind *kind = kind_find(STUDIES[which].kind);
    struct error err = {0};
    if (parameters[which] == NULL) {
        parameters[which] = cJSON_Parse(STUDIES[which].text);
        MUST(merger_create(&empty[which], kind, parameters[which], &err) == 0);
    }
    unsigned char *sealed = malloc(size - 2 + 8);
    MUST(sealed != NULL);
    memcpy(sealed, data + 2, size - 2);
    seal(sealed, size - 2);
    struct block_result result = {.count = 1 + data[1] % REALISATIONS_MOST,
                                  .scalar_count = kind_scalar_count(kind),
                                  .scalars = scalars,
                                  .data = sealed,
                                  .size = size - 2 + 8,
                                  .seconds = 1};
    MUST(result.scalar_count <= SCALARS_MOST);
    int fits = merger_fits(empty[which], &result, &err);
    MUST(fits == 0 || (fits == ERROR_INPUT && *err.text != 0));
    if (fits == 0)
        merge_and_show(kind, which, &result);
    else
        MUST(merger_add(empty[which], &result, &err) == ERROR_INPUT); /* and nothing is added */
    free(sealed);
    return 0;
}
