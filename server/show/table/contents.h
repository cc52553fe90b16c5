/* What a study holds, without the numbers: its cases by what was swept, the curves and scalars that
 * there are. A page asks for it once, and then for each curve that it draws. */
#ifndef RUGO_SERVER_SHOW_TABLE_CONTENTS_H
#define RUGO_SERVER_SHOW_TABLE_CONTENTS_H

#include "worker/publish/aggregate.h"
#include <cjson/cJSON.h>

/* {study, name, kind, provenance, cases: [{case, swept: {pointer: value}, realisations}], curves:
 * [{quantity, matrix, series, models, levels, x_label, y_label}], scalars: [names]}, the caller's
 * to delete. Curves and scalars are those of the first case that has any. ERROR_ABSENT for a study
 * that is not known. */
int contents_document(struct store *store, const char *id, cJSON **out, struct error *err);

#endif
