/* What a study would do and what it would cost, before anything runs. */
#ifndef RUGO_SERVER_SHOW_SUMMARY_PLAN_H
#define RUGO_SERVER_SHOW_SUMMARY_PLAN_H

#include "schema/study/study.h"

/* CPU seconds of a case, of all its components; likewise its jobs. */
double plan_case_seconds(const struct study_case *one);
uint64_t plan_case_jobs(const struct study_case *one);
/* Between what a case takes in nine of ten, where a few realisations may take many times what
 * others take; NaN: seconds are as estimated. */
struct plan_range {
    double least, most;
};
struct plan_range plan_case_range(const struct study_case *one);
/* The relative error that is expected, or asked for. */
double plan_case_error(const struct study_case *one);
/* The tolerance of the solver, that of the components where there are any; 0: none. */
double plan_case_tolerance(const struct study_case *one);
/* Bytes of a worker, by the largest of what runs. */
double plan_case_bytes(const struct study_case *one);
/* Those of the whole study. */
double plan_seconds(const struct study *study);
struct plan_range plan_range(const struct study *study);
double plan_bytes(const struct study *study);
/* What the files of nodes of all cases take; path NULL: there are none. */
struct study_kept plan_kept(const struct study *study);

/* The plan as `rugo check --format json` and POST /v1/check answer it, the caller's to delete; NULL
 * when out of memory. */
cJSON *plan_document(const struct study *study);

#endif
