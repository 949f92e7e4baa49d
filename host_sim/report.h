/* report.h - a replay as one self-contained HTML page: angle plots, node paths, a moving 3-D view. */
#ifndef LIMBER_REPORT_H
#define LIMBER_REPORT_H

#include "replay.h"

/* The page's layout and the JSON it reads are described at the top of report_page/page.html. preset may be
 * NULL. Returns SIM_OK, or an exit code after complaining. */
int report_write(const replay *r, const char *preset, const char *path);

#endif
