/* Whether a store is whole, and what mends it. Looks at all that is stored: the file's own
 * structure, references, checksums (store_seal.h), whether the jobs of each case cover its
 * realisations, whether counters are what they count. Whether blocks can be merged is for who knows
 * their kinds (worker/verify.h). */
#ifndef RUGO_SCHEMA_STORE_STORE_VERIFY_H
#define RUGO_SCHEMA_STORE_STORE_VERIFY_H

#include "schema/store/store.h"

enum flaw_kind {
    FLAW_FILE,      /* the structure of the file; what else is told may follow from it */
    FLAW_REFERENCE, /* a row belongs to one that is not there */
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
    /* Called every now and then; non-zero stops with ERROR_STOPPED. May be NULL. */
    int (*progress)(void *context, const char *what, uint64_t done);
    void *context;
};
struct verify_counts {
    uint64_t cases, blocks, published; /* looked at */
    uint64_t unsealed;                 /* of these, without a checksum: of an older program */
    uint64_t flaws;
};
/* Looks at the store as it is at one moment; *counts is added to. */
int store_verify(struct store *store, const struct verification *verification,
                 struct verify_counts *counts, struct error *err);

/* --- mending, by who has the store alone --- */

/* Takes the file for this handle alone, until it is closed. ERROR_STATE where another process, or
 * another handle, has it open. */
int store_take_alone(struct store *store, struct error *err);
/* Makes indices anew, and deletes rows that belong to none that is there. */
int store_mend_structure(struct store *store, struct error *err);
/* Puts what a case is computed from back, where its checksum says that it was so. */
struct case_origin {
    const char *kind, *parameters; /* as they are printed when a study is queued */
    enum study_random random;
    uint64_t seed;
};
int store_mend_case(struct store *store, const char *study, uint64_t case_number,
                    const struct case_origin *origin, bool *mended, struct error *err);
/* Gives up a block, or, with job 0, all of a case: store_mend_counts queues them again. Of a study
 * of another edition than this (study.h) all of the case goes, as its rest could not stand beside
 * what this program computes. */
int store_drop_blocks(struct store *store, const char *study, uint64_t case_number, int64_t job,
                      uint64_t edition, struct error *err);
/* Has what is published of a case published anew. */
int store_drop_published(struct store *store, const char *study, uint64_t case_number,
                         struct error *err);
/* Queues what cases that count as flawed lack, counts all anew, and seals what has no seal. What is
 * queued of a study that was cancelled is cancelled. */
int store_mend_counts(struct store *store, struct error *err);

#endif
