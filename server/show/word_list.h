/* Lists of words in messages, tables and pictures: "halfspace, layered, 0.8". */
#ifndef RUGO_SERVER_SHOW_WORD_LIST_H
#define RUGO_SERVER_SHOW_WORD_LIST_H

#include <stddef.h>

/* Appends a word to the list in a buffer of this size, behind `between` where it is not the first;
 * "..." where there is no room for it, behind which nothing is appended. */
void word_list_append(char *list, size_t size, const char *between, const char *word);
/* Does so unless the whole word is in the list already, or the word is NULL or "". */
void word_list_add(char *list, size_t size, const char *between, const char *word);

#endif
