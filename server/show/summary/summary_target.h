/* Prints an error that was asked for: what was reached, and of what it is made. */
#ifndef RUGO_SERVER_SHOW_SUMMARY_SUMMARY_TARGET_H
#define RUGO_SERVER_SHOW_SUMMARY_SUMMARY_TARGET_H

#include "schema/result/result.h"
#include "schema/study/study.h"
#include <stdio.h>

/* Prints nothing for a case that asked for none. */
void summary_of_target(const struct case_result *one, FILE *file);
/* Prints the components of a case with what they are expected to take; nothing without. */
void summary_of_plan(const struct study_case *one, FILE *file);

#endif
