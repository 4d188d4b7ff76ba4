"""The methods: in what order they stand, how they look in every figure, and what they are in plain words."""

import zlib
from collections.abc import Iterable
from dataclasses import dataclass

BLACK, GREY = "#000000", "#8A8A8A"
ORANGE, SKY, GREEN, BLUE, VERMILLION, PURPLE = (
    "#E69F00",
    "#56B4E9",
    "#009E73",
    "#0072B2",
    "#D55E00",
    "#CC79A7",
)
"""The palette of Okabe and Ito (2008), which people with any common colour blindness can tell apart."""

DASHED, DOTTED, MIXED = (0, (5, 2)), (0, (1.2, 1.4)), (0, (5, 1.5, 1.2, 1.5))


@dataclass(frozen=True)
class Look:
    """How a method looks, the same in every figure: no two methods share both colour and line."""

    colour: str
    line: str | tuple = "-"
    marker: str = "o"


@dataclass(frozen=True)
class Group:
    """Methods that may know the same things."""

    title: str
    methods: tuple[str, ...]


PUBLISHED = "Knows tomorrow's prices"
SIGHTS = {
    "past": "the last 24 hours and the day of the week",
    "published": "the prices of the coming hours as far as they are published",
    "forecast": "a forecast of the coming hours, and how well it did of late",
    "past and forecast": "the last 24 hours, the day of the week and a forecast of the coming hours",
    "published and forecast": "published prices and a forecast of what is not published",
}
"""What the words behind a method's name say that it sees."""
CAUSAL = "taught by the default controller, which knows no more, instead of the expert in hindsight"

GROUPS = (
    Group(
        "Learned from demonstrations",
        ("HA-1", "HA-2", "AIRL", "GAIL", "MaxEnt IRL", "MaxEnt IRL neural", "BC"),
    ),
    Group("Learned from a hand-written reward", ("PPO", "DDPG")),
    Group("Plans again in every slot", ("default", "MPC forecast", "MPC hourly means", "MPC yesterday")),
    Group("Fixed rules", ("thresholds", "Rule", "no battery")),
    Group(PUBLISHED, ("default published",)),
    Group("Knows the future", ("MPC perfect", "HMPC", "HMPC joint", "DNLP", "optimum")),
)
OTHERS = "Others"

_LOOKS = {
    "HA-1": Look(BLUE, "-", "o"),
    "HA-2": Look(SKY, DASHED, "s"),
    "AIRL": Look(BLUE, "-", "o"),
    "GAIL": Look(GREEN, DASHED, "s"),
    "MaxEnt IRL": Look(GREEN, DOTTED, "v"),
    "MaxEnt IRL neural": Look(GREEN, MIXED, "d"),
    "BC": Look(PURPLE, MIXED, "^"),
    "PPO": Look(ORANGE, MIXED, "D"),
    "DDPG": Look(ORANGE, DOTTED, "v"),
    "default": Look(SKY, "-", "P"),
    "default published": Look(SKY, DOTTED, "X"),
    "MPC forecast": Look(GREY, "-", "o"),
    "MPC hourly means": Look(GREY, DASHED, "s"),
    "MPC yesterday": Look(GREY, DOTTED, "^"),
    "thresholds": Look(PURPLE, DOTTED, "D"),
    "Rule": Look(VERMILLION, DASHED, "X"),
    "no battery": Look(VERMILLION, DOTTED, "P"),
    "MPC perfect": Look(GREY, MIXED, "v"),
    "HMPC": Look(BLACK, DASHED, "s"),
    "HMPC joint": Look(BLACK, "-", "o"),
    "DNLP": Look(BLACK, MIXED, "D"),
    "optimum": Look(BLACK, DOTTED, "*"),
}
"""AIRL is HA-1 and HA-2 at any demonstration length, so it wears the colour of HA-1."""

_UNKNOWN = tuple(Look(colour, DASHED, "h") for colour in (PURPLE, SKY, VERMILLION, GREEN, BLUE, ORANGE))

