/* Help, the man page and the completion of shells, all from the tables of commands and options. */
#ifndef RUGO_SERVER_COMMAND_HELP_H
#define RUGO_SERVER_COMMAND_HELP_H

#include "server/command/command.h"
#include <stdio.h>

void help_commands(FILE *file);
void help_command(const struct command *command, FILE *file);
void help_man(FILE *file);  /* rugo(1), as roff */
void help_bash(FILE *file); /* completion for bash */
/* Writes "-o, --output FILE". */
void help_option_name(const struct option_row *row, char *text, size_t size);
/* Writes what an option does, with its default. */
void help_option_text(const struct option_row *row, char *text, size_t size);
/* Returns NULL where there is none of this name. */
const struct command *command_find(const char *name);
/* The command that a word names, or with the next one (or NULL) two; *taken is how many. */
const struct command *command_find_words(const char *first, const char *second, int *taken);
/* Returns the name of the command nearest to what was typed; NULL where none is near. */
const char *command_near(const char *typed);

#endif
