"""The selling price: on its line over the buying price where it has one, else forecast for itself."""

from dataclasses import replace

import jax
import numpy as np
import pytest

from hemma.forecasting.combined import MeanForecast, RefittedForecast
from hemma.forecasting.outlook import Outlook, hourly_means, perfect, yesterday
from hemma.forecasting.published import PublishedPrices
from hemma.forecasting.ridge import fitted
from hemma.forecasting.shape import ShapeForecast
from hemma.home.selling import fit_selling
from small_worlds import changed_after, cut, hourly_export, noisy, periodic

SHAPE = ShapeForecast()
BOTH = RefittedForecast(MeanForecast((SHAPE, fitted)), days=1)
FORECASTERS = (perfect, yesterday, hourly_means, fitted, SHAPE, BOTH, PublishedPrices(SHAPE))
LINES = {
    "share": lambda u: 0.9 * u,
    "share to four places": lambda u: np.round(0.9 * u, 4),
    "above buying": lambda u: 1.2 * u,
    "difference": lambda u: u - 0.05,
    "fixed": lambda u: np.full(len(u), 0.08),
    "nothing": np.zeros_like,
    "net metering": lambda u: u,
}


def outlook(exogenous, past_days=6):
    past, period = cut(exogenous, 24 * past_days)
    return Outlook(past, period, 1.0, 30.0)


def random_export(exogenous, seed=0):
    """A price of its own, at most the buying price."""
    share = np.random.default_rng(seed).uniform(0.1, 1.0, exogenous.slots)
    return replace(exogenous, selling_price=share * exogenous.buying_price)


@pytest.mark.parametrize("line", LINES.values(), ids=LINES)
@pytest.mark.parametrize("scale", [1.0, 1000.0])
def test_a_line_is_one_whatever_the_currency(line, scale):
    u = noisy(8, 1).buying_price
    exogenous = replace(noisy(8, 1), buying_price=scale * u, selling_price=scale * line(u))
    found = fit_selling(exogenous)
    assert found is not None
    ahead = BOTH(outlook(exogenous))
    expected = found(ahead.buying_price[:, 1:])
    np.testing.assert_allclose(ahead.selling_price[:, 1:], expected, rtol=1e-3, atol=1e-9 * scale)


@pytest.mark.parametrize("forecaster", [fitted, SHAPE])
def test_on_a_line_no_bit_of_a_forecast_is_another_than_the_lines(forecaster):
    world = outlook(noisy(8, 2))
    ahead, line = forecaster(world), fit_selling(world.past)
    assert line is not None
    np.testing.assert_array_equal(ahead.selling_price[:, 1:], line(ahead.buying_price)[:, 1:])


def test_one_import_price_has_a_line_with_one_export_price_alone():
    flat = periodic(4, price=0.3)
    assert fit_selling(replace(flat, selling_price=np.full(flat.slots, 0.08))) is not None
    assert fit_selling(replace(flat, selling_price=np.zeros(flat.slots))) is not None
    assert fit_selling(hourly_export(4)) is None
    free = replace(flat, buying_price=np.zeros(flat.slots))
    assert fit_selling(replace(free, selling_price=np.full(flat.slots, 0.08))) is not None
    assert fit_selling(replace(free, selling_price=flat.pv_generation)) is None


@pytest.mark.parametrize("forecaster", FORECASTERS)
def test_a_shape_of_its_own_that_comes_again_every_day_is_forecast_exactly(forecaster):
    base = periodic(8)
    own = replace(base, selling_price=0.05 + 0.03 * np.cos(base.hour_of_day * np.pi / 6))
    for exogenous in (own, hourly_export(8)):
        world = outlook(exogenous)
        ahead, n = forecaster(world).selling_price, world.period.slots
        for slot in (0, 11, 30):
            known = min(world.ahead, n - slot)
            np.testing.assert_allclose(
                ahead[slot, :known], world.period.selling_price[slot : slot + known], atol=1e-9
            )


@pytest.mark.parametrize("forecaster", [fitted, SHAPE, BOTH])
def test_a_shape_of_its_own_stays_within_what_was_seen(forecaster):
    exogenous = random_export(noisy(9, 3))
    world = outlook(exogenous, 7)
    ahead, v = forecaster(world), exogenous.selling_price
    assert np.min(ahead.selling_price) >= np.min(v)
    assert np.max(ahead.selling_price) <= np.max(v)
    assert np.all(ahead.selling_price <= ahead.buying_price + 1e-12)  # it never was dearer


@pytest.mark.parametrize("forecaster", [fitted, SHAPE, BOTH])
def test_later_selling_prices_change_no_earlier_forecast(forecaster):
    exogenous = random_export(noisy(8, 4))
    one, other = (
        forecaster(outlook(traces)) for traces in (exogenous, changed_after(exogenous, 6 * 24 + 20))
    )
    jax.tree.map(lambda a, b: np.testing.assert_array_equal(a[:21], b[:21]), one, other)
    assert not np.array_equal(one.selling_price[21:], other.selling_price[21:])
