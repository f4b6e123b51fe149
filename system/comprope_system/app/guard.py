"""Who may use the app: only pages of this machine's browser that know the token, through its own address.

Other web pages and other machines that resolve a name to this address are refused by the headers Host and Origin, other users of
this machine by the token, which is in the address that the command prints and then in a cookie.
"""

from hmac import compare_digest
from http.cookies import CookieError, SimpleCookie
from urllib.parse import parse_qs

from starlette.datastructures import Headers, MutableHeaders
from starlette.responses import PlainTextResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

READING = ("GET", "HEAD")
POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; connect-src 'self'; frame-src 'self'; "
    "form-action 'none'; base-uri 'none'; frame-ancestors 'self'"
)
HEADERS = {"x-content-type-options": "nosniff", "referrer-policy": "no-referrer", "cache-control": "no-store"}


class Guard:
    """ASGI middleware that answers 403 to whoever may not use the app."""

    def __init__(self, app: ASGIApp, token: str, port: int) -> None:
        self.app, self.token, self.cookie = app, token, f"comprope-{port}"
        self.hosts = (f"127.0.0.1:{port}", f"localhost:{port}")

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass a request on, or refuse it."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        refused = self._refused(scope)
        if refused:
            await PlainTextResponse(refused, 403, HEADERS)(scope, receive, send)
            return

        async def answered(message: Message) -> None:
            if message["type"] == "http.response.start":
                headers = MutableHeaders(scope=message)
                for name, value in HEADERS.items():
                    headers[name] = value
                headers.setdefault("content-security-policy", POLICY)
                headers.append("set-cookie", f"{self.cookie}={self.token}; Path=/; HttpOnly; SameSite=Strict")
            await send(message)

        await self.app(scope, receive, answered)

    def _refused(self, scope: Scope) -> str:
        """Why a request is refused; empty if it is not."""
        headers = Headers(scope=scope)
        host, origin = headers.get("host", ""), headers.get("origin")
        if host not in self.hosts:
            return f"Host: {host[:80]} is not the address of this app."
        if origin is None and scope["method"] not in READING:
            return "Origin: none was stated; only pages of this app may change anything."
        if origin is not None and origin != f"http://{host}":
            return f"Origin: {origin[:80]} is not this app."
        if not any(compare_digest(one.encode(), self.token.encode()) for one in self._tokens(scope, headers)):
            return "The token is missing or wrong. Open the address that `comprope app` printed."
        return ""

    def _tokens(self, scope: Scope, headers: Headers) -> list[str]:
        """The tokens that a request shows."""
        found = parse_qs(scope["query_string"].decode("latin-1")).get("token", [])
        try:
            cookie = SimpleCookie(headers.get("cookie", "")).get(self.cookie)
        except CookieError:
            cookie = None
        return [*found, *([cookie.value] if cookie else [])]
