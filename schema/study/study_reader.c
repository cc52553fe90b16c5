#include "schema/study/study_reader.h"
#include "schema/near_name.h"
#include "schema/study/common.h"
#include "schema/study/override.h"
#include "schema/study/sweep.h"
#include "schema/study/value.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double JOB_SECONDS = 5; /* what a job should take */
/* Most realisations of a job, and bytes of its result. */
static const double JOB_REALISATIONS = 1000, JOB_BYTES = 4e6;
static const double SHARE_SECONDS = 0.1; /* jobs as short as this are not divided among workers */

/* --- names --- */

/* Returns the path of a row of every study, or of the kind; NULL behind the last. */
static const char *known_path(const struct study_kind *kind, size_t index) {
    if (index < COMMON_PARAMETERS.count)
        return COMMON_PARAMETERS.rows[index].path;
    const struct parameter *row = parameter_row(kind->tables, index - COMMON_PARAMETERS.count);
    return row != NULL ? row->path : NULL;
}

enum pointer_kind { POINTER_UNKNOWN, POINTER_INSIDE, POINTER_PARAMETER };

/* Returns whether a pointer names a parameter, an object that has parameters, or nothing. */
static enum pointer_kind kind_of_pointer(const struct study_kind *kind, const char *pointer) {
    size_t length = strlen(pointer);
    const char *path;
    for (size_t i = 0; (path = known_path(kind, i)) != NULL; i++) {
        if (strncmp(path, pointer, length) != 0)
            continue;
        if (path[length] == 0)
            return POINTER_PARAMETER;
        if (path[length] == '/')
            return POINTER_INSIDE;
    }
    return POINTER_UNKNOWN;
}

/* Copies the name of an object's member out of a path; false where the path leads elsewhere. */
static bool member_of_path(const char *path, const char *prefix, char member[POINTER_SIZE]) {
    size_t length = strlen(prefix);
    if (strncmp(path, prefix, length) != 0 || path[length] != '/')
        return false;
    snprintf(member, POINTER_SIZE, "%.*s", (int)strcspn(path + length + 1, "/"), path + length + 1);
    return true;
}

/* Appends the names that an object may have, as many as there is room for. */
static void list_members(const struct study_kind *kind, const char *prefix, char *text,
                         size_t size) {
    char member[POINTER_SIZE], last[POINTER_SIZE] = "";
    const char *path;
    size_t used = (size_t)snprintf(text, size, "; allowed: ");
    bool first = true;
    for (size_t i = 0; (path = known_path(kind, i)) != NULL; i++) {
        if (!member_of_path(path, prefix, member) || strcmp(member, last) == 0)
            continue;
        if (used + strlen(member) + sizeof ", ..." > size) {
            snprintf(text + used, size - used, ", ...");
            return;
        }
        used += (size_t)snprintf(text + used, size - used, "%s%s", first ? "" : ", ", member);
        snprintf(last, sizeof last, "%s", member);
        first = false;
    }
}

/* Writes "; did you mean ...?" where a name at the same level is similar, or elsewhere the same;
 * else the names of the level. */
static void suggestion(const struct study_kind *kind, const char *prefix, const char *name,
                       char *text, size_t size) {
    struct near_name near = {.typed = name};
    const char *path, *elsewhere = NULL;
    char sibling[POINTER_SIZE];
    list_members(kind, prefix, text, size);
    for (size_t i = 0; (path = known_path(kind, i)) != NULL; i++) {
        if (elsewhere == NULL && strcmp(strrchr(path, '/') + 1, name) == 0)
            elsewhere = path;
        if (!member_of_path(path, prefix, sibling))
            continue;
        size_t before = near.distance;
        bool found = near.name != NULL;
        near_name_see(&near, sibling);
        if (near.name == NULL || (found && near.distance == before))
            continue;
        near.name = path; /* for the sibling, whose text is overwritten */
        snprintf(text, size, "; did you mean \"%.60s\"?", sibling);
    }
    if (near.name == NULL && elsewhere != NULL)
        snprintf(text, size, "; did you mean \"%.60s\"?", elsewhere);
}

/* Returns whether a member stands for a file that was not read: the file's name, or an object
 * without its digest. */
static bool is_unread(const struct study_kind *kind, const cJSON *member, const char *pointer) {
    char digest[POINTER_SIZE + 8];
    snprintf(digest, sizeof digest, "%s/sha256", pointer);
    return kind_of_pointer(kind, digest) == POINTER_PARAMETER &&
           (cJSON_IsString(member) ||
            (cJSON_IsObject(member) && !cJSON_HasObjectItem(member, "sha256")));
}

static void check_names(const struct study_kind *kind, const cJSON *object, const char *prefix,
                        struct fault_list *faults);

static void check_inside(const struct study_kind *kind, const cJSON *member, const char *pointer,
                         struct fault_list *faults) {
    char text[48];
    json_describe(member, text, sizeof text);
    if (is_unread(kind, member, pointer))
        fault_add(faults, pointer,
                  "the file is not fitted: commands read it where they run, and rugo check --study "
                  "STUDY.json prints the study with what was fitted, which can be sent");
    else if (cJSON_IsObject(member))
        check_names(kind, member, pointer, faults);
    else
        fault_add(faults, pointer, "%s is not an object", text);
}

