"""The least path from 0 to the end, where some edges share a cost: the mixed requests.

An edge costs its own bytes, and so many mixed words. All mixed words of a path together cost
``base * ceil(words / capacity)``. That is a shortest path with one resource, solved exactly:

- Each word priced at ``base / capacity``, its share of a full request, no path costs less than the shortest
  one at that price: the shortest rest from every node is a bound from below.
- Any path is a bound from above; the shortest ones at three prices are tried first.
- From node to node all (words, cost) are kept that are not dominated, and that could, with the bound of their
  rest, still beat the best path. Nothing better is ever dropped, so the end holds the least.
"""

from __future__ import annotations

from math import ceil
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

_EPSILON = 1e-6


class Edge(NamedTuple):
    """A step of a path.

    Attributes:
        to: the node it leads to, farther on than the one it comes from.
        cost: its own bytes.
        words: mixed words.
        piece: what it stands for.
    """

    to: int
    cost: float
    words: int
    piece: object


def least_path(end: int, edges: Callable[[int], Iterable[Edge]], base: float, capacity: int) -> list[object]:
    """The pieces of the least path from node 0 to node ``end``.

    Args:
        end: the last node.
        edges: the edges from a node; every node but the last has one.
        base: what each mixed request costs.
        capacity: how many words a mixed request holds.
    """
    graph = _reachable(end, edges)
    nodes = sorted(graph)

    def total(pieces: list[Edge]) -> float:
        words = sum(edge.words for edge in pieces)
        return sum(edge.cost for edge in pieces) + base * ceil(words / capacity)

    price = base / capacity
    candidates = [_shortest(graph, nodes, end, each) for each in (price, 0.0, base)]
    best = min((path for path, _ in candidates), key=total)
    better = _search(
        graph, nodes, end, base=base, capacity=capacity, rest=candidates[0][1], limit=total(best)
    )
    return [edge.piece for edge in better or best]


def _reachable(end: int, edges: Callable[[int], Iterable[Edge]]) -> dict[int, list[Edge]]:
    graph: dict[int, list[Edge]] = {}
    todo = [0]
    while todo:
        node = todo.pop()
        if node == end or node in graph:
            continue
        graph[node] = list(edges(node))
        todo += [edge.to for edge in graph[node]]
    return graph


def _shortest(
    graph: dict[int, list[Edge]], nodes: list[int], end: int, price: float
) -> tuple[list[Edge], dict[int, float]]:
    """The shortest path at this price a word, and the shortest rest from every node."""
    rest = {end: 0.0}
    step: dict[int, Edge] = {}
    for node in reversed(nodes):
        step[node] = min(graph[node], key=lambda edge: edge.cost + price * edge.words + rest[edge.to])
        taken = step[node]
        rest[node] = taken.cost + price * taken.words + rest[taken.to]
    path = []
    at = 0
    while at != end:
        path.append(step[at])
        at = step[at].to
    return path, rest


class _Label(NamedTuple):
    cost: float
    before: _Label | None
    edge: Edge | None


def _search(
    graph: dict[int, list[Edge]],
    nodes: list[int],
    end: int,
    *,
    base: float,
    capacity: int,
    rest: dict[int, float],
    limit: float,
) -> list[Edge] | None:
    """A path that costs less than ``limit``, the least of all; None if there is none."""
    price = base / capacity
    labels: dict[int, dict[int, _Label]] = {node: {} for node in [*nodes, end]}
    labels[0][0] = _Label(0.0, None, None)
    for node in nodes:
        for words, label in _undominated(labels[node]):
            for edge in graph[node]:
                cost = label.cost + edge.cost
                used = words + edge.words
                if (
                    max(cost + price * used + rest[edge.to], cost + base * ceil(used / capacity))
                    >= limit - _EPSILON
                ):
                    continue
                known = labels[edge.to].get(used)
                if known is None or cost < known.cost:
                    labels[edge.to][used] = _Label(cost, label, edge)
    found = [(label.cost + base * ceil(words / capacity), label) for words, label in labels[end].items()]
    if not found:
        return None
    cost, last = min(found, key=lambda pair: pair[0])
    if cost >= limit:
        return None
    path: list[Edge] = []
    while last.before is not None and last.edge is not None:
        path.append(last.edge)
        last = last.before
    return path[::-1]


def _undominated(labels: dict[int, _Label]) -> list[tuple[int, _Label]]:
    """Those that no other label with fewer words and less cost makes useless."""
    kept: list[tuple[int, _Label]] = []
    least = float("inf")
    for words in sorted(labels):
        label = labels[words]
        if label.cost < least:
            least = label.cost
            kept.append((words, label))
    return kept
