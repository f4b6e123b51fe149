/* Reading and setting variables by value reference, all or none; all must be of one type. See instance.h for the
 * conventions. */
#ifndef VALUES_H
#define VALUES_H

#include "instance.h"
#include "variables.h"

#include <stddef.h>

/* A type of the FMI: its variables, and how its numbers lie in the importer's array. */
typedef struct {
    enum kind kind;
    double (*load)(const void *values, size_t index);
    void (*store)(void *values, size_t index, double value);
    bool reads_time; /* the reference after the last variable is that of the time */
} ValueType;

int get_values(void *component, const ValueType *type, const unsigned references[], size_t count, void *values,
               size_t value_count);
int set_values(void *component, const ValueType *type, const unsigned references[], size_t count, const void *values,
               size_t value_count);

/* For types that both versions of FMI have, under different names. */
double load_double(const void *values, size_t index);
void store_double(void *values, size_t index, double value);
double load_int32(const void *values, size_t index);
void store_int32(void *values, size_t index, double value);

#endif
