/* `rugo slurm pilots`: keeps as many pilots in Slurm as the queue of a server needs. It remembers
 * nothing: its pilots have the name that the server's address gives them, so that it may end and
 * start at any time. */
#include "server/command/access/access.h"
#include "server/command/cluster/pilots.h"
#include "server/command/command.h"
#include "server/command/service/token_file.h"
#include "worker/clock.h"
#include "worker/link/client.h"
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

struct options {
    struct access_options place;
    const char *folder;
    unsigned most, jobs, every_s;
    bool once, print;
    struct pilot_options pilot;
};
#define AT(member) offsetof(struct options, member)
static const struct option_row OPTIONS[] = {
    ACCESS_SERVER_ROWS(struct options, "the server"),
    {"max", 0, OPTION_COUNT, 1, 100000, AT(most), "N", "1", "most pilots, one on a node each"},
    {"jobs", 0, OPTION_COUNT, 1, 1000000, AT(jobs), "N", "1",
     "a thread of a pilot for so many jobs that wait or run"},
    {"every", 0, OPTION_COUNT, 1, SECONDS_MOST, AT(every_s), "SECONDS", "10",
     "how often the queue is looked at"},
    {"once", 0, OPTION_FLAG, 0, 0, AT(once), NULL, NULL, "look once and end, as for cron"},
    PILOT_ROWS(struct options),
    {"dir", 0, OPTION_TEXT, 0, 0, AT(folder), "DIR", "rugo-pilots",
     "work folder, which the nodes see too: script, logs"},
    {"print", 0, OPTION_FLAG, 0, 0, AT(print), NULL, NULL,
     "print the batch script, which stays in the work folder, and stop"},
    {0}};

struct keeper {
    const struct options *options;
    struct slurm_folder folder;
    struct pilots pilots;
    struct client *client;
};

/* Counts the jobs that wait and run. */
static int count_jobs(struct keeper *keeper, double *jobs, struct error *err) {
    const struct request request = {.method = "GET", .path = "/v1/workers"};
    cJSON *document = NULL;
    int status = client_json(keeper->client, &request, &document, err);
    const cJSON *waiting = cJSON_GetObjectItemCaseSensitive(document, "waiting"), *worker;
    if (status == 0 && !cJSON_IsNumber(waiting))
        status = error_set(err, ERROR_SYSTEM, "the server's answer has no number of waiting jobs");
    *jobs = status == 0 ? waiting->valuedouble : 0;
    cJSON_ArrayForEach(worker, cJSON_GetObjectItemCaseSensitive(document, "workers")) *jobs +=
        cJSON_GetArraySize(cJSON_GetObjectItemCaseSensitive(worker, "jobs"));
    cJSON_Delete(document);
    return status;
}

static unsigned pilots_for(const struct options *options, double jobs) {
    double each = (double)options->pilot.tasks * options->pilot.cpus * options->jobs;
    return jobs >= each * options->most ? options->most : (unsigned)((jobs + each - 1) / each);
}

/* Brings pilots to what the queue needs. Those that work are left alone: they end when idle. */
static int look(struct keeper *keeper, struct error *err) {
    double jobs = 0;
    struct slurm_count count;
    int status = count_jobs(keeper, &jobs, err);
    if (status == 0)
        status = slurm_jobs_count(keeper->pilots.name, &count, err);
    if (status != 0)
        return status;
    unsigned wanted = pilots_for(keeper->options, jobs), there = count.running + count.waiting;
    if (there < wanted) {
        fprintf(stderr, "rugo slurm pilots: jobs %.0f, pilots %u running, %u waiting; %u more\n",
                jobs, count.running, count.waiting, wanted - there);
        return slurm_jobs_submit(keeper->pilots.script, wanted - there, err);
    }
    if (count.waiting == 0 || wanted > count.running)
        return 0;
    fprintf(stderr, "rugo slurm pilots: jobs %.0f, pilots %u running; %u waiting are cancelled\n",
            jobs, count.running, count.waiting);
    return slurm_jobs_cancel(keeper->pilots.name, 1, err);
}

