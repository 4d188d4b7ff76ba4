"""The updates that fit the network: mean square error over multi-step windows, Adam, compiled in chunks."""

import equinox as eqx
import jax
import jax.numpy as jnp
import optax

from hemma.home.thermal import ThermalDrivers
from hemma.identification.pcnn import PcnnWeights, PhysicallyConsistentNetwork
from hemma.identification.record import ThermalRecord
from hemma.identification.settings import IdentificationSettings
from hemma.identification.validation import run_free, windows
from hemma.types import Array


class NetworkTrainingState(eqx.Module):
    """What changes from update to update."""

    model: PhysicallyConsistentNetwork
    optimiser: optax.OptState


class NetworkTraining(eqx.Module):
    """The two parts of a record and what is done with them."""

    settings: IdentificationSettings = eqx.field(static=True)
    length: int = eqx.field(static=True)
    """Slots of a window."""
    training: ThermalRecord
    validation: ThermalRecord

    @property
    def optimiser(self) -> optax.GradientTransformation:
        """Adam, its step falling to zero along a cosine."""
        return optax.adam(optax.cosine_decay_schedule(self.settings.learning_rate, self.settings.updates))

    def initial(self, model: PhysicallyConsistentNetwork) -> NetworkTrainingState:
        """State before the first update."""
        return NetworkTrainingState(model, self.optimiser.init(eqx.filter(model.weights, eqx.is_array)))

    @eqx.filter_jit
    def updates(self, state: NetworkTrainingState, keys: Array) -> tuple[NetworkTrainingState, Array]:
        """One update per key; the mean square error of each [degC^2]."""
        constant = state.model

        def update(
            carry: tuple[PcnnWeights, optax.OptState], key: Array
        ) -> tuple[tuple[PcnnWeights, optax.OptState], Array]:
            weights, optimiser = carry
            gradients, error = jax.grad(self.loss, has_aux=True)(weights, constant, key)
            changes, optimiser = self.optimiser.update(gradients, optimiser)
            return (eqx.apply_updates(weights, changes), optimiser), error

        (weights, optimiser), errors = jax.lax.scan(update, (constant.weights, state.optimiser), keys)
        return NetworkTrainingState(_with_weights(constant, weights), optimiser), errors

    def loss(
        self, weights: PcnnWeights, constant: PhysicallyConsistentNetwork, key: Array
    ) -> tuple[Array, Array]:
        """Mean square error over random windows plus the penalty on f, and the error alone [degC^2]."""
        last = self.training.slots - self.length
        starts = jax.random.randint(key, (self.settings.batch,), 0, last + 1)
        drivers, measured = windows(self.training, starts, self.length)
        error, gain = _errors(_with_weights(constant, weights), drivers, measured)
        return error + self.settings.gain_penalty * gain, error

    @eqx.filter_jit
    def validation_error(self, model: PhysicallyConsistentNetwork) -> Array:
        """Root mean square error over all windows of the validation part [degC]."""
        starts = jnp.arange(self.validation.slots - self.length + 1)
        return jnp.sqrt(_errors(model, *windows(self.validation, starts, self.length))[0])


def _errors(
    model: PhysicallyConsistentNetwork, drivers: ThermalDrivers, measured: Array
) -> tuple[Array, Array]:
    """Mean square error [degC^2] over all slots of the windows, and mean square of f / dt [(degC/h)^2]."""
    states = run_free(model, drivers, measured[0])
    gains = jnp.diff(states.memory, axis=0) / model.slot_length
    return jnp.mean((states.indoor_temperature[1:] - measured[1:]) ** 2), jnp.mean(gains**2)


def _with_weights(model: PhysicallyConsistentNetwork, weights: PcnnWeights) -> PhysicallyConsistentNetwork:
    return eqx.tree_at(lambda m: m.weights, model, weights)
