/* A service under faults: a server, workers, and those who submit studies and take snapshots, all
 * real processes over one store, in the empty folder of a test. Processes that end are started
 * again; meanwhile a program strikes them, or what they stand on. In the end what was acknowledged
 * is compared with what is there, and a line reports it.
 *
 * RUGO_SECONDS is how long the faults go on, RUGO_SEED repeats a row of them. */
#ifndef RUGO_TESTS_SUPPORT_FAULTS_WORLD_H
#define RUGO_TESTS_SUPPORT_FAULTS_WORLD_H

#include "tests/support/process.h"
#include <stdatomic.h>
#include <stdint.h>

enum { WORLD_ACTORS = 16, WORLD_MODELS = 4, WORLD_NAME = 32 };
/* The model behind the others has a realisation of several leases; only those who say so run it. */
enum { WORLD_LONG_MODEL = WORLD_MODELS };

enum role {
    ROLE_IS_SERVER,
    ROLE_IS_WORKER,
    ROLE_IS_SUBMITTER, /* a child of the test, by keys and over plain sockets */
    ROLE_IS_COMMAND,   /* `rugo submit` */
    ROLE_IS_SNAPSHOT,  /* `rugo snapshot` */
};

struct actor {
    enum role role;
    int number; /* of those of its role, from 0 */
    char name[WORLD_NAME];
    char study[WORLD_NAME]; /* that a command submits */
    struct process process;
    int64_t start_at; /* milliseconds of world_now; while it does not run */
    int64_t wake_at;  /* when it is to go on; 0: it is not stopped */
    bool struck;      /* by a signal of ours, so that its end is no surprise */
};

struct world;
struct world_options {
    const char *program;                          /* its name in the report */
    int workers, submitters, commands, snapshots; /* all 0: 3, 2, 1 and 1 */
    const char *const *serve;  /* more options of `rugo serve`, NULL-terminated; or NULL */
    const char *const *client; /* more options of all commands that ask the server, likewise */
    const char *headers;       /* of requests, each with its line break; NULL: of a JSON body */
    const char *token_file;    /* of the processes; NULL: none */
    const char *listen, *ask;  /* addresses; NULL: of this machine */
    long server_kb;            /* most memory of the server; 0: 256 MiB */
    bool long_model;           /* submitters send it, too, and no lease of a job may be lost */
    /* Around the start of a process, so that it inherits what these set; NULL: nothing. */
    void (*before)(struct world *world, const struct actor *actor);
    void (*after)(struct world *world, const struct actor *actor);
    /* Strikes once; pause_ms is the mean time between two strikes. */
    void (*strike)(struct world *world);
    long pause_ms;
    /* Ends all faults; NULL: there is nothing to end. */
    void (*heal)(struct world *world);
    void *context; /* of these functions */
};

/* What is counted; submitters share it with the test. */
struct world_tally {
    atomic_uint kills, faults, requests, submitted, acknowledged, retried, next_key;
    atomic_uint lost, doubled, differing, unfinished, damaged, leftovers, crashes;
};

struct world {
    struct world_options options;
    uint64_t seed, random;
    double seconds;
    unsigned port;
    char url[64];
    struct actor actors[WORLD_ACTORS];
    int actor_count;
    bool ending; /* nobody but server and workers is started again */
    long server_kb;
    struct world_tally *tally;
};

/* Lease of the servers, in seconds. */
enum { WORLD_LEASE = 2 };

/* Runs the whole of a test: opens, strikes for RUGO_SECONDS (else `usual`), judges, reports; fails
 * the test where anything was lost. */
void world_test(const struct world_options *options, double usual);

/* --- for strikes --- */

int64_t world_now(void);
/* How many models the submitters of a world send. */
unsigned world_models(const struct world *world);
/* A random number below n. */
unsigned world_draw(struct world *world, unsigned n);
/* A random actor that runs; NULL: none. */
struct actor *world_pick(struct world *world);
void world_kill(struct world *world, struct actor *actor);
/* Stops an actor for so long. */
void world_stop(struct world *world, struct actor *actor, long milliseconds);
/* Counts a fault of another sort. */
void world_count_fault(struct world *world);
/* Asks as the test: the status, 0 where no answer came. */
int world_ask(struct world *world, const char *method, const char *path, const char *body,
              char **answer);

/* --- for the parts --- */

/* A loss: counts it and says what it is. */
void world_lose(atomic_uint *count, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* Reaps, wakes and starts whoever is due. */
void world_tend(struct world *world);
void world_start(struct world *world, struct actor *actor);
/* Ends an actor by a signal and waits for its status. */
int world_end(struct actor *actor, int signal_number, int seconds);

/* Studies of a moment: the text of a model under a name; the caller frees. */
char *model_text(unsigned model, const char *name);
/* The model that a study of this name and length is; -1: none. */
int model_find(const char *name, int64_t realisations);
int64_t model_realisations(unsigned model);
/* What follows the provenance in a document of curves; NULL: it is none. */
const char *model_cases(const char *document);
/* Runs so many models calmly; the curves of each lie in calm-MODEL.out. */
void models_run(unsigned count);

/* Sends a model under a name, which is its key, too: the status, 0 without a whole answer; id of
 * the study where it is 200 or 201. */
int submission_send(struct world *world, unsigned model, const char *name, char id[17]);
/* The life of a submitter, which does not end. */
void submitter_run(struct world *world, const struct actor *actor);
/* Adds a line to the ledger, at once and whole. */
void ledger_add(const char *what, const char *name, const char *id);

/* Ends all faults, waits for the studies, and holds everything against what was acknowledged. */
void world_judge(struct world *world);
/* A copy of the store that is there is whole, and then taken away. promised: it must be there. */
void world_judge_snapshot(struct world *world, const struct actor *actor, bool promised);
/* The file of the store and the folder, after the server has ended. */
void world_judge_files(struct world *world);

#endif
