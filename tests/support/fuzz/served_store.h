/* A store with small studies of every kind: finished, broken, waiting and given up. */
#ifndef RUGO_TESTS_SUPPORT_FUZZ_SERVED_STORE_H
#define RUGO_TESTS_SUPPORT_FUZZ_SERVED_STORE_H

#include "tests/support/fuzz/served.h"

/* Makes the file and fills `served`, those with results first; ends the process where it cannot. */
void served_store_make(struct served *served, const char *path);
/* Removes a store and what SQLite keeps beside it. */
void served_store_remove(const char *path);

#endif
