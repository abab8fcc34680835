"""``python -m fatektool`` is the command."""

from fatektool.cli import main

if __name__ == "__main__":
    main()
