"""The lab that `serve` shows, in a real browser."""

import asyncio
import json

import pyte
import pytest

from pendu_tui.tui.drawing.palette import PALETTES
from tests.tui.chromium import NEEDED, Page, chromium
from tests.tui.commands.test_serve import serving

pytestmark = [NEEDED, pytest.mark.slow]

METHODS = PALETTES["dark"].methods[:4]


class Shown:
    """The text that a page's terminal shows, by what its websocket received."""

    def __init__(self, page: Page) -> None:
        self.page = page
        self._read = 0
        self.screen = pyte.Screen(140, 50)

    @property
    def text(self) -> str:
        for message in self.page.received[self._read :]:
            pyte.ByteStream(self.screen).feed(message)
        self._read = len(self.page.received)
        return "\n".join(self.screen.display)

    async def shows(self, *words: str) -> None:
        await self.page.until(lambda: all(word in self.text for word in words))

    @property
    def size(self) -> tuple[int, int]:
        """The columns and rows that the page asked for last."""
        *_, last = (message for message in self.page.sent if '"resize"' in message)
        size = json.loads(last)[1]
        return size["width"], size["height"]

    async def resized(self, width: int, height: int) -> tuple[int, int]:
        """Resize the page of a paused lab, wait until the lab fits, and return its size."""
        count = len(self.page.sent)
        await self.page.resize(width, height)
        await self.page.until(lambda: '"resize"' in "".join(self.page.sent[count:]))
        self.screen = pyte.Screen(*self.size)
        await self.page.until(self._fits)
        return self.size

    def _fits(self) -> bool:
        first, second, *_, last = self.text.splitlines()
        return "paused" in first and second[-1] == "╮" and "ctrl+p" in last


async def test_a_lab_is_painted_takes_keys_and_clicks_fits_its_tab_and_ends_with_it(tmp_path):
    with serving() as server:
        async with chromium(tmp_path / "profile") as browser:
            page = await browser.open(server.address)
            tab = Shown(page)
            await tab.shows("LIVE", "scene drift", "RK4", "ctrl+p")
            async with asyncio.timeout(60):  # until each method has its colour on the screen
                while min(await page.pixels(METHODS)) < 50:
                    await asyncio.sleep(0.1)
            await page.click(500, 350)
            await page.press(" ")
            await tab.shows("paused")
            columns, rows = tab.size
            assert (await tab.resized(800, 500)) < (columns, rows)
            assert len(server.labs) == 1
            await page.close()
            await server.until_labs(0)
            assert page.thrown == []
