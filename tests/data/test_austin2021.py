"""The embedded homes say what their sources say, at the right hour."""

import gzip
import hashlib
from importlib.resources import files

import numpy as np
import pytest

from hemma.data import AUSTIN2021_HOMES, Tariff, load_austin2021, split
from hemma.data.canonical import canonical_text
from hemma.errors import HemmaError


@pytest.fixture(scope="module")
def homes():
    return [load_austin2021(home) for home in AUSTIN2021_HOMES]


def test_it_is_the_summer_of_2021_in_standard_time(homes):
    for traces in homes:
        stamps = traces.time_stamps()
        assert (stamps[0], stamps[-1]) == ("2021-06-01T00:00:00-06:00", "2021-08-31T23:00:00-06:00")
        assert (traces.slots, traces.slot_length) == (2208, 1.0)
        np.testing.assert_array_equal(traces.exogenous.hour_of_day, np.tile(np.arange(24.0), 92))


@pytest.mark.parametrize(
    ("stamp", "dollars_per_mwh"),
    [
        ("2021-06-01T00:00:00-06:00", 19.16),  # sheet Jun: 06/01/2021,02:00,N,LZ_AEN,19.16
        ("2021-06-01T01:00:00-06:00", 18.65),  # sheet Jun: 06/01/2021,03:00,N,LZ_AEN,18.65
        ("2021-06-30T22:00:00-06:00", 25.99),  # sheet Jun: 06/30/2021,24:00,N,LZ_AEN,25.99
        ("2021-07-31T23:00:00-06:00", 28.83),  # sheet Aug: 08/01/2021,01:00,N,LZ_AEN,28.83
        ("2021-08-31T22:00:00-06:00", 30.74),  # sheet Aug: 08/31/2021,24:00,N,LZ_AEN,30.74
        ("2021-08-31T23:00:00-06:00", 27.55),  # sheet Sep: 09/01/2021,01:00,N,LZ_AEN,27.55
    ],
)
def test_prices_stand_at_their_hour(homes, stamp, dollars_per_mwh):
    """ERCOT prints the end of the hour in daylight saving time: 02:00 is from 00:00 standard time."""
    slot = homes[0].time_stamps().index(stamp)
    assert homes[0].exogenous.buying_price[slot] == pytest.approx(dollars_per_mwh / 1000 + 0.05, abs=1e-12)
    assert homes[0].exogenous.selling_price[slot] == pytest.approx(
        0.9 * (dollars_per_mwh / 1000 + 0.05), abs=1e-12
    )


def test_the_sun_stands_highest_at_solar_noon(homes):
    """Austin lies at 97.74 W: noon is 12:31 standard time plus up to 7 minutes; panels may look west."""
    days = homes[0].exogenous.pv_generation.reshape(92, 24)
    clear = np.quantile(days, 0.95, axis=0)
    centre = np.sum(clear * (np.arange(24) + 0.5)) / clear.sum()
    assert 12.5 < centre < 13.0
    assert (days[:, [0, 1, 2, 3, 4, 21, 22, 23]] == 0).all()


def test_first_rows_of_the_source(homes):
    """Building_1.csv and weather.csv by hand: Hour 2 has a cooling load of 0.2277 kWh at 21.38 degC."""
    home = homes[0]
    performance = 0.2535049749071043 * (7.991821357673299 + 273.15) / (21.38 - 7.991821357673299)
    assert home.hvac_power[1] == pytest.approx(0.2277370395414095 / performance, abs=1e-5)
    assert home.exogenous.load[1] == pytest.approx(0.344522307747465, abs=1e-5)
    assert home.exogenous.outdoor_temperature[1] == 21.38
    # the row of Hour 2 ends at 22.2232: that is the start of the third hour
    np.testing.assert_allclose(home.indoor_temperature[:3], [22.42813, 22.42813, 22.22321], atol=1e-4)


def test_power_of_the_air_conditioner_reaches_its_nominal_power(homes):
    """schema.json gives home 1 4.1096 kW electric, and the simulation runs into that limit."""
    assert homes[0].hvac_power.max() == pytest.approx(4.10962, abs=2e-5)
    assert homes[4].hvac_power.max() == pytest.approx(5.80918, abs=2e-5)


def test_temperatures_follow_the_power_of_their_own_slot(homes):
    """T(t+1) - T(t) falls with h(t) once the weather is accounted for; one hour later it would not."""
    home = homes[4]
    warming = np.diff(home.indoor_temperature)
    gap = (home.exogenous.outdoor_temperature - home.indoor_temperature)[:-1]
    regressors = np.column_stack([gap, home.hvac_power[:-1], np.ones_like(gap)])
    coefficients, *_ = np.linalg.lstsq(regressors, warming, rcond=None)
    explained = 1 - np.var(warming - regressors @ coefficients) / np.var(warming)
    assert coefficients[0] > 0
    assert coefficients[1] < 0
    assert explained > 0.5


def test_retail_price_is_wholesale_plus_adder():
    plain, dear = load_austin2021(2, Tariff(0.0, 1.0)), load_austin2021(2, Tariff(0.11, 0.5))
    np.testing.assert_allclose(dear.exogenous.buying_price - plain.exogenous.buying_price, 0.11, atol=1e-12)
    np.testing.assert_allclose(dear.exogenous.selling_price, 0.5 * dear.exogenous.buying_price)
    np.testing.assert_array_equal(plain.exogenous.selling_price, plain.exogenous.buying_price)
    assert plain.sha256 != dear.sha256


def test_pv_scale_multiplies_pv_alone():
    plain, larger = load_austin2021(2), load_austin2021(2, pv_scale=3.0)
    np.testing.assert_allclose(larger.exogenous.pv_generation, 3 * plain.exogenous.pv_generation)
    np.testing.assert_array_equal(larger.exogenous.load, plain.exogenous.load)


def test_sha256_is_that_of_the_exported_file(homes):
    assert homes[0].sha256 == hashlib.sha256(canonical_text(homes[0]).encode()).hexdigest()
    assert len({home.sha256 for home in homes}) == 6


def test_files_hold_no_time_of_making():
    """Bytes 4 to 8 of a gzip file are its time stamp, byte 3 says whether a name follows."""
    for name in ["weather_and_prices.csv.gz", *(f"home{home}.csv.gz" for home in AUSTIN2021_HOMES)]:
        content = (files("hemma.data") / "austin2021" / name).read_bytes()
        assert content[3:8] == bytes(5)
        assert gzip.decompress(content).count(b"\n") == 2209


def test_august_is_the_test_period(homes):
    parts = split(homes[0])
    assert parts.test.time_stamps()[0] == "2021-08-01T00:00:00-06:00"
    assert (parts.training.slots, parts.test.slots) == (61 * 24, 744)


@pytest.mark.parametrize("home", [0, 7, -1])
def test_unknown_home_names_those_there_are(home):
    with pytest.raises(HemmaError, match=f"expected one of the homes 1, 2, 3, 4, 5, 6, got {home}"):
        load_austin2021(home)


@pytest.mark.parametrize("value", [-0.1, float("nan"), float("inf")])
def test_impossible_parameters_are_refused(value):
    with pytest.raises(HemmaError, match="adder_per_kwh: expected a number of at least 0"):
        Tariff(adder_per_kwh=value)
    with pytest.raises(HemmaError, match="selling_ratio: expected a fraction"):
        Tariff(selling_ratio=value)
    with pytest.raises(HemmaError, match="pv_scale: expected a number of at least 0"):
        load_austin2021(1, pv_scale=value)
