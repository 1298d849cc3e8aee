"""Peer of benches/engine.rs: OpenCV's remap, handed the finished deformation as float maps.

usage: remap.py WIDTH HEIGHT
Prints two numbers, ns per pixel with one thread and with all: 4 channels of 8 bits, bilinear, mirrored border; the
same bumps as the bench's surface (D_n, beta = 0), so that both read the same texels.
"""
import sys
import time

import cv2
import numpy as np

width, height = int(sys.argv[1]), int(sys.argv[2])
y, x = np.mgrid[0:height, 0:width].astype(np.float32) + 0.5
i, j = (x - 0.5).astype(np.uint32), (y - 0.5).astype(np.uint32)
picture = np.dstack([i & 255, j & 255, (i ^ j) & 255, np.full_like(i, 255)]).astype(np.uint8)
bump_x = 0.3 * np.cos(x / 97) * np.sin(y / 131)
bump_y = 0.3 * np.sin(x / 89) * np.cos(y / 113)
pin_x, pin_y = bump_x[height // 2, width // 2], bump_y[height // 2, width // 2]
turn = np.hypot(bump_x - pin_x, bump_y - pin_y) * width * 0.5
map_x = (x - 0.5 + turn * (bump_x - pin_x)).astype(np.float32)
map_y = (y - 0.5 + turn * (bump_y - pin_y)).astype(np.float32)
for threads in (1, cv2.getNumberOfCPUs()):
    cv2.setNumThreads(threads)
    seconds = []
    for _ in range(7):
        start = time.perf_counter()
        cv2.remap(picture, map_x, map_y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REFLECT)
        seconds.append(time.perf_counter() - start)
    print(f"{sorted(seconds)[3] * 1e9 / (width * height):.3f}")
