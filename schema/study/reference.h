/* The reference of the study file, written from the tables that read it: for a terminal, and as
 * the Markdown that stands in REFERENCE.md. */
#ifndef RUGO_SCHEMA_STUDY_REFERENCE_H
#define RUGO_SCHEMA_STUDY_REFERENCE_H

#include "schema/study/study.h"
#include <stdio.h>

/* Every parameter of these kinds: path, type, range, unit, default, meaning, example. path narrows
 * it to one parameter or to those below one ("/surface/heights", also "surface.heights"); NULL for
 * all. ERROR_INPUT where there is no such path, and nothing is written then; ERROR_MEMORY. Whether
 * the text arrived is for the caller to ask of the file. */
int reference_print(FILE *file, const struct study_kind *const *kinds, const char *path,
                    struct error *err);
/* Prints the same of all parameters as Markdown, with an introduction. */
int reference_markdown(FILE *file, const struct study_kind *const *kinds, struct error *err);

#endif
