"""Which packages are missing, and which folders hide ours."""

import sys
from importlib.util import find_spec
from pathlib import Path


def install_advice(package: str, extra: str) -> str:
    """Return the command that installs an extra, for the tool that installed pendu-tui."""
    environment = Path(sys.prefix)
    if (environment / "uv-receipt.toml").exists():
        return f"uv tool install --with {package} pendu-tui"
    if (environment / "pipx_metadata.json").exists():
        return f"pipx inject pendu-tui {package}"
    return f"pip install 'pendu-tui[{extra}]'"


def hidden_package() -> str:
    """Return a sentence if a user's folder hides a package of pendu-tui, else ""."""
    ours = Path(__file__).resolve().parents[2]
    for name in ("engine", "recordings"):
        spec = find_spec(name)
        origin = Path(spec.origin or "") if spec else Path()
        if ours not in origin.resolve().parents:
            where = "unset PYTHONPATH, or run pendu-tui in another folder"
            return f"{origin} hides the package {name} of pendu-tui; {where}."
    return ""
