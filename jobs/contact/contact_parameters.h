/* The parameters of /contact/..., and what their choices stand for where core has no enumeration.
 */
#ifndef RUGO_JOBS_CONTACT_CONTACT_PARAMETERS_H
#define RUGO_JOBS_CONTACT_CONTACT_PARAMETERS_H

#include "schema/study/parameter.h"

enum { CONTACT_LEVELS_MOST = 8, CONTACT_LOADS_MOST = 1000 };

enum height_unit { HEIGHT_RMS_HEIGHTS, HEIGHT_LENGTHS };
enum area_estimator { AREA_NODES, AREA_EDGES, AREA_PERIMETER, AREA_ESTIMATORS };
/* Whether the error of the cell is probed (contact_cell.h). */
enum cell_error { CELL_ERROR_PROBED, CELL_ERROR_NONE };
/* Whether the error of generation is (contact_generation.h). */
enum generation_error { GENERATION_ERROR_PROBED, GENERATION_ERROR_NONE };

enum stiffness_choice { STIFFNESS_MEASURED, STIFFNESS_OMITTED };

extern const struct choice KINEMATICS_CHOICES[]; /* of enum kinematics */
extern const struct parameter_table CONTACT_PARAMETERS;

#endif
