#!/usr/bin/env python3
"""The checks of a firmware image can fail: small programs that each break one rule are refused, by name; and the
stack's depth is right where it can be counted by hand."""
import contextlib
import io
import pathlib
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools" / "firmware"))
import check_elf  # noqa: E402  (where they are found must be said first)
import report  # noqa: E402
import stack  # noqa: E402

FLAGS = ["-std=c11", "-O2", "-mcpu=cortex-m4", "-mthumb", "-mfpu=fpv4-sp-d16", "-mfloat-abi=hard", "-ffp-contract=off",
         "-fno-inline", "-fcallgraph-info=su", "-nostartfiles", "--specs=nano.specs", "--specs=nosys.specs"]
LINKER_SCRIPT = """
ENTRY(reset_handler)
stack_top = 0x20020000;
end = 0x20010000;
guard_start = 0x2001E000;
stack_bottom = 0x2001F000;
SECTIONS
{
    .text %s : { KEEP(*(.vectors)) *(.text*) *(.rodata*) }
    .data 0x20000000 : AT(ADDR(.text) + SIZEOF(.text)) { *(.data*) *(.bss*) *(COMMON) }
    /DISCARD/ : { *(.ARM.exidx*) }
    .settings 0x080E0000 : { KEEP(*(.settings)) }
}
"""
PROGRAM = """
#include <stdint.h>
#include <stdlib.h>
#include <math.h>
#include <stdio.h>
extern uint32_t stack_top[];
int main(void);
void handler(void);
void reset_handler(void);
void reset_handler(void) { (void)main(); for (;;) { } }
__attribute__((section(".vectors"), used)) const uintptr_t vectors[16] = {
    (uintptr_t)stack_top, (uintptr_t)reset_handler, (uintptr_t)handler, (uintptr_t)handler, (uintptr_t)handler,
    (uintptr_t)handler, (uintptr_t)handler};
volatile float x = 2.0f;
volatile int64_t wide = 5;
volatile int n = 3;
"""
HANDLER = "void handler(void) { for (;;) { } }"
PLAIN = "int main(void) { x = x * 3.0f; return (int)x; }"


