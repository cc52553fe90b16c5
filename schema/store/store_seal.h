/* Checksums of what is stored: FNV-1a of 64 bits over values with their types and lengths, against
 * damage, not against intent. They detect every change of a single bit. SQL computes them by two
 * functions that every handle has: seal_of(...) of values in their order, seals_of(...) of rows in
 * any order.
 *
 * Readers check those of a case, a result and a published document. rows_seal is that of the rows
 * that people read by the views, and is checked by store_verify alone. */
#ifndef RUGO_SCHEMA_STORE_STORE_SEAL_H
#define RUGO_SCHEMA_STORE_STORE_SEAL_H

#include "schema/store/store_internal.h"

/* Adds the two functions to a handle. */
int seal_functions(struct store *store, struct error *err);

/* The checksum of a row of study_case, under that name or another, joined with study s. */
#define CASE_SEAL_OF(c)                                                                            \
    "seal_of(s.kind, s.seed, s.random, " c ".number, " c ".parameters, " c ".sequence, " c         \
    ".parent, " c ".role)"
#define CASE_SEAL CASE_SEAL_OF("study_case")
/* That of a row of result, joined with its job and scalar_names; block_seal returns the same. */
#define RESULT_SEAL "seal_of(job.first, job.count, scalar_names.names, result.scalars, result.data)"
/* That of a row of published. */
#define PUBLISHED_SEAL                                                                             \
    "seal_of(published.study_id, published.case_number, published.revision, published.document, "  \
    "published.report, published.curves_seal)"
/* That of the curves of case ?2 of study ?1. */
#define CURVES_SEAL                                                                                \
    "(SELECT seals_of(quantity, id) FROM curve WHERE study_id = ?1 AND case_number = ?2)"
/* A last value with that of the other law, and with totals, where there are any, so that rows of
 * older programs keep their checksum. */
#define WITH_LAW(last)                                                                             \
    "iif(law_difference IS NULL, " last ", seal_of(" last ", law_difference, law_standard_error))"
#define WITH_TOTAL(last)                                                                           \
    "iif(total_low IS NULL AND unknown_errors IS NULL, " last ", seal_of(" last                    \
    ", total_low, total_high, unknown_errors))"
#define OF_CURVE "FROM curve c JOIN "
#define OF_CASE " ON r.curve_id = c.id WHERE c.study_id = ?1 AND c.case_number = ?2), "
#define ROWS_SEAL                                                                                  \
    "seal_of((SELECT seals_of(name, value, standard_error, theory, " WITH_TOTAL(WITH_LAW(          \
        "grid_theory")) ") FROM scalar WHERE study_id = ?1 AND case_number = ?2), (SELECT "        \
                        "seals_of(name, source, value, bound, "                                    \
                        "standard_error) FROM scalar_error WHERE study_id = ?1 AND case_number = " \
                        "?2), "                                                                    \
                        "(SELECT seals_of(r.curve_id, r.number, x, x2, y, standard_error, "        \
                        "discretisation_error, "                                                   \
                        "model_error, " WITH_TOTAL(WITH_LAW(                                       \
                            "valueless")) ") " OF_CURVE "point r" OF_CASE                          \
                                          "(SELECT seals_of(r.curve_id, r.number, source, value, " \
                                          "standard_error, bound) " OF_CURVE                       \
                                          "point_error r" OF_CASE                                  \
                                          "(SELECT seals_of(r.curve_id, r.number, y) " OF_CURVE    \
                                          "point_realisations r" OF_CASE                           \
                                          "(SELECT seals_of(id, quantity, series, model, "         \
                                          "kinematics, level, pressure, data) FROM "               \
                                          "curve WHERE study_id = ?1 AND case_number = ?2))"

/* Returns the checksum of a block as it is stored: data and texts as block_text has them. */
int64_t block_seal(const struct block_result *result, const char *names, const char *scalars);
/* Sets the checksums of the cases of a study that have none. */
int cases_seal(struct store *store, int64_t study, struct error *err);

#endif
