"""The studio's server: on this machine only, behind a token."""

from __future__ import annotations

import asyncio
import socket
import webbrowser
from collections.abc import Callable
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
    from nicegui import app, ui
    from starlette.responses import Response

    from fabrication.export.report import strip_svg
    from fabrication.lamella_system import LamellaSystem
    from fabrication.studio.page import Page
    from fabrication.studio.session import Session

    session = Session(path)
    chosen = free_port(port)
    token = new_token()
    address = f"http://{LOOPBACK}:{chosen}/?token={token}"
    app.add_middleware(Guard, token=token, port=chosen)

    @app.get("/flat")
    def flat(mark: str) -> Response:
        system = None if session.built is None else session.built.system
        if isinstance(system, LamellaSystem):
            families = (lamella.family for lamella in system.jointed.strips.lamellas)
            for part, family in zip(system.parts, families, strict=True):
                if part.mark == mark:
                    return Response(strip_svg(part, family), media_type="image/svg+xml")
        return Response(status_code=404)

    working: list[asyncio.Task[None]] = []

    def begin() -> None:
        working.append(asyncio.create_task(session.work()))
        told(f"{path} is at {address}\nCtrl-C ends it.")
        if browser:
            webbrowser.open(address)

    async def end() -> None:
        for task in working:
            task.cancel()

    app.on_startup(begin)
    app.on_shutdown(end)

    def root() -> None:
        Page(session)

    ui.run(
        root,
        host=LOOPBACK,
        port=chosen,
        title=f"{session.present.project.name} – gridshell",
        show=False,
        reload=False,
        tailwind=False,
        show_welcome_message=False,
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
