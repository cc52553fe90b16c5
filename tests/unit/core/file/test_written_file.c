/* Protects: what stands at a path stays there, with its mode, until another file is whole; what
 * cannot be replaced is written in place, and nothing else is left in the folder. */
#include "core/file/written_file.h"
#include "tests/support/check.h"
#include "tests/support/process.h"
#include <dirent.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#define PATH "map.csv"

static int write_file(const char *path, const char *text, int status, struct error *err) {
    struct written_file file;
    assert_int_equal(written_file_open(&file, path, err), 0);
    (void)fputs(text, file.stream);
    status = written_file_close(&file, status, err);
    assert_null(file.stream);
    return status;
}

static void check_whole(const char *path, const char *text) {
    char *read = slurp(path);
    assert_string_equal(read, text);
    free(read);
}

static int enter_folder(void **state) {
    (void)state;
    return mkdir("written", 0777) != 0 || chdir("written") != 0 ? -1 : 0;
}

/* Checks how many files there are. */
static void check_count(size_t expected) {
    DIR *folder = opendir(".");
    assert_non_null(folder);
    size_t count = 0;
    for (const struct dirent *entry; (entry = readdir(folder)) != NULL;)
        count += entry->d_name[0] != '.';
    closedir(folder);
    assert_int_equal(count, expected);
}

static void failure_leaves_what_stood_there(void **state) {
    (void)state;
    struct error err = {0};
    assert_int_equal(write_file(PATH, "old", 0, &err), 0);
    assert_int_equal(write_file(PATH, "new", ERROR_INPUT, &err), ERROR_INPUT);
    check_whole(PATH, "old");
    assert_int_equal(write_file("none.csv", "new", ERROR_MEMORY, &err), ERROR_MEMORY);
    check_count(1);
    assert_int_equal(write_file(PATH, "new", 0, &err), 0);
    check_whole(PATH, "new");
    check_count(1);
    unlink(PATH);
}

/* A limit of a file's size stands for a disk that is full. */
static void full_disk_leaves_what_stood_there(void **state) {
    (void)state;
    static char much[1 << 16];
    struct error err = {0};
    const struct rlimit limit = {1024, RLIM_INFINITY}, none = {RLIM_INFINITY, RLIM_INFINITY};
    memset(much, 'x', sizeof much - 1);
    assert_int_equal(write_file(PATH, "old", 0, &err), 0);
    signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
    int status = write_file(PATH, much, 0, &err);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &none), 0);
    assert_int_equal(status, ERROR_SYSTEM);
    assert_string_equal(err.text, "cannot write " PATH ": File too large");
    check_whole(PATH, "old");
    check_count(1);
    unlink(PATH);
}

static void part_of_a_killed_run_is_written_over(void **state) {
    (void)state;
    struct error err = {0};
    struct written_file killed;
    assert_int_equal(write_file(PATH, "old", 0, &err), 0);
    assert_int_equal(written_file_open(&killed, PATH, &err), 0);
    (void)fputs("half of a long text", killed.stream);
    (void)fflush(killed.stream);
    check_whole(PATH, "old");
    check_count(2);
    fclose(killed.stream);
    free(killed.path);
    free(killed.part);
    assert_int_equal(write_file(PATH, "new", 0, &err), 0);
    check_whole(PATH, "new");
    check_count(1);
    unlink(PATH);
}

static void mode_stays(void **state) {
    (void)state;
    struct stat about;
    mode_t mask = umask(027);
    assert_int_equal(write_file(PATH, "old", 0, NULL), 0);
    umask(mask);
    assert_int_equal(stat(PATH, &about), 0);
    assert_int_equal(about.st_mode & 07777, 0640);
    assert_int_equal(chmod(PATH, 0604), 0);
    assert_int_equal(write_file(PATH, "new", 0, NULL), 0);
    assert_int_equal(stat(PATH, &about), 0);
    assert_int_equal(about.st_mode & 07777, 0604);
    unlink(PATH);
}

static void links_and_devices_are_written_in_place(void **state) {
    (void)state;
    struct error err = {0};
    struct stat about;
    assert_int_equal(write_file("target", "old", 0, &err), 0);
    assert_int_equal(symlink("target", "soft"), 0);
    assert_int_equal(write_file("soft", "by a link", 0, &err), 0);
    check_whole("target", "by a link");
    assert_int_equal(link("target", "hard"), 0);
    assert_int_equal(write_file("hard", "by a name", 0, &err), 0);
    check_whole("target", "by a name");
    check_count(3);
    assert_int_equal(write_file("/dev/full", "text", 0, &err), ERROR_SYSTEM);
    assert_string_equal(err.text, "cannot write /dev/full: No space left on device");
    assert_int_equal(stat("/dev/full", &about), 0);
    assert_true(S_ISCHR(about.st_mode));
    unlink("soft");
    unlink("hard");
    unlink("target");
}

static void long_name_is_written_in_place(void **state) {
    (void)state;
    char name[256];
    memset(name, 'n', sizeof name - 1);
    name[sizeof name - 1] = '\0';
    assert_int_equal(write_file(name, "long", 0, NULL), 0);
    check_whole(name, "long");
    unlink(name);
}

static void missing_folder_is_named(void **state) {
    (void)state;
    struct error err = {0};
    struct written_file file;
    assert_int_equal(written_file_open(&file, "no/such.csv", &err), ERROR_SYSTEM);
    assert_string_equal(err.text, "cannot open no/such.csv: No such file or directory");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(failure_leaves_what_stood_there),
        cmocka_unit_test(full_disk_leaves_what_stood_there),
        cmocka_unit_test(part_of_a_killed_run_is_written_over),
        cmocka_unit_test(mode_stays),
        cmocka_unit_test(links_and_devices_are_written_in_place),
        cmocka_unit_test(long_name_is_written_in_place),
        cmocka_unit_test(missing_folder_is_named),
    };
    return cmocka_run_group_tests(tests, enter_folder, NULL);
}
