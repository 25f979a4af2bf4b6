#!/usr/bin/env python3
"""Makes a ramp or a step of a scenario that `locograph info ROBOT --write-srdf` has written.

    skeleton_climb.py go1.scenario.xml go1.ramp.xml --ramp 15
    skeleton_climb.py go1.scenario.xml go1.step.xml --step 0.1

The floor ends 0.1 m ahead of the front feet, of soles of their ends; a ramp (degrees) or a box (its
height in metres) begins there. The goal has all feet on it, as far apart as they stand, the rear
ones 0.1 m from its edge.
"""
import argparse
import math
import xml.etree.ElementTree as ElementTree

LENGTH = WIDTH = 3.0


def vector(text):
    return [float(value) for value in text.split()]


def text_of(values):
    return " ".join(f"{value:.8g}" for value in values)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("source")
    parser.add_argument("target")
    kind = parser.add_mutually_exclusive_group(required=True)
    kind.add_argument("--ramp", type=float, metavar="DEGREES")
    kind.add_argument("--step", type=float, metavar="METRES")
    options = parser.parse_args()
    slope = math.radians(options.ramp or 0.0)
    ahead, up = math.cos(slope), math.sin(slope)
    height = options.step or 0.0

    tree = ElementTree.parse(options.source)
    root = tree.getroot()
    feet = {contact.get("end_effector"): vector(contact.get("position"))
            for contact in root.find("start").findall("contact")}
    rear = min(foot[0] for foot in feet.values())
    sole = max(float(effector.get("half_x", 0)) for effector in root.iter("end_effector"))
    begins = max(foot[0] for foot in feet.values()) + 0.1 + sole
    environment = root.find("environment")
    environment.find("plane").attrib.update(
        {"center": text_of([begins - LENGTH / 2, 0, 0]), "forward": "1 0 0",
         "size": text_of([LENGTH, WIDTH])})
    if options.step:
        ElementTree.SubElement(environment, "box", {
            "name": "step", "center": text_of([begins + LENGTH / 2, 0, height / 2]),
            "size": text_of([LENGTH, WIDTH, height])})
    else:
        ElementTree.SubElement(environment, "plane", {
            "name": "ramp",
            "center": text_of([begins + LENGTH / 2 * ahead, 0, LENGTH / 2 * up]),
            "normal": text_of([-up, 0, ahead]), "forward": text_of([ahead, 0, up]),
            "size": text_of([LENGTH, WIDTH])})
    for contact in root.find("goal").findall("contact"):
        foot = feet[contact.get("end_effector")]
        along = 0.1 + sole + foot[0] - rear
        contact.set("position", text_of([begins + along * ahead, foot[1], height + along * up]))
        contact.set("normal", text_of([-up, 0, ahead]))
        if contact.get("forward"):
            x, y, _ = vector(contact.get("forward"))
            contact.set("forward", text_of([x * ahead, y, x * up]))
    tree.write(options.target)


main()
