#include "server/command/cluster/slurm_server.h"
#include "server/command/command.h"
#include "server/command/input_file.h"
#include "server/http/guard/self_signed.h"
#include "worker/clock.h"
#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netdb.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

/* The address by which other machines of a network reach this one. */

enum { OWN_ADDRESS_SIZE = 64 };

static bool is_bridge(const char *name) {
    static const char *const BRIDGES[] = {"docker", "virbr", "br-", "veth", "cni", "podman"};
    for (size_t b = 0; b < sizeof BRIDGES / sizeof *BRIDGES; b++)
        if (strncmp(name, BRIDGES[b], strlen(BRIDGES[b])) == 0)
            return true;
    return false;
}

/* Writes the IPv4 address of an interface; false where others cannot reach it. */
static bool address_of(const struct ifaddrs *entry, char address[OWN_ADDRESS_SIZE]) {
    if (entry->ifa_addr == NULL || entry->ifa_addr->sa_family != AF_INET ||
        (entry->ifa_flags & IFF_LOOPBACK) != 0 || (entry->ifa_flags & IFF_UP) == 0)
        return false;
    return getnameinfo(entry->ifa_addr, sizeof(struct sockaddr_in), address, OWN_ADDRESS_SIZE, NULL,
                       0, NI_NUMERICHOST) == 0;
}

/* Writes the address that the name of this machine has. */
static bool address_of_name(char address[OWN_ADDRESS_SIZE]) {
    const struct addrinfo hints = {.ai_family = AF_INET, .ai_socktype = SOCK_STREAM};
    struct addrinfo *found = NULL;
    char name[256] = "";
    if (gethostname(name, sizeof name - 1) != 0 || getaddrinfo(name, NULL, &hints, &found) != 0)
        return false;
    bool written = getnameinfo(found->ai_addr, found->ai_addrlen, address, OWN_ADDRESS_SIZE, NULL,
                               0, NI_NUMERICHOST) == 0;
    freeaddrinfo(found);
    return written;
}

/* Writes the address that this machine's name has, where it is one of its own and not loopback;
 * else the first of an interface that is neither loopback nor a virtual one of containers; else
 * 127.0.0.1. */
static void own_address(char address[OWN_ADDRESS_SIZE]) {
    char named[OWN_ADDRESS_SIZE] = "", own[OWN_ADDRESS_SIZE], first[OWN_ADDRESS_SIZE] = "";
    struct ifaddrs *all = NULL;
    bool is_own = false;
    if (getifaddrs(&all) != 0)
        all = NULL;
    bool has_name = address_of_name(named);
    for (const struct ifaddrs *entry = all; entry != NULL; entry = entry->ifa_next) {
        if (!address_of(entry, own))
            continue;
        is_own = is_own || (has_name && strcmp(own, named) == 0);
        if (first[0] == '\0' && !is_bridge(entry->ifa_name))
            memcpy(first, own, sizeof first);
    }
    freeifaddrs(all);
    const char *best = is_own ? named : first[0] != '\0' ? first : "127.0.0.1";
    snprintf(address, OWN_ADDRESS_SIZE, "%s", best);
}

#define TLS "tls" /* folder of the certificate */

enum { VALID_DAYS = 3650, URL_SIZE = 128, START_MS = 20000, STOP_MS = 10000, PLACE_MOST = 1 << 16 };

/* What is in a child between fork and exec: nothing that allocates. Ctrl-C does not reach it. Where
 * the command is a job itself, Slurm sends SIGTERM to all of its processes: the server stays until
 * pilots have handed in, and is ended by SIGINT. */
static void become(const char *const *arguments, const char *out, const char *log, pid_t parent) {
    static const int APPEND = O_WRONLY | O_CREAT | O_APPEND, ANEW = O_WRONLY | O_CREAT | O_TRUNC;
    int none = open("/dev/null", O_RDONLY), printed = open(out, ANEW, 0600),
        said = open(log, APPEND, 0600);
    sigset_t term;
    sigemptyset(&term);
    sigaddset(&term, SIGTERM);
    setpgid(0, 0);
    if (none < 0 || printed < 0 || said < 0 || dup2(none, STDIN_FILENO) < 0 ||
        dup2(printed, STDOUT_FILENO) < 0 || dup2(said, STDERR_FILENO) < 0 ||
        sigprocmask(SIG_BLOCK, &term, NULL) != 0 || prctl(PR_SET_PDEATHSIG, SIGINT) != 0 ||
        getppid() != parent)
        _exit(EXIT_FAILED);
    execv("/proc/self/exe", (char *const *)arguments);
    _exit(EXIT_FAILED);
}

static void sleep_ms(long ms) {
    const struct timespec pause = {ms / 1000, ms % 1000 * 1000000L};
    nanosleep(&pause, NULL);
}

/* Reads the address that a server prints once it listens; false where it has not yet. */
static bool read_url(const char *out, char url[URL_SIZE]) {
    static const char BEFORE[] = "listening on ";
    char line[URL_SIZE];
    FILE *file = fopen(out, "r");
    bool found = file != NULL && fgets(line, sizeof line, file) != NULL &&
                 strncmp(line, BEFORE, sizeof BEFORE - 1) == 0 && strchr(line, '\n') != NULL;
    if (found) {
        line[strcspn(line, "\n")] = '\0';
        snprintf(url, URL_SIZE, "%s", line + sizeof BEFORE - 1);
    }
    if (file != NULL)
        (void)fclose(file);
    return found;
}

bool slurm_server_has_ended(struct slurm_server *server) {
    int state;
    if (server->pid != 0 && waitpid(server->pid, &state, WNOHANG) == server->pid)
        server->pid = 0;
    return server->pid == 0;
}

