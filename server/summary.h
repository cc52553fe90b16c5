/* What people read of a study: tables made from the documents of interface.md. */
#ifndef RUGO_SERVER_SUMMARY_H
#define RUGO_SERVER_SUMMARY_H

#include <cjson/cJSON.h>
#include <stdio.h>

/* One row a case of a curves document: what was swept, the main scalars beside their theory, and
 * where the report is given (it may be NULL) the time that the case took. */
void summary_of_curves(const cJSON *curves, const cJSON *report, FILE *file);
/* Progress of one study, with its failures; of a list of them. */
void summary_of_status(const cJSON *status, FILE *file);
void summary_of_list(const cJSON *studies, FILE *file);
/* Speed against error. */
void summary_of_report(const cJSON *report, FILE *file);
/* "2 h 5 min", "12 s", "-" for NaN. */
void duration_text(double seconds, char *out, size_t size);

#endif
