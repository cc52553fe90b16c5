/* The provenance of the results of a study, which stands beside them in every document, table and
 * picture. Nothing else differs between two runs of the same study.
 *
 *     {"seed": "1", "program", "created", "finished",
 *      "runs": [{"host", "program", "jobs", "first", "last"}]}
 *
 * seed: a decimal text of 64 bits; created and finished: UTC; program: VERSION+COMMIT. That of the
 * whole queued the study. That of a run computed so many of its jobs on this host, between the
 * first claim and the last result. What is not known is null. */
#ifndef RUGO_SCHEMA_RESULT_PROVENANCE_H
#define RUGO_SCHEMA_RESULT_PROVENANCE_H

#include "schema/result/result.h"
#include <stdio.h>

/* Prints lines of text that begin with "# ", as the head of a table: what the study is, which
 * measured surface its surfaces are like, and its provenance; nothing where that is not known. */
void provenance_comment(FILE *file, const struct study_result *study);

#endif
