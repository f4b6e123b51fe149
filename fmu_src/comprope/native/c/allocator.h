/* The importer's functions for memory, or C's own where it gives none. */
#ifndef MEMORY_H
#define MEMORY_H

#include <stddef.h>
#include <string.h>

typedef struct {
    void *(*take)(size_t count, size_t size);
    void (*give_back)(void *);
} Memory;

/* Bytes that are zero, or NULL. FMI asks the importer for zeros, but not every one gives them. */
static inline void *take_zeros(Memory memory, size_t bytes)
{
    void *taken = memory.take(1, bytes);
    return taken ? memset(taken, 0, bytes) : NULL;
}

#endif
