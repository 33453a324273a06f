"""``python -m fegear`` does what the command ``fegear`` does."""

from fegear.cli import main

if __name__ == "__main__":
    main()
