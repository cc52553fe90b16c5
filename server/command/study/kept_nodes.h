/* The files of nodes that a study keeps (/contact/keep), for `rugo run --out`. */
#ifndef RUGO_SERVER_COMMAND_STUDY_KEPT_NODES_H
#define RUGO_SERVER_COMMAND_STUDY_KEPT_NODES_H

#include "schema/store/store.h"

/* Writes folder/nodes/case-K/realisation-R/MODEL/ with the files of step_folder.h, which replace
 * those of an earlier run; none where the study keeps none. Realisations are made and pressed
 * again: study and seed give the same bits as when they were measured. A model without a solution
 * gets a warning, and its files hold the loads before. Ends with ERROR_STOPPED where a signal asks
 * for it. */
int kept_nodes_write(struct store *store, const char *id, const char *folder, struct error *err);
/* Removes these files of any study from the folder, by their names, and the folders of them that
 * hold nothing else then. ERROR_SYSTEM names what could not be removed. */
int kept_nodes_remove(const char *folder, struct error *err);

#endif
