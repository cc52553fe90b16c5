#include "server/command/study/result_folder.h"
#include "core/file/file.h"
#include "core/file/whole_file.h"
#include "core/file/written_file.h"
#include "schema/json/json.h"
#include "schema/store/store.h"
#include "server/command/study/kept_nodes.h"
#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { PATH_SIZE = 4096, HEAD_SIZE = 4096, ID_SIZE = 40, NAME_SIZE = 80 };

/* The study whose results a folder holds. */
struct holder {
    char id[ID_SIZE];     /* "": the folder holds no results */
    char name[NAME_SIZE]; /* may be cut */
    cJSON *document;      /* owned; NULL where the folder has none, as one of older programs */
};

static int path_in(const struct result_folder *folder, const char *name, char path[PATH_SIZE],
                   struct error *err) {
    return snprintf(path, PATH_SIZE, "%s/%s", folder->path, name) < PATH_SIZE
               ? 0
               : error_set(err, ERROR_INPUT, "the path %.100s... is too long", folder->path);
}

/* Reads the first bytes of a file; "" where it cannot be read. */
static void read_head(const char *path, char head[HEAD_SIZE]) {
    FILE *file = fopen(path, "rb");
    size_t size = file != NULL ? fread(head, 1, HEAD_SIZE - 1, file) : 0;
    head[size] = '\0';
    if (file != NULL)
        (void)fclose(file);
}

static void copy_text(const cJSON *object, const char *key, char *out, size_t size) {
    const char *text = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(object, key));
    if (text != NULL)
        snprintf(out, size, "%s", text);
}

/* Reads who holds the folder from the head of curves.json: all before its kind. */
static void read_curves_head(const char *path, struct holder *out) {
    char head[HEAD_SIZE];
    cJSON *object = NULL;
    struct error ignored;
    read_head(path, head);
    char *end = strstr(head, ",\"kind\":");
    if (strncmp(head, "{\"study\":", 9) != 0 || end == NULL)
        return;
    end[0] = '}';
    end[1] = '\0';
    if (json_parse(head, strlen(head), NULL, &object, &ignored) != 0)
        return;
    copy_text(object, "study", out->id, sizeof out->id);
    copy_text(object, "name", out->name, sizeof out->name);
    cJSON_Delete(object);
}

static int read_holder(const struct result_folder *folder, struct holder *out, struct error *err) {
    char path[PATH_SIZE], *text = NULL;
    size_t size = 0;
    struct error ignored;
    *out = (struct holder){0};
    int status = path_in(folder, "curves.json", path, err);
    if (status != 0)
        return status;
    read_curves_head(path, out);
    status = path_in(folder, "study.json", path, err);
    if (status == 0 && whole_file_read(path, JSON_LIMITS.bytes, &text, &size, &ignored) == 0 &&
        json_parse(text, size, NULL, &out->document, &ignored) != 0)
        out->document = NULL;
    free(text);
    return status;
}

static bool is_theory(const char *id) {
    return strcmp(id, FOLDER_OF_THEORY) == 0;
}

/* The same study has the same id, or in another store the same document. */
static bool is_of(const struct holder *holder, const char *id, const cJSON *document) {
    if (holder->id[0] == '\0')
        return true;
    if (is_theory(holder->id) != is_theory(id))
        return false;
    return (!is_theory(id) && strcmp(holder->id, id) == 0) ||
           (holder->document != NULL && cJSON_Compare(holder->document, document, true));
}

static int refuse(const struct result_folder *folder, const struct holder *holder,
                  struct error *err) {
    bool theory = is_theory(holder->id);
    return error_set(err, ERROR_INPUT,
                     "folder %.200s holds the %s of another study, \"%s\"%s%s; name another folder "
                     "by --out, or add --replace",
                     folder->path, theory ? "theories" : "results", holder->name,
                     theory ? "" : ", id ", theory ? "" : holder->id);
}

int result_folder_check(const struct result_folder *folder, const char *id, const cJSON *document,
                        struct error *err) {
    struct holder holder;
    if (folder->path == NULL || folder->replace)
        return 0;
    int status = read_holder(folder, &holder, err);
    if (status == 0 && !is_of(&holder, id, document))
        status = refuse(folder, &holder, err);
    cJSON_Delete(holder.document);
    return status;
}

/* Whether a file is a picture of a study: its metadata, in the first lines, begin with the id. */
static bool is_picture_of(const char *path, const char *id) {
    char head[HEAD_SIZE], words[ID_SIZE + 48];
    snprintf(words, sizeof words, "<metadata>{&quot;study&quot;:&quot;%s&quot;", id);
    read_head(path, head);
    return strstr(head, words) != NULL;
}

/* Whether a file is of `rugo export` and of this study, whose id stands in its first lines: a
 * README.txt may be somebody's own. */
static bool is_exported_of(const char *name, const char *path, const char *id) {
    static const char *const NAMES[] = {"README.txt", "provenance.json", "scalars.csv",
                                        "table.csv",  "report.txt",      "report.json"};
    char head[HEAD_SIZE];
    bool named = false;
    for (size_t n = 0; n < sizeof NAMES / sizeof *NAMES; n++)
        named = named || strcmp(name, NAMES[n]) == 0;
    if (!named || strlen(id) != STUDY_ID_SIZE - 1) /* theories are not exported */
        return false;
    read_head(path, head);
    return strstr(head, id) != NULL;
}

static bool is_of_study(const char *name, const char *path, const char *id) {
    return file_ends_in(name, ".svg") ? is_picture_of(path, id) : is_exported_of(name, path, id);
}

/* Removes pictures of a study, and what `rugo export` wrote of it; curves and the document are
 * written over. */
static int remove_files(const struct result_folder *folder, const char *id, struct error *err) {
    char path[PATH_SIZE];
    int status = 0;
    DIR *list = opendir(folder->path);
    if (list == NULL)
        return error_set(err, ERROR_SYSTEM, "folder %s: %s", folder->path, strerror(errno));
    for (const struct dirent *one; status == 0 && (one = readdir(list)) != NULL;) {
        status = path_in(folder, one->d_name, path, err);
        if (status == 0 && is_of_study(one->d_name, path, id) && unlink(path) != 0)
            status = error_set(err, ERROR_SYSTEM, "%s: %s", path, strerror(errno));
    }
    (void)closedir(list);
    return status;
}

static int remove_results(const struct result_folder *folder, const char *id, struct error *err) {
    int status = remove_files(folder, id, err);
    return status == 0 ? kept_nodes_remove(folder->path, err) : status;
}

static int write_document(const struct result_folder *folder, const cJSON *document,
                          struct error *err) {
    char path[PATH_SIZE], *text = json_print_pretty(document);
    struct written_file file;
    int status =
        text != NULL ? path_in(folder, "study.json", path, err) : error_memory(err, 0, "a study");
    if (status == 0)
        status = written_file_open(&file, path, err);
    if (status == 0) {
        (void)fputs(text, file.stream); /* the file remembers a failure */
        status = written_file_close(&file, 0, err);
    }
    free(text);
    return status;
}

int result_folder_take(const struct result_folder *folder, const char *id, const cJSON *document,
                       struct error *err) {
    struct holder holder;
    if (folder->path == NULL)
        return 0;
    int status = read_holder(folder, &holder, err);
    if (status == 0 && !is_of(&holder, id, document))
        status =
            folder->replace ? remove_results(folder, holder.id, err) : refuse(folder, &holder, err);
    cJSON_Delete(holder.document);
    if (status == 0)
        status = folder_make(folder->path, err);
    return status == 0 ? write_document(folder, document, err) : status;
}
