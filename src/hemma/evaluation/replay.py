"""Replay a controller over a period in double precision: what every method is measured by."""

from dataclasses import dataclass
from typing import Any

import equinox as eqx
import jax
import numpy as np
from jaxtyping import Float

from hemma.home import AbstractController, Home, Step, replay_in_double
from hemma.types import Array, Exogenous


@dataclass(frozen=True)
class Outcome:
    """What a controller did to a home, one value a slot; energies and temperatures at the end of the slot."""

    battery_power: Float[np.ndarray, "slots"]
    """e [kW], charging positive, as carried out."""
    hvac_power: Float[np.ndarray, "slots"]
    """h [kW], as carried out."""
    battery_energy: Float[np.ndarray, "slots"]
    """E [kWh] at the end of the slot."""
    indoor_temperature: Float[np.ndarray, "slots"]
    """T_in [degC] at the end of the slot."""
    grid_power: Float[np.ndarray, "slots"]
    """g [kW], buying positive."""
    transaction: Float[np.ndarray, "slots"]
    """X1 [currency]."""
    ageing: Float[np.ndarray, "slots"]
    """X2 [currency]."""
    temperature_deviation: Float[np.ndarray, "slots"]
    """X3 [degC]."""

    @property
    def cost(self) -> Float[np.ndarray, "slots"]:
        """X1 + X2 of each slot [currency], objective (1)."""
        return self.transaction + self.ageing

    @property
    def total_deviation(self) -> float:
        """D, the sum of X3 over the period [degC], objective (2)."""
        return float(np.sum(self.temperature_deviation))


def evaluate(
    home: Home,
    exogenous: Exogenous,
    controller: AbstractController,
    key: Array,
    disturbance_deviation: float = 0.0,
) -> Outcome:
    """Run ``controller`` from the home's initial state through ``exogenous`` without any reset.

    Everything is cast to float64, whatever precision the controller was trained in. The thermal
    disturbance of the home is replaced by one of ``disturbance_deviation`` [degC]: none unless asked for,
    because perfect information knows none either.
    """
    home = eqx.tree_at(lambda h: h.disturbance_deviation, home, disturbance_deviation)
    return outcome_of(replay_in_double(home, exogenous, controller, key=key).steps)


def evaluate_stacked(
    home: Home,
    exogenous: Exogenous,
    controllers: AbstractController,
    keys: Array,
    disturbance_deviation: float = 0.0,
) -> tuple[Outcome, ...]:
    """``evaluate`` for one controller a seed: every array of ``controllers`` and ``keys`` is stacked along
    its first axis. They run one after the other, so that no outcome depends on how many there are."""

    def evaluated(run: int) -> Outcome:
        controller = jax.tree.map(lambda x: x[run] if eqx.is_array(x) else x, controllers)
        return evaluate(home, exogenous, controller, keys[run], disturbance_deviation)

    return tuple(evaluated(run) for run in range(len(keys)))


def outcome_of(steps: Step) -> Outcome:
    """The outcome of carried-out ``steps``, shape (slots,)."""
    taken: Any = jax.tree.map(np.asarray, steps)
    return Outcome(
        battery_power=taken.action.battery_power,
        hvac_power=taken.action.hvac_power,
        battery_energy=taken.state.battery_energy,
        indoor_temperature=taken.state.indoor_temperature,
        grid_power=taken.grid_power,
        transaction=taken.costs.transaction,
        ageing=taken.costs.ageing,
        temperature_deviation=taken.costs.temperature_deviation,
    )
