"""Forecasts: exact where the world repeats itself, blind to the future, and never outside what can be."""

from dataclasses import replace

import jax
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from small_worlds import changed_after, cut, noisy, periodic

from hemma.baselines.fitted_forecast import fitted
from hemma.baselines.forecast import Outlook, hourly_means, perfect, yesterday
from hemma.baselines.selling import fit_selling
from hemma.errors import HemmaError
from hemma.types import Exogenous

FORECASTERS = (perfect, yesterday, hourly_means, fitted)
BLIND = (yesterday, hourly_means, fitted)
QUANTITIES = ("pv_generation", "load", "outdoor_temperature", "buying_price", "selling_price", "hour_of_day")


def outlook(exogenous: Exogenous, past_days: int, slot_length: float = 1.0, horizon: float = 30.0) -> Outlook:
    past, period = cut(exogenous, round(past_days * 24 / slot_length))
    return Outlook(past, period, slot_length, horizon)


def truth(world: Outlook, quantity: str) -> np.ndarray:
    """Value of slot t + k in row t, column k; NaN beyond the end. A plain loop."""
    series, n = getattr(world.period, quantity), world.period.slots
    return np.array([[series[t + k] if t + k < n else np.nan for k in range(world.ahead)] for t in range(n)])


@pytest.mark.parametrize("forecaster", FORECASTERS)
@pytest.mark.parametrize("slot_length", [1.0, 0.25])
def test_a_periodic_world_is_forecast_exactly(forecaster, slot_length):
    world = outlook(periodic(8, slot_length), 6, slot_length)
    ahead = forecaster(world)
    for quantity in QUANTITIES:
        forecast, true = getattr(ahead, quantity), truth(world, quantity)
        assert forecast.shape == (world.period.slots, world.ahead)
        inside = ~np.isnan(true)
        np.testing.assert_allclose(forecast[inside], true[inside], atol=1e-9, err_msg=quantity)
        assert np.all(np.isfinite(forecast))


@pytest.mark.parametrize("forecaster", FORECASTERS)
def test_the_present_slot_and_the_clock_are_known(forecaster):
    world = outlook(noisy(8, 1), 6)
    ahead = forecaster(world)
    for quantity in QUANTITIES:
        np.testing.assert_array_equal(getattr(ahead, quantity)[:, 0], getattr(world.period, quantity))
    true = truth(world, "hour_of_day")
    np.testing.assert_array_equal(ahead.hour_of_day[~np.isnan(true)], true[~np.isnan(true)])
    assert ahead.hour_of_day[-1, 1] == (world.period.hour_of_day[-1] + 1) % 24


def test_perfect_is_the_truth():
    world = outlook(noisy(8, 2), 6)
    for quantity in QUANTITIES:
        true = truth(world, quantity)
        np.testing.assert_array_equal(
            getattr(perfect(world), quantity)[~np.isnan(true)], true[~np.isnan(true)]
        )


def test_yesterday_is_the_value_a_day_earlier_and_on_the_first_day_that_of_the_past():
    world = outlook(noisy(6, 3), 4, horizon=60.0)
    joined = np.concatenate([world.past.buying_price, world.period.buying_price])
    ahead, first = yesterday(world).buying_price, world.past.slots
    for t, k in ((0, 1), (0, 23), (5, 12), (30, 7)):
        assert ahead[t, k] == joined[first + t + k - 24]
    assert ahead[5, 24] == joined[first + 5]  # tomorrow at this time: the present value
    assert ahead[5, 25] == joined[first + 5 + 25 - 48]
    assert ahead[5, 49] == joined[first + 5 + 49 - 72]


def test_hourly_means_are_those_of_the_training_period_by_time_of_day():
    world = outlook(noisy(8, 4, 0.5), 6, 0.5)
    ahead = hourly_means(world).load
    for t, k in ((0, 1), (11, 40), (60, 3)):
        same = world.past.hour_of_day == world.period.hour_of_day[t + k]
        assert ahead[t, k] == pytest.approx(np.mean(world.past.load[same]))


