"""The keys of a settings file: the parameters themselves, with their units in the names."""

import ast
import inspect
import re
import textwrap
from collections.abc import Callable, Mapping, Sequence
from copy import copy
from dataclasses import fields, is_dataclass
from functools import cache
from itertools import pairwise
from types import UnionType
from typing import Annotated, Any, Optional, get_args, get_origin, get_type_hints

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, create_model

from hemma.errors import HemmaError, ParameterError, shortened
from hemma.forecasting.shape import ShapeForecast
from hemma.home import Battery, ComfortBand, ExplicitThermalModel, Hvac
from hemma.identification.excitation import Excitation
from hemma.identification.settings import IdentificationSettings
from hemma.irl.cloning import CloningSettings
from hemma.optimisation.horizon import Horizon
from hemma.optimisation.hvac import DescentSettings
from hemma.settings.experiment import ComfortPrices, DefaultController, Experiment, ParetoSettings
from hemma.settings.faults import FaultSettings
from hemma.settings.plausibility import LONGEST_LIST, LONGEST_WORD, Limits, limits_of
from hemma.settings.yaml_file import place_in
from hemma.types import Scalar

NAMES: dict[type, dict[str, str]] = {
    Battery: {
        "max_energy": "max_energy_kwh",
        "min_energy": "min_energy_kwh",
        "initial_energy": "initial_energy_kwh",
        "max_charging_power": "max_charging_kw",
        "max_discharging_power": "max_discharging_kw",
        "ageing_cost": "ageing_per_kwh",
    },
    ExplicitThermalModel: {
        "inertia": "inertia_per_hour",
        "efficiency": "coefficient_of_performance",
        "conductance": "conductance_kw_per_c",
    },
    Hvac: {"max_power": "max_power_kw"},
    ComfortBand: {"low": "low_c", "high": "high_c"},
    Excitation: {"mean_hold": "mean_hold_h", "margin": "margin_c"},
    IdentificationSettings: {"window": "window_h"},
    Horizon: {"planned": "planned_h", "carried_out": "carried_out_h"},
    DescentSettings: {"tolerance": "tolerance_kw"},
    CloningSettings: {"held_out": "held_out_every_days"},
    ComfortPrices: {"tolerance": "tolerance_c"},
    ParetoSettings: {"relaxations": "relaxations_c"},
    ShapeForecast: {"history": "history_h", "closeness": "closeness_h"},
    DefaultController: {"refitted": "refitted_days", "published_at": "published_at_h"},
    FaultSettings: {
        "disturbance": "disturbance_c",
        "temperature_noise": "temperature_noise_c",
        "margin": "margin_c",
    },
    Experiment: {
        "initial_temperature": "initial_indoor_c",
        "disturbance_deviation": "thermal_disturbance_c",
        "forecast_horizon": "forecast_horizon_h",
    },
}
"""Parameters that have another name in the file than inside, mostly with the unit behind it."""


EARLIER: dict[type, tuple[str, ...]] = {
    CloningSettings: ("held_out",),
    ComfortPrices: ("tolerance",),
    ParetoSettings: ("relaxations",),
    ShapeForecast: ("history", "closeness"),
    DefaultController: ("refitted", "published_at"),
    FaultSettings: ("disturbance", "temperature_noise", "margin"),
    Experiment: ("forecast_horizon",),
}
"""Parameters whose key was their name before it had its unit; files that have it are still understood."""


class Keys(BaseModel):
    """A section of the file; no other keys than these."""

    model_config = ConfigDict(extra="forbid", frozen=True)


@cache
def section(target: type) -> type[Keys]:
    """The keys of one class of parameters, with the types and limits that they must keep."""
    hints = get_type_hints(target)
    content: dict[str, Any] = {
        field.name: (
            _checked(hints[field.name], limits_of(target, field.name)),
            Field(alias=key_of(target, field.name)),
        )
        for field in fields(target)
    }
    return create_model(f"{target.__name__}Keys", __base__=Keys, **content)


def in_keys_of_today(target: Any, given: Any) -> Any:
    """What a file says, its earlier keys replaced by those of today."""
    if not isinstance(given, dict) or not (isinstance(target, type) and is_dataclass(target)):
        return given
    hints, content = get_type_hints(target), copy(given)
    for name in (field.name for field in fields(target)):
        key = key_of(target, name)
        if name in EARLIER.get(target, ()) and name in content and key not in content:
            content[key] = content.pop(name)
        if key in content:
            content[key] = in_keys_of_today(hints[name], content[key])
    return content


