/* host_device.h - the device on this machine: the app's hal made of a line, servos, a flash file and a clock of its own
 * that advances a tick at a time. */
#ifndef LIMBER_HOST_DEVICE_H
#define LIMBER_HOST_DEVICE_H

#include "body_log.h"
#include "bus_model.h"
#include "device.h"
#include "flash_file.h"
#include "injection.h"
#include "line.h"
#include "servo_plant.h"

enum { HOST_SERVOS_BAUD = 1000000 }; /* where nothing is said */

/* The servos that hang on it. */
typedef struct {
    servos_kind kind;
    int servos_n;  /* on the bus; 0: two a link. Hobby servos: one on every channel */
    uint32_t baud; /* what those on the bus are set to */
    bool echo;     /* the bus is wired so that the device hears itself */
} host_servos;

typedef struct {
    hal hal;
    line line;
    servo_plant plant; /* what turns, hung on the bus or on PWM */
    bus_model bus;
    host_servos servos; /* baud 0: smart servos, two a link */
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
    scene objects;      /* stand there at every start, but what there is no time for */
    bool late;          /* this machine is behind: what has come in since belongs to a later tick */
} host_device;

/* hal and defaults; the line, flash and log must be open (or {0}) by then, the plant initialised. Starts the device
 * and its servos: new ones, though they stand where the plant has them. */
void host_device_start(host_device *h, float tick_s, int links_n);

/* One tick of the device and of the world around it. */
void host_device_tick(host_device *h);

#endif
