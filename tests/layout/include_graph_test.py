"""The tree is the house that doc/architecture.md describes, as its #include lines tell.

    python3 include_graph_test.py SOURCE_FOLDER

Three things have to hold: a top folder includes those below it alone; folders include each other in
no circle, a folder and its sub-folders counted apart; within planners/ neither do units, which are
a header and the source of the same name. Each circle is printed with the lines that close it. First
it is proved on small trees of its own that it finds what it looks for.
"""

import pathlib
import re
import sys
import tempfile

LIBRARIES = ("common", "core", "solvers", "types", "robots", "world", "check", "plugins", "planners",
             "execution")
# What each top folder may include besides itself.
BELOW = {
    "common": (),
    "core": ("common",),
    "solvers": ("common", "core"),
    "types": ("common", "core"),
    "robots": ("common",),
    "world": ("common", "robots"),
    "check": ("common", "robots", "world"),
    "plugins": ("common", "core", "robots", "world"),
    "planners": ("common", "core", "solvers", "robots", "world", "check", "plugins"),
    "execution": ("common", "core", "solvers", "robots", "world", "check"),
    "apps": LIBRARIES,
    "python": LIBRARIES,
}
UNITS_IN = "planners"

INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]locograph/([^>"]+)[>"]', re.MULTILINE)


def includes(root):
    """(file, included file) for each line of the top folders, both relative to the root."""
    for top in sorted(BELOW):
        for path in sorted((root / top).rglob("*")):
            if path.suffix not in (".h", ".cpp"):
                continue
            file = path.relative_to(root).as_posix()
            for included in INCLUDE.findall(path.read_text(encoding="utf-8")):
                yield file, included


def folder_of(file):
    return file.rsplit("/", 1)[0]


def unit_of(file):
    return file.rsplit(".", 1)[0]


def graph_of(lines, name_of):
    """For each name those it needs, each with the first line that says so."""
    graph = {}
    for file, included in lines:
        source, target = name_of(file), name_of(included)
        if source != target:
            graph.setdefault(source, {}).setdefault(target, (file, included))
    return graph


def way(graph, start, goal):
    """The shortest way between two names; none: an empty list."""
    before, reached = {start: None}, [start]
    for name in reached:
        if name == goal:
            names = []
            while name is not None:
                names.append(name)
                name = before[name]
            return names[::-1]
        for target in sorted(graph.get(name, {})):
            if target not in before:
                before[target] = name
                reached.append(target)
    return []


def circles(graph):
    """Shortest circles, until each name that stands in one is in one of them."""
    told = set()
    for start in sorted(graph):
        ways = [way(graph, target, start) for target in sorted(graph[start])]
        ways = sorted((names for names in ways if names), key=len)
        if not ways or start in told:
            continue
        told.update(ways[0])
        yield [start] + ways[0]


def complaints(root):
    lines = list(includes(root))
    for file, included in lines:
        top, below = file.split("/")[0], included.split("/")[0]
        if below != top and below not in BELOW[top]:
            yield f"{file} includes {included}: {top}/ does not know {below}/"
    units = [line for line in lines if all(file.startswith(UNITS_IN + "/") for file in line)]
    graphs = {"folders": graph_of(lines, folder_of), "units": graph_of(units, unit_of)}
    for kind, graph in graphs.items():
        for names in circles(graph):
            text = f"{kind} in a circle: " + " -> ".join(names)
            for source, target in zip(names, names[1:]):
                text += "\n    {} includes {}".format(*graph[source][target])
            yield text


def complaints_of(files):
    """Of a tree of files with the headers that each includes."""
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for name, included in files.items():
            path = root / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text("".join(f"#include <locograph/{header}>\n" for header in included))
        return list(complaints(root))


def prove():
    """That it can fail."""
    sound = {
        "core/graph.h": (),
        "planners/plan/plan.h": ("core/graph.h",),
        "planners/plan/plan.cpp": ("planners/plan/plan.h", "planners/plan/times.h"),
        "planners/plan/times.h": (),
        "planners/task/task.h": ("planners/plan/plan.h",),
    }
    assert not complaints_of(sound), complaints_of(sound)

    upwards = complaints_of({**sound, "core/graph.cpp": ("planners/plan/plan.h",)})
    assert "core/graph.cpp includes planners/plan/plan.h: core/ does not know planners/" in upwards

    (folders,) = complaints_of({**sound, "planners/plan/times.h": ("planners/task/task.h",),
                                "planners/plan/plan.cpp": ()})
    assert folders == (
        "folders in a circle: planners/plan -> planners/task -> planners/plan\n"
        "    planners/plan/times.h includes planners/task/task.h\n"
        "    planners/task/task.h includes planners/plan/plan.h"
    ), folders

    (units,) = complaints_of({**sound, "planners/plan/times.cpp": ("planners/plan/plan.h",)})
    assert units == (
        "units in a circle: planners/plan/plan -> planners/plan/times -> planners/plan/plan\n"
        "    planners/plan/plan.cpp includes planners/plan/times.h\n"
        "    planners/plan/times.cpp includes planners/plan/plan.h"
    ), units

    three = {f"planners/plan/{a}.h": (f"planners/plan/{b}.h",) for a, b in ("ab", "bc", "ca")}
    (units,) = complaints_of(three)
    assert "planners/plan/a -> planners/plan/b -> planners/plan/c -> planners/plan/a" in units


def main():
    prove()
    root = pathlib.Path(sys.argv[1])
    if not list(includes(root)):
        sys.exit(f"no sources in {root}")
    found = list(complaints(root))
    if found:
        sys.exit("\n".join(found))


main()
