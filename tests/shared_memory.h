// The memory behind all shared arrays of the program, by what the kernel says of its
// mappings.
#pragma once

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "src/base/shared_array.h"

// Chunks that several arrays have are counted once [bytes]. Asks for no memory, and calls
// nothing that a test may refuse.
static inline size_t shared_array_memory(void)
{
    enum { MOST = 1 << 22, CHUNKS = 1 << 14 };
    static char text[MOST];
    static unsigned long seen[CHUNKS];
    size_t length = 0, different = 0;
    const long file = syscall(SYS_openat, AT_FDCWD, "/proc/self/maps", O_RDONLY);
    for (long count = 1;
         count > 0 && length<MOST - 1; length += count> 0 ? (size_t)count : 0) {
        count = syscall(SYS_read, file, text + length, MOST - 1 - length);
    }
    syscall(SYS_close, file);
    text[length] = '\0';

    // each chunk is a file of its own without a name
    for (char *line = text, *end; (end = strchr(line, '\n')) != NULL; line = end + 1) {
        *end = '\0';
        unsigned long inode;
        if (strstr(line, "/dev/zero (deleted)") != NULL &&
            sscanf(line, "%*s %*s %*s %*s %lu", &inode) == 1) {
            size_t known = 0;
            seen[different] = inode;
            while (seen[known] != inode) {
                known++;
            }
            different += known == different;
        }
    }
    return different * ARRAY_CHUNK;
}
