#!/usr/bin/python3
"""Draws a part of a trace of `triglyph --trace` as an SVG: a row a thread, a colour a stage, and the
counters below. Usage: draw_trace.py TRACE FROM_SECONDS TO_SECONDS > PICTURE.svg
With one argument it prints what the spans add up to instead."""

import collections
import json
import sys
from html import escape

WIDTH, LEFT, ROW = 1100, 110, 46
# enclosing spans are not drawn
ENCLOSING = {"file"}
COLOURS = {
    "load": "#4e79a7", "plan": "#9c755f", "look up": "#d7b5a6", "mark": "#59a14f", "write": "#f28e2b",
    "read back": "#edc948", "measure": "#b07aa1", "ledger": "#e15759", "publish": "#ff9da7",
    "records": "#79706e", "deliver": "#499894", "wait to deliver": "#000000", "next": "#bab0ac",
    "companions": "#86bcb6", "read": "#4e79a7", "verify": "#4e79a7", "attack": "#4e79a7", "pair": "#4e79a7",
    "trace": "#4e79a7",
}


def read_events(path):
    """Reads a trace; one that was cut off lacks its end, and perhaps the end of its last line."""
    events = []
    with open(path, encoding="utf-8") as lines:
        for line in lines:
            try:
                events.append(json.loads(line.strip().rstrip(",")))
            except json.JSONDecodeError:
                continue
    return [event for event in events if isinstance(event, dict)]


def summarise(events):
    spans = [event for event in events if event["ph"] == "X"]
    begin = min(span["ts"] for span in spans)
    end = max(span["ts"] + span["dur"] for span in spans)
    threads = {(span["pid"], span["tid"]) for span in spans}
    total = collections.Counter()
    count = collections.Counter()
    for span in spans:
        total[span["name"]] += span["dur"]
        count[span["name"]] += 1
    available = (end - begin) * len(threads)
    stages = [name for name in total if name not in ENCLOSING]
    print(f"{(end - begin) / 1e6:.2f} s, {len(threads)} threads, {count['file']} files")
    for name in sorted(stages, key=lambda name: -total[name]):
        print(f"{name:16} {count[name]:7} {total[name] / 1e6:9.3f} s {100 * total[name] / available:6.2f} %")
    rest = available - sum(total[name] for name in stages)
    print(f"{'idle and other':16} {'':7} {rest / 1e6:9.3f} s {100 * rest / available:6.2f} %")


def draw(events, begin, end):
    scale = (WIDTH - LEFT - 10) / (end - begin)
    threads = sorted({(event["pid"], event["tid"]) for event in events if event["ph"] == "X"})
    seen = []
    body = []

    def place(time):
        return LEFT + (min(max(time, begin), end) - begin) * scale

    for row, thread in enumerate(threads):
        top = 30 + row * ROW
        body.append(f'<text x="4" y="{top + 22}">thread {row + 1}</text>')
        body.append(f'<rect x="{LEFT}" y="{top}" width="{WIDTH - LEFT - 10}" height="32" fill="#eee"/>')
        for event in events:
            if event["ph"] != "X" or event["name"] in ENCLOSING or (event["pid"], event["tid"]) != thread:
                continue
            if event["ts"] + event["dur"] < begin or event["ts"] > end:
                continue
            left, right = place(event["ts"]), place(event["ts"] + event["dur"])
            name = event["name"]
            if name not in seen:
                seen.append(name)
            title = escape(f'{name}, {event["args"]["file"]}, {event["dur"] / 1000:.3f} ms')
            body.append(f'<rect x="{left:.2f}" y="{top}" width="{max(right - left, 0.15):.2f}" height="32" '
                        f'fill="{COLOURS.get(name, "#888")}"><title>{title}</title></rect>')
    top = 30 + len(threads) * ROW
    for name, key, unit in (("bytes in flight", "bytes", "MB"), ("resident memory", "bytes", "MB")):
        values = [(event["ts"], event["args"][key] / 1e6) for event in events
                  if event["ph"] == "C" and event["name"] == name]
        values.sort()
        most = max((value for time, value in values if time <= end), default=1) or 1
        path, last = [], None
        for time, value in values:
            if time > end:
                break
            height = top + 36 - 34 * value / most
            if time >= begin:
                path.append(f"H{place(time):.1f}V{height:.1f}" if path or last else f"M{LEFT},{height:.1f}")
            last = height
            if time < begin:
                path = [f"M{LEFT},{height:.1f}"]
        body.append(f'<path d="{"".join(path)}H{WIDTH - 10}" fill="none" stroke="#4e79a7"/>')
        body.append(f'<text x="4" y="{top + 16}">{name}</text>')
        body.append(f'<text x="4" y="{top + 31}" fill="#666">to {most:.1f} {unit}</text>')
        top += ROW
    for tick in range(6):
        time = begin + (end - begin) * tick / 5
        body.append(f'<text x="{place(time):.1f}" y="{top + 12}" text-anchor="{"end" if tick == 5 else "middle"}" '
                    f'fill="#666">{time / 1e6:.3f} s</text>')
    left = 4
    for name in seen:
        body.append(f'<rect x="{left}" y="6" width="12" height="12" fill="{COLOURS.get(name, "#888")}"/>')
        body.append(f'<text x="{left + 16}" y="16">{name}</text>')
        left += 34 + 7 * len(name)
    print(f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {top + 20}" '
          f'font-family="sans-serif" font-size="12"><rect width="100%" height="100%" fill="#fff"/>')
    print("\n".join(body))
    print("</svg>")


if __name__ == "__main__":
    if len(sys.argv) not in (2, 4):
        sys.exit(__doc__)
    trace = read_events(sys.argv[1])
    if len(sys.argv) == 2:
        summarise(trace)
    else:
        draw(trace, float(sys.argv[2]) * 1e6, float(sys.argv[3]) * 1e6)
