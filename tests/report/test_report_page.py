"""The page: complete, self-contained, accessible, and safe with any text."""

import base64
import re
from html.parser import HTMLParser
from itertools import pairwise

import pytest
from synthetic_results import save_results, write_results

from hemma.report import results_table, write_report

EVIL = '"><img src=x onerror=alert(1)><script>alert(2)</script>'


class _Page(HTMLParser):
    """Elements with their attributes, and all text outside the style sheet."""

    def __init__(self, html: str):
        super().__init__()
        self.elements: list[tuple[str, dict[str, str | None]]] = []
        self.texts: list[str] = []
        self._open: list[str] = []
        self.feed(html)

    def handle_starttag(self, tag, attrs):
        self.elements.append((tag, dict(attrs)))
        if tag == "style":
            self._open.append(tag)

    def handle_endtag(self, tag):
        if tag == "style":
            self._open.pop()

    def handle_data(self, data):
        if not self._open:
            self.texts.append(data)

    def all(self, tag: str) -> list[dict[str, str | None]]:
        return [attributes for name, attributes in self.elements if name == tag]

    @property
    def text(self) -> str:
        return " ".join(self.texts)


@pytest.fixture(scope="module")
def page(written) -> _Page:
    return _Page(written.html)


def test_every_cell_of_the_table_stands_in_the_page(written, page):
    for row in results_table(written.folder):
        for cell in row.measures.values():
            assert cell.value in page.texts
            assert not cell.detail or cell.detail in page.texts


def test_every_cell_knows_its_column_for_screens_that_have_no_room_for_columns(written, page):
    labels = [cell["data-label"] for cell in page.all("td")]
    headings = list(results_table(written.folder)[0].measures)
    assert labels[: len(headings)] == headings
    assert all(labels)
    assert "content: attr(data-label)" in written.html


def test_nothing_is_loaded_from_anywhere(written, page):
    tags = {tag for tag, _ in page.elements}
    assert not tags & {
        "script",
        "link",
        "iframe",
        "object",
        "embed",
        "video",
        "audio",
        "source",
        "base",
        "form",
    }
    for tag, attributes in page.elements:
        assert not {"href", "srcset", "action", "background", "style"} & set(attributes), tag
        assert "src" not in attributes or str(attributes["src"]).startswith("data:image/svg+xml;base64,")
    assert not re.search(r"url\(|@import|https?:", written.html)


def test_the_figures_refer_only_to_themselves(page):
    for image in page.all("img"):
        svg = base64.b64decode(str(image["src"]).split(",", 1)[1]).decode()
        assert all(link.startswith("#") for link in re.findall(r'href="([^"]*)"', svg))
        assert "<script" not in svg
        assert "<image" not in svg


def test_the_embedded_figures_are_the_files(written, page):
    embedded = {base64.b64decode(str(image["src"]).split(",", 1)[1]) for image in page.all("img")}
    files = {
        path.read_bytes() for path in (written.folder / "figures").glob("*.svg") if path.stem != "results"
    }
    assert embedded == files


def test_a_reader_who_cannot_see_gets_everything(page):
    assert page.all("html") == [{"lang": "en"}]
    assert all(len(image["alt"] or "") > 30 for image in page.all("img"))
    assert all(head["scope"] in ("col", "row", "rowgroup") for head in page.all("th"))
    levels = [int(tag[1]) for tag, _ in page.elements if re.fullmatch(r"h[1-6]", tag)]
    assert levels[0] == 1
    assert levels.count(1) == 1
    assert all(below - above <= 1 for above, below in pairwise(levels))


def test_the_alternative_texts_hold_the_numbers(page):
    costs = next(image["alt"] for image in page.all("img") if (image["alt"] or "").startswith("Bars"))
    assert "Rule $44.60" in str(costs)


