#!/usr/bin/env python3
"""Times steps of shallow water in PyTorch on a GPU, all wet, for a look beside Wadi's: torch.compile, ten steps a CUDA graph, median of 25 by the device's clock, and by the
wall. Needs torch (optional: exit code 77 without it or without a GPU). Mass and finite values are checked at the end.

usage: tests/conformance/torch_times.py N ...     on N x N cells
"""
import argparse
import statistics
import sys
import time

try:
    import torch
except ImportError:
    print("SKIPPED: no torch")
    sys.exit(77)

STEPS = 10  # of a graph
LEAST_SECONDS = 1.2  # of replays ahead of the first time: clocks rise
MASS = 1e-4  # most relative change of a float32 sum


def water(k, g=9.81, eps=1e-5):
    """Upwind mass flux, momentum in flux form with those fluxes, pressure, walls, dry faces; k = dt / dx. Arrays are (ny, nx), velocities those
    of west and south faces; column 0 of u and row 0 of v are walls and stay 0, so that rolling wraps round to a wall."""
    west, east, south, north = (lambda a, by=by, axis=axis: torch.roll(a, by, axis) for axis, by in ((1, 1), (1, -1), (0, 1), (0, -1)))
    pos = lambda a: torch.clamp_min(a, 0.0)

    def step(ground, h, u, v):
        inner_x = torch.arange(h.shape[1], device=h.device)[None, :] > 0
        inner_y = torch.arange(h.shape[0], device=h.device)[:, None] > 0
        fx, fy = k * (pos(u) * west(h) - pos(-u) * h), k * (pos(v) * south(h) - pos(-v) * h)
        h = h + ((fx - east(fx)) + (fy - north(fy)))
        hx, hy, fy_north, fx_east = 0.5 * (west(h) + h), 0.5 * (south(h) + h), north(fy), east(fx)
        du = (pos(west(fx) + fx) * (west(u) - u) + pos(-(fx + fx_east)) * (east(u) - u) + pos(west(fy) + fy) * (south(u) - u)
              + pos(-(west(fy_north) + fy_north)) * (north(u) - u))
        dv = (pos(south(fy) + fy) * (south(v) - v) + pos(-(fy + fy_north)) * (north(v) - v) + pos(south(fx) + fx) * (west(v) - v)
              + pos(-(south(fx_east) + fx_east)) * (east(v) - v))
        surface = ground + h
        u = torch.where(inner_x & (hx > eps), u + 0.5 * du / hx - k * g * (surface - west(surface)), 0.0)
        v = torch.where(inner_y & (hy > eps), v + 0.5 * dv / hy - k * g * (surface - south(surface)), 0.0)
        return h, u, v
    return step


def dam(n, device):
    """Ground, heights and velocities: 2 m of water beside 1 m."""
    column, zero = torch.arange(n, device=device)[None, :].expand(n, n), torch.zeros(n, n, device=device)
    return zero, [torch.where(column < n // 2, 2.0, 1.0).contiguous(), zero.clone(), zero.clone()]


def measure(n):
    """(ms a step by the device's clock, by the wall)"""
    one = torch.compile(water(0.08), dynamic=False, fullgraph=True)
    ground, state = dam(n, "cuda")
    mass, step = float(state[0].double().sum()), lambda s: list(one(ground, *s))
    stream = torch.cuda.Stream()
    with torch.cuda.stream(stream):
        for _ in range(3):
            step(state)
    torch.cuda.current_stream().wait_stream(stream)
    graph = torch.cuda.CUDAGraph()
    with torch.cuda.graph(graph):
        out = state
        for _ in range(STEPS):
            out = step(out)
        for field, new in zip(state, out):
            field.copy_(new)
    start = time.monotonic()
    while time.monotonic() - start < LEAST_SECONDS:
        graph.replay()
        torch.cuda.synchronize()
    times = []
    for _ in range(25):
        first, last = torch.cuda.Event(True), torch.cuda.Event(True)
        first.record()
        graph.replay()
        last.record()
        torch.cuda.synchronize()
        times.append(first.elapsed_time(last) / STEPS)
    start = time.perf_counter()
    for _ in range(10):
        graph.replay()
    torch.cuda.synchronize()
    wall = 1e3 * (time.perf_counter() - start) / (10 * STEPS)
    assert all(bool(torch.isfinite(field).all()) for field in state), "not finite"
    assert abs(float(state[0].double().sum()) - mass) <= MASS * mass, "mass changed"
    return statistics.median(times), wall


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("sizes", nargs="+", type=int, metavar="N")
    options = parser.parse_args()
    if not torch.cuda.is_available():
        print("SKIPPED: no GPU for torch")
        return 77
    torch.set_grad_enabled(False)
    print(f"{torch.cuda.get_device_name()}, torch {torch.__version__}\n\n| | ms a step | by the wall |\n| --- | ---: | ---: |")
    for n in options.sizes:
        device, wall = measure(n)
        print(f"| water, {n} x {n} | {device:.5f} | {wall:.5f} |", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
