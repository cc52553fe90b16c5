/* Protects: files of formats that are not read are converted by the program `gwyddion` of the PATH,
 * in a folder and an environment of its own, with its version in the record; where it hangs, fails,
 * writes nonsense, takes too much memory, dies or is missing, the command says so in words; nothing
 * that it started and no file of it is left, also where the command itself is killed; and a server
 * does it only where it was asked to. The program is a script here, a new one for each test. */
#include "tests/support/check.h"
#include "tests/support/process.h"
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

/* What the scripts begin with: they answer for the version, and know the file in the tree that they
 * may return. "$1" is --convert-to-gwy=FILE then, "$2" the file. */
static void install(const char *script) {
    char text[2048], here[512];
    const char *source = getenv("RUGO_SOURCE");
    assert_non_null(getcwd(here, sizeof here));
    snprintf(text, sizeof text,
             "#!/bin/sh\n"
             "here=%s\nfixture=%s/tests/fixtures/instrument/gwyddion.gwy\n"
             "[ \"$1\" != --version ] || { echo 'Gwyddion 9.87 (2099-01-01)'; exit 0; }\n"
             "echo \"$2\" >$here/asked\nout=${1#--convert-to-gwy=}\n%s\n",
             here, source != NULL ? source : ".", script);
    spit("bin/gwyddion", text);
    assert_int_equal(chmod("bin/gwyddion", 0755), 0);
    (void)unlink("asked");
}

static int setup(void **state) {
    (void)state;
    char path[4096], here[512];
    assert_non_null(getcwd(here, sizeof here));
    assert_true(mkdir("bin", 0755) == 0 && mkdir("tmp", 0755) == 0);
    snprintf(path, sizeof path, "%s/bin:%s", here, getenv("PATH"));
    setenv("PATH", path, 1);
    snprintf(path, sizeof path, "%s/tmp", here);
    setenv("TMPDIR", path, 1);
    setenv("DISPLAY", ":77", 1);
    FILE *file = fopen("patch.al3d", "wb");
    assert_non_null(file);
    assert_int_equal(fwrite("AliconaImaging\0\r\nVersion", 1, 24, file), 24);
    assert_int_equal(fclose(file), 0);
    return 0;
}

/* The folder of the conversion is gone. */
static void expect_nothing_left(void) {
    assert_int_equal(rmdir("tmp"), 0);
    assert_int_equal(mkdir("tmp", 0755), 0);
}

static void expect_refusal(const char *line, const char *words) {
    int status = run_shell(line);
    if (status != 2 || !contains("shell.err", words)) {
        char *said = slurp("shell.err");
        fail_msg("%s: status %d, %s, not '%s'", line, status, said, words);
    }
    expect_nothing_left();
}

static const char CONVERT[] = "$RUGO convert patch.al3d map.npy";

static void files_are_converted(void **state) {
    (void)state;
    /* Neither the user's screen nor settings nor the name of the file reach it. */
    install(
        "[ -z \"$DISPLAY\" ] && [ \"$HOME\" = \"$PWD\" ] && [ \"$TMPDIR\" = \"$PWD\" ] || exit 9\n"
        "head -c 14 \"$2\" | grep -q AliconaImaging || exit 8\n"
        "mkdir .gwyddion && echo x >.gwyddion/settings && cp $fixture $out");
    assert_int_equal(run_shell(CONVERT), 0);
    assert_true(contains("shell.out", "file: patch.al3d\nbytes: 24\n"));
    assert_true(contains("shell.out", "converted: by Gwyddion 9.87 from Alicona's AL3D\n"));
    assert_true(contains("shell.out", "written: 7 by 5 points"));
    assert_true(contains("shell.out", "\nlayer: 2 'Topography' of 2\n"));
    assert_int_equal(run_shell("$RUGO convert patch.al3d map.csv"), 0);
    assert_true(contains("map.csv", "# done: layer, 2 'Topography' of 2\n"));
    assert_int_equal(run_shell("$RUGO characterise patch.al3d"), 0);
    assert_true(contains("shell.out", "bytes, layer 2 'Topography' of 2"));
    assert_true(contains("asked", "measured.al3d\n"));
    expect_nothing_left();
    assert_int_equal(run_shell("$RUGO characterise patch.al3d --format json | grep -c "
                               "'\"converted\":\"by Gwyddion 9.87 from'"),
                     0);
    assert_int_equal(run_shell("$RUGO press patch.al3d --fill"), 0);
    /* Packed, by standard input, and a layer that is none. */
    assert_int_equal(run_shell("gzip -c patch.al3d | $RUGO characterise - --name a.al3d.gz"), 0);
    assert_true(contains("asked", "measured.al3d\n"));
    expect_refusal("$RUGO convert patch.al3d map.npy --layer Error", "no layer 'Error'");
    /* An ending is cleaned before it is a name. */
    assert_int_equal(run_shell("cp patch.al3d 'a.$(x) -y' && $RUGO convert 'a.$(x) -y' map.npy"),
                     0);
    assert_true(contains("asked", "measured.xy\n"));
    expect_nothing_left();
}

