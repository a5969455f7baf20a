"""Start the given command in a terminal of 100x30, press + and q, and exit with its code."""

import fcntl
import os
import pty
import select
import struct
import sys
import termios
import time

MAX_SECONDS = 30
KEYS = {1.5: b"+", 2.5: b"v", 4.0: b"q"}  # s after the first output: key


def main() -> int:
    """Return 1 unless the program ended with code 0 after painting."""
    pid, terminal = pty.fork()
    if pid == 0:
        fcntl.ioctl(0, termios.TIOCSWINSZ, struct.pack("HHHH", 30, 100, 0, 0))
        os.environ["TERM"] = "xterm-256color"
        os.execvp(sys.argv[1], sys.argv[1:])
    began = time.monotonic()
    first_output = None
    waiting = dict(KEYS)
    output = b""
    while time.monotonic() - began < MAX_SECONDS:
        if select.select([terminal], [], [], 0.1)[0]:
            try:
                output += os.read(terminal, 65536)
            except OSError:  # the program has ended
                break
            first_output = first_output or time.monotonic()
        for delay in list(waiting):
            if first_output and time.monotonic() - first_output > delay:
                os.write(terminal, waiting.pop(delay))
    else:
        os.kill(pid, 9)
    code = os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])
    if code != 0:
        sys.stderr.buffer.write(output[-3000:])
    print(f"exit code {code} after {time.monotonic() - began:.1f} s, {len(output)} bytes of output")
    return int(code != 0 or len(output) < 10_000)


if __name__ == "__main__":
    sys.exit(main())
