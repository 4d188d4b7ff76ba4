"""The keys of a settings file: the parameters themselves, with their units in the names."""

import ast
import inspect
import textwrap
from dataclasses import fields, is_dataclass
from functools import cache
from itertools import pairwise
from types import UnionType
from typing import Annotated, Any, Optional, get_args, get_origin, get_type_hints

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, create_model

from hemma.home import Battery, ComfortBand, ExplicitThermalModel, Hvac
from hemma.identification.excitation import Excitation
from hemma.identification.settings import IdentificationSettings
from hemma.optimisation.horizon import Horizon
from hemma.optimisation.hvac import DescentSettings
from hemma.optimisation.programme import SolverSettings
from hemma.settings.experiment import Experiment, ParetoSettings
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


def _no_switch(value: Any) -> Any:
    """YAML reads yes, no, on and off as switches; none of them is a number."""
    if isinstance(value, bool):
        raise ValueError(f"a number is expected, not {'yes' if value else 'no'}")
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


def inside(target: type, keys: Keys) -> Any:
    """The parameters that checked keys stand for; their own checks raise ``HemmaError``."""
    hints = get_type_hints(target)
    values = {
        field.name: inside(hints[field.name], value) if isinstance(value, Keys) else value
        for field in fields(target)
        for value in [getattr(keys, field.name)]
    }
    return target(**values)


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
        return Annotated[kind, BeforeValidator(_no_switch), limit]
    return hint
