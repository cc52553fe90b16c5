/* Studies of needles (third_kind.h), of any number of tiny jobs: what benches of the store load it
 * with. */
#ifndef RUGO_TESTS_SUPPORT_NEEDLE_STUDY_H
#define RUGO_TESTS_SUPPORT_NEEDLE_STUDY_H

#include "schema/study/fault.h"
#include "tests/support/third_kind.h"
#include <stdio.h>
#include <stdlib.h>

/* Returns a study of so many cases, each of a number of throws of its own, with a job a
 * realisation; NULL after an error. The caller destroys it. */
static inline struct study *needle_study(unsigned cases, unsigned realisations, struct error *err) {
    struct study *study = NULL;
    struct fault_list faults = {0};
    const size_t size = 200 + 8 * (size_t)cases;
    char *text = array_create(size, 1);
    if (text == NULL) {
        (void)error_memory(err, size, "a study");
        return NULL;
    }
    size_t used = (size_t)snprintf(text, size,
                                   "{\"name\":\"n\",\"kind\":\"needle\",\"seed\":1,"
                                   "\"realisations\":%u,\"needle\":{\"throws\":[",
                                   realisations);
    for (unsigned n = 0; n < cases; n++)
        used += (size_t)snprintf(text + used, size - used, "%s%u", n > 0 ? "," : "", 10 + n);
    used += (size_t)snprintf(text + used, size - used, "]}}");
    if (kind_read_study(&study, text, used, NULL, &faults, err) == 0)
        for (unsigned c = 0; c < cases; c++)
            study->cases[c].block = 1; /* a job a realisation */
    fault_list_clear(&faults);
    free(text);
    return study;
}

#endif
