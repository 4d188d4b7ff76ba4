"""Progress on a terminal."""

from collections.abc import Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.markup import escape
from rich.progress import BarColumn, Progress, TaskID, TextColumn, TimeElapsedColumn


class Bars:
    """One bar a stage; a finished stage leaves one line."""

    def __init__(self, progress: Progress):
        self._progress = progress
        self._bars: dict[str, TaskID] = {}

    def started(self, stage: str, total: int) -> None:
        """The stage begins."""
        self._bars[stage] = self._progress.add_task(escape(stage), total=total, message="")

    def advanced(self, stage: str, done: int, message: str) -> None:
        """The bar moves."""
        self._progress.update(self._bars[stage], completed=done, message=escape(message))

    def finished(self, stage: str, message: str) -> None:
        """The bar gives way to a line."""
        if stage in self._bars:
            self._progress.remove_task(self._bars.pop(stage))
        self._progress.console.print(f"[green]✓[/] {escape(stage)}: {escape(message)}")

    def reused(self, stage: str, message: str) -> None:
        """The stage was not run."""
        self._progress.console.print(
            f"[dim]✓ {escape(stage)}: kept from an earlier run, {escape(message)}[/]"
        )

    def noticed(self, message: str) -> None:
        """Something to know."""
        self._progress.console.print(f"[yellow]![/] {escape(message)}")


@contextmanager
def show_bars() -> Iterator[Bars]:
    """Bars on standard error while the block runs."""
    columns = (
        TextColumn("  {task.description}"),
        BarColumn(),
        TimeElapsedColumn(),
        TextColumn("{task.fields[message]}"),
    )
    with Progress(*columns, console=Console(stderr=True), transient=True) as progress:
        yield Bars(progress)
