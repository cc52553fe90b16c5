/* The server of `rugo slurm`: a child process, at an address that nodes reach, which ends with the
 * command however this ends. */
#ifndef RUGO_SERVER_COMMAND_CLUSTER_SLURM_SERVER_H
#define RUGO_SERVER_COMMAND_CLUSTER_SLURM_SERVER_H

#include "server/command/cluster/slurm_folder.h"
#include <stdbool.h>
#include <sys/types.h>

struct slurm_server {
    const struct slurm_folder *folder; /* all borrowed */
    const char *database;
    const char *address; /* to listen on; NULL: own_address */
    unsigned lease_s;
    pid_t pid; /* 0: none */
};
/* Starts it, waits until it listens, and writes "place" for the pilots: at the port that it had in
 * this folder before, where that is free, so that its pilots find it again. */
int slurm_server_start(struct slurm_server *server, struct error *err);
/* Whether it has ended by itself; it can be started again then. */
bool slurm_server_has_ended(struct slurm_server *server);
void slurm_server_stop(struct slurm_server *server);

#endif
