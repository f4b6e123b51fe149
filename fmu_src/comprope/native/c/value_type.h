/* How the numbers of one type of the FMI lie in the importer's arrays. */
#ifndef VALUE_TYPE_H
#define VALUE_TYPE_H

#include "variables.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct {
    enum kind kind;
    double (*load)(const void *values, size_t index);
    void (*store)(void *values, size_t index, double value);
    bool is_fmi3; /* whose variables may be arrays; the reference after the last variable is that of the time */
} ValueType;

/* For types that both versions of FMI have, under different names. */

static inline double load_double(const void *values, size_t index)
{
    return ((const double *)values)[index];
}

static inline void store_double(void *values, size_t index, double value)
{
    ((double *)values)[index] = value;
}

static inline double load_int32(const void *values, size_t index)
{
    return ((const int32_t *)values)[index];
}

static inline void store_int32(void *values, size_t index, double value)
{
    ((int32_t *)values)[index] = (int32_t)fmax(fmin(value, INT32_MAX), INT32_MIN);
}

#endif
