/* params_fixture.h - what the tests of parameters share. Included once by each test program. */
#ifndef LIMBER_PARAMS_FIXTURE_H
#define LIMBER_PARAMS_FIXTURE_H

#include "file_fixture.h"
#include "params_text.h"

static params_text text;
static rod_params params;

void setUp(void)
{
    memset(&text, 0, sizeof text);
    forget_complaints();
}

void tearDown(void) {}

static inline void set(const char *assignment)
{
    TEST_ASSERT_EQUAL_INT_MESSAGE(SIM_OK, params_text_set(&text, assignment), complaint);
}

static inline void read_ini(const char *ini)
{
    write_text(ini);
    TEST_ASSERT_EQUAL_INT_MESSAGE(SIM_OK, params_text_read_ini(&text, file_path), complaint);
}

static inline void resolve(void)
{
    TEST_ASSERT_EQUAL_INT_MESSAGE(SIM_OK, params_text_resolve(&text, 1000.0, &params), complaint);
}

static inline bool is_per_joint(const rod_field *field)
{
    return field->kind == ROD_FIELD_PER_JOINT;
}

static inline void expect_ini_refused(const char *ini, long line, const char *reason)
{
    setUp();
    write_text(ini);
    TEST_ASSERT_EQUAL_INT_MESSAGE(SIM_BAD_INPUT, params_text_read_ini(&text, file_path), ini);
    expect_complaint(file_path, line, reason, ini);
}

#endif
