/* Protects: `rugo slurm` against programs that stand in for Slurm's. It checks the batch script and
 * the options of sbatch, and that no option can become a line of its own. It checks a study from
 * submission to table with nothing left, and the messages where Slurm is missing or refuses. The
 * real Slurm is asked by tests/system/slurm. */
#include "tests/support/check.h"
#include "tests/support/process.h"
#include "tests/support/small_studies.h"
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

/* An array is so many processes of this machine, whose numbers are in a file. */
static const char SBATCH[] =
    "#!/bin/sh\n"
    "echo \"$@\" >>sbatch.told\n"
    "[ ! -e refuse ] || { echo 'sbatch: error: no such partition' >&2; exit 1; }\n"
    "for n in $(seq ${2#--array=1-}); do\n"
    "    sh \"$3\" >>pilots.log 2>&1 & echo $! >>pilots\n"
    "done\n"
    "echo 77\n";
static const char SQUEUE[] = "#!/bin/sh\n"
                             "[ ! -e squeue.says ] || { cat squeue.says; exit 0; }\n"
                             "[ -e pilots ] || exit 0\n"
                             "for pilot in $(cat pilots); do\n"
                             "    ! kill -0 $pilot 2>/dev/null || echo RUNNING\n"
                             "done\n";
static const char SCANCEL[] = "#!/bin/sh\n"
                              "echo \"$@\" >>scancel.told\n"
                              "[ ! -e pilots ] || kill $(cat pilots) 2>/dev/null\n"
                              "exit 0\n";

static void stand_in(const char *name, const char *text) {
    char path[64];
    snprintf(path, sizeof path, "bin/%s", name);
    spit(path, text);
    assert_int_equal(chmod(path, 0755), 0);
}

static int set_up(void **state) {
    (void)state;
    char path[8192], here[4096];
    assert_non_null(getcwd(here, sizeof here));
    assert_int_equal(mkdir("bin", 0755), 0);
    stand_in("sbatch", SBATCH);
    stand_in("squeue", SQUEUE);
    stand_in("scancel", SCANCEL);
    snprintf(path, sizeof path, "%s/bin:%s", here, getenv("PATH"));
    assert_int_equal(setenv("PATH", path, 1), 0);
    spit("study.json", SEVERAL_BLOCKS);
    return 0;
}

static void check_told(const char *path, const char *text) {
    if (contains(path, text))
        return;
    char *all = slurp(path);
    print_error("\"%s\" is not in %s:\n%s\n", text, path, all);
    free(all);
    fail();
}

static void the_script_is_printed_and_kept(void **state) {
    (void)state;
    const char *const arguments[] = {
        "slurm",      "study.json",      "--print",         "--nodes",  "3",
        "--dir",      "it's 5% \"off\"", "--time",          "2:00:00",  "--partition",
        "long,short", "--account",       "friction",        "--sbatch", "--mem=2G",
        "--sbatch",   "-C \"a&b\"",      "--cpus-per-task", "4",        NULL};
    static const char *const LINES[] = {
        "#!/bin/sh\n#SBATCH --job-name=rugo-",
        "/it's 5%% \\\"off\\\"/pilot-%A_%a.log\"\n",
        "\n#SBATCH --open-mode=append\n#SBATCH --requeue\n#SBATCH --nodes=1\n",
        "\n#SBATCH --ntasks-per-node=1\n#SBATCH --cpus-per-task=4\n#SBATCH --signal=B:TERM@60\n",
        "\n#SBATCH --time=2:00:00\n#SBATCH --partition=long,short\n#SBATCH --account=friction\n",
        "\n#SBATCH --mem=2G\n#SBATCH -C \"a&b\"\n",
        "/it'\\''s 5% \"off\"/place' || exit\n",
        "' work \"$@\" --idle-exit 300 &\nworker=$!\ntrap 'kill -s TERM \"$worker\"' TERM\n",
    };
    assert_int_equal(run_rugo("print", arguments), 0);
    for (size_t l = 0; l < sizeof LINES / sizeof *LINES; l++)
        check_told("print.out", LINES[l]);
    char *printed = slurp("print.out"), *kept = slurp("it's 5% \"off\"/pilots.sh");
    assert_string_equal(printed, kept);
    free(printed);
    free(kept);
    assert_int_not_equal(access("sbatch.told", F_OK), 0);
    assert_int_not_equal(access("it's 5% \"off\"/rugo.db", F_OK), 0);
}

