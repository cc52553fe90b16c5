/* The address by which other machines of a network reach this one. */
#ifndef RUGO_SERVER_COMMAND_OWN_ADDRESS_H
#define RUGO_SERVER_COMMAND_OWN_ADDRESS_H

enum { OWN_ADDRESS_SIZE = 64 };

/* Writes the address that this machine's name has, where it is one of its own and not loopback;
 * else the first of an interface that is neither loopback nor a bridge of containers; else
 * 127.0.0.1. */
void own_address(char address[OWN_ADDRESS_SIZE]);

#endif
