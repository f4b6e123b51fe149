/* The variables of the model. model_variables.c, which defines them, is generated from their declarations. */
#ifndef VARIABLES_H
#define VARIABLES_H

#include <stddef.h>

enum kind { REAL, INTEGER, BOOLEAN, STRING };
enum role { PARAMETER, TUNABLE, INPUT, OUTPUT }; /* a tunable parameter may change between steps */

/* One variable; its index in VARIABLES is its value reference. An absent bound is infinite. In FMI 3.0 it is the first of
 * `elements` variables that make an array, every `stride`-th; one alone is an array of 1, and those after the first have 0. */
typedef struct {
    enum kind kind;
    enum role role;
    const char *name; /* with its role, as in "parameter sheave.mass" */
    double start, minimum, maximum;
    const char *unit;     /* with a space before it, or empty */
    const char *accepted; /* as in "0.1 to 20000 kg is accepted" */
    const char *help;
    size_t elements, stride;
} Variable;

extern const Variable VARIABLES[];
extern const size_t VARIABLE_COUNT; /* parameters, then inputs, then outputs */
extern const size_t OUTPUT_COUNT;
extern const char MODEL_NAME[];
extern const char MODEL_GUID[];  /* of FMI 2.0 */
extern const char MODEL_TOKEN[]; /* of FMI 3.0 */

#endif
