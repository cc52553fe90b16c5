#include "jobs/contact/model/model.h"

/* The models of librugo; a model of studies alone is an entry behind them. */
CONTACT_MODEL_TABLES(RUGO_MODELS)
