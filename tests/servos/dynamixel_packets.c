/* dynamixel_packets.c - packets as dynamixel.c writes them, one a line in hexadecimal, for sdk_test.py.
 *
 *     ping ID | sync_write ADDRESS N ID VALUE [ID VALUE ...] | crc HEX     one of these a line, from stdin
 */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "dynamixel.h"

static uint8_t packet[2048];

static unsigned long number(void)
{
    const char *word = strtok(NULL, " \n");
    return word != NULL ? strtoul(word, NULL, 0) : 0;
}

static size_t sync_write(void)
{
    const uint16_t address = (uint16_t)number(), n = (uint16_t)number();
    uint8_t *part = packet + DXL_SYNC_PARAMS_AT;
    dxl_sync_open(packet, address, n);
    for (const char *id = strtok(NULL, " \n"); id != NULL; id = strtok(NULL, " \n")) {
        part[0] = (uint8_t)strtoul(id, NULL, 0);
        dxl_put_u32(part + 1, (uint32_t)number());
        part += 1 + n;
    }
    const size_t params_n = (size_t)(part - packet) - DXL_PARAMS_AT;
    return dxl_seal(packet, sizeof packet, DXL_BROADCAST, DXL_SYNC_WRITE, params_n);
}

static size_t crc_of(const char *hex)
{
    size_t n = 0;
    unsigned byte;
    for (; sscanf(hex, "%2x", &byte) == 1; hex += 2) {
        packet[n++] = (uint8_t)byte;
    }
    const uint16_t crc = dxl_crc16(0, packet, n);
    packet[0] = (uint8_t)crc;
    packet[1] = (uint8_t)(crc >> 8);
    return 2;
}

int main(void)
{
    static char line[8192];
    while (fgets(line, sizeof line, stdin) != NULL) {
        const char *word = strtok(line, " \n");
        size_t n = 0;
        if (word != NULL && strcmp(word, "ping") == 0) {
            n = dxl_ping(packet, sizeof packet, (uint8_t)number());
        } else if (word != NULL && strcmp(word, "sync_write") == 0) {
            n = sync_write();
        } else if (word != NULL && strcmp(word, "crc") == 0) {
            n = crc_of(strtok(NULL, " \n"));
        }
        for (size_t i = 0; i < n; i++) {
            printf("%02X", packet[i]);
        }
        printf("\n");
    }
    return 0;
}
