"""HTML as a tree, read strictly: every element that is opened is closed, in order."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from html.parser import HTMLParser
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterator

_VOID = {"meta"}


@dataclass
class Node:
    """An element."""

    name: str
    attributes: dict[str, str | None] = field(default_factory=dict)
    children: list[Node | str] = field(default_factory=list)

    def every(self, *names: str) -> Iterator[Node]:
        """All elements of these names below, in the document's order; of any name if none is given."""
        for child in self.children:
            if isinstance(child, Node):
                if not names or child.name in names:
                    yield child
                yield from child.every(*names)

    def first(self, name: str) -> Node:
        return next(self.every(name))

    @property
    def text(self) -> str:
        return "".join(child if isinstance(child, str) else child.text for child in self.children)

    @property
    def figures(self) -> list[Any]:
        """The figures below, as JSON has them."""
        return [json.loads(str(each.attributes["value"])) for each in self.every("data")]


class _Reader(HTMLParser):
    def __init__(self) -> None:
        super().__init__(convert_charrefs=True)
        self.root = Node("")
        self.open = [self.root]

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        assert len(dict(attrs)) == len(attrs), f"{tag}: an attribute twice"
        node = Node(tag, dict(attrs))
        self.open[-1].children.append(node)
        if tag not in _VOID:
            self.open.append(node)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop().name == tag, f"</{tag}> closes another element"

    def handle_data(self, data: str) -> None:
        self.open[-1].children.append(data)

    def handle_comment(self, data: str) -> None:
        raise AssertionError(f"a comment: {data}")

    def unknown_decl(self, data: str) -> None:
        raise AssertionError(f"a declaration: {data}")


def parse(html: str) -> Node:
    assert html.startswith("<!doctype html>\n")
    reader = _Reader()
    reader.feed(html)
    reader.close()
    assert len(reader.open) == 1, f"open at the end: {[node.name for node in reader.open]}"
    return reader.root.first("html")


def facts(page: Node) -> dict[str, Node]:
    """What stands at the top, by name."""
    names, values = page.every("dt"), page.every("dd")
    return {name.text: value for name, value in zip(names, values, strict=True)}


def rows(page: Node, caption: str) -> list[list[Node]]:
    """The cells of a table's body."""
    (table,) = (each for each in page.every("table") if each.first("caption").text == caption)
    return [list(row.every("th", "td")) for row in table.first("tbody").every("tr")]


def texts(page: Node, caption: str) -> list[list[str]]:
    return [[cell.text for cell in row] for row in rows(page, caption)]


def section(page: Node, heading: str) -> Node:
    (found,) = (
        each for each in page.every("section") if any(h.text == heading for h in each.every("h2", "h3"))
        and next(each.every("h2", "h3")).text == heading
    )  # fmt: skip
    return found
