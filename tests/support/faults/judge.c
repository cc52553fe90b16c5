/* What a service must hold after its faults: every study that was acknowledged, once, done, with
 * the curves of a calm run. */
#include "tests/support/check.h"
#include "tests/support/faults/world.h"
#include <cjson/cJSON.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { STUDIES_MOST = 4000, SETTLE_MS = 300000, RETRIES_MOST = 3 };

struct study_seen {
    char name[WORLD_NAME], id[20], state[16];
    int64_t realisations;
    int retries;
};
struct judge {
    struct world *world;
    struct study_seen studies[STUDIES_MOST];
    int count;
};

/* --- what is there --- */

static const char *text_of(const cJSON *object, const char *key) {
    const char *text = cJSON_GetStringValue(cJSON_GetObjectItem(object, key));
    return text != NULL ? text : "";
}

static struct study_seen *seen_by_id(struct judge *judge, const char *id) {
    for (int s = 0; s < judge->count; s++)
        if (strcmp(judge->studies[s].id, id) == 0)
            return &judge->studies[s];
    return NULL;
}

static void note_study(struct judge *judge, const cJSON *study) {
    const char *id = text_of(study, "id");
    struct study_seen *seen = seen_by_id(judge, id);
    const cJSON *realisations = cJSON_GetObjectItem(study, "realisations");
    const cJSON *cases = cJSON_GetObjectItem(study, "cases");
    const cJSON *total = cJSON_GetObjectItem(realisations, "total");
    if (seen == NULL) {
        assert_true(judge->count < STUDIES_MOST);
        seen = &judge->studies[judge->count++];
    }
    snprintf(seen->name, sizeof seen->name, "%s", text_of(study, "name"));
    snprintf(seen->id, sizeof seen->id, "%s", id);
    snprintf(seen->state, sizeof seen->state, "%s", text_of(study, "state"));
    if (cJSON_IsNumber(total) && cJSON_IsNumber(cases) && cases->valueint > 0)
        seen->realisations = (int64_t)total->valuedouble / cases->valueint;
}

/* Reads the list, page by page. False where an answer did not come. */
static bool read_studies(struct judge *judge) {
    char path[64] = "/v1/studies?limit=500";
    for (bool more = true; more;) {
        char *answer = NULL;
        int status = world_ask(judge->world, "GET", path, NULL, &answer);
        cJSON *document = status == 200 ? cJSON_Parse(answer) : NULL;
        const cJSON *studies = cJSON_GetObjectItem(document, "studies"), *study = NULL;
        bool good = cJSON_IsArray(studies);
        free(answer);
        more = false;
        cJSON_ArrayForEach(study, studies) {
            note_study(judge, study);
            snprintf(path, sizeof path, "/v1/studies?limit=500&after=%.20s", text_of(study, "id"));
            more = true;
        }
        cJSON_Delete(document);
        if (!good)
            return false;
    }
    return true;
}

/* --- waiting for the end --- */

/* No fault fails a study. */
static void tell_failure(struct judge *judge, const struct study_seen *seen) {
    char path[80], *answer = NULL;
    snprintf(path, sizeof path, "/v1/studies/%s", seen->id);
    world_ask(judge->world, "GET", path, NULL, &answer);
    const char *failures = strstr(answer, "\"failures\":");
    world_lose(&judge->world->tally->unfinished, "%s (%s) failed: %.300s", seen->name, seen->id,
               failures != NULL ? failures : answer);
    free(answer);
}

/* Studies that were cancelled, by who was then killed before thinking again, go on. */
static bool settle_study(struct judge *judge, struct study_seen *seen) {
    char path[80];
    bool failed = strcmp(seen->state, "failed") == 0;
    if (strcmp(seen->state, "done") == 0)
        return true;
    if ((failed || strcmp(seen->state, "cancelled") == 0) && seen->retries < RETRIES_MOST) {
        if (failed)
            tell_failure(judge, seen);
        snprintf(path, sizeof path, "/v1/studies/%s/retry", seen->id);
        if (world_ask(judge->world, "POST", path, NULL, NULL) == 200) {
            seen->retries++;
            atomic_fetch_add(&judge->world->tally->retried, 1);
        }
    }
    return false;
}

static void settle(struct judge *judge) {
    struct world *world = judge->world;
    bool ended = false;
    for (int64_t end = world_now() + SETTLE_MS, next = 0; !ended && world_now() < end;
         sleep_ms(10)) {
        world_tend(world);
        if (world_now() < next)
            continue;
        next = world_now() + 300;
        ended = read_studies(judge);
        for (int s = 0; s < judge->count; s++)
            ended = settle_study(judge, &judge->studies[s]) && ended;
    }
    for (int s = 0; s < judge->count; s++)
        if (strcmp(judge->studies[s].state, "done") != 0)
            world_lose(&world->tally->unfinished, "%s (%s) is %s", judge->studies[s].name,
                       judge->studies[s].id, judge->studies[s].state);
    if (judge->count == 0)
        world_lose(&world->tally->lost, "no study is there");
}

/* --- what was acknowledged --- */

