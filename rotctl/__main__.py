"""`python -m rotctl` is `rotctl`."""

import sys

from rotctl.cli.main import main

if __name__ == "__main__":
    sys.exit(main())
