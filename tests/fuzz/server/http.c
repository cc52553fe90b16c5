/* Bytes sent to the service as they are: the whole stack in one process, over the loopback. It ends
 * the connection, with an answer that is none of its own failures, or without one. */
#include "server/http/http.h"
#include "tests/support/fuzz/fuzz.h"
#include "worker/checker.h"
#include <arpa/inet.h>
#include <errno.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

enum { ANSWER_MS = 10 };

static struct service service;
static struct http *http;

static void start(void) {
    struct error err = {0};
    struct http_options options = {.address = "127.0.0.1", .connections = 16, .deadline_s = 5};
    /* In the folder of the run, which is the caller's to clear. */
    unlink("fuzz.db");
    unlink("fuzz.db-wal");
    unlink("fuzz.db-shm");
    if (service_open(&service, "fuzz.db", 60000, &err) != 0 ||
        http_start(&http, &service, &options, &err) != 0) {
        fprintf(stderr, "%s\n", err.text);
        abort();
    }
}

static int connect_to(uint16_t port) {
    struct sockaddr_in address = {.sin_family = AF_INET, .sin_port = htons(port)};
    struct timeval patience = {.tv_usec = 500000};
    int peer = socket(AF_INET, SOCK_STREAM, 0);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    MUST(peer >= 0);
    MUST(connect(peer, (struct sockaddr *)&address, sizeof address) == 0);
    setsockopt(peer, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    return peer;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    char answer[4096];
    size_t length = 0;
    ssize_t got = 0;
    if (http == NULL)
        start();
    int peer = connect_to(http_port(http));
    if (size > 0)
        (void)!send(peer, data, size, MSG_NOSIGNAL);
    /* Who shuts its end is taken for gone: its answer is waited for, where the request is whole. */
    (void)poll(&(struct pollfd){.fd = peer, .events = POLLIN}, 1, ANSWER_MS);
    shutdown(peer, SHUT_WR);
    /* libFuzzer's clock interrupts now and then. */
    while ((got = recv(peer, answer + length, sizeof answer - 1 - length, 0)) > 0 ||
           (got < 0 && errno == EINTR))
        if (got > 0 && (length += (size_t)got) == sizeof answer - 1)
            length = 32; /* its beginning is enough */
    /* After half a request that follows a whole one the service waits for the rest. */
    MUST(got == 0 || errno == ECONNRESET || errno == EAGAIN);
    answer[length] = 0;
    close(peer);
    if (length == 0)
        return 0;
    MUST(strncmp(answer, "HTTP/1.1 ", 9) == 0 || strncmp(answer, "HTTP/1.0 ", 9) == 0);
    long status = strtol(answer + 9, NULL, 10);
    /* 501, 505: a method or a version that there is not; 503: the server saw the shut end first, as
     * it says, but to HEAD. */
    bool head = size > 5 && memcmp(data, "HEAD ", 5) == 0;
    MUST((status >= 100 && status < 500) || status == 501 || status == 505 ||
         (status == 503 && (head || strstr(answer, "was stopped") != NULL)));
    return 0;
}
