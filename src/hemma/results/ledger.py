"""The results file while an experiment runs: rewritten after every stage, never a mix of two settings."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from hemma.results.document import document, home_document, read_document
from hemma.results.found import RESULTS_FILE, Head, HomeResults
from hemma.results.progress import Progress
from hemma.results.reading import json_text, write_json
from hemma.results.results import HomeResults as HomeRecord


@dataclass
class Ledger:
    """Collects the results of the homes of one folder."""

    folder: Path
    head: Head
    homes: dict[str, Any] = field(default_factory=dict)
    """Entries of the file, also those of earlier runs with the same settings. What follows from the runs in
    them is added when the file is written."""
    stale: set[str] = field(default_factory=set)
    """Files that an earlier results file named."""

    def put(self, results: HomeResults) -> None:
        """Take the results of a home and write the file, unless the file already says that and more."""
        entry = home_document(results)
        if is_part_of(entry, self.homes.get(results.name)):
            return
        self.homes[results.name] = entry
        write_json(self.folder / RESULTS_FILE, self.content)

    def close(self) -> None:
        """Remove the schedules and curves that only an earlier results file named."""
        write_json(self.folder / RESULTS_FILE, self.content)
        root = self.folder.resolve()
        for name in self.stale - _files(self.homes):
            path = (self.folder / name).resolve()
            if path.is_relative_to(root) and path.suffix == ".csv":
                path.unlink(missing_ok=True)

    @property
    def content(self) -> Any:
        """The whole file."""
        return document(self.head, self.homes)


def open_ledger(folder: Path, head: Head, progress: Progress) -> Ledger:
    """The ledger of a folder. Homes measured with other settings or another version, and damaged entries, are
    not taken over."""
    earlier = read_document(folder)
    ledger = Ledger(folder, head)
    if not isinstance(earlier, dict) or not isinstance(earlier.get("homes"), dict):
        return ledger
    ledger.stale = _files(earlier["homes"])
    now = ledger.content
    if all(earlier.get(key) == now[key] for key in ("schema", "hemma", "code", "settings")):
        ledger.homes = {name: entry for name, entry in earlier["homes"].items() if _is_whole(entry)}
        for name in earlier["homes"].keys() - ledger.homes.keys():
            progress.noticed(f"{folder / RESULTS_FILE}: the entry of {name[:60]} is damaged and left out")
    else:
        progress.noticed(
            f"{folder / RESULTS_FILE} held results of other settings or another version; they are replaced"
        )
    return ledger


def is_part_of(part: Any, whole: Any) -> bool:
    """Whether all that ``part`` says stands in ``whole`` as well; of a list of records each one does."""
    if isinstance(part, dict) and isinstance(whole, dict):
        return all(name in whole and is_part_of(value, whole[name]) for name, value in part.items())
    if isinstance(part, list) and isinstance(whole, list) and all(isinstance(item, dict) for item in part):
        return all(any(is_part_of(item, other) for other in whole) for item in part)
    return part == whole


def _is_whole(entry: Any) -> bool:
    """Whether an entry of a home is as ``home_document`` makes them."""
    try:
        HomeRecord.model_validate_json(json_text(entry), strict=True)
    except (ValueError, RecursionError):
        return False
    return True


def _files(content: Any) -> set[str]:
    """Schedules and curves that entries of homes name, at whatever depth."""
    named, waiting = set(), [content]
    while waiting:
        item = waiting.pop()
        if isinstance(item, list):
            waiting += item
        elif isinstance(item, dict):
            waiting += item.values()
            listed = item.get("schedules")
            found = [item.get("schedule"), item.get("curve"), *(listed if isinstance(listed, list) else [])]
            named |= {name for name in found if isinstance(name, str)}
    return named
