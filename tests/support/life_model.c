#include "tests/support/life_model.h"
#include <stdio.h>
#include <string.h>

const char *const LIFE_STATE_NAMES[LIFE_STATES] = {"waiting", "running", "done", "failed",
                                                   "cancelled"};

static bool is_of(const struct life_job *job, int study, int case_number) {
    return job->study == study && (case_number < 0 || job->case_number == case_number);
}

static int count_of(const struct life *life, int study, int case_number, enum life_state state) {
    int n = 0;
    for (int j = 0; j < life->job_count; j++)
        if (is_of(&life->jobs[j], study, case_number) && life->jobs[j].state == state)
            n += life->jobs[j].blocks;
    return n;
}

int life_count(const struct life *life, int study, enum life_state state) {
    return count_of(life, study, -1, state);
}

int life_left(const struct life *life, int study, int case_number) {
    return count_of(life, study, case_number, LIFE_WAITING) +
           count_of(life, study, case_number, LIFE_RUNNING);
}

int life_marks(const struct life *life, int study) {
    int n = 0;
    for (int c = 0; c < life->studies[study].cases; c++)
        n += life->studies[study].of[c].marked;
    return n;
}

static int blocks_of(int64_t count) {
    return (int)((count + LIFE_BLOCK - 1) / LIFE_BLOCK);
}

void life_submit(struct life *life, int cases, int realisations) {
    int study = life->study_count++;
    life->studies[study] = (struct life_study){.cases = cases};
    for (int c = 0; c < cases; c++)
        life->jobs[life->job_count++] = (struct life_job){.study = study,
                                                          .case_number = c,
                                                          .count = realisations,
                                                          .blocks = blocks_of(realisations)};
}

/* --- jobs --- */

static void give_up(struct life_job *job, const char *reason, bool permanent) {
    bool last = permanent || job->attempts >= 3;
    snprintf(job->error, sizeof job->error, "%s", reason);
    job->state = last ? LIFE_FAILED : LIFE_WAITING;
    job->not_before = 0;
    if (!last)
        job->token = 0;
}

static void lose(struct life_job *job, int64_t now_ms) {
    job->attempts--;
    job->losses++;
    bool last = job->losses >= 10;
    snprintf(job->error, sizeof job->error, "%slease ran out on worker w%d",
             last ? "lost with its worker 10 times: killed, cut off or out of memory; the last "
                  : "",
             job->worker);
    job->state = last ? LIFE_FAILED : LIFE_WAITING;
    if (last)
        return;
    job->token = 0;
    job->not_before = now_ms + 1000 * (job->losses < 7 ? 1 << (job->losses - 1) : 64);
}

void life_expire(struct life *life, int64_t now_ms) {
    for (int j = 0; j < life->job_count; j++) {
        struct life_job *job = &life->jobs[j];
        if (job->state == LIFE_RUNNING && job->lease_until <= now_ms)
            lose(job, now_ms);
    }
}

int life_next(const struct life *life, int64_t now_ms) {
    int found = -1;
    for (int j = 0; j < life->job_count; j++) {
        const struct life_job *job = &life->jobs[j], *best = &life->jobs[found < 0 ? 0 : found];
        if (job->state != LIFE_WAITING || job->not_before > now_ms)
            continue;
        if (found < 0 || job->study < best->study ||
            (job->study == best->study && job->case_number < best->case_number))
            found = j;
    }
    return found;
}

int64_t life_block(const struct life_job *job) {
    return (job->count + blocks_of(job->count) - 1) / blocks_of(job->count);
}

int life_lease(struct life *life, int job, int64_t count, int worker, int token, int64_t now_ms) {
    struct life_job *one = &life->jobs[job];
    if (count < one->count) {
        struct life_job *span = one;
        one = &life->jobs[life->job_count++];
        *one = *span;
        one->count = count;
        span->first += count;
        span->count -= count;
        span->blocks = blocks_of(span->count);
        *one->error = 0;
    }
    one->state = LIFE_RUNNING;
    one->blocks = 1;
    one->attempts++;
    one->worker = worker;
    one->token = token;
    one->lease_until = now_ms + LIFE_LEASE_MS;
    life->studies[one->study].begun = true;
    return (int)(one - life->jobs);
}

static bool is_leased(const struct life_job *job, int token) {
    return job->state == LIFE_RUNNING && job->token == token;
}

bool life_complete(struct life *life, int job, int token, int64_t count, bool *again) {
    struct life_job *one = &life->jobs[job];
    *again = one->state == LIFE_DONE && one->token == token;
    if (*again)
        return true;
    if (!is_leased(one, token))
        return false;
    if (count < one->count)
        life->jobs[life->job_count++] = (struct life_job){.study = one->study,
                                                          .case_number = one->case_number,
                                                          .first = one->first + count,
                                                          .count = one->count - count,
                                                          .blocks = blocks_of(one->count - count),
                                                          .attempts = one->attempts - 1,
                                                          .losses = one->losses};
    one->count = count;
    one->state = LIFE_DONE;
    life->studies[one->study].of[one->case_number].revision++;
    return true;
}

