"""The 3D view of reports as an element of the studio's page."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from nicegui.element import Element

from fabrication.export.scene import page
from fabrication.export.scene.layers import Scene


class ShellView(
    Element,
    component="shell_view.js",
    esm={
        "nicegui-scene": str(page.library_folder()),
        "gridshell-scene": str(Path(page.__file__).parent),
    },
):
    """The 3D view.

    Parameters
    ----------
    patterns : where the page gets a part's flat pattern, with its mark in the query.
    ready : called when the browser can show something.
    """

    def __init__(self, patterns: str, ready: Callable[[], None]) -> None:
        super().__init__()
        self._props["patterns"] = patterns
        self.on("ready", lambda: ready())

    def show(self, scene: Scene, *, pending: bool = False) -> None:
        """Show *scene*: all there is, or a net that what is built on it still has to follow."""
        self.run_method("replace", scene.packed(), {"pending": pending})

    def choose(self, mark: str) -> None:
        """Show one part alone."""
        self.run_method("select", mark)
