"""`python -m rotctl` is `rotctl`."""

import sys

from rotctl.cli.cli import main

if __name__ == "__main__":
    sys.exit(main())