static void the_command_as_a_job_is_itself_again(void **state) {
    (void)state;
    static const char *const LINES[] = {
        "#!/bin/sh\n#SBATCH --job-name=rugo-",
        "/inside/inside.log\"\n#SBATCH --open-mode=append\n#SBATCH --requeue\n",
        "\n#SBATCH --signal=B:TERM@120\n#SBATCH --time=1-0\n#SBATCH --partition=long\nexec '/",
        " slurm --nodes='3' ",
        " --sbatch='--mem=2G' --sbatch='--comment=it'\\''s' ",
        " --set='seed=9' --out='results' --replace --dir='inside' --lease='60' -- 'study.json'\n",
        "\n#SBATCH --mem=2G\n#SBATCH --comment=it's\n#SBATCH --ntasks=1\n",
    };
    assert_int_equal(
        run_rugo("inside",
                 (const char *[]){"slurm", "study.json", "--print",  "--nodes",  "3",
                                  "--dir", "inside",     "--inside", "1-0",      "--partition",
                                  "long",  "--sbatch",   "--mem=2G", "--sbatch", "--comment=it's",
                                  "--set", "seed=9",     "--out",    "results",  "--replace",
                                  NULL}),
        0);
    for (size_t l = 0; l < sizeof LINES / sizeof *LINES; l++)
        check_told("inside.out", LINES[l]);
    char *kept = slurp("inside/inside.sh");
    assert_null(strstr(kept, "--inside"));
    assert_null(strstr(kept, "--print"));
    char *printed = slurp("inside.out"); /* that of the pilots is not printed */
    assert_string_equal(printed, kept);
    free(printed);
    free(kept);
}

static void several_processes_are_started_by_srun(void **state) {
    (void)state;
    assert_int_equal(run_rugo("srun", (const char *[]){"slurm", "study.json", "--print", "--dir",
                                                       "srun", "--tasks-per-node", "2", NULL}),
                     0);
    check_told("srun.out", "\n#SBATCH --signal=TERM@60\n");
    check_told("srun.out", "\nsrun --ntasks=2 --cpus-per-task=1 --kill-on-bad-exit=0 '/");
    check_told("srun.out", "\nworker=$!\ntrap : TERM\n");
}

static void no_option_becomes_a_line_of_its_own(void **state) {
    (void)state;
    static const struct {
        const char *option, *value, *told;
    } WRONG[] = {
        {"--partition", "a\n#SBATCH --uid=0", "--partition has characters other than"},
        {"--time", "1 --uid=0", "--time has characters other than"},
        {"--account", "", "--account has characters other than"},
        {"--sbatch", "--mem=1\nrm -rf /", "on one line"},
        {"--sbatch", "mem=1", "takes an option of sbatch"},
        {"--inside", "1\n2", "--inside takes a time as of sbatch"},
        {"--program", "/bin/a\nb", "--program has control characters"},
        {"--nodes", "0", "--nodes 0 is not a whole number in"},
    };
    for (size_t w = 0; w < sizeof WRONG / sizeof *WRONG; w++) {
        assert_int_equal(
            run_rugo("wrong", (const char *[]){"slurm", "study.json", "--print", "--dir", "wrong",
                                               WRONG[w].option, WRONG[w].value, NULL}),
            2);
        check_told("wrong.err", WRONG[w].told);
    }
    assert_int_equal(run_rugo("relative", (const char *[]){"slurm", "study.json", "--print",
                                                           "--program", "rugo", NULL}),
                     2);
    check_told("relative.err", "--program rugo is not an absolute path");
}

/* Compares files of curves but for their comments, which have hosts and times. */
static void check_same_curves(const char *one, const char *other) {
    char *a = slurp(one), *b = slurp(other);
    const char *rest_a = a, *rest_b = b;
    while (*rest_a == '#')
        rest_a = strchr(rest_a, '\n') + 1;
    while (*rest_b == '#')
        rest_b = strchr(rest_b, '\n') + 1;
    assert_true(strlen(rest_a) > 1000);
    assert_string_equal(rest_a, rest_b);
    free(a);
    free(b);
}

static void a_study_runs_from_submission_to_table(void **state) {
    (void)state;
    static const char *const SECRETS[] = {"work/tokens", "work/pilot.token", "work/place"};
    assert_int_equal(
        run_rugo("reference", (const char *[]){"run", "study.json", "--db", "reference.db", "--out",
                                               "reference", NULL}),
        0);
    assert_int_equal(
        run_rugo("slurm", (const char *[]){"slurm", "study.json", "--nodes", "2", "--dir", "work",
                                           "--listen", "127.0.0.1", "--out", "got", NULL}),
        0);
    check_same_curves("reference/curves.csv", "got/curves.csv");
    check_told("slurm.out", "(done)");
    check_told("sbatch.told", "--parsable --array=1-2 /");
    check_told("scancel.told", "--name=rugo-");
    check_told("pilots.log", "worker=");
    for (size_t s = 0; s < sizeof SECRETS / sizeof *SECRETS; s++)
        assert_int_not_equal(access(SECRETS[s], F_OK), 0);
    assert_int_equal(remove("sbatch.told"), 0);
    /* done already: nothing is submitted, and the table is there again */
    assert_int_equal(
        run_rugo("again", (const char *[]){"slurm", "study.json", "--dir", "work", NULL}), 0);
    check_told("again.out", "(done)");
    assert_int_not_equal(access("sbatch.told", F_OK), 0);
}

