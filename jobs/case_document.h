/* The document of one case: {"realisations", "scalars", "curves"} of schema/result/README.md, and
 * "notes" where there are any. */
#ifndef RUGO_JOBS_CASE_DOCUMENT_H
#define RUGO_JOBS_CASE_DOCUMENT_H

#include "jobs/notes.h"

/* notes: NULL for none. Takes scalars and curves, also where it fails. Caller deletes *out. */
int case_document(uint64_t realisations, cJSON *scalars, cJSON *curves, const struct notes *notes,
                  cJSON **out, struct error *err);

#endif
