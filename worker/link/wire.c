#include "worker/link/wire.h"
#include "schema/json/field.h"
#include "schema/program.h"
#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* U+0080 to U+009F are control characters of two bytes. */
bool worker_name_is_plain(const char *name) {
    for (const unsigned char *at = (const unsigned char *)name; *at != 0; at++)
        if (*at < ' ' || *at == 0x7f || (*at == 0xc2 && at[1] >= 0x80 && at[1] < 0xa0))
            return false;
    return true;
}

static cJSON *texts(const char *const *strings) {
    cJSON *array = cJSON_CreateArray();
    bool complete = array != NULL;
    for (size_t n = 0; complete && strings[n] != NULL; n++)
        complete = list_put(array, cJSON_CreateString(strings[n]));
    return fields_finish(array, complete);
}

static int read_seed(const cJSON *object, uint64_t *out, struct error *err) {
    const char *text = cJSON_GetStringValue(field_at(object, "seed"));
    bool digits = text != NULL && *text != '\0' && strspn(text, "0123456789") == strlen(text);
    errno = 0;
    unsigned long long seed = digits ? strtoull(text, NULL, 10) : 0;
    if (!digits || errno != 0)
        return field_fault(field_at(object, "seed"), "seed", "a decimal string of at most 2^64 - 1",
                           err);
    *out = seed;
    return 0;
}

/* --- claim --- */

/* Returns the forms in which this program makes the results of these kinds. */
static cJSON *forms(const char *const *kinds) {
    cJSON *value = cJSON_CreateObject();
    bool complete = value != NULL;
    for (size_t n = 0; complete && kinds[n] != NULL; n++) {
        const struct job_kind *kind = kind_find(kinds[n]);
        complete = kind == NULL || field_put_count(value, kinds[n], kind->format_version);
    }
    return fields_finish(value, complete);
}

cJSON *wire_claim(const struct claim *claim) {
    cJSON *value = cJSON_CreateObject();
    return fields_finish(
        value,
        value != NULL && field_put_text(value, "worker", claim->worker) &&
            field_put_text(value, "host", claim->host != NULL ? claim->host : "") &&
            (claim->program == NULL || field_put_text(value, "program", claim->program)) &&
            (claim->kinds == NULL || (field_put(value, "kinds", texts(claim->kinds)) &&
                                      field_put(value, "forms", forms(claim->kinds)))) &&
            field_put_count(value, "count", claim->count) &&
            (claim->seconds <= 0 || field_put(value, "seconds", json_number(claim->seconds))) &&
            (claim->threads == 0 || field_put_count(value, "threads", claim->threads)) &&
            field_put(value, "sequence", cJSON_CreateBool(!claim->independent_only)));
}

/* Takes each kind once, however often it is named. */
static int read_kinds(const cJSON *kinds, const char **out, struct error *err) {
    if (!cJSON_IsArray(kinds) || cJSON_GetArraySize(kinds) > WIRE_KINDS_MOST)
        return field_fault(kinds, "kinds", "an array of at most 32 names", err);
    size_t count = 0;
    const cJSON *kind;
    cJSON_ArrayForEach(kind, kinds) {
        if (!cJSON_IsString(kind))
            return field_fault(kinds, "kinds", "an array of at most 32 names", err);
        size_t same = 0;
        while (same < count && strcmp(out[same], kind->valuestring) != 0)
            same++;
        out[same] = kind->valuestring;
        count += same == count;
    }
    out[count] = NULL;
    return 0;
}

