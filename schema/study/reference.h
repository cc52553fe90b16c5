/* The reference of the study file, written from the tables that read it: for a terminal, and as
 * the Markdown that stands in REFERENCE.md. */
#ifndef RUGO_SCHEMA_STUDY_REFERENCE_H
#define RUGO_SCHEMA_STUDY_REFERENCE_H

#include "schema/study/study.h"
#include <stdio.h>

/* Prints every parameter of these kinds: path, type, range, unit, default, meaning, example. path
 * selects one parameter, or those below it ("/surface/heights", also "surface.heights"); NULL
 * selects all. ERROR_INPUT where there is no such path, before anything is written; ERROR_MEMORY.
 * The caller checks the file for write errors. */
int reference_print(FILE *file, const struct study_kind *const *kinds, const char *path,
                    struct error *err);
/* Prints the same of all parameters as Markdown, with an introduction. */
int reference_markdown(FILE *file, const struct study_kind *const *kinds, struct error *err);

#endif
