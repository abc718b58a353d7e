// A zip archive (APPNOTE 6.3.9, version 2.0), written from front to end: each file packed
// by deflate, dated 1980-01-01, so that the same content gives the same bytes.
#pragma once

#include <stdint.h>
#include <stdio.h>

#include "src/base/fault.h"

enum { ZIP_ENTRIES = 512 }; // files of an archive, at most

// A file, packed by zlib.
typedef struct zip_entry {
    const char *name; // with its folders, "sources/fmu.c"
    size_t size;      // of the content [bytes]
    uint32_t check;   // its CRC-32
    size_t packed_size;
    const unsigned char *packed;
} zip_entry;

typedef struct zip_writer {
    FILE *stream;
    size_t offset; // bytes written so far
    int count;
    struct {
        zip_entry entry; // whose `packed` is no longer needed
        size_t offset;
    } entries[ZIP_ENTRIES];
} zip_writer;

// Begins an archive in a stream, which keeps errors of writing to itself. Names stay the
// caller's until zip_finish.
void zip_init(zip_writer *z, FILE *stream);

// Adds a packed file; or packs a content of `size` bytes and adds it: STATUS_NO_MEMORY.
void zip_add_packed(zip_writer *z, const zip_entry *entry);
status zip_add(zip_writer *z, const char *name, const void *content, size_t size,
               fault *f);

// The content of a packed file on the heap; NULL without memory.
unsigned char *zip_unpack(const zip_entry *entry);

// Writes the directory, with which the archive ends.
void zip_finish(zip_writer *z);
