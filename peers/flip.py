"""FLIP of the lab's pictures by NVIDIA's own package, beside what the lab says of them.

    python -m venv env && env/bin/pip install -r peers/requirements.txt
    cargo run --release -- lab make:brick-wall -o DIR
    env/bin/python peers/flip.py DIR

Fails where a mean differs by more than 1e-3.
"""

import json
import os
import sys

import flip_evaluator

TOLERANCE = 1e-3


def main(folder):
    with open(os.path.join(folder, "results.json")) as file:
        rows = json.load(file)["pictures"]
    if not rows:
        sys.exit(f"{folder}: the results have no pictures")
    worst = 0.0
    for row in rows:
        files = [os.path.join(folder, row[name]) for name in ("truth", "picture")]
        _, theirs, _ = flip_evaluator.evaluate(*files, "LDR")
        difference = abs(theirs - row["flip"])
        if difference > worst:
            worst = difference
            print(f"{row['picture']}: {row['flip']:.6f} here, {theirs:.6f} there")
    print(f"{len(rows)} pictures, the largest difference of a mean is {worst:.2e}")
    if worst > TOLERANCE:
        sys.exit(f"more than {TOLERANCE:g}")


if len(sys.argv) != 2:
    sys.exit(__doc__)
main(sys.argv[1])
