/* The document of one case: {"realisations", "scalars", "curves"} of interface.md. */
#ifndef RUGO_JOBS_CASE_DOCUMENT_H
#define RUGO_JOBS_CASE_DOCUMENT_H

#include "core/error.h"
#include <cjson/cJSON.h>
#include <stdint.h>

/* Takes scalars and curves, also where it fails. Caller deletes *out. */
int case_document(uint64_t realisations, cJSON *scalars, cJSON *curves, cJSON **out,
                  struct error *err);

#endif
