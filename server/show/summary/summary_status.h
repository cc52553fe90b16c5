/* Tables of where studies stand, from the documents of GET /v1/studies and GET /v1/studies/{id}. */
#ifndef RUGO_SERVER_SHOW_SUMMARY_SUMMARY_STATUS_H
#define RUGO_SERVER_SHOW_SUMMARY_SUMMARY_STATUS_H

#include <cjson/cJSON.h>
#include <stdbool.h>
#include <stdio.h>

/* These print the progress of one study with its failures, and of a list of studies. */
void summary_of_status(const cJSON *status, FILE *file);
void summary_of_list(const cJSON *studies, FILE *file);
/* Whether a study has ended without a single value in any of its cases. */
bool status_has_no_value(const cJSON *status);

#endif
