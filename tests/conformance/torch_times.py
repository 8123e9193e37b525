#!/usr/bin/env python3
"""Times steps of PyTorch on a GPU, for a look beside Wadi's: torch.compile, ten steps a CUDA graph, median of 25 by the device's clock, and by the
wall. Needs torch (optional: exit code 77 without it or without a GPU). Mass and finite values are checked at the end.

usage: tests/conformance/torch_times.py mixture|water N ...
mixture: dam_break's sand and water on N x N cells (torch_scheme.py); water: the lean shallow-water step below, all wet.
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
import torch_scheme as scheme

STEPS = 10  # of a graph
LEAST_SECONDS = 1.2  # of replays ahead of the first time: clocks rise
MASS = 1e-4  # most relative change of a float32 sum


def water(k, g=9.81, eps=1e-5):
    """Upwind mass flux, momentum in flux form with those fluxes, pressure, walls, dry faces; k = dt / dx."""
    west, east, south, north, pos = scheme.W, scheme.E, scheme.S, scheme.N, scheme.pos

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


def problem(what, n, device, compiled):
    """(step(state) -> state, state, how many of its first fields keep their sums)"""
    ground = torch.zeros(n, n, device=device)
    if what == "water":
        one = compiled(water(0.08))
        column = torch.arange(n, device=device)[None, :].expand(n, n)
        state = [torch.where(column < n // 2, 2.0, 1.0).contiguous(), torch.zeros_like(ground), torch.zeros_like(ground)]
        return (lambda s: list(one(ground, *s))), state, 1
    p = scheme.Params(96 / n, 8.64 / n)
    parts = scheme.make_step(p)
    water_step, cohesion, sand_step = compiled(parts.water_step), compiled(parts.cohesion), compiled(parts.sand_step)

    def step(s):
        hs, w, us, vs, uw, vw, um, vm, xx, xy, yy = s
        w, uw, vw, um, vm, px, py = water_step(ground, hs, w, uw, vw, um, vm)
        c = cohesion(hs, w)
        for _ in range(p.T):
            hs, us, vs, uw, vw, um, vm, xx, xy, yy = sand_step(ground, hs, w, us, vs, uw, vw, um, vm, xx, xy, yy, c, px, py)
        return [hs, w, us, vs, uw, vw, um, vm, xx, xy, yy]
    return step, scheme.dam_break(n, device), 2


def checked(state, before):
    after = [float(field.double().sum()) for field in state[:len(before)]]
    assert all(bool(torch.isfinite(field).all()) for field in state), "not finite"
    assert all(abs(new - old) <= MASS * old for new, old in zip(after, before)), (before, after)


def measure(what, n):
    """(ms a step by the device's clock, by the wall)"""
    step, state, kept = problem(what, n, "cuda", lambda f: torch.compile(f, dynamic=False, fullgraph=True))
    before = [float(field.double().sum()) for field in state[:kept]]
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
    checked(state, before)
    return statistics.median(times), wall


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("what", choices=("mixture", "water"))
    parser.add_argument("sizes", nargs="+", type=int, metavar="N")
    options = parser.parse_args()
    if not torch.cuda.is_available():
        print("SKIPPED: no GPU for torch")
        return 77
    torch.set_grad_enabled(False)
    print(f"{torch.cuda.get_device_name()}, torch {torch.__version__}\n\n| | ms a step | by the wall |\n| --- | ---: | ---: |")
    for n in options.sizes:
        device, wall = measure(options.what, n)
        print(f"| {options.what}, {n} x {n} | {device:.5f} | {wall:.5f} |", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
