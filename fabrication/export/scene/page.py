"""The 3D view as a part of an HTML page: three.js, the viewer and a scene, all inline.

three.js comes from the package nicegui, which carries it as one module; the pages ask the network
for nothing.
"""

from __future__ import annotations

import base64
import json
import re
import zlib
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from markupsafe import Markup

_HERE = Path(__file__).parent


def library_folder() -> Path:
    """The folder of three.js as one module, ``index.js``."""
    found = find_spec("nicegui")
    if found is None or found.origin is None:
        raise AssertionError("nicegui is a dependency")
    return Path(found.origin).parent / "elements" / "scene" / "dist"


@cache
def library() -> str:
    """three.js with its controls, as the text of a module."""
    text = (library_folder() / "index.js").read_text(encoding="utf-8")
    return re.sub(r"^//# sourceMappingURL=.*$", "", text, flags=re.MULTILINE)


@cache
def viewer() -> str:
    """The viewer as the text of one module."""
    layers, view = (
        (_HERE / name).read_text(encoding="utf-8") for name in ("layers.js", "viewer.js")
    )
    return layers + re.sub(r"^import .*$", "", view, flags=re.MULTILINE)


def style() -> Markup:
    """The viewer's own CSS."""
    return Markup((_HERE / "viewer.css").read_text(encoding="utf-8"))


def scripts() -> Markup:
    """Inert script elements ``#three`` and ``#viewer``, and the function ``shell(root, options)``.

    That one imports the two as modules, shows the page's ``#scene``, and promises the view.
    """
    inert = "".join(
        f'<script type="text/plain" id="{name}">{_inert(text)}</script>\n'
        for name, text in (("three", library()), ("viewer", viewer()))
    )
    own = (_HERE / "shell.js").read_text(encoding="utf-8")
    return Markup(f"{inert}<script>\n{own}</script>\n")


def _inert(text: str) -> str:
    """*text* without what would end a script element."""
    return re.sub(r"</(script)|<!--", lambda m: f"<\\/{m[1]}" if m[1] else "<\\!--", text)


def deflated(value: Any) -> str:
    """*value* as JSON, deflated and in base 64: for what is large and not needed at once."""
    text = json.dumps(value, allow_nan=False, separators=(",", ":"))
    return base64.b64encode(zlib.compress(text.encode(), 9)).decode()


def as_json(value: Any) -> Markup:
    """*value* for a script of a page."""
    return Markup(json.dumps(value, allow_nan=False).replace("<", "\\u003c"))
