/* crc32c.c - see crc32c.h. */
#include "crc32c.h"

/* What four bits shifted out of the register do to the rest of it. */
static const uint32_t NIBBLE[16] = {
    0x00000000u, 0x105EC76Fu, 0x20BD8EDEu, 0x30E349B1u, 0x417B1DBCu, 0x5125DAD3u,
    0x61C69362u, 0x7198540Du, 0x82F63B78u, 0x92A8FC17u, 0xA24BB5A6u, 0xB21572C9u,
    0xC38D26C4u, 0xD3D3E1ABu, 0xE330A81Au, 0xF36E6F75u,
};

uint32_t crc32c_add_byte(uint32_t crc, uint8_t byte)
{
    crc ^= byte;
    crc = NIBBLE[crc & 0xFu] ^ (crc >> 4);
    return NIBBLE[crc & 0xFu] ^ (crc >> 4);
}

uint32_t crc32c_add(uint32_t crc, const void *bytes, size_t bytes_n)
{
    const uint8_t *byte = bytes;
    for (size_t i = 0; i < bytes_n; i++) {
        crc = crc32c_add_byte(crc, byte[i]);
    }
    return crc;
}

uint32_t crc32c(const void *bytes, size_t bytes_n)
{
    return crc32c_finish(crc32c_add(CRC32C_START, bytes, bytes_n));
}
