/* What the benches of the queue over HTTP share: plain requests on kept connections, so that it is
 * the server that is measured. */
#ifndef RUGO_TESTS_SUPPORT_HTTP_LOAD_H
#define RUGO_TESTS_SUPPORT_HTTP_LOAD_H

#include "worker/link/wire.h"
#include <arpa/inet.h>
#include <netinet/tcp.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/types.h>
#include <time.h>
#include <unistd.h>

enum { LOAD_ANSWER = 256 << 10, LOAD_REQUEST = 2 << 20 };

static inline int load_connect(uint16_t port) {
    struct sockaddr_in address = {
        .sin_family = AF_INET, .sin_port = htons(port), .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
    int on = 1, socket_file = socket(AF_INET, SOCK_STREAM, 0);
    setsockopt(socket_file, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    if (socket_file >= 0 && connect(socket_file, (struct sockaddr *)&address, sizeof address)) {
        close(socket_file);
        return -1;
    }
    return socket_file;
}

/* One POST on a kept connection; the status, or -1. answer: headers and body. */
static inline int load_post(int socket_file, const char *path, const char *body,
                            char answer[LOAD_ANSWER]) {
    static _Thread_local char request[LOAD_REQUEST];
    int size = snprintf(request, sizeof request,
                        "POST %s HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/json\r\n"
                        "Content-Length: %zu\r\n\r\n%s",
                        path, strlen(body), body);
    if (size < 0 || (size_t)size >= sizeof request ||
        send(socket_file, request, (size_t)size, MSG_NOSIGNAL) != size)
        return -1;
    for (size_t have = 0; have + 1 < LOAD_ANSWER;) {
        ssize_t got = recv(socket_file, answer + have, LOAD_ANSWER - 1 - have, 0);
        if (got <= 0)
            return -1;
        have += (size_t)got;
        answer[have] = 0;
        const char *end = strstr(answer, "\r\n\r\n"), *length = strstr(answer, "Content-Length: ");
        size_t wanted = length ? strtoul(length + 16, NULL, 10) : 0;
        if (end && (size_t)(end + 4 - answer) + wanted <= have)
            return atoi(answer + 9);
    }
    return -1;
}

static inline const char *load_behind(const char *text, const char *key) {
    const char *at = strstr(text, key);
    return at ? at + strlen(key) : "";
}

/* The message of a result, without its opening brace, token and first. */
static inline char *load_body(const struct block_result *result) {
    cJSON *message = wire_result("token", result);
    cJSON_DeleteItemFromObject(message, "token");
    cJSON_DeleteItemFromObject(message, "first");
    char *text = message ? json_print(message) : NULL;
    cJSON_Delete(message);
    if (text)
        memmove(text, text + 1, strlen(text));
    return text;
}

/* Starts the server and waits for its port; 0 when it does not come. */
static inline uint16_t load_serve(const char *database, pid_t *pid) {
    const char *program = getenv("RUGO");
    fflush(stdout); /* or the child would print it once more */
    unlink("serve.out");
    *pid = fork();
    if (*pid == 0) {
        if (freopen("serve.out", "w", stdout) && freopen("/dev/null", "w", stderr))
            execl(program ? program : "build/rugo", "rugo", "serve", "--db", database, "--listen",
                  "127.0.0.1:0", "--log-level", "warning", (char *)NULL);
        _exit(127);
    }
    unsigned port = 0;
    for (int tries = 0; tries < 500 && !port; tries++) {
        FILE *file = fopen("serve.out", "r");
        if (!file || fscanf(file, "listening on http://127.0.0.1:%u", &port) != 1)
            port = 0;
        if (file)
            fclose(file);
        nanosleep(&(struct timespec){0, 10000000}, NULL);
    }
    return (uint16_t)port;
}

#endif
