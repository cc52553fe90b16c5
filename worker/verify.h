/* Whether a store is whole, with what kinds know of it; and what makes it whole again. */
#ifndef RUGO_WORKER_VERIFY_H
#define RUGO_WORKER_VERIFY_H

#include "schema/store/store_verify.h"

struct verify_report {
    struct verify_counts counts;
    uint64_t kept; /* blocks that this program cannot merge, of cases that are published whole */
};
/* Looks at all that store_verify looks at, and, unless quick, whether every block can be merged. */
int verify_store(struct store *store, const struct verification *verification, bool quick,
                 struct verify_report *report, struct error *err);

struct repair_report {
    uint64_t structure;     /* times that indices were made anew */
    uint64_t cases, blocks; /* whose parameters were put back; given up, to be computed anew */
    uint64_t published;     /* cases made anew from their blocks */
    uint64_t counters;      /* and coverage: put right */
    uint64_t sealed;        /* what had no checksum and has one now */
    struct verify_report before, after;
};
/* Mends a store that nobody else has open (store_take_alone): what is published is merged anew,
 * blocks that cannot be read are queued again, as their random numbers give the same, parameters
 * are put back from the document of the study, what is counted is counted anew. verification->found
 * is called with what was wrong, and at the end with what still is. ERROR_INPUT where the file
 * itself is damaged beyond this. */
int repair_store(struct store *store, const struct verification *verification,
                 struct repair_report *report, struct error *err);

#endif
