#!/usr/bin/python3
"""Compares what two builds of core_designs print: compare_designs.py NAME OLD NEW [LIMIT, 1e-12]. Statuses must be equal,
metrics within LIMIT, relative."""
import math
import sys

old, new = ([line.split() for line in open(path)] for path in sys.argv[2:4])
limit = float(sys.argv[4]) if len(sys.argv) > 4 else 1e-12
statuses = abs(len(old) - len(new)) + sum(a[0] != b[0] for a, b in zip(old, new))
largest = 0.0
for a, b in zip(old, new):
    for x, y in zip(map(float, a[1:]), map(float, b[1:])):
        if a[0] == b[0] and x != y and not (math.isnan(x) and math.isnan(y)):
            largest = max(largest, abs(x - y) / abs(x) if math.isfinite(x) and math.isfinite(y) else math.inf)
print(f"{sys.argv[1]}: {len(old)} designs, {statuses} statuses differ, metrics by {largest:.2g} at most")
sys.exit(statuses > 0 or largest > limit)