MEANINGS = {
    "HA-1": "HMPC-assisted adversarial inverse reinforcement learning, the shorter demonstrations",
    "HA-2": "the same method with the longer demonstrations",
    "AIRL": "the method of HA-1 and HA-2 at other demonstration lengths",
    "GAIL": "generative adversarial imitation of the demonstrations, without a reward to keep",
    "MaxEnt IRL": "maximum-entropy inverse reinforcement learning from demonstrations, a reward linear in "
    "named features",
    "MaxEnt IRL neural": "the same with a neural network as the reward",
    "BC": "behavioural cloning: a regression from states to the demonstrated actions, without any trial",
    "PPO": "reinforcement learning on the hand-written reward −(X1 + X2) − β·X3, on policy",
    "DDPG": "reinforcement learning on the same hand-written reward, off policy",
    "default": "the controller that Hemma uses unless told otherwise: plans battery and HVAC of the next "
    "hours together in every slot, does the first slot of the plan, measures, and plans again; the building "
    "is the identified network, and of several forecasts fitted to the past it takes the one that cost least "
    "to plan with on training days that the forecast had not seen",
    "default published": "the same controller where prices are published ahead: it knows today's, and from "
    "the afternoon on tomorrow's",
    "MPC forecast": "the same planner with the simplest fitted forecast: yesterday, corrected by how today "
    "differs from it",
    "MPC hourly means": "the same planner, expecting the training period's mean at each time of day",
    "MPC yesterday": "the same planner, expecting the last known value at the same time of day",
    "thresholds": "charges below one price and discharges above another, both fitted on the training "
    "period; the HVAC holds the edge of comfort by the identified building",
    "Rule": "a thermostat with hysteresis; the battery rests",
    "no battery": "holds the temperature at the edge of comfort; there is no battery",
    "MPC perfect": "the same planner as MPC forecast, told the next hours exactly: what is left is due to "
    "its horizon and to the identified building",
    "HMPC": "the expert: the two-level optimiser in hindsight, with the identified network as its model",
    "HMPC joint": "HVAC and battery planned together and exactly in hindsight through the identified "
    "network, carried out on the real home without a correction: what the expert's two levels give away",
    "DNLP": "the optimum's problem again as a nonlinear programme over the whole period in hindsight, "
    "solved by an interior-point method; a local optimum, so an independent check of the proven one",
    "optimum": "the proven least cost in hindsight, with the least deviation that is possible",
}


def plain(method: str) -> str:
    """``HA-1`` of ``HA-1 published causal``: the method that sees the paper's state and has its teacher."""
    if method in MEANINGS:
        return method
    first = [name for name in MEANINGS if method.startswith(f"{name} ") and _added(method, name) is not None]
    return first[0] if first else method


def meaning_of(method: str) -> str | None:
    """What a method is; None if nothing is known of it."""
    first = plain(method)
    return MEANINGS.get(method) if first == method else f"as {first}, {_added(method, first)}"


def _added(method: str, first: str) -> str | None:
    """What the words behind the name ``first`` add to it; None if they are no such words."""
    rest = method.removeprefix(f"{first} ")
    seen = rest.removesuffix("causal").strip()
    if seen and seen not in SIGHTS:
        return None
    parts = [f"which also sees {SIGHTS[seen]}"] if seen else []
    return ", ".join(parts + ([CAUSAL] if rest.endswith("causal") else []))


def in_order(methods: Iterable[str]) -> list[str]:
    """Method names in the order of the groups, each before those that see more or have another teacher.

    Those that no group knows come last, as they came.
    """
    known = [name for group in GROUPS for name in group.methods]
    present = list(methods)
    ours = [name for name in present if plain(name) in known]
    ours.sort(key=lambda name: (known.index(plain(name)), name != plain(name)))
    return ours + [name for name in present if plain(name) not in known]


def grouped(methods: Iterable[str]) -> dict[str, list[str]]:
    """The methods present by the titles of their groups, all in order; strangers stand under ``OTHERS``."""
    groups: dict[str, list[str]] = {group.title: [] for group in GROUPS} | {OTHERS: []}
    for name in in_order(methods):
        groups[_title(name)].append(name)
    return {title: names for title, names in groups.items() if names}


def _title(method: str) -> str:
    """Of its group; who sees published prices stands with those that know them."""
    if plain(method) != method and "published" in method:
        return PUBLISHED
    return next((group.title for group in GROUPS if plain(method) in group.methods), OTHERS)


def look_of(method: str) -> Look:
    """How a method is drawn; one that is not known here gets a look that depends on its name alone."""
    if method in _LOOKS:
        return _LOOKS[method]
    return _UNKNOWN[zlib.crc32(method.encode()) % len(_UNKNOWN)]


def main_method(methods: Iterable[str]) -> str:
    """The method that the report speaks of: HA-1, else the first in order."""
    return in_order(methods)[0]


def shown_over_time(methods: Iterable[str]) -> list[str]:
    """At most four methods whose lines can be told apart in one panel."""
    present = list(methods)
    wanted = dict.fromkeys((*in_order(present)[:1], "Rule", "PPO", "optimum"))
    return in_order(name for name in wanted if name in present)
