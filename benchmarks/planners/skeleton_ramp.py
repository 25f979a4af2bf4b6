#!/usr/bin/env python3
"""Makes a ramp of a scenario that `locograph info ROBOT --write-srdf` has written.

    skeleton_ramp.py go1.scenario.xml go1.ramp.xml [DEGREES]

The floor ends 0.1 m ahead of the front feet, a ramp begins there. The goal has all feet on it, as
far apart as they stand, the rear ones 0.1 m up its slope (of soles their ends, about).
"""
import math
import sys
import xml.etree.ElementTree as ElementTree


def vector(text):
    return [float(value) for value in text.split()]


def text_of(values):
    return " ".join(f"{value:.8g}" for value in values)


def main():
    source, target = sys.argv[1:3]
    slope = math.radians(float(sys.argv[3]) if len(sys.argv) > 3 else 15.0)
    tree = ElementTree.parse(source)
    root = tree.getroot()
    feet = {contact.get("end_effector"): vector(contact.get("position"))
            for contact in root.find("start").findall("contact")}
    rear = min(foot[0] for foot in feet.values())
    sole = max(float(effector.get("half_x", 0)) for effector in root.iter("end_effector"))
    begins = max(foot[0] for foot in feet.values()) + 0.1 + sole
    environment = root.find("environment")
    environment.find("plane").attrib.update(
        {"center": text_of([begins - 1.5, 0, 0]), "forward": "1 0 0", "size": "3 3"})
    half = 1.0
    ElementTree.SubElement(environment, "plane", {
        "name": "ramp",
        "center": text_of([begins + half * math.cos(slope), 0, half * math.sin(slope)]),
        "normal": text_of([-math.sin(slope), 0, math.cos(slope)]),
        "forward": text_of([math.cos(slope), 0, math.sin(slope)]),
        "size": text_of([2 * half, 3])})
    for contact in root.find("goal").findall("contact"):
        foot = feet[contact.get("end_effector")]
        along = 0.1 + sole + foot[0] - rear
        contact.set("position", text_of([begins + along * math.cos(slope), foot[1],
                                         along * math.sin(slope)]))
        contact.set("normal", text_of([-math.sin(slope), 0, math.cos(slope)]))
        if contact.get("forward"):
            x, y, _ = vector(contact.get("forward"))
            contact.set("forward", text_of([x * math.cos(slope), y, x * math.sin(slope)]))
    tree.write(target)


main()
