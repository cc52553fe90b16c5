/* Lists of faults in what a user wrote. */
#ifndef RUGO_SCHEMA_STUDY_FAULT_H
#define RUGO_SCHEMA_STUDY_FAULT_H

#include <stddef.h>

/* A growing list of the faults of one input, each with the JSON pointer of the value at fault.
 * Initialise with {0}; it owns its strings. All faults are counted, and the first FAULTS_KEPT are
 * kept. */
enum { FAULTS_KEPT = 100 };
struct fault {
    char *pointer; /* RFC 6901; "" is the whole document */
    char *detail;  /* what is wrong and what is allowed */
};
struct fault_list {
    struct fault *faults; /* count entries, or FAULTS_KEPT if fewer; NULL: no memory for them */
    size_t count;
};
/* Adds a fault. When out of memory the fault is counted, and its texts are empty, or there is no
 * list. */
__attribute__((format(printf, 3, 4))) void fault_add(struct fault_list *list, const char *pointer,
                                                     const char *format, ...);
void fault_list_clear(struct fault_list *list);

#endif
