#include "schema/program.h"
#include "core/rugo.h"
#include <stdio.h>

__attribute__((weak)) const char PROGRAM_COMMIT[] = "unknown";

void program_write(char text[PROGRAM_SIZE]) {
    snprintf(text, PROGRAM_SIZE, "%s+%.96s", RUGO_VERSION, PROGRAM_COMMIT);
}