/* What this program reads is not given away, nor is a picture. */
static void own_formats_are_not(void **state) {
    (void)state;
    install("cp $fixture $out");
    assert_int_equal(
        run_shell("cp \"$RUGO_SOURCE\"/tests/fixtures/instrument/gwyddion.sdf a.dat && "
                  "printf '1,2,1,3\\n2,3,3,1\\n' >a.csv && $RUGO convert a.dat b.npy && "
                  "$RUGO convert a.csv b.npy && ! test -e asked"),
        0);
    expect_refusal("printf '\\211PNG\\r\\n\\032\\n\\0\\0\\0' >a.bin; $RUGO convert a.bin b.npy",
                   "a.bin: this is a picture (PNG), which holds no heights");
    assert_int_equal(access("asked", F_OK), -1);
}

static void a_missing_program_is_named(void **state) {
    (void)state;
    (void)unlink("bin/gwyddion");
    expect_refusal("PATH=/absent $RUGO convert patch.al3d map.npy",
                   "patch.al3d: by its first bytes this is Alicona's AL3D, which is not read here; "
                   "where Gwyddion is installed (package gwyddion of Debian)");
    expect_refusal("printf '\\1\\0\\2' >a.bin; PATH=/absent $RUGO convert a.bin map.npy",
                   "a.bin: neither its first bytes nor its ending belong to a format that is read "
                   "here; where Gwyddion is installed");
    install("cp $fixture $out");
    expect_refusal("$RUGO convert patch.al3d map.npy --convert 0", "is not asked to (--convert");
    assert_int_equal(access("asked", F_OK), -1);
    expect_refusal("$RUGO convert patch.al3d map.npy --convert 1m",
                   "--convert 1m is not a number of seconds");
}

static void failures_are_reported(void **state) {
    (void)state;
    install("printf 'measured.al3d: cut \\033[31m off\\nmore' >&2; exit 3");
    expect_refusal(CONVERT, "patch.al3d: Gwyddion 9.87 cannot convert it, within 512 MiB: "
                            "measured.al3d: cut ?[31m off");
    install("kill -9 $$");
    expect_refusal(CONVERT, "patch.al3d: Gwyddion 9.87 was ended by signal 9");
    install("exit 0");
    expect_refusal(CONVERT, "patch.al3d: Gwyddion 9.87 made nothing of it");
    install("echo 1 2 3 >$out");
    expect_refusal(CONVERT, "patch.al3d: ");
    install("head -c 300 $fixture >$out");
    expect_refusal(CONVERT, "patch.al3d: ");
}

/* 512 MiB and 64 times 24 bytes of address space, in KiB; and awk, which doubles a text until it
 * has no more, is stopped there. */
static void memory_is_bounded(void **state) {
    (void)state;
#ifdef RUGO_SANITIZED
    skip(); /* address space is not bounded in a sanitizer's shadow */
#endif
    install("ulimit -v >&2; exit 1");
    expect_refusal(CONVERT, "within 512 MiB: 524289");
    install("awk 'BEGIN { text = \"x\"; while (1) text = text text }' 2>/dev/null || "
            "{ echo out of memory >&2; exit 1; }");
    expect_refusal(CONVERT, "within 512 MiB: out of memory");
}

/* Whether a process that wrote its number is still at work; one that nobody waits for yet is not.
 */
static bool is_running(const char *file) {
    char path[64], line[128], *number = slurp(file);
    bool running = false;
    snprintf(path, sizeof path, "/proc/%d/status", atoi(number));
    free(number);
    FILE *status = fopen(path, "r");
    while (status != NULL && fgets(line, sizeof line, status) != NULL)
        if (strncmp(line, "State:", 6) == 0)
            running = strchr(line, 'Z') == NULL && strchr(line, 'X') == NULL;
    if (status != NULL)
        (void)fclose(status);
    return running;
}

static void wait_for_end(const char *file) {
    for (int tries = 0; is_running(file); tries++, sleep_ms(10))
        assert_true(tries < 3000);
}

/* It waits, and so does what it has started beside it, which ignores gentle signals. */
static const char HANGS[] = "sh -c 'trap \"\" TERM HUP INT; echo $$ >'$here/second'; sleep 600; "
                            "sleep 600' &\nwhile ! [ -s $here/second ]; do sleep 0.01; done\n"
                            "echo $$ >$here/first; sleep 600; cp $fixture $out";

static void time_is_bounded(void **state) {
    (void)state;
    install(HANGS);
    expect_refusal("$RUGO convert patch.al3d map.npy --convert 1",
                   "patch.al3d: Gwyddion 9.87 took longer than the 1 s that it may take");
    wait_for_end("first");
    wait_for_end("second");
    /* What it leaves behind when it ends by itself goes too. */
    install("sh -c 'echo $$ >'$here/second'; sleep 600' &\n"
            "while ! [ -s $here/second ]; do sleep 0.01; done; cp $fixture $out");
    (void)unlink("second");
    assert_int_equal(run_shell(CONVERT), 0);
    wait_for_end("second");
    expect_nothing_left();
}

