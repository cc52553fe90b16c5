/* The difference of two cases of a study, from what the store has of both now. */
#ifndef RUGO_WORKER_PUBLISH_COMPARISON_H
#define RUGO_WORKER_PUBLISH_COMPARISON_H

#include "schema/store/store.h"

struct comparison {
    uint64_t minuend, subtrahend; /* cases */
    const char *quantity;         /* of curves; NULL: all */
};
/* Fills a study's result with one case, the difference (schema/result/difference.h). Its values are
 * over the realisations that both have, paired where cases share their random numbers; its remark
 * names exceptions. ERROR_INPUT where the two are one, have nothing of the quantity in common, or
 * one asks for an error. ERROR_ABSENT for an unknown study or case; ERROR_STATE for one that has
 * not begun. */
int comparison_make(struct store *store, const char *study, const struct comparison *comparison,
                    struct study_result *out, struct error *err);

#endif
