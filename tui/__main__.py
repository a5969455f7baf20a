"""Let `python -m pendu_tui.tui` do what `pendu-tui` does."""

import sys

from pendu_tui.tui.cli import main

if __name__ == "__main__":
    sys.exit(main())
