#include "worker/checker.h"
#include "jobs/kind.h"
#include "jobs/merger.h"
#include "schema/json/json.h"
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CASES_KEPT = 4 };

/* An empty merger of one case. As nothing is merged into it, all threads may use it. */
struct case_merger {
    char study[STUDY_ID_SIZE];
    uint64_t case_number;
    const struct job_kind *kind;
    struct job_merger *merger; /* owned */
    unsigned holders;          /* the checker that keeps it, and each thread that uses it */
};

struct checker {
    pthread_mutex_t mutex;                /* guards the list and all counts of holders */
    struct case_merger *kept[CASES_KEPT]; /* the one used last in front */
};

static void case_merger_destroy(struct case_merger **one) {
    if (*one != NULL && (*one)->merger != NULL)
        merger_destroy(&(*one)->merger);
    free(*one);
    *one = NULL;
}

static int case_merger_create(struct case_merger **out, const struct claimed_job *job,
                              const struct job_kind *kind, struct error *err) {
    struct case_merger *one = array_create(1, sizeof *one);
    if (one == NULL)
        return error_memory(err, sizeof *one, "a merger");
    snprintf(one->study, sizeof one->study, "%s", job->study);
    one->case_number = job->case_number;
    one->kind = kind;
    one->holders = 1;
    int status = merger_create(&one->merger, kind, job->parameters, err);
    if (status != 0)
        case_merger_destroy(&one);
    else
        *out = one;
    return status;
}

static void let_go(struct checker *checker, struct case_merger *one) {
    pthread_mutex_lock(&checker->mutex);
    bool last = --one->holders == 0;
    pthread_mutex_unlock(&checker->mutex);
    if (last)
        case_merger_destroy(&one);
}

/* Moves the case's merger to the front and counts a holder; NULL when it is not kept. */
static struct case_merger *take(struct checker *checker, const struct claimed_job *job) {
    struct case_merger *found = NULL;
    pthread_mutex_lock(&checker->mutex);
    for (size_t i = 0; i < CASES_KEPT && checker->kept[i] != NULL && found == NULL; i++) {
        struct case_merger *one = checker->kept[i];
        if (one->case_number != job->case_number || strcmp(one->study, job->study) != 0)
            continue;
        memmove(checker->kept + 1, checker->kept, i * sizeof *checker->kept);
        checker->kept[0] = found = one;
        found->holders++;
    }
    pthread_mutex_unlock(&checker->mutex);
    return found;
}

/* Keeps a merger in front. Two threads may keep the same case for a while: the older merger drops
 * out at the end. */
static void keep(struct checker *checker, struct case_merger *one) {
    pthread_mutex_lock(&checker->mutex);
    struct case_merger *dropped = checker->kept[CASES_KEPT - 1];
    memmove(checker->kept + 1, checker->kept, (CASES_KEPT - 1) * sizeof *checker->kept);
    checker->kept[0] = one;
    one->holders++;
    pthread_mutex_unlock(&checker->mutex);
    if (dropped != NULL)
        let_go(checker, dropped);
}

int checker_check(struct checker *checker, const struct claimed_job *job,
                  const struct block_result *result, struct error *err) {
    const struct job_kind *kind = kind_find(job->kind);
    if (kind == NULL)
        return error_set(err, ERROR_SYSTEM, "this program knows no kind '%.40s'", job->kind);
    int status = kind_check_names(kind, result, err);
    if (status != 0)
        return status;
    struct case_merger *one = take(checker, job);
    if (one == NULL) {
        status = case_merger_create(&one, job, kind, err);
        if (status != 0)
            return status;
        keep(checker, one);
    }
    status = merger_fits(one->merger, result, err);
    let_go(checker, one);
    return status;
}

int checker_create(struct checker **out, struct error *err) {
    struct checker *checker = array_create(1, sizeof *checker);
    if (checker == NULL)
        return error_memory(err, sizeof *checker, "a checker of results");
    pthread_mutex_init(&checker->mutex, NULL);
    *out = checker;
    return 0;
}

void checker_destroy(struct checker **checker) {
    struct checker *c = *checker;
    if (c == NULL)
        return;
    for (size_t i = 0; i < CASES_KEPT; i++)
        case_merger_destroy(&c->kept[i]);
    pthread_mutex_destroy(&c->mutex);
    free(c);
    *checker = NULL;
}
