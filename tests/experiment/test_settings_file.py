"""Settings files: a round trip keeps everything, and a mistake gives one message with file, key and cure."""

import re
from dataclasses import fields, is_dataclass, replace
from pathlib import Path

import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from hemma.errors import HemmaError
from hemma.home import Battery, ComfortBand, Hvac
from hemma.settings.experiment import DataEfficiency, Experiment, quick
from hemma.settings.file import experiment_of, read_settings, settings_text
from hemma.settings.keys import outside


def written(tmp_path, text):
    path = tmp_path / "home.yaml"
    path.write_text(text)
    return path


def refused(tmp_path, text, message, literally=True):
    """One line of at most 600 characters that begins with the file."""
    path = written(tmp_path, text)
    with pytest.raises(HemmaError) as caught:
        read_settings(path)
    said = str(caught.value)
    assert said.startswith(f"{path}: ")
    assert len(said) - len(str(path)) < 600
    assert "\n" not in said
    assert re.search(re.escape(message) if literally else message, said), said


def test_the_printed_defaults_are_the_defaults(tmp_path):
    assert read_settings(written(tmp_path, settings_text(Experiment()))) == Experiment()
    assert read_settings(written(tmp_path, "")) == Experiment()
    assert read_settings(written(tmp_path, "battery:\n")) == Experiment()


@settings(max_examples=25)
@given(
    max_energy=st.floats(0.7, 100.0),
    low=st.floats(5.0, 20.0),
    seeds=st.integers(1, 50),
    days=st.lists(st.integers(1, 60), unique=True).map(tuple),
    heats=st.booleans(),
    rate=st.floats(1e-7, 1.0),
)
def test_a_round_trip_keeps_every_digit(tmp_path_factory, max_energy, low, seeds, days, heats, rate):
    default = Experiment()
    experiment = replace(
        default,
        battery=Battery(max_energy=max_energy, initial_energy=0.65),
        comfort=ComfortBand(low=low),
        hvac=Hvac(heats=heats),
        seeds=seeds,
        data_efficiency=DataEfficiency(days=days),
        identification=replace(default.identification, learning_rate=rate),
    )
    path = written(tmp_path_factory.mktemp("settings"), settings_text(experiment))
    assert read_settings(path) == experiment