static int wait_for_url(struct slurm_server *server, const char *out, const char *log,
                        char url[URL_SIZE], struct error *err) {
    int64_t until_ms = clock_ms() + START_MS;
    while (!read_url(out, url)) {
        if (slurm_server_has_ended(server))
            return error_set(err, ERROR_SYSTEM, "the server did not start; see %.300s", log);
        if (clock_ms() >= until_ms) {
            slurm_server_stop(server);
            return error_set(err, ERROR_SYSTEM, "the server does not listen; see %.300s", log);
        }
        sleep_ms(50);
    }
    return 0;
}

static int start_at(struct slurm_server *server, const char *listen, char url[URL_SIZE],
                    struct error *err) {
    char tokens[PATH_MAX], certificate[PATH_MAX], key[PATH_MAX], out[PATH_MAX], log[PATH_MAX];
    char lease[16];
    int status = slurm_folder_file(server->folder, "tokens", tokens, err);
    if (status == 0)
        status = slurm_folder_file(server->folder, TLS "/" CERTIFICATE_FILE, certificate, err);
    if (status == 0)
        status = slurm_folder_file(server->folder, TLS "/" KEY_FILE, key, err);
    if (status == 0)
        status = slurm_folder_file(server->folder, "server.out", out, err);
    if (status == 0)
        status = slurm_folder_file(server->folder, "server.log", log, err);
    if (status != 0)
        return status;
    snprintf(lease, sizeof lease, "%u", server->lease_s);
    const char *const arguments[] = {"rugo",         "serve", "--db",       server->database,
                                     "--listen",     listen,  "--lease",    lease,
                                     "--token-file", tokens,  "--tls-cert", certificate,
                                     "--tls-key",    key,     NULL};
    pid_t parent = getpid();
    (void)unlink(out);
    server->pid = fork();
    if (server->pid < 0) {
        server->pid = 0;
        return error_set(err, ERROR_SYSTEM, "cannot start the server: %s", strerror(errno));
    }
    if (server->pid == 0)
        become(arguments, out, log, parent);
    return wait_for_url(server, out, log, url, err);
}

/* Returns the port of the address that an earlier run left in "place"; 0: none. */
static unsigned long earlier_port(const struct slurm_server *server) {
    char path[PATH_MAX], *text = NULL;
    size_t size = 0;
    unsigned long port = 0;
    if (slurm_folder_file(server->folder, "place", path, NULL) != 0 || access(path, R_OK) != 0 ||
        input_file_read(path, PLACE_MOST, &text, &size, NULL) != 0)
        return 0;
    const char *url = strstr(text, "://"), *end = url != NULL ? strchr(url, '\n') : NULL;
    const char *colon = end != NULL ? memrchr(url, ':', (size_t)(end - url)) : NULL;
    if (colon != NULL)
        port = strtoul(colon + 1, NULL, 10);
    free(text);
    return port < 65536 ? port : 0;
}

/* Makes a certificate where an earlier run left none, and reads its fingerprint. */
static int find_certificate(const struct slurm_server *server, char fingerprint[FINGERPRINT_SIZE],
                            struct error *err) {
    static const char *const NAMES[] = {NULL};
    char folder[PATH_MAX], file[PATH_MAX];
    int status = slurm_folder_file(server->folder, TLS, folder, err);
    if (status == 0)
        status = slurm_folder_file(server->folder, TLS "/" CERTIFICATE_FILE, file, err);
    if (status != 0)
        return status;
    if (access(file, R_OK) == 0)
        return certificate_file_fingerprint(file, fingerprint, err);
    return self_signed_make(folder, NAMES, VALID_DAYS, fingerprint, err);
}

/* Writes for pilots where the server is and what they need to be let in. */
static int write_place(const struct slurm_server *server, const char *url, const char *fingerprint,
                       struct error *err) {
    char token[PATH_MAX], text[PATH_MAX + 3 * URL_SIZE];
    int status = slurm_folder_file(server->folder, "pilot.token", token, err);
    if (status != 0)
        return status;
    snprintf(text, sizeof text, "--server\n%s\n--fingerprint\n%s\n--token-file\n%s\n", url,
             fingerprint, token);
    return slurm_folder_write(server->folder, "place", text, 1, err);
}

int slurm_server_start(struct slurm_server *server, struct error *err) {
    char own[OWN_ADDRESS_SIZE], listen[OWN_ADDRESS_SIZE + 16], url[URL_SIZE];
    char fingerprint[FINGERPRINT_SIZE];
    unsigned long port = earlier_port(server);
    int status = slurm_folder_make_tokens(server->folder, err);
    if (status == 0)
        status = find_certificate(server, fingerprint, err);
    if (status != 0)
        return status;
    if (server->address != NULL)
        snprintf(own, sizeof own, "%s", server->address);
    else
        own_address(own);
    bool v6 = strchr(own, ':') != NULL && own[0] != '[';
    for (bool again = true; again; port = 0) {
        snprintf(listen, sizeof listen, v6 ? "[%s]:%lu" : "%s:%lu", own, port);
        status = start_at(server, listen, url, err);
        again = status != 0 && port != 0;
    }
    return status != 0 ? status : write_place(server, url, fingerprint, err);
}

void slurm_server_stop(struct slurm_server *server) {
    if (slurm_server_has_ended(server))
        return;
    kill(server->pid, SIGINT);
    for (int64_t until_ms = clock_ms() + STOP_MS; !slurm_server_has_ended(server);) {
        if (clock_ms() >= until_ms)
            kill(server->pid, SIGKILL);
        sleep_ms(20);
    }
}
