/* A study in a local store from submission to table, for the commands that see to it all. */
#ifndef RUGO_SERVER_COMMAND_STUDY_LOCAL_STUDY_H
#define RUGO_SERVER_COMMAND_STUDY_LOCAL_STUDY_H

#include "schema/store/store.h"
#include "schema/study/fault.h"
#include "server/command/study/result_folder.h"
#include "worker/publish/publish.h"

/* What is run here; all is borrowed. */
struct local_submission {
    const char *database, *file;
    const char *const *overrides; /* as of --set */
    struct result_folder folder;  /* for its results */
};
/* Opens the store and queues the study of a file. The same study in the same store is the same run:
 * its text is its key. ERROR_INPUT, with nothing queued, where the folder holds the results of
 * another study. The caller closes *store, also after a failure. */
int local_study_submit(struct store **store, const struct local_submission *submission,
                       char id[STUDY_ID_SIZE], struct fault_list *faults, struct error *err);

/* What became of a study that nobody works on any more. All is borrowed. */
struct outcome {
    const char *command; /* for messages */
    struct store *store;
    const char *database, *id;
    struct result_folder folder;            /* for the files of output.h */
    const struct publish_counts *published; /* what was left due, and why */
};
/* Prints the table and writes the files. Fails where the study is not done or has no value, and
 * says how to go on. */
int local_study_present(const struct outcome *outcome, struct error *err);

#endif
