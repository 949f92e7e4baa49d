/* semihosting.c - lets a test on the emulated board have arguments, files, stdout and an exit status.
 *
 * newlib's librdimon does the talking; only the arguments are asked for here (ARM semihosting, operation
 * 0x15, SYS_GET_CMDLINE).
 */
#include <stddef.h>
#include <string.h>

void initialise_monitor_handles(void); /* librdimon: opens stdin, stdout, stderr on the host */
int startup_arguments(char ***argv);

int startup_arguments(char ***argv)
{
    enum { SYS_GET_CMDLINE = 0x15, WORDS_MAX = 8 };
    static char line[512];
    static char *words[WORDS_MAX + 1];
    struct {
        char *text;
        size_t room;
    } block = {line, sizeof line};

    initialise_monitor_handles();
    register int operation __asm__("r0") = SYS_GET_CMDLINE;
    register void *parameters __asm__("r1") = &block;
    __asm__ volatile("bkpt 0xAB" : "+r"(operation) : "r"(parameters) : "memory");
    int n = 0;
    if (operation == 0) {
        for (char *word = strtok(line, " "); word != NULL && n < WORDS_MAX;
             word = strtok(NULL, " ")) {
            words[n++] = word;
        }
    }
    *argv = words;
    return n;
}
