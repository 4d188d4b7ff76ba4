"""The lower level against a dynamic programme on a grid, SciPy's MILP and a loop written from the paper."""

import dataclasses

import equinox as eqx
import jax
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import Bounds, LinearConstraint, milp

from hemma.errors import HemmaError
from hemma.home import Battery, Home, HomeState, benchmark_home
from hemma.optimisation.battery import schedule_battery
from hemma.optimisation.horizon import Horizon
from hemma.types import Exogenous


def traces(slots: int, seed: int, selling_ratio: float = 0.9, negative_share: float = 0.0) -> Exogenous:
    random = np.random.default_rng(seed)
    hour = np.arange(slots) % 24.0
    price = 0.08 + 0.05 * np.sin((hour - 12) * np.pi / 12) + random.gamma(0.5, 0.03, slots)
    price = np.where(random.uniform(size=slots) < negative_share, -price, price)
    return Exogenous(
        pv_generation=np.clip(3 * np.sin((hour - 6) * np.pi / 12), 0, None) * random.uniform(0.3, 1, slots),
        load=0.3 + random.gamma(1.0, 0.4, slots),
        outdoor_temperature=30 + 6 * np.sin((hour - 9) * np.pi / 12),
        buying_price=price,
        selling_price=selling_ratio * price,
        hour_of_day=hour,
    )


def start(home: Home) -> HomeState:
    with jax.enable_x64(True):
        return home.reset()


def cost_of(home: Home, exogenous: Exogenous, h: np.ndarray, e: np.ndarray) -> float:
    """Equations (1), (2) and (8) in NumPy."""
    g = h + e + exogenous.load - exogenous.pv_generation
    price = np.where(g > 0, exogenous.buying_price, exogenous.selling_price)
    return float(np.sum(price * g + home.battery.ageing_cost * np.abs(e)) * home.slot_length)


def grid_programme(home: Home, exogenous: Exogenous, h: np.ndarray, levels: int) -> float:
    """Least cost over schedules that move between ``levels`` equidistant energies."""
    b, dt = home.battery, home.slot_length
    energy = np.linspace(b.min_energy, b.max_energy, levels)
    change = energy[None, :] - energy[:, None]
    e = np.where(change > 0, change / b.charging_efficiency, change * b.discharging_efficiency) / dt
    forbidden = (e > b.max_charging_power + 1e-12) | (e < -b.max_discharging_power - 1e-12)
    value = np.zeros(levels)
    for t in reversed(range(len(h))):
        g = h[t] + e + exogenous.load[t] - exogenous.pv_generation[t]
        price = np.where(g > 0, exogenous.buying_price[t], exogenous.selling_price[t])
        stage = (price * g + b.ageing_cost * np.abs(e)) * dt
        value = np.min(np.where(forbidden, np.inf, stage + value[None, :]), axis=1)
    start = np.argmin(np.abs(energy - b.initial_energy))
    assert energy[start] == pytest.approx(b.initial_energy)
    return float(value[start])


def scipy_milp(home: Home, exogenous: Exogenous, h: np.ndarray) -> float:
    """Every slot with both binaries; x = (charge, discharge, buy, sell, charging?, buying?)."""
    b, dt, n = home.battery, home.slot_length, len(h)
    eye, low, zero = np.eye(n), np.tril(np.ones((n, n))), np.zeros((n, n))
    demand = h + exogenous.load - exogenous.pv_generation
    M = np.abs(demand).max() + b.max_charging_power + b.max_discharging_power
    ageing = np.full(n, b.ageing_cost)
    c = dt * np.concatenate(
        [ageing, ageing, exogenous.buying_price, -exogenous.selling_price, np.zeros(2 * n)]
    )
    stored = np.hstack([low * b.charging_efficiency * dt, -low * dt / b.discharging_efficiency, *[zero] * 4])
    balance = np.hstack([-eye, eye, eye, -eye, zero, zero])
    rows = [
        LinearConstraint(stored, b.min_energy - b.initial_energy, b.max_energy - b.initial_energy),
        LinearConstraint(balance, demand, demand),
        LinearConstraint(np.hstack([eye, zero, zero, zero, -b.max_charging_power * eye, zero]), -np.inf, 0),
        LinearConstraint(
            np.hstack([zero, eye, zero, zero, b.max_discharging_power * eye, zero]),
            -np.inf,
            b.max_discharging_power,
        ),
        LinearConstraint(np.hstack([zero, zero, eye, zero, zero, -M * eye]), -np.inf, 0),
        LinearConstraint(np.hstack([zero, zero, zero, eye, zero, M * eye]), -np.inf, M),
    ]
    most = np.repeat([b.max_charging_power, b.max_discharging_power, M, M, 1, 1], n)
    whole = np.repeat([0, 0, 0, 0, 1, 1], n)
    found = milp(
        c, constraints=rows, bounds=Bounds(0, most), integrality=whole, options={"mip_rel_gap": 1e-9}
    )
    assert found.success
    return float(found.fun)


@pytest.mark.parametrize(
    ("selling_ratio", "negative_share"), [(0.9, 0.0), (0.9, 0.3), (1.2, 0.0), (0.5, 0.3), (1.0, 0.2)]
)
def test_schedule_beats_the_grid_by_no_more_than_the_grid_is_coarse(selling_ratio, negative_share):
    home = Home(battery=Battery(charging_efficiency=0.9, discharging_efficiency=0.8))
    exogenous = traces(30, 3, selling_ratio, negative_share)
    h = np.linspace(0, 1.5, 30)
    plan = schedule_battery(home, exogenous, h, start(home))
    grid = grid_programme(home, exogenous, h, 541)
    assert plan.cost <= grid + 1e-9
    assert plan.cost >= grid - 0.005  # 30 slots, steps of 0.01 kWh, prices about 0.1 per kWh
    assert plan.gap <= 1e-5
    assert cost_of(home, exogenous, h, plan.battery_power) == pytest.approx(plan.cost, abs=1e-9)