bool life_fail(struct life *life, int job, int token, const char *reason, bool permanent) {
    if (!is_leased(&life->jobs[job], token))
        return false;
    give_up(&life->jobs[job], reason, permanent);
    return true;
}

bool life_release(struct life *life, int job, int token) {
    struct life_job *one = &life->jobs[job];
    if (!is_leased(one, token))
        return false;
    one->state = LIFE_WAITING;
    one->not_before = 0;
    one->token = 0;
    one->attempts--;
    return true;
}

bool life_heartbeat(struct life *life, int job, int token, int64_t now_ms) {
    if (!is_leased(&life->jobs[job], token))
        return false;
    life->jobs[job].lease_until = now_ms + LIFE_LEASE_MS;
    return true;
}

/* --- studies --- */

static bool is_open(const struct life *life, int study) {
    return life_left(life, study, -1) > 0;
}

bool life_cancel(struct life *life, int study) {
    const char *now = life_study_state(life, study);
    if (strcmp(now, "queued") != 0 && strcmp(now, "running") != 0)
        return false;
    life->studies[study].cancelled = true;
    for (int j = 0; j < life->job_count; j++) {
        struct life_job *job = &life->jobs[j];
        if (job->study == study && (job->state == LIFE_WAITING || job->state == LIFE_RUNNING))
            job->state = LIFE_CANCELLED;
    }
    return true;
}

int life_retry(struct life *life, int study) {
    struct life_study *one = &life->studies[study];
    int n = 0;
    for (int j = 0; j < life->job_count; j++) {
        struct life_job *job = &life->jobs[j];
        if (job->study == study && job->state == LIFE_DONE && one->of[job->case_number].marked)
            job->state = LIFE_FAILED; /* its result is given up */
        if (job->study != study || (job->state != LIFE_FAILED && job->state != LIFE_CANCELLED))
            continue;
        job->state = LIFE_WAITING;
        job->attempts = job->losses = job->token = 0;
        job->not_before = 0;
        n += job->blocks;
    }
    if (n > 0 || one->cancelled) {
        one->cancelled = false;
        one->begun = life_count(life, study, LIFE_DONE) + life_count(life, study, LIFE_RUNNING) > 0;
    }
    for (int c = 0; c < one->cases; c++)
        if (one->of[c].marked) {
            one->of[c].marked = false;
            one->of[c].settled = 0;
        }
    return n;
}

const char *life_study_state(const struct life *life, int study) {
    const struct life_study *one = &life->studies[study];
    if (one->cancelled)
        return "cancelled";
    if (is_open(life, study))
        return one->begun ? "running" : "queued";
    for (int c = 0; c < one->cases; c++)
        if (life_is_due(life, study, c))
            return "running";
    return life_count(life, study, LIFE_FAILED) + life_marks(life, study) > 0 ? "failed" : "done";
}

/* --- cases --- */

bool life_is_due(const struct life *life, int study, int case_number) {
    const struct life_case *one = &life->studies[study].of[case_number];
    return life_left(life, study, case_number) == 0 && one->revision > one->settled;
}

int life_due_count(const struct life *life) {
    int n = 0;
    for (int s = 0; s < life->study_count; s++)
        for (int c = 0; c < life->studies[s].cases; c++)
            n += life_is_due(life, s, c);
    return n;
}

uint32_t life_done_jobs(const struct life *life, int study, int case_number) {
    uint32_t jobs = 0;
    for (int j = 0; j < life->job_count; j++)
        if (is_of(&life->jobs[j], study, case_number) && life->jobs[j].state == LIFE_DONE)
            jobs |= (uint32_t)1 << j;
    return jobs;
}

void life_publish(struct life *life, int study, int case_number, int64_t revision, uint32_t jobs) {
    struct life_case *one = &life->studies[study].of[case_number];
    if (revision > one->published) {
        one->published = revision;
        one->published_jobs = jobs;
    }
    if (revision >= one->settled) {
        one->settled = revision;
        one->marked = false;
    }
}

void life_mark(struct life *life, int study, int case_number, int64_t revision) {
    struct life_case *one = &life->studies[study].of[case_number];
    if (!life_is_due(life, study, case_number) || one->revision != revision)
        return;
    one->settled = revision;
    one->marked = true;
}

const char *life_case_state(const struct life *life, int study, int case_number) {
    const struct life_case *one = &life->studies[study].of[case_number];
    if (life_left(life, study, case_number) > 0)
        return "open";
    if (one->revision == 0)
        return "empty";
    if (life_is_due(life, study, case_number))
        return "due";
    return one->marked ? "failed" : "published";
}
