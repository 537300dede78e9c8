"""A headless Chromium that is driven over the DevTools protocol, through a pipe: no driver is needed.

    with Browser() as browser:
        page = browser.open(pathlib.Path("x.html"), "#view=scene")
        page.evaluate("galactic.parts.length")

What a page writes to the console and asks of a network is kept: page.errors, page.requests.
"""

import base64
import json
import os
import pathlib
import select
import shutil
import signal
import struct
import subprocess
import tempfile
import time
import zlib

PROGRAMS = ("chromium", "chromium-browser", "google-chrome")
# Drawing in software: the same pixels on every machine, with or without a graphics processor.
ARGUMENTS = (
    "--headless=new",
    "--no-sandbox",
    "--disable-gpu",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--hide-scrollbars",
    "--mute-audio",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-extensions",
    "--force-device-scale-factor=1",
    "--force-color-profile=srgb",
    "--remote-debugging-pipe",
    "about:blank",
)
# What controls of a browser look at, beside the name of a key.
KEY_NUMBERS = {
    " ": 32,
    "PageUp": 33,
    "PageDown": 34,
    "End": 35,
    "Home": 36,
    "ArrowLeft": 37,
    "ArrowRight": 39,
}
PATIENCE_SECONDS = 120


def find_chromium() -> str | None:
    return next((found for found in map(shutil.which, PROGRAMS) if found), None)


class Page:
    def __init__(self, browser: "Browser", session: str):
        self.browser = browser
        self.session = session
        self.errors: list[str] = []
        self.requests: list[str] = []

    def call(self, method: str, **parameters) -> dict:
        return self.browser.call(method, parameters, self.session)

    def evaluate(self, expression: str):
        """The value of JavaScript, waited for if it is a promise."""
        answer = self.call(
            "Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True
        )
        if "exceptionDetails" in answer:
            raise RuntimeError(json.dumps(answer["exceptionDetails"])[:800])
        return answer["result"].get("value")

    def wait(self, expression: str):
        """Until JavaScript is true; its value."""
        deadline = time.monotonic() + PATIENCE_SECONDS
        while time.monotonic() < deadline:
            value = self.evaluate(expression)
            if value:
                return value
            time.sleep(0.05)
        raise TimeoutError(f"never true: {expression}; errors: {self.errors}")

    def shown(self, part: str):
        """Waits until a part is shown and laid out."""
        self.wait(f"document.documentElement?.dataset.shown === {json.dumps(part)}")
        # Sizes are told after the first frame, and followed in another.
        self.frames(3)

    def frames(self, count: int):
        """Waits until so many frames have begun."""
        self.evaluate(
            f"new Promise((done) => {{ let left = {count};"
            "const next = () => (left-- > 0 ? requestAnimationFrame(next) : done(1)); next(); })"
        )

    def size(self, width: int, height: int):
        self.call(
            "Emulation.setDeviceMetricsOverride",
            width=width,
            height=height,
            deviceScaleFactor=1,
            mobile=False,
        )

    def screenshot(self) -> bytes:
        """As PNG."""
        return base64.b64decode(self.call("Page.captureScreenshot", format="png")["data"])

    def pixels(self) -> tuple[int, int, bytes]:
        """Width, height and RGB of a screenshot."""
        return decode_png(self.screenshot())

    def mouse(self, kind: str, x: float, y: float, **more):
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, **more)

    def click(self, x: float, y: float):
        self.mouse("mouseMoved", x, y)
        self.mouse("mousePressed", x, y, button="left", buttons=1, clickCount=1)
        self.mouse("mouseReleased", x, y, button="left", buttons=0, clickCount=1)

    def drag(self, start: tuple[float, float], end: tuple[float, float]):
        self.mouse("mousePressed", *start, button="left", buttons=1, clickCount=1)
        for n in range(1, 6):
            self.mouse(
                "mouseMoved",
                *(a + (b - a) * n / 5 for a, b in zip(start, end)),
                button="left",
                buttons=1,
            )
        self.mouse("mouseReleased", *end, button="left", buttons=0, clickCount=1)

    def key(self, key: str, code: str = "", text: str = ""):
        more = {"key": key, "code": code or key, "windowsVirtualKeyCode": KEY_NUMBERS.get(key, 0)}
        self.call("Input.dispatchKeyEvent", type="keyDown", text=text, **more)
        self.call("Input.dispatchKeyEvent", type="keyUp", **more)


