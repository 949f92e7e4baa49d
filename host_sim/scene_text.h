/* scene_text.h - things to touch as people write them: an INI file, or one line on the command line.
 *
 *     [sphere ball]                  a kind, then a name of your own: one word
 *     centre = 0, 0, 0.5             m, in the world: right-handed, z up, where the track is
 *     radius = 0.1
 *     friction = 0.3                 Coulomb's mu; 0.3 where it is not given
 *
 *     sphere ball centre=0,0,0.5 radius=0.1 friction=0.3
 *
 *     plane    point, normal         everything on the other side of the normal is solid
 *     sphere   centre, radius
 *     capsule  from, to, radius      the centres of its round ends
 *     box      centre, size (whole edges), rounding (of the edges, part of the size; 5 mm), and either turn
 *              (degrees about the world's x, then its y, then its z) or quaternion (x, y, z, w)
 */
#ifndef LIMBER_SCENE_TEXT_H
#define LIMBER_SCENE_TEXT_H

#include <stdio.h>

#include "scene.h"

enum { SCENE_NAME_MAX = 32, SCENE_LINE_MAX = 320 };

typedef struct {
    scene_object object; /* as scene_check has it */
    char name[SCENE_NAME_MAX];
} scene_text_object;

/* All of a file, in its order: object i goes to place i of a scene. */
typedef struct {
    int objects_n;
    scene_text_object objects[SCENE_OBJECTS_MAX];
} scene_text;

/* Each returns SIM_OK, or SIM_BAD_INPUT after one line with place, value and bounds; then nothing is changed. */

/* What the file holds, which may be nothing. */
int scene_text_read_ini(const char *path, scene_text *text);

/* One object from one line; complaints begin with `origin` ("--index 2", ...). Without a name its kind is its name. */
int scene_text_read_line(const char *origin, const char *line, scene_text_object *object);

/* "x,y,z" within the bounds of a place. */
int scene_text_read_place(const char *origin, const char *text, vec3 *place_m);

/* Objects as a file that reads back to the same bits; a plane's normal and a capsule's ends, out of which its turn
 * comes anew, to 1e-7. */
void scene_text_write_ini(const scene_text *text, const char *title, FILE *out);

/* One object as a line that scene_text_read_line takes. A NULL name is left out. */
void scene_text_write_line(const scene_object *object, const char *name, char line[SCENE_LINE_MAX]);

#endif
