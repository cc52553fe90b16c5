/* Where claims wait for jobs (Prefer: wait=N). Safe from many threads.
 *
 * A thread of its own asks the store, on a handle of its own, whether a job waits: after each
 * commit that changed something, and each second, as leases run out and others write to the file.
 * It wakes a few of those that wait, who came first: their claims change the store, so that it asks
 * again and wakes the next ones while jobs are left. So a new job costs a few claims, however many
 * wait for it. */
#ifndef RUGO_SERVER_HTTP_WAITING_ROOM_H
#define RUGO_SERVER_HTTP_WAITING_ROOM_H

#include "core/error.h"
#include <stdbool.h>
#include <stdint.h>

struct waiting_room;
int waiting_room_create(struct waiting_room **out, const char *database, struct error *err);
/* Accepts NULL; nobody may wait any more. */
void waiting_room_destroy(struct waiting_room **room);
/* Notifies those who wait that the store has changed. */
void waiting_room_wake(struct waiting_room *room);
/* Lets all go, and nobody wait any more. */
void waiting_room_end(struct waiting_room *room);
/* Returns true once a job may be there for the caller, who comes back where there was none for it;
 * false at until_ms (clock_ms), when the peer of the socket has gone, or at the end. *seen
 * remembers, between calls of one request, what the caller came for; 0 at first. */
bool waiting_room_wait(struct waiting_room *room, int socket, int64_t until_ms, uint64_t *seen);

#endif
