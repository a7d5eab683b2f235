"""The studio's server: on this machine only, behind a token."""

from __future__ import annotations

import asyncio
import gc
import socket
import webbrowser
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from fabrication.studio.guard import LOOPBACK, Guard, new_token
from gridshell import SettingError


def serve(path: Path, *, port: int | None, browser: bool, told: Callable[[str], None]) -> None:
    """Show the project at *path* until Ctrl-C.

    Parameters
    ----------
    port : of the address; None for any that is free.
    browser : whether to open the address in the browser.
    told : hears the address.

    Raises
    ------
    ProjectError, SettingError
        When the project cannot be used, or the port is taken.
    """
    from nicegui import app
    from starlette.responses import Response

    from fabrication.studio.page import Page
    from fabrication.studio.session import Session

    session = Session(path)
    chosen = free_port(port)
    token = new_token()
    address = f"http://{LOOPBACK}:{chosen}/?token={token}"
    app.add_middleware(Guard, token=token, port=chosen)

    @app.get("/flat")
    def flat(mark: str) -> Response:
        drawn = None if session.built is None else session.built.patterns.get(mark)
        if drawn is None:
            return Response(status_code=404)
        return Response(drawn, media_type="image/svg+xml")

    working: list[asyncio.Task[None]] = []

    def begin() -> None:
        working.append(asyncio.create_task(session.work()))
        gc.freeze()  # what was loaded stays: looking through it again takes a tenth of a second
        told(f"{path} is at {address}\nCtrl-C ends it.")
        if browser:
            webbrowser.open(address)

    async def end() -> None:
        for task in working:
            task.cancel()
        kept = session.rescue()
        if kept:
            told(f"What was not saved is in {kept}.")

    app.on_startup(begin)
    app.on_shutdown(end)

    def root() -> None:
        Page(session)

    with suppress(KeyboardInterrupt):  # the usual end
        _run(root, chosen, session.present.project.name)


def _run(root: Callable[[], None], port: int, name: str) -> None:
    from nicegui import ui

    ui.run(
        root,
        host=LOOPBACK,
        port=port,
        title=f"{name} – gridshell",
        show=False,
        reload=False,
        tailwind=False,
        show_welcome_message=False,
        ws_per_message_deflate=False,  # megabytes to this machine itself
    )


def free_port(port: int | None) -> int:
    """*port* where nobody listens, or any other.

    Raises
    ------
    SettingError
        When somebody listens on *port*.
    """
    with socket.socket() as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((LOOPBACK, port or 0))
        except OSError as error:
            raise SettingError(
                "The port cannot be used",
                where="--port",
                value=f"{port}, {error.strerror}",
                advice="another one, or leave it out for one that is free",
            ) from None
        return int(probe.getsockname()[1])
