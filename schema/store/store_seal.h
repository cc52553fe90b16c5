/* Checksums of what is stored: FNV-1a of 64 bits over values with their types and lengths, against
 * damage, not against intent. A single changed bit always shows. SQL computes them by two functions
 * that every handle has: seal_of(...) of values in their order, seals_of(...) of rows in any order.
 *
 * Checked on reading: those of a case, a result, a published document. rows_seal is of the rows
 * that people read by the views, and checked by store_verify alone. */
#ifndef RUGO_SCHEMA_STORE_STORE_SEAL_H
#define RUGO_SCHEMA_STORE_STORE_SEAL_H

#include "schema/store/store_internal.h"

/* Gives a handle the two functions. */
int seal_functions(struct store *store, struct error *err);

/* Of a row of study_case, under that name or another, joined with study s. */
#define CASE_SEAL_OF(c)                                                                            \
    "seal_of(s.kind, s.seed, s.random, " c ".number, " c ".parameters, " c ".sequence, " c         \
    ".parent, " c ".role)"
#define CASE_SEAL CASE_SEAL_OF("study_case")
/* Of a row of result joined with its job and scalar_names; block_seal gives the same. */
#define RESULT_SEAL "seal_of(job.first, job.count, scalar_names.names, result.scalars, result.data)"
/* Of a row of published. */
#define PUBLISHED_SEAL                                                                             \
    "seal_of(published.study_id, published.case_number, published.revision, published.document, "  \
    "published.report, published.curves_seal)"
/* Of case ?2 of study ?1. */
#define CURVES_SEAL                                                                                \
    "(SELECT seals_of(quantity, id) FROM curve WHERE study_id = ?1 AND case_number = ?2)"
#define OF_CURVE "FROM curve c JOIN "
#define OF_CASE " ON r.curve_id = c.id WHERE c.study_id = ?1 AND c.case_number = ?2), "
#define ROWS_SEAL                                                                                  \
    "seal_of((SELECT seals_of(name, value, standard_error, theory, grid_theory) FROM scalar "      \
    "WHERE study_id = ?1 AND case_number = ?2), (SELECT seals_of(name, source, value, bound, "     \
    "standard_error) FROM scalar_error WHERE study_id = ?1 AND case_number = ?2), "                \
    "(SELECT seals_of(r.curve_id, r.number, x, x2, y, standard_error, discretisation_error, "      \
    "model_error, valueless) " OF_CURVE "point r" OF_CASE                                          \
    "(SELECT seals_of(r.curve_id, r.number, source, value, standard_error, bound) " OF_CURVE       \
    "point_error r" OF_CASE "(SELECT seals_of(r.curve_id, r.number, y) " OF_CURVE                  \
    "point_realisations r" OF_CASE                                                                 \
    "(SELECT seals_of(id, quantity, series, model, kinematics, level, pressure, data) FROM "       \
    "curve WHERE study_id = ?1 AND case_number = ?2))"

/* The seal of a block as it is stored; texts as block_text has them. */
int64_t block_seal(const struct block_result *result, const char *names, const char *scalars);
/* Seals the cases of a study that have no seal yet. */
int cases_seal(struct store *store, int64_t study, struct error *err);

#endif