/* Takes kinds out of which the worker makes results in another form than this program. */
static int read_forms(const cJSON *forms, const char **kinds, char *others, struct error *err) {
    static const char WHAT[] = "an object of whole numbers by kinds";
    if (!cJSON_IsObject(forms))
        return field_fault(forms, "forms", WHAT, err);
    size_t kept = 0, used = 0;
    for (size_t n = 0; kinds[n] != NULL; n++) {
        const struct job_kind *kind = kind_find(kinds[n]);
        uint64_t form = 0;
        bool named = kind != NULL && field_at(forms, kinds[n]) != NULL;
        if (named && field_count(forms, kinds[n], &form, err) != 0)
            return field_fault(forms, "forms", WHAT, err);
        if (!named || form == kind->format_version)
            kinds[kept++] = kinds[n];
        else if (used < WIRE_FORMS_SIZE)
            used += (size_t)snprintf(others + used, WIRE_FORMS_SIZE - used, "%s%s",
                                     used > 0 ? ", " : "", kinds[n]);
    }
    kinds[kept] = NULL;
    return 0;
}

/* "" where it is absent. */
static int read_host(const cJSON *host, const char **out, struct error *err) {
    enum { HOST_MOST = 255 };
    const char *name = host != NULL ? cJSON_GetStringValue(host) : "";
    if (name == NULL || strlen(name) > HOST_MOST)
        return field_fault(host, "host", "a string of at most 255 bytes", err);
    if (!worker_name_is_plain(name))
        return field_fault(host, "host", "a text without control characters", err);
    *out = name;
    return 0;
}

int wire_claim_read(const cJSON *value, struct wire_claim *out, struct error *err) {
    if (!cJSON_IsObject(value))
        return error_set(err, ERROR_INPUT, "a claim must be an object");
    struct claim claim = {0};
    const char *kinds[WIRE_KINDS_MOST + 1] = {NULL};
    char other_forms[WIRE_FORMS_SIZE] = "";
    uint64_t count = 1, threads = 0;
    bool sequence = false;
    int status = field_text(value, "worker", 256, &claim.worker, err);
    if (status == 0 && !worker_name_is_plain(claim.worker))
        status = field_fault(field_at(value, "worker"), "worker",
                             "a text without control characters", err);
    if (status == 0)
        status = read_host(field_at(value, "host"), &claim.host, err);
    if (status == 0 && field_at(value, "program") != NULL)
        status = field_text(value, "program", PROGRAM_SIZE, &claim.program, err);
    if (status == 0 && claim.program != NULL && !worker_name_is_plain(claim.program))
        status = field_fault(field_at(value, "program"), "program",
                             "a text without control characters", err);
    if (status == 0 && field_at(value, "kinds") != NULL)
        status = read_kinds(field_at(value, "kinds"), kinds, err);
    if (status == 0 && field_at(value, "forms") != NULL)
        status = read_forms(field_at(value, "forms"), kinds, other_forms, err);
    if (status == 0 && field_at(value, "count") != NULL)
        status = field_count(value, "count", &count, err);
    if (status == 0 && field_at(value, "seconds") != NULL)
        status = field_seconds(value, "seconds", &claim.seconds, err);
    if (status == 0 && field_at(value, "threads") != NULL)
        status = field_count(value, "threads", &threads, err);
    if (status == 0)
        status = field_bool(value, "sequence", &sequence, err);
    if (status != 0)
        return status;
    claim.independent_only = !sequence;
    claim.threads = threads < UINT_MAX ? (unsigned)threads : UINT_MAX;
    claim.count = count < WIRE_JOBS_MOST ? (size_t)count : WIRE_JOBS_MOST;
    memcpy(out->kinds, kinds, sizeof kinds);
    memcpy(out->other_forms, other_forms, sizeof other_forms);
    claim.kinds = field_at(value, "kinds") != NULL ? out->kinds : NULL;
    out->claim = claim;
    return 0;
}

/* --- jobs --- */

