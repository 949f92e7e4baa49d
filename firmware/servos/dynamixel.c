/* dynamixel.c - packets of Dynamixel Protocol 2.0; see dynamixel.h. */
#include "dynamixel.h"

enum { MARK_BYTES = 4, HEADER_BYTES = 7, CRC_BYTES = 2, STUFFED = 0xFD };

static const uint8_t MARK[MARK_BYTES] = {0xFF, 0xFF, 0xFD, 0x00};
#define MARK_AS_LAST 0xFFFFFD00u

/* The CRC of each byte: polynomial 8005, the highest bit first (e-Manual, CRC Calculation). */
static const uint16_t CRC_OF[256] = {
    0x0000, 0x8005, 0x800F, 0x000A, 0x801B, 0x001E, 0x0014, 0x8011, 0x8033, 0x0036, 0x003C, 0x8039,
    0x0028, 0x802D, 0x8027, 0x0022, 0x8063, 0x0066, 0x006C, 0x8069, 0x0078, 0x807D, 0x8077, 0x0072,
    0x0050, 0x8055, 0x805F, 0x005A, 0x804B, 0x004E, 0x0044, 0x8041, 0x80C3, 0x00C6, 0x00CC, 0x80C9,
    0x00D8, 0x80DD, 0x80D7, 0x00D2, 0x00F0, 0x80F5, 0x80FF, 0x00FA, 0x80EB, 0x00EE, 0x00E4, 0x80E1,
    0x00A0, 0x80A5, 0x80AF, 0x00AA, 0x80BB, 0x00BE, 0x00B4, 0x80B1, 0x8093, 0x0096, 0x009C, 0x8099,
    0x0088, 0x808D, 0x8087, 0x0082, 0x8183, 0x0186, 0x018C, 0x8189, 0x0198, 0x819D, 0x8197, 0x0192,
    0x01B0, 0x81B5, 0x81BF, 0x01BA, 0x81AB, 0x01AE, 0x01A4, 0x81A1, 0x01E0, 0x81E5, 0x81EF, 0x01EA,
    0x81FB, 0x01FE, 0x01F4, 0x81F1, 0x81D3, 0x01D6, 0x01DC, 0x81D9, 0x01C8, 0x81CD, 0x81C7, 0x01C2,
    0x0140, 0x8145, 0x814F, 0x014A, 0x815B, 0x015E, 0x0154, 0x8151, 0x8173, 0x0176, 0x017C, 0x8179,
    0x0168, 0x816D, 0x8167, 0x0162, 0x8123, 0x0126, 0x012C, 0x8129, 0x0138, 0x813D, 0x8137, 0x0132,
    0x0110, 0x8115, 0x811F, 0x011A, 0x810B, 0x010E, 0x0104, 0x8101, 0x8303, 0x0306, 0x030C, 0x8309,
    0x0318, 0x831D, 0x8317, 0x0312, 0x0330, 0x8335, 0x833F, 0x033A, 0x832B, 0x032E, 0x0324, 0x8321,
    0x0360, 0x8365, 0x836F, 0x036A, 0x837B, 0x037E, 0x0374, 0x8371, 0x8353, 0x0356, 0x035C, 0x8359,
    0x0348, 0x834D, 0x8347, 0x0342, 0x03C0, 0x83C5, 0x83CF, 0x03CA, 0x83DB, 0x03DE, 0x03D4, 0x83D1,
    0x83F3, 0x03F6, 0x03FC, 0x83F9, 0x03E8, 0x83ED, 0x83E7, 0x03E2, 0x83A3, 0x03A6, 0x03AC, 0x83A9,
    0x03B8, 0x83BD, 0x83B7, 0x03B2, 0x0390, 0x8395, 0x839F, 0x039A, 0x838B, 0x038E, 0x0384, 0x8381,
    0x0280, 0x8285, 0x828F, 0x028A, 0x829B, 0x029E, 0x0294, 0x8291, 0x82B3, 0x02B6, 0x02BC, 0x82B9,
    0x02A8, 0x82AD, 0x82A7, 0x02A2, 0x82E3, 0x02E6, 0x02EC, 0x82E9, 0x02F8, 0x82FD, 0x82F7, 0x02F2,
    0x02D0, 0x82D5, 0x82DF, 0x02DA, 0x82CB, 0x02CE, 0x02C4, 0x82C1, 0x8243, 0x0246, 0x024C, 0x8249,
    0x0258, 0x825D, 0x8257, 0x0252, 0x0270, 0x8275, 0x827F, 0x027A, 0x826B, 0x026E, 0x0264, 0x8261,
    0x0220, 0x8225, 0x822F, 0x022A, 0x823B, 0x023E, 0x0234, 0x8231, 0x8213, 0x0216, 0x021C, 0x8219,
    0x0208, 0x820D, 0x8207, 0x0202,
};

