/* How the program ends; the status that the shell gets. */
#ifndef RUGO_SERVER_COMMAND_EXIT_STATUS_H
#define RUGO_SERVER_COMMAND_EXIT_STATUS_H

enum { EXIT_DONE = 0, EXIT_FAILED = 1, EXIT_USAGE = 2, EXIT_INTERRUPTED = 130 };

#endif