static cJSON *wire_job(const struct claimed_job *job) {
    cJSON *value = cJSON_CreateObject();
    char seed[24];
    snprintf(seed, sizeof seed, "%llu", (unsigned long long)job->seed);
    bool complete =
        value != NULL && field_put(value, "id", cJSON_CreateNumber((double)job->id)) &&
        field_put_text(value, "study", job->study) && field_put_text(value, "kind", job->kind) &&
        field_put_count(value, "case", job->case_number) && field_put_text(value, "seed", seed) &&
        field_put_count(value, "sequence", job->sequence) &&
        field_put_count(value, "first", job->first) &&
        field_put_count(value, "count", job->count) &&
        field_put_count(value, "attempt", job->attempt) &&
        field_put_text(value, "token", job->token) &&
        field_put(value, "lease_seconds", cJSON_CreateNumber((double)job->lease_ms / 1000.0)) &&
        field_put(value, "parameters", cJSON_CreateObjectReference(job->parameters->child));
    return fields_finish(value, complete);
}

cJSON *wire_jobs(const struct claimed_job *jobs, size_t count) {
    cJSON *value = cJSON_CreateObject(), *array = cJSON_CreateArray();
    bool complete = field_put(value, "jobs", array); /* takes the array also on failure */
    for (size_t n = 0; complete && n < count; n++)
        complete = list_put(array, wire_job(&jobs[n]));
    return fields_finish(value, complete);
}

static int read_numbers(const cJSON *value, struct claimed_job *job, struct error *err) {
    uint64_t id = 0;
    double lease = 0;
    int status = field_count(value, "id", &id, err);
    job->id = (int64_t)id;
    status = status != 0 ? status : field_count(value, "case", &job->case_number, err);
    status = status != 0 ? status : read_seed(value, &job->seed, err);
    job->sequence = job->case_number;
    if (status == 0 && field_at(value, "sequence") != NULL)
        status = field_count(value, "sequence", &job->sequence, err);
    status = status != 0 ? status : field_count(value, "first", &job->first, err);
    status = status != 0 ? status : field_count(value, "count", &job->count, err);
    status = status != 0 ? status : field_count(value, "attempt", &job->attempt, err);
    status = status != 0 ? status : field_seconds(value, "lease_seconds", &lease, err);
    job->lease_ms = lease > 1e9 ? 1000000000000 : llround(lease * 1000.0);
    if (status == 0 && job->count == 0)
        status = field_fault(field_at(value, "count"), "count", "at least 1", err);
    return status;
}

static int wire_job_read(cJSON *value, struct claimed_job *out, struct error *err) {
    struct claimed_job job = {0};
    const char *kind = "";
    int status = read_numbers(value, &job, err);
    status = status != 0 ? status : field_copy(value, "study", STUDY_ID_SIZE, job.study, err);
    status = status != 0 ? status : field_copy(value, "token", TOKEN_SIZE, job.token, err);
    status = status != 0 ? status : field_text(value, "kind", 64, &kind, err);
    if (status == 0 && !cJSON_IsObject(field_at(value, "parameters")))
        status = field_fault(field_at(value, "parameters"), "parameters", "an object", err);
    if (status != 0)
        return status;
    job.kind = strdup(kind);
    if (job.kind == NULL)
        return error_set(err, ERROR_MEMORY, "no memory left to read a job");
    job.parameters = cJSON_DetachItemFromObjectCaseSensitive(value, "parameters");
    *out = job;
    return 0;
}

int wire_jobs_read(cJSON *value, struct claimed_job *jobs, size_t most, size_t *count,
                   struct error *err) {
    const cJSON *array = field_at(value, "jobs");
    cJSON *item;
    if (!cJSON_IsArray(array) || (size_t)cJSON_GetArraySize(array) > most) {
        char what[48];
        snprintf(what, sizeof what, "an array of at most %zu", most);
        return field_fault(array, "jobs", what, err);
    }
    size_t n = 0;
    int status = 0;
    cJSON_ArrayForEach(item, array) {
        status = wire_job_read(item, &jobs[n], err);
        if (status != 0)
            break;
        n++;
    }
    if (status != 0) {
        while (n > 0)
            claimed_job_clear(&jobs[--n]);
        return status;
    }
    *count = n;
    return 0;
}

/* --- results --- */

