"""What a browser makes of the lab that `serve` shows."""

import asyncio
import json

import pyte

from tests.tui.chromium import NEEDED, Chromium, Page, chromium
from tests.tui.commands.test_serve import serving
from tui.drawing.palette import PALETTES

pytestmark = NEEDED

METHODS = [*PALETTES["dark"].methods[:4]]


class Shown:
    """The terminal of a page: what its websocket brought, as another terminal of its size would show it."""

    def __init__(self, page: Page) -> None:
        self.page, self._read = page, 0
        self.screen = pyte.Screen(140, 50)

    @property
    def text(self) -> str:
        for message in self.page.received[self._read :]:
            pyte.ByteStream(self.screen).feed(message)
        self._read = len(self.page.received)
        return "\n".join(self.screen.display)

    async def shows(self, *words: str) -> None:
        await self.page.until(lambda: all(word in self.text for word in words))

    async def resized(self, width: int, height: int) -> tuple[int, int]:
        """Resize the page, whose lab is paused, and wait until that fits; columns and rows."""
        count = len(self.page.sent)
        await self.page.resize(width, height)
        await self.page.until(lambda: any('"resize"' in said for said in self.page.sent[count:]))
        size = json.loads(next(said for said in reversed(self.page.sent) if '"resize"' in said))[1]
        self.screen = pyte.Screen(size["width"], size["height"])
        await self.page.until(self._fits)
        return size["width"], size["height"]

    def _fits(self) -> bool:
        first, second, *_, last = self.text.splitlines()
        return "paused" in first and second[-1] == "╮" and last.startswith(" F2 Lab")


async def paused(browser: Chromium, address: str) -> Page:
    """Another lab, which leaves the machine to the others as soon as it is there."""
    page = await browser.open(address, 640, 360)
    await page.until(lambda: b"LIVE" in b"".join(page.received))
    await page.press(" ")
    return page


async def test_a_lab_is_painted_takes_keys_and_the_mouse_fits_its_tab_and_ends_with_it_ten_at_once(tmp_path):
    with serving("--at-most", "10") as server:
        async with chromium(tmp_path / "profile") as browser:
            page = await browser.open(server.address)
            tab = Shown(page)
            await tab.shows("LIVE", "scene drift", "RK4", "q Quit")
            async with asyncio.timeout(60):
                while min(await page.pixels(METHODS)) < 50:  # every method has its colour on the screen
                    await asyncio.sleep(0.1)
            await page.press(" ")
            await tab.shows("paused")
            lines = [line.rstrip() for line in tab.text.splitlines() if line.strip()]
            columns, rows = max(map(len, lines)), len(lines)
            left, bottom, width = await page.evaluate(
                "(({x, bottom, width}) => [x, bottom, width])"
                "(document.querySelector('.xterm-screen').getBoundingClientRect())"
            )
            await page.click(left + width * (lines[-1].index("Phase") + 0.5) / columns, bottom - 4)  # on its hint
            await tab.shows("Ring")
            fewer, lower = await tab.resized(800, 500)
            assert (fewer < columns, lower < rows) == (True, True)
            others = await asyncio.gather(*(paused(browser, server.address) for _ in range(9)))
            assert len(server.labs) == 10
            for other in others:
                await other.close()
            await server.until_labs(1)
            await page.close()
            await server.until_labs(0)
            assert [each.thrown for each in (page, *others)] == [[]] * 10
