/* file_fixture.h - what the tests of files share: complaints caught instead of printed, and a file to
 * write damaged texts into. Included once by each test program. */
#ifndef LIMBER_FILE_FIXTURE_H
#define LIMBER_FILE_FIXTURE_H

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "sim.h"
#include "unity.h"

static char complaint[1024];
static int complaints_n;

/* These stand in for the simulator's own complain.c, which a linker then leaves in its library. */
const char *sim_program_name = "test";

int sim_complain(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(complaint, sizeof complaint, format, arguments);
    va_end(arguments);
    complaints_n++;
    return SIM_BAD_INPUT;
}

int sim_give_up(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(complaint, sizeof complaint, format, arguments);
    va_end(arguments);
    complaints_n++;
    return SIM_INTERNAL;
}

static char folder[] = "/tmp/limber-test-XXXXXX";
static char file_path[64];

static inline void fixture_start(void)
{
    if (mkdtemp(folder) == NULL) {
        perror(folder);
        exit(1);
    }
    snprintf(file_path, sizeof file_path, "%s/file.txt", folder);
}

static inline void fixture_end(void)
{
    unlink(file_path);
    rmdir(folder);
}

static inline void forget_complaints(void)
{
    complaint[0] = '\0';
    complaints_n = 0;
}

static inline void write_file(const char *bytes, size_t bytes_n)
{
    FILE *file = fopen(file_path, "wb");
    TEST_ASSERT_NOT_NULL(file);
    TEST_ASSERT_EQUAL_size_t(bytes_n, fwrite(bytes, 1, bytes_n, file));
    TEST_ASSERT_EQUAL_INT(0, fclose(file));
}

static inline void write_text(const char *text)
{
    write_file(text, strlen(text));
}

/* Exactly one complaint: "FILE:LINE: ...reason...", or "FILE: ...reason..." where line is 0. */
static inline void expect_complaint(const char *path, long line, const char *reason,
                                    const char *input)
{
    char start[128], shown[400];
    snprintf(start, sizeof start, line > 0 ? "%s:%ld: " : "%s: ", path, line);
    snprintf(shown, sizeof shown, "input <%.120s> complaint <%.200s>", input, complaint);
    TEST_ASSERT_EQUAL_INT_MESSAGE(1, complaints_n, shown);
    TEST_ASSERT_EQUAL_STRING_LEN_MESSAGE(start, complaint, strlen(start), shown);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(complaint + strlen(start), reason), shown);
}

#endif
