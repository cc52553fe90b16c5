/* Verifies and repairs a store by what the kinds know of their blocks, too. */
#ifndef RUGO_WORKER_PUBLISH_VERIFY_H
#define RUGO_WORKER_PUBLISH_VERIFY_H

#include "schema/store/upkeep/store_verify.h"

struct verify_report {
    struct verify_counts counts;
    uint64_t kept; /* blocks that this program cannot merge, of published cases */
};
/* Checks all that store_verify checks and, unless quick, whether every block can be merged. */
int verify_store(struct store *store, const struct verification *verification, bool quick,
                 struct verify_report *report, struct error *err);

struct repair_report {
    uint64_t structure;     /* times that indices were rebuilt */
    uint64_t cases, blocks; /* parameters restored; blocks deleted, to be computed again */
    uint64_t published;     /* cases to be published again */
    uint64_t counters;      /* counters and gaps repaired */
    uint64_t sealed;        /* rows without a checksum that have one now */
    struct verify_report before, after;
};
/* Repairs a store that no other process has open (store_take_alone). What is published is merged
 * again; blocks that cannot be read are queued again, as their random numbers give the same;
 * parameters are restored from the document of the study; counters are counted again.
 * verification->found is called with each fault found, and at the end with those that remain.
 * ERROR_INPUT where the file itself is damaged beyond this. */
int repair_store(struct store *store, const struct verification *verification,
                 struct repair_report *report, struct error *err);

#endif