static void check_names(const struct study_kind *kind, const cJSON *object, const char *prefix,
                        struct fault_list *faults) {
    for (const cJSON *member = object->child; member != NULL; member = member->next) {
        char pointer[POINTER_SIZE], hint[200];
        snprintf(pointer, sizeof pointer, "%s/%s", prefix, member->string);
        /* a slash in a name would make the pointer of another parameter */
        bool whole = strchr(member->string, '/') == NULL;
        switch (whole ? kind_of_pointer(kind, pointer) : POINTER_UNKNOWN) {
        case POINTER_PARAMETER:
            break;
        case POINTER_INSIDE:
            check_inside(kind, member, pointer, faults);
            break;
        case POINTER_UNKNOWN:
            suggestion(kind, prefix, member->string, hint, sizeof hint);
            fault_add(faults, pointer, "unknown name%s", hint);
        }
    }
}

/* --- what the kind asks for --- */

static void check_list(const struct parameter *parameter, const cJSON *list,
                       struct fault_list *faults) {
    if (!parameter->sweep) {
        fault_add(faults, parameter->path, "a list is not allowed here: this cannot be swept");
        return;
    }
    size_t i = 0;
    for (const cJSON *item = list->child; item != NULL; item = item->next, i++) {
        char pointer[POINTER_SIZE];
        snprintf(pointer, sizeof pointer, "%s/%zu", parameter->path, i);
        value_check(parameter, item, pointer, faults);
    }
    if (i == 0)
        fault_add(faults, parameter->path, "an empty list; give at least one value");
}

static void check_parameters(const struct study_kind *kind, const cJSON *document,
                             struct fault_list *faults) {
    const struct parameter *parameter;
    for (size_t p = 0; (parameter = parameter_row(kind->tables, p)) != NULL; p++) {
        const cJSON *value = json_at(document, parameter->path);
        if (value != NULL && value_is_list(parameter, value))
            check_list(parameter, value, faults);
        else if (value != NULL)
            value_check(parameter, value, parameter->path, faults);
        else if (parameter->required)
            value_missing(parameter, faults);
    }
}

/* Cases of a sweep share most of their faults; each is listed once. */
static void merge_faults(struct fault_list *all, const struct fault_list *found) {
    size_t kept = found->count < FAULTS_KEPT ? found->count : FAULTS_KEPT;
    if (found->faults == NULL)
        all->count += found->count;
    for (size_t i = 0; found->faults != NULL && i < kept; i++) {
        const struct fault *fault = &found->faults[i];
        bool known = false;
        size_t merged = all->count < FAULTS_KEPT ? all->count : FAULTS_KEPT;
        for (size_t k = 0; all->faults != NULL && k < merged && !known; k++)
            known = strcmp(all->faults[k].pointer, fault->pointer) == 0 &&
                    strcmp(all->faults[k].detail, fault->detail) == 0;
        if (!known)
            fault_add(all, fault->pointer, "%s", fault->detail);
    }
}

uint64_t study_block_most(const struct study_cost *cost) {
    double most =
        cost->runs_most > 0 ? fmin((double)cost->runs_most, JOB_REALISATIONS) : JOB_REALISATIONS;
    if (cost->result_bytes > 0)
        most = fmin(most, floor(JOB_BYTES / cost->result_bytes));
    return most > 1 ? (uint64_t)most : 1;
}

uint64_t study_block(uint64_t realisations, double seconds, uint64_t most) {
    if (realisations == 0 || most == 0)
        return 1;
    double timely = seconds > 0 ? floor(JOB_SECONDS / seconds + 0.5) : (double)most;
    uint64_t block = timely < (double)most ? (uint64_t)fmax(timely, 1) : most;
    uint64_t blocks = realisations / block + (realisations % block != 0);
    return realisations / blocks + (realisations % blocks != 0);
}

uint64_t study_share(uint64_t block, double seconds, uint64_t waiting, uint64_t workers) {
    if (workers < 2)
        return block;
    uint64_t equal = waiting / workers + (waiting % workers != 0);
    double share = (double)equal;
    double least = seconds > 0 ? floor(SHARE_SECONDS / seconds) : (double)block;
    double most = fmax(fmax(share, least), 1);
    return most < (double)block ? (uint64_t)most : block;
}