def test_the_headline_is_computed(written, page):
    methods = written.content["homes"]["austin2021-1"]["methods"]
    cost, share = (methods["HA-1"]["mean"][key] for key in ("energy_cost", "share_of_savings"))
    low, high = methods["HA-1"]["interval"]["energy_cost"]
    assert f"HA-1 costs ${cost:.2f} (mean of 3 seeds, 95 % interval ${low:.2f} to ${high:.2f})" in page.text
    assert "Rule costs $44.60; perfect information would cost $28.40." in page.text
    assert f"HA-1 costs {100 * (44.6 - cost) / 44.6:.1f}\u00a0% less than Rule" in page.text
    assert f"keeps {100 * share:.1f}\u00a0% of the possible savings" in page.text


@pytest.mark.usefixtures("undrawn")
def test_what_no_controller_can_keep_comfortable_is_not_compared_at_equal_comfort(small, page):
    assert "At equal comfort HA-1 keeps" in page.text
    assert "out of reach" not in page.text
    folder, content = small
    home = content["homes"]["home"]
    home["optimum"]["mean_temperature_deviation"] = 0.51
    home["recommendation"] = {
        "method": "Rule", "days": 9, "judged": [{"method": "Rule", "daily_cost": 2.0, "excess": 0.0}],
    }  # fmt: skip
    save_results(folder, content)
    said = _Page(write_report(folder).read_text(encoding="utf-8"))
    images = " ".join(str(image["alt"]) for image in said.all("img"))
    start = said.text.index("How to read it")
    assert "equal comfort" not in (said.text[:start] + images).lower()
    assert "At the same deviation from comfort HA-1 keeps" in said.text
    assert "outside the band by 0.5100\u00a0°C on average" in said.text


@pytest.mark.usefixtures("undrawn")
@pytest.mark.parametrize(("gap", "is_proven"), [(9e-7, True), (1.1e-6, False), (None, True)])
def test_an_optimum_whose_bound_is_open_is_said_to_be_unproven(small, gap, is_proven):
    folder, content = small
    content["homes"]["home"]["optimum"]["relative_gap"] = gap
    save_results(folder, content)
    (row,) = [row for row in results_table(folder) if row.method == "optimum"]
    assert (row.measures["Gap to optimum"].detail == "not proven") is not is_proven
    said = _Page(write_report(folder).read_text(encoding="utf-8")).text
    assert ("would cost $28.40 (not proven)." in said) is not is_proven
    assert ("It is not proven" in said) is not is_proven


@pytest.mark.usefixtures("undrawn")
def test_a_row_whose_perfect_information_is_not_proven_says_so(small):
    folder, content = small
    content["homes"]["home"]["methods"]["Rule"]["mean"]["reference_gap"] = 1.1e-6
    save_results(folder, content)
    told = {
        row.method: "not proven" in row.measures["Gap to optimum"].detail for row in results_table(folder)
    }
    assert [method for method, is_told in told.items() if is_told] == ["Rule"]


def test_order_of_the_sections(page):
    wanted = [
        "Results on austin2021-1", "The six panels", "A week of every method", "Cost against comfort",
        "Where the regret comes from", "How sure the differences are", "How to read it", "Learning curves",
        "Identification", "Data, attribution and limits", "Settings, and how to get this again",
    ]  # fmt: skip
    places = [page.texts.index(title) for title in wanted]
    assert places == sorted(places)


def test_origin_settings_and_command_are_told(written, page):
    home = written.content["homes"]["austin2021-1"]
    for told in (home["source"], home["notes"][0], "airl.rounds", "1800", "0, 1, 2", "not set"):
        assert told in page.texts
    assert home["traces_sha256"] in page.text
    assert "hemma reproduce --out results" in page.texts
    assert "Hemma 0.1.0" in page.text


def test_identification_errors_are_told(page):
    for told in ("24 h", "0.1430\u00a0°C", "Fitting the network took 12\u00a0s."):
        assert told in page.texts