static cJSON *names_of(const struct block_result *result) {
    return cJSON_CreateStringArray(result->names, (int)result->scalar_count);
}

static cJSON *scalar_rows(const struct block_result *result) {
    cJSON *rows = cJSON_CreateArray();
    bool complete = rows != NULL;
    for (uint64_t r = 0; complete && r < result->count; r++)
        complete = list_put(
            rows, json_numbers(result->scalars + r * result->scalar_count, result->scalar_count));
    return fields_finish(rows, complete);
}

cJSON *wire_result(const char *token, const struct block_result *result) {
    char *data = NULL;
    struct error ignored;
    if (base64_encode(result->data, result->size, &data, &ignored) != 0)
        return NULL;
    cJSON *value = cJSON_CreateObject(), *scalars = cJSON_CreateObject();
    bool complete =
        field_put(value, "scalars", scalars) && /* takes them also on failure */
        field_put(scalars, "names", names_of(result)) &&
        field_put(scalars, "rows", scalar_rows(result)) && field_put_text(value, "token", token) &&
        field_put(value, "seconds", json_number(result->seconds)) &&
        field_put(value, "cpu_seconds", json_number(result->cpu_seconds)) &&
        field_put_count(value, "first", result->first) &&
        field_put_count(value, "count", result->count) && field_put_text(value, "data", data);
    free(data);
    return fields_finish(value, complete);
}

static int read_names(const cJSON *scalars, struct block_result *out, struct error *err) {
    const cJSON *names = field_at(scalars, "names"), *name;
    if (!cJSON_IsArray(names))
        return field_fault(names, "scalars/names", "an array of strings", err);
    size_t count = (size_t)cJSON_GetArraySize(names), n = 0;
    const char **texts_read = array_create(count, sizeof *texts_read);
    if (texts_read == NULL)
        return error_memory(err, count * sizeof *texts_read, "names of scalars");
    out->names = texts_read;
    cJSON_ArrayForEach(name, names) {
        if (!cJSON_IsString(name))
            return field_fault(names, "scalars/names", "an array of strings", err);
        texts_read[n++] = name->valuestring;
    }
    out->scalar_count = count;
    return 0;
}

static int read_row(const cJSON *row, double *values, size_t count, struct error *err) {
    size_t n = 0;
    const cJSON *item;
    if (!cJSON_IsArray(row))
        return field_fault(row, "scalars/rows", "an array", err);
    cJSON_ArrayForEach(item, row) {
        if (n == count || !(cJSON_IsNumber(item) || cJSON_IsNull(item)))
            return field_fault(row, "scalars/rows", "numbers or null, one for each name", err);
        values[n++] = cJSON_IsNull(item) ? (double)NAN : item->valuedouble;
    }
    return n == count ? 0
                      : field_fault(row, "scalars/rows", "numbers or null, one for each name", err);
}

/* Memory follows the rows that are there, never a count that was only claimed. */
static int read_rows(const cJSON *scalars, struct block_result *out, struct error *err) {
    const cJSON *rows = field_at(scalars, "rows"), *row;
    if (!cJSON_IsArray(rows) || (uint64_t)cJSON_GetArraySize(rows) != out->count)
        return field_fault(rows, "scalars/rows", "an array of as many rows as /count", err);
    size_t count = (size_t)out->count, width = out->scalar_count;
    double *values = array_create(count * (width > 0 ? width : 1), sizeof *values);
    out->scalars = values;
    if (values == NULL)
        return error_memory(err, count * width * sizeof *values, "scalars of a result");
    size_t r = 0;
    cJSON_ArrayForEach(row, rows) {
        int status = read_row(row, values + r * width, width, err);
        if (status != 0)
            return status;
        r++;
    }
    return 0;
}

/* Workers of older programs do not send it. */
static int read_cpu_seconds(const cJSON *value, double *out, struct error *err) {
    const cJSON *given = field_at(value, "cpu_seconds");
    *out = NAN;
    return given == NULL || cJSON_IsNull(given) ? 0 : field_seconds(value, "cpu_seconds", out, err);
}

