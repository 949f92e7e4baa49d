"""The deepest that the stack can get: call graph of gcc (-fcallgraph-info=su), completed by the disassembly.

gcc tells frames and calls of all it has compiled; what it has not (the C library, assembler) is read from the
image's instructions. Calls through pointers are resolved by INDIRECT below; one that no line there covers is an
error, and so are recursion and a frame whose size is not known beforehand.
"""
import pathlib
import re

import elf

# Calls through pointers: the source text that makes the call; where the pointers are set, and what that looks like
# (group 1 is the function's name; {member} stands for what the call's own group 1 has matched). The call may reach
# each of these.
ALWAYS, EVENTUALLY, NEVER = range(3)  # somebody sets one; perhaps nobody; nobody on the board, without looking
BOARD, SERVOS = "firmware/boards/stm32f405", "firmware/servos"
MEMBER = r"\.{member}\s*=\s*&?(\w+)"
STEP = r"servo_bus_step \w+ = {{"
INDIRECT = [
    (r"\bhal->(\w+)\(", ALWAYS, BOARD, MEMBER),  # hal.h: the board fills in one
    (r"\bwatcher\.(\w+)\(", EVENTUALLY, BOARD, MEMBER),  # device.h: the simulator's log
    (r"->(force)\(", NEVER, BOARD, MEMBER),  # rod.h: a force from outside
    (r"script\[0\]->(ask)\(", ALWAYS, SERVOS, r"servo_bus_step ON = {{(\w+),"),  # ask_go: has just begun that script
    (r"->(ask)\(", ALWAYS, SERVOS, STEP + r"(\w+),"),  # servo_bus_private.h: the steps of scripts
    (r"->(took)\(", ALWAYS, SERVOS, STEP + r"\w+, (\w+),"),
    (r"->(lost)\(", ALWAYS, SERVOS, STEP + r"\w+, \w+, (\w+)}}"),
    (r"->(each)\(", ALWAYS, SERVOS, r"servo_bus_ask_many\(b, [^;]*, (\w+)\);"),
]

FRAME_BYTES = 104 + 4  # of an exception with the FPU in use, and its alignment: ARMv7-M ARM, B1.5.7
INDIRECT_CALL = "__indirect_call"


class Unknown(Exception):
    """The depth cannot be told; the text says why."""


def base_name(title):
    return title.rsplit(":", 1)[-1]


class Graph:
    def __init__(self, image, builds, root):
        self.root = pathlib.Path(root)
        self.frames, self.calls, self.kinds = {}, {}, {}
        self.memo = {}
        for path in sorted(path for build in builds for path in pathlib.Path(build).rglob("*.ci")):
            self.read_ci(path.read_text(encoding="utf-8"))
        if not self.frames:
            raise Unknown(f"no call graph under {', '.join(map(str, builds))}: compile with -fcallgraph-info=su")
        self.named = {}
        for title in self.frames:
            self.named.setdefault(base_name(title), []).append(title)
        self.read_image(elf.functions(image))

    def read_ci(self, text):
        for title, label in re.findall(r'^node: \{ title: "([^"]+)" label: "([^"]+)" \}', text, re.MULTILINE):
            frame = re.search(r"(\d+) bytes \(([^)]+)\)", label)
            if frame:
                self.frames[title], self.kinds[title] = int(frame[1]), frame[2]
        for caller, target, place in re.findall(
                r'^edge: \{ sourcename: "([^"]+)" targetname: "([^"]+)"(?: label: "([^"]+)")? \}', text, re.MULTILINE):
            self.calls.setdefault(caller, []).append((target, place))

    def read_image(self, functions):
        """Adds what the compiler did not see: functions without a frame, calls made in assembler."""
        for name, instructions in functions.items():
            if name not in self.named:
                self.frames[name], self.kinds[name] = frame_of(instructions)
                self.named[name] = [name]
                if any(re.match(r"blx\s+r|bx\s+(?!lr)", f"{i.mnemonic} {i.operands}") for i in instructions):
                    self.calls.setdefault(name, []).append((INDIRECT_CALL, ""))
        for name, instructions in functions.items():
            known = {base_name(target) for title in self.named[name] for target, _ in self.calls.get(title, [])}
            for target in {target for i in instructions for target in [branch_target(i)] if target}:
                if target not in known | {name} and target in self.named:
                    for title in self.named[name]:
                        self.calls.setdefault(title, []).extend((t, "") for t in self.named[target])

    def resolve(self, caller, target, place):
        """The titles that a call may reach."""
        if target != INDIRECT_CALL:
            return [target] if target in self.frames else self.named.get(base_name(target), [])
        return [title for text in called_at(place) for title in self.pointed_to(caller, place, text)]

    def pointed_to(self, caller, place, text):
        if (name := text.partition("(")[0]) in self.named:
            return self.named[name]
        for pattern, how, sources, finder in INDIRECT:
            if call := re.match(r"[^(;]*?" + pattern, text):
                return [] if how == NEVER else self.set_to(how, sources, finder.format(member=call[1]))
        raise Unknown(f"{base_name(caller)} calls through a pointer at {place or 'an unknown place'}, which INDIRECT "
                      f"in tools/firmware/stack.py does not cover: {text[:60]}")

    def set_to(self, how, sources, finder):
        text = "".join(path.read_text(encoding="utf-8") for path in sorted((self.root / sources).rglob("*.c")))
        names = set(re.findall(finder, text)) - {"NULL"}
        titles = [title for name in sorted(names) for title in self.named.get(name, [])]
        if not names <= self.named.keys() or how == ALWAYS and not names:
            raise Unknown(f"no function found for what {sources} sets by {finder}")
        return titles

    def depth(self, title, above=()):
        """(bytes, path of titles) from here down."""
        if title in above:
            raise Unknown("recursion: " + " > ".join(base_name(t) for t in [*above[above.index(title):], title]))
        if title not in self.memo:
            if "bounded" not in self.kinds[title] and self.kinds[title] != "static":
                raise Unknown(f"{base_name(title)}: a frame of no fixed size")
            reached = {t for target, place in self.calls.get(title, []) for t in self.resolve(title, target, place)}
            below = max((self.depth(t, (*above, title)) for t in sorted(reached)), default=(0, ()))
            self.memo[title] = (self.frames[title] + below[0], (title, *below[1]))
        return self.memo[title]

    def entry(self, name):
        return max((self.depth(title) for title in self.named[name]), default=(0, ()))

    def largest(self, names, n):
        """The n largest frames of all functions in reach of these, (bytes, name)."""
        todo, seen = [t for name in names for t in self.named[name]], set()
        while todo:
            title = todo.pop()
            if title not in seen:
                seen.add(title)
                for target, place in self.calls.get(title, []):
                    todo += self.resolve(title, target, place)
        return sorted(((self.frames[t], base_name(t)) for t in seen), reverse=True)[:n]


