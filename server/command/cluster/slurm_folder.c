#include "server/command/cluster/slurm_folder.h"
#include "schema/hex.h"
#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

static const char *const SECRETS[] = {"tokens", "pilot.token", "place"};
enum { SECRET_COUNT = sizeof SECRETS / sizeof *SECRETS };

static int fail_file(const char *path, struct error *err) {
    return error_set(err, ERROR_SYSTEM, "%.300s: %s", path, strerror(errno));
}

int slurm_folder_file(const struct slurm_folder *folder, const char *name, char path[PATH_MAX],
                      struct error *err) {
    int length = snprintf(path, PATH_MAX, "%s/%s", folder->path, name);
    return length < PATH_MAX ? 0 : error_set(err, ERROR_INPUT, "%.200s...: too long", folder->path);
}

static int hold(struct slurm_folder *folder, struct error *err) {
    char path[PATH_MAX];
    int status = slurm_folder_file(folder, "lock", path, err);
    if (status != 0)
        return status;
    folder->lock = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    if (folder->lock < 0)
        return fail_file(path, err);
    if (flock(folder->lock, LOCK_EX | LOCK_NB) == 0)
        return 0;
    return errno == EWOULDBLOCK ? error_set(err, ERROR_STATE,
                                            "%.300s: another rugo slurm works in this folder; "
                                            "--dir names another",
                                            folder->path)
                                : fail_file(path, err);
}

int slurm_folder_open(struct slurm_folder *folder, const char *path, struct error *err) {
    folder->lock = -1;
    if (mkdir(path, 0700) != 0 && errno != EEXIST)
        return fail_file(path, err);
    if (realpath(path, folder->path) == NULL)
        return fail_file(path, err);
    for (const char *c = folder->path; *c != '\0'; c++)
        if ((unsigned char)*c < ' ' || *c == 0x7f)
            return error_set(err, ERROR_INPUT, "the folder's path has control characters");
    return hold(folder, err);
}

void slurm_folder_close(struct slurm_folder *folder) {
    if (folder->path[0] != '\0' && folder->lock >= 0)
        close(folder->lock);
    folder->path[0] = '\0';
}

static int write_text(int file, const char *text) {
    size_t left = strlen(text);
    while (left > 0) {
        ssize_t wrote = write(file, text, left);
        if (wrote < 0 && errno != EINTR)
            return -1;
        if (wrote > 0) {
            text += wrote;
            left -= (size_t)wrote;
        }
    }
    return fsync(file);
}

int slurm_folder_write(const struct slurm_folder *folder, const char *name, const char *text,
                       int secret, struct error *err) {
    char path[PATH_MAX], beside[PATH_MAX], other[64];
    snprintf(other, sizeof other, ".%.50s.new", name);
    int status = slurm_folder_file(folder, name, path, err);
    if (status == 0)
        status = slurm_folder_file(folder, other, beside, err);
    if (status != 0)
        return status;
    (void)unlink(beside); /* what a run that was killed left */
    int file = open(beside, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, secret != 0 ? 0600 : 0755);
    if (file < 0)
        return fail_file(beside, err);
    if (write_text(file, text) != 0)
        status = fail_file(beside, err);
    if (close(file) != 0 && status == 0)
        status = fail_file(beside, err);
    if (status == 0 && rename(beside, path) != 0)
        status = fail_file(path, err);
    if (status != 0)
        (void)unlink(beside);
    return status;
}

int slurm_folder_make_tokens(const struct slurm_folder *folder, struct error *err) {
    char work[65], submit[65], text[256], path[PATH_MAX];
    bool there = true;
    int status = 0;
    for (size_t s = 0; s < 2 && status == 0; s++) {
        status = slurm_folder_file(folder, SECRETS[s], path, err);
        there = there && access(path, R_OK) == 0;
    }
    if (status != 0 || there)
        return status;
    status = hex_random(work, sizeof work - 1, err);
    if (status == 0)
        status = hex_random(submit, sizeof submit - 1, err);
    if (status != 0)
        return status;
    snprintf(text, sizeof text, "work:%s\n", work);
    status = slurm_folder_write(folder, "pilot.token", text, 1, err);
    snprintf(text, sizeof text, "work:%s\nadmin:%s\n", work, submit);
    if (status == 0)
        status = slurm_folder_write(folder, "tokens", text, 1, err);
    explicit_bzero(text, sizeof text);
    return status;
}

void slurm_folder_forget(const struct slurm_folder *folder) {
    char path[PATH_MAX];
    for (size_t s = 0; s < SECRET_COUNT; s++)
        if (slurm_folder_file(folder, SECRETS[s], path, NULL) == 0)
            (void)unlink(path);
}
