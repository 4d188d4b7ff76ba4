"""The plain words follow the numbers, whichever way they point."""

import json
from pathlib import Path

import pytest
from synthetic_results import save_results

from hemma.report.page.headline import Headline, headline
from hemma.results.results import load_results


def _said(folder: Path, content: dict) -> Headline:
    save_results(folder, content)
    return headline("home", load_results(folder).homes["home"])


@pytest.mark.parametrize(
    ("cost", "share", "title"),
    [
        (49.06, -0.4, "HA-1 costs 10.0\u00a0% more than Rule and keeps −40.0\u00a0% of the possible savings"),
        (22.3, 0.951, "HA-1 costs 50.0\u00a0% less than Rule and keeps 95.1\u00a0% of the possible savings"),
        (22.3, None, "HA-1 costs 50.0\u00a0% less than Rule"),
        (-4.46, None, "HA-1 costs 110.0\u00a0% less than Rule"),
    ],
)
def test_title(small, cost, share, title):
    folder, content = small
    content["homes"]["home"]["methods"]["HA-1"]["mean"] |= {"energy_cost": cost, "share_of_savings": share}
    assert _said(folder, content).title == title


def test_no_percentage_of_a_rule_that_earns(small):
    folder, content = small
    content["homes"]["home"]["methods"]["Rule"]["mean"]["energy_cost"] = -1.0
    content["homes"]["home"]["methods"]["HA-1"]["mean"]["energy_cost"] = -2.0
    assert _said(folder, content).title == "HA-1 costs −$2.00"


def test_one_seed_is_said_to_have_no_known_spread(small):
    folder, content = small
    method = content["homes"]["home"]["methods"]["HA-1"]
    method["runs"], method["interval"] = method["runs"][:1], {}
    assert "(one seed, so nobody knows its spread)" in _said(folder, content).text


def test_an_undefined_share_is_not_spoken_of(small):
    folder, content = small
    content["homes"]["home"]["methods"]["HA-1"]["mean"]["share_of_savings"] = None
    assert "equal comfort" not in _said(folder, content).text


def test_perfect_comfort_is_said_in_words(small):
    folder, content = small
    content["homes"]["home"]["methods"]["HA-1"]["mean"]["mean_temperature_deviation"] = 0.0
    assert (
        "The rooms never leave the comfort band of 19 to 24 °C (Rule: 0.4700" in _said(folder, content).text
    )


def test_without_rule_and_optimum_neither_is_spoken_of(small):
    folder, content = small
    home = content["homes"]["home"]
    home["methods"] = {"HA-1": home["methods"]["HA-1"]}
    del home["optimum"]
    text = _said(folder, content).text
    assert "Rule" not in text
    assert "perfect information" not in text


def test_the_default_controller_is_named_beside_the_main_method(small):
    folder, content = small
    assert "default controller" not in _said(folder, content).text
    methods = content["homes"]["home"]["methods"]
    methods["default"] = json.loads(json.dumps(methods["HA-1"]))
    methods["default"]["mean"] |= {"energy_cost": 21.5, "share_of_savings": 0.975}
    said = _said(folder, content).text
    assert "The default controller costs $21.50 and keeps 97.5\u00a0% of them." in said
