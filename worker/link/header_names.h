/* Headers of answers by which server and client understand each other. */
#ifndef RUGO_WORKER_LINK_HEADER_NAMES_H
#define RUGO_WORKER_LINK_HEADER_NAMES_H

/* By this one a client sees that a server of Rugo made the answer: the version of its program. */
#define VERSION_HEADER "Rugo-Version"
/* A study that was found by a name: how many older ones have the same one. */
#define SAME_NAME_HEADER "Rugo-Same-Name"
/* A claim that names kinds whose results the server reads in another form than the worker makes:
 * their names, with commas between. */
#define OTHER_FORMS_HEADER "Rugo-Other-Forms"

#endif
