/* Protects: a file of any length up to its bound, from the disk, a pipe or the kernel, is read to
 * its last byte with a NUL behind it, and a longer one is refused by its bound. */
#include "core/file/whole_file.h"
#include "tests/support/check.h"
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

enum { MOST = 3 * WHOLE_FILE_ROOM };

static char byte_at(size_t n) {
    return (char)(n * 2654435761U >> 11);
}

static void put(int file, size_t size) {
    char *bytes = malloc(size + 1);
    assert_non_null(bytes);
    for (size_t n = 0; n < size; n++)
        bytes[n] = byte_at(n);
    for (size_t done = 0; done < size;) {
        ssize_t part = write(file, bytes + done, size - done);
        assert_true(part > 0);
        done += (size_t)part;
    }
    free(bytes);
}

static void check_text(char *text, size_t size, size_t expected) {
    assert_int_equal(size, expected);
    assert_int_equal(text[size], '\0');
    for (size_t n = 0; n < size; n++)
        if (text[n] != byte_at(n))
            fail_msg("byte %zu of %zu is another one", n, size);
    free(text);
}

/* A child writes what does not fit into a pipe. */
static int read_pipe(size_t written, char **text, size_t *size, struct error *err) {
    int ends[2], state = 0;
    assert_int_equal(pipe(ends), 0);
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        (void)close(ends[0]);
        put(ends[1], written);
        _exit(0);
    }
    (void)close(ends[1]);
    int status = whole_file_take(ends[0], "a pipe", MOST, text, size, err);
    (void)close(ends[0]);
    assert_int_equal(waitpid(child, &state, 0), child);
    return status;
}

/* Lengths at, before and behind those at which room is made. */
static void every_byte_is_read(void **state) {
    (void)state;
    static const size_t SIZES[] = {0,
                                   1,
                                   WHOLE_FILE_ROOM - 1,
                                   WHOLE_FILE_ROOM,
                                   WHOLE_FILE_ROOM + 1,
                                   WHOLE_FILE_ROOM + 2,
                                   MOST,
                                   MOST - 1};
    for (size_t s = 0; s < sizeof SIZES / sizeof *SIZES; s++) {
        char *text = NULL;
        size_t size = 7;
        int file = open("bytes", O_WRONLY | O_CREAT | O_TRUNC, 0600);
        assert_true(file >= 0);
        put(file, SIZES[s]);
        assert_int_equal(close(file), 0);
        assert_int_equal(whole_file_read("bytes", MOST, &text, &size, NULL), 0);
        check_text(text, size, SIZES[s]);
        assert_int_equal(read_pipe(SIZES[s], &text, &size, NULL), 0);
        check_text(text, size, SIZES[s]);
    }
    assert_int_equal(unlink("bytes"), 0);
}

/* The kernel says that its files have no bytes. */
static void files_of_the_kernel_are_read(void **state) {
    (void)state;
    char *text = NULL;
    size_t size = 0;
    assert_int_equal(whole_file_read("/proc/self/status", MOST, &text, &size, NULL), 0);
    assert_int_equal(strlen(text), size);
    assert_non_null(strstr(text, "test_whole_file"));
    free(text);
}

static void what_is_no_file_of_this_length_is_refused(void **state) {
    (void)state;
    struct error err = {0};
    char *text = NULL;
    size_t size = 0;
    int file = open("bytes", O_WRONLY | O_CREAT | O_TRUNC, 0600);
    assert_true(file >= 0);
    put(file, 12);
    assert_int_equal(close(file), 0);
    assert_int_equal(whole_file_read("bytes", 11, &text, &size, &err), ERROR_INPUT);
    assert_string_equal(err.text, "bytes: larger than 11 bytes");
    assert_int_equal(whole_file_read("bytes", 12, &text, &size, &err), 0);
    check_text(text, size, 12);
    assert_int_equal(whole_file_read("/dev/zero", 11, &text, &size, &err), ERROR_INPUT);
    assert_int_equal(unlink("bytes"), 0);
    assert_int_equal(whole_file_read("bytes", 12, &text, &size, &err), ERROR_INPUT);
    assert_string_equal(err.text, "bytes: No such file or directory");
    assert_int_equal(whole_file_read(".", 12, &text, &size, &err), ERROR_SYSTEM);
    assert_string_equal(err.text, ".: Is a directory");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_byte_is_read),
        cmocka_unit_test(files_of_the_kernel_are_read),
        cmocka_unit_test(what_is_no_file_of_this_length_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
