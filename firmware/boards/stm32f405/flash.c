/* flash.c - see flash.h. */
#include "flash.h"

#include <string.h>

static const uint32_t KEYS[2] = {0x45670123, 0xCDEF89AB}; /* RM0090 3.6.1 */

enum {
    ERRORS = FLASH_SR_OPERR | FLASH_SR_WRPERR | FLASH_SR_PGAERR | FLASH_SR_PGPERR | FLASH_SR_PGSERR,
    CACHES = FLASH_ACR_PRFTEN | FLASH_ACR_ICEN | FLASH_ACR_DCEN,
    /* Of 8 cycles of 168 MHz or more: 10 ms and 4 s, where the data sheet has 0.1 ms and 2 s at most. They count
     * only what the core gets to poll: what stalls it for ever is the watchdog's. */
    WRITE_POLLS_N = 210 * 1000,
    ERASE_POLLS_N = 84 * 1000 * 1000,
};

void flash_init(flash *f, flash_registers *registers, reg *sector0, reg *sector1)
{
    *f = (flash){.registers = registers, .sector = {sector0, sector1}};
    reg_set(&registers->acr, CACHES);
    f->present = (reg_read(&registers->acr) & CACHES) == CACHES;
}

static bool within(int sector, uint32_t offset, size_t bytes_n)
{
    return sector >= 0 && sector < HAL_FLASH_SECTORS_N && offset <= FLASH_SECTOR_BYTES &&
           bytes_n <= FLASH_SECTOR_BYTES - offset;
}

void flash_read(const flash *f, int sector, uint32_t offset, void *bytes, size_t bytes_n)
{
    if (!f->present || !within(sector, offset, bytes_n)) {
        memset(bytes, 0xFF, bytes_n);
        return;
    }
    memcpy(bytes, (const uint8_t *)f->sector[sector] + offset, bytes_n);
}

/* Waits for the end of what is under way; keeps its errors in *f, and clears them (3.8.4: by writing 1). */
static bool finish(flash *f, int polls_n)
{
    uint32_t status;
    do {
        status = reg_read(&f->registers->sr);
    } while ((status & FLASH_SR_BSY) != 0 && --polls_n > 0);
    f->errors = status & (ERRORS | FLASH_SR_BSY);
    if ((status & FLASH_SR_BSY) == 0) {
        reg_write(&f->registers->sr, ERRORS | FLASH_SR_EOP);
    }
    return f->errors == 0;
}

static bool unlock(flash *f)
{
    (void)finish(f, WRITE_POLLS_N); /* what was left over by others is not this one's error */
    if ((f->errors & FLASH_SR_BSY) != 0) {
        return false;
    }
    f->errors = 0;
    if ((reg_read(&f->registers->cr) & FLASH_CR_LOCK) != 0) {
        reg_write(&f->registers->keyr, KEYS[0]);
        reg_write(&f->registers->keyr, KEYS[1]);
    }
    return (reg_read(&f->registers->cr) & FLASH_CR_LOCK) == 0;
}

/* A write to CR while the controller is busy would stall the core for as long (3.8.5). */
static void lock(flash *f)
{
    if ((f->errors & FLASH_SR_BSY) == 0) {
        reg_write(&f->registers->cr, FLASH_CR_LOCK);
    }
}

bool flash_write(flash *f, int sector, uint32_t offset, const void *bytes, size_t bytes_n)
{
    if (!f->present || !within(sector, offset, bytes_n) || offset % 4 != 0 || bytes_n % 4 != 0 ||
        !unlock(f)) {
        return false;
    }
    reg_write(&f->registers->cr, FLASH_CR_PG | FLASH_CR_PSIZE_WORD);
    bool good = true;
    for (size_t done = 0; good && done < bytes_n; done += 4) {
        uint32_t word;
        memcpy(&word, (const uint8_t *)bytes + done, 4);
        reg_write(f->sector[sector] + (offset + done) / 4, word);
        memory_barrier(); /* it has begun before its end is looked for */
        good = finish(f, WRITE_POLLS_N);
    }
    lock(f);
    return good;
}

/* Lines of it may be in the data cache, which an erase does not tell (3.5.4). */
static void forget_cached(flash *f)
{
    reg_clear(&f->registers->acr, FLASH_ACR_DCEN);
    reg_set(&f->registers->acr, FLASH_ACR_DCRST);
    reg_clear(&f->registers->acr, FLASH_ACR_DCRST);
    reg_set(&f->registers->acr, FLASH_ACR_DCEN);
}

bool flash_erase(flash *f, int sector)
{
    if (!f->present || !within(sector, 0, 0) || !unlock(f)) {
        return false;
    }
    const uint32_t number = FLASH_FIRST_SECTOR + (uint32_t)sector;
    reg_write(&f->registers->cr, FLASH_CR_SER | FLASH_CR_PSIZE_WORD | number * FLASH_CR_SNB0);
    reg_set(&f->registers->cr, FLASH_CR_STRT);
    memory_barrier();
    const bool good = finish(f, ERASE_POLLS_N);
    lock(f);
    forget_cached(f);
    return good;
}