def called_at(place):
    """The source of a call, from its file:line:column on; both of a choice's, `(one ? this : that)(...)`."""
    path, line, column = place.rsplit(":", 2) if place else ("", 0, 0)
    if not path or not pathlib.Path(path).exists():
        return [""]
    lines = pathlib.Path(path).read_text(encoding="utf-8").splitlines()[int(line) - 1:][:3]
    text = " ".join([lines[0][int(column) - 1:], *(further.strip() for further in lines[1:])])
    if text.startswith((":", "?")) and (choice := re.search(r"\? (\S+) : (\S+)\)\(", lines[0])):
        return [f"{name}(" for name in choice.groups()]
    return [text]


def branch_target(instruction):
    if not re.match(r"(bl?|b(eq|ne|cs|cc|mi|pl|vs|vc|hi|ls|ge|lt|gt|le)|cbn?z)(\.[nw])?$", instruction.mnemonic):
        return None
    target = re.search(r"<([^>+]+)(\+0x[0-9a-f]+)?>", instruction.operands)
    return target and target[1]


def register_bytes(registers):
    total = 0
    for part in registers.split(","):
        first, _, last = part.strip().partition("-")
        count = int(last[1:]) - int(first[1:]) + 1 if last else 1
        total += count * (8 if first[0] == "d" else 4)
    return total


def frame_of(instructions):
    """(bytes, kind) of a function, from what it takes off the stack pointer: everything, as if all paths were one."""
    total, kind = 0, "static"
    for i in instructions:
        text = f"{i.mnemonic} {i.operands}"
        if saved := re.match(r"(?:v?push|v?stmdb\S* sp!,)\S*\s*\{([^}]+)\}", text):
            total += register_bytes(saved[1])
        elif lowered := re.match(r"subw?\S* sp, (?:sp, )?#(\d+)|str\S* .*\[sp, #-(\d+)\]!", text):
            total += int(lowered[1] or lowered[2])
        elif re.match(r"(sub|add|mov|msr)\S* (sp|MSP|PSP)\b(?!.*#\d)", text):
            kind = "dynamic"
    return total, kind


def worst(graph, handlers, own_stack=()):
    """(bytes, path) of the main loop; then (bytes, path) for each interrupt, frames included: every one of them may
    interrupt every other. Of one that changes to its own stack only the frame counts here."""
    callers, roots = {}, ["main"]
    for caller, targets in graph.calls.items():
        for target, _ in targets:
            callers.setdefault(base_name(target), set()).add(base_name(caller))
    for name in roots:  # start-up code lies below main
        roots += sorted(callers.get(name, set()) - set(roots))
    interrupts = []
    for name in set(handlers) - set(roots):
        bytes_n, path = (0, (name,)) if name in own_stack else graph.entry(name)
        interrupts.append((FRAME_BYTES + bytes_n, path))
    return max(graph.entry(name) for name in roots), sorted(interrupts, reverse=True)
