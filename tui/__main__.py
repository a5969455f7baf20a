"""Let `python -m tui` do what `pendu-tui` does."""

import sys

from tui.cli import main

if __name__ == "__main__":
    sys.exit(main())
