"""Runs a program on QEMU's STM32F405 with semihosting; shared by the target tests."""
import subprocess


def run(qemu, program, arguments=(), count_instructions=False, plugin=None, timeout_s=300):
    """Returns what the program printed; raises CalledProcessError where it did not exit with 0."""
    config = ["enable=on", "target=native"] + [f"arg={word}" for word in ("program", *arguments)]
    command = [qemu, "-M", "olimex-stm32-h405", "-display", "none", "-monitor", "none", "-serial", "null",
               "-semihosting-config", ",".join(config), "-kernel", program]
    if count_instructions:
        command += ["-icount", "shift=0"]
    if plugin:
        command += ["-plugin", plugin]
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          timeout=timeout_s, stdin=subprocess.DEVNULL, check=False)
    if done.returncode != 0:
        raise subprocess.CalledProcessError(done.returncode, command, done.stdout)
    return done.stdout
