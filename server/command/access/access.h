/* A store, in a local file or behind a server: each question gives the same document from either.
 */
#ifndef RUGO_SERVER_COMMAND_ACCESS_ACCESS_H
#define RUGO_SERVER_COMMAND_ACCESS_ACCESS_H

#include "schema/study/fault.h"
#include "server/command/command.h"
#include "worker/link/client_trust.h"
#include "worker/publish/aggregate.h"
#include "worker/publish/comparison.h"
#include <stdio.h>

struct access_options {
    const char *database, *server, *token_file; /* as given; database NULL: DATABASE */
    struct client_trust trust;
};
/* The rows of its options, for a command's struct that holds it under the name in the offsets: of
 * commands that ask a store or a server, and of those that ask servers alone. */
#define ACCESS_ROWS(options)                                                                       \
    {"db",   0,    OPTION_TEXT,                                                                    \
     0,      0,    offsetof(options, place.database),                                              \
     "FILE", NULL, "the local store (" DATABASE ")"},                                              \
        ACCESS_SERVER_ROWS(options, "a server instead")
#define ACCESS_SERVER_ROWS(options, what)                                                          \
    {"server", 0, OPTION_TEXT, 0, 0, offsetof(options, place.server), "URL", NULL, what},          \
        {"ca-file",                                                                                \
         0,                                                                                        \
         OPTION_TEXT,                                                                              \
         0,                                                                                        \
         0,                                                                                        \
         offsetof(options, place.trust.ca_file),                                                   \
         "FILE",                                                                                   \
         NULL,                                                                                     \
         "certificates of authorities that sign it, PEM, or RUGO_CA_FILE; else the system's"},     \
        {"fingerprint",                                                                            \
         0,                                                                                        \
         OPTION_TEXT,                                                                              \
         0,                                                                                        \
         0,                                                                                        \
         offsetof(options, place.trust.fingerprint),                                               \
         "sha256:HEX",                                                                             \
         NULL,                                                                                     \
         "fingerprint of its key, in place of an authority; or RUGO_FINGERPRINT"},                 \
        {"insecure", 0,    OPTION_FLAG,                                                            \
         0,          0,    offsetof(options, place.trust.insecure),                                \
         NULL,       NULL, "send the token beyond this machine in clear text too"},                \
    {                                                                                              \
        "token-file", 0, OPTION_TEXT, 0, 0, offsetof(options, place.token_file), "FILE", NULL,     \
            "a token for it, or its own file of tokens; or RUGO_TOKEN"                             \
    }

enum access_mode { ACCESS_READ, ACCESS_WRITE, ACCESS_CREATE };
struct access;

/* Whom to believe of servers: as given, else as the environment says. */
struct client_trust access_trust(const struct access_options *options);
/* 0, or EXIT_USAGE after a usage error was printed (both store and server, or a token without a
 * server). */
int access_options_check(const char *command, const struct access_options *options);
int access_open(struct access **out, const struct access_options *options, enum access_mode mode,
                struct error *err);
void access_close(struct access **access);

/* Finds the id of the study that `given` stands for (store_find); the functions below take ids
 * alone. Of several studies with that name it is the newest, and the command prints to standard
 * error which one that is; with command NULL they are refused. */
int access_find(struct access *access, const char *command, const char *given,
                char id[STUDY_ID_SIZE], struct error *err);

/* What is submitted; all borrowed. */
struct submission {
    const char *text; /* JSON */
    size_t size;
    const char *const *overrides; /* as of --set, NULL-terminated; or NULL */
    /* The same key and study make one study, however often they are submitted. NULL: one of this
     * call alone. */
    const char *key;
    unsigned timeout_s; /* for a server's answer; 0: 30 */
};
/* These give documents as in openapi.yaml; the caller deletes them. */
int access_submit(struct access *access, const struct submission *submission, cJSON **out,
                  struct fault_list *faults, struct error *err);
int access_status(struct access *access, const char *id, cJSON **out, struct error *err);
int access_document(struct access *access, const char *id, cJSON **out, struct error *err);
int access_list(struct access *access, cJSON **out, struct error *err); /* of all studies */
int access_cancel(struct access *access, const char *id, cJSON **out, struct error *err);
int access_retry(struct access *access, const char *id, cJSON **out, struct error *err);
/* Of a local store, this gives the space back before it returns. */
int access_delete(struct access *access, const char *id, cJSON **out, struct error *err);
int access_extend(struct access *access, const char *id, uint64_t realisations, cJSON **out,
                  struct error *err);
/* These give results, differences and reports, whose theories a server completes in any case. */
int access_results(struct access *access, const char *id, const struct result_filter *filter,
                   struct study_result *out, struct error *err);
int access_difference(struct access *access, const char *id, const struct comparison *comparison,
                      struct study_result *out, struct error *err);
/* Prints the table of a study (case_table.h), which a server makes itself. */
struct table_request;
int access_table(struct access *access, const char *id, const struct table_request *request,
                 int format, FILE *file, struct error *err);
int access_report(struct access *access, const char *id, struct study_report *out,
                  struct error *err);
/* Of a server alone: what it says of itself; an error where it is not well. */
int access_health(struct access *access, cJSON **out, struct error *err);
/* Copies the store to a file, which is there when it is whole; path must not exist. A local copy
 * ends when stop_requested is set. */
int access_snapshot(struct access *access, const char *path, struct error *err);

#endif
