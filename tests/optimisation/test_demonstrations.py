"""The expert's demonstrations: feasible on any traces, what the home did, and the same again from disk."""

import dataclasses

import jax
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hemma.checkpoint import save_tree
from hemma.control.comfort import ComfortHold
from hemma.errors import HemmaError
from hemma.home import Battery, ExplicitThermalModel, Home, Hvac, Schedule, benchmark_home, replay
from hemma.identification.pcnn import (
    InputScaling,
    PcnnWeights,
    PhysicallyConsistentNetwork,
    ThermalResponse,
)
from hemma.optimisation.battery import schedule_battery
from hemma.optimisation.demonstrations import (
    Demonstrations,
    TracesOrigin,
    demonstrate,
    load_demonstrations,
    save_demonstrations,
)
from hemma.optimisation.hierarchy import HierarchySettings, run_hierarchy
from hemma.optimisation.horizon import WHOLE_PERIOD, Horizon
from hemma.optimisation.hvac import DescentSettings
from hemma.optimisation.optimum import optimum_problem
from hemma.types import Exogenous


def traces(slots: int, seed: int, mean: float = 31.0, slot_length: float = 1.0) -> Exogenous:
    random = np.random.default_rng(seed)
    hour = np.arange(slots) * slot_length % 24.0
    price = 0.08 + 0.05 * np.sin((hour - 12) * np.pi / 12) + random.gamma(0.5, 0.05, slots)
    return Exogenous(
        pv_generation=np.clip(3 * np.sin((hour - 6) * np.pi / 12), 0, None) * random.uniform(0.3, 1, slots),
        load=0.3 + random.gamma(1.0, 0.4, slots),
        outdoor_temperature=mean + 6 * np.sin((hour - 9) * np.pi / 12),
        buying_price=price,
        selling_price=0.9 * price,
        hour_of_day=hour,
    )


def network(cooling: float = 0.3 * 2.5 / 0.252, width: int = 4) -> PhysicallyConsistentNetwork:
    """A network equal to the explicit model: no learned gain, b = 1 - eps."""
    return PhysicallyConsistentNetwork(
        weights=PcnnWeights.create(jax.random.key(0), width, 1),
        start=ThermalResponse(heating=cooling, cooling=cooling, loss=0.3),
        scaling=InputScaling(temperature_mean=22.0, temperature_deviation=3.0, pv_peak=3.0),
        slot_length=1.0,
    )


finite = {"allow_nan": False, "allow_infinity": False}


@settings(max_examples=8)
@given(
    data=st.lists(
        st.tuples(
            st.floats(0, 9, **finite),
            st.floats(0, 9, **finite),
            st.floats(-30, 55, **finite),
            st.floats(-1, 1, **finite),
            st.floats(-1, 1, **finite),
        ),
        min_size=7,
        max_size=7,
    ),
    heats=st.booleans(),
)
def test_demonstrations_are_feasible_and_obey_the_home_on_any_traces(data, heats):
    pv, load, outdoor, buying, selling = np.array(data).T
    exogenous = Exogenous(pv, load, outdoor, buying, selling, np.arange(7.0))
    home = Home(hvac=Hvac(heats=heats), battery=Battery(charging_efficiency=0.9))
    d = demonstrate(home, home, exogenous)
    e, h = d.actions.T
    E, T, T_out = d.states[:, 2], d.states[:, 4], d.states[:, 3]
    assert d.samples == 6
    assert np.all((h >= 0) & (h <= 2))
    assert np.all((e >= d.lowest_battery_power - 1e-12) & (e <= d.highest_battery_power + 1e-12))
    assert np.all((d.lowest_battery_power <= 0) & (d.highest_battery_power >= 0))
    after = E + np.where(e > 0, 0.9 * e, e / 0.95)
    np.testing.assert_allclose(d.next_states[:, 2], after, atol=1e-9)
    assert np.all((after >= 0.6 - 1e-9) & (after <= 6 + 1e-9))
    sign = 1 if heats else -1
    np.testing.assert_allclose(
        d.next_states[:, 4], 0.7 * T + 0.3 * (T_out + sign * 2.5 / 0.252 * h), atol=1e-9
    )
    np.testing.assert_array_equal(d.next_states[:-1], d.states[1:])
    expected = np.column_stack([pv, load, outdoor, buying, np.arange(7.0)])
    np.testing.assert_array_equal(d.states[:, [0, 1, 3, 5, 6]], expected[:-1])
    np.testing.assert_array_equal(d.next_states[:, [0, 1, 3, 5, 6]], expected[1:])


def test_through_an_exact_network_the_expert_is_the_oracle():
    home, exogenous = Home(), traces(72, 1)
    run = run_hierarchy(dataclasses.replace(home, thermal_model=network()), home, exogenous)
    with jax.enable_x64(True):
        law = replay(home, exogenous, ComfortHold(home), home.reset(), jax.random.key(0))
        hvac = np.asarray(law.steps.action.hvac_power)
        oracle = schedule_battery(home, exogenous, hvac, home.reset())
    np.testing.assert_allclose(run.trajectory.steps.action.hvac_power, hvac, atol=1e-5)
    assert run.battery.cost == pytest.approx(oracle.cost, rel=1e-5)
    assert np.max(run.trajectory.steps.costs.temperature_deviation) < 1e-5
    assert run.plans == 3
    assert run.iterations == 2


