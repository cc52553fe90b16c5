/* Whole studies, drawn from the tables of parameters that also read them and write their schema: a
 * new row is drawn by itself. */
#ifndef RUGO_TESTS_SUPPORT_FUZZ_DRAW_STUDY_H
#define RUGO_TESTS_SUPPORT_FUZZ_DRAW_STUDY_H

#include "schema/study/study.h"
#include "tests/support/fuzz/choices.h"

/* Draws the document of a study of one of the kinds: a small one that is whole, with leaves and
 * groups of leaves of the tables put into it. Of about half of the documents all that is put in is
 * plausible; in the others a value may be at or beyond its bounds, of a wrong type, a list of one
 * or many, or there twice, and names may be unknown. The caller frees. */
char *draw_study(struct choices *choices, const struct study_kind *const *kinds);

#endif
