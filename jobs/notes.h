/* Notes of a kind on single realisations, such as why one has no values. The first NOTES_MOST of a
 * case are kept, in the order of realisations, and all are counted. The same notes are kept
 * whatever the blocks and the order of merging. */
#ifndef RUGO_JOBS_NOTES_H
#define RUGO_JOBS_NOTES_H

#include "core/error.h"
#include "schema/result/bytes/bytes.h"
#include "schema/result/result.h"

enum { NOTES_MOST = 20, NOTE_SIZE = sizeof((struct error *)0)->text };
struct note {
    uint64_t realisation;
    char text[NOTE_SIZE]; /* printable ASCII */
};
struct notes { /* initialise with {0} */
    uint64_t count;
    struct note kept[NOTES_MOST]; /* the first notes_kept, in the order of realisations */
};
static inline size_t notes_kept(const struct notes *notes) {
    return notes->count < NOTES_MOST ? (size_t)notes->count : NOTES_MOST;
}

/* realisation: that of the last note or a later one. Characters that are not printable ASCII are
 * replaced. */
void notes_add(struct notes *notes, uint64_t realisation, const char *text);
/* Merges the notes of other realisations. */
void notes_merge(struct notes *into, const struct notes *from);

void notes_put(struct bytes *bytes, const struct notes *notes);
/* Fails the reader for bytes that notes_put does not make. */
void notes_get(struct byte_reader *reader, struct notes *notes);
/* Copies them into the result. */
int notes_result(const struct notes *notes, struct case_result *out, struct error *err);

#endif