class Browser:
    def __init__(self):
        # Processes that were killed may still be at work on their last write.
        self.folder = tempfile.TemporaryDirectory(
            prefix="galactic-browser-", ignore_cleanup_errors=True
        )
        to_child, self.to = os.pipe()
        self.back, from_child = os.pipe()
        # Chromium reads commands from descriptor 3 and answers on 4.
        self.process = subprocess.Popen(
            [
                "/bin/sh",
                "-c",
                f'exec "$@" 3<&{to_child} 4>&{from_child}',
                "sh",
                find_chromium(),
                f"--user-data-dir={self.folder.name}",
                *ARGUMENTS,
            ],
            pass_fds=(to_child, from_child),
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
        )
        os.close(to_child)
        os.close(from_child)
        self.buffer = b""
        self.number = 0
        self.pages: dict[str, Page] = {}

    def __enter__(self):
        return self

    def __exit__(self, *_):
        # With all its processes: each of them may write to the folder.
        os.killpg(self.process.pid, signal.SIGKILL)
        self.process.wait()
        os.close(self.to)
        os.close(self.back)
        self.folder.cleanup()

    def open(
        self,
        file: pathlib.Path,
        fragment: str = "",
        size: tuple[int, int] = (1280, 800),
        before: str = "",
    ) -> Page:
        """`before`: JavaScript that runs before that of the page."""
        target = self.call("Target.createTarget", {"url": "about:blank"})["targetId"]
        session = self.call("Target.attachToTarget", {"targetId": target, "flatten": True})[
            "sessionId"
        ]
        page = self.pages[session] = Page(self, session)
        for domain in ("Runtime", "Network", "Page", "Log"):
            page.call(f"{domain}.enable")
        page.call("Emulation.setFocusEmulationEnabled", enabled=True)
        page.size(*size)
        if before:
            page.call("Page.addScriptToEvaluateOnNewDocument", source=before)
        page.url = file.resolve().as_uri()
        page.call("Page.navigate", url=page.url + fragment)
        return page

    def call(self, method: str, parameters: dict, session: str | None = None) -> dict:
        self.number += 1
        number = self.number
        message = {"id": number, "method": method, "params": parameters}
        if session:
            message["sessionId"] = session
        os.write(self.to, json.dumps(message).encode() + b"\0")
        while True:
            answer = self.receive()
            if answer.get("id") == number:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']}")
                return answer["result"]
            self.note(answer)

    def receive(self) -> dict:
        while b"\0" not in self.buffer:
            ready, _, _ = select.select([self.back], [], [], PATIENCE_SECONDS)
            data = os.read(self.back, 1 << 20) if ready else b""
            if not data:
                raise RuntimeError("Chromium does not answer")
            self.buffer += data
        message, self.buffer = self.buffer.split(b"\0", 1)
        return json.loads(message)

    def note(self, event: dict):
        page = self.pages.get(event.get("sessionId", ""))
        if not page:
            return
        method, parameters = event["method"], event["params"]
        if method == "Runtime.exceptionThrown":
            page.errors.append(json.dumps(parameters["exceptionDetails"])[:500])
        elif method == "Runtime.consoleAPICalled" and parameters["type"] in (
            "error",
            "warning",
            "assert",
        ):
            page.errors.append(json.dumps(parameters["args"])[:500])
        elif method == "Log.entryAdded" and parameters["entry"]["level"] in ("error", "warning"):
            text = parameters["entry"]["text"]
            # Taking a screenshot makes the driver wait, and it says so.
            if "GPU stall due to ReadPixels" not in text:
                page.errors.append(text)
        elif method == "Network.requestWillBeSent":
            page.requests.append(parameters["request"]["url"])


def decode_png(png: bytes) -> tuple[int, int, bytes]:
    """Width, height and RGB bytes of a PNG with 8 bits for each channel, not interlaced."""
    width, height, depth, color = struct.unpack(">IIBB", png[16:26])
    assert depth == 8 and color in (2, 6), "Chromium writes RGB or RGBA"
    channels = 3 if color == 2 else 4
    data = b""
    at = 8
    while at < len(png):
        length, kind = struct.unpack(">I4s", png[at : at + 8])
        if kind == b"IDAT":
            data += png[at + 8 : at + 8 + length]
        at += 12 + length
    raw = zlib.decompress(data)
    stride = width * channels
    rows = []
    before = bytearray(stride)
    for y in range(height):
        begin = y * (stride + 1)
        before = unfiltered(
            raw[begin], bytearray(raw[begin + 1 : begin + 1 + stride]), before, channels
        )
        rows.append(
            bytes(before)
            if channels == 3
            else b"".join(before[n : n + 3] for n in range(0, stride, 4))
        )
    return width, height, b"".join(rows)


def unfiltered(kind: int, row: bytearray, above: bytearray, pixel: int) -> bytearray:
    """A row of a PNG without its filter: see the PNG specification, section 9."""
    for n, value in enumerate(row):
        left = row[n - pixel] if n >= pixel else 0
        up = above[n]
        if kind == 1:
            row[n] = (value + left) & 255
        elif kind == 2:
            row[n] = (value + up) & 255
        elif kind == 3:
            row[n] = (value + (left + up) // 2) & 255
        elif kind == 4:
            corner = above[n - pixel] if n >= pixel else 0
            guess = left + up - corner
            row[n] = (value + min((left, up, corner), key=lambda one: abs(guess - one))) & 255
    return row
