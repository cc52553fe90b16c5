/* The error of the cell, from surfaces of other lengths (contact_cell.h). */
#ifndef RUGO_JOBS_CONTACT_CONTACT_CELL_ERRORS_H
#define RUGO_JOBS_CONTACT_CONTACT_CELL_ERRORS_H

#include "jobs/contact/contact_error.h"
#include "jobs/contact/contact_tally.h"

/* Of a measure of a model at every load, as contact_errors tells them; FORMULAS.md, F15.7. */
bool contact_cell_errors(const struct contact_tally *tally, enum contact_measure measure,
                         size_t model, struct contact_error *out);

#endif
