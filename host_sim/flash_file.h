/* flash_file.h - two flash sectors in a file, with the manners of NOR flash: bits only clear until erased. */
#ifndef LIMBER_FLASH_FILE_H
#define LIMBER_FLASH_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { FLASH_FILE_SECTORS_N = 2, FLASH_FILE_SECTOR_BYTES = 128 * 1024 };

typedef struct {
    const char *path; /* NULL: only in memory */
    bool cut;         /* power has gone: nothing is written any more */
    long writes_left; /* until the power goes, words; -1: it stays */
    uint8_t bytes[FLASH_FILE_SECTORS_N][FLASH_FILE_SECTOR_BYTES];
} flash_file;

/* Reads the file, or starts erased where there is none. Returns SIM_OK, or complains. */
int flash_file_open(flash_file *flash, const char *path);

bool flash_file_write(flash_file *flash, int sector, uint32_t offset, const void *bytes,
                      size_t bytes_n);
bool flash_file_erase(flash_file *flash, int sector);

#endif
