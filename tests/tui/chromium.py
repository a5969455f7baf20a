"""A headless Chromium, controlled through the websocket of its developer tools."""

import asyncio
import base64
import itertools
import json
import re
import shutil
import subprocess
from contextlib import asynccontextmanager
from typing import Any

import pytest

aiohttp = pytest.importorskip("aiohttp", reason="the extra web is not installed")

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
PROGRAM = next(filter(None, map(shutil.which, NAMES)), None)
NEEDED = pytest.mark.skipif(PROGRAM is None, reason="Chromium is not there: apt install chromium")
OPTIONS = (
    "--headless=new",
    "--no-sandbox",  # which does not work for root
    "--disable-gpu",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--remote-debugging-port=0",
    "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1",  # nothing comes from elsewhere
)
PATIENCE = 60.0  # s, on a busy machine
# Counts the pixels of a screenshot near each of some colours.
_COUNT = """(async () => {
  const image = new Image(); image.src = "data:image/png;base64,%s"; await image.decode();
  const canvas = document.createElement("canvas"); canvas.width = image.width; canvas.height = image.height;
  const context = canvas.getContext("2d"); context.drawImage(image, 0, 0);
  const {data} = context.getImageData(0, 0, image.width, image.height);
  return %s.map(colour => {
    let found = 0;
    for (let at = 0; at < data.length; at += 4)
      found += Math.max(...colour.map((part, place) => Math.abs(part - data[at + place]))) < 8;
    return found;
  });
})()"""


class Page:
    """A tab of the browser."""

    def __init__(self, browser: "Chromium", target: str, session: str) -> None:
        self.browser = browser
        self._target = target
        self._session = session
        self.received: list[bytes] = []  # through its websocket
        self.sent: list[str] = []
        self.thrown: list[str] = []  # errors of its scripts

    async def call(self, method: str, **parameters: Any) -> Any:
        return await self.browser.call(method, self._session, **parameters)

    async def evaluate(self, expression: str) -> Any:
        answer = await self.call(
            "Runtime.evaluate", expression=expression, awaitPromise=True, returnByValue=True
        )
        assert "exceptionDetails" not in answer, answer
        return answer["result"].get("value")

    async def until(self, condition: Any) -> None:
        async with asyncio.timeout(PATIENCE):
            while not condition():
                await asyncio.sleep(0.05)

    async def press(self, key: str) -> None:
        """Press a key that is a character."""
        event = {"key": key, "windowsVirtualKeyCode": ord(key.upper())}
        await self.call("Input.dispatchKeyEvent", type="keyDown", text=key, **event)
        await self.call("Input.dispatchKeyEvent", type="keyUp", **event)

    async def click(self, x: float, y: float) -> None:
        for kind in ("mouseMoved", "mousePressed", "mouseReleased"):
            await self.call(
                "Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1
            )

    async def resize(self, width: int, height: int) -> None:
        size = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False}
        await self.call("Emulation.setDeviceMetricsOverride", **size)

    async def pixels(self, colours: list[str]) -> list[int]:
        """Return how many pixels have each of the colours "#rrggbb"."""
        shot = (await self.call("Page.captureScreenshot"))["data"]
        rgb = json.dumps([list(bytes.fromhex(colour[1:])) for colour in colours])
        return await self.evaluate(_COUNT % (shot, rgb))

    async def close(self) -> None:
        await self.browser.call("Target.closeTarget", targetId=self._target)


class Chromium:
    """A running browser."""

    def __init__(self, socket: Any) -> None:
        self._socket = socket
        self._numbers = itertools.count(1)
        self._answers: dict[int, asyncio.Future[Any]] = {}
        self._pages: dict[str, Page] = {}

    async def listen(self) -> None:
        async for message in self._socket:
            event = json.loads(message.data)
            if "id" in event:
                self._answers.pop(event["id"]).set_result(event)
            elif (page := self._pages.get(event.get("sessionId", ""))) is not None:
                self._note(page, event["method"], event["params"])

    def _note(self, page: Page, method: str, parameters: dict[str, Any]) -> None:
        match method:
            case "Network.webSocketFrameReceived":
                response = parameters["response"]
                if response["opcode"] == 2:  # binary
                    page.received.append(base64.b64decode(response["payloadData"]))
            case "Network.webSocketFrameSent":
                page.sent.append(parameters["response"]["payloadData"])
            case "Runtime.exceptionThrown":
                page.thrown.append(str(parameters["exceptionDetails"]))

    async def call(self, method: str, session: str | None = None, **parameters: Any) -> Any:
        number = next(self._numbers)
        future = self._answers[number] = asyncio.get_running_loop().create_future()
        request = {"id": number, "method": method, "params": parameters}
        if session is not None:
            request["sessionId"] = session
        await self._socket.send_json(request)
        answer = await asyncio.wait_for(future, PATIENCE)
        assert "error" not in answer, answer
        return answer["result"]

    async def open(self, url: str, width: int = 1000, height: int = 700) -> Page:
        target = (await self.call("Target.createTarget", url="about:blank"))["targetId"]
        attached = await self.call("Target.attachToTarget", targetId=target, flatten=True)
        session = attached["sessionId"]
        page = self._pages[session] = Page(self, target, session)
        for domain in ("Page", "Network", "Runtime"):
            await page.call(f"{domain}.enable")
        await page.resize(width, height)
        await page.call("Page.navigate", url=url)
        return page


@asynccontextmanager
async def chromium(folder: Any):
    """Run a browser with its profile in the folder."""
    command = [PROGRAM, *OPTIONS, f"--user-data-dir={folder}"]
    process = subprocess.Popen(
        command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True
    )
    try:
        lines = iter(process.stderr.readline, "")
        address = next(found[0] for line in lines if (found := re.search(r"ws://\S+", line)))
        async with (
            aiohttp.ClientSession() as client,
            client.ws_connect(address, max_msg_size=0) as socket,
        ):
            browser = Chromium(socket)
            listener = asyncio.create_task(browser.listen())
            yield browser
            listener.cancel()
    finally:
        process.terminate()
        process.communicate(timeout=PATIENCE)
