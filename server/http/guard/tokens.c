#include "server/http/guard/tokens.h"
#include "schema/digest.h"
#include "server/command/service/secret_file.h"
#include "worker/clock.h"
#include "worker/log.h"
#include <nettle/memops.h>
#include <pthread.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

struct entry {
    unsigned char digest[DIGEST_SIZE];
    struct token_holder holder;
};
struct entries {
    struct entry *all; /* owned */
    size_t count;
};

struct tokens {
    char *file;            /* owned */
    bool watched;          /* it is no pipe, which is read once */
    struct entry own;      /* no roles: there is none */
    pthread_mutex_t mutex; /* guards all below */
    struct entries entries;
    struct stat seen;       /* the file as it was read */
    int64_t empty_since_ms; /* the file has had no token; 0: it has */
};

/* --- the file --- */

/* What reads a file fills. */
struct token_reading {
    struct entries entries;
    const char *file;
    bool lenient; /* a line at fault is logged, and passed over */
};

static int add_line(void *context, const struct token_line *line, struct error *err) {
    struct token_reading *reading = context;
    struct entries *entries = &reading->entries;
    int status = token_line_check(line, reading->file, err);
    if (status != 0 && reading->lenient)
        log_line(LEVEL_ERROR, NULL, "%s; the line counts for nothing", err->text);
    if (status != 0)
        return reading->lenient ? 0 : status;
    size_t bytes = (entries->count + 1) * sizeof *entries->all;
    struct entry *larger = realloc(entries->all, bytes);
    if (larger == NULL)
        return error_memory(err, bytes, "tokens");
    entries->all = larger;
    struct entry *entry = &larger[entries->count++];
    memcpy(entry->digest, line->digest, sizeof entry->digest);
    entry->holder = (struct token_holder){.roles = line->roles};
    snprintf(entry->holder.name, sizeof entry->holder.name, "%s", line->name);
    return 0;
}

static bool same_file(const struct stat *a, const struct stat *b) {
    return a->st_ino == b->st_ino && a->st_dev == b->st_dev && a->st_size == b->st_size &&
           a->st_mtim.tv_sec == b->st_mtim.tv_sec && a->st_mtim.tv_nsec == b->st_mtim.tv_nsec &&
           a->st_ctim.tv_sec == b->st_ctim.tv_sec && a->st_ctim.tv_nsec == b->st_ctim.tv_nsec;
}

/* What the file holds comes into force; what cannot be read, or is nothing, not yet. A mode that
 * has become open is no reason to go on with tokens that were revoked. */
static void read_again(struct tokens *tokens, const struct stat *now) {
    struct token_reading reading = {.file = tokens->file, .lenient = true};
    struct error err = {0};
    int status = token_file_read(tokens->file, true, add_line, &reading, &err);
    tokens->seen = *now;
    if (status == ERROR_MEMORY) {
        tokens->seen = (struct stat){0}; /* the next request tries again */
        log_line(LEVEL_ERROR, NULL, "tokens stay as they were: %s", err.text);
    } else if (status == 0 && reading.entries.count > 0) {
        struct entries old = tokens->entries;
        tokens->entries = reading.entries;
        tokens->empty_since_ms = 0;
        reading.entries = old;
        log_line(LEVEL_INFO, NULL, "%s holds %zu tokens now", tokens->file, tokens->entries.count);
        if (secret_file_check(tokens->file, now, &err) != 0)
            log_line(LEVEL_ERROR, NULL, "%s", err.text);
    } else if (tokens->empty_since_ms == 0) {
        tokens->empty_since_ms = clock_ms();
        log_line(LEVEL_ERROR, NULL, "%s%s; in %d s no token is valid any more",
                 status != 0 ? err.text : tokens->file, status != 0 ? "" : " holds no token",
                 TOKENS_GRACE_MS / 1000);
    }
    free(reading.entries.all);
}

static void refresh(struct tokens *tokens) {
    struct stat now = {0};
    if (!tokens->watched)
        return;
    bool there = stat(tokens->file, &now) == 0;
    if (!there)
        now = (struct stat){0};
    if (!same_file(&now, &tokens->seen) || (!there && tokens->empty_since_ms == 0))
        read_again(tokens, &now);
    if (tokens->empty_since_ms != 0 && clock_ms() - tokens->empty_since_ms >= TOKENS_GRACE_MS)
        tokens->entries.count = 0;
}

int tokens_read(struct tokens **out, const char *file, struct error *err) {
    struct token_reading reading = {.file = file};
    struct tokens *tokens = calloc(1, sizeof *tokens);
    if (tokens == NULL || (tokens->file = strdup(file)) == NULL) {
        free(tokens);
        return error_memory(err, sizeof *tokens, "tokens");
    }
    pthread_mutex_init(&tokens->mutex, NULL);
    tokens->watched = stat(file, &tokens->seen) == 0 && S_ISREG(tokens->seen.st_mode);
    int status = token_file_read(file, false, add_line, &reading, err);
    tokens->entries = reading.entries;
    if (status == 0 && reading.entries.count == 0)
        status = error_set(err, ERROR_INPUT, "%s holds no token", file);
    if (status != 0) {
        tokens_destroy(&tokens);
        return status;
    }
    *out = tokens;
    return 0;
}

void tokens_destroy(struct tokens **tokens) {
    struct tokens *gone = *tokens;
    if (gone == NULL)
        return;
    pthread_mutex_destroy(&gone->mutex);
    free(gone->entries.all);
    free(gone->file);
    free(gone);
    *tokens = NULL;
}

void tokens_set_own(struct tokens *tokens, unsigned roles, const char *token) {
    digest_text(token, tokens->own.digest);
    tokens->own.holder = (struct token_holder){.roles = roles};
}

/* --- who asks --- */

static void match(const struct entry *entry, const unsigned char digest[DIGEST_SIZE],
                  struct token_holder *found) {
    if (!memeql_sec(entry->digest, digest, DIGEST_SIZE))
        return;
    found->roles |= entry->holder.roles;
    if (*found->name == '\0')
        memcpy(found->name, entry->holder.name, sizeof found->name);
}

struct token_holder tokens_find(struct tokens *tokens, const char *token) {
    unsigned char digest[DIGEST_SIZE];
    struct token_holder found = {0};
    if (token == NULL)
        return found;
    digest_text(token, digest);
    match(&tokens->own, digest, &found);
    pthread_mutex_lock(&tokens->mutex);
    refresh(tokens);
    for (size_t i = 0; i < tokens->entries.count; i++) /* all of them, whichever fits */
        match(&tokens->entries.all[i], digest, &found);
    pthread_mutex_unlock(&tokens->mutex);
    return found;
}

void tokens_look(struct tokens *tokens) {
    pthread_mutex_lock(&tokens->mutex);
    refresh(tokens);
    pthread_mutex_unlock(&tokens->mutex);
}
