#!/usr/bin/env python3
"""Prints hand.json: a camera that stands in `windmill` and is turned by a hand with a mouse.

Strokes of minimum jerk [Flash 1985], each with a correction back of what it went too far, and rests between them; the
angles are whole counts of the mouse, as a game takes them. Most of the turning is sideways.
"""
import math
import random

SECONDS, RATE, COUNT = 4.0, 50, math.radians(0.12)  # keys a second; angle of a count
EYE = (1.6, 1.8, 11.0)
random = random.Random(10)
strokes, time, turned = [], 0.0, 0.0  # strokes: begin, seconds, yaw, pitch
while time < SECONDS:
    seconds = random.uniform(0.14, 0.32)
    side = math.copysign(1, turned) if random.random() < 0.3 else -math.copysign(1, turned)
    yaw, pitch = side * math.radians(random.uniform(12, 60)), math.radians(random.uniform(-7, 7))
    strokes.append((time, seconds, yaw, pitch))
    strokes.append((time + seconds, 0.12, -0.12 * yaw, -0.2 * pitch))
    time += seconds + 0.12 + random.uniform(0.05, 0.35)
    turned += 0.88 * yaw


def angle(now, axis):
    """Angle at `now`, in whole counts."""
    total = 0.0
    for begin, seconds, *turns in strokes:
        x = min(max((now - begin) / seconds, 0.0), 1.0)
        total += turns[axis] * (10 * x**3 - 15 * x**4 + 6 * x**5)
    return COUNT * round(total / COUNT)


keys = []
for i in range(int(SECONDS * RATE) + 1):
    yaw, pitch = angle(i / RATE, 0), angle(i / RATE, 1) + math.radians(8)
    ahead = (-math.sin(yaw) * math.cos(pitch), math.sin(pitch), -math.cos(yaw) * math.cos(pitch))
    target = [round(e + 10 * a, 3) for e, a in zip(EYE, ahead)]
    keys.append(f'{{"time": {i / RATE}, "position": {list(EYE)}, "target": {target}, "fov_degrees": 55}}')
lines = [", ".join(keys[i:i + 5]) for i in range(0, len(keys), 5)]
print('{\n "keys": [\n  ' + ",\n  ".join(lines) + "\n ]\n}")
