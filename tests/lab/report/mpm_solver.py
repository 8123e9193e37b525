"""A half column in plane strain or a quarter of a round one, by the material point method, in Taichi: MLS-MPM (Hu et al. 2018) with
Drucker-Prager sand (Klar et al. 2016) and the volume correction of Tampubolon et al. (2017). One processor thread, single precision.
Importing it raises ImportError where Taichi is not installed."""
import math
import time

import numpy as np
import taichi as ti

GRAVITY, DENSITY, POISSON = 9.81, 2000.0, 0.3
COURANT = 0.3  # of pressure waves
PAD = 3  # cells beyond the walls: a quadratic kernel reaches 1.5
SIDE = 2  # particles along a cell's side

ti.init(arch=ti.cpu, cpu_max_num_threads=1, default_fp=ti.f32, log_level=ti.WARN, offline_cache=True)


@ti.data_oriented
class Column:
    """dimensions 2: a column of half-width `half` in plane strain, 3: radius; planes of symmetry at 0. Lengths in m. `cone`: the friction
    coefficient in triaxial compression, `floor`: that of the ground; `cohesion` [Pa]: the cone's tip bears cohesion / cone. `bed`: depth of
    the sand that the column stands on, from the middle to walls at `wall`."""

    def __init__(self, dimensions, half, height, cell, cone, floor, cohesion=0.0, bed=0.0, wall=None):
        self.dimensions, self.cell, self.floor = dimensions, cell, floor
        young = 1e6 * max(1.0, (bed + height) / 2)  # stiff enough for strains of some percent under the column
        self.lame = young * POISSON / ((1 + POISSON) * (1 - 2 * POISSON))
        self.shear = young / (2 * (1 + POISSON))
        self.step_size = COURANT * cell / math.sqrt((self.lame + 2 * self.shear) / DENSITY)
        self.tip = 3 * cohesion / cone / (3 * self.lame + 2 * self.shear) if cohesion else 0.0  # in logarithmic volume
        sine = math.sin(math.atan(cone))
        self.cone = math.sqrt(2 / 3) * 2 * sine / (3 - sine)  # alpha of Klar et al. 2016
        places = self.sites(half, height, bed, wall)
        self.count = len(places)
        area = math.pi * half**2 / 4 if dimensions == 3 else half
        self.volume = (area * height + (wall or 0) ** (dimensions - 1) * bed) / self.count
        self.mass = self.volume * DENSITY
        reach = wall + 2 * cell if wall else half + 2.2 * height + 1  # no pile gets there
        self.nodes = (round(reach / cell) + 2 * PAD,) * (dimensions - 1) + (round(1.15 * (bed + height) / cell) + 2 * PAD + 3,)
        self.last = (self.nodes[0] - 2 * PAD - 2) * cell
        self.x = ti.Vector.field(dimensions, ti.f32, self.count)
        self.v = ti.Vector.field(dimensions, ti.f32, self.count)
        self.affine = ti.Matrix.field(dimensions, dimensions, ti.f32, self.count)
        self.elastic = ti.Matrix.field(dimensions, dimensions, ti.f32, self.count)
        self.across = ti.field(ti.f32, self.count)  # logarithmic elastic strain normal to the plane, where that is not resolved
        self.gained = ti.field(ti.f32, self.count)  # logarithmic volume gained while the sand came apart
        self.momentum = ti.Vector.field(dimensions, ti.f32, self.nodes)
        self.weight = ti.field(ti.f32, self.nodes)
        self.x.from_numpy(places.astype(np.float32))
        self.elastic.from_numpy(np.broadcast_to(np.eye(dimensions, dtype=np.float32), (self.count, dimensions, dimensions)).copy())
        self.clock = 0.0

    def sites(self, half, height, bed, wall):
        """Places of the particles: a lattice, each moved by up to a quarter of its spacing."""
        spacing = self.cell / SIDE
        across, up = (np.arange(round(length / spacing)) + 0.5 for length in (wall or half, bed + height))
        axes = np.meshgrid(*[across] * (self.dimensions - 1), up, indexing="ij")
        places = np.stack([axis.ravel() for axis in axes], axis=1)
        places += np.random.default_rng(1).uniform(-0.25, 0.25, places.shape)
        places *= spacing
        return places[(np.linalg.norm(places[:, :-1], axis=1) < half) | (places[:, -1] < bed)]

    @ti.func
    def kernel_at(self, place):
        """First node, offset from it and weights of the quadratic B-spline."""
        scaled = place / self.cell + PAD
        base = ti.cast(scaled - 0.5, ti.i32)
        offset = scaled - ti.cast(base, ti.f32)
        return base, offset, [0.5 * (1.5 - offset) ** 2, 0.75 - (offset - 1) ** 2, 0.5 * (offset - 0.5) ** 2]

    @ti.func
    def returned(self, strain, gained):
        """Strain on or inside the cone, and what volume is still to be lost: projection to the yield surface, Klar et al. 2016."""
        whole = strain + (gained - self.tip) / 3
        trace = whole.sum()
        deviator = whole - trace / 3
        size = deviator.norm() + 1e-20
        excess = size + (3 * self.lame + 2 * self.shear) / (2 * self.shear) * trace * self.cone
        kept = ti.select(trace < 0, 1.0, 0.0)
        return kept * (whole - ti.max(excess / size, 0.0) * deviator) + self.tip / 3, ti.max(trace, 0.0)

    @ti.kernel
    def step(self):
        dt = ti.static(self.step_size)
        d = ti.static(self.dimensions)
        for node in ti.grouped(self.weight):
            self.weight[node] = 0
            self.momentum[node] = ti.Vector.zero(ti.f32, d)
        for p in self.x:
            base, offset, weights = self.kernel_at(self.x[p])
            u, sigma, w = ti.svd(self.elastic[p] + dt * self.affine[p] @ self.elastic[p])
            trial = ti.Vector([0.0, 0.0, self.across[p]])
            for i in ti.static(range(d)):
                trial[i] = ti.log(ti.max(sigma[i, i], 1e-4))
            strain, gained = self.returned(trial, self.gained[p])
            self.gained[p] = gained
            stretch = ti.Matrix.zero(ti.f32, d, d)
            stress = ti.Matrix.zero(ti.f32, d, d)
            for i in ti.static(range(d)):
                stretch[i, i] = ti.exp(strain[i])
                stress[i, i] = 2 * self.shear * strain[i] + self.lame * strain.sum()
            if ti.static(d == 2):
                self.across[p] = strain[2]
            self.elastic[p] = u @ stretch @ w.transpose()
            push = self.mass * self.affine[p] - dt * self.volume * 4 / self.cell**2 * (u @ stress @ u.transpose())
            for near in ti.static(ti.grouped(ti.ndrange(*[3] * d))):
                share = 1.0
                for i in ti.static(range(d)):
                    share *= weights[near[i]][i]
                away = (ti.cast(near, ti.f32) - offset) * self.cell
                # Not "+=", which would be atomic: there is one thread.
                self.momentum[base + near] = self.momentum[base + near] + share * (self.mass * self.v[p] + push @ away)
                self.weight[base + near] = self.weight[base + near] + share * self.mass
        for node in ti.grouped(self.weight):
            if self.weight[node] > 0:
                v = self.momentum[node] / self.weight[node]
                v[d - 1] -= dt * GRAVITY
                if node[d - 1] <= PAD and v[d - 1] < 0:  # Coulomb's friction for what the ground takes of the fall
                    stopped = self.floor * v[d - 1]
                    v[d - 1] = 0
                    v *= ti.max(0.0, 1 + stopped / (v.norm() + 1e-20))
                for i in ti.static(range(d - 1)):
                    if node[i] <= PAD or node[i] >= ti.static(self.nodes[0] - PAD - 2):
                        v[i] = 0
                self.momentum[node] = v
        for p in self.x:
            base, offset, weights = self.kernel_at(self.x[p])
            v = ti.Vector.zero(ti.f32, d)
            affine = ti.Matrix.zero(ti.f32, d, d)
            for near in ti.static(ti.grouped(ti.ndrange(*[3] * d))):
                share = 1.0
                for i in ti.static(range(d)):
                    share *= weights[near[i]][i]
                at = share * self.momentum[base + near]
                v += at
                affine += 4 / self.cell * at.outer_product(ti.cast(near, ti.f32) - offset)
            self.v[p] = v
            self.affine[p] = affine
            place = self.x[p] + dt * v
            for i in ti.static(range(d - 1)):
                place[i] = ti.min(ti.max(place[i], 1e-4), self.last)
            place[d - 1] = ti.max(place[d - 1], -self.cell)
            self.x[p] = place

    def warm(self):
        """Takes a first step: it is compiled then."""
        self.step()
        self.clock += self.step_size

    def advance(self, until):
        """Runs to that time [s] and returns the processor time that it took [s]."""
        begin = time.process_time()
        while self.clock < until - self.step_size / 2:
            self.step()
            self.clock += self.step_size
        return time.process_time() - begin

    def depths(self, width, samples=8):
        """Depth of the sand in rings or strips of `width` about the middle; a particle is as wide as a cell, which is what makes coarse
        ones err least."""
        places = self.x.to_numpy()[:, :-1]
        offsets = ((np.arange(samples) + 0.5) / samples - 0.5) * self.cell
        count = int(self.last / width) + 1
        held, shares = np.zeros(count), samples ** (self.dimensions - 1)
        for moved in np.stack(np.meshgrid(*[offsets] * (self.dimensions - 1)), axis=-1).reshape(shares, -1):
            ring = (np.linalg.norm(places + moved, axis=1) / width).astype(int)
            held += np.bincount(np.minimum(ring, count - 1), minlength=count)
        rim = np.arange(count + 1) * width
        areas = np.diff(np.pi * rim**2 / 4 if self.dimensions == 3 else rim)
        return held * self.volume / shares / areas