@settings(max_examples=8)
@given(seed=st.integers(0, 100), slot=st.integers(0, 46))
@pytest.mark.parametrize("forecaster", BLIND)
def test_what_happens_later_changes_no_earlier_forecast(forecaster, seed, slot):
    exogenous = noisy(7, seed, negative_share=0.1)
    as_it_was = forecaster(outlook(exogenous, 5))
    otherwise = forecaster(outlook(changed_after(exogenous, 5 * 24 + slot), 5))
    before = jax.tree.map(lambda x: x[: slot + 1], as_it_was)
    jax.tree.map(np.testing.assert_array_equal, before, jax.tree.map(lambda x: x[: slot + 1], otherwise))
    assert not np.array_equal(as_it_was.load[slot + 1 :], otherwise.load[slot + 1 :])


@settings(max_examples=8)
@given(seed=st.integers(0, 100), negative=st.sampled_from([0.0, 0.2]), scale=st.sampled_from([1.0, 100.0]))
def test_the_fitted_forecast_stays_within_what_can_be(seed, negative, scale):
    exogenous = noisy(9, seed, negative_share=negative)
    u = exogenous.buying_price
    exogenous = replace(exogenous, buying_price=scale * u, selling_price=scale * (0.8 * u - 0.01))
    world = outlook(exogenous, 7)
    ahead = fitted(world)
    assert np.all(ahead.load >= 0)
    assert np.all(ahead.pv_generation >= 0)
    night = (ahead.hour_of_day < 6) | (ahead.hour_of_day > 18)
    assert np.all(ahead.pv_generation[night] == 0)
    assert np.max(ahead.buying_price) <= np.max(exogenous.buying_price)
    assert np.min(ahead.buying_price) >= np.min(exogenous.buying_price)
    line = 0.8 * ahead.buying_price - 0.01 * scale
    np.testing.assert_allclose(ahead.selling_price, line, rtol=1e-9, atol=1e-12 * scale)


def test_the_currency_does_not_matter_to_the_fit():
    exogenous = noisy(9, 5)
    u, v = exogenous.buying_price, exogenous.selling_price
    world, dear = (
        outlook(replace(exogenous, buying_price=rate * u, selling_price=rate * v), 7) for rate in (1, 10)
    )
    np.testing.assert_allclose(fitted(dear).buying_price, 10 * fitted(world).buying_price, rtol=1e-9)


def test_one_spike_in_the_training_moves_other_days_little():
    exogenous = periodic(20)
    price = np.where(np.arange(exogenous.slots) == 110, 5.0, exogenous.buying_price)
    spiked = replace(exogenous, buying_price=price)
    for forecaster, most in ((hourly_means, 0.4), (fitted, 0.05)):
        world = outlook(spiked, 18)
        error = np.nanmax(np.abs(forecaster(world).buying_price - truth(world, "buying_price")))
        assert error < most
    assert np.nanmax(np.abs(hourly_means(world).buying_price - truth(world, "buying_price"))) > 0.2


def test_a_home_without_sun_and_with_one_price_is_forecast_too():
    exogenous = periodic(8, price=0.2)
    nothing = np.zeros(exogenous.slots)
    dark = replace(exogenous, pv_generation=nothing, selling_price=nothing + 0.05)
    ahead = fitted(outlook(dark, 6))
    assert np.all(ahead.pv_generation == 0)
    np.testing.assert_allclose(ahead.buying_price, 0.2)
    np.testing.assert_allclose(ahead.selling_price, 0.05)


@pytest.mark.parametrize(("share", "constant"), [(0.9, 0.0), (0.0, 0.08), (1.0, -0.05)])
def test_the_selling_line_is_exact_for_a_share_a_fixed_price_and_a_difference(share, constant):
    exogenous = noisy(3, 6)
    sold = share * exogenous.buying_price + constant
    line = fit_selling(replace(exogenous, selling_price=sold))
    assert (line.slope, line.constant) == pytest.approx((share, constant), abs=1e-12)


def test_bad_outlooks_are_refused():
    exogenous = noisy(4, 7)
    past, period = cut(exogenous, 48)
    with pytest.raises(HemmaError, match="divide a day"):
        Outlook(past, period, 0.7)
    with pytest.raises(HemmaError, match="horizon > 0"):
        Outlook(past, period, 1.0, 0.0)
    with pytest.raises(HemmaError, match="at least one day"):
        Outlook(exogenous.window(0, 20), period, 1.0)
    with pytest.raises(HemmaError, match="longer training traces"):
        fitted(Outlook(past, period, 1.0))
