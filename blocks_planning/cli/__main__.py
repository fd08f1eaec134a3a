"""``python -m blocks_planning.cli``."""

from blocks_planning.cli import main

if __name__ == '__main__':
    main()
