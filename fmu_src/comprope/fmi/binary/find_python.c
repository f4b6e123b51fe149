#define _GNU_SOURCE
#include "find_python.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char VARIABLE[] = "COMPROPE_LIBPYTHON";
enum { OLDEST = 11, NEWEST = 20, PATH_SIZE = 4096 }; /* minor versions of Python 3 that are looked for */

typedef void *(*Lookup)(void *library, const char *name);

static bool functions_of(void *library, Lookup lookup, Python *python)
{
    static const char *const NAMES[] = {
        "Py_IsInitialized", "Py_InitializeEx", "PyEval_SaveThread", "PyGILState_Ensure", "PyGILState_Release",
        "PyRun_SimpleStringFlags",
    };
    void *found[6];
    for (size_t k = 0; k < 6; k++) {
        found[k] = lookup(library, NAMES[k]);
        if (!found[k]) {
            return false;
        }
    }
    memcpy(python, found, sizeof found);
    return true;
}

_Static_assert(sizeof(Python) == 6 * sizeof(void *), "a table of six pointers");

#ifdef _WIN32

#include <windows.h>

#include <psapi.h>

static void *lookup(void *library, const char *name)
{
    return (void *)GetProcAddress(library, name);
}

static bool to_wide(const char *path, wchar_t *wide)
{
    return MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS, path, -1, wide, PATH_SIZE) > 0;
}

bool file_exists(const char *path)
{
    wchar_t wide[PATH_SIZE];
    const DWORD found = to_wide(path, wide) ? GetFileAttributesW(wide) : INVALID_FILE_ATTRIBUTES;
    return found != INVALID_FILE_ATTRIBUTES && !(found & FILE_ATTRIBUTE_DIRECTORY);
}

bool path_of_this_binary(char *path, size_t size)
{
    static const DWORD FLAGS = GET_MODULE_HANDLE_EX_FLAG_FROM_ADDRESS | GET_MODULE_HANDLE_EX_FLAG_UNCHANGED_REFCOUNT;
    wchar_t wide[PATH_SIZE];
    HMODULE own;
    if (!GetModuleHandleExW(FLAGS, (const wchar_t *)(const void *)VARIABLE, &own)) {
        return false;
    }
    const DWORD length = GetModuleFileNameW(own, wide, PATH_SIZE);
    return length && length < PATH_SIZE && WideCharToMultiByte(CP_UTF8, 0, wide, -1, path, (int)size, NULL, NULL) > 0;
}

static bool in_this_process(Python *python)
{
    HMODULE modules[1024];
    DWORD bytes = 0;
    if (!K32EnumProcessModules(GetCurrentProcess(), modules, sizeof modules, &bytes)) {
        return false;
    }
    const size_t count = bytes < sizeof modules ? bytes / sizeof *modules : 1024;
    for (size_t k = 0; k < count; k++) {
        if (functions_of(modules[k], lookup, python)) {
            return true;
        }
    }
    return false;
}

static bool load_library(const wchar_t *path, Python *python)
{
    void *library = LoadLibraryExW(path, NULL, LOAD_WITH_ALTERED_SEARCH_PATH);
    return library && functions_of(library, lookup, python);
}

/* python3*.dll in the folders of the PATH that are absolute: the present folder is no place for programs. */
static bool load_from_path(Python *python)
{
    static wchar_t folders[32768], path[PATH_SIZE];
    wchar_t *rest = folders, *end;
    if (!GetEnvironmentVariableW(L"PATH", folders, 32768)) {
        return false;
    }
    for (; rest; rest = end ? end + 1 : NULL) {
        end = wcschr(rest, L';');
        if (end) {
            *end = L'\0';
        }
        for (int minor = NEWEST; wcslen(rest) > 2 && rest[1] == L':' && minor >= OLDEST; minor--) {
            _snwprintf(path, PATH_SIZE, L"%ls\\python3%d.dll", rest, minor);
            if (GetFileAttributesW(path) != INVALID_FILE_ATTRIBUTES && load_library(path, python)) {
                return true;
            }
        }
    }
    return false;
}

bool find_python(Python *python)
{
    static wchar_t path[PATH_SIZE];
    if (in_this_process(python)) {
        return true;
    }
    if (GetEnvironmentVariableW(L"COMPROPE_LIBPYTHON", path, PATH_SIZE)) {
        return load_library(path, python);
    }
    return load_from_path(python);
}

#else

#include <dlfcn.h>
#include <unistd.h>

#ifdef __APPLE__
static const char LIBRARY[] = "libpython3.%d.dylib";
#else
static const char LIBRARY[] = "libpython3.%d.so.1.0";
#endif

bool file_exists(const char *path)
{
    return !access(path, R_OK);
}

bool path_of_this_binary(char *path, size_t size)
{
    Dl_info own;
    const int written = dladdr(VARIABLE, &own) && own.dli_fname ? snprintf(path, size, "%s", own.dli_fname) : -1;
    return written > 0 && (size_t)written < size;
}

/* Loaded for all: numpy and others look up Python's functions without naming its library. */
static bool load_library(const char *path, Python *python)
{
    void *library = dlopen(path, RTLD_NOW | RTLD_GLOBAL);
    return library && functions_of(library, dlsym, python);
}

/* The library of the first python3 in the PATH. */
static bool load_from_path(Python *python)
{
    static const char COMMAND[] =
        "python3 -I -c 'import sysconfig as s; v = s.get_config_var; "
        "print((v(\"PYTHONFRAMEWORKPREFIX\") or v(\"LIBDIR\")) + \"/\" + v(\"INSTSONAME\"))' 2>/dev/null";
    char path[PATH_SIZE] = "";
    FILE *answer = popen(COMMAND, "r");
    if (answer) {
        if (!fgets(path, sizeof path, answer)) {
            path[0] = '\0';
        }
        pclose(answer);
    }
    path[strcspn(path, "\n")] = '\0';
    return path[0] == '/' && load_library(path, python);
}

bool find_python(Python *python)
{
    char name[32];
    const char *chosen = getenv(VARIABLE);
    if (functions_of(RTLD_DEFAULT, dlsym, python)) {
        return true;
    }
    if (chosen && *chosen) {
        return load_library(chosen, python);
    }
    if (load_from_path(python)) {
        return true;
    }
    for (int minor = NEWEST; minor >= OLDEST; minor--) {
        snprintf(name, sizeof name, LIBRARY, minor);
        if (load_library(name, python)) {
            return true;
        }
    }
    return false;
}

#endif
