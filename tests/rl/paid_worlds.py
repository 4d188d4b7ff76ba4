"""A hot home with two prices, and what a learner makes of it."""

import jax
import jax.numpy as jnp
import numpy as np

from hemma.home import Home, Step, replay
from hemma.rl import training
from hemma.rl.task import explicit_task, stack
from hemma.types import Exogenous


def two_price_traces(days=6):
    """Electricity costs a tenth by night of what it costs by day; it is hot by day."""
    hour = np.arange(24 * days) % 24.0
    price = np.where((hour >= 6) & (hour < 18), 0.5, 0.05)
    return Exogenous(
        pv_generation=np.zeros(hour.size),
        load=np.full(hour.size, 3.5),
        outdoor_temperature=29 + 5 * np.sin((hour - 9) / 24 * 2 * np.pi),
        buying_price=price,
        selling_price=0.9 * price,
        hour_of_day=hour,
    )


def paid_task(seed=0, days=6, comfort_price=0.5):
    """The task of learning from the explicit reward on such days."""
    return explicit_task(Home(), Home(), two_price_traces(days), comfort_price, seed)


def played(learner, comfort_price) -> Step:
    """Every slot of the days that ``learner`` learned from, by its result without exploration."""
    home, traces = Home(), two_price_traces()
    task = stack([paid_task(comfort_price=comfort_price)])
    trained = training.train(task, learner)
    controller = jax.tree.map(lambda x: x[0], training.controllers(trained, task, learner))
    exogenous = jax.tree.map(lambda x: jnp.asarray(x, float), traces)

    return replay(home, exogenous, controller, home.reset(), jax.random.key(0)).steps
