"""``python -m whacamole``: the command line."""

from whacamole.cli import main

if __name__ == "__main__":
    main()
