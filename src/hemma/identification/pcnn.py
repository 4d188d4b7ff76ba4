"""The physically consistent neural network (PCNN): learned gains beside a physical module.

Di Natale, Svetozarevic, Heer, Jones, "Physically Consistent Neural Networks for building thermal modeling:
Theory and analysis", Applied Energy 325, 119806 (2022); the mathematics stands in ``docs/identification.md``.
"""

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Float

from hemma.home.checks import require
from hemma.home.thermal import AbstractThermalModel, ThermalDrivers, ThermalState
from hemma.types import Array, Scalar

FEATURES = 4
"""Inputs of f: D, sin and cos of the hour, sun."""


class ThermalResponse(eqx.Module):
    """How the indoor temperature answers within one slot: the physical parameters of the PCNN."""

    heating: Scalar
    """a, warming per electric power that heats for one slot [degC/kW], above 0."""
    cooling: Scalar
    """d, cooling per electric power that cools for one slot [degC/kW], above 0."""
    loss: Scalar
    """b, share of the difference between inside and outside that is lost in one slot, in (0, 1)."""

    def __check_init__(self):
        """Refuse a building that breaks physics."""
        require("thermal response", self.heating > 0, "heating > 0", self.heating)
        require("thermal response", self.cooling > 0, "cooling > 0", self.cooling)
        require("thermal response", (self.loss > 0) & (self.loss < 1), "0 < loss < 1", self.loss)


class InputScaling(eqx.Module):
    """What makes the inputs of f of order one, taken from the training data and kept with the model."""

    temperature_mean: Scalar
    """Mean indoor temperature [degC]."""
    temperature_deviation: Scalar
    """Standard deviation of the indoor temperature [degC], above 0."""
    pv_peak: Scalar
    """Largest PV generation [kW], above 0."""


class Layer(eqx.Module):
    """x -> W x + b over the last axis. Arrays only, so that the model passes through jit, vmap and scan."""

    weight: Float[Array, "*homes out in"]
    bias: Float[Array, "*homes out"]

    @staticmethod
    def create(key: Array, size: int, outputs: int) -> "Layer":
        """Weights and biases uniform within 1 / sqrt(size) around 0."""
        bound = size**-0.5
        both = jax.random.uniform(key, (outputs, size + 1), minval=-bound, maxval=bound)
        return Layer(weight=both[:, :-1], bias=both[:, -1])

    def __call__(self, x: Float[Array, "*slots in"]) -> Float[Array, "*slots out"]:
        """W x + b."""
        return x @ self.weight.T + self.bias


class PcnnWeights(eqx.Module):
    """All that training changes."""

    log_heating: Scalar
    """w_a, logarithm of a over its start value."""
    log_cooling: Scalar
    """w_d, logarithm of d over its start value."""
    log_loss: Scalar
    """w_b, logarithm of the exponent of b over its start value."""
    layers: tuple[Layer, ...]
    """The layers of f, tanh between them."""

    @staticmethod
    def create(key: Array, width: int, depth: int) -> "PcnnWeights":
        """Physical parameters at their start values and f = 0: the last layer is zero."""
        sizes = [FEATURES, *[width] * (depth - 1)]
        keys = jax.random.split(key, depth)
        hidden = [Layer.create(key, size, width) for key, size in zip(keys, sizes, strict=True)]
        last = Layer(weight=jnp.zeros((1, width), float), bias=jnp.zeros((1,), float))
        zero = jnp.zeros((), float)
        return PcnnWeights(log_heating=zero, log_cooling=zero, log_loss=zero, layers=(*hidden, last))


class PhysicallyConsistentNetwork(AbstractThermalModel):
    """T = D + E: D moves with the gains that a network has learned, E with what physics prescribes.

    D' = D + f(D, x),    f(D, x) = dt * network(D, sin, cos, sun) [degC]
    E' = E + a u_heat - d u_cool - b (T - T_out) + epsilon_t
    a = a_0 exp(w_a),    d = d_0 exp(w_d),    b = 1 - (1 - b_0)^exp(w_b).

    f sees neither u nor T_out, and a, d > 0 and 0 < b < 1 hold for any weights. So for k = 1, 2, ... slots
    dT_k/du_heat = a (1 - b)^(k-1) > 0, dT_k/du_cool < 0 and dT_k/dT_out > 0, and T is affine in u and T_out.
    ``memory`` of the state is D. A replan starts from the measured temperature: D = T, E = 0 (``initial``).
    """

    weights: PcnnWeights
    start: ThermalResponse
    """a_0, d_0 and b_0, chosen before training."""
    scaling: InputScaling
    slot_length: Scalar
    """dt [h] of the data that the model was fitted on."""

    @property
    def heating_response(self) -> Scalar:
        """Parameter a [degC/kW]."""
        return self.start.heating * jnp.exp(self.weights.log_heating)

    @property
    def cooling_response(self) -> Scalar:
        """Parameter d [degC/kW]."""
        return self.start.cooling * jnp.exp(self.weights.log_cooling)

    @property
    def loss_share(self) -> Scalar:
        """Parameter b, share of T - T_out lost in a slot."""
        exponent = -jnp.log1p(-self.start.loss) * jnp.exp(self.weights.log_loss)
        return -jnp.expm1(-exponent)

    def gain(self, natural: Array, drivers: ThermalDrivers) -> Float[Array, "*slots"]:
        """f(D, x) [degC per slot] for the natural temperature D [degC]; of ``drivers`` only hour and sun."""
        angle = 2 * jnp.pi * drivers.hour_of_day / 24
        level = (natural - self.scaling.temperature_mean) / self.scaling.temperature_deviation
        sun = drivers.pv_generation / self.scaling.pv_peak
        x = jnp.stack(jnp.broadcast_arrays(jnp.tanh(level), jnp.sin(angle), jnp.cos(angle), sun), axis=-1)
        *hidden, last = self.weights.layers
        for layer in hidden:
            x = jnp.tanh(layer(x))
        return self.slot_length * last(x)[..., 0]

    def __call__(self, state: ThermalState, drivers: ThermalDrivers) -> ThermalState:
        """State at the end of the slot."""
        a, d, b = self.heating_response, self.cooling_response, self.loss_share
        T, D = state.indoor_temperature, state.memory
        u_heat, u_cool = drivers.heating_power, drivers.cooling_power
        E = T - D + a * u_heat - d * u_cool - b * (T - drivers.outdoor_temperature) + drivers.disturbance
        D = D + self.gain(D, drivers)
        return ThermalState(indoor_temperature=D + E, memory=D)