def test_the_parts_of_the_regret_stand_in_a_table(written, page):
    for split in written.content["homes"]["austin2021-1"]["regret"].values():
        for amount in split.values():
            assert f"{'−' if amount < 0 else ''}${abs(amount):.2f}" in page.texts


@pytest.mark.usefixtures("undrawn")
def test_the_kind_of_interval_is_told_and_older_folders_used_students_t(written, page, small):
    assert "95 % interval of that mean (Student's t below 10 runs, bootstrap from 10 runs on)" in page.text
    folder, content = small
    del content["interval_kind"]
    save_results(folder, content)
    assert "95 % interval of that mean (Student's t)" in _Page(write_report(folder).read_text()).text


@pytest.mark.usefixtures("undrawn")
def test_an_older_folder_says_what_it_does_not_have(small):
    folder, content = small
    home = content["homes"]["home"]
    for key in ("probability_of_improvement", "regret", "pareto"):
        del home[key]
    save_results(folder, content)
    page = _Page(write_report(folder).read_text(encoding="utf-8"))
    assert "No sweep of cost against comfort in this folder." in page.texts
    assert "The regret is not split in this folder." in page.texts
    assert "No learned method is compared with another run by run in this folder." in page.texts


def test_hostile_names_are_text(tmp_path):
    content = write_results(tmp_path, homes=("home",), seeds=1, methods=("Rule",))
    home = content["homes"].pop("home")
    (tmp_path / f"schedules/{EVIL}").parent.mkdir(parents=True, exist_ok=True)
    (tmp_path / "schedules/home").rename(tmp_path / "schedules/<b>home")
    run = home["methods"]["Rule"]["runs"][0]
    run["schedule"] = run["schedule"].replace("/home/", "/<b>home/")
    home["methods"] = {EVIL: home["methods"]["Rule"], r"$\frac{$": home["methods"]["Rule"]}
    home["regret"] = {EVIL: {"total": 1.0, "future": 2.0, "thermal_model": 0.0, "policy": -1.0}}
    point = {"value": 1.0, "energy_cost": 1.0, "mean_temperature_deviation": 0.0}
    home["pareto"] = [{"series": EVIL, "parameter": EVIL, **point}]
    home |= {"source": EVIL, "notes": [EVIL], "traces_sha256": EVIL, "currency": EVIL, "data_efficiency": []}
    home["identification"]["rmse_c"] = {EVIL: 0.1}
    content |= {"hemma": EVIL, "command": EVIL, "settings": {EVIL: {EVIL: EVIL}}, "homes": {"<b>home": home}}
    save_results(tmp_path, content)
    page = _Page(write_report(tmp_path).read_text(encoding="utf-8"))
    assert not page.all("script")
    assert not page.all("b")
    assert all("onerror" not in attributes for _, attributes in page.elements)
    assert page.texts.count(EVIL) >= 5
    assert "Results on <b>home" in page.texts


def test_the_dash_is_explained(page):
    assert "–" in page.texts
    assert "En dash (–)" in page.texts


@pytest.mark.usefixtures("undrawn")
def test_a_partial_folder_still_gives_a_report(small):
    folder, content = small
    home = content["homes"]["home"]
    home["methods"] = {"HA-1": home["methods"]["HA-1"]}
    home["methods"]["HA-1"]["runs"][0] |= {"curve": None}
    home["methods"]["HA-1"]["runs"][1] |= {"curve": None, "schedule": None}
    for key in ("identification", "optimum", "demonstration_days", "data_efficiency", "notes"):
        del home[key]
    content["homes"]["next"] = home | {"methods": {}}
    save_results(folder, content)
    page = _Page(write_report(folder).read_text(encoding="utf-8"))
    assert "Rule costs" not in page.text
    assert "No training curve in this folder." in page.texts
    assert "No thermal model was identified for this home." in page.texts
    assert "Not finished yet: next." in page.texts
    assert not (folder / "figures/training-curves.png").exists()
