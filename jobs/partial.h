/* A tally as bytes: the partial result of a block. It has a checksum, and only a case of the same
 * kind, version of its format and parameters decodes it. */
#ifndef RUGO_JOBS_PARTIAL_H
#define RUGO_JOBS_PARTIAL_H

#include "jobs/kind.h"

/* Encodes a tally with the fingerprint of its case (kind_fingerprint). The caller frees *data. */
int partial_encode(const struct job_kind *kind, uint64_t fingerprint, const void *tally,
                   unsigned char **data, size_t *size, struct error *err);
/* Decodes into a new tally of the case, whose contents are undefined after a failure. */
int partial_decode(const struct job_kind *kind, uint64_t fingerprint, const unsigned char *data,
                   size_t size, void *tally, struct error *err);

#endif
