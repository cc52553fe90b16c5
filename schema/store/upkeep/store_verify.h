/* Verifies and repairs a store. Checks all that is stored: the file's own structure, references,
 * checksums (store_seal.h), whether the jobs of each case cover its realisations, and counters.
 * Whether blocks can be merged is checked where their kinds are known (worker/publish/verify.h). */
#ifndef RUGO_SCHEMA_STORE_STORE_VERIFY_H
#define RUGO_SCHEMA_STORE_STORE_VERIFY_H

#include "schema/store/store.h"

enum flaw_kind {
    FLAW_FILE,      /* the structure of the file; other faults may follow from it */
    FLAW_REFERENCE, /* a row refers to one that is not there */
    FLAW_CASE,      /* what the realisations of a case are computed from */
    FLAW_BLOCK,     /* the result of realisations */
    FLAW_COVER,     /* realisations that no job has, or two */
    FLAW_PUBLISHED, /* what is published of a case */
    FLAW_COUNTER,
    FLAW_KINDS
};
struct flaw {
    enum flaw_kind kind;
    char study[STUDY_ID_SIZE]; /* "": of the store */
    int64_t case_number;       /* -1: of the study */
    uint64_t first, count;     /* realisations; count 0: of the case */
    int64_t job;               /* 0: none */
    const char *text;          /* borrowed: what is wrong */
};

struct verification {
    int (*found)(void *context, const struct flaw *flaw, struct error *err); /* non-zero stops */
    /* Called repeatedly; non-zero stops with ERROR_STOPPED. May be NULL. */
    int (*progress)(void *context, const char *what, uint64_t done);
    void *context;
};
struct verify_counts {
    uint64_t cases, blocks, published; /* checked */
    uint64_t unsealed;                 /* of these, without a checksum: of an older program */
    uint64_t flaws;
};
/* Verifies the store as it is at one moment; adds to *counts. */
int store_verify(struct store *store, const struct verification *verification,
                 struct verify_counts *counts, struct error *err);

/* --- repair, by a process that has the store alone --- */

/* Locks the file for this handle alone, until it is closed. ERROR_STATE where another process, or
 * another handle, has it open. */
int store_take_alone(struct store *store, struct error *err);
/* Rebuilds indices, and deletes rows that refer to rows that are not there. */
int store_repair_structure(struct store *store, struct error *err);
/* Restores what a case is computed from, if its checksum agrees with it; *repaired. If its row is
 * already that, the checksum is the damage, and is set again. */
struct case_origin {
    const char *kind, *parameters; /* as they are printed when a study is queued */
    enum study_random random;
    uint64_t seed;
};
int store_repair_case(struct store *store, const char *study, uint64_t case_number,
                      const struct case_origin *origin, bool *repaired, struct error *err);
/* Deletes a block, or, with job 0, all of a case; store_repair_counts queues them again. If the
 * study is of another version of the program (study.h), all of the case is deleted, as its rest
 * cannot be merged with what this program computes. Adds the results given up to *dropped. */
int store_drop_blocks(struct store *store, const char *study, uint64_t case_number, int64_t job,
                      uint64_t edition, uint64_t *dropped, struct error *err);
/* Has what is published of a case published again. */
int store_drop_published(struct store *store, const char *study, uint64_t case_number,
                         struct error *err);
/* Queues the realisations that cases lack, counts all again, and sets missing checksums. What is
 * queued of a cancelled study is cancelled. */
int store_repair_counts(struct store *store, struct error *err);

#endif
