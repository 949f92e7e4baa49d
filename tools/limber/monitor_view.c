/* monitor_view.c - see monitor_view.h: the terminal, its keys, and what others say meanwhile. */
#include "monitor_view.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <curses.h>
#include <term.h>

#include "monitor_draw.h"

enum { ESCAPE_MS = 50 }; /* that the rest of an arrow key may come late, over ssh */

bool monitor_view_possible(void)
{
    int error;
    if (isatty(STDOUT_FILENO) == 0 || setupterm(NULL, STDOUT_FILENO, &error) != OK) {
        return false;
    }
    const bool places_cursor = cursor_address != NULL && clear_screen != NULL;
    del_curterm(cur_term);
    return places_cursor;
}

/* --- stderr ---------------------------------------------------------------------------------------- */

static void catch_stderr(monitor_view *v)
{
    int ends[2];
    v->stderr_fd = v->said_fd = -1;
    if (isatty(STDERR_FILENO) == 0 || pipe2(ends, O_CLOEXEC | O_NONBLOCK) != 0) {
        return;
    }
    v->stderr_fd = fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 3);
    if (v->stderr_fd < 0) {
        close(ends[0]);
        close(ends[1]);
        return;
    }
    v->said_fd = ends[0];
    (void)dup2(ends[1], STDERR_FILENO); /* full: what is written is lost, nobody waits */
    close(ends[1]);
}

static void take_said(monitor_view *v)
{
    char bytes[4096];
    size_t used = strlen(v->line);
    for (ssize_t n; v->said_fd >= 0 && (n = read(v->said_fd, bytes, sizeof bytes)) > 0;) {
        for (ssize_t i = 0; i < n; i++) {
            if (bytes[i] == '\n') {
                memcpy(v->said[v->said_n++ % MONITOR_SAID_N], v->line, sizeof v->line);
                used = 0;
            } else if (used < sizeof v->line - 1) {
                v->line[used++] = bytes[i];
            }
            v->line[used] = '\0';
        }
    }
}

static void give_stderr_back(monitor_view *v)
{
    if (v->said_fd < 0) {
        return;
    }
    take_said(v);
    (void)dup2(v->stderr_fd, STDERR_FILENO);
    close(v->stderr_fd);
    close(v->said_fd);
    const int first = v->said_n > MONITOR_SAID_N ? v->said_n - MONITOR_SAID_N : 0;
    for (int i = first; i < v->said_n; i++) {
        fprintf(stderr, "%s\n", v->said[i % MONITOR_SAID_N]);
    }
}

/* --- the terminal ---------------------------------------------------------------------------------- */

/* As https://no-color.org has it. */
static bool colour_is_wanted(void)
{
    const char *const no_color = getenv("NO_COLOR");
    return no_color == NULL || *no_color == '\0';
}

static void choose_colours(monitor_view *v)
{
    v->colour = colour_is_wanted() && has_colors() && start_color() == OK;
    if (v->colour) {
        const short background = use_default_colors() == OK ? -1 : COLOR_BLACK;
        init_pair(COLOUR_GOOD, COLOR_GREEN, background);
        init_pair(COLOUR_CARE, COLOR_YELLOW, background);
        init_pair(COLOUR_BAD, COLOR_RED, background);
        init_pair(COLOUR_FAINT, COLOR_CYAN, background);
    }
}

bool monitor_view_open(monitor_view *v)
{
    *v = (monitor_view){.said_fd = -1};
    v->screen = newterm(NULL, stdout, stdin);
    if (v->screen == NULL) {
        return false;
    }
    set_term(v->screen);
    set_escdelay(ESCAPE_MS);
    cbreak(); /* keys at once, but Ctrl-C stays a signal */
    noecho();
    nodelay(stdscr, true);
    keypad(stdscr, true);
    (void)curs_set(0); /* a terminal that cannot hide it, shows it */
    choose_colours(v);
    catch_stderr(v);
    return true;
}

void monitor_view_draw(monitor_view *v, const monitor_state *m)
{
    take_said(v);
    char *const said = v->said_n == 0 ? NULL : v->said[(v->said_n - 1) % MONITOR_SAID_N];
    if (said != NULL) {
        monitor_text_clean(said);
    }
    monitor_draw(v, m, said);
    refresh();
}

bool monitor_view_keys(monitor_view *v)
{
    for (int key; (key = getch()) != ERR;) {
        switch (key) {
        case 'q':
        case 'Q':
            return false;
        case KEY_DOWN:
        case 'j':
            v->first_joint++;
            break;
        case KEY_UP:
        case 'k':
            v->first_joint--;
            break;
        case KEY_NPAGE:
        case ' ':
            v->first_joint += v->shown_n;
            break;
        case KEY_PPAGE:
            v->first_joint -= v->shown_n;
            break;
        case 'L' & 0x1f: /* Ctrl-L: something else wrote on the screen */
            clearok(curscr, true);
            break;
        default:
            break; /* a new size comes as KEY_RESIZE: the next picture has it */
        }
    }
    return true;
}

void monitor_view_close(monitor_view *v)
{
    endwin();
    delscreen(v->screen);
    give_stderr_back(v);
    v->screen = NULL;
}
