"""The least path from 0 to the end, if some edges have a common cost: the mixed requests.

An edge costs its own bytes, and a number of mixed words. All mixed words of a path together cost
``base * ceil(words / capacity)``. This is a shortest path with a resource, solved exactly:

- For each number of mixed requests, the words are limited, and the rest of the cost is that of the edges.
- With a price for each word, no path within the limit costs less than the shortest one at that price minus
  the price of all allowed words: a lower bound. The path found is an upper bound.
- The best price for a limit is found on the corners of (words, cost): a chord between two of them is the next
  price, until no path is below the chord.
- A number of requests whose bound is not below the best path is done. For the others, from node to node, all
  (words, cost) are kept that are not dominated and that could, with the bound of the rest, be better than the
  best path. A better path is never dropped. Before that, the same is done with a few labels for each node, to
  find a good path early.
"""

from __future__ import annotations

from heapq import nsmallest
from math import ceil, inf
from typing import TYPE_CHECKING, Final, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Callable, Generator, Iterable, Iterator

    from fatektool.protocol.elements import Element

_EPSILON: Final = 1e-6
_FEW: Final = 32
_NODES_A_STEP: Final = 8


class Run(NamedTuple):
    """A run: its first element and the number of elements."""

    symbol: str
    first: int
    length: int


class Edge(NamedTuple):
    """A step of a path.

    Attributes:
        to: the node at its end, after the one at its beginning.
        cost: its own bytes.
        words: mixed words.
        piece: a run, or mixed items.
    """

    to: int
    cost: float
    words: int
    piece: Run | list[Element]


def least_path(
    end: int, edges: Callable[[int], Iterable[Edge]], base: float, capacity: int
) -> list[Run | list[Element]]:
    """The pieces of the least path from node 0 to node ``end``.

    Args:
        end: the last node.
        edges: the edges from a node; every node but the last has one.
        base: the cost of each mixed request.
        capacity: the most words in a mixed request.
    """
    search = Search(end, edges, base, capacity)
    for _ in search.steps():
        pass
    return search.pieces


class _Priced(NamedTuple):
    """The shortest path at a price per word: its words, own cost, and the shortest rest from each node."""

    price: float
    words: int
    cost: float
    path: list[Edge]
    rest: dict[int, float]


class _Label(NamedTuple):
    cost: float
    before: _Label | None
    edge: Edge | None


