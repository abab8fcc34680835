"""The 8-bit checksum: what it lets through in one pass, and that a second pass and parity let nothing."""

from __future__ import annotations

import os

import pytest

from fatektool.errors import FatektoolError
from fatektool.jobs.programs.backup import backup
from fatektool.protocol.fatek.facon.codec import parse_frame
from fatektool.transport.base import LineSettings
from tests.night import night
from tests.protocol.decoding import framed
from tests.reliability.damage import DAMAGES, count
from tests.rigs import OLD, Rig

ANSWERS = 2000
ODD = ("bit errors, 1 in 1000", "bit errors, 1 in 200", "bit errors, 1 in 50")
"""Damages that leave each byte they hit with an odd number of wrong bits."""


@pytest.mark.parametrize("name", DAMAGES)
def test_what_passes_once_does_not_pass_twice(name: str) -> None:
    found = count(DAMAGES[name], ANSWERS, seed=2)
    assert found.damaged >= ANSWERS
    assert found.same_twice == 0
    if name in ODD:
        assert found.passed > 0, "the count counts nothing"
        assert found.unseen_by_parity == 0


@pytest.mark.parametrize("seeds", [range(25), night(range(25, 100))])
def test_a_backup_in_one_pass_may_be_wrong_and_one_in_two_is_not(seeds: range) -> None:
    """On a line so bad that most answers are damaged, and without parity."""
    wrong = {1: 0, 2: 0}
    done = {1: 0, 2: 0}
    for seed in seeds:
        for passes in (1, 2):
            rig = Rig(faults=["bit-errors=0.005"], seed=seed, retries=40)
            try:
                found = backup(rig.plc, single_pass=passes == 1, any_header=True)
            except FatektoolError:
                continue
            done[passes] += 1
            wrong[passes] += found.program != OLD
    assert done[2] > len(seeds) // 2
    assert wrong[1] > 0, "no damaged page passed: nothing was proven"
    assert wrong[2] == 0


@pytest.mark.skipif(not hasattr(os, "openpty"), reason="no terminals to set here")
@pytest.mark.parametrize("before", ["8N1", "7E1"])
def test_the_driver_is_asked_to_check_parity(before: str) -> None:
    import termios

    from fatektool.transport.serial_line.settings import check_parity

    master, slave = os.openpty()
    try:
        assert check_parity(slave, LineSettings(format=before))
        for form in ("7E1", "7O1", "8E1", "8N1"):
            assert check_parity(slave, LineSettings(format=form))
            flags = termios.tcgetattr(slave)[0]
            assert bool(flags & termios.INPCK) == ("N" not in form)
            assert not flags & (termios.IGNPAR | termios.PARMRK)  # a byte dropped or doubled would hide it
    finally:
        os.close(master)
        os.close(slave)
    assert not check_parity(slave, LineSettings())


def test_both_passes_are_needed_by_the_checksum_alone() -> None:
    """Two wrong bits that cancel: the sum is right, the page is not, the parity of both is wrong."""
    answer = framed(b"014F0" + b"01" * 128)
    spoiled = answer[:6] + b"10" + answer[8:]  # 30 31 became 31 30: one bit in each
    assert spoiled != answer
    assert parse_frame(spoiled).data[1:3] == b"10"
    odd = [(a ^ b).bit_count() % 2 for a, b in zip(answer, spoiled, strict=True) if a != b]
    assert odd == [1, 1]
