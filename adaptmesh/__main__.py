"""``python -m adaptmesh``: the command line."""

from adaptmesh.cli.commands import main

if __name__ == "__main__":
    main()
