/* The version and commit of this program, with which results are marked. */
#ifndef RUGO_SCHEMA_PROGRAM_H
#define RUGO_SCHEMA_PROGRAM_H

/* The commit that the program was built from, with "-dirty" behind it where the tree had changes,
 * or "unknown". The build links it; a program linked without it has "unknown". */
extern const char PROGRAM_COMMIT[];

enum { PROGRAM_SIZE = 128 };
/* Writes "0.1.0+COMMIT": the version and, as build metadata of Semantic Versioning, the commit. */
void program_write(char text[PROGRAM_SIZE]);

#endif