static void a_killed_command_leaves_nothing(void **state) {
    (void)state;
    struct process command;
    install(HANGS);
    (void)unlink("first");
    (void)unlink("second");
    process_start(&command, "killed", (const char *[]){"convert", "patch.al3d", "map.npy", NULL});
    wait_for_text("first", "\n");
    process_kill(&command, SIGKILL);
    assert_int_equal(process_wait(&command, 20), 128 + SIGKILL);
    wait_for_end("first");
    wait_for_end("second");
    for (int tries = 0; rmdir("tmp") != 0; tries++, sleep_ms(10))
        assert_true(tries < 3000);
    assert_int_equal(mkdir("tmp", 0755), 0);
}

static void studies_are_like_converted_files(void **state) {
    (void)state;
    install("cp $fixture $out");
    spit("like.json",
         "{\"surface\": {\"like\": {\"file\": \"patch.al3d\", \"convert\": 0}}, \"kind\": "
         "\"statistics\", \"realisations\": 2}");
    expect_refusal("$RUGO check like.json", "is not asked to (--convert");
    assert_int_equal(access("asked", F_OK), -1);
    spit("like.json", "{\"surface\": {\"like\": {\"file\": \"patch.al3d\", \"fill\": true}}, "
                      "\"kind\": \"statistics\", \"realisations\": 2}");
    (void)run_shell("$RUGO check like.json"); /* 7 x 5 heights may be too few to fit */
    assert_int_equal(access("asked", F_OK), 0);
    expect_nothing_left();
}

static int post_file(unsigned port, char **answer) {
    static const char FILE_BYTES[] = "AliconaImaging\0\r\nVersion";
    static const char HEAD[] =
        "POST /v1/characterise?name=patch.al3d HTTP/1.1\r\nHost: localhost\r\n"
        "Content-Type: application/octet-stream\r\nConnection: close\r\n"
        "Content-Length: 24\r\n\r\n";
    char bytes[sizeof HEAD + sizeof FILE_BYTES];
    memcpy(bytes, HEAD, sizeof HEAD - 1);
    memcpy(bytes + sizeof HEAD - 1, FILE_BYTES, sizeof FILE_BYTES - 1);
    *answer = http_raw(port, bytes, sizeof HEAD - 1 + 24);
    return atoi(*answer + strlen("HTTP/1.1 "));
}

static void servers_convert_when_asked_to(void **state) {
    (void)state;
    struct process server;
    char *answer;
    install("cp $fixture $out");
    unsigned port = serve_start(&server, (const char *[]){"--db", "closed.db", NULL});
    assert_int_equal(post_file(port, &answer), 422);
    assert_non_null(strstr(answer, "by its first bytes this is Alicona's AL3D"));
    assert_non_null(strstr(answer, "of rugo serve"));
    free(answer);
    assert_int_equal(access("asked", F_OK), -1);
    process_kill(&server, SIGTERM);
    assert_int_equal(process_wait(&server, 20), 0);
    port = serve_start(&server, (const char *[]){"--db", "open.db", "--convert", NULL});
    assert_int_equal(post_file(port, &answer), 200);
    assert_non_null(strstr(answer, "by Gwyddion 9.87 from Alicona's AL3D"));
    free(answer);
    expect_nothing_left();
    /* A client that goes ends the conversion with all that it started. */
    install(HANGS);
    (void)unlink("first");
    (void)unlink("second");
    static const char GOES[] =
        "POST /v1/characterise?name=a.al3d HTTP/1.1\r\nHost: localhost\r\n"
        "Content-Type: application/octet-stream\r\nContent-Length: 17\r\n\r\n"
        "AliconaImaging\0\r\n";
    int client = http_connect(port);
    assert_int_equal(send(client, GOES, sizeof GOES - 1, MSG_NOSIGNAL), sizeof GOES - 1);
    wait_for_text("first", "\n");
    (void)close(client);
    wait_for_end("first");
    wait_for_end("second");
    process_kill(&server, SIGTERM);
    assert_int_equal(process_wait(&server, 20), 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(files_are_converted),
        cmocka_unit_test(own_formats_are_not),
        cmocka_unit_test(a_missing_program_is_named),
        cmocka_unit_test(failures_are_reported),
        cmocka_unit_test(memory_is_bounded),
        cmocka_unit_test(time_is_bounded),
        cmocka_unit_test(a_killed_command_leaves_nothing),
        cmocka_unit_test(studies_are_like_converted_files),
        cmocka_unit_test(servers_convert_when_asked_to),
    };
    return cmocka_run_group_tests(tests, setup, NULL);
}
