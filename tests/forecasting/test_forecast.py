"""Forecasts: exact where the world repeats itself, blind to the future, and never outside what can be."""

from dataclasses import replace

import jax
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hemma.errors import HemmaError
from hemma.forecasting.combined import MeanForecast, RefittedForecast
from hemma.forecasting.outlook import Outlook, hourly_means, perfect, yesterday
from hemma.forecasting.published import PublishedPrices
from hemma.forecasting.ridge import fitted
from hemma.forecasting.shape import ShapeForecast
from hemma.home.selling import fit_selling
from hemma.types import Exogenous
from small_worlds import changed_after, cut, noisy, periodic

SHAPE = ShapeForecast()
BOTH = RefittedForecast(MeanForecast((SHAPE, fitted)), days=1)
FORECASTERS = (perfect, yesterday, hourly_means, fitted, SHAPE, BOTH, PublishedPrices(SHAPE))
BLIND = (yesterday, hourly_means, fitted, SHAPE, BOTH)
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
    exogenous = noisy(8, seed, negative_share=0.1)
    as_it_was = forecaster(outlook(exogenous, 6))
    otherwise = forecaster(outlook(changed_after(exogenous, 6 * 24 + slot), 6))
    before = jax.tree.map(lambda x: x[: slot + 1], as_it_was)
    jax.tree.map(np.testing.assert_array_equal, before, jax.tree.map(lambda x: x[: slot + 1], otherwise))
    assert not np.array_equal(as_it_was.load[slot + 1 :], otherwise.load[slot + 1 :])


@settings(max_examples=8)
@given(seed=st.integers(0, 100), negative=st.sampled_from([0.0, 0.2]), scale=st.sampled_from([1.0, 100.0]))
@pytest.mark.parametrize("forecaster", [fitted, BOTH])
def test_a_fitted_forecast_stays_within_what_can_be(forecaster, seed, negative, scale):
    exogenous = noisy(9, seed, negative_share=negative)
    u = exogenous.buying_price
    exogenous = replace(exogenous, buying_price=scale * u, selling_price=scale * (0.8 * u - 0.01))
    world = outlook(exogenous, 7)
    ahead = forecaster(world)
    assert np.all(ahead.load >= 0)
    assert np.all(ahead.pv_generation >= 0)
    night = (ahead.hour_of_day < 6) | (ahead.hour_of_day > 18)
    assert np.all(ahead.pv_generation[night] == 0)
    assert np.max(ahead.buying_price) <= np.max(exogenous.buying_price)
    assert np.min(ahead.buying_price) >= np.min(exogenous.buying_price)
    line = 0.8 * ahead.buying_price - 0.01 * scale
    np.testing.assert_allclose(ahead.selling_price, line, rtol=1e-9, atol=1e-12 * scale)


@pytest.mark.parametrize("forecaster", [fitted, SHAPE])
def test_the_currency_does_not_matter_to_the_fit(forecaster):
    exogenous = noisy(9, 5)
    u, v = exogenous.buying_price, exogenous.selling_price
    world, dear = (
        outlook(replace(exogenous, buying_price=rate * u, selling_price=rate * v), 7) for rate in (1, 10)
    )
    np.testing.assert_allclose(forecaster(dear).buying_price, 10 * forecaster(world).buying_price, rtol=1e-9)


def test_one_spike_in_the_training_moves_other_days_little():
    exogenous = periodic(20)
    price = np.where(np.arange(exogenous.slots) == 110, 5.0, exogenous.buying_price)
    spiked = replace(exogenous, buying_price=price)
    for forecaster, most in ((hourly_means, 0.4), (fitted, 0.05), (SHAPE, 0.05)):
        world = outlook(spiked, 18)
        error = np.nanmax(np.abs(forecaster(world).buying_price - truth(world, "buying_price")))
        assert error < most
    assert np.nanmax(np.abs(hourly_means(world).buying_price - truth(world, "buying_price"))) > 0.2


def test_a_home_without_sun_and_with_one_price_is_forecast_too():
    exogenous = periodic(8, price=0.2)
    nothing = np.zeros(exogenous.slots)
    dark = replace(exogenous, pv_generation=nothing, selling_price=nothing + 0.05)
    ahead = BOTH(outlook(dark, 6))
    assert np.all(ahead.pv_generation == 0)
    np.testing.assert_allclose(ahead.buying_price, 0.2)
    np.testing.assert_allclose(ahead.selling_price, 0.05)


