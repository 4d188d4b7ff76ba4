"""Demonstrations of the expert: transitions (s, a, s') of the real home, with where they come from."""

import hashlib
from dataclasses import asdict, dataclass, fields, is_dataclass, replace
from pathlib import Path

import equinox as eqx
import jax
import numpy as np
from jaxtyping import Float

import hemma
from hemma.checkpoint import load_header, load_tree, save_tree
from hemma.errors import HemmaError
from hemma.home import Home, Trajectory, paper_state
from hemma.home.precision import in_double
from hemma.optimisation.hierarchy import HierarchySettings, Progress, run_hierarchy
from hemma.types import Exogenous

KIND = "demonstrations"
STATE, ACTION = 7, 2


@dataclass(frozen=True)
class TracesOrigin:
    """Which traces were demonstrated on."""

    name: str = "unnamed"
    sha256: str = ""
    """Of the traces' file."""
    start: str = ""
    """Start of the first slot, ISO 8601 with offset."""
    stop: str = ""
    """Start of the last slot."""


@dataclass(frozen=True)
class Provenance:
    """Enough to make the same demonstrations again, and to see when they would differ."""

    traces: TracesOrigin
    slots: int
    """Slots of the period, one more than transitions."""
    slot_length: float
    """dt [h]."""
    home: str
    """The real home and all its parameters."""
    planning_model: str
    """The thermal model that the plans went through, and the SHA-256 of its parameters."""
    settings: str
    """Horizons, tolerances and seed."""
    version: str
    """Of Hemma."""


class Demonstrations(eqx.Module):
    """tau^e = {(s_i, a_i, s'_i)}, equation (9): consecutive slots, NumPy float64."""

    states: Float[np.ndarray, "samples 7"]
    """s = (p, l, E, T_out, T_in, u, t'), in the paper's order and units."""
    actions: Float[np.ndarray, "samples 2"]
    """a = (e, h) [kW] as the real home carried them out, feasible in s."""
    next_states: Float[np.ndarray, "samples 7"]
    """s': E and T_in after the slot, the rest of the slot that follows."""
    lowest_battery_power: Float[np.ndarray, "samples"]
    """Smallest feasible e in s [kW], at most 0."""
    highest_battery_power: Float[np.ndarray, "samples"]
    """Largest feasible e in s [kW], at least 0."""
    provenance: Provenance = eqx.field(static=True)

    @property
    def samples(self) -> int:
        """L, number of transitions."""
        return len(self.actions)

    def first_days(self, days: int) -> "Demonstrations":
        """The transitions that lie wholly within the first ``days`` days: s and s' both."""
        slots = round(24 * days / self.provenance.slot_length)
        if not 2 <= slots <= self.samples + 1:
            held = (self.samples + 1) * self.provenance.slot_length / 24
            raise HemmaError(
                f"demonstrations: expected 1 to {held:g} days, got {days}; demonstrate more days"
            )
        cut = jax.tree.map(lambda x: x[: slots - 1], self)
        return replace(cut, provenance=replace(self.provenance, slots=slots))


def demonstrate(
    planning_home: Home,
    real_home: Home,
    exogenous: Exogenous,
    settings: HierarchySettings | None = None,
    origin: TracesOrigin | None = None,
    on_progress: Progress | None = None,
) -> Demonstrations:
    """Let the expert run ``real_home`` over ``exogenous``, planning through ``planning_home``; write it down.

    The last slot has no successor, so L is one less than the number of slots. ``run_hierarchy`` says
    what is raised.
    """
    settings = HierarchySettings() if settings is None else settings
    if exogenous.slots < 2:
        raise HemmaError(
            f"demonstrations: expected at least 2 slots, got {exogenous.slots}; give longer traces"
        )
    run = run_hierarchy(planning_home, real_home, exogenous, settings, on_progress)
    provenance = Provenance(
        traces=TracesOrigin() if origin is None else origin,
        slots=exogenous.slots,
        slot_length=float(real_home.slot_length),
        home=_written(real_home),
        planning_model=_written(planning_home.thermal_model),
        settings=repr(settings),
        version=hemma.__version__,
    )
    return recorded(real_home, run.trajectory, provenance)


def recorded(home: Home, path: Trajectory, provenance: Provenance) -> Demonstrations:
    """The transitions of a path of ``home`` under an expert."""
    observations, (states, actions) = path.observations, states_and_actions(path)
    with jax.enable_x64(True):
        battery, energy, dt = in_double((home.battery, observations.battery_energy, home.slot_length))
        low, high = battery.power_limits(energy, dt)
    return Demonstrations(
        states=states[:-1],
        actions=actions[:-1],
        next_states=states[1:],
        lowest_battery_power=np.asarray(low)[:-1],
        highest_battery_power=np.asarray(high)[:-1],
        provenance=provenance,
    )


def states_and_actions(
    path: Trajectory,
) -> tuple[Float[np.ndarray, "slots 7"], Float[np.ndarray, "slots 2"]]:
    """s and a = (e, h) [kW] of every slot of a path, NumPy float64."""
    action = path.steps.action
    with jax.enable_x64(True):
        states = np.asarray(paper_state(path.observations))
    return states, np.stack([action.battery_power, action.hvac_power], axis=-1)


def save_demonstrations(path: Path, demonstrations: Demonstrations) -> None:
    """Write them as safetensors with their provenance in the header, whole or not at all."""
    header = {
        "kind": KIND,
        "samples": demonstrations.samples,
        "provenance": asdict(demonstrations.provenance),
    }
    save_tree(path, demonstrations, header)


def load_demonstrations(path: Path) -> Demonstrations:
    """Read what ``save_demonstrations`` wrote; another file raises ``HemmaError``."""
    header = load_header(path)
    if header.get("kind") != KIND:
        raise HemmaError(f"{path}: expected demonstrations, got {header.get('kind')!r}; demonstrate again")
    samples, origin = header["samples"], header["provenance"]
    origin["traces"] = TracesOrigin(**origin["traces"])
    like = Demonstrations(
        states=np.zeros((samples, STATE)),
        actions=np.zeros((samples, ACTION)),
        next_states=np.zeros((samples, STATE)),
        lowest_battery_power=np.zeros(samples),
        highest_battery_power=np.zeros(samples),
        provenance=Provenance(**origin),
    )
    return load_tree(path, like)


def _written(module: eqx.Module) -> str:
    """All parameters by name, large arrays by their shapes, and one digest of everything."""
    digest = hashlib.sha256()
    for leaf in jax.tree.leaves(module):
        digest.update(np.asarray(leaf, np.float64).tobytes())
    return f"{_named(module)} sha256:{digest.hexdigest()}"


def _named(value: object) -> str:
    if is_dataclass(value):
        inside = (f"{field.name}={_named(getattr(value, field.name))}" for field in fields(value))
        return f"{type(value).__name__}({', '.join(inside)})"
    if isinstance(value, tuple):
        return f"({', '.join(map(_named, value))})"
    if isinstance(value, jax.Array | np.ndarray):
        return f"{value.dtype}{list(value.shape)}" if value.ndim else repr(value.item())
    return repr(value)