class Search:
    """The search for the least path, in steps of about a millisecond or less.

    Args:
        end: as of ``least_path``.
        edges: as of ``least_path``.
        base: as of ``least_path``.
        capacity: as of ``least_path``.
    """

    def __init__(self, end: int, edges: Callable[[int], Iterable[Edge]], base: float, capacity: int) -> None:
        self._edges = edges
        self._graph: dict[int, list[Edge]] = {}
        self._end = end
        self._base = base
        self._capacity = capacity
        self._known: list[_Priced] = []
        self._best: list[Edge] = []
        self._limit = inf

    @property
    def pieces(self) -> list[Run | list[Element]]:
        """The pieces of the least path, after all steps."""
        return [edge.piece for edge in self._best]

    def steps(self) -> Iterator[None]:
        """Do the search, one step at a time."""
        yield from self._reach()
        dear = 1 + self._base + sum(max(edge.cost for edge in edges) for edges in self._graph.values())
        self._shortest(dear)  # no path has fewer words
        yield
        most = self._shortest(0.0)
        yield
        self._thin(self._shortest(self._base / self._capacity))
        yield
        stages = dict.fromkeys(range(ceil(most.words / self._capacity) + 1), 0) if self._graph else {}
        corners: dict[int, _Priced] = {}
        while left := [count for count in stages if self._bound(count) < self._limit - _EPSILON]:
            count = min(left, key=lambda count: (stages[count], self._bound(count)))
            stage = stages[count] = stages[count] + 1
            if stage == 1:
                corners[count] = yield from self._corner(count)
            elif (yield from self._beat(count, corners[count], _FEW if stage == 2 else inf)):
                del stages[count]

    def _reach(self) -> Iterator[None]:
        """Collect the edges of all nodes that a path from 0 may reach, in the order of the nodes."""
        graph = self._graph
        todo = [0]
        while todo:
            node = todo.pop()
            if node == self._end or node in graph:
                continue
            graph[node] = list(self._edges(node))
            todo += {edge.to for edge in graph[node]}
            if len(graph) % _NODES_A_STEP == 0:
                yield
        self._graph = dict(sorted(graph.items()))

    def _bound(self, count: int) -> float:
        """The lower bound of the cost of paths with this number of mixed requests."""
        words = count * self._capacity
        return self._base * count + max(one.cost + one.price * (one.words - words) for one in self._known)

    def _take(self, path: list[Edge], cost: float) -> None:
        if cost < self._limit - _EPSILON:
            self._best, self._limit = path, cost

    def _shortest(self, price: float) -> _Priced:
        rest = {self._end: 0.0}
        step: dict[int, Edge] = {}
        for node in reversed(self._graph):
            least = inf
            for edge in self._graph[node]:
                to, cost, words, _ = edge
                total = cost + price * words + rest[to]
                if total < least:
                    least = total
                    step[node] = edge
            rest[node] = least
        path = []
        at = 0
        while at != self._end:
            path.append(step[at])
            at = step[at].to
        words = sum(edge.words for edge in path)
        cost = sum(edge.cost for edge in path)
        self._take(path, cost + self._base * ceil(words / self._capacity))
        self._known.append(_Priced(price, words, cost, path, rest))
        return self._known[-1]

    def _thin(self, share: _Priced) -> None:
        """Drop the edges that no better path has, with a word's share of a full request as its price."""
        begun = dict.fromkeys(self._graph, inf)
        begun[self._end] = inf
        begun[0] = 0.0
        for node, edges in self._graph.items():
            kept = []
            for edge in edges:
                total = begun[node] + edge.cost + share.price * edge.words
                if total + share.rest[edge.to] < self._limit - _EPSILON:
                    kept.append(edge)
                    begun[edge.to] = min(begun[edge.to], total)
            self._graph[node] = kept
        self._graph = {node: edges for node, edges in self._graph.items() if edges}

    def _corner(self, count: int) -> Generator[None, None, _Priced]:
        """The best price for this number of mixed requests, or one at which they cannot be better."""
        words = count * self._capacity
        while True:
            light = max((one for one in self._known if one.words <= words), key=lambda one: one.words)
            heavy = min((one for one in self._known if one.words > words), key=lambda one: one.words)
            price = (light.cost - heavy.cost) / (heavy.words - light.words)
            found = self._shortest(price)
            yield
            on_the_chord = found.cost + price * found.words >= light.cost + price * light.words - _EPSILON
            if on_the_chord or self._bound(count) >= self._limit - _EPSILON:
                return found

    def _beat(self, count: int, corner: _Priced, width: float) -> Generator[None, None, bool]:
        """Search a better path with this number of mixed requests; True if there is none left.

        At most ``width`` labels of each node are continued, the most promising ones: few, or all.
        """
        most = count * self._capacity
        price, rest = corner.price, corner.rest
        slack = self._limit - _EPSILON - self._base * count + price * most
        labels: dict[int, dict[int, _Label]] = {node: {} for node in self._graph}
        labels[self._end] = {}
        labels[0][0] = _Label(0.0, None, None)
        all_seen = True
        for number, (node, edges) in enumerate(self._graph.items(), 1):
            if number % _NODES_A_STEP == 0:
                yield
            kept = _undominated(labels.pop(node))
            if len(kept) > width:
                all_seen = False
                kept = nsmallest(_FEW, kept, key=lambda pair: pair[1].cost + price * pair[0])
            for words, label in kept:
                space = slack - label.cost - price * words
                for edge in edges:
                    to, cost, more, _ = edge
                    if cost + price * more + rest[to] >= space or words + more > most:
                        continue
                    known = labels[to].get(words + more)
                    if known is None or label.cost + cost < known.cost:
                        labels[to][words + more] = _Label(label.cost + cost, label, edge)
        for label in labels[self._end].values():
            self._take(_path_of(label), label.cost + self._base * count)
        return all_seen


def _path_of(label: _Label) -> list[Edge]:
    path: list[Edge] = []
    while label.before is not None and label.edge is not None:
        path.append(label.edge)
        label = label.before
    return path[::-1]


def _undominated(labels: dict[int, _Label]) -> list[tuple[int, _Label]]:
    """The labels for which there is no other with fewer words and less cost."""
    kept: list[tuple[int, _Label]] = []
    least = inf
    for words in sorted(labels):
        label = labels[words]
        if label.cost < least:
            least = label.cost
            kept.append((words, label))
    return kept