def test_units_stand_in_the_names_and_only_what_is_given_changes(tmp_path):
    text = "battery:\n  max_energy_kwh: 13.5\ncomfort: {high_c: 25}\nppo: {discount: 0.9}\n"
    experiment = read_settings(written(tmp_path, text))
    assert experiment.battery == Battery(max_energy=13.5)
    assert experiment.comfort == ComfortBand(high=25.0)
    assert experiment.ppo.discount == 0.9
    assert experiment.identification == Experiment().identification


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("battery: {max_enrgy_kwh: 5}", "battery.max_enrgy_kwh: unknown key; did you mean max_energy_kwh?"),
        ("battery: {max_energy: 5}", "battery.max_energy: unknown key; did you mean max_energy_kwh?"),
        ("building: {efficiency: 3}", "unknown key; did you mean coefficient_of_performance?"),
        ("xyzzy: blue", "xyzzy: unknown key; the keys there are battery, building"),
        ("ppo: {learning_rate: -1}", "ppo.learning_rate: expected a step of learning from 0 to 1, got -1"),
        ("ppo: {learning_rate: 0}", "ppo.learning_rate: expected learning_rate > 0, got learning_rate 0.0"),
        ("comfort: {high_c: warm}", "comfort.high_c: expected a number, got 'warm'"),
        ("comfort: {high_c: }", "comfort.high_c: expected a number, got nothing"),
        ("seeds: yes", "seeds: expected a whole number, got yes"),
        ("seeds: '3'", "seeds: expected a whole number, got '3'"),
        ("seeds: 2.5", "seeds: expected a whole number, got 2.5"),
        ("seeds: 1_0", "seeds: expected a whole number, got '1_0'"),
        ("seeds: 0x10", "seeds: expected a whole number, got '0x10'"),
        ("seeds: 1:30", "seeds: expected a whole number, got '1:30'"),
        ("seeds: 2021-13-45", "seeds: expected a whole number, got '2021-13-45'"),
        ("hvac: {heats: 5}", "hvac.heats: expected true or false, got 5"),
        ("currency: ''", "currency: expected a word of at most 40 characters, got ''"),
        ("currency: no", "currency: expected a word of at most 40 characters, got no; put quotes around"),
        ("learned: " + "x" * 300, "learned: expected a list such as [1, 2], got 'xxxxxxxx"),
        ("learned: [HA-1, HA-1]", "learned: expected different methods as learned"),
        ("airl: {exploration: {first_deviation: [0.1]}}", "first_deviation.1: expected one value more"),
        ("battery: 3", "battery: expected lines such as `max_energy_kwh: ...`, got 3"),
        ("- a list", "the file: expected lines such as `battery: ...`, got ['a list']"),
    ],
)
def test_a_mistake_is_named_with_file_key_and_value(tmp_path, text, message):
    refused(tmp_path, text, message)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "battery: {max_energy_kwh: 13.5, min_energy_kwh: 1.35}",
            "battery: expected min_energy_kwh <= initial_energy_kwh <= max_energy_kwh, got "
            "min_energy_kwh 1.35, initial_energy_kwh 1.2 (the default), max_energy_kwh 13.5. ",
        ),
        (
            "battery: {min_energy_kwh: 7}",
            "battery: expected max_energy_kwh >= min_energy_kwh, got max_energy_kwh 6.0 (the default), "
            "min_energy_kwh 7.0. ",
        ),
        (
            "comfort: {low_c: 25}",
            "comfort: expected low_c <= high_c, got low_c 25.0, high_c 24.0 (the default). ",
        ),
        (
            "building: {inertia_per_hour: 1}",
            "building.inertia_per_hour: expected 0 < inertia_per_hour < 1, got inertia_per_hour 1.0. ",
        ),
        (
            "airl: {rollouts: 4}",
            "airl: expected agent_rollouts <= rollouts, got agent_rollouts 8 (the default), rollouts 4. ",
        ),
        (
            "ddpg: {capacity: 100}",
            "ddpg: expected capacity >= rollouts * slots, got capacity 100, rollouts 8 (the default), "
            "slots 24 (the default). ",
        ),
        (
            "expert: {hvac: {planned_h: 12}}",
            "expert.hvac: expected carried_out_h <= planned_h, got carried_out_h 24.0 (the default), "
            "planned_h 12.0. ",
        ),
    ],
)
def test_a_contradiction_is_told_by_the_keys_with_all_values_and_which_are_defaults(tmp_path, text, message):
    refused(tmp_path, text, f"line 1: {message}")


def test_the_line_is_named(tmp_path):
    refused(tmp_path, "seeds: 2\n\ncomfort:\n  low_c: 20\n  high_c: 75\n", "line 5: comfort.high_c: expected")
    refused(tmp_path, "seeds: 2\nbattery:\n  max_enrgy_kwh: 5", "line 3: battery.max_enrgy_kwh: unknown key")
    refused(tmp_path, "seeds: 2\n\nbattery:\n  min_energy_kwh: 7", "line 3: battery: expected max_energy_kwh")


def test_a_decimal_number_is_what_it_looks_like(tmp_path):
    experiment = read_settings(written(tmp_path, "ppo: {learning_rate: 1e-3}\nseeds: 010\npv_scale: +1.5\n"))
    assert (experiment.ppo.learning_rate, experiment.seeds, experiment.pv_scale) == (0.001, 10, 1.5)


