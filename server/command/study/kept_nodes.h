/* The files of nodes that a study keeps (/contact/keep), for `rugo run --out`. */
#ifndef RUGO_SERVER_COMMAND_STUDY_KEPT_NODES_H
#define RUGO_SERVER_COMMAND_STUDY_KEPT_NODES_H

#include "schema/store/store.h"

/* Writes them into folder/nodes; none where the study keeps none. Warnings of models without a
 * solution begin with the command. Ends with ERROR_STOPPED where a signal asks for it. */
int kept_nodes_write(struct store *store, const char *id, const char *folder, struct error *err);

#endif
