# Reads a groom in plain Python, from the formats' descriptions alone, and dumps what it found:
#   python3 read.py FILE DUMP
import importlib
import os
import sys

import dump

READERS = {".hair": "hair_strands", ".abc": "alembic", ".usda": "usda", ".ply": "ply", ".tfx": "tfx", ".glb": "glb"}

if __name__ == "__main__":
    reader = importlib.import_module(READERS[os.path.splitext(sys.argv[1])[1]])
    with open(sys.argv[1], "rb") as file:
        times, moments = reader.read(file.read())
    dump.write(sys.argv[2], times, moments)