class Images(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def build(self, text, start="0x08000000"):
        (self.folder / "image.ld").write_text(LINKER_SCRIPT % start)
        source, image = self.folder / "image.c", self.folder / "image.elf"
        source.write_text(PROGRAM + text + ("" if "void handler" in text else HANDLER))
        subprocess.run(["arm-none-eabi-gcc", *FLAGS, "-Timage.ld", source, "-lm", "-o", image], cwd=self.folder,
                       check=True, stderr=subprocess.PIPE, text=True)
        return image

    def refused(self, word, text, start="0x08000000"):
        faults = check_elf.check(self.build(text, start))
        self.assertTrue(any(word in fault for fault in faults), f"no '{word}' in {faults}")

    def test_a_plain_program_is_not_refused(self):
        self.assertEqual(check_elf.check(self.build(PLAIN)), [])

    def test_refused(self):
        self.refused("double precision", "int main(void) { x = (float)((double)x * 1.1); return 0; }")
        self.refused("64-bit division", "int main(void) { wide = wide / n; return 0; }")
        self.refused("64-bit division or conversion", "int main(void) { x = (float)wide; return 0; }")
        self.refused("sinf: libm", "int main(void) { x = sinf(x); return 0; }")
        self.refused("sqrtf: libm", "int main(void) { x = sqrtf(x); return 0; }")  # it sets errno
        self.refused("malloc: a heap", "int main(void) { return malloc((size_t)n) != NULL; }")
        self.refused("printf: stdio", 'int main(void) { return printf("%d", n); }')
        self.refused("where the settings are",
                     '__attribute__((section(".settings"), used)) const int kept = 1;' + PLAIN)
        self.refused("where the processor looks for the vectors", PLAIN, start="0x08004000")
        self.refused("where the settings are", "const char filler[900000] = {1};"
                     "int main(void) { return filler[(unsigned)n * 9999]; }")

    def graph(self, text):
        return stack.Graph(self.build(text), [self.folder], self.folder)

    def reported(self, text, **budgets):
        image = self.build(text)
        with contextlib.ExitStack() as patches:
            for name, value in {"OWN_STACK": {}, **budgets}.items():
                patches.enter_context(mock.patch.object(report, name, value))
            patches.enter_context(contextlib.redirect_stdout(io.StringIO()))
            return report.report(image, [self.folder])

    def test_budgets(self):
        self.assertEqual(self.reported(PLAIN), [])
        self.assertRegex(self.reported(PLAIN, FLASH_MAX_BYTES=100)[0], "flash: .* and 100 are all")
        much = "char much[70000]; int main(void) { much[n] = 1; return much[n + 1]; }"
        self.assertRegex(self.reported(much)[0], "SRAM: .* and 65,536 are all")
        deep = "int main(void) { volatile char room[5000]; room[n] = 1; return room[n + 1]; }"
        faults = self.reported(deep)
        self.assertRegex(faults[0], "stack: 5,.* at worst, and there are 4,096")
        self.assertRegex(faults[1], "frame of main, 5,.* can step over the guard's 4,096")

    def why_unknown(self, text):
        with self.assertRaises(stack.Unknown) as raised:
            self.graph(text).entry("main")
        return str(raised.exception)

    def test_the_stack_adds_up(self):
        graph = self.graph("""
            static int deep(int i) { volatile char room[1000]; room[i] = 1; return room[0]; }
            static int shallow(int i) { volatile char room[200]; room[i] = 1; return room[0]; }
            void handler(void) { volatile char room[400]; room[n] = 1; }
            int main(void) { volatile char room[100]; room[n] = 1; return deep(n) + shallow(n) + room[0]; }""")
        frames = {stack.base_name(title): bytes_n for title, bytes_n in graph.frames.items()}
        self.assertTrue(1000 <= frames["deep"] <= 1016 and 100 <= frames["main"] <= 124 and frames["handler"] >= 400)
        (bytes_n, path), interrupts = stack.worst(graph, {"reset_handler", "handler"})
        self.assertEqual([stack.base_name(title) for title in path], ["reset_handler", "main", "deep"])
        self.assertEqual(bytes_n, frames["reset_handler"] + frames["main"] + frames["deep"])
        self.assertEqual([b for b, _ in interrupts], [108 + frames["handler"]])

    def test_all_handlers_nest(self):
        graph = self.graph("void first(void) { n = 1; } void second(void) { n = 2; }" + PLAIN)
        interrupts = stack.worst(graph, {"first", "second"}, own_stack={"second"})[1]
        self.assertEqual([b for b, _ in interrupts], [108 + graph.entry("first")[0], 108])

    def test_frames_of_what_the_compiler_has_not_compiled(self):
        graph = self.graph("""
            __asm__(".thumb_func\\n.type by_hand, %function\\nby_hand: push {r4-r7, lr}\\nvpush {d8-d9}\\n"
                    "sub sp, #24\\nbl helper\\nadd sp, #24\\nvpop {d8-d9}\\npop {r4-r7, pc}\\n");
            void by_hand(void);
            __attribute__((used)) void helper(void) { volatile char room[64]; room[n] = 1; }
            int main(void) { by_hand(); return 0; }""")
        self.assertEqual(graph.entry("by_hand")[0], 5 * 4 + 2 * 8 + 24 + graph.entry("helper")[0])

    def test_what_cannot_be_told(self):
        self.assertIn("recursion: down > down",
                      self.why_unknown("int down(int i) { return i ? i + down(i - 1) * n : 0; }"
                                       "int main(void) { return down(n); }"))
        self.assertIn("image.c", self.why_unknown("int (*volatile any)(void);"
                                                  "int main(void) { return any() + 1; }"))
        self.assertIn("no fixed size", self.why_unknown("int main(void) { volatile char room[n]; room[0] = 1;"
                                                        "return room[0]; }"))

    def test_calls_through_the_hal_reach_what_the_board_put_there(self):
        board = self.folder / stack.BOARD
        board.mkdir(parents=True)
        text = """
            typedef struct { int (*now)(void); int (*later)(void); } table;
            static int now(void) { volatile char room[500]; room[n] = 1; return room[0]; }
            static int later(void) { volatile char room[900]; room[n] = 1; return room[0]; }
            static const table board = {.now = now, .later = later};
            const table *volatile hal = &board;
            """
        (board / "board.c").write_text(text)
        bytes_n, path = self.graph(text + "int main(void) { return hal->now() + 1; }").entry("main")
        self.assertEqual([stack.base_name(title) for title in path], ["main", "now"])
        self.assertTrue(500 <= bytes_n < 600)
        (board / "board.c").write_text("")
        self.assertIn("now", self.why_unknown(text + "int main(void) { return hal->now() + 1; }"))


if __name__ == "__main__":
    unittest.main()
