/* Which servers a client believes, and what it tells to those it cannot check. */
#ifndef RUGO_WORKER_CLIENT_TRUST_H
#define RUGO_WORKER_CLIENT_TRUST_H

#include <stdbool.h>

/* All zero: those of https that an authority of the system vouches for; a token goes over TLS, or
 * to this machine, alone. */
struct client_trust {
    const char *ca_file; /* PEM: these authorities alone; NULL: the system's */
    /* "sha256:" and 64 hexadecimal digits: the server whose public key has this digest, whatever
     * its name is and whoever vouches for it; NULL: any that an authority vouches for. */
    const char *fingerprint;
    bool insecure; /* a token may cross a network in clear text */
    bool own;      /* the server is of this process: it need not be checked */
};

#endif
