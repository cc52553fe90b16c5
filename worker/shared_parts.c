#include "worker/shared_parts.h"

#include <stdlib.h>
#include <string.h>

struct shared_part {
    const struct job_kind *kind;
    char study[STUDY_ID_SIZE];
    uint64_t case_number;
    struct job_shared *content; /* NULL while it is being made; constant from then on */
    size_t holders;
    struct shared_part *next;
};

int shared_parts_init(struct shared_parts *parts, struct error *err) {
    parts->first = NULL;
    if (pthread_mutex_init(&parts->lock, NULL) != 0)
        return error_set(err, ERROR_SYSTEM, "cannot make a lock");
    if (pthread_cond_init(&parts->made, NULL) != 0) {
        pthread_mutex_destroy(&parts->lock);
        return error_set(err, ERROR_SYSTEM, "cannot make a condition");
    }
    return 0;
}

void shared_parts_destroy(struct shared_parts *parts) {
    pthread_cond_destroy(&parts->made);
    pthread_mutex_destroy(&parts->lock);
}

/* The caller holds the lock, here and in all functions below that do not say otherwise. */
static struct shared_part *part_find(struct shared_parts *parts, const char *study,
                                     uint64_t case_number) {
    struct shared_part *part = parts->first;
    while (part != NULL && (part->case_number != case_number || strcmp(part->study, study) != 0))
        part = part->next;
    return part;
}

static void part_unlink(struct shared_parts *parts, struct shared_part *part) {
    struct shared_part **link = &parts->first;
    while (*link != part)
        link = &(*link)->next;
    *link = part->next;
}

/* Counts one more holder of the part and returns it, or NULL where there is none. Waits while
 * another thread makes the part. */
static struct shared_part *part_hold(struct shared_parts *parts, const char *study,
                                     uint64_t case_number) {
    struct shared_part *part;
    while ((part = part_find(parts, study, case_number)) != NULL && part->content == NULL)
        pthread_cond_wait(&parts->made, &parts->lock);
    if (part != NULL)
        part->holders++;
    return part;
}

/* Links an empty part that this thread is about to make; NULL when out of memory. */
static struct shared_part *part_link(struct shared_parts *parts, const struct job_kind *kind,
                                     const char *study, uint64_t case_number) {
    struct shared_part *part = array_create(1, sizeof *part);
    if (part != NULL) {
        part->kind = kind;
        part->case_number = case_number;
        part->holders = 1;
        strncpy(part->study, study, sizeof part->study - 1);
        part->next = parts->first;
        parts->first = part;
    }
    return part;
}

/* Makes a part. The caller does not hold the lock: this may take long, and threads of other cases
 * go on. */
static int part_make(struct shared_parts *parts, struct shared_part *part, const cJSON *parameters,
                     struct error *err) {
    struct job_shared *content = NULL;
    int status = job_shared_create(&content, part->kind, parameters, err);
    pthread_mutex_lock(&parts->lock);
    part->content = content;
    if (status != 0)
        part_unlink(parts, part);
    pthread_cond_broadcast(&parts->made);
    pthread_mutex_unlock(&parts->lock);
    return status;
}

int shared_parts_take(struct shared_parts *parts, const struct job_kind *kind, const char *study,
                      uint64_t case_number, const cJSON *parameters, struct shared_part **out,
                      struct error *err) {
    *out = NULL;
    if (kind->shared_create == NULL)
        return 0;
    pthread_mutex_lock(&parts->lock);
    *out = part_hold(parts, study, case_number);
    bool ready = *out != NULL;
    if (!ready)
        *out = part_link(parts, kind, study, case_number);
    pthread_mutex_unlock(&parts->lock);
    if (ready)
        return 0;
    if (*out == NULL)
        return error_memory(err, sizeof **out, "what runners share");
    int status = part_make(parts, *out, parameters, err);
    if (status != 0) {
        free(*out);
        *out = NULL;
    }
    return status;
}

void shared_parts_let_go(struct shared_parts *parts, struct shared_part **handle) {
    struct shared_part *part = *handle;
    *handle = NULL;
    if (part == NULL)
        return;
    pthread_mutex_lock(&parts->lock);
    bool last = --part->holders == 0;
    if (last)
        part_unlink(parts, part);
    pthread_mutex_unlock(&parts->lock);
    if (last) {
        job_shared_destroy(&part->content);
        free(part);
    }
}

const struct job_shared *shared_part_content(const struct shared_part *part) {
    return part != NULL ? part->content : NULL;
}