@pytest.mark.parametrize(("share", "constant"), [(0.9, 0.0), (0.0, 0.08), (1.0, -0.05)])
def test_the_selling_line_is_exact_for_a_share_a_fixed_price_and_a_difference(share, constant):
    exogenous = noisy(3, 6)
    sold = share * exogenous.buying_price + constant
    line = fit_selling(replace(exogenous, selling_price=sold))
    assert line is not None
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
    with pytest.raises(HemmaError, match="longer training traces"):
        SHAPE(Outlook(past, period, 1.0))
    for settings_without_meaning in ({"history": 0.0}, {"closeness": -1.0}, {"ridge": 0.0}):
        with pytest.raises(HemmaError, match="> 0"):
            ShapeForecast(**settings_without_meaning)
    with pytest.raises(HemmaError, match="days >= 1"):
        RefittedForecast(SHAPE, days=0)
    with pytest.raises(HemmaError, match="an hour of the day"):
        PublishedPrices(SHAPE, 25.0)


def test_the_shape_forecast_is_the_weighted_ridge_regression_written_out():
    world = outlook(noisy(12, 8), 9, horizon=6.0)
    shape = ShapeForecast(history=5.0, closeness=2.0, ridge=0.1)
    u, past = np.concatenate([world.past.load, world.period.load]), world.past.slots
    low, median, high = np.quantile(u[:past], (0.1, 0.5, 0.9))
    bent = np.arcsinh((u - median) / ((high - low) / 2))
    usual = np.array([np.mean(bent[:past][np.arange(past) % 24 == hour]) for hour in range(24)])
    z = bent - usual[np.arange(len(u)) % 24]
    t, k = past + 31, 4
    rows, weights = [], []
    for s in range(5, past - 5):
        apart = abs((s - t + 12) % 24 - 12)
        weights.append(np.exp(-0.5 * (apart / 2.0) ** 2))
        rows.append([*(z[s - back] for back in range(5)), z[s + k]])
    rows, weights = np.array(rows), np.array(weights) / np.sum(weights)
    x, y = rows[:, :5], rows[:, 5]
    penalty = 0.1 * np.mean(x**2, axis=0)
    centred = x - weights @ x
    moments = np.einsum("s,si,sj->ij", weights, centred, centred) + np.diag(penalty)
    w = np.linalg.solve(moments, np.einsum("s,si,s->i", weights, centred, y - weights @ y))
    expected = weights @ y + w @ (np.array([z[t - back] for back in range(5)]) - weights @ x)
    load = median + (high - low) / 2 * np.sinh(expected + usual[(t + k) % 24])
    assert shape(world).load[31, k] == pytest.approx(np.clip(load, u[: t + 1].min(), u[: t + 1].max()))


def test_a_day_whose_evening_follows_its_morning_is_forecast_by_its_shape():
    exogenous, random = periodic(40), np.random.default_rng(3)
    day = np.arange(exogenous.slots) // 24
    dear = random.integers(0, 2, 40)[day] * np.isin(np.arange(exogenous.slots) % 24, (7, 18))
    world = outlook(replace(exogenous, buying_price=exogenous.buying_price + 0.1 * dear), 34)
    noon = np.arange(12, world.period.slots, 24)[:-1]
    true = np.array([world.period.buying_price[t + 6] for t in noon])
    error = [np.max(np.abs(f(world).buying_price[noon, 6] - true)) for f in (SHAPE, fitted)]
    assert error[0] < 0.02
    assert error[1] > 0.05


def test_the_mean_forecast_is_the_mean_of_its_parts():
    world = outlook(noisy(9, 9), 7)
    mean = MeanForecast((yesterday, hourly_means))(world)
    expected = (yesterday(world).load + hourly_means(world).load) / 2
    np.testing.assert_allclose(mean.load[:, 1:], expected[:, 1:])


def test_a_refitted_forecast_takes_each_day_from_the_fit_of_that_morning():
    exogenous = noisy(11, 10)
    again = RefittedForecast(hourly_means, days=2)(outlook(exogenous, 6))
    third_day = hourly_means(outlook(exogenous, 8))
    np.testing.assert_array_equal(again.load[48:96], third_day.load[:48])
    assert not np.array_equal(again.load[48:96], hourly_means(outlook(exogenous, 6)).load[48:96])


@pytest.mark.parametrize("slot_length", [1.0, 0.25])
def test_published_prices_are_true_until_midnight_and_from_their_hour_on_until_the_next(slot_length):
    world = outlook(noisy(9, 11, slot_length), 7, slot_length)
    ahead, true = PublishedPrices(yesterday, 14.0)(world).buying_price, truth(world, "buying_price")
    otherwise = yesterday(world).buying_price
    for hour, known in ((0.0, 24.0), (13.75, 10.25), (14.0, 34.0), (23.0, 25.0)):
        t, last = round(hour / slot_length), round(known / slot_length)
        if t * slot_length != hour:
            continue
        stop = min(last, world.ahead)
        np.testing.assert_array_equal(ahead[t, :stop], true[t, :stop])
        np.testing.assert_array_equal(ahead[t, last:], otherwise[t, last:])
