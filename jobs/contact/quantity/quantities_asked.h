/* Which quantities a case asks for (quantity.h). */
#ifndef RUGO_JOBS_CONTACT_QUANTITY_QUANTITIES_ASKED_H
#define RUGO_JOBS_CONTACT_QUANTITY_QUANTITIES_ASKED_H

#include <stdbool.h>
#include <stddef.h>

enum { CONTACT_QUANTITIES_MOST = 10 };

struct quantities_asked {
    bool of[CONTACT_QUANTITIES_MOST]; /* in the order of the table */
    size_t measures; /* numbers of measures up to the last of these: 0 where none is asked for */
};

#endif
