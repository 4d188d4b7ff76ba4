"""The results file while an experiment runs: rewritten after every stage, never a mix of two settings."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from pydantic import ValidationError

import hemma
from hemma.errors import HemmaError
from hemma.results.comparisons import aggregate, improvements
from hemma.results.fingerprint import code
from hemma.results.progress import Progress
from hemma.results.reading import items, json_content, read_json, write_record
from hemma.results.results import RESULTS_FILE, HomeResults, Results

CODE = code("home", "identification", "optimisation", "rl", "irl", "forecasting", "control", "evaluation")
"""Of all that numbers in the file come from."""
INTERVAL_KIND = "Student's t below 10 runs, bootstrap from 10 runs on"
"""In words, for readers; each method says which of the two it has."""


@dataclass
class Ledger:
    """Collects the results of the homes of one folder."""

    folder: Path
    command: str
    """What was typed."""
    settings: dict[str, Any]
    homes: dict[str, HomeResults] = field(default_factory=dict)
    """Entries of the file, also those of earlier runs with the same settings. What follows from the runs in
    them is added when the file is written."""
    stale: set[str] = field(default_factory=set)
    """Files that an earlier results file named."""

    def put(self, name: str, results: HomeResults) -> None:
        """Take the results of a home and write the file, unless the file already says that and more."""
        known = self.homes.get(name)
        if known is not None and is_part_of(json_content(results), json_content(known)):
            return
        self.homes[name] = results
        write_record(self.folder / RESULTS_FILE, self.results)

    def close(self) -> None:
        """Remove the schedules and curves that only an earlier results file named."""
        write_record(self.folder / RESULTS_FILE, self.results)
        root = self.folder.resolve()
        for name in self.stale - _files(json_content(self.results)):
            path = (self.folder / name).resolve()
            if path.is_relative_to(root) and path.suffix == ".csv":
                path.unlink(missing_ok=True)

    @property
    def results(self) -> Results:
        """The whole file: the homes, and what their runs say about each other."""
        compared = {
            name: home.model_copy(update={"probability_of_improvement": improvements([home])})
            for name, home in self.homes.items()
        }
        return Results(
            hemma=hemma.__version__,
            code=CODE,
            command=self.command,
            settings=self.settings,
            interval_kind=INTERVAL_KIND,
            homes=compared,
            aggregate=aggregate(self.homes),
        )


def open_ledger(folder: Path, command: str, settings: dict[str, Any], progress: Progress) -> Ledger:
    """The ledger of a folder.

    Homes measured with other settings or another version are not taken over, nor is an entry that is damaged.
    """
    ledger = Ledger(folder, command, settings)
    try:
        earlier = read_json(folder / RESULTS_FILE)
    except (HemmaError, OSError):
        return ledger
    if not isinstance(earlier, dict) or not isinstance(earlier.get("homes"), dict):
        return ledger
    ledger.stale = _files(earlier["homes"])
    now = json_content(ledger.results)
    if all(earlier.get(key) == now[key] for key in ("schema", "hemma", "code", "settings")):
        ledger.homes = _sound(earlier["homes"], folder, progress)
    else:
        progress.noticed(
            f"{folder / RESULTS_FILE} held results of other settings or another version; they are replaced"
        )
    return ledger


def _sound(homes: dict[str, Any], folder: Path, progress: Progress) -> dict[str, HomeResults]:
    """The entries that can be read."""
    sound = {}
    for name, entry in homes.items():
        try:
            sound[name] = HomeResults.model_validate(entry)
        except ValidationError:
            progress.noticed(f"{folder / RESULTS_FILE}: the entry of {name} is damaged; it is made anew")
    return sound


def is_part_of(part: Any, whole: Any) -> bool:
    """Whether all that ``part`` says stands in ``whole`` as well; of a list of records each one does.

    None says nothing.
    """
    if part is None:
        return True
    if isinstance(part, dict) and isinstance(whole, dict):
        return all(name in whole and is_part_of(value, whole[name]) for name, value in part.items())
    if isinstance(part, list) and isinstance(whole, list) and all(isinstance(item, dict) for item in part):
        return all(any(is_part_of(item, other) for other in whole) for item in part)
    return part == whole


def _files(content: Any) -> set[str]:
    """Schedules and curves that entries of homes name, at whatever depth."""
    named = set()
    for item in items(content):
        if isinstance(item, dict):
            listed = item.get("schedules")
            found = [item.get("schedule"), item.get("curve"), *(listed if isinstance(listed, list) else [])]
            named |= {name for name in found if isinstance(name, str)}
    return named
