#include "schema/store/store_seal.h"
#include "schema/result/bytes/bytes.h"
#include <string.h>

static uint64_t add_word(uint64_t hash, char type, uint64_t word) {
    unsigned char bytes[9] = {(unsigned char)type};
    for (int a = 0; a < 8; a++)
        bytes[1 + a] = (unsigned char)(word >> (8 * a));
    return hash_bytes(hash, sizeof bytes, bytes);
}

static uint64_t add_bytes(uint64_t hash, char type, size_t size, const void *data) {
    return hash_bytes(add_word(hash, type, size), size, data);
}

/* Whether SQLite had no memory for the text or the bytes of a value. */
static bool is_lost(sqlite3_value *value) {
    switch (sqlite3_value_type(value)) {
    case SQLITE_TEXT:
        return sqlite3_value_text(value) == NULL;
    case SQLITE_BLOB:
        return sqlite3_value_blob(value) == NULL && sqlite3_value_bytes(value) > 0;
    default:
        return false;
    }
}

static uint64_t add_value(uint64_t hash, sqlite3_value *value) {
    double number;
    uint64_t bits;
    switch (sqlite3_value_type(value)) {
    case SQLITE_INTEGER:
        return add_word(hash, 'i', (uint64_t)sqlite3_value_int64(value));
    case SQLITE_FLOAT:
        number = sqlite3_value_double(value);
        memcpy(&bits, &number, sizeof bits);
        return add_word(hash, 'd', bits);
    case SQLITE_TEXT:
        return add_bytes(hash, 't', (size_t)sqlite3_value_bytes(value), sqlite3_value_text(value));
    case SQLITE_BLOB:
        return add_bytes(hash, 'b', (size_t)sqlite3_value_bytes(value), sqlite3_value_blob(value));
    default:
        return add_word(hash, 'n', 0);
    }
}

/* Hashes the values of a row. False where memory is short; the statement then fails. */
static bool hash_values(sqlite3_context *context, int count, sqlite3_value **values,
                        uint64_t *out) {
    uint64_t hash = HASH_START;
    for (int a = 0; a < count; a++) {
        if (is_lost(values[a])) {
            sqlite3_result_error_nomem(context);
            return false;
        }
        hash = add_value(hash, values[a]);
    }
    *out = hash;
    return true;
}

static void seal_of(sqlite3_context *context, int count, sqlite3_value **values) {
    uint64_t hash;
    if (hash_values(context, count, values, &hash))
        sqlite3_result_int64(context, (int64_t)hash);
}

/* The sum of the hashes of rows, which does not depend on their order. */
struct row_sum {
    uint64_t hash;
};

static void add_row(sqlite3_context *context, int count, sqlite3_value **values) {
    struct row_sum *sum = sqlite3_aggregate_context(context, sizeof *sum);
    uint64_t hash;
    if (sum == NULL)
        sqlite3_result_error_nomem(context);
    else if (hash_values(context, count, values, &hash))
        sum->hash += hash;
}

static void sum_rows(sqlite3_context *context) {
    const struct row_sum *sum = sqlite3_aggregate_context(context, 0);
    sqlite3_result_int64(context, sum != NULL ? (int64_t)sum->hash : 0);
}

int seal_functions(struct store *store, struct error *err) {
    const int how = SQLITE_UTF8 | SQLITE_DETERMINISTIC | SQLITE_DIRECTONLY;
    int code = sqlite3_create_function(store->db, "seal_of", -1, how, NULL, seal_of, NULL, NULL);
    if (code == SQLITE_OK)
        code =
            sqlite3_create_function(store->db, "seals_of", -1, how, NULL, NULL, add_row, sum_rows);
    return code == SQLITE_OK ? 0 : store_error(store, err);
}

int64_t block_seal(const struct block_result *result, const char *names, const char *scalars) {
    uint64_t hash = add_word(HASH_START, 'i', result->first);
    hash = add_word(hash, 'i', result->count);
    hash = add_bytes(hash, 't', strlen(names), names);
    hash = add_bytes(hash, 't', strlen(scalars), scalars);
    return (int64_t)add_bytes(hash, 'b', result->size, result->data);
}

int cases_seal(struct store *store, int64_t study, struct error *err) {
    return store_run(store, err,
                     "UPDATE study_case SET seal = " CASE_SEAL
                     " FROM study s WHERE s.id = study_id AND study_id = ? AND seal IS NULL",
                     "i", study);
}
