"""The methods in a report: in what order they stand, what they are, how they are drawn."""

import zlib
from collections.abc import Iterable

from hemma import methods as known_methods
from hemma.methods import AIRL, HA_1, method_of
from hemma.methods.looks import UNKNOWN, Look
from hemma.methods.method import AbstractLearner, Group

OTHERS = "Others"


def plain(method: str) -> str:
    """``HA-1`` of ``HA-1 published causal``: the method that sees the paper's state and has its teacher."""
    known = method_of(method)
    return known.plain if isinstance(known, AbstractLearner) and known.plain else method


def meaning_of(method: str) -> str | None:
    """What a method is; None if nothing is known of it."""
    known = method_of(method)
    return None if known is None else known.meaning


def in_order(methods: Iterable[str]) -> list[str]:
    """Method names in the order of the groups, each before those that see more or have another teacher.

    Those that nobody knows come last, as they came.
    """
    present = list(methods)
    ours = [name for name in present if method_of(name) is not None]
    places = _places()
    ours.sort(key=lambda name: (places[plain(name)], name != plain(name)))
    return ours + [name for name in present if method_of(name) is None]


def grouped(methods: Iterable[str]) -> dict[str, list[str]]:
    """The methods present by the titles of their groups, all in order; strangers stand under ``OTHERS``."""
    groups: dict[str, list[str]] = {str(group): [] for group in Group} | {OTHERS: []}
    for name in in_order(methods):
        known = method_of(name)
        groups[OTHERS if known is None else str(known.group)].append(name)
    return {title: names for title, names in groups.items() if names}


def look_of(method: str) -> Look:
    """How a method is drawn; one that is not known here gets a look that depends on its name alone."""
    known = method_of(method)
    return UNKNOWN[zlib.crc32(method.encode()) % len(UNKNOWN)] if known is None else known.drawn


def main_method(methods: Iterable[str]) -> str:
    """The method that the report speaks of: HA-1, else the first in order."""
    present = list(methods)
    return HA_1.name if HA_1.name in present else in_order(present)[0]


def shown_over_time(methods: Iterable[str]) -> list[str]:
    """At most four methods whose lines can be told apart in one panel."""
    present = list(methods)
    wanted = dict.fromkeys((*in_order(present)[:1], "Rule", "PPO", "optimum"))
    return in_order(name for name in wanted if name in present)


def _places() -> dict[str, tuple[int, int]]:
    """Of each plain method: that of its group, and its own in ``METHODS``; AIRL stands behind HA-2."""
    order = list(Group)
    listed = [*known_methods.METHODS[:2], AIRL, *known_methods.METHODS[2:]]
    return {method.name: (order.index(method.group), place) for place, method in enumerate(listed)}
