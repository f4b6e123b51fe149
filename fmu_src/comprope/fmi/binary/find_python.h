/* Functions of Python, and what differs between systems: files, and libraries loaded at run time. */
#ifndef FIND_PYTHON_H
#define FIND_PYTHON_H

#include <stdbool.h>
#include <stddef.h>

/* The few functions of Python's C interface that are needed; their names are the same in every version. */
typedef struct {
    int (*is_initialized)(void);
    void (*initialize)(int install_signal_handlers);
    void *(*save_thread)(void);
    int (*ensure)(void);
    void (*release)(int lock);
    int (*run)(const char *statements, void *flags);
} Python;

/* Python's functions: from this process, else from a library that is loaded; whether there is one. */
bool find_python(Python *python);

/* Whether a file of this name, in UTF-8, can be read. */
bool file_exists(const char *path);

/* The absolute path of this binary in UTF-8; whether it is known and fits. */
bool path_of_this_binary(char *path, size_t size);

#endif
