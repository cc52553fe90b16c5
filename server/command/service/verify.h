/* What `rugo verify` prints, for other commands that make or take copies of stores. */
#ifndef RUGO_SERVER_COMMAND_SERVICE_VERIFY_H
#define RUGO_SERVER_COMMAND_SERVICE_VERIFY_H

#include "worker/publish/verify.h"

/* Verifies a store, shows how far it is where standard error is a terminal, and prints each flaw
 * and a line of counts under this name. ERROR_STOPPED after a signal. */
int verify_and_print(struct store *store, const char *name, bool quick,
                     struct verify_report *report, struct error *err);

#endif