static void what_slurm_refuses_is_told(void **state) {
    (void)state;
    const char *const arguments[] = {"slurm",    "study.json", "--dir", "refused",
                                     "--listen", "127.0.0.1",  NULL};
    spit("refuse", "");
    assert_int_equal(run_rugo("refused", arguments), 1);
    check_told("refused.err", "sbatch ended with status 1: sbatch: error: no such partition");
    assert_int_equal(remove("refuse"), 0);
    assert_int_equal(rename("bin/squeue", "bin/hidden"), 0);
    assert_int_equal(run_rugo("missing", arguments), 1);
    assert_int_equal(rename("bin/hidden", "bin/squeue"), 0);
    check_told("missing.err", "squeue");
}

static void a_folder_is_of_one_command(void **state) {
    (void)state;
    assert_int_equal(mkdir("held", 0700), 0);
    int lock = open("held/lock", O_RDWR | O_CREAT, 0600);
    assert_true(lock >= 0 && flock(lock, LOCK_EX) == 0);
    assert_int_equal(
        run_rugo("held", (const char *[]){"slurm", "study.json", "--dir", "held", NULL}), 1);
    check_told("held.err", "another rugo slurm works in this folder");
    close(lock);
}

static void pilots_follow_the_queue(void **state) {
    (void)state;
    char url[64], token[] = "work:0123456789abcdef\nadmin:abcdef0123456789\n";
    const char *keeper[] = {"slurm", "pilots", "--server", url, "--token-file", "tokens", "--max",
                            "2",     "--once", "--idle",   "3", "--dir",        "kept",   NULL};
    struct process server;
    spit("tokens", token);
    assert_int_equal(chmod("tokens", 0600), 0);
    (void)remove("pilots");
    (void)remove("sbatch.told");
    unsigned port = serve_start(&server, (const char *[]){"--token-file", "tokens", NULL});
    snprintf(url, sizeof url, "http://127.0.0.1:%u", port);
    assert_int_equal(run_rugo("none", keeper), 0);
    assert_int_not_equal(access("sbatch.told", F_OK), 0);
    assert_int_equal(run_rugo("submit", (const char *[]){"submit", "study.json", "--server", url,
                                                         "--token-file", "tokens", NULL}),
                     0);
    /* two that end and will start again, as their seconds say */
    spit("squeue.says", "COMPLETING 0:00\nCOMPLETING 0:00\n");
    assert_int_equal(run_rugo("requeued", keeper), 0);
    assert_int_not_equal(access("sbatch.told", F_OK), 0);
    assert_int_equal(remove("squeue.says"), 0);
    assert_int_equal(run_rugo("two", keeper), 0);
    check_told("sbatch.told", "--array=1-2 /");
    char *id = slurp("submit.out");
    id[strcspn(id, "\n")] = '\0';
    const char *const wait[] = {"wait", "--server", url, "--token-file", "tokens", "--timeout",
                                "10",   id,         NULL};
    /* where a busy machine had them idle before they got a job, others follow */
    for (int tries = 0; run_rugo("wait", wait) != 0; tries++) {
        assert_true(tries < 30);
        assert_int_equal(run_rugo("two", keeper), 0);
    }
    assert_int_equal(remove("sbatch.told"), 0);
    free(id);
    /* pilots end when idle, and there is no work for others */
    for (int tries = 0; system("[ -z \"$(squeue)\" ]") != 0; tries++) { // NOLINT(cert-env33-c)
        assert_true(tries < 2400);
        sleep_ms(50);
    }
    assert_int_equal(run_rugo("idle", keeper), 0);
    assert_int_not_equal(access("sbatch.told", F_OK), 0);
    process_kill(&server, SIGTERM);
    assert_int_equal(process_wait(&server, 15), 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_script_is_printed_and_kept),
        cmocka_unit_test(the_command_as_a_job_is_itself_again),
        cmocka_unit_test(several_processes_are_started_by_srun),
        cmocka_unit_test(no_option_becomes_a_line_of_its_own),
        cmocka_unit_test(a_study_runs_from_submission_to_table),
        cmocka_unit_test(what_slurm_refuses_is_told),
        cmocka_unit_test(a_folder_is_of_one_command),
        cmocka_unit_test(pilots_follow_the_queue),
    };
    return cmocka_run_group_tests(tests, set_up, NULL);
}
