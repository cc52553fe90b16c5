/* Lists of faults found in what a user wrote, each with the place it belongs to. */
#ifndef RUGO_SCHEMA_STUDY_FAULT_H
#define RUGO_SCHEMA_STUDY_FAULT_H

#include <stddef.h>

/* A growing list of faults in one input, each with the JSON pointer it belongs to. Initialise
 * with {0}; owns its strings. At most FAULTS_KEPT are kept, all are counted. */
enum { FAULTS_KEPT = 100 };
struct fault {
    char *pointer; /* RFC 6901; "" is the whole document */
    char *detail;  /* what is wrong and what is allowed */
};
struct fault_list {
    struct fault *faults; /* count entries, or FAULTS_KEPT if fewer; NULL: no memory for them */
    size_t count;
};
/* Adds a fault; out of memory only counts it, or leaves its texts empty. */
__attribute__((format(printf, 3, 4))) void fault_add(struct fault_list *list, const char *pointer,
                                                     const char *format, ...);
void fault_list_clear(struct fault_list *list);

#endif
