#include "server/command/own_address.h"
#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netdb.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

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

void own_address(char address[OWN_ADDRESS_SIZE]) {
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