static inline uint16_t crc_add(uint16_t crc, uint8_t byte)
{
    return (uint16_t)(crc << 8 ^ CRC_OF[(crc >> 8) ^ byte]);
}

uint16_t dxl_crc16(uint16_t crc, const uint8_t *bytes, size_t bytes_n)
{
    for (const uint8_t *end = bytes + bytes_n; bytes < end; bytes++) {
        crc = crc_add(crc, *bytes);
    }
    return crc;
}

static bool ends_pattern(const uint8_t *byte)
{
    return byte[0] == STUFFED && byte[-1] == 0xFF && byte[-2] == 0xFF;
}

/* How many FF FF FD there are in bytes[n]. Looks at every third byte: one that is neither FD nor FF is in none. */
static size_t patterns(const uint8_t *bytes, size_t n)
{
    size_t found = 0;
    for (size_t i = 2; i < n;) {
        if (bytes[i] == 0xFF) {
            i++;
            continue;
        }
        found += ends_pattern(bytes + i) ? 1 : 0;
        i += 3;
    }
    return found;
}

/* An FD behind each of the found FF FF FD, from the last to the first. */
static void stuff(uint8_t *bytes, size_t n, size_t found)
{
    for (size_t i = n; found > 0; i--) {
        if (ends_pattern(bytes + i - 1)) {
            bytes[i - 1 + found] = STUFFED;
            found--;
        }
        bytes[i - 1 + found] = bytes[i - 1];
    }
}

size_t dxl_seal(uint8_t *packet, size_t room, uint8_t id, uint8_t instruction, size_t params_n)
{
    if (room < DXL_OVERHEAD_BYTES || params_n > room - DXL_OVERHEAD_BYTES) {
        return 0;
    }
    uint8_t *body = packet + HEADER_BYTES;
    body[0] = instruction;
    const size_t found = patterns(body, 1 + params_n);
    const size_t body_n = 1 + params_n + found;
    const size_t length = body_n + CRC_BYTES;
    if (HEADER_BYTES + length > room || length > DXL_LENGTH_MAX) {
        return 0;
    }
    stuff(body, 1 + params_n, found);
    memcpy(packet, MARK, MARK_BYTES);
    packet[4] = id;
    packet[5] = (uint8_t)length;
    packet[6] = (uint8_t)(length >> 8);
    const uint16_t crc = dxl_crc16(0, packet, HEADER_BYTES + body_n);
    body[body_n] = (uint8_t)crc;
    body[body_n + 1] = (uint8_t)(crc >> 8);
    return HEADER_BYTES + length;
}

size_t dxl_ping(uint8_t *packet, size_t room, uint8_t id)
{
    return dxl_seal(packet, room, id, DXL_PING, 0);
}

size_t dxl_reboot(uint8_t *packet, size_t room, uint8_t id)
{
    return dxl_seal(packet, room, id, DXL_REBOOT, 0);
}

void dxl_sync_open(uint8_t *packet, uint16_t address, uint16_t n)
{
    dxl_put_u32(packet + DXL_PARAMS_AT, address | (uint32_t)n << 16);
}

size_t dxl_read(uint8_t *packet, size_t room, uint8_t id, uint16_t address, uint16_t n)
{
    if (room < DXL_SYNC_PARAMS_AT) {
        return 0;
    }
    dxl_sync_open(packet, address, n);
    return dxl_seal(packet, room, id, DXL_READ, 4);
}

size_t dxl_write(uint8_t *packet, size_t room, uint8_t id, uint16_t address, uint16_t n,
                 uint32_t value)
{
    if (room < DXL_OVERHEAD_BYTES + 6 || n > 4) {
        return 0;
    }
    packet[DXL_PARAMS_AT] = (uint8_t)address;
    packet[DXL_PARAMS_AT + 1] = (uint8_t)(address >> 8);
    dxl_put_u32(packet + DXL_PARAMS_AT + 2, value);
    return dxl_seal(packet, room, id, DXL_WRITE, 2u + n);
}