BOMB = "seeds: [&a [x,x,x,x,x,x,x,x,x], " + ", ".join(
    f"&{chr(98 + n)} [{','.join(['*' + chr(97 + n)] * 9)}]" for n in range(8)
)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("seeds: !!int abc", "line 1: .*tags"),
        ('seeds: !!int ""', "line 1: .*tags"),
        ("seeds: 1\ncomfort: {low_c: !!float abc}", "line 2: .*tags"),
        ("seeds: !!python/object:os.system x", "line 1: .*tags"),
        ("battery: &a {}\nhvac: *a", "line 1: .*anchors, aliases"),
        ("seeds: *a", "line 1: .*anchors, aliases"),
        (BOMB + "]", "line 1: .*anchors, aliases"),
        ("battery: {<<: {max_energy_kwh: 5}}", "line 1: .*merge keys"),
        ("seeds: 1\nseeds: 2", "line 2: .*the key seeds stands twice"),
        ("seeds: 1\nppo: {clip: 0.1, 'clip': 0.2}", "line 2: .*the key clip stands twice"),
        ("seeds: " + "[" * 50 + "]" * 50, "line 1: .*more than 16 levels"),
        ("seeds: " + "[" * 5000, "line 1: .*more than 16 levels"),
        ("seeds: " + "{a: " * 5000 + "1" + "}" * 5000, "line 1: .*more than 16 levels"),
        ("- " * 5000, "line 1: .*more than 16 levels"),
        ("seeds: " + "9" * 5000, "line 1: .*a number of 5000 characters"),
        ("? [a, b]\n: 1", "line 1: .*expected a word as key"),
        ("seeds: 3\n\tx: 1", "line 2: .*indented by spaces"),
        ("seeds: 3\nx: \x07", "line 2: .*control character.*Save it as plain UTF-8"),
        ('seeds: 3\ncurrency: "\\0"', "line 2: .*cannot be shown"),
        ('currency: "\\ud800"', "line 1: .*cannot be shown"),
        ("a: [", "line 1: .*expected YAML"),
        ("seeds: 1\n---\nseeds: 2", "line 2: .*another document"),
        ("time,pv_kw\n2024-01-01T00:00:00Z,1\n" * 1000, "the file: expected lines such as `battery: ...`"),
    ],
)
def test_what_is_no_plain_yaml_is_refused_in_one_line(tmp_path, text, message):
    refused(tmp_path, text, message, literally=False)


def test_files_that_are_no_settings_files(tmp_path):
    path = tmp_path / "home.yaml"
    for content, message in (
        (b"seeds: 1\n\xff\xfe\x00", "cannot read it: line 2 is not UTF-8 text"),
        ("seeds: 1\n# é\n".encode("latin-1"), "cannot read it: line 2 is not UTF-8 text"),
        ("seeds: 1".encode("utf-16"), "cannot read it: line 1 is not UTF-8 text"),
        ("seeds: 1".encode("utf-16-le"), "line 1: .*control character"),
        (b"#" * 2_000_000, "at most 100000 bytes"),
    ):
        path.write_bytes(content)
        with pytest.raises(HemmaError, match=message):
            read_settings(path)
    path.write_bytes(b"\xef\xbb\xbfseeds: 4\r\n")
    assert read_settings(path).seeds == 4
    with pytest.raises(HemmaError, match="cannot read it"):
        read_settings(tmp_path / "missing.yaml")
    with pytest.raises(HemmaError, match="cannot read it"):
        read_settings(tmp_path)


def test_settings_of_a_results_file_are_checked_as_well():
    for content in ({"\ud800": 1}, {"currency": "\ud800"}, {"seeds": 10**400}, {"learned": [3]}, [1], "x"):
        with pytest.raises(HemmaError, match=r"^results\.json: "):
            experiment_of(content, Path("results.json"))


def test_every_parameter_is_reachable_from_the_file():
    """Nothing is lost on the way out: as many values in the file as parameters in the tree."""

    def count(value):
        if is_dataclass(value):
            return sum(count(getattr(value, field.name)) for field in fields(value))
        return 1

    def leaves(content):
        return sum(leaves(item) for item in content.values()) if isinstance(content, dict) else 1

    assert leaves(yaml.safe_load(settings_text(Experiment()))) == count(Experiment())
    assert yaml.safe_load(settings_text(Experiment())) == outside(Experiment())


def test_quick_keeps_the_home_and_every_stage():
    experiment = replace(Experiment(), battery=Battery(max_energy=9.0))
    fast = quick(experiment)
    assert fast.battery == experiment.battery
    assert fast.seeds >= 1
    assert fast.data_efficiency.days
    assert fast.airl.iterations < experiment.airl.iterations
