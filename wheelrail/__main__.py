"""Run the command as ``python -m wheelrail``."""

import sys

from wheelrail.cli import main

sys.exit(main())
