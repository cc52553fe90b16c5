/* What people read of a study: tables made from the documents of interface.md. */
#ifndef RUGO_SERVER_SHOW_SUMMARY_H
#define RUGO_SERVER_SHOW_SUMMARY_H

#include <cjson/cJSON.h>
#include <stdio.h>

/* A curves document: one row a case, with what was swept, the main scalars beside their theory,
 * and, where the report is given (it may be NULL), the time that the case took. Contact has tables
 * of its own. */
void summary_of_curves(const cJSON *curves, const cJSON *report, FILE *file);
/* The cases of a contact study: for a few, a table each of the contact area at up to ten loads, by
 * model, with its statistical error and those of mesh and model in percent of it, and the theories;
 * for many, a row each with the area at three loads. costs: the cases of the report, or NULL. */
void summary_of_contact(const cJSON *cases, const cJSON *costs, FILE *file);
/* Progress of one study, with its failures; of a list of them. */
void summary_of_status(const cJSON *status, FILE *file);
void summary_of_list(const cJSON *studies, FILE *file);
/* Speed against error: a row a case, and, where there are models and levels, what each of them and
 * each estimator cost and err: by case for a few cases, over all of them for many. */
void summary_of_report(const cJSON *report, FILE *file);
/* "2 h 5 min", "12 s", "-" for NaN. */
void duration_text(double seconds, char *out, size_t size);

#endif
