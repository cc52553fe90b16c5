/* A server of few words, on a thread of the test. */
#ifndef RUGO_TESTS_UNIT_WORKER_STUB_SERVER_H
#define RUGO_TESTS_UNIT_WORKER_STUB_SERVER_H

#include <arpa/inet.h>
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>

/* Answers every request with the same bytes, in one of these manners. DRIP goes on, byte by byte,
 * until the client leaves. */
enum manner { ANSWER, ANSWER_AND_CLOSE, SILENT, DRIP, ENDLESS };
struct stub {
    enum manner manner;
    const char *answer;
    int listener;
    char url[64];
    pthread_t thread;
    /* of the thread, to be read after stub_stop */
    unsigned connections, requests;
    char request[4096]; /* the last one, headers and body */
};

/* Reads one request with its body; false when the client has gone. */
static inline bool stub_read(struct stub *stub, int peer) {
    size_t size = 0, wanted = SIZE_MAX;
    while (size < wanted) {
        ssize_t got = read(peer, stub->request + size, sizeof stub->request - 1 - size);
        if (got <= 0) {
            return false;
        }
        size += (size_t)got;
        stub->request[size] = '\0';
        const char *end = strstr(stub->request, "\r\n\r\n");
        const char *length = strstr(stub->request, "Content-Length: ");
        if (end) {
            wanted = (size_t)(end + 4 - stub->request);
            wanted += length ? strtoul(length + 16, NULL, 10) : 0;
        }
    }
    stub->requests++;
    return true;
}

static inline bool stub_write(int peer, const char *bytes, size_t size) {
    while (size > 0) {
        ssize_t sent = send(peer, bytes, size, MSG_NOSIGNAL);
        if (sent <= 0) {
            return false;
        }
        bytes += sent;
        size -= (size_t)sent;
    }
    return true;
}

/* Answers; true to go on with the connection. */
static inline bool stub_answer(const struct stub *stub, int peer) {
    static const char chunk[65536];
    char byte;
    switch (stub->manner) {
    case ANSWER:
        return stub_write(peer, stub->answer, strlen(stub->answer));
    case ANSWER_AND_CLOSE:
        (void)stub_write(peer, stub->answer, strlen(stub->answer));
        return false;
    case SILENT:
        return read(peer, &byte, 1) > 0; /* until the client has had enough */
    case DRIP:
        for (const char *next = stub->answer; stub_write(peer, *next ? next : "a", 1);) {
            next += *next != '\0';
            nanosleep(&(struct timespec){.tv_nsec = 20000000}, NULL);
        }
        return false;
    default:
        (void)stub_write(peer, stub->answer, strlen(stub->answer));
        while (stub_write(peer, chunk, sizeof chunk)) {
        }
        return false;
    }
}

static inline void *stub_main(void *context) {
    struct stub *stub = context;
    for (int peer; (peer = accept(stub->listener, NULL, NULL)) >= 0;) {
        stub->connections++;
        while (stub_read(stub, peer) && stub_answer(stub, peer)) {
        }
        close(peer);
    }
    return NULL;
}

/* A free port of the loopback, which refuses whoever connects. */
static inline int bind_any(char *url, size_t size) {
    struct sockaddr_in address = {.sin_family = AF_INET, .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
    socklen_t length = sizeof address;
    int listener = socket(AF_INET, SOCK_STREAM, 0);
    assert_true(listener >= 0);
    assert_int_equal(bind(listener, (struct sockaddr *)&address, length), 0);
    assert_int_equal(getsockname(listener, (struct sockaddr *)&address, &length), 0);
    snprintf(url, size, "http://127.0.0.1:%d", ntohs(address.sin_port));
    return listener;
}

/* The same, listened to. */
static inline int listen_any(char *url, size_t size) {
    int listener = bind_any(url, size);
    assert_int_equal(listen(listener, 8), 0);
    return listener;
}

static inline void stub_start(struct stub *stub) {
    stub->listener = listen_any(stub->url, sizeof stub->url);
    assert_int_equal(pthread_create(&stub->thread, NULL, stub_main, stub), 0);
}

static inline void stub_stop(struct stub *stub) {
    shutdown(stub->listener, SHUT_RDWR);
    pthread_join(stub->thread, NULL);
    close(stub->listener);
}

#endif
