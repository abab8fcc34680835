from __future__ import annotations

import os
import shutil

import pytest

from tests.wireshark.capture import Tshark


@pytest.fixture(scope="session")
def tshark(tmp_path_factory: pytest.TempPathFactory) -> Tshark:
    program = shutil.which("tshark")
    if program is None:
        if os.environ.get("CI"):
            pytest.fail("tshark is not installed: expected it where CI is set")
        pytest.skip("tshark is not installed")
    return Tshark(program, tmp_path_factory.mktemp("wireshark"))
