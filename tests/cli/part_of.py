#!/usr/bin/env python3
"""part_of.py WHOLE.exr PART.exr -- how far the pixels of PART are off those of WHOLE at its data window.

Both are written by `tyndall render --float`: channels of 32-bit floats, blocks of 16 lines, ZIP. Prints the number of values,
how many differ by more than 1e-5 of themselves and a thousandth of the whole's mean, and the farthest. Exit 1: the
windows do not fit, or PART is black.
"""
import struct
import sys
import zlib


def unpacked(data, size):
    """What a ZIP block of an .exr holds: differences of bytes, even bytes before odd ones."""
    if len(data) == size:
        return data
    data = bytearray(zlib.decompress(data))
    for i in range(1, len(data)):
        data[i] = (data[i - 1] + data[i] - 128) & 255
    half, out = (len(data) + 1) // 2, bytearray(len(data))
    out[0::2], out[1::2] = data[:half], data[half:]
    return bytes(out)


def read(path):
    """Data window (x0, y0, x1, y1), and of each channel, in the file's order, its lines."""
    with open(path, "rb") as file:
        data = file.read()
    at, window, channels = 8, None, 0
    while data[at]:
        name_end = data.index(0, at)
        kind_end = data.index(0, name_end + 1)
        size, = struct.unpack_from("<i", data, kind_end + 1)
        name, begin = data[at:name_end], kind_end + 5
        at = begin + size
        if name == b"dataWindow":
            window = struct.unpack_from("<4i", data, begin)
        elif name == b"channels":
            while data[begin]:
                begin, channels = data.index(0, begin) + 17, channels + 1
    width, height = window[2] - window[0] + 1, window[3] - window[1] + 1
    planes = [[] for _ in range(channels)]
    for block in range((height + 15) // 16):
        offset, = struct.unpack_from("<Q", data, at + 1 + 8 * block)
        y, size = struct.unpack_from("<2i", data, offset)
        lines = min(16, window[3] + 1 - y)
        values = unpacked(data[offset + 8:offset + 8 + size], 4 * lines * channels * width)
        for line in range(lines):
            for channel in range(channels):
                planes[channel].append(struct.unpack_from(f"<{width}f", values, 4 * width * (line * channels + channel)))
    return window, planes


def main():
    (window, whole), (part_window, part) = read(sys.argv[1]), read(sys.argv[2])
    x, y = part_window[0] - window[0], part_window[1] - window[1]
    width, height = part_window[2] - part_window[0] + 1, part_window[3] - part_window[1] + 1
    if min(x, y) < 0 or part_window[2] > window[2] or part_window[3] > window[3] or len(part) != len(whole):
        print(f"{part_window} of {window}")
        return 1
    count, off, farthest, light = 0, 0, 0.0, 0.0
    for p, w in zip(part, whole):
        mean = sum(map(sum, w)) / (len(w) * len(w[0]))
        for row in range(height):
            for a, b in zip(p[row], w[y + row][x:x + width]):
                apart = abs(a - b) / (abs(b) + 1e-3 * abs(mean) + 1e-30)
                count, light = count + 1, light + abs(a)
                off, farthest = off + (not apart <= 1e-5), max(farthest, apart)
    print(count, off, f"{farthest:.2g}")
    return 0 if light > 0 else 1


if __name__ == "__main__":
    sys.exit(main())
