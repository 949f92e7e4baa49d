/* rod_config.h - the one size that is fixed when the core is compiled. */
#ifndef LIMBER_ROD_CONFIG_H
#define LIMBER_ROD_CONFIG_H

/* Most links a rod can have; every array of the core is sized by it. A build option, 1 ... 256
 * (cmake -DROD_MAX_LINKS=256). */
#ifndef ROD_MAX_LINKS
#define ROD_MAX_LINKS 64
#endif

_Static_assert(ROD_MAX_LINKS >= 1 && ROD_MAX_LINKS <= 256, "ROD_MAX_LINKS must lie in 1 ... 256");

#endif
