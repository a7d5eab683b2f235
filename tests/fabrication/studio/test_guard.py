import pytest
from starlette.applications import Starlette
from starlette.responses import PlainTextResponse
from starlette.routing import Route, WebSocketRoute
from starlette.testclient import TestClient
from starlette.websockets import WebSocketDisconnect

from fabrication.studio.guard import Guard, new_token

TOKEN, PORT = "right-token", 8123
HERE = f"http://127.0.0.1:{PORT}"


async def _page(request):
    return PlainTextResponse("inside")


async def _socket(websocket):
    await websocket.accept()
    await websocket.send_text("inside")
    await websocket.close()


def visitor(client=("127.0.0.1", 50000), base=HERE):
    app = Starlette(routes=[Route("/", _page), WebSocketRoute("/ws", _socket)])
    return TestClient(Guard(app, TOKEN, PORT), base_url=base, client=client)


def test_the_address_with_the_token_opens_and_is_remembered():
    here = visitor()
    first = here.get("/", params={"token": TOKEN})
    assert (first.status_code, first.text) == (200, "inside")
    cookie = first.headers["set-cookie"]
    assert "HttpOnly" in cookie
    assert "SameSite=Strict" in cookie
    assert here.get("/").text == "inside"


@pytest.mark.parametrize("query", [{}, {"token": ""}, {"token": "wrong"}, {"token": "röght"}])
def test_without_the_token_nothing_is_told(query):
    refused = visitor().get("/", params=query)
    assert refused.status_code == 403
    assert "gridshell view" in refused.text
    assert "set-cookie" not in refused.headers


def test_the_cookie_of_another_studio_does_not_open_this_one():
    here = visitor()
    here.cookies.set("gridshell-8124", TOKEN)
    assert here.get("/").status_code == 403


@pytest.mark.parametrize("base", ["http://evil.example:8123", "http://10.0.0.5:8123"])
def test_another_name_of_this_machine_is_refused(base):
    """A page elsewhere that makes its own name point here is still a stranger."""
    assert visitor(base=base).get("/", params={"token": TOKEN}).status_code == 403


@pytest.mark.parametrize("address", [("192.168.0.7", 50000), ("somewhere", 50000)])
def test_another_machine_is_refused(address):
    assert visitor(client=address).get("/", params={"token": TOKEN}).status_code == 403


@pytest.mark.parametrize(
    "origin", ["http://evil.example", "http://127.0.0.1:9999", "null", "http://127.0.0.1:x"]
)
def test_a_page_of_another_origin_is_refused(origin):
    found = visitor().get("/", params={"token": TOKEN}, headers={"origin": origin})
    assert found.status_code == 403


def test_the_socket_needs_the_token_too():
    here = visitor()
    named = {"origin": HERE, "host": f"127.0.0.1:{PORT}"}
    with pytest.raises(WebSocketDisconnect), here.websocket_connect("/ws", headers=named):
        pass
    with here.websocket_connect(f"/ws?token={TOKEN}", headers=named) as socket:
        assert socket.receive_text() == "inside"


def test_tokens_differ_and_are_long():
    assert new_token() != new_token()
    assert len(new_token()) >= 32
