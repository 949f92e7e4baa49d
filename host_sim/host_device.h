/* host_device.h - the device on this machine: the app's hal made of a line, a servo plant, a flash file and a
 * clock of its own that advances a tick at a time. */
#ifndef LIMBER_HOST_DEVICE_H
#define LIMBER_HOST_DEVICE_H

#include "body_log.h"
#include "device.h"
#include "flash_file.h"
#include "injection.h"
#include "line.h"
#include "servo_plant.h"

typedef struct {
    hal hal;
    line line;
    servo_plant plant;
    flash_file flash;
    injection injection;
    body_log log;
    device device;
    device_config config;
    hal_boot boot;
    double elapsed_s;   /* of the device's own clock, jumps left out */
    uint32_t jumped_us; /* by which injected clock jumps are ahead */
    bool rebooting;
    uint32_t line_baud; /* to be believed in: 0 where the line has no rate */
    bool late;          /* this machine is behind: what has come in since belongs to a later tick */
} host_device;

/* hal and defaults; the line, flash and log must be open (or {0}) by then. Starts the device. */
void host_device_start(host_device *h, float tick_s, int links_n);

/* One tick of the device and of the world around it. */
void host_device_tick(host_device *h);

#endif
