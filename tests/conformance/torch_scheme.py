"""The step of sand and water as a user of PyTorch would write it: whole arrays, float32. What torch_times.py times Wadi against.

Arrays are (ny, nx). u[j, i] is the velocity on the west face of cell (j, i), v[j, i] on its south face. Column 0 of u and row 0 of v are walls
and stay 0, so that torch.roll wraps round to a wall: a closed box needs no padding. Formulas in brackets: engine/NUMERICS.md. It has mixture,
diffusion, drag, elastoplastic force and cohesion, T sand substeps, and lacks what Wadi's step also does: quanta of mass, the rest rule, slope-normal
gravity, internal friction, retention, shock viscosity, bed friction, sources, rain, open sides, active tiles.
"""
import math
import torch

TINY = 1e-30


class Params:
    """Material and method of samples/levels/dam_break unless said otherwise; derived as engine/world_params.cpp does."""

    def __init__(self, dx, dt, substeps=3, young=1e6, nu=0.3, friction=0.5, c_f=0.4, c0=500.0, c1=2e4, c2=2e4,
                 phi=(0.2, 0.25, 0.33), exchange=2e4, diffusion=0.02, rho_w=1000.0, rho_s=2000.0, g=9.81):
        self.dx, self.dt, self.T = dx, dt, substeps
        dts = dt / substeps
        self.k, self.ks, self.dts = dt / dx, dts / dx, dts
        self.g, self.eps, self.mu_f, self.c_f = g, 1e-5, friction, c_f
        self.clamp_w, self.clamp_s = 0.35 / self.k, 0.35 / self.ks
        self.cap_base, self.cap_least, self.sand_cap = 0.55, 0.15, 0.25 / self.ks**2
        self.ratio, self.rho_w, self.rho_s = rho_w / rho_s, rho_w, rho_s
        kd = dts * exchange
        self.coupling, self.share = kd * rho_w / (rho_w + kd) / rho_s, kd / (rho_w + kd)
        lam, mu = young * nu / ((1 + nu) * (1 - 2 * nu)), young / (2 * (1 + nu))
        s = min(1.0, 0.2 * rho_s * dx * dx / (dts * dts * (lam + 2 * mu)))
        self.lam, self.mu = lam * s, mu * s
        self.c0, self.c1, self.c2, self.phi = c0, c1, c2, phi
        self.diff = min(diffusion, 0.2 * dx * dx / dt) * dt / (dx * dx)


def W(a): return torch.roll(a, 1, 1)
def E(a): return torch.roll(a, -1, 1)
def S(a): return torch.roll(a, 1, 0)
def N(a): return torch.roll(a, -1, 0)
def pos(a): return torch.clamp_min(a, 0.0)
def neg(a): return torch.clamp_max(a, 0.0)
def ratio(a, b): return torch.where(b > 0, a / torch.where(b > 0, b, 1.0), 0.0)


