/* A command that asks a store or a server one question and shows the document that answers. */
#ifndef RUGO_SERVER_COMMAND_STUDY_QUESTION_H
#define RUGO_SERVER_COMMAND_STUDY_QUESTION_H

#include "server/command/access/access.h"

/* A command asks and shows by these; id is that of a study, NULL where the command line gave none,
 * and options are the command's. */
struct question {
    const char *command;
    enum access_mode mode;
    bool alone; /* several studies of one name are refused: the newest need not be what is meant */
    int (*ask)(struct access *access, const char *id, const void *options, cJSON **out,
               struct error *err);
    int (*show)(const cJSON *document, const char *id, const void *options, struct error *err);
};
/* Checks the access, finds the study that `given` stands for (NULL: none), asks and shows; returns
 * an exit status. */
int question_answer(const struct question *question, const struct access_options *place,
                    const char *given, const void *options);
/* A command that changes one study and shows its progress then; its only options are those of
 * access. */
struct change_question {
    const char *command;
    bool alone; /* as above */
    int (*make)(struct access *access, const char *id, cJSON **progress, struct error *err);
};
struct change_options {
    struct access_options place;
};
extern const struct option_row CHANGE_OPTIONS[];
/* Makes the change and shows the progress; returns an exit status. */
int change_answer(const struct change_question *change, const struct change_options *options,
                  const char *id);
/* Prints a study's progress as text. */
int show_progress(const cJSON *document, const char *id, const void *options, struct error *err);

#endif
