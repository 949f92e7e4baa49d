/* mix_plugin.c - a plugin for QEMU that counts how often each instruction runs, and how often it jumps.
 *
 *     qemu-system-arm ... -plugin libmix_plugin.so,begin=ADDRESS,end=ADDRESS,tell=ADDRESS,out=FILE
 *
 * Counts from when the instruction at `begin` runs until that at `end` does; when the one at `tell` runs, and when
 * QEMU ends, writes "region", then a line "address runs jumps" for each instruction, and starts at 0. Without
 * begin it counts always. One processor, code in the STM32F405's flash.
 *
 * QEMU's header for plugins is not packaged with it, so what is used of its API is declared here: the same in its
 * versions 1 (QEMU before 9) and 2 to 6.
 */
#include <inttypes.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifndef QEMU_PLUGIN_API
#define QEMU_PLUGIN_API 2
#endif

typedef uint64_t plugin_id;
struct qemu_plugin_tb;
struct qemu_plugin_insn;
struct qemu_info;
enum { CB_NO_REGISTERS = 0 };

void qemu_plugin_register_vcpu_tb_trans_cb(plugin_id id,
                                           void (*translated)(plugin_id, struct qemu_plugin_tb *));
void qemu_plugin_register_atexit_cb(plugin_id id, void (*ended)(plugin_id, void *), void *context);
size_t qemu_plugin_tb_n_insns(const struct qemu_plugin_tb *block);
struct qemu_plugin_insn *qemu_plugin_tb_get_insn(const struct qemu_plugin_tb *block, size_t i);
uint64_t qemu_plugin_insn_vaddr(const struct qemu_plugin_insn *instruction);
size_t qemu_plugin_insn_size(const struct qemu_plugin_insn *instruction);
void qemu_plugin_register_vcpu_insn_exec_cb(struct qemu_plugin_insn *instruction,
                                            void (*executed)(unsigned, void *), int flags,
                                            void *context);

extern int qemu_plugin_version;
int qemu_plugin_version = QEMU_PLUGIN_API;
int qemu_plugin_install(plugin_id id, const struct qemu_info *info, int words_n, char **words);

enum { FLASH_START = 0x08000000, FLASH_BYTES = 0x100000 };

typedef struct {
    uint32_t address, bytes_n;
    uint64_t runs, jumps;
} tally;

static tally tallies[FLASH_BYTES / 2]; /* instructions lie at even addresses */
static tally *last;                    /* that ran, while counting */
static uint32_t begin, end, tell;
static bool counting;
static FILE *out;

static void tell_region(void)
{
    fprintf(out, "region\n");
    for (size_t i = 0; i < FLASH_BYTES / 2; i++) {
        if (tallies[i].runs > 0) {
            fprintf(out, "%" PRIx32 " %" PRIu64 " %" PRIu64 "\n", tallies[i].address,
                    tallies[i].runs, tallies[i].jumps);
        }
        tallies[i].runs = tallies[i].jumps = 0;
    }
    fflush(out);
    last = NULL;
}

static void executed(unsigned processor, void *context)
{
    tally *t = context;
    (void)processor;
    if (t->address == begin) {
        counting = true;
        last = NULL;
    } else if (t->address == end) {
        counting = false;
    } else if (t->address == tell) {
        tell_region();
    }
    if (counting) {
        t->runs++;
        if (last != NULL && last->address + last->bytes_n != t->address) {
            last->jumps++;
        }
        last = t;
    }
}

static void translated(plugin_id id, struct qemu_plugin_tb *block)
{
    (void)id;
    for (size_t i = 0; i < qemu_plugin_tb_n_insns(block); i++) {
        struct qemu_plugin_insn *instruction = qemu_plugin_tb_get_insn(block, i);
        const uint64_t offset = qemu_plugin_insn_vaddr(instruction) - FLASH_START;
        if (offset < FLASH_BYTES) {
            tally *t = &tallies[offset / 2];
            t->address = (uint32_t)(FLASH_START + offset);
            t->bytes_n = (uint32_t)qemu_plugin_insn_size(instruction);
            qemu_plugin_register_vcpu_insn_exec_cb(instruction, executed, CB_NO_REGISTERS, t);
        }
    }
}

static void ended(plugin_id id, void *context)
{
    (void)id;
    (void)context;
    tell_region();
}

int qemu_plugin_install(plugin_id id, const struct qemu_info *info, int words_n, char **words)
{
    (void)info;
    for (int i = 0; i < words_n; i++) {
        const char *value = strchr(words[i], '=');
        value = value != NULL ? value + 1 : "";
        uint32_t *address = strncmp(words[i], "begin=", 6) == 0  ? &begin
                            : strncmp(words[i], "end=", 4) == 0  ? &end
                            : strncmp(words[i], "tell=", 5) == 0 ? &tell
                                                                 : NULL;
        if (address != NULL) {
            *address = (uint32_t)strtoul(value, NULL, 0);
        } else if (strncmp(words[i], "out=", 4) == 0) {
            out = fopen(value, "w");
        }
    }
    if (out == NULL) {
        fprintf(stderr, "mix_plugin: out=FILE is missing, or cannot be written\n");
        return 1;
    }
    counting = begin == 0;
    qemu_plugin_register_vcpu_tb_trans_cb(id, translated);
    qemu_plugin_register_atexit_cb(id, ended, NULL);
    return 0;
}
