#include "src/exchange/fmu/zip_writer.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

enum {
    LOCAL_SIGNATURE = 0x04034b50,
    DIRECTORY_SIGNATURE = 0x02014b50,
    END_SIGNATURE = 0x06054b50,
    VERSION = 20,      // of the format that it takes to read the archive
    DEFLATED = 8,      // the method
    DATE = 1 << 5 | 1, // 1980-01-01
    ZLIB_HEAD = 2,     // bytes around a stream of zlib's that an archive leaves out
    ZLIB_FRAME = ZLIB_HEAD + 4
};

// Writes the lowest `bytes` bytes of a number, the lowest first.
static void put(zip_writer *z, size_t number, int bytes)
{
    for (int i = 0; i < bytes; i++) {
        fputc((int)(number >> 8 * i & 0xff), z->stream);
    }
    z->offset += (size_t)bytes;
}

static void put_bytes(zip_writer *z, const void *bytes, size_t size)
{
    fwrite(bytes, 1, size, z->stream);
    z->offset += size;
}

// What a file's own head and its row of the directory have in common.
static void put_description(zip_writer *z, const zip_entry *e)
{
    put(z, VERSION, 2);
    put(z, 0, 2); // flags
    put(z, DEFLATED, 2);
    put(z, 0, 2); // time
    put(z, DATE, 2);
    put(z, e->check, 4);
    put(z, e->packed_size - ZLIB_FRAME, 4);
    put(z, e->size, 4);
    put(z, strlen(e->name), 2);
    put(z, 0, 2); // further fields
}

void zip_init(zip_writer *z, FILE *stream)
{
    *z = (zip_writer){.stream = stream};
}

void zip_add_packed(zip_writer *z, const zip_entry *entry)
{
    assert(z->count < ZIP_ENTRIES && entry->packed_size >= ZLIB_FRAME);
    z->entries[z->count].entry = *entry;
    z->entries[z->count].offset = z->offset;
    z->count++;

    put(z, LOCAL_SIGNATURE, 4);
    put_description(z, entry);
    put_bytes(z, entry->name, strlen(entry->name));
    put_bytes(z, entry->packed + ZLIB_HEAD, entry->packed_size - ZLIB_FRAME);
}

status zip_add(zip_writer *z, const char *name, const void *content, size_t size,
               fault *f)
{
    uLongf packed_size = compressBound(size);
    unsigned char *packed = malloc(packed_size);
    if (packed == NULL ||
        compress2(packed, &packed_size, content, size, Z_BEST_COMPRESSION) != Z_OK) {
        free(packed);
        return fault_no_memory(f);
    }
    const zip_entry entry = {name, size, (uint32_t)crc32(0, content, (uInt)size),
                             packed_size, packed};
    zip_add_packed(z, &entry);
    free(packed);
    return STATUS_OK;
}

unsigned char *zip_unpack(const zip_entry *entry)
{
    uLongf size = entry->size;
    unsigned char *content = malloc(size + 1);
    if (content == NULL ||
        uncompress(content, &size, entry->packed, entry->packed_size) != Z_OK) {
        free(content);
        return NULL;
    }
    return content;
}

void zip_finish(zip_writer *z)
{
    const size_t directory = z->offset;
    for (int i = 0; i < z->count; i++) {
        const zip_entry *e = &z->entries[i].entry;
        put(z, DIRECTORY_SIGNATURE, 4);
        put(z, VERSION, 2); // of the program that wrote it
        put_description(z, e);
        put(z, 0, 2); // comment
        put(z, 0, 2); // disk
        put(z, 0, 2); // internal attributes
        put(z, 0, 4); // external attributes
        put(z, z->entries[i].offset, 4);
        put_bytes(z, e->name, strlen(e->name));
    }

    const size_t size = z->offset - directory;
    put(z, END_SIGNATURE, 4);
    put(z, 0, 2); // disk
    put(z, 0, 2); // disk of the directory
    put(z, (size_t)z->count, 2);
    put(z, (size_t)z->count, 2);
    put(z, size, 4);
    put(z, directory, 4);
    put(z, 0, 2); // comment
}