def make_step(p):
    eps = p.eps

    def inner(a):
        """Masks of the faces that are no walls; index arithmetic once compiled."""
        ix = torch.arange(a.shape[1], device=a.device)[None, :] > 0
        iy = torch.arange(a.shape[0], device=a.device)[:, None] > 0
        return ix, iy

    def minmod(a, b):
        return torch.where(a * b > 0, torch.where(a.abs() < b.abs(), a, b), 0.0)

    def limited(fx, fy, h):
        """Outflow limiter, limited fluxes (NUMERICS 2.2)."""
        out = (pos(-fx) + pos(E(fx))) + (pos(-fy) + pos(N(fy)))
        safe = h * (1 - 4 * 2.0**-23)
        scale = torch.where(out > safe, ratio(safe, out), 1.0)
        return (fx * torch.where(fx > 0, W(scale), scale), fy * torch.where(fy > 0, S(scale), scale))

    def moved(h, fx, fy):
        return pos(h + ((fx - E(fx)) + (fy - N(fy))))

    def upwind(u, v, h, k):
        return k * (pos(u) * W(h) + neg(u) * h), k * (pos(v) * S(h) + neg(v) * h)

    def advect(u, v, fx, fy, h):
        """Momentum in flux form on the faces' own control volumes (2.3)."""
        hx, hy = 0.5 * (W(h) + h), 0.5 * (S(h) + h)
        qw, qe = 0.5 * (W(fx) + fx), 0.5 * (fx + E(fx))
        fyn = N(fy)
        qs, qn = 0.5 * (W(fy) + fy), 0.5 * (W(fyn) + fyn)
        du = (pos(-qe) * (E(u) - u) + pos(qw) * (W(u) - u)) + (pos(-qn) * (N(u) - u) + pos(qs) * (S(u) - u))
        rs, rn = 0.5 * (S(fy) + fy), 0.5 * (fy + N(fy))
        fxe = E(fx)
        rw, re = 0.5 * (S(fx) + fx), 0.5 * (S(fxe) + fxe)
        dv = (pos(-rn) * (N(v) - v) + pos(rs) * (S(v) - v)) + (pos(-re) * (E(v) - v) + pos(rw) * (W(v) - v))
        return torch.where(hx > eps, u + ratio(du, hx), u), torch.where(hy > eps, v + ratio(dv, hy), v)

    def exchange(u, um, gl, gh, pure, mixed):
        """Water changes between pure and mixed and takes its momentum along (2.4a)."""
        to_m, to_p = 0.5 * (pos(gl) + pos(gh)), 0.5 * (pos(-gl) + pos(-gh))
        m, w = pos(mixed - to_p) + to_m, pos(pure - to_m) + to_p
        d = u - um
        return torch.where(w > eps, u - ratio(to_p * d, w), u), torch.where(m > eps, um + ratio(to_m * d, m), um)

    def blocked(hl, hh, sl, sh):
        wl, wh = hl > eps, hh > eps
        return (~wl & ~wh) | (wl & ~wh & (sh >= sl)) | (wh & ~wl & (sl >= sh))

    def water_gravity(speed, deep):
        cap = torch.square(torch.clamp_min(p.cap_base - p.k * speed, p.cap_least)) / p.k**2
        return torch.where(p.g * deep > cap, ratio(cap, deep), p.g)

    def sand_gravity(h):
        return torch.where(p.g * h > p.sand_cap, p.sand_cap / torch.clamp_min(h, TINY), p.g)

    def saturation(hs, w):
        a, b = torch.where(hs > eps, w, 0.0), torch.where(hs > eps, w + hs, 0.0)
        return ratio(a, b)

    def water_step(H, hs, w, uw, vw, um, vm):
        ix, iy = inner(w)
        hm = torch.minimum(w, hs)
        hw = w - hm
        eta = H + w
        wfx, wfy = upwind(uw, vw, hw, p.k)
        mfx, mfy = upwind(um, vm, hm, p.k)
        wet = hs > eps
        mfx = mfx - torch.where(ix & W(wet) & wet, p.diff * minmod(hm - W(hm), eta - W(eta)), 0.0)
        mfy = mfy - torch.where(iy & S(wet) & wet, p.diff * minmod(hm - S(hm), eta - S(eta)), 0.0)
        wfx, wfy = limited(wfx, wfy, hw)
        mfx, mfy = limited(mfx, mfy, hm)
        pure, mixed = moved(hw, wfx, wfy), moved(hm, mfx, mfy)
        w = pure + mixed
        u1, v1 = advect(uw, vw, wfx, wfy, pure)
        m1, m2 = advect(um, vm, mfx, mfy, mixed)
        split = torch.minimum(w, hs)
        gain = split - mixed
        u1, m1 = exchange(u1, m1, W(gain), gain, 0.5 * (W(pure) + pure), 0.5 * (W(mixed) + mixed))
        v1, m2 = exchange(v1, m2, S(gain), gain, 0.5 * (S(pure) + pure), 0.5 * (S(mixed) + mixed))
        eta = H + w
        rx, ry = eta - W(eta), eta - S(eta)
        gx = water_gravity(torch.maximum(u1.abs(), m1.abs()), torch.maximum(w, W(w)))
        gy = water_gravity(torch.maximum(v1.abs(), m2.abs()), torch.maximum(w, S(w)))
        px, py = p.k * gx * rx, p.k * gy * ry
        u1, v1 = u1 - px, v1 - py
        sx = blocked(W(split), split, W(eta), eta) | ~ix
        sy = blocked(S(split), split, S(eta), eta) | ~iy
        m1 = torch.where(sx, 0.0, torch.clamp(m1, -p.clamp_w, p.clamp_w))
        m2 = torch.where(sy, 0.0, torch.clamp(m2, -p.clamp_w, p.clamp_w))
        px, py = torch.where(sx, 0.0, px / p.T), torch.where(sy, 0.0, py / p.T)
        top = w - split
        u1 = torch.where(blocked(W(top), top, W(eta), eta) | ~ix, 0.0, torch.clamp(u1, -p.clamp_w, p.clamp_w))
        v1 = torch.where(blocked(S(top), top, S(eta), eta) | ~iy, 0.0, torch.clamp(v1, -p.clamp_w, p.clamp_w))
        return w, u1, v1, m1, m2, px, py

    def gradient(us, vs, wet):
        uc, vc = 0.5 * (us + E(us)), 0.5 * (vs + N(vs))

        def across(low, mid, high, wl, wh, other):
            one = torch.where(wh, p.ks * (high - mid), torch.where(wl, p.ks * (mid - low), -other))
            return torch.where(wl & wh, 0.5 * p.ks * (high - low), one)
        ix, iy = inner(us)
        ww, ws = W(wet) & ix, S(wet) & iy
        we, wn = E(wet & ix), N(wet & iy)
        zero = torch.zeros_like(us)
        yx = across(W(vc), vc, E(vc), ww, we, zero)
        any_x, any_y = ww | we, ws | wn
        xy = across(S(uc), uc, N(uc), ws, wn, torch.where(any_x, yx, 0.0))
        yx = torch.where(any_x, yx, -torch.where(any_y, xy, 0.0))
        c = lambda x: torch.clamp(x, -0.4, 0.4)
        return c(p.ks * (E(us) - us)), c(xy), c(yx), c(p.ks * (N(vs) - vs))

    def evolve(xx, xy, yy, gxx, gxy, gyx, gyy):
        """Cayley step of the left stretch, rotation taken out again (2.6). xx, xy, yy hold V - I."""
        ax, ay = 1 - 0.5 * gxx, 1 - 0.5 * gyy
        q = gxy * gyx
        det = 1.0 / (ax * ay - 0.25 * q)
        mxx, mxy, myx, myy = (ay * gxx + 0.5 * q) * det, gxy * det, gyx * det, (ax * gyy + 0.5 * q) * det
        exx, exy = xx + mxx + mxx * xx + mxy * xy, xy + mxy + mxx * xy + mxy * yy
        eyx, eyy = xy + myx + myx * xx + myy * xy, yy + myy + myx * xy + myy * yy
        x, y = 2 + (exx + eyy), eyx - exy
        n = torch.sqrt(x * x + y * y)
        sn, small = y / n, -y * y / (n * (n + x))
        cs = 1 + small
        return (exx * cs - exy * sn + small, 0.5 * ((exx - eyy) * sn + (exy + eyx) * cs), eyx * sn + eyy * cs + small)

    def project(xx, xy, yy, c, cap):
        """Hencky strain of V by the eigenvalues of V V^T, compression cap, Drucker-Prager cone, back to V and to stress (2.7)."""
        bxx, byy = 2 * xx + (xx * xx + xy * xy), 2 * yy + (yy * yy + xy * xy)
        bxy = 2 * xy + xy * (xx + yy)
        m, d = 0.5 * (bxx + byy), 0.5 * (bxx - byy)
        r = torch.sqrt(d * d + bxy * bxy)
        det = (1 + xx) * (1 + yy) - xy * xy
        e1 = torch.clamp(0.5 * torch.log1p(torch.clamp_min(m + r, -0.99)), -0.5, 0.5)
        e2 = torch.clamp(0.5 * torch.log1p(torch.clamp_min(m - r, -0.99)), -0.5, 0.5)
        tr = e1 + e2
        along = ratio(0.5 * (e1 - e2), r)
        dd, dxy = along * d, along * bxy
        bulk, slope = p.lam + p.mu, p.c_f * (2 * p.mu + 2 * p.lam)
        least = -(cap + c / p.c_f) / bulk
        slack = 1 + 4e-6
        keep = tr >= least * slack
        tr = torch.where(keep, tr, least)
        y = slope * tr - c
        tip = y >= 0
        limit, size = -y / (2 * p.mu), math.sqrt(0.5) * (e1 - e2)
        beyond = size > limit * slack
        shrink = torch.where(tip, 0.0, torch.where(beyond, ratio(limit, size), 1.0))
        tr = torch.where(tip, c / slope, tr)
        dd, dxy = dd * shrink, dxy * shrink
        broken = ~((det > 1e-6) & (m + r < 1e6))
        tr, dd, dxy = torch.where(broken, 0.0, tr), torch.where(broken, 0.0, dd), torch.where(broken, 0.0, dxy)
        keep = keep & ~tip & ~broken & ~beyond
        h = torch.sqrt(dd * dd + dxy * dxy)
        em = torch.expm1(0.5 * tr)
        e = 1 + em
        ch = torch.square(torch.sinh(0.5 * h)) * 2
        sh = e * torch.where(h > 1e-4, torch.sinh(h) / torch.clamp_min(h, TINY), 1.0)
        nxx, nyy, nxy = em + e * ch + sh * dd, em + e * ch - sh * dd, sh * dxy
        xx, xy, yy = torch.where(keep, xx, nxx), torch.where(keep, xy, nxy), torch.where(keep, yy, nyy)
        j = 1 / (e * e)
        mean = bulk * tr
        return xx, xy, yy, (mean + 2 * p.mu * dd) * j, 2 * p.mu * dxy * j, (mean - 2 * p.mu * dd) * j

    def sand_step(H, hs, w, us, vs, uw, vw, um, vm, xx, xy, yy, coh, px, py):
        ix, iy = inner(hs)
        old = hs
        fx, fy = limited(*upwind(us, vs, hs, p.ks), hs)
        hs = moved(old, fx, fy)
        # strain moves with the sand, then follows the velocity gradient
        iw, ie, isn, ino = pos(fx), pos(-E(fx)), pos(fy), pos(-N(fy))
        inv = ratio(torch.ones_like(hs), hs)
        adv = lambda a: a + inv * ((iw * (W(a) - a) + ie * (E(a) - a)) + (isn * (S(a) - a) + ino * (N(a) - a)))
        xx, xy, yy = adv(xx), adv(xy), adv(yy)
        wet = old > eps
        ex, exy, ey = evolve(xx, xy, yy, *gradient(us, vs, wet))
        gone = hs <= TINY
        xx = torch.where(gone, 0.0, torch.where(wet, ex, xx))
        xy = torch.where(gone, 0.0, torch.where(wet, exy, xy))
        yy = torch.where(gone, 0.0, torch.where(wet, ey, yy))
        # water changes layer; this substep's share of the mixed water's pressure
        b = torch.minimum(w, old)
        gain = torch.minimum(w, hs) - b
        pure = w - b
        uw, um = exchange(uw, um, W(gain), gain, 0.5 * (W(pure) + pure), 0.5 * (W(b) + b))
        vw, vm = exchange(vw, vm, S(gain), gain, 0.5 * (S(pure) + pure), 0.5 * (S(b) + b))
        uw, vw = torch.where(ix, uw, 0.0), torch.where(iy, vw, 0.0)
        um, vm = torch.where(ix, um - px, 0.0), torch.where(iy, vm - py, 0.0)
        # yield and stress
        weight = p.rho_s * p.g
        c = torch.minimum(coh, 2 * p.c_f * 0.9 * weight * hs)
        wet = hs > eps
        nxx, nxy, nyy, sxx, sxy, syy = project(xx, xy, yy, c, weight * hs)
        xx, xy, yy = torch.where(wet, nxx, xx), torch.where(wet, nxy, xy), torch.where(wet, nyy, yy)
        sxx, sxy, syy = torch.where(wet, sxx, 0.0), torch.where(wet, sxy, 0.0), torch.where(wet, syy, 0.0)
        # momentum, elastoplastic force, gravity
        u1, v1 = advect(us, vs, fx, fy, hs)
        hx, hy = 0.5 * (W(hs) + hs), 0.5 * (S(hs) + hs)
        hW, sW = W(hs), W(sxy)
        least = torch.minimum(torch.minimum(hs, hW), torch.minimum(S(hs), S(hW)))
        corner = least * 0.25 * ((sxy + sW) + (S(sxy) + S(sW)))
        corner = torch.where(ix & iy, corner, 0.0)
        tx, ty = hs * sxx, hs * syy
        u1 = u1 + p.ks / p.rho_s * ratio((tx - W(tx)) + (N(corner) - corner), hx)
        v1 = v1 + p.ks / p.rho_s * ratio((ty - S(ty)) + (E(corner) - corner), hy)
        load = H + hs + p.ratio * pos(w - hs)
        gx, gy = sand_gravity(torch.maximum(hs, W(hs))), sand_gravity(torch.maximum(hs, S(hs)))
        u1, v1 = u1 - p.ks * gx * (load - W(load)), v1 - p.ks * gy * (load - S(load))
        u1 = torch.where((hx < 0.5 * eps) | blocked(W(hs), hs, W(load), load) | ~ix, 0.0, u1)
        v1 = torch.where((hy < 0.5 * eps) | blocked(S(hs), hs, S(load), load) | ~iy, 0.0, v1)
        # drag and Coulomb friction together (2.8)
        hm = torch.minimum(w, hs)
        mx, my = 0.5 * (W(hm) + hm), 0.5 * (S(hm) + hm)
        rx, ry = ratio(mx, hx), ratio(my, hy)
        kx, ky = torch.where(mx > eps, rx * p.coupling, 0.0), torch.where(my > eps, ry * p.coupling, 0.0)
        def four_v(a): n = N(a); return 0.25 * ((W(a) + W(n)) + (a + n))
        def four_u(a): e = E(a); return 0.25 * ((S(a) + S(e)) + (a + e))
        ax, ay = u1 + kx * um, v1 + ky * vm
        cx, cy = four_v(v1) + kx * four_v(vm), four_u(u1) + ky * four_u(um)

        def stick(a, c, gf, r, kap):
            size = torch.sqrt(a * a + c * c)
            slip = p.mu_f * p.dts * gf * pos(1 - p.ratio * r)
            return a * ratio(pos(size - slip), size * (1 + kap))
        us = torch.where((hx <= 0.5 * eps) | ~ix, 0.0, stick(ax, cx, gx, rx, kx))
        vs = torch.where((hy <= 0.5 * eps) | ~iy, 0.0, stick(ay, cy, gy, ry, ky))
        um = torch.where((mx > 0) & ix, torch.where(hx <= 0.5 * eps, um, um + p.share * (us - um)), 0.0)
        vm = torch.where((my > 0) & iy, torch.where(hy <= 0.5 * eps, vm, vm + p.share * (vs - vm)), 0.0)
        c_s, c_w = p.clamp_s, p.clamp_w
        return (hs, torch.clamp(us, -c_s, c_s), torch.clamp(vs, -c_s, c_s), uw, vw, torch.clamp(um, -c_w, c_w),
                torch.clamp(vm, -c_w, c_w), xx, xy, yy)

    def cohesion(hs, w):
        f = saturation(hs, w)
        p1, p2, p3 = p.phi
        c = torch.where(f < p1, p.c0 + f * ((p.c1 - p.c0) / p1),
                        torch.where(f < p2, p.c1 + (f - p1) * ((p.c2 - p.c1) / (p2 - p1)), (p3 - f) * (p.c2 / (p3 - p2))))
        return torch.where(f > p3, 0.0, c)

    def step(H, hs, w, us, vs, uw, vw, um, vm, xx, xy, yy):
        w, uw, vw, um, vm, px, py = water_step(H, hs, w, uw, vw, um, vm)
        coh = cohesion(hs, w)
        for _ in range(p.T):
            hs, us, vs, uw, vw, um, vm, xx, xy, yy = sand_step(H, hs, w, us, vs, uw, vw, um, vm, xx, xy, yy, coh, px, py)
        return hs, w, us, vs, uw, vw, um, vm, xx, xy, yy
    step.water_step, step.sand_step, step.cohesion = water_step, sand_step, cohesion
    return step


def dam_break(n, device, size=96.0):
    """samples/levels/dam_break on n x n cells: heights at cell centres."""
    dx = size / n
    c = (torch.arange(n, dtype=torch.float64) + 0.5) * dx
    y, x = torch.meshgrid(c, c, indexing="ij")
    disc = lambda cx, cy, r: (x - cx)**2 + (y - cy)**2 < r * r
    hs = 6.0 * disc(62, 62, 14) + 2.5 * disc(70, 25, 11)
    w = 8.0 * ((x < 39) & (y < 40)) + 0.22 * 2.5 * disc(70, 25, 11)
    z = lambda: torch.zeros(n, n, device=device)
    return [hs.float().to(device), w.float().to(device)] + [z() for _ in range(9)]
