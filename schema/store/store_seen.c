/* Workers that asked for jobs of late. Where few realisations wait, these divide them. */
#include "schema/result/bytes.h"
#include "schema/store/store_internal.h"
#include <string.h>

/* A worker is seen for so long; it is noted again about so often, and all are counted no more often
 * than that, as every claim asks. More of them make no difference, and would cost. */
enum { SEEN_MS = 120000, NOTE_MS = 20000, COUNT_MS = 1000, SEEN_MOST = 20000, THREADS_MOST = 4096 };

static int64_t threads_of(const struct claim *claim) {
    if (claim->threads < 1)
        return 1;
    return claim->threads < THREADS_MOST ? (int64_t)claim->threads : THREADS_MOST;
}

/* Forgets those not seen for long, and counts the others. */
static int count(struct store *store, int64_t now, struct error *err) {
    sqlite3_stmt *row = NULL;
    int status = store_run(store, err, "DELETE FROM seen WHERE at NOT BETWEEN ? AND ?", "ii",
                           now - SEEN_MS, now);
    if (status == 0)
        status = store_query(store, &row, err, "SELECT count(*), total(threads) FROM seen", "");
    if (status == 0)
        status = store_step(store, row, err);
    if (status < 0)
        return status;
    store->workers_seen = sqlite3_column_int64(row, 0);
    store->threads_seen = sqlite3_column_int64(row, 1);
    store->seen_ms = now;
    sqlite3_reset(row);
    return 0;
}

/* Two workers may share a place among those noted here: then the store tells what is noted. */
static int note(struct store *store, const struct claim *claim, int64_t now, struct error *err) {
    int64_t threads = threads_of(claim), last = -1;
    int status = store_integer(store, &last, err,
                               "SELECT at FROM seen WHERE worker = ? AND threads = ? AND at <= ?",
                               "tii", claim->worker, threads, now);
    if (status == ERROR_ABSENT)
        status = 0;
    if (status != 0 || (last >= 0 && now - last < NOTE_MS / 2) ||
        (last < 0 && store->workers_seen >= SEEN_MOST))
        return status;
    store->workers_seen += last < 0;
    store->threads_seen += last < 0 ? threads : 0;
    return store_run(store, err,
                     "INSERT OR REPLACE INTO seen (worker, threads, at) VALUES (?, ?, ?)", "tii",
                     claim->worker, threads, now);
}

/* A worker whose note was rolled back is noted again with the next one that is due. */
static int note_unless_fresh(struct store *store, const struct claim *claim, int64_t now,
                             struct error *err) {
    int64_t threads = threads_of(claim);
    uint64_t worker = hash_bytes(HASH_START, strlen(claim->worker) + 1, claim->worker);
    worker = hash_bytes(worker, sizeof threads, &threads);
    size_t place = worker % NOTED;
    if (store->noted[place].worker == worker && now >= store->noted[place].from_ms &&
        now < store->noted[place].until_ms)
        return 0;
    store->noted[place].worker = worker;
    store->noted[place].from_ms = now;
    store->noted[place].until_ms = now + NOTE_MS;
    return note(store, claim, now, err);
}

int seen_note(struct store *store, const struct claim *claim, int64_t *threads, struct error *err) {
    int64_t now = store_now(store), age = now - store->seen_ms;
    int status = 0;
    if (store->workers_seen == 0 || age < 0 || age >= COUNT_MS)
        status = count(store, now, err);
    if (status == 0 && claim->worker != NULL)
        status = note_unless_fresh(store, claim, now, err);
    *threads = store->threads_seen > 0 ? store->threads_seen : 1;
    return status;
}
