"""What is installed beside pendu-tui, and what is in its way."""

import sys
from importlib.util import find_spec
from pathlib import Path


def install_advice(package: str, extra: str) -> str:
    """Return the command that adds an extra's package, by the tool that installed pendu-tui."""
    environment = Path(sys.prefix)
    if (environment / "uv-receipt.toml").exists():
        return f"uv tool install --with {package} pendu-tui"
    if (environment / "pipx_metadata.json").exists():
        return f"pipx inject pendu-tui {package}"
    return f"pip install 'pendu-tui[{extra}]'"


def hidden_package() -> str:
    """Return a sentence if a folder of the user's hides a package of pendu-tui; "" if none does."""
    ours = Path(__file__).resolve().parents[2]
    for name in ("engine", "recordings"):
        spec = find_spec(name)
        origin = Path(spec.origin or "") if spec else Path()
        if ours not in origin.resolve().parents:
            where = "unset PYTHONPATH, or run pendu-tui in another folder"
            return f"{origin} hides the package {name} of pendu-tui; {where}."
    return ""
