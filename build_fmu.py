"""Build WheelRail.fmu from a case file: ``python build_fmu.py [CASE] --output DIR``."""

from __future__ import annotations

import sys

from fmu_src.command import main

if __name__ == "__main__":
    sys.exit(main())
