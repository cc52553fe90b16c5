/* A folder of results belongs to one study: its curves.json has the id, its study.json the
 * document. */
#ifndef RUGO_SERVER_COMMAND_STUDY_RESULT_FOLDER_H
#define RUGO_SERVER_COMMAND_STUDY_RESULT_FOLDER_H

#include "core/error.h"
#include <cjson/cJSON.h>
#include <stdbool.h>

struct result_folder {
    const char *path; /* as of --out; NULL: no files are written */
    bool replace;     /* results of another study may go */
};
/* The row of --replace, for a command's struct that holds a result_folder in the offset. */
#define REPLACE_ROW(at)                                                                            \
    {                                                                                              \
        "replace", 0, OPTION_FLAG, 0, 0, at, NULL, NULL,                                           \
            "write into --out though it holds the results of another study, and take those away"   \
    }

/* The id that theories have in place of a study's. */
#define FOLDER_OF_THEORY "theory"
/* ERROR_INPUT where the folder holds the results of a study of another id and another document, or
 * theories in place of results, unless they are to be replaced. A folder that is missing holds
 * nothing. */
int result_folder_check(const struct result_folder *folder, const char *id, const cJSON *document,
                        struct error *err);
/* Checks likewise, makes the folder if it is missing, and writes study.json into it. Before, it
 * takes away what another study wrote into it: pictures whose metadata name that one, the files of
 * `rugo export` that do, and kept nodes. What else is in the folder stays. */
int result_folder_take(const struct result_folder *folder, const char *id, const cJSON *document,
                       struct error *err);

#endif
