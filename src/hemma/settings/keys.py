"""The keys of a settings file: the parameters themselves, with their units in the names."""

import ast
import inspect
import re
import textwrap
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from functools import cache
from itertools import pairwise
from types import UnionType
from typing import Annotated, Any, Optional, get_args, get_origin, get_type_hints

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, create_model

from hemma.errors import HemmaError, ParameterError, shortened
from hemma.home import Battery, ComfortBand, ExplicitThermalModel, Hvac
from hemma.identification.excitation import Excitation
from hemma.identification.settings import IdentificationSettings
from hemma.optimisation.horizon import Horizon
from hemma.optimisation.hvac import DescentSettings
from hemma.optimisation.programme import SolverSettings
from hemma.settings.experiment import Experiment, ParetoSettings
from hemma.settings.plausibility import complaint
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
    SolverSettings: {"time_limit": "time_limit_s"},
    Experiment: {
        "initial_temperature": "initial_indoor_c",
        "disturbance_deviation": "thermal_disturbance_c",
    },
}
"""Parameters that have another name in the file than inside, mostly with the unit behind it."""

ANY_SIGN = {
    (ComfortBand, "low"),
    (ComfortBand, "high"),
    (Experiment, "initial_temperature"),
    (ParetoSettings, "relaxations"),
}
"""Parameters that may be negative."""


class Keys(BaseModel):
    """A section of the file; no other keys than these, no NaN and no infinity."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)


def _number(value: Any) -> Any:
    """YAML reads yes, no, on and off as switches; neither they nor a text such as 1_0 is a number."""
    if isinstance(value, bool):
        raise ValueError(f"a number is expected, not {'yes' if value else 'no'}")
    if isinstance(value, str):
        raise ValueError("a valid number is expected, an integer for a count")
    return value


@cache
def section(target: type) -> type[Keys]:
    """The keys of one class of parameters, with the types and limits that they must keep."""
    hints = get_type_hints(target)
    content: dict[str, Any] = {
        field.name: (
            _checked(hints[field.name], (target, field.name) in ANY_SIGN),
            Field(alias=key_of(target, field.name)),
        )
        for field in fields(target)
    }
    return create_model(f"{target.__name__}Keys", __base__=Keys, **content)


def key_of(target: type, name: str) -> str:
    """The key of a parameter."""
    return NAMES.get(target, {}).get(name, name)


def outside(value: Any) -> Any:
    """Parameters as the file has them: mappings, lists and numbers."""
    if is_dataclass(value):
        target = type(value)
        return {key_of(target, field.name): outside(getattr(value, field.name)) for field in fields(value)}
    return [outside(item) for item in value] if isinstance(value, tuple) else value


def inside(target: type, keys: Keys, given: Any, place: str = "") -> Any:
    """The parameters that checked keys stand for.

    A value that is not plausible or contradicts another raises ``HemmaError``, told by the file's keys;
    ``given`` is what the file says of this section, so that a default can be called one.
    """
    hints, said = get_type_hints(target), given if isinstance(given, Mapping) else {}
    values = {}
    for name in (field.name for field in fields(target)):
        value, key = getattr(keys, name), key_of(target, name)
        if isinstance(value, Keys):
            values[name] = inside(hints[name], value, said.get(key), f"{place}{key}.")
            continue
        wrong = complaint(target, name, value)
        if wrong is not None:
            raise HemmaError(f"{place}{key}: expected {wrong}; got {_told(key, value, said)}. Correct it")
        values[name] = value
    try:
        return target(**values)
    except ParameterError as error:
        raise HemmaError(_in_keys(error, target, values, said, place)) from error


def _in_keys(
    error: ParameterError, target: type, values: Mapping[str, Any], given: Mapping[str, Any], place: str
) -> str:
    """What contradicts what, in the keys of the file, with all values that take part."""
    named = [name for name in values if re.search(rf"\b{name}\b", error.expected)]
    expected = error.expected
    for name in named:
        expected = re.sub(rf"\b{name}\b", key_of(target, name), expected)
    came = [f"{key_of(target, n)} {_told(key_of(target, n), values[n], given)}" for n in named]
    where = place.rstrip(".") or error.owner
    return f"{where}: expected {expected}, got {', '.join(came) or shortened(error.came)}. Correct it"


def _told(key: str, value: Any, given: Mapping[str, Any]) -> str:
    return shortened(outside(value)) + ("" if key in given else " (the default)")


def explanations(target: type) -> dict[str, str]:
    """What the text below each parameter says, by key."""
    body = ast.parse(textwrap.dedent(inspect.getsource(target))).body[0].body  # type: ignore[attr-defined]
    found = {}
    for statement, following in pairwise(body):
        if isinstance(statement, ast.AnnAssign) and isinstance(following, ast.Expr):
            text = ast.literal_eval(following.value)
            found[key_of(target, statement.target.id)] = " ".join(text.split()).replace("None", "null")  # type: ignore[attr-defined]
    return found


def _checked(hint: Any, any_sign: bool) -> Any:
    if is_dataclass(hint):
        return section(hint)  # type: ignore[arg-type]
    if get_origin(hint) is tuple:
        return tuple[tuple(part if part is Ellipsis else _checked(part, any_sign) for part in get_args(hint))]
    if get_origin(hint) is UnionType and hint != Scalar:
        return Optional[_checked(get_args(hint)[0], any_sign)]  # noqa: UP045 - the type is only known now
    if hint in (float, int, Scalar):
        kind = int if hint is int else float
        limit = Field() if any_sign else Field(ge=0)
        return Annotated[kind, BeforeValidator(_number), limit]
    return hint