def test_the_exact_joint_plan_goes_through_the_network_too():
    home, exogenous = Home(), traces(72, 1)
    through = optimum_problem(dataclasses.replace(home, thermal_model=network()), exogenous).solve(1.0)
    exact = optimum_problem(home, exogenous).solve(1.0)
    assert through.cost == pytest.approx(exact.cost, rel=1e-5)
    run = run_hierarchy(home, home, exogenous)
    least = optimum_problem(home, exogenous).solve()
    assert least.bound <= run.battery.cost + 1e-9  # what the hierarchy loses


def test_measuring_the_real_temperature_often_mends_a_wrong_model():
    home, exogenous = Home(), traces(72, 2, 34.0)
    planning = dataclasses.replace(home, thermal_model=network(cooling=3.4))  # believes in too much cooling

    def deviation(horizon: Horizon) -> float:
        run = run_hierarchy(planning, home, exogenous, HierarchySettings(hvac=horizon))
        return float(np.mean(run.trajectory.steps.costs.temperature_deviation))

    once, often = deviation(WHOLE_PERIOD), deviation(Horizon(72.0, 2.0))
    assert 0 < often < 0.6 * once


def test_the_run_replays_on_the_home():
    home, exogenous = benchmark_home(0.25), traces(72, 3, slot_length=0.25)
    run = run_hierarchy(home, home, exogenous, HierarchySettings(battery=Horizon(12.0, 6.0)))
    with jax.enable_x64(True):
        path = replay(home, exogenous, Schedule(run.trajectory.steps.action), home.reset(), jax.random.key(0))
        assert run.battery.cost == pytest.approx(float(path.energy_cost), abs=1e-9)
    assert 0 <= run.battery.cost - run.battery.bound < 0.01


def test_a_disturbed_home_is_recorded_as_it_went():
    home, exogenous = Home(disturbance_deviation=0.3), traces(72, 4)
    first, again = (demonstrate(home, home, exogenous, HierarchySettings(seed=1)) for _ in range(2))
    other = demonstrate(home, home, exogenous, HierarchySettings(seed=2))
    np.testing.assert_array_equal(first.states, again.states)
    h, T, T_out = first.actions[:, 1], first.states[:, 4], first.states[:, 3]
    noise = first.next_states[:, 4] - (0.7 * T + 0.3 * (T_out - 2.5 / 0.252 * h))
    assert 0.2 < np.std(noise) < 0.4
    assert not np.allclose(first.states[:, 4], other.states[:, 4])


def test_demonstrations_come_back_from_disk_as_they_were(tmp_path):
    home, exogenous = Home(), traces(72, 5)
    origin = TracesOrigin("somewhere", "ab12", "2021-06-01T00:00:00-06:00", "2021-06-03T11:00:00-06:00")
    d = demonstrate(home, home, exogenous, origin=origin)
    path = tmp_path / "demonstrations.safetensors"
    save_demonstrations(path, d)
    back = load_demonstrations(path)
    assert back.provenance == d.provenance
    assert "max_energy=6.0" in d.provenance.home
    for name in ("states", "actions", "next_states", "lowest_battery_power", "highest_battery_power"):
        np.testing.assert_array_equal(getattr(back, name), getattr(d, name))
        assert getattr(back, name).dtype == np.float64
    save_tree(tmp_path / "other.safetensors", {"x": np.zeros(3)}, {"kind": "policy"})
    with pytest.raises(HemmaError, match="expected demonstrations"):
        load_demonstrations(tmp_path / "other.safetensors")


def test_the_first_days_hold_no_slot_of_a_later_day():
    home, exogenous = Home(), traces(72, 6)
    d = demonstrate(home, home, exogenous)
    two = d.first_days(2)
    assert isinstance(two, Demonstrations)
    assert two.samples == 47
    assert two.provenance.slots == 48
    np.testing.assert_array_equal(two.next_states, d.next_states[:47])
    with pytest.raises(HemmaError, match="got 5"):
        d.first_days(5)


def test_progress_arrives_at_the_end_and_failures_are_said():
    home, exogenous = Home(), traces(72, 7)
    seen = []
    run_hierarchy(home, home, exogenous, on_progress=lambda done, total: seen.append((done, total)))
    assert seen == [(24, 72), (48, 72), (72, 72)]
    hasty = HierarchySettings(descent=DescentSettings(max_iterations=1))
    with pytest.raises(HemmaError, match="max_iterations"):
        run_hierarchy(home, home, exogenous, hasty)
    with pytest.raises(HemmaError, match="at least 2 slots"):
        demonstrate(home, home, exogenous.window(0, 1))


def test_the_planning_model_is_named_with_a_digest_of_its_parameters():
    home, exogenous = Home(), traces(72, 8)
    names = [
        demonstrate(
            dataclasses.replace(home, thermal_model=ExplicitThermalModel(eps)), home, exogenous
        ).provenance.planning_model
        for eps in (0.7, 0.71)
    ]
    assert all(name.startswith("ExplicitThermalModel") for name in names)
    assert names[0].split("sha256:")[1] != names[1].split("sha256:")[1]
