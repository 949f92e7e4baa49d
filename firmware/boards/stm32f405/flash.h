/* flash.h - the two sectors that hold the settings: 10 and 11, 128 KB each (RM0090 section 3, table 5).
 *
 * This code runs from the same flash, which answers nobody while it works: the core stands still, for 16 us a
 * word written and 1 to 2 s a sector erased, interrupts included. They are not lost but late; bytes that
 * come in meanwhile may be (at 1 Mbaud a UART bears 10 us). So nothing is erased but at boot, and
 * nothing written but while DISARMED (settings.h).
 *
 * Where there is no flash controller (an emulator) flash reads blank and refuses to be changed: the device says
 * that settings were never saved.
 */
#ifndef LIMBER_FLASH_H
#define LIMBER_FLASH_H

#include <stdbool.h>
#include <stddef.h>

#include "hal.h"
#include "registers.h"

enum { FLASH_SECTOR_BYTES = 128 * 1024, FLASH_FIRST_SECTOR = 10 };
#define FLASH_SECTOR_10 ((reg *)0x080C0000u)
#define FLASH_SECTOR_11 ((reg *)0x080E0000u)

typedef struct {
    flash_registers *registers;
    reg *sector[HAL_FLASH_SECTORS_N];
    bool present;
    uint32_t
        errors; /* of the last write or erase: FLASH_SR_..., BSY where it did not end; 0: none */
} flash;

/* Switches the caches on, too; which is how it learns whether there is a controller. */
void flash_init(flash *f, flash_registers *registers, reg *sector0, reg *sector1);

/* As flash_read, flash_write and flash_erase of hal.h. Reading needs no controller's help. A write or an erase
 * ends with the controller locked again, unless that never ends what it does. */
void flash_read(const flash *f, int sector, uint32_t offset, void *bytes, size_t bytes_n);
bool flash_write(flash *f, int sector, uint32_t offset, const void *bytes, size_t bytes_n);
bool flash_erase(flash *f, int sector);

#endif