def test_relaxation_alone_would_be_wrong_at_a_negative_price():
    home = Home(battery=Battery(charging_efficiency=0.9, discharging_efficiency=0.9))
    one = traces(1, 0)
    price = np.array([-0.2])
    exogenous = eqx.tree_at(lambda x: (x.buying_price, x.selling_price), one, (price, price))
    full = eqx.tree_at(lambda h: h.battery.initial_energy, home, 6.0)
    plan = schedule_battery(full, exogenous, np.zeros(1), start(full))
    assert plan.battery_power[0] == pytest.approx(0.0, abs=1e-6)  # a full battery cannot burn energy


@settings(max_examples=25)
@given(
    seed=st.integers(0, 10_000),
    ratio=st.sampled_from([0.0, 0.5, 0.9, 1.0, 1.3]),
    negative=st.sampled_from([0.0, 0.4, 1.0]),
    ageing=st.sampled_from([0.0, 0.001, 0.05]),
    efficiency=st.sampled_from([0.7, 0.95, 1.0]),
    minutes=st.sampled_from([15, 30, 60]),
)
def test_binaries_only_where_needed_give_the_optimum_of_binaries_everywhere(
    seed, ratio, negative, ageing, efficiency, minutes
):
    battery = Battery(ageing_cost=ageing, charging_efficiency=efficiency, discharging_efficiency=efficiency)
    home = dataclasses.replace(benchmark_home(minutes / 60), battery=battery)
    exogenous = traces(8, seed, ratio, negative)
    h = np.random.default_rng(seed).uniform(0, 2, 8)
    plan = schedule_battery(home, exogenous, h, start(home))
    assert plan.cost == pytest.approx(scipy_milp(home, exogenous, h), abs=2e-5)
    assert plan.bound <= plan.cost + 1e-9
    low = np.concatenate([[1.2], plan.battery_energy[:-1]]) - 0.6
    assert np.all(plan.battery_power >= -low * efficiency * 60 / minutes - 1e-9)
    assert np.all((plan.battery_energy >= 0.6) & (plan.battery_energy <= 6.0))


def test_free_prices_and_no_ageing_leave_no_round_trips():
    home = Home(battery=Battery(ageing_cost=0.0))
    free = np.zeros(6)
    exogenous = eqx.tree_at(lambda x: (x.buying_price, x.selling_price), traces(6, 0), (free, free))
    plan = schedule_battery(home, exogenous, np.ones(6), start(home))
    E = np.concatenate([[1.2], plan.battery_energy])
    stored = np.where(plan.battery_power > 0, 0.95 * plan.battery_power, plan.battery_power / 0.95)
    np.testing.assert_allclose(np.diff(E), stored, atol=1e-9)
    assert plan.cost == 0.0


def test_short_horizons_cost_more_and_the_gap_says_how_much():
    home, exogenous, h = Home(), traces(96, 5), np.full(96, 0.8)
    whole = schedule_battery(home, exogenous, h, start(home))
    blind = schedule_battery(home, exogenous, h, start(home), Horizon(4.0, 4.0))
    rolling = schedule_battery(home, exogenous, h, start(home), Horizon(8.0, 2.0))
    assert whole.cost < rolling.cost < blind.cost
    assert whole.gap <= 1e-6
    assert blind.gap == pytest.approx((blind.cost - whole.bound) / abs(blind.cost), rel=1e-6)


def test_same_schedule_every_time():
    home, exogenous, h = Home(), traces(48, 5, 0.9, 0.2), np.full(48, 0.8)
    first, again = (schedule_battery(home, exogenous, h, start(home)) for _ in range(2))
    np.testing.assert_array_equal(first.battery_power, again.battery_power)


def test_an_empty_battery_is_not_below_its_limit_in_single_precision():
    home = Home(battery=Battery(min_energy=0.7, initial_energy=0.7))
    assert float(home.reset().battery_energy) < 0.7
    schedule_battery(home, traces(4, 0), np.zeros(4), home.reset())
    with pytest.raises(HemmaError, match="initial energy"):
        schedule_battery(home, traces(4, 0), np.zeros(4), home.reset(battery_energy=np.array(0.5)))


@pytest.mark.parametrize(("planned", "carried_out"), [(0.0, None), (4.0, 5.0), (4.0, 0.0), (-1.0, None)])
def test_horizons_that_never_arrive_are_refused(planned, carried_out):
    with pytest.raises(HemmaError, match="horizon"):
        Horizon(planned, carried_out)


@given(
    slots=st.integers(0, 60),
    planned=st.one_of(st.none(), st.floats(5, 30)),
    carried_out=st.one_of(st.none(), st.floats(0.1, 5)),
    slot_length=st.sampled_from([0.25, 0.5, 1.0]),
)
def test_windows_carry_out_every_slot_once(slots, planned, carried_out, slot_length):
    windows = list(Horizon(planned, carried_out).windows(slots, slot_length))
    assert [t for w in windows for t in range(w.start, w.stop)] == list(range(slots))
    if planned is not None:
        assert all(w.end - w.start <= planned / slot_length + 0.5 for w in windows)


def test_a_day_is_a_day_at_any_slot_length():
    assert [w.stop for w in Horizon(48.0, 24.0).windows(192, 0.25)] == [96, 192]
