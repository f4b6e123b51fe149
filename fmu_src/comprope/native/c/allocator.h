/* Memory from the importer's functions, or from the C library where the importer gives none. */
#ifndef ALLOCATOR_H
#define ALLOCATOR_H

#include <stddef.h>
#include <string.h>

typedef struct {
    void *(*allocate)(size_t count, size_t size);
    void (*release)(void *);
} Allocator;

/* Bytes that are zero, or NULL. FMI asks the importer for zeroed memory, but not every importer zeroes it. */
static inline void *allocate_zeros(Allocator allocator, size_t bytes)
{
    void *block = allocator.allocate(1, bytes);
    return block ? memset(block, 0, bytes) : NULL;
}

#endif
