"""Who may talk to the studio: programs on this machine that know the token in its address.

The page sets the token as a cookie on its first answer; every later request and the socket show it.
A request under another host's name is refused, so that no other page of the browser gets in.
"""

from __future__ import annotations

import hmac
import secrets
from collections.abc import Mapping
from http.cookies import CookieError, SimpleCookie
from ipaddress import ip_address
from urllib.parse import parse_qs, urlsplit

from starlette.datastructures import Headers, MutableHeaders
from starlette.responses import PlainTextResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

LOOPBACK = "127.0.0.1"

_NAMES = frozenset({LOOPBACK, "localhost", "::1"})


def new_token() -> str:
    """A token that nobody guesses."""
    return secrets.token_urlsafe(24)


class Guard:
    """Lets requests with the token through, and no others.

    Parameters
    ----------
    app : what is guarded.
    token : in the address's query as ``token``, or in the cookie of :func:`cookie_name`.
    port : the studio's own.
    """

    def __init__(self, app: ASGIApp, token: str, port: int) -> None:
        self.app, self.token, self.port = app, token, port

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Hand the request on, or refuse it."""
        if scope["type"] not in ("http", "websocket"):
            await self.app(scope, receive, send)
            return
        headers = Headers(scope=scope)
        query = parse_qs(scope["query_string"].decode("latin-1")).get("token", [""])[0]
        known = self._is_token(query)
        if not self._is_here(scope, headers) or not (
            known or self._is_token(self._cookie(headers))
        ):
            await self._refuse(scope, receive, send)
            return
        await self.app(scope, receive, self._with_cookie(send) if known else send)

    def _is_token(self, found: str) -> bool:
        return hmac.compare_digest(found.encode(), self.token.encode())

    def _cookie(self, headers: Mapping[str, str]) -> str:
        cookies: SimpleCookie = SimpleCookie()
        try:
            cookies.load(headers.get("cookie", ""))
        except CookieError:
            return ""
        found = cookies.get(cookie_name(self.port))
        return "" if found is None else found.value

    def _is_here(self, scope: Scope, headers: Mapping[str, str]) -> bool:
        """Whether the request comes from this machine, to this name, from a page of ours."""
        client = scope.get("client")
        if client is None or not _is_loopback(client[0]):
            return False
        host = urlsplit(f"//{headers.get('host', '')}").hostname
        origin = headers.get("origin")
        ours = origin is None or _is_origin(origin, self.port)
        return host in _NAMES and ours

    def _with_cookie(self, send: Send) -> Send:
        async def sending(message: Message) -> None:
            if message["type"] == "http.response.start":
                value = f"{cookie_name(self.port)}={self.token}; Path=/; HttpOnly; SameSite=Strict"
                MutableHeaders(scope=message).append("set-cookie", value)
            await send(message)

        return sending

    @staticmethod
    async def _refuse(scope: Scope, receive: Receive, send: Send) -> None:
        """Hand the request on, or refuse it."""
        if scope["type"] == "websocket":
            await send({"type": "websocket.close", "code": 1008})
            return
        text = "This studio opens with the whole address that gridshell view printed.\n"
        await PlainTextResponse(text, status_code=403)(scope, receive, send)


def cookie_name(port: int) -> str:
    """Cookies do not tell ports apart; two studios need two names."""
    return f"gridshell-{port}"


def _is_loopback(host: str) -> bool:
    try:
        return ip_address(host).is_loopback
    except ValueError:
        return False


def _is_origin(origin: str, port: int) -> bool:
    parts = urlsplit(origin)
    try:
        return parts.hostname in _NAMES and parts.port == port
    except ValueError:
        return False