def key_of(target: type, name: str) -> str:
    """The key of a parameter."""
    return NAMES.get(target, {}).get(name, name)


def outside(value: Any) -> Any:
    """Parameters as the file has them: mappings, lists and numbers."""
    if is_dataclass(value):
        target = type(value)
        return {key_of(target, field.name): outside(getattr(value, field.name)) for field in fields(value)}
    return [outside(item) for item in value] if isinstance(value, tuple) else value


def inside(target: type, keys: Keys, given: Any, place: tuple[str, ...] = ()) -> Any:
    """The parameters that checked keys stand for.

    Values that contradict each other raise ``HemmaError``, told by the file's keys; ``given`` is what the
    whole file says, so that a default can be called one. ``place`` leads to this section.
    """
    hints = get_type_hints(target)
    values = {field.name: getattr(keys, field.name) for field in fields(target)}
    for name, value in values.items():
        if isinstance(value, Keys):
            values[name] = inside(hints[name], value, given, (*place, key_of(target, name)))
    try:
        return target(**values)
    except ParameterError as error:
        raise HemmaError(_in_keys(error, target, values, given, place)) from error


def _in_keys(
    error: ParameterError, target: type, values: Mapping[str, Any], given: Any, place: Sequence[str]
) -> str:
    """What contradicts what, in the keys of the file, with all values that take part."""
    said = given
    for key in place:
        said = said.get(key) if isinstance(said, Mapping) else None
    said = said if isinstance(said, Mapping) else {}
    words = [word for word in re.findall(r"\w+", error.expected) if word in values]
    names = list(dict.fromkeys(words))
    expected, came = error.expected, []
    for name in names:
        key = key_of(target, name)
        expected = re.sub(rf"\b{name}\b", key, expected)
        came.append(f"{key} {shortened(outside(values[name]))}" + ("" if key in said else " (the default)"))
    set_keys = [key_of(target, name) for name in names if key_of(target, name) in said]
    where = place_in(given, (*place, set_keys[-1]) if len(names) == 1 and set_keys else place)
    return f"{where}: expected {expected}, got {', '.join(came) or shortened(error.came)}. Correct it"


def explanations(target: type) -> dict[str, str]:
    """What the text below each parameter says, by key."""
    body = ast.parse(textwrap.dedent(inspect.getsource(target))).body[0].body  # type: ignore[attr-defined]
    found = {}
    for statement, following in pairwise(body):
        if isinstance(statement, ast.AnnAssign) and isinstance(following, ast.Expr):
            text = ast.literal_eval(following.value)
            found[key_of(target, statement.target.id)] = " ".join(text.split()).replace("None", "null")  # type: ignore[attr-defined]
    return found


def _checked(hint: Any, limits: Limits) -> Any:
    if is_dataclass(hint):
        return section(hint)  # type: ignore[arg-type]
    if get_origin(hint) is tuple:
        parts = tuple(part if part is Ellipsis else _checked(part, limits) for part in get_args(hint))
        return Annotated[tuple[parts], Field(max_length=LONGEST_LIST)]
    if get_origin(hint) is UnionType and hint != Scalar:
        return Optional[_checked(get_args(hint)[0], limits)]  # noqa: UP045 - the type is only known now
    if hint in (float, int, Scalar):
        return Annotated[int if hint is int else float, BeforeValidator(_number(hint is int, limits))]
    return Annotated[str, BeforeValidator(_word)] if hint is str else hint


def _number(is_whole: bool, limits: Limits) -> Callable[[Any], int | float]:
    """A check that leaves nothing to conversion: no words, and no yes and no, which YAML has as switches."""

    def check(value: Any) -> int | float:
        kind = "a whole number" if is_whole else "a number"
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise ValueError(f"expected {kind}, got {shown(value)}. Correct it")
        limits.check(value)
        if is_whole and value != int(value):
            raise ValueError(f"expected {kind}, got {value}. Correct it")
        return value

    return check


def _word(value: Any) -> str:
    if not (isinstance(value, str) and value.isprintable() and 0 < len(value) <= LONGEST_WORD):
        raise ValueError(
            f"expected a word of at most {LONGEST_WORD} characters, got {shown(value)}; put quotes around "
            "what YAML takes for something else"
        )
    return value


def shown(value: Any) -> str:
    """What a file says, as a message repeats it."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    return "nothing" if value is None else shortened(repr(value))
