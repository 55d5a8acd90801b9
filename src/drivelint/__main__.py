"""Run the command line with `python -m drivelint`."""

from drivelint.cli import main

if __name__ == "__main__":
    main()
