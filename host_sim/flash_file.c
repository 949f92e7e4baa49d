/* flash_file.c - see flash_file.h. */
#include "flash_file.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "sim.h"

int flash_file_open(flash_file *flash, const char *path)
{
    memset(flash->bytes, 0xFF, sizeof flash->bytes);
    flash->path = path;
    flash->cut = false;
    flash->writes_left = -1;
    FILE *file = path != NULL ? fopen(path, "rb") : NULL;
    if (file == NULL) {
        return path == NULL || errno == ENOENT ? SIM_OK
                                               : sim_complain("%s: %s", path, strerror(errno));
    }
    const size_t n = fread(flash->bytes, 1, sizeof flash->bytes, file);
    const bool too_long = getc(file) != EOF;
    fclose(file);
    if (n != sizeof flash->bytes || too_long) {
        return sim_complain("%s: not a flash file: it must be %zu bytes long", path,
                            sizeof flash->bytes);
    }
    return SIM_OK;
}

/* The part of the file that has changed, or all of a file that is not there yet. */
static bool keep(const flash_file *flash, int sector, uint32_t offset, size_t bytes_n)
{
    if (flash->path == NULL) {
        return true;
    }
    FILE *file = fopen(flash->path, "r+b");
    if (file == NULL) {
        file = fopen(flash->path, "wb");
        sector = 0;
        offset = 0;
        bytes_n = sizeof flash->bytes;
    }
    if (file == NULL) {
        return false;
    }
    const long at = (long)sector * FLASH_FILE_SECTOR_BYTES + (long)offset;
    const uint8_t *from = &flash->bytes[0][0] + at;
    const bool good = fseek(file, at, SEEK_SET) == 0 && fwrite(from, 1, bytes_n, file) == bytes_n;
    return fclose(file) == 0 && good;
}

bool flash_file_write(flash_file *flash, int sector, uint32_t offset, const void *bytes,
                      size_t bytes_n)
{
    const uint8_t *from = bytes;
    for (size_t i = 0; i < bytes_n; i++) {
        if (i % 4 == 0 && flash->writes_left >= 0 && flash->writes_left-- == 0) {
            flash->cut = true;
        }
        if (!flash->cut) {
            flash->bytes[sector][offset + i] &= from[i];
        }
    }
    return keep(flash, sector, offset, bytes_n);
}

bool flash_file_erase(flash_file *flash, int sector)
{
    if (!flash->cut) {
        memset(flash->bytes[sector], 0xFF, FLASH_FILE_SECTOR_BYTES);
    }
    return keep(flash, sector, 0, FLASH_FILE_SECTOR_BYTES);
}
