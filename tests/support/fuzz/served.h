/* What a service holds that requests are drawn for: studies with the names in their results, and
 * jobs that were handed out. */
#ifndef RUGO_TESTS_SUPPORT_FUZZ_SERVED_H
#define RUGO_TESTS_SUPPORT_FUZZ_SERVED_H

#include "schema/store/store.h"
#include "tests/support/fuzz/choices.h"

enum { SERVED_STUDIES = 16, SERVED_JOBS = 12, SERVED_TEXT_SIZE = 80 };

struct served_study {
    char id[STUDY_ID_SIZE], name[SERVED_TEXT_SIZE]; /* the name as a path has it */
    cJSON *contents; /* owned: what /v1/studies/ID/contents answers; NULL before */
};

struct served {
    size_t studies;
    struct served_study study[SERVED_STUDIES];
    size_t jobs; /* that a claim was given; the oldest goes for a new one */
    struct claimed_job job[SERVED_JOBS];
    char etag[SERVED_TEXT_SIZE]; /* of the last answer that had one; "" before */
};

/* Takes over the jobs of an answer to a claim. */
void served_take_jobs(struct served *served, const char *answer, size_t size);
/* Returns a job that was handed out; NULL where none was. */
const struct claimed_job *served_job(struct served *served, struct choices *choices);
/* Forgets a job, such as one that is done; another number is none of them. */
void served_forget_job(struct served *served, int64_t number);
void served_forget_jobs(struct served *served);
void served_clear(struct served *served);

#endif
