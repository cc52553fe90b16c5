/* The loads, steps and meshes that `generate` is asked for. */
#ifndef RUGO_SERVER_COMMAND_MAP_GENERATE_STEPS_H
#define RUGO_SERVER_COMMAND_MAP_GENERATE_STEPS_H

#include "core/random.h"
#include "schema/study/study.h"
#include "server/command/options.h"

/* As options give them; NULL: not given. */
struct step_words {
    const char *mesh;     /* file: by its ending .msh, .inp, else VTU */
    const char *steps;    /* folder of a VTU file a load */
    const char *nodes;    /* table of nodes */
    const char *pressure; /* rising loads p/(E* h') */
    const char *model;
};
/* Rows of a table of options: those of a struct step_words that is `member` of the struct `type`.
 */
#define STEP_ROW(type, member, name, kind, field, argument, help)                                  \
    {                                                                                              \
        name, 0, kind, 0, 0, offsetof(type, member) + offsetof(struct step_words, field),          \
            argument, NULL, help                                                                   \
    }
#define STEP_OPTION_ROWS(type, member)                                                             \
    STEP_ROW(type, member, "mesh", OPTION_TEXT, mesh, "FILE.vtu|FILE.msh|FILE.inp",                \
             "write the block of the model full, meshed on the surface: for ParaView, for Gmsh, "  \
             "or as a complete model for CalculiX and Abaqus"),                                    \
        STEP_ROW(                                                                                  \
            type, member, "steps", OPTION_TEXT, steps, "DIR",                                      \
            "press the surface, and write step-1.vtu ... there, with steps.pvd for ParaView"),     \
        STEP_ROW(type, member, "nodes", OPTION_TEXT, nodes, "FILE.csv",                            \
                 "press the surface, and write gap, pressure and status of each node and load"),   \
        STEP_ROW(type, member, "pressure", OPTION_TEXT, pressure, "LIST",                          \
                 "rising loads p/(E* h') of --mesh, --steps and --nodes (of steps those of the "   \
                 "study); a mesh in VTU has the last one, with displacement, pressure, stress"),   \
        STEP_ROW(type, member, "model", OPTION_TEXT, model, "MODEL",                               \
                 "the model of the study that presses (the most complete one)")

/* Returns whether the words ask for anything. */
bool step_words_ask(const struct step_words *words);
/* Returns 0 or EXIT_USAGE, after a word on standard error. */
int step_words_check(const struct step_words *words);
/* Presses the surface z of a case as the words ask, and writes the files. */
int generate_steps(const struct step_words *words, const struct study *study, size_t case_number,
                   struct random_key key, const double *z, struct error *err);

#endif
