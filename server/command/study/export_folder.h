/* The files by which a study is published: what it is, what came out, and how to repeat it. */
#ifndef RUGO_SERVER_COMMAND_STUDY_EXPORT_FOLDER_H
#define RUGO_SERVER_COMMAND_STUDY_EXPORT_FOLDER_H

#include "server/command/access/access.h"
#include "server/command/study/result_folder.h"

struct export_order {
    struct access *access;
    const char *id;
    struct result_folder folder; /* is there */
};
/* Writes the files. *study gets the results, which the caller clears also after a failure.
 * ERROR_STOPPED, between two files, where stop_requested is set. */
int export_folder(const struct export_order *order, struct study_result *study, struct error *err);

#endif
