"""A committee: its members learn by themselves, and it does the mean of what they would do."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest

from hemma.errors import HemmaError
from hemma.rl.policies.action_space import ActionSpace
from hemma.rl.policies.committee import Committee, CommitteePolicy
from hemma.rl.policies.spaces import FRACTIONS
from hemma.rl.task import Task

TASK = object.__new__(Task)
"""A task that nobody looks at."""


class Walk(eqx.Module):
    """The state of a learner that adds up random numbers."""

    total: jax.Array
    key: jax.Array


class Constant(eqx.Module):
    """A policy that always asks for the same."""

    fractions: jax.Array
    space: ActionSpace = eqx.field(static=True, default=FRACTIONS)

    def mean(self, features):
        return self.fractions


class Walker:
    """An algorithm whose outcome can be told by hand."""

    iterations = 25

    def start(self, task, key):
        return Walk(jnp.zeros(()), key)

    def iterate(self, state, task):
        key, draw = jax.random.split(state.key)
        total = state.total + jax.random.normal(draw)
        return Walk(total, key), Walk(total, total)

    def policy(self, state):
        return Constant(jnp.stack([state.total, -state.total]))


def test_each_member_is_the_algorithm_alone_with_a_key_of_its_own():
    alone, committee = Walker(), Committee(Walker(), members=3)
    together = committee.start(TASK, jax.random.key(7))
    singles = [alone.start(TASK, key) for key in jax.random.split(jax.random.key(7), 3)]
    for _ in range(4):
        together, progress = committee.iterate(together, TASK)
        steps = [alone.iterate(single, TASK) for single in singles]
        singles = [state for state, _ in steps]
    np.testing.assert_allclose(together.total, [single.total for single in singles])
    assert len({float(total) for total in together.total}) == 3
    assert float(progress.total) == pytest.approx(np.mean([single.total for single in singles]))
    assert committee.iterations == alone.iterations


def test_it_does_the_mean_of_what_its_members_can_do():
    policy = CommitteePolicy(Constant(jnp.array([[0.5, -3.0], [2.0, 0.0]])))
    np.testing.assert_allclose(policy.mean(jnp.zeros(8)), [(0.5 + 1.0) / 2, (-1.0 + 0.0) / 2])


def test_a_committee_of_one_does_what_its_member_does():
    committee = Committee(Walker(), members=1)
    state, _ = committee.iterate(committee.start(TASK, jax.random.key(1)), TASK)
    bounded = np.clip([state.total[0], -state.total[0]], -1, 1)
    np.testing.assert_allclose(committee.policy(state).mean(jnp.zeros(8)), bounded)


def test_a_committee_of_nobody_is_refused():
    with pytest.raises(HemmaError, match="members >= 1"):
        Committee(Walker(), members=0)
