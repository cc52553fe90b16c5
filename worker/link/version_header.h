/* By this header of an answer a client sees that a server of Rugo made it. */
#ifndef RUGO_WORKER_LINK_VERSION_HEADER_H
#define RUGO_WORKER_LINK_VERSION_HEADER_H

#define VERSION_HEADER "Rugo-Version"

#endif
