"""Weather and prices that come from elsewhere."""

from datetime import UTC, datetime, timedelta

import numpy as np
import pytest
from dataport_files import body, dataport, instants, read, refusal, same_series, weather_file
from hypothesis import given
from hypothesis import strategies as st

from hemma.data import PecanStreetOptions, TimeOfUse
from hemma.data.clock import Clock
from hemma.data.surroundings import price
from hemma.errors import HemmaError


def test_dataport_weather_is_in_fahrenheit_and_has_places(folder):
    lines = ["localhour,latitude,longitude,temperature,humidity"]
    for t in instants(60, "2018-06-01T00:00+00:00", timedelta(hours=1)):
        fahrenheit = 68 + 1.8 * t.hour
        lines += [f"{dataport(t)},30.292432,-97.7,{fahrenheit},0.5", f"{dataport(t)},40.1,-105,32,0.5"]
    (folder / "dataport.csv").write_text("\n".join(lines))
    options = PecanStreetOptions(latitude=30.0)
    traces = read(folder, body(192), options, weather=folder / "dataport.csv")
    hour = [datetime.fromisoformat(s).astimezone(UTC).hour for s in traces.time_stamps()]
    np.testing.assert_allclose(traces.exogenous.outdoor_temperature, 20 + np.array(hour))
    assert "got latitudes 30.292432, 40.1" in refusal(folder, body(192), weather=folder / "dataport.csv")


def test_coarse_weather_is_interpolated_and_coarse_prices_hold(folder):
    hours = instants(60, "2018-06-01T00:00+00:00", timedelta(hours=1))
    table = [f"{t.isoformat()},{10 + k % 24},0.{10 + k % 24}" for k, t in enumerate(hours)]
    (folder / "both.csv").write_text("\n".join(["time,outdoor_c,buy_per_kwh", *table]))
    options = PecanStreetOptions(slot_length=0.25)
    traces = read(folder, body(192), options, weather=folder / "both.csv", prices=folder / "both.csv")
    np.testing.assert_allclose(traces.exogenous.outdoor_temperature[:6], [15, 15.25, 15.5, 15.75, 16, 16.25])
    np.testing.assert_allclose(traces.exogenous.buying_price[:6], [0.15, 0.15, 0.15, 0.15, 0.16, 0.16])
    np.testing.assert_allclose(traces.exogenous.selling_price, 0.9 * traces.exogenous.buying_price)


def test_fine_prices_are_averaged(folder):
    fine = instants(1200, "2018-06-01T00:00+00:00", timedelta(minutes=5))
    table = [f"{t.isoformat()},{0.01 * t.minute / 5},{0.01}" for t in fine]
    (folder / "p.csv").write_text("\n".join(["time,buy_per_kwh,sell_per_kwh", *table]))
    traces = read(folder, body(192), prices=folder / "p.csv")
    np.testing.assert_allclose(traces.exogenous.buying_price, 0.01 * np.mean(np.arange(12)))
    np.testing.assert_allclose(traces.exogenous.selling_price, 0.01)


def test_weather_that_ends_too_early_is_told(folder):
    weather = weather_file(folder, "2018-06-01T05:00+00:00", 30)
    message = refusal(folder, body(192), weather=weather)
    assert "expected outdoor_c from 2018-06-01T00:00:00-05:00 to 2018-06-03T00:00:00-05:00" in message


def test_holes_of_the_weather_outside_the_period_do_no_harm(folder):
    lines = (folder / "weather.csv").read_text().splitlines()
    (folder / "a.csv").write_text("\n".join([*lines[:5], *lines[20:]]))
    same_series(read(folder, body(192), weather=folder / "a.csv"), read(folder, body(192)))
    (folder / "b.csv").write_text("\n".join([*lines[:60], *lines[70:]]))
    assert "10 hours missing from 2018-06-01T11:00:00+00:00 in outdoor_c" in refusal(
        folder, body(192), weather=folder / "b.csv"
    )


def test_time_of_use_prices(folder):
    """15:30 to 20:00: half of the hour from 15:00 is dear."""
    traces = read(
        folder, body(192), prices=TimeOfUse(0.1, 0.3, peak_from=15.5, peak_until=20.0, selling_ratio=0.5)
    )
    price = np.full(24, 0.1)
    price[15], price[16:20] = 0.2, 0.3
    np.testing.assert_allclose(traces.exogenous.buying_price, np.tile(price, 2))
    np.testing.assert_allclose(traces.exogenous.selling_price, 0.5 * np.tile(price, 2))


def test_time_of_use_over_midnight_and_on_weekdays(folder):
    """1 June 2018 is a Friday."""
    tariff = TimeOfUse(0.1, 0.3, peak_from=22.0, peak_until=2.0, weekdays_only=True)
    traces = read(folder, body(192), prices=tariff)
    dear = np.flatnonzero(traces.exogenous.buying_price > 0.2)
    np.testing.assert_array_equal(dear, [0, 1, 22, 23])
    with pytest.raises(HemmaError, match="hours between 0 and 24"):
        TimeOfUse(0.1, 0.3, peak_from=25.0)


@given(
    coarse=st.sampled_from([5, 10, 15, 20, 30, 45, 60, 120, 180]),
    slot=st.sampled_from([5, 15, 30, 60, 90]),
    shift=st.integers(0, 12),
    seed=st.integers(0, 2**32 - 1),
)
def test_prices_keep_their_mean_whatever_the_two_clocks(tmp_path_factory, coarse, slot, shift, seed):
    """Against a loop over the minutes of each slot, each at the price that holds then."""
    prices = np.random.default_rng(seed).uniform(-0.1, 1.0, 60 * 24 // coarse)
    times = instants(len(prices), "2018-06-01T00:00+00:00", timedelta(minutes=coarse))
    path = tmp_path_factory.mktemp("prices") / "prices.csv"
    rows = [f"{t.isoformat()},{p!r}" for t, p in zip(times, prices.tolist(), strict=True)]
    path.write_text("\n".join(["time,buy_per_kwh", *rows]))
    start = int(times[0].timestamp()) + shift * 300
    clock = Clock(start, slot * 60, np.zeros(8))
    minutes = shift * 5 + np.arange(8 * slot)
    by_hand = prices[minutes // coarse].reshape(8, slot).mean(axis=1)
    np.testing.assert_allclose(price(path, "buy_per_kwh", clock).series["buy_per_kwh"], by_hand, atol=1e-12)
