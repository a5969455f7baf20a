"""How to install what is missing."""

import sys
from pathlib import Path


def install_advice(package: str, extra: str) -> str:
    """Return the command that installs an extra, for the tool that installed pendu-tui."""
    environment = Path(sys.prefix)
    if (environment / "uv-receipt.toml").exists():
        return f"uv tool install --with {package} pendu-tui"
    if (environment / "pipx_metadata.json").exists():
        return f"pipx inject pendu-tui {package}"
    return f"pip install 'pendu-tui[{extra}]'"
