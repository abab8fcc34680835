"""docs/simulator.md says what there is, no more and no less."""

from __future__ import annotations

import re

import pytest

from fatektool.simulator import faults
from fatektool.simulator.models import MODELS
from fatektool.simulator.slaves.registry import SLAVES
from tests.root import ROOT

PAGE = (ROOT / "docs" / "simulator.md").read_text(encoding="utf-8")


def rows(heading: str) -> dict[str, str]:
    """The first two columns of the table under a heading."""
    part = PAGE.split(f"\n## {heading}\n")[1].split("\n## ")[0]
    return dict(re.findall(r"^\| `([\w-]+)` \| ([^|]+) \|", part, re.MULTILINE))


def test_faults() -> None:
    assert tuple(rows("Faults")) == faults.FAULT_KINDS


@pytest.mark.parametrize("kind", faults.FAULT_KINDS)
def test_the_module_tells_of_each_fault_too(kind: str) -> None:
    assert re.search(rf"^    {kind}(=[PN])? +\w", faults.__doc__ or "", re.MULTILINE)


def test_protocols() -> None:
    found = {name: model.strip(" `") for name, model in rows("Protocols").items()}
    assert found == {name: spoken.model for name, spoken in SLAVES.items()}
    assert set(found.values()) <= MODELS.keys()
