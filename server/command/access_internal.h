/* What the files of an access share; nobody else includes this. */
#ifndef RUGO_SERVER_COMMAND_ACCESS_INTERNAL_H
#define RUGO_SERVER_COMMAND_ACCESS_INTERNAL_H

#include "worker/client.h"

struct access {
    struct store *store; /* one of the two; owned */
    struct client *client;
};

#endif
