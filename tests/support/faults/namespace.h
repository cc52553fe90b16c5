/* Namespaces of the kernel for a test alone, which vanish with it: as root, or, where the system
 * lets users, with a user namespace around them. */
#ifndef RUGO_TESTS_SUPPORT_FAULTS_NAMESPACE_H
#define RUGO_TESTS_SUPPORT_FAULTS_NAMESPACE_H

#include <stdbool.h>

/* Moves this process into new namespaces, flags as of unshare(2); false where that is not
 * permitted. */
bool namespace_enter(int flags);
/* Runs a line of shell, quietly; whether it succeeded. */
bool shell_quietly(const char *format, ...) __attribute__((format(printf, 1, 2)));

#endif
