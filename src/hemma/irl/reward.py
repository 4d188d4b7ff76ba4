"""What tells expert from agent, and what the agent is paid for it: one head for each adversarial method."""

import math
from abc import abstractmethod
from typing import ClassVar

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Float

from hemma.rl.environment import Transitions
from hemma.rl.policies.network import Network
from hemma.rl.policies.policy import ACTIONS, FEATURES
from hemma.types import Array


class AbstractHead(eqx.Module):
    """The learned part of a discriminator."""

    entropy_share: ClassVar[float] = 1.0
    """Share of the setting ``airl.entropy`` that counts beside its rewards."""

    @classmethod
    @abstractmethod
    def random(
        cls, hidden: tuple[int, ...], discount: float, key: Array, features: int = FEATURES
    ) -> "AbstractHead":
        """A head with random weights and hidden layers of these sizes; ``discount`` is gamma."""

    @abstractmethod
    def __call__(self, transition: Transitions) -> Float[Array, ""]:
        """The learned part of the logit of one transition."""

    @abstractmethod
    def logits(self, transitions: Transitions, log_density: Float[Array, "*batch"]) -> Float[Array, "*batch"]:
        """log d - log(1 - d), d the probability that the expert did it, who acts with log pi(a|s)."""

    @abstractmethod
    def rewards(self, transitions: Transitions) -> Float[Array, "*batch"]:
        """What the policy is to maximise."""

    def batch(self, transitions: Transitions) -> Float[Array, "*batch"]:
        """``self`` of many transitions at once."""
        shape = transitions.fractions.shape[:-1]
        samples = math.prod(shape)
        flat = jax.tree.map(lambda x: x.reshape(samples, x.shape[-1]), transitions)
        return jax.vmap(self)(flat).reshape(shape)


class ShapedReward(AbstractHead):
    """AIRL: the learned reward r = g + gamma h' - h, equation (11) of the paper (Fu et al. 2018)."""

    approximator: Network
    """g(s, a)."""
    shaping: Network
    """h(s)."""
    discount: float = eqx.field(static=True)
    """gamma."""

    @classmethod
    def random(
        cls, hidden: tuple[int, ...], discount: float, key: Array, features: int = FEATURES
    ) -> "ShapedReward":
        """Random g and h."""
        g_key, h_key = jax.random.split(key)
        g = Network((features + ACTIONS, *hidden, 1), g_key)
        return cls(g, Network((features, *hidden, 1), h_key), discount)

    def __call__(self, transition: Transitions) -> Float[Array, ""]:
        """r(s, a, s') = g(s, a) + gamma h(s') - h(s) of one transition."""
        inputs = jnp.concatenate([transition.features, transition.fractions])
        g = self.approximator(inputs)[0]
        return (
            g
            + self.discount * self.shaping(transition.next_features)[0]
            - self.shaping(transition.features)[0]
        )

    def logits(self, transitions: Transitions, log_density: Float[Array, "*batch"]) -> Float[Array, "*batch"]:
        """r - log pi: equation (10), d = exp(r) / (exp(r) + pi), needs no ratio and no exponential."""
        return self.batch(transitions) - log_density

    def rewards(self, transitions: Transitions) -> Float[Array, "*batch"]:
        """r."""
        return self.batch(transitions)


class ImitationScore(AbstractHead):
    """GAIL: a score f(s, a) that knows no policy and leaves no reward behind.

    Ho and Ermon 2016, arXiv 1606.03476.
    """

    entropy_share: ClassVar[float] = 0.1
    """Near its saddle, where f is 0, its rewards move by tenths where AIRL's move by whole numbers."""

    score: Network
    """f(s, a)."""

    @classmethod
    def random(
        cls, hidden: tuple[int, ...], discount: float, key: Array, features: int = FEATURES
    ) -> "ImitationScore":
        """Random f; the discount plays no part in it."""
        return cls(Network((features + ACTIONS, *hidden, 1), key))

    def __call__(self, transition: Transitions) -> Float[Array, ""]:
        """f(s, a) of one transition."""
        return self.score(jnp.concatenate([transition.features, transition.fractions]))[0]

    def logits(self, transitions: Transitions, log_density: Float[Array, "*batch"]) -> Float[Array, "*batch"]:
        """f: the score itself is the logit, whatever the policy's density."""
        return self.batch(transitions)

    def rewards(self, transitions: Transitions) -> Float[Array, "*batch"]:
        """-log(1 - d) = log(1 + exp f)."""
        return jax.nn.softplus(self.batch(transitions))
