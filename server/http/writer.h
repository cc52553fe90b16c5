/* The one writer of a served store: requests post a change and wait until it is on disk.
 *
 * The thread takes all changes that wait and commits them together (group commit), each still all
 * or nothing. A change is not acknowledged before its commit; when the commit fails every change in
 * it failed. */
#ifndef RUGO_SERVER_HTTP_WRITER_H
#define RUGO_SERVER_HTTP_WRITER_H

#include "schema/store/store.h"

typedef int store_change(struct store *store, void *context, struct error *err);
struct writer;

/* Borrows the store until writer_destroy, which finishes what was posted. */
int writer_create(struct writer **out, struct store *store, struct error *err);
void writer_destroy(struct writer **writer);
/* After each commit that leaves a case due for publication, due(context) is called on the writer's
 * thread. Set it before the first change is posted. */
void writer_on_due(struct writer *writer, void (*due)(void *context), void *context);
/* After each commit that changed anything, changed(context) is called likewise. */
void writer_on_change(struct writer *writer, void (*changed)(void *context), void *context);
/* Runs change on the writer's thread; returns its status once committed, or the commit's error. */
int writer_do(struct writer *writer, store_change *change, void *context, struct error *err);

struct writer_figures {
    uint64_t changes, commits; /* since the start */
};
void writer_figures(struct writer *writer, struct writer_figures *out);

/* Whether it gets on. After a commit that failed the writer tries again by itself, until one is
 * done. */
struct writer_state {
    int64_t busy_ms;      /* that it has been at what it does now; 0: at nothing */
    struct error failure; /* of the last commit; code 0: it was done */
};
void writer_state(struct writer *writer, struct writer_state *out);

#endif
