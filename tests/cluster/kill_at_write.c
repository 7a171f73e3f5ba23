/* Preloaded into the program: kills it before its n-th write to a file below a folder, n =
   CATENA_KILL_AT_WRITE, the folder's path ends with CATENA_KILL_FOLDER. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>
#include <unistd.h>

static int is_watched(int descriptor) {
    char link[64], path[4096];
    snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
    ssize_t const length = readlink(link, path, sizeof path - 1);
    if (length < 0) return 0;
    path[length] = '\0';
    return strstr(path, getenv("CATENA_KILL_FOLDER")) != NULL;
}

static void count(int descriptor) {
    static long left = -1;
    if (left < 0) left = atol(getenv("CATENA_KILL_AT_WRITE"));
    if (is_watched(descriptor) && left-- == 0) raise(SIGKILL);
}

#define COUNTED(name, parameters, arguments)                        \
    ssize_t name parameters {                                       \
        static ssize_t(*real) parameters;                           \
        if (real == NULL) *(void**)&real = dlsym(RTLD_NEXT, #name); \
        count(descriptor);                                          \
        return real arguments;                                      \
    }
COUNTED(write, (int descriptor, void const* data, size_t size), (descriptor, data, size))
COUNTED(pwrite, (int descriptor, void const* data, size_t size, off_t offset),
        (descriptor, data, size, offset))
COUNTED(pwrite64, (int descriptor, void const* data, size_t size, off_t offset),
        (descriptor, data, size, offset))
