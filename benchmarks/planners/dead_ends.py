#!/usr/bin/env python3
"""Two to six boxes at random on the way of CENTAURO's drive: how often does it arrive with and
without `refine --replan`, what does the judge say, and what becomes of it in the physics engine.

    dead_ends.py [--locograph build/bin/locograph] [--seed N] [--cases N] [--simulate]

Places to start and to end keep free; one box at least stands across the way. Prints one JSON
object: a row for each case, then the totals.
"""
import argparse
import json
import pathlib
import random
import subprocess
import tempfile

START_AND_GOAL_M = (0.0, 4.0)
FREE_M = (0.85, 0.75)  # around them, along and across the way


def boxes_of(draw):
    while True:
        boxes = []
        for _ in range(draw.randint(2, 6)):
            x, y = draw.uniform(1.2, 3.6), draw.uniform(-2.2, 2.2)
            size = draw.uniform(0.2, 1.2), draw.uniform(0.3, 2.5), draw.uniform(0.4, 1.2)
            if all(abs(x - end) > size[0] / 2 + FREE_M[0] or abs(y) > size[1] / 2 + FREE_M[1]
                   for end in START_AND_GOAL_M):
                boxes.append((x, y, size))
        if any(abs(y) < size[1] / 2 + 0.3 for _, y, size in boxes):
            return boxes


def write(boxes, file):
    lines = [f'  <box name="box {i}" center="{x} {y} {size[2] / 2}" '
             f'size="{size[0]} {size[1]} {size[2]}"/>\n' for i, (x, y, size) in enumerate(boxes)]
    file.write_text('<obstacles version="1">\n' + ''.join(lines) + '</obstacles>\n')


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--locograph', default='build/bin/locograph')
    parser.add_argument('--seed', type=int, default=1)
    parser.add_argument('--cases', type=int, default=20)
    parser.add_argument('--simulate', action='store_true', help='those that were planned on')
    options = parser.parse_args()
    draw = random.Random(options.seed)

    def run(*arguments):
        return subprocess.run([options.locograph, *map(str, arguments)], capture_output=True,
                              text=True, check=False)

    rows = []
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        plan, obstacles, refined = (folder / f for f in ('plan.g2o', 'boxes.xml', 'refined.g2o'))
        if run('plan', 'centauro_drive', '-o', plan).returncode != 0:
            raise SystemExit('the drive is not planned')
        for _ in range(options.cases):
            write(boxes_of(draw), obstacles)
            refine = ('refine', plan, '--obstacles', obstacles, '-o', refined, '--json')
            alone = run(*refine).returncode
            done = run(*refine, '--replan')
            told = json.loads(done.stdout)
            row = {'arrives_alone': alone == 0, 'arrives': done.returncode == 0,
                   'feasible': run('check', refined, '--obstacles', obstacles).returncode == 0,
                   'resumed': told['resumed'], 'resume_s': told['resume_s'],
                   'goal_distance_m': told['goal_distance_m'], 'reason': told['reason']}
            if options.simulate and row['arrives'] and row['resumed'] > 0:
                row['carried_out'] = run('simulate', refined, '--obstacles', obstacles,
                                         '--seed', options.seed).returncode == 0
            rows.append(row)
    totals = {key: sum(row.get(key, False) for row in rows)
              for key in ('arrives_alone', 'arrives', 'feasible', 'carried_out')}
    print(json.dumps({'seed': options.seed, 'cases': options.cases, **totals,
                      'planned_on': sum(row['resumed'] > 0 for row in rows), 'rows': rows},
                     indent=2))


if __name__ == '__main__':
    main()