static int read_result(const cJSON *value, struct block_result *out, struct error *err) {
    int status = field_seconds(value, "seconds", &out->seconds, err);
    status = status != 0 ? status : read_cpu_seconds(value, &out->cpu_seconds, err);
    status = status != 0 ? status : field_count(value, "first", &out->first, err);
    status = status != 0 ? status : field_count(value, "count", &out->count, err);
    status = status != 0 ? status : read_names(field_at(value, "scalars"), out, err);
    status = status != 0 ? status : read_rows(field_at(value, "scalars"), out, err);
    if (status != 0)
        return status;
    const char *data = cJSON_GetStringValue(field_at(value, "data"));
    if (data == NULL)
        return field_fault(field_at(value, "data"), "data", "a base64 string", err);
    unsigned char *decoded = NULL;
    status = base64_decode(data, &decoded, &out->size, err);
    out->data = decoded;
    return status != 0 ? error_context(err, "/data") : 0;
}

int wire_result_read(const cJSON *value, char token[TOKEN_SIZE], struct block_result *out,
                     struct error *err) {
    struct block_result result = {0};
    int status = field_copy(value, "token", TOKEN_SIZE, token, err);
    if (status == 0)
        status = read_result(value, &result, err);
    if (status != 0)
        block_result_clear(&result);
    else
        *out = result;
    return status;
}

/* --- heartbeat, fail, release --- */

cJSON *wire_heartbeat(const char *token, double done) {
    cJSON *value = wire_release(token);
    return fields_finish(value, value != NULL &&
                                    field_put_count(value, "done", (uint64_t)floor(done)) &&
                                    field_put(value, "part", json_number(done - floor(done))));
}

cJSON *wire_fail(const char *token, const char *reason, bool permanent) {
    cJSON *value = wire_release(token);
    return fields_finish(value, value != NULL && field_put_text(value, "reason", reason) &&
                                    field_put(value, "permanent", cJSON_CreateBool(permanent)));
}

cJSON *wire_release(const char *token) {
    cJSON *value = cJSON_CreateObject();
    return fields_finish(value, value != NULL && field_put_text(value, "token", token));
}

/* Copies what fits, without a broken UTF-8 character at the cut. */
static void text_cut(char *out, size_t size, const char *text) {
    size_t length = strlen(text);
    if (length >= size) {
        length = size - 1;
        while (length > 0 && ((unsigned char)text[length] & 0xc0) == 0x80)
            length--;
    }
    memcpy(out, text, length);
    out[length] = '\0';
}

/* Reads the whole realisations and the part of one, each 0 where it is absent. */
static int read_done(const cJSON *value, double *out, struct error *err) {
    const cJSON *part = field_at(value, "part");
    uint64_t whole = 0;
    int status = field_at(value, "done") != NULL ? field_count(value, "done", &whole, err) : 0;
    if (status == 0 && part != NULL &&
        !(cJSON_IsNumber(part) && part->valuedouble >= 0 && part->valuedouble < 1))
        status = field_fault(part, "part", "a number from 0 to below 1", err);
    if (status == 0)
        *out = (double)whole + (part != NULL ? part->valuedouble : 0);
    return status;
}

int wire_report_read(const cJSON *value, struct wire_report *out, struct error *err) {
    struct wire_report report = {0};
    int status = field_copy(value, "token", TOKEN_SIZE, report.token, err);
    if (status == 0)
        status = read_done(value, &report.done, err);
    status = status != 0 ? status : field_bool(value, "permanent", &report.permanent, err);
    const cJSON *reason = field_at(value, "reason");
    if (status == 0 && reason != NULL && !cJSON_IsString(reason))
        status = field_fault(reason, "reason", "a string", err);
    if (status != 0)
        return status;
    if (reason != NULL)
        text_cut(report.reason, sizeof report.reason, reason->valuestring);
    *out = report;
    return 0;
}