/* Checks one case, and bounds the size of its jobs. */
static int check_case(const struct study_kind *kind, struct study_case *one, double memory_limit,
                      const struct study_reading *reading, struct fault_list *faults,
                      struct error *err) {
    struct fault_list found = {0};
    if (reading->stop != NULL && reading->stop(reading->stop_context) != 0)
        return error_set(err, ERROR_STOPPED, "checking the study was stopped");
    int status = kind->check(kind, one->parameters, memory_limit, &found, &one->cost, err);
    one->block = study_block_most(&one->cost);
    one->cost.memory_bytes += (double)one->block * one->cost.result_bytes;
    if (status == 0 && found.count == 0 && memory_limit > 0 &&
        one->cost.memory_bytes > memory_limit)
        fault_add(&found, "",
                  "a worker needs %.3g GiB for a grid of %zu by %zu; allowed: "
                  "%.3g GiB on this machine",
                  one->cost.memory_bytes / 0x1p30, one->cost.nx, one->cost.ny,
                  memory_limit / 0x1p30);
    if (status == 0 && one->realisations > 0 && one->cost.kept.past > one->realisations)
        fault_add(&found, one->cost.kept.path,
                  "the study has no realisation %llu: cases have %llu, from 0",
                  (unsigned long long)one->cost.kept.past - 1,
                  (unsigned long long)one->realisations);
    merge_faults(faults, &found);
    fault_list_clear(&found);
    return status;
}

/* Checks the components of a case. A component with faults that starts only if needed (realisations
 * 0) is dropped: the others answer without it. */
static int check_components(const struct study_kind *kind, struct study_case *one,
                            const struct study_reading *reading, struct fault_list *faults,
                            struct error *err) {
    size_t kept = 0;
    int status = 0;
    for (size_t a = 0; a < one->component_count; a++) {
        struct study_case component = one->components[a];
        struct fault_list found = {0};
        if (status == 0)
            status = check_case(kind, &component, reading->memory_limit, reading, &found, err);
        bool spare = status == 0 && component.realisations == 0 && found.count > 0;
        if (spare)
            cJSON_Delete(component.parameters);
        else
            one->components[kept++] = component;
        if (!spare)
            merge_faults(faults, &found);
        fault_list_clear(&found);
    }
    one->component_count = kept;
    return status;
}

/* Of a case with components these run in its place, so that the limit of memory applies to them. */
static int check_cases(struct study *study, const cJSON *document,
                       const struct study_reading *reading, struct fault_list *faults,
                       struct error *err) {
    int status = 0;
    for (size_t c = 0; c < study->case_count && status == 0; c++) {
        struct study_case *one = &study->cases[c];
        one->realisations = study->realisations;
        if (study->kind->fill != NULL)
            status = study->kind->fill(document, one->parameters, err);
        if (status == 0 && study->realisations == 0)
            status = study->kind->expand(document, one, faults, err);
        if (status == 0)
            status =
                check_case(study->kind, one, one->component_count > 0 ? 0 : reading->memory_limit,
                           reading, faults, err);
        if (status == 0)
            status = check_components(study->kind, one, reading, faults, err);
    }
    return status;
}

/* --- together --- */

static int faulty(const struct fault_list *faults, struct error *err) {
    const struct fault *first = faults->faults;
    if (first != NULL && first->pointer != NULL && first->detail != NULL)
        return error_set(err, ERROR_INPUT, "%s%s%s", first->pointer, *first->pointer ? ": " : "",
                         first->detail);
    return error_set(err, ERROR_INPUT, "the study has %zu faults", faults->count);
}

static int fill(struct study *study, const cJSON *document, const struct study_reading *reading,
                struct fault_list *faults, struct error *err) {
    int status = common_read(study, document, reading->kinds, faults, err);
    if (status != 0)
        return status;
    if (study->kind == NULL)
        return faulty(faults, err);
    /* What all studies have, such as the name, bears on no case, which are checked all the same. */
    const size_t common = faults->count;
    check_names(study->kind, document, "", faults);
    check_parameters(study->kind, document, faults);
    if (faults->count != common)
        return faulty(faults, err);
    study->source = json_print(document);
    if (study->source == NULL)
        return error_memory(err, strlen(study->kind->name), "a study");
    status = sweep_open(study, document, faults, err);
    if (status == 0 && faults->count == common)
        status = check_cases(study, document, reading, faults, err);
    if (status == 0 && faults->count != 0)
        status = faulty(faults, err);
    return status;
}

int study_read(struct study **out, const char *text, size_t size, const char *const *overrides,
               const struct study_kind *const *kinds, double memory_limit,
               struct fault_list *faults, struct error *err) {
    const struct study_reading reading = {
        .overrides = overrides, .kinds = kinds, .memory_limit = memory_limit};
    return study_read_ext(out, text, size, &reading, faults, err);
}

int study_read_ext(struct study **out, const char *text, size_t size,
                   const struct study_reading *reading, struct fault_list *faults,
                   struct error *err) {
    const char *const *overrides = reading->overrides;
    cJSON *document = NULL;
    struct study *study = NULL;
    int status = json_parse(text, size, NULL, &document, err);
    if (status == 0 && !cJSON_IsObject(document)) {
        fault_add(faults, "", "a study is a JSON object");
        status = faulty(faults, err);
    }
    for (size_t i = 0; status == 0 && overrides != NULL && overrides[i] != NULL; i++)
        status = override_apply(document, overrides[i], err);
    if (status == 0 && (study = array_create(1, sizeof *study)) == NULL)
        status = error_memory(err, sizeof *study, "a study");
    if (status == 0)
        status = fill(study, document, reading, faults, err);
    cJSON_Delete(document);
    if (status != 0) {
        study_destroy(&study);
        return status;
    }
    *out = study;
    return 0;
}
