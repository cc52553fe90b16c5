/* Studies by what people call them: an id, its first digits, or a name. */
#include "schema/store/store_internal.h"
#include <stdio.h>
#include <string.h>

enum { CANDIDATES_SHOWN = 5 };

/* The studies whose name or first digits were given, newest first. */
static int query_candidates(struct store *store, const char *given, sqlite3_stmt **row,
                            struct error *err) {
    return store_query(store, row, err,
                       "SELECT public, name, state, created FROM study WHERE (name = ?1 OR "
                       "substr(public, 1, length(?1)) = ?1) AND id NOT IN " DELETED_STUDIES
                       " ORDER BY id DESC",
                       "t", given);
}

/* Appends "ID (name, state, since)". */
static size_t append_candidate(char *text, size_t size, size_t used, sqlite3_stmt *row) {
    int length = snprintf(
        text + used, size - used, "%s%s (%.24s, %s, %s)", used > 0 ? ", " : "",
        (const char *)sqlite3_column_text(row, 0), (const char *)sqlite3_column_text(row, 1),
        (const char *)sqlite3_column_text(row, 2), (const char *)sqlite3_column_text(row, 3));
    return used + (length > 0 ? (size_t)length : 0);
}

/* Reads all that fit: the newest goes into id, and into the list beside the next few. */
static int read_candidates(struct store *store, const char *given, char id[STUDY_ID_SIZE],
                           struct error *err) {
    sqlite3_stmt *row = NULL;
    char list[110 * CANDIDATES_SHOWN] = "", more[32] = "";
    size_t used = 0, count = 0;
    int status = query_candidates(store, given, &row, err);
    if (status != 0)
        return status;
    for (; (status = store_step(store, row, err)) == 1; count++) {
        if (count == 0)
            snprintf(id, STUDY_ID_SIZE, "%s", (const char *)sqlite3_column_text(row, 0));
        if (count < CANDIDATES_SHOWN)
            used = append_candidate(list, sizeof list, used, row);
    }
    if (status != 0 || count == 1)
        return status;
    if (count == 0)
        return error_set(err, ERROR_ABSENT,
                         "there is no study \"%.40s\"; rugo status lists those there are", given);
    if (count > CANDIDATES_SHOWN)
        snprintf(more, sizeof more, " and %zu more", count - CANDIDATES_SHOWN);
    return error_set(err, ERROR_INPUT, "\"%.40s\" may be each of %zu studies; name its id: %s%s",
                     given, count, list, more);
}

int store_find(struct store *store, const char *given, char id[STUDY_ID_SIZE], struct error *err) {
    int64_t row;
    struct error absent = {0};
    if (*given == '\0')
        return error_set(err, ERROR_INPUT, "a study has an id and a name, and neither is empty");
    int status =
        strlen(given) < STUDY_ID_SIZE ? study_row(store, given, &row, &absent) : ERROR_ABSENT;
    if (status == 0)
        snprintf(id, STUDY_ID_SIZE, "%s", given);
    if (status != 0 && status != ERROR_ABSENT)
        *err = absent;
    return status == ERROR_ABSENT ? read_candidates(store, given, id, err) : status;
}
