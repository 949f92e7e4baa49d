/* dynamixel_x.c - which X series servos there are, and their rates; see dynamixel_x.h. */
#include "dynamixel_x.h"

/* e-Manual XL430-W250, Baud Rate(8). XL330 and XC330 end with 4 Mbaud. */
static const uint32_t BAUDS[DXL_X_BAUD_CODES_N] = {9600,    57600,   115200,  1000000,
                                                   2000000, 3000000, 4000000, 4500000};

uint32_t dxl_x_baud(int code)
{
    return code >= 0 && code < DXL_X_BAUD_CODES_N ? BAUDS[code] : 0;
}

int dxl_x_baud_code(uint32_t baud)
{
    for (int code = 0; code < DXL_X_BAUD_CODES_N; code++) {
        if (BAUDS[code] == baud) {
            return code;
        }
    }
    return -1;
}

bool dxl_x_accepts(uint16_t model)
{
    const bool x = model >= 1000 && model <= 1999;
    return x || model == 30 || model == 311 || model == 321;
}
