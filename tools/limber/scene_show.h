/* scene_show.h - what stands in the device's scene, as lines that limber scene put takes, or as JSON. */
#ifndef LIMBER_SCENE_SHOW_H
#define LIMBER_SCENE_SHOW_H

#include "session.h"

/* Asks for every place and prints those that are taken. SIM_OK, or LIMBER_DEVICE after complaining. */
int scene_show(session *s, bool json);

#endif