/* The same request again gives the same study. */
static void check_key(struct judge *judge, const char *name, const char *id) {
    char again[17] = "";
    unsigned model = 0;
    if (sscanf(name, "m%u-k", &model) != 1 || strstr(name, "-k") == NULL)
        return;
    int status = 0;
    for (int tries = 0; tries < 3 && status == 0; tries++) /* of a busy machine */
        status = submission_send(judge->world, model, name, again);
    if (status != 200 || strcmp(again, id) != 0)
        world_lose(&judge->world->tally->doubled, "%s is %s, and sent again %d %s", name, id,
                   status, again);
}

static void check_line(struct judge *judge, const char *what, const char *name, const char *id) {
    int named = 0;
    for (int s = 0; s < judge->count; s++)
        named += strcmp(judge->studies[s].name, name) == 0;
    if (named > 1)
        world_lose(&judge->world->tally->doubled, "%d studies are %s", named, name);
    if (strcmp(what, "acked") != 0)
        return;
    const struct study_seen *seen = seen_by_id(judge, id);
    if (seen == NULL || strcmp(seen->name, name) != 0)
        world_lose(&judge->world->tally->lost, "%s (%s) was acknowledged and is not there", name,
                   id);
    else
        check_key(judge, name, id);
}

static void check_ledger(struct judge *judge) {
    char *ledger = slurp("ledger"), what[8], name[WORLD_NAME], id[20];
    for (const char *line = ledger; sscanf(line, "%7s %31s %19s", what, name, id) == 3;) {
        check_line(judge, what, name, id);
        line = strchr(line, '\n');
        if (line == NULL)
            break;
        line++;
    }
    free(ledger);
}

static void check_curves(struct judge *judge, const struct study_seen *seen) {
    struct world *world = judge->world;
    char path[80], file[WORLD_NAME], *answer = NULL;
    int model = model_find(seen->name, seen->realisations);
    if (model < 0) {
        world_lose(&world->tally->differing, "%s has %d realisations", seen->name,
                   (int)seen->realisations);
        return;
    }
    snprintf(file, sizeof file, "calm-%d.out", model);
    snprintf(path, sizeof path, "/v1/studies/%s/curves", seen->id);
    char *calm = slurp(file);
    calm[strcspn(calm, "\n")] = '\0';
    int status = world_ask(world, "GET", path, NULL, &answer);
    answer[strcspn(answer, "\n")] = '\0';
    const char *expected = model_cases(calm), *got = model_cases(answer);
    if (status != 200 || got == NULL || strcmp(got, expected) != 0)
        world_lose(&world->tally->differing, "%s (%s): its curves are not those of a calm run (%d)",
                   seen->name, seen->id, status);
    free(answer);
    free(calm);
}

/* --- the end of the processes --- */

/* One more copy, which takes away what killed ones have left. */
static void copy_once_more(struct world *world) {
    for (int a = 0; a < world->actor_count; a++) {
        struct actor *actor = &world->actors[a];
        if (actor->role != ROLE_IS_SNAPSHOT)
            continue;
        world_start(world, actor);
        int status = process_wait(&actor->process, 60);
        if (status != 0)
            world_lose(&world->tally->lost, "%s ended with status %d", actor->name, status);
        world_judge_snapshot(world, actor, status == 0);
    }
}

static void end_processes(struct world *world) {
    for (int a = world->actor_count - 1; a >= 0; a--) { /* the server, the first, comes last */
        struct actor *actor = &world->actors[a];
        bool server = actor->role == ROLE_IS_SERVER;
        int status = world_end(actor, SIGTERM, server ? 10 : 30);
        if (status != 0 && status != 130)
            world_lose(&world->tally->crashes, "%s ended with status %d at SIGTERM", actor->name,
                       status);
    }
}

/* Waits for the ends of those that were killed, which no later look at them takes for crashes. */
static void reap_killed(struct world *world) {
    bool left = true;
    for (int64_t end = world_now() + 10000; left && world_now() < end; sleep_ms(5)) {
        world_tend(world);
        left = false;
        for (int a = 0; a < world->actor_count; a++) {
            const struct actor *actor = &world->actors[a];
            left = left || (actor->role > ROLE_IS_WORKER && actor->process.pid != 0);
        }
    }
}

void world_judge(struct world *world) {
    struct judge *judge = calloc(1, sizeof *judge);
    assert_non_null(judge);
    judge->world = world;
    if (world->options.heal != NULL)
        world->options.heal(world);
    world->ending = true;
    for (int a = 0; a < world->actor_count; a++) {
        struct actor *actor = &world->actors[a];
        actor->wake_at = actor->wake_at != 0 ? 1 : 0;
        if (actor->role > ROLE_IS_WORKER) {
            actor->struck = true;
            process_kill(&actor->process, SIGKILL);
        }
    }
    reap_killed(world);
    settle(judge);
    check_ledger(judge);
    for (int s = 0; s < judge->count; s++)
        check_curves(judge, &judge->studies[s]);
    copy_once_more(world);
    end_processes(world);
    free(judge);
}
