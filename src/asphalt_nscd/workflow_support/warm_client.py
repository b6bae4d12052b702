"""Hands a step to the warm process (`warm`) and stands for it: signals, exit status, death. Else starts the step.

It runs as `python -I -S warm_client.py ADDRESS COMMAND WORDS...` and loads little, which is its purpose.
"""

import os
import signal
import socket
import sys
from contextlib import suppress

PASSED_ON = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGTSTP, signal.SIGCONT)


def handed_over(address: str, words: list[str]) -> socket.socket | None:
    """The connection to the warm process that has begun a step; None where there is none, or it will not."""
    variables = [f"{name}={value}" for name, value in os.environ.items()]
    request = os.fsencode("\0".join([os.getcwd(), str(len(words)), *words, *variables]))
    connection = socket.socket(socket.AF_UNIX)
    try:
        connection.connect(address)
        socket.send_fds(connection, [len(request).to_bytes(4)], [0, 1, 2])
        connection.sendall(request)
        return connection if connection.recv(1) else None
    except OSError:
        return None


def stand_for_it(connection: socket.socket) -> None:
    """Wait for the end of a step, pass signals on to it, and end as it did."""

    def pass_on(number: int, _: object) -> None:
        with suppress(OSError):  # it has just ended
            connection.send(bytes([number]))
        if number == signal.SIGTSTP:
            os.kill(os.getpid(), signal.SIGSTOP)

    for number in PASSED_ON:
        signal.signal(number, pass_on)
    # nothing comes where the warm process has died: a failure
    ended = int.from_bytes(connection.recv(4) or b"\1", signed=True)
    if ended < 0:
        if -ended in PASSED_ON:
            signal.signal(-ended, signal.SIG_DFL)
        os.kill(os.getpid(), -ended)
    sys.exit(ended)


if __name__ == "__main__":
    step = handed_over(sys.argv[1], sys.argv[2:])
    if step is None:
        os.execv(sys.argv[2], sys.argv[2:])
    stand_for_it(step)
