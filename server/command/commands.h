/* Commands by their names, and help from the tables of commands and options. */
#ifndef RUGO_SERVER_COMMAND_COMMANDS_H
#define RUGO_SERVER_COMMAND_COMMANDS_H

#include "server/command/command.h"
#include <stdio.h>

void help_commands(FILE *file);
void help_command(const struct command *command, FILE *file);
/* Returns NULL where there is none of this name. */
const struct command *command_find(const char *name);
/* The command that a word names, or with the next one (or NULL) two; *taken is how many. */
const struct command *command_find_words(const char *first, const char *second, int *taken);
/* Returns the name of the command nearest to what was typed, or which does what programs elsewhere
 * call so; NULL where none is near. */
const char *command_near(const char *typed);

#endif
