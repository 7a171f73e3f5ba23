"""Are two runs the same, bit for bit? Usage: compare_runs.py FOLDER FOLDER"""
import sys

from cluster import difference_of_runs

found = difference_of_runs(sys.argv[1], sys.argv[2])
print(f"{' and '.join(sys.argv[1:])}: {found + ' DIFFERS' if found else 'the same bits'}")
sys.exit(1 if found else 0)
