"""The wait of a simulator, which a signal ends."""

from __future__ import annotations

import os
import signal
import threading

import pytest

from fatektool.simulator.build import build_simulation
from fatektool.simulator.listen.servers import Server
from tests.guard import GUARD_S
from tests.platforms import posix


@posix("the handler of a signal is run in another thread, as Windows does it for Ctrl-C")
def test_ctrl_c_ends_a_wait_that_it_does_not_interrupt() -> None:
    """The main thread takes no signal: nothing but the byte for it can end the wait for a client."""
    server = Server(build_simulation())
    server.open_tcp()
    waits, ended = threading.Event(), threading.Event()
    late: list[bool] = []

    def begun() -> bool:
        waits.set()
        return False

    def interrupt() -> None:
        waits.wait()
        os.kill(os.getpid(), signal.SIGINT)
        if not ended.wait(GUARD_S):
            late.append(True)
            server.stop()

    thread = threading.Thread(target=interrupt)
    thread.start()
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        with pytest.raises(KeyboardInterrupt):
            server.serve_until(begun)
    finally:
        ended.set()
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
        thread.join()
        server.close()
    assert not late
    assert signal.set_wakeup_fd(-1) == -1  # as it was
