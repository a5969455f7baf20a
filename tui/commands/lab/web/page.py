"""The pages that a browser gets.  They load nothing from other hosts, so a class needs no internet."""

from html import escape

_LAB = """\
<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<title>pendu-tui</title>
<link rel="stylesheet" href="/static/css/xterm.css">
<script src="/static/js/textual.js"></script>
<style>
@font-face {{
  font-family: "Roboto Mono"; font-weight: 100 700; src: url("/static/fonts/RobotoMono-VariableFont_wght.ttf");
}}
body {{ margin: 0; overflow: hidden; background: #121212; }}
p {{ color: #d8d8d8; font: 16px "Roboto Mono", monospace; padding: 1em; }} /* so it is there to be measured */
a {{ color: inherit; }}
#ended, #start {{ display: none; }}
.-closed #terminal, .-first-byte #waiting {{ display: none; }}
.-closed #ended {{ display: block; }}
</style>
</head>
<body>
<p id="waiting">The lab is starting.</p>
<p id="ended">The lab has ended. <a href="/">Start another</a></p>
<p id="start"></p>
<div id="terminal" class="textual-terminal" data-font-size="16" data-session-websocket-url="{socket}"></div>
<script>
const wait = setInterval(() => {{  // keys go to the lab from the start
  const field = document.querySelector("#terminal textarea");
  if (field && document.body.classList.contains("-first-byte")) {{ field.focus(); clearInterval(wait); }}
}}, 100);
</script>
</body>
</html>
"""


def lab_page(address: str) -> str:
    """The page of a lab whose server the browser calls by this address, such as ws://127.0.0.1:8000."""
    return _LAB.format(socket=escape(f"{address}/ws"))


def full_text(most: int) -> str:
    """The answer to a browser when `most` labs are open."""
    return f"{most} labs are open, and that is the most at once. Close one, or reload this page later.\n"
