/* What the files of an access share; nobody else includes this. */
#ifndef RUGO_SERVER_COMMAND_ACCESS_INTERNAL_H
#define RUGO_SERVER_COMMAND_ACCESS_INTERNAL_H

#include "worker/client.h"

struct access {
    struct store *store; /* one of the two; owned */
    struct client *client;
    const char *server; /* its URL, borrowed */
};
/* Writes the path of a study, with what is behind its id; ERROR_ABSENT where it is no id. */
int access_study_path(char *path, size_t size, const char *id, const char *rest, struct error *err);

#endif