static void pause_for(unsigned seconds) {
    const struct timespec step = {0, 100000000};
    int64_t until_ms = clock_ms() + 1000 * (int64_t)seconds;
    while (clock_ms() < until_ms && stop_requested == 0)
        nanosleep(&step, NULL);
}

/* Looks until asked to stop; what fails, such as a server or Slurm that is away, is tried again. */
static int keep(struct keeper *keeper, struct error *err) {
    struct error away = {0};
    while (stop_requested == 0) {
        int status = look(keeper, &away);
        if (keeper->options->once) {
            *err = away;
            return status;
        }
        if (status != 0)
            fprintf(stderr, "rugo slurm pilots: %s; tried again\n", away.text);
        pause_for(keeper->options->every_s);
    }
    fprintf(stderr,
            "rugo slurm pilots: ended; its pilots go on until they are idle, or until "
            "scancel --name=%s\n",
            keeper->pilots.name);
    return 0;
}

/* Writes for pilots where the server is and what they need to be let in; a token of RUGO_TOKEN
 * comes to them by the environment, which sbatch hands on. */
static int write_place(struct keeper *keeper, struct error *err) {
    const struct access_options *place = &keeper->options->place;
    struct client_trust trust = access_trust(place);
    const char *files[2] = {place->token_file, trust.ca_file};
    const char *names[2] = {"--token-file", "--ca-file"};
    char text[2 * PATH_MAX + 1024], path[PATH_MAX];
    size_t used = (size_t)snprintf(text, sizeof text, "--server\n%.400s\n", place->server);
    for (size_t f = 0; f < 2; f++) {
        if (files[f] == NULL)
            continue;
        if (realpath(files[f], path) == NULL)
            return error_set(err, ERROR_INPUT, "%.300s: %s", files[f], strerror(errno));
        used += (size_t)snprintf(text + used, sizeof text - used, "%s\n%s\n", names[f], path);
    }
    if (trust.fingerprint != NULL)
        used += (size_t)snprintf(text + used, sizeof text - used, "--fingerprint\n%.100s\n",
                                 trust.fingerprint);
    if (trust.insecure)
        snprintf(text + used, sizeof text - used, "--insecure\n");
    return slurm_folder_write(&keeper->folder, "place", text, 1, err);
}

static int perform(struct keeper *keeper, struct error *err) {
    const struct options *options = keeper->options;
    struct client_trust trust = access_trust(&options->place);
    char *token = NULL;
    int status = slurm_folder_open(&keeper->folder, options->folder, err);
    if (status == 0)
        status = pilots_prepare(&keeper->pilots, &keeper->folder, options->place.server,
                                &options->pilot, err);
    if (status == 0 && options->print)
        return pilots_print(keeper->pilots.script, err);
    if (status == 0)
        status = write_place(keeper, err);
    if (status == 0)
        status = token_read(options->place.token_file, ROLE_WORK, &token, err);
    if (status == 0)
        status = client_create(&keeper->client, options->place.server, token, &trust, err);
    free(token);
    return status != 0 ? status : keep(keeper, err);
}

static int run(const void *values, const char *const *arguments) {
    (void)arguments;
    struct keeper keeper = {.options = values};
    const struct access_options *place = &keeper.options->place;
    struct error err = {0};
    if (place->server == NULL)
        return usage_error("slurm pilots", "pilots work for a server: --server URL is needed");
    if (strpbrk(place->server, "\r\n") != NULL)
        return usage_error("slurm pilots", "--server has more than one line");
    if (pilot_options_check("slurm pilots", &keeper.options->pilot) != 0)
        return EXIT_USAGE;
    signals_catch();
    int status = perform(&keeper, &err);
    client_destroy(&keeper.client);
    slurm_folder_close(&keeper.folder);
    return status == 0 ? EXIT_DONE : command_fail("slurm pilots", &err);
}

const struct command COMMAND_SLURM_PILOTS = {
    .name = "slurm pilots",
    .arguments = "",
    .summary = "keep as many workers in Slurm as a server's queue needs",
    .options = OPTIONS,
    .options_size = sizeof(struct options),
    .run = run,
};
