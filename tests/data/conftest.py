"""Where the tests write their synthetic files."""

import pytest
from canonical_files import HEADER
from dataport_files import QUARTER, instants


@pytest.fixture
def folder(tmp_path):
    weather = ["time,outdoor_c"]
    weather += [
        f"{t.isoformat()},{20 + t.hour / 2}" for t in instants(24 * 9, "2018-05-30T00:00+00:00", 4 * QUARTER)
    ]
    (tmp_path / "weather.csv").write_text("\n".join(weather))
    return tmp_path


@pytest.fixture
def write(tmp_path):
    def written(lines, header=HEADER):
        path = tmp_path / "home.csv"
        path.write_text("\n".join([header, *lines]) + "\n")
        return path

    return written
