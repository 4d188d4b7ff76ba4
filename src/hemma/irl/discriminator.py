"""The discriminator's loss, equation (12), and what keeps its slope in bounds."""

import jax
import jax.numpy as jnp
import optax
from jaxtyping import Float

from hemma.irl.reward import AbstractHead
from hemma.rl.environment import Transitions
from hemma.types import Array


def cross_entropy(expert_logits: Float[Array, "samples"], agent_logits: Float[Array, "samples"]) -> Array:
    """Mean binary cross-entropy, equation (12): label 1 for the expert's transitions, 0 for the agent's."""
    expert = optax.sigmoid_binary_cross_entropy(expert_logits, jnp.ones_like(expert_logits))
    agent = optax.sigmoid_binary_cross_entropy(agent_logits, jnp.zeros_like(agent_logits))
    return 0.5 * (jnp.mean(expert) + jnp.mean(agent))


def gradient_penalty(head: AbstractHead, expert: Transitions, agent: Transitions, key: Array) -> Array:
    """E[max(|grad r| - 1, 0)^2] between expert and agent: keeps the head (AIRL: r) Lipschitz.

    Gulrajani et al. 2017 (arXiv 1704.00028), one-sided, in the features and
    fractions of a transition; Orsini et al. 2021 (arXiv 2106.00672) find that regularising the
    discriminator helps adversarial imitation in general.
    """
    share = jax.random.uniform(key, (expert.fractions.shape[0], 1))
    between = jax.tree.map(lambda e, a: share * e + (1 - share) * a, expert, agent)

    def norm(transition: Transitions) -> Array:
        gradient = jax.grad(lambda t: head(t))(transition)
        return jnp.sqrt(sum(jnp.sum(g**2) for g in jax.tree.leaves(gradient)) + 1e-12)

    return jnp.mean(jnp.maximum(jax.vmap(norm)(between) - 1.0, 0.0) ** 2)