size_t dxl_status(uint8_t *packet, size_t room, uint8_t id, uint8_t error, const uint8_t *params,
                  size_t params_n)
{
    if (room < DXL_STATUS_BYTES || params_n > room - DXL_STATUS_BYTES) {
        return 0;
    }
    packet[DXL_PARAMS_AT] = error;
    if (params_n > 0) {
        memcpy(packet + DXL_PARAMS_AT + 1, params, params_n);
    }
    return dxl_seal(packet, room, id, DXL_STATUS, 1 + params_n);
}

/* What the next byte is. */
enum {
    HUNTING,
    AT_ID,
    AT_LENGTH_LOW,
    AT_LENGTH_HIGH,
    AT_INSTRUCTION,
    AT_ERROR,
    IN_PARAMS,
    AT_CRC_LOW,
    AT_CRC_HIGH
};

void dxl_decoder_init(dxl_decoder *d, uint8_t *params, size_t room)
{
    *d = (dxl_decoder){.params = params, .room = room};
}

static void begin(dxl_decoder *d)
{
    if (d->state != HUNTING) {
        d->bad_n++;
    }
    d->state = AT_ID;
    d->params_n = 0;
    d->error = 0;
    d->crc = dxl_crc16(0, MARK, MARK_BYTES);
}

static void give_up(dxl_decoder *d)
{
    d->bad_n++;
    d->state = HUNTING;
}

static void take_length(dxl_decoder *d, uint8_t high)
{
    d->length = (uint16_t)(d->length | high << 8);
    d->left_n = (uint16_t)(d->length - CRC_BYTES);
    d->state = AT_INSTRUCTION;
    if (d->length < 1 + CRC_BYTES || d->length > DXL_LENGTH_MAX) {
        give_up(d);
    }
}

static void take_instruction(dxl_decoder *d, uint8_t byte)
{
    const bool status = byte == DXL_STATUS;
    d->instruction = byte;
    d->state = status ? AT_ERROR : IN_PARAMS;
    if (status && d->left_n == 1) {
        give_up(d); /* has no error */
    }
}

static void take_param(dxl_decoder *d, uint8_t byte)
{
    if (byte == STUFFED && d->last >> 8 == MARK_AS_LAST >> 8) {
        return; /* stuffing */
    }
    if (d->params_n < d->room) {
        d->params[d->params_n] = byte;
    }
    d->params_n++;
}

/* From the instruction to the last parameter. */
static void take_body(dxl_decoder *d, uint8_t byte)
{
    if (d->state == IN_PARAMS) {
        take_param(d, byte);
    } else if (d->state == AT_INSTRUCTION) {
        take_instruction(d, byte);
    } else {
        d->error = byte;
        d->state = IN_PARAMS;
    }
    d->left_n--;
    if (d->left_n == 0 && d->state == IN_PARAMS) {
        d->state = AT_CRC_LOW;
    }
}

/* Whether the packet is whole. */
static bool take_crc(dxl_decoder *d, uint8_t high, dxl_packet *packet)
{
    if ((d->crc_sent | high << 8) != d->crc) {
        give_up(d);
        return false;
    }
    *packet = (dxl_packet){
        .id = d->id,
        .instruction = d->instruction,
        .error = d->error,
        .params = d->params,
        .params_n = d->params_n,
        .wire_n = HEADER_BYTES + (size_t)d->length,
    };
    d->state = HUNTING;
    return true;
}

static void take_header(dxl_decoder *d, uint8_t byte)
{
    if (d->state == AT_ID) {
        d->id = byte;
        d->state = AT_LENGTH_LOW;
    } else if (d->state == AT_LENGTH_LOW) {
        d->length = byte;
        d->state = AT_LENGTH_HIGH;
    } else {
        take_length(d, byte);
    }
}

bool dxl_decode(dxl_decoder *d, uint8_t byte, dxl_packet *packet)
{
    d->last = d->last << 8 | byte;
    if (d->state == AT_CRC_HIGH && take_crc(d, byte, packet)) {
        return true;
    }
    if (d->last == MARK_AS_LAST) {
        begin(d); /* stuffing keeps this out of all packets but for a CRC that is right */
    } else if (d->state == AT_CRC_LOW) {
        d->crc_sent = byte;
        d->state = AT_CRC_HIGH;
    } else if (d->state != HUNTING) {
        d->crc = crc_add(d->crc, byte);
        (d->state >= AT_INSTRUCTION ? take_body : take_header)(d, byte);
    }
    return false;
}
