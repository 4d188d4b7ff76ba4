"""Prices hold until the next value; power and temperature are interpolated."""

from datetime import timedelta

import numpy as np
import pytest
from canonical_files import HEADER, refusal, stamps, sun

from hemma.data import read_canonical, report_quality
from hemma.data.clock import Clock
from hemma.data.surroundings import price

QUARTER = timedelta(minutes=15)
BOTH = f"{HEADER},sell_per_kwh"


def lines(times, buying, selling=None):
    """A home whose prices are known where they are not None."""
    body = []
    for k, t in enumerate(times):
        prices = [buying[k], *([selling[k]] if selling is not None else [])]
        cells = [t, str(sun(t)), f"0.{5 + k % 4}", f"30.{k % 7}"]
        body.append(",".join([*cells, *("" if p is None else str(p) for p in prices)]))
    return body


def every(slots, count):
    """A price once in some slots: 0.1, 0.2, ... again from 0.1 after nine."""
    return [round(0.1 * (1 + k // slots % 9), 1) if k % slots == 0 else None for k in range(count)]


def held(slots, count):
    return 0.1 * (1 + np.arange(count) // slots % 9)


@pytest.mark.parametrize(
    ("minutes", "slots", "told"),
    [
        (15, 4, "1 hour"),
        (15, 2, "30 minutes"),
        (5, 12, "1 hour"),
        (30, 6, "3 hours"),
        (60, 24, "24 hours"),
    ],
)
def test_coarser_prices_hold_until_the_next(write, minutes, slots, told):
    count = 10 * slots
    times = stamps(count, timedelta(minutes=minutes))
    read = read_canonical(write(lines(times, every(slots, count))))
    np.testing.assert_allclose(read.exogenous.buying_price, held(slots, count), atol=1e-12)
    assert f"buy_per_kwh comes once in {told}: each value is held until the next" in read.notes
    assert f"note: buy_per_kwh comes once in {told}" in "\n".join(report_quality(read))
    assert not any("interpolated" in note for note in read.notes)


def test_both_prices_hold_each_for_its_own_time(write):
    times = stamps(96, QUARTER)
    read = read_canonical(write(lines(times, every(4, 96), every(8, 96)), BOTH))
    np.testing.assert_allclose(read.exogenous.buying_price, held(4, 96), atol=1e-12)
    np.testing.assert_allclose(read.exogenous.selling_price, held(8, 96), atol=1e-12)


def test_the_last_price_may_be_repeated_to_the_end(write):
    times = stamps(96, QUARTER)
    prices = every(4, 96)
    prices[93:] = [prices[92]] * 3
    read = read_canonical(write(lines(times, prices)))
    np.testing.assert_allclose(read.exogenous.buying_price, held(4, 96), atol=1e-12)


def test_a_missing_hour_of_prices_holds_the_hour_before_and_two_are_refused(write):
    times = stamps(96, QUARTER)
    prices = every(4, 96)
    prices[40] = None
    read = read_canonical(write(lines(times, prices)))
    np.testing.assert_allclose(read.exogenous.buying_price[36:48], [0.1] * 8 + [0.3] * 4, atol=1e-12)
    assert "1 hour held from 2021-06-01T10:00:00-06:00 in buy_per_kwh" in read.notes
    prices[44] = None
    assert "2 hours missing from 2021-06-01T10:00:00-06:00 in buy_per_kwh" in refusal(
        write(lines(times, prices))
    )


def test_a_single_missing_price_is_held_not_interpolated(write):
    times = stamps(48)
    prices = [0.1 * (1 + k % 5) for k in range(48)]
    prices[13] = None
    read = read_canonical(write(lines(times, prices)))
    assert read.exogenous.buying_price[13] == pytest.approx(0.3)
    assert "1 hour held from 2021-06-01T13:00:00-06:00 in buy_per_kwh" in read.notes


def test_prices_that_begin_late_are_refused(write):
    prices = every(4, 96)
    prices[0] = None
    message = refusal(write(lines(stamps(96, QUARTER), prices)))
    assert "1 hour missing from 2021-06-01T00:00:00-06:00 in buy_per_kwh" in message


def test_prices_without_a_rhythm_are_refused(write):
    """Given when they change: nobody knows whether the next value or the log was lost."""
    prices = [0.2 if k in (0, 15, 20, 47, 63, 90, 95) else None for k in range(96)]
    assert "missing from" in refusal(write(lines(stamps(96, QUARTER), prices)))


def test_hourly_weather_in_a_finer_file_is_interpolated(write):
    body = lines(stamps(17, QUARTER), [0.1] * 17)
    body = [row if k % 4 == 0 else row.replace(f",30.{k % 7},", ",,") for k, row in enumerate(body)]
    read = read_canonical(write(body))
    np.testing.assert_allclose(read.exogenous.outdoor_temperature[:5], [30, 30.1, 30.2, 30.3, 30.4])


def test_a_price_file_with_empty_cells_holds_as_well(tmp_path):
    rows = [f"{t},{p or ''}" for t, p in zip(stamps(96, QUARTER), every(4, 96), strict=True)]
    (tmp_path / "p.csv").write_text("\n".join(["time,buy_per_kwh", *rows]))
    start = int(np.datetime64("2021-06-01T06:30", "s").astype(int))
    found = price(tmp_path / "p.csv", "buy_per_kwh", Clock(start, 900, np.zeros(90)))
    np.testing.assert_allclose(found.series["buy_per_kwh"], held(4, 96)[2:92], atol=1e-12)
    assert found.notes == ("buy_per_kwh comes once in 1 hour: each value is held until the next of p.csv",)
